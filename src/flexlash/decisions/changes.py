"""Which values of a variant may change alone, what follows them, and the variant after such a change."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace

from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.variant import Material, Variant

__all__ = ["Change", "changes_of", "in_material", "with_sizes"]


@dataclass(frozen=True, kw_only=True)
class Change:
    """A dimension that takes another value.

    `moves` are dimensions that follow it because they are the same on the drawing; `splits` those that were the same so
    far and stay as they are, by name, with what they were the same as; `present` the dimension that holds its value now
    where it has no entry of its own.
    """

    dimension: str
    moves: tuple[str, ...] = ()
    splits: Mapping[str, str] = field(default_factory=dict)
    present: str = ""

    def before(self, dimensions: Mapping[str, float]) -> float:
        """Return the present value [SI]."""
        return dimensions[self.present or self.dimension]

    def sizes(self, dimensions: Mapping[str, float], value: float) -> dict[str, float]:
        """Return dimensions [SI] with another value of this one."""
        kept = {name: dimensions[same] for name, same in self.splits.items()}
        return {**dimensions, **kept, self.dimension: value}


def changes_of(variant: Variant, may_change: Callable[[str], bool]) -> Iterator[Change]:
    """Yield the changes of single dimensions of a variant, of those that may change.

    A blank disk thickness gives three: with the wall, the wall alone, the disk alone. Blank disk radii are the mean
    radius, so that they only move with it.
    """
    sizes, kind = variant.dimensions, variant.flexspline_type
    shared = kind != "cylinder" and not {"disk_thickness", "disk_thickness_exponent"} & sizes.keys()
    for name, column in DIMENSIONS.items():
        if column.sheet != "Variants":
            continue
        if name == "disk_thickness" and shared and may_change(name):
            yield Change(dimension=name, present="wall_thickness")
        if name not in sizes or not may_change(name):
            continue
        if name == "wall_thickness" and shared:
            if may_change("disk_thickness"):
                yield Change(dimension=name, moves=("disk_thickness",))
            yield Change(dimension=name, splits={"disk_thickness": name})
        elif name in {"mean_radius", "bore_diameter"}:
            yield Change(dimension=name, moves=_with_the_mean_radius(kind, sizes))
        else:
            yield Change(dimension=name)


def _with_the_mean_radius(kind: str, sizes: Mapping[str, float]) -> tuple[str, ...]:
    """Return the blank radius of the disk that is the mean radius."""
    blank = {"cup": "disk_outer_radius", "hat": "disk_inner_radius"}.get(kind)
    return (blank,) if blank and blank not in sizes else ()


def with_sizes(variant: Variant, sizes: Mapping[str, float]) -> Variant:
    """Return a variant with other dimensions [SI], in the order in which a submission has them."""
    return replace(variant, dimensions={name: sizes[name] for name in DIMENSIONS if name in sizes})


def in_material(variant: Variant, material: Material) -> Variant:
    """Return a variant that is made of another material."""
    constants = material.constants
    used = {"shear_modulus": constants["shear_modulus"]} if "shear_modulus" in constants else constants
    elastic = {"shear_modulus", "youngs_modulus", "poisson_ratio"}
    sizes = {name: size for name, size in variant.dimensions.items() if name not in elastic} | dict(used)
    return replace(
        with_sizes(variant, sizes),
        material=material.name,
        yield_strength=material.yield_strength,
        youngs_modulus=constants.get("youngs_modulus"),
        poisson_ratio=constants.get("poisson_ratio"),
        density=material.density,
    )
