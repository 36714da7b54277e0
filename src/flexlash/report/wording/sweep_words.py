"""What a sweep shows, in sentences: how far a dimension may go within the limit, and where each level crosses it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from decimal import ROUND_CEILING, ROUND_FLOOR, ROUND_HALF_EVEN, Decimal

from flexlash.decisions.allowed_spans import AllowedSpan, allowed_spans, computed_values
from flexlash.decisions.sweep import Study, percentile_key, sweep_levels
from flexlash.schema.angle_unit import AngleUnit
from flexlash.schema.columns import columns_of
from flexlash.schema.entry_words import inner_name
from flexlash.schema.limit_verdict import VerdictBounds

__all__ = [
    "allowed_sentence",
    "allowed_words",
    "level_title",
    "shown_level",
    "study_sentences",
    "study_title",
    "summary_sentence",
    "swept_title",
    "told_sentences",
    "value_words",
]

_DIGITS = 5
"""Digits to which a crossing is told, rounded to the safe side where a sentence allows values up to it."""

_SUMMARISED = 2
"""Most studies that the Summary tells."""

_SHOWN = 12
"""Most values of a second dimension that a screen tells."""

_CAPABLE = 99.865
"""The level that a table of two dimensions shows where Results have no column for the target."""


def swept_title(key: str) -> str:
    """Return the name of a swept column as it heads a column.

    >>> swept_title("cylinder_length_mm")
    'Cylinder length [mm]'
    """
    column = columns_of("Variants")[key]
    return f"{_capital(inner_name(column))}{f' [{column.unit}]' if column.unit_behind else ''}"


def study_title(study: Study) -> str:
    """Return what is swept: `B3-160 case 3: cylinder length from 100 to 200 mm`."""
    swept = [_range(one.key, one.values) for one in (study.first, study.second) if one is not None]
    return f"{study.variant}: {' and '.join(swept)}"


def level_title(percent: float | None) -> str:
    """Return the name of a level.

    >>> level_title(None), level_title(97.5)
    ('Nominal', 'P97.5')
    """
    return "Nominal" if percent is None else f"P{percent:.10g}"


def shown_level(target: float) -> float:
    """Return the level that a table of two dimensions shows: the target's, where Results have a column for it."""
    return target if percentile_key(target) else _CAPABLE


def study_sentences(study: Study, target: float, angles: AngleUnit) -> list[str]:
    """Return what a study shows: what is allowed, where levels cross, the course, what is missing.

    Of two dimensions it is how the table is to be read.
    """
    if study.second is not None:
        return [_table_sentence(study, target, angles), *missing(study)]
    allowed, crossed = allowed_sentence(study, target, angles), _crossing_sentence(study, target, angles)
    return [sentence for sentence in (allowed, crossed, *_course(study, angles), *missing(study)) if sentence]


def told_sentences(study: Study, target: float, angles: AngleUnit) -> list[str]:
    """Return what a screen says of a study, which has no table: of two dimensions what is allowed beside each value."""
    if study.second is None or study.limit is None:
        return study_sentences(study, target, angles) if study.second is None else list(missing(study))
    first, second = (columns_of("Variants")[key] for key in study.keys)
    values = list(dict.fromkeys(study.second.values))
    lines = [f"{_capital(inner_name(first))} with {target:.10g} % of units within {_limit(study, angles)}, beside"]
    for value in values[:_SHOWN]:
        words = allowed_words(study, target, value)
        lines.append(f"{inner_name(second)} {value:.10g}{second.unit_behind}: {words}")
    if len(values) > _SHOWN:
        lines.append(f"… and {len(values) - _SHOWN:,} more values")
    return [*lines, *missing(study)]


def summary_sentence(studies: Sequence[Study], target: float, angles: AngleUnit) -> str:
    """Return what the first studies allow, and how many there are beside them; an empty text without a study."""
    allowed = [(study, allowed_sentence(study, target, angles)) for study in studies]
    told = [(study, sentence) for study, sentence in allowed if sentence][:_SUMMARISED]
    sentences = [f"{study.variant}: {sentence}" for study, sentence in told]
    if more := len(studies) - len(told):
        others = " more" if told else ""
        sentences.append(f"{more:,}{others} {'study' if more == 1 else 'studies'} on the sheet Sweep.")
    return " ".join(sentences)


def allowed_sentence(study: Study, target: float, angles: AngleUnit) -> str:
    """Return how far the first dimension may go with the target share of units within the limit.

    An empty text without a limit or a computed point, and for two dimensions.
    """
    values = computed_values(study) if study.second is None else []
    if study.limit is None or not values:
        return ""
    spans, name = allowed_spans(study, target), inner_name(columns_of("Variants")[study.first.key])
    share = f"{target:.10g} % of units"
    swept = _range(study.first.key, values)
    if len(values) == 1:
        few = "" if spans else "fewer than "
        return f"With {swept.replace(' of ', ' ')}, {few}{share} are within {_limit(study, angles)}."
    if not spans:
        return f"No computed {swept} keeps {share} within {_limit(study, angles)}."
    if spans == [AllowedSpan(low=values[0], high=values[-1])]:
        return f"Every computed {swept} keeps {share} within {_limit(study, angles)}."
    verb = _verb(study, spans, values)
    unit = columns_of("Variants")[study.first.key].unit_behind
    return f"{_capital(name)} {verb}{unit} for {share} within {_limit(study, angles)}."


def _verb(study: Study, spans: Sequence[AllowedSpan], values: Sequence[float]) -> str:
    """Return what the dimension may or must be, the unit left out."""
    entered, (first, *others) = study.entered.get(study.first.key), spans
    if not others and first.low == values[0] and not first.low_crosses:
        known = value_words(first.high, ROUND_FLOOR)
        if entered is None:
            return f"may be at most {known}"
        return f"must be at most {known}" if entered > first.high else f"may grow to {known}"
    if not others and first.high == values[-1] and not first.high_crosses:
        known = value_words(first.low, ROUND_CEILING)
        if entered is None:
            return f"must be at least {known}"
        return f"must be at least {known}" if entered < first.low else f"may shrink to {known}"
    return "must be " + " or ".join(f"from {_span(one, ' to ')}" for one in spans)


def allowed_words(study: Study, percent: float | None, second: float | None = None) -> str:
    """Return the allowed values of the first dimension in a cell: `≥ 45.836`, `≤ 161.85`, `all`, `none`."""
    values, spans = computed_values(study, second), allowed_spans(study, percent, second)
    if not values or study.limit is None:
        return "–"
    if not spans:
        return "none"
    if spans == [AllowedSpan(low=values[0], high=values[-1])]:
        return "all"
    words = []
    for one in spans:
        if one.low == values[0] and not one.low_crosses:
            words.append(f"≤ {value_words(one.high, ROUND_FLOOR)}")
        elif one.high == values[-1] and not one.high_crosses:
            words.append(f"≥ {value_words(one.low, ROUND_CEILING)}")
        else:
            words.append(_span(one, " – "))
    return ", ".join(words)


def value_words(value: float, rounding: str = ROUND_HALF_EVEN) -> str:
    """Return a value in five digits at most, rounded as asked.

    >>> value_words(161.8525860), value_words(45.835577, ROUND_CEILING), value_words(45.835577, ROUND_FLOOR)
    ('161.85', '45.836', '45.835')
    >>> value_words(200.0), value_words(1.9995000001, ROUND_FLOOR)
    ('200', '1.9995')
    """
    exact = Decimal(repr(value))
    place = Decimal(1).scaleb(exact.adjusted() - _DIGITS + 1)
    return f"{exact.quantize(place, rounding).normalize():f}"


def _span(one: AllowedSpan, between: str) -> str:
    return f"{value_words(one.low, ROUND_CEILING)}{between}{value_words(one.high, ROUND_FLOOR)}"


def _crossing_sentence(study: Study, target: float, angles: AngleUnit) -> str:
    """Return at which values each level is just the limit."""
    if study.limit is None:
        return ""
    unit = columns_of("Variants")[study.first.key].unit_behind
    crossed, never = [], []
    for percent in sweep_levels(target):
        values = [value_words(one.value) for one in study.crossings if one.percent == percent]
        name = "the nominal backlash" if percent is None else level_title(percent)
        if values:
            crossed.append(f"{name} at {' and '.join(values)}{unit}")
        else:
            never.append(name)
    if not crossed:
        return (
            f"No crossing of {_limit(study, angles)} was found between the computed points."
            if computed_values(study)
            else ""
        )
    nor = f"; {', '.join(never)} not" if never else ""
    return f"{_limit(study, angles)} is crossed by {', '.join(crossed)}{nor}."


def _table_sentence(study: Study, target: float, angles: AngleUnit) -> str:
    """Return which number a table of two dimensions holds, and what its colours and borders say."""
    level, second = shown_level(target), columns_of("Variants")[study.second.key if study.second else ""]
    what = f"Each cell is {level_title(level)}, the backlash that {level:.10g} % of units stay below"
    if study.limit is None:
        return f"{what}; the redder, the greater. No limit is given."
    bounds = VerdictBounds.of(target)
    marginal = f"; amber, marginal: at least {100 - 100 * bounds.marginal:.10g} %" if bounds.any_marginal else ""
    return (
        f"{what}. Green, meets: at least {target:.10g} % of units are within {_limit(study, angles)}{marginal}; red, "
        f"fails: fewer. The thick line is the contour of green. Below stands, for each {inner_name(second)}, which "
        f"{inner_name(columns_of('Variants')[study.first.key])} keeps each level within the limit."
    )


def _course(study: Study, angles: AngleUnit) -> Iterator[str]:
    """Yield how nominal backlash and disk share run from the first computed value to the last."""
    rows = study.results.filter(study.results["backlash_arcmin"].is_not_null())
    if rows.height < 2:  # noqa: PLR2004
        return
    first, last = rows.row(0, named=True), rows.row(-1, named=True)
    unit = columns_of("Variants")[study.first.key].unit_behind
    ends = f"From {first[study.first.key]:.10g} to {last[study.first.key]:.10g}{unit}"
    nominal = [f"{angles.of(row['backlash_arcmin']):.{3 - angles.fewer}f}{angles.sign}" for row in (first, last)]
    shares = [f"{100 * row['disk_share']:.1f} %" for row in (first, last) if row["disk_share"] is not None]
    disk = f", the disk's share of it from {shares[0]} to {shares[1]}" if shares[0] != shares[-1] else ""
    yield f"{ends} the nominal backlash goes from {nominal[0]} to {nominal[1]}{disk}."


def missing(study: Study) -> Iterator[str]:
    """Yield how many points have no numbers, and why the first of them has none."""
    faulty = study.results.filter(study.results["status"] == "error")
    if faulty.height:
        what = "point is" if faulty.height == 1 else "points are"
        why = faulty["findings"][0] or "see Findings"
        yield f"{faulty.height:,} of {study.results.height:,} {what} not computed: {why}"


def _limit(study: Study, angles: AngleUnit) -> str:
    return angles.spelled_out(study.limit or 0.0, 6)


def _range(key: str, values: Sequence[float]) -> str:
    """Return a dimension with the ends of its values: `cylinder length from 100 to 200 mm`."""
    column = columns_of("Variants")[key]
    low, high = values[0], values[-1]
    span = f"of {low:.10g}" if low == high else f"from {low:.10g} to {high:.10g}"
    return f"{inner_name(column)} {span}{column.unit_behind}"


def _capital(words: str) -> str:
    return f"{words[:1].upper()}{words[1:]}"
