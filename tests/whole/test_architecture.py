"""The house: who may import whom, and how large a room may be."""

from __future__ import annotations

import ast
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest
from grids import for_each

SOURCE = Path(__file__).resolve().parents[2] / "src" / "flexlash"
MODULES = sorted(SOURCE.rglob("*.py"))

ROOMS = (
    "workers",
    "schema",
    "reading",
    "validation",
    "mechanics",
    "tolerance",
    "analysis",
    "decisions",
    "feedback",
    "report",
    "comparison",
    "outputs",
    "pipeline",
    "batch",
    "service",
    "cli",
)
"""The order of the rooms: each imports those before it alone."""

ENTRANCES = {"__init__", "__main__"}

CLIMBS = {
    ("reading.inside_limits", "validation.validate"),
    ("reading.survey", "validation.whole_tables"),
    ("reading.survey_parquet", "validation.whole_tables"),
}
"""The imports that go the other way: the limited process loads before its limits what it will need, and a survey judges
the rows of a table by the functions that judge a table read at once, while nothing holds more than a block of them."""

EDGES = {
    "openpyxl": {"reading"},
    "xlsxwriter": {"batch", "feedback", "report"},
    "pandera": {"validation"},
    "click": {"cli"},
    "scipy": {"decisions", "mechanics", "report", "tolerance"},
    "dask": {"batch"},
    "distributed": {"batch"},
    "rapidfuzz": {"schema"},
    "skfem": {"mechanics"},
    "matplotlib": {"report"},
    "sqlite3": {"service"},
    "filelock": {"service"},
    "starlette": {"service"},
    "uvicorn": {"service"},
    "jinja2": {"service"},
}


def _name(path):
    parts = path.relative_to(SOURCE).with_suffix("").parts
    return ".".join(parts).removesuffix(".__init__")


NAMES = {_name(path): path for path in MODULES}


def _imports(path):
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module:
            names = [f"{node.module}.{alias.name}" for alias in node.names]
            inner = [name for name in names if name.removeprefix("flexlash.") in NAMES]
            yield from inner
            if len(inner) < len(names):
                yield node.module
        elif isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)


@cache
def _edges():
    """Return which module imports which other one of the package."""
    return {
        name: {found.removeprefix("flexlash.") for found in _imports(path)} & set(NAMES) for name, path in NAMES.items()
    }


def test_imports_point_one_way():
    """A room imports those before it in the order alone; the few that do not are named, and stay few."""
    found = {
        (name, target)
        for name, targets in _edges().items()
        for target in targets
        if name.split(".")[0] not in ENTRANCES and ROOMS.index(target.split(".")[0]) > ROOMS.index(name.split(".")[0])
    }
    assert found == CLIMBS


STAGES = (
    "validation.validate",
    "analysis.assessment",
    "analysis.tolerance_spread",
    "analysis.verification",
    "analysis.run_result",
    "report.report_data",
    "outputs.delivery",
    "pipeline",
    "batch",
)
"""The stages of a submission in their order, by the module that returns each one's record."""

RECORDS = ("validation.validated", "analysis.computed", "analysis.outcome")
"""What the stages return: whoever receives it loads none of the code that makes it."""


def _reached(name):
    """Return every module of the package that is loaded with one, whether at once or later."""
    edges, reached, ahead = _edges(), set(), {name}
    while ahead:
        reached |= ahead
        ahead = {target for known in ahead for target in edges[known]} - reached
    return reached


def test_no_stage_imports_a_later_one():
    """Nothing that a stage uses, by however many steps, belongs to a later stage; records belong to none."""
    for number, stage in enumerate(STAGES):
        assert not _reached(stage) & {*STAGES[number + 1 :]}, stage
    for record in RECORDS:
        assert not _reached(record) & {*STAGES}, record


BUILT = {
    "cli.submissions",
    "outputs.plan",
    "reading.delimited",
    "reading.survey",
    "report.submission_sheets",
    "service.progress",
}
"""Where a record is filled step by step by the code beside it, and stays with it."""

OURS = {"schema", "validation", "mechanics", "tolerance", "analysis", "decisions", "comparison", "outputs", "pipeline"}
"""The rooms whose objects are all of our own making; elsewhere, cells and sheets of libraries are given attributes."""


def _assigned(path):
    """Yield the owner of every attribute that a module assigns, as written."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
        for target in targets:
            for one in ast.walk(target) if target is not None else ():
                if isinstance(one, ast.Attribute) and isinstance(one.ctx, ast.Store):
                    yield ast.unparse(one.value)


def test_records_are_never_changed():
    """Every record is frozen, and an object's attributes are assigned by itself alone; the ledger is filled openly."""
    for name, path in NAMES.items():
        text = path.read_text(encoding="utf-8")
        assert "object.__setattr__" not in text, name
        if name not in BUILT:
            for line in text.splitlines():
                assert not line.strip().startswith("@dataclass") or "frozen=True" in line, name
        if name.split(".")[0] in OURS:
            assert set(_assigned(path)) <= {"self", "cls", "ledger", "self.ledger"}, name


def test_every_entry_is_a_room():
    """The folder holds the rooms of the order and the two entrances, nothing else."""
    assert {name.split(".")[0] for name in NAMES} == {*ROOMS, *ENTRANCES}


def test_no_two_modules_have_one_name():
    """A module is called by its last name, which no other has."""
    last = [name.split(".")[-1] for name in NAMES]
    assert {name for name in last if last.count(name) > 1} <= {"__init__"}


@for_each("path", MODULES)
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


@for_each("path", MODULES)
def test_modules_and_public_names_are_documented(path):
    """Every module and every public function or class says what it is."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    assert ast.get_docstring(tree)
    for node in tree.body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef) and not node.name.startswith("_"):
            assert ast.get_docstring(node), node.name


@for_each("path", MODULES)
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


@pytest.mark.slow
def test_check_does_not_load_the_sampler():
    """Validation loads neither the Sobol' sampler nor the report writer's workbook."""
    study = SOURCE.parent.parent / "data" / "b3-160-study.xlsx"
    code = (
        f"import sys\nfrom flexlash.pipeline import check\ncheck({str(study)!r})\n"
        "assert 'scipy.stats' not in sys.modules and 'flexlash.report.workbook' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)
