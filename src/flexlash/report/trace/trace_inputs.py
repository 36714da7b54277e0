"""The inputs of Trace: what was submitted, what the reader puts in its place, and what counts."""

from __future__ import annotations

from xlsxwriter.utility import xl_rowcol_to_cell

from flexlash.mechanics.windup import mean_radius_from_bore, shear_modulus
from flexlash.report.formula.closed_forms import worked
from flexlash.report.formula.functions import AND, IF, ISNUMBER, OR
from flexlash.report.formula.live import Live, Operand, Range, fill, put
from flexlash.report.trace.inputs import ENTERED
from flexlash.report.trace.trace_page import CHANGE, LEFT_OUT, SUBMITTED, Lines, Page
from flexlash.report.trace.trace_rules import ALWAYS, TYPES
from flexlash.schema.columns import Column

__all__ = ["INPUT_LINES", "what_blank_is", "write_inputs"]

INPUT_LINES = (
    ("torque", "T", ""),
    ("cylinder_length", "l", "inside depth, tooth rim included"),
    ("wall_thickness", "Δ", ""),
    ("bore_diameter", "d", ""),
    ("mean_radius", "r_m", "as given, else (d + Δ)/2"),
    ("disk_thickness", "t", "as given, else Δ"),
    ("disk_inner_radius", "r_ci", "as given, else r_m"),
    ("disk_outer_radius", "r_co", "as given, else r_m"),
    ("disk_hub_thickness", "t_h", "straight taper from t_h at r_ci to t at r_co"),
    ("disk_thickness_exponent", "n", "or power law: thickness t_h (r_ci/r)^n"),
    ("disk_cone_angle", "α", "as given, else 90: a flat disk"),
    ("hub_fillet_radius", "R_h", ""),
    ("junction_fillet_radius", "R_j", ""),
    ("rim_length", "b", ""),
    ("rim_thickness", "t_b", ""),
    ("tooth_face_width", "b_f", "as given, else the teeth load the open end"),
    ("youngs_modulus", "E", ""),
    ("poisson_ratio", "ν", ""),
    ("shear_modulus", "G", "as given, else E / (2 (1 + ν))"),
    ("yield_strength", "σ_y", ""),
    ("cylinder_calibration", "c_c", "factor on the wind-up of tooth face, rim, wall and junction fillet"),
    ("disk_calibration", "c_d", "factor on the wind-up of disk and hub fillet"),
    ("rated_torque", "T_r", ""),
    ("lost_motion_percent", "p", "share of the rated torque at which lost motion is stated"),
    ("backlash_limit", "", ""),
)
_MAY_BE_ZERO = frozenset({"poisson_ratio", "disk_thickness_exponent"})
_LOOKS = dict.fromkeys(_MAY_BE_ZERO, "plain") | {"shear_modulus": "figure"}
_NAMES = {
    "cylinder_calibration": "Calibration of the cylinder",
    "disk_calibration": "Calibration of the disk",
    "lost_motion_percent": "Lost motion at",
}


def write_inputs(page: Page) -> Range:
    """Write the inputs; return the range of the cells for changes."""
    page.section("1  Inputs")
    first = page.row + 1
    _write_words(page)
    bore: Live | None = None
    for name, symbol, equation in INPUT_LINES:
        column = ENTERED[name]
        submitted, change = _cells(page, name, column.label, "general")
        _restrict(page, column, name)
        value = _used(page, name, submitted, change)
        if name == "bore_diameter":
            bore = change
        elif name == "mean_radius" and bore is not None:
            # A bore that the reader types takes the place of a submitted mean radius.
            from_bore = what_blank_is(page, name)
            given = IF(OR(submitted.equals(""), ISNUMBER(bore)), from_bore, submitted)
            value = IF(change.equals(""), given, IF(change.equals(LEFT_OUT), from_bore, change))
        unit = column.unit if column.unit != "-" else ""
        look = _LOOKS.get(name, "size")
        page.line(name, value, (_NAMES.get(name, column.plain_name), symbol, unit, equation), look)
    change_cells = [xl_rowcol_to_cell(row, CHANGE, row_abs=True, col_abs=True) for row in (first, page.row)]
    return Range(":".join(change_cells), [])


def _write_words(page: Page) -> None:
    """Write type and material."""
    submitted, change = _cells(page, "flexspline_type", "Flexspline type", "@")
    page.sheet.data_validation(page.row + 1, CHANGE, page.row + 1, CHANGE, {
        "validate": "list", "source": list(TYPES), "error_title": "Flexspline type",
        "error_message": "Pick one from the list.",
    })  # fmt: skip
    words = ("Flexspline type", "", "", "cup or hat: with a disk or flange; cylinder: without")
    page.line("flexspline_type", _counting(submitted, change), words, "plain")
    style = page.book.format("figure")
    material = put(page.sheet, page.row + 1, SUBMITTED, page.submitted("Material"), style)
    page.line(
        "material",
        IF(material.equals(""), LEFT_OUT, material),
        ("Material", "", "", "its constants stand below"),
        "plain",
    )


def _cells(page: Page, name: str, heading: str, number: str) -> tuple[Live, Live]:
    """Write what was submitted and the cell for a change into the next line; return references to both."""
    submitted = put(page.sheet, page.row + 1, SUBMITTED, page.submitted(heading), page.book.format("figure"))
    change = fill(page.sheet, page.row + 1, CHANGE, "", page.book.format("input", number))
    page.entries[name] = submitted, change
    return submitted, change


def _restrict(page: Page, column: Column, name: str) -> None:
    """Let the cell for a change take what a submission may hold, or the word that leaves it out."""
    cell = xl_rowcol_to_cell(page.row + 1, CHANGE)
    bounds = [f"{cell}{'>' if column.exclusive_minimum else '>='}{column.minimum:.15g}"]
    if column.maximum is not None:
        bounds.append(f"{cell}<={column.maximum:.15g}")
    rule = f'IF(ISNUMBER({cell}),AND({",".join(bounds)}),{cell}="{LEFT_OUT}")'
    required = f"{column.requirement[0].upper()}{column.requirement[1:]} is required here"
    if name in ALWAYS:
        rule = f"AND(ISNUMBER({cell}),{','.join(bounds)})"
    else:
        required += f", or {LEFT_OUT} to leave it out"
    page.sheet.data_validation(page.row + 1, CHANGE, page.row + 1, CHANGE, {
        "validate": "custom", "value": f"={rule}", "error_title": column.plain_name, "error_message": f"{required}.",
    })  # fmt: skip


def _used(page: Page, name: str, submitted: Live, change: Live) -> Live:
    """Return the input that counts: the change, else what was submitted, else what a blank stands for."""
    if name in ALWAYS:
        return _counting(submitted, change)
    other = what_blank_is(page, name)
    entered = IF(submitted.equals(""), other, submitted)
    return IF(change.equals(""), entered, IF(change.equals(LEFT_OUT), other, change))


def _counting(submitted: Live, change: Live) -> Live:
    """Return the change, else what was submitted, which is missing where no variant is picked."""
    return IF(change.equals(""), IF(submitted.equals(""), LEFT_OUT, submitted), change)


def what_blank_is(page: Lines, name: str) -> Operand:
    """Return what a blank input stands for."""
    if name == "mean_radius":
        bore, wall = page["bore_diameter"], page["wall_thickness"]
        has_bore = AND(ISNUMBER(bore), bore > 0, ISNUMBER(wall))
        return IF(has_bore, worked(mean_radius_from_bore, bore, wall), LEFT_OUT)
    if name == "shear_modulus":
        modulus, ratio = page["youngs_modulus"], page["poisson_ratio"]
        is_known = AND(ISNUMBER(modulus), ISNUMBER(ratio), ratio > -1)
        return IF(is_known, worked(shear_modulus, modulus, ratio), LEFT_OUT)
    same_as = {
        "disk_thickness": "wall_thickness",
        "disk_inner_radius": "mean_radius",
        "disk_outer_radius": "mean_radius",
    }
    if name in same_as:
        return page[same_as[name]]
    if name == "disk_cone_angle":
        return IF(page.number > 0, 90.0, LEFT_OUT)
    return LEFT_OUT if name in _MAY_BE_ZERO else 0.0
