"""LibreOffice without a window, set to recalculate every formula when it loads a workbook."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

__all__ = ["convert", "convert_all", "needs_libreoffice", "needs_pages"]

_POPPLER = ("pdfinfo", "pdftotext", "pdftoppm")
_CALIBRI = ("Calibri", "Carlito")
"""The reports' font, and the free one whose letters are as wide."""


def _has_letters_of_calibri() -> bool:
    """Whether LibreOffice sets texts as wide as Excel does, by a font that came with it or one of the system."""
    beside = Path(shutil.which("soffice") or "").resolve().parent.parent
    if any(
        (beside / place / "truetype" / "Carlito-Regular.ttf").exists() for place in ("share/fonts", "Resources/fonts")
    ):
        return True
    if not shutil.which("fc-list"):
        return False
    families = subprocess.run(["fc-list", ":", "family"], check=False, capture_output=True, text=True).stdout
    return any(name in families for name in _CALIBRI)


needs_libreoffice = pytest.mark.skipif(
    not shutil.which("soffice"), reason="LibreOffice (soffice) is not installed here"
)

needs_pages = pytest.mark.skipif(
    not all(map(shutil.which, ("soffice", *_POPPLER))) or not _has_letters_of_calibri(),
    reason="LibreOffice (soffice), poppler-utils or the font Carlito are not installed here",
)
"""For tests that look at printed pages, whose breaks depend on the width of the letters."""

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
