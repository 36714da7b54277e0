"""The pages in Debian's browser, over a whole service: without script, by keyboard, on a telephone, reloaded."""

from __future__ import annotations

import re
import time
import zipfile
from pathlib import Path

import pytest
from filled import SOUND
from rendered import pages
from served import chromium, needs_chromium, served

DATA = Path(__file__).parents[2] / "data"
NEEDS_FIXING, STUDY = DATA / "needs-fixing.xlsx", DATA / "b3-160-study.xlsx"
PATIENCE = 40_000
"""Milliseconds that a page may take until it says what is waited for."""

pytestmark = [pytest.mark.slow, needs_chromium]


@pytest.fixture(scope="module")
def browser():
    """Run the browser once for all tests."""
    with chromium() as running:
        yield running


@pytest.fixture(scope="module")
def service(tmp_path_factory):
    """Run a service with one worker for all tests."""
    with served(tmp_path_factory.mktemp("service") / "store") as running:
        yield running


@pytest.fixture
def tab(browser, service):
    """Return a function that opens a tab, by default without script; nothing may go wrong in any of them."""
    contexts, wrong = [], []

    def opened(*, script=False, width=1200, height=800, address=None):
        context = browser.new_context(
            java_script_enabled=script, viewport={"width": width, "height": height}, accept_downloads=True
        )
        contexts.append(context)
        page = context.new_page()
        page.set_default_timeout(PATIENCE)
        own = address or service.address
        page.on("console", lambda said: wrong.append(f"{said.type}: {said.text}") if said.type == "error" else None)
        page.on("pageerror", lambda fault: wrong.append(str(fault)))
        page.on("request", lambda asked: None if asked.url.startswith(own) else wrong.append(asked.url))
        page.goto(own)
        return page

    yield opened
    for context in contexts:
        context.close()
    assert not wrong, wrong


def hand_in(page, path, button="Check and compute"):
    """Hand in a file by the form; return the address of its page."""
    page.goto(re.match(r"http://[^/]+", page.url)[0])
    page.get_by_label("Drop the filled workbook here").set_input_files(path)
    page.get_by_role("button", name=button).click()
    return page.url


def until(page, words):
    """Wait until a page that looks again by itself says so."""
    page.get_by_text(words).first.wait_for()


def handed_over(page, link, folder):
    """Return where the file of a button was saved."""
    with page.expect_download() as coming:
        page.get_by_role("link", name=link).click()
    target = folder / coming.value.suggested_filename
    coming.value.save_as(target)
    return target


def overflow(page):
    """Return by how many pixels a page is wider than its window."""
    return page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth")


@pytest.mark.parametrize("script", [False, True], ids=["without script", "with script"])
def test_a_file_that_needs_fixing_comes_back_with_its_cells(tab, tmp_path, script):
    """Handed in, a workbook with errors shows each cell, what it would become, and a marked copy to download."""
    page = tab(script=script)
    address = hand_in(page, NEEDS_FIXING)
    assert re.fullmatch(r"http://127\.0\.0\.1:\d+/submissions/[0-9a-f]{32}", address)
    until(page, "3 of 27 rows computed; 24 cells to fix")
    assert page.url == address
    card = page.locator("article", has_text="E202").first
    assert card.locator(".mark").inner_text() == "1,6 mm"
    assert "1.6" in card.locator(".fixed").inner_text()
    copy = handed_over(page, "Marked copy", tmp_path)
    assert copy.name.endswith(".xlsx")
    assert zipfile.is_zipfile(copy)
    card.get_by_role("link", name="explain").click()
    assert page.get_by_role("heading", level=1).inner_text() == "Text instead of a number"


def test_a_sound_file_comes_back_with_its_report(tab, tmp_path):
    """A study shows verdicts, sentences, chart and table; each variant has a page; the report is downloaded."""
    page = tab()
    address = hand_in(page, STUDY)
    until(page, "11 of 11 rows computed")
    assert page.locator(".tile").all_inner_texts()[0].split() == ["3", "fail"]
    assert page.get_by_role("img", name=re.compile("Backlash of 11 variants")).count() == 1
    page.get_by_role("link", name="B3-160 case 3", exact=True).click()
    assert page.locator("h1").inner_text().split() == ["B3-160", "case", "3", "fails"]
    assert page.get_by_role("img").count() == 4
    for name in (
        "Half-section of B3-160 case 3",
        "How the backlash is spread",
        "What causes the spread",
        "Where the wind-up arises",
    ):
        assert page.get_by_role("img", name=name).count() == 1
    page.get_by_role("link", name="B3-160 case 4 r_m 80").click()
    page.get_by_role("link", name="All variants").click()
    assert page.url.startswith(address)
    assert zipfile.is_zipfile(handed_over(page, "Report (.xlsx)", tmp_path))
    assert len(handed_over(page, "Results (.csv)", tmp_path).read_text(encoding="utf-8").splitlines()) == 12


def test_the_same_file_again_is_answered_at_once_and_told_so(tab):
    """What was computed before is shown again, with a link to the first time, and is not computed anew."""
    page = tab()
    hand_in(page, STUDY)
    until(page, "11 of 11 rows computed")
    again = hand_in(page, STUDY)
    assert "Handed in before." in page.locator("main").inner_text()
    page.get_by_role("link", name="as it was then").click()
    assert page.url != again


def test_progress_is_true_and_survives_a_reload(tab, tmp_path):
    """A table at work shows rows that only rise, under an address that stays."""
    table = tmp_path / "sweep.csv"
    rows = [{**SOUND, "variant": f"v{number}", "wall_thickness_mm": 0.4 + number / 1e5} for number in range(800)]
    table.write_text("\n".join(",".join(map(str, row)) for row in [list(rows[0]), *(row.values() for row in rows)]))
    page = tab()
    address, seen, end = hand_in(page, table), [], time.monotonic() + 60
    while "rows computed" not in (html := page.request.get(address).text()) and time.monotonic() < end:
        seen += [int(done) for done in re.findall(r'aria-label="Rows computed" max="800" value="(\d+)"', html)]
        if len(seen) in {1, 4}:
            page.reload()
        time.sleep(0.1)
    assert seen == sorted(seen)
    assert any(0 < done < 800 for done in seen), seen
    until(page, "800 of 800 rows computed")
    assert page.url == address


def test_a_page_outlives_waiting_and_working(tab, tmp_path):
    """What waits says its place, what is at work its rows; the address is the same once it is done."""
    with served(tmp_path / "store", working=False) as idle:
        page = tab(address=idle.address)
        first = hand_in(page, STUDY)
        second = hand_in(page, NEEDS_FIXING)
        assert "Waiting; 1 submission before it" in page.get_by_role("status").inner_text()
        page.goto(first)
        assert "Waiting; next in the queue" in page.get_by_role("status").inner_text()
        taken = idle.store.take()
        idle.store.note_rows(taken.id, 412, 1000)
        until(page, "412 of 1000 rows")
        assert page.title().startswith("41 % · b3-160-study.xlsx")
        page.reload()
        assert page.get_by_role("progressbar").get_attribute("value") == "412"
        idle.store.hand_back(taken.id, after=30, trouble="no space left on the disk")
        until(page, "No space left on the disk. The fault is this machine's, not your file's.")
        page.goto(second)
        idle.dispatcher.start()
        until(page, "3 of 27 rows computed")
        assert page.url == second


def test_what_changed_since_the_upload_before_is_told(tab, tmp_path):
    """The second upload of a name leads to what changed against the first, the answer first, both reports linked."""
    page, addresses = tab(), []
    for wall in (0.4, 0.41):
        (tmp_path / f"{wall}").mkdir()
        table = tmp_path / f"{wall}" / "revised.csv"
        row = {**SOUND, "wall_thickness_mm": wall}
        table.write_text(f"{','.join(row)}\n{','.join(map(str, row.values()))}\n", encoding="utf-8")
        addresses.append(hand_in(page, table))
        until(page, "1 of 1 rows computed")
    page.get_by_role("link", name="What changed since today").click()
    assert "0.4 → 0.41" in page.locator("main").inner_text()
    links = [link.get_attribute("href") for link in page.locator("p.lead a").all()]
    assert [address.endswith(link) for address, link in zip(addresses, links, strict=True)] == [True, True]


def test_two_people_get_each_their_own(tab):
    """Two browsers that hand in at once have an address each, with their own file, and both are in the history."""
    pages = [tab(), tab()]
    addresses = [hand_in(page, path) for page, path in zip(pages, (DATA / "b3-160-proof.xlsx", STUDY), strict=True)]
    assert len(set(addresses)) == 2
    for page, name in zip(pages, ("b3-160-proof.xlsx", "b3-160-study.xlsx"), strict=True):
        until(page, "rows computed")
        assert page.get_by_role("heading", level=1).inner_text() == name
    pages[0].get_by_role("link", name="History").click()
    listed = pages[0].locator("tbody").inner_text()
    assert {"b3-160-proof.xlsx", "b3-160-study.xlsx"} <= set(re.findall(r"\S+\.xlsx", listed))


def test_everything_is_reached_by_keyboard(tab, service):
    """Tab goes from the link to the content to the form, Enter works, and nothing is kept of what is checked only."""
    page = tab()
    before = len(service.store.history())
    order = []
    for _ in range(8):
        page.keyboard.press("Tab")
        order.append(page.evaluate("document.activeElement.innerText || document.activeElement.name"))
    assert order == ["To the content", "flexlash", "Hand in", "History", "What fails most", "How to fill it",
                     "file", "Check and compute"]  # fmt: skip
    outline = page.evaluate("getComputedStyle(document.activeElement).outlineStyle")
    assert outline == "solid"
    page.get_by_label("Drop the filled workbook here").set_input_files(NEEDS_FIXING)
    page.keyboard.press("Tab")
    page.get_by_role("button", name="Check only, keep nothing").focus()
    page.keyboard.press("Enter")
    until(page, "Checked only: nothing of it is kept here")
    assert page.locator("article .mark").first.inner_text() == "(empty)"
    assert len(service.store.history()) == before
    page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    assert page.evaluate("document.activeElement.id") == "main"


def test_a_dropped_file_is_taken_without_script(tab):
    """A file that is dropped on the large area is the form's file."""
    page = tab()
    box = page.get_by_label("Drop the filled workbook here").bounding_box()
    assert box["height"] >= 190
    assert box["width"] >= 900
    tools = page.context.new_cdp_session(page)
    for kind in ("dragEnter", "dragOver", "drop"):
        tools.send("Input.dispatchDragEvent", {
            "type": kind, "x": box["x"] + box["width"] / 2, "y": box["y"] + 50,
            "data": {"items": [], "files": [str(NEEDS_FIXING)], "dragOperationsMask": 1},
        })  # fmt: skip
    page.get_by_role("button", name="Check and compute").click()
    until(page, "24 cells to fix")
    assert page.get_by_role("heading", level=1).inner_text() == "needs-fixing.xlsx"


@pytest.mark.parametrize("width", [360, 1200])
def test_no_page_is_wider_than_its_window(tab, width):
    """On a telephone and on a desk no page scrolls sideways: wide tables do so in their own frame."""
    page = tab(width=width, height=740)
    findings = hand_in(page, NEEDS_FIXING)
    until(page, "24 cells to fix")
    report = hand_in(page, STUDY)
    until(page, "11 of 11 rows computed")
    own = re.match(r"http://[^/]+", report)[0]
    paths = ["/", "/history", "/history?text=nothing+like+it", "/rules", "/findings/E202", "/help"]
    addresses = [own + path for path in paths] + [findings, report, f"{report}/variants/0", f"{report}/difference"]
    wide = {}
    for address in addresses:
        assert page.goto(address).status == 200, address
        for summary in page.locator("summary").all():
            summary.click()
        if (more := overflow(page)) > 0:
            wide[address] = more
    assert not wide
    assert page.goto(f"{report}/variants/0")
    assert page.locator(".picture").first.bounding_box()["width"] <= width


def test_no_long_word_makes_a_page_wider(tab, service):
    """With a word of 300 letters in each of its fields no page scrolls sideways on a telephone."""
    page, wide = tab(width=360, height=740), {}
    made_up = {name: html.replace('http-equiv="refresh"', "") for name, html in pages("x" * 300).items()}
    page.route("**/made-up/*", lambda route: route.fulfill(
        body=made_up[route.request.url.rpartition("/")[2].replace("-", " ")], content_type="text/html"))  # fmt: skip
    for name in made_up:
        page.goto(f"{service.address}/made-up/{name.replace(' ', '-')}")
        if (more := overflow(page)) > 0:
            wide[name] = more
    assert not wide


def test_what_is_forgotten_is_gone_and_said_so(tab, tmp_path):
    """A submission is forgotten by its page's form; its address then says that it is no longer kept."""
    table = tmp_path / "forgotten.csv"
    table.write_text("variant\nv1\n")
    page = tab()
    address = hand_in(page, table)
    until(page, "to fix")
    page.get_by_text("Compute it anew, or forget it").click()
    page.get_by_role("button", name="Compute it anew").click()
    assert page.url == address
    until(page, "to fix")
    page.get_by_text("Compute it anew, or forget it").click()
    page.get_by_role("button", name="Forget file and report").click()
    assert page.request.get(address).status == 410
