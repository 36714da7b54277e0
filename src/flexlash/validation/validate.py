"""Cells → variants in SI and findings: every cell, every relation, all at once."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import polars as pl

from flexlash.reading.raw import RawSheet, Submission
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.schema.columns import columns_of
from flexlash.schema.spellings import plain
from flexlash.schema.variant import CorrelationRow, Material, Settings, ToleranceRow
from flexlash.validation.class_bases import class_names
from flexlash.validation.correlation_rows import correlation_rows_of
from flexlash.validation.csv_findings import report_dialect
from flexlash.validation.decision_sheets import DECISION_SHEETS, decided_by
from flexlash.validation.entry_sheets import (
    entry_sheets,
    report_other_names,
    report_second_tables,
    with_tables,
)
from flexlash.validation.hidden_content import report_hidden_content
from flexlash.validation.ledger import Ledger
from flexlash.validation.materials_and_classes import (
    built_in_materials,
    materials_of,
    standard_class,
    tolerance_classes_of,
)
from flexlash.validation.meant_names import MeantNames
from flexlash.validation.measured_samples import Samples, measured_samples
from flexlash.validation.row_checks import check_cells, check_relations
from flexlash.validation.sample_faults import report_sample_faults
from flexlash.validation.sample_sizes import report_sample_sizes
from flexlash.validation.settings_table import settings_of
from flexlash.validation.template_versions import TEMPLATE_VERSION, check_version
from flexlash.validation.typed_columns import tabulate
from flexlash.validation.unused_classes import report_unused_classes
from flexlash.validation.validated import Table, Validated
from flexlash.validation.variant_rows import VariantRows

__all__ = ["TEMPLATE_VERSION", "validate"]

_OF_THEIR_OWN = frozenset({"Measurements", *DECISION_SHEETS})
"""Sheets whose errors spoil what is taken from them alone, not the rows of Variants."""


def validate(submission: Submission, limits: ReadingLimits | None = None) -> Validated:
    """Return the variants of a submission and all that is wrong with it.

    Raises Refusal when there is no Variants sheet or the template is newer than this program.
    """
    ledger = Ledger(submission.name)
    check_version(submission)
    sheets = entry_sheets(submission, limits or ReadingLimits())
    unclear = report_other_names(submission, sheets, ledger)
    report_second_tables(submission, sheets, ledger)
    sheets = with_tables(sheets, ledger)
    own = {schema: Ledger(ledger.file) for schema in _OF_THEIR_OWN}
    tables, samples = _tables(sheets, ledger, own)
    for sheet in sheets.values():
        report_dialect(sheet, ledger)
    used = _used(submission, sheets.keys() | unclear, tables, samples, ledger)
    variants = tables.get("Variants")
    if variants is not None:
        _check_rows(variants, used, ledger)
        report_unused_classes(tables.get("Tolerances"), variants, used.classes, ledger)
        report_sample_sizes(samples, tables.get("Tolerances"), variants, ledger)
    ledger.apart = frozenset(sheets[name].name for name in DECISION_SHEETS if name in sheets)
    decided = decided_by(tables, unclear, ledger, own)
    ledger.findings += [found for schema in sheets if schema in own for found in own[schema].findings]
    sound = None if variants is None or ledger.everything else _sound(variants.frame, ledger.rows)
    return Validated(
        file=submission.name,
        findings=tuple(ledger.findings),
        blocked=ledger.blocked,
        unit_mistakes=ledger.unit_mistakes,
        table=variants,
        tolerances=tables.get("Tolerances"),
        measurements=tables.get("Measurements"),
        measured=samples.dimensions,
        other_sources=decided.sources.rows,
        sources_are_faulty=decided.sources.are_faulty,
        levers=decided.levers.rows,
        withheld_levers=decided.levers.withheld,
        sweeps=decided.sweeps.rows,
        faulty_sweeps=decided.sweeps.faulty,
        decision_tables={name: tables[name] for name in DECISION_SHEETS if name in tables},
        correlations=tables.get("Correlations"),
        correlation_rows=used.correlations,
        variants=VariantRows(frame=sound, materials=used.materials, settings=used.settings),
        classes=used.classes,
        materials=used.materials,
        settings=used.settings,
        header_rows={schema: table.heading.row for schema, table in tables.items()},
    )


def _tables(
    sheets: Mapping[str, RawSheet], ledger: Ledger, own: Mapping[str, Ledger]
) -> tuple[dict[str, Table], Samples]:
    """Return the typed tables of the entry sheets that have one, and what was measured."""
    tables: dict[str, Table] = {}
    samples = Samples()
    for schema, sheet in sheets.items():
        table = _typed(sheet, schema, own.get(schema, ledger))
        if schema == "Measurements":
            samples = measured_samples(table, own[schema])
        if table is not None:
            tables[schema] = table
    return tables, samples


def _typed(sheet: RawSheet, schema: str, ledger: Ledger) -> Table | None:
    """Return a typed table whose cells were checked one by one, None where there is no header row."""
    table = tabulate(sheet, schema, ledger)
    if table is not None:
        report_hidden_content(sheet, table, ledger)
        check_cells(table, ledger)
    return table


def _sound(frame: pl.DataFrame, faulty: Collection[int]) -> pl.DataFrame:
    """Return the rows that can be computed; the frame itself, held once, where all can."""
    rows = frame["row"].to_list()
    return frame.filter(pl.Series([row not in faulty for row in rows], dtype=pl.Boolean)) if faulty else frame


@dataclass(frozen=True, kw_only=True)
class _Used:
    """What the rows of Variants draw on: materials and classes by plain name, settings, sound rows of Correlations.

    `class_names` are the classes of the sheet as first written.
    """

    materials: Mapping[str, Material]
    classes: Mapping[str, Sequence[ToleranceRow]]
    class_names: Mapping[str, str]
    settings: Settings
    correlations: Sequence[CorrelationRow]


def _used(
    submission: Submission,
    present: Collection[str],
    tables: Mapping[str, Table],
    samples: Samples,
    ledger: Ledger,
) -> _Used:
    """Return materials, tolerance classes and settings of the submission, else the built-in ones."""
    is_workbook = submission.kind == "workbook"
    materials = materials_of(tables["Materials"], ledger) if "Materials" in tables else {}
    if "Materials" not in present:
        materials = built_in_materials()
        if is_workbook:
            ledger.add("I505", value="sheet Materials", other="materials")
    classes: dict[str, list[ToleranceRow]] = {}
    if "Tolerances" in tables:
        classes = tolerance_classes_of(tables["Tolerances"], ledger, samples)
    # Where the classes have no column, which of them there are cannot be told.
    are_named = "Tolerances" not in present or (
        "Tolerances" in tables and "tolerance_class" in tables["Tolerances"].heading.columns
    )
    if "standard" not in classes and are_named:
        classes["standard"] = standard_class()
        if is_workbook:
            ledger.add("I505", value="rows for tolerance class standard", other="class")
    report_sample_faults(samples, classes, tables.get("Tolerances"), ledger)
    settings = settings_of(tables["Settings"], ledger) if "Settings" in tables else Settings()
    tied = tables.get("Correlations") if are_named else None
    correlations = () if tied is None else correlation_rows_of(tied, classes, ledger, tables.get("Tolerances"))
    names = class_names(tables["Tolerances"]) if "Tolerances" in tables else {}
    return _Used(materials=materials, classes=classes, class_names=names, settings=settings, correlations=correlations)


def _check_rows(table: Table, used: _Used, ledger: Ledger) -> None:
    """Check relations, duplicates and references of the Variants rows."""
    if not table.has_entries:
        cell = table.address(table.heading.row + 1, "variant")
        ledger.add("E115", sheet=table.sheet, cell=cell)
        ledger.everything = True
        return
    check_relations(table, ledger)
    _check_duplicates(table, ledger)
    materials = [material.name for material in used.materials.values()]
    classes = [used.class_names.get(key, key) for key in used.classes]
    _check_references(table, ledger, "material", "E307", materials)
    _check_references(table, ledger, "tolerance_class", "E309", classes)
    if "standard" in ledger.classes:
        ledger.rows.update(table.frame.filter(pl.col("tolerance_class").is_null())["row"])


def _check_references(table: Table, ledger: Ledger, key: str, code: str, names: Sequence[str]) -> None:
    """Check that every row names a material or a class that there is; rows of a faulty one are not computed."""
    if ledger.everything and not names:
        return
    faulty = ledger.materials if key == "material" else ledger.classes
    meant = MeantNames(names, table.whole.named[key] if table.whole else table.frame[key].drop_nulls().n_unique())
    known, column = meant.known, columns_of("Variants")[key]
    spellings = {name: plain(name) for name in table.frame[key].drop_nulls().unique()}
    for row, value in table.frame.select("row", key).iter_rows():
        if value is None or (row, key) in table.faulty:
            continue
        spelling = spellings[value]
        if spelling not in known:
            _report(table, ledger, row=row, key=key, value=value, **meant.unknown(code, column, value))
        elif spelling in faulty:
            ledger.rows.add(row)
        elif value != known[spelling]:
            name = known[spelling]
            _report(table, ledger, "I504", row, key, value=value, suggestion=name, certain_value=name)


def _check_duplicates(table: Table, ledger: Ledger) -> None:
    """Mark every row of a name that is used more than once, each with its partners."""
    if table.whole:
        for row in table.frame["row"]:
            if others := table.whole.partners.get(row):
                _report(table, ledger, "E308", row, "variant", value=table.entered(row, "variant"), other=others)
        return
    partners: dict[str, list[int]] = defaultdict(list)
    for row, name in table.frame.select("row", "variant").iter_rows():
        if name is not None:
            partners[name.casefold()].append(row)
    for rows in partners.values():
        for row, others in table.partners(rows, "variant"):
            _report(table, ledger, "E308", row, "variant", value=table.entered(row, "variant"), other=others)


def _report(table: Table, ledger: Ledger, code: str, row: int, key: str, **facts: Any) -> None:
    """Record a finding at a cell of Variants."""
    name = columns_of("Variants")[key].name
    cell = table.address(row, key)
    ledger.add(code, sheet=table.sheet, cell=cell, column=key, name=name, rows=[row], **facts)
