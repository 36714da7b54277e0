"""What validation returns, apart from the code that makes it: whoever receives it loads nothing else."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

from flexlash.reading.raw import RawValue
from flexlash.reading.whole_table import WholeTable
from flexlash.schema.cell_addresses import CellAddress, cell_ranges
from flexlash.schema.decision_rows import LeverRow, OtherSource, SweepRow
from flexlash.schema.findings import Finding
from flexlash.schema.variant import CorrelationRow, Material, MeasuredDimension, Settings, ToleranceRow
from flexlash.validation.variant_rows import VariantRows

if TYPE_CHECKING:
    import polars as pl

__all__ = ["MANY", "Blocked", "Heading", "Owner", "Table", "UnitMistake", "Validated"]

MANY = 100
"""Rows of one name from which on each is told the range of all instead of its partners."""

Owner: TypeAlias = tuple[Literal["material", "class"], str]
"""A material or a tolerance class, by its plain name."""


@dataclass(frozen=True, kw_only=True)
class Heading:
    """The columns found in a sheet: column and factor to the printed unit by key, extra headers by column.

    `doubtful` are the columns of headers that cannot be taken and the key that was probably meant, `diameters` those of
    them that hold twice what is meant; `ignored` those of the template's own formulas.
    """

    row: int
    columns: dict[str, int] = field(default_factory=dict)
    factors: dict[str, float] = field(default_factory=dict)
    extra: dict[int, str] = field(default_factory=dict)
    doubtful: dict[int, str] = field(default_factory=dict)
    diameters: set[int] = field(default_factory=set)
    ignored: set[int] = field(default_factory=set)


@dataclass(frozen=True, kw_only=True)
class Table:
    """Typed cells of an entry sheet in the template's units.

    `frame` has the column `row` and one column per key of the schema, null where blank or unreadable;
    `cells` are the raw cells by row and column; `faulty` holds (row, key) of cells that already have a finding. `whole`
    are the facts of the table of which these are but some rows.
    """

    sheet: str
    schema: str
    heading: Heading
    frame: pl.DataFrame
    cells: dict[int, dict[int, RawValue]] = field(default_factory=dict)
    faulty: set[tuple[int, str]] = field(default_factory=set)
    numbers_are_texts: bool = False
    whole: WholeTable | None = None

    @property
    def has_entries(self) -> bool:
        """Whether there is an entry, here or in the table of which these are but some rows."""
        return not (self.whole.is_empty if self.whole else self.frame.is_empty())

    @property
    def last_head_row(self) -> int:
        """The last row above the entries that every excerpt of the table holds; what is told of it is told by each."""
        return max(self.heading.row, self.whole.head if self.whole else 0)

    def entered(self, row: int, key: str) -> Any:
        """Return a cell as the user entered it, an empty text where it is blank."""
        return self.cells[row].get(self.heading.columns.get(key, 0), "")

    def address(self, row: int, key: str) -> CellAddress:
        """Return a cell's address; a column that the sheet lacks stands at the row's first cell."""
        return CellAddress(row=row, column=self.heading.columns.get(key, 1))

    def partners(self, rows: Sequence[int], key: str) -> Iterator[tuple[int, str]]:
        """Yield rows that hold the same entry, each with the addresses of the others; of many rows, those of all."""
        few = len(rows) <= MANY
        every = "" if few else cell_ranges([self.address(row, key) for row in rows])
        for row in rows if len(rows) > 1 else ():
            yield row, cell_ranges([self.address(other, key) for other in rows if other != row]) if few else every


@dataclass(frozen=True, kw_only=True)
class UnitMistake:
    """A cell whose unit is mistaken, with what to say of it: `suggestion` is what was probably meant.

    `material` is the plain name of the material whose row it stands in, empty for a cell of Variants.
    """

    sheet: str
    schema: str
    cell: CellAddress
    column: str
    variant: str
    material: str
    row: int
    shown: str
    entered: Any
    times: str
    beside: str
    suggestion: str


@dataclass(frozen=True, kw_only=True)
class Blocked:
    """What is not to be computed because of errors.

    `rows` are rows of Variants; `materials` and `classes` plain names whose rows are faulty, `sources` the sheets and
    rows of their faults; `everything` says that a fault leaves no row computable. `apart` are sheets whose faults stop
    no row, whatever else does.
    """

    rows: frozenset[int] = frozenset()
    materials: frozenset[str] = frozenset()
    classes: frozenset[str] = frozenset()
    sources: Mapping[Owner, Sequence[tuple[str, int]]] = field(default_factory=dict)
    everything: bool = False
    apart: frozenset[str] = frozenset()


@dataclass(frozen=True, kw_only=True)
class Validated:
    """A submission after validation.

    `file` is its name; `findings` are those of validation alone, as they were made; `blocked` is what they spoil.
    `unit_mistakes` are the cells whose unit is mistaken, by sheet, row and column. `table` is Variants as read, one row
    per submitted variant; `tolerances` is Tolerances, None where the built-in class is used; `measurements` and
    `correlations` are those sheets, None where there are none, `correlation_rows` the sound rows of the latter,
    `measured` what was measured, by plain name of the sample and dimension; `other_sources`, `levers` (by
    dimension) and `sweeps` are the sound rows of those sheets. What other rows of them with errors take away:
    `sources_are_faulty` leaves no budget of the drive, since it would lack a source; `withheld_levers` are dimensions,
    or material, of which nothing may be advised, so that `levers` says that they may not change; `faulty_sweeps` are
    rows of Sweep whose studies are left out. `decision_tables` are these sheets by name. `variants` are the rows of
    Variants without an error; `header_rows` the row of each entry sheet's headers.
    """

    file: str = ""
    findings: tuple[Finding, ...] = ()
    blocked: Blocked = field(default_factory=Blocked)
    unit_mistakes: Mapping[tuple[str, int, str], UnitMistake] = field(default_factory=dict)
    table: Table | None = None
    tolerances: Table | None = None
    measurements: Table | None = None
    correlations: Table | None = None
    correlation_rows: Sequence[CorrelationRow] = ()
    measured: Mapping[str, Mapping[str, MeasuredDimension]] = field(default_factory=dict)
    other_sources: Sequence[OtherSource] = ()
    sources_are_faulty: bool = False
    levers: Mapping[str, LeverRow] = field(default_factory=dict)
    withheld_levers: frozenset[str] = frozenset()
    sweeps: Sequence[SweepRow] = ()
    faulty_sweeps: tuple[int, ...] = ()
    decision_tables: Mapping[str, Table] = field(default_factory=dict)
    variants: VariantRows = field(default_factory=VariantRows)
    classes: Mapping[str, Sequence[ToleranceRow]] = field(default_factory=dict)
    materials: Mapping[str, Material] = field(default_factory=dict)
    settings: Settings = field(default_factory=Settings)
    header_rows: Mapping[str, int] = field(default_factory=dict)

    @property
    def submitted(self) -> list[tuple[int, str, str]]:
        """Row number, name and notes of every submitted variant, in submitted order."""
        if self.table is None:
            return []
        return list(self.table.frame.select("row", "variant", "notes").fill_null("").iter_rows())
