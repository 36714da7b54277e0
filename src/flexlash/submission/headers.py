"""Header cells → columns of the schema: by label or key, in any order, with the unit in brackets."""

from __future__ import annotations

import difflib
import re
import unicodedata
from dataclasses import dataclass, field

from flexlash.columns import Column, columns_of
from flexlash.submission.ledger import Ledger
from flexlash.submission.read import RawSheet, column_letters
from flexlash.units import Unit, find_unit

__all__ = ["STATUS_HEADER", "Heading", "closest", "find_headings", "plain"]

STATUS_HEADER = "Row status"
"""Header of the template's own formula column, which is never data."""

_LAST_HEADER_ROW = 15
_BRACKETS = re.compile(r"^(.*?)\s*[\[(]([^\])]*)[\])]\s*$", re.DOTALL)


@dataclass(kw_only=True)
class Heading:
    """The columns found in a sheet: place and factor to the printed unit by key, extra headers by place.

    `doubtful` are the places of headers with an error and the key that was probably meant; `ignored` those of
    the template's own formulas.
    """

    row: int
    places: dict[str, int] = field(default_factory=dict)
    factors: dict[str, float] = field(default_factory=dict)
    extra: dict[int, str] = field(default_factory=dict)
    doubtful: dict[int, str] = field(default_factory=dict)
    ignored: set[int] = field(default_factory=set)


def plain(text: str) -> str:
    """Return a text without case, spaces, underscores and hyphens, in one Unicode form."""
    folded = unicodedata.normalize("NFKC", text).casefold()
    return "".join(character for character in folded if not character.isspace() and character not in "_-\u200b")


def closest(text: str, names: list[str], cutoff: float = 0.6) -> str:
    """Return the name that a text most resembles, or an empty text."""
    by_plain = {plain(name): name for name in names}
    near = difflib.get_close_matches(plain(text), list(by_plain), n=1, cutoff=cutoff)
    return by_plain[near[0]] if near else ""


def _spellings(columns: dict[str, Column]) -> dict[str, str]:
    """Every accepted header without its unit → key: key, label, label without symbol."""
    found = {}
    for key, column in columns.items():
        words = column.name.split(" ")
        short = " ".join(words[:-1]) if len(words) > 1 and _is_symbol(words[-1]) else column.name
        for spelling in (key, column.dimension, column.name, short):
            found[plain(spelling)] = key
    return found


def _is_symbol(word: str) -> bool:
    return len(word) == 1 or "_" in word


def _split(header: str) -> tuple[str, str | None]:
    """Return a header's name and the unit in its brackets, None without brackets."""
    match = _BRACKETS.match(header)
    return (match[1], match[2].strip()) if match else (header, None)


def find_headings(sheet: RawSheet, schema: str, ledger: Ledger) -> Heading | None:
    """Return the columns of a sheet, or None (with a finding) when it has no header row."""
    columns = columns_of(schema)
    spellings = _spellings(columns)
    counts = {
        number: sum(isinstance(cell, str) and plain(_split(cell)[0]) in spellings for cell in cells.values())
        for number, cells in sheet.rows.items()
        if number <= _LAST_HEADER_ROW
    }
    best = max(counts, key=lambda number: counts[number], default=0)
    if not counts or counts[best] < min(2, len(columns)):
        ledger.add("E109", sheet=sheet.name, cell="A1")
        ledger.everything = True
        return None
    heading = Heading(row=best)
    for place, cell in sheet.rows[best].items():
        if isinstance(cell, str) and plain(cell) == plain(STATUS_HEADER):
            heading.ignored.add(place)
        elif isinstance(cell, str):
            _place(heading, place, cell, sheet.name, columns, spellings, ledger)
    for key, column in columns.items():
        if column.required and key not in heading.places and key not in heading.doubtful.values():
            address = f"{column_letters(max(sheet.rows[best]) + 1)}{best}"
            ledger.add("E111", sheet=sheet.name, cell=address, column=key, name=column.name, label=column.label)
            ledger.everything = True
    return heading


def _place(
    heading: Heading,
    place: int,
    header: str,
    sheet: str,
    columns: dict[str, Column],
    spellings: dict[str, str],
    ledger: Ledger,
) -> None:
    """Recognise one header cell, or say what is wrong with it."""
    name, unit_text = _split(header)
    key = spellings.get(plain(name))
    address = f"{column_letters(place)}{heading.row}"
    meant = key or _resembled(name, spellings)
    if meant is None:
        heading.extra[place] = header.strip()
        ledger.add("I502", sheet=sheet, cell=address, value=header.strip())
        return
    column = columns[meant]
    facts = {
        "sheet": sheet,
        "cell": address,
        "column": meant,
        "value": header.strip(),
        "name": column.name,
        "label": column.label,
        "unit": column.unit or "the unit that Deviation unit names",
    }
    if key is None:
        heading.doubtful[place] = meant
        ledger.add("E112", suggestion=column.label, **facts)
    elif key in heading.places:
        heading.doubtful[place] = key
        ledger.add("E114", other=column_letters(heading.places[key]), **facts)
        ledger.everything = True
    else:
        unit = _unit(column, unit_text, by_key=plain(name) == plain(key))
        if unit is None and unit_text is not None and column.is_number:
            heading.doubtful[place] = key
            ledger.add("E113", suggestion=column.label, **facts)
            return
        heading.places[key] = place
        heading.factors[key] = unit.si / column.si_unit.si if unit else 1.0
        if unit is None and column.unit and column.unit != "-":
            ledger.add("I503", **facts)
        elif unit and unit != column.si_unit:
            ledger.add("I501", **facts | {"value": unit_text})


def _unit(column: Column, text: str | None, *, by_key: bool) -> Unit | None:
    """Return the unit that a header names: in brackets, or at the end of its key."""
    if not column.unit:
        return None
    if text is None:
        return column.si_unit if by_key else None
    return find_unit(text, column.quantity)


def _resembled(name: str, spellings: dict[str, str]) -> str | None:
    """Return the key that an unknown header resembles closely, or None."""
    near = difflib.get_close_matches(plain(name), list(spellings), n=1, cutoff=0.85)
    return spellings[near[0]] if near else None
