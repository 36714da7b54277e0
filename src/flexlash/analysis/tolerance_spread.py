"""Computed variants → their tolerance spread; the drawn ones among them → their whole distribution."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

from flexlash.analysis.assessment import Computed
from flexlash.analysis.options import Options, Progress
from flexlash.mechanics.flexspline import backlash
from flexlash.schema.variant import Settings
from flexlash.tolerance.distribution_curves import Curve, curves_of
from flexlash.tolerance.row_batches import spread_rows
from flexlash.tolerance.spread_statistics import SamplingPlan, Task

__all__ = ["drawn_curves", "scattered"]

_MODELS = {kind: partial(backlash, kind) for kind in ("cup", "hat", "cylinder")}


def scattered(
    computed: dict[int, Computed], settings: Settings, options: Options, progress: Progress | None
) -> dict[int, Computed]:
    """Return the variants with their spread; the same points serve all rows."""
    rows = list(computed.values())
    found = dict(computed)
    spreads = spread_rows([_task(one) for one in rows], _draws(settings, options), jobs=options.jobs)
    for done, (place, spread) in enumerate(spreads, start=1):
        found[rows[place].variant.row] = replace(rows[place], spread=spread)
        if progress:
            progress(done, len(rows))
    return found


def drawn_curves(drawn: Sequence[Computed], settings: Settings, options: Options) -> dict[int, Curve]:
    """Return the curves of variants by row number."""
    tasks = [(_task(one), one.spread) for one in drawn if one.spread]
    curves = curves_of(tasks, _draws(settings, options), jobs=options.jobs)
    return dict(zip((one.variant.row for one in drawn), curves, strict=True))


def _draws(settings: Settings, options: Options) -> SamplingPlan:
    return SamplingPlan(
        method=settings.method,
        samples=settings.samples,
        seed=settings.seed,
        coverage=settings.coverage_percent / 100,
        cross_check=bool(options.cross_check),
    )


def _task(one: Computed) -> Task:
    model = _MODELS[one.variant.flexspline_type]
    return model, one.variant.dimensions, one.limits, one.variant.backlash_limit
