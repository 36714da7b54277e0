"""Names as people spell them: what does not distinguish two, which is nearest, which can only be meant."""

from __future__ import annotations

import difflib
import re
import unicodedata
from collections.abc import Iterable, Mapping

__all__ = ["closest", "misspelt", "plain", "spelt_alike", "suggested", "words"]

_CLOSE = 0.85
"""Likeness from which on two names are one misspelt, when no other name is as near."""

_DIGITS = re.compile(r"\d+")
_WORD = re.compile(r"[^\W_]{2,}")
_SHORTEST = 3
"""Fewest characters of a text that says something as the beginning of a name."""


def plain(text: str) -> str:
    """Return a text without case, spaces, underscores and hyphens, in one Unicode form."""
    folded = unicodedata.normalize("NFKC", text).casefold().replace("’", "'")
    return "".join(character for character in folded if not character.isspace() and character not in "_-\u200b")


def closest(text: str, names: list[str], cutoff: float = 0.6) -> str:
    """Return the name that a text most resembles, or an empty text."""
    by_plain = {plain(name): name for name in names}
    near = difflib.get_close_matches(plain(text), list(by_plain), n=1, cutoff=cutoff)
    return by_plain[near[0]] if near else ""


def words(text: str) -> list[str]:
    """Return the words of a name in one spelling, without symbols of one letter.

    >>> words("Mean radius r_m"), words("bore_diameter")
    (['mean', 'radius'], ['bore', 'diameter'])
    """
    return _WORD.findall(unicodedata.normalize("NFKC", text).casefold())


def suggested(text: str, names: Iterable[str], cutoff: float = 0.6) -> str:
    """Return the name, or the two names, that a text probably means, or an empty text.

    The one name with that word or beginning goes before all that merely share letters with it.

    >>> suggested("bore", ["torque", "bore_diameter"]), suggested("length", ["rim_length", "cylinder_length"])
    ('bore_diameter', 'rim_length or cylinder_length')
    """
    wanted, known = plain(text), list(names)
    holding = [name for name in known if wanted in map(plain, words(name))]
    if not holding and len(wanted) >= _SHORTEST:
        holding = [name for name in known if plain(name).startswith(wanted)]
    if holding:
        return " or ".join(holding) if len(holding) <= 2 else ""  # noqa: PLR2004
    return closest(text, known, cutoff)


def misspelt(text: str, names: Mapping[str, str]) -> str | None:
    """Return the one name that a text can be a misspelling of, from names by their plain spellings; else None.

    Digits distinguish: another number is another material, not a slip of the keyboard.

    >>> misspelt("standart", spelt_alike(["standard", "fine"])), misspelt("20Cr2Ni5", spelt_alike(["20Cr2Ni4"]))
    ('standard', None)
    """
    wanted = plain(text)
    near = difflib.get_close_matches(wanted, list(names), n=len(names) or 1, cutoff=_CLOSE)
    meant = {names[one] for one in near}
    if len(meant) != 1 or _DIGITS.findall(near[0]) != _DIGITS.findall(wanted):
        return None
    return meant.pop()


def spelt_alike(names: Iterable[str]) -> dict[str, str]:
    """Return names by their plain spellings."""
    return {plain(name): name for name in names}
