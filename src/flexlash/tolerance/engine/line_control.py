"""The surrogate along the lines of rows: what its law knows exactly corrects what the lines say of the model.

    control             the surrogate beside the model on the same lines
    used                rows (rows,) in which the difference of both is sharper known than the model alone

Equation: P(Y > y) = 1 − F_S(s) + mean over lines of (Φ(−t_model(y)) − Φ(−t_surrogate(s))), whichever s stands for y
Valid: a surrogate that only rises along every line; its law is known to `residual`.
Source: control variates (Glasserman 2003, 4.1) with an expectation that is known.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.special import ndtr, ndtri

from flexlash.schema.arrays import Array
from flexlash.tolerance.distributions import Normal
from flexlash.tolerance.engine.line_crossings import NODES, crossings
from flexlash.tolerance.engine.line_points import normal_density
from flexlash.tolerance.engine.line_surrogate import AdditiveSurrogate
from flexlash.tolerance.engine.line_tables import Lines, bounds_of
from flexlash.tolerance.engine.shape_rules import pulled_in
from flexlash.tolerance.engine.surrogate_law import SurrogateLaw
from flexlash.tolerance.engine.term_rules import polynomial

__all__ = ["LineControl"]

_TRIED = np.array([0.00135, 0.025, 0.5, 0.975, 0.99865])
"""Probabilities at whose outputs model and surrogate are compared."""

_BETTER = 0.8
"""The difference must be this much sharper than the model alone."""

_RARE, _RARE_UNCARRIED = 0.05, 1.0
"""Part of a probability up to which the law's own residual is let in."""

_CARRIED, _CARRIED_PART = np.array([1e-4, 1e-5, 1e-6]), 0.3
"""Probabilities at which it is seen whether lines carry a tail by themselves, the least of them that the law's residual
does not reach; they do if they find it to this part of it."""

_MIDDLE = [len(NODES) // 2]
"""The node of the medians along a line."""

_OUTER = [int(np.flatnonzero(score == NODES)[0]) for score in (-4.0, 4.0)]
"""Nodes at which model and surrogate are compared for the tails that no line reaches."""

_ALONE = np.arange(0.5, 6.25, 0.5)
"""Scores at which model and surrogate are compared where one input alone lies that far out."""

_DIP = 1e-9
"""A fall along a line smaller than this part of its range is rounding."""

Bools = npt.NDArray[np.bool_]


class LineControl:
    """The surrogates of rows alike on their lines: `table` (nodes, rows × lines) of outputs that only rise."""

    def __init__(self, lines: Lines, surrogate: AdditiveSurrogate, law: SurrogateLaw, needed: Bools) -> None:
        self._lines = lines
        self.surrogate = surrogate
        self.law = law
        self._heavy = [index for index, rule in enumerate(surrogate.rules) if rule.heavy]
        self._coefficients = np.repeat(surrogate.coefficients[:, :, None], lines.lines, axis=3)
        middle = np.array([[rule.middle] for rule in surrogate.rules])
        half = np.array([[rule.half] for rule in surrogate.rules])
        inputs = lines.inputs
        self._middle = np.repeat(inputs.location + inputs.scale * middle, lines.lines, axis=1)[:, None]
        self._inverse = np.repeat(1 / (inputs.scale * half), lines.lines, axis=1)[:, None]
        table = self.outputs(NODES[:, None])
        rises = (np.diff(table, axis=0) >= -_DIP * (table[-1] - table[0])).all(axis=0) & np.isfinite(table).all(axis=0)
        self.used = needed & surrogate.fitted & rises.reshape(lines.rows, -1).all(axis=1)
        self.table = np.maximum.accumulate(table, axis=0)
        self._apart = self._mismatch()
        self._apart_alone = self._mismatch_alone()
        self._carried = self._tails_carried()
        self.used &= self._helps()

    def _mismatch(self) -> Array:
        """Return how far apart model and surrogate are in both tails, (tails, rows), as values of S."""
        lines = self._lines
        tails = lines.table[_OUTER].reshape(len(_OUTER), lines.rows, -1)
        matched = self.surrogate.matched(np.moveaxis(tails, 1, 2).reshape(-1, lines.rows))[0]
        matched = np.moveaxis(matched.reshape(len(_OUTER), -1, lines.rows), 1, 2).reshape(len(_OUTER), -1)
        return lines.mean_over_lines(np.abs(matched - self.table[_OUTER]))

    def _mismatch_alone(self) -> Array | None:
        """Return how far apart both are at most where one input alone lies up to so many scores out, as values of S.

        (tails, `_ALONE`, rows); None where all inputs are bounded or normal, which polynomials follow to their ends.
        """
        inputs, rules = self._lines.inputs, self.surrogate.rules
        ends = np.array([-_ALONE[-1], _ALONE[-1]])
        long = [
            index
            for index, (shape, rule) in enumerate(zip(inputs.shapes, rules, strict=True))
            if shape.shape != Normal.shape and np.abs(rule.variable(shape.standard_at(ends))).max() > 1 + 1e-9
        ]
        if not long:
            return None
        scores = np.zeros((len(rules), len(long), 2, len(_ALONE)))
        for place, index in enumerate(long):
            scores[index, place] = -_ALONE, _ALONE
        scores = inputs.correlated(scores.reshape(len(rules), -1))
        standard = np.stack([shape.standard_at(one) for shape, one in zip(inputs.shapes, scores, strict=True)])[
            :, :, None
        ]
        variable = np.stack([rule.variable(one) for rule, one in zip(rules, standard, strict=True)])
        total = np.add.reduce(polynomial(self.surrogate.coefficients[:, :, None], variable), axis=0)
        output = self._lines.outputs_at(inputs.location[:, None] + inputs.scale[:, None] * standard)
        apart = np.abs(self.matched(output)[0] - total)
        apart = np.where(np.isfinite(apart), apart, np.inf).reshape(len(long), 2, len(_ALONE), -1)
        higher = (output > self.surrogate.centre).reshape(apart.shape)
        tails = [np.where(higher == upper, apart, 0.0).max(axis=(0, 1)) for upper in (False, True)]
        return np.maximum.accumulate(np.stack(tails), axis=1)

    def _tails_carried(self) -> Bools:
        """Return whether the lines carry each tail (tails, rows) of the surrogate by themselves."""
        probability = np.concatenate([_CARRIED, 1 - _CARRIED])
        total = self.law.quantiles(probability)
        position = self.crossings(self._lines.each(total))[0].reshape(2, len(_CARRIED), -1)
        below = self.law.below(total)[0].reshape(2, len(_CARRIED), -1)
        exact = below[0], 1 - below[1]
        lined = (self._lines.mean_over_lines(ndtr(side * one)) for side, one in zip((1, -1), position, strict=True))
        found = [np.abs(one - true) <= _CARRIED_PART * true for one, true in zip(lined, exact, strict=True)]
        rarest = np.maximum((_CARRIED[:, None] >= self.law.residual).sum(axis=0) - 1, 0)
        return np.stack(found)[:, rarest, np.arange(self._lines.rows)]

    def _helps(self) -> Bools:
        """Return in which rows the difference is sharper known than the model alone, pooled over probabilities."""
        lines = self._lines
        output = np.where(self.used, self.quantiles(_TRIED), lines.mean_over_lines(lines.table[_MIDDLE]))
        model = ndtr(-lines.crossings(lines.each(output))[0])
        difference = model - ndtr(-self.crossings(lines.each(self.matched(output)[0]))[0])
        density = normal_density(ndtri(_TRIED))[:, None]
        alone = lines.standard_error(model) / density
        controlled = (lines.standard_error(difference) + self.law.residual) / density
        pooled = [np.add.reduce(error * error, axis=0) for error in (controlled, alone)]
        return np.asarray(pooled[0] < _BETTER * pooled[1])

    def outputs(self, positions: Array) -> Array:
        """Return S (k, rows × lines) at positions (k, 1) or (k, rows × lines) along the lines."""
        return self._lines.along(positions, self._total)

    def _total(self, values: Array, block: slice) -> Array:
        variable = (values - self._middle[:, :, block]) * self._inverse[:, :, block]
        for index in self._heavy:
            variable[index] = pulled_in(variable[index])
        return np.asarray(np.add.reduce(polynomial(self._coefficients[:, :, :, block], variable), axis=0))

    def matched(self, output: Array) -> tuple[Array, Array]:
        """Return the values of S that stand for outputs (levels, rows), and how they rise with these."""
        return self.surrogate.matched(output)

    def crossings(self, totals: Array) -> tuple[Array, Array]:
        """Return where the surrogates cross values of S (levels, rows × lines) by their table, and their slopes."""
        return crossings(self.table, totals)

    @property
    def bounds(self) -> tuple[Array, Array]:
        """About the least and the greatest output of each row that its surrogate stands for, (rows,) each."""
        low, high = self.surrogate.unmatched(np.stack(bounds_of(self.table, self._lines.rows)))
        return low, high

    def above(self, output: Array) -> Array:
        """Return the exact probabilities of S above what stands for outputs (levels, rows)."""
        return 1 - self.law.below(self.matched(output)[0])[0]

    def quantiles(self, probability: Array) -> Array:
        """Return about which outputs (levels, rows) the surrogate stays below with probabilities (levels,)."""
        return self.surrogate.unmatched(self.law.quantiles(probability))

    def trusted(self, rarer: Array) -> Bools:
        """Return at which levels (levels, rows), of this lesser probability, the law is sharp enough to be used."""
        carried = self._carried.all(axis=0)
        return np.asarray(self.used & (self.law.residual <= np.where(carried, _RARE, _RARE_UNCARRIED) * rarer))

    def unseen(self, above: Array, density: Array, lined: Array) -> Array:
        """Return about what no line tells of the probabilities of the model where the law is trusted, (levels, rows).

        Equation: |p − mean over lines of Φ(−t_surrogate)| · min(1, d f/min(p, 1 − p)), d how far apart model and
            surrogate are in that tail: what the lines miss of the surrogate's own probability may be as far off for
            the model as that is
        Arguments: exact probabilities p above values of S, the densities f there, the mean over lines of the same,
            (levels, rows) each.
        Valid: an order of size, not a bound: model and surrogate are compared where lines still pass.
        Source: coverage of the told intervals against exact probabilities.
        """
        apart = np.where(above < 1 - above, self._apart[1], self._apart[0])
        rarer = np.maximum(np.minimum(above, 1 - above), np.finfo(float).tiny)
        return np.asarray(np.abs(above - lined) * np.minimum(1.0, apart * density / rarer))

    def unmet(self, total: Array, above: Array, crossed: Array) -> Array | float:
        """Return about what no line tells of the model where one input alone goes far out, (levels, rows).

        Equation: |P(S > s ∓ d) − p| · min(1, m/min(p, 1 − p)), d how far apart both are where one input alone lies as
            far out as p is rare, m what the lines miss of p: how far their mean is off and may be by chance
        Arguments: values s of S, exact probabilities p above them, and what each line says of these.
        Valid: tails in which one input outdoes all others, as those of long-tailed inputs do.
        """
        if self._apart_alone is None:
            return 0.0
        upper = above < 1 - above
        rarer = np.maximum(np.minimum(above, 1 - above), np.finfo(float).tiny)
        # Half a score further than p is rare: what lies just beyond weighs as well.
        place = np.minimum(np.searchsorted(_ALONE, -ndtri(rarer)) + 1, len(_ALONE) - 1)
        apart = self._apart_alone[upper.astype(int), place, np.arange(above.shape[1])]
        moved = 1 - self.law.below(np.where(upper, total - apart, total + apart))[0]
        missed = np.abs(above - self._lines.mean_over_lines(crossed)) + self._lines.standard_error(crossed)
        return np.asarray(np.abs(moved - above) * np.minimum(1.0, missed / rarer))

    def untold(self, above: Array) -> Array:
        """Return what lines alone may miss at levels too rare for the law (levels, rows): its residual, at most.

        Nothing where the lines carry that tail of the surrogate by themselves.
        """
        carried = np.where(above < 1 - above, self._carried[1], self._carried[0])
        return np.where(self.used & ~carried, self.law.residual, 0.0)
