"""What the stages of the analysis return, apart from the code that makes it: whoever receives it loads nothing else."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from flexlash.mechanics.nominal_record import NominalNumbers
from flexlash.schema.findings import Finding
from flexlash.schema.variant import Limits, Variant
from flexlash.validation.validated import Blocked

if TYPE_CHECKING:
    from flexlash.tolerance.spread_statistics import SpreadStatistics

__all__ = ["Computed", "Elasticity", "Nominal", "Spread", "Verified"]


@dataclass(frozen=True, kw_only=True)
class Elasticity:
    """What the elasticity check of one variant found.

    `windup` [rad], its `error` as a share of it, the `difference` of the formula without calibration as a share of it,
    and the peak stresses at the fillets [Pa], None without a fillet or where the stress has not settled.
    """

    windup: float
    difference: float
    error: float
    hub_fillet_shear: float | None
    junction_fillet_shear: float | None


@dataclass(frozen=True, kw_only=True)
class Computed:
    """One computed variant, all in SI: as entered, its limits, its nominal numbers, its spread, its elasticity check.

    What no stage has found so far, or could not find, is None.
    """

    variant: Variant
    limits: Mapping[str, Limits]
    nominal: NominalNumbers
    spread: SpreadStatistics | None = None
    elasticity: Elasticity | None = None


@dataclass(frozen=True, kw_only=True)
class Nominal:
    """The variants that can be computed, at their entered dimensions, by row number; and what else was found.

    `blocked` is what is not to be computed after this stage.
    """

    computed: Mapping[int, Computed] = field(default_factory=dict)
    findings: tuple[Finding, ...] = ()
    blocked: Blocked = field(default_factory=Blocked)


@dataclass(frozen=True, kw_only=True)
class Spread:
    """The spread of each variant by row number; `cross_checked` says that plain Monte Carlo stands beside it."""

    statistics: Mapping[int, SpreadStatistics]
    cross_checked: bool = False


@dataclass(frozen=True, kw_only=True)
class Verified:
    """The elasticity check of each variant that could be checked, by row number, and what it showed."""

    checks: Mapping[int, Elasticity]
    findings: tuple[Finding, ...] = ()
