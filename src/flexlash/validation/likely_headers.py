"""Which columns the unknown headers of a sheet may mean: required ones that are missing first."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

from flexlash.schema.column import Column
from flexlash.schema.spellings import likeness, plain, words

__all__ = ["likely_headers"]

_RESEMBLING = 0.85
"""Likeness from which on an unknown header is taken for a misspelt one."""

_MISSING = 0.7
"""The same where a required column is missing, so that some header must mean it."""

_EQUALLY = 0.05
"""Difference of likeness within which two columns are meant alike."""

_RADII = ("mean_radius_mm", "bore_diameter_mm")
"""Columns of which one is required."""


def likely_headers(
    names: Mapping[int, str], columns: Mapping[str, Column], spellings: Mapping[str, str]
) -> dict[int, list[str]]:
    """Return the keys that each unknown header may mean, by its index; more than one where they are as near.

    `names` are the headers of a row without their units, `spellings` the keys by every spelling that is known.
    """
    present = {spellings[plain(name)] for name in names.values() if plain(name) in spellings}
    unknown = {index: name for index, name in names.items() if plain(name) not in spellings}
    alike = {index: _likenesses(name, spellings) for index, name in unknown.items()}
    absent = columns.keys() - present - (set() if present.isdisjoint(_RADII) else set(_RADII))
    called = _called(unknown, [columns[key] for key in columns if key in absent])
    missing = _missing(columns, present | {*called.values()})
    pairs = sorted(
        (-_nearness(name, key, columns[key], spellings), index, key)
        for index, name in unknown.items()
        for key in missing
        if index not in called
    )
    rivals = Counter((opposite, index) for opposite, index, _ in pairs)
    likely = {index: [key] for index, key in called.items()}
    for opposite, index, key in pairs:
        if -opposite < max(_MISSING, *alike[index].values()) or index in likely or rivals[opposite, index] > 1:
            continue
        if [key] not in likely.values():
            likely[index] = [key]
    return {index: _resembling(alike[index], present) for index in unknown} | likely


def _called(unknown: Mapping[int, str], absent: Sequence[Column]) -> dict[int, str]:
    """Return the absent column that each header names in other words, by its index; the first header of two."""
    spelt = {plain(name): column.key for column in absent for name in column.also_called.split()}
    named: dict[int, str] = {}
    for index, name in unknown.items():
        key = spelt.get(plain(name)) or spelt.get(plain(" ".join(words(name))))
        if key and key not in named.values():
            named[index] = key
    return named


def _missing(columns: Mapping[str, Column], present: set[str]) -> list[str]:
    """Return the columns that a sheet needs and lacks."""
    needed = [key for key, column in columns.items() if column.is_needed(present)]
    if _RADII[0] in columns:
        needed += [_RADII[0]] if present.isdisjoint(_RADII) else []
        needed.append("disk_inner_radius_mm")
    return [key for key in needed if key not in present]


def _nearness(name: str, key: str, column: Column, spellings: Mapping[str, str]) -> float:
    """Return how near a header is to a column that is missing: 1 for a word of it."""
    wanted = plain(" ".join(words(name)))
    known = [spelling for spelling, meant in spellings.items() if meant == key]
    if key != "disk_inner_radius_mm":
        known += [word for word in words(column.plain_name) if len(word) > 3]  # noqa: PLR2004
    return max(likeness(wanted, spelling) for spelling in known)


def _likenesses(name: str, spellings: Mapping[str, str]) -> dict[str, float]:
    """Return how like a header is to each column by its letters."""
    likenesses: dict[str, float] = {}
    for spelling, key in spellings.items():
        likenesses[key] = max(likenesses.get(key, 0.0), likeness(plain(name), spelling))
    return likenesses


def _resembling(alike: Mapping[str, float], present: set[str]) -> list[str]:
    """Return the one or two columns that a header resembles about equally; those that the sheet has come last."""
    best = max(alike.values(), default=0.0)
    keys = [key for key, likeness in alike.items() if best >= _RESEMBLING and likeness > best - _EQUALLY]
    return sorted([key for key in keys if key not in present] or keys, key=lambda key: -alike[key])[:2]
