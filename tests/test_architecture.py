"""The house: who may import whom, and how large a room may be."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

SOURCE = Path(__file__).resolve().parent.parent / "src" / "flexlash"
MODULES = sorted(SOURCE.rglob("*.py"))

CORE = {
    "arrays",
    "catalogue",
    "column",
    "columns",
    "exit_codes",
    "explanations",
    "findings",
    "limit_verdict",
    "number_words",
    "parameters",
    "result_columns",
    "stamps",
    "tables",
    "units",
    "variant",
    "workers",
}
ALLOWED = {
    "mechanics": CORE,
    "elasticity": CORE | {"mechanics"},
    "tolerance": CORE,
    "submission": CORE | {"tolerance.grades"},
    "assessment": CORE | {"mechanics", "submission", "tolerance"},
    "examination": CORE | {"assessment", "options", "outcome", "results", "submission"},
    "verification": CORE | {"assessment", "elasticity", "mechanics", "submission"},
    "results": CORE | {"outcome", "submission", "tolerance"},
    "scatter": CORE | {"assessment", "mechanics", "options", "tolerance"},
    "outcome": CORE | {"assessment", "elasticity", "options", "remedies", "submission", "tolerance.curves"},
    "remedies": CORE | {"assessment", "mechanics", "options", "scatter", "tolerance"},
    "outputs": CORE | {"submission"},
    "handback": CORE | {"outcome", "submission"},
    "summary": CORE | {"outcome", "submission"},
    "report": CORE
    | {"assessment", "elasticity", "outcome", "remedies", "summary", "submission", "tolerance"}
    | {"mechanics.fillets", "mechanics.strength", "mechanics.windup"},  # points and bounds that Trace shows
    "pipeline": CORE
    | {
        "assessment",
        "elasticity",
        "examination",
        "handback",
        "mechanics",
        "options",
        "outcome",
        "outputs",
        "remedies",
        "report",
        "results",
        "scatter",
        "submission",
        "summary",
        "verification",
    },
    "comparison": CORE | {"assessment", "submission"},
    "recreation": CORE | {"comparison", "outcome", "outputs", "pipeline", "report", "submission"},
    "commands": CORE
    | {
        "comparison",
        "elasticity",
        "outcome",
        "outputs",
        "pipeline",
        "recreation",
        "submission",
        "summary",
        "terminal",
    },
    "options": CORE | {"outputs", "submission"},
    "terminal": CORE | {"options", "submission"},
    "streams": set(),
    "cli": {"commands", "exit_codes", "streams", "terminal"},
    "__main__": {"cli"},
    "__init__": {"outcome", "pipeline"},
}
EDGES = {
    "openpyxl": {"submission"},
    "xlsxwriter": {"submission", "report"},
    "pandera": {"submission"},
    "click": {"cli", "commands", "terminal"},
    "scipy": {"mechanics", "report", "tolerance"},
    "pebble": {"submission", "workers"},
    "rapidfuzz": {"submission"},
    "skfem": {"elasticity"},
    "matplotlib": {"report"},
}


def _name(path):
    parts = path.relative_to(SOURCE).with_suffix("").parts
    return ".".join(parts).removesuffix(".__init__")


def _imports(path):
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module:
            yield node.module
            if node.module in {"flexlash", "flexlash.mechanics", "flexlash.tolerance"}:
                yield from (f"{node.module}.{alias.name}" for alias in node.names)
        elif isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)


@pytest.mark.parametrize("path", MODULES, ids=_name)
def test_imports_point_one_way(path):
    """A stage imports the core and what the table allows, never a later stage."""
    stage = _name(path).split(".")[0]
    allowed = ALLOWED.get(stage, CORE) | {stage, "__version__"}
    for name in _imports(path):
        if name.startswith("flexlash."):
            target = name.removeprefix("flexlash.")
            assert any(target == one or target.startswith(f"{one}.") for one in allowed), f"{stage} imports {target}"


@pytest.mark.parametrize("path", MODULES, ids=_name)
def test_libraries_stay_at_their_edge(path):
    """Each third-party library is imported in the rooms that are its edge, and nowhere else."""
    stage = _name(path).split(".")[0]
    for name in _imports(path):
        library = name.split(".")[0]
        assert stage in EDGES.get(library, {stage}), f"{stage} imports {library}"


def test_no_rooms_without_a_purpose():
    """No module is called utils, helpers, common, base or manager."""
    names = {part for path in MODULES for part in _name(path).split(".")}
    assert not names & {"utils", "util", "helpers", "common", "base", "manager", "misc"}


@pytest.mark.parametrize("path", MODULES, ids=_name)
def test_modules_and_public_names_are_documented(path):
    """Every module and every public function or class says what it is."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    assert ast.get_docstring(tree)
    for node in tree.body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef) and not node.name.startswith("_"):
            assert ast.get_docstring(node), node.name


@pytest.mark.parametrize("path", MODULES, ids=_name)
def test_functions_are_short(path):
    """No function body is longer than 50 lines, docstring aside."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.FunctionDef):
            start = node.body[1].lineno if ast.get_docstring(node) and len(node.body) > 1 else node.body[0].lineno
            assert node.end_lineno - start < 50, node.name


def test_help_imports_nothing_heavy():
    """`flexlash --help` answers without loading polars, scipy, pandera, numpy or the workbook libraries."""
    code = (
        "import sys\nfrom flexlash.cli import cli\ncli.main(['--help'], standalone_mode=False)\n"
        "heavy = {'polars', 'scipy', 'pandera', 'numpy', 'openpyxl', 'xlsxwriter'} & set(sys.modules)\n"
        "assert not heavy, heavy"
    )
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)


def test_check_does_not_load_the_sampler():
    """Validation loads neither the Sobol' sampler nor the report writer's workbook."""
    study = SOURCE.parent.parent / "data" / "b3-160-study.xlsx"
    code = (
        f"import sys\nfrom flexlash.pipeline import check\ncheck({str(study)!r})\n"
        "assert 'scipy.stats' not in sys.modules and 'flexlash.report.workbook' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)
