"""Lots and parts: which inputs a lot draws once, which each part in it draws, and how the two act together.

lot                 parts that share the values of the lot inputs
lot input           an input that is drawn once for each lot, such as a modulus
part input          an input that is drawn anew for each part, such as a wall
relation            how lot and part inputs meet in the output: as a sum, as a product, or otherwise
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from flexlash.schema.arrays import Array
from flexlash.tolerance.engine.line_direction import Indices, Inputs, RowModel

__all__ = [
    "LOTS_ALIKE",
    "OTHERWISE",
    "PARTS_ALIKE",
    "PRODUCT",
    "SUM",
    "LotsAndParts",
    "holding",
    "of_rows",
    "values_at",
]

LOTS_ALIKE, PARTS_ALIKE, SUM, PRODUCT, OTHERWISE = range(5)
"""Relations: the lot inputs have no effect, the part inputs have none, Y = g(lot) + h(part), Y = g(lot) h(part)."""

_PROBES = 8
_REACH = 5.0
"""Probes lie within this score to both sides, near and far."""

_ENTANGLED = 1e-7
"""Part of the range of the probed outputs that a sum or a product may miss: far below every precision wanted."""

_ROUNDING = 64 * np.finfo(float).eps
"""Part of the greatest probed output below which differences are rounding."""


class LotsAndParts:
    """The model of rows alike with its inputs split into `lots`, the names in `between`, and `parts`, the others.

    Medians are the values at score 0, by name, (rows,) each.
    """

    def __init__(self, model: RowModel, inputs: Inputs, between: Collection[str]) -> None:
        self.model = model
        self.inputs = inputs
        self.between = frozenset(between)
        drawn_once = [name in self.between for name in inputs.names]
        self.lots = _chosen(inputs, np.flatnonzero(drawn_once))
        self.parts = _chosen(inputs, np.flatnonzero(np.logical_not(drawn_once)))
        self.rows = inputs.count
        self.lot_medians, self.part_medians = (
            values_at(group, np.zeros((len(group.names), 1, 1)), (-1,)) for group in (self.lots, self.parts)
        )

    def take(self, rows: Indices) -> LotsAndParts:
        """Return some of the rows."""
        return LotsAndParts(of_rows(self.model, rows), self.inputs.take(rows), self.between)

    @property
    def lots_alone(self) -> RowModel:
        """The model of the lot inputs, parts at their medians."""
        return holding(self.model, self.part_medians, np.arange(self.rows))

    @property
    def parts_alone(self) -> RowModel:
        """The model of the part inputs in the lot at the medians."""
        return holding(self.model, self.lot_medians, np.arange(self.rows))

    def at_medians(self) -> Array:
        """Return the output (rows,) with every input at its median."""
        held = {**self.lot_medians, **self.part_medians}
        return np.asarray(self.model({name: values[None] for name, values in held.items()}, np.arange(self.rows))[0])

    def relation(self) -> npt.NDArray[np.intp]:
        """Return how lot and part inputs act together in each row, (rows,), by a few outputs at scattered inputs.

        Equation: Y(l, p) + Y(l₀, p₀) = Y(l, p₀) + Y(l₀, p) for a sum, and the same with × for a product
        Valid: smooth models; (l₀, p₀) are the medians; a product whose factors may change sign is none.
        Source: definition; the probed points lie up to five scores out.
        """
        lots, parts = (_scattered(group, seed) for group, seed in ((self.lots, 1), (self.parts, 2)))
        middle = {name: values[None] for name, values in (self.lot_medians | self.part_medians).items()}
        every = np.arange(self.rows)
        joint, lot, part = (self.model(middle | varied, every) for varied in (lots | parts, lots, parts))
        centre = self.at_medians()
        noise = _ROUNDING * np.abs(joint).max(axis=0)
        slack = _ENTANGLED * np.abs(joint - centre).max(axis=0) + noise
        ratio = np.where(centre != 0, part / np.where(centre != 0, centre, 1.0), -1.0)
        one_sign = (ratio > 0).all(axis=0) & (lot * centre > 0).all(axis=0)
        found = np.full(self.rows, OTHERWISE)
        for relation, holds in (
            (PRODUCT, one_sign & (np.abs(joint - lot * ratio).max(axis=0) <= slack)),
            (SUM, np.abs(joint - centre - (lot - centre) - (part - centre)).max(axis=0) <= slack),
            (PARTS_ALIKE, _alike(joint - lot, part - centre, noise)),
            (LOTS_ALIKE, _alike(joint - part, lot - centre, noise)),
        ):
            found = np.where(holds, relation, found)
        return found


def holding(model: RowModel, held: Mapping[str, Array], rows: Indices) -> RowModel:
    """Return the model of the other inputs where these are held.

    Arguments: a model of rows alike; values (n,) by name, each for the row of that index among `rows` (n,).
    """
    return lambda arguments, chosen: model(
        {**{name: values[chosen] for name, values in held.items()}, **arguments}, rows[chosen]
    )


def of_rows(model: RowModel, rows: Indices) -> RowModel:
    """Return the model of some of the rows."""
    return lambda arguments, chosen: model(arguments, rows[chosen])


def _chosen(inputs: Inputs, group: Indices) -> Inputs:
    """Return some of the inputs, which none outside them is correlated with."""
    return replace(
        inputs,
        names=tuple(inputs.names[index] for index in group),
        shapes=tuple(inputs.shapes[index] for index in group),
        location=inputs.location[group],
        scale=inputs.scale[group],
        factor=None if inputs.factor is None else inputs.factor[np.ix_(group, group)],
    )


def values_at(inputs: Inputs, scores: Array, shape: tuple[int, ...] | None = None) -> dict[str, Array]:
    """Return inputs by name at independent scores (inputs, k, 1), (k, rows) each, or in another shape."""
    values = {}
    scores = inputs.correlated(scores)
    for index, name in enumerate(inputs.names):
        value = inputs.location[index] + inputs.scale[index] * inputs.shapes[index].standard_at(scores[index])
        values[name] = value if shape is None else value.reshape(shape)
    return values


def _scattered(inputs: Inputs, seed: int) -> dict[str, Array]:
    """Return inputs at points near and far that have nothing in common, (probes, rows) by name."""
    generator = np.random.default_rng(seed)
    shape = len(inputs.names), _PROBES, 1
    scores = generator.choice([-1.0, 1.0], shape) * generator.uniform(0.6, 1, shape)
    return values_at(inputs, scores * np.linspace(_REACH, _REACH / _PROBES, _PROBES)[:, None])


def _alike(joint: Array, alone: Array, noise: Array) -> npt.NDArray[np.bool_]:
    """Return of which rows a change of inputs moves the output by rounding alone, (rows,)."""
    return np.asarray(np.maximum(np.abs(joint), np.abs(alone)).max(axis=0) <= noise)
