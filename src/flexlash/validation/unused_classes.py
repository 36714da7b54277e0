"""Tolerance classes that no variant uses, though one of nearly the same name is in use."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from itertools import islice
from typing import Any

from flexlash.schema.columns import columns_of
from flexlash.schema.spellings import affordable, misspelt, plain
from flexlash.validation.ledger import Ledger
from flexlash.validation.validated import Table

__all__ = ["report_unused_classes"]

_KEY = "tolerance_class"


def report_unused_classes(tolerances: Table | None, variants: Table, known: Iterable[str], ledger: Ledger) -> None:
    """Warn once of each unused class whose name is nearly that of a class in use; `known` are plain names.

    A class that another is based on is used. One that is used but not known has an error of its own; standard, which is
    in every template, is none.
    """
    if tolerances is None:
        return
    column = columns_of("Tolerances")[_KEY]
    bases = tolerances.frame["based_on"].drop_nulls().unique(maintain_order=True).to_list()
    entered = variants.whole.classes if variants.whole else variants.frame[_KEY].fill_null("standard").to_list()
    used = {plain(name): name for name in (*reversed(bases), *reversed(entered))}
    candidates = {key: used[key] for key in known if key in used}
    swapped = _by_letters(candidates)
    for row, name in islice(_unused(tolerances, {"", "standard", *used}), affordable(candidates)):
        if meant := misspelt(name, candidates) or swapped.get("".join(sorted(plain(name)))):
            cell = tolerances.address(row, _KEY)
            facts: dict[str, Any] = {"column": _KEY, "name": column.name, "value": name, "suggestion": meant}
            ledger.add("W429", sheet=tolerances.sheet, cell=cell, **facts)


def _unused(tolerances: Table, done: set[str]) -> Iterator[tuple[int, str]]:
    """Yield the first row and the name of each class whose plain name is not in `done`."""
    for row, name in tolerances.frame.select("row", _KEY).iter_rows():
        key = plain(name or "")
        if key not in done:
            done.add(key)
            yield row, name


def _by_letters(names: Mapping[str, str]) -> dict[str, str]:
    """Return the names without digits whose letters no other has: in short names a swap of two weighs much."""
    alike: dict[str, list[str]] = defaultdict(list)
    for key, name in names.items():
        alike["".join(sorted(key))].append(name)
    return {
        letters: same[0] for letters, same in alike.items() if len(same) == 1 and not any(map(str.isdigit, letters))
    }
