"""Other materials that a variant that misses its limit would meet it with."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from flexlash.decisions.changed_rows import limits_as_submitted, over_limit, toleranced
from flexlash.decisions.changes import in_material
from flexlash.decisions.lever import Lever, Present, Terms
from flexlash.decisions.why_not import share_of_units
from flexlash.schema.decision_columns import MATERIAL
from flexlash.schema.spellings import plain
from flexlash.schema.variant import Variant

__all__ = ["material_levers"]


def material_levers(presents: Sequence[Present], terms: Terms) -> Iterator[tuple[int, Lever, Variant | None]]:
    """Yield a lever for each other material of variants that miss their limit, possible or not, as `nominal_levers`."""
    if not terms.may_change(MATERIAL):
        return
    missing = [index for index, one in enumerate(presents) if one.direction(terms.target) == "meet"]
    pairs = [
        (index, in_material(presents[index].variant, material))
        for index in missing
        for name, material in terms.materials.items()
        if name != plain(presents[index].variant.material)
    ]
    row = terms.rows.get(MATERIAL)
    cost = 1.0 if row is None else row.cost_per_step
    for (index, changed), over in zip(pairs, _shares(pairs, presents, terms), strict=True):
        variant = presents[index].variant
        reason = "" if over <= terms.target else f"with {changed.material} {share_of_units(over)} are over the limit"
        lever = Lever(
            variant=variant,
            dimension=MATERIAL,
            what="material",
            direction="meet",
            unit="",
            to_material=changed.material,
            reason=reason,
            over=None if reason else over,
            relative_cost=None if reason else cost,
        )
        yield index, lever, None if reason else changed


def _shares(pairs: Sequence[tuple[int, Variant]], presents: Sequence[Present], terms: Terms) -> list[float]:
    """Return the share over the limit of each variant in another material."""
    rows = []
    for index, changed in pairs:
        limits, _ = limits_as_submitted(changed, terms)
        rows.append(toleranced(changed, limits, presents[index].limit, terms))
    return over_limit(rows, terms)
