"""What is said now holds; what is left open is as an earlier run had it."""

import pytest

from flexlash.options import Options

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


def test_without_an_earlier_run_nothing_changes():
    """Options of an ordinary run stay as they are."""
    assert Options(seed=1).completed(None) == Options(seed=1)
