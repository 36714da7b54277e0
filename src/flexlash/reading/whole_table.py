"""What of a whole table an excerpt of it would lose: every judgement that looks at more than one row."""

from __future__ import annotations

from array import array
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, TypeAlias

__all__ = ["DoubledNames", "OwnKind", "WholeTable"]

OwnKind: TypeAlias = Literal["whole", "number", "text", "endless"]
"""What a column that flexlash does not use holds: whole numbers, numbers, texts, or numbers beyond all bounds."""


@dataclass(frozen=True, kw_only=True)
class WholeTable:
    """The facts of a whole table of variants; rows and columns are numbered from 1 as the user counts.

    `head` is the last row that every excerpt holds: that of the headers, or of units. `filled` are the columns with
    anything below the header row, `first_row` the first such row, 0 for none; `is_empty` says that no row is
    an entry. `nameless` are columns without a header, each with its first row; `digits` the first row of each column of
    remarks that holds nothing but short digits, by key. `named` is how many different materials and tolerance classes
    the rows name, by key, `classes` are the latter, each in its first spelling; `own` says what the columns hold that
    flexlash does not use.

    Of the rows of one excerpt alone: `above` is the last entry before a row where that is not the next row above it, 0
    for none; `partners` are the other cells of the same name, for a name that is used more than once.
    """

    head: int = 0
    filled: frozenset[int] = frozenset()
    first_row: int = 0
    is_empty: bool = False
    nameless: Mapping[int, int] = field(default_factory=dict)
    digits: Mapping[str, int] = field(default_factory=dict)
    named: Mapping[str, int] = field(default_factory=dict)
    classes: tuple[str, ...] = ()
    own: Mapping[int, OwnKind] = field(default_factory=dict)
    above: Mapping[int, int] = field(default_factory=dict)
    partners: Mapping[int, str] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class DoubledNames:
    """The rows of names that more than one row of a table has, in their `column`.

    `rows` are those of one name after the other, which begin at `starts`; the last of these is the end. `ranges` are
    the cells of names that too many rows have for each to be told its partners, by the number of the name.
    """

    rows: array[int]
    starts: array[int]
    ranges: Mapping[int, str]
    column: int
