"""Which processes can be meant beside the limits of a drawing."""

from __future__ import annotations

import itertools

import numpy as np
from grids import for_each

from flexlash.schema.process_verdict import is_usual_process, process_verdict

BOUNDS = {
    "entered, usual up to twelve sds": (12.0, True, None),
    "entered, more than that is odd": (12.01, True, "W444"),
    "entered, usual from one sd": (1.0, True, None),
    "entered, less is odd": (0.99, True, "W444"),
    "entered, three times the greatest Cp": (300.0, True, "W444"),
    "entered, beyond that": (300.1, True, "E339"),
    "entered, at least half an sd": (0.5, True, "W444"),
    "entered, below that": (0.49, True, "E339"),
    "measured, as bad as it is": (0.1, False, None),
    "measured, far worse": (0.09, False, "E339"),
    "measured, as good as it is": (1e6, False, None),
}


@for_each("case", BOUNDS)
def test_limits_lie_so_many_standard_deviations_off(case):
    """How far half the width of the limits may be from the standard deviation, in these, by how it is known."""
    sigma, is_entered, code = BOUNDS[case]
    verdict = process_verdict(-sigma, sigma, 0.0, 1.0, is_entered=is_entered)
    assert (verdict and verdict.code) == code


def test_many_are_usual_where_one_is():
    """What is said to be usual of many processes has no verdict one by one; well within the bounds each is usual."""
    grid = list(
        itertools.product((-1.0, 0.0, 3.0), (0.5, 2.0, 40.0), (-2.5, -0.9, 0.0, 0.6, 1.0, 1.1), (0.5, 1.5, 11.0, 30.0))
    )
    low, width, place, sigma = np.array(grid).T
    high, mean, sd = low + width, low + width / 2 * (1 + place), width / 2 / sigma
    usual = is_usual_process(low, high, mean, sd)
    verdicts = [process_verdict(*map(float, one), is_entered=True) for one in zip(low, high, mean, sd, strict=True)]
    assert [one for one, verdict in zip(usual, verdicts, strict=True) if one and verdict] == []
    assert usual[(abs(place) < 1) & (sigma > 1) & (sigma < 12)].all()
    assert not usual[(abs(place) > 1) | (sigma < 1) | (sigma > 12)].any()


TRUNCATED = {"within": (0.9, None), "little beyond": (1.4, "W442"), "no part is kept": (1.6, "E339")}


@for_each("case", TRUNCATED)
def test_a_truncated_process_must_have_parts_within_its_limits(case):
    """Beyond five standard deviations no part in a million is left; a normal process has all of its parts."""
    mean, code = TRUNCATED[case]
    verdict = process_verdict(-1.0, 1.0, mean, 0.1, is_entered=True, is_truncated=True)
    assert (verdict and verdict.code) == code
    of_all = process_verdict(-1.0, 1.0, mean, 0.1, is_entered=True)
    assert (of_all and of_all.code) == (code and "W442")
