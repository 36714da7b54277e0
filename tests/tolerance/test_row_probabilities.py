"""Probabilities over the limit alone, beside those of whole statistics."""

from dataclasses import replace

import numpy as np
import pytest
from b3_160 import CUP, NOMINAL
from toleranced import SUM, plan, row, statistics_of_row
from unlike_rows import ROWS

from flexlash.schema.variant import Limits
from flexlash.tolerance.row_probabilities import probabilities_over

JUMP = row(lambda size: np.floor(size["torque"]), {"torque": 800.0}, {"torque": Limits(low=790.0, high=810.0)}, 803.0)
PAIR = ("mean_radius", "wall_thickness")
TIED = replace(
    row(
        CUP,
        NOMINAL,
        {
            name: Limits(low=0.99 * NOMINAL[name], high=1.01 * NOMINAL[name])
            for name in ("mean_radius", "wall_thickness")
        },
        1.09e-3,
    ),
    correlation=((*PAIR, 0.6),),
)


def _limited():
    """Return rows of every kind, each with a limit somewhere about its output, and some that lines do not serve."""
    rows = [
        replace(one, upper_limit=(0.98 + 0.004 * number) * float(one.model(one.nominal)))
        for number, one in enumerate(ROWS)
    ]
    return [*rows, SUM, JUMP, TIED, TIED]


@pytest.mark.slow
@pytest.mark.parametrize("method", ["line", "sobol", "random"])
def test_a_probability_alone_has_the_bits_of_the_whole_statistics(method):
    """Asked alone, the probability over the limit and its interval are to the last bit those that a report has."""
    sampling, rows = plan(method, 256 if method != "line" else None, 3), _limited()
    expected = [statistics_of_row(one, sampling).numbers for one in rows]
    keys = [f"probability_over_limit{end}" for end in ("", "_low", "_high")]
    assert [list(one) for one in probabilities_over(rows, sampling)] == [[one[key] for key in keys] for one in expected]


def test_neighbours_change_no_bit():
    """A row keeps its bits when others come, go or change places."""
    rows = _limited()[::3]
    alone = [probabilities_over([one], plan())[0] for one in rows]
    assert probabilities_over(rows[::-1], plan()) == alone[::-1]


def test_a_row_without_a_limit_is_refused():
    """Nothing is made up for a row that has no limit."""
    with pytest.raises(LookupError, match="without a limit"):
        probabilities_over([replace(SUM, upper_limit=None)], plan())
