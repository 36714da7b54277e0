"""The shape of what a page shows of a submission, as it is kept as JSON: whoever shows it loads nothing else.

Every text is short, on one line and without control characters, but may hold anything that a stranger typed: escape
it. Numbers are in the printed unit, angles in that of the report; what is not there is null. Lists are bounded, and say
how many there are in all. The facts of a check (`ran` is false) have findings alone: they come first, while rows are
computed.
"""

from __future__ import annotations

from typing import Literal, NotRequired, TypedDict

__all__ = [
    "Axis",
    "Card",
    "Chart",
    "ChartVariant",
    "Density",
    "FindingFacts",
    "Grid",
    "GridRow",
    "LeverCells",
    "LeverTable",
    "Lost",
    "Number",
    "PageFacts",
    "Refused",
    "Segment",
    "Sentence",
    "Share",
    "TableRow",
    "Tile",
    "UsedLimits",
    "VariantPage",
]


class Tile(TypedDict):
    """A figure and what it counts: `3 of 24`, `rows ready, computed`."""

    number: str
    words: str
    kind: Literal["good", "bad", "warn", "plain"]


class Refused(TypedDict):
    """Why a file is no readable submission; `skipped` says that flexlash itself wrote it."""

    code: str
    title: str
    message: str
    fix: str
    skipped: bool


class GridRow(TypedDict):
    """Cells of one row as entered, one for each column of the grid, an empty text where blank or left out.

    `marked` are the places in it, from 0, of guilty cells; `fixed` are the cells after the certain fixes, an empty
    text where nothing changes, and null for a row without any.
    """

    row: int
    cells: list[str]
    marked: list[int]
    fixed: list[str] | None


class Grid(TypedDict):
    """Some cells drawn like the sheet, its columns by their letters, "…" for those left out between.

    `header_row` is the row of the headers, 0 for a sheet without.
    """

    sheet: str
    columns: list[str]
    header_row: int
    header: list[str]
    rows: list[GridRow]


class FindingFacts(TypedDict):
    """One finding: its place as Excel writes it, the variant and what was entered, in the words of the report."""

    place: str
    variant: str
    value: str
    message: str
    fix: str
    suggestion: str


class Card(TypedDict):
    """The findings of one rule in one sheet: `count` of them at so many `cells`, whose `places` are told as ranges.

    `message` is that of the first, `fix` fixes all of them; `findings` are the first, `more` how many there are beside.
    `grid` has the first cells, null where they cannot be drawn.
    """

    code: str
    level: Literal["error", "warning", "info"]
    title: str
    sheet: str
    count: int
    cells: int
    places: str
    message: str
    fix: str
    suggestion: str
    grid: Grid | None
    findings: list[FindingFacts]
    more: int


class Sentence(TypedDict):
    """What the Summary says on a topic: `kind` is what it is about."""

    topic: str
    text: str
    kind: Literal["computed", "verdict", "cause", "advice", "note", "findings"]


class Axis(TypedDict):
    """A round start and step of an axis that shows everything, and to how many decimals it is labelled."""

    start: float
    step: float
    decimals: int


class ChartVariant(TypedDict):
    """A variant of the chart: its P2.5, median, P97.5, nominal backlash and limit."""

    variant: str
    low: float
    median: float
    high: float
    nominal: float
    limit: float | None
    verdict: str
    page: int | None


class Chart(TypedDict):
    """The worst variants, worst first: `drawn` of `of`; `limits` are the different limits among them, rising."""

    title: str
    unit: str
    axis: Axis
    limits: list[float]
    variants: list[ChartVariant]
    drawn: int
    of: int


class TableRow(TypedDict):
    """A computed variant, angles as texts in the digits that are known.

    `verdict` is `fails`, `marginal`, `meets` or empty without a limit, `settled` whether more points may not change it,
    `light` the Summary's word for it. `page` is the place of its own page among `variants`, from 0, null without one.
    `cheapest` is the cheapest single change of one that misses its limit, a dash where there is none, else empty; facts
    of earlier versions have none.
    """

    variant: str
    row: int
    status: str
    verdict: str
    settled: bool
    light: str
    nominal: str
    median: str
    p97_5: str
    p99_865: str
    limit: str
    distance: str
    over_limit: str
    main_cause: str
    page: int | None
    cheapest: NotRequired[str]


class Lost(TypedDict):
    """A submitted variant that was not computed, and the codes and cells of the errors that are why."""

    variant: str
    row: int
    why: str


class Density(TypedDict):
    """A histogram of the backlash in a unit: equal bins from `start` on, each with its share of all units.

    Facts of earlier versions have no `mean`, and no `unit`: they are in arcmin.
    """

    unit: NotRequired[str]
    start: float
    width: float
    heights: list[float]
    nominal: float
    mean: NotRequired[float]
    limit: float | None


class Share(TypedDict):
    """A dimension's share of the variance, and the backlash with it at its lower and upper limit."""

    name: str
    share: float
    words: str
    low: float | None
    high: float | None


class Segment(TypedDict):
    """A stretch of the part, the nominal backlash that arises there, and its share of the whole."""

    name: str
    backlash: float
    share: float
    words: str


class UsedLimits(TypedDict):
    """A dimension as it was used, in the template's unit: nominal, lower and upper limit, how it scatters between."""

    name: str
    unit: str
    nominal: str
    lower: str
    upper: str
    sd: str
    distribution: str


class LeverCells(TypedDict):
    """A change: its cells as the sheet Levers shows them, whether it can do it, whether it is the cheapest that can."""

    cells: list[str]
    possible: bool
    cheapest: bool


class LeverTable(TypedDict):
    """The single changes of a variant: those that make it `meet` its limit, or how far each may go: `relax`.

    `are_numbers` says of each column whether it holds numbers, `more` how many changes are left out.
    """

    direction: Literal["meet", "relax"]
    headings: list[str]
    are_numbers: list[bool]
    rows: list[LeverCells]
    more: int


class SketchMark(TypedDict):
    """An area, a line through points or words at the first of them [px]; what a kind has not is blank or 0."""

    kind: Literal["area", "stroke", "label"]
    points: list[list[float]]
    colour: str
    hatch: str
    width: float
    dashed: bool
    words: str
    anchor: str


class Sketch(TypedDict):
    """The sketch of a part, and the words that stand for it."""

    width: float
    height: float
    title: str
    description: str
    marks: list[SketchMark]


class Number(TypedDict):
    """A number of Results as the report shows it, with what it means."""

    key: str
    label: str
    value: str
    unit: str
    help: str


class VariantPage(TypedDict):
    """A variant's own page: sentences, distribution, what causes the spread, where the wind-up arises, its numbers.

    `levers` is null without a limit; facts of earlier versions have none, nor a `sketch`.
    """

    variant: str
    row: int
    place: int
    verdict: str
    settled: bool
    light: str
    sentences: list[Sentence]
    density: Density
    shares: list[Share]
    segments: list[Segment]
    limits: list[UsedLimits]
    sketch: NotRequired[Sketch]
    levers: NotRequired[LeverTable | None]
    numbers: list[Number]
    findings: list[FindingFacts]
    more_findings: int


class PageFacts(TypedDict):
    """All that a page shows of a submission.

    `tiles` are of its findings, `verdict_tiles` of its limits, none before rows are computed. `counts` are those of
    `--json`; `cells_to_fix` and `fixable` how many cells have an error and a certain fix. `state` says it in a
    sentence. `findings` is how many there are in all, on `cards` worst first. `table` has the worst of `computed`
    variants, worst first, `lost` the first of `lost_in_all` that were not computed; the first of the table have a page
    in `variants`.
    """

    name: str
    sha256: str
    version: str
    ran: bool
    method: str
    seed: int
    points: str
    target_percent: str
    counts: dict[str, int]
    cells_to_fix: int
    fixable: int
    state: str
    tiles: list[Tile]
    verdict_tiles: list[Tile]
    refused: Refused | None
    findings: int
    cards: list[Card]
    sentences: list[Sentence]
    chart: Chart | None
    table: list[TableRow]
    computed: int
    lost: list[Lost]
    lost_in_all: int
    variants: list[VariantPage]
