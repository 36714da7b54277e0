"""The upper tail of variants as they are: where a search for a changed dimension starts from."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.special import ndtri

from flexlash.decisions.lever import Present
from flexlash.decisions.predicted_scores import ChangedAlike, Moments
from flexlash.schema.arrays import Array

__all__ = ["Tail", "tail_of"]


class Tail(NamedTuple):
    """How scores follow levels z of Φ about the wanted one as they are now: score + rise (z − z₀) + bend (z − z₀)²."""

    score: Array
    rise: Array
    bend: Array


def tail_of(presents: Sequence[Present], unchanged: ChangedAlike, wanted: float) -> Tail:
    """Return the scores (variants,) about a wanted level of Φ, by the parabola through the three nearest quantiles."""
    moments = Moments(*(one[:, 0] for one in unchanged.moments(unchanged.present[:, None])))
    known = np.array(sorted(presents[0].quantiles))
    levels = ndtri(known)
    middle = int(np.clip(np.argmin(np.abs(levels - wanted)), 1, len(levels) - 2))
    near = slice(middle - 1, middle + 2)
    outputs = np.array([[one.quantiles[probability] for probability in known[near].tolist()] for one in presents])
    scores = ((outputs - moments.mean[:, None]) / moments.sd[:, None]).T
    first, second, third = levels[near]
    slopes = np.diff(scores, axis=0) / np.diff(levels[near])[:, None]
    bend = (slopes[1] - slopes[0]) / (third - first)
    score = scores[1] + (wanted - second) * (slopes[1] + (wanted - third) * bend)
    rise = slopes[1] + (2 * wanted - second - third) * bend
    scatters = rise > 0
    return Tail(score - moments.bend(wanted), np.where(scatters, rise, 1.0), np.where(scatters, bend, 0.0))
