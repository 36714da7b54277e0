"""What `propagate` is told of correlated inputs, and what it refuses."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Literal, get_args

from flexlash.schema.argument_checks import number, of_type, one_of
from flexlash.schema.arrays import Array
from flexlash.tolerance.correlation import CorrelationFault, CorrelationMatrix, Entry, entry_faults, score_factor
from flexlash.tolerance.distributions import Distribution, Normal
from flexlash.tolerance.hermite_series import score_correlation, value_correlation

__all__ = ["CorrelationOf", "correlation_factor", "correlation_matrix"]

CorrelationOf = Literal["scores", "ranks", "values"]

_STEPS = 10_000
"""Admissible values are told in these parts of 1, rounded to the side where they stay admissible."""


def correlation_matrix(
    correlation: Mapping[tuple[str, str], float], correlation_of: CorrelationOf, inputs: Mapping[str, Distribution]
) -> CorrelationMatrix:
    """Return the correlations of the inputs' normal scores.

    Equation: ρ for `scores`; 2 sin(π ρ/6) for `ranks`; for `values` the ρ whose values correlate so
    Arguments: correlations by pairs of input names; what they are correlations of.
    Valid: a Gaussian copula; ranks and scores from −1 to 1, values as far as their distributions can be correlated.
    Source: Pearson 1907 (ranks); Nataf 1962 (values).

    Raises TypeError or ValueError with the pair for what is no such mapping, and for correlations that cannot be.

    >>> from flexlash.tolerance.distributions import Uniform
    >>> pair = {"a": Uniform(0, 1), "b": Uniform(0, 5)}
    >>> correlation_matrix({("a", "b"): 0.5}, "ranks", pair).scores.round(6).tolist()
    [[1.0, 0.517638], [0.517638, 1.0]]
    """
    one_of("correlation_of", correlation_of, get_args(CorrelationOf))
    entries = _entries(correlation)
    for fault in entry_faults(entries, inputs):
        raise ValueError(_entry_refusal(entries[fault.entries[0]], fault, inputs))
    matrix = CorrelationMatrix.of([_of_scores(entry, correlation_of, inputs) for entry in entries], list(inputs))
    for fault in matrix.faults():
        raise ValueError(_matrix_refusal(entries, fault, correlation_of, inputs))
    return matrix


def correlation_factor(
    correlation: Mapping[tuple[str, str], float], correlation_of: CorrelationOf, inputs: Mapping[str, Distribution]
) -> Array | None:
    """Return the factor (inputs, inputs) that makes the inputs' correlated scores, None if they are independent.

    Inputs that are not normal come first in it: where there is one in a cluster, a score of its own moves it alone.
    """
    matrix = correlation_matrix(correlation, correlation_of, inputs)
    straight = [distribution.shape == Normal.shape for distribution in inputs.values()]
    return score_factor(matrix.scores, sorted(range(len(straight)), key=straight.__getitem__))


def _entries(correlation: Mapping[tuple[str, str], float]) -> list[Entry]:
    """Return the entries of a mapping of pairs to numbers."""
    entries = []
    for pair, value in of_type("correlation", correlation, Mapping, "a mapping of pairs of names to numbers").items():
        if not (isinstance(pair, tuple) and list(map(type, pair)) == [str, str]):
            raise TypeError(f"correlation has the pair {pair!r}: a tuple of two names is required")
        entries.append((*pair, number(f"correlation[{pair!r}]", value)))
    return entries


def _entry_refusal(entry: Entry, fault: CorrelationFault, inputs: Mapping[str, Distribution]) -> str:
    """Return what is wrong with one entry."""
    first, second, value = entry
    what = f"correlation[{(first, second)!r}]"
    if fault.kind == "name":
        unknown = first if first not in inputs else second
        return f"{what}: {unknown} is none of the inputs that vary, which are {', '.join(inputs)}"
    if fault.kind == "range":
        return f"{what} = {value:g}: a number from -1 to 1 is required"
    reasons = {"alone": "two different inputs are required", "twice": "each pair is required once, in either order"}
    return f"{what}: {reasons[fault.kind]}"


def _of_scores(entry: Entry, correlation_of: CorrelationOf, inputs: Mapping[str, Distribution]) -> Entry:
    """Return an entry as a correlation of scores, or raise ValueError for values that cannot be correlated so."""
    first, second, value = entry
    if correlation_of == "scores":
        return entry
    if correlation_of == "ranks":
        # The sine of π/6 is not quite a half.
        return first, second, value if abs(value) == 1 else 2 * math.sin(math.pi * value / 6)
    pair = inputs[first], inputs[second]
    score = score_correlation(*pair, value)
    if score is None:
        reach = value_correlation(*pair)
        low, high = _inward(reach(-1.0), up=True), _inward(reach(1.0), up=False)
        raise ValueError(
            f"correlation[{(first, second)!r}] = {value:g}: values of these distributions can be correlated from "
            f"{low} to {high}"
        )
    return first, second, score


def _as_entered(entry: Entry, score: float, correlation_of: CorrelationOf, inputs: Mapping[str, Distribution]) -> float:
    """Return a correlation of scores as one of what is entered."""
    if correlation_of == "scores":
        return score
    if correlation_of == "ranks":
        return 6 / math.pi * math.asin(score / 2)
    return value_correlation(inputs[entry[0]], inputs[entry[1]])(score)


def _matrix_refusal(
    entries: list[Entry],
    fault: CorrelationFault,
    correlation_of: CorrelationOf,
    inputs: Mapping[str, Distribution],
) -> str:
    """Return which correlations contradict one another, and the nearest that do not."""
    nearest = {
        index: _as_entered(entries[index], score, correlation_of, inputs) for index, score in fault.nearest.items()
    }
    if len(nearest) == 1:
        ((index, value),) = nearest.items()
        first, second, entered = entries[index]
        told = _inward(value, up=value > entered)
        rounded = [*entries[:index], (first, second, told), *entries[index + 1 :]]
        scores = CorrelationMatrix.of([_of_scores(entry, correlation_of, inputs) for entry in rounded], list(inputs))
        if any(index in other.entries for other in scores.faults()):
            told = value  # Where inputs follow one another no other value than this one will do.
        return (
            f"correlation[{(first, second)!r}] = {entered:g} contradicts the other correlations; the nearest "
            f"admissible value is {told}"
        )
    # Rounding moves an eigenvalue by less than all of this.
    smaller = 1 - len(entries) / _STEPS
    pairs = ", ".join(
        f"{entries[index][:2]!r}: {round(smaller * value * _STEPS) / _STEPS}" for index, value in nearest.items()
    )
    return f"correlation contradicts itself in more than one pair; the nearest admissible values are {{{pairs}}}"


def _inward(value: float, *, up: bool) -> float:
    """Return a value with few decimals, rounded up or down."""
    shifted = round(value * _STEPS, 6)
    return (math.ceil(shifted) if up else math.floor(shifted)) / _STEPS
