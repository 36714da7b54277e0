"""Where outputs go: beside the submission, into a folder, under a name that nothing else has."""

from pathlib import Path

import pytest

from flexlash.targets import beside, mended_targets, recreated_targets, report_targets, template_target


def _names(targets, folder):
    return [str(target.relative_to(folder)) for target in targets]


PLANS = {
    "beside the submission": (["a.xlsx"], None, ["a-report.xlsx"], ["a-mended.xlsx"], ["a-checked.xlsx"]),
    "into a folder": (
        ["a.xlsx", "b.csv"],
        "out",
        ["out/a-report.xlsx", "out/b-report.xlsx"],
        ["out/a-mended.xlsx", "out/b-mended.csv"],
        ["out/a-checked.xlsx", "out/b-checked.xlsx"],
    ),
    "equal names": (
        ["a.xlsx", "in/a.xlsx", "in/a.csv"],
        "out",
        ["out/a-report.xlsx", "out/a-report (2).xlsx", "out/a-report (3).xlsx"],
        ["out/a-mended.xlsx", "out/a-mended (2).xlsx", "out/a-mended.csv"],
        ["out/a-checked.xlsx", "out/a-checked (2).xlsx", "out/a-checked (3).xlsx"],
    ),
    "a marked copy": (
        ["a-checked.xlsx"],
        None,
        ["a-checked-report.xlsx"],
        ["a-checked-mended.xlsx"],
        ["a-checked.xlsx"],
    ),
    "a file": (["a.xlsx"], "x.xlsx", ["x.xlsx"], ["x.xlsx"], ["a-checked.xlsx"]),
}


@pytest.mark.parametrize("what", PLANS)
def test_where_outputs_go(what, tmp_path):
    """Reports, mended files and marked copies get names that say what they are, each its own."""
    submissions, output, reports, mended, marked = PLANS[what]
    paths = [tmp_path / name for name in submissions]
    out = tmp_path / output if output else None
    assert _names(report_targets(paths, out), tmp_path) == reports
    assert _names(mended_targets(paths, out), tmp_path) == mended
    assert _names(beside(paths, report_targets(paths, out)), tmp_path) == marked


WRONG = {
    "several submissions, one file": (["a.xlsx", "b.xlsx"], "x.xlsx", "folder"),
    "an unknown ending": (["a.xlsx"], "x.pdf", r"\.pdf"),
    "the submission itself": (["a.xlsx", "b.xlsx"][:1], "a.xlsx", "never overwrites"),
}


@pytest.mark.parametrize("what", WRONG)
@pytest.mark.parametrize("plan", [report_targets, mended_targets])
def test_outputs_that_cannot_be_meant(plan, what, tmp_path):
    """An output that would overwrite a submission, or that no form or folder fits, is refused with a reason."""
    submissions, output, words = WRONG[what]
    with pytest.raises(ValueError, match=words):
        plan([tmp_path / name for name in submissions], tmp_path / output)


def test_a_report_may_be_parquet_and_a_mended_file_not(tmp_path):
    """Results take forms that a mended submission cannot have."""
    assert report_targets([tmp_path / "a.xlsx"], tmp_path / "x.parquet") == [tmp_path / "x.parquet"]
    with pytest.raises(ValueError, match="parquet"):
        mended_targets([tmp_path / "a.xlsx"], tmp_path / "x.parquet")


def test_a_folder_is_made(tmp_path):
    """A folder that does not exist is made, also where it ends in a slash."""
    report_targets([Path("a.xlsx")], tmp_path / "new" / "deep")
    assert (tmp_path / "new" / "deep").is_dir()


@pytest.mark.parametrize("name", ["t.csv", "t", "t.xls"])
def test_a_template_is_a_workbook(tmp_path, name):
    """A template is not written under another ending than .xlsx, which Excel would refuse to open."""
    with pytest.raises(ValueError, match=r"must end in \.xlsx"):
        template_target(tmp_path / name, None, force=True)
    assert template_target(tmp_path / "t.XLSX", None, force=False) == tmp_path / "t.XLSX"


NAMES = {
    "a file": ("study.xlsx", ["study-recreated.xlsx", "study-recreated-report.xlsx"]),
    "a path": ("../../study.csv", [".._.._study-recreated.xlsx", ".._.._study-recreated-report.xlsx"]),
    "another system's path": ("C:\\x.csv", ["C__x-recreated.xlsx", "C__x-recreated-report.xlsx"]),
    "a device": ("a:b|c\0", ["a_b_c_-recreated.xlsx", "a_b_c_-recreated-report.xlsx"]),
}


@pytest.mark.parametrize("what", NAMES)
def test_a_name_that_a_report_carries_leads_nowhere_else(what, tmp_path):
    """What is made anew stands beside the report, whatever the submission is said to be called."""
    name, expected = NAMES[what]
    targets = recreated_targets(tmp_path / "r.xlsx", None, name, set())
    assert [target.parent for target in targets] == [tmp_path, tmp_path]
    assert _names(targets, tmp_path) == expected


def test_what_is_made_anew_replaces_no_given_report(tmp_path):
    """A report made anew from a report made anew gets a number; so do two of one name."""
    taken = {(tmp_path / "a-recreated-report.xlsx").resolve()}
    first = recreated_targets(tmp_path / "a-recreated-report.xlsx", None, "a.csv", taken)
    second = recreated_targets(tmp_path / "other.xlsx", tmp_path, "a.csv", taken)
    assert _names(first, tmp_path) == ["a-recreated.xlsx", "a-recreated-report (2).xlsx"]
    assert _names(second, tmp_path) == ["a-recreated (2).xlsx", "a-recreated-report (3).xlsx"]


def test_the_report_made_anew_goes_where_it_is_wanted(tmp_path):
    """A path given for the report is its path, and the submission stands beside it."""
    targets = recreated_targets(tmp_path / "r.xlsx", tmp_path / "new" / "x.csv", "a.csv", set())
    assert _names(targets, tmp_path) == ["new/a-recreated.xlsx", "new/x.csv"]
