"""What a reviewer asks of a report is answered one click away from its Summary, with the numbers of Results."""

from __future__ import annotations

import re

import pytest
from filled import SOUND, filled
from report_entries import opened, values_of
from said import said_of

from flexlash.analysis.used_tolerances import used_rows
from flexlash.pipeline import run
from flexlash.report.report_data import drawn_variants, report_data
from flexlash.report.shown_sheets import shown_sheets
from flexlash.report.wording.review_sentences import FINITE_ELEMENTS, TWO_TERMS, WITH_FILLETS_AND_RIM
from flexlash.schema.entry_words import dimension_title

ANSWERS = {
    "What is compared": "Verdict",
    "Which fail": "B3-160 case 5",
    "Another limit": "Another limit",
    "How sure": "Units over the limit",
    "Worst case": "Worst case, highest",
    "Lots and parts": "Within-lot sd",
    "Why": "Which tolerance hurts everywhere, which only here",
    "Limits used": "B3-160 case 5",
    "What to change": "B3-160 case 5",
    "What may be relaxed": "B3-160 case 1",
    "Length allowed": "B3-160 case 1",
    "Tolerance classes": "Sheets",
    "Cylinder-only formula": "Nominal by cylinder-only formula",
    "Strength": "Von Mises, torsion only",
    "Model": "How good the formula is",
    "Findings": "Findings",
}
"""What stands in the row to which each topic of the study's Summary leads."""


def _led_to(book, topic):
    """Return the words in the row to which a topic of the Summary leads, on a sheet that can be seen."""
    (cell,) = (cell for cell in book["Summary"]["A"] if cell.value == topic)
    title, _, place = cell.hyperlink.location.rpartition("!")
    sheet = book[title.strip("'")]
    assert sheet.sheet_state == "visible", topic
    row = sheet[int(re.search(r"\d+", place)[0])]
    return [one.value for one in row if one.value is not None]


def test_every_topic_leads_to_its_answer(study):
    """Each topic has a link to a visible sheet, to the row in which its answer stands or begins."""
    outcome, path = study
    book = opened(path)
    topics = {*said_of(outcome), "Tolerance classes"}
    assert topics == set(ANSWERS)
    assert {topic: ANSWERS[topic] for topic in topics if ANSWERS[topic] not in _led_to(book, topic)} == {}


def test_the_first_line_says_what_a_limit_is_compared_with(study):
    """Above all figures stands that the limit is compared with 2U at full torque, which no catalogue calls backlash."""
    sheet = opened(study[1])["Summary"]
    said = {sheet.cell(row, 1).value: sheet.cell(row, 2).value for row in (1, 2, 3)}
    assert said["What is compared"].startswith("The limit is compared with 2U at full torque, ")
    assert "which is no catalogue's definition of backlash." in said["What is compared"]


def test_explorer_tells_limits_and_strength_of_the_picked_variant(study):
    """Below its charts stand the limits in the unit of each dimension, beside the figures stress and reserve."""
    outcome, path = study
    values = values_of(path, "Explorer")
    worst = drawn_variants(outcome, 1)[0]
    first = 1 + next(int(cell[1:]) for cell, value in values.items() if cell[0] == "A" and value == "Dimension")
    told = [tuple(values.get(f"{letter}{row}") for letter in "ABCE") for row in range(first, first + 12)]
    used = [
        (f"{dimension_title(one['dimension'])} [{one['unit']}]", one["lower"], one["upper"], one["distribution"])
        for one in used_rows(worst.computed)
    ]
    assert [line for line in told if line[0]] == used
    labels = {value: cell for cell, value in values.items() if cell[0] == "E"}
    row, torque = worst.row, worst.computed.variant.dimensions["torque"]
    assert values[f"F{labels['Von Mises, torsion only'][1:]}"] == f"{row['von_mises_MPa']:.1f}"
    assert values[f"F{labels['Yields at'][1:]}"] == f"{row['elastic_limit_torque_Nm'] / torque:.2f}"


def test_a_variant_meets_its_limit_from_the_told_one_on(table, sound):
    """With the told limit a variant meets it; with one a last digit lower it does not."""
    told = said_of(run(table([{**sound, "backlash_limit_arcmin": 3.7}])))["Another limit"]
    (limit,) = re.findall(r"meets any limit from ([\d.]+)′ on\.", told)
    lower = float(limit) - 10.0 ** -len(limit.partition(".")[2])
    rows = [{**sound, "variant": given, "backlash_limit_arcmin": given} for given in (limit, f"{lower:.6g}")]
    over = run(table(rows)).results["probability_over_limit"].to_list()
    assert over[0] <= 0.00135 < over[1]


def test_the_model_is_told_with_the_figures_of_its_proof(study):
    """The sentence has the differences from published finite elements that About lists, in per cent."""
    said = said_of(study[0])["Model"]
    fine, rough = (100 * (number / FINITE_ELEMENTS - 1) for number in (WITH_FILLETS_AND_RIM, TWO_TERMS))
    assert f" {fine:.1f} % above published finite elements" in said
    assert f" {rough:.0f} % without" in said


@pytest.mark.parametrize(("faults", "seen"), [({}, "Trace"), ({"torque_Nm": None}, "Submission")])
def test_the_trace_is_seen_unless_cells_are_to_be_fixed(tmp_path, faults, seen):
    """The last tab is Trace, also beside warnings; sheets with errors come before it."""
    rows = [SOUND, {**SOUND, "variant": "other", "backlash_limit_arcmin": 3.0, **faults}]
    (tmp_path / "rows.xlsx").write_bytes(filled(rows))
    outcome = run(tmp_path / "rows.xlsx", method="random", samples=64)
    assert {"Trace", "Submission"} & shown_sheets(outcome, report_data(outcome)) == {seen}
