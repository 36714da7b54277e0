"""The tolerances of the reference model: a cup of B3-160 whose wall and disk scatter apart."""

from flexlash.tolerance import Normal, Uniform

__all__ = ["CORRELATED_WALLS", "REFERENCE_ERROR", "SCATTER"]

SCATTER = {
    "cylinder_length": Uniform(low=0.1598, high=0.1602),
    "wall_thickness": Uniform(low=0.00155, high=0.00165),
    "disk_thickness": Uniform(low=0.00155, high=0.00165),
    "mean_radius": Normal(mean=0.080, sd=2e-5),
    "disk_inner_radius": Uniform(low=0.03985, high=0.04015),
    "youngs_modulus": Normal(mean=211e9, sd=2.11e9),
    "poisson_ratio": Uniform(low=0.28, high=0.32),
}

CORRELATED_WALLS = {
    0.0: (2.01204, 1.112602, 1.131560),
    0.5: (2.22863, 1.116400, 1.135383),
    0.8: (2.34907, 1.118319, 1.137139),
    1.0: (2.42602, 1.119490, 1.138189),
}
"""sd [1e-5 rad], P97.5 and P99.865 [1e-3 rad] of the backlash by Pearson's correlation of wall and disk thickness."""

REFERENCE_ERROR = 3e-9
"""How well they are known [rad]."""
