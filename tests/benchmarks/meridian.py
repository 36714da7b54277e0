"""Cost of the meridian model beside the two-term formula, and of the elasticity check; prints ratios, asserts nothing.

`python tests/benchmarks/meridian.py` takes about a minute.
"""

from __future__ import annotations

import time
from functools import partial

import numpy as np

from flexlash.analysis.tolerance_spread import row_statistics
from flexlash.mechanics.elasticity.twist import elasticity_check
from flexlash.mechanics.flexspline import backlash
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.variant import Variant
from flexlash.tolerance.dimension_limits import limits_of
from flexlash.tolerance.row_batches import TolerancedRow
from flexlash.tolerance.sampling import SamplingPlan
from flexlash.validation.materials_and_classes import standard_class

PLAIN = {
    "torque": 800.0,
    "cylinder_length": 0.16,
    "mean_radius": 0.0808,
    "wall_thickness": 0.0016,
    "disk_inner_radius": 0.04,
    "youngs_modulus": 211e9,
    "poisson_ratio": 0.3,
    "cylinder_calibration": 1.0,
    "disk_calibration": 1.0,
}
RIM = {"rim_length": 0.02, "rim_thickness": 0.0032}
FILLETS = {"hub_fillet_radius": 0.0035, "junction_fillet_radius": 0.0035}
TAPER = {"disk_thickness": 0.0016, "disk_hub_thickness": 0.003}
POWER = {"disk_hub_thickness": 0.004, "disk_thickness_exponent": 2.0}
SHAPES = {
    "plain (two-term)": PLAIN,
    "rim": PLAIN | RIM,
    "fillets": PLAIN | FILLETS,
    "taper": PLAIN | TAPER,
    "cone": PLAIN | {"disk_cone_angle": 1.2},
    "power law": PLAIN | POWER,
    "fillets, rim": PLAIN | FILLETS | RIM,
    "fillets, rim, taper": PLAIN | FILLETS | RIM | TAPER,
    "fillets, rim, power law": PLAIN | FILLETS | RIM | POWER,
}
ROWS = 200
POINTS = 16_384


def best(action, repeats=5):
    """Return the least time of several runs [s]."""
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        action()
        times.append(time.perf_counter() - start)
    return min(times)


def spread_time(dimensions, lines=None):
    """Return the time of the tolerance spread of one row among `ROWS` alike [s]; lines None adapts."""
    variants = [
        Variant(
            row=row,
            name=str(row),
            flexspline_type="cup",
            material="steel",
            tolerance_class="standard",
            dimensions=dimensions | {"cylinder_length": 0.16 + 1e-5 * row},
        )
        for row in range(ROWS)
    ]
    model = partial(backlash, "cup")
    rows = [
        TolerancedRow(model=model, nominal=variant.dimensions, limits=limits_of(variant, standard_class())[0])
        for variant in variants
    ]
    plan = SamplingPlan(method="line", inputs=tuple(DIMENSIONS), samples=lines)
    return best(lambda: list(row_statistics(rows, plan, 1)), 3) / ROWS


def model_time(dimensions):
    """Return the time of the model at `POINTS` points [s]."""
    stretched = np.linspace(1.0, 1.0001, POINTS)
    arrays = {name: size * stretched for name, size in dimensions.items()}
    return best(lambda: backlash("cup", arrays), 20)


def main() -> None:
    """Print the table."""
    print(f"{'':26} {'64 lines':>14} {'adaptive':>14} {f'model, {POINTS} points':>22}")
    print(f"{'shape':26} {'ms/row':>7} {'ratio':>6} {'ms/row':>7} {'ratio':>6} {'µs':>15} {'ratio':>6} {'check, s':>9}")
    first = None
    for name, dimensions in SHAPES.items():
        times = spread_time(dimensions, 64), spread_time(dimensions), model_time(dimensions)
        first = first or times
        fixed, adaptive, model = (one / other for one, other in zip(times, first, strict=True))
        check = best(lambda dimensions=dimensions: elasticity_check("cup", dimensions), 3)
        print(
            f"{name:26} {1e3 * times[0]:7.2f} {fixed:6.2f} {1e3 * times[1]:7.2f} {adaptive:6.2f} "
            f"{1e6 * times[2]:15.0f} {model:6.1f} {check:9.3f}"
        )


if __name__ == "__main__":
    main()
