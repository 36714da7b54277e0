"""Everything in the tree that is generated: template, example submissions, tables of the documents, list of findings.

`python tests/support/regenerate.py` writes what is stale; `--check` only says so and exits with 1.
"""

from __future__ import annotations

import csv
import datetime
import io
import re
import sys
import tempfile
from dataclasses import fields
from functools import cache
from pathlib import Path

from finding_examples import examples
from made_up_parts import measured_parts

from flexlash.feedback.template.sketch_sheet import sketches
from flexlash.feedback.template.template_workbook import Filling, study, template_bytes
from flexlash.mechanics.sketch.sketch_svg import svg
from flexlash.pipeline import run
from flexlash.reading.raw import ErrorCell, Unstored
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.schema import tables
from flexlash.schema.columns import (
    CORRELATIONS,
    LEVERS,
    MEASUREMENTS,
    OTHER_SOURCES,
    SETTINGS,
    SWEEP,
    TOLERANCES,
    VARIANTS,
    Column,
)
from flexlash.schema.finding_explanations import EXAMPLES, findings_page
from flexlash.schema.findings import CATALOGUE
from flexlash.schema.units import ARCMIN

ROOT = Path(__file__).resolve().parents[2]

_SOUND = {
    "flexspline_type": "cup",
    "material": "20Cr2Ni4",
    "torque_Nm": 800.0,
    "cylinder_length_mm": 160.0,
    "mean_radius_mm": 80.0,
    "wall_thickness_mm": 1.6,
    "disk_inner_radius_mm": 40.0,
}

FAULTS = (
    ("E201", "torque_Nm", {"torque_Nm": None}),
    ("E202", "wall_thickness_mm", {"wall_thickness_mm": "1,6 mm"}),
    ("E203", "torque_Nm", {"torque_Nm": datetime.date(2026, 4, 1)}),
    ("E204", "cylinder_length_mm", {"cylinder_length_mm": True}),
    ("E205", "torque_Nm", {"torque_Nm": ErrorCell("#REF!")}),
    ("E206", "wall_thickness_mm", {"wall_thickness_mm": Unstored()}),
    ("E207", "torque_Nm", {"torque_Nm": -800.0}),
    ("E209", "flexspline_type", {"flexspline_type": "cap"}),
    ("E301", "mean_radius_mm", {"mean_radius_mm": None}),
    ("E302", "mean_radius_mm", {"bore_diameter_mm": 160.0}),
    ("E303", "disk_inner_radius_mm", {"disk_inner_radius_mm": 90.0}),
    ("E304", "rim_thickness_mm", {"rim_length_mm": 25.0}),
    ("E305", "rim_length_mm", {"rim_length_mm": 180.0, "rim_thickness_mm": 3.2}),
    ("E306", "rim_thickness_mm", {"rim_length_mm": 25.0, "rim_thickness_mm": 1.2}),
    ("E307", "material", {"material": "20Cr2Ni5"}),
    ("E309", "tolerance_class", {"tolerance_class": "standart"}),
    (
        "E310",
        "disk_thickness_mm",
        {"flexspline_type": "cylinder", "disk_inner_radius_mm": None, "disk_thickness_mm": 1.6},
    ),
    ("E311", "disk_outer_radius_mm", {"flexspline_type": "hat", "disk_inner_radius_mm": None}),
    ("E312", "hub_fillet_radius_mm", {"hub_fillet_radius_mm": 45.0}),
    (
        "E313",
        "junction_fillet_radius_mm",
        {"junction_fillet_radius_mm": 20.0, "rim_length_mm": 145.0, "rim_thickness_mm": 3.2},
    ),
    ("E325", "disk_hub_thickness_mm", {"disk_thickness_exponent": 2.0}),
    (
        "E326",
        "disk_thickness_mm",
        {"disk_thickness_exponent": 2.0, "disk_hub_thickness_mm": 4.0, "disk_thickness_mm": 1.6},
    ),
    ("E327", "hub_fillet_radius_mm", {"disk_cone_angle_deg": 60.0, "hub_fillet_radius_mm": 2.0}),
    ("E328", "junction_fillet_radius_mm", {"junction_fillet_radius_mm": 85.0}),
)
"""Code, the column it is found in, and what makes the otherwise sound row faulty."""


def needs_fixing() -> Filling:
    """Return three sound rows, and twenty-four rows with a fault each."""
    rows = [
        {"variant": "sound cup", **_SOUND},
        {"variant": "sound bore", **_SOUND, "mean_radius_mm": None, "bore_diameter_mm": 160.0},
        {"variant": "sound cylinder", **_SOUND, "flexspline_type": "cylinder", "disk_inner_radius_mm": None},
    ]
    for code, _, change in FAULTS:
        rows.append({"variant": f"fault {code}", **_SOUND, "notes": CATALOGUE[code].title, **change})
    return Filling(variants=rows)


def catalogue_sizes() -> Filling:
    """Return plausible variants over the catalogue's sizes: three proportions of each, constructed."""
    rows = []
    for entry in tables.rows("catalogue_stiffness"):
        if entry["ratio_from"] != "50":
            continue
        size = int(entry["size"])
        diameter = 2.54 * size
        for name, length, kind in (("long cup", 0.95, "cup"), ("short cup", 0.55, "cup"), ("hat", 0.75, "hat")):
            wall = round(0.0125 * diameter, 2)
            row = {
                "variant": f"size {size} {name}",
                "flexspline_type": kind,
                "material": "40CrNiMoA",
                "torque_Nm": float(entry["T2_Nm"]),
                "cylinder_length_mm": round(length * diameter, 1),
                "bore_diameter_mm": round(diameter, 1),
                "wall_thickness_mm": wall,
                "rated_torque_Nm": float(entry["T2_Nm"]),
                "backlash_limit_arcmin": 2.65,
                "notes": f"Constructed: bore 2.54 mm × size, wall 0.0125 d, l/d {length}; torque T2 of the catalogue",
            }
            if kind == "cup":
                row |= {"disk_inner_radius_mm": round(0.25 * diameter, 1)}
                row |= {"hub_fillet_radius_mm": wall, "junction_fillet_radius_mm": wall}
                row |= {"rim_length_mm": round(0.15 * diameter, 1), "rim_thickness_mm": round(2 * wall, 2)}
            else:
                row |= {"disk_outer_radius_mm": round(0.68 * diameter, 1), "disk_thickness_mm": round(2.5 * wall, 2)}
            rows.append(row)
    return Filling(variants=rows)


def proof() -> Filling:
    """Return B3-160 as published, at its true mean radius, with its fillets, and with a tooth rim in two lengths."""
    plain = {
        "flexspline_type": "cup",
        "material": "20Cr2Ni4",
        "torque_Nm": 800.0,
        "cylinder_length_mm": 160.0,
        "wall_thickness_mm": 1.6,
        "disk_inner_radius_mm": 40.0,
        "backlash_limit_arcmin": 3.5,
    }
    bore = {"bore_diameter_mm": 160.0}
    fillets = bore | {"hub_fillet_radius_mm": 3.5, "junction_fillet_radius_mm": 3.5}
    rim = {"rim_thickness_mm": 3.2}
    return Filling(
        variants=[
            {"variant": "as published", **plain, "mean_radius_mm": 80.0, "notes": "80 mm is the radius of the bore"},
            {"variant": "true mean radius", **plain, **bore},
            {"variant": "fillets", **plain, **fillets, "notes": "R 3.5 mm at hub and junction"},
            {"variant": "fillets, rim 20 mm", **plain, **fillets, **rim, "rim_length_mm": 20.0},
            {"variant": "fillets, rim 30 mm", **plain, **fillets, **rim, "rim_length_mm": 30.0},
        ]
    )


def swept() -> Filling:
    """Return the published study with two parametric studies: the length of case 3, and its hub with its wall."""
    third = {"variant": "B3-160 case 3"}
    length = {"dimension": "cylinder_length", "from": 100.0, "to": 200.0, "step": 20.0}
    hub = {"dimension": "disk_inner_radius", "from": 36.0, "to": 60.0, "step": 2.0}
    wall = {"second_dimension": "wall_thickness", "second_from": 1.4, "second_to": 2.0, "second_step": 0.1}
    published = study()
    return Filling(
        variants=published.variants[:5], tolerances=published.tolerances, sweep=[third | length, third | hub | wall]
    )


def calibrated() -> Filling:
    """Return the published case with factors from its finite elements, which scatter as a model does."""
    variant = {
        "variant": "B3-160 calibrated",
        **_SOUND,
        "backlash_limit_arcmin": 3.5,
        "tolerance_class": "calibrated",
        "notes": "Factors: published FEA over the two-term formula, cylinder 2.78/3.064, disk 2.15/2.298",
    }
    texts = {"dimension", "deviation_unit", "grade", "distribution"}
    standard = [
        {key: text if key in texts else float(text) for key, text in row.items() if text}
        for row in tables.rows("standard_class")
    ]
    uncertain = [
        {"dimension": name, "lower_deviation": -3.0, "upper_deviation": 3.0, "deviation_unit": "%"}
        for name in ("cylinder_calibration", "disk_calibration")
    ]
    return Filling(
        variants=[variant],
        tolerances=[{"tolerance_class": "calibrated", **row} for row in (*standard, *uncertain)],
        settings={"cylinder_calibration": 0.907, "disk_calibration": 0.936},
    )


def column_table(columns: tuple[Column, ...] = VARIANTS) -> str:
    """Return the table of a sheet's columns."""
    lines = ["| column | required | holds | meaning |", "|---|---|---|---|"]
    for column in columns:
        required = "yes" if column.required else ""
        lines.append(f"| {column.label} | {required} | {column.requirement} | {column.help} |")
    return "\n".join(lines)


def limits_table() -> str:
    """Return the table of the limits of reading."""
    lines = ["| limit | at most | what |", "|---|---|---|"]
    for one in fields(ReadingLimits):
        unit = f" {one.metadata['unit']}" if one.metadata["unit"] else ""
        lines.append(f"| `{one.name}` | {one.default:,}{unit} | {one.metadata['what']} |")
    return "\n".join(lines)


def settings_table() -> str:
    """Return the table of the settings."""
    lines = ["| setting | default | meaning |", "|---|---|---|"]
    for column in SETTINGS:
        default = "" if column.default is None else f"`{column.default}`"
        lines.append(f"| `{column.key}` | {default} | {column.help} |")
    return "\n".join(lines)


PUBLISHED = 9.86e-4
"""Backlash of the published finite-element model [rad]."""


def proof_table() -> str:
    """Return the table of B3-160 by formula, meridian integral, elasticity and published finite elements."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "proof.xlsx"
        path.write_bytes(template_bytes(proof()))
        rows = run(path, elasticity=True, method="random", samples=16, jobs=1).results.iter_rows(named=True)
        published = PUBLISHED / ARCMIN
        lines = [
            "| B3-160 | two-term | meridian | elasticity | published FEA |",
            "|---|---|---|---|---|",
        ]
        for row in rows:
            elastic = row["backlash_arcmin"] / (1 + row["elasticity_difference_percent"] / 100)
            cells = (row["two_term_backlash_arcmin"], row["backlash_arcmin"], elastic)
            shown = " | ".join(f"{value:.3f}′ ({100 * (value / published - 1):+.1f} %)" for value in cells)
            lines.append(f"| {row['variant']} | {shown} | {published:.3f}′ |")
    return "\n".join(lines)


def measurements_table() -> str:
    """Return the table of the columns of Measurements; those of the dimensions are one line."""
    named = tuple(column for column in MEASUREMENTS if not column.unit)
    sizes = "| any dimension of Variants |  | a number | What was measured of each part; blank where it was not. |"
    return f"{column_table(named)}\n{sizes}"


def document(path: str, **tables: str) -> bytes:
    """Return a document with its generated tables."""
    text = (ROOT / path).read_text(encoding="utf-8")
    for name, table in tables.items():
        pattern = rf"(<!-- {name}: generated -->\n)(?:(?!<!-- ).)*(<!-- end -->)"
        text, found = re.subn(
            pattern, lambda match, table=table: f"{match[1]}{table}\n{match[2]}", text, flags=re.DOTALL
        )
        if found != 1:
            raise ValueError(f"{path} has no place for its table of {name}")
    return text.encode()


@cache
def messages() -> dict[str, str]:
    """Return a real message of each finding by its code."""
    return {code: found.message for code, found in examples().items()}


def _as_table(entries: dict[str, str]) -> bytes:
    """Return messages by code as a CSV table."""
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(("code", "message"))
    writer.writerows(entries.items())
    return buffer.getvalue().encode()


def generated() -> dict[str, bytes]:
    """Return every generated file by its path in the tree."""
    return {
        "templates/flexlash-template.xlsx": template_bytes(),
        "data/b3-160-study.xlsx": template_bytes(study()),
        "data/catalogue-sizes.xlsx": template_bytes(catalogue_sizes()),
        "data/needs-fixing.xlsx": template_bytes(needs_fixing()),
        "data/b3-160-proof.xlsx": template_bytes(proof()),
        "data/b3-160-calibrated.xlsx": template_bytes(calibrated()),
        "data/b3-160-sweep.xlsx": template_bytes(swept()),
        "data/measured-parts.xlsx": template_bytes(measured_parts()),
        "docs/template.md": document("docs/template.md", columns=column_table(), settings=settings_table()),
        "docs/checking.md": document("docs/checking.md", limits=limits_table()),
        "docs/model.md": document("docs/model.md", proof=proof_table()),
        "docs/tolerances.md": document(
            "docs/tolerances.md",
            tolerances=column_table(TOLERANCES),
            measurements=measurements_table(),
            correlations=column_table(CORRELATIONS),
        ),
        "docs/decisions.md": document(
            "docs/decisions.md",
            levers=column_table(LEVERS),
            sweep=column_table(SWEEP),
            other_sources=column_table(OTHER_SOURCES),
        ),
        f"src/flexlash/schema/tables/{EXAMPLES}.csv": _as_table(messages()),
        "docs/findings.md": findings_page(messages()).encode(),
        **{f"docs/{name}.svg": f"{svg(drawing)}\n".encode() for name, drawing in sketches().items()},
    }


def stale() -> dict[str, bytes]:
    """Return the generated files that differ from what is in the tree."""
    found = {}
    for name, data in generated().items():
        path = ROOT / name
        if not path.exists() or path.read_bytes() != data:
            found[name] = data
    return found


def main() -> int:
    """Write, or with --check only name, the stale files."""
    files = stale()
    for name, data in files.items():
        print(f"{name} is stale")
        if "--check" not in sys.argv:
            (ROOT / name).parent.mkdir(exist_ok=True)
            (ROOT / name).write_bytes(data)
    return 1 if files and "--check" in sys.argv else 0


if __name__ == "__main__":
    sys.exit(main())
