"""What cells of one Variants row must be to one another, each relation with the cell it blames."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import polars as pl

__all__ = ["RELATIONS", "Relation"]


@dataclass(frozen=True, kw_only=True)
class Relation:
    """A code, the key of the cell it blames, an expression that is true where it is broken, and its facts.

    A relation is silent for a row in which one of the columns of its expression has a finding already.
    """

    code: str
    key: str
    broken: pl.Expr
    facts: Callable[[Mapping[str, Any]], dict[str, Any]] = lambda _: {}

    @property
    def keys(self) -> set[str]:
        """The columns that the relation looks at."""
        return {self.key, *self.broken.meta.root_names()}


_FLAT = 89.9999
"""Angle to the axis [°] from which on a disk counts as flat; 90° in radians rarely is 90."""

_WALL_SHARES = (0.006, 0.02)
"""Wall over mean diameter outside which a flexspline is not expected; 0.01 to 0.015 is usual."""

_HUB_SHARE = 0.7
"""Hub radius over bore radius above which a diameter was probably entered as a radius."""

_EDGE = 1e-9
"""Sums of decimals miss an edge [mm] by their last binary digit; so much counts as on it."""


def _is(*types: str) -> pl.Expr:
    return pl.col("flexspline_type").fill_null("cup").is_in(types)


_RADIUS = pl.coalesce("mean_radius_mm", (pl.col("bore_diameter_mm") + pl.col("wall_thickness_mm")) / 2)
_INNER = pl.when(_is("hat")).then(pl.coalesce("disk_inner_radius_mm", _RADIUS)).otherwise("disk_inner_radius_mm")
_OUTER = pl.coalesce("disk_outer_radius_mm", _RADIUS)
_RIM = pl.col("rim_length_mm").fill_null(0)
_BORE = _RADIUS - pl.col("wall_thickness_mm") / 2
_HUB_FILLET = pl.col("hub_fillet_radius_mm").fill_null(0)


def radius(row: Mapping[str, Any]) -> float:
    """Mean radius [mm] of a row, as given or from its bore."""
    given = row["mean_radius_mm"]
    return float(given) if given is not None else (row["bore_diameter_mm"] + row["wall_thickness_mm"]) / 2


def _bore(row: Mapping[str, Any]) -> float:
    """Return the radius of the bore [mm]."""
    return radius(row) - float(row["wall_thickness_mm"]) / 2


def _outer(row: Mapping[str, Any]) -> float:
    given = row["disk_outer_radius_mm"]
    return float(given) if given is not None else radius(row)


def _foreign(key: str, *types: str, least: float = 0.0) -> Relation:
    """Return the relation that a dimension must be blank, or not above `least`, for these flexspline types."""
    return Relation(
        code="E310",
        key=key,
        broken=_is(*types) & (pl.col(key) > least),
        facts=lambda row: {"other": row["flexspline_type"]},
    )


def _fillet_on_a_cone(key: str) -> Relation:
    """Return the relation that a conical disk has no fillets."""
    return Relation(
        code="E327",
        key=key,
        broken=_is("cup") & (pl.col("disk_cone_angle_deg") < _FLAT) & (pl.col(key) > 0),
        facts=lambda row: {"other": f"{row['disk_cone_angle_deg']:g}"},
    )


_WALL_SHARE = pl.col("wall_thickness_mm") / (2 * _RADIUS)
_HAS_BORE = _BORE > _EDGE
_HAS_DISK = _OUTER > _INNER

RELATIONS = (
    Relation(
        code="E301",
        key="mean_radius_mm",
        broken=pl.col("mean_radius_mm").is_null() & pl.col("bore_diameter_mm").is_null(),
    ),
    Relation(
        code="E302",
        key="mean_radius_mm",
        broken=pl.col("mean_radius_mm").is_not_null() & pl.col("bore_diameter_mm").is_not_null(),
        facts=lambda row: {"other": f"{row['bore_diameter_mm']:g}"},
    ),
    _foreign("disk_thickness_mm", "cylinder"),
    _foreign("disk_inner_radius_mm", "cylinder"),
    _foreign("disk_outer_radius_mm", "cylinder"),
    _foreign("disk_hub_thickness_mm", "cylinder", "hat"),
    _foreign("disk_thickness_exponent", "cylinder", "hat", least=-1.0),
    _foreign("disk_cone_angle_deg", "cylinder"),
    _foreign("hub_fillet_radius_mm", "cylinder", "hat"),
    _foreign("junction_fillet_radius_mm", "cylinder", "hat"),
    Relation(
        code="E311",
        key="disk_inner_radius_mm",
        broken=_is("cup") & pl.col("disk_inner_radius_mm").is_null(),
        facts=lambda _: {"other": "cup"},
    ),
    Relation(
        code="E311",
        key="disk_outer_radius_mm",
        broken=_is("hat") & pl.col("disk_outer_radius_mm").is_null(),
        facts=lambda _: {"other": "hat"},
    ),
    Relation(
        code="E303",
        key="disk_inner_radius_mm",
        broken=_is("cup") & (_INNER >= _OUTER),
        facts=lambda row: {"other": _outer(row)},
    ),
    Relation(
        code="E303",
        key="disk_inner_radius_mm",
        broken=_is("hat") & (pl.col("disk_outer_radius_mm") <= _INNER),
        facts=lambda row: {
            "other": row["disk_outer_radius_mm"],
            "value": radius(row) if row["disk_inner_radius_mm"] is None else row["disk_inner_radius_mm"],
        },
    ),
    Relation(
        code="E330",
        key="wall_thickness_mm",
        broken=~_HAS_BORE,
        facts=lambda row: {"other": 2 * radius(row)},
    ),
    Relation(
        code="E304",
        key="rim_thickness_mm",
        broken=pl.col("rim_length_mm").is_not_null() & pl.col("rim_thickness_mm").is_null(),
    ),
    Relation(
        code="E304",
        key="rim_length_mm",
        broken=pl.col("rim_thickness_mm").is_not_null() & pl.col("rim_length_mm").is_null(),
    ),
    Relation(
        code="E325",
        key="disk_hub_thickness_mm",
        broken=_is("cup") & pl.col("disk_thickness_exponent").is_not_null() & pl.col("disk_hub_thickness_mm").is_null(),
    ),
    Relation(
        code="E326",
        key="disk_thickness_mm",
        broken=_is("cup")
        & pl.col("disk_thickness_exponent").is_not_null()
        & pl.col("disk_hub_thickness_mm").is_not_null()
        & pl.col("disk_thickness_mm").is_not_null(),
        facts=lambda row: {"other": f"{row['disk_thickness_exponent']:g}"},
    ),
    _fillet_on_a_cone("hub_fillet_radius_mm"),
    _fillet_on_a_cone("junction_fillet_radius_mm"),
    Relation(
        code="E305",
        key="rim_length_mm",
        broken=pl.col("rim_length_mm") >= pl.col("cylinder_length_mm"),
        facts=lambda row: {"other": row["cylinder_length_mm"]},
    ),
    Relation(
        code="E306",
        key="rim_thickness_mm",
        broken=pl.col("rim_thickness_mm") < pl.col("wall_thickness_mm"),
        facts=lambda row: {"other": row["wall_thickness_mm"]},
    ),
    Relation(
        code="E312",
        key="hub_fillet_radius_mm",
        broken=_is("cup") & _HAS_DISK & (pl.col("hub_fillet_radius_mm") > _OUTER - _INNER + _EDGE),
        facts=lambda row: {"other": _outer(row) - row["disk_inner_radius_mm"]},
    ),
    Relation(
        code="E313",
        key="junction_fillet_radius_mm",
        broken=_is("cup")
        & (pl.col("junction_fillet_radius_mm") > 0)
        & (pl.col("cylinder_length_mm") > _RIM)
        & (pl.col("junction_fillet_radius_mm") + _RIM > pl.col("cylinder_length_mm") + _EDGE),
        facts=lambda row: {"other": row["cylinder_length_mm"]},
    ),
    Relation(
        code="E328",
        key="junction_fillet_radius_mm",
        broken=_is("cup") & _HAS_BORE & (pl.col("junction_fillet_radius_mm") > _BORE + _EDGE),
        facts=lambda row: {"other": _bore(row)},
    ),
    Relation(
        code="W416",
        key="junction_fillet_radius_mm",
        broken=_is("cup")
        & (pl.col("junction_fillet_radius_mm") > 0)
        & (pl.col("junction_fillet_radius_mm") <= _BORE + _EDGE)
        & _HAS_DISK
        & (_HUB_FILLET <= _OUTER - _INNER + _EDGE)
        & (pl.col("junction_fillet_radius_mm") + _HUB_FILLET > _BORE - pl.col("disk_inner_radius_mm") + _EDGE),
        facts=lambda row: {"other": _bore(row) - row["disk_inner_radius_mm"]},
    ),
    Relation(
        code="W401",
        key="disk_outer_radius_mm",
        broken=_is("cup") & ((pl.col("disk_outer_radius_mm") / _RADIUS - 1).abs() > 1e-9),  # noqa: PLR2004
        facts=lambda row: {"other": radius(row)},
    ),
    Relation(
        code="W401",
        key="disk_inner_radius_mm",
        broken=_is("hat")
        & (pl.col("disk_inner_radius_mm") < pl.col("disk_outer_radius_mm"))
        & ((pl.col("disk_inner_radius_mm") - _RADIUS).abs() > pl.col("wall_thickness_mm") / 2 + _EDGE),
        facts=lambda row: {"other": radius(row)},
    ),
    Relation(
        code="W419",
        key="disk_inner_radius_mm",
        broken=_is("cup") & _HAS_BORE & _HAS_DISK & (pl.col("disk_inner_radius_mm") > _HUB_SHARE * _BORE + _EDGE),
        facts=lambda row: {"other": _bore(row)},
    ),
    Relation(
        code="W418",
        key="wall_thickness_mm",
        broken=(pl.col("wall_thickness_mm") / _RADIUS <= 0.1)  # noqa: PLR2004
        & ~_WALL_SHARE.is_between(_WALL_SHARES[0] - _EDGE, _WALL_SHARES[1] + _EDGE),
        facts=lambda row: {
            "detail": f"{row['wall_thickness_mm'] / (2 * radius(row)):.2g}",
            "other": 2 * radius(row),
        },
    ),
    Relation(
        code="W403",
        key="wall_thickness_mm",
        broken=_HAS_BORE & (pl.col("wall_thickness_mm") / _RADIUS > 0.2),  # noqa: PLR2004
        facts=lambda row: {"value": f"{row['wall_thickness_mm'] / radius(row):.2g}"},
    ),
    Relation(
        code="I506",
        key="wall_thickness_mm",
        broken=(pl.col("wall_thickness_mm") / _RADIUS).is_between(0.1, 0.2, closed="right"),
        facts=lambda row: {"value": f"{row['wall_thickness_mm'] / radius(row):.2g}"},
    ),
)
