"""What the wave generator does is told where it is known: bending beside torsion, and the bounds under two lobes."""

from __future__ import annotations

from dataclasses import replace

import polars as pl
import pytest
from filled import SOUND
from report_entries import opened
from said import said_of

from flexlash.pipeline import run
from flexlash.report.page.page_facts import Found, page_facts
from flexlash.report.report_data import report_data
from flexlash.schema.result_columns import RESULTS

QUICK = {"method": "random", "samples": 16}
BENDING = ("Bending at wall [MPa]", "Bending at rim [MPa]", "Alternating stress [MPa]", "Combined stress [MPa]")
KEYS = ("bending_stress_MPa", "rim_bending_stress_MPa", "alternating_stress_MPa", "combined_stress_MPa")
TORSION = [
    f"{place} {stress}, torsion only [MPa]" for place in ("Wall", "Rim", "Disk") for stress in ("shear", "von Mises")
]
LOW, HIGH = 3.4149, 3.7851


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Return a function that computes rows, each a change of a cup, and gives outcome and path of the report."""

    def make(*changes):
        rows = [{**SOUND, "variant": f"v{place}", **change} for place, change in enumerate(changes)]
        path = tmp_path_factory.mktemp("bent") / "bent.csv"
        pl.DataFrame(rows, infer_schema_length=None).write_csv(path)
        return run(path, path.with_name("report.xlsx"), **QUICK), path.with_name("report.xlsx")

    return make


RIM = {"rim_length_mm": 30.0, "rim_thickness_mm": 3.2}


@pytest.fixture(scope="module")
def bent(made):
    """Return a cup in torsion, one that is bent, one bent hard enough to be warned of, and one without a rim."""
    return made(
        {**RIM, "torque_Nm": 700.0},
        {**RIM, "radial_deflection_mm": 0.3},
        {**RIM, "radial_deflection_mm": 4.0},
        {"radial_deflection_mm": 0.2},
    )


@pytest.fixture(scope="module")
def straight(made):
    """Return the same cup without a deflection."""
    return made(RIM)


def _strength(path):
    """Return the texts above the table of Strength, its header and its rows by name."""
    rows = list(opened(path)["Strength"].iter_rows(values_only=True))
    place = next(place for place, row in enumerate(rows) if row[0] == "Variant")
    header = [heading for heading in rows[place] if heading]
    table = {row[0]: dict(zip(header, row, strict=False)) for row in rows[place + 1 :] if row[0]}
    return " ".join(str(row[0]) for row in rows[:place] if row[0]), header, table


def test_strength_shows_bending_beside_torsion(bent):
    """Each variant has the bending stresses of Results, blank where it has none, and torsion's headings say so."""
    outcome, path = bent
    notes, header, table = _strength(path)
    assert [heading for heading in header if heading in TORSION] == TORSION
    for row in outcome.results.iter_rows(named=True):
        told = [table[row["variant"]][heading] for heading in BENDING]
        assert told == [pytest.approx(row[key], rel=1e-12) if row[key] is not None else None for key in KEYS]
    assert [table["v0"][heading] for heading in BENDING] == [None] * 4
    assert table["v3"]["Bending at rim [MPa]"] is None
    assert table["v3"]["Bending at wall [MPa]"] > 0
    assert table["v1"]["Governing section"]
    for said in ("twice a turn", "without coning", "without notches", "0.4 of the yield", "are of torsion only"):
        assert said in notes


def test_without_bending_strength_is_of_torsion_only(straight):
    """Where no variant is bent no column and no word of bending stands in Strength, and the note says torsion only."""
    notes, header, _ = _strength(straight[1])
    assert not any("ending" in heading or "torsion" in heading for heading in header)
    assert "ending" not in notes
    assert notes.index("Torsion only: ") < notes.index("shear stress")


def test_results_say_which_stresses_are_of_torsion_only():
    """The help of each stress that knows no bending says so; that of bending does not."""
    help_of = {column.key: column.help for column in RESULTS}
    for key in ("wall_shear_MPa", "rim_shear_MPa", "hub_shear_MPa", "von_mises_MPa"):
        assert help_of[key].endswith("Torsion only.")
    assert not any("orsion only" in help_of[key] for key in KEYS)


def test_about_says_what_is_counted_bracketed_and_not_known(straight):
    """About tells face width, bracket and bending under Model, the wave generator's fit under what is not covered."""
    rows = [row[0] for row in opened(straight[1])["About"].iter_rows(values_only=True)]
    starts = map(rows.index, ("Model", "Not covered"))
    counted, unknown = (" ".join(rows[start : rows.index(None, start)]) for start in starts)
    for said in ("counts a third", "Low: all engaged teeth", "High: two single teeth", "no factor", "Bending: "):
        assert said in counted
    assert "fit: radial play of a few µm, or a soft bearing, can add 20 to 130 %" in unknown
    assert "0.6 of the axisymmetric" not in unknown


def test_the_summary_names_what_bends_most(bent, straight):
    """Under Strength stand the greatest alternating stress and those warned of; nothing where nothing is bent."""
    outcome = bent[0]
    rows = {row["variant"]: row for row in outcome.results.iter_rows(named=True)}
    assert [found.variant for found in outcome.findings if found.code == "W460"] == ["v2"]
    said = said_of(outcome)["Strength"]
    assert (
        f"The wave generator bends “v2” most: {rows['v2']['alternating_stress_MPa']:.3g} MPa alternating, "
        f"{rows['v2']['combined_stress_MPa']:.3g} MPa with torsion; all other stresses are of torsion only."
    ) in said
    assert "Bending fatigue: “v2” (W460)." in said
    assert "bend" not in said_of(straight[0])["Strength"].lower()


def test_one_bent_alone_is_not_the_most(made):
    """Where one variant alone is bent, none is bent less."""
    assert "bends “v0”: " in said_of(made({"radial_deflection_mm": 0.2}, {})[0])["Strength"]


def _bounded(outcome, names):
    """Return an outcome in which these variants have bounds under two lobes, as a run with --elasticity gives them."""
    has = pl.col("variant").is_in(names)
    bounds = {
        f"two_lobe_{end}_arcmin": pl.when(has).then(pl.lit(value)).otherwise(None)
        for end, value in (("low", LOW), ("high", HIGH))
    }
    return replace(outcome, results=outcome.results.with_columns(**bounds))


def test_the_summary_gives_the_bounds_of_the_worst_that_has_any(bent):
    """Of the calculation: the bounds of the worst variant with bounds, in three digits, without the fit."""
    said = said_of(_bounded(bent[0], ["v0", "v2"]))["Of the calculation"]
    worst = max((row["p97_5_arcmin"], row["variant"]) for row in bent[0].results.iter_rows(named=True))[1]
    assert worst == "v3", "the worst of all has no bounds here"
    assert said.count("Two lobes") == 1
    assert (
        "Two lobes on a rigid, tight wave generator: 3.41′ to 3.79′ for “v2”; the wave generator's fit is not included."
    ) in said
    assert "wo lobes" not in said_of(_bounded(bent[0], [])).get("Of the calculation", "")
    assert "wo lobes" not in said_of(bent[0]).get("Of the calculation", "")


def test_a_variants_page_shows_bending_and_bounds(bent):
    """A variant's own page has sentences and numbers of bending and of two lobes where it has them, and no others."""
    outcome = _bounded(bent[0], ["v1"])
    facts = page_facts(outcome, Found.of(outcome, ran=True), ran=True, data=report_data(outcome))
    pages = {page["variant"]: page for page in facts["variants"]}
    topics = {
        name: {one["topic"]: one["text"] for one in page["sentences"] if one["kind"] == "note"}
        for name, page in pages.items()
    }
    assert {name: set(told) & {"Bending", "Two lobes"} for name, told in topics.items()} == {
        "v0": set(), "v1": {"Bending", "Two lobes"}, "v2": {"Bending"}, "v3": {"Bending"},
    }  # fmt: skip
    row = next(row for row in outcome.results.iter_rows(named=True) if row["variant"] == "v1")
    assert f"twice a turn: {row['alternating_stress_MPa']:.3g} MPa alternating" in topics["v1"]["Bending"]
    assert topics["v1"]["Two lobes"] == (
        "Two lobes on a rigid, tight wave generator: 3.41′ to 3.79′; the wave generator's fit is not included."
    )
    numbers = {name: {number["key"] for number in page["numbers"]} for name, page in pages.items()}
    assert {*KEYS, "two_lobe_low_arcmin", "two_lobe_high_arcmin"} <= numbers["v1"]
    assert not {*KEYS, "two_lobe_low_arcmin"} & numbers["v0"]
