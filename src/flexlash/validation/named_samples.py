"""The samples of Measurements that rows of Tolerances name."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

from flexlash.schema.columns import DIMENSIONS, columns_of
from flexlash.schema.entry_words import inner_name
from flexlash.schema.spellings import plain
from flexlash.schema.variant import MeasuredDimension
from flexlash.validation.cell_values import is_no_value, no_value_facts
from flexlash.validation.ledger import Ledger
from flexlash.validation.meant_names import MeantNames
from flexlash.validation.validated import Table

__all__ = ["Measured", "NamedSamples"]

Measured = Mapping[str, Mapping[str, MeasuredDimension]]
"""What was measured, by plain name of the sample and dimension."""

_KEY = "sample"


class NamedSamples:
    """Finds the sample that a row of Tolerances names, and tells where there is none.

    `spoilt` are the plain names and dimensions of samples whose values have errors of their own.
    """

    def __init__(self, table: Table, ledger: Ledger, measured: Measured, spoilt: Collection[tuple[str, str]]) -> None:
        self.table = table
        self.ledger = ledger
        self.measured = measured
        self.spoilt = spoilt
        self.names = {key: next((one.sample for one in of.values()), key) for key, of in measured.items()}
        named = table.frame[_KEY].drop_nulls()
        self.plain_names = {name: plain(name) for name in named.unique()}
        self.meant = MeantNames(list(self.names.values()), len(self.plain_names))

    def of(self, record: Mapping[str, Any]) -> MeasuredDimension | None:
        """Return the sample of a row, None where it names none; cells with a fault are None in its record."""
        name, dimension = record[_KEY], record["dimension"]
        if name is None:
            return None
        key = self.plain_names[name]
        found = self.measured.get(key)
        if found is None:
            self._report_unknown(record["row"], name)
            return None
        if name != self.names[key]:
            meant = self.names[key]
            self._report("I504", record["row"], value=name, suggestion=meant, certain_value=meant)
        if dimension is not None and dimension not in found and (key, dimension) not in self.spoilt:
            words = f"has no measured {inner_name(DIMENSIONS[dimension])}"
            self._report("E223", record["row"], value=name, detail=words)
        return found.get(dimension)

    def _report_unknown(self, row: int, name: str) -> None:
        if is_no_value(name):
            self._report("E221", row, value=name, **no_value_facts(columns_of("Tolerances")[_KEY]))
        else:
            self._report("E223", row, value=name, detail="is no sample of Measurements", **self.meant[name])

    def _report(self, code: str, row: int, **facts: Any) -> None:
        self.ledger.add_in(self.table, code, row, _KEY, **facts)
