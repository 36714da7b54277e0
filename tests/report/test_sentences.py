"""The Summary's sentences are right, also where there is no limit, no scatter, one variant or hardly any."""

from __future__ import annotations

import re
from dataclasses import replace

import polars as pl
import pytest
from said import said_of

from flexlash.pipeline import run
from flexlash.report.wording.lever_sentences import LEVER_TOPICS

EXACT = "tolerance_class,dimension,lower_deviation,upper_deviation\nstandard,rim_length,-1,1\n"


@pytest.fixture
def outcome(study):
    """Return the study's outcome."""
    return study[0]


@pytest.fixture
def told(table, sound):
    """Return a function that computes rows, each a change of a sound one, and gives their sentences by topic."""

    def tell(*changes, **options):
        rows = [{**sound, "variant": f"v{place}", **change} for place, change in enumerate(changes)]
        return said_of(run(table(rows), **options))

    return tell


def test_the_topics_are_questions_of_a_review_in_order(outcome):
    """Which fail, how sure, why, what to change: in this order, what leads to further sheets last."""
    assert list(said_of(outcome)) == [
        "What is compared", "Which fail", "Another limit", "How sure", "Worst case", "Lots and parts", "Why",
        "Limits used", *LEVER_TOPICS, "Cylinder-only formula", "Strength", "Model", "Findings",
    ]  # fmt: skip


def test_the_study_in_words(outcome):
    """Names, percentages and limits of the study's failing variants are those of its results."""
    told = said_of(outcome)
    rows = {row["variant"]: row for row in outcome.results.iter_rows(named=True)}
    worst = rows["B3-160 case 5"]
    assert told["Which fail"].startswith(
        f"3 of 11 variants with a limit fail: “B3-160 case 5” (99.865 % of its units stay below "
        f"{worst['p99_865_arcmin']:.3f}′, "
        f"{worst['p99_865_arcmin'] - 3.8:.3f}′ over its limit of 3.8′), “B3-160 case 3” ("
    )
    assert told["Which fail"].endswith(" 8 meet it.")
    # Its 95 % interval is narrower than the digits that words tell, so that none is told.
    assert re.search(r"“B3-160 case 4 r_m 80” 99\.452 %\.$", told["How sure"])
    assert told["Worst case"].startswith(
        "With every dimension at its worst limits the backlash of “B3-160 case 5” lies between "
    )
    shares = (100 * worst["main_contributor_share"], "Young's modulus")
    assert told["Why"].startswith(f"The spread of “B3-160 case 5” comes from {shares[1]} {shares[0]:.0f} % and ")
    assert told["Why"].endswith("Main contributor of all 11 variants: Young's modulus.")
    ratio = worst["cylinder_only_backlash_arcmin"] / worst["backlash_arcmin"]
    assert told["Cylinder-only formula"].startswith(
        f"The classical formula, without the disk, gives {worst['cylinder_only_backlash_arcmin']:.3f}′ for "
        f"“B3-160 case 5” instead of {worst['backlash_arcmin']:.3f}′: {100 * (1 - ratio):.0f} % too low."
    )


LIMITS = {
    "no limit": (
        ["", ""],
        "No limit was given, so nothing is judged. 97.5 % of the units of “v0” stay below 3.748′, "
        "the greatest backlash of all.",
    ),
    "no limit, one variant": (
        [""],
        "No limit was given, so nothing is judged. 97.5 % of the units of “v0” stay below 3.748′.",
    ),
    "all meet it": (
        [5, 4],
        "None: all 2 variants with a limit meet it. Nearest to its limit is “v1” (99.865 % of its units stay below "
        "3.780′, 0.220′ under its limit of 4′).",
    ),
    "one that meets it": (
        [5],
        "None: the 1 variant with a limit meets it. Nearest to its limit is “v0” (99.865 % of its units stay below "
        "3.780′, 1.220′ under its limit of 5′).",
    ),
    "fails, marginal, meets and none": (
        [3.7, 3.76, 5, ""],
        "1 of 3 variants with a limit fails: “v0” (99.865 % of its units stay below 3.780′, 0.080′ over its limit of "
        "3.7′). 1 of 3 variants with a limit is marginal: “v1” (99.865 % of its units stay below 3.780′, 0.020′ "
        "over its limit of 3.76′). 1 meets it. 1 has no limit.",
    ),
    "more than are named": (
        [3.5, 3.6, 3.7, 3.72],
        "4 of 4 variants with a limit fail: “v0” (99.865 % of its units stay below 3.780′, 0.280′ over its limit of "
        "3.5′), “v1” (3.780′, 0.180′ over 3.6′), “v2” (3.780′, 0.080′ over 3.7′) and 1 more.",
    ),
    "far over": (
        [0.5],
        "1 of 1 variant with a limit fails: “v0” (99.865 % of its units stay below 3.780′, 3.280′ over its limit of "
        "0.5′).",
    ),
}


@pytest.mark.parametrize("case", LIMITS)
def test_which_fail(told, case):
    """Verdicts are counted over the variants that have a limit; who fails is named with distance from its limit."""
    limits, words = LIMITS[case]
    assert told(*({"backlash_limit_arcmin": limit} for limit in limits))["Which fail"] == words


def test_nothing_to_change_without_a_limit(told):
    """Where nothing is judged, nothing is said of what to change."""
    said = told({"backlash_limit_arcmin": ""})
    assert not {*LEVER_TOPICS} & said.keys()
    assert "How sure" not in said
    assert said["Worst case"].startswith("With every dimension at its worst limits the backlash of “v0” lies between ")


@pytest.mark.parametrize(("limit", "share"), [(5, "none"), (3.6, "all"), ("", None)])
def test_without_scatter(told, tmp_path, limit, share):
    """Exact dimensions have no interval, no worst case and no contributor; the sentences say so."""
    tolerances = tmp_path / "tolerances.csv"
    tolerances.write_text(EXACT, encoding="utf-8")
    said = told({"backlash_limit_arcmin": limit}, tolerances=tolerances)
    assert (
        said["Why"] == "Nothing scatters in “v0”: no tolerance applies to its dimensions, so all units are identical."
    )
    assert said.get("How sure") == (f"Units over the limit: “v0” {share}." if share else None)
    assert "3.687′" in said["Which fail"]


def test_a_tube_has_no_disk_to_miss(told):
    """The classical formula is right for a tube, so nothing is said of it; beside a cup only the cup is named."""
    tube = {"flexspline_type": "cylinder", "disk_inner_radius_mm": ""}
    assert "Cylinder-only formula" not in told(tube)
    assert re.fullmatch(r"The classical formula.* for “v1” .*: 43 % too low\.", told(tube, {})["Cylinder-only formula"])


@pytest.mark.slow
@pytest.mark.parametrize(("factor", "words"), [(0.1, "too high"), (1.0, "too low")])
def test_the_classical_formula_may_be_too_high(workbook, sound, factor, words):
    """With a calibration of the disk and wall far below 1 the classical formula overstates, which is said."""
    settings = {f"{part}_calibration": factor for part in ("cylinder", "disk")}
    said = said_of(run(workbook([sound], settings=settings), samples=64))
    assert said["Cylinder-only formula"].endswith(f"% {words}.")


def test_what_was_not_computed(told):
    """Rows with errors are named, the first few, with the first fault in words; the others are still told."""
    faulty = [{"variant": f"bad {place}", "torque_Nm": ""} for place in range(5)]
    said = told({"backlash_limit_arcmin": 5}, *faulty)
    assert said["Computed"] == (
        "1 of 6 variants was computed. Not computed: “bad 0”, “bad 1”, “bad 2” and 2 more. "
        "First fault: Variants!D3 Torque T is empty: a torque in N·m above 0 is required."
    )
    assert said["Which fail"].startswith("None: the 1 variant")
    assert said["Findings"] == "5 errors: required cell empty (5)."


def test_nothing_computed(told):
    """Of a submission without a computed row only what is wrong is told."""
    assert list(told({"torque_Nm": ""})) == ["Computed", "Findings"]


@pytest.mark.parametrize("name", ["=1+1", "{x}", "W" * 80, "尺" * 40])
def test_odd_names_are_told_short_and_on_one_line(told, name):
    """A name of any letters stands in the sentences, cut to thirty of them, never across lines."""
    said = told({"variant": name, "backlash_limit_arcmin": 3.6})
    for text in said.values():
        assert text.replace("\n", "").isprintable()
        assert name[:31] not in text or len(name) <= 30
    assert (name if len(name) <= 30 else f"{name[:29]}…") in said["Which fail"]


def test_all_variants_are_counted_not_only_those_drawn(told, monkeypatch):
    """Counts and the classical formula's range are of all variants, however few the report draws."""
    monkeypatch.setattr("flexlash.report.report_data.DRAWN", 2)
    said = told(*({"backlash_limit_arcmin": 3.5} for _ in range(5)))
    assert said["Which fail"].startswith("5 of 5 variants with a limit fail: ")
    assert said["Why"].endswith("Main contributor of all 5 variants: Young's modulus.")
    assert "Over the 5 cups and hats" in said["Cylinder-only formula"]


def test_a_given_shear_modulus_without_tolerance_is_said(told, tmp_path):
    """A material that gives G has no scatter in class standard, which the Summary says."""
    materials = tmp_path / "materials.csv"
    materials.write_text("material,shear_modulus_GPa\n20Cr2Ni4,81\n", encoding="utf-8")
    said = told({}, materials=materials, samples=64)["Of the calculation"]
    assert said == "The shear modulus of 1 variant is given and has no tolerance: it does not scatter."


def test_what_yields_first(outcome):
    """The variant nearest to yield is named with its governing section and its reserve."""
    rows = list(outcome.results.iter_rows(named=True))
    torque = {one.variant.name: one.variant.dimensions["torque"] for one in outcome.computed.values()}
    least = min(row["elastic_limit_torque_Nm"] / torque[row["variant"]] for row in rows)
    said = said_of(outcome)["Strength"]
    name, others, section = re.match(r"Nearest to yield: “(.*)” and (\d+) others, whose (.*) yields at ", said).groups()
    assert int(others) + 1 == sum(
        row["elastic_limit_torque_Nm"] / torque[row["variant"]] < 1.0005 * least for row in rows
    )
    row = next(row for row in rows if row["variant"] == name)
    assert row["governing_section"] == section
    assert row["elastic_limit_torque_Nm"] / torque[name] == pytest.approx(least, rel=1e-6)
    assert f" yields at {least:.3g} times the torque, corners not counted." in said


def test_one_alone_is_nearest_to_yield(told):
    """Where no other variant has the same reserve nothing is said of others."""
    said = told({"torque_Nm": 700}, {"torque_Nm": 900})["Strength"]
    assert said.startswith("Nearest to yield: “v1”, whose disk yields at 11.1 times the torque")


def test_without_a_yield_strength_nothing_is_near_to_yield(told, tmp_path):
    """Of materials without a yield strength the Summary says nothing about yield."""
    materials = tmp_path / "materials.csv"
    materials.write_text("material,youngs_modulus_GPa,poisson_ratio\n20Cr2Ni4,211,0.3\n", encoding="utf-8")
    assert "Strength" not in told({}, materials=materials, method="random", samples=16)


def test_what_the_verdict_does_not_show(told):
    """Variants that yield are named under Strength, the first three of them."""
    said = told(*({"variant": f"T {place}", "torque_Nm": 12000 + place} for place in range(5)), samples=64)
    assert "Beyond yield: “T 0”, “T 1”, “T 2” and 2 more (W402)." in said["Strength"]
    assert "W411" not in said["Strength"]


@pytest.mark.slow
def test_how_far_the_formula_is_off(workbook, sound):
    """With the elasticity check the Summary gives the range of differences; without a checked row nothing."""
    pytest.importorskip("skfem", reason="scikit-fem is not installed here")
    odd = {**sound, "variant": "odd", "disk_outer_radius_mm": 100.0}
    outcome = run(workbook([sound, odd]), elasticity=True, method="random", samples=16)
    difference = outcome.results["elasticity_difference_percent"][0]
    assert f"is {difference:+.2f} % off (1 checked" in said_of(outcome)["Of the calculation"]
    outcome = run(workbook([odd]), elasticity=True, method="random", samples=16)
    assert "elasticity" not in said_of(outcome).get("Of the calculation", "")


def test_the_cross_check_is_told(told):
    """With a cross-check the Summary says how many variants agree."""
    said = told({}, cross_check=True)["Of the calculation"]
    assert said.startswith("Plain Monte Carlo agrees for 1 of 1 variants; ")


def test_digits_end_where_the_error_begins(table, sound):
    """Of few plain draws a percentile is told with the digits that its standard error leaves."""
    outcome = run(table([{**sound, "backlash_limit_arcmin": 3.6}]), method="random", samples=64)
    error = outcome.results["p99_865_standard_error_arcmin"][0]
    (told_tail,) = re.findall(r"stay below ([\d.]+)′", said_of(outcome)["Which fail"])
    assert len(told_tail.partition(".")[2]) == 2
    assert 1e-3 < error < 0.1
    outcome = replace(outcome, results=outcome.results.with_columns(pl.lit(0.3).alias("p99_865_standard_error_arcmin")))
    assert re.findall(r"stay below ([\d.]+)′", said_of(outcome)["Which fail"]) == [f"{float(told_tail):.1f}"]


FEW = {"method": "random", "samples": 64}


def test_few_points_leave_verdicts_open(told):
    """A share of which 64 points saw nothing settles no verdict: the Summary says so, and what would settle it."""
    limits = [{"backlash_limit_arcmin": limit} for limit in (5, 4, 3, "")]
    said = told(*limits, **FEW)
    assert said["Which fail"].endswith("2 meet it, none of them settled. 1 has no limit.")
    assert (
        "2 verdicts with ? are not settled: 64 points leave open whether more than 0.135 or 2.5 % of units are over "
        "the limit. Run with more samples or with the method line." in said["How sure"]
    )
    said = told(*limits)
    assert "settled" not in " ".join(said.values())


def test_some_open_verdicts_are_counted(told):
    """Of several marginal or failing variants those are counted that more points may change."""
    limits = [{"backlash_limit_arcmin": limit} for limit in (3.0, 3.745)]
    said = told(*limits, method="random", samples=256)
    assert said["Which fail"].startswith("2 of 2 variants with a limit fail, 1 of them not settled: “v0” (")
    assert "1 verdict with ? is not settled: 256 points leave open whether more than 2.5 % of" in said["How sure"]


def test_a_limit_at_the_percentile_is_open_by_lines_too(told, table, sound):
    """Where the limit is the P99.865 itself the lines' own error leaves the verdict open; more lines may help."""
    tail = run(table([sound], "first.csv"), samples=64).results["p99_865_arcmin"][0]
    said = told({"backlash_limit_arcmin": tail}, samples=64)["How sure"]
    assert "1 verdict with ? is not settled: 64 lines leave open whether more than 0.135 % of units are over" in said
    assert said.endswith("Run with more samples.")


SHARES = {
    "few points": (FEW | {"seed": 1}, r"Young's modulus about \d\d %.* about \d+ %"),
    "line": ({}, r"Young's modulus \d\d %, Poisson's ratio \d\d % and wall thickness \d+ %"),
    "many points": ({"method": "sobol", "samples": 4096}, r"Young's modulus \d\d %, Poisson's ratio \d\d % and .*"),
}


@pytest.mark.parametrize("case", SHARES)
def test_shares_of_few_points_are_about_right(told, case):
    """Shares that are estimated from few points are told as about right; a sum beyond 100 % is explained."""
    options, words = SHARES[case]
    said = told({}, **options)["Why"]
    found = re.match(rf"The spread of “v0” comes from ({words}) \((.*?)\)\.", said)
    total = sum(float(share) for share in re.findall(r"(\d+) %", found[1]))
    if total <= 100:
        assert found[2] == "shares of its variance"
    elif case == "few points":
        assert found[2].endswith("estimated from 64 points: their errors make the sum more than 100 %")
    else:
        assert found[2] == "shares of its variance, rounded"
    assert total > 100 or case != "few points"


def test_long_names_stay_apart(told):
    """Names that begin alike are told so that a reader can tell them apart."""
    names = [f"a name that is the same for thirty letters, wall {wall}" for wall in ("1.6 mm", "1.8 mm")]
    said = told(*({"variant": name, "backlash_limit_arcmin": 3.5} for name in names))["Which fail"]
    first, second = re.findall(r"“([^”]+)”", said)
    assert first != second
    assert first.endswith("wall 1.6 mm")
    assert second.endswith("wall 1.8 mm")


def test_long_names_that_were_not_computed_stay_apart(told):
    """Names of rows with errors are told apart, too."""
    names = [f"a name that is the same for thirty letters, wall {wall}" for wall in ("1.6 mm", "1.8 mm")]
    said = told({}, *({"variant": name, "torque_Nm": ""} for name in names))["Computed"]
    first, second = re.findall(r"“([^”]+)”", said)
    assert first != second


UNCERTAIN = "Which of the first two causes more is not certain"


ALIKE = """tolerance_class,dimension,lower_deviation,upper_deviation,deviation_unit
standard,youngs_modulus,-3,3,%
standard,poisson_ratio,-0.0386,0.0386,-
"""


def test_a_lead_within_the_error_is_told(told, tmp_path):
    """Where the main cause leads by less than the error of few points it is said so, and by lines it is not."""
    tolerances = tmp_path / "alike.csv"
    tolerances.write_text(ALIKE, encoding="utf-8")
    assert UNCERTAIN in told({}, method="random", samples=64, tolerances=tolerances)["Why"]
    assert UNCERTAIN not in told({}, tolerances=tolerances)["Why"]
