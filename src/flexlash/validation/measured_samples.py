"""Measurements: from a typed table to samples in SI, with what is wrong with a sample as a whole."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from flexlash.schema.cell_addresses import cell_ranges
from flexlash.schema.column import Column
from flexlash.schema.columns import DIMENSIONS, columns_of
from flexlash.schema.spellings import plain
from flexlash.schema.variant import MeasuredDimension
from flexlash.validation.ledger import Ledger
from flexlash.validation.odd_measurements import odd_values
from flexlash.validation.validated import Table

__all__ = ["Samples", "measured_samples"]

_COLUMNS = columns_of("Measurements")

_MEANT_AS_DEVIATIONS = 0.2
"""Share of values that are not above 0 from which on they are deviations rather than slips."""

_GREATEST = 1e9
"""Greatest number, in any unit, that a dimension or deviation can be; beyond it sums of squares end."""

_Part = tuple[int, float | None]
"""Row of a part and what was measured [printed unit]; None for a cell that could not be read."""


@dataclass(frozen=True, kw_only=True)
class Samples:
    """What was measured, by plain name of the sample and dimension, in SI; of any number of parts from one on.

    `names` are the samples as first entered, `rows` their rows in `table`, by plain name. `faults` are rows whose
    errors spoil a dimension of a sample, by both; `unclear` rows whose errors leave open which samples there are.
    `is_whole` is not so where a header could not be read, so that what is missing may be there.
    """

    table: Table | None = None
    names: Mapping[str, str] = field(default_factory=dict)
    rows: Mapping[str, Sequence[int]] = field(default_factory=dict)
    dimensions: Mapping[str, Mapping[str, MeasuredDimension]] = field(default_factory=dict)
    faults: Mapping[tuple[str, str], Sequence[int]] = field(default_factory=dict)
    unclear: Sequence[int] = ()
    is_whole: bool = True

    def faulty_rows(self, name: str, dimension: str) -> list[int]:
        """Return the rows of Measurements whose errors spoil a dimension of a sample."""
        return list(dict.fromkeys([*self.faults.get((plain(name), dimension), ()), *self.unclear]))


def measured_samples(table: Table | None, ledger: Ledger) -> Samples:
    """Return the samples of a table; `ledger` holds what was found in it so far, and gets what is wrong with them."""
    wide = {found.row for found in ledger.findings if found.level == "error"} if ledger.everything else set()
    samples = Samples(unclear=sorted(wide)) if table is None else _Gathering(table, ledger).samples(wide)
    return replace(samples, is_whole=not ledger.everything)


class _Gathering:
    """Puts the rows of a table together to samples."""

    def __init__(self, table: Table, ledger: Ledger) -> None:
        self.table = table
        self.ledger = ledger
        self.names: dict[str, str] = {}
        self.rows: dict[str, list[int]] = defaultdict(list)
        self.sample: dict[int, str] = {}
        self.faults: dict[tuple[str, str], list[int]] = defaultdict(list)

    def samples(self, wide: set[int]) -> Samples:
        """Return the samples; findings of each as a whole are added. `wide` are rows whose errors spoil all of them."""
        unclear = sorted(wide.union(self._place_rows()))
        uses, spoilt = self._uses()
        measured: dict[str, dict[str, MeasuredDimension]] = {name: {} for name in self.rows}
        for column in _COLUMNS.values():
            for name, parts in self._parts_under(column).items():
                values = [(row, value) for row, value in parts if value is not None and abs(value) <= _GREATEST]
                self.faults[name, column.dimension] += [row for row, value in parts if value is None]
                self.faults[name, column.dimension] += [*spoilt[name], *self._report_endless(column, parts)]
                if uses[name] == "value":
                    self._check_bounds(name, column, values)
                self._report_odd(name, column, values, are_sizes=uses[name] == "value")
                if values:
                    measured[name][column.dimension] = MeasuredDimension(
                        sample=self.names[name],
                        dimension=column.dimension,
                        values=tuple(value * column.si_unit.si for _, value in values),
                        parts=tuple(row for row, _ in values),
                        are_deviations=uses[name] == "deviation",
                    )
        self._report_doubled()
        return Samples(
            table=self.table,
            names=self.names,
            rows=self.rows,
            dimensions=measured,
            faults={place: rows for place, rows in self.faults.items() if rows},
            unclear=unclear,
        )

    def _place_rows(self) -> list[int]:
        """Find the sample of each row; return the rows without one."""
        spelt: dict[str, str] = {}
        unclear = []
        for row, name in self.table.frame.select("row", "sample").iter_rows():
            if name is None:
                unclear += [row] if "sample" in self.table.heading.columns else []
                continue
            if name not in spelt:
                spelt[name] = plain(name)
                self.names.setdefault(spelt[name], name)
            self.sample[row] = spelt[name]
            self.rows[spelt[name]].append(row)
        return unclear

    def _parts_under(self, column: Column) -> dict[str, list[_Part]]:
        """Return what was measured of a dimension by sample; nothing for a column that is none."""
        parts: dict[str, list[_Part]] = defaultdict(list)
        if column.is_number:
            for row, value in self.table.frame.select("row", column.key).iter_rows():
                is_faulty = (row, column.key) in self.table.faulty
                if row in self.sample and (is_faulty or value is not None):
                    parts[self.sample[row]].append((row, None if is_faulty else value))
        return parts

    def _uses(self) -> tuple[dict[str, str], dict[str, list[int]]]:
        """Return what the rows of each sample hold, as most of them say, and the rows that leave it open."""
        entered = {row: use or "value" for row, use in self.table.frame.select("row", "use_as").iter_rows()}
        uses, spoilt = {}, {}
        for name, rows in self.rows.items():
            faulty = {row for row in rows for key in ("sample", "use_as") if (row, key) in self.table.faulty}
            by_use: dict[str, list[int]] = defaultdict(list)
            for row in rows:
                if row not in faulty:
                    by_use[entered[row]].append(row)
            in_order = sorted(by_use, key=lambda use: len(by_use[use])) or ["value"]
            fewest, most = in_order[0], in_order[-1]
            uses[name], spoilt[name] = most, sorted(faulty)
            if fewest != most:
                where = cell_ranges([self.table.address(row, "use_as") for row in by_use[fewest]])
                facts = {"value": fewest, "other": most, "detail": where, "found": self.names[name]}
                self._report("E342", by_use[fewest][0], "use_as", **facts)
                spoilt[name].append(by_use[fewest][0])
        return uses, spoilt

    def _report_endless(self, column: Column, parts: Sequence[_Part]) -> list[int]:
        """Report numbers that are no size at all; return their rows."""
        rows = [row for row, value in parts if value is not None and abs(value) > _GREATEST]
        for row in rows:
            self._report("E208", row, column.key, requirement=f"{column.requirement}, at most {_GREATEST:,.0f},")
        return rows

    def _check_bounds(self, name: str, column: Column, values: Sequence[tuple[int, float]]) -> None:
        """Report sizes that no part can have."""
        dimension = DIMENSIONS[column.dimension]
        low, high, is_above = dimension.minimum, dimension.maximum, dimension.exclusive_minimum
        below = [row for row, value in values if low is not None and (value < low or (is_above and value == low))]
        beyond = [row for row, value in values if high is not None and value > high]
        self.faults[name, column.dimension] += [*below, *beyond]
        if len(below) > 1 and len(below) >= _MEANT_AS_DEVIATIONS * len(values):
            where = cell_ranges([self.table.address(row, column.key) for row in below])
            facts = {"found": f"{len(below)} of {len(values)}", "other": self.names[name], "detail": where}
            self._report("E343", below[0], column.key, **facts)
            return
        for code, rows in (("E207", below), ("E208", beyond)):
            for row in rows:
                self._report(code, row, column.key, requirement=dimension.requirement)

    def _report_odd(self, name: str, column: Column, values: Sequence[tuple[int, float]], *, are_sizes: bool) -> None:
        """Warn of values that are probably slips, unless they have an error."""
        factor = self.table.heading.factors.get(column.key, 1.0)
        faulty = {*self.faults[name, column.dimension]}
        for index, odd in odd_values([value / factor for _, value in values], are_sizes=are_sizes).items():
            row = values[index][0]
            if row not in faulty:
                detail = f"{odd.least * factor:.6g} to {odd.most * factor:.6g}{column.unit_behind}"
                facts = {"detail": detail, "other": self.names[name], "suggestion": odd.suggestion}
                self._report("W446", row, column.key, **facts)

    def _report_doubled(self) -> None:
        """Tell the first part of each sample whose name stands there more than once."""
        parts = dict(self.table.frame.select("row", "part").drop_nulls().iter_rows())
        for name, rows in self.rows.items():
            times = Counter(parts[row] for row in rows if row in parts)
            doubled = [part for part, count in times.items() if count > 1]
            if doubled:
                places = [self.table.address(row, "part") for row in rows if parts.get(row) == doubled[0]]
                found = f"{len(doubled)} parts stand" if len(doubled) > 1 else "1 part stands"
                facts = {"other": self.names[name], "detail": cell_ranges(places), "found": found}
                self._report("I530", places[1].row, "part", **facts)

    def _report(self, code: str, row: int, key: str, **facts: Any) -> None:
        """Record a finding at a cell of Measurements."""
        self.ledger.add_in(self.table, code, row, key, **{"value": self.table.entered(row, key), **facts})
