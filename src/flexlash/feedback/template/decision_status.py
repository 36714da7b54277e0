"""What the status of a row of Other sources, of Levers and of Sweep says."""

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
from flexlash.schema.column import Column
from flexlash.schema.columns import DIMENSIONS, LEVERS, OTHER_SOURCES, SWEEP
from flexlash.schema.decision_columns import MATERIAL
from flexlash.schema.entry_words import inner_name
from flexlash.schema.swept_values import MOST_POINTS, swept_count

__all__ = ["LEVER_STATUS", "SIZES", "SOURCE_STATUS", "SWEEP_STATUS"]

SIZES = tuple(name for name, column in DIMENSIONS.items() if column.sheet == "Variants")
"""Dimensions that may be changed and swept: those of Variants."""

_DEVIATIONS = ("lower_deviation", "upper_deviation")
_ENTERED_AS = {"angle": ("", "arcmin"), "play": ("mm at radius", "mm radial play"), "radial": ("mm radial play",)}
_SIDES = {"output": ("", "output"), "input": ("input",)}
_OF_A_SIZE = ("lowest", "highest", "step", "tolerance_may_change", "cost_per_grade")
_FIRST = ("dimension", "from", "to", "step")
_SECOND = ("second_dimension", "second_from", "second_to", "second_step")
_EDGE = "0.000000001"


def _entries(columns: Sequence[Column], listed: dict[str, str]) -> list[Rule]:
    """Return the rules of single cells; `listed` are columns whose list is too long for a formula, with its name."""
    return [
        *(missing(column) for column in columns if column.required),
        *(not_in_list(column, listed[column.key]) for column in columns if column.key in listed),
        *(unlisted(column) for column in columns if column.choices and column.key not in listed),
        *(no_number(column) for column in columns if column.is_number),
    ]


def _is(key: str, words: Sequence[str]) -> str:
    """Return the condition that a cell holds one of these words."""
    conditions = [f'TRIM({{{key}}})="{word}"' for word in words]
    return f"OR({','.join(conditions)})" if len(conditions) > 1 else conditions[0]


def _beside(text: str, key: str, words: Sequence[str], other: str, *, is_given: bool) -> Rule:
    """Return the rule that beside one of these words in a column another cell must not be filled, or not be blank."""
    return Rule(
        text=text,
        excel=f'AND({_is(key, words)},{{{other}}}{"<>" if is_given else "="}"")',
        holds=lambda row, _: entry_text(row, key).strip() in words and is_blank(row.get(other)) is not is_given,
    )


def _other_deviation(key: str, column: Column) -> Rule:
    """Return the rule that a deviation does not stand alone."""
    return Rule(
        text=f"{inner_name(column)} missing",
        excel=f'AND({{{key}}}="",{count_formula(*_DEVIATIONS)}=1)',
        holds=lambda row, _: is_blank(row.get(key)) and given(row, *_DEVIATIONS) == 1,
    )


def _has_play_below_0(row: Row, _: Known) -> bool:
    """Whether a systematic source is negative in the middle of its deviations."""
    middle = entry_number(row, "value_arcmin") + sum(entry_number(row, key) for key in _DEVIATIONS) / 2
    return entry_text(row, "kind").strip() != "random" and middle < -float(_EDGE)


SOURCE_STATUS = (
    Stage(name="fl_source_entries", rules=_entries(OTHER_SOURCES, {})),
    Stage(
        name="fl_source_relations",
        rules=[
            twice(("source",), "source used twice"),
            _beside("radius missing", "enter_as", _ENTERED_AS["play"], "radius_mm", is_given=False),
            _beside("a radius beside arcmin", "enter_as", _ENTERED_AS["angle"], "radius_mm", is_given=True),
            _beside(
                "a pressure angle without mm radial play",
                "enter_as",
                (*_ENTERED_AS["angle"], "mm at radius"),
                "pressure_angle_deg",
                is_given=True,
            ),
            _beside("ratio missing", "side", _SIDES["input"], "ratio", is_given=False),
            _beside("a ratio on the output side", "side", _SIDES["output"], "ratio", is_given=True),
            *(_other_deviation(column.key, column) for column in OTHER_SOURCES if column.key in _DEVIATIONS),
            Rule(
                text="neither value nor deviations are given",
                excel=f"{count_formula('value_arcmin', *_DEVIATIONS)}=0",
                holds=lambda row, _: not given(row, "value_arcmin", *_DEVIATIONS),
            ),
            Rule(
                text="a random source without deviations",
                excel=f"AND({_is('kind', ('random',))},{count_formula(*_DEVIATIONS)}=0)",
                holds=lambda row, _: entry_text(row, "kind").strip() == "random" and not given(row, *_DEVIATIONS),
            ),
            Rule(
                text="lower deviation is above upper deviation",
                excel="{lower_deviation}>{upper_deviation}",
                holds=lambda row, _: entry_number(row, "lower_deviation") > entry_number(row, "upper_deviation"),
            ),
            Rule(
                text="the play is below 0 in the middle of its deviations",
                excel=f'AND(TRIM({{kind}})<>"random",'
                f"N({{value_arcmin}})+({{lower_deviation}}+{{upper_deviation}})/2<-{_EDGE})",
                holds=_has_play_below_0,
            ),
        ],
    ),
)


def _bound(key: str, dimension: str, *, is_least: bool = False) -> Rule:
    """Return the rule that a value lies within the bounds of its dimension; `is_least` may be a bound itself."""
    least, above, most = (
        f"SUMIF(fl_levers,TRIM({{{dimension}}}),fl_lever_{name})" for name in ("least", "above", "most")
    )
    on_bound = "" if is_least else f",AND({{{key}}}={least},{above}=1)"

    def holds(row: Row, _: Known) -> bool:
        column = DIMENSIONS.get(entry_text(row, dimension).strip())
        if is_blank(row.get(key)) or column is None:
            return False
        value, low, high = float(row[key]), column.minimum or 0.0, column.maximum
        is_on_bound = value == low and column.exclusive_minimum and not is_least
        return value < low or is_on_bound or (high is not None and value > high)

    return Rule(
        text=f"{key.replace('_', ' ')} is beyond what its dimension can be",
        excel=f'AND({{{key}}}<>"",{{{dimension}}}<>"",OR({{{key}}}<{least}{on_bound},{{{key}}}>{most}))',
        holds=holds,
    )


LEVER_STATUS = (
    Stage(name="fl_lever_entries", rules=_entries(LEVERS, {"dimension": "fl_levers"})),
    Stage(
        name="fl_lever_relations",
        rules=[
            twice(("dimension",), "dimension used twice"),
            Rule(
                text="another material has no range, no step and no tolerance",
                excel=f'AND(TRIM({{dimension}})="{MATERIAL}",{count_formula(*_OF_A_SIZE)}>0)',
                holds=lambda row, _: entry_text(row, "dimension").strip() == MATERIAL and given(row, *_OF_A_SIZE) > 0,
            ),
            _bound("lowest", "dimension", is_least=True),
            _bound("highest", "dimension"),
            Rule(
                text="lowest is above highest",
                excel='AND({lowest}<>"",{highest}<>"",{lowest}>{highest})',
                holds=lambda row, _: given(row, "lowest", "highest") == 2 and row["lowest"] > row["highest"],  # noqa: PLR2004
            ),
        ],
    ),
)


def _too_wide(keys: Sequence[str]) -> Rule:
    """Return the rule that a step reaches a second value."""
    first, last, step = (f"{{{key}}}" for key in keys[1:])
    distance = f"ABS({last}-{first})"

    def holds(row: Row, _: Known) -> bool:
        if given(row, *keys) < len(keys):
            return False
        way = abs(float(row[keys[2]]) - float(row[keys[1]]))
        return float(row[keys[3]]) > way > 0

    return Rule(
        text=f"{keys[3].replace('_', ' ')} reaches no second value",
        excel=f'AND({step}<>"",{distance}>0,{step}>{distance})',
        holds=holds,
    )


def _beside_second(key: str) -> Rule:
    """Return the rule that the four cells of a second dimension are all filled, or all blank."""
    return Rule(
        text=f"{key.replace('_', ' ')} missing",
        excel=f'AND({{{key}}}="",{count_formula(*_SECOND)}>0)',
        holds=lambda row, _: is_blank(row.get(key)) and given(row, *_SECOND) > 0,
    )


def _points(keys: Sequence[str]) -> str:
    """Return the formula of how many values a dimension takes; one without an entry."""
    first, last, step = (f"{{{key}}}" for key in keys[1:])
    return f"IF(N({step})>0,INT(ABS({last}-{first})/{step}+{_EDGE})+1,1)"


def _computes_too_much(row: Row, known: Known) -> bool:
    """Whether a study alone computes more rows than all may."""
    counts = [
        swept_count(*(float(row[key]) for key in keys[1:]))
        for keys in (_FIRST, _SECOND)
        if given(row, *keys) == len(keys)
    ]
    rows = 1 if given(row, "variant") else max(1, sum(known["fl_variants"].values()))
    for count in counts:
        rows *= count
    return rows > MOST_POINTS


SWEEP_STATUS = (
    Stage(
        name="fl_sweep_entries",
        rules=[
            *_entries(SWEEP, dict.fromkeys(("dimension", "second_dimension"), "fl_sizes")),
            unknown("variant", "variant not in Variants", "fl_variants"),
        ],
    ),
    Stage(
        name="fl_sweep_values",
        rules=[
            *(_beside_second(key) for key in _SECOND),
            Rule(
                text="one dimension swept twice",
                excel='AND({second_dimension}<>"",TRIM({dimension})=TRIM({second_dimension}))',
                holds=lambda row, _: (
                    given(row, "second_dimension") == 1
                    and entry_text(row, "dimension").strip() == entry_text(row, "second_dimension").strip()
                ),
            ),
            *(_bound(key, keys[0]) for keys in (_FIRST, _SECOND) for key in keys[1:3]),
            *(_too_wide(keys) for keys in (_FIRST, _SECOND)),
            Rule(
                text=f"more than {MOST_POINTS} rows to compute",
                excel=f'{_points(_FIRST)}*{_points(_SECOND)}*IF({{variant}}="",MAX(1,COUNTA(fl_variants)),1)'
                f">{MOST_POINTS}",
                holds=_computes_too_much,
            ),
        ],
    ),
)
