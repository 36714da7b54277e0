"""How much of the variance of an output its inputs cause, each by itself and together with others."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from flexlash.schema.arrays import Array

__all__ = ["VarianceShares"]


@dataclass(frozen=True, kw_only=True)
class VarianceShares:
    """First-order and total Sobol' index of each input with their standard errors, by name.

    An index lies between 0 and 1, its error too: an error of 1 says that nothing is known.
    """

    first: dict[str, float]
    total: dict[str, float]
    first_error: dict[str, float]
    total_error: dict[str, float]

    @classmethod
    def of(cls, names: Iterable[str], found: Array) -> VarianceShares:
        """Return the shares of one row from first and total indices and the errors of both, (4, inputs).

        >>> import numpy as np
        >>> VarianceShares.of("ab", np.array([[0.2, 0.8], [0.2, 0.8], [0.0, 0.0], [0.0, 0.0]])).first
        {'a': 0.2, 'b': 0.8}
        """
        first, total, first_error, total_error = (dict(zip(names, one, strict=True)) for one in found.tolist())
        return cls(first=first, total=total, first_error=first_error, total_error=total_error)
