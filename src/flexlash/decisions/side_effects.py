"""What a change does beside the backlash: mass, stiffness, stresses, and what a submission of it would be warned of."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
import numpy.typing as npt

from flexlash.decisions.lever import Effects
from flexlash.mechanics.bending import ENDURANCE
from flexlash.mechanics.mass import mass
from flexlash.mechanics.nominal import nominal_numbers
from flexlash.schema.arrays import Array
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.variant import Variant
from flexlash.schema.variant_arrays import VariantArrays

__all__ = ["PartNumbers", "effects_between"]

Bools = npt.NDArray[np.bool_]

_BESIDE = ("radial_deflection", "yield_strength", "density", "youngs_modulus", "poisson_ratio")


class PartNumbers:
    """Numbers [SI] of variants at their dimensions, of which one at least is given, as arrays (variants,)."""

    def __init__(self, variants: Sequence[Variant]) -> None:
        names = [name for name in DIMENSIONS if any(name in one.dimensions for one in variants)]
        self.arrays = VariantArrays(
            flexspline_types=[one.flexspline_type for one in variants],
            dimensions={name: _column(one.dimensions.get(name) for one in variants) for name in names},
            numbers={name: _column(getattr(one, name) for one in variants) for name in _BESIDE},
        )
        self.nominal = nominal_numbers(self.arrays, 0.0)
        self.made_of = np.array([one.material for one in variants])
        self.mass = np.full(len(variants), np.nan)
        for kind, _, places, sizes in self.arrays.alike():
            self.mass[places] = mass(kind, sizes, self.arrays.numbers["density"][places])

    def __getitem__(self, name: str) -> Array:
        """Return one of the nominal numbers, NaN where a variant has none."""
        return np.asarray(self.nominal[name].to_numpy(), dtype=float)

    @property
    def bent(self) -> Array:
        """What the bending stress is in proportion to at equal deflection, apart from the material: Δ/r_m²."""
        radius = self["mean_radius"]
        return self.arrays.dimensions["wall_thickness"] / (radius * radius)

    @property
    def plate_modulus(self) -> Array:
        """Modulus E/(1 − ν²) of a plate, by which the material enters the bending stress; NaN where it is not known."""
        young, poisson = (self.arrays.numbers[name] for name in ("youngs_modulus", "poisson_ratio"))
        return young / (1 - poisson * poisson)

    @property
    def yields(self) -> Bools:
        """Where torsion goes above the yield strength."""
        return self["von_mises"] > self.arrays.numbers["yield_strength"]

    @property
    def buckles(self) -> Bools:
        """Where the wall's shear goes above that at which it buckles."""
        return self["wall_shear"] > self["buckling_shear"]

    @property
    def tires(self) -> Bools:
        """Where bending by the wave generator goes above what the material endures."""
        return self["alternating_stress"] > ENDURANCE * self.arrays.numbers["yield_strength"]


def _column(values: Iterable[float | None]) -> Array:
    return np.array([np.nan if value is None else value for value in values], dtype=float)


def effects_between(before: PartNumbers, after: PartNumbers) -> list[Effects]:
    """Return what the change from each variant to another does.

    Equation: bending stress at equal deflection (Δ'/Δ)(r_m/r_m')² · E'(1 − ν²)/(E (1 − ν'²)) − 1; the others as defined
    """
    with np.errstate(all="ignore"):
        weight = after.mass / before.mass - 1
        stiffness = after["stiffness"] / before["stiffness"] - 1
        material = np.where(after.made_of == before.made_of, 1.0, after.plate_modulus / before.plate_modulus)
        bending = after.bent / before.bent * material - 1
    columns = (weight, stiffness, after["von_mises"], bending)
    return [
        Effects(
            mass_change=None if np.isnan(weigh) else weigh,
            stiffness_change=stiff,
            von_mises=stress,
            bending_stress_change=None if np.isnan(bent) else bent,
        )
        for weigh, stiff, stress, bent in zip(*(column.tolist() for column in columns), strict=True)
    ]
