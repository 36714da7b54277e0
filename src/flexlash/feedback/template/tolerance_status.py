"""What the status of a row of Tolerances and of Correlations says."""

from __future__ import annotations

from collections.abc import Sequence

from flexlash.feedback.template.status_rules import (
    Known,
    Row,
    Rule,
    Stage,
    count_formula,
    entry_number,
    entry_text,
    given,
    is_blank,
    missing,
    no_number,
    not_in_list,
    twice,
    unknown,
    unlisted,
)
from flexlash.schema.columns import CORRELATIONS, DIMENSIONS, TOLERANCES, Column
from flexlash.schema.entry_words import inner_name
from flexlash.schema.tolerance_grades import is_grade

__all__ = ["CORRELATION_STATUS", "GRADED", "tolerance_status"]

GRADED = tuple(name for name, column in DIMENSIONS.items() if column.quantity == "length" and column.grade_at != "none")
"""Dimensions that a tolerance grade applies to."""

_COLUMNS = {column.key: column for column in TOLERANCES}
_DEVIATIONS = ("lower_deviation", "upper_deviation")
_SPREADS = ("limits_sigma", "standard_deviation", "cp", "sample")
_OF_A_PROCESS = ("mean_shift", "standard_deviation", "cp", "cpk", "sample")
_BESIDE_BASE = tuple(key for key in _COLUMNS if key not in {"tolerance_class", "dimension", "based_on"})
_NO_NORMAL = ("uniform", "triangular")
_NO_CLASS = "tolerance class not in Tolerances"


def _is_no_normal(row: Row) -> bool:
    """Whether the distribution has no mean and standard deviation of its own."""
    return entry_text(row, "distribution").strip() in _NO_NORMAL


def _has_two_bases(row: Row, known: Known) -> bool:
    """Whether a row and another of its class name what the class is based on: rows without a dimension."""
    return (
        given(row, "based_on") == 1 and known["tolerance_class,dimension"][entry_text(row, "tolerance_class"), ""] > 1
    )


def _other_deviation(key: str) -> Rule:
    """Return the rule that a deviation does not stand alone."""
    return Rule(
        text=f"{inner_name(_COLUMNS[key])} missing",
        excel=f'AND({{{key}}}="",{count_formula(*_DEVIATIONS)}=1)',
        holds=lambda row, _: is_blank(row.get(key)) and given(row, *_DEVIATIONS) == 1,
    )


_ENTRIES = (
    missing(_COLUMNS["tolerance_class"]),
    Rule(
        text="dimension missing",
        excel='AND({dimension}="",{based_on}="")',
        holds=lambda row, _: not given(row, "dimension", "based_on"),
    ),
    not_in_list(_COLUMNS["dimension"], "fl_dimensions"),
    *(unlisted(column) for column in TOLERANCES if column.choices and column.key != "dimension"),
    *(no_number(column) for column in TOLERANCES if column.is_number),
)
_BASE = (
    Rule(
        text="based on class needs a row without a dimension",
        excel='AND({based_on}<>"",{dimension}<>"")',
        holds=lambda row, _: given(row, "based_on", "dimension") == 2,  # noqa: PLR2004
    ),
    Rule(
        text="based on class stands alone: nothing else in its row",
        excel=f'AND({{based_on}}<>"",{count_formula(*_BESIDE_BASE)}>0)',
        holds=lambda row, _: given(row, "based_on") == 1 and given(row, *_BESIDE_BASE) > 0,
    ),
    Rule(
        text="a class based on itself",
        excel='AND({based_on}<>"",{based_on}={tolerance_class})',
        holds=lambda row, _: (
            given(row, "based_on") == 1 and entry_text(row, "based_on") == entry_text(row, "tolerance_class")
        ),
    ),
    unknown("based_on", "based on class not in Tolerances", "fl_tolerance_rows", "standard"),
    Rule(
        text="class is based on another twice",
        excel='AND({based_on}<>"",COUNTIFS({tolerance_class_block},{tolerance_class},{dimension_block},"")>1)',
        holds=_has_two_bases,
        together=("tolerance_class", "dimension"),
    ),
)
_DRAWING = (
    Rule(
        text="grade is not in its list",
        excel='AND({grade}<>"",SUMPRODUCT(--EXACT(fl_grades,SUBSTITUTE(TRIM({grade}),"JS","js")))=0)',
        holds=lambda row, _: given(row, "grade") == 1 and not is_grade(str(row["grade"]).strip()),
    ),
    Rule(
        text="a grade for a dimension that has none",
        excel='AND({grade}<>"",COUNTIF(fl_graded_dimensions,TRIM({dimension}))=0)',
        holds=lambda row, _: given(row, "grade") == 1 and entry_text(row, "dimension").strip() not in GRADED,
    ),
    Rule(
        text="grade and deviations are both given",
        excel=f'AND({{grade}}<>"",{count_formula(*_DEVIATIONS)}>0)',
        holds=lambda row, _: given(row, "grade") == 1 and given(row, *_DEVIATIONS) > 0,
    ),
    Rule(
        text="neither grade nor deviations are given",
        excel=f'AND({{dimension}}<>"",{{grade}}="",{count_formula(*_DEVIATIONS)}=0)',
        holds=lambda row, _: given(row, "dimension") == 1 and not given(row, "grade", *_DEVIATIONS),
    ),
    *(_other_deviation(key) for key in _DEVIATIONS),
    Rule(
        text="lower deviation is above upper deviation",
        excel="{lower_deviation}>{upper_deviation}",
        holds=lambda row, _: entry_number(row, "lower_deviation") > entry_number(row, "upper_deviation"),
    ),
)
_PROCESS = (
    Rule(
        text="only one of limits at ± sigma, standard deviation, Cp and sample counts",
        excel=f"{count_formula(*_SPREADS)}>1",
        holds=lambda row, _: given(row, *_SPREADS) > 1,
    ),
    Rule(
        text="Cpk without Cp",
        excel='AND({cpk}<>"",{cp}="")',
        holds=lambda row, _: given(row, "cpk") == 1 and not given(row, "cp"),
    ),
    Rule(
        text="Cpk is above Cp",
        excel='AND({cpk}<>"",{cpk}>{cp})',
        holds=lambda row, _: given(row, "cpk") == 1 and entry_number(row, "cpk") > entry_number(row, "cp"),
    ),
    Rule(
        text="a uniform or triangular distribution has no process of its own",
        excel=f'AND(OR(TRIM({{distribution}})="uniform",TRIM({{distribution}})="triangular"),{count_formula(*_OF_A_PROCESS)}>0)',
        holds=lambda row, _: _is_no_normal(row) and given(row, *_OF_A_PROCESS) > 0,
    ),
    Rule(
        text="both deviations are equal: no process scatters between them",
        excel=f'AND({{lower_deviation}}<>"",{{lower_deviation}}={{upper_deviation}},{count_formula(*_OF_A_PROCESS)}>0)',
        holds=lambda row, _: (
            given(row, *_DEVIATIONS) == 2  # noqa: PLR2004
            and row["lower_deviation"] == row["upper_deviation"]
            and given(row, *_OF_A_PROCESS) > 0
        ),
    ),
    Rule(
        text="a sample has its own mean: no mean shift, no Cpk",
        excel=f'AND({{sample}}<>"",{count_formula("mean_shift", "cpk")}>0)',
        holds=lambda row, _: given(row, "sample") == 1 and given(row, "mean_shift", "cpk") > 0,
    ),
    Rule(
        text="a measured distribution without a sample",
        excel='AND(TRIM({distribution})="measured",{sample}="")',
        holds=lambda row, _: entry_text(row, "distribution").strip() == "measured" and is_blank(row.get("sample")),
    ),
    twice(("tolerance_class", "dimension"), "class and dimension used twice"),
)


def tolerance_status(*, has_measurements: bool) -> Sequence[Stage]:
    """Return the status of a row of Tolerances, whose samples stand in Measurements where there is that sheet."""
    without = Rule(
        text="sample without a sheet Measurements",
        excel='{sample}<>""',
        holds=lambda row, _: given(row, "sample") == 1,
    )
    sample = unknown("sample", "sample not in Measurements", "fl_sample_rows") if has_measurements else without
    return (
        Stage(name="fl_tolerance_entries", rules=_ENTRIES),
        Stage(name="fl_tolerance_limits", rules=[*_BASE, *_DRAWING]),
        Stage(name="fl_tolerance_process", rules=[*_PROCESS, sample]),
    )


def _pair_is_double(row: Row, known: Known) -> bool:
    """Whether a pair stands in another row of its class, either way round."""
    name, first, second = (entry_text(row, key) for key in _PAIR)
    counts = known[",".join(_PAIR)]
    return all((name, first, second)) and counts[name, first, second] + counts[name, second, first] > 1


def _same_cells(one: str, other: str) -> str:
    """Return the formula of how many rows of a class hold these two dimensions."""
    return (
        f"COUNTIFS({{tolerance_class_block}},{{tolerance_class}},"
        f"{{dimension_1_block}},{{{one}}},{{dimension_2_block}},{{{other}}})"
    )


def _without_row(key: str) -> Rule:
    """Return the rule that a class on Tolerances, unless it is based on another, has a row for a dimension."""
    own, base, any_row = (
        f"COUNTIFS(fl_tolerance_rows,{{tolerance_class}},fl_tolerance_dimensions,{criterion})"
        for criterion in (f"TRIM({{{key}}})", '""', '"<>#"')
    )

    def holds(row: Row, known: Known) -> bool:
        name, dimension = entry_text(row, "tolerance_class"), entry_text(row, key).strip()
        rows = known["fl_tolerance_dimensions"]
        return known["fl_tolerance_rows"][name] > 0 and not rows[name, dimension] and not rows[name, ""]

    return Rule(
        text=f"{key.replace('_', ' ')} has no row in the class",
        excel=f"AND({any_row}>0,{own}=0,{base}=0)",
        holds=holds,
    )


def _required(column: Column) -> Sequence[Rule]:
    """Return the rules of a column of Correlations."""
    rules = [missing(column)] if column.required else []
    if column.choices:
        return [*rules, not_in_list(column, "fl_dimensions")]
    return [*rules, no_number(column)] if column.is_number else rules


_PAIR = ("tolerance_class", "dimension_1", "dimension_2")
CORRELATION_STATUS = (
    Stage(
        name="fl_correlation_entries",
        rules=[
            *(rule for column in CORRELATIONS for rule in _required(column)),
            unknown("tolerance_class", _NO_CLASS, "fl_tolerance_rows", "standard"),
            Rule(
                text="a dimension with itself",
                excel="TRIM({dimension_1})=TRIM({dimension_2})",
                holds=lambda row, _: entry_text(row, "dimension_1").strip() == entry_text(row, "dimension_2").strip(),
            ),
            *(_without_row(key) for key in ("dimension_1", "dimension_2")),
            Rule(
                text="pair used twice",
                excel=f"{_same_cells('dimension_1', 'dimension_2')}+{_same_cells('dimension_2', 'dimension_1')}>1",
                holds=_pair_is_double,
                together=_PAIR,
            ),
        ],
    ),
)
