"""A difference in words: what many variants share first, then each variant, the most important line last."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from flexlash.columns import DIMENSIONS
from flexlash.comparison.difference import FIRST, Change, Difference, Differing
from flexlash.comparison.sides import Name
from flexlash.findings import shown

__all__ = ["comparison_line", "difference_lines"]

_NAME = 30
_NAMED = 3
_TOLD = 20
"""Most variants that are told one by one."""

_SHARE = ("probability", "share")
_UNITS = ((1e-3, 100.0, " %"), (1e-7, 1e6, " ppm"), (0.0, 1e9, " ppb"))
"""Shares of at least the first number are told in the unit, which is the factor times the share."""

_BLANK = "–"


def difference_lines(found: Difference, *, every: bool = False) -> Iterator[str]:
    """Yield a difference line by line; `every` tells all columns of Results and all variants."""
    for change, names in found.shared.items():
        yield f"{_owner(change)}, {_words(change)}, used by {_who(names, found.common)}"
    ordered = sorted(found.variants, key=_importance, reverse=True)
    own = [one for one in ordered if one.entered or one.results]
    for one in own if every else own[:_TOLD]:
        yield _listed(one.name)
        yield from (f"    {line}" for line in _variant_lines(one, every=every))
    if len(own) > _TOLD and not every:
        yield f"… and {len(own) - _TOLD} more variants (--all tells every one)"
    for words, names in (("Only in", found.removed), ("Only in", found.added)):
        if names:
            side = found.old if names is found.removed else found.new
            yield f"{words} {shown(side.file, _NAME * 2)}: {_named(names, None if every else _TOLD)}"
    yield _verdict(found)


def _importance(one: Differing) -> tuple[bool, float]:
    """Return what brings a variant forward: its limit crossed, then how much its P97.5 or backlash changed."""
    parts = {change.key: abs(change.part or 0.0) for change in one.results}
    return bool(one.limit), max((parts.get(key, 0.0) for key in ("p97_5_arcmin", "backlash_arcmin")), default=0.0)


def _variant_lines(one: Differing, *, every: bool) -> Iterator[str]:
    """Yield what differs of one variant."""
    for change in one.entered:
        yield _words(change)
    told = [change for change in one.results if every or change.key in FIRST]
    for change in told:
        yield _words(change) + (_limit_words(one) if change.key == "p97_5_arcmin" else "")
    if rest := len(one.results) - len(told):
        yield f"{rest} {'further ' if told else ''}{'column' if rest == 1 else 'columns'} of Results (--all)"


def _limit_words(one: Differing) -> str:
    """Return what became of the limit."""
    return {"over": ", now over its limit", "within": ", now within its limit"}.get(one.limit, "")


def _owner(change: Change) -> str:
    """Return where a shared change stands."""
    if change.sheet == "Settings":
        return "Settings"
    return f"{'Material' if change.sheet == 'Materials' else 'Tolerances'} {shown(change.owner, _NAME)}"


def _words(change: Change) -> str:
    """Return a change as `Wall thickness Δ: 1.6 → 1.7 mm (+6.25 %)`."""
    old, new = _pair(change)
    share = any(word in change.key for word in _SHARE)
    unit = "" if share or change.unit in {"", "-"} else f" {change.unit}"
    part = "" if change.part is None or share or change.sheet == "Settings" else f" ({_percent(change.part)})"
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
        return DIMENSIONS[value].plain_name if value in DIMENSIONS else shown(value)
    return f"{factor * value:.{digits}g}{unit}"


def _listed(name: Name) -> str:
    """Return a variant's name; a later row of the same name says so."""
    text = shown(name.text, _NAME) or "(row without a name)"
    return f"{text} (row {name.place} of this name)" if name.place > 1 else text


def _named(names: Sequence[Name], most: int | None = _NAMED) -> str:
    """Return the first few names, and how many more there are."""
    few = names[:most]
    more = f" and {len(names) - len(few)} more" if len(names) > len(few) else ""
    return ", ".join(map(_listed, few)) + more


def _who(names: Sequence[Name], common: int) -> str:
    """Return which variants share a change."""
    return f"all {common} variants" if len(names) == common > 1 else _named(names)


def _verdict(found: Difference) -> str:
    """Return the last line."""
    if found.is_none:
        return "No difference in inputs or results." if found.has_results else "No difference in inputs."
    beside = [f"{len(names)} {word}" for word, names in (("removed", found.removed), ("added", found.added)) if names]
    if not found.variants:
        return f"None of {found.common} common variants differs; {', '.join(beside)}."
    verb = "differs" if len(found.variants) == 1 else "differ"
    names = _named([one.name for one in sorted(found.variants, key=_importance, reverse=True)])
    what = [
        f"{count} in {word}"
        for word, count in (
            ("inputs", sum(bool(one.entered or one.used) for one in found.variants)),
            ("results", sum(bool(one.results) for one in found.variants) if found.has_results else 0),
        )
        if count
    ]
    tail = ", ".join([*what, *beside])
    return f"{len(found.variants)} of {found.common} variants {verb}: {names} ({tail})."


def comparison_line(different: int, numbers: int, report: str) -> str:
    """Return whether the Results computed anew are those of a report."""
    if not different:
        return f"Every number of Results equals that of {report} ({numbers} compared)."
    return f"{different} of {numbers} numbers of Results differ from {report}; flexlash diff tells which."
