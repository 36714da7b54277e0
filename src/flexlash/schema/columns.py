"""The one truth about every field that is entered: what it is called, measured in, allowed to hold, good for.

Template, validation, data dictionary, report and the README's tables all derive from these records; the
fields of Variants are in `variant_columns`, those of the report in `result_columns`. What is usual: foam rubber to
osmium, limits at one to twelve standard deviations, makers' lost motion at 3 to 4 % of the rated torque. Fillets, rims
and other refinements lower a wind-up by less than a half; play under the teeth raises it to at most 2.3 times, which
bounds a calibration.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache, partial
from types import MappingProxyType

from flexlash.schema.column import FACTOR, PERCENT, POSITIVE, STRESS, Column
from flexlash.schema.variant_columns import VARIANTS

__all__ = [
    "CORRELATIONS",
    "DIMENSIONS",
    "ENTRY_SHEETS",
    "LOT_DIMENSIONS",
    "MATERIALS",
    "MEASUREMENTS",
    "OPTIONAL_SHEETS",
    "SETTINGS",
    "SETTINGS_SHEET",
    "TOLERANCES",
    "VARIANTS",
    "Column",
    "columns_of",
    "naming_column",
]

_material: Callable[..., Column] = partial(Column.entry, "Materials")
_tolerance: Callable[..., Column] = partial(Column.entry, "Tolerances")
_setting: Callable[..., Column] = partial(Column.entry, "Settings")
_measurement: Callable[..., Column] = partial(Column.entry, "Measurements", since=4)
_correlation: Callable[..., Column] = partial(Column.entry, "Correlations", since=4)

MATERIALS = (
    _material(
        "identity",
        "material",
        "Material",
        "Name that the Variants sheet refers to, used once.",
        type="text",
        required=True,
        also_called="werkstoff matériau materiau matière materiale steel steelgrade stahl",
    ),
    _material(
        "dimension",
        "youngs_modulus_GPa",
        "Young's modulus E [GPa]",
        "Gives the shear modulus E/(2(1 + ν)) together with Poisson's ratio.",
        **STRESS,
        usual=(0.001, 1500),
        also_called="emodul elastizitätsmodul elasticmodulus youngmodulus modulusofelasticity e",
    ),
    _material(
        "dimension",
        "poisson_ratio",
        "Poisson's ratio ν [-]",
        "Gives the shear modulus together with Young's modulus.",
        quantity="ratio",
        minimum=0,
        maximum=0.5,
        usual=(0.1, 0.5),
        also_called="querkontraktionszahl poissonzahl poisson nu ν",
    ),
    _material(
        "dimension",
        "shear_modulus_GPa",
        "Shear modulus G [GPa]",
        "Optional. When given it is used instead of E and ν, and their tolerances do not apply.",
        **STRESS,
        usual=(0.0003, 600),
        also_called="schubmodul gmodul modulusofrigidity g",
    ),
    _material(
        "requirement",
        "density_kg_m3",
        "Density [kg/m³]",
        "Optional; carried to the report.",
        quantity="density",
        **POSITIVE,
        usual=(10, 25000),
    ),
    _material(
        "requirement",
        "yield_MPa",
        "Yield strength [MPa]",
        "Optional. A von Mises stress above it is flagged.",
        **STRESS,
        usual=(1, 10000),
        also_called="streckgrenze yieldstress yield rp02 re",
    ),
    _material("remark", "source", "Source", "Where the values come from; carried to the report.", type="text"),
)

SETTINGS = (
    _setting(
        "requirement",
        "seed",
        "seed",
        "Start of the random numbers. The same seed gives the same report.",
        type="integer",
        minimum=0,
        maximum=2**32 - 1,
        default=0,
    ),
    _setting(
        "requirement",
        "coverage_percent",
        "coverage_percent",
        "Share of units inside the coverage interval of the report.",
        **PERCENT | {"minimum": 50, "exclusive_minimum": False},
        maximum=99.99,
        default=95,
    ),
    _setting(
        "requirement",
        "method",
        "method",
        "How the spread is sampled: line (sharp in the tails), sobol, or random (plain Monte Carlo).",
        type="choice",
        choices=("line", "sobol", "random"),
        default="line",
    ),
    _setting(
        "requirement",
        "samples",
        "samples",
        "Lines or points per variant. Blank: as many lines as the precision needs.",
        type="integer",
        minimum=1,
        maximum=2**22,
    ),
    _setting(
        "requirement",
        "lost_motion_percent",
        "lost_motion_percent",
        "Share of the rated torque at which lost motion is stated, of the flexspline alone and of a catalogue drive.",
        **PERCENT | {"minimum": 0.1, "exclusive_minimum": False},
        maximum=100,
        default=4,
        usual=(1, 10),
    ),
    _setting(
        "dimension",
        "cylinder_calibration",
        "cylinder_calibration",
        "Factor on the cylinder wind-up, from your own tests or FEA; 1 changes nothing.",
        **FACTOR,
        usual=(0.5, 2.5),
    ),
    _setting(
        "dimension",
        "disk_calibration",
        "disk_calibration",
        "Factor on the disk wind-up, from your own tests or FEA; 1 changes nothing.",
        **FACTOR,
        usual=(0.5, 2.5),
    ),
    _setting(
        "requirement",
        "acceptable_ppm",
        "acceptable_ppm",
        "Units of one lot over the limit, per million, above which the whole lot counts as failing.",
        **POSITIVE,
        maximum=999_999,
        default=1350,
        usual=(1, 100_000),
        since=4,
    ),
)

DIMENSIONS: dict[str, Column] = {
    column.dimension: column for column in (*VARIANTS, *MATERIALS, *SETTINGS) if column.role == "dimension"
}
"""Every dimension that may have a tolerance, with the column its nominal value stands in."""

LOT_DIMENSIONS = frozenset(name for name, column in DIMENSIONS.items() if column.sheet != "Variants")
"""Dimensions that are one value for a whole lot of parts unless Tolerances says otherwise: elastic constants, which a
heat of steel shares, and calibrations, which are one unknown number."""

TOLERANCES = (
    _tolerance(
        "identity",
        "tolerance_class",
        "Tolerance class",
        "Name that the Variants sheet refers to; one row per class and dimension.",
        type="text",
        required=True,
        also_called="toleranzklasse classedetolérance tolclass",
        group="Class",
    ),
    _tolerance(
        "identity",
        "dimension",
        "Dimension",
        "The dimension that varies. A dimension without a row is exact. Blank only beside Based on class.",
        type="choice",
        choices=tuple(DIMENSIONS),
        group="Class",
        instead="based_on",
    ),
    _tolerance(
        "requirement",
        "lower_deviation",
        "Lower deviation",
        "Signed: what the smallest part differs from the entered value. Numbers only, one per cell.",
        also_called="lower unteresabmaß unteresabmass untereabweichung lowertolerance minus",
        group="Drawing",
    ),
    _tolerance(
        "requirement",
        "upper_deviation",
        "Upper deviation",
        "Signed: what the largest part differs from the entered value.",
        also_called="upper oberesabmaß oberesabmass obereabweichung uppertolerance plus",
        group="Drawing",
    ),
    _tolerance(
        "requirement",
        "deviation_unit",
        "Deviation unit",
        "Unit of both deviations: a length unit, % of the entered value, or the dimension's own (N·m, GPa, -). "
        "Blank: the dimension's own.",
        type="text",
        group="Drawing",
    ),
    _tolerance(
        "requirement",
        "grade",
        "Grade",
        "Instead of deviations: IT5…IT12 or js5…js12 (± half), h5…h12 (minus), H5…H12 (plus), 2768-f, 2768-m, "
        "2768-c, 2768-v. On a radius: the grade of its diameter, halved.",
        type="text",
        group="Drawing",
    ),
    _tolerance(
        "requirement",
        "distribution",
        "Distribution",
        "How parts scatter between the limits. Blank means normal.",
        type="choice",
        choices=("normal", "truncated normal", "uniform", "triangular", "measured"),
        default="normal",
        group="Scatter",
    ),
    _tolerance(
        "requirement",
        "limits_sigma",
        "Limits at ± sigma",
        "Normal distributions: the limits lie this many standard deviations from the middle. Blank: 3.",
        minimum=0.5,
        maximum=100,
        default=3,
        usual=(1, 12),
        group="Scatter",
    ),
    _tolerance(
        "requirement",
        "mean_shift",
        "Mean shift",
        "Normal distributions: what the mean of the process lies above the middle of the limits, signed, in the "
        "deviation unit.",
        since=4,
        group="Process",
        also_called="shift meanoffset mittelwertverschiebung mittenabweichung décalage",
    ),
    _tolerance(
        "requirement",
        "standard_deviation",
        "Standard deviation",
        "Normal distributions: that of the process, in the deviation unit, instead of Limits at ± sigma.",
        **POSITIVE,
        since=4,
        group="Process",
        also_called="sd s stdev stddev standardabweichung écarttype scartotipo sigma",
    ),
    _tolerance(
        "requirement",
        "cp",
        "Cp",
        "Normal distributions: width of the limits over six standard deviations, instead of Limits at ± sigma.",
        **POSITIVE,
        maximum=100,
        usual=(0.3, 4),
        since=4,
        group="Process",
    ),
    _tolerance(
        "requirement",
        "cpk",
        "Cpk",
        "Beside Cp: the mean lies (Cp − Cpk) · 3 standard deviations off the middle of the limits, to the side that "
        "raises the backlash unless a mean shift is given.",
        maximum=100,
        usual=(0, 4),
        since=4,
        group="Process",
    ),
    _tolerance(
        "identity",
        "sample",
        "Sample",
        "Name of a sample of Measurements: mean and standard deviation are those of its values.",
        type="text",
        since=4,
        group="Process",
        also_called="stichprobe messreihe échantillon campione",
    ),
    _tolerance(
        "requirement",
        "scatters_between",
        "Scatters between",
        "parts: every part has a value of its own. lots: one value for a whole lot. Blank: lots for elastic constants "
        "and calibrations, else parts.",
        type="choice",
        choices=("parts", "lots"),
        since=4,
        group="Process",
    ),
    _tolerance(
        "identity",
        "based_on",
        "Based on class",
        "In a row without a dimension: the class takes over every row of this class that it does not have itself.",
        type="text",
        since=4,
        group="Inheritance",
        also_called="basedon base basis basisklasse baseclass parentclass inherits",
    ),
)

MEASUREMENTS = (
    _measurement(
        "identity",
        "sample",
        "Sample",
        "Name that the Tolerances sheet refers to; one row for each measured part.",
        type="text",
        required=True,
    ),
    _measurement("identity", "part", "Part", "Number or name of the measured part.", type="text"),
    _measurement(
        "requirement",
        "use_as",
        "Use as",
        "value: the measured values themselves. deviation: what was measured above the entered value.",
        type="choice",
        choices=("value", "deviation"),
        default="value",
    ),
    *(
        Column(
            sheet="Measurements",
            role="requirement",
            key=column.key,
            label=column.label,
            help=f"{column.plain_name} of each measured part; blank where it was not measured.",
            unit=column.unit,
            quantity=column.quantity,
            since=4,
            also_called=column.also_called,
        )
        for column in VARIANTS
        if column.role == "dimension"
    ),
)

CORRELATIONS = (
    _correlation(
        "identity",
        "tolerance_class",
        "Tolerance class",
        "The class whose dimensions scatter together; one row per pair.",
        type="text",
        required=True,
    ),
    *(
        _correlation(
            "identity",
            f"dimension_{number}",
            f"Dimension {number}",
            f"The {which} dimension of the pair.",
            type="choice",
            required=True,
            choices=tuple(DIMENSIONS),
        )
        for number, which in ((1, "first"), (2, "second"))
    ),
    _correlation(
        "requirement",
        "correlation",
        "Correlation",
        "From -1 to 1, of the normal scores: 0 is independent, 1 is large with large.",
        required=True,
        minimum=-1,
        maximum=1,
    ),
    _correlation(
        "remark", "reason", "Reason", "Why they scatter together: cut in one set-up, for example.", type="text"
    ),
)

SETTINGS_SHEET = (
    _setting(
        "identity",
        "setting",
        "Setting",
        "Name of the setting.",
        type="choice",
        required=True,
        choices=tuple(column.key for column in SETTINGS),
    ),
    _setting("requirement", "value", "Value", "Its value. Blank: the default.", type="text"),
)

ENTRY_SHEETS = {
    "Variants": VARIANTS,
    "Materials": MATERIALS,
    "Tolerances": TOLERANCES,
    "Settings": SETTINGS_SHEET,
    "Measurements": MEASUREMENTS,
    "Correlations": CORRELATIONS,
}

OPTIONAL_SHEETS = ("Measurements", "Correlations")
"""Entry sheets that a template has only where they are asked for."""


@cache
def columns_of(sheet: str) -> Mapping[str, Column]:
    """Return the columns of an entry sheet by key."""
    return MappingProxyType({column.key: column for column in ENTRY_SHEETS[sheet]})


def naming_column(sheet: str) -> Column:
    """Return the column of an entry sheet that names its rows: the first that says which they are."""
    return next(column for column in ENTRY_SHEETS[sheet] if column.role == "identity")
