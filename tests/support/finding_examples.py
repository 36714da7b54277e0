"""Submissions that have every finding of the catalogue: what `flexlash explain` and docs/findings.md show is real.

To add a code, add what makes it to one of the submissions below, then run `python tests/support/regenerate.py`.
"""

from __future__ import annotations

import csv
import io
import tempfile
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import openpyxl
from entry_books import entry_book
from measured_parts import HEADERS, measured_rows, samples_of, scattered
from openpyxl.packaging.custom import StringProperty
from small_workbook import MAIN, OLE2, WORKBOOK, archive_of, parts_of

from flexlash.feedback.template.template_workbook import Filling, template_bytes
from flexlash.pipeline import check, run
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.schema.columns import columns_of
from flexlash.schema.findings import Finding

__all__ = ["PENDING", "SUBMISSIONS", "examples"]

PENDING = frozenset({"E118", "E334"})
"""Codes that may stand in the catalogue without an example; both need a fault of the program itself."""

CUP: dict[str, Any] = {
    "variant": "C-1",
    "flexspline_type": "cup",
    "material": "20Cr2Ni4",
    "torque_Nm": 800,
    "cylinder_length_mm": 160,
    "mean_radius_mm": 80,
    "wall_thickness_mm": 1.6,
    "disk_inner_radius_mm": 40,
}
LABELS = {column.key: column.label for column in columns_of("Variants").values()}
Rows = Sequence[Mapping[str, Any]]
Made = tuple[Path, dict[str, Any]]


def _numbered(*changes: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return a sound row for each change, changed."""
    return [CUP | {"variant": f"C-{number}"} | change for number, change in enumerate(changes, start=1)]


def _text(rows: Rows, headers: Mapping[str, str] = LABELS, delimiter: str = ",") -> str:
    """Return rows as a delimited text under their labels."""
    keys = list(dict.fromkeys(key for row in rows for key in row))
    buffer = io.StringIO()
    writer = csv.writer(buffer, delimiter=delimiter, lineterminator="\n")
    writer.writerow([headers.get(key, key) for key in keys])
    writer.writerows([row.get(key, "") for key in keys] for row in rows)
    return buffer.getvalue()


def _file(folder: Path, content: str | bytes, name: str = "study.csv", **options: Any) -> Made:
    path = folder / name
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return path, options


def _book(
    folder: Path, sheets: Mapping[str, Sequence[Sequence[Any]]], change: Callable[[Any], None] | None = None
) -> Made:
    """Write sheets as lists of rows with openpyxl."""
    book = openpyxl.Workbook()
    book.remove(book.active)
    for name, rows in sheets.items():
        sheet = book.create_sheet(name)
        for row in rows:
            sheet.append(list(row))
    if change:
        change(book)
    path = folder / "study.xlsx"
    book.save(path)
    return path, {}


def _lines(rows: Rows) -> list[list[Any]]:
    """Return rows as a sheet's lines under their labels."""
    keys = list(dict.fromkeys(key for row in rows for key in row))
    return [[LABELS.get(key, key) for key in keys], *([row.get(key) for key in keys] for row in rows)]


def _needs_fixing(folder: Path) -> Made:
    from regenerate import needs_fixing

    return _file(folder, template_bytes(needs_fixing()), "needs-fixing.xlsx")


def _variants(folder: Path) -> Made:
    """Write faults in cells and rows of Variants."""
    rows = _numbered(
        {"disk_cone_angle_deg": 120},
        {"torque_Nm": "1e400"},
        {"variant": "twice"},
        {"variant": "twice"},
        {"torque_Nm": 1e-9},
        {"disk_outer_radius_mm": 82},
        {"torque_Nm": 12000},
        {"torque_Nm": 4000, "wall_thickness_mm": 0.6, "cylinder_length_mm": 480},
        {"torque_Nm": 800_000},
        {"wall_thickness_mm": 20},
        {"wall_thickness_mm": 10},
        {"material": " 20cr2ni4", "load_inertia_kg_m2": 50},
        {"hub_fillet_radius_mm": 30, "junction_fillet_radius_mm": 20},
        {"wall_thickness_mm": 0.5},
        {"wall_thickness_mm": 0.9},
        {"disk_inner_radius_mm": 60},
        {"wall_thickness_mm": 0.0016},
        {"backlash_limit_arcmin": 1},
        {"torque_Nm": 6500},
        {"mean_radius_mm": 160, "torque_Nm": 100, "cylinder_length_mm": 1600},
        {"mean_radius_mm": 0.08},
        {"wall_thickness_mm": 450},
        {"wall_thickness_mm": "TBD"},
        {"notes": "n" * 1001},
        {"rated_torque_Nm": 1e9},
        {"tooth_face_width_mm": 165},
        {"radial_deflection_mm": 6},
        {"notes": "moved by a comma"},
    )
    rows[0]["Customer"] = "Example Ltd"
    text = _text(rows, LABELS | {"mean_radius_mm": "Mean radius r_m", "disk_cone_angle_deg": "Disk cone angle [mrad]"})
    text = text.replace(",120,", f",{120 / 180 * 3141.592653589793},", 1)
    first, *rest, last = text.splitlines()
    rest = [f"{first},,Drawing", f"{rest[0]},unnamed,", *(f"{line},," for line in rest[1:]), f"{last},,,1,6"]
    return _file(folder, "\n".join([*rest, *[""] * 70, ",,,?", ""]))


def _tables(folder: Path) -> Made:
    """Write faults in Tolerances and Materials, each in a class or material of its own."""
    wall = {"dimension": "wall_thickness"}
    classes: list[dict[str, Any]] = [
        wall | {"grade": "IT 7"},
        wall | {"lower_deviation": -1, "upper_deviation": 1, "deviation_unit": "N·m"},
        wall | {"lower_deviation": -2, "upper_deviation": 2},
        {"dimension": "wall_thickness", "grade": "2768-v"},
        wall | {"grade": "IT7", "lower_deviation": 0},
        wall | {"lower_deviation": 0},
        wall | {"lower_deviation": 0.1, "upper_deviation": -0.1},
        {"dimension": "torque", "grade": "IT7"},
        wall | {"lower_deviation": 0.02, "upper_deviation": 0.02},
        wall | {"lower_deviation": -0.7, "upper_deviation": 0.7},
        wall | {"lower_deviation": -0.3, "upper_deviation": 0.3},
        wall | {"grade": "2768-m"},
        wall | {"lower_deviation": 0, "upper_deviation": 5},
        wall | {"lower_deviation": -1e-9, "upper_deviation": 1e-9},
        {"dimension": "rim_length", "lower_deviation": -1, "upper_deviation": 3},
    ]
    keys = ("dimension", "lower_deviation", "upper_deviation", "deviation_unit", "grade")
    rows = [
        {"tolerance_class": f"T{number}", **{key: row.get(key, "") for key in keys}}
        for number, row in enumerate(classes, start=1)
    ]
    rows += [{"tolerance_class": "twice", **wall, "grade": "IT7"}] * 2
    rows += [{"tolerance_class": name, **wall, "grade": "IT7"} for name in ("press fit", "pres fit")]
    steel = {"youngs_modulus_GPa": 211, "poisson_ratio": 0.3, "shear_modulus_GPa": ""}
    materials = [
        {"material": "20Cr2Ni4", **steel},
        {"material": "twice", **steel},
        {"material": "Twice", **steel},
        {"material": "half", **steel, "poisson_ratio": ""},
        {"material": "both", **steel, "shear_modulus_GPa": 79},
    ]
    variants = _numbered(*({"tolerance_class": f"T{number}"} for number in range(1, len(classes) + 1)))
    variants[-1] |= {"rim_length_mm": 158, "rim_thickness_mm": 3.2}
    variants += [CUP | {"variant": "pressed", "tolerance_class": "press fit"}]
    variants += [CUP | {"variant": "doubled", "tolerance_class": "twice"}]
    variants += [CUP | {"variant": f"of {material}", "material": material} for material in ("twice", "half")]
    options = {}
    for name, table in (("tolerances", rows), ("materials", materials)):
        options[name] = folder / f"{name}.csv"
        options[name].write_text(_text(table), encoding="utf-8")
    return _file(folder, _text(variants), **options)


def _processes(folder: Path) -> Made:
    """Write processes and bases with faults, each in a class of its own."""
    wall = {"dimension": "wall_thickness", "lower_deviation": -0.02, "upper_deviation": 0.02}
    rows = {
        "unknown sample": wall | {"sample": "walls"},
        "unknown base": {"based_on": "standart"},
        "twice": wall | {"limits_sigma": 3, "standard_deviation": 0.004},
        "above Cp": wall | {"cp": 1.1, "cpk": 1.33},
        "uniform": wall | {"distribution": "uniform", "mean_shift": 0.007},
        "circle": {"based_on": "circle"},
        "far": wall | {"mean_shift": 7, "standard_deviation": 0.004},
        "outside": wall | {"mean_shift": 0.022, "standard_deviation": 0.004},
        "disagree": wall | {"mean_shift": 0.007, "cp": 1.5, "cpk": 1.1},
        "narrow": wall | {"standard_deviation": 4.1e-4},
    }
    return entry_book(
        folder / "study.xlsx",
        variants=[CUP | {"variant": f"of {name}", "tolerance_class": name} for name in rows],
        tolerances=[{"tolerance_class": name} | row for name, row in rows.items()],
    ), {}


def _tied(folder: Path) -> Made:
    """Write correlations with faults, each in a class of its own."""
    wall, disk, radius, young = "wall_thickness", "disk_thickness", "mean_radius", "youngs_modulus"
    pairs = [
        ("twice", wall, disk, 0.5),
        ("twice", disk, wall, 0.6),
        ("itself", wall, wall, 0.5),
        ("exact", wall, "torque", 0.5),
        ("contrary", wall, disk, 0.9),
        ("contrary", wall, radius, 0.9),
        ("contrary", disk, radius, 0.5),
        ("lots", young, wall, 0.5),
    ]
    keys = ("tolerance_class", "dimension_1", "dimension_2", "correlation")
    classes = list(dict.fromkeys(pair[0] for pair in pairs))
    tolerances = [
        {"tolerance_class": name, "dimension": dimension, "lower_deviation": -0.01, "upper_deviation": 0.01}
        for name in classes
        for dimension in (wall, disk, radius, young)
    ]
    return entry_book(
        folder / "study.xlsx",
        variants=[{**CUP, "variant": f"of {name}", "tolerance_class": name, disk + "_mm": 1.6} for name in classes],
        tolerances=tolerances,
        correlations=[dict(zip(keys, pair, strict=True)) for pair in pairs],
    ), {}


def _together(folder: Path) -> Made:
    """Write parts that were measured together, one class that enters another correlation, one that cannot have it."""
    tenths = (-9, -6, -5, -4, -3, -2, -2, -1, -1, 0, 0, 0, 1, 1, 2, 3, 3, 4, 5, 7, 9, 6, -7, 2)
    parts = [
        {"sample": "milled", "part": str(number), "wall_thickness_mm": 1.6 + wall / 1e3, "disk_thickness_mm": disk}
        for number, wall in enumerate(tenths, start=1)
        for disk in [1.6 + (0.8 * wall + 0.5 * tenths[number * 7 % len(tenths)]) / 1e3]
    ]
    tolerances: list[dict[str, Any]] = [
        {"tolerance_class": name, "dimension": dimension, "lower_deviation": -0.03, "upper_deviation": 0.03, **rest}
        for name in ("milled", "entered", "by lots")
        for dimension, rest in (("wall_thickness", {"scatters_between": "lots"}), ("disk_thickness", {}))
    ]
    tolerances = [
        {**row, "sample": "milled"} | ({} if row["tolerance_class"] == "by lots" else {"scatters_between": "parts"})
        for row in tolerances
    ]
    pair = {"dimension_1": "wall_thickness", "dimension_2": "disk_thickness", "correlation": 0.1}
    names = dict.fromkeys(row["tolerance_class"] for row in tolerances)
    return entry_book(
        folder / "study.xlsx",
        variants=[{**CUP, "variant": name, "tolerance_class": name, "disk_thickness_mm": 1.6} for name in names],
        tolerances=tolerances,
        correlations=[{"tolerance_class": "entered", **pair}],
        measurements=parts,
    ), {}


def _settings(folder: Path) -> Made:
    """Write settings with faults."""
    settings = [["Setting", "Value"], ["samples", 1.5], ["seed", 1], ["seed", 2]]
    return _book(folder, {"Variants": _lines([CUP]), "Settings": settings})


def _decided(folder: Path) -> Made:
    """Write Other sources, Levers and Sweep with a fault in each row."""
    clearance = {"enter_as": "mm at radius", "value_arcmin": 0.01, "radius_mm": 80}
    sources: list[dict[str, Any]] = [
        {"source": "tooth clearance", **clearance},
        {"source": "Tooth clearance", **clearance},
        {"source": "coupling", "value_arcmin": 20, "ratio": 100},
        {"source": "key", "side": "output"},
        {"source": "bearing", **clearance, "lower_deviation": -0.03, "upper_deviation": 0.005},
        {"source": "spline", **clearance, "lower_deviation": -0.02, "upper_deviation": 0.02},
        {"source": "runout", "value_arcmin": 0.2, "kind": "random", "lower_deviation": -0.2, "upper_deviation": 0.2},
    ]
    levers: list[dict[str, Any]] = [
        {"dimension": "cylinder_length", "lowest": 200, "highest": 100},
        {"dimension": "wall_thickness", "lowest": 1.2, "highest": 2, "step": 10},
        {"dimension": "disk_inner_radius", "lowest": 0.03, "highest": 0.05},
    ]
    length = {"dimension": "cylinder_length", "from": 100, "to": 200, "step": 20}
    second = dict(zip(("second_from", "second_to", "second_step"), (100, 200, 20), strict=True))
    sweep: list[dict[str, Any]] = [
        length | {"variant": "C-3"},
        length | {"second_dimension": "cylinder_length", **second},
        length | {"step": 150},
        length | {"step": 0.01},
        {"variant": "C-1", "dimension": "bore_diameter", "from": 150, "to": 160, "step": 5},
        {"dimension": "disk_inner_radius", "from": 40, "to": 50, "step": 5},
    ]
    cylinder = {"flexspline_type": "cylinder", "disk_inner_radius_mm": None}
    return entry_book(
        folder / "study.xlsx", variants=_numbered({}, cylinder), other_sources=sources, levers=levers, sweep=sweep
    ), {}


def _without_sources(folder: Path) -> Made:
    """Write a limit of a system that has no sources."""
    return _file(folder, _text(_numbered({"system_limit_arcmin": 5})))


def _calibrated(folder: Path) -> Made:
    filling = Filling(variants=_numbered({"hub_fillet_radius_mm": 2}), settings={"disk_calibration": 0.9})
    return _file(folder, template_bytes(filling), "study.xlsx")


def _headers(folder: Path) -> Made:
    """Write wrong headers."""
    labels = LABELS | {"wall_thickness_mm": "Wal thickness [mm]", "torque_Nm": "Torque T [ft]"}
    row = {key: value for key, value in CUP.items() if key != "cylinder_length_mm"} | {"Mean radius": 80}
    return _file(folder, _text([row], labels))


def _overlooked(folder: Path) -> Made:
    """Write what nobody sees on the screen."""

    def hide(book: Any) -> None:
        sheet = book["Variants"]
        sheet.merge_cells("D2:D3")
        sheet.row_dimensions[4].hidden = True
        for place, cell in enumerate(sheet[4], start=1):
            sheet.cell(90, place, cell.value)
        sheet["A90"] = "far below"
        book["Materials"].sheet_state = "hidden"

    materials = [["Material", "Young's modulus E [GPa]", "Poisson's ratio ν [-]"], ["20Cr2Ni4", 211, 0.3]]
    return _book(folder, {"Variants": _lines(_numbered({}, {}, {})), "Materials": materials}, hide)


def _percentages(folder: Path) -> Made:
    """Write tolerances in cells that show per cent."""

    def shape(book: Any) -> None:
        for cell in ("C2", "D2", "C3", "D3"):
            book["Tolerances"][cell].number_format = "0%"

    tolerances = [
        ["Tolerance class", "Dimension", "Lower deviation", "Upper deviation", "Deviation unit"],
        ["fine", "wall_thickness", -0.05, 0.05, "%"],
        ["fine", "torque", -0.05, 0.05],
    ]
    return _book(folder, {"Variants": _lines([CUP | {"tolerance_class": "fine"}]), "Tolerances": tolerances}, shape)


def _marked(name: str, value: str) -> Callable[[Path], Made]:
    """Return what makes a template with a document property."""

    def made(folder: Path) -> Made:
        def mark(book: Any) -> None:
            book.custom_doc_props.append(StringProperty(name=name, value=value))

        return _book(folder, {"Variants": _lines([CUP])}, mark)

    return made


def _elastic(folder: Path) -> Made:
    """Write parts that formula and elasticity see differently."""
    hat = {
        "flexspline_type": "hat", "mean_radius_mm": 60, "cylinder_length_mm": 48, "wall_thickness_mm": 1.8,
        "disk_inner_radius_mm": "", "disk_outer_radius_mm": 90, "disk_thickness_mm": 5,
        "rim_length_mm": 10, "rim_thickness_mm": 3.6,
    }  # fmt: skip
    hat |= {"tooth_face_width_mm": 10}
    rows = _numbered({"disk_outer_radius_mm": 90}, hat, {"torque_Nm": 9800, "hub_fillet_radius_mm": 1})
    return _file(folder, _text(rows), elasticity=True)


def _whole_drives(folder: Path) -> Made:
    """Return whole drives over their limit on average, in part, and of a limit below that of a part."""
    limits = ({"system_limit_arcmin": 4}, {"system_limit_arcmin": 4.2})
    rows = _numbered(*limits, {"system_limit_arcmin": 3, "backlash_limit_arcmin": 3.75})
    sources = [
        ["Source", "Enter as", "Lower deviation", "Upper deviation", "Radius [mm]"],
        ["tooth clearance", "mm at radius", 0, 0.02, 80],
    ]
    return _book(folder, {"Variants": _lines(rows), "Other sources": sources})


def _measured(folder: Path) -> Made:
    """Write samples of which none is as it should be."""
    rows = [HEADERS, *measured_rows(), *measured_rows(15, "few"), *measured_rows(3, "fewer"), *measured_rows(6, "rest")]
    rows += [["coarse", number, None, 1.6, None] for number in range(1, 13)]
    rows += [["round", number, None, wall, None] for number, wall in enumerate([1.6, 1.61] * 20)]
    rows += [["above", number, None, wall, None] for number, wall in enumerate([0.02, -0.01, 0.0, -0.015, 0.01])]
    rows += [["inch", number, None, None, wall / 25.4] for number, wall in enumerate(scattered(20))]
    rows[5][3], rows[6][0], rows[7][2], rows[9][1] = 16.07, "wal", "deviation", 8
    names = ("wall", "few", "fewer", "coarse", "round", "above")
    variants = _numbered(*({"tolerance_class": name} for name in names))
    variants.append(CUP | {"variant": "inch", "tolerance_class": "inch", "disk_thickness_mm": 1.6})
    tolerances = samples_of(*((name, "wall_thickness", name) for name in names), ("inch", "disk_thickness", "inch"))
    sheets = {"Variants": _lines(variants), "Tolerances": tolerances, "Measurements": rows}
    return _book(folder, {**sheets, "Correlations": [["of prices", 0.3]]})


def _by_machine(folder: Path) -> Made:
    """Write what a measuring machine does, a file of the parts of one sample, beside a submission."""
    parts = folder / "lathe 3.csv"
    lines = [f"{number},{wall:.4f}" for number, wall in enumerate(scattered(60), start=1)]
    parts.write_text("\n".join(["Part,Wall thickness [mm]", *lines]), encoding="utf-8")
    sheets = {"Variants": _lines([CUP]), "Tolerances": samples_of(("standard", "wall_thickness", "lathe 3"))}
    return _book(folder, sheets)[0], {"measurements": parts}


def _fixed(folder: Path) -> Made:
    """Write a table and what was fixed in it."""
    original = _file(folder, _text([CUP]))[0]
    fixed = _file(folder, _text([CUP]), "study-autofixed.csv")[0]
    return fixed, {"given": [original, fixed]}


def _results(folder: Path) -> Made:
    """Write the results of a table."""
    run(_file(folder, _text([CUP]))[0], folder / "results.csv", samples=16, method="random")
    return folder / "results.csv", {}


def _plain(content: str | bytes, name: str = "study.xlsx") -> Callable[[Path], Made]:
    return lambda folder: _file(folder, content, name)


def _sheets(**sheets: Sequence[Sequence[Any]]) -> Callable[[Path], Made]:
    return lambda folder: _book(folder, {name.replace("_", " "): rows for name, rows in sheets.items()})


def _with_units(units: str) -> str:
    """Return a table with a row of units below its headers."""
    header, row = _text([CUP], delimiter=";").splitlines()
    return f"{header}\n;;;{units}\n{row}\n"


GERMAN = _text(_numbered({"wall_thickness_mm": "1,6", "notes": "für Müller"}), delimiter=";")
FOREIGN = parts_of()[WORKBOOK].replace(MAIN, "http://example.com/main")

SUBMISSIONS: dict[str, Callable[[Path], Made]] = {
    "needs fixing": _needs_fixing,
    "tables": _tables,
    "processes": _processes,
    "correlations": _tied,
    "parts measured together": _together,
    "parts of one file": _by_machine,
    "variants": _variants,
    "settings": _settings,
    "decided": _decided,
    "without sources": _without_sources,
    "calibrated": _calibrated,
    "headers": _headers,
    "overlooked": _overlooked,
    "percentages": _percentages,
    "elastic": _elastic,
    "whole drives": _whole_drives,
    "many sources": lambda folder: _book(
        folder,
        {
            "Variants": _lines([CUP]),
            "Other sources": [["Source", "Value"], *([f"play {n}", 0.1] for n in range(1, 53))],
        },
    ),
    "measured": _measured,
    "numbers as text": lambda folder: _book(folder, {"Variants": _lines([CUP | {"torque_Nm": "800"}])}),
    "report": _marked("flexlash", "report"),
    "no report": lambda folder: (_file(folder, _text([CUP]))[0], {"from_report": True}),
    "older report": lambda folder: (_marked("flexlash", "report")(folder)[0], {"from_report": True}),
    "altered report": lambda folder: (_book(folder, {"Carried": [["{"]]})[0], {"from_report": True}),
    "marked": _marked("flexlash", "checked"),
    "fixed": _fixed,
    "results": _results,
    "lock": _plain(b"\x05Anna", "~$study.xlsx"),
    "newer": _marked("flexlash_template_version", "99"),
    "a document": _plain(b"%PDF-1.7", "drawing.pdf"),
    "half a copy": _plain(b"PK\x03\x04half"),
    "locked": _plain(OLE2 + "EncryptedPackage".encode("utf-16-le")),
    "another kind": _plain(archive_of(parts_of() | {WORKBOOK: FOREIGN})),
    "many rows": lambda folder: (_book(folder, {"Variants": _lines([CUP] * 5)})[0], {"limits": ReadingLimits(rows=5)}),
    "old Excel": _plain(OLE2 + b"Workbook", "study.xls"),
    "other letters": _plain(b"a,b\n\x81,2\n", "study.csv"),
    "German": _plain(GERMAN.replace("Δ", "?").encode("cp1252"), "study.csv"),
    "a row of units": _plain(_with_units("[N·m];[mm];[mm];[µm];[mm]"), "study.csv"),
    "digits for notes": _plain(_text([{**CUP, "notes": 5}]), "study.csv"),
    "no sheet": _sheets(Overview=[["a"]]),
    "no header": _sheets(Variants=[["a", "b"]]),
    "no rows": _sheets(Variants=_lines([CUP])[:1]),
    "two sheets": _sheets(Variants=_lines([CUP]), Variants_=_lines([CUP])),
    "a copied sheet": _sheets(Variants=_lines([CUP]), Variants_copy=_lines([CUP])),
    "a sheet of notes": _sheets(Variants=_lines([CUP]), Levers=[["to be agreed"]]),
    "sheets of other names": _sheets(Sheet1=_lines([CUP])),
    "two sheets of one kind": _sheets(
        Variants=_lines([CUP]),
        Tolerance=[["Tolerance class", "Dimension", "Grade", "Distribution"]],
        Limits=[["Tolerance class", "Dimension", "Grade", "Distribution"]],
    ),
    "other rows": _sheets(Variants=[*_lines([CUP]), ["C-2"], [], ["Mean", "cup", None, 800]]),
    "other columns": _plain(
        _text(
            [CUP | {"Rim lenght [mm]": "", "Wall tol": "±0.02", "variant ": "", "disk_inner_radius_mm": 80}],
            LABELS | {"disk_inner_radius_mm": "Hub diameter"},
        ),
        "study.csv",
    ),
    "document type": lambda folder: _file(
        folder, archive_of(parts_of() | {"xl/styles.xml": "<!DOCTYPE a><styleSheet/>"}), "study.xlsx"
    ),
}


RUN = frozenset({"elastic", "whole drives"})
"""Submissions some of whose findings need more than a check."""


def examples(*names: str) -> dict[str, Finding]:
    """Return the first finding of each code that these submissions, or all, have."""
    found: dict[str, Finding] = {}
    for name in names or SUBMISSIONS:
        with tempfile.TemporaryDirectory() as folder:
            path, options = SUBMISSIONS[name](Path(folder))
            outcome = run(path, samples=16, method="random", **options) if name in RUN else check(path, **options)
            for one in outcome.findings:
                found.setdefault(one.code, one)
    return dict(sorted(found.items(), key=lambda entry: ("EWI".index(entry[0][0]), entry[0])))
