"""Every kind of workbook that flexlash writes, and the commands that write it."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest
import regenerate
from decided_drives import drive
from made_up_parts import faulty_parts, measured_parts
from old_templates import old_workbook

from flexlash.cli import cli
from flexlash.feedback.template.template_workbook import template_bytes

__all__ = ["COMMANDS", "KINDS", "REPORTS", "write_kinds"]

TABLE = """variant,flexspline_type,material,torque_Nm,cylinder_length_mm,mean_radius_mm,wall_thickness_mm,\
disk_inner_radius_mm,hub_fillet_radius_mm,backlash_limit_arcmin,notes
a cup,cup,20Cr2Ni4,800,160,80,1.6,40,2,3.75,=not a formula
a hat,hat,20Cr2Ni4,300,100,60,1.3,80,,3.5,
a cylinder,cylinder,20Cr2Ni4,300,100,60,1.3,,,,<&>
a wall too much,cup,20Cr2Ni4,300,100,60,450,,,,
no torque,cup,20Cr2Ni4,,100,60,1.3,30,,,
"""
COMMANDS = {
    "template.xlsx": "template -o template.xlsx",
    "example.xlsx": "template --example -o example.xlsx",
    "all-sheets.xlsx": "template --with all -o all-sheets.xlsx",
    "upgraded.xlsx": "template --upgrade old.xlsx --with measurements,correlations -o upgraded.xlsx",
    "upgraded-table.xlsx": "template --upgrade table.csv -o upgraded-table.xlsx",
    "example-report.xlsx": "run example.xlsx --samples 256 --method random",
    "table-report.xlsx": "run table.csv --elasticity --cross-check --samples 256",
    "one-report.xlsx": "run one.csv",
    "again.xlsx": "run --from-report table-report.xlsx -o again.xlsx",
    "needs-fixing-report.xlsx": "run needs-fixing.xlsx --samples 256 --method random",
    "needs-fixing-checked.xlsx": "check needs-fixing.xlsx --annotate",
    "needs-fixing-autofixed.xlsx": "check needs-fixing.xlsx --apply-fixes -o needs-fixing-autofixed.xlsx",
    "measured-parts-report.xlsx": "run measured-parts.xlsx",
    "measured-again.xlsx": "run --from-report measured-parts-report.xlsx -o measured-again.xlsx",
    "measured-faulty-checked.xlsx": "check measured-faulty.xlsx --annotate",
    "measured-faulty-autofixed.xlsx": "check measured-faulty.xlsx --apply-fixes -o measured-faulty-autofixed.xlsx",
    "table-checked.xlsx": "check table.csv --annotate",
    "damaged-checked.xlsx": "check damaged.xlsx --annotate",
    "decided-report.xlsx": "run decided.xlsx",
    "decided-checked.xlsx": "check decided.xlsx --annotate",
    "decided-again.xlsx": "run --from-report decided-report.xlsx -o decided-again.xlsx",
    "decided-sweep.xlsx": "sweep decided.xlsx",
    "table-sweep.xlsx": "sweep table.csv --vary wall_thickness_mm=1.2:1.6:0.2 --samples 64",
    "many-report.xlsx": "run many.csv --samples 32 --method random",
    "reports/flexlash-summary.xlsx": "run table.csv one.csv damaged.xlsx none.csv --samples 64 -o reports",
}
"""Each kind of workbook and the command that writes it, in order."""

KINDS = ["decided.xlsx", *COMMANDS, "table-recreated.xlsx"]
"""All of them: a filled template, and the submission that making a report anew writes as well."""

REPORTS = [name for name in KINDS if name.endswith(("report.xlsx", "again.xlsx", "-sweep.xlsx"))]
"""Those that draw charts of the variants."""

_MANY, _LARGE, _DRAWN = 60, 40, 30
"""Rows of a submission, those up to which a report repeats all, and how many it draws: fewer than for a user."""


def _many() -> str:
    """Return a large table of cups whose walls grow from row to row."""
    header, cup, *_ = csv.reader(TABLE.splitlines())
    rows = [[f"cup {number}", *cup[1:6], str(1.4 + number / 200), *cup[7:-1], ""] for number in range(_MANY)]
    return "\n".join(",".join(row) for row in [header, *rows])


def write_kinds(folder: Path) -> None:
    """Write one workbook of each kind into a folder, by giving every command there."""
    (folder / "table.csv").write_text(TABLE, encoding="utf-8")
    (folder / "one.csv").write_text("".join(TABLE.splitlines(keepends=True)[:2]), encoding="utf-8")
    (folder / "many.csv").write_text(_many(), encoding="utf-8")
    old_workbook([["A", "cup", "20Cr2Ni4", 800.0, 160.0, 80.0]]).save(folder / "old.xlsx")
    faulty = (regenerate.ROOT / "data" / "needs-fixing.xlsx").read_bytes()
    (folder / "needs-fixing.xlsx").write_bytes(faulty)
    (folder / "measured-parts.xlsx").write_bytes(template_bytes(measured_parts()))
    (folder / "measured-faulty.xlsx").write_bytes(template_bytes(faulty_parts()))
    (folder / "decided.xlsx").write_bytes(template_bytes(drive()))
    (folder / "damaged.xlsx").write_bytes(faulty[: len(faulty) // 2])
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        patch.setattr("flexlash.analysis.whole_batch.LARGE", _LARGE)
        patch.setattr("flexlash.report.report_data.DRAWN", _DRAWN)
        for command in COMMANDS.values():
            with pytest.raises(SystemExit):
                cli.main(command.split())
