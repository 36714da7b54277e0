"""What the stages of the analysis return, apart from the code that makes it: whoever receives it loads nothing else."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

from flexlash.analysis.row_records import RowRecords
from flexlash.mechanics.nominal_record import NominalNumbers
from flexlash.schema.findings import Finding
from flexlash.schema.spellings import plain
from flexlash.schema.variant import Limits, Variant
from flexlash.validation.validated import Blocked, Validated

if TYPE_CHECKING:
    import polars as pl

    from flexlash.analysis.spread_rows import SpreadRows
    from flexlash.tolerance.spread_statistics import SpreadStatistics

__all__ = ["Computed", "ComputedRows", "Elasticity", "Nominal", "Spread", "Verified"]


@dataclass(frozen=True, kw_only=True)
class Elasticity:
    """What the elasticity check of one variant found.

    `windup` [rad], its `error` as a share of it, the `difference` of the formula without calibration as a share of it,
    and the peak stresses at the fillets [Pa], None without a fillet or where the stress has not settled. With a tooth
    face width, of cups: the bounds of the backlash under two lobes [rad], and what the face width changes, as a share.
    """

    windup: float
    difference: float
    error: float
    hub_fillet_shear: float | None
    junction_fillet_shear: float | None
    two_lobe_low: float | None = None
    two_lobe_high: float | None = None
    face_width_change: float | None = None


@dataclass(frozen=True)
class Computed:
    """One computed variant, all in SI: as entered, its limits, its nominal numbers, its spread, its elasticity check.

    What no stage has found so far, or could not find, is None. Each part is made when it is first asked for.
    """

    among: ComputedRows = field(repr=False)
    place: int

    @cached_property
    def variant(self) -> Variant:
        """The variant as entered."""
        return self.among.variant(self.place)

    @cached_property
    def limits(self) -> Mapping[str, Limits]:
        """The limits of its dimensions, far tails cut."""
        from flexlash.analysis.backlash_models import BACKLASH_OF
        from flexlash.tolerance.dimension_limits import limits_of, shape_problems

        rows = self.among.validated.classes[plain(self.variant.tolerance_class)]
        limits, _ = limits_of(self.variant, rows, BACKLASH_OF[self.variant.flexspline_type])
        return shape_problems(self.variant, limits)[0]

    @property
    def between(self) -> frozenset[str]:
        """Those of its dimensions that scatter between lots: one value for all parts of a lot."""
        return frozenset(
            name for name, one in self.limits.items() if one.low < one.high and one.scatters_between == "lots"
        )

    @cached_property
    def correlation(self) -> tuple[tuple[str, str, float], ...]:
        """Which of its dimensions scatter together: two that both scatter, and the correlation of their scores."""
        pairs = self.among.correlations.get(plain(self.variant.tolerance_class), {})
        scattering = {name for name, limit in self.limits.items() if limit.low < limit.high} if pairs else set()
        return tuple((*pair, value) for pair, value in pairs.items() if scattering.issuperset(pair))

    @cached_property
    def nominal(self) -> NominalNumbers:
        """Its numbers at the entered dimensions."""
        return self.among.nominal(self.place)

    @cached_property
    def spread(self) -> SpreadStatistics | None:
        """Its spread."""
        statistics = self.among.statistics
        return None if statistics is None else statistics.get(self.variant.row)

    @cached_property
    def elasticity(self) -> Elasticity | None:
        """Its elasticity check."""
        return self.among.checks.get(self.variant.row)


@dataclass(frozen=True, kw_only=True, eq=False)
class ComputedRows(RowRecords[Computed]):
    """The computed variants by row number, which rises; held as columns, each a record when it is asked for.

    `numbers` has the columns `row`, `place` among the variants of `validated`, and the fields of `NominalNumbers` that
    some variant has; it is None where no variant is computed. `correlations` are those of the normal scores of two
    dimensions of a class, by its plain name, as entered or measured. `statistics` and `checks` are what later stages
    found, by row number.
    """

    validated: Validated = field(default_factory=Validated)
    numbers: pl.DataFrame | None = None
    correlations: Mapping[str, Mapping[tuple[str, str], float]] = field(default_factory=dict)
    statistics: SpreadRows | None = None
    checks: Mapping[int, Elasticity] = field(default_factory=dict)

    @property
    def columns(self) -> pl.DataFrame | None:
        """The numbers."""
        return self.numbers

    def at(self, place: int) -> Computed:
        """Return the variant at a place among the computed ones."""
        return Computed(self, place)

    def alike(self, most: int) -> list[list[int]]:
        """Return the row numbers of variants of one type, one tolerance class and the same dimensions, so many each."""
        rows, variants = list(self), self.validated.variants
        if not rows:
            return []
        places, classes = self._numbers["place"].to_numpy(), variants.classes
        arrays = variants.arrays().take(places)
        groups = [indices.tolist() for _, _, indices, _ in arrays.alike([classes[place] for place in places])]
        pieces = [group[start : start + most] for group in groups for start in range(0, len(group), most)]
        return [[rows[index] for index in piece] for piece in pieces]

    def variant(self, place: int) -> Variant:
        """Return the variant at a place among the computed ones."""
        return self.validated.variants[int(self._numbers["place"][place])]

    def nominal(self, place: int) -> NominalNumbers:
        """Return the nominal numbers at a place among the computed ones."""
        known = self._numbers.row(place, named=True)
        return NominalNumbers(**{name: value for name, value in known.items() if name not in {"row", "place"}})

    @property
    def _numbers(self) -> pl.DataFrame:
        if self.numbers is None:
            raise LookupError("no variant is computed")
        return self.numbers


@dataclass(frozen=True, kw_only=True)
class Nominal:
    """The variants that can be computed, at their entered dimensions, by row number; and what else was found.

    `blocked` is what is not to be computed after this stage.
    """

    computed: ComputedRows = field(default_factory=ComputedRows)
    findings: tuple[Finding, ...] = ()
    blocked: Blocked = field(default_factory=Blocked)


@dataclass(frozen=True, kw_only=True)
class Spread:
    """The spread of each variant by row number, and what it shows of whole drives.

    `cross_checked` says that plain Monte Carlo stands beside it.
    """

    statistics: SpreadRows
    cross_checked: bool = False
    findings: tuple[Finding, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Verified:
    """The elasticity check of each variant that could be checked, by row number, and what it showed."""

    checks: Mapping[int, Elasticity]
    findings: tuple[Finding, ...] = ()
