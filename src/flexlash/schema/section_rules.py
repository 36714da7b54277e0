"""What a closed half-section needs beside the book of rules: the formula computes these parts, elasticity cannot."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from flexlash.schema.part_row import Operand, PartRow, PartRule
from flexlash.schema.part_rules import face_meets_fillet, fillet_meets_rim, fillets_overlap, is_off_the_wall

__all__ = ["SECTION_RULES"]


def _section(dimension: str, words: str, broken: Callable[[PartRow], Iterable[Operand]]) -> PartRule:
    """Return the rule of one need."""
    return PartRule(code="W413", dimension=dimension, words=words, broken=broken)


def _disk(row: PartRow) -> Operand:
    """Return the width of a cup's disk between hub and bore."""
    return row.bore - row["disk_inner_radius"]


_OFF = "the disk does not end within the wall"
_TOO_LONG = "rim and junction fillet are longer than the cylinder"
_TOO_WIDE = "the tooth face reaches into the junction fillet"

SECTION_RULES = (
    _section("tooth_face_width", _TOO_WIDE, lambda row: (row.given("tooth_face_width"), face_meets_fillet(row))),
    _section("wall_thickness", "the wall fills its bore", lambda row: (row.bore <= row.edge,)),
    _section("disk_outer_radius", _OFF, lambda row: (row.is_type("cup"), is_off_the_wall(row, "disk_outer_radius"))),
    _section("disk_inner_radius", _OFF, lambda row: (row.is_type("hat"), is_off_the_wall(row, "disk_inner_radius"))),
    _section(
        "disk_outer_radius",
        "the flange ends within the wall",
        lambda row: (
            row.is_type("hat"),
            row["disk_outer_radius"] <= row["mean_radius"] + row["wall_thickness"] / 2 + row.edge,
        ),
    ),
    _section(
        "disk_inner_radius",
        "the hub reaches into the wall",
        lambda row: (row.is_type("cup"), _disk(row) <= row.edge),
    ),
    _section(
        "hub_fillet_radius",
        "the hub fillet reaches into the wall",
        lambda row: (row.is_type("cup"), row["hub_fillet_radius"] > _disk(row) + row.edge),
    ),
    _section(
        "junction_fillet_radius",
        "hub fillet and junction fillet overlap on the disk",
        lambda row: (row.is_type("cup"), row["hub_fillet_radius"] > 0, fillets_overlap(row)),
    ),
    _section(
        "junction_fillet_radius",
        "the junction fillet reaches beyond the disk",
        lambda row: (row.is_type("cup"), fillets_overlap(row)),
    ),
    _section(
        "disk_cone_angle",
        "a conical disk takes no fillet",
        lambda row: (
            row["disk_cone_angle"] < row.flat,
            row["hub_fillet_radius"] + row["junction_fillet_radius"] > 0,
        ),
    ),
    _section(
        "rim_length",
        "the rim is as long as the cylinder",
        lambda row: (row["rim_length"] > row["cylinder_length"] - row.edge,),
    ),
    _section("rim_length", _TOO_LONG, lambda row: (row["rim_length"] > 0, fillet_meets_rim(row))),
    _section("junction_fillet_radius", _TOO_LONG, lambda row: (fillet_meets_rim(row),)),
)
"""Every need, in the order in which it is told."""
