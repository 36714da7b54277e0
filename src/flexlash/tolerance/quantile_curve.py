"""All quantiles of a smooth output from a few exact ones: a cubic on the normal scale, one curve per row."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flexlash.arrays import Array

__all__ = ["QuantileCurve"]


@dataclass(frozen=True, kw_only=True)
class QuantileCurve:
    """Quantiles `outputs` (scores, rows) at standard normal `scores`, and `rises`, their change per score.

    For a normal output the curve is a straight line, so cubics between the knots are close for others.
    """

    scores: Array
    outputs: Array
    rises: Array

    def outputs_at(self, scores: Array) -> Array:
        """Return the quantiles (k, rows) at scores (k,)."""
        after = np.clip(np.searchsorted(self.scores, scores), 1, len(self.scores) - 1)
        width = (self.scores[after] - self.scores[after - 1])[:, None]
        place = (scores[:, None] - self.scores[after - 1][:, None]) / width
        ends = self.outputs[after - 1], self.outputs[after]
        return _cubic(place, *ends, self.rises[after - 1] * width, self.rises[after] * width)

    def scores_at(self, outputs: Array) -> Array:
        """Return the scores (k, rows) of outputs (k, rows); beyond the knots in a straight line."""
        passed = np.zeros(outputs.shape, dtype=np.int64)
        for knot in self.outputs:
            passed += knot <= outputs
        after = np.clip(passed, 1, len(self.scores) - 1)
        column = np.arange(outputs.shape[1])
        first, last = self.outputs[after - 1, column], self.outputs[after, column]
        width = np.where(last > first, last - first, 1.0)
        slopes = [width / self.rises[place, column] for place in (after - 1, after)]
        place = (outputs - first) / width
        inside = _cubic(np.clip(place, 0, 1), self.scores[after - 1], self.scores[after], *slopes)
        below = self.scores[0] + (outputs - self.outputs[0]) / self.rises[0]
        above = self.scores[-1] + (outputs - self.outputs[-1]) / self.rises[-1]
        return np.where(place < 0, below, np.where(place > 1, above, inside))


def _cubic(place: Array, first: Array, last: Array, first_rise: Array, last_rise: Array) -> Array:
    """Return the cubic through two ends with these rises over the interval, cut where it would turn back."""
    most = 3 * (last - first)
    first_rise, last_rise = np.minimum(first_rise, most), np.minimum(last_rise, most)
    curve = 3 * (last - first) - 2 * first_rise - last_rise
    twist = first_rise + last_rise - 2 * (last - first)
    return np.asarray(first + place * (first_rise + place * (curve + place * twist)))
