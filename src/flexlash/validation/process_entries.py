"""What a row of Tolerances says of the process behind it: each thing once, and nothing that contradicts another."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from flexlash.schema.columns import columns_of
from flexlash.schema.process_verdict import process_verdict
from flexlash.schema.variant import ToleranceRow
from flexlash.validation.ledger import Ledger
from flexlash.validation.validated import Table

__all__ = ["BLAMED", "check_process", "check_verdict"]

_COLUMNS = columns_of("Tolerances")
BLAMED = {
    "mean": ("sample", "mean_shift", "cpk"),
    "scatter": ("sample", "standard_deviation", "cp"),
    "cpk": ("cpk",),
}
"""The cells of which the first that is filled is to blame for where a process lies, or how it scatters."""

_OF_A_PROCESS = ("mean_shift", "standard_deviation", "cp", "cpk", "sample")
_SCATTERS = ("limits_sigma", "standard_deviation", "cp", "sample")
"""What tells the standard deviation, of which a row has one at most."""


def check_process(table: Table, ledger: Ledger, record: Mapping[str, Any]) -> None:
    """Check what a row says of its process; cells with a fault are None in its record."""
    given = {key: record[key] for key in (*_SCATTERS, "mean_shift", "cpk") if record[key] is not None}
    misplaced = _misplaced(table, record, given)
    for key, words in misplaced.items():
        ledger.add_in(table, "E337", record["row"], key, value=table.entered(record["row"], key), detail=words)
    said = {key: value for key, value in given.items() if key not in misplaced}
    for key, other in _said_twice(said):
        words = f"{_COLUMNS[other].name} = {table.entered(record['row'], other)}"
        ledger.add_in(table, "E335", record["row"], key, value=said[key], other=words)
    if "cpk" in said and "sample" not in said:
        _check_cpk(table, ledger, record)
    is_measured = record["distribution"] == "measured" and not misplaced
    if is_measured and "sample" not in given and (record["row"], "sample") not in table.faulty:
        requirement = "the name of a sample of Measurements, which the distribution measured goes through,"
        ledger.add_in(table, "E201", record["row"], "sample", requirement=requirement)


def _misplaced(table: Table, record: Mapping[str, Any], given: Mapping[str, Any]) -> dict[str, str]:
    """Return what is given of a process that has none, each with the reason."""
    keys = [key for key in _OF_A_PROCESS if key in given]
    distribution = record["distribution"]
    if distribution in {"uniform", "triangular"}:
        words = f"a {distribution} dimension scatters between its limits alone"
        return dict.fromkeys(keys, words)
    lower, upper = record["lower_deviation"], record["upper_deviation"]
    has_grade = record["grade"] is not None or (record["row"], "grade") in table.faulty
    if lower is not None and lower == upper and not has_grade:
        words = "both deviations are equal, so that the dimension does not scatter"
        return dict.fromkeys(["upper_deviation"] if lower and keys else keys, words)
    if distribution == "measured":
        words = "a measured distribution has mean and standard deviation of its sample"
        return dict.fromkeys((key for key in keys if key != "sample"), words)
    return {}


def _said_twice(said: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Yield the cells that say again where the mean is or how parts scatter, each with the first that says it."""
    scatters = [key for key in _SCATTERS if key in said]
    for key in scatters[1:]:
        yield key, scatters[0]
    if "sample" in said:
        for key in ("mean_shift", "cpk"):
            if key in said:
                yield key, "sample"


def _check_cpk(table: Table, ledger: Ledger, record: Mapping[str, Any]) -> None:
    """Require Cp beside Cpk, and no less than that."""
    row, cp, cpk = record["row"], record["cp"], record["cpk"]
    if cp is None:
        if (row, "cp") not in table.faulty:
            ledger.add_in(table, "E336", row, "cpk", value=cpk, detail="Cp is required beside it")
    elif cpk > cp:
        ledger.add_in(table, "E336", row, "cpk", value=cpk, detail=f"at most Cp = {cp:.10g} is possible")


def check_verdict(table: Table, ledger: Ledger, record: Mapping[str, Any], row: ToleranceRow) -> bool:
    """Check a sound row's process beside its limits where these do not wait for a size; return whether it can be."""
    sample = row.sample
    if not (row.scatters and row.has_process) or row.waits_for_size or (sample and not sample.scatters):
        return True
    width, middle = row.upper - row.lower, (row.lower + row.upper) / 2
    sd = width / (2 * row.limits_sigma) if row.sd is None else row.sd
    mean = middle + row.mean_shift + row.harmful_shift * width
    if sample:
        mean, sd = sample.mean, sample.standard_deviation
    is_cut, is_entered = row.distribution == "truncated normal", row.sd is not None
    verdict = process_verdict(row.lower, row.upper, mean, sd, is_entered=is_entered, cpk=row.cpk, is_truncated=is_cut)
    if verdict is None:
        return True
    key = next((key for key in BLAMED[verdict.blamed] if record[key] is not None), "dimension")
    ledger.add_in(table, verdict.code, record["row"], key, value=record[key], detail=verdict.words)
    return verdict.code[0] != "E"
