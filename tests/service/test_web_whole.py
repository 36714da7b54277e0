"""The page over a whole service with a worker: what comes out of a file, whatever stands in it."""

import csv
import html
import io
import re
import time
from functools import partial
from pathlib import Path

import httpx
import pytest
from filled import SOUND
from own_workbooks import REFUSED
from served import served

from flexlash.feedback.template.filling import Filling, study
from flexlash.feedback.template.template_workbook import template_bytes
from flexlash.schema.columns import OPTIONAL_SHEETS

DATA = Path(__file__).parents[2] / "data"
JSON = {"accept": "application/json"}
HARM = "<script>alert(1)</script><img src=x onerror=alert(1)>{{ 7 }}\"'`"

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def service(tmp_path_factory):
    """Run a service with one worker for all tests."""
    with served(tmp_path_factory.mktemp("whole") / "store") as running:
        yield running


@pytest.fixture
def client(service):
    """Return a program that asks the page."""
    with httpx.Client(base_url=service.address, timeout=60) as asking:
        yield asking


def _hand_in(client, name, content, action="run"):
    token = client.get("/", headers=JSON).json()["token"]
    fields = {"token": token, "action": action}
    return client.post("/submissions", data=fields, files={"file": (name, content)}, headers=JSON)


def _ended(client, answer):
    """Return a submission as JSON once it has ended."""
    end = time.monotonic() + 60
    while True:
        told = client.get(answer.headers["location"], headers=JSON).json()
        if told["state"] in {"done", "rejected"}:
            return told
        assert time.monotonic() < end
        time.sleep(0.05)


def _table(*rows):
    text = io.StringIO()
    writer = csv.DictWriter(text, list(rows[0]))
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue().encode()


def test_texts_in_cells_are_inert(client):
    """Texts of cells, headers and names that would do harm in a page are text on every page, and equal in the JSON."""
    bad = {**SOUND, "variant": HARM, "torque_Nm": HARM}
    good = {**SOUND, "variant": f"{HARM}2", f"own {HARM}": HARM}
    told = _ended(client, _hand_in(client, f"{HARM.replace('/', '')}.csv", _table({**good, **bad}, good)))
    assert told["state"] == "done", told["reason"]
    assert f"{HARM}2" in [row["variant"] for row in told["page"]["table"]]
    where = told["href"]
    pages = [client.get(path).text for path in (where, "/", "/history", "/rules", f"{where}/variants/0")]
    assert "&lt;script&gt;alert(1)" in pages[0]
    assert "&lt;script&gt;alert(1)" in pages[4]
    for text in pages:
        assert "<script>alert" not in text
        assert "<img src=x" not in text


def test_r5_r6_files_that_must_be_refused_are_refused_by_name(client):
    """Every kind of damaged, locked, foreign or hostile workbook is rejected on its page by its code, in words."""
    answers = {kind: _hand_in(client, "own.xlsx", make()) for kind, (_, make) in REFUSED.items()}
    for kind, answer in answers.items():
        told = _ended(client, answer)
        refused = told["page"]["refused"] if told["page"] else None
        found = refused["code"] if refused else told["reason"]
        assert (told["state"], told["exit_code"], found) == ("rejected", 4, REFUSED[kind][0]), kind
        shown = client.get(told["href"])
        assert shown.status_code == 200
        assert refused["fix"] in html.unescape(shown.text)
        assert "Traceback" not in shown.text
    assert _ended(client, _hand_in(client, "sound.csv", _table(SOUND)))["state"] == "done"


def test_files_of_a_result_are_those_that_were_computed(client, service):
    """Each file of a result comes whole, under its name, with the digest that the JSON says; nothing else is there."""
    told = _ended(client, _hand_in(client, "study.xlsx", (DATA / "b3-160-study.xlsx").read_bytes()))
    assert {file["role"] for file in told["files"]} >= {"report", "results", "checked", "outcome"}
    for file in told["files"]:
        answer = client.get(file["href"])
        assert len(answer.content) == file["size"]
        assert answer.headers["etag"] == f'"{file["sha256"]}"'
        assert f'filename="{file["name"]}"' in answer.headers["content-disposition"]
        assert service.store.blobs.read(file["sha256"]) == answer.content
    assert client.get(f"{told['href']}/files/page").json() == told["page"]


def test_a_check_keeps_nothing(client, service):
    """Checked only, a file gives the page of its findings at once, and neither submission nor blob is there after."""

    def kept():
        return sorted(path.name for path in (service.store.folder / "blobs").glob("??/*")), len(service.store.history())

    before = kept()
    answer = _hand_in(client, "needs-fixing.xlsx", (DATA / "needs-fixing.xlsx").read_bytes(), "check")
    assert answer.status_code == 200
    assert answer.json()["page"]["cards"]
    assert answer.json()["exit_code"] == 3
    assert answer.json()["counts"]["errors"] == 24
    refused = _hand_in(client, "no.xlsx", b"no workbook", "check")
    assert refused.json()["page"]["refused"]
    assert kept() == before


@pytest.mark.parametrize(
    ("path", "filling"),
    [("/template", Filling), ("/example", study), ("/template/all", partial(Filling, optional=OPTIONAL_SHEETS))],
    ids=["template", "example", "all"],
)
def test_the_template_is_that_of_the_command(client, path, filling):
    """Template and example are the bytes that `flexlash template` writes, made by a worker once."""
    answer = client.get(path)
    assert answer.content == template_bytes(filling())
    assert re.search(
        'filename="flexlash-(template|template-all-sheets|example).xlsx"', answer.headers["content-disposition"]
    )
    began = time.monotonic()
    assert client.get(path).content == answer.content
    assert time.monotonic() - began < 0.5


def test_what_changed_is_told(client):
    """The second upload of a name says what changed against the first; one without a predecessor says so."""
    first = _ended(client, _hand_in(client, "part.csv", _table(SOUND)))
    assert client.get(f"{first['href']}/difference", headers=JSON).json()["previous"] is None
    assert client.get(f"{first['href']}/difference").status_code == 200
    second = _ended(client, _hand_in(client, "part.csv", _table({**SOUND, "torque_Nm": 900})))
    told = client.get(f"{second['href']}/difference", headers=JSON).json()
    assert told["previous"] == first["id"]
    assert told["difference"]["differs"]
    assert any("900" in line for line in told["difference"]["lines"])
    assert "900" in client.get(f"{second['href']}/difference").text
