"""Other materials that a variant that misses its limit would meet it with."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from flexlash.decisions.changed_rows import limits_as_submitted, over_limit, toleranced
from flexlash.decisions.changes import Change, in_material
from flexlash.decisions.lever import Lever, Present, Terms
from flexlash.decisions.nominal_levers import changed_alike, presents_alike
from flexlash.decisions.why_not import softer, still_over
from flexlash.schema.decision_columns import MATERIAL
from flexlash.schema.spellings import plain
from flexlash.schema.variant import Variant

__all__ = ["material_levers"]


def material_levers(presents: Sequence[Present], terms: Terms) -> Iterator[tuple[int, Lever, Variant | None]]:
    """Yield a lever for each other material of variants that miss their limit, possible or not, as `nominal_levers`."""
    if not terms.may_change(MATERIAL):
        return
    failing = [index for index, one in enumerate(presents) if one.direction(terms.target) == "meet"]
    pairs = [
        (index, in_material(presents[index].variant, material))
        for index in failing
        for name, material in terms.materials.items()
        if name != plain(presents[index].variant.material)
    ]
    changed = [replace(presents[index], variant=variant) for index, variant in pairs]
    for (index, variant), (over, reason) in zip(pairs, _shares(changed, terms), strict=True):
        row = terms.rows.get(MATERIAL)
        lever = Lever(
            variant=presents[index].variant,
            dimension=MATERIAL,
            what="material",
            direction="meet",
            unit="",
            to_material=variant.material,
            reason=reason,
            over=over,
            relative_cost=None if reason else 1.0 if row is None else row.cost_per_step,
        )
        yield index, lever, None if reason else variant


def _shares(changed: Sequence[Present], terms: Terms) -> list[tuple[float | None, str]]:
    """Return of each variant in another material the share over the limit, or why it does not meet that.

    The share is not asked for where the mean backlash alone is over the limit.
    """
    found: list[tuple[float | None, str]] = [(None, "")] * len(changed)
    hopeful = []
    for indices in presents_alike(changed):
        group = [changed[index] for index in indices]
        alike = changed_alike(group, Change(dimension="wall_thickness"), terms)
        means = alike.moments(alike.present[:, None]).mean[:, 0].tolist()
        for index, present, mean in zip(indices, group, means, strict=True):
            if mean > present.limit:
                found[index] = None, softer(present.variant.material, mean, present.limit, terms.angles)
            else:
                hopeful.append(index)
    rows = []
    for present in (changed[index] for index in hopeful):
        limits, _ = limits_as_submitted(present.variant, terms)
        rows.append(toleranced(present.variant, limits, present.limit, terms))
    for index, over in zip(hopeful, over_limit(rows, terms), strict=True):
        material = changed[index].variant.material
        found[index] = (over, "") if over <= terms.target else (None, still_over(material, over))
    return found
