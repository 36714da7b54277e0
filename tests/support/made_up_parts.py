"""Sixty parts that nobody has measured: made-up walls and disks of a wanted mean, standard deviation and correlation.

They are whole numbers of a hundredth of a micrometre, chosen so that mean and standard deviation are met exactly.
"""

from __future__ import annotations

import random
import statistics
from dataclasses import replace
from itertools import permutations

from flexlash.feedback.template.filling import Filling

__all__ = ["DISK", "FAULTS", "LIMIT", "PARTS", "SAMPLE", "WALL", "faulty_parts", "measured_parts"]

PARTS = 60
SAMPLE = "made-up pilot lot"

WALL = (1.607, 0.0041)
DISK = (1.604, 0.0038)
"""Mean and standard deviation of the sample [mm]."""

LIMIT = 3.767
"""Backlash limit [arcmin] that the sample meets, though sixty parts leave in doubt whether the process does."""

_STEPS = 100_000
"""Steps of the gauge in a millimetre."""

_SEED = 284
_TIE = 0.6


def _with_moments(scores: list[float], mean: float, sd: float) -> list[float]:
    """Return numbers [mm] in the order of these, with exactly the mean and standard deviation that are wanted."""
    centre, spread, own = statistics.fmean(scores), statistics.stdev(scores), round(sd * _STEPS)
    steps = [round((score - centre) / spread * own) for score in scores]
    for place in range(abs(sum(steps))):
        steps[place] -= 1 if sum(steps) > 0 else -1
    wanted = (len(scores) - 1) * own**2
    while lacking := wanted - sum(step**2 for step in steps):
        # One up and one down keep the sum; the squares gain 2 (up − down) + 2, always an even number.
        up, down = min(
            permutations(range(len(steps)), 2),
            key=lambda pair: abs(lacking - 2 * (steps[pair[0]] - steps[pair[1]]) - 2),
        )
        steps[up], steps[down] = steps[up] + 1, steps[down] - 1
    return [(round(mean * _STEPS) + step) / _STEPS for step in steps]


def _measurements() -> list[dict[str, str | float]]:
    """Return the rows of Measurements."""
    chance = random.Random(_SEED)  # noqa: S311
    walls = [chance.gauss(0, 1) for _ in range(PARTS)]
    disks = [_TIE * wall + (1 - _TIE**2) ** 0.5 * chance.gauss(0, 1) for wall in walls]
    columns = zip(_with_moments(walls, *WALL), _with_moments(disks, *DISK), strict=True)
    return [
        {"sample": SAMPLE, "part": f"P{number:02d}", "wall_thickness_mm": wall, "disk_thickness_mm": disk}
        for number, (wall, disk) in enumerate(columns, start=1)
    ]


def measured_parts() -> Filling:
    """Return one drawing twice: spread as its limits say, and as sixty made-up parts of it were measured."""
    part = {
        "flexspline_type": "cup",
        "material": "20Cr2Ni4",
        "torque_Nm": 800.0,
        "cylinder_length_mm": 160.0,
        "mean_radius_mm": 80.0,
        "wall_thickness_mm": 1.6,
        "disk_thickness_mm": 1.6,
        "disk_inner_radius_mm": 40.0,
        "backlash_limit_arcmin": LIMIT,
    }
    limits = {"lower_deviation": -0.02, "upper_deviation": 0.02, "deviation_unit": "mm"}
    both = ("wall_thickness", "disk_thickness")
    return Filling(
        variants=[
            {"variant": "as drawn", **part, "tolerance_class": "drawing", "notes": "± 0.02 mm at three sigma, centred"},
            {
                "variant": "as measured",
                **part,
                "tolerance_class": "measured",
                "notes": "Made up: no part was measured. Sixty walls and disks as a shop might measure them",
            },
        ],
        tolerances=[
            {"tolerance_class": "drawing", "based_on": "standard"},
            *({"tolerance_class": "drawing", "dimension": name, **limits} for name in both),
            {"tolerance_class": "measured", "based_on": "standard"},
            *({"tolerance_class": "measured", "dimension": name, **limits, "sample": SAMPLE} for name in both),
        ],
        measurements=_measurements(),
        correlations=[
            {
                "tolerance_class": "drawing",
                "dimension_1": "wall_thickness",
                "dimension_2": "disk_thickness",
                "correlation": 0.5,
                "reason": "Assumed: both are turned in one set-up",
            }
        ],
    )


FAULTS = {
    ("Measurements", "A16"): "E201",
    ("Measurements", "H8"): "E202",
    ("Measurements", "C14"): "E209",
    ("Tolerances", "K20"): "E202",
    ("Tolerances", "N21"): "E209",
    ("Tolerances", "M24"): "E223",
    ("Tolerances", "O19"): "E224",
    ("Correlations", "D5"): "E202",
    ("Correlations", "A6"): "E309",
}
"""The errors of `faulty_parts` by sheet and cell."""


def faulty_parts() -> Filling:
    """Return the same with a fault of each kind on the sheets of tolerances, measurements and correlations."""
    filling = measured_parts()
    tolerances, measurements = ([dict(row) for row in rows] for rows in (filling.tolerances, filling.measurements))
    measurements[3]["wall_thickness_mm"] = "1,60712"
    measurements[9]["use_as"] = "valeu"
    measurements[11]["sample"] = None
    tolerances[0]["based_on"] = "standart"
    tolerances[1]["cp"] = "1,33"
    tolerances[2]["scatters_between"] = "part"
    tolerances[4]["sample"] = SAMPLE.upper()
    tolerances[5]["sample"] = "pilot lot"
    (pair,) = filling.correlations
    correlations = [{**pair, "dimension_2": "Disk thickness", "correlation": "0,5"}]
    correlations += [{**pair, "tolerance_class": "measurd"}]
    return replace(filling, tolerances=tolerances, measurements=measurements, correlations=correlations)
