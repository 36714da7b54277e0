"""Units that a header or a tolerance may be given in, each with its factor to SI."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

__all__ = ["ARCMIN", "ARCSEC", "RPM", "Unit", "as_entered", "find_unit"]

ARCMIN = math.pi / 180 / 60
ARCSEC = ARCMIN / 60
RPM = math.pi / 30

_INCH = 0.0254
_POUND_FORCE = 4.4482216152605
_KILOGRAM_FORCE = 9.80665


@dataclass(frozen=True, kw_only=True)
class Unit:
    """A unit of measure: its printed name, the quantity it measures and its size in SI."""

    name: str
    quantity: str
    si: float


_TABLE: dict[str, dict[str, float]] = {
    "length": {
        "m": 1.0,
        "cm": 1e-2,
        "mm": 1e-3,
        "µm": 1e-6,
        "in": _INCH,
        "mil": _INCH / 1000,
        "ft": 12 * _INCH,
    },
    "torque": {
        "N·m": 1.0,
        "kN·m": 1e3,
        "N·mm": 1e-3,
        "N·cm": 1e-2,
        "kgf·m": _KILOGRAM_FORCE,
        "kgf·cm": _KILOGRAM_FORCE / 100,
        "lbf·in": _POUND_FORCE * _INCH,
        "lbf·ft": _POUND_FORCE * _INCH * 12,
    },
    "stress": {
        "Pa": 1.0,
        "kPa": 1e3,
        "MPa": 1e6,
        "GPa": 1e9,
        "N/mm²": 1e6,
        "kN/mm²": 1e9,
        "psi": _POUND_FORCE / _INCH**2,
        "ksi": 1000 * _POUND_FORCE / _INCH**2,
        "Mpsi": 1e6 * _POUND_FORCE / _INCH**2,
    },
    "angle": {
        "rad": 1.0,
        "mrad": 1e-3,
        "µrad": 1e-6,
        "°": 60 * ARCMIN,
        "arcmin": ARCMIN,
        "arcsec": ARCSEC,
    },
    "inertia": {
        "kg·m²": 1.0,
        "kg·cm²": 1e-4,
        "kg·mm²": 1e-6,
        "g·cm²": 1e-7,
        "lb·in²": 0.45359237 * _INCH**2,
        "lb·ft²": 0.45359237 * (12 * _INCH) ** 2,
    },
    "density": {"kg/m³": 1.0, "g/cm³": 1e3, "kg/dm³": 1e3, "lb/in³": 0.45359237 / _INCH**3},
    "ratio": {"-": 1.0, "%": 1e-2},
}
_ALIASES = {
    "um": "µm",
    "micron": "µm",
    "inch": "in",
    '"': "in",
    "thou": "mil",
    "Nm": "N·m",
    "kNm": "kN·m",
    "Nmm": "N·mm",
    "Ncm": "N·cm",
    "kgfm": "kgf·m",
    "kgm": "kgf·m",
    "kgfcm": "kgf·cm",
    "lbfin": "lbf·in",
    "lbin": "lbf·in",
    "inlb": "lbf·in",
    "inlbf": "lbf·in",
    "lbfft": "lbf·ft",
    "lbft": "lbf·ft",
    "ftlb": "lbf·ft",
    "ftlbf": "lbf·ft",
    "urad": "µrad",
    "deg": "°",
    "degree": "°",
    "'": "arcmin",
    "′": "arcmin",
    "''": "arcsec",
    "″": "arcsec",
    "N/mm2": "N/mm²",
    "kN/mm2": "kN/mm²",
    "kgm2": "kg·m²",
    "kgcm2": "kg·cm²",
    "kgmm2": "kg·mm²",
    "gcm2": "g·cm²",
    "lbin2": "lb·in²",
    "lbft2": "lb·ft²",
    "kg/m3": "kg/m³",
    "g/cm3": "g/cm³",
    "kg/dm3": "kg/dm³",
    "lb/in3": "lb/in³",
    "": "-",
    "1": "-",
    "–": "-",
}
_UNITS = {
    quantity: {name: Unit(name=name, quantity=quantity, si=si) for name, si in units.items()}
    for quantity, units in _TABLE.items()
}


def as_entered(size: float, unit: float) -> float:
    """Return a size in a unit as it was entered: with fifteen digits where these give the same size, else with all.

    >>> 3.8 * ARCMIN / ARCMIN, as_entered(3.8 * ARCMIN, ARCMIN)
    (3.7999999999999994, 3.8)
    """
    short = float(f"{size / unit:.15g}")
    return short if short * unit == size else size / unit


def _plain(text: str) -> str:
    """Return a unit's letters alone: no spaces, no multiplication signs, one micro sign."""
    kept = text.replace("μ", "µ")
    return "".join(character for character in kept if character not in " \u00a0·⋅*.-–^") or text.strip()


@cache
def _spellings(quantity: str) -> dict[str, Unit]:
    """Return the units of a quantity by every spelling of them."""
    units = _UNITS[quantity]
    aliases = {_plain(alias): units[name] for alias, name in _ALIASES.items() if name in units}
    return {_plain(name): unit for name, unit in units.items()} | aliases


def find_unit(text: str, quantity: str) -> Unit | None:
    """Return the unit of a quantity that a text names, or None.

    Multiplication signs and spaces do not count; letter case counts only where two units differ by it.

    >>> find_unit("in-lb", "torque").name
    'lbf·in'
    >>> find_unit("um", "length").si
    1e-06
    >>> find_unit("furlong", "length") is None
    True
    """
    spellings = _spellings(quantity)
    wanted = _plain(text)
    if wanted in spellings:
        return spellings[wanted]
    near = {unit.name: unit for spelling, unit in spellings.items() if spelling.casefold() == wanted.casefold()}
    return next(iter(near.values())) if len(near) == 1 else None
