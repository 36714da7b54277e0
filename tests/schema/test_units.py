"""Every unit a header may carry: its size in SI, its spellings, and what is not guessed at."""

import math

import pytest
from grids import for_each

from flexlash.schema.units import ARCMIN, ARCSEC, RPM, as_entered, find_unit

SIZES = [
    ("length", "m", 1.0),
    ("length", "cm", 0.01),
    ("length", "mm", 0.001),
    ("length", "µm", 1e-6),
    ("length", "in", 0.0254),
    ("length", "mil", 2.54e-5),
    ("length", "ft", 0.3048),
    ("torque", "N·m", 1.0),
    ("torque", "kN·m", 1000.0),
    ("torque", "N·mm", 0.001),
    ("torque", "N·cm", 0.01),
    ("torque", "kgf·m", 9.80665),
    ("torque", "kgf·cm", 0.0980665),
    ("torque", "lbf·in", 0.1129848290276167),
    ("torque", "lbf·ft", 1.3558179483314004),
    ("stress", "Pa", 1.0),
    ("stress", "kPa", 1e3),
    ("stress", "MPa", 1e6),
    ("stress", "GPa", 1e9),
    ("stress", "N/mm²", 1e6),
    ("stress", "kN/mm²", 1e9),
    ("stress", "psi", 6894.757293168361),
    ("stress", "ksi", 6894757.293168361),
    ("stress", "Mpsi", 6894757293.168361),
    ("angle", "rad", 1.0),
    ("angle", "mrad", 1e-3),
    ("angle", "µrad", 1e-6),
    ("angle", "°", math.pi / 180),
    ("angle", "arcmin", math.pi / 10800),
    ("angle", "arcsec", math.pi / 648000),
    ("density", "kg/m³", 1.0),
    ("density", "g/cm³", 1000.0),
    ("density", "kg/dm³", 1000.0),
    ("density", "lb/in³", 27679.904710203125),
    ("inertia", "kg·m²", 1.0),
    ("inertia", "kg·cm²", 1e-4),
    ("inertia", "kg·mm²", 1e-6),
    ("inertia", "g·cm²", 1e-7),
    ("inertia", "lb·in²", 2.926396534292e-4),
    ("inertia", "lb·ft²", 0.04214011009380048),
    ("ratio", "-", 1.0),
    ("ratio", "%", 0.01),
]
SPELLINGS = [
    ("length", "um", "µm"),
    ("length", "micron", "µm"),
    ("length", "μm", "µm"),
    ("length", "inch", "in"),
    ("length", "in.", "in"),
    ("length", '"', "in"),
    ("length", "thou", "mil"),
    ("length", "MM", "mm"),
    ("length", " m m ", "mm"),
    ("torque", "Nm", "N·m"),
    ("torque", "N m", "N·m"),
    ("torque", "N*m", "N·m"),
    ("torque", "N.m", "N·m"),
    ("torque", "N-m", "N·m"),
    ("torque", "N⋅m", "N·m"),
    ("torque", "N\u00a0m", "N·m"),
    ("torque", "nm", "N·m"),
    ("torque", "kNm", "kN·m"),
    ("torque", "Nmm", "N·mm"),
    ("torque", "Ncm", "N·cm"),
    ("torque", "kgf m", "kgf·m"),
    ("torque", "kg-cm", None),
    ("torque", "in-lb", "lbf·in"),
    ("torque", "lb-in", "lbf·in"),
    ("torque", "in·lbf", "lbf·in"),
    ("torque", "ft-lb", "lbf·ft"),
    ("torque", "lbf ft", "lbf·ft"),
    ("stress", "mpa", "MPa"),
    ("stress", "N/mm2", "N/mm²"),
    ("stress", "kN/mm2", "kN/mm²"),
    ("stress", "PSI", "psi"),
    ("angle", "deg", "°"),
    ("angle", "'", "arcmin"),
    ("angle", "′", "arcmin"),
    ("angle", "arc min", "arcmin"),
    ("angle", "''", "arcsec"),
    ("angle", "″", "arcsec"),
    ("angle", "urad", "µrad"),
    ("density", "kg/m3", "kg/m³"),
    ("density", "g/cm3", "g/cm³"),
    ("inertia", "kg m2", "kg·m²"),
    ("inertia", "kg m²", "kg·m²"),
    ("inertia", "kgm²", "kg·m²"),
    ("inertia", "kg*m2", "kg·m²"),
    ("inertia", "kg-m2", "kg·m²"),
    ("inertia", "kg.m2", "kg·m²"),
    ("inertia", "kgcm2", "kg·cm²"),
    ("inertia", "kg mm2", "kg·mm²"),
    ("inertia", "g cm²", "g·cm²"),
    ("inertia", "lb-in2", "lb·in²"),
    ("inertia", "lb ft²", "lb·ft²"),
    ("inertia", "kg·m", None),
    ("inertia", "kg", None),
    ("inertia", "kg/m³", None),
    ("inertia", "lbf·in", None),
    ("inertia", "m²", None),
    ("inertia", "", None),
    ("torque", "kg·m²", None),
    ("ratio", "", "-"),
    ("ratio", "1", "-"),
    ("ratio", "–", "-"),
    ("length", "", None),
    ("length", "-", None),
    ("length", "furlong", None),
    ("length", "%", None),
    ("torque", "mm", None),
    ("torque", "mN·m", None),
    ("torque", "MN·m", None),
    ("angle", "mm", None),
]


@for_each("quantity, name, size", SIZES)
def test_size_in_si(quantity, name, size):
    """A unit is found by its printed name and has the size that its standard gives."""
    unit = find_unit(name, quantity)
    assert unit is not None
    assert (unit.name, unit.quantity) == (name, quantity)
    assert unit.si == pytest.approx(size, rel=1e-14)


@for_each("quantity, text, name", SPELLINGS)
def test_spellings(quantity, text, name):
    """Signs, spaces and usual other spellings lead to one unit; what measures something else is not guessed at."""
    unit = find_unit(text, quantity)
    assert (unit.name if unit else None) == name


@pytest.mark.parametrize("quantity", ["length", "torque", "stress", "angle", "inertia", "density", "ratio"])
def test_no_unit_measures_two_things(quantity):
    """A unit of one quantity is unknown to every other, so that a header copied to a wrong column is caught."""
    foreign = [name for other, name, _ in SIZES if other != quantity]
    assert [name for name in foreign if find_unit(name, quantity)] == []


def test_newton_metres_are_no_nanometres():
    """A length given in N·m is an error, not a length in nanometres."""
    assert find_unit("N·m", "length") is find_unit("nm", "length") is None
    assert find_unit("Nm", "length") is None


def test_minutes_and_seconds_of_arc():
    """Sixty minutes of arc are a degree, and sixty seconds a minute."""
    assert pytest.approx(math.radians(1), rel=1e-15) == 60 * ARCMIN
    assert pytest.approx(ARCMIN, rel=1e-15) == 60 * ARCSEC


def test_turns_per_minute():
    """Sixty turns per minute are a turn per second."""
    assert pytest.approx(math.tau, rel=1e-15) == 60 * RPM


def test_a_quantity_that_nobody_measures_is_a_fault_of_the_program():
    """Asking for a quantity that does not exist fails loudly."""
    with pytest.raises(LookupError):
        find_unit("mm", "colour")


@for_each("entry", [3.8, 0.1, 37.3, 3.75, 1e-9, 780000.0, 2 / 3])
@for_each("unit", [ARCMIN, 1e-3, 0.0254, 1.0])
def test_an_entry_comes_back_as_it_was_made(entry, unit):
    """A number converted to SI and back is the one that was entered, or, with more digits than 15, its size is kept."""
    back = as_entered(entry * unit, unit)
    assert back == entry or (entry == 2 / 3 and back == pytest.approx(entry, rel=1e-15))


def test_a_computed_size_keeps_all_digits():
    """A size that fifteen digits do not give is not rounded."""
    size = 0.1 + 0.2
    assert as_entered(size, 1.0) == size
