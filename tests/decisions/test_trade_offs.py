"""Backlash, mass and cost of variants beside each other are those of the variants, and so are the fronts."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from filled import SOUND, filled

import flexlash
from flexlash.decisions.spider import SPIDER_CHANGES, spider_of
from flexlash.decisions.trade_offs import quantile_of, trade_offs
from flexlash.report.report_data import drawn_variants
from flexlash.schema.decision_rows import LeverRow
from flexlash.schema.units import ARCMIN

STUDY = Path(__file__).parents[2] / "data" / "b3-160-study.xlsx"
DENSITY = 7850.0


@pytest.fixture
def outcome(tmp_path):
    """Return a function that computes cups like B3-160 with these changes, and gives the outcome."""

    def compute(*changes, **filling):
        path = tmp_path / f"cups-{len(list(tmp_path.iterdir()))}.xlsx"
        rows = [{**SOUND, "variant": f"v{place}", **change} for place, change in enumerate(changes)]
        path.write_bytes(filled(rows, **filling))
        return flexlash.run(path)

    return compute


def _offers(outcome, rows=None):
    """Return the trade-offs of an outcome by variant, the first one submitted as the base."""
    computed = list(outcome.computed.values())
    quantiles = [one.spread.numbers["p99_865"] for one in computed]
    return {
        one.variant.name: offer
        for one, offer in zip(computed, trade_offs(computed, quantiles, rows or {}), strict=True)
    }


def test_the_front_of_the_study():
    """Of the study case 2 and the cylinder are beaten by none in backlash and mass; case 3 weighs 1.452 kg."""
    offers = _offers(flexlash.run(STUDY))
    assert {name for name, offer in offers.items() if offer.light} == {"B3-160 case 2", "B3-160 cylinder"}
    assert offers["B3-160 case 3"].mass == pytest.approx(1.452, abs=5e-4)
    assert all(offer.cost is None and offer.cheap is None for offer in offers.values())


CHANGES = {
    "hub radius": ({"disk_inner_radius_mm": 46.0}, -1.4),
    "length": ({"cylinder_length_mm": 161.5}, -16.7),
    "wall and disk": ({"wall_thickness_mm": 1.82}, 13.75),
    "disk alone": ({"disk_thickness_mm": 2.35}, 6.1),
    "wall alone": ({"wall_thickness_mm": 1.98, "disk_thickness_mm": 1.6}, 20.7),
    "mean radius": ({"mean_radius_mm": 87.0}, 10.8),
}


def test_masses_change_as_the_worked_example_says(outcome):
    """The drawn changes of case 3 change its mass by the printed per cent, and by ρ times cylinder and annulus."""
    base = {"cylinder_length_mm": 200.0}
    offers = _offers(outcome(base, *({**base, **change} for change, _ in CHANGES.values())))
    before, *after = (offer.mass for offer in offers.values())
    assert before == pytest.approx(DENSITY * math.pi * (2 * 0.08 * 0.2 + 0.08**2 - 0.04**2) * 0.0016, rel=1e-9)
    for mass, (name, (_, percent)) in zip(after, CHANGES.items(), strict=True):
        assert 100 * (mass / before - 1) == pytest.approx(percent, abs=0.051), name


def test_costs_count_steps_of_the_levers(outcome):
    """Cost is steps times cost of the rows of Levers, whichever way: 12 steps of 0.5 mm and 5 of 0.01 mm at 3 each."""
    found = outcome({}, {"disk_inner_radius_mm": 46.0}, {"wall_thickness_mm": 1.55}, {"material": "17-4PH H1025"})
    rows = {"wall_thickness": LeverRow(row=2, dimension="wall_thickness", cost_per_step=3.0)}
    # The blank disk is the wall, which costs once.
    assert [offer.cost for offer in _offers(found, rows).values()] == [0.0, 12.0, 15.0, 1.0]


def test_a_bore_costs_by_itself(outcome):
    """Where both have a bore, a thicker wall on it costs no step of the radius; a bore against a radius costs that."""
    bore = {"mean_radius_mm": None, "bore_diameter_mm": 160.0}
    found = outcome(bore, {**bore, "wall_thickness_mm": 1.62}, {**bore, "bore_diameter_mm": 161.0}, {})
    offers = _offers(found, {"material": LeverRow(row=2, dimension="material")})
    assert [offer.cost for offer in offers.values()] == pytest.approx([0.0, 2.0, 2.0, 1.6], rel=1e-9)


def test_another_class_costs_its_grades(outcome):
    """A class ten times as fine costs five grades of each dimension; one of another type cannot be counted."""
    widths = {"coarse": 0.1, "fine": 0.01}
    keys = ("tolerance_class", "dimension", "lower_deviation", "upper_deviation")
    classes = [
        dict(zip(keys, (name, dimension, -half, half), strict=True))
        for name, half in widths.items()
        for dimension in ("wall_thickness", "cylinder_length")
    ]
    hat = {"flexspline_type": "hat", "disk_inner_radius_mm": None, "disk_outer_radius_mm": 120.0}
    changes = ({"tolerance_class": "coarse"}, {"tolerance_class": "fine"}, {"tolerance_class": "coarse", **hat})
    rows = {"wall_thickness": LeverRow(row=2, dimension="wall_thickness", cost_per_grade=2.0)}
    assert [offer.cost for offer in _offers(outcome(*changes, tolerances=classes), rows).values()] == [0.0, 15.0, None]


def test_only_variants_of_one_torque_are_compared(outcome):
    """A variant with a torque of its own is on no front and keeps none off it; one without a density has no mass."""
    material = {"material": "light", "youngs_modulus_GPa": 211.0, "poisson_ratio": 0.3}
    steel = {"material": "20Cr2Ni4", "youngs_modulus_GPa": 211.0, "poisson_ratio": 0.3, "density_kg_m3": DENSITY}
    changes = ({}, {"wall_thickness_mm": 1.8}, {"torque_Nm": 100.0, "wall_thickness_mm": 0.9}, {"material": "light"})
    offers = _offers(outcome(*changes, materials=[steel, material]))
    assert [offer.light for offer in offers.values()] == [True, True, None, None]
    assert offers["v3"].mass is None


@pytest.mark.parametrize("percent", [97.5, 99.0, 99.5, 99.9, 99.99, 99.9999])
def test_the_targets_percentile_has_the_targets_share_over_it(outcome, percent):
    """With the percentile as its limit a variant has the share over it that the target allows."""
    (drawn,) = drawn_variants(outcome({}))
    value = quantile_of(drawn.computed, drawn.curve, percent)
    over = outcome({"backlash_limit_arcmin": value / ARCMIN}).results["probability_over_limit"][0]
    assert over == pytest.approx(1 - percent / 100, rel=5e-3)


def test_spiders_are_the_backlash_of_parts_that_are_so(outcome):
    """Each point of each line is the nominal backlash of a submission with that dimension, over that of the variant."""
    base = outcome({})
    lines = {(line.dimension, line.alone): line for line in spider_of(base.computed[min(base.computed)])}
    assert set(lines) == {
        ("mean_radius", False), ("disk_inner_radius", False), ("wall_thickness", False), ("wall_thickness", True),
        ("disk_thickness", True), ("cylinder_length", False),
    }  # fmt: skip
    entered = {**SOUND, "disk_thickness_mm": SOUND["wall_thickness_mm"]}
    changes, expected = [], []
    for (name, alone), line in lines.items():
        for change, part in zip(SPIDER_CHANGES, line.backlash, strict=True):
            key = f"{name}_mm"
            beside = {"disk_thickness_mm": SOUND["wall_thickness_mm"]} if alone and name == "wall_thickness" else {}
            changes.append({**beside, key: entered[key] * (1 + change)})
            expected.append(part)
    nominal = base.results["backlash_arcmin"][0]
    found = [value / nominal - 1 for value in outcome(*changes).results["backlash_arcmin"].to_list()]
    assert found == pytest.approx(expected, abs=1e-12)
    assert all(line.backlash[len(SPIDER_CHANGES) // 2] == 0 for line in lines.values())


def test_spiders_know_exact_slopes():
    """Near the nominal, lines have the slopes that the formulas of B3-160 have: l 5/8 of case 3, shared wall −1."""
    study = flexlash.run(STUDY)
    case = next(one for one in study.computed.values() if one.variant.name == "B3-160 case 3")
    lines = {(line.dimension, line.alone): line for line in spider_of(case)}
    below, above = (SPIDER_CHANGES.index(part) for part in (-0.01, 0.01))

    def slope(*key):
        return (lines[key].backlash[above] - lines[key].backlash[below]) / 0.02

    assert slope("cylinder_length", False) == pytest.approx(5 / 8, abs=1e-12)
    assert slope("wall_thickness", False) == pytest.approx(-1, abs=2e-4)
    assert slope("wall_thickness", True) == pytest.approx(-5 / 8, abs=2e-4)
    assert slope("disk_thickness", True) == pytest.approx(-3 / 8, abs=2e-4)
    assert slope("disk_inner_radius", False) == pytest.approx(-1, abs=3e-4)
    assert lines["wall_thickness", False].tolerance == pytest.approx((-0.0025 / 1.6, 0.0025 / 1.6), abs=1e-12)
    assert lines["wall_thickness", False].swing == pytest.approx((1.6 / 1.5975 - 1, 1.6 / 1.6025 - 1), abs=1e-12)
    assert lines["wall_thickness", True].tolerance is None


def test_a_line_ends_where_no_part_can_be_made(outcome):
    """A rim as thick as the wall ends the line of a thicker wall: nothing is told beyond."""
    rim = {"rim_length_mm": 20.0, "rim_thickness_mm": 1.65}
    (computed,) = outcome(rim).computed.values()
    line = next(one for one in spider_of(computed) if one.dimension == "wall_thickness" and not one.alone)
    known = [change for change, part in zip(SPIDER_CHANGES, line.backlash, strict=True) if part is not None]
    assert known == [change for change in SPIDER_CHANGES if 1.6 * (1 + change) <= 1.65]
