"""From tolerances to a spread: limits, distributions, sampling, statistics. Knows no mechanics.

>>> from flexlash.tolerance import Uniform, propagate
>>> spread = propagate(lambda a: 2 * a, {"a": Uniform(low=0, high=1)})
>>> f"{spread.quantile(0.95):.9f}"
'1.900000000'
"""

from flexlash.tolerance.distributions import Normal, Triangular, TruncatedNormal, Uniform
from flexlash.tolerance.propagate import propagate
from flexlash.tolerance.spread import Spread

__all__ = ["Normal", "Spread", "Triangular", "TruncatedNormal", "Uniform", "propagate"]
