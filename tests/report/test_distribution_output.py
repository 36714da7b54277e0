"""Distributions for other programs: units, percentiles and metalogs tell what the report tells."""

import json
from statistics import NormalDist

import numpy as np
import polars as pl
import pytest

from flexlash import distribution, run
from flexlash.mechanics.flexspline import backlash
from flexlash.pipeline import check
from flexlash.schema.distribution_keys import PERCENTILES_TABLE
from flexlash.schema.stamps import stamp_at
from flexlash.schema.units import ARCMIN
from flexlash.tolerance.metalog import metalog_quantile

pytestmark = pytest.mark.slow


@pytest.fixture
def submission(table, sound):
    """Return two variants, of which the second is longer."""
    rows = [{**sound, "variant": name, "cylinder_length_mm": length} for name, length in (("A", 160), ("B", 200))]
    return table(rows, "gear.csv")


def test_units_are_parts_with_the_backlash_of_their_dimensions(submission, tmp_path):
    """Each unit has the backlash that the mechanics give its own dimensions, and they scatter as the report says."""
    outcome = distribution(submission, tmp_path / "units.parquet", units=4000)
    frame = pl.read_parquet(tmp_path / "units.parquet")
    assert frame["variant"].to_list() == ["A"] * 4000 + ["B"] * 4000
    assert frame["unit"].to_list() == [*range(1, 4001)] * 2
    for name, results in zip("AB", outcome.results.to_dicts(), strict=True):
        units = frame.filter(pl.col("variant") == name)
        values = units["backlash_arcmin"].to_numpy()
        # Four standard errors of 4,000 draws.
        assert values.mean() == pytest.approx(results["mean_arcmin"], abs=4 * results["sd_arcmin"] / 4000**0.5)
        assert values.std() == pytest.approx(results["sd_arcmin"], rel=4 / 8000**0.5)
        variant = next(one.variant for one in outcome.computed.values() if one.variant.name == name)
        drawn = {
            "youngs_modulus": units["youngs_modulus_GPa"].to_numpy() * 1e9,
            "poisson_ratio": units["poisson_ratio"].to_numpy(),
        }
        drawn |= {
            key.removesuffix("_mm"): units[key].to_numpy() * 1e-3
            for key in units.columns
            if key.endswith("_mm") and units[key].null_count() == 0
        }
        model = backlash(variant.flexspline_type, variant.dimensions | drawn)
        assert values == pytest.approx(model / ARCMIN, rel=1e-12)


def test_a_variant_has_its_units_whatever_stands_beside_it(submission, table, sound, tmp_path):
    """Alone, a variant has the units that it has beside others, and another seed gives others."""
    distribution(submission, tmp_path / "both.parquet", units=100)
    both = pl.read_parquet(tmp_path / "both.parquet").filter(pl.col("variant") == "B")
    alone = table([{**sound, "variant": "B", "cylinder_length_mm": 200}], "alone.csv")
    distribution(alone, tmp_path / "alone.parquet", units=100)
    assert pl.read_parquet(tmp_path / "alone.parquet").equals(both)
    distribution(alone, tmp_path / "seed.parquet", units=100, seed=1)
    assert not pl.read_parquet(tmp_path / "seed.parquet").equals(both)


def test_percentiles_are_those_of_the_report(submission, tmp_path):
    """The table has the report's own percentiles at these scores, the median among them, rising throughout."""
    distribution(submission, tmp_path / "percentiles.csv")
    frame = pl.read_csv(tmp_path / "percentiles.csv")
    assert tuple(frame.columns) == PERCENTILES_TABLE
    results = run(submission).results
    for name, median, high in results.select("variant", "p50_arcmin", "p99_865_arcmin").iter_rows():
        own = frame.filter(pl.col("variant") == name)
        at = dict(zip(own["normal_score"].round(3), own["backlash_arcmin"], strict=True))
        assert at[0.0] == pytest.approx(median, rel=1e-9)
        assert at[3.0] == pytest.approx(high, rel=1e-6)
        assert own["backlash_arcmin"].is_sorted()
        shares = [NormalDist().cdf(score) for score in own["normal_score"]]
        assert own["share_below"].to_list() == pytest.approx(shares, rel=1e-6)


def test_metalogs_follow_the_percentiles(submission, tmp_path):
    """The SIPmath library has one metalog a variant, within a hundredth of its sd from 0.1 to 99.9 %, and a stamp."""
    outcome = distribution(submission, tmp_path / "library.json")
    library = json.loads((tmp_path / "library.json").read_text(encoding="utf-8"))
    assert (library["objectType"], library["libraryType"], library["name"]) == ("sipModel", "SIPmath_3_0", "gear.csv")
    assert stamp_at(tmp_path / "library.json")
    streams = {one["name"]: one["arguments"] for one in library["U01"]["rng"]}
    assert len(streams) == 2
    assert streams.keys() == {sip["ref"]["name"] for sip in library["sips"]}
    for sip, results in zip(library["sips"], outcome.results.to_dicts(), strict=True):
        assert sip["name"] == results["variant"]
        coefficients = np.array(sip["arguments"]["aCoefficients"])
        levels = {"p2_5_arcmin": 0.025, "p50_arcmin": 0.5, "p97_5_arcmin": 0.975, "p99_865_arcmin": 0.99865}
        for key, level in levels.items():
            told = metalog_quantile(coefficients, np.array([level]))[0]
            assert told == pytest.approx(results[key], abs=0.01 * results["sd_arcmin"]), key
        assert np.diff(metalog_quantile(coefficients, np.linspace(1e-6, 1 - 1e-6, 999))).min() > 0


def test_what_flexlash_wrote_is_no_submission(submission, tmp_path):
    """Given to read, such a file is told as flexlash's own."""
    for ending in ("csv", "parquet"):
        distribution(submission, tmp_path / f"own.{ending}", units=5)
        assert {one.code for one in check(tmp_path / f"own.{ending}").findings} == {"I527"}


@pytest.mark.parametrize("units", [0, 1_000_001])
def test_too_few_or_too_many_units_are_refused(submission, tmp_path, units):
    """Less than one unit, or more than a million, are no number of units."""
    with pytest.raises(ValueError, match="units"):
        distribution(submission, tmp_path / "units.parquet", units=units)
