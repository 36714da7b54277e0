"""A file → one side of a comparison: what was entered, in the template's units, what it uses, what came out."""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flexlash.analysis.assessment import assess
from flexlash.analysis.computed import Nominal
from flexlash.comparison.used_values import Used, Value, correlation_value, tolerance_value
from flexlash.reading.limited_process import ask
from flexlash.reading.raw import RawSheet, Submission
from flexlash.reading.read import Source, limits_of_reports, report_of, submission_of
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.schema.cell_addresses import CellAddress
from flexlash.schema.columns import MATERIALS, columns_of
from flexlash.schema.findings import Finding, shown
from flexlash.schema.result_columns import result_columns
from flexlash.schema.spellings import plain
from flexlash.schema.variant import OVERRIDDEN
from flexlash.validation.blocking_errors import stopped_by
from flexlash.validation.consolidation import consolidated
from flexlash.validation.validate import validate
from flexlash.validation.validated import Table, Validated

if TYPE_CHECKING:
    import polars as pl

__all__ = ["Name", "Side", "by_variant", "frame_rows", "result_rows", "side_of", "side_of_source"]

_TOP = 15
_NAMED = 3
"""Most errors elsewhere that are named for a row."""

_ESCAPED = re.compile("_x([0-9A-Fa-f]{4})_")
_ESCAPE = "x005F_"


@dataclass(frozen=True, kw_only=True)
class Name:
    """A variant by its name, case as written; `occurrence` counts rows of one name from 1."""

    text: str
    occurrence: int = 1


@dataclass(frozen=True, kw_only=True)
class Side:
    """A report or submission as it is compared.

    `results` are a report's by variant, None for a submission; `version` is that of the flexlash that made the report;
    `changes` its cheapest single changes in words, by the name of the variant.
    """

    file: str
    submission: Submission
    validated: Validated
    version: str = ""
    results: Mapping[Name, Mapping[str, Any]] | None = None
    changes: Mapping[str, str] = field(default_factory=dict)

    @property
    def is_report(self) -> bool:
        """Whether it is a report, which has results."""
        return self.submission.run_with is not None

    def as_dictionary(self) -> dict[str, Any]:
        """Return what it is, as JSON holds it."""
        facts: dict[str, Any] = {"file": self.file, "kind": "report" if self.is_report else "submission"}
        facts |= {"submission": self.submission.name, "sha256": self.submission.sha256}
        facts |= {"worst_of": self.submission.worst_of} if self.submission.worst_of else {}
        made = {"version": self.version, "options": dict(self.submission.run_with or {})}
        return facts | made if self.is_report else facts

    @cached_property
    def records(self) -> Mapping[Name, Mapping[str, Any]]:
        """The typed rows of Variants by name, in submitted order."""
        table = self.validated.table
        rows = table.frame.to_dicts() if table else []
        return dict(zip(_named(row["variant"] or "" for row in rows), rows, strict=True))

    def entries(self) -> dict[Name, dict[str, Any]]:
        """Return what was entered for each variant: blank cells with their default, faulty ones as entered."""
        table = self.validated.table
        fixes = {
            (finding.address, finding.column): finding.certain_value
            for finding in self._findings
            if table and finding.sheet == table.sheet and finding.certain_value is not None
        }
        return {name: _entered(record, table, fixes) for name, record in self.records.items() if table}

    def hindrance(self, name: Name) -> str:
        """Return why a variant cannot be computed, an empty text where nothing is in its way."""
        row = self.records[name]["row"]
        if row in self._computed:
            return ""
        return ", ".join(self._errors[row]) or "an error on another sheet"

    @cached_property
    def _nominal(self) -> Nominal:
        return assess(self.validated, self.validated.settings)

    @cached_property
    def _findings(self) -> list[Finding]:
        return consolidated(self.validated, self._nominal.findings, self._nominal.blocked)

    @cached_property
    def _computed(self) -> Collection[int]:
        """The rows that can be computed: their limits and shape are looked at as well, which adds findings."""
        return self._nominal.computed.keys()

    @cached_property
    def _errors(self) -> Mapping[int, list[str]]:
        """The errors of each row that cannot be computed; without one of its own, those elsewhere that stop it."""
        by_row: dict[int, list[str]] = defaultdict(list)
        sheet = self.validated.table.sheet if self.validated.table else ""
        for error in self._findings:
            if error.level == "error" and error.sheet == sheet and error.cell:
                by_row[error.row].append(f"{error.code} {error.cell}")
        table = self.validated.table
        stops = stopped_by(table, self._nominal.blocked, self._findings) if table else {}
        for row, errors in stops.items():
            if row not in by_row:
                by_row[row] = [f"{error.code} {error.place}" for error in errors[:_NAMED]]
        return by_row

    @cached_property
    def _rows(self) -> Mapping[int, frozenset[str]]:
        return {variant.row: frozenset(variant.dimensions) for variant in self.validated.variants}

    def material(self, name: Name) -> Used | None:
        """Return the material that a variant uses; None for one that is unknown."""
        record = self.records[name]
        material = self.validated.materials.get(plain(record["material"] or ""))
        if material is None:
            return None
        constants = material.constants | {"yield": material.yield_strength, "density_kg_m3": material.density}
        values = {
            column.dimension: Value(
                value=number,
                shown=None if number is None else number / column.si_unit.si,
                label=column.name,
                unit=column.unit,
            )
            for column in MATERIALS
            if (number := constants.get(column.dimension)) is not None
        }
        return Used(owner=plain(material.name), name=material.name, values=values)

    def tolerances(self, name: Name) -> Used | None:
        """Return the tolerances of a variant's class; None for one that is unknown."""
        record = self.records[name]
        class_name = record["tolerance_class"] or "standard"
        rows = self.validated.classes.get(plain(class_name))
        if rows is None:
            return None
        return Used(
            owner=plain(class_name), name=class_name, values={row.dimension: tolerance_value(row) for row in rows}
        )

    def correlations(self, name: Name) -> Used | None:
        """Return how the dimensions of a variant's class scatter together, by pair; None for a class that is unknown.

        Pairs of which it has but one, or none, do not matter; nor do those that are independent.
        """
        used = self.tolerances(name)
        if used is None:
            return None
        own = self.dimensions(name)
        pairs = self._nominal.computed.correlations.get(used.owner, {})
        values = {" ".join(pair): correlation_value(pair, value) for pair, value in pairs.items() if own >= {*pair}}
        return Used(owner=used.owner, name=used.name, values=values)

    def dimensions(self, name: Name) -> frozenset[str]:
        """Return the dimensions that a variant has itself; none for one with errors."""
        return self._rows.get(self.records[name]["row"], frozenset())

    @cached_property
    def settings(self) -> dict[str, Any]:
        """Return the settings that hold, those that options of the run have replaced among them."""
        run_with = self.submission.run_with or {}
        settings = vars(self.validated.settings) | self.validated.settings.calibrations
        return settings | {key: run_with[key] for key in OVERRIDDEN if key in run_with}


def side_of(path: Path, limits: ReadingLimits) -> Side:
    """Return a report or submission to compare.

    Raises OSError when the file cannot be opened, Refusal when it is neither.
    """
    return side_of_source(Source.at(path, limits), limits)


def side_of_source(source: Source, limits: ReadingLimits) -> Side:
    """Return the same of bytes."""
    return ask(_side, limits_of_reports(limits), source, limits)


def _side(source: Source, limits: ReadingLimits) -> Side:
    """Return a file to compare, read and validated."""
    try:
        report = report_of(source, limits)
        submission = report.submission
    except Refusal as refusal:
        if refusal.code != "E120":
            raise
        report, submission = None, submission_of(source, limits)
    validated = validate(submission, limits)
    if validated.table is None:
        raise Refusal("E109", sheet="Variants", cell="A1")
    side = Side(file=source.name, submission=submission, validated=validated)
    if report is None:
        return side
    results = by_variant(result_rows(report.results), side.records)
    return replace(side, results=results, version=report.version, changes=report.changes)


def by_variant(rows: Mapping[Name, Mapping[str, Any]], names: Iterable[Name]) -> dict[Name, Mapping[str, Any]]:
    """Return rows that were read from a sheet by the names of the variants that they belong to.

    Rows of none keep the name they have. A sheet may give `_x0041_` back as A, so that a name is not the key.
    """
    rows_by_bare_name = dict(zip(_named(_bare(name.text) for name in rows), rows.items(), strict=True))
    wanted = list(names)
    by_name = {}
    for name, bare in zip(wanted, _named(_bare(name.text) for name in wanted), strict=True):
        if bare in rows_by_bare_name:
            by_name[name] = rows_by_bare_name.pop(bare)[1]
    return by_name | {name: row for name, row in rows_by_bare_name.values() if name not in by_name}


def _bare(text: str) -> str:
    """Return a text without the escapes of a workbook, the same of what was written and of what was read back."""
    while (shorter := _ESCAPED.sub(lambda match: chr(int(match[1], 16)), text.replace(_ESCAPE, ""))) != text:
        text = shorter
    return text


def _named(names: Iterable[str]) -> list[Name]:
    """Return names that tell apart the rows of one name."""
    seen: Counter[str] = Counter()
    distinct = []
    for name in names:
        seen[name] += 1
        distinct.append(Name(text=name, occurrence=seen[name]))
    return distinct


def _entered(
    record: Mapping[str, Any], table: Table, fixes: Mapping[tuple[CellAddress | None, str], str | float | None]
) -> dict[str, Any]:
    """Return a row of Variants as it is compared."""
    entered = {}
    for key, column in columns_of("Variants").items():
        value = record[key]
        if (record["row"], key) in table.faulty:
            fix = fixes.get((table.address(record["row"], key), key))
            value = shown(table.entered(record["row"], key))
            if isinstance(fix, float):
                value = fix * table.heading.factors.get(key, 1.0)
        elif value is None and not column.is_number:
            value = column.default
        entered[key] = None if value == 0 and column.zero_is_blank else value
    return entered


def result_rows(sheet: RawSheet | None) -> dict[Name, dict[str, Any]]:
    """Return the rows of a Results sheet by variant; its keys stand in one row, above the first variant."""
    if sheet is None:
        raise Refusal("E122", found="its sheet Results is missing")
    known = {column.key: column for column in result_columns(cross_check=True, elasticity=True)}
    header_row = next((row for row, cells in sheet.rows.items() if {"variant", "status"} <= _texts(cells)), None)
    if header_row is None or header_row > _TOP:
        raise Refusal("E122", found="its sheet Results has no row of keys")
    columns = {key: column for column, key in sheet.rows[header_row].items() if key in known}
    numeric = {key: known[str(key)].is_number for key in columns}
    rows: list[dict[str, Any]] = [
        {str(key): _plain_value(cells.get(column), is_number=numeric[key]) for key, column in columns.items()}
        for row, cells in sheet.rows.items()
        if row > header_row
    ]
    return dict(zip(_named(row["variant"] or "" for row in rows), rows, strict=True))


def frame_rows(results: pl.DataFrame) -> dict[Name, dict[str, Any]]:
    """Return the rows of a Results table by variant."""
    rows = results.to_dicts()
    return dict(zip(_named(row["variant"] or "" for row in rows), rows, strict=True))


def _texts(cells: Mapping[int, Any]) -> set[str]:
    return {value for value in cells.values() if isinstance(value, str)}


def _plain_value(value: Any, *, is_number: bool) -> str | float | None:
    """Return what a cell of Results holds; None for what its column cannot hold."""
    if is_number:
        return float(value) if isinstance(value, int | float) and not isinstance(value, bool) else None
    return None if value is None else str(value)
