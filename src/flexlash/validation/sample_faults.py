"""What tolerance classes take of Measurements: samples that are too small, without scatter, spoilt or left over."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.entry_words import inner_name
from flexlash.schema.spellings import affordable, misspelt, plain
from flexlash.schema.variant import FEWEST_PARTS, MeasuredDimension, ToleranceRow
from flexlash.validation.ledger import Ledger
from flexlash.validation.measured_samples import Samples
from flexlash.validation.validated import Table

__all__ = ["report_sample_faults"]


def report_sample_faults(
    samples: Samples, classes: Mapping[str, Sequence[ToleranceRow]], tolerances: Table | None, ledger: Ledger
) -> None:
    """Report what classes, by plain name and with inherited rows, use of the samples and cannot; and what is not used.

    A class is spoilt by what it inherits, too, but a row is told once, where it stands.
    """
    _spoil_by_faults(samples, tolerances, ledger)
    told: dict[tuple[int, str], bool] = {}
    for key, rows in classes.items():
        for row in rows:
            if row.sample is None or tolerances is None:
                continue
            place = (row.row, row.dimension)
            if place not in told:
                told[place] = _report_scatter(row.sample, row, tolerances, ledger)
            if told[place]:
                ledger.spoil("class", key, tolerances.sheet, row.row)
            if samples.table is not None and (plain(row.tolerance_class) != key):
                for fault in samples.faulty_rows(row.sample.sample, row.dimension):
                    ledger.spoil("class", key, samples.table.sheet, fault)
    _report_unused(samples, tolerances, ledger)


def _spoil_by_faults(samples: Samples, tolerances: Table | None, ledger: Ledger) -> None:
    """Spoil each class by the errors of what its own rows take, of which nothing may be left."""
    if tolerances is None or samples.table is None:
        return
    entered = tolerances.frame.select("tolerance_class", "sample", "dimension")
    for name, sample, dimension in entered.drop_nulls().unique(maintain_order=True).iter_rows():
        for fault in samples.faulty_rows(sample, dimension):
            ledger.spoil("class", plain(name), samples.table.sheet, fault)


def _report_scatter(sample: MeasuredDimension, row: ToleranceRow, tolerances: Table, ledger: Ledger) -> bool:
    """Require that a dimension was measured on enough parts and scatters; return whether it does not."""
    count, column = len(sample.values), DIMENSIONS[row.dimension]
    facts = {"value": sample.sample, "dimension": inner_name(column)}
    if count < FEWEST_PARTS:
        found = f"{count} value{'s' * (count > 1)}"
        ledger.add_in(tolerances, "E340", row.row, "sample", found=found, **facts)
        return True
    if not sample.scatters:
        detail = f"{sample.values[0] / column.si_unit.si:.10g}{column.unit_behind}"
        ledger.add_in(tolerances, "E341", row.row, "sample", found=f"{count} values", detail=detail, **facts)
        return True
    return False


def _report_unused(samples: Samples, tolerances: Table | None, ledger: Ledger) -> None:
    """Tell samples that no row of Tolerances names; one of nearly the same name as a sample in use is a warning."""
    if samples.table is None:
        return
    entered = (
        [] if tolerances is None else tolerances.frame["sample"].drop_nulls().unique(maintain_order=True).to_list()
    )
    used = {plain(name): name for name in reversed(entered)}
    known = {name: samples.names[name] for name in used if name in samples.names}
    for number, (name, row) in enumerate(_unused(samples, used)):
        meant = misspelt(samples.names[name], known) if known and number < affordable(known) else None
        facts = {"value": samples.names[name], "suggestion": meant or ""}
        ledger.add_in(samples.table, "W453" if meant else "I529", row, "sample", **facts)


def _unused(samples: Samples, used: Mapping[str, str]) -> Iterator[tuple[str, int]]:
    """Yield plain name and first row of each sample that is not used."""
    return ((name, rows[0]) for name, rows in samples.rows.items() if name not in used)
