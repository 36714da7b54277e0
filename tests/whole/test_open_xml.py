"""Every kind of workbook that flexlash writes is valid by Microsoft's Open XML SDK."""

from __future__ import annotations

import pytest
import regenerate
from made_up_parts import faulty_parts, measured_parts
from marking_samples import fault, own_workbook, rich_workbook
from old_templates import old_workbook
from open_xml import faults_of, needs_validator
from own_workbooks import READABLE, RICH

from flexlash.cli import cli
from flexlash.feedback.annotation import marked_copy
from flexlash.feedback.template.template_workbook import template_bytes

pytestmark = [needs_validator, pytest.mark.slow]

TABLE = """variant,flexspline_type,material,torque_Nm,cylinder_length_mm,mean_radius_mm,wall_thickness_mm,\
disk_inner_radius_mm,hub_fillet_radius_mm,backlash_limit_arcmin,notes
a cup,cup,20Cr2Ni4,800,160,80,1.6,40,2,3.75,=not a formula
a hat,hat,20Cr2Ni4,300,100,60,1.3,80,,3.5,
a cylinder,cylinder,20Cr2Ni4,300,100,60,1.3,,,,<&>
a wall too much,cup,20Cr2Ni4,300,100,60,450,,,,
no torque,cup,20Cr2Ni4,,100,60,1.3,30,,,
"""
COMMANDS = {
    "template.xlsx": "template -o template.xlsx",
    "example.xlsx": "template --example -o example.xlsx",
    "all-sheets.xlsx": "template --with all -o all-sheets.xlsx",
    "upgraded.xlsx": "template --upgrade old.xlsx --with measurements,correlations -o upgraded.xlsx",
    "upgraded-table.xlsx": "template --upgrade table.csv -o upgraded-table.xlsx",
    "example-report.xlsx": "run example.xlsx --samples 256 --method random",
    "table-report.xlsx": "run table.csv --elasticity --cross-check --samples 256",
    "one-report.xlsx": "run one.csv",
    "again.xlsx": "run --from-report table-report.xlsx -o again.xlsx",
    "needs-fixing-report.xlsx": "run needs-fixing.xlsx --samples 256 --method random",
    "needs-fixing-checked.xlsx": "check needs-fixing.xlsx --annotate",
    "needs-fixing-mended.xlsx": "check needs-fixing.xlsx --apply-fixes -o needs-fixing-mended.xlsx",
    "measured-parts-report.xlsx": "run measured-parts.xlsx",
    "measured-again.xlsx": "run --from-report measured-parts-report.xlsx -o measured-again.xlsx",
    "measured-faulty-checked.xlsx": "check measured-faulty.xlsx --annotate",
    "measured-faulty-mended.xlsx": "check measured-faulty.xlsx --apply-fixes -o measured-faulty-mended.xlsx",
    "table-checked.xlsx": "check table.csv --annotate",
    "damaged-checked.xlsx": "check damaged.xlsx --annotate",
    "reports/flexlash-summary.xlsx": "run table.csv one.csv damaged.xlsx none.csv --samples 64 -o reports",
}
"""Each kind of workbook and the command that writes it, in order."""

KINDS = [*COMMANDS, "table-recreated.xlsx"]
"""All of them: making a report anew also writes the submission that it carries."""

MARKABLE = {
    **{kind: make for kind, (make, _) in READABLE.items()},
    **RICH,
    "by openpyxl": own_workbook,
    "by XlsxWriter": rich_workbook,
}
"""Workbooks as engineers, programs and converters make them."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Return a folder in which every command was given."""
    path = tmp_path_factory.mktemp("kinds")
    (path / "table.csv").write_text(TABLE, encoding="utf-8")
    (path / "one.csv").write_text("".join(TABLE.splitlines(keepends=True)[:2]), encoding="utf-8")
    old_workbook([["A", "cup", "20Cr2Ni4", 800.0, 160.0, 80.0]]).save(path / "old.xlsx")
    faulty = (regenerate.ROOT / "data" / "needs-fixing.xlsx").read_bytes()
    (path / "needs-fixing.xlsx").write_bytes(faulty)
    (path / "measured-parts.xlsx").write_bytes(template_bytes(measured_parts()))
    (path / "measured-faulty.xlsx").write_bytes(template_bytes(faulty_parts()))
    (path / "damaged.xlsx").write_bytes(faulty[: len(faulty) // 2])
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(path)
        for command in COMMANDS.values():
            with pytest.raises(SystemExit):
                cli.main(command.split())
    return path


@pytest.mark.parametrize("name", KINDS)
def test_every_kind_of_file_is_valid(folder, name):
    """The Open XML SDK finds nothing wrong in a file of each kind."""
    assert faults_of(folder / name) == []


@pytest.mark.parametrize("name", MARKABLE)
def test_the_marked_copy_of_any_workbook_is_valid(tmp_path, name):
    """Whatever the engineer's file holds, its marked copy has no fault that the file itself does not have."""
    path = tmp_path / "marked.xlsx"
    path.write_bytes(marked_copy(MARKABLE[name](), [fault(), fault(cell="ZZ77", level="warning")], name).data)
    if faults := faults_of(path):
        path.write_bytes(MARKABLE[name]())
        described = [{one.partition(": ")[2] for one in found} for found in (faults, faults_of(path))]
        assert described[0] <= described[1]


def test_the_validator_finds_faults(tmp_path):
    """A workbook as openpyxl writes it, its fonts out of order, is not valid."""
    path = tmp_path / "openpyxl.xlsx"
    path.write_bytes(own_workbook())
    assert "font" in str(faults_of(path))
