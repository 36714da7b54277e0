"""Lots and parts of submitted variants: how the spread divides and how many lots fail, as the submission says it."""

import math
import random
from dataclasses import replace
from pathlib import Path

import pytest
from b3_160 import CUP, NOMINAL
from toleranced import plan, row

import flexlash
from flexlash.analysis.assessment import assess
from flexlash.analysis.options import Options
from flexlash.analysis.tolerance_spread import row_statistics, spread_of
from flexlash.reading.read import Source, submission_of
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.schema.variant import Limits, Settings
from flexlash.validation.validate import validate

STUDY = Path(__file__).parents[2] / "data" / "b3-160-study.xlsx"
CELLS = {
    "variant": "V", "material": "20Cr2Ni4", "torque_Nm": 800, "cylinder_length_mm": 160, "mean_radius_mm": 80,
    "wall_thickness_mm": 1.6, "disk_inner_radius_mm": 40, "backlash_limit_arcmin": 3.72, "tolerance_class": "own",
}  # fmt: skip
HEADER = "tolerance_class,dimension,lower_deviation,upper_deviation,deviation_unit,distribution,scatters_between"
MODULUS = "own,youngs_modulus,-2,2,%,normal,"
POISSON = "own,poisson_ratio,-0.01,0.01,-,uniform,"
CALIBRATION = "own,cylinder_calibration,-0.01,0.01,-,normal,"
WALL = "own,wall_thickness,-0.02,0.02,mm,normal,"
RADIUS = "own,disk_inner_radius,-0.1,0.1,mm,uniform,"


def results_of(folder, *tolerances, method="line", **cells):
    """Return the row of Results of a variant with these rows of Tolerances."""
    variants, classes = folder / "variants.csv", folder / "classes.csv"
    entered = CELLS | cells
    variants.write_text(f"{','.join(entered)}\n{','.join(map(str, entered.values()))}\n")
    classes.write_text("\n".join([HEADER, *tolerances]) + "\n")
    outcome = flexlash.run(variants, tolerances=classes, method=method, elasticity=False)
    assert outcome.results["status"].to_list() != ["error"], outcome.findings
    return outcome.results.row(0, named=True)


def divided(numbers):
    """Return the sds within and between lots, and of all, of a row of Results."""
    return tuple(numbers[f"{name}_arcmin"] for name in ("within_lot_sd", "between_lots_sd", "sd"))


@pytest.mark.slow
def test_lots_of_the_study():
    """Case 1 of the study scatters from lot to lot: 115 lots in a million have more than 1,350 ppm over the limit."""
    numbers = flexlash.run(STUDY).results.row(0, named=True)
    within, between, sd = divided(numbers)
    assert within == pytest.approx(0.0019357, abs=5e-7)
    assert between == pytest.approx(0.029539, abs=5e-6)
    assert math.hypot(within, between) == pytest.approx(sd, rel=1e-9)
    assert numbers["lots_failing"] == pytest.approx(1.1493e-4, abs=4 * 1.6e-7)
    assert 0 < numbers["lots_failing_standard_error"] < 1e-6
    for name in ("within_lot_sd", "between_lots_sd"):
        assert 0 < numbers[f"{name}_standard_error_arcmin"] < 1e-4 * sd


@pytest.mark.parametrize("method", ["line", "sobol", "random"])
@pytest.mark.parametrize("alone", [MODULUS, CALIBRATION, WALL.replace("normal,", "normal,lots")])
def test_what_is_one_value_for_a_lot_leaves_its_parts_alike(alone, method, tmp_path):
    """Where lots alone scatter nothing does so within a lot, and as many lots fail as units."""
    numbers = results_of(tmp_path, alone, method=method, backlash_limit_arcmin=3.70)
    within, between, sd = divided(numbers)
    assert (within, between) == (0.0, sd)
    assert numbers["lots_failing"] == numbers["probability_over_limit"] > 0.01


@pytest.mark.parametrize("method", ["line", "sobol", "random"])
@pytest.mark.parametrize("over", [False, True])
def test_lots_are_alike_where_only_parts_scatter(over, method, tmp_path):
    """With exact constants and calibrations every lot is like the whole: all fail, or none does."""
    limit = 3.60 if over else 3.75
    numbers = results_of(tmp_path, WALL, RADIUS, method=method, backlash_limit_arcmin=limit)
    within, between, sd = divided(numbers)
    assert (within, between) == (sd, 0.0)
    assert numbers["lots_failing"] == float(numbers["probability_over_limit"] > 1350e-6) == float(over)


def test_the_submission_says_between_what_a_dimension_scatters(tmp_path):
    """A modulus of parts and a wall of lots change places; the spread of all units is the same."""
    usual = results_of(tmp_path, MODULUS, WALL)
    swapped = results_of(tmp_path, MODULUS + "parts", WALL + "lots")
    assert divided(swapped)[0] == pytest.approx(divided(usual)[1], rel=2e-3)
    assert divided(swapped)[1] == pytest.approx(divided(usual)[0], rel=2e-3)
    assert divided(swapped)[2] == divided(usual)[2]


def test_what_is_exact_has_lots_that_are_alike(tmp_path):
    """Where nothing scatters both sds are 0 and every lot fails, or none."""
    for limit, failing in ((3.5, 1.0), (3.8, 0.0)):
        numbers = results_of(tmp_path, "own,rim_length,-1,1,mm,normal,", backlash_limit_arcmin=limit)
        assert divided(numbers) == (0.0, 0.0, 0.0)
        assert numbers["lots_failing"] == failing


def test_no_limit_no_failing_lots(tmp_path):
    """Without a limit nothing is said of lots that fail; the sds are the same."""
    numbers = results_of(tmp_path, MODULUS, WALL, backlash_limit_arcmin="")
    assert numbers["lots_failing"] is None
    assert numbers["lots_failing_standard_error"] is None
    assert divided(numbers) == divided(results_of(tmp_path, MODULUS, WALL))


def test_the_acceptable_share_is_that_of_settings():
    """The more units over the limit are acceptable, the fewer lots fail, by the setting acceptable_ppm."""
    computed = computed_variant()
    spreads = [spread_with(computed, Settings(acceptable_ppm=ppm)) for ppm in (100.0, 1350.0, 20000.0)]
    shares = [one.numbers["lots_failing"] for one in spreads]
    assert shares[0] > shares[1] > shares[2] > 0


def computed_variant():
    """Return the computed variant of these cells in the built-in class."""
    cells = CELLS | {"tolerance_class": "standard"}
    text = f"{','.join(cells)}\n{','.join(map(str, cells.values()))}\n"
    validated = validate(submission_of(Source(name="v.csv", data=text.encode()), ReadingLimits()), ReadingLimits())
    (computed,) = assess(validated, validated.settings).computed.values()
    return computed


def spread_with(computed, settings):
    """Return the spread of a computed variant with its own limits."""
    return spread_of(computed.among, settings, Options()).statistics[computed.variant.row]


def test_which_dimensions_are_a_lots():
    """Of the built-in class the elastic constants are one value for a lot, as far as they scatter."""
    computed = computed_variant()
    assert computed.between == {"youngs_modulus", "poisson_ratio"}
    assert computed.between < computed.limits.keys()


def _random_row(draw):
    """Return a row of the cup with random limits and distributions, some of lots; some of a kind are correlated."""
    limits = {}
    for name, share in (("wall_thickness", 0.02), ("disk_inner_radius", 0.004), ("youngs_modulus", 0.03),
                        ("poisson_ratio", 0.03), ("cylinder_length", 0.003)):  # fmt: skip
        if draw.random() < 0.8:
            half = NOMINAL[name] * share * draw.uniform(0.2, 1)
            shape = draw.choice(["normal", "uniform", "triangular", "truncated normal"])
            limits[name] = Limits(low=NOMINAL[name] - half, high=NOMINAL[name] + half, distribution=shape)
    names = frozenset(name for name in limits if draw.random() < 0.5)
    nominal = float(CUP(NOMINAL))
    kinds = ([name for name in limits if (name in names) == lots] for lots in (True, False))
    pairs = tuple((first, second, draw.uniform(-0.9, 0.9)) for first, second, *_ in filter(_several, kinds))
    given = row(CUP, NOMINAL, limits, nominal * draw.uniform(0.99, 1.04))
    return replace(given, between=names, correlation=pairs if draw.random() < 0.3 else ())


def _several(names):
    return len(names) > 1


@pytest.mark.slow
def test_random_rows_divide_and_fail_within_their_bounds():
    """within² + between² = sd², and (P − a)/(1 − a) ≤ share of failing lots ≤ P/a, within errors, of random rows."""
    draw, acceptable = random.Random(5), 1350e-6  # noqa: S311
    rows = [_random_row(draw) for _ in range(150)]
    for index, statistics in row_statistics(rows, plan("line", acceptable=acceptable), 1):
        numbers = statistics.numbers
        within, between, sd = (numbers[name] for name in ("within_lot_sd", "between_lots_sd", "sd"))
        assert within**2 + between**2 == pytest.approx(sd**2, rel=1e-9), rows[index]
        failing, error = numbers["lots_failing"], numbers["lots_failing_standard_error"]
        low, high = (numbers[f"probability_over_limit_{end}"] for end in ("low", "high"))
        assert (low - acceptable) / (1 - acceptable) <= failing + 4 * error + 1e-12, rows[index]
        assert failing - 4 * error <= high / acceptable + 1e-12, rows[index]
    assert index
