"""Correlations of a class: entered before measured, inherited, and never such as no parts can have."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import polars as pl
import pytest
from entry_books import CUP, UNIFORM_CUP, correlations, entry_book

from flexlash.analysis.assessment import assess
from flexlash.analysis.class_correlations import class_correlations
from flexlash.pipeline import check
from flexlash.schema.variant import MeasuredDimension, Settings, ToleranceRow
from flexlash.tolerance.sample_statistics import measured_correlation
from flexlash.validation.ledger import Ledger

WALL, DISK, RADIUS, YOUNG = "wall_thickness", "disk_thickness", "mean_radius", "youngs_modulus"
SCORES = np.random.default_rng(5).multivariate_normal(
    [0, 0, 0], [[1, 0.7, 0.3], [0.7, 1, 0.0], [0.3, 0.0, 1]], 60, method="cholesky"
)
PARTS = {
    name: MeasuredDimension(sample="Lot 7", dimension=name, values=tuple(values), parts=tuple(range(2, 62)))
    for name, values in zip((WALL, DISK, RADIUS), SCORES.T.tolist(), strict=True)
}


def _row(name, owner="shop", number=2, **given):
    """Return a row of Tolerances that scatters a dimension by its sample, where it has one."""
    kept = {"sample": PARTS.get(name)} | given
    return ToleranceRow(row=number, tolerance_class=owner, dimension=name, lower=-1e-5, upper=1e-5, **kept)


@pytest.fixture
def settled(tmp_path):
    """Return a function that gives correlations by class and findings for classes and rows of Correlations."""

    def of(classes, *rows, bases=()):
        width = {"lower_deviation": -1e-3, "upper_deviation": 1e-3}
        tolerances = [
            {"tolerance_class": owner, "dimension": row.dimension, **width}
            for owner in classes
            for row in classes[owner]
        ]
        sheets = {"tolerances": tolerances, "correlations": correlations(*rows) if rows else [{"reason": None}]}
        validated = check(entry_book(tmp_path / "study.xlsx", variants=[CUP], **sheets)).validated
        if bases:
            based = pl.DataFrame(bases, schema={"tolerance_class": pl.String, "based_on": pl.String}, orient="row")
            frame = based.with_row_index("row", 90).with_columns(pl.col("row").cast(pl.Int64))
            validated = replace(validated, tolerances=replace(validated.tolerances, frame=frame))
        ledger = Ledger("study.xlsx")
        found = class_correlations(replace(validated, classes=classes), ledger)
        return found, ledger

    return of


def _told(ledger):
    return [(found.code, found.place) for found in ledger.findings]


def test_parts_measured_together_give_their_correlations(settled):
    """Dimensions of one sample are tied as their parts were measured; that is told once, at the sample's first row."""
    rows = [_row(YOUNG), _row(DISK), _row(WALL), _row(RADIUS)]
    found, ledger = settled({"shop": rows})
    pairs = [(RADIUS, WALL), (RADIUS, DISK), (WALL, DISK)]
    assert list(found) == ["shop"]
    assert list(found["shop"]) == pairs
    for first, second in pairs:
        exact = float(np.corrcoef(PARTS[first].values, PARTS[second].values)[0, 1])
        assert found["shop"][first, second] == pytest.approx(exact, rel=1e-12)
    (told,) = ledger.findings
    assert told.code == "I531"
    assert told.place == "Tolerances!A2"
    measured = measured_correlation(PARTS[WALL], PARTS[DISK], by_scores=False)
    words = f"wall thickness with disk thickness {measured.correlation:.2f} (95 %: {measured.low:.2f} to"
    assert words in told.message
    assert "class shop the parts of sample Lot 7" in told.message


def test_parts_of_different_samples_are_independent(settled):
    """Dimensions that were measured on other parts have no correlation of their own."""
    other = replace(PARTS[DISK], sample="lot 8")
    assert settled({"shop": [_row(WALL), _row(DISK, sample=other)]})[0] == {}
    assert settled({"shop": [_row(WALL), _row(DISK, sample=None)]})[0] == {}
    apart = replace(PARTS[DISK], parts=tuple(range(62, 122)))
    assert settled({"shop": [_row(WALL), _row(DISK, sample=apart)]})[0] == {}


def test_a_measured_shape_takes_the_correlation_of_scores(settled):
    """Where either dimension follows the shape of its sample the ranks' normal scores are correlated."""
    rows = [_row(WALL, distribution="measured"), _row(DISK)]
    found, _ = settled({"shop": rows})
    expected = measured_correlation(PARTS[WALL], PARTS[DISK], by_scores=True).correlation
    assert found == {"shop": {(WALL, DISK): expected}}
    assert expected != measured_correlation(PARTS[WALL], PARTS[DISK], by_scores=False).correlation


def test_an_entered_correlation_goes_before_the_measured_one(settled):
    """The entered value is used; outside the interval of the measured one that is a warning, inside it is not."""
    measured = measured_correlation(PARTS[WALL], PARTS[DISK], by_scores=False)
    rows = [_row(WALL), _row(DISK)]
    inside, outside = measured.low + 0.01, measured.low - 0.01
    found, ledger = settled({"shop": rows}, (DISK, WALL, inside))
    assert (found, _told(ledger)) == ({"shop": {(WALL, DISK): inside}}, [])
    found, ledger = settled({"shop": rows}, (DISK, WALL, outside))
    assert (found, _told(ledger)) == ({"shop": {(WALL, DISK): outside}}, [("W448", "Correlations!D2")])
    assert f"{measured.low:.2f} to {measured.high:.2f}, 60 parts" in ledger.findings[0].message


def test_an_entered_zero_unties_what_was_measured(settled):
    """0 is a value: the pair is independent, which the measured parts speak against."""
    found, ledger = settled({"shop": [_row(WALL), _row(DISK)]}, (WALL, DISK, 0))
    assert found == {}
    assert _told(ledger) == [("W448", "Correlations!D2")]


def test_a_class_takes_over_the_pairs_of_the_class_it_is_based_on(settled):
    """What a class does not enter itself is that of its base, and of the base's own, where both dimensions scatter."""
    plain = {"sample": None}
    full = [_row(name, "full", **plain) for name in (WALL, DISK, RADIUS)]
    shop = [_row(WALL, "shop", **plain), *full[1:]]
    narrow = [_row(WALL, "narrow", **plain), full[1]]
    rows = [(WALL, DISK, 0.5, "full"), (WALL, RADIUS, 0.2, "full"), (WALL, DISK, 0.3, "shop")]
    bases = [("shop", "Full"), ("narrow", "shop"), ("full", "narrow"), (None, "full")]
    found, ledger = settled({"full": full, "shop": shop, "narrow": narrow, "alone": full}, *rows, bases=bases)
    assert ledger.findings == []
    assert found == {
        "full": {(RADIUS, WALL): 0.2, (WALL, DISK): 0.5},
        "shop": {(RADIUS, WALL): 0.2, (WALL, DISK): 0.3},
        "narrow": {(WALL, DISK): 0.3},
    }


def test_a_class_that_takes_over_measured_rows_repeats_nothing(settled):
    """What was measured of a base is told of the base alone, and used by both."""
    base = [_row(WALL), _row(DISK)]
    found, ledger = settled({"shop": base, "other": base})
    assert found["shop"] == found["other"] != {}
    assert [one.code for one in ledger.findings] == ["I531"]


def test_a_class_that_takes_over_a_fault_waits_for_it_without_another_word(settled):
    """A contradiction of a base is told once, at the base; both classes wait for it."""
    base = [_row(name, sample=None) for name in (WALL, DISK, RADIUS)]
    rows = (WALL, DISK, 0.9), (WALL, RADIUS, 0.9), (DISK, RADIUS, 0.5)
    found, ledger = settled({"shop": base, "other": base}, *rows, bases=[("other", "shop")])
    assert found == {}
    assert _told(ledger) == [("E348", "Correlations!D2")]
    assert ledger.classes == {"shop", "other"}


def test_what_a_class_changes_of_its_base_is_told_of_it(settled):
    """A row of its own makes a class another process: what was measured is told of it, at its own row."""
    base = [_row(WALL), _row(DISK), _row(RADIUS)]
    own = [_row(WALL, "own", 9), *base[1:]]
    _, ledger = settled({"shop": base, "own": own}, (WALL, DISK, -0.9), bases=[("own", "shop")])
    assert _told(ledger) == [
        ("I531", "Tolerances!A2"),
        ("W448", "Correlations!D2"),
        ("I531", "Tolerances!A9"),
        ("W448", "Correlations!D2"),
    ]
    assert "mean radius with disk thickness" in ledger.findings[0].message
    assert "mean radius with disk thickness" not in ledger.findings[2].message


def test_contradicting_correlations_name_the_nearest_that_can_be(settled):
    """Of three that no parts can have the one that must change least is an error with its nearest admissible value."""
    rows = (WALL, DISK, 0.9), (WALL, RADIUS, 0.9), (DISK, RADIUS, 0.5)
    plain = [_row(name, sample=None) for name in (WALL, DISK, RADIUS)]
    found, ledger = settled({"shop": plain, "fine": plain}, *rows)
    assert found == {}
    assert _told(ledger) == [("E348", "Correlations!D2")]
    assert ledger.classes == {"shop"}
    nearest = float(ledger.findings[0].suggestion)
    assert nearest == 0.8274 < 0.9 * 0.5 + ((1 - 0.9**2) * (1 - 0.5**2)) ** 0.5 < 0.8275
    found, ledger = settled({"shop": plain}, (WALL, DISK, nearest), *rows[1:])
    assert _told(ledger) == []
    assert len(found["shop"]) == 3


def test_contradictions_that_no_single_value_fixes_name_all(settled):
    """Where two pairs must change each is told with its own value, and with these values nothing is wrong."""
    names = (WALL, DISK, RADIUS, "disk_inner_radius")
    plain = [_row(name, sample=None) for name in names]
    rows = [(WALL, name, 0.95) for name in names[1:]] + [
        (first, second, -0.9) for first, second in ((DISK, RADIUS), (DISK, names[3]), (RADIUS, names[3]))
    ]
    _, ledger = settled({"shop": plain}, *rows)
    assert len(ledger.findings) > 1
    assert {found.code for found in ledger.findings} == {"E348"}
    nearest = {int(found.cell[1:]) - 2: float(found.suggestion) for found in ledger.findings}
    fixed = [(*pair, nearest.get(index, value)) for index, (*pair, value) in enumerate(rows)]
    assert _told(settled({"shop": plain}, *fixed)[1]) == []


def test_what_no_part_has_at_once_contradicts_nothing(settled):
    """Mean radius and bore are never in one part, so that the wall may follow the one and flee the other."""
    plain = [_row(name, sample=None) for name in (WALL, RADIUS, "bore_diameter")]
    rows = (WALL, RADIUS, 0.9), (WALL, "bore_diameter", -0.9)
    found, ledger = settled({"shop": plain}, *rows)
    assert ledger.findings == []
    assert found == {"shop": {(RADIUS, WALL): 0.9, ("bore_diameter", WALL): -0.9}}


def test_an_entered_correlation_that_contradicts_measured_ones_is_the_one_to_blame(settled):
    """Measured correlations are kept; the entered one beside them gets the nearest admissible value."""
    follow = replace(PARTS[DISK], values=PARTS[WALL].values)
    rows = [_row(WALL), _row(DISK, sample=follow), _row(RADIUS, sample=None)]
    _, ledger = settled({"shop": rows}, (WALL, RADIUS, 0.5))
    assert _told(ledger) == [("I531", "Tolerances!A2"), ("E348", "Correlations!D2")]
    assert float(ledger.findings[1].suggestion) == 0.0


def test_a_lot_dimension_is_not_tied_to_one_of_a_part(settled):
    """Entered it is an error; measured it is left out with a warning."""
    lots = {"scatters_between": "lots"}
    _, ledger = settled({"shop": [_row(WALL, sample=None), _row(YOUNG, **lots)]}, (YOUNG, WALL, 0.5))
    assert _told(ledger) == [("E349", "Correlations!C2")]
    assert "Young's modulus scatters between lots and wall thickness between parts." in ledger.findings[0].message
    assert ledger.classes == {"shop"}
    found, ledger = settled({"shop": [_row(WALL, **lots), _row(DISK)]})
    assert (found, _told(ledger)) == ({}, [("W449", "Tolerances!A2")])
    both = [_row(WALL, sample=None, **lots), _row(YOUNG, **lots)]
    assert settled({"shop": both}, (YOUNG, WALL, 0.5))[0] == {"shop": {(WALL, YOUNG): 0.5}}


def test_measured_correlations_of_different_parts_are_brought_together(settled):
    """Three pairs measured on other parts each may contradict: the nearest that do not are used, which is told."""
    low, middle, high = (tuple(range(start, start + 20)) for start in (2, 22, 42))
    up = np.linspace(-1, 1, 20) + 0.05 * np.sin(np.arange(20.0))
    line = np.linspace(-1, 1, 20)

    def sampled(name, values, parts):
        return MeasuredDimension(sample="Lot 7", dimension=name, values=tuple(values), parts=parts)

    rows = [
        _row(WALL, sample=sampled(WALL, [*line, *line], low + middle)),
        _row(DISK, sample=sampled(DISK, [*up, *line], low + high)),
        _row(RADIUS, sample=sampled(RADIUS, [*up, *-up], middle + high)),
    ]
    found, ledger = settled({"shop": rows})
    assert [one.code for one in ledger.findings] == ["I531", "W449"]
    matrix = np.eye(3)
    names = [RADIUS, WALL, DISK]
    for (first, second), value in found["shop"].items():
        matrix[names.index(first), names.index(second)] = matrix[names.index(second), names.index(first)] = value
    assert np.linalg.eigvalsh(matrix)[0] >= -1e-9
    assert found["shop"][WALL, DISK] == pytest.approx(0.5, abs=0.02)


def test_rows_of_a_contradicting_class_wait(tmp_path):
    """The variants of the class are not computed, those of others are; the error says which wait."""
    fine = [row | {"tolerance_class": "fine"} for row in UNIFORM_CUP]
    rows = correlations((WALL, DISK, 0.9), (WALL, RADIUS, 0.9), (DISK, RADIUS, 0.5))
    variants = [CUP, CUP | {"variant": "fine", "tolerance_class": "fine"}]
    sheets = {"variants": variants, "tolerances": [*UNIFORM_CUP, *fine], "correlations": rows}
    outcome = check(entry_book(tmp_path / "study.xlsx", **sheets))
    assert outcome.results["status"].to_list() == ["error", "ok"]
    error = next(found for found in outcome.findings if found.level == "error")
    assert error.message.endswith("the nearest admissible value is 0.8274. Row 2 of Variants waits for class shop.")


def test_a_variant_has_the_pairs_that_both_scatter_in_it(tmp_path):
    """`Computed.correlation` holds pairs whose dimensions the variant has; a blank disk thickness does without."""
    variants = [CUP, CUP | {"variant": "one thickness", "disk_thickness_mm": None}]
    rows = correlations((DISK, WALL, 0.5), (WALL, RADIUS, 0.2))
    sheets = {"variants": variants, "tolerances": UNIFORM_CUP, "correlations": rows}
    validated = check(entry_book(tmp_path / "study.xlsx", **sheets)).validated
    computed = assess(validated, Settings()).computed
    assert [one.correlation for one in computed.values()] == [
        ((RADIUS, WALL, 0.2), (WALL, DISK, 0.5)),
        ((RADIUS, WALL, 0.2),),
    ]
