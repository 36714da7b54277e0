"""A drawn variant → its own page: verdict, distribution, causes, segments, limits used, numbers, its findings."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import polars as pl

from flexlash.report.explorer.curves_sheet import CAUSES, SEGMENTS
from flexlash.report.layout.result_formats import number_codes
from flexlash.report.page.cards import finding_facts
from flexlash.report.page.excel_texts import number_text
from flexlash.report.page.lever_cells import lever_table
from flexlash.report.page.shape import (
    Density,
    Number,
    Segment,
    Sentence,
    Share,
    UsedLimits,
    VariantPage,
)
from flexlash.report.page.sketch_facts import sketch_facts
from flexlash.report.page.variants import verdict_of
from flexlash.report.report_data import ROW, Drawn
from flexlash.report.wording.drive_sentences import DRIVE, whole_drive_of
from flexlash.report.wording.lever_sentences import CHANGE, LENGTH, RELAX, lengths, relaxing, what_to_change
from flexlash.report.wording.lot_sentences import LOTS, lots_of
from flexlash.report.wording.measured_parts import PARTS, left_open_by
from flexlash.report.wording.review_sentences import ANOTHER, another_limit_of, strength_of
from flexlash.report.wording.sentences import cause_of
from flexlash.report.wording.summary_facts import SummaryFacts, rough
from flexlash.report.wording.verdict import straddled, verdict_word
from flexlash.report.wording.verdict_sentences import extremes, judged
from flexlash.report.wording.wave_generator import BENDING, TWO_LOBES, bending_of, two_lobes_of
from flexlash.schema.angle_unit import AngleUnit
from flexlash.schema.columns import DIMENSIONS, Column
from flexlash.schema.entry_words import dimension_words
from flexlash.schema.findings import Finding, shown
from flexlash.schema.result_columns import result_columns
from flexlash.schema.units import ARCMIN, as_entered
from flexlash.schema.variant import Limits
from flexlash.tolerance.dimension_limits import distribution_of
from flexlash.tolerance.distribution_curves import HISTOGRAM_BINS

__all__ = ["density_of", "segments_of", "shares_of", "used_limits", "variant_pages"]

_FINDINGS = 5
"""Most findings of a variant that are told."""

_TEXT = 200
"""Most characters of a text of Results."""

_NUMBERS = (
    "backlash_arcmin", "mean_arcmin", "sd_arcmin", "p0_135_arcmin", "p1_arcmin", "p2_5_arcmin", "p5_arcmin",
    "p25_arcmin", "p50_arcmin", "p75_arcmin", "p95_arcmin", "p97_5_arcmin", "p99_arcmin", "p99_865_arcmin",
    "coverage_low_arcmin", "coverage_high_arcmin", "worst_case_low_arcmin", "worst_case_high_arcmin",
    "first_order_sd_arcmin", "first_order_valid", "skewness", "kurtosis", "backlash_limit_arcmin",
    "probability_over_limit", "probability_over_limit_low", "probability_over_limit_high",
    "ppm_over_limit", "probability_over_limit_sample_low", "probability_over_limit_sample_high",
    "p99_865_sample_low_arcmin", "p99_865_sample_high_arcmin",
    "within_lot_sd_arcmin", "between_lots_sd_arcmin", "lots_failing",
    "system_mean_arcmin", "system_rss_high_arcmin", "system_bender_high_arcmin", "system_mean_shift_high_arcmin",
    "system_worst_case_high_arcmin", "system_p99_865_arcmin", "system_limit_arcmin", "system_probability_over_limit",
    "ppk", "ppk_normal", "interaction_share", "disk_share", "cylinder_only_backlash_arcmin",
    "two_term_backlash_arcmin", "lost_motion_arcmin", "drive_lost_motion_arcmin", "stiffness_Nm_per_rad",
    "stiffness_Nm_per_arcmin", "catalogue_stiffness_Nm_per_rad", "wall_shear_MPa", "rim_shear_MPa", "hub_shear_MPa",
    "hub_shear_radius_mm", "von_mises_MPa", "bending_stress_MPa", "rim_bending_stress_MPa", "alternating_stress_MPa",
    "combined_stress_MPa", "governing_section", "elastic_limit_torque_Nm", "buckling_shear_MPa",
    "buckling_range", "natural_frequency_Hz", "resonance_speed_rpm", "cross_check", "cross_check_deviation",
    "elasticity_difference_percent", "elasticity_error_percent", "elasticity_hub_fillet_shear_MPa",
    "elasticity_junction_fillet_shear_MPa", "face_width_change_percent", "two_lobe_low_arcmin", "two_lobe_high_arcmin",
    "spread_method", "spread_points", "spread_note",
)  # fmt: skip
"""Results that a variant's own page has, in the order in which a reader wants them."""

_COLUMNS = {column.key: column for column in result_columns(cross_check=True, elasticity=True)}


def variant_pages(
    facts: SummaryFacts, drawn: Sequence[Drawn], names: Sequence[str], findings: Mapping[int, Sequence[Finding]]
) -> Iterator[VariantPage]:
    """Yield the pages of variants of these short names; `findings` are those of each row of Variants."""
    numbers = _numbers(facts.ranked.head(len(drawn)), facts.angles)
    for place, (variant, name, own) in enumerate(zip(drawn, names, numbers, strict=True)):
        row = variant.row
        found = findings.get(row[ROW], ())
        yield VariantPage(
            variant=name,
            row=row[ROW],
            place=place + 1,
            verdict=verdict_of(row, facts.bounds),
            settled=not straddled(row, facts.bounds),
            light="" if row["backlash_limit_arcmin"] is None else verdict_word(row, facts.bounds),
            sentences=list(_sentences(facts, variant)),
            density=density_of(variant, facts.angles),
            shares=list(shares_of(variant, facts.angles)),
            segments=list(segments_of(variant, facts.angles)),
            limits=[limits for _, limits in used_limits(variant)],
            sketch=sketch_facts(variant.computed.variant, name),
            levers=lever_table(facts.levers, row["variant"]),
            numbers=own,
            findings=[finding_facts(one) for one in found[:_FINDINGS]],
            more_findings=max(0, len(found) - _FINDINGS),
        )


def _sentences(facts: SummaryFacts, variant: Drawn) -> Iterator[Sentence]:
    """Yield what is said of a variant, as the Summary says it of the worst."""
    row = variant.row
    yield Sentence(topic="Verdict", text=" ".join([*judged(facts, row), *extremes(facts, row)]), kind="verdict")
    if left_open := " ".join(left_open_by(facts, row)):
        yield Sentence(topic=PARTS, text=left_open, kind="verdict")
    if lots := " ".join(lots_of(facts, row)):
        yield Sentence(topic=LOTS, text=lots, kind="verdict")
    yield Sentence(topic="Why", text=" ".join(cause_of(facts, row)), kind="cause")
    if other := " ".join(another_limit_of(facts, row)):
        yield Sentence(topic=ANOTHER, text=other, kind="verdict")
    if strength := " ".join(strength_of(facts, row)):
        yield Sentence(topic="Strength", text=strength, kind="note")
    its_own = replace(facts, levers=facts.levers.filter(pl.col("variant") == row["variant"]))
    for topic, advice in ((CHANGE, what_to_change), (RELAX, relaxing), (LENGTH, lengths)):
        if text := " ".join(advice(its_own)):
            yield Sentence(topic=topic, text=text, kind="advice")
    if drive := " ".join(whole_drive_of(facts, row)):
        yield Sentence(topic=DRIVE, text=drive, kind="verdict")
    for topic, told in ((BENDING, bending_of(row)), (TWO_LOBES, two_lobes_of(row, facts.angles))):
        if text := " ".join(told):
            yield Sentence(topic=topic, text=text, kind="note")


def density_of(variant: Drawn, angles: AngleUnit) -> Density:
    """Return the histogram that Explorer draws."""
    curve, row = variant.curve, variant.row
    limit = row["backlash_limit_arcmin"]
    return Density(
        unit=angles.name,
        start=angles.of_radians(float(curve.edges[0])),
        width=angles.of_radians(float(curve.edges[-1] - curve.edges[0]) / HISTOGRAM_BINS),
        heights=[float(f"{height:.5e}") for height in curve.heights.tolist()],
        nominal=angles.of(row["backlash_arcmin"]),
        mean=angles.of(row["mean_arcmin"]),
        limit=None if limit is None else angles.of(limit),
    )


def shares_of(variant: Drawn, angles: AngleUnit) -> Iterator[Share]:
    """Yield the dimensions that move the backlash most, by their share of the variance."""
    spread = variant.computed.spread
    about = "≈" if rough(variant.row) else ""
    shares = spread.shares if spread else {}
    for name in sorted(shares, key=lambda name: (-shares[name], name))[:CAUSES]:
        low, high = spread.swings[name] if spread and name in spread.swings else (None, None)
        yield Share(
            name=dimension_words(name),
            share=shares[name],
            words=f"{about}{100 * shares[name]:.0f} %",
            low=None if low is None else angles.of_radians(low),
            high=None if high is None else angles.of_radians(high),
        )


def segments_of(variant: Drawn, angles: AngleUnit) -> Iterator[Segment]:
    """Yield the stretches of the part in which the nominal backlash arises, from the open end to the hub."""
    nominal = variant.computed.nominal
    for segment, name in SEGMENTS.items():
        angle = getattr(nominal, f"{segment}_windup")
        if isinstance(angle, float) and angle > 0:
            share, backlash = angle / nominal.windup, angles.of(2 * angle / ARCMIN)
            yield Segment(
                name=name,
                backlash=backlash,
                share=share,
                words=f"{backlash:.{4 - angles.fewer}f}{angles.sign}, {100 * share:.1f} %",
            )


def used_limits(variant: Drawn) -> Iterator[tuple[str, UsedLimits]]:
    """Yield the dimensions with how they were used, in the order of the template."""
    entered, limits = variant.computed.variant.dimensions, variant.computed.limits
    for name, column in DIMENSIONS.items():
        is_unused = column.sheet == "Settings" and entered.get(name) == column.default
        if name in entered and not is_unused:
            yield name, _used(column, entered[name], limits.get(name))


def _used(column: Column, nominal: float, limits: Limits | None) -> UsedLimits:
    """Return how a dimension was used; what has no limits, or no room between them, is exact."""
    size = column.si_unit.si
    used = UsedLimits(
        name=column.name if column.sheet != "Settings" else column.plain_name.replace("_", " "),
        unit="" if column.unit == "-" else column.unit,
        nominal=_entry(nominal, size),
        lower="",
        upper="",
        sd="",
        distribution="exact",
    )
    if limits is not None and limits.high > limits.low:
        is_by_sigma = "normal" in limits.distribution and limits.sd is None
        scatter = f", limits at ± {limits.sigma:g} sigma" if is_by_sigma else ""
        shift = f", mean {_entry(limits.mean, size)}" if limits.mean_shift else ""
        used["lower"], used["upper"] = _entry(limits.low, size), _entry(limits.high, size)
        used["sd"] = f"{distribution_of(limits).standard_deviation / size:.3g}"
        lot = ", one value for a lot" if limits.scatters_between == "lots" else ""
        used["distribution"] = f"{limits.distribution}{scatter}{shift}{lot}"
    return used


def _entry(number: float, size: float) -> str:
    return f"{as_entered(number, size):.10g}"


def _numbers(results: pl.DataFrame, angles: AngleUnit) -> list[list[Number]]:
    """Return the numbers of each Results row as the sheet Results shows them, angles in a unit."""
    pages: list[list[Number]] = [[] for _ in range(results.height)]
    in_arcmin = [key for key in results.columns if key.endswith("_arcmin") and "_per_" not in key]
    results = results.with_columns(pl.col(in_arcmin) * angles.per_arcmin)
    for key in (key for key in _NUMBERS if key in results.columns):
        column = replace(_COLUMNS[key], unit=angles.name) if key in in_arcmin else _COLUMNS[key]
        codes = number_codes(results, column) if column.is_number else [""] * results.height
        name, _, unit = column.label.partition(" [")
        unit = angles.name if key in in_arcmin else unit.rstrip("]")
        for page, value, code in zip(pages, results[key].to_list(), codes, strict=True):
            if value is not None:
                text = number_text(value, code) if column.is_number else shown(value, _TEXT)
                page.append(Number(key=key, label=name, value=text, unit=unit, help=column.help))
    return pages
