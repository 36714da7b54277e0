"""Names as people spell them: what does not distinguish two, which is nearest, which can only be meant."""

from __future__ import annotations

import re
import unicodedata
from bisect import bisect_left
from collections import defaultdict
from collections.abc import Collection, Iterable, Mapping
from functools import lru_cache
from itertools import islice, takewhile
from typing import NamedTuple

__all__ = ["affordable", "closest", "likeness", "misspelt", "plain", "spelt_alike", "suggested", "words"]

_CLOSE = 0.85
"""Likeness from which on two names are one misspelt, when no other name is as near."""

_DIGITS = re.compile(r"\d+")
_WORD = re.compile(r"[^\W_]{2,}")
_SHORTEST = 3
"""Fewest characters of a text that says something as the beginning of a name."""

_NAMED = 2
"""Most names that a suggestion offers."""

_COMPARISONS = 10_000_000
"""Most comparisons of two names in one table, about a second."""


def plain(text: str) -> str:
    """Return a text without case, spaces, underscores and hyphens, in one Unicode form."""
    folded = unicodedata.normalize("NFKC", text).casefold().replace("’", "'")
    return "".join(character for character in folded if not character.isspace() and character not in "_-\u200b")


def likeness(first: str, second: str) -> float:
    """Return how alike two plain spellings are: twice the letters in common, in order, over the letters of both."""
    from rapidfuzz.distance import Indel

    return Indel.normalized_similarity(first, second)


def affordable(names: Collection[str]) -> int:
    """Return for how many texts the nearest of so many names may be sought; who misspells more has one reason."""
    return max(_COMPARISONS // max(len(names), 1), 1)


def words(text: str) -> list[str]:
    """Return the words of a name in one spelling, without symbols of one letter.

    >>> words("Mean radius r_m"), words("bore_diameter")
    (['mean', 'radius'], ['bore', 'diameter'])
    """
    return _WORD.findall(unicodedata.normalize("NFKC", text).casefold())


class _Index(NamedTuple):
    """Names by their plain spellings, by the words in them, and in the alphabetical order of the spellings."""

    by_plain: Mapping[str, str]
    by_word: Mapping[str, list[str]]
    ordered: list[tuple[str, str]]


@lru_cache(maxsize=8)
def _index(names: tuple[str, ...]) -> _Index:
    """Return the index of a set of names, made once for all texts that are looked up in it."""
    by_word: dict[str, list[str]] = defaultdict(list)
    for name in names:
        for word in dict.fromkeys(map(plain, words(name))):
            by_word[word].append(name)
    spelt = [(plain(name), name) for name in names]
    return _Index(dict(spelt), by_word, sorted(spelt))


def closest(text: str, names: Iterable[str], cutoff: float = 0.6) -> str:
    """Return the name that a text most resembles, or an empty text."""
    from rapidfuzz import process
    from rapidfuzz.distance import Indel

    by_plain = _index(tuple(names)).by_plain
    near = process.extractOne(plain(text), by_plain.keys(), scorer=Indel.normalized_similarity, score_cutoff=cutoff)
    return by_plain[near[0]] if near else ""


def suggested(text: str, names: Iterable[str], cutoff: float = 0.6) -> str:
    """Return the name, or the two names, that a text probably means, or an empty text.

    The one name with that word or beginning goes before all that merely share letters with it.

    >>> suggested("bore", ["torque", "bore_diameter"]), suggested("length", ["rim_length", "cylinder_length"])
    ('bore_diameter', 'rim_length or cylinder_length')
    """
    wanted, known = plain(text), tuple(names)
    index = _index(known)
    holding = index.by_word.get(wanted, [])
    if not holding and len(wanted) >= _SHORTEST:
        first = bisect_left(index.ordered, (wanted, ""))
        beginning = takewhile(lambda known_as: known_as[0].startswith(wanted), islice(index.ordered, first, None))
        holding = [name for _, name in islice(beginning, _NAMED + 1)]
    if holding:
        return " or ".join(holding) if len(holding) <= _NAMED else ""
    return closest(text, known, cutoff)


def misspelt(text: str, names: Mapping[str, str]) -> str | None:
    """Return the one name that a text can be a misspelling of, from names by their plain spellings; else None.

    Digits distinguish: another number is another material, not a slip of the keyboard.

    >>> misspelt("standart", spelt_alike(["standard", "fine"])), misspelt("20Cr2Ni5", spelt_alike(["20Cr2Ni4"]))
    ('standard', None)
    """
    from rapidfuzz import process
    from rapidfuzz.distance import Indel

    wanted = plain(text)
    near = process.extract(wanted, names.keys(), scorer=Indel.normalized_similarity, score_cutoff=_CLOSE, limit=None)
    meant = {names[spelling] for spelling, _, _ in near}
    if len(meant) != 1 or _DIGITS.findall(near[0][0]) != _DIGITS.findall(wanted):
        return None
    return meant.pop()


def spelt_alike(names: Iterable[str]) -> dict[str, str]:
    """Return names by their plain spellings."""
    return {plain(name): name for name in names}
