"""The pages as HTML: well formed, within the policy, readable by ear and eye, whatever stands in a file."""

from __future__ import annotations

import json
import re
import subprocess
import sys

import pytest
from grids import for_each
from html_pages import HtmlPage, faults_of
from rendered import COUNTS, FILES, NOW, made, pages, render, submission

from flexlash.report.page.shape import PageFacts
from flexlash.service.records import Ending, HandedIn, StoredFile
from flexlash.service.store import Store
from flexlash.service.web import views
from flexlash.service.web.submission_page import checked_view, submission_view
from flexlash.service.web.variant_page import variant_view

HOSTILE = """</title><script>alert(1)</script>"'><x-evil onclick=a>{{ 7*7 }}{% x %}<!-- &amp; </svg></textarea>"""


PLAIN, EVIL = pages("some words"), pages(HOSTILE)


@for_each("name", PLAIN)
def test_pages_are_well_formed_and_within_the_policy(name):
    """Every page nests rightly, has unique IDs, labels, landmarks and headings, no script, style or foreign address."""
    faults = faults_of(PLAIN[name])
    assert not faults, "; ".join(faults[:8])


@for_each("name", EVIL)
def test_nothing_that_a_stranger_typed_becomes_part_of_the_page(name):
    """With a hostile text in every field a page has the very elements that it has with a harmless one."""
    faults = faults_of(EVIL[name])
    assert not faults, "; ".join(faults[:8])
    assert [tag for tag, _ in HtmlPage(EVIL[name]).elements if tag not in {"title", "br"}] == [
        tag for tag, _ in HtmlPage(PLAIN[name]).elements if tag not in {"title", "br"}
    ]


@pytest.mark.parametrize("name", ["hand in", "done", "variant", "checked", "difference", "refused"])
def test_a_hostile_text_is_shown_as_it_was_typed(name):
    """What a stranger typed is read on the page letter by letter."""
    assert " ".join(HOSTILE.split()) in HtmlPage(EVIL[name]).text


def test_a_checker_that_finds_no_fault_would_be_none():
    """A page with a fault of each kind is told of each."""
    page = PLAIN["hand in"].replace('id="lately"', 'id="file"').replace("<h2", "<h4", 1).replace("</h2>", "</h4>", 1)
    page = page.replace("<main", "<div style='x' onclick='y'><script src='//evil'></script></div><!-- c --><main", 1)
    page = page.replace('<label for="file">', "<label>", 1).replace('scope="col"', "", 1)
    told = " ".join(faults_of(page))
    for fault in ("twice", "style", "onclick", "script", "leaves", "no label", "heading", "comment", "row or a column"):
        assert fault in told, fault


def test_only_what_still_changes_is_asked_for_again():
    """A page is refreshed while its submission waits or is at work, soon at first, never once it has ended."""
    again = {state: "http-equiv" in PLAIN[state] for state in ("waiting", "working", "done", "rejected")}
    assert again == {"waiting": True, "working": True, "done": False, "rejected": False}
    ages, facts = (1, 30, 300, 3000), made(PageFacts, "words")
    at_work = [submission(state="working", began_at=NOW - age) for age in ages]
    assert [submission_view(one, NOW).refresh for one in at_work] == [1, 2, 5, 10]
    assert [submission_view(one, NOW, facts=facts).refresh for one in at_work] == [1, 5, 5, 10]
    assert [submission_view(submission(received_at=NOW - age), NOW).refresh for age in ages] == [1, 3, 3, 3]


def test_progress_says_rows_speed_and_time_left():
    """A submission at work shows true rows, their speed, the time left and what the check found."""
    at_work = submission(state="working", began_at=NOW - 166, rows=1_000_000, rows_done=412_000,
                         counts={**COUNTS, "rows": 1_000_000, "computed": 999_998})  # fmt: skip
    page = HtmlPage(render("submission", view=submission_view(at_work, NOW, waiting=3)))
    assert "Computing · 412,000 of 1,000,000 rows · 2482 rows a second · about 4 minutes left" in page.text
    assert "Checked: 999,998 rows ready, 2 rows with errors. Next in the queue: 3 submissions." in page.text
    assert {"max": "1000000", "value": "412000", "aria-label": "Rows computed"} in page.all("progress")
    assert "41 % · cup.xlsx" in page.text


def test_no_time_left_is_told_before_it_can_be_known():
    """After a second, or with one row of thousands, nobody can say how long the rest takes."""
    for past, done in ((1, 500), (9, 1), (9, 0), (9, 1000)):
        at_work = submission(state="working", began_at=NOW - past, rows=1000, rows_done=done)
        assert "left" not in HtmlPage(render("submission", view=submission_view(at_work, NOW))).text, (past, done)
    at_work = submission(state="working", began_at=NOW - 9, rows=1000, rows_done=20)
    assert "about 7 minutes left" in HtmlPage(render("submission", view=submission_view(at_work, NOW))).text


def test_the_queue_and_a_fault_of_the_machine_are_told():
    """What waits is told its place; a fault of the machine is no fault of the file, and when it is tried again."""
    waiting = HtmlPage(render("submission", view=submission_view(submission(), NOW, before=2)))
    assert "Waiting; 2 submissions before it" in waiting.text
    faulty = submission(trouble="no space left on the disk", not_before=NOW + 40)
    told = HtmlPage(render("submission", view=submission_view(faulty, NOW))).text
    assert "No space left on the disk. The fault is this machine's, not your file's. It is tried again in 40" in told


def test_where_all_findings_are_is_said_truly():
    """A page that cannot show all findings says which file has them; a check only, of which there is none, how to."""
    facts = made(PageFacts, "words")
    for card in facts["cards"]:
        card["more"] = card["cells"] = 11_119
    view = submission_view(submission(state="done"), NOW, facts=facts, files=FILES)
    assert "and 11,119 more: the file of all findings has them" in HtmlPage(render("submission", view=view)).text
    small = {role: file for role, file in FILES.items() if role != "findings"}
    view = submission_view(submission(state="done"), NOW, facts=facts, files=small)
    assert "and 11,119 more: the marked copy has them all" in HtmlPage(render("submission", view=view)).text
    checked = HtmlPage(render("checked", view=checked_view("x.xlsx", facts))).text
    assert "has them all" not in checked


def test_a_file_that_cannot_be_read_is_promised_nothing():
    """Of a refused file no report is promised after a check, and what says why is not called a marked copy."""
    facts = made(PageFacts, "words")
    assert "the report of the rows that are ready" not in render("checked", view=checked_view("x.xlsx", facts))
    files = {role: FILES[role] for role in ("checked", "reasons")}
    html = render("submission", view=submission_view(submission(state="rejected"), NOW, facts=facts, files=files))
    assert "Reasons (.xlsx)" in html
    assert "Marked copy" not in html
    facts["refused"] = None
    assert "the report of the rows that are ready" in render("checked", view=checked_view("x.xlsx", facts))


def test_findings_come_before_the_report_where_a_file_needs_fixing():
    """With errors the findings and the marked copy come first, without any the report does."""
    facts = made(PageFacts, "words")
    html = PLAIN["done"]
    assert html.index('id="findings"') < html.index('id="variants"')
    assert html.index("Marked copy (.xlsx)") < html.index("Report of the 24 rows (.xlsx)")
    facts["counts"] = {**COUNTS, "errors": 0}
    clean = render("submission", view=submission_view(submission(state="done"), NOW, facts=facts, files=FILES))
    assert clean.index('id="variants"') < clean.index('id="findings"')
    assert clean.index("Report (.xlsx)") < clean.index("Marked copy (.xlsx)")


def test_many_rules_wait_behind_a_line():
    """The first six rules are open, in the order of the facts; the others open by a line that says how many."""
    facts = made(PageFacts, "words")
    facts["cards"] = [{**facts["cards"][0], "title": f"rule {index}"} for index in range(9)]
    html = render("checked", view=checked_view("x", facts))
    assert "3 more rules with findings" in HtmlPage(html).text
    assert html.index("Rule 5") < html.index("3 more rules") < html.index("Rule 6")


def test_cells_are_drawn_like_the_sheet():
    """A card shows column letters, row numbers, the guilty cell marked and what it would become."""
    facts = made(PageFacts, "words")
    row = {"row": 9, "cells": ["V-05", "", "1,6 mm"], "marked": [2], "fixed": ["", "", "1.6"]}
    grid = {"sheet": "Variants", "columns": ["A", "…", "H"], "header_row": 4, "header": ["Variant", "", "Wall [mm]"]}
    grid["rows"] = [row]
    facts["cards"] = [{**facts["cards"][0], "grid": grid}]
    html = render("checked", view=checked_view("x", facts))
    table = html[html.index('<table class="sheet">') : html.index("</table>")]
    cells = re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", table)
    assert cells[1:] == [
        "A",
        "…",
        "H",
        "4",
        "Variant",
        "",
        "Wall [mm]",
        "9",
        "V-05",
        "",
        "1,6 mm",
        "fixed",
        "",
        "",
        "1.6",
    ]
    assert re.findall(r'<td class="mark ?">(.*?)</td>', table) == ["1,6 mm"]


def test_a_variant_that_there_is_not_has_no_page():
    """The place of a variant is one of those that have facts."""
    facts = json.loads(json.dumps(made(PageFacts, "words")))
    assert variant_view(submission(), facts, 1)
    assert variant_view(submission(), facts, 2) is None
    assert variant_view(submission(), facts, -1) is None


def test_what_keeps_files_from_the_drop_folder_is_told(tmp_path):
    """A submission of the drop folder whose files cannot be put there says why, until they are there."""
    with Store(tmp_path, serving=True) as store:
        one = store.accept(HandedIn(name="cup.xlsx", options="o", door="folder"), b"bytes")
        store.take()
        sha256, size = store.blobs.put(b"report")
        report = StoredFile(role="report", sha256=sha256, size=size, name="cup-report.xlsx")
        store.end(one.id, Ending(state="done", exit_code=0, words="1 of 1 rows computed", files=[report]))
        assert not views.submission(store, store.submission(one.id))["view"].undelivered
        store.postpone(store.deliveries()[0], 60, "the folder cannot be written")
        html = render("submission", **views.submission(store, store.submission(one.id)))
        told = "Not put into the results folder. The folder cannot be written; it is tried again. All files are here"
        assert told in HtmlPage(html).text
        store.delivered(store.undelivered()[0])
        assert not views.submission(store, store.submission(one.id))["view"].undelivered


def test_the_same_file_again_is_told_also_where_the_first_was_forgotten(tmp_path):
    """An answer that was there is called so, with a link to the first as long as that is kept."""
    with Store(tmp_path, serving=True) as store:
        first = store.accept(HandedIn(name="cup.xlsx", options="o", door="page"), b"bytes")
        store.take()
        store.end(first.id, Ending(state="rejected", exit_code=4, words="not a submission"))
        again = store.accept(HandedIn(name="cup.xlsx", options="o", door="page"), b"bytes")
        link = f'href="/submissions/{first.id}"'
        kept = render("submission", **views.submission(store, again))
        store.forget(first.id)
        gone = render("submission", **views.submission(store, again))
    assert ["Handed in before." in html for html in (kept, gone)] == [True, True]
    assert [link in html for html in (kept, gone)] == [True, False]


def test_server_side_of_the_pages_loads_nothing_heavy():
    """The server keeps small: its pages import no library of numbers or workbooks."""
    heavy = ("polars", "numpy", "openpyxl", "xlsxwriter", "scipy", "pandera")
    program = f"import flexlash.service.web.views, sys; print([name for name in {heavy} if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
