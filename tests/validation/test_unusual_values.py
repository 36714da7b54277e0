"""Values that are possible but unusual: a warning each, and none where something else is said already."""

from __future__ import annotations

import pytest

from flexlash.pipeline import check
from flexlash.schema.columns import columns_of

FULL = {
    "disk_thickness_mm": 1.6,
    "disk_hub_thickness_mm": 3,
    "hub_fillet_radius_mm": 3.5,
    "junction_fillet_radius_mm": 3.5,
    "rim_length_mm": 20,
    "rim_thickness_mm": 3.2,
    "rated_torque_Nm": 800,
    "load_inertia_kg_m2": 1,
    "backlash_limit_arcmin": 5,
    "tolerance_class": "own",
}
STEEL = {
    "material": "20Cr2Ni4",
    "youngs_modulus_GPa": 211,
    "poisson_ratio": 0.3,
    "density_kg_m3": 7850,
    "yield_MPa": 1080,
}
TOLERANCE = {
    "tolerance_class": "own",
    "dimension": "wall_thickness",
    "lower_deviation": -0.02,
    "upper_deviation": 0.02,
    "limits_sigma": 3,
}
EXACT = TOLERANCE | {"tolerance_class": "standard", "dimension": "torque", "lower_deviation": 0, "upper_deviation": 0}
ABSURD = (1e-300, 1e-9, 1e9, 1e300)


@pytest.fixture
def judge(table, sound):
    """Return a function that checks a full cup with changes in its row, its material and its tolerance."""

    def judged(row=None, material=None, tolerance=None):
        tolerances = table([TOLERANCE | (tolerance or {}), EXACT], "tolerances.csv")
        materials = table([STEEL | (material or {})], "materials.csv")
        return check(table([sound | FULL | (row or {})]), tolerances=tolerances, materials=materials)

    return judged


def _codes(outcome):
    return {found.code for found in outcome.findings if found.level != "info"}


def test_a_full_row_is_usual(judge):
    """A cup in full detail, with its material and tolerance, has no finding."""
    assert judge().findings == ()


@pytest.mark.parametrize("value", ABSURD)
def test_no_absurd_number_passes_in_silence(judge, value):
    """Whatever column holds 1e-300, 1e-9, 1e9 or 1e300, somebody is told; an exponent of about 0 is an even disk."""
    silent = []
    for key, column in columns_of("Variants").items():
        row = {key: value}
        if key == "bore_diameter_mm":
            row["mean_radius_mm"] = ""
        if column.is_number and key != "disk_thickness_exponent" and not _codes(judge(row)):
            silent.append(key)
    for key, column in columns_of("Materials").items():
        if column.is_number and not _codes(judge(material={key: value})):
            silent.append(key)
    silent += [key for key in ("limits_sigma",) if not _codes(judge(tolerance={key: value}))]
    assert silent == []


@pytest.mark.parametrize(
    ("row", "words"),
    [
        ({"backlash_limit_arcmin": 601}, "Backlash limit = 601: 0.001 to 600 arcmin is plausible; used as entered."),
        ({"rated_torque_Nm": 1e9}, "Rated torque = 1000000000: 0.8 to 800000 N·m is plausible; used as entered."),
        ({"load_inertia_kg_m2": 1e-8}, "Load inertia J = 1e-08: 1e-07 to 1000000 kg·m² is plausible; used as entered."),
        ({"hub_fillet_radius_mm": 1e-4}, "Hub fillet radius = 0.0001: 0.016 to 160 mm is plausible; used as entered."),
    ],
)
def test_an_unusual_cell_of_a_row(judge, row, words):
    """An unusual cell is told with what is usual, and the row is computed."""
    outcome = judge(row)
    assert [found.message.partition(" ")[2] for found in outcome.findings if found.code == "W440"] == [words]
    assert outcome.counts["computed"] == 1


@pytest.mark.parametrize(
    ("material", "told"),
    [
        ({"poisson_ratio": 0.03}, True),
        ({"poisson_ratio": 0.47, "youngs_modulus_GPa": 2}, False),
        ({"density_kg_m3": 7.85}, True),
        ({"density_kg_m3": 22590}, False),
        ({"yield_MPa": 10_001}, True),
        ({"youngs_modulus_GPa": 2e6}, True),
    ],
)
def test_an_unusual_material(judge, material, told):
    """Real materials from rubber to osmium are usual; a ratio of 0.03 or a density in g/cm³ is told."""
    assert ("W440" in _codes(judge(material=material))) == told


@pytest.mark.parametrize(
    ("sigma", "codes"), [(1, set()), (12, set()), (0.9, {"W440"}), (13, {"W440"}), (0.49, {"E207"})]
)
def test_unusual_limits(judge, sigma, codes):
    """Limits at one to twelve standard deviations are usual, at less than a half they are an error."""
    assert _codes(judge(tolerance={"limits_sigma": sigma})) == codes


def test_a_slip_is_told_alone(judge):
    """In a row where a unit slipped no length is also told as unusual beside the others."""
    assert _codes(judge({"mean_radius_mm": 0.08, "hub_fillet_radius_mm": "", "junction_fillet_radius_mm": ""})) == {
        "E329"
    }


def test_an_error_is_told_alone(judge):
    """A cell that has an error is not also told as unusual."""
    found = [one for one in judge({"wall_thickness_mm": 450_000}).findings if one.column == "wall_thickness_mm"]
    assert [one.code for one in found] == ["E330"]
