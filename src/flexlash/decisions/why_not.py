"""Why a change alone cannot do it, in words."""

from __future__ import annotations

from flexlash.schema.angle_unit import ARC_MINUTES, AngleUnit
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.entry_words import dimension_words
from flexlash.schema.findings import spelled_out
from flexlash.schema.units import ARCMIN

__all__ = ["always_kept", "never_met", "no_step", "share_of_units", "softer", "still_over", "unmoved"]

_ALL, _RARE, _LEAST = 0.9999, 1e-3, 1e-9
_DIGITS = 4


def share_of_units(share: float) -> str:
    """Return a share of units in three digits, never as a bare 0 or 100 %.

    >>> share_of_units(0.1234), share_of_units(0.00032), share_of_units(1.0)
    ('12.3 % of units', '320 ppm of units', 'practically all units')
    """
    if share > _ALL:
        return "practically all units"
    if share >= _RARE:
        return f"{100 * share:.3g} % of units"
    return f"{spelled_out(1e6 * share, 3)} ppm of units" if share > _LEAST else "practically no unit"


def _value(dimension: str, value: float) -> str:
    """Return a value [SI] of a dimension with its unit."""
    column = DIMENSIONS[dimension]
    return f"{spelled_out(value / column.si_unit.si)}{column.unit_behind}"


def never_met(dimension: str, value: float, ends: tuple[float, float], over: float) -> str:
    """Return that no value of a dimension meets the limit, where the best one tried [SI] leaves such a share over it.

    >>> never_met("disk_inner_radius", 0.0795, (0.004, 0.0795), 0.12)
    'even at 79.5 mm, the greatest value tried, 12 % of units are still over the limit'
    """
    names = {ends[0]: "the least value tried", ends[1]: "the greatest value tried"}
    which = f", {names.get(value, 'the best value tried')}"
    share = share_of_units(over)
    verb = "is" if share.endswith("unit") else "are"
    return f"even at {_value(dimension, value)}{which}, {share} {verb} still over the limit"


def always_kept(dimension: str, ends: tuple[float, float]) -> str:
    """Return that every value of a dimension [SI] between two ends keeps the limit.

    >>> always_kept("rim_length", (0.0024, 0.159))
    'nothing to find: every tooth rim length from 2.4 to 159 mm keeps the limit'
    """
    low, high = (_value(dimension, end) for end in ends)
    low = low.removesuffix(DIMENSIONS[dimension].unit_behind)
    return f"nothing to find: every {dimension_words(dimension)} from {low} to {high} keeps the limit"


def no_step(dimension: str, value: float, step: float) -> str:
    """Return that a value [SI] would do, but no value of the drawing beside it.

    >>> no_step("disk_inner_radius", 0.07912, 0.5)
    '79.12 mm would do, but beside it no multiple of the drawing step 0.5 mm makes a part that does'
    """
    unit = DIMENSIONS[dimension].unit_behind
    return (
        f"{_value(dimension, value)} would do, but beside it no multiple of the drawing step {step:g}{unit} makes a "
        "part that does"
    )


def unmoved(dimension: str) -> str:
    """Return that the process of a dimension is that of measured parts.

    >>> unmoved("wall_thickness")
    'its parts were measured: another wall thickness on the drawing does not move what the process makes'
    """
    words = dimension_words(dimension)
    return f"its parts were measured: another {words} on the drawing does not move what the process makes"


def softer(material: str, mean: float, limit: float, angles: AngleUnit = ARC_MINUTES) -> str:
    """Return that the mean backlash [rad] in a material is over the limit already.

    >>> softer("Ti-6Al-4V", 7.2 * ARCMIN, 3.8 * ARCMIN)
    'with Ti-6Al-4V the mean backlash is 7.2′, over the limit of 3.8′'
    """
    mean_words, limit_words = (angles.spelled_out(angle / ARCMIN, _DIGITS) for angle in (mean, limit))
    return f"with {material} the mean backlash is {mean_words}, over the limit of {limit_words}"


def still_over(material: str, over: float) -> str:
    """Return that with a material such a share of units is still over the limit.

    >>> still_over("20Cr2Ni4", 0.02)
    'with 20Cr2Ni4 2 % of units are still over the limit'
    """
    return f"with {material} {share_of_units(over)} are still over the limit"
