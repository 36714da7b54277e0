"""The fields of Tolerances, Measurements and Correlations: how dimensions scatter, alone and together.

What is usual: limits at one to twelve standard deviations.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from flexlash.schema.column import POSITIVE, Column
from flexlash.schema.dimension_columns import DIMENSIONS
from flexlash.schema.variant_columns import VARIANTS

__all__ = ["CORRELATIONS", "MEASUREMENTS", "TOLERANCES"]

_FIRST = 4
"""Template version that brought the optional sheets."""

_tolerance: Callable[..., Column] = partial(Column.entry, "Tolerances")
_measurement: Callable[..., Column] = partial(Column.entry, "Measurements", since=_FIRST)
_correlation: Callable[..., Column] = partial(Column.entry, "Correlations", since=_FIRST)

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
        "With its sign: smallest part minus entered value, such as -0.02. One number in a cell.",
        also_called="lower unteresabmaß unteresabmass untereabweichung lowertolerance minus",
        group="Drawing",
    ),
    _tolerance(
        "requirement",
        "upper_deviation",
        "Upper deviation",
        "With its sign: largest part minus entered value, such as 0.01.",
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
        "Normal distributions: how far the mean of the process lies above the middle of the limits, signed, in the "
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
            since=max(_FIRST, column.since),
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
        "From -1 to 1: 0 where neither tells of the other, 1 where large comes with large, -1 where large comes with "
        "small. Of the normal scores.",
        required=True,
        minimum=-1,
        maximum=1,
    ),
    _correlation(
        "remark", "reason", "Reason", "Why they scatter together: cut in one set-up, for example.", type="text"
    ),
)
