"""What the Summary, a variant's page and the terminal say of lots and parts, and of what verdicts are about."""

from __future__ import annotations

import re

import pytest
from said import said_of

from flexlash.analysis.run_summary import limit_lines
from flexlash.pipeline import run
from flexlash.report.page.page_facts import Found, page_facts
from flexlash.report.report_data import report_data
from flexlash.schema.lot_words import lots_words

LOTS = "Lots and parts"
HEADER = "tolerance_class,dimension,lower_deviation,upper_deviation,deviation_unit,scatters_between"
WALL = "standard,wall_thickness,-0.02,0.02,mm,"
MODULUS = "standard,youngs_modulus,-2,2,%,"
POISSON = "standard,poisson_ratio,-0.01,0.01,-,"
CALIBRATION = "standard,disk_calibration,-0.01,0.01,-,"


@pytest.fixture
def computed(table, sound, tmp_path):
    """Return a function that computes rows, each a change of a sound one, with these rows of Tolerances."""

    def compute(tolerances, *changes):
        classes = tmp_path / "classes.csv"
        classes.write_text("\n".join([HEADER, *tolerances]) + "\n", encoding="utf-8")
        rows = [{**sound, "variant": f"v{place}", **change} for place, change in enumerate(changes)]
        return run(table(rows), tolerances=classes)

    return compute


def page_of(outcome, place=0):
    """Return the sentences of a variant's page by topic."""
    told = page_facts(outcome, Found.of(outcome, ran=True), ran=True, data=report_data(outcome))
    return {one["topic"]: one["text"] for one in told["variants"][place]["sentences"]}, told


def test_the_study_in_the_words_of_lots(study):
    """Case 1 of the study: parts of a lot lie close together, lots far apart, and 115 lots in a million fail."""
    outcome, _ = study
    drawn = {one.row["variant"]: place for place, one in enumerate(report_data(outcome).drawn)}
    told, _ = page_of(outcome, drawn["B3-160 case 1"])
    assert told[LOTS] == (
        "Within one lot 95 % of parts lie within ± 0.0038′; lots differ by ± 0.058′; 115 lots in a million have more "
        "than 1350 ppm over the limit (50.62 ppm of all units). One value for a whole lot: Young's modulus and "
        "Poisson's ratio. The verdict is about all units of many lots, not about one lot."
    )


def test_the_worst_is_told_in_full_and_the_next_by_their_lots(study):
    """The Summary tells how the worst variant divides, how many lots of the next fail, what verdicts are about."""
    told = said_of(study[0])[LOTS]
    assert told.startswith(
        "“B3-160 case 5”: within one lot 95 % of parts lie within ± 0.0064′; lots differ by ± 0.097′"
    )
    assert "; practically every lot has more than 1350 ppm over the limit (practically all units)." in told
    assert (
        "More than 1350 ppm over the limit: practically every lot of “B3-160 case 3” and 99.7 % of lots of "
        "“B3-160 case 4 r_m 80”." in told
    )
    assert told.endswith("Verdicts and shares are about all units of many lots, not about one lot.")


def test_where_parts_alone_scatter_every_lot_is_like_the_whole(computed):
    """Without scatter between lots it is said whether every lot fails, and that verdicts hold for each."""
    for limit, words in ((3.8, "No more"), (3.68, "More")):
        outcome = computed([WALL], {"backlash_limit_arcmin": limit})
        assert said_of(outcome)[LOTS] == (
            "Nothing scatters between lots: in every lot 95 % of parts lie within ± 0.03′. "
            f"{words} than 1350 ppm of them are over the limit. Verdicts and shares hold for every lot."
        )
        told, _ = page_of(outcome)
        assert told[LOTS].endswith(f"{words} than 1350 ppm of them are over the limit.")


def test_where_lots_alone_scatter_their_parts_are_alike(computed):
    """Without scatter within lots as many lots lie over the limit as units, each with all its parts."""
    outcome = computed([MODULUS], {"backlash_limit_arcmin": 3.72})
    share = outcome.results["probability_over_limit"].item()
    assert said_of(outcome)[LOTS].startswith(
        f"All parts of a lot are identical; lots differ by ± 0.048′; {100 * share:.3g} % of lots lie over the limit "
        "with every part. One value for a whole lot: Young's modulus. "
    )


def test_a_calibration_is_one_value_for_all_lots(computed):
    """That a calibration counts with lots, and is the same for all of them, is said where one scatters."""
    words = "A calibration is one unknown value for all lots; it counts with what differs between lots."
    with_one, without = (said_of(computed(rows, {}))[LOTS] for rows in ([WALL, CALIBRATION], [WALL, POISSON]))
    assert words in with_one
    assert "One value for a whole lot" not in with_one
    assert words not in without
    assert "One value for a whole lot: Poisson's ratio." in without


def test_without_limit_or_scatter_less_is_said(computed):
    """Without a limit no lot fails and no verdict is about anything; where nothing scatters nothing is said of lots."""
    told = said_of(computed([WALL, MODULUS], {"backlash_limit_arcmin": ""}))[LOTS]
    assert re.fullmatch(
        r"Within one lot 95 % of parts lie within ± 0\.03\d?′; lots differ by ± 0\.048′\. One value for a whole lot: "
        r"Young's modulus\.",
        told,
    )
    assert LOTS not in said_of(computed(["standard,rim_length,-1,1,mm,"], {}))


def test_the_terminal_tells_lots_where_some_fail_and_others_do_not(computed):
    """Beside the share of units over a limit stands that of lots, unless all or none of them fail."""
    outcome = computed([WALL, MODULUS], {"backlash_limit_arcmin": 3.72}, {"backlash_limit_arcmin": 3.0})
    _, far, near = limit_lines(outcome)
    assert re.fullmatch(r"  v0: 12\.\d+ % of units are over 3\.72′; \d\d\.\d % of lots fail\.", near)
    assert far == "  v1: practically all units are over 3′."


def test_a_page_says_what_is_one_value_for_a_lot(computed):
    """Limits used say which dimension is one value for a lot, numbers how the spread divides."""
    outcome = computed([WALL, MODULUS], {})
    _, facts = page_of(outcome)
    used = {one["name"]: one["distribution"] for one in facts["variants"][0]["limits"]}
    lots = {name for name, words in used.items() if words.endswith("one value for a lot")}
    assert lots == {name for name in used if name.startswith("Young")} != set()
    numbers = {one["key"] for one in facts["variants"][0]["numbers"]}
    assert {"within_lot_sd_arcmin", "between_lots_sd_arcmin", "lots_failing"} <= numbers


SHARES = {
    (0.0, 0.0): "no lot",
    (1.0, 0.0): "every lot",
    (1.1493e-4, 1.6e-7): "115 lots in a million",
    (9.84e-7, 3e-9): "984 lots in a billion",
    (2e-5, 3e-5): "at most 79 lots in a million",
    (0.02, 0.004): "2.0 % of lots",
    (1 - 2e-5, 3e-5): "at least 99.99212 % of lots",
    (1 - 2.4e-4, 1e-7): "99.9760 % of lots",
}


@pytest.mark.parametrize("share", SHARES, ids=str)
def test_shares_of_lots_in_words(share):
    """Lots are counted in a hundred, a million or a billion, nearly all in per cent, in the digits known."""
    assert lots_words({"lots_failing": share[0], "lots_failing_standard_error": share[1]}) == SHARES[share]


def test_whether_lots_fail_that_are_alike_may_not_be_settled():
    """Where all lots are alike and their share over the limit is too near to the acceptable one, that is said."""
    row = {"lots_failing": 1.0, "lots_failing_standard_error": 0.4, "between_lots_sd_arcmin": 0.0}
    assert lots_words(row) == "not settled"
    assert lots_words(row | {"lots_failing_standard_error": 0.01}) == "every lot"


def test_lots_that_differ_are_never_told_as_none_or_all():
    """A share that is told as 0 or 1 of lots that differ is practically so."""
    for share, words in ((0.0, "practically no lot"), (1.0, "practically every lot")):
        row = {"lots_failing": share, "lots_failing_standard_error": 1e-20, "between_lots_sd_arcmin": 0.1}
        assert lots_words(row) == words
