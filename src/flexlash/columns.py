"""The one truth about every field: what it is called, measured in, allowed to hold and good for.

Template, validation, data dictionary, report headings and the README's tables all derive from the
`Column` records here and in `result_columns`.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any, Literal

from flexlash.units import Unit, find_unit

__all__ = [
    "DIMENSIONS",
    "ENTRY_SHEETS",
    "MATERIALS",
    "SETTINGS",
    "SETTINGS_SHEET",
    "TOLERANCES",
    "VARIANTS",
    "Column",
    "columns_of",
    "is_symbol",
]


@dataclass(frozen=True, kw_only=True)
class Column:
    """One field of one sheet; bounds are in the printed unit."""

    sheet: str
    key: str
    label: str
    help: str
    type: Literal["number", "integer", "text", "choice"] = "number"
    unit: str = ""
    quantity: str = ""
    required: bool = False
    minimum: float | None = None
    exclusive_minimum: bool = False
    maximum: float | None = None
    choices: tuple[str, ...] = ()
    default: str | float | None = None
    group: str = ""

    @cached_property
    def name(self) -> str:
        """The label without its unit, as a sentence names it."""
        return self.label.split(" [")[0]

    @cached_property
    def plain_name(self) -> str:
        """The label without unit and symbol: `Cylinder length`."""
        return " ".join(word for word in self.name.split(" ") if not is_symbol(word)) or self.name

    @cached_property
    def dimension(self) -> str:
        """The key without its unit, as Tolerances and the report name a dimension."""
        stem, _, last = self.key.rpartition("_")
        return stem if self.unit and stem and find_unit(last, self.quantity) else self.key

    @cached_property
    def si_unit(self) -> Unit:
        """The unit the field is measured in."""
        unit = find_unit(self.unit, self.quantity)
        if unit is None:
            raise LookupError(f"{self.sheet}.{self.key} has no unit")
        return unit

    @property
    def is_number(self) -> bool:
        """Whether the field holds numbers."""
        return self.type in {"number", "integer"}

    @property
    def requirement(self) -> str:
        """What a cell must hold, in words: `a number in mm greater than 0`."""
        if self.choices:
            return "one of " + ", ".join(self.choices)
        if not self.is_number:
            return "a text"
        words = "a whole number" if self.type == "integer" else "a number"
        if self.unit not in {"", "-"}:
            words += f" in {self.unit}"
        if self.minimum is not None:
            words += f" {'greater than' if self.exclusive_minimum else 'of at least'} {self.minimum:.15g}"
        if self.maximum is not None:
            words += f"{' and' if self.minimum is not None else ''} at most {self.maximum:.15g}"
        return words

    def as_dictionary(self) -> dict[str, Any]:
        """Return the entry of `flexlash schema --json`."""
        entry = asdict(self)
        entry["choices"] = list(self.choices)
        order = ("sheet", "key", "label", "unit", "type", "required", "minimum", "maximum")
        return {key: entry[key] for key in (*order, "choices", "default", "help", "exclusive_minimum", "group")}


def is_symbol(word: str) -> bool:
    """Whether a word of a label is its symbol, such as Δ or r_ci."""
    return len(word) == 1 or word.startswith("r_")


def _length(key: str, label: str, text: str, **rest: Any) -> Column:
    """Return a Variants length in mm; lengths are greater than 0 unless told otherwise."""
    settings: dict[str, Any] = {"minimum": 0, "exclusive_minimum": True, "group": "Cylinder"} | rest
    return Column(
        sheet="Variants",
        key=f"{key}_mm",
        label=f"{label} [mm]",
        help=text,
        unit="mm",
        quantity="length",
        **settings,
    )


VARIANTS = (
    Column(
        sheet="Variants",
        key="variant",
        label="Variant",
        type="text",
        required=True,
        group="Variant",
        help="Name of the variant, used once. The report names each row by it.",
    ),
    Column(
        sheet="Variants",
        key="flexspline_type",
        label="Flexspline type",
        type="choice",
        choices=("cup", "hat", "cylinder"),
        default="cup",
        group="Variant",
        help="cup: disk inwards to the hub. hat: flange outwards to the bolt circle. cylinder: pin, tooth "
        "or jaw connection, no disk. Blank means cup.",
    ),
    Column(
        sheet="Variants",
        key="material",
        label="Material",
        type="text",
        required=True,
        group="Variant",
        help="A material of the Materials sheet. Add a row there for your own.",
    ),
    Column(
        sheet="Variants",
        key="torque_Nm",
        label="Torque T [N·m]",
        unit="N·m",
        quantity="torque",
        required=True,
        minimum=0,
        exclusive_minimum=True,
        group="Load",
        help="Output torque at which the wind-up is wanted. The backlash is the lag when it reverses.",
    ),
    _length(
        "cylinder_length",
        "Cylinder length l",
        "Inside depth: from the inner face of the disk to the open end, tooth rim included.",
        required=True,
    ),
    _length(
        "mean_radius",
        "Mean radius r_m",
        "Radius of the middle of the wall. Give this or the bore diameter, not both.",
    ),
    _length(
        "bore_diameter",
        "Bore diameter",
        "Inside diameter of the wall. The mean radius is then bore/2 + wall/2 and follows both tolerances.",
    ),
    _length("wall_thickness", "Wall thickness Δ", "Thickness of the cylinder wall.", required=True),
    _length(
        "disk_thickness",
        "Disk thickness",
        "Thickness of the disk or flange. Blank: the same as the wall, cut in one pass, one tolerance for both.",
        group="Disk",
    ),
    _length(
        "disk_inner_radius",
        "Disk inner radius r_ci",
        "Cup: radius of the hub, where the disk is clamped; required. Hat: blank means the mean radius.",
        group="Disk",
    ),
    _length(
        "disk_outer_radius",
        "Disk outer radius r_co",
        "Cup: blank means the mean radius, as it should be. Hat: radius of the bolt circle; required.",
        group="Disk",
    ),
    _length(
        "disk_hub_thickness",
        "Disk thickness at hub",
        "Cup only. Disk that thins in a straight line from here to the disk thickness at its rim. Blank: even.",
        group="Refinements",
    ),
    _length(
        "hub_fillet_radius",
        "Hub fillet radius",
        "Cup only. Fillet between hub and inner face of the disk. Blank or 0: sharp corner.",
        exclusive_minimum=False,
        group="Refinements",
    ),
    _length(
        "junction_fillet_radius",
        "Junction fillet radius",
        "Cup only. Fillet inside the corner of disk and wall. Blank or 0: sharp corner.",
        exclusive_minimum=False,
        group="Refinements",
    ),
    _length(
        "rim_length",
        "Tooth rim length",
        "Length of the thicker toothed rim at the open end. Give length and thickness, or neither.",
        group="Refinements",
    ),
    _length(
        "rim_thickness",
        "Tooth rim thickness",
        "Total thickness of the rim over the same bore, teeth counted to their root or pitch circle.",
        group="Refinements",
    ),
    Column(
        sheet="Variants",
        key="rated_torque_Nm",
        label="Rated torque [N·m]",
        unit="N·m",
        quantity="torque",
        minimum=0,
        exclusive_minimum=True,
        group="Requirements",
        help="Gives the lost motion at a few per cent of this torque (Settings: lost_motion_percent).",
    ),
    Column(
        sheet="Variants",
        key="backlash_limit_arcmin",
        label="Backlash limit [arcmin]",
        unit="arcmin",
        quantity="angle",
        minimum=0,
        exclusive_minimum=True,
        group="Requirements",
        help="Greatest backlash allowed. Gives probability over limit, ppm and Ppk.",
    ),
    Column(
        sheet="Variants",
        key="tolerance_class",
        label="Tolerance class",
        type="text",
        default="standard",
        group="Requirements",
        help="A class of the Tolerances sheet. Blank means standard.",
    ),
    Column(
        sheet="Variants",
        key="notes",
        label="Notes",
        type="text",
        group="Requirements",
        help="Free text; carried to the report.",
    ),
)

MATERIALS = (
    Column(
        sheet="Materials",
        key="material",
        label="Material",
        type="text",
        required=True,
        help="Name that the Variants sheet refers to, used once.",
    ),
    Column(
        sheet="Materials",
        key="youngs_modulus_GPa",
        label="Young's modulus E [GPa]",
        unit="GPa",
        quantity="stress",
        minimum=0,
        exclusive_minimum=True,
        help="Gives the shear modulus E/(2(1 + ν)) together with Poisson's ratio.",
    ),
    Column(
        sheet="Materials",
        key="poisson_ratio",
        label="Poisson's ratio ν [-]",
        unit="-",
        quantity="ratio",
        minimum=0,
        maximum=0.5,
        help="Gives the shear modulus together with Young's modulus.",
    ),
    Column(
        sheet="Materials",
        key="shear_modulus_GPa",
        label="Shear modulus G [GPa]",
        unit="GPa",
        quantity="stress",
        minimum=0,
        exclusive_minimum=True,
        help="Optional. When given it is used instead of E and ν, and their tolerances do not apply.",
    ),
    Column(
        sheet="Materials",
        key="density_kg_m3",
        label="Density [kg/m³]",
        unit="kg/m³",
        quantity="density",
        minimum=0,
        exclusive_minimum=True,
        help="Optional; carried to the report.",
    ),
    Column(
        sheet="Materials",
        key="yield_MPa",
        label="Yield strength [MPa]",
        unit="MPa",
        quantity="stress",
        minimum=0,
        exclusive_minimum=True,
        help="Optional. A von Mises stress above it is flagged.",
    ),
    Column(
        sheet="Materials",
        key="source",
        label="Source",
        type="text",
        help="Where the values come from; carried to the report.",
    ),
)

SETTINGS = (
    Column(
        sheet="Settings",
        key="seed",
        label="seed",
        type="integer",
        minimum=0,
        maximum=2**32 - 1,
        default=0,
        help="Start of the random numbers. The same seed gives the same report.",
    ),
    Column(
        sheet="Settings",
        key="coverage_percent",
        label="coverage_percent",
        unit="%",
        quantity="ratio",
        minimum=0,
        exclusive_minimum=True,
        maximum=99.99,
        default=95,
        help="Share of units inside the coverage interval of the report.",
    ),
    Column(
        sheet="Settings",
        key="method",
        label="method",
        type="choice",
        choices=("line", "sobol", "random"),
        default="line",
        help="How the tolerance spread is sampled: line (best), sobol, or random (plain Monte Carlo).",
    ),
    Column(
        sheet="Settings",
        key="samples",
        label="samples",
        type="integer",
        minimum=1,
        maximum=2**22,
        help="Points per variant. Blank: chosen by the program.",
    ),
    Column(
        sheet="Settings",
        key="lost_motion_percent",
        label="lost_motion_percent",
        unit="%",
        quantity="ratio",
        minimum=0,
        exclusive_minimum=True,
        maximum=100,
        default=4,
        help="Share of the rated torque at which lost motion is stated.",
    ),
    Column(
        sheet="Settings",
        key="cylinder_calibration",
        label="cylinder_calibration",
        unit="-",
        quantity="ratio",
        minimum=0,
        exclusive_minimum=True,
        maximum=10,
        default=1,
        help="Factor on the cylinder wind-up, from your own tests or FEA; 1 changes nothing.",
    ),
    Column(
        sheet="Settings",
        key="disk_calibration",
        label="disk_calibration",
        unit="-",
        quantity="ratio",
        minimum=0,
        exclusive_minimum=True,
        maximum=10,
        default=1,
        help="Factor on the disk wind-up, from your own tests or FEA; 1 changes nothing.",
    ),
)

_SOURCES = {
    **{
        column.dimension: column
        for column in VARIANTS
        if column.is_number and column.dimension not in {"rated_torque", "backlash_limit"}
    },
    **{column.dimension: column for column in MATERIALS[1:4]},
    **{column.key: column for column in SETTINGS if column.key.endswith("calibration")},
}
DIMENSIONS: dict[str, Column] = _SOURCES
"""Every dimension that may have a tolerance, with the column its nominal value stands in."""

TOLERANCES = (
    Column(
        sheet="Tolerances",
        key="tolerance_class",
        label="Tolerance class",
        type="text",
        required=True,
        help="Name that the Variants sheet refers to; one row per class and dimension.",
    ),
    Column(
        sheet="Tolerances",
        key="dimension",
        label="Dimension",
        type="choice",
        required=True,
        choices=tuple(DIMENSIONS),
        help="The dimension that varies. A dimension without a row is exact.",
    ),
    Column(
        sheet="Tolerances",
        key="lower_deviation",
        label="Lower deviation",
        help="Signed: what the smallest part differs from the entered value. Numbers only, one per cell.",
    ),
    Column(
        sheet="Tolerances",
        key="upper_deviation",
        label="Upper deviation",
        help="Signed: what the largest part differs from the entered value.",
    ),
    Column(
        sheet="Tolerances",
        key="deviation_unit",
        label="Deviation unit",
        type="text",
        help="Unit of both deviations: a length unit, % of the entered value, or the dimension's own "
        "(N·m, GPa, -). Blank: the dimension's own.",
    ),
    Column(
        sheet="Tolerances",
        key="grade",
        label="Grade",
        type="text",
        help="Instead of deviations: IT5…IT12 or js5…js12 (± half), h5…h12 (minus), H5…H12 (plus), "
        "2768-f, 2768-m, 2768-c, 2768-v. On a radius: the grade of its diameter, halved.",
    ),
    Column(
        sheet="Tolerances",
        key="distribution",
        label="Distribution",
        type="choice",
        choices=("normal", "truncated normal", "uniform", "triangular"),
        default="normal",
        help="How parts scatter between the limits. Blank means normal.",
    ),
    Column(
        sheet="Tolerances",
        key="limits_sigma",
        label="Limits at ± sigma",
        minimum=0,
        exclusive_minimum=True,
        maximum=100,
        default=3,
        help="Normal distributions: the limits lie this many standard deviations from the middle. Blank: 3.",
    ),
)

SETTINGS_SHEET = (
    Column(
        sheet="Settings",
        key="setting",
        label="Setting",
        type="choice",
        required=True,
        choices=tuple(column.key for column in SETTINGS),
        help="Name of the setting.",
    ),
    Column(sheet="Settings", key="value", label="Value", type="text", help="Its value. Blank: the default."),
)

ENTRY_SHEETS = {
    "Variants": VARIANTS,
    "Materials": MATERIALS,
    "Tolerances": TOLERANCES,
    "Settings": SETTINGS_SHEET,
}


def columns_of(sheet: str) -> dict[str, Column]:
    """Return the columns of an entry sheet by key."""
    return {column.key: column for column in ENTRY_SHEETS[sheet]}
