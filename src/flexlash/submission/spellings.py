"""Names as people spell them: what does not distinguish two, which is nearest, which can only be meant."""

from __future__ import annotations

import difflib
import re
import unicodedata
from collections.abc import Iterable, Mapping

__all__ = ["closest", "misspelt", "plain", "spelt_alike"]

_CLOSE = 0.85
"""Likeness from which on two names are one misspelt, when no other name is as near."""

_DIGITS = re.compile(r"\d+")


def plain(text: str) -> str:
    """Return a text without case, spaces, underscores and hyphens, in one Unicode form."""
    folded = unicodedata.normalize("NFKC", text).casefold().replace("’", "'")
    return "".join(character for character in folded if not character.isspace() and character not in "_-\u200b")


def closest(text: str, names: list[str], cutoff: float = 0.6) -> str:
    """Return the name that a text most resembles, or an empty text."""
    by_plain = {plain(name): name for name in names}
    near = difflib.get_close_matches(plain(text), list(by_plain), n=1, cutoff=cutoff)
    return by_plain[near[0]] if near else ""


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
