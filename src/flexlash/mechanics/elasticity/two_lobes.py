"""The bounds of the wind-up where the teeth load two opposite arcs of a cup on a wave generator.

The wave generator is taken to be rigid and to fit tightly, so that it holds the bore round where its bearing runs. How
the teeth share the torque is not known; two cases lie on either side of it. Low: all engaged teeth turn by the same
angle, as in a rigid circular spline, and the bearing holds the bore over its width. High: two single teeth carry
everything, and the bearing holds the bore in the middle of its width alone. What play between bore and bearing or a
soft bearing adds is in neither.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from flexlash.mechanics.elasticity.half_section import section_of
from flexlash.mechanics.elasticity.lobes import lobes_of
from flexlash.mechanics.elasticity.part import BENDING, SLACK, part_of, section_problem
from flexlash.mechanics.elasticity.tooth_loads import (
    HARMONICS,
    all_compliances,
    engaged_arc,
    lobe_factor,
    rigid_contact_factor,
    single_tooth_ratios,
)
from flexlash.mechanics.elasticity.twist import require_dimensions
from flexlash.mechanics.flexspline import windups
from flexlash.schema.argument_checks import number
from flexlash.schema.arrays import Array

__all__ = ["ENGAGED_SHARE", "SOLVED", "LobeFactors", "TwoLobeBracket", "bracket_problem", "two_lobe_bracket"]

SOLVED = (2, 4, 6, 8, 12, 18, 26, 40)
"""Harmonics that are solved; those between are interpolated, those above follow the last two."""

ENGAGED_SHARE = 0.3
"""Share of all teeth that carry torque, unless given."""

_BEARING_SHARE = 0.7
"""Width of the bearing over the tooth face width, unless given; that of the parts which the method was checked with."""

_MID_LINE = 0.05
"""Share of its width over which a bearing that bears in the middle alone holds the bore."""

_MOST_POISSON = 0.49
"""Poisson's ratio above which the elements lock, since the material all but keeps its volume."""

_KEPT = 64
"""Parts whose factors are kept, since many variants of a submission differ in torque and material alone."""


@dataclass(frozen=True, kw_only=True)
class LobeFactors:
    """What two lobes do to the wind-up of one shape, whatever its torque and modulus.

    `even_windup` is that of an even load over the tooth face times Young's modulus over the torque [1/m³]; `low` and
    `high` are factors on it [-]; `held` and `on_mid_line` the compliances ρ_n of `SOLVED` harmonics [-] where the
    bearing holds the bore over its width, and in the middle of it alone.
    """

    even_windup: float
    low: float
    high: float
    held: Array
    on_mid_line: Array


@dataclass(frozen=True, kw_only=True)
class TwoLobeBracket:
    """The bounds of one cup's wind-up under two lobes, in SI.

    `low` and `high` are the bounds [rad], `even` the wind-up by the meridian integral where the load is even over the
    tooth face [rad]: the bounds are `factors` of it. `face_factor` is that wind-up over that of a load at the open end
    [-]. `is_sensitive` tells that the wall has no thicker rim, so that fit and sharing matter most.
    """

    low: float
    high: float
    even: float
    face_factor: float
    factors: LobeFactors
    is_sensitive: bool


def bracket_problem(
    flexspline_type: str,
    dimensions: Mapping[str, float],
    *,
    poisson_ratio: float | None = None,
    bearing_width: float | None = None,
) -> str | None:
    """Return why a flexspline has no bounds for two lobes, as a clause; None if it has.

    Arguments as for `two_lobe_bracket`.
    """
    poisson = dimensions.get("poisson_ratio") if poisson_ratio is None else poisson_ratio
    return next(_problems(flexspline_type, dimensions, poisson, bearing_width), None)


def _problems(
    flexspline_type: str, dimensions: Mapping[str, float], poisson: float | None, bearing_width: float | None
) -> Iterator[str]:
    """Yield why there are no bounds; each reason needs that there is none before it."""
    if flexspline_type != "cup":
        held = "at its bolt circle" if flexspline_type == "hat" else "at the end of its wall"
        yield f"only cups have been checked; a {flexspline_type} is held {held}"
    if not dimensions.get("tooth_face_width"):
        yield "the tooth face width is not given"
    if poisson is None:
        yield "Poisson's ratio of the material is not given"
    elif poisson > _MOST_POISSON:
        yield "so incompressible a material cannot be solved"
    if problem := section_problem(flexspline_type, dimensions):
        yield problem[1]
    part = part_of(flexspline_type, dimensions)
    on_the_wall = part.length - part.junction_fillet + SLACK * part.length
    if (part.face_width + _bearing_width(part.face_width, bearing_width)) / 2 > on_the_wall:
        yield "the bearing of the wave generator reaches into the disk"


def two_lobe_bracket(
    flexspline_type: str,
    dimensions: Mapping[str, float],
    *,
    poisson_ratio: float | None = None,
    bearing_width: float | None = None,
    engaged_share: float = ENGAGED_SHARE,
) -> TwoLobeBracket:
    """Bounds of the wind-up of a cup whose teeth load two opposite arcs, on a rigid, tightly fitting wave generator.

    Equation: U = U_band [1 + ½ Σ ρ_n (q_n/q₀)²], n = 2, 4, …, U_band as of `flexspline.windups` and ρ_n as of
        `Lobes.compliances`; low: the least over loads ≥ 0 within the engaged arcs, no radial displacement of the bore
        over the bearing width; high: q_n/q₀ = 2, none over a twentieth of that width
    Arguments: flexspline_type and dimensions in SI by name as for `flexspline.windups`, but scalars, with
        tooth_face_width; poisson_ratio [-] where dimensions have none; bearing_width [m], 0.7 times the tooth face
        width unless given, about the middle of the tooth face; engaged_share of all teeth [-].
    Valid: linear elasticity, cups, small lobes; raises ValueError where `bracket_problem` names a problem, TypeError or
        ValueError, with its name, for an argument that is none. With every cell of the mesh halved the low bound
        changes by less than 6e-4, the high one by less than 4e-3. The play between bore and bearing is in neither: a
        few µm of it can add 20 to 130 %.
    Source: elasticity of bodies of revolution in Fourier series; checked against a solid finite-element model.

    >>> from flexlash.mechanics.elasticity import is_available
    >>> cup = {"torque": 30.0, "cylinder_length": 0.025, "mean_radius": 0.025, "wall_thickness": 0.55e-3,
    ...        "disk_thickness": 0.8e-3, "disk_inner_radius": 0.013, "rim_length": 0.01, "rim_thickness": 1.1e-3,
    ...        "tooth_face_width": 0.01, "youngs_modulus": 206e9, "poisson_ratio": 0.3}
    >>> bracket = two_lobe_bracket("cup", cup) if is_available() else None
    >>> [f"{bound:.2e}" for bound in (bracket.low, bracket.high)] if bracket else ["3.03e-04", "3.79e-04"]
    ['3.03e-04', '3.79e-04']
    """
    require_dimensions(flexspline_type, dimensions)
    poisson = dimensions.get("poisson_ratio") if poisson_ratio is None else number("poisson_ratio", poisson_ratio)
    for name, value in (("bearing_width", bearing_width), ("engaged_share", engaged_share)):
        if value is not None and number(name, value) <= 0:
            raise ValueError(f"{name} = {value:g}: a number above 0 is required")
    if engaged_share > 1:
        raise ValueError(f"engaged_share = {engaged_share:g}: a share of at most 1 is required")
    problem = bracket_problem(flexspline_type, dimensions, poisson_ratio=poisson, bearing_width=bearing_width)
    if problem or poisson is None:
        raise ValueError(problem)
    shape = tuple((name, value) for name, value in dimensions.items() if name not in _NO_SHAPE)
    width = _bearing_width(dimensions["tooth_face_width"], bearing_width)
    factors = _lobe_factors(shape, poisson, width, engaged_share)
    at_the_end = {name: value for name, value in dimensions.items() if name != "tooth_face_width"}
    even, by_edge = (float(sum(windups(flexspline_type, sizes).values())) for sizes in (dimensions, at_the_end))
    return TwoLobeBracket(
        low=even * factors.low,
        high=even * factors.high,
        even=even,
        face_factor=even / by_edge,
        factors=factors,
        is_sensitive=not part_of(flexspline_type, dimensions).has_step,
    )


_NO_SHAPE = {
    "torque", "youngs_modulus", "poisson_ratio", "shear_modulus", "cylinder_calibration", "disk_calibration",
}  # fmt: skip
"""Dimensions on which the factors do not depend."""


def _bearing_width(face_width: float, bearing_width: float | None) -> float:
    """Return the width over which the wave generator holds the bore."""
    return _BEARING_SHARE * face_width if bearing_width is None else bearing_width


@lru_cache(maxsize=_KEPT)
def _lobe_factors(
    shape: tuple[tuple[str, float], ...],
    poisson_ratio: float,
    bearing_width: float,
    engaged_share: float,
    refinement: int = 0,
) -> LobeFactors:
    """Return what two lobes do to a cup of this shape; every refinement of the mesh halves its cells."""
    part = part_of("cup", dict(shape))
    middle = part.length - part.face_width / 2
    reaches = bearing_width / 2, bearing_width / 2 * _MID_LINE
    stops = (middle + side * reach for side in (-1, 1) for reach in reaches)
    section = section_of(replace(part, stops=(*part.stops, *stops), grading=BENDING), refinement)
    lobes = lobes_of(section, poisson_ratio)
    held, on_mid_line = (
        lobes.compliances(
            SOLVED, np.logical_and(section.bore, np.abs(section.height - middle) <= reach + SLACK * part.length)
        )
        for reach in reaches
    )
    return LobeFactors(
        even_windup=lobes.even_windup(),
        low=rigid_contact_factor(HARMONICS, all_compliances(SOLVED, held), engaged_arc(engaged_share)),
        high=lobe_factor(all_compliances(SOLVED, on_mid_line), single_tooth_ratios(HARMONICS)),
        held=held,
        on_mid_line=on_mid_line,
    )
