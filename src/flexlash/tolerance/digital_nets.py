"""Scrambled Sobol' points: the base net of Joe and Kuo, scrambled anew for every replicate.

Nested uniform scrambling (Owen 1995) leaves the evenness of the net alone and makes every point uniform, so
replicates are independent and unbiased; their means are close to normal (Loh 2003), which the cheaper linear
scrambling does not give.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import numpy.typing as npt

from flexlash.schema.arrays import Array
from flexlash.schema.tables import rows

__all__ = ["COORDINATES", "scrambled_net"]

COORDINATES = 64
"""Coordinates with direction numbers; beyond them points are independent."""

_BITS = 32
"""Binary digits of a coordinate."""

Words = npt.NDArray[np.uint32]


@cache
def _directions() -> Words:
    """Return the direction numbers (coordinates, bits) of Joe and Kuo 2008, the first bit uppermost."""
    table = np.zeros((COORDINATES, _BITS), dtype=np.uint32)
    for coordinate, row in enumerate(rows("sobol_directions")):
        polynomial = int(row["polynomial"])
        degree = max(polynomial.bit_length() - 1, 1)
        numbers = [int(number) << (_BITS - 1 - bit) for bit, number in enumerate(row["initial_numbers"].split())]
        for bit in range(degree, _BITS):
            number = numbers[bit - degree] ^ numbers[bit - degree] >> degree if coordinate else 1 << (_BITS - 1 - bit)
            for back in range(1, degree):
                if polynomial >> (degree - back) & 1:
                    number ^= numbers[bit - back]
            numbers.append(number)
        table[coordinate] = numbers
    return table


@cache
def _strata(count: int) -> npt.NDArray[np.intp]:
    """Return in which of `count` equal strata the first points of the net lie, (coordinates, count)."""
    bits = count.bit_length() - 1
    words = np.zeros((COORDINATES, count), dtype=np.uint32)
    for bit, direction in enumerate(_directions().T[:bits]):
        filled = 1 << bit
        words[:, filled : 2 * filled] = words[:, :filled] ^ direction[:, None]
    return (words >> np.uint32(_BITS - bits) if bits else words).astype(np.intp)


def scrambled_net(width: int, replicates: int, count: int, generator: np.random.Generator, *, later: int = 0) -> Array:
    """Return points inside the unit cube, (width + later, replicates, count).

    Equation: the digital net of Joe and Kuo's direction numbers, its binary digits permuted nestedly at random
    Arguments: coordinates, independent replicates, points in each, a power of two; the source of randomness; `later`
        coordinates, drawn after the others, which have the same points with and without them.
    Valid: the first 64 coordinates are a net; beyond them points are independent.
    Source: Joe and Kuo 2008; Owen 1995.

    >>> points = scrambled_net(1, 2, 4, np.random.default_rng(0))
    >>> np.sort(points * 4, axis=2).astype(int).tolist()
    [[[0, 1, 2, 3], [0, 1, 2, 3]]]
    """
    flips, points = _drawn(width, replicates, count, generator)
    if later:
        others = _drawn(later, replicates, count, generator)
        flips, points = np.concatenate([flips, others[0]]), np.concatenate([points, others[1]])
    known = min(width + later, COORDINATES)
    flips = flips[:known]
    strata = np.zeros((known, replicates, 1), dtype=np.int32)
    while (filled := strata.shape[2]) < count:
        # Each stratum is halved, and its halves are exchanged or not by a coin of its own.
        split = np.empty((known, replicates, 2 * filled), dtype=np.int32)
        split[:, :, 0::2] = 2 * strata + flips[:, :, filled : 2 * filled]
        split[:, :, 1::2] = 2 * strata + 1 - flips[:, :, filled : 2 * filled]
        strata = split
    order = _strata(count)
    for coordinate in range(known):
        points[coordinate] += strata[coordinate].take(order[coordinate], axis=1)
    points[:known] /= count
    return np.clip(points, 2.0**-53, 1 - 2.0**-53)


def _drawn(
    width: int, replicates: int, count: int, generator: np.random.Generator
) -> tuple[npt.NDArray[np.int32], Array]:
    """Return a coin for every half of a stratum, and where in its last stratum each point lies."""
    flips = generator.integers(2, size=(min(width, COORDINATES), replicates, count), dtype=np.int32)
    return flips, generator.random((width, replicates, count))
