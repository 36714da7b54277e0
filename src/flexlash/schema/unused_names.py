"""A name that nothing else has yet: the wanted one, another, or one with a number.

Files, sheets, columns and labels that flexlash adds to what is there already get their names here.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Iterator
from itertools import count

__all__ = ["numbered_names", "unused_name"]


def numbered_names(*names: str, numbered: Callable[[int], str]) -> Iterator[str]:
    """Yield names, then without end what `numbered` makes of the numbers from 2 on."""
    yield from names
    yield from map(numbered, count(2))


def unused_name(taken: Container[str], *names: str, numbered: Callable[[int], str]) -> str:
    """Return the first of some names, and then of the numbered ones from 2 on, that is not taken.

    >>> unused_name({"wall", "wall (2)"}, "wall", numbered="wall ({})".format)
    'wall (3)'
    """
    return next(name for name in numbered_names(*names, numbered=numbered) if name not in taken)
