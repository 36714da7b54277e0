"""The Elasticity sheet: formula and two-dimensional elasticity side by side, and the stress in pictures."""

from __future__ import annotations

import io
from collections.abc import Sequence

from flexlash.analysis.outcome import Outcome
from flexlash.report.extent import extent_of
from flexlash.report.layout.styles import Book
from flexlash.report.report_data import PICTURED, Drawn, ReportData
from flexlash.report.section_picture import section_png
from flexlash.schema.findings import shown
from flexlash.schema.units import ARCMIN

__all__ = ["NOTES", "write_elasticity", "write_stress"]

NOTES = (
    "Torsion of a body of revolution, ∇·(G r³ ∇φ) = 0 on the half-section with fillets, taper, cone and rim; the hub "
    "bore (hat: bolt circle) is held, the torque enters at the open end, or evenly over the tooth face width where it "
    "is given. Second-order finite elements.",
    "The error is the change from the mesh before, which is greater than what remains. Formula and elasticity are "
    "compared without calibration. The spread keeps the formula: scale it by the difference where that matters.",
    "The hub is held rigidly, so that a sharp corner there shows no notch, though a real one is a notch. Sharp corners "
    "between disk and wall and at the rim have no finite peak; the colours of Stress end below it.",
)
_COLUMNS = (
    ("two_term_backlash_arcmin", "Two-term formula [{angle}]", "angle"),
    ("meridian", "Meridian integral [{angle}]", "angle"),
    ("elasticity", "Elasticity [{angle}]", "angle"),
    ("elasticity_difference_percent", "Meridian over elasticity [%]", "0.00"),
    ("elasticity_error_percent", "Error of elasticity [%]", "0.0000"),
    ("hub_shear_MPa", "Disk shear by formula [MPa]", "stress"),
    ("elasticity_hub_fillet_shear_MPa", "Peak at hub fillet [MPa]", "stress"),
    ("elasticity_junction_fillet_shear_MPa", "Peak at junction fillet [MPa]", "stress"),
)
_LOBE_NOTE = (
    "Two lobes, of cups with a tooth face width, on a rigid, tightly fitting wave generator. Low: all engaged teeth "
    "turn by the same angle, the bearing holds the bore over its width. High: two single teeth carry everything, the "
    "bearing holds the bore in its middle alone. The wave generator's fit is not included: a few µm of play can add "
    "20 to 130 %, most where no tooth rim is thicker than the wall."
)
_LOBE_COLUMNS = (
    ("face_width_change_percent", "Change by the tooth face [%]", "0.00"),
    ("two_lobe_low_arcmin", "Two lobes, low [{angle}]", "angle"),
    ("two_lobe_high_arcmin", "Two lobes, high [{angle}]", "angle"),
)
"""What stands there where a variant has bounds for two lobes."""

_NAME = 30
_OVER = 1.25
"""Where the colours of a picture end, over the greatest stress by formula."""

_PER_ROW = 2
_PICTURE_ROWS = 30
_PICTURE_COLUMNS = 10


def write_elasticity(book: Book, outcome: Outcome, drawn: Sequence[Drawn]) -> None:
    """Write the comparison of all checked variants, in submitted order; of many, of those drawn, worst first."""
    extent = extent_of(outcome)
    sheet = book.sheet("Elasticity", landscape=False)
    sheet.write_string(0, 0, "Check by two-dimensional elasticity", book.format("title"))
    sheet.set_row(0, 28)
    has_lobes = outcome.results["two_lobe_low_arcmin"].count() > 0
    columns = (*_COLUMNS, *(_LOBE_COLUMNS if has_lobes else ()))
    notes = (*NOTES, *((_LOBE_NOTE,) if has_lobes else ()))
    sheet.set_column(0, 0, 26)
    sheet.set_column(1, len(columns), 13)
    for row, note in enumerate(notes, start=1):
        sheet.merge_range(row, 0, row, len(columns), note, book.format("wrap"))
        sheet.set_row(row, 32)
    header = row = len(notes) + 2
    sheet.write_row(
        header, 0, ("Variant", *book.headings(*(heading for _, heading, _ in columns))), book.format("header")
    )
    sheet.set_row(header, 48)
    if extent.large and extent.note:
        sheet.write_string(header - 1, 0, extent.note, book.format("quiet"))
    for record in (variant.row for variant in drawn) if extent.large else outcome.results.iter_rows(named=True):
        if record["windup_rad"] is None:
            continue
        row += 1
        sheet.write_string(row, 0, shown(record["variant"], longest=_NAME), book.format("text"))
        if record["elasticity_windup_rad"] is None:
            sheet.write_string(row, 1, "not checked, see Findings", book.format("quiet"))
            continue
        elastic = 2 * record["elasticity_windup_rad"] / ARCMIN
        meridian = elastic * (1 + record["elasticity_difference_percent"] / 100)
        values = {**record, "meridian": meridian, "elasticity": elastic}
        for column, (key, _, number) in enumerate(columns, start=1):
            if values[key] is not None:
                book.write_figure(sheet, row, column, values[key], number)
    sheet.freeze_panes(header + 1, 1)
    sheet.repeat_rows(header)


def write_stress(book: Book, data: ReportData) -> None:
    """Write the pictures of the worst variants that were checked."""
    if not data.pictured:
        return
    sheet = book.sheet("Stress", landscape=False, pages_tall=1)
    sheet.write_string(0, 0, "Shear stress in the half-section", book.format("title"))
    sheet.set_row(0, 28)
    text = (
        f"Checked variants, worst first, at most {PICTURED}. Each has its own colours; they end at {_OVER:g} times its "
        "greatest stress by formula."
    )
    sheet.write_string(1, 0, text, book.format("quiet"))
    by_name = {variant.row["variant"]: variant for variant in data.drawn}
    for number, (name, check) in enumerate(data.pictured.items()):
        row, column = (number // _PER_ROW) * _PICTURE_ROWS + 4, (number % _PER_ROW) * _PICTURE_COLUMNS
        greatest = _OVER * _greatest_shear(by_name[name])
        title = shown(name, longest=_NAME)
        sheet.write_string(row - 1, column, title, book.format("label"))
        image = io.BytesIO(section_png(check, greatest))
        described = f"Half-section of {title}, coloured by shear stress up to {greatest / 1e6:.3g} MPa"
        options = {"image_data": image, "description": described, "object_position": 2}
        sheet.insert_image(row, column, f"half-section-{number + 1}.png", options)
    pages = -(-len(data.pictured) // _PER_ROW)
    sheet.print_area(0, 0, pages * _PICTURE_ROWS + 2, _PER_ROW * _PICTURE_COLUMNS - 1)


def _greatest_shear(variant: Drawn) -> float:
    """Return the greatest shear stress by formula [Pa]."""
    nominal = variant.computed.nominal
    return max(stress for stress in (nominal.wall_shear, nominal.rim_shear, nominal.hub_shear) if stress is not None)
