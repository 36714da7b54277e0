"""The sound rows of Variants in SI: one by one as records, all together as columns; each is made when asked for."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import chain
from typing import TYPE_CHECKING, Any, overload

from flexlash.schema.column import Column, Role
from flexlash.schema.columns import VARIANTS
from flexlash.schema.spellings import plain
from flexlash.schema.variant import Material, Settings, Variant

if TYPE_CHECKING:
    import polars as pl

    from flexlash.schema.arrays import Array
    from flexlash.schema.variant_arrays import VariantArrays

__all__ = ["VariantRows"]

_REQUIREMENTS = {
    "rated_torque": "rated_torque",
    "load_inertia": "load_inertia_kg_m2",
    "backlash_limit": "backlash_limit",
    "system_limit": "system_limit",
    "bearing_width": "bearing_width",
    "engaged_teeth": "engaged_teeth_percent",
    "radial_deflection": "radial_deflection",
}
"""What is asked of a variant: its name in the record, and that of its column without unit."""

_CUP, _STANDARD = "cup", "standard"
"""What a blank cell stands for."""


@dataclass(frozen=True, kw_only=True)
class VariantRows(Sequence[Variant]):
    """The variants of a frame of Variants whose rows are all sound.

    `materials` are those that the rows use and maybe others, by plain name. Held is the frame alone.
    """

    frame: pl.DataFrame | None = None
    materials: Mapping[str, Material] = field(default_factory=dict)
    settings: Settings = field(default_factory=Settings)

    @property
    def _frame(self) -> pl.DataFrame:
        if self.frame is None:
            raise LookupError("there is no variant")
        return self.frame

    def __len__(self) -> int:
        """Return how many variants there are."""
        return 0 if self.frame is None else self.frame.height

    @overload
    def __getitem__(self, index: int) -> Variant: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[Variant]: ...
    def __getitem__(self, index: int | slice) -> Variant | Sequence[Variant]:
        """Return a variant, or some."""
        if isinstance(index, slice):
            return list(self.some(range(*index.indices(len(self)))))
        return self._variant(self._frame.row(index, named=True))

    def __iter__(self) -> Iterator[Variant]:
        """Yield the variants."""
        return self.some(range(len(self)))

    def some(self, places: Sequence[int]) -> Iterator[Variant]:
        """Yield the variants at some places, which costs less than one by one."""
        return map(self._variant, self._frame[places].iter_rows(named=True) if len(places) else ())

    @property
    def rows(self) -> list[int]:
        """The row numbers of the variants."""
        return self._frame["row"].to_list() if len(self) else []

    @property
    def classes(self) -> list[str]:
        """The plain name of each variant's tolerance class."""
        names = self._frame["tolerance_class"].to_list() if len(self) else []
        spelt = {name: plain(name or _STANDARD) for name in set(names)}
        return [spelt[name] for name in names]

    def arrays(self) -> VariantArrays:
        """Return the variants, of which there is one at least, as columns."""
        import numpy as np

        from flexlash.schema.variant_arrays import VariantArrays

        count, names = len(self), self._frame["material"].to_list()
        places = {name: place for place, name in enumerate(dict.fromkeys(names))}
        of_row = np.array([places[name] for name in names])
        used = [self.materials[plain(name)] for name in places]

        def of_material(values: Iterable[float | None]) -> Array:
            found: Array = np.array(list(values), dtype=float)[of_row]
            return found

        constants = [_constants(material) for material in used]
        elastic = {name: of_material(one.get(name) for one in constants) for name in dict.fromkeys(chain(*constants))}
        calibrations = {name: np.full(count, float(value)) for name, value in self.settings.calibrations.items()}
        asked, none = self._columns("requirement"), np.full(count, np.nan)
        numbers = {name: asked.get(key, none) for name, key in _REQUIREMENTS.items()}
        numbers["yield_strength"] = of_material(one.yield_strength for one in used)
        numbers["density"] = of_material(one.density for one in used)
        numbers |= {
            name: of_material(one.constants.get(name) for one in used) for name in ("youngs_modulus", "poisson_ratio")
        }
        return VariantArrays(
            flexspline_types=self._frame["flexspline_type"].replace("", _CUP).fill_null(_CUP).to_list(),
            dimensions=self._columns("dimension") | elastic | calibrations,
            numbers=numbers,
        )

    def _columns(self, role: Role) -> dict[str, Array]:
        """Return the numbers of this role in SI by name, NaN where one is left out; columns without any are absent."""
        found = {}
        for column in _NUMBERS[role]:
            values = self._frame[column.key].to_numpy() * column.si_unit.si
            if column.zero_is_blank:
                values[values == 0] = float("nan")
            if self._frame[column.key].count():
                found[column.dimension] = values
        return found

    def _variant(self, record: Mapping[str, Any]) -> Variant:
        """Return a row as a variant in SI; dimensions that equal another are left out."""
        requirements = _sizes(record, "requirement")
        material = self.materials[plain(record["material"])]
        return Variant(
            row=record["row"],
            name=record["variant"],
            flexspline_type=record["flexspline_type"] or _CUP,
            material=material.name,
            tolerance_class=record["tolerance_class"] or _STANDARD,
            dimensions=_sizes(record, "dimension") | _constants(material) | self.settings.calibrations,
            **{name: requirements.get(key) for name, key in _REQUIREMENTS.items()},
            yield_strength=material.yield_strength,
            youngs_modulus=material.constants.get("youngs_modulus"),
            poisson_ratio=material.constants.get("poisson_ratio"),
            density=material.density,
        )


_NUMBERS: Mapping[Role, Sequence[Column]] = {
    role: [column for column in VARIANTS if column.role == role and column.is_number]
    for role in ("dimension", "requirement")
}


_SIZES = {
    role: [(column.key, column.dimension, column.si_unit.si, column.zero_is_blank) for column in columns]
    for role, columns in _NUMBERS.items()
}


def _sizes(record: Mapping[str, Any], role: Role) -> dict[str, float]:
    """Return the numbers of a row in SI by name; those that are blank, or 0 where that says the same, are left out."""
    return {
        name: value * size
        for key, name, size, zero_is_blank in _SIZES[role]
        if (value := record[key]) is not None and not (zero_is_blank and value == 0)
    }


def _constants(material: Material) -> dict[str, float]:
    """Return the elastic constants that the mechanics take: the shear modulus alone where it is given."""
    return {name: material.constants[name] for name in ("shear_modulus",) if name in material.constants} or dict(
        material.constants
    )
