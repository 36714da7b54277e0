"""The pages around a submission: states as sentences, the history, explanations, how to fill the template."""

from __future__ import annotations

import re

import pytest
from html_pages import HtmlPage
from rendered import NOW, render, submission

from flexlash.schema.columns import ENTRY_SHEETS
from flexlash.schema.finding_catalogue import CATALOGUE
from flexlash.service.web import lists, views
from flexlash.service.web.words import Moment, state_line


def test_states_are_sentences():
    """Each state of a list is a sentence with a colour and a link that says what is there."""
    told = {
        state_line(one, NOW): None
        for one in (
            submission(state="done", words="12 of 12 rows computed", counts={"rows": 12, "computed": 12, "fails": 2}),
            submission(state="done", words="9 of 12 rows computed; 3 cells to fix", counts={"rows": 12, "computed": 9}),
            submission(state="rejected", words="password-protected file"),
            submission(state="working"),
        )
    }
    assert [(line.words, line.kind, line.link) for line in told] == [
        ("12 of 12 rows computed; 2 fail", "good", "report"),
        ("9 of 12 rows computed; 3 cells to fix", "warn", "findings"),
        ("password-protected file", "bad", "reason"),
        ("being read and checked", "plain", "watch"),
    ]


def test_history_leads_to_older_ones_only_where_there_are_some():
    """A full page of the history with one more behind it leads on, by the last number that it shows."""
    found = [submission(number=number) for number in range(60, 0, -1)]
    more = lists.history_view(found[:51], NOW, text="a&b", totals={})
    assert (len(more.lines), more.older) == (50, 11)
    assert lists.history_view(found[:50], NOW, totals={}).older is None
    assert "/history?text=a%26b&amp;state=&amp;before=11" in render("history", "/history", view=more)


def test_a_history_of_nothing_does_not_blame_the_filter():
    """Where nothing was handed in, that is said; that nothing fits the filter only where there is something."""
    nothing = render("history", view=lists.history_view([], NOW, totals={}))
    assert "Nothing has been handed in yet" in nothing
    assert "No submission matches" not in nothing
    assert "No submission matches" in render("history", view=lists.history_view([], NOW, text="x", totals={"done": 1}))


def test_what_fails_most_names_columns_as_the_template_does():
    """A column is told by its header, one of the engineer's own by its name, and each rule leads to its explanation."""
    row = {"level": "error", "code": "E202", "sheet": "Variants", "cells": 41, "submissions": 9}
    rows = [
        {**row, "column": "wall_thickness_mm"},
        {**row, "column": "Remark 7"},
        {**row, "code": "E999", "column": ""},
    ]
    html = render("rules", "/rules", view=lists.rules_view(rows))
    assert re.findall(r'<td class="name">(.*?)</td>', html) == ["Wall thickness Δ [mm]", "Remark 7"]
    assert html.count('href="/findings/E202"') == 2


@pytest.mark.slow
def test_every_finding_has_a_page():
    """Each code of the catalogue is explained under its address, in any case; other codes are not."""
    for code, rule in CATALOGUE.items():
        context = views.explained(code.lower())
        assert context, code
        assert rule.title[1:] in HtmlPage(render("explained", **context)).text
    assert views.explained("E999") is None


def test_the_help_has_every_column():
    """How to fill the template names every column of every sheet, and what its cells must be."""
    text = HtmlPage(render("help", "/help", **views.how_to_fill())).text
    for sheet in ENTRY_SHEETS.values():
        for column in sheet:
            for words in (column.label, column.requirement, column.help):
                assert " ".join(words.split()) in text, column.key


def test_moments_are_near_and_exact():
    """A moment is told as one says it, and exactly beside it."""
    said = [Moment.of(NOW - past, NOW).near for past in (5, 130, 2 * 3600 + 5)]
    assert said == ["just now", "2 min ago", "2 h ago"]
    assert re.fullmatch(r"\d{4}-\d\d-\d\d \d\d:\d\d:\d\d", Moment.of(NOW, NOW).exact)
    assert re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d[+-]\d\d:\d\d", Moment.of(NOW, NOW).machine)
