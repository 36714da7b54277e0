"""Sweep: from the typed table to the values that each study takes, and what in a row makes none."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

from flexlash.schema.columns import DIMENSIONS, columns_of
from flexlash.schema.decision_rows import SweepRow, SweptDimension
from flexlash.schema.entry_words import dimension_words
from flexlash.schema.part_row import NumberRow, PartRule, first_broken
from flexlash.schema.part_rules import PART_RULES
from flexlash.schema.spellings import plain
from flexlash.schema.swept_values import MOST_POINTS, swept_count, swept_values
from flexlash.validation.ledger import Ledger
from flexlash.validation.meant_names import MeantNames
from flexlash.validation.relations import numbers_of
from flexlash.validation.validated import Table

__all__ = ["Sweeps", "sweep_rows_of", "why_no_part"]

_COLUMNS = columns_of("Sweep")
_FIRST = ("dimension", "from", "to", "step")
_SECOND = ("second_dimension", "second_from", "second_to", "second_step")
_IMPOSSIBLE = [rule for rule in PART_RULES if rule.is_error]
_RADII = ("mean_radius", "bore_diameter")
_LISTED = 5


@dataclass(frozen=True, kw_only=True)
class Sweeps:
    """The sound rows of Sweep, and the row numbers of those with an error, whose studies are left out."""

    rows: tuple[SweepRow, ...] = ()
    faulty: tuple[int, ...] = ()


def sweep_rows_of(table: Table, variants: Table, spoilt: set[int], ledger: Ledger) -> Sweeps:
    """Return the studies of a sheet; `ledger` holds what was found in it so far, and gets what is wrong with rows.

    `spoilt` are the rows of Variants with an error of their own, of which no value is judged.
    """
    reader = _Reader(table, variants, spoilt, ledger)
    sound, faulty = [], []
    for record in table.frame.iter_rows(named=True):
        before = len(ledger.findings)
        study = None if ledger.everything else reader.study(record)
        if study is None or ledger.has_errors(before):
            faulty.append(record["row"])
        else:
            sound.append(study)
    return Sweeps(rows=tuple(sound), faulty=tuple(faulty))


class _Reader:
    """Reads the rows of a sheet beside the variants of the submission."""

    def __init__(self, table: Table, variants: Table, spoilt: set[int], ledger: Ledger) -> None:
        self.table = table
        self.variants = variants
        self.spoilt = spoilt
        self.ledger = ledger
        names = [name for name in variants.frame["variant"].unique(maintain_order=True) if name is not None]
        self.meant = MeantNames(names, table.frame["variant"].drop_nulls().n_unique())
        self.computed = 0

    def study(self, record: Mapping[str, Any]) -> SweepRow | None:
        """Return the study of a row; None where it has an error, all of which are reported."""
        row = record["row"]
        faulty = {key for key in _COLUMNS if (row, key) in self.table.faulty}
        name = None if "variant" in faulty else self._variant(row, record["variant"])
        first = self._values(record, _FIRST, faulty)
        second = self._second(record, faulty)
        needed = {*_FIRST, *(_SECOND if record["second_dimension"] else ())}
        if first is None or faulty or not all(record[key] is not None for key in needed):
            return None
        if record["variant"] is not None and name is None:
            return None
        study = SweepRow(row=row, variant=name, first=first, second=second)
        return study if self._is_affordable(study) and self._makes_parts(study) else None

    def _variant(self, row: int, entered: str | None) -> str | None:
        """Return the name of the variant that a row is about, as Variants has it."""
        if entered is None:
            return None
        known = self.meant.known.get(plain(entered))
        if known is None:
            facts = self.meant.unknown("E366", _COLUMNS["variant"], entered)
            self.ledger.add_in(self.table, row=row, key="variant", value=entered, **facts)
        elif known != entered:
            facts = {"suggestion": known, "certain_value": known}
            self.ledger.add_in(self.table, "I504", row, "variant", value=entered, **facts)
        return known

    def _second(self, record: Mapping[str, Any], faulty: set[str]) -> SweptDimension | None:
        """Return the second dimension of a row; None, with what is wrong, where it has none or not all of it."""
        row = record["row"]
        given = [key for key in _SECOND if record[key] is not None or key in faulty]
        missing = [key for key in _SECOND if key not in given]
        for key in missing if given else ():
            requirement = f"{_COLUMNS[key].requirement} beside the other cells of a second dimension"
            self.ledger.add_in(self.table, "E201", row, key, requirement=requirement)
        if record["second_dimension"] is not None and record["second_dimension"] == record["dimension"]:
            entered = self.table.entered(row, "second_dimension")
            self.ledger.add_in(self.table, "E367", row, "second_dimension", value=entered)
            return None
        return self._values(record, _SECOND, faulty)

    def _values(self, record: Mapping[str, Any], keys: Sequence[str], faulty: set[str]) -> SweptDimension | None:
        """Return a dimension with its values, which are within its bounds and at most as many as may be computed."""
        name, first, last, step = (record[key] for key in keys)
        ends = [(key, record[key]) for key in keys[1:3] if record[key] is not None]
        if name is None or keys[0] in faulty:
            return None
        column, row, before = DIMENSIONS[name], record["row"], len(self.ledger.findings)
        for key, value in ends:
            low, high = column.minimum, column.maximum
            if low is not None and (value < low or (column.exclusive_minimum and value == low)):
                self.ledger.add_in(self.table, "E207", row, key, value=value, requirement=column.requirement)
            elif high is not None and value > high:
                self.ledger.add_in(self.table, "E208", row, key, value=value, requirement=column.requirement)
        if step is None or len(ends) < len(keys[1:3]) or faulty.intersection(keys):
            return None
        if step > abs(last - first) > 0:
            words = f"{abs(last - first):.10g}{column.unit_behind}"
            self.ledger.add_in(self.table, "E368", row, keys[3], value=step, other=words)
        elif (count := swept_count(first, last, step)) > MOST_POINTS:
            self._report_many(row, keys[3], step, count)
        if len(self.ledger.findings) > before:
            return None
        return SweptDimension(key=column.key, values=swept_values(first, last, step))

    def _is_affordable(self, study: SweepRow) -> bool:
        """Whether the rows that a study computes, with those of the studies above it, are not too many."""
        rows = len(study.first.values) * (len(study.second.values) if study.second else 1)
        rows *= 1 if study.variant is not None else self.variants.frame.height
        if self.computed + rows > MOST_POINTS:
            self._report_many(study.row, "step", self.table.entered(study.row, "step"), rows)
            return False
        self.computed += rows
        return True

    def _report_many(self, row: int, key: str, step: float, count: int) -> None:
        """Report that a study computes too many rows, with those of the studies above it."""
        words = f"{count:,}" if count < 10 * MOST_POINTS**2 else f"more than {10 * MOST_POINTS**2:,}"
        above = f" beside the {self.computed:,} of the rows above" if self.computed else ""
        facts = {"value": step, "found": words, "detail": above, "limit": f"{MOST_POINTS:,}"}
        self.ledger.add_in(self.table, "E369", row, key, **facts)

    def _makes_parts(self, study: SweepRow) -> bool:
        """Report the variants of which no value makes a part; return whether there is another."""
        refused, judged = {}, 0
        for record in self._variants_of(study):
            judged += 1
            if words := why_no_part(study, record):
                refused[record["variant"]] = words
        if not refused:
            return True
        names = list(refused)
        more = f" and {len(names) - _LISTED:,} more" if len(names) > _LISTED else ""
        listed = f"{', '.join(names[:_LISTED])}{more}"
        facts = {"value": self.table.entered(study.row, "dimension"), "other": listed, "detail": refused[names[0]]}
        is_all = len(refused) == judged
        self.ledger.add_in(self.table, "E370" if is_all else "W465", study.row, "dimension", **facts)
        return not is_all

    def _variants_of(self, study: SweepRow) -> Iterator[dict[str, Any]]:
        """Yield the rows of Variants that a study is about and that have no error of their own."""
        for record in self.variants.frame.iter_rows(named=True):
            if record["row"] not in self.spoilt and study.variant in {None, record["variant"]}:
                yield record


def why_no_part(study: SweepRow, record: Mapping[str, Any]) -> str:
    """Return why no value of a study makes a part of a variant, in words; an empty text where one does."""
    part, words = numbers_of(record), ""
    swept = [one for one in (study.first, study.second) if one]
    names = [columns_of("Variants")[one.key].dimension for one in swept]
    for values in product(*(one.values for one in swept)):
        entries = {**part.entries, **dict(zip(names, values, strict=True))}
        rule = first_broken(_IMPOSSIBLE, NumberRow(type=part.type, entries=entries))
        if rule is None:
            return ""
        words = words or _words(rule, names)
    return words


def _words(rule: PartRule, swept: Sequence[str]) -> str:
    """Return the words of a broken rule; of two entries for one radius what to sweep instead."""
    others = [name for name in _RADII if name not in swept]
    if rule.code != "E302" or len(others) != 1:
        return rule.words
    (entered,) = others
    return f"its {dimension_words(entered)} is entered; sweep {DIMENSIONS[entered].key} instead"
