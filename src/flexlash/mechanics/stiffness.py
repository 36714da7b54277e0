"""Torsional stiffness of the flexspline beside that of whole drives, and the vibration of a load on it."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections import defaultdict
from collections.abc import Iterable
from functools import cache
from typing import NamedTuple

from flexlash.mechanics.elementary import sqrt
from flexlash.schema import tables
from flexlash.schema.arrays import Quantity

__all__ = [
    "DriveTorque",
    "WholeDrive",
    "catalogue_stiffness",
    "catalogue_torque",
    "drive_lost_motion",
    "lost_motion",
    "natural_frequency",
    "nearest_size",
    "resonance_speed",
    "torsional_stiffness",
]

_METRES_PER_SIZE = 2.54e-3
"""A maker's size counts tenths of an inch of pitch diameter."""

_WAVES = 2
"""Meshing waves, and so torque ripples, per turn of the wave generator."""


def torsional_stiffness(torque: Quantity, windup: Quantity) -> Quantity:
    """Torsional stiffness [N·m/rad].

    Equation: K = T/U
    Arguments: torque T [N·m] and the wind-up U at it [rad], of any one shape.
    Valid: linear elasticity.
    Source: definition.

    >>> torsional_stiffness(800.0, 5e-4)
    1600000.0
    """
    return torque / windup


def lost_motion(stiffness: Quantity, torque: Quantity) -> Quantity:
    """Lost motion of the flexspline alone: its wind-up from a torque to the same the other way [rad].

    Equation: φ = 2 M/K
    Arguments: stiffness K [N·m/rad]; torque M = p T_rated [N·m] to either side at which it is stated.
    Valid: linear elasticity.
    Source: makers' definition of lost motion.

    >>> lost_motion(1.6e6, 32.0)
    4e-05
    """
    return 2 * torque / stiffness


def natural_frequency(stiffness: Quantity, inertia: Quantity) -> Quantity:
    """Natural frequency of a load on the flexspline, the other end held [Hz].

    Equation: f = √(K/J) / 2π
    Arguments: stiffness K [N·m/rad], inertia J of the load on the output [kg·m²], of any one shape.
    Valid: flexspline without mass; an upper bound, since bearing, teeth and hub bolts yield as well.
    Source: one-mass oscillator.

    >>> f"{natural_frequency(1.491835e6, 1.0):.2f}"
    '194.39'
    """
    return sqrt(stiffness / inertia) / (2 * math.pi)


def resonance_speed(frequency: Quantity) -> Quantity:
    """Speed of the wave generator at which its ripple meets a natural frequency [rad/s].

    Equation: ω = 2π f / 2
    Arguments: frequency f [Hz], of any shape.
    Valid: kinematic error at two waves per turn of the wave generator, its strongest order.
    Source: kinematic error of strain wave gears.

    >>> f"{resonance_speed(194.39) * 30 / math.pi:.0f} per minute"
    '5832 per minute'
    """
    return 2 * math.pi * frequency / _WAVES


class WholeDrive(NamedTuple):
    """A catalogue drive: its size [-] and the least stiffness listed beyond its second slope [N·m/rad]."""

    size: int
    stiffness: float

    def at_radius(self, mean_radius: float) -> float:
        """Return the stiffness [N·m/rad] that a drive of a smaller radius [m] would have: it goes as its cube."""
        share = 2 * mean_radius / (_METRES_PER_SIZE * self.size)
        return self.stiffness * min(1.0, share**3)


def catalogue_stiffness(mean_radius: float) -> WholeDrive | None:
    """Nearest drive of a maker's catalogue with its stiffness [N·m/rad]; None if unlisted.

    Equation: size = 2 r_m / 2.54 mm; K3 the least over the listed ratios
    Arguments: mean_radius r_m of the wall [m].
    Valid: sizes 14 to 100, where the catalogue lists K3.
    Source: a maker's catalogue, `tables/catalogue_stiffness.csv`.

    >>> catalogue_stiffness(0.0178), catalogue_stiffness(0.2)
    (WholeDrive(size=14, stiffness=3400.0), None)
    """
    listed = _least_stiffness()
    nearest = nearest_size(mean_radius, listed)
    stiffness = None if nearest is None else listed[nearest]
    return None if nearest is None or stiffness is None else WholeDrive(size=nearest, stiffness=stiffness)


class DriveTorque(NamedTuple):
    """A catalogue drive: its size [-] and the greatest momentary peak torque allowed over its ratios [N·m]."""

    size: int
    torque: float


def catalogue_torque(mean_radius: float) -> DriveTorque | None:
    """Nearest drive of a maker's catalogue with its momentary peak torque [N·m]; None if unlisted.

    Equation: size = 2 r_m / 2.54 mm; the limit for momentary peak torque, the greatest over the listed ratios
    Arguments: mean_radius r_m of the wall [m].
    Valid: sizes 14 to 90. Rated and repeated-peak torques are lower.
    Source: a maker's catalogue, `tables/catalogue_torque.csv`.

    >>> catalogue_torque(0.08), catalogue_torque(0.2)
    (DriveTorque(size=65, torque=6175.0), None)
    """
    listed = _greatest_torque()
    nearest = nearest_size(mean_radius, listed)
    torque = None if nearest is None else listed[nearest]
    return None if nearest is None or torque is None else DriveTorque(size=nearest, torque=torque)


def drive_lost_motion(mean_radius: float, torque: float) -> float | None:
    """Lost motion of the whole drive of the nearest catalogue size [rad]; None where its catalogue does not say.

    Equation: φ = 2 M/K1, K1 the least over the listed ratios
    Arguments: mean_radius r_m of the wall [m]; torque M = p T_rated [N·m] to either side at which it is stated.
    Valid: sizes 14 to 100, up to the torque T1 where the first slope ends.
    Source: a maker's catalogue, `tables/catalogue_stiffness.csv`.

    >>> f"{drive_lost_motion(0.08, 32.0):.4e}", drive_lost_motion(0.08, 236.0)
    ('1.4545e-04', None)
    """
    listed = _first_slopes()
    nearest = nearest_size(mean_radius, listed)
    if nearest is None:
        return None
    stiffness, most = listed[nearest]
    return 2 * torque / stiffness if torque <= most else None


def nearest_size(mean_radius: float, listed: Iterable[int]) -> int | None:
    """Size of a catalogue that is nearest to a mean radius [-], the smaller of two, None beyond all.

    Equation: size = 2 r_m / 2.54 mm
    Arguments: mean_radius r_m of the wall [m]; listed, the sizes there are, rising.
    Valid: from the smallest size to the greatest.
    Source: pitch diameters of makers' catalogues.

    >>> nearest_size(0.0406, [25, 32, 40]), nearest_size(0.2, [25, 32, 40])
    (32, None)
    """
    size, sizes = 2 * mean_radius / _METRES_PER_SIZE, list(listed)
    if not sizes[0] - _SLACK <= size <= sizes[-1] + _SLACK:
        return None
    above = bisect_left(sizes, size)
    beside = sizes[max(above - 1, 0) : above + 1]
    return min(beside, key=lambda candidate: abs(candidate - size))


_SLACK = 1e-9


@cache
def _least_stiffness() -> dict[int, float | None]:
    """Return the least K3 [N·m/rad] of each size over its ratios, None where none is listed."""
    return {size: min(listed, default=None) for size, listed in _listed("catalogue_stiffness", "K3_Nm_per_rad").items()}


@cache
def _greatest_torque() -> dict[int, float | None]:
    """Return the greatest momentary peak torque [N·m] of each size over its ratios, None where none is listed."""
    listed = _listed("catalogue_torque", "momentary_peak_Nm")
    return {size: max(torques, default=None) for size, torques in listed.items()}


@cache
def _first_slopes() -> dict[int, tuple[float, float]]:
    """Return the least K1 [N·m/rad] of each size over its ratios, and the torque T1 [N·m] up to which it holds."""
    torques, slopes = (_listed("catalogue_stiffness", column) for column in ("T1_Nm", "K1_Nm_per_rad"))
    return {size: (min(listed), min(torques[size])) for size, listed in slopes.items()}


def _listed(table: str, column: str) -> dict[int, list[float]]:
    """Return the entries of a catalogue column by rising size, over the ratios that have one."""
    listed: dict[int, list[float]] = defaultdict(list)
    for row in tables.rows(table):
        entries = listed[int(row["size"])]
        if row[column]:
            entries.append(float(row[column]))
    return dict(sorted(listed.items()))
