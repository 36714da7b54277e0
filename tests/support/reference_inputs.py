"""The tolerances of the reference model: a cup of B3-160 whose wall and disk scatter apart."""

from flexlash.tolerance import Normal, Uniform

__all__ = ["SCATTER"]

SCATTER = {
    "cylinder_length": Uniform(low=0.1598, high=0.1602),
    "wall_thickness": Uniform(low=0.00155, high=0.00165),
    "disk_thickness": Uniform(low=0.00155, high=0.00165),
    "mean_radius": Normal(mean=0.080, sd=2e-5),
    "disk_inner_radius": Uniform(low=0.03985, high=0.04015),
    "youngs_modulus": Normal(mean=211e9, sd=2.11e9),
    "poisson_ratio": Uniform(low=0.28, high=0.32),
}
