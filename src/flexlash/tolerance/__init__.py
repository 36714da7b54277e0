"""From tolerances to a spread: limits, distributions, sampling, statistics. Knows no mechanics and no processes.

>>> from flexlash.tolerance import Uniform, propagate
>>> spread = propagate(lambda a: 2 * a, {"a": Uniform(low=0, high=1)})
>>> f"{spread.quantile(0.95):.9f}"
'1.900000000'

Limits of a dimension are a `Distribution` that it scatters by; a `SamplingPlan` says how many lines or points are
taken; a `Spread` is the output's whole distribution, `SpreadStatistics` the numbers of it that are kept for a row, a
`Curve` what is drawn of it. Inputs may be correlated (`correlation`), and some may be one value for a whole lot of
parts (`lots`). Lines are the method for models that rise smoothly (`engine`); points serve any model.
"""

from flexlash.tolerance.distributions import Normal, Triangular, Uniform
from flexlash.tolerance.lognormal import Lognormal
from flexlash.tolerance.measured import Measured
from flexlash.tolerance.propagate import propagate
from flexlash.tolerance.spread import Spread
from flexlash.tolerance.student import Student
from flexlash.tolerance.truncated_normal import TruncatedNormal

__all__ = [
    "Lognormal",
    "Measured",
    "Normal",
    "Spread",
    "Student",
    "Triangular",
    "TruncatedNormal",
    "Uniform",
    "propagate",
]
