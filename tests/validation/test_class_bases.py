"""Classes based on others: what they take over, what can be wrong with a base, and whom a faulty base takes along."""

from __future__ import annotations

import time

import pytest
from tolerance_sheets import GRADED, WALL, based, judged, row, sample, told

from flexlash.pipeline import check
from flexlash.validation.tolerance_rows import standard_class


def held(classes, name):
    """Return the dimensions of a class, each with class and upper deviation [mm] of its row."""
    return {one.dimension: (one.tolerance_class, round(one.upper * 1e3, 9)) for one in classes[name]}


def test_a_class_takes_over_what_it_does_not_have():
    """Its own row goes before that of its base, whose other rows keep their name and number."""
    rows = [row("shop"), based("shop", "full"), row("full", half=0.05), row("full", "mean_radius", half=0.1)]
    classes, ledger = judged(*rows)
    assert told(ledger) == []
    assert held(classes, "shop") == {"wall_thickness": ("shop", 0.02), "mean_radius": ("full", 0.1)}
    assert held(classes, "full") == {"wall_thickness": ("full", 0.05), "mean_radius": ("full", 0.1)}
    assert [one.row for one in classes["shop"]] == [2, 5]


def test_an_exact_row_of_its_own_is_held():
    """A row with both deviations 0 keeps the base's away."""
    classes, _ = judged(row("shop", half=0), based("shop", "full"), row("full"))
    assert held(classes, "shop") == {"wall_thickness": ("shop", 0)}


@pytest.mark.parametrize("order", [(0, 1, 2, 3, 4), (4, 3, 2, 1, 0), (2, 4, 0, 3, 1)])
def test_chains_are_followed_in_any_order_of_the_rows(order):
    """A class takes over what its base takes over, wherever the rows stand."""
    rows = [based("a", "b"), based("b", "c"), row("b", "mean_radius"), row("c"), row("c", "cylinder_length")]
    classes, ledger = judged(*(rows[place] for place in order))
    assert told(ledger) == []
    expected = {"mean_radius": ("b", 0.02), "wall_thickness": ("c", 0.02), "cylinder_length": ("c", 0.02)}
    assert held(classes, "a") == held(classes, "b") == expected


def test_several_classes_share_a_base():
    """Classes based on one get the same rows and nothing of one another."""
    classes, ledger = judged(based("a", "c"), based("b", "c"), row("b", "mean_radius"), row("c"))
    assert told(ledger) == []
    assert set(held(classes, "a")) == {"wall_thickness"}
    assert set(held(classes, "b")) == {"wall_thickness", "mean_radius"}
    assert set(held(classes, "c")) == {"wall_thickness"}


def test_standard_is_built_in_where_the_sheet_lacks_it():
    """A class may be based on standard though no row stands for it; the sheet's own goes before the built-in one."""
    classes, ledger = judged(row("shop"), based("shop", "standard"))
    assert told(ledger) == []
    built_in = [one for one in standard_class() if one.dimension != "wall_thickness"]
    assert classes["shop"][1:] == built_in
    assert "standard" not in classes
    classes, _ = judged(row("shop"), based("shop", "standard"), row("standard", "mean_radius"))
    assert held(classes, "shop") == {"wall_thickness": ("shop", 0.02), "mean_radius": ("standard", 0.02)}


def test_processes_and_samples_are_taken_over():
    """Sample, shift and lots are those of the base's row."""
    rows = [based("a", "b"), {**WALL, "tolerance_class": "b", "sample": "Wall", "scatters_between": "lots"}]
    ((found,), _) = (judged(*rows)[0]["a"], None)
    assert (found.sample, found.scatters_between, found.tolerance_class) == (sample(), "lots", "b")


def test_the_name_is_found_in_any_case():
    """Letter case and spaces do not matter; the spelling is repaired."""
    classes, ledger = judged(based("shop", "FULL "), row("Full"))
    assert held(classes, "shop") == {"wall_thickness": ("Full", 0.02)}
    assert {found.code for found in ledger.findings} == {"I504"}
    assert ledger.findings[-1].suggestion == "Full"


FAULTS = [
    ([based("shop", "fulll"), row("full")], [("E224", "based_on", 2)], {"shop"}),
    ([based("shop", "n/a"), row("full")], [("E221", "based_on", 2)], {"shop"}),
    ([based("shop", "full", dimension="mean_radius", grade="IT9"), row("full")], [("E338", "based_on", 2)], {"shop"}),
    ([based("shop", "full", grade="IT9"), row("full")], [("E338", "grade", 2)], {"shop"}),
    ([based("shop", "full", cp=1, sample="Wall"), row("full")], [("E338", "cp", 2), ("E338", "sample", 2)], {"shop"}),
    ([based("shop", "full", distribution="normal"), row("full")], [("E338", "distribution", 2)], {"shop"}),
    ([based("shop", "full"), based("shop", "full"), row("full")],
     [("E338", "based_on", 2), ("E338", "based_on", 3)], {"shop"}),
    ([based("shop", "full"), based("Shop", "fine"), row("full"), row("fine")],
     [("E338", "based_on", 2), ("E338", "based_on", 3)], {"shop"}),
    ([based("shop", "shop"), row("shop")], [("E338", "based_on", 2)], {"shop"}),
    ([based("standard", "standard")], [("E338", "based_on", 2)], {"standard"}),
    ([based("a", "b"), based("b", "c"), based("c", "a"), based("d", "a")],
     [("E338", "based_on", 2), ("E338", "based_on", 3), ("E338", "based_on", 4)], {"a", "b", "c", "d"}),
    ([based("shop", None), row("full")], [("E201", "dimension", 2)], {"shop"}),
    ([based("shop", 7), row("full")], [("E224", "based_on", 2)], {"shop"}),
    ([based("shop", True), row("full")], [("E204", "based_on", 2)], {"shop"}),
    ([based("shop", "full"), row("full", half=-0.02)], [("E318", "lower_deviation", 3)], {"shop", "full"}),
]  # fmt: skip


@pytest.mark.parametrize(("rows", "expected", "spoilt"), FAULTS)
def test_what_is_wrong_with_a_base_is_told_at_its_cell(rows, expected, spoilt):
    """Each fault is told where it stands and spoils its class and those that are based on it."""
    _, ledger = judged(*rows)
    assert told(ledger) == expected
    assert ledger.classes == spoilt


def test_an_unknown_base_is_told_with_what_was_probably_meant():
    """A slip of the keyboard gets the class that was meant, standard among them."""
    for name, meant in (("ful", "full"), ("standart", "standard")):
        (found,) = judged(based("shop", name), row("full"))[1].findings
        assert (found.suggestion, found.certain_value) == (meant, meant if name == "standart" else found.certain_value)


def test_the_members_of_a_circle_are_named():
    """Who leads back to itself is told by way of whom."""
    _, ledger = judged(based("a", "b"), based("b", "C"), based("c", "a"))
    words = [found.message for found in ledger.findings if found.code == "E338"]
    assert "class a is based on itself by way of b, c" in words[0]
    assert "class c is based on itself by way of a, b" in words[2]


def test_rows_wait_for_the_fault_of_the_base(table, sound):
    """A fault in a base says which rows wait for it, those of the classes based on it as well as its own."""
    tolerances = [based("shop", "full"), row("full", half=-0.02), row("fine")]
    variants = [{**sound, "variant": f"V{name}", "tolerance_class": name} for name in ("shop", "full", "fine")]
    outcome = check(table(variants), tolerances=table(tolerances, name="tolerances.csv"))
    assert outcome.counts["computed"] == 1
    (found,) = (one for one in outcome.findings if one.code == "E318")
    assert "Row 2 of Variants waits for class shop." in found.message
    assert "Row 3 of Variants waits for class full." in found.message


def test_a_class_that_only_another_is_based_on_is_used(table, sound):
    """A base whose name resembles a class in use is no slip; a class keeps its name whoever gives it its rows."""
    tolerances = [based("press fit", "pres fit"), row("pres fit"), row("press fti")]
    variants = [{**sound, "tolerance_class": "press fit"}]
    outcome = check(table(variants), tolerances=table(tolerances, name="tolerances.csv"))
    assert [(one.code, one.cell) for one in outcome.findings if one.code in {"W429", "E309", "I504"}] == [
        ("W429", "A4")
    ]


@pytest.mark.parametrize(("base", "left"), [("standard", None), ("full", "Cylinder length"), (None, "Young's modulus")])
def test_what_a_class_leaves_exact_counts_what_it_takes_over(table, sound, base, left):
    """A class based on standard leaves nothing exact; else what neither it nor its base has is named."""
    tolerances = [row("shop"), *([based("shop", base)] if base else []), row("full", "youngs_modulus", half=1)]
    variants = [{**sound, "tolerance_class": "shop"}]
    outcome = check(table(variants), tolerances=table(tolerances, name="tolerances.csv"))
    words = [one.message for one in outcome.findings if one.code == "W438"]
    assert len(words) == (left is not None)
    assert all(left in one and "Wall thickness" not in one for one in words)
    assert all(("Young" in one) is (base is None) for one in words)


def test_a_sheet_may_hold_bases_alone(table, sound):
    """Without the column Dimension a class can still be based on another; without either the column is missing."""
    variants = table([{**sound, "tolerance_class": "shop"}])
    outcome = check(variants, tolerances=table([based("shop", "standard")], name="tolerances.csv"))
    assert (outcome.findings, outcome.counts["computed"]) == ((), 1)
    lacking = table([{"tolerance_class": "shop", "grade": "IT9"}], name="lacking.csv")
    (found,) = check(variants, tolerances=lacking).findings
    assert (found.code, found.column) == ("E111", "dimension")


def test_sums_below_the_tolerances_are_no_rows(table, sound):
    """A total or a remark below Tolerances is no class without a dimension."""
    rows = [row("shop"), {"tolerance_class": "Total", "upper_deviation": 0.02}, {"tolerance_class": "Note: by hand"}]
    outcome = check(table([{**sound, "tolerance_class": "shop"}]), tolerances=table(rows, name="tolerances.csv"))
    assert [(one.code, one.cell) for one in outcome.findings if one.code != "W438"] == [("W433", "A3"), ("W433", "A4")]


@pytest.mark.slow
def test_a_long_chain_costs_linear_time():
    """Ten thousand classes, each based on the next, are resolved in seconds, faulty or not."""
    count = 10_000
    rows = [based(f"c{number}", f"c{number + 1}") for number in range(count)]
    start = time.process_time()
    classes, ledger = judged(*rows, row(f"c{count}"))
    assert len(classes["c0"]) == 1
    assert ledger.classes == set()
    _, ledger = judged(*rows, {**GRADED, "tolerance_class": f"c{count}", "grade": "IT99"})
    assert len(ledger.classes) == count + 1
    _, ledger = judged(*rows, based(f"c{count}", "c0"))
    assert len(ledger.findings) == count + 1
    assert time.process_time() - start < 30
