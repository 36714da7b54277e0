"""Tolerance classes that no variant uses, though one of nearly the same name is in use."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from flexlash.columns import columns_of
from flexlash.submission.ledger import Ledger
from flexlash.submission.spellings import misspelt, plain
from flexlash.submission.tabulate import Table

__all__ = ["tell_unused_classes"]

_KEY = "tolerance_class"


def tell_unused_classes(tolerances: Table | None, variants: Table, known: Iterable[str], ledger: Ledger) -> None:
    """Warn once of each unused class whose name is nearly that of a class in use; `known` are plain names.

    A class that is used but not known has an error of its own; standard is no slip, and stands in every template.
    """
    if tolerances is None:
        return
    column = columns_of("Tolerances")[_KEY]
    entered = variants.frame[_KEY].fill_null("standard")
    used = {plain(name): name for name in reversed(entered.to_list())}
    candidates = {key: used[key] for key in known if key in used}
    done = {"", "standard", *used}
    for row, name in tolerances.frame.select("row", _KEY).iter_rows():
        key = plain(name or "")
        if key in done:
            continue
        done.add(key)
        if meant := misspelt(name, candidates) or _swapped(key, candidates):
            cell = tolerances.address(row, _KEY)
            facts = {"column": _KEY, "name": column.name, "value": name, "suggestion": meant}
            ledger.add("W429", sheet=tolerances.sheet, cell=cell, **facts)


def _swapped(key: str, names: Mapping[str, str]) -> str | None:
    """Return the one name of the same letters in another order: in short names a swap of two weighs much."""
    same = [name for other, name in names.items() if sorted(other) == sorted(key) and not any(map(str.isdigit, key))]
    return same[0] if len(same) == 1 else None
