"""A difference → its lines of text: what many variants share first, then each variant, the most important line last."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from flexlash.comparison.calculation_error import AGREEING
from flexlash.comparison.changed_value import Change
from flexlash.comparison.difference import FIRST, Difference, Differing
from flexlash.comparison.sides import Name
from flexlash.reading.carried import SWITCHES
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.findings import shown

__all__ = ["comparison_line", "difference_lines"]

_NAME = 30
_STUDY = 90
"""Most letters of what a study varies: two dimensions, and a variant."""

_NAMED = 3
_WORDS = 200
"""Most letters of a text that differs: a tolerance with its sample takes more than a cell's usual entry."""

_LISTED = 20
"""Most variants that are told one by one."""

_SHARE = ("probability", "share", "lots_failing")
_UNITS = ((1e-3, 100.0, " %"), (1e-7, 1e6, " ppm"), (0.0, 1e9, " ppb"))
"""Shares of at least the first number are told in the unit, which is the factor times the share."""

_BLANK = "–"


def difference_lines(difference: Difference, *, every: bool = False, all_by: str = "--all") -> Iterator[str]:
    """Yield a difference line by line; `every` tells all columns of Results and all variants.

    `all_by` is how a reader asks for that, empty for one who cannot.
    """
    if difference.variants:
        yield _count(difference)
    yield from _how_reports_differ(difference)
    for change, names in difference.shared.items():
        yield f"{_owner(change)}, {_words(change)}, used by {_who(names, difference.common)}"
    if difference.within_error:
        who = _who(difference.within_error, difference.common)
        yield f"Within the error of the calculation ({AGREEING:g} combined standard errors): {who}"
    yield from _each_variant(difference, every=every, all_by=all_by)
    for file, names in zip(_files(difference), (difference.removed, difference.added), strict=True):
        if names:
            yield f"Only in {file}: {_named(names, None if every else _LISTED)}"
    yield _verdict(difference)


def _count(difference: Difference) -> str:
    """Return how many variants differ, and how many do not."""
    differing, within = len(difference.differing), len(difference.within_error)
    equal = difference.common - differing - within
    parts = [f"{differing} of {difference.common} variants {'differs' if differing == 1 else 'differ'}"]
    if within:
        parts = [f"{parts[0]} beyond the error of the calculation", f"{within} within it"]
    if equal or not within:
        parts.append(f"{equal} {'is' if equal == 1 else 'are'} equal")
    return f"{', '.join(parts)}."


def _how_reports_differ(difference: Difference) -> Iterator[str]:
    """Yield what is known of how two reports were made that their cells do not show."""
    if not difference.has_results:
        return
    old, new = difference.old, difference.new
    files = _files(difference)
    for file, side in zip(files, (old, new), strict=True):
        if side.submission.worst_of > len(side.records):
            carried = f"the {len(side.records):,} worst of {side.submission.worst_of:,} rows"
            yield f"{file} carries {carried}; the others are not compared."
    if old.version != new.version:
        yield f"{files[0]} was made by flexlash {shown(old.version)}, {files[1]} by flexlash {shown(new.version)}."
    for name in SWITCHES:
        switched = [bool((side.submission.run_with or {}).get(name)) for side in (old, new)]
        if switched[0] != switched[1]:
            yield f"Only {files[switched.index(True)]} was made with --{name.replace('_', '-')}."


def _files(difference: Difference) -> tuple[str, str]:
    """Return what both files are called; files of one name are told apart as in the command."""
    old, new = (shown(side.file, _NAME * 2) for side in (difference.old, difference.new))
    return (f"{old} (A)", f"{new} (B)") if old == new else (old, new)


def _each_variant(difference: Difference, *, every: bool, all_by: str) -> Iterator[str]:
    """Yield the variants that differ, the most important first."""
    ordered = sorted(difference.variants if every else difference.differing, key=_importance, reverse=True)
    own = [variant for variant in ordered if variant.entered or variant.results]
    for variant in own if every else own[:_LISTED]:
        yield _listed(variant.name)
        yield from (f"    {line}" for line in _variant_lines(variant, every=every, all_by=all_by))
    if len(own) > _LISTED and not every:
        yield f"… and {len(own) - _LISTED} more variants{f' ({all_by} lists all)' if all_by else ''}"


def _importance(variant: Differing) -> tuple[bool, float]:
    """Return what brings a variant forward: its limit crossed, then how much its P97.5 or backlash changed."""
    parts = {change.key: abs(change.part or 0.0) for change in variant.results}
    return bool(variant.limit), max((parts.get(key, 0.0) for key in ("p97_5_arcmin", "backlash_arcmin")), default=0.0)


def _variant_lines(variant: Differing, *, every: bool, all_by: str) -> Iterator[str]:
    """Yield what differs of one variant."""
    for change in variant.entered:
        yield _words(change)
    listed = [change for change in variant.results if every or change.key in FIRST]
    for change in listed:
        yield _words(change) + (_limit_words(variant) if change.key == "p97_5_arcmin" else "")
    if rest := len(variant.results) - len(listed):
        columns = "column" if rest == 1 else "columns"
        yield f"{rest} {'further ' if listed else ''}{columns} of Results{f' ({all_by})' if all_by else ''}"


def _limit_words(variant: Differing) -> str:
    """Return what became of the limit."""
    return {"over": ", now over its limit", "within": ", now within its limit"}.get(variant.limit, "")


def _owner(change: Change) -> str:
    """Return where a shared change stands."""
    if change.sheet == "Settings":
        return "Settings"
    longest = _STUDY if change.sheet == "Sweep" else _NAME
    return f"{'Material' if change.sheet == 'Materials' else change.sheet} {shown(change.owner, longest)}"


def _words(change: Change) -> str:
    """Return a change as `Wall thickness Δ: 1.6 → 1.7 mm (+6.25 %)`."""
    old, new = _pair(change)
    share = any(word in change.key for word in _SHARE)
    unit = "" if share or change.unit in {"", "-"} else f" {change.unit}"
    alone = share or change.sheet in {"Settings", "Correlations"}
    part = "" if change.part is None or alone else f" ({_percent(change.part)})"
    return f"{change.label}: {old} → {new}{unit}{part}"


def _percent(part: float) -> str:
    return f"{100 * part:+.3g} %".replace("-", "−")


def _pair(change: Change) -> tuple[str, str]:
    """Return both values with as few digits as tell them apart."""
    share = any(word in change.key for word in _SHARE)
    factor, unit = _share_unit(change) if share else (1.0, "")
    for digits in (6, 10, 17):
        old, new = (_value(value, digits, factor, unit) for value in (change.old, change.new))
        if old != new:
            break
    return old, new


def _share_unit(change: Change) -> tuple[float, str]:
    """Return factor and name of the unit in which the greater of two shares is told."""
    greatest = max((value for value in (change.old, change.new) if isinstance(value, float)), default=1.0)
    return next((factor, name) for least, factor, name in _UNITS if greatest >= least)


def _value(value: str | float | None, digits: int, factor: float, unit: str) -> str:
    """Return a value as it is shown."""
    if value is None:
        return _BLANK
    if isinstance(value, str):
        return DIMENSIONS[value].plain_name if value in DIMENSIONS else shown(value, _WORDS)
    return f"{factor * value:.{digits}g}{unit}"


def _listed(name: Name) -> str:
    """Return a variant's name; a later row of the same name says so."""
    text = shown(name.text, _NAME) or "(row without a name)"
    return f"{text} (row {name.occurrence} of this name)" if name.occurrence > 1 else text


def _named(names: Sequence[Name], most: int | None = _NAMED) -> str:
    """Return the first few names, and how many more there are."""
    few = names[:most]
    more = f" and {len(names) - len(few)} more" if len(names) > len(few) else ""
    return ", ".join(map(_listed, few)) + more


def _who(names: Sequence[Name], common: int) -> str:
    """Return which variants share a change."""
    return f"all {common} variants" if len(names) == common > 1 else _named(names)


def _verdict(difference: Difference) -> str:
    """Return the last line."""
    if difference.is_none:
        return "No difference in inputs or results." if difference.has_results else "No difference in inputs."
    beside = [
        f"{len(names)} {word}"
        for word, names in (("removed", difference.removed), ("added", difference.added))
        if names
    ]
    differing = sorted(difference.differing, key=_importance, reverse=True)
    if not differing:
        beyond = " beyond the error of the calculation" if difference.within_error else ""
        if not beside:
            return f"No difference{beyond}."
        return f"None of {difference.common} common variants differs{beyond}; {', '.join(beside)}."
    verb = "differs" if len(differing) == 1 else "differ"
    names = _named([variant.name for variant in differing])
    what = [
        f"{count} in {word}"
        for word, count in (
            ("inputs", sum(bool(variant.entered or variant.used) for variant in differing)),
            ("results", sum(bool(variant.results) for variant in differing) if difference.has_results else 0),
        )
        if count
    ]
    tail = ", ".join([*what, *beside])
    return f"{len(differing)} of {difference.common} variants {verb}: {names} ({tail})."


def comparison_line(different: int, numbers: int, report: str) -> str:
    """Return whether the Results computed anew are those of a report."""
    if not different:
        return f"Every number of Results equals that of {report} ({numbers} compared)."
    return f"{different} of {numbers} numbers of Results differ from {report}; flexlash diff shows which."
