"""The types of numbers in the whole package: in double precision, one or an array of them."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

__all__ = ["Array", "Condition", "Quantity"]

Array: TypeAlias = npt.NDArray[np.float64]

Quantity: TypeAlias = Array | float
"""One number or an array of them; arrays of one calculation have one shape, or broadcast."""

Condition: TypeAlias = npt.NDArray[np.bool_] | bool
"""Whether something holds, for each number of a quantity."""
