"""From tolerances to a spread: limits, distributions, sampling, statistics. Knows no mechanics.

>>> from flexlash.tolerance import Uniform, propagate
>>> spread = propagate(lambda a: 2 * a, {"a": Uniform(low=0, high=1)}, method="sobol", seed=1)
>>> f"{spread.quantile(0.95):.3f}"
'1.900'
"""

from flexlash.tolerance.distributions import Normal, Triangular, TruncatedNormal, Uniform
from flexlash.tolerance.propagate import Spread, propagate

__all__ = ["Normal", "Spread", "Triangular", "TruncatedNormal", "Uniform", "propagate"]
