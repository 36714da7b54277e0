"""An outcome → the files that are wanted beside its report: random units of each variant, and pictures."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from flexlash.analysis.drawn_units import UNITS
from flexlash.analysis.outcome import Outcome
from flexlash.analysis.whole_batch import DRAWN
from flexlash.report.exported_file import ExportedFile
from flexlash.report.extent import extent_of
from flexlash.report.report_data import ROW, Drawn, ReportData, drawn_variants, ranked
from flexlash.schema.angle_unit import AngleUnit
from flexlash.schema.findings import shown
from flexlash.schema.number_words import grouped

if TYPE_CHECKING:
    import polars as pl

__all__ = ["DEPICTED", "UNITS_IN_ALL", "export_notes", "exported_files"]

UNITS_IN_ALL = 1_000_000
"""Most units in a file of samples, which a sheet of Excel can hold as well."""

DEPICTED, _COMPARED = 10, 40
"""Most variants with pictures of their own, and most in the picture that compares them."""

_NAME = 40
"""Most characters of a variant's name in that of a file."""

_EXPLAINED = {"causes": " (dark: at the lower limit)"}

_FORBIDDEN = re.compile(r'[<>:"/\\|?*\s]+')
"""What no name of a file can hold on every system, and spaces."""


def exported_files(
    outcome: Outcome, *, samples: bool, pictures: bool, data: ReportData | None = None
) -> tuple[ExportedFile, ...]:
    """Return what is wanted of an outcome, nothing where no variant has a spread; `data` is what its report draws.

    Samples are one Parquet file: of each variant, or of the worst that a report would draw, the same number of units.
    Pictures are those of the worst variants and one of all, as SVG, and as PNG where matplotlib is installed.
    """
    worst = ranked(outcome)
    if worst.is_empty():
        return ()
    found = [_samples(outcome, worst)] if samples else []
    if pictures:
        drawn = drawn_variants(outcome, DEPICTED) if data is None else data.drawn[:DEPICTED]
        found += _pictures(outcome, worst, drawn)
    return tuple(found)


def export_notes(outcome: Outcome, *, samples: bool, pictures: bool) -> Iterator[str]:
    """Yield which variants are in the files, where these are not all of them, and how many units."""
    computed = extent_of(outcome).total
    if samples and computed:
        drawn = min(DRAWN, computed)
        whose = f"the {grouped(drawn)} worst of {grouped(computed)} variants" if drawn < computed else "each variant"
        yield f"Samples: {grouped(_units_each(drawn))} random units of {whose}."
    if pictures and computed > DEPICTED:
        yield f"Pictures: the {DEPICTED} worst of {grouped(computed)} variants."


def _units_each(variants: int) -> int:
    """Return how many units of each of so many variants are drawn."""
    return min(UNITS, UNITS_IN_ALL // variants)


def _samples(outcome: Outcome, worst: pl.DataFrame) -> ExportedFile:
    from flexlash.report.distribution_output import ROLE, distribution_bytes

    rows = set(worst.head(DRAWN)[ROW])
    kept = {row: variant for row, variant in outcome.computed.items() if row in rows}
    data = distribution_bytes(replace(outcome, computed=kept), ".parquet", UNITS, _units_each(len(kept)))
    return ExportedFile(kind="samples", name="-samples.parquet", data=data, role=ROLE)


def _pictures(outcome: Outcome, worst: pl.DataFrame, drawn: Sequence[Drawn]) -> Iterator[ExportedFile]:
    """Yield the pictures of the worst variants and that of all."""
    from flexlash.report.pictures.raster import is_available, png_file
    from flexlash.report.pictures.standing_alone import ROLE, svg_file

    with_png = is_available()
    labels = _labels([one.row["variant"] for one in drawn], [one.row[ROW] for one in drawn])
    inline = [_comparison(outcome, worst)]
    inline += [
        one
        for variant, label in zip(drawn, labels, strict=True)
        for one in _of_variant(variant, label, outcome.settings.angles)
    ]
    for name, picture, heading in inline:
        svg = svg_file(picture, heading)
        yield ExportedFile(kind="pictures", name=f"{name}.svg", data=svg, role=ROLE)
        if with_png:
            yield ExportedFile(kind="pictures", name=f"{name}.png", data=png_file(svg), role=ROLE)


def _comparison(outcome: Outcome, worst: pl.DataFrame) -> tuple[str, str, str]:
    """Return the picture of all variants: its name, the picture inline, its heading."""
    from flexlash.report.pictures.chart import Spread, spread_chart

    bounds, angles = outcome.settings.verdict_bounds, outcome.settings.angles
    ends = {"low": "p2_5_arcmin", "median": "p50_arcmin", "high": "p97_5_arcmin", "limit": "backlash_limit_arcmin"}
    spreads = [
        Spread(
            variant=row["variant"],
            verdict=bounds.verdict(row["probability_over_limit"]) or "",
            **{end: angles.of(row[key]) for end, key in ends.items() if row[key] is not None},
        )
        for row in worst.head(_COMPARED).to_dicts()
    ]
    picture = spread_chart("comparison", spreads, angles.sign, of=extent_of(outcome).total)
    return "-comparison", picture.inline(), f"{picture.title}: 95 % of units, median and limit"


def _of_variant(variant: Drawn, label: str, angles: AngleUnit) -> Iterator[tuple[str, str, str]]:
    """Yield the pictures of a variant: names, the pictures inline, headings."""
    from flexlash.mechanics.sketch.part_sketch import part_sketch
    from flexlash.mechanics.sketch.sketch_svg import svg
    from flexlash.report.page.one_variant import density_of, segments_of, shares_of
    from flexlash.report.pictures.variant_charts import variant_charts

    name, part = shown(variant.row["variant"], longest=_NAME), variant.computed.variant
    drawing = part_sketch(part.flexspline_type, part.dimensions, name=name)
    yield f"-{label}-part", svg(drawing), drawing.title
    charts = variant_charts(
        density_of(variant, angles), list(shares_of(variant, angles)), list(segments_of(variant, angles))
    )
    for kind, picture in charts.items():
        yield f"-{label}-{kind}", picture.inline(), f"{name}: {picture.title}{_EXPLAINED.get(kind, '')}"


def _labels(names: Sequence[str], rows: Sequence[int]) -> list[str]:
    """Return what stands for variants in names of files: their names, with the row where these would be the same.

    >>> _labels(["C 12/a", "c-12-A", "B"], [2, 3, 4])
    ['C-12-a-row-2', 'c-12-A-row-3', 'B']
    """
    printed = ["".join(letter for letter in name if letter.isprintable() or letter.isspace()) for name in names]
    labels = [_FORBIDDEN.sub("-", name)[:_NAME].strip("-. ") for name in printed]
    folded = [label.casefold() for label in labels]
    return [
        label if label and folded.count(label.casefold()) == 1 else "-".join(filter(None, (label, f"row-{row}")))
        for label, row in zip(labels, rows, strict=True)
    ]
