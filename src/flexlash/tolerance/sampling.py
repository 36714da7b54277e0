"""Points in the unit cube: independent replicates, the same points for every variant.

A coordinate belongs to a *name*, not to a place in a list, so that two variants with different dimensions
meet the same wall thickness in the same draw.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Literal

import numpy as np
from scipy.special import ndtri, stdtrit

from flexlash.schema.arrays import Array
from flexlash.tolerance.digital_nets import scrambled_net
from flexlash.tolerance.distributions import Distribution

__all__ = ["DEFAULT_SAMPLES", "REPLICATES", "UnitPoints", "standard_error"]

REPLICATES = 16
"""Independent replicates behind every standard error: 15 degrees of freedom."""

DEFAULT_SAMPLES = {"sobol": 2**15, "random": 2**17}
"""Points per variant when none are asked for."""

PointSet = Literal["all", "leading", "second"]

_SHARE_POINTS = 512
_CACHED_SHAPES = 256


def standard_error(replicates: Array) -> Array:
    """Return the standard errors of means over independent replicates, the last axis.

    They are widened for the small number of replicates, so that ± 1.96 of them is Student's 95 % interval.
    """
    count = replicates.shape[-1]
    deviation = replicates - np.add.reduce(replicates, axis=-1, keepdims=True) / count
    squares = np.add.reduce(deviation * deviation, axis=-1)
    return np.asarray(np.sqrt(squares / ((count - 1) * count)) * _widening(count))


@cache
def _widening(count: int) -> float:
    """Return how much wider Student's 95 % interval is than the normal one."""
    return float(stdtrit(count - 1, 0.975) / ndtri(0.975))


class UnitPoints:
    """Points in the unit cube, one coordinate per name, as arrays of shape (replicates, points).

    `all` of them make the spread. The shares of variance cross their leading part, `leading`, with a second
    independent set of the same length, `second`.
    """

    def __init__(
        self, names: Sequence[str], *, method: Literal["sobol", "random"], samples: int | None, seed: int
    ) -> None:
        wanted = DEFAULT_SAMPLES[method] if samples is None else samples
        if wanted < 1:
            raise ValueError(f"samples = {wanted} must be at least 1")
        self.method = method
        self.count = 1 << max(0, -(-wanted // REPLICATES) - 1).bit_length()
        self.share_count = min(self.count, _SHARE_POINTS)
        draw = _sobol if method == "sobol" else _random
        width = len(names)
        points = draw(2 * width, self.count, np.random.default_rng(seed))
        self._sets: dict[PointSet, dict[str, Array]] = {
            "all": {name: points[place] for place, name in enumerate(names)},
            "second": {
                name: np.ascontiguousarray(points[width + place, :, : self.share_count])
                for place, name in enumerate(names)
            },
        }
        self._sets["leading"] = {
            name: np.ascontiguousarray(values[:, : self.share_count]) for name, values in self._sets["all"].items()
        }
        self._standard: dict[tuple[PointSet, str, tuple[str | float, ...]], Array] = {}

    @property
    def size(self) -> int:
        """Points in all replicates together."""
        return REPLICATES * self.count

    def standard(self, name: str, distribution: Distribution, points: PointSet = "all") -> Array:
        """Return the standard values of a distribution at a name's points, (replicates, points)."""
        key = (points, name, distribution.shape)
        known = self._standard.get(key)
        if known is None:
            known = distribution.standard(self._sets[points][name])
            if len(self._standard) < _CACHED_SHAPES:
                self._standard[key] = known
        return known


def _sobol(width: int, count: int, generator: np.random.Generator) -> Array:
    """Return scrambled Sobol' points (width, replicates, count)."""
    return scrambled_net(width, REPLICATES, count, generator)


def _random(width: int, count: int, generator: np.random.Generator) -> Array:
    """Return independent uniform points (width, replicates, count), none of them on a face of the cube."""
    return np.clip(generator.random((width, REPLICATES, count)), 2.0**-53, 1 - 2.0**-53)
