"""What the tests of the whole program share: one workbook of every kind."""

from __future__ import annotations

from pathlib import Path

import pytest
from workbook_kinds import write_kinds


@pytest.fixture(scope="session")
def kinds(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with a workbook of every kind, which is only read."""
    path = tmp_path_factory.mktemp("kinds")
    write_kinds(path)
    return path
