"""The Strength sheet: what each section bears, when the wall buckles, how stiff the part is."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from flexlash.mechanics.bending import ENDURANCE
from flexlash.report.extent import Extent
from flexlash.report.layout.paper import SMALL, print_readably
from flexlash.report.layout.styles import Book
from flexlash.report.report_data import Drawn
from flexlash.report.wording.labels import distinct_labels

__all__ = ["write_strength"]

_NAME = 30
_NAME_WIDTH, _WIDTH = 28.0, 10.5
_MEGAPASCAL = 1e6
_COLUMNS = (
    ("wall_shear_MPa", "Wall shear [MPa]", "stress"),
    ("wall_von_mises", "Wall von Mises [MPa]", "stress"),
    ("rim_shear_MPa", "Rim shear [MPa]", "stress"),
    ("rim_von_mises", "Rim von Mises [MPa]", "stress"),
    ("hub_shear_MPa", "Disk shear [MPa]", "stress"),
    ("hub_von_mises", "Disk von Mises [MPa]", "stress"),
    ("hub_shear_radius_mm", "Radius of disk shear [mm]", "plain"),
    ("governing_section", "Governing section", ""),
    ("elastic_limit_torque_Nm", "Elastic limit torque [N·m]", "stress"),
    ("buckling_shear_MPa", "Wall buckles at shear [MPa]", "stress"),
    ("buckling_torque", "Buckling torque [N·m]", "stress"),
    ("buckling_range", "Buckling formula applies", ""),
    ("wall_ratio", "Wall over mean radius", "share"),
    ("stiffness_Nm_per_rad", "Stiffness [N·m/rad]", "count"),
    ("catalogue_size", "Nearest catalogue size", "count"),
    ("catalogue_stiffness_Nm_per_rad", "Whole drives [N·m/rad]", "count"),
    ("lost_motion_arcmin", "Lost motion, flexspline alone [{angle}]", "angle"),
    ("drive_lost_motion_arcmin", "Lost motion, catalogue drive [{angle}]", "angle"),
    ("natural_frequency_Hz", "Natural frequency [Hz]", "stress"),
    ("resonance_speed_rpm", "Resonance at input [rpm]", "count"),
)
_NOTES = (
    "Torsion only: shear stress T/(2π r² t) of each section; von Mises stress √3 times it. The governing section is "
    "the first to yield, at the elastic limit torque, unless the wall buckles before. Peaks at corners come on top; a "
    "run with --elasticity gives those of the fillets.",
    "Buckling of the wall: NASA SP-8007 with its knock-down factor; for shorter cylinders a lower bound. A buckling "
    "stress above yield/√3 means that the wall yields first. The flexspline alone must be stiffer than whole drives.",
    "Lost motion of the flexspline alone is its part of a drive's; beside it the catalogue's for the whole drive of "
    "the nearest size at the same torque, 2 p T_rated/K1; blank beyond the torque T1 where the first slope ends.",
    "The natural frequency is that of the load inertia on the flexspline alone, an upper bound; the input meets it by "
    "its two torque ripples per turn.",
)
_TORSION = ", torsion only [MPa]"
"""How the headings of stresses end where those of bending stand beside them."""

_BENDING_NOTES = (
    "Bending by the wave generator, twice a turn: of a ring that keeps its deflection, without coning of the mouth and "
    "without notches such as tooth roots. All other stresses, and the governing section, are of torsion only.",
    "Alternating: equivalent amplitude of the bending stress. Combined: with the von Mises stress of torsion. Both are "
    f"the greater of wall and rim; an alternating stress above {ENDURANCE:g} of the yield strength is warned of.",
)
_BENDING_COLUMNS = (
    ("bending_stress_MPa", "Bending at wall [MPa]", "stress"),
    ("rim_bending_stress_MPa", "Bending at rim [MPa]", "stress"),
    ("alternating_stress_MPa", "Alternating stress [MPa]", "stress"),
    ("combined_stress_MPa", "Combined stress [MPa]", "stress"),
)
"""What stands there where a variant has a radial deflection."""

_BENDING_AFTER = 1 + max(place for place, (key, *_) in enumerate(_COLUMNS) if key.startswith("hub_"))


def write_strength(book: Book, drawn: Sequence[Drawn], extent: Extent) -> None:
    """Write stresses, limits and stiffness, worst variants first."""
    bends = any(variant.row["bending_stress_MPa"] is not None for variant in drawn)
    columns, notes = (_with_bending(), (*_NOTES, *_BENDING_NOTES)) if bends else (_COLUMNS, _NOTES)
    header = len(notes) + 2
    sheet = book.sheet("Strength")
    sheet.write_string(0, 0, "What the sections bear", book.format("title"))
    sheet.set_row(0, 28)
    for row, note in enumerate(notes, start=1):
        sheet.write_string(row, 0, note, book.format("quiet"))
    if extent.note:
        sheet.write_string(header - 1, 0, extent.note, book.format("quiet"))
    sheet.set_column(0, 0, _NAME_WIDTH)
    sheet.set_column(1, len(columns), _WIDTH)
    print_readably(sheet, [_NAME_WIDTH, *[_WIDTH] * len(columns)], least=SMALL)
    sheet.write_row(
        header, 0, ("Variant", *book.headings(*(heading for _, heading, _ in columns))), book.format("header")
    )
    sheet.set_row(header, 64 if bends else 48)
    labels = distinct_labels([variant.row["variant"] for variant in drawn], _NAME)
    for row, (variant, label) in enumerate(zip(drawn, labels, strict=True), start=header + 1):
        sheet.write_string(row, 0, label, book.format("text"))
        for column, (key, _, number) in enumerate(columns, start=1):
            value = _value(variant, key)
            if isinstance(value, str):
                sheet.write_string(row, column, value, book.format("indented"))
            elif value is not None:
                book.write_figure(sheet, row, column, value, number)
    sheet.freeze_panes(header + 1, 1)
    sheet.repeat_rows(header)


def _with_bending() -> tuple[tuple[str, str, str], ...]:
    """Return the columns with those of bending behind the stresses of torsion, which say so in their headings."""
    torsion = (
        (
            key,
            heading.replace(" [MPa]", _TORSION) if heading.endswith(("shear [MPa]", "Mises [MPa]")) else heading,
            kind,
        )
        for key, heading, kind in _COLUMNS[:_BENDING_AFTER]
    )
    return *torsion, *_BENDING_COLUMNS, *_COLUMNS[_BENDING_AFTER:]


def _value(variant: Drawn, key: str) -> Any:
    """Return what a variant has in a column, stresses in MPa."""
    value = variant.row[key] if key in variant.row else getattr(variant.computed.nominal, key)
    return value / _MEGAPASCAL if isinstance(value, float) and key.endswith("von_mises") else value
