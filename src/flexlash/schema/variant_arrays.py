"""Variants as columns: what is computed of many at once takes a number of all of them by its name."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from flexlash.schema.arrays import Array

__all__ = ["Indices", "VariantArrays"]

Indices: TypeAlias = npt.NDArray[np.intp]
"""Places of variants among all of them."""


@dataclass(frozen=True, kw_only=True)
class VariantArrays:
    """Variants in SI, each array of shape (variants,); NaN is what a variant has not.

    `dimensions` are those of `schema.variant.Variant`; `numbers` what it holds beside them: `rated_torque`,
    `load_inertia`, `backlash_limit`, `system_limit`, `bearing_width`, `engaged_teeth`, `radial_deflection`,
    `yield_strength`, `density`, `youngs_modulus` and `poisson_ratio`.
    """

    flexspline_types: Sequence[str]
    dimensions: Mapping[str, Array]
    numbers: Mapping[str, Array]

    def take(self, indices: Indices) -> VariantArrays:
        """Return some of the variants."""
        return VariantArrays(
            flexspline_types=[self.flexspline_types[index] for index in indices.tolist()],
            dimensions={name: values[indices] for name, values in self.dimensions.items()},
            numbers={name: values[indices] for name, values in self.numbers.items()},
        )

    def alike(self, owners: Sequence[str] | None = None) -> Iterator[tuple[str, str, Indices, dict[str, Array]]]:
        """Yield the variants that have one type, the same dimensions and one owner, if these are given.

        Each time type, owner, places and dimensions; nothing of a variant depends on those beside it.
        """
        present = np.array([~np.isnan(values) for values in self.dimensions.values()])
        shapes = (present.T @ (1 << np.arange(len(present)))).tolist()
        groups: dict[tuple[str, str, int], list[int]] = defaultdict(list)
        owned = owners or [""] * len(shapes)
        for index, key in enumerate(zip(self.flexspline_types, owned, shapes, strict=True)):
            groups[key].append(index)
        for (flexspline_type, owner, _), places in groups.items():
            indices = np.array(places)
            names = [name for name, has in zip(self.dimensions, present[:, places[0]], strict=True) if has]
            yield flexspline_type, owner, indices, {name: self.dimensions[name][indices] for name in names}
