"""Two reports or submissions → what differs between them: per variant what was entered, what it uses, what came out."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from flexlash.comparison.calculation_error import POINTS, is_within_error
from flexlash.comparison.changed_value import ROUNDING, Change, equal
from flexlash.comparison.decision_changes import decision_changes
from flexlash.comparison.sides import Name, Side
from flexlash.comparison.used_values import Used
from flexlash.schema.column import Column
from flexlash.schema.columns import SETTINGS, VARIANTS
from flexlash.schema.result_columns import result_columns
from flexlash.schema.spellings import plain

__all__ = ["FIRST", "Difference", "Differing", "changed_results", "difference"]

FIRST = (
    "status", "backlash_arcmin", "p97_5_arcmin", "probability_over_limit", "lots_failing", "main_contributor",
    "system_mean_arcmin", "system_p99_865_arcmin", "system_probability_over_limit", "cheapest_change",
)  # fmt: skip
"""Results on which a verdict rests, how many lots fail, what the whole drive comes to and which change costs least."""

_RESULTS = {column.key: column for column in result_columns(cross_check=True, elasticity=True)}


@dataclass(frozen=True, kw_only=True)
class Differing:
    """What differs of one variant: what was entered in its row, what it uses of other sheets, what came out."""

    name: Name
    entered: list[Change] = field(default_factory=list)
    used: list[Change] = field(default_factory=list)
    results: list[Change] = field(default_factory=list)
    limit: str = ""
    """Whether P97.5 is `over` the limit now, or `within` it, where it was not before."""

    within_error: bool = False
    """Whether only the points of the calculation are others, and the results the same within its error."""

    def as_dictionary(self) -> dict[str, Any]:
        """Return it as JSON holds it."""
        parts = {"entered": self.entered, "used": self.used, "results": self.results}
        return {
            "variant": self.name.text,
            **{part: [change.as_dictionary() for change in changes] for part, changes in parts.items()},
            "limit": self.limit,
            "within_error": self.within_error,
        }


@dataclass(frozen=True, kw_only=True)
class Difference:
    """What differs between two files; `variants` are those of both that differ, `common` is how many both have."""

    old: Side
    new: Side
    common: int
    variants: list[Differing]
    removed: list[Name]
    added: list[Name]

    @property
    def has_results(self) -> bool:
        """Whether both are reports, whose results are compared."""
        return self.old.results is not None and self.new.results is not None

    @property
    def is_none(self) -> bool:
        """Whether nothing differs."""
        return not (self.variants or self.removed or self.added)

    @property
    def differing(self) -> list[Differing]:
        """The variants that differ by more than the error of the calculation."""
        return [variant for variant in self.variants if not variant.within_error]

    @property
    def within_error(self) -> list[Name]:
        """The variants that differ only within the error of the calculation."""
        return [variant.name for variant in self.variants if variant.within_error]

    @property
    def shared(self) -> dict[Change, list[Name]]:
        """Return every change of a table or setting with the variants that use it."""
        users: dict[Change, list[Name]] = {}
        for variant in self.variants:
            for change in variant.used:
                users.setdefault(change, []).append(variant.name)
        return users

    @property
    def counts(self) -> dict[str, int]:
        """How many variants both have, differ, are equal, or are in one alone."""
        return {
            "common": self.common,
            "differing": len(self.differing),
            "within_error": len(self.within_error),
            "equal": self.common - len(self.variants),
            "removed": len(self.removed),
            "added": len(self.added),
        }

    def as_dictionary(self) -> dict[str, Any]:
        """Return the object that `flexlash diff --json` prints."""
        return {
            "old": self.old.as_dictionary(),
            "new": self.new.as_dictionary(),
            "results_compared": self.has_results,
            "counts": self.counts,
            "removed": [name.text for name in self.removed],
            "added": [name.text for name in self.added],
            "variants": [variant.as_dictionary() for variant in self.variants],
        }


def difference(old: Side, new: Side, tolerance: float = ROUNDING) -> Difference:
    """Return what differs between two files; numbers of Results may differ by `tolerance` of themselves."""
    before, after = old.entries(), new.entries()
    common = [name for name in after if name in before]
    decided = decision_changes(old, new)
    differing = []
    for name in common:
        entered = list(_entered(before[name], after[name]))
        used = list(_used(old, new, name))
        own = old.dimensions(name) | new.dimensions(name) if decided else frozenset()
        used += [one.change for one in decided if one.concerns(name, own)]
        results = _results(old, new, name, tolerance)
        if entered or used or results:
            limit = _limit(old, new, name)
            only_points = bool(used) and not entered and not limit and all(change.key in POINTS for change in used)
            within = only_points and _is_within(old, new, name, results)
            differing.append(
                Differing(name=name, entered=entered, used=used, results=results, limit=limit, within_error=within)
            )
    return Difference(
        old=old,
        new=new,
        common=len(common),
        variants=differing,
        removed=[name for name in before if name not in after],
        added=[name for name in after if name not in before],
    )


def _entered(old: Mapping[str, Any], new: Mapping[str, Any]) -> Iterator[Change]:
    """Yield what differs between two rows of Variants."""
    for column in VARIANTS:
        pair = old.get(column.key), new.get(column.key)
        is_name = column.role == "identity" and column.type == "text"
        alike = is_name and plain(pair[0] or "") == plain(pair[1] or "")
        if column.key != "variant" and not (alike or equal(*pair)):
            yield _change(column, *pair)


def _change(column: Column, old: Any, new: Any) -> Change:
    return Change(sheet=column.sheet, key=column.key, label=column.name, unit=column.unit, old=old, new=new)


def _used(old: Side, new: Side, name: Name) -> Iterator[Change]:
    """Yield what differs of material, tolerances, correlations and settings that a variant uses on both sides."""
    yield from _values("Materials", old.material(name), new.material(name))
    its_own = old.dimensions(name) | new.dimensions(name)
    for change in _values("Tolerances", old.tolerances(name), new.tolerances(name)):
        if change.key in its_own:
            yield change
    yield from _values("Correlations", old.correlations(name), new.correlations(name), 0.0)
    before, after = old.settings, new.settings
    for column in SETTINGS:
        if not equal(before[column.key], after[column.key]):
            yield _change(column, before[column.key], after[column.key])


def _values(sheet: str, old: Used | None, new: Used | None, absent: float | None = None) -> Iterator[Change]:
    """Yield what differs between two rows of a table; other rows were chosen on purpose and are told as that.

    `absent` is what a value counts as that is not there.
    """
    if old is None or new is None or old.owner != new.owner:
        return
    for key in dict.fromkeys([*old.values, *new.values]):
        before, after = old.values.get(key), new.values.get(key)
        value = before or after
        if value and not equal(before and before.value, after and after.value):
            yield Change(
                sheet=sheet,
                owner=old.name,
                key=key,
                label=value.label,
                unit=value.unit,
                old=before.shown if before else absent,
                new=after.shown if after else absent,
            )


def _results(old: Side, new: Side, name: Name, tolerance: float) -> list[Change]:
    """Return what differs between the Results of a variant; without them, whether it can be computed."""
    if old.results is None or new.results is None:
        pair = old.hindrance(name), new.hindrance(name)
        words = [f"no, {reason}" if reason else "yes" for reason in pair]
        change = Change(sheet="Variants", key="status", label="Computable", old=words[0], new=words[1])
        return [change] if bool(pair[0]) != bool(pair[1]) else []
    before, after = old.results.get(name), new.results.get(name)
    if before is None or after is None:
        words = ["missing" if row is None else "there" for row in (before, after)]
        change = Change(sheet="Results", key="status", label="Row of Results", old=words[0], new=words[1])
        return [] if before is after else [change]
    return [*_cheapest(old, new, name), *changed_results(before, after, tolerance)]


def _cheapest(old: Side, new: Side, name: Name) -> list[Change]:
    """Return that the cheapest single change that meets the limit is another one, where both reports tell it."""
    before, after = (side.changes.get(name.text) for side in (old, new))
    if before is None or after is None or before == after:
        return []
    return [Change(sheet="Levers", key="cheapest_change", label="Cheapest single change", old=before, new=after)]


def _is_within(old: Side, new: Side, name: Name, results: list[Change]) -> bool:
    """Whether the Results of a variant are the same within the error of the calculation."""
    if old.results is None or new.results is None:
        return False
    rows = old.results.get(name), new.results.get(name)
    if rows[0] is None or rows[1] is None:
        return rows[0] is rows[1]
    return is_within_error((change.key for change in results), rows[0], rows[1])


def changed_results(old: Mapping[str, Any], new: Mapping[str, Any], tolerance: float = ROUNDING) -> list[Change]:
    """Return what differs between two rows of Results, what a verdict rests on first; a column of one alone is none."""
    keys = [key for key in _RESULTS if key in old and key in new and _RESULTS[key].role == "result"]
    order = sorted(keys, key=lambda key: FIRST.index(key) if key in FIRST else len(FIRST))
    return [_change(_RESULTS[key], old[key], new[key]) for key in order if not equal(old[key], new[key], tolerance)]


def _limit(old: Side, new: Side, name: Name) -> str:
    """Return whether P97.5 has crossed the limit."""
    verdicts = []
    for side in (old, new):
        row = (side.results or {}).get(name, {})
        value, limit = row.get("p97_5_arcmin"), row.get("backlash_limit_arcmin")
        verdicts.append(None if value is None or limit is None else value > limit)
    if None in verdicts or verdicts[0] == verdicts[1]:
        return ""
    return "over" if verdicts[1] else "within"
