"""Any model, any inputs: their spread with honest standard errors."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import cast, get_args

import numpy as np

from flexlash.schema.argument_checks import function, named_arguments, of_type, one_of, whole_number
from flexlash.schema.arrays import Array
from flexlash.tolerance.correlated_inputs import CorrelationOf, correlation_factor
from flexlash.tolerance.distributions import Distribution, Normal, Triangular, Uniform
from flexlash.tolerance.engine.line_direction import Indices, Inputs, RowModel
from flexlash.tolerance.engine.line_spread import LineSpread, LinesUnsuitable
from flexlash.tolerance.lognormal import Lognormal
from flexlash.tolerance.measured import Measured
from flexlash.tolerance.nested_lots import lots_of, require_lots_apart
from flexlash.tolerance.sampled_spread import Model, SampledSpread
from flexlash.tolerance.sampling import UnitPoints
from flexlash.tolerance.spread import Method, Spread
from flexlash.tolerance.student import Student
from flexlash.tolerance.truncated_normal import TruncatedNormal

__all__ = ["NOT_LINES", "propagate"]

NOT_LINES = "Sobol' points instead of lines"

_KNOWN = {Normal, TruncatedNormal, Uniform, Triangular, Lognormal, Student, Measured}
"""What needs no look at all that a distribution must tell, which takes as long as a fifth of a spread by lines."""


@named_arguments
def propagate(
    model: Model,
    inputs: Mapping[str, Distribution],
    *,
    method: Method = "line",
    samples: int | None = None,
    seed: int = 0,
    correlation: Mapping[tuple[str, str], float] | None = None,
    correlation_of: CorrelationOf = "scores",
    between: Collection[str] = (),
) -> Spread:
    """Return the spread of a model whose inputs vary independently, or by pairs as `correlation` says.

    `model` takes the inputs as keyword arrays of one shape and returns an array of that shape. `samples` are the
    lines or points in all, rounded up to replicates × a power of two; without them `line` takes as many lines as
    its precision needs. Where lines do not serve the model, Sobol' points answer and `notes` says why. `between` names
    the inputs that are one value for a whole lot of parts, so that the spread tells lots from parts.

    `correlation` holds numbers from −1 to 1 by pairs of names; pairs that it does not hold are independent. They are
    Pearson's correlations of the normal scores unless `correlation_of` says `"ranks"` (Spearman's) or `"values"`
    (Pearson's of the values); in any case a Gaussian copula ties the inputs. With ±1 one input follows the other.

    Raises TypeError or ValueError, with its name, for an argument that is none of these, and ValueError for a model
    that returns another shape or a number that is not finite, and for correlations that contradict one another: it
    names the nearest admissible value. No correlation may tie an input of a lot to one of a part.

    >>> from flexlash.tolerance import Normal, propagate
    >>> spread = propagate(lambda a, b: a + b, {"a": Normal(0, 3), "b": Normal(0, 4)})
    >>> f"{spread.sd:.9f} {spread.quantile(0.99865):.4f} {spread.shares['b']:.2f}"
    '5.000000000 14.9999 0.64'
    >>> lots = propagate(lambda a, b: a + b, {"a": Normal(0, 3), "b": Normal(0, 4)}, between={"a"})
    >>> f"{lots.within_lot_sd:.6f} {lots.between_lots_sd:.6f} {lots.lots_failing(limit=12, ppm=1350):.6f}"
    '4.000000 3.000000 0.499988'
    >>> tied = {("a", "b"): 0.8}
    >>> spread = propagate(lambda a, b: a + b, {"a": Normal(0, 3), "b": Normal(0, 4)}, correlation=tied)
    >>> f"{spread.sd:.9f} {(9 + 16 + 2 * 0.8 * 3 * 4) ** 0.5:.9f}"
    '6.648308055 6.648308055'
    """
    one_of("method", method, get_args(Method))
    samples = None if samples is None else whole_number("samples", samples, least=1)
    seed = whole_number("seed", seed, least=0)
    function("model", model, required="a function of the inputs by name")
    for name, distribution in of_type("inputs", inputs, Mapping, "a mapping of names to distributions").items():
        of_type("a name of inputs", name, str, "a text")
        if type(distribution) not in _KNOWN:
            of_type(f"inputs[{name!r}]", distribution, Distribution, "a distribution such as Normal(0, 1)")
    if not inputs:
        raise ValueError("at least one input must vary")
    factor = None if correlation is None else correlation_factor(correlation, correlation_of, inputs)
    together = {one_of("a name of between", name, inputs) for name in _names(between)}
    tied = Inputs.of([inputs], factor)
    require_lots_apart(tied, together)
    spread = _spread_of(model, inputs, factor, method, samples=samples, seed=seed)
    if together:
        spread.divide(*lots_of(_row_model(model), tied, together, spread.method, samples=samples, seed=seed))
    return spread


def _names(between: object) -> Collection[object]:
    """Return a collection of names, which a text is not."""
    required = "a collection of names of inputs"
    if isinstance(between, str):
        raise TypeError(f"between = {between!r}: {required} is required")
    return cast("Collection[object]", of_type("between", between, Collection, required))


def _spread_of(
    model: Model,
    inputs: Mapping[str, Distribution],
    factor: Array | None,
    method: Method,
    *,
    samples: int | None,
    seed: int,
) -> Spread:
    """Return the spread by a method; by Sobol' points where lines do not serve."""
    notes: tuple[str, ...] = ()
    if method == "line":
        try:
            return LineSpread(_row_model(model), inputs, samples=samples, seed=seed, factor=factor)
        except LinesUnsuitable as reason:
            notes = (f"{NOT_LINES}: {reason}.",)
            method = "sobol"
    points = UnitPoints(list(inputs), method=method, samples=samples, seed=seed)
    return SampledSpread(model=model, inputs=inputs, points=points, notes=notes, factor=factor)


def _row_model(model: Model) -> RowModel:
    """Return a model of keyword arrays as the model of a single row."""

    def outputs_of(arguments: Mapping[str, Array], rows: Indices) -> Array:  # noqa: ARG001
        shape = np.broadcast_shapes(*(values.shape for values in arguments.values()))
        flat = {
            name: (values if values.shape == shape else np.broadcast_to(values, shape)).reshape(-1)
            for name, values in arguments.items()
        }
        outputs = np.asarray(model(**flat), dtype=float)
        if outputs.shape != (shape[0] * shape[1],):
            raise ValueError(f"the model returned shape {outputs.shape}, not that of its inputs")
        return outputs.reshape(shape)

    return outputs_of
