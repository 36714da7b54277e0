"""What samples tell beside the limits of the classes that use them."""

from __future__ import annotations

import pytest
from measured_parts import HEADERS, measured_rows, scattered

from flexlash.analysis.sample_uses import measured_pairs, sample_uses
from flexlash.pipeline import check
from flexlash.schema.columns import columns_of

_LIMITS = [
    "Tolerance class", "Dimension", "Lower deviation", "Upper deviation", "Deviation unit", "Distribution", "Sample",
    "Based on class",
]  # fmt: skip


@pytest.fixture
def worked_up(book, sound):
    """Return a function that gives uses and pairs of a submission with these classes and measurements."""

    def read(limits, rows, *variants, headers=HEADERS):
        label = {key: column.label for key, column in columns_of("Variants").items()}
        own = [sound | {"variant": f"V{place}"} | variant for place, variant in enumerate(variants)]
        sheet = [[label[key] for key in own[0]], *(list(row.values()) for row in own)]
        outcome = check(book({"Variants": sheet, "Tolerances": [_LIMITS, *limits], "Measurements": [headers, *rows]}))
        assert [one for one in outcome.findings if one.level == "error"] == []
        computed = list(outcome.computed.values())
        return sample_uses(outcome.validated.measured, computed), measured_pairs(outcome.validated.measured, computed)

    return read


_WALL = ["shop", "wall_thickness", -0.02, 0.02, "mm", None, "wall", None]


def test_the_issues_wall(worked_up):
    """Sixty walls: mean, s and Cpk 1.06 from 0.85 to 1.27, told once for two variants of the same limits."""
    uses, pairs = worked_up([_WALL], measured_rows(), {"tolerance_class": "shop"}, {"tolerance_class": "shop"})
    wall, disk = uses
    assert (wall.sample, wall.column.key, wall.count, wall.variants) == ("wall", "wall_thickness_mm", 60, 2)
    assert (wall.low, wall.high, wall.distribution, wall.used_by) == (1.58, 1.62, "normal", "class shop")
    assert wall.statistics.mean == pytest.approx(1.607, rel=1e-12)
    assert wall.statistics.sd == pytest.approx(0.0041, rel=1e-9)
    told = wall.capability
    assert [f"{one:.2f}" for one in (told.cpk, told.cpk_low, told.cpk_high)] == ["1.06", "0.85", "1.27"]
    assert (disk.capability, disk.used_by, disk.variants, disk.low) == (None, "", 0, None)
    (pair,) = pairs
    assert (pair.first.key, pair.second.key, pair.by_scores) == ("wall_thickness_mm", "disk_thickness_mm", False)
    assert pair.correlation.count == 60


def test_limits_of_each_class(worked_up):
    """Two classes and two entered values are three pairs of limits; an inherited row names its class."""
    limits = [_WALL, ["heir", None, None, None, None, None, None, "shop"]]
    limits += [["wide", "wall_thickness", -0.05, 0.05, "mm", "measured", "wall", None]]
    uses, pairs = worked_up(
        limits,
        measured_rows(),
        {"tolerance_class": "shop"},
        {"tolerance_class": "heir", "wall_thickness_mm": 1.61},
        {"tolerance_class": "wide"},
    )
    walls = [(one.used_by, one.low, one.high, one.distribution) for one in uses if one.used_by]
    assert walls == [
        ("class shop", 1.58, 1.62, "normal"),
        ("class heir, taken over from shop", 1.59, 1.63, "normal"),
        ("class wide", 1.55, 1.65, "measured"),
    ]
    assert pairs[0].by_scores


def test_deviations_are_compared_with_deviations(worked_up):
    """What was measured above the entered value has the same Cpk for parts of two sizes."""
    rows = [["wall", number, "deviation", value - 1.6, None] for number, value in enumerate(scattered(60))]
    uses, pairs = worked_up(
        [_WALL], rows, {"tolerance_class": "shop"}, {"tolerance_class": "shop", "wall_thickness_mm": 2.0}
    )
    (wall,) = uses
    assert (wall.low, wall.high, wall.variants, wall.are_deviations) == (-0.02, 0.02, 2, True)
    assert wall.capability.cpk == pytest.approx(0.013 / 0.0123, rel=1e-9)
    assert pairs == []


def test_a_single_value_has_no_statistics(worked_up):
    """A sample of one part that nobody uses stands in the table with its value alone."""
    uses, _ = worked_up([_WALL], [*measured_rows(), *measured_rows(1, "first")], {"tolerance_class": "shop"})
    assert [(one.sample, one.count, one.statistics is None) for one in uses if one.sample == "first"] == [
        ("first", 1, True),
        ("first", 1, True),
    ]


def test_samples_in_use_come_first(worked_up):
    """However many samples there are, those that classes use are worked up."""
    spare = [[f"sample {number}", 1, None, 1.6, None] for number in range(700)]
    uses, _ = worked_up([_WALL], [*spare, *measured_rows()], {"tolerance_class": "shop"})
    assert len(uses) == 500
    assert uses[0].used_by == "class shop"
