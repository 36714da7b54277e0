"""The mechanics with live operands: the same number as with floats, from a formula that says what was worked out."""

from __future__ import annotations

import math

import pytest

from flexlash.mechanics import fillets, flexspline, stiffness, strength, tapered_disk, windup
from flexlash.report.formula.closed_forms import worked
from flexlash.report.formula.live import Live

FORMS = {
    windup.shear_modulus: (211e9, 0.3),
    windup.mean_radius_from_bore: (0.16, 0.0016),
    windup.rim_radius: (0.08, 0.0016, 0.0032),
    windup.torque_over_modulus: (800.0, 8.1e10),
    windup.segment_windup: (800.0, 8.1e10, 1.2e5),
    windup.wall_integral: (0.16, 0.08, 0.0016),
    windup.rim_integral: (0.02, 0.0808, 0.0016, 0.0032),
    windup.annulus_integral: (0.04, 0.08, 0.0016),
    windup.cone_integral: (1.5e5, 0.6),
    windup.power_law_growth: (0.04, 0.08, 3.7),
    windup.growth_integral: (0.7, 0.04, 0.003),
    windup.power_law_disk_integral: (0.04, 0.08, 0.004, 1.3),
    tapered_disk.axis_thickness: (0.02, 0.1, 12.5),
    tapered_disk.relative_slope: (0.04, 0.004, 0.0064),
    tapered_disk.closed_integral: (12.5, 25.0, 0.02, 0.1, 0.0064, -9.375),
    tapered_disk.summand: (0.1, 17.0, 0.05),
    fillets.added_thickness: (0.0035, 0.4),
    fillets.arc_radius: (0.04, 0.0035, 0.4, 0.6),
    flexspline.thickness_slope: (0.04, 0.08, 0.004, 0.0016),
    flexspline.tapered_thickness: (0.06, 0.04, 0.004, -0.06),
    flexspline.power_law_thickness: (0.06, 0.04, 0.004, 1.7),
    strength.shear_stress: (800.0, 0.08, 0.0016),
    strength.von_mises_stress: (12e6,),
    strength.limit_torque: (800.0, 12e6, 1080e6),
    strength.curvature_parameter: (0.3, 0.08, 0.0016, 0.16),
    strength.slenderness: (0.08, 0.0016, 0.16),
    strength.buckling_range: (0.3, 0.08, 0.0016, 0.08),
    strength.buckling_shear: (211e9, 0.08, 0.0016, 0.16),
    strength.plate_buckling_shear: (211e9, 0.3, 0.0016, 0.03),
    strength.tube_buckling_shear: (211e9, 0.3, 0.08, 0.0016),
    strength.wall_buckling_shear: (211e9, 0.3, 0.08, 0.0016, 0.08),
    stiffness.torsional_stiffness: (800.0, 5e-4),
    stiffness.lost_motion: (1.6e6, 32.0),
}
"""Closed forms of the mechanics, each with arguments [SI] of a plausible part."""

EXCEL = {
    "PI": lambda: math.pi,
    "SQRT": math.sqrt,
    "SIN": math.sin,
    "LN": math.log,
    "ABS": abs,
    "MAX": max,
    "IF": lambda condition, then, otherwise: then if condition else otherwise,
}


def _read(text, numbers):
    """Return what a formula comes to by Excel's rules, read with Python's eyes."""
    return eval(text.replace("^", "**").replace(")=1", ")==1"), EXCEL | numbers)  # noqa: S307


def test_live_operands_come_to_the_number_of_floats():
    """With cells for arguments each closed form has the value it has with numbers, and its text says so."""
    offenders = []
    for form, arguments in FORMS.items():
        names = [f"c{index}" for index in range(len(arguments))]
        cells = [Live(name, argument) for name, argument in zip(names, arguments, strict=True)]
        formula, expected = worked(form, *cells), pytest.approx(float(form(*arguments)), rel=4e-15)
        numbers = dict(zip(names, arguments, strict=True))
        if formula.value != expected or _read(formula.text, numbers) != expected:
            offenders.append(f"{form.__name__}: {formula}")
        elif not all(name in formula.text for name in names):
            offenders.append(f"{form.__name__} forgets an argument: {formula.text}")
    assert not offenders


@pytest.mark.parametrize("exponent", [2.0, 2.0 + 1e-15, 2.0 + 1e-9, 2.0 - 1e-6, 2.1, 0.0, 9.0])
def test_power_law_keeps_its_digits_as_its_exponent_nears_two(exponent):
    """Where (x^p - 1)/p loses its digits as p vanishes, the formula does not."""
    cells = [Live("r_i", 0.04), Live("r_o", 0.08), Live("n", exponent)]
    growth = worked(windup.power_law_growth, *cells)
    assert growth.value == pytest.approx(float(windup.power_law_growth(0.04, 0.08, exponent)), rel=5e-15)


def test_constants_are_written_as_a_reader_knows_them():
    """π stays PI(), √3 a root, and the knock-down factor its power."""
    cell = Live("c", 2.0)
    assert worked(windup.torque_over_modulus, cell, Live("g", 3.0)).text == "c/(2*PI()*g)"
    assert worked(strength.von_mises_stress, cell).text == "SQRT(3)*c"
    assert worked(strength.curvature_parameter, 0.0, 1.0, cell, cell).text.endswith("*0.67^(4/3)")
    assert "5.35*PI()^2*c" in worked(strength.plate_buckling_shear, cell, 0.0, 1.0, 1.0).text
