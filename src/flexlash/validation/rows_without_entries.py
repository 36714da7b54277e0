"""Rows in a table that are no entries of it: totals and means, notes, legends; and entries that nothing but name."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any, NamedTuple

from flexlash.reading.raw import RawValue
from flexlash.schema.columns import columns_of, naming_column
from flexlash.schema.header_names import BLANK
from flexlash.schema.spellings import plain
from flexlash.validation.validated import Heading

__all__ = ["NoEntries", "NoEntry"]

_SUMMARIES = (
    "total totals sum sums subtotal grandtotal mean means average avg median min max minimum maximum range count std "
    "stdev stddev sd sigma standarddeviation deviation variance summe gesamt gesamtsumme mittelwert mittel "
    "durchschnitt anzahl standardabweichung somme moyenne totale media somma ø σ ∑"
)
_TOTALS = frozenset(_SUMMARIES.split())
_LIMITS = frozenset((
    *_TOTALS, "nominal", "target", "tolerance", "limit", "limits", "usl", "lsl", "ucl", "lcl", "upperlimit",
    "lowerlimit", "uppertolerance", "lowertolerance", "cp", "cpk", "pp", "ppk", "sollwert", "nennmaß", "nennmass",
    "xbar", "xquer",
))  # fmt: skip
"""What measuring machines write in place of a part's number, in rows of statistics and limits."""

_SUMMED = frozenset({"Other sources", "Levers"})
"""Sheets whose rows have no second text that a total would lack: plays and costs are summed below."""

_NOTES = (
    "notes? remarks? comments? legend key source prepared created checked approved author date revision rev see "
    "hinweise? bemerkung(?:en)? anmerkung(?:en)? legende quelle erstellt geprüft bearbeiter datum stand end"
)
_REMARK = re.compile(rf"(?:{_NOTES.replace(' ', '|')})\b", re.IGNORECASE)
_MARKS = ("*", "†", "‡", "#", "//", "©", "→", "—", "–")
_LONGEST = 40
"""Characters of a text within which a total is named."""

_SENTENCE = 4
"""Words from which on a text in the column of names reads like a sentence."""


class NoEntry(NamedTuple):
    """Why a row is no entry: its code, what it looks like, and the column and value of the cell that says so."""

    code: str
    detail: str
    column: int
    value: RawValue

    @property
    def facts(self) -> dict[str, Any]:
        """What a finding says of the row."""
        return {"value": self.value, "detail": self.detail}


class NoEntries:
    """Tells the rows of a table that are no entries of it."""

    def __init__(self, schema: str, heading: Heading) -> None:
        columns = columns_of(schema)
        first = naming_column(schema).key
        others = [key for key in columns if key != first]
        indices = heading.columns
        self.schema = schema
        self.first = indices.get(first)
        instead = {column.instead for column in columns.values()}
        needed = {key for key in others if columns[key].is_needed(()) or key in instead}
        self.texts = {indices[key] for key in needed if key in indices and not columns[key].is_number}
        self.numbers = {indices[key] for key in others if key in indices and columns[key].is_number}
        self.part = indices.get("part") if schema == "Measurements" else None
        self.others = {indices[key] for key in others if key in indices}

    def of(self, cells: Mapping[int, RawValue], *, apart: bool) -> NoEntry | None:
        """Return why a row is no entry, or None; `cells` are those under a header.

        A total lacks the texts that every entry needs, a remark has no number. `apart` says that an empty row stands
        between it and the entries. A variant without anything in a column of numbers is an error, told once.
        """
        index, value = next(iter(cells.items()))
        if not isinstance(value, str):
            return None
        others = self.texts - {index}
        if (total := self._total_at(cells, index)) is not None:
            return NoEntry("W433", "a total or a mean", total, cells[total])
        if not others.isdisjoint(cells) and not self.numbers.isdisjoint(cells):
            return None
        if index != self.first or any(_has_digits(cells[number]) for number in self.numbers & cells.keys()):
            return None
        is_alone = self.others.isdisjoint(cells)
        # A source may be called Key; a note has nothing beside it.
        is_note = _begins_like_a_note(value) and (self.texts or self.others).isdisjoint(cells)
        # A material or a source may have a name of many words; without numbers it is told as one that lacks them.
        reads_like_one = self.schema not in {"Materials", "Other sources"} and len(value.split()) >= _SENTENCE
        if is_note or (is_alone and (apart or reads_like_one)):
            return NoEntry("W433", "a remark", index, value)
        is_bare = self.schema == "Variants" and self.numbers.isdisjoint(cells)
        return NoEntry("E217", "", index, value) if is_bare else None

    def _total_at(self, cells: Mapping[int, RawValue], index: int) -> int | None:
        """Return the cell that names a total; `index` is the first one of the row, its name or what stands instead.

        Below measured parts a machine writes statistics and limits, by words in place of a part's number.
        """
        named: tuple[tuple[int | None, frozenset[str]], ...] = ((self.first, _TOTALS),)
        if self.schema == "Measurements":
            named = (*named, (self.part, _LIMITS))
        elif self.schema not in _SUMMED:
            if not self.texts or (self.texts - {index}) & cells.keys() or index not in self.texts | {self.first}:
                return None
            named = ((index, _TOTALS),)
        texts = ((place, cells.get(place or 0), known) for place, known in named)
        return next((place for place, text, known in texts if isinstance(text, str) and _bare(text) in known), None)


def _bare(text: str) -> str:
    """Return the beginning of a text without what stands around a word."""
    return plain(text[:_LONGEST]).replace(".", "").strip(":=()")


def _has_digits(value: RawValue) -> bool:
    """Whether a cell holds a number, or a text with one."""
    return any(map(str.isdigit, str(value)))


def _begins_like_a_note(text: str) -> bool:
    """Whether a text in the column of names is a note rather than a name."""
    bare = text.strip(BLANK)
    return bool(_REMARK.match(bare.lstrip("(["))) or bare.startswith(_MARKS) or bare.endswith(":")
