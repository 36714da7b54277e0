"""The book of rules: which dimensions of one row do not go together, each rule written once.

A rule is a function of a row of operands, so that validation's expressions, the template's status, the report's Trace,
the check at the tolerance limits and the elasticity check answer from the same line.
"""

from __future__ import annotations

from flexlash.schema.entry_words import dimension_words
from flexlash.schema.part_row import Operand, PartRow, PartRule, Reached

__all__ = ["PART_RULES", "face_meets_fillet", "fillet_meets_rim", "fillets_overlap", "is_off_the_wall", "said_before"]


_WALL_SHARES = (0.006, 0.02)
"""Wall over mean diameter outside which a flexspline is not expected; 0.01 to 0.015 is usual."""

_HUB_SHARE = 0.7
"""Hub radius over bore radius above which a diameter was probably entered as a radius."""

_THICK, _THICKEST = 0.1, 0.2
"""Wall over mean radius above which the thin-wall formula is noted, and warned of."""


def _foreign(dimension: str, *types: str) -> PartRule:
    """Return the rule that these flexspline types have no such dimension."""
    return PartRule(
        code="E310",
        dimension=dimension,
        words=f"{'only a cup has a' if 'hat' in types else 'a cylinder has no'} {dimension_words(dimension)}",
        broken=lambda row: (row.is_type(*types), row.given(dimension)),
        facts=lambda row: {"other": row.type},
        demands="none",
    )


def _foreign_fillet(dimension: str) -> PartRule:
    """Return the rule that only a cup has this fillet; one of 0 is none."""
    return PartRule(
        code="E310",
        dimension=dimension,
        words=f"only a cup has a {dimension_words(dimension)}",
        broken=lambda row: (row.is_type("cylinder", "hat"), row[dimension] > 0),
        facts=lambda row: {"other": row.type},
        demands="none",
    )


def _missing(dimension: str, flexspline_type: str) -> PartRule:
    """Return the rule that this flexspline type needs a dimension."""
    return PartRule(
        code="E311",
        dimension=dimension,
        words=f"a {flexspline_type} without a {dimension_words(dimension)}",
        broken=lambda row: (row.is_type(flexspline_type), row.blank(dimension)),
        facts=lambda _: {"other": flexspline_type},
        demands="entry",
    )


def _half_rim(dimension: str, given: str, words: str) -> PartRule:
    """Return the rule that a tooth rim with one dimension has the other as well."""
    return PartRule(
        code="E304",
        dimension=dimension,
        words=words,
        broken=lambda row: (row.given(given), row.blank(dimension)),
        demands="entry",
    )


def _fillet_on_a_cone(dimension: str) -> PartRule:
    """Return the rule that a conical disk has no fillets."""
    return PartRule(
        code="E327",
        dimension=dimension,
        words=f"a conical disk with a {dimension_words(dimension)}",
        broken=lambda row: (row.is_type("cup"), row["disk_cone_angle"] < row.flat, row[dimension] > 0),
        facts=lambda row: {"other": f"{row['disk_cone_angle']:g}"},
        demands="none",
    )


def fillets_overlap(row: PartRow) -> Operand:
    """Return whether the fillets of a cup take more than the disk between hub and bore."""
    fillets = row["junction_fillet_radius"] + row["hub_fillet_radius"]
    return fillets > row.bore - row["disk_inner_radius"] + row.edge


def face_meets_fillet(row: PartRow) -> Operand:
    """Return whether tooth face and junction fillet together are longer than the cylinder."""
    return row["tooth_face_width"] + row["junction_fillet_radius"] > row["cylinder_length"] + row.edge


def fillet_meets_rim(row: PartRow) -> Operand:
    """Return whether junction fillet and tooth rim are longer than the cylinder."""
    return row["junction_fillet_radius"] + row["rim_length"] > row["cylinder_length"] + row.edge


def is_off_the_wall(row: PartRow, dimension: str) -> Operand:
    """Return whether a radius of the disk does not lie within the wall."""
    return row.are_apart(row[dimension], row["mean_radius"], row["wall_thickness"] / 2 + row.edge)


PART_RULES = (
    PartRule(
        code="E301",
        dimension="mean_radius",
        words="neither mean radius nor bore diameter is given",
        broken=lambda row: (row.blank("mean_radius"), row.blank("bore_diameter")),
        demands="entry",
        instead="bore_diameter",
    ),
    PartRule(
        code="E302",
        dimension="mean_radius",
        words="mean radius and bore diameter are both given",
        broken=lambda row: (row.given("mean_radius"), row.given("bore_diameter")),
        facts=lambda row: {"other": f"{row['bore_diameter']:g}"},
        demands="none",
        instead="bore_diameter",
    ),
    _foreign("disk_thickness", "cylinder"),
    _foreign("disk_inner_radius", "cylinder"),
    _foreign("disk_outer_radius", "cylinder"),
    _foreign("disk_hub_thickness", "cylinder", "hat"),
    _foreign("disk_thickness_exponent", "cylinder", "hat"),
    _foreign("disk_cone_angle", "cylinder"),
    _foreign_fillet("hub_fillet_radius"),
    _foreign_fillet("junction_fillet_radius"),
    _missing("disk_inner_radius", "cup"),
    _missing("disk_outer_radius", "hat"),
    PartRule(
        code="E303",
        dimension="disk_inner_radius",
        words="disk inner radius is not below disk outer radius",
        broken=lambda row: (row.is_type("cup", "hat"), row["disk_inner_radius"] >= row["disk_outer_radius"]),
        facts=lambda row: {"other": row["disk_outer_radius"], "value": row["disk_inner_radius"]},
        after=("E311",),
        compares_lengths=True,
        reached=Reached(kind="impossible", words="the other radius of the disk"),
    ),
    PartRule(
        code="E330",
        dimension="wall_thickness",
        words="wall is not below twice the mean radius: no bore",
        broken=lambda row: (row.bore <= row.edge,),
        facts=lambda row: {"other": 2 * row["mean_radius"]},
        compares_lengths=True,
        reached=Reached(kind="impossible", words="the axis: no bore is left"),
    ),
    _half_rim("rim_thickness", "rim_length", "a tooth rim without a thickness"),
    _half_rim("rim_length", "rim_thickness", "a tooth rim without a length"),
    PartRule(
        code="E325",
        dimension="disk_hub_thickness",
        words="an exponent without a thickness at hub",
        broken=lambda row: (
            row.is_type("cup"),
            row.given("disk_thickness_exponent"),
            row.blank("disk_hub_thickness"),
        ),
        demands="entry",
    ),
    PartRule(
        code="E326",
        dimension="disk_thickness",
        words="an exponent and a disk thickness are both given",
        broken=lambda row: (
            row.is_type("cup"),
            row.given("disk_thickness_exponent"),
            row.given("disk_hub_thickness"),
            row.given("disk_thickness"),
        ),
        facts=lambda row: {"other": f"{row['disk_thickness_exponent']:g}"},
        demands="none",
    ),
    _fillet_on_a_cone("hub_fillet_radius"),
    _fillet_on_a_cone("junction_fillet_radius"),
    PartRule(
        code="E305",
        dimension="rim_length",
        words="tooth rim is not shorter than the cylinder",
        broken=lambda row: (row["rim_length"] >= row["cylinder_length"],),
        facts=lambda row: {"other": row["cylinder_length"]},
        compares_lengths=True,
        reached=Reached(kind="overlap", words="the cylinder length"),
    ),
    PartRule(
        code="E306",
        dimension="rim_thickness",
        words="tooth rim is thinner than the wall",
        broken=lambda row: (row.given("rim_thickness"), row["rim_thickness"] < row["wall_thickness"]),
        facts=lambda row: {"other": row["wall_thickness"]},
        compares_lengths=True,
    ),
    PartRule(
        code="E312",
        dimension="hub_fillet_radius",
        words="hub fillet is wider than the disk",
        broken=lambda row: (
            row.is_type("cup"),
            row["hub_fillet_radius"] > row["disk_outer_radius"] - row["disk_inner_radius"] + row.edge,
        ),
        facts=lambda row: {"other": row["disk_outer_radius"] - row["disk_inner_radius"]},
        after=("E303",),
        compares_lengths=True,
        reached=Reached(kind="overlap", words="the width of the disk"),
    ),
    PartRule(
        code="E313",
        dimension="junction_fillet_radius",
        words="junction fillet and tooth rim exceed the length",
        broken=lambda row: (row.is_type("cup"), row["junction_fillet_radius"] > 0, fillet_meets_rim(row)),
        facts=lambda row: {"other": row["cylinder_length"]},
        after=("E305",),
        compares_lengths=True,
        reached=Reached(kind="overlap", words="the cylinder length"),
    ),
    PartRule(
        code="E360",
        dimension="tooth_face_width",
        words="tooth face and junction fillet exceed the length",
        broken=lambda row: (
            row.given("tooth_face_width"),
            face_meets_fillet(row),
        ),
        facts=lambda row: {"other": row["cylinder_length"] - row["junction_fillet_radius"]},
        compares_lengths=True,
        reached=Reached(kind="overlap", words="the cylinder length"),
    ),
    PartRule(
        code="E328",
        dimension="junction_fillet_radius",
        words="junction fillet is wider than the bore",
        broken=lambda row: (row.is_type("cup"), row["junction_fillet_radius"] > row.bore + row.edge),
        facts=lambda row: {"other": row.bore},
        after=("E330",),
        compares_lengths=True,
        reached=Reached(kind="impossible", words="beyond the axis"),
    ),
    PartRule(
        code="W416",
        dimension="junction_fillet_radius",
        words="fillets overlap on the disk",
        broken=lambda row: (row.is_type("cup"), row["junction_fillet_radius"] > 0, fillets_overlap(row)),
        facts=lambda row: {"other": row.bore - row["disk_inner_radius"]},
        after=("E303", "E312", "E328", "E330"),
    ),
    PartRule(
        code="W401",
        dimension="disk_outer_radius",
        words="disk does not end at the mean radius",
        broken=lambda row: (
            row.is_type("cup"),
            row.are_apart(row["disk_outer_radius"] / row["mean_radius"], 1.0, 1e-9),
        ),
        facts=lambda row: {"other": row["mean_radius"]},
    ),
    PartRule(
        code="W401",
        dimension="disk_inner_radius",
        words="flange does not begin within the wall",
        broken=lambda row: (row.is_type("hat"), is_off_the_wall(row, "disk_inner_radius")),
        facts=lambda row: {"other": row["mean_radius"]},
        after=("E303", "E311"),
    ),
    PartRule(
        code="W419",
        dimension="disk_inner_radius",
        words="hub is large",
        broken=lambda row: (row.is_type("cup"), row["disk_inner_radius"] > _HUB_SHARE * row.bore + row.edge),
        facts=lambda row: {"other": row.bore},
        after=("E303", "E330"),
    ),
    PartRule(
        code="W418",
        dimension="wall_thickness",
        words="wall is unusual",
        broken=lambda row: (
            row.wall_share <= _THICK,
            row.any_of(
                row.wall_share / 2 < _WALL_SHARES[0] - row.edge, row.wall_share / 2 > _WALL_SHARES[1] + row.edge
            ),
        ),
        facts=lambda row: {"detail": f"{row.wall_share / 2:.2g}", "other": 2 * row["mean_radius"]},
    ),
    PartRule(
        code="W403",
        dimension="wall_thickness",
        words="wall is thick",
        broken=lambda row: (row.wall_share > _THICKEST,),
        facts=lambda row: {"value": f"{row.wall_share:.2g}"},
        after=("E330",),
    ),
    PartRule(
        code="I506",
        dimension="wall_thickness",
        words="wall is rather thick",
        broken=lambda row: (row.wall_share > _THICK, row.wall_share <= _THICKEST),
        facts=lambda row: {"value": f"{row.wall_share:.2g}"},
    ),
)
"""Every rule, in the order in which a row's faults are told; one that stands `after` others follows them."""


def said_before(rule: PartRule) -> list[PartRule]:
    """Return the rules that say what a rule says when they are broken: those it stands after, and theirs in turn."""
    said: set[str] = set()
    waiting = [rule]
    while waiting:
        after = waiting.pop().after
        named = [one for one in PART_RULES if one.code in after and one.id not in said]
        said |= {one.id for one in named}
        waiting += named
    return [one for one in PART_RULES if one.id in said]
