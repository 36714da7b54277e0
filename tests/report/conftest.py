"""The report that most tests of this room look at, made once."""

from __future__ import annotations

import pytest
import regenerate
from libreoffice import convert

from flexlash.pipeline import run


@pytest.fixture(scope="session")
def study(tmp_path_factory):
    """Return the study's outcome and the path of its report, which no test may change."""
    path = tmp_path_factory.mktemp("study") / "report.xlsx"
    return run(regenerate.ROOT / "data" / "b3-160-study.xlsx", path), path


@pytest.fixture(scope="session")
def recalculated(study, tmp_path_factory):
    """Return the path of the study's report as LibreOffice recalculates and saves it."""
    return convert(study[1], "xlsx", tmp_path_factory.mktemp("recalculated"))
