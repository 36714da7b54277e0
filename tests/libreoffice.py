"""LibreOffice without a window, set to recalculate every formula when it loads a workbook."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

__all__ = ["convert", "convert_all", "needs_libreoffice"]

needs_libreoffice = pytest.mark.skipif(
    not all(map(shutil.which, ("soffice", "pdfinfo", "pdftotext"))),
    reason="LibreOffice (soffice) or poppler-utils are not installed here",
)

_PROFILE = """<?xml version="1.0" encoding="UTF-8"?>
<oor:items xmlns:oor="http://openoffice.org/2001/registry">
<item oor:path="/org.openoffice.Office.Calc/Formula/Load">
<prop oor:name="OOXMLRecalcMode" oor:op="fuse"><value>0</value></prop>
</item>
</oor:items>
"""


def convert(path: Path, ending: str, folder: Path) -> Path:
    """Return the recalculated workbook in another form, written into a folder of its own."""
    return convert_all([path], ending, folder)[0]


def convert_all(paths: list[Path], ending: str, folder: Path) -> list[Path]:
    """Return the recalculated workbooks in another form; starting takes longer than converting one more."""
    profile = folder / "profile"
    (profile / "user").mkdir(parents=True, exist_ok=True)
    (profile / "user" / "registrymodifications.xcu").write_text(_PROFILE, encoding="utf-8")
    target = folder / "converted"
    command = [
        "soffice",
        f"-env:UserInstallation={profile.as_uri()}",
        "--headless",
        "--convert-to",
        ending,
        "--outdir",
        str(target),
        *map(str, paths),
    ]
    subprocess.run(command, check=True, capture_output=True, timeout=180 + 10 * len(paths))
    return [target / f"{path.stem}.{ending}" for path in paths]
