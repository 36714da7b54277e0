"""The samples of Measurements that rows of Tolerances name."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from flexlash.schema.columns import columns_of
from flexlash.schema.entry_words import dimension_words
from flexlash.schema.spellings import plain
from flexlash.schema.variant import MeasuredDimension
from flexlash.validation.ledger import Ledger
from flexlash.validation.meant_names import MeantNames
from flexlash.validation.measured_samples import Samples
from flexlash.validation.validated import Table

__all__ = ["NamedSamples"]

_KEY = "sample"


class NamedSamples:
    """Finds the sample that a row of Tolerances names, and tells where there is none.

    What may be in Measurements, but could not be read there, is not told again.
    """

    def __init__(self, table: Table, ledger: Ledger, samples: Samples) -> None:
        self.table = table
        self.ledger = ledger
        self.samples = samples
        self.names = samples.names
        named = table.frame[_KEY].drop_nulls()
        self.plain_names = {name: plain(name) for name in named.unique()}
        self.meant = MeantNames(list(self.names.values()), len(self.plain_names))

    def of(self, record: Mapping[str, Any]) -> MeasuredDimension | None:
        """Return the sample of a row, None where it names none; cells with a fault are None in its record."""
        name, dimension = record[_KEY], record["dimension"]
        if name is None:
            return None
        key = self.plain_names[name]
        found = self.samples.dimensions.get(key)
        if found is None:
            self._report_unknown(record["row"], name)
            return None
        if name != self.names[key]:
            meant = self.names[key]
            self._report("I504", record["row"], value=name, suggestion=meant, certain_value=meant)
        is_missing = dimension is not None and dimension not in found and (key, dimension) not in self.samples.faults
        if is_missing:
            words = f"{dimension_words(dimension)} of this sample"
            self._report("E223", record["row"], value=name, detail=words)
        return found.get(dimension)

    def _report_unknown(self, row: int, name: str) -> None:
        facts = self.meant.unknown("E223", columns_of("Tolerances")[_KEY], name)
        if self.samples.is_whole or facts["code"] != "E223":
            self._report(row=row, value=name, **{"detail": "this sample", **facts})

    def _report(self, code: str, row: int, **facts: Any) -> None:
        self.ledger.add_in(self.table, code, row, _KEY, **facts)
