"""How far a whole drive of the catalogue turns under torque: three slopes, for the drive nearest in size."""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

from flexlash.mechanics.elementary import maximum, minimum
from flexlash.mechanics.stiffness import nearest_size
from flexlash.schema import tables
from flexlash.schema.arrays import Quantity

__all__ = ["CatalogueCurve", "catalogue_curve", "first_slope", "later_slope"]


def first_slope(torque: Quantity, end: Quantity, stiffness: Quantity) -> Quantity:
    """Angle on the first slope of a drive's stiffness, from no torque on [rad].

    Equation: φ = min(T, T1)/K1
    Arguments: torque T; torque T1 where the slope ends [N·m]; its stiffness K1 [N·m/rad].
    Valid: T ≥ 0; the whole drive, its input held.
    Source: makers' catalogues.

    >>> f"{first_slope(60.0, 29.0, 67e3):.4e}"
    '4.3284e-04'
    """
    return minimum(torque, end) / stiffness


def later_slope(torque: Quantity, begin: Quantity, end: Quantity, stiffness: Quantity) -> Quantity:
    """Angle on a further slope of a drive's stiffness [rad].

    Equation: φ = (min(T, T_end) − T_begin)/K, 0 up to T_begin
    Arguments: torque T; torques at which the slope begins and ends [N·m]; its stiffness K [N·m/rad].
    Valid: as for `first_slope`.
    Source: makers' catalogues.

    >>> f"{later_slope(60.0, 29.0, 108.0, 110e3):.4e}", float(later_slope(20.0, 29.0, 108.0, 110e3))
    ('2.8182e-04', 0.0)
    """
    return maximum(minimum(torque, end) - begin, 0.0) / stiffness


class CatalogueCurve(NamedTuple):
    """The slopes of a catalogue drive: its size, the ratio from which on they hold, T1, T2 [N·m], K1 to K3 [N·m/rad].

    The third one is None where the catalogue does not list it.
    """

    size: int
    ratio_from: int
    first_torque: float
    second_torque: float
    first_stiffness: float
    second_stiffness: float
    third_stiffness: float | None

    def angle(self, torque: float) -> float | None:
        """Return how far the drive turns under a torque [N·m] at its output, the input held [rad].

        None beyond T2 where no slope is listed.

        Equation: φ = T1/K1 + (T2 − T1)/K2 + (T − T2)/K3, each term as far as T goes
        Arguments: torque T from no torque on, to one side [N·m].
        Valid: up to the peak torques that the catalogue allows.
        Source: a maker's catalogue, `tables/catalogue_stiffness.csv`.

        >>> f"{catalogue_curve(2.54e-3 * 32 / 2, 100).angle(60.0):.4e}"
        '7.1465e-04'
        """
        first, second = self.first_torque, self.second_torque
        low = first_slope(torque, first, self.first_stiffness)
        low = low + later_slope(torque, first, second, self.second_stiffness)
        if torque <= second:
            return float(low)
        if self.third_stiffness is None:
            return None
        return float(low + later_slope(torque, second, torque, self.third_stiffness))


def catalogue_curve(mean_radius: float, ratio: float | None = None) -> CatalogueCurve | None:
    """Slopes of the nearest drive of a maker's catalogue [N·m, N·m/rad], None beyond its sizes.

    Equation: size = 2 r_m / 2.54 mm; of the listed ratios the greatest up to that of the drive, or else the least
    Arguments: mean_radius r_m of the wall [m]; ratio of the drive, None where it is not known: then the least stiff.
    Valid: sizes 14 to 100.
    Source: a maker's catalogue, `tables/catalogue_stiffness.csv`.

    >>> catalogue_curve(0.0406, 100).ratio_from, catalogue_curve(0.0406).ratio_from, catalogue_curve(0.2)
    (80, 30, None)
    """
    listed = _curves()
    size = nearest_size(mean_radius, listed)
    if size is None:
        return None
    curves = listed[size]
    reached = [curve for curve in curves if ratio is not None and curve.ratio_from <= ratio]
    return reached[-1] if reached else curves[0]


@cache
def _curves() -> dict[int, list[CatalogueCurve]]:
    """Return the listed drives by rising size, each with its ratios rising, along which all slopes get stiffer."""
    listed: dict[int, list[CatalogueCurve]] = {}
    for row in tables.rows("catalogue_stiffness"):
        third = row["K3_Nm_per_rad"]
        curve = CatalogueCurve(
            size=int(row["size"]),
            ratio_from=int(row["ratio_from"]),
            first_torque=float(row["T1_Nm"]),
            second_torque=float(row["T2_Nm"]),
            first_stiffness=float(row["K1_Nm_per_rad"]),
            second_stiffness=float(row["K2_Nm_per_rad"]),
            third_stiffness=float(third) if third else None,
        )
        listed.setdefault(curve.size, []).append(curve)
    return {size: sorted(listed[size], key=lambda curve: curve.ratio_from) for size in sorted(listed)}
