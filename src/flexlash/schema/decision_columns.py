"""The fields of Other sources, Levers and Sweep: what else plays in the drive, what may change, what is swept."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from flexlash.schema.column import LENGTH, POSITIVE, Column
from flexlash.schema.variant_columns import VARIANTS

__all__ = ["LEVERS", "MATERIAL", "OTHER_SOURCES", "SWEEP", "source_unit"]

_FIRST = 6
"""Template version that brought these sheets."""

MATERIAL = "material"
"""What Levers calls the choice of another material."""


def source_unit(enter_as: str | None) -> str:
    """Return the unit of a source's value and deviations, by what it is entered as.

    >>> source_unit(None), source_unit("mm radial play")
    ('arcmin', 'mm')
    """
    return (enter_as or "arcmin").split(" ")[0]


_SIZES = tuple(column.dimension for column in VARIANTS if column.role == "dimension")

_source: Callable[..., Column] = partial(Column.entry, "Other sources", since=_FIRST)
_lever: Callable[..., Column] = partial(Column.entry, "Levers", since=_FIRST)
_sweep: Callable[..., Column] = partial(Column.entry, "Sweep", since=_FIRST)

OTHER_SOURCES = (
    _source(
        "identity",
        "source",
        "Source",
        "Name of a source of backlash beside the wind-up of the flexspline, used once: tooth clearance, output "
        "bearing, coupling.",
        type="text",
        required=True,
        group="Source",
    ),
    _source(
        "requirement",
        "enter_as",
        "Enter as",
        "What the numbers of the row are: an angle in arcmin; a play in mm along the circumference at a radius; a "
        "radial play in mm, which the pressure angle turns into one at the radius. Blank: arcmin.",
        type="choice",
        choices=("arcmin", "mm at radius", "mm radial play"),
        default="arcmin",
        group="Source",
    ),
    _source(
        "requirement",
        "value_arcmin",
        "Value",
        "The play, in arcmin or mm as Enter as says. Blank: 0, the deviations alone count.",
        minimum=0,
        group="Source",
        also_called="play backlash clearance lostmotion amount nominal spiel wert jeu valeur gioco valore",
    ),
    _source(
        "requirement",
        "radius_mm",
        "Radius [mm]",
        "Radius at which a play in mm acts. Only where Enter as says mm.",
        **LENGTH,
        group="Source",
    ),
    _source(
        "requirement",
        "pressure_angle_deg",
        "Pressure angle [°]",
        "Of the teeth; only for a radial play. Blank: 20.",
        quantity="angle",
        **POSITIVE,
        maximum=60,
        default=20,
        usual=(14, 30),
        group="Source",
    ),
    _source(
        "requirement",
        "lower_deviation",
        "Lower deviation",
        "With its sign: least play minus the value, in its unit.",
        group="Scatter",
        also_called="lower unteresabmaß unteresabmass untereabweichung lowertolerance minus",
    ),
    _source(
        "requirement",
        "upper_deviation",
        "Upper deviation",
        "With its sign: greatest play minus the value, in its unit.",
        group="Scatter",
        also_called="upper oberesabmaß oberesabmass obereabweichung uppertolerance plus",
    ),
    _source(
        "requirement",
        "distribution",
        "Distribution",
        "How units scatter between the deviations. Blank means normal.",
        type="choice",
        choices=("normal", "truncated normal", "uniform", "triangular"),
        default="normal",
        group="Scatter",
    ),
    _source(
        "requirement",
        "limits_sigma",
        "Limits at ± sigma",
        "Normal distributions: the deviations lie this many standard deviations from their middle. Blank: 3.",
        minimum=0.5,
        maximum=100,
        default=3,
        usual=(1, 12),
        group="Scatter",
    ),
    _source(
        "requirement",
        "side",
        "Side",
        "output: the play is one of the output. input: it is one of the input, divided by the ratio. Blank: output.",
        type="choice",
        choices=("output", "input"),
        default="output",
        group="Drive",
    ),
    _source(
        "requirement",
        "ratio",
        "Ratio",
        "Reduction ratio of the drive: turns of the input for one of the output. Only for an input side.",
        minimum=1,
        usual=(5, 1000),
        group="Drive",
        also_called="reduction reductionratio gearratio übersetzung untersetzung rapport rapporto i",
    ),
    _source(
        "requirement",
        "kind",
        "Kind",
        "systematic: the value adds, and its deviations combine. random: only its deviations combine. Blank: "
        "systematic.",
        type="choice",
        choices=("systematic", "random"),
        default="systematic",
        group="Drive",
    ),
)

LEVERS = (
    _lever(
        "identity",
        "dimension",
        "Dimension",
        "What may change or not: a dimension of Variants, or material. What has no row here changes by the built-in "
        "defaults.",
        type="choice",
        choices=(*_SIZES, MATERIAL),
        required=True,
        group="Lever",
    ),
    _lever(
        "requirement",
        "may_change",
        "May change",
        "Whether the drawing may have another value. Blank: yes, but no for the torque.",
        type="choice",
        choices=("yes", "no"),
        group="Lever",
    ),
    _lever(
        "requirement",
        "lowest",
        "Lowest",
        "Least value that is still possible, in the unit of the dimension. Blank: no bound but the shape's.",
        group="Range",
    ),
    _lever(
        "requirement",
        "highest",
        "Highest",
        "Greatest value that is still possible, in the unit of the dimension.",
        group="Range",
    ),
    _lever(
        "requirement",
        "step",
        "Drawing step",
        "The drawing's values are multiples of it, in the unit of the dimension. Blank: 0.5 mm for lengths and radii, "
        "0.01 mm for thicknesses and fillets, 0.5 for angles, 0.05 for an exponent.",
        **POSITIVE,
        group="Range",
    ),
    _lever(
        "requirement",
        "cost_per_step",
        "Cost per step",
        "Relative cost of one step of the value, in any currency; for material that of the change. Blank: 1.",
        minimum=0,
        default=1,
        group="Cost",
    ),
    _lever(
        "requirement",
        "tolerance_may_change",
        "Tolerance may change",
        "Whether the drawing may have another tolerance for it. Blank: yes.",
        type="choice",
        choices=("yes", "no"),
        group="Tolerance",
    ),
    _lever(
        "requirement",
        "cost_per_grade",
        "Cost per IT grade",
        "Relative cost of a tolerance one IT grade finer (narrower by a factor of 10^(1/5)). Blank: 1.",
        minimum=0,
        default=1,
        group="Tolerance",
    ),
)

SWEEP = (
    _sweep(
        "identity",
        "variant",
        "Variant",
        "A variant of the sheet Variants. Blank: every variant.",
        type="text",
        group="Sweep",
    ),
    _sweep(
        "requirement",
        "dimension",
        "Dimension",
        "The dimension of Variants that is swept.",
        type="choice",
        choices=_SIZES,
        required=True,
        group="Sweep",
    ),
    _sweep(
        "requirement",
        "from",
        "From",
        "First value, in the unit of the dimension's column.",
        required=True,
        group="Sweep",
    ),
    _sweep("requirement", "to", "To", "Last value; the last step ends there at most.", required=True, group="Sweep"),
    _sweep("requirement", "step", "Step", "From one value to the next.", **POSITIVE, required=True, group="Sweep"),
    _sweep(
        "requirement",
        "second_dimension",
        "Second dimension",
        "Another dimension that is swept with it: every combination of values is computed.",
        type="choice",
        choices=_SIZES,
        group="Second",
    ),
    _sweep("requirement", "second_from", "Second from", "First value of the second dimension.", group="Second"),
    _sweep("requirement", "second_to", "Second to", "Last value of the second dimension.", group="Second"),
    _sweep("requirement", "second_step", "Second step", "From one value to the next.", **POSITIVE, group="Second"),
)
