"""What is said now holds; what is left open is as an earlier run had it."""

from dataclasses import fields

import numpy as np
import pytest

from flexlash.analysis.options import Options
from flexlash.pipeline import check, fix, run

RUN = {"seed": 3, "method": "sobol", "samples": None, "cross_check": True, "elasticity": True, "strict": False}


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ({}, RUN),
        ({"seed": 0}, RUN | {"seed": 0}),
        ({"cross_check": False, "samples": 5}, RUN | {"cross_check": False, "samples": 5}),
        ({"strict": True}, RUN | {"strict": True}),
    ],
)
def test_an_earlier_run_fills_what_is_left_open(given, expected):
    """An option given now wins, even when it switches something off; the others come from the earlier run."""
    completed = Options(**given).completed(RUN)
    assert {name: getattr(completed, name) for name in RUN} == expected


REFUSED = [
    (ValueError, {"method": "sobl"}, "method = 'sobl': one of line, sobol, random is required; did you mean sobol?"),
    (ValueError, {"jobs": 0}, "jobs = 0: a whole number of at least 1 is required"),
    (TypeError, {"jobs": None}, "jobs = None: a whole number of at least 1 is required"),
    (TypeError, {"jobs": True}, "jobs = True: a whole number of at least 1 is required"),
    (TypeError, {"strict": "x"}, "strict = 'x': True or False is required"),
    (TypeError, {"cross_check": 1}, "cross_check = 1: True or False is required"),
    (TypeError, {"from_report": None}, "from_report = None: True or False is required"),
    (TypeError, {"samples": 1.5}, "samples = 1.5: a whole number of at least 1 and at most 4194304 is required"),
    (ValueError, {"samples": 0}, "samples = 0: a whole number of at least 1 and at most 4194304 is required"),
    (ValueError, {"seed": -1}, "seed = -1: a whole number of at least 0 and at most 4294967295 is required"),
    (ValueError, {"seed": 2**32}, "seed = 4294967296: a whole number of at least 0 and at most 4294967295 is required"),
    (TypeError, {"tolerances": 5}, "tolerances = 5: the path of a file, as a text or a pathlib.Path, is required"),
    (
        TypeError,
        {"marked_copy": b"x"},
        "marked_copy = b'x': the path of a file, as a text or a pathlib.Path, is required",
    ),
    (
        TypeError,
        {"limits": {"rows": 5}},
        "limits = {'rows': 5}: ReadingLimits, as ReadingLimits.of makes them, is required",
    ),
    (TypeError, {"progress": 1}, "progress = 1: a function of how many steps are done, and of how many, is required"),
    (TypeError, {"sede": 1}, "run() takes no argument sede; did you mean seed?"),
]


@pytest.mark.parametrize(("fault", "given", "message"), REFUSED)
def test_wrong_options_are_refused_by_name(fault, given, message):
    """Each option of the Python interface is checked before a file is opened, with its name in the refusal."""
    for call in (run, check, lambda file, **options: fix(file, "fixed.xlsx", **options)):
        name = {run: "run()", check: "check()"}.get(call, "fix()")
        with pytest.raises(fault) as refusal:
            call("absent.xlsx", **given)
        assert str(refusal.value) == message.replace("run()", name)


def test_every_option_is_checked():
    """No option can be given that nothing looks at."""
    for option in fields(Options):
        with pytest.raises((TypeError, ValueError), match=f"^{option.name} = "):
            Options.of("run()", {option.name: object()})


@pytest.mark.parametrize("call", [run, check, lambda file: fix(file, "fixed.xlsx"), lambda file: run("a.xlsx", file)])
@pytest.mark.parametrize("file", [5, b"a.xlsx", ["a.xlsx"]])
def test_files_are_paths(call, file):
    """Submission and output are a text or a path."""
    with pytest.raises(TypeError, match=r"^(submission|output) = .*: the path of a file"):
        call(file)


def test_options_of_numpy_serve():
    """Numbers and truths of NumPy are taken as Python's own."""
    chosen = Options.of("run()", {"seed": np.int64(3), "jobs": np.uint8(2), "strict": np.True_})
    assert chosen == Options(seed=3, jobs=2, strict=True)
    assert type(chosen.seed) is int


def test_without_an_earlier_run_nothing_changes():
    """Options of an ordinary run stay as they are."""
    assert Options(seed=1).completed(None) == Options(seed=1)
