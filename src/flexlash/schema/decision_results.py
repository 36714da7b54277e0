"""The fields of what flexlash decides: single changes that meet the limit, and the tolerances of a class."""

from __future__ import annotations

from typing import Any

from flexlash.schema.column import Column

__all__ = ["ALLOCATION", "LEVERS_TABLE"]


def _decided(sheet: str, key: str, label: str, text: str, **rest: Any) -> Column:
    return Column(sheet=sheet, key=key, label=label, help=text, **{"role": "result", **rest})


def _lever(key: str, label: str, text: str, **rest: Any) -> Column:
    return _decided("Levers", key, label, text, **rest)


def _allocated(key: str, label: str, text: str, **rest: Any) -> Column:
    return _decided("Allocation", key, label, text, **rest)


_YES_NO: dict[str, Any] = {"type": "choice", "choices": ("yes", "no")}

LEVERS_TABLE = (
    _lever("variant", "Variant", "Name of the variant as submitted.", type="text", role="identity"),
    _lever(
        "dimension",
        "Dimension",
        "The dimension that changes alone, as entered; material for another material.",
        type="text",
        role="identity",
    ),
    _lever(
        "moves",
        "Moves",
        "Dimensions that follow it because they are the same on the drawing, joined by +. Blank: none.",
        type="text",
    ),
    _lever(
        "what",
        "What",
        "nominal: the value on the drawing. tolerance: half the width of its limits. material: another material.",
        type="choice",
        choices=("nominal", "tolerance", "material"),
    ),
    _lever(
        "direction",
        "Direction",
        "meet: the variant misses its limit, and this change alone brings it within. relax: it meets its limit, and "
        "this is how far the change may go.",
        type="choice",
        choices=("meet", "relax"),
    ),
    _lever("from_value", "From", "The value as it is, in the unit of the row."),
    _lever("to_value", "To (exact)", "The value at which the share of units within the limit is just the target."),
    _lever("drawing_value", "To (drawing)", "The same, rounded to the drawing step on the safe side."),
    _lever("to_material", "To material", "The other material.", type="text"),
    _lever("unit", "Unit", "Unit of the values of this row: that of the dimension's own column.", type="text"),
    _lever("possible", "Possible", "Whether this change alone can do it.", **_YES_NO),
    _lever("reason", "Why not", "Why it cannot.", type="text"),
    _lever(
        "probability_over_limit_after",
        "Over limit after",
        "Share of units over the limit with the drawing value, computed anew.",
        minimum=0,
        maximum=1,
    ),
    _lever(
        "ppm_after",
        "Over limit after [ppm]",
        "The same, per million.",
        minimum=0,
        maximum=1_000_000,
    ),
    _lever("mass_change_percent", "Mass [%]", "Change of the mass of wall, rim and disk; blank without a density."),
    _lever("stiffness_change_percent", "Stiffness [%]", "Change of the torsional stiffness."),
    _lever(
        "von_mises_MPa_after",
        "von Mises after [MPa]",
        "Greatest von Mises stress of torsion with the change.",
        minimum=0,
    ),
    _lever(
        "bending_stress_change_percent",
        "Bending stress [%]",
        "Change of the stress by which the wave generator bends the wall: as Δ/r_m² at equal deflection, times E of "
        "another material.",
    ),
    _lever(
        "in_range",
        "In range",
        "Whether the drawing value keeps to the rules of a part, to plausible proportions and to the range of Levers.",
        **_YES_NO,
    ),
    _lever("range_note", "Range note", "Which of these it breaks, or what gets worse with the change.", type="text"),
    _lever(
        "relative_cost", "Relative cost", "Steps times cost per step; of a tolerance IT grades times cost per grade."
    ),
    _lever(
        "rank",
        "Rank",
        "1 is the cheapest of the possible changes of this variant that are in range and meet the limit.",
        minimum=1,
    ),
)

ALLOCATION = (
    _allocated("tolerance_class", "Tolerance class", "The class.", type="text", role="identity"),
    _allocated("dimension", "Dimension", "A dimension of the class that scatters.", type="text", role="identity"),
    _allocated(
        "unit",
        "Unit",
        "Unit of the widths: that of the dimension; % where the class has them so; IT grade where sizes differ.",
        type="text",
    ),
    _allocated("from_value", "± now", "Half the width of the limits as it is, or the grade.", minimum=0),
    _allocated(
        "to_value",
        "± allocated",
        "Half the width, or the grade, that keeps every variant of the class within its limit at the least relative "
        "cost. In whole steps of the drawing, so that it can be entered in Tolerances.",
        minimum=0,
    ),
    _allocated("grade_steps", "IT grades wider", "How many IT grades wider that is; negative: finer."),
    _allocated("relative_cost", "Relative cost", "Grades finer times cost per grade; negative: it saves."),
    _allocated(
        "limited_by",
        "Limited by",
        "Variants that are at their limit with these tolerances, the greatest width that was allowed, or why it stays.",
        type="text",
    ),
    _allocated(
        "possible", "Possible", "Whether tolerances of this class can keep all of its variants within.", **_YES_NO
    ),
    _allocated("reason", "Why not", "Why they cannot, with the least that is left over the limit.", type="text"),
)
