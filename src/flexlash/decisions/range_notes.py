"""What a drawing value does not keep to, and what gets worse with it, in words."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from flexlash.decisions.lever import Lever, Terms
from flexlash.decisions.part_range import broken_rules
from flexlash.decisions.side_effects import PartNumbers
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.findings import spelled_out
from flexlash.schema.spellings import plain
from flexlash.schema.units import as_entered

__all__ = ["beyond_entered_range", "faults_of", "growing_worse"]

_DISK = "disk_thickness"
_OWN_DISK = {_DISK, "disk_thickness_exponent"}
"""What a disk has whose thickness is not the wall's."""


def faults_of(numbers: PartNumbers) -> list[dict[str, str]]:
    """Return of each variant what a submission of it is warned of, by a name of the warning."""
    arrays = numbers.arrays
    found: list[dict[str, str]] = [{} for _ in arrays.flexspline_types]
    for kind, _, places, sizes in arrays.alike():
        with np.errstate(all="ignore"):
            for rule, broken in broken_rules(kind, sizes, errors=False):
                for place in places[np.flatnonzero(np.broadcast_to(broken, places.shape))].tolist():
                    found[place][rule.id] = rule.words
    strength = arrays.numbers["yield_strength"]
    told = {
        "yields": ("von Mises stress {} MPa of torsion is above the yield strength {} MPa", "von_mises", strength),
        "buckles": (
            "wall shear {} MPa is above that at which the wall buckles, {} MPa",
            "wall_shear",
            numbers["buckling_shear"],
        ),
        "tires": (
            "alternating stress {} MPa of bending is more than a part of the yield strength {} MPa that can last",
            "alternating_stress",
            strength,
        ),
    }
    soft = "softer than catalogue drives of its size, {} N·m/rad beside at least {}"
    for place in np.flatnonzero(numbers["least_stiffness"] > numbers["stiffness"]).tolist():
        pair = (spelled_out(float(numbers[name][place])) for name in ("stiffness", "least_stiffness"))
        found[place]["soft"] = soft.format(*pair)
    for name, (words, stress, allowed) in told.items():
        for place in np.flatnonzero(getattr(numbers, name)).tolist():
            pair = (spelled_out(float(values[place]) / 1e6) for values in (numbers[stress], allowed))
            found[place][name] = words.format(*pair)
    return found


def beyond_entered_range(lever: Lever, terms: Terms) -> Iterator[str]:
    """Yield how a drawing value lies beyond the range of Levers."""
    row, drawing = terms.rows.get(lever.dimension), lever.drawing_value
    if row is None or drawing is None or lever.what != "nominal":
        return
    column = DIMENSIONS[lever.dimension]
    unit, behind = column.si_unit.si, column.unit_behind
    if row.lowest is not None and drawing < (least := as_entered(row.lowest, unit)):
        yield f"below the lowest value of Levers, {least:.10g}{behind}"
    if row.highest is not None and drawing > (most := as_entered(row.highest, unit)):
        yield f"above the highest value of Levers, {most:.10g}{behind}"


def growing_worse(lever: Lever, terms: Terms) -> Iterator[str]:
    """Yield what gets worse with a lever, or is left open by it, though no number of the report shows it."""
    yield from _left_without_tolerance(lever, terms)
    drawing, before, kind = lever.drawing_value, lever.from_value, lever.variant.flexspline_type
    if lever.dimension != "cylinder_length" or drawing is None or before is None or kind == "cylinder":
        return
    if drawing < before:
        more = f"{100 * (before / drawing - 1):.3g} %"
        yield f"a shorter {kind} is coned more steeply by the wave generator: that part of its bending rises by {more}"


def _left_without_tolerance(lever: Lever, terms: Terms) -> Iterator[str]:
    """Yield that a disk which was as thick as the wall has no tolerance once it is not."""
    variant = lever.variant
    shared = variant.flexspline_type != "cylinder" and not _OWN_DISK & variant.dimensions.keys()
    if not shared or lever.what != "nominal" or lever.moves or lever.dimension not in {"wall_thickness", _DISK}:
        return
    if not any(row.dimension == _DISK for row in terms.classes[plain(variant.tolerance_class)]):
        name = variant.tolerance_class
        yield f"the disk then counts as exact: tolerance class {name} has no row for a disk thickness of its own"
