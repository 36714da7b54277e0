"""What changed on Other sources, Levers and Sweep is told in words, once for all variants that it concerns."""

from __future__ import annotations

import pytest
from decided_drives import CASE_3, CYLINDER, LEVERS, SOURCES, SWEEPS, drive

from flexlash.comparison.difference import difference
from flexlash.comparison.difference_lines import difference_lines
from flexlash.comparison.sides import side_of
from flexlash.feedback.template import entry_rules
from flexlash.feedback.template.template_workbook import template_bytes
from flexlash.reading.reading_limits import ReadingLimits

LIMITS = ReadingLimits()
BOTH = "used by all 2 variants"


@pytest.fixture(autouse=True)
def _few_rows(monkeypatch):
    """Few prepared rows, for speed."""
    monkeypatch.setattr(entry_rules, "PREPARED_ROWS", 8)
    monkeypatch.setattr(entry_rules, "SIDE_ROWS", 8)


@pytest.fixture
def between(tmp_path):
    """Return what is told of the drive and a filling that was made of it, but for the count and the verdict."""

    def lines(old, new):
        paths = [tmp_path / "old.xlsx", tmp_path / "new.xlsx"]
        for path, filling in zip(paths, (old, new), strict=True):
            path.write_bytes(template_bytes(filling))
        return list(difference_lines(difference(*(side_of(path, LIMITS) for path in paths))))

    return lines


def _changed(rows, number, **change):
    return [row | change if index == number else row for index, row in enumerate(rows)]


CHANGES = {
    "play": (
        {"other_sources": _changed(SOURCES, 0, value_arcmin=0.012)},
        f"Other sources tooth clearance, Value: 0.01 → 0.012 mm (+20 %), {BOTH}",
    ),
    "angle": (
        {"other_sources": _changed(SOURCES, 2, upper_deviation=15.0)},
        f"Other sources coupling, Upper deviation: 10 → 15 arcmin (+50 %), {BOTH}",
    ),
    "kind": (
        {"other_sources": _changed(SOURCES, 3, kind="systematic", value_arcmin=0.2)},
        f"Other sources runout, Kind: random → systematic, {BOTH}",
    ),
    "distribution": (
        {"other_sources": _changed(SOURCES, 1, distribution=None)},
        f"Other sources output bearing, Distribution: uniform → normal, {BOTH}",
    ),
    "fault": (
        {"other_sources": _changed(SOURCES, 0, value_arcmin="0,01")},
        f"Other sources tooth clearance, Value: 0.01 → 0,01 mm, {BOTH}",
    ),
    "removed source": (
        {"other_sources": SOURCES[:2] + SOURCES[3:]},
        "Other sources coupling, Row: Value 10 arcmin, Lower deviation -10 arcmin, Upper deviation 10 arcmin, "
        f"Limits at ± sigma 2, Side input, Ratio 100 → –, {BOTH}",
    ),
    "added source": (
        {"other_sources": [*SOURCES, {"source": "key", "value_arcmin": 0.5}]},
        f"Other sources key, Row: – → Value 0.5 arcmin, {BOTH}",
    ),
    "range": (
        {"levers": _changed(LEVERS, 0, lowest=150.0)},
        f"Levers Cylinder length, Lowest: 120 → 150 mm (+25 %), {BOTH}",
    ),
    "cost": (
        {"levers": _changed(LEVERS, 3, cost_per_step=100.0)},
        f"Levers material, Cost per step: 300 → 100 (−66.7 %), {BOTH}",
    ),
    "may not": (
        {"levers": _changed(LEVERS, 2, may_change="yes")},
        "Levers Mean radius, May change: no → yes, used by case 3",
    ),
    "study of one": (
        {"sweep": _changed(SWEEPS, 0, to=180.0)},
        "Sweep Cylinder length of case 3, To: 200 → 180 mm (−10 %), used by case 3",
    ),
    "study over two": (
        {"sweep": _changed(SWEEPS, 1, second_step=2.5)},
        "Sweep Wall thickness over Disk inner radius of case 3, Second step: 5 → 2.5 mm (−50 %), used by case 3",
    ),
    "study of all": (
        {"sweep": SWEEPS[:2]},
        f"Sweep Wall thickness of every variant, Row: From 1.5 mm, To 1.7 mm, Step 0.1 mm → –, {BOTH}",
    ),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("name", CHANGES)
def test_a_changed_row_is_told_with_the_variants_it_concerns(name, between):
    """A changed cell, a row more and one less each get their line, in the unit that the row gives."""
    changes, line = CHANGES[name]
    assert line in between(drive(), drive(**changes))


def test_blank_cells_and_another_order_are_no_change(between):
    """Defaults written out, and rows in another order, say the same."""
    sources = [
        row | {"kind": row.get("kind", "systematic"), "limits_sigma": row.get("limits_sigma", 3.0)} for row in SOURCES
    ]
    levers = [row | {"cost_per_grade": row.get("cost_per_grade", 1.0)} for row in LEVERS[:3]]
    new = drive(other_sources=sources[::-1], levers=[LEVERS[3], *levers], sweep=SWEEPS[::-1])
    assert between(drive(), new) == ["No difference in inputs."]


def test_another_unit_of_a_source_is_told_with_both(between):
    """Where a row is entered as something else, each number has its own unit."""
    new = _changed(
        SOURCES, 1, enter_as=None, radius_mm=None, value_arcmin=0.1, lower_deviation=-0.1, upper_deviation=0.1
    )
    lines = between(drive(), drive(other_sources=new))
    assert f"Other sources output bearing, Value: 0.0025 mm → 0.1 arcmin, {BOTH}" in lines
    assert f"Other sources output bearing, Enter as: mm radial play → arcmin, {BOTH}" in lines


def test_settings_and_system_limit_are_told(between):
    """The target, the mean shift factor and the system's limit are compared like every other entry."""
    new = drive(
        variants=[CASE_3 | {"system_limit_arcmin": 6.0}, CYLINDER],
        settings={"target_percent": 97.5, "mean_shift_factor": 0.2, "angle_unit": "arcsec"},
    )
    lines = between(drive(), new)
    assert f"Settings, target_percent: 99.865 → 97.5 %, {BOTH}" in lines
    assert f"Settings, mean_shift_factor: 0.3 → 0.2, {BOTH}" in lines
    assert f"Settings, angle_unit: arcmin → arcsec, {BOTH}" in lines
    assert "    System backlash limit: 5.5 → 6 arcmin (+9.09 %)" in lines


def test_the_density_of_a_material_is_told(between):
    """The density counts in what a change weighs, so that another one is a difference."""
    steel = {"material": "20Cr2Ni4", "youngs_modulus_GPa": 211.0, "poisson_ratio": 0.3, "density_kg_m3": 7850.0}
    other = steel | {"material": "40CrNiMoA"}
    old, new = (drive(materials=[steel | {"density_kg_m3": density}, other]) for density in (7850.0, 7700.0))
    assert "Material 20Cr2Ni4, Density: 7850 → 7700 kg/m³ (−1.91 %), used by case 3" in between(old, new)
