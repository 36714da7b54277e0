"""A filled template with few prepared rows, and workbooks with some of its cells replaced by anything."""

from __future__ import annotations

import io
import re
import zipfile
from collections.abc import Iterable, Mapping
from contextlib import contextmanager
from functools import cache
from xml.etree import ElementTree as ET

import pytest
from here import WHERE, answer_here
from measured_parts import scattered
from report_entries import sheet_part
from small_workbook import MAIN, archive_of

from flexlash.feedback.template.entry_rules import FIRST_ROW, HEADER_ROW
from flexlash.feedback.template.template_workbook import Filling, template_bytes
from flexlash.schema.cell_addresses import column_letters
from flexlash.schema.columns import ENTRY_SHEETS
from flexlash.validation.decision_sheets import DECISION_SHEETS

__all__ = [
    "FIRST", "HEADER", "LETTERS", "edited", "last_row", "parts", "reading_here", "records", "small_template", "twelve",
]  # fmt: skip

HEADER, FIRST = HEADER_ROW + 1, FIRST_ROW + 1
"""Row of the headers and first row of entries, as Excel counts."""

LETTERS = {
    sheet: {column.key: column_letters(place) for place, column in enumerate(columns, start=1)}
    for sheet, columns in ENTRY_SHEETS.items()
    if sheet not in DECISION_SHEETS
}
"""Column letters of each entry sheet of the template by key."""

_STYLES = "xl/styles.xml"
_DATE_FORMAT = 14
_ADDRESS = re.compile(r"([A-Z]+)(\d+)")

_CUP = {"flexspline_type": "cup", "material": "Steel alpha", "tolerance_class": "careful"}
_SHOP = {**_CUP, "tolerance_class": "shop"}
_GAUGED = {**_CUP, "tolerance_class": "gauged"}
_HAT = {"flexspline_type": "hat", "material": "Bronze beta", "tolerance_class": "coarse"}
_PIPE = {"flexspline_type": "cylinder", "material": "Shear only"}


def _sized(number: int, radius: float, **rest: object) -> dict[str, object]:
    """Return a row of usual proportions for its radius [mm]."""
    row = {
        "variant": f"Variant {number:02d}",
        "torque_Nm": 0.001 * radius**3,
        "cylinder_length_mm": 1.75 * radius,
        "mean_radius_mm": radius,
        "wall_thickness_mm": 0.0225 * radius,
        **rest,
    }
    return {key: value for key, value in row.items() if value is not None}


def twelve() -> Filling:
    """Return twelve variants of all types with own materials, classes, measured parts and correlations."""
    rim = {"rim_length_mm": 12.0, "rim_thickness_mm": 3.0}
    fillets = {"hub_fillet_radius_mm": 1.5, "junction_fillet_radius_mm": 2.0}
    variants = [
        _sized(1, 80.0, **_CUP, disk_inner_radius_mm=40.0),
        _sized(2, 60.0, **_CUP, disk_inner_radius_mm=30.0, **rim),
        _sized(3, 60.0, **_CUP, disk_inner_radius_mm=32.0, **fillets, notes="as drawn"),
        _sized(4, 50.0, **_SHOP, disk_inner_radius_mm=25.0, disk_thickness_mm=1.25, disk_hub_thickness_mm=2.5),
        _sized(5, 50.0, **_CUP, disk_inner_radius_mm=25.0, disk_thickness_exponent=2.0, disk_hub_thickness_mm=2.5),
        _sized(6, 40.0, **_CUP, disk_inner_radius_mm=20.0, disk_cone_angle_deg=70.0, backlash_limit_arcmin=30.0),
        _sized(7, 70.0, **_HAT, disk_outer_radius_mm=110.0),
        _sized(8, 70.0, **_HAT, disk_outer_radius_mm=105.0, disk_thickness_mm=2.0, **rim),
        _sized(9, 80.0, **_PIPE, rated_torque_Nm=700.0),
        _sized(10, 64.0, **_PIPE, **rim, load_inertia_kg_m2=0.2),
        _sized(11, 75.0, material="Steel alpha", disk_inner_radius_mm=36.0, notes="all by default"),
        _sized(12, 80.0, **_GAUGED, mean_radius_mm=None, bore_diameter_mm=158.0, disk_inner_radius_mm=40.0),
    ]
    materials = [
        {"material": "Steel alpha", "youngs_modulus_GPa": 206.0, "poisson_ratio": 0.3, "yield_MPa": 1100.0},
        {"material": "Bronze beta", "youngs_modulus_GPa": 110.0, "poisson_ratio": 0.34, "density_kg_m3": 8800.0},
        {"material": "Shear only", "shear_modulus_GPa": 79.5, "source": "own tests"},
    ]
    tolerances = [
        {"tolerance_class": "careful", "dimension": "wall_thickness", "lower_deviation": -0.02,
         "upper_deviation": 0.03},
        {"tolerance_class": "careful", "dimension": "cylinder_length", "grade": "js9"},
        {"tolerance_class": "careful", "dimension": "torque", "lower_deviation": -2.0, "upper_deviation": 1.0,
         "deviation_unit": "%", "distribution": "uniform"},
        {"tolerance_class": "coarse", "dimension": "wall_thickness", "lower_deviation": -60.0, "upper_deviation": 50.0,
         "deviation_unit": "µm", "limits_sigma": 2.0},
        {"tolerance_class": "coarse", "dimension": "mean_radius", "grade": "IT8", "distribution": "truncated normal"},
        {"tolerance_class": "shop", "based_on": "careful"},
        {"tolerance_class": "shop", "dimension": "wall_thickness", "lower_deviation": -0.02, "upper_deviation": 0.02,
         "sample": "lathe 3"},
        {"tolerance_class": "shop", "dimension": "disk_thickness", "lower_deviation": -0.02, "upper_deviation": 0.03,
         "sample": "lathe 3"},
        {"tolerance_class": "shop", "dimension": "disk_inner_radius", "lower_deviation": -0.05,
         "upper_deviation": 0.05, "cp": 1.2, "cpk": 0.9},
        {"tolerance_class": "shop", "dimension": "mean_radius", "grade": "IT8", "deviation_unit": "µm",
         "mean_shift": 5.0, "standard_deviation": 4.0, "scatters_between": "parts"},
        {"tolerance_class": "gauged", "based_on": "shop"},
        {"tolerance_class": "gauged", "dimension": "wall_thickness", "lower_deviation": -0.03,
         "upper_deviation": 0.03, "distribution": "measured", "sample": "gauge"},
        {"tolerance_class": "gauged", "dimension": "bore_diameter", "lower_deviation": 0.0, "upper_deviation": 0.04,
         "limits_sigma": 3.0},
    ]  # fmt: skip
    return Filling(
        variants=variants,
        materials=materials,
        tolerances=tolerances,
        measurements=_measurements(),
        correlations=[
            {"tolerance_class": "shop", "dimension_1": "mean_radius", "dimension_2": "disk_inner_radius",
             "correlation": 0.4, "reason": "one set-up"},
            {"tolerance_class": "gauged", "dimension_1": "cylinder_length", "dimension_2": "disk_inner_radius",
             "correlation": -0.3},
        ],
    )  # fmt: skip


def _measurements() -> list[dict[str, object]]:
    """Return deviations of wall and disk of one sample, sizes of the wall of another."""
    deviations = zip(scattered(26, 0.004, 0.004), scattered(26, 0.003, 0.005, turn=7), strict=True)
    lathe = [
        {"sample": "lathe 3", "part": f"L{place}", "use_as": "deviation",
         "wall_thickness_mm": round(wall, 4), "disk_thickness_mm": round(disk, 4)}
        for place, (wall, disk) in enumerate(deviations, start=1)
    ]  # fmt: skip
    gauge = [
        {"sample": "gauge", "part": f"G{place}", "wall_thickness_mm": round(wall, 4)}
        for place, wall in enumerate(scattered(24, 1.803, 0.005), start=1)
    ]
    return [*lathe, *gauge]


@cache
def small_template() -> bytes:
    """Return the template filled with the twelve variants, with no more prepared rows than these."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("flexlash.feedback.template.entry_rules.PREPARED_ROWS", 12)
        patch.setattr("flexlash.feedback.template.entry_rules.SIDE_ROWS", 12)
        return template_bytes(twelve())


@cache
def parts() -> dict[str, bytes]:
    """Return the parts of the small template by name."""
    with zipfile.ZipFile(io.BytesIO(small_template())) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


@cache
def _part(sheet: str) -> str:
    """Return the part of the small template that holds a sheet."""
    with zipfile.ZipFile(io.BytesIO(small_template())) as archive:
        return sheet_part(archive, sheet)


def records(sheet: str) -> dict[int, dict[str, object]]:
    """Return what the small template's rows hold by key, by row number."""
    return dict(enumerate(map(dict, twelve().entries(sheet).rows), start=FIRST))


def last_row(sheet: str) -> int:
    """Return the last filled row of a sheet of the small template."""
    return max(records(sheet))


@contextmanager
def reading_here():
    """Read in this process; for fixtures that outlive a test."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(WHERE, answer_here)
        yield


def edited(
    cells: Mapping[tuple[str, str], tuple[str, str]],
    hidden: Iterable[tuple[str, int]] = (),
    merged: Iterable[tuple[str, str]] = (),
) -> bytes:
    """Return the small template with cells, given by sheet and address, replaced by a kind and a text.

    Kinds: number, text, boolean, error, date, unstored (a formula without a result), blank.
    """
    changed = dict(parts())
    changed[_STYLES] = _with_a_date(changed[_STYLES])
    hidden, merged = list(hidden), list(merged)
    touched = {sheet for sheet, _ in cells} | {sheet for sheet, _ in hidden} | {sheet for sheet, _ in merged}
    for sheet in touched:
        part = _part(sheet)
        root = ET.fromstring(changed[part])  # noqa: S314
        for (name, address), (kind, text) in cells.items():
            if name == sheet:
                _put(root, address, kind, text)
        for name, number in hidden:
            if name == sheet:
                _row(root, number).set("hidden", "1")
        _merge(root, [area for name, area in merged if name == sheet])
        changed[part] = ET.tostring(root, "utf-8", xml_declaration=True)
    return archive_of(changed)


def _with_a_date(styles: bytes) -> bytes:
    """Return the styles with one more cell format, the last: a date."""
    root = ET.fromstring(styles)  # noqa: S314
    formats = root.find(f"{{{MAIN}}}cellXfs")
    ET.SubElement(formats, f"{{{MAIN}}}xf", {"numFmtId": str(_DATE_FORMAT), "applyNumberFormat": "1"})
    formats.set("count", str(len(formats)))
    return ET.tostring(root, "utf-8", xml_declaration=True)


@cache
def _date_style() -> str:
    return str(len(ET.fromstring(parts()[_STYLES]).find(f"{{{MAIN}}}cellXfs")))  # noqa: S314


def _row(root: ET.Element, number: int) -> ET.Element:
    """Return a row of a worksheet, a new one at its place when it has none."""
    rows = root.find(f"{{{MAIN}}}sheetData")
    row = next((row for row in rows if int(row.get("r")) == number), None)
    if row is None:
        row = ET.Element(f"{{{MAIN}}}row", {"r": str(number)})
        rows.insert(sum(int(other.get("r")) < number for other in rows), row)
    return row


def _order(address: str) -> tuple[int, str]:
    letters = _ADDRESS.fullmatch(address)[1]
    return len(letters), letters


def _put(root: ET.Element, address: str, kind: str, text: str) -> None:
    """Replace a cell of a worksheet."""
    row = _row(root, int(_ADDRESS.fullmatch(address)[2]))
    old = next((cell for cell in row if cell.get("r") == address), None)
    style = old.get("s") if old is not None else None
    if old is not None:
        row.remove(old)
    if kind == "blank":
        return
    place = sum(_order(cell.get("r")) < _order(address) for cell in row)
    cell = ET.Element(f"{{{MAIN}}}c", {"r": address, **({"s": style} if style else {})})
    row.insert(place, cell)
    if kind == "text":
        cell.set("t", "inlineStr")
        inline = ET.SubElement(cell, f"{{{MAIN}}}is")
        ET.SubElement(inline, f"{{{MAIN}}}t", {"{http://www.w3.org/XML/1998/namespace}space": "preserve"}).text = text
        return
    if kind == "date":
        cell.set("s", _date_style())
    elif kind in {"boolean", "error"}:
        cell.set("t", kind[0])
    if kind in {"error", "unstored"}:
        ET.SubElement(cell, f"{{{MAIN}}}f").text = "1/0"
    if kind != "unstored":
        ET.SubElement(cell, f"{{{MAIN}}}v").text = text


def _merge(root: ET.Element, areas: list[str]) -> None:
    """Add merged areas to a worksheet, at the place that the order of its elements demands."""
    if areas:
        merges = ET.Element(f"{{{MAIN}}}mergeCells", {"count": str(len(areas))})
        for area in areas:
            ET.SubElement(merges, f"{{{MAIN}}}mergeCell", {"ref": area})
        before = max(
            place for place, one in enumerate(root) if one.tag in {f"{{{MAIN}}}sheetData", f"{{{MAIN}}}sheetProtection"}
        )
        root.insert(before + 1, merges)
