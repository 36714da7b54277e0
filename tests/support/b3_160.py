"""The published cup B3-160 in SI, as the tests' usual variant."""

from functools import partial

from flexlash.mechanics import flexspline

CUP, TUBE = (partial(flexspline.backlash, kind) for kind in ("cup", "cylinder"))

NOMINAL = {
    "torque": 800.0,
    "cylinder_length": 0.160,
    "mean_radius": 0.080,
    "wall_thickness": 0.0016,
    "disk_inner_radius": 0.040,
    "youngs_modulus": 211e9,
    "poisson_ratio": 0.3,
}
