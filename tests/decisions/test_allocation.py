"""Allocated tolerances keep every variant of a class, cost less than equal scaling, and say what limits them."""

from __future__ import annotations

import math
import random

import numpy as np
import polars as pl
import pytest

import flexlash
from flexlash.analysis.options import Options
from flexlash.decisions.allocation import allocation_of
from flexlash.schema.decision_rows import LeverRow

HEADER = "tolerance_class,dimension,lower_deviation,upper_deviation,deviation_unit,grade,distribution,scatters_between"
WIDTHS = {"wall_thickness": 0.03, "cylinder_length": 0.4, "disk_inner_radius": 0.4, "mean_radius": 0.2}
ELASTIC = ["shop,youngs_modulus,-1,1,%,,normal,lots", "shop,poisson_ratio,-0.005,0.005,,,uniform,lots"]


@pytest.fixture
def classes(tmp_path):
    """Return a function that writes rows of the class shop, given as text, and gives the path."""

    def write(lines):
        path = tmp_path / f"classes-{len(list(tmp_path.iterdir()))}.csv"
        path.write_text("\n".join([HEADER, *lines, *ELASTIC]), encoding="utf-8")
        return path

    return write


def _allocation(outcome, **levers):
    rows = {name: LeverRow(row=2, dimension=name, **rest) for name, rest in levers.items()}
    return allocation_of(outcome.computed, outcome.settings, rows, Options())


def _lines(deviations):
    return [f"shop,{name},{low!r},{high!r},{unit},,{kind}," for name, (low, high, unit, kind) in deviations.items()]


def _allocated(deviations, frame):
    """Return deviations with the allocated widths about the same middles."""
    changed = dict(deviations)
    for name, value in frame.select("dimension", "to_value").iter_rows():
        low, high, unit, kind = deviations[name]
        changed[name] = ((low + high) / 2 - value, (low + high) / 2 + value, unit, kind)
    return changed


def _scaled(deviations, factor):
    return {
        name: ((low + high) / 2 - factor * (high - low) / 2, (low + high) / 2 + factor * (high - low) / 2, unit, kind)
        for name, (low, high, unit, kind) in deviations.items()
    }


def _random_class(draw, sound):
    """Return rows of Variants without limits, and the deviations of their class."""
    size = draw.uniform(0.4, 1.2)
    rows = [
        sound
        | {
            "variant": f"V{number}",
            "torque_Nm": 800 * size**3,
            "cylinder_length_mm": round(160 * size * draw.uniform(0.6, 1.2), 2),
            "mean_radius_mm": round(80 * size, 2),
            "wall_thickness_mm": round(1.6 * size * draw.uniform(0.9, 1.2), 3),
            "disk_inner_radius_mm": round(40 * size * draw.uniform(0.9, 1.1), 2),
            "tolerance_class": "shop",
        }
        for number in range(draw.randint(2, 6))
    ]
    deviations = {}
    for name, width in WIDTHS.items():
        half, off = width * size * draw.uniform(0.4, 1.6), draw.choice([0.0, 0.2]) * width * size
        unit = "%" if name == "disk_inner_radius" and draw.random() < 0.5 else ""
        part = 100 / (40 * size) if unit else 1.0
        kind = draw.choice(["normal", "uniform", "triangular"])
        deviations[name] = (round((off - half) * part, 4), round((off + half) * part, 4), unit, kind)
    return rows, deviations


def _greatest_equal(outcomes, low=0.02, high=8.0):
    """Return the greatest factor that keeps all variants, by halving an interval of submissions."""
    for _ in range(10):
        middle = math.sqrt(low * high)
        keeps = outcomes(middle)["probability_over_limit"].max() <= 0.00135
        low, high = (middle, high) if keeps else (low, middle)
    return low


def random_classes(table, sound, classes, count, seed):
    """Yield for random classes the allocation, the run with it, the deviations and the greatest equal factor."""
    draw = random.Random(seed)  # noqa: S311
    for _ in range(count):
        rows, deviations = _random_class(draw, sound)
        bare = flexlash.run(table(rows), tolerances=classes(_lines(deviations))).results
        scale = draw.uniform(0.99, 1.04)
        limits = [
            median + (tail - median) * draw.uniform(0.8, 2.0) * scale
            for median, tail in bare.select("p50_arcmin", "p99_865_arcmin").iter_rows()
        ]
        limited = table([row | {"backlash_limit_arcmin": limit} for row, limit in zip(rows, limits, strict=True)])
        outcome = flexlash.run(limited, tolerances=classes(_lines(deviations)))
        frame = _allocation(outcome)

        def run(factor, limited=limited, deviations=deviations):
            return flexlash.run(limited, tolerances=classes(_lines(_scaled(deviations, factor)))).results

        again = None
        if frame["to_value"].null_count() == 0:
            again = flexlash.run(limited, tolerances=classes(_lines(_allocated(deviations, frame)))).results
        yield frame, again, run, deviations


@pytest.mark.slow
def test_an_allocation_holds_and_costs_less_than_equal_scaling(table, sound, classes):
    """Of random classes the allocated widths, run as a submission, keep every variant, and are cheaper than equal ones.

    Equal ones are not rounded to steps of the drawing, which makes them cheaper than any drawing could have them.
    """
    compared = 0
    for frame, again, run, deviations in random_classes(table, sound, classes, 12, 3):
        if again is None or set(frame["possible"]) != {"yes"}:
            continue
        assert again["probability_over_limit"].max() <= 0.00135 * (1 + 1e-9)
        equal = _greatest_equal(run)
        assert frame["relative_cost"].sum() < -5 * len(deviations) * math.log10(equal)
        compared += 1
    assert compared >= 6


ROWS = ({"variant": "long", "cylinder_length_mm": 160.0}, {"variant": "short", "cylinder_length_mm": 119.0})
DEVIATIONS = {"wall_thickness": (-0.02, 0.02, "", "normal"), "disk_inner_radius": (-0.2, 0.2, "", "normal")}


def _outcome(table, sound, classes, limits, lines=None):
    rows = [
        sound | one | {"backlash_limit_arcmin": limit, "tolerance_class": "shop"}
        for one, limit in zip(ROWS, limits, strict=True)
    ]
    return flexlash.run(table(rows), tolerances=classes(_lines(DEVIATIONS) if lines is None else lines))


@pytest.mark.slow
def test_no_pair_of_drawn_widths_is_cheaper(table, sound, classes):
    """Of two tolerances no pair of widths near the allocated one keeps both variants at less cost."""
    outcome = _outcome(table, sound, classes, (3.79, 3.27))
    frame = _allocation(outcome)
    wall, radius = frame["to_value"].to_list()
    assert frame["possible"].to_list() == ["yes", "yes"]

    def over(first, second):
        changed = {
            "wall_thickness": (-first, first, "", "normal"),
            "disk_inner_radius": (-second, second, "", "normal"),
        }
        return _outcome(table, sound, classes, (3.79, 3.27), _lines(changed)).results["probability_over_limit"].max()

    assert over(wall, radius) <= 0.00135
    for steps in (-6, -3, -1, 0, 1, 3, 6):
        other = wall + steps / 1000
        cheaper = wall * radius / other
        following = math.ceil(cheaper * 1000 * (1 + 1e-9) + 1) / 1000
        assert over(other, following) > 0.00135


def test_what_may_not_change_stays(table, sound, classes):
    """A tolerance that Levers fixes keeps its width and says so; a dearer one is left wider."""
    outcome = _outcome(table, sound, classes, (3.79, 3.27))
    free = dict(_allocation(outcome).select("dimension", "to_value").iter_rows())
    fixed = _allocation(outcome, wall_thickness={"tolerance_may_change": False})
    row = fixed.row(by_predicate=pl.col("dimension") == "wall_thickness", named=True)
    assert (row["to_value"], row["relative_cost"], row["limited_by"]) == (
        0.02,
        0.0,
        "Levers says that it may not change",
    )
    dear = _allocation(outcome, wall_thickness={"cost_per_grade": 10.0})
    wider = dict(dear.select("dimension", "to_value").iter_rows())
    assert wider["wall_thickness"] > free["wall_thickness"]
    assert wider["disk_inner_radius"] < free["disk_inner_radius"]


def test_a_variant_that_no_tolerance_keeps_is_told(table, sound, classes):
    """A variant whose nominal backlash is over its limit is named with what stays over; the other one is kept."""
    frame = _allocation(_outcome(table, sound, classes, (3.6, 3.3)))
    assert set(frame["possible"]) == {"no"}
    assert "units of long stay over the limit; the others are kept with these" in frame["reason"][0]
    assert frame["to_value"].null_count() == 0
    alone = _allocation(_outcome(table, sound, classes, (3.6, 2.7)))
    assert alone["to_value"].null_count() == alone.height
    assert "long" in alone["reason"][0]
    assert "short" in alone["reason"][0]


def test_grades_stay_grades_where_sizes_differ(table, sound, classes):
    """A grade of variants of different sizes goes in whole grades, which a submission of it keeps."""
    lines = ["shop,wall_thickness,,,,IT9,,", "shop,cylinder_length,,,,IT11,,"]
    rows = [
        sound
        | {"variant": f"V{size}", "mean_radius_mm": size, "wall_thickness_mm": size / 40, "tolerance_class": "shop"}
        | {"torque_Nm": 800 * (size / 80) ** 3, "disk_inner_radius_mm": size / 2, "cylinder_length_mm": 2 * size}
        for size in (50.0, 80.0, 150.0)
    ]
    bare = flexlash.run(table(rows), tolerances=classes(lines)).results
    limits = (bare["p50_arcmin"] + 1.3 * (bare["p99_865_arcmin"] - bare["p50_arcmin"])).to_list()
    rows = [row | {"backlash_limit_arcmin": limit} for row, limit in zip(rows, limits, strict=True)]
    frame = _allocation(flexlash.run(table(rows), tolerances=classes(lines)))
    wall, length = (
        frame.row(by_predicate=pl.col("dimension") == name, named=True)
        for name in ("wall_thickness", "cylinder_length")
    )
    assert (wall["unit"], wall["from_value"], length["unit"]) == ("IT grade", 9.0, "IT grade")
    changed = [
        f"shop,wall_thickness,,,,IT{wall['to_value']:.0f},,",
        f"shop,cylinder_length,,,,IT{length['to_value']:.0f},,",
    ]
    assert flexlash.run(table(rows), tolerances=classes(changed)).results["probability_over_limit"].max() <= 0.00135
    assert wall["grade_steps"] == wall["to_value"] - 9
    single = _allocation(flexlash.run(table(rows[1:2]), tolerances=classes(lines)))
    assert set(single["unit"]) == {"mm"}


def test_lots_are_never_allocated(table, sound, classes):
    """Moduli scatter as they are: no row of them, whatever scatters between lots."""
    frame = _allocation(_outcome(table, sound, classes, (3.8, 3.3)))
    assert frame["dimension"].to_list() == list(DEVIATIONS)
    assert np.isfinite(frame["relative_cost"].to_numpy()).all()


def test_a_general_tolerance_of_different_sizes_stays(table, sound, classes):
    """A general tolerance of different sizes has no width that could be entered: it stays, and the reason is told."""
    lines = [*_lines({"disk_inner_radius": (-0.1, 0.1, "", "normal")}), "shop,cylinder_length,,,,2768-m,,"]
    frame = _allocation(_outcome(table, sound, classes, (3.79, 3.27), lines))
    row = frame.row(by_predicate=pl.col("dimension") == "cylinder_length", named=True)
    assert (row["from_value"], row["to_value"], row["relative_cost"]) == (None, None, 0.0)
    assert "a general tolerance" in row["limited_by"]
    assert set(frame["possible"]) == {"yes"}
