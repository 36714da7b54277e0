"""`flexlash serve` and `watch` as a user starts them: processes of their own, folders that are not there yet."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import httpx
import pytest
from batch_runs import ENVIRONMENT, none_left
from click.testing import CliRunner
from filled import SOUND, filled

from flexlash.cli import cli

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals are those of POSIX")

ROW = SOUND | {"backlash_limit_arcmin": 3.8}


def _begun(folder, *arguments, **environment):
    """Return a command that runs, in a session of its own."""
    return subprocess.Popen(
        [sys.executable, "-m", "flexlash", *map(str, arguments)], cwd=folder, env=ENVIRONMENT | environment,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True,
    )  # fmt: skip


def _ended(folder, *arguments):
    """Return exit code and output of a command."""
    process = _begun(folder, *arguments)
    said, _ = process.communicate(timeout=120)
    return process.returncode, said


def _stopped(process, how=signal.SIGTERM):
    """Return exit code, what was still said, and how long it took to stop."""
    start = time.monotonic()
    process.send_signal(how)
    said, _ = process.communicate(timeout=60)
    return process.returncode, said, time.monotonic() - start


def _address(process):
    """Return the address that a server says, and what it said before that."""
    said = ""
    for line in process.stdout:
        said += line
        if line.startswith("Page:"):
            return line.split()[1], said
    raise AssertionError(said)


def _until(condition, seconds=60):
    end = time.monotonic() + seconds
    while not (found := condition()) and time.monotonic() < end:
        time.sleep(0.1)
    return found


def _handed_in(page, name, data, action="run"):
    token = re.search(r'name="token" value="([^"]+)"', page.get("/").text)[1]
    answer = page.post("/submissions", data={"token": token, "action": action}, files={"file": (name, data)},
                       headers={"Sec-Fetch-Site": "same-origin", "Accept": "application/json"})  # fmt: skip
    return answer.headers["Location"]


def _told(page, place):
    return page.get(place, headers={"Accept": "application/json"}).json()


@pytest.fixture(scope="module")
def serving(tmp_path_factory):
    """Run a server with page and drop folder, none of whose folders were there."""
    folder = tmp_path_factory.mktemp("serving")
    process = _begun(folder, "serve", "inbox", "--out", "out", "--store", "kept/store", "--port", 0, "--workers", 1)
    address, said = _address(process)
    with httpx.Client(base_url=address) as page:
        yield folder, page, process, said
    process.kill()
    process.communicate()


@pytest.mark.slow
def test_a_first_start_makes_its_folders(serving):
    """INBOX, OUT and the store are made, the store for its owner alone, and the screen says where they are."""
    folder, _, process, _ = serving
    said = "".join(next(process.stdout) for _ in range(4))
    for name in ("inbox", "out", "kept/store"):
        assert (folder / name).is_dir()
        assert str(folder / name) in said
    assert (folder / "kept/store").stat().st_mode & 0o077 == 0
    assert "Ctrl-C" in said


@pytest.mark.slow
def test_page_and_folder_give_the_report_of_the_command(serving):
    """A workbook through the page, through the folder and by `flexlash run` has the same report, byte for byte."""
    folder, page, _, _ = serving
    data = filled([ROW])
    (folder / "cup.xlsx").write_bytes(data)
    (folder / "inbox" / "cup.xlsx").write_bytes(data)
    assert _ended(folder, "run", "cup.xlsx")[0] == 0
    place = _handed_in(page, "cup.xlsx", data)
    assert _until(lambda: _told(page, place)["state"] == "done")
    by_page = page.get(f"{place}/files/report").content
    assert _until((folder / "out" / "cup-report.xlsx").exists)
    assert by_page == (folder / "cup-report.xlsx").read_bytes() == (folder / "out" / "cup-report.xlsx").read_bytes()
    assert _until(lambda: [*(folder / "out" / "done").glob("*/cup.xlsx")])[0].read_bytes() == data
    assert not [*(folder / "inbox").iterdir()]
    assert not {path.name for path in (folder / "out").glob("cup*")} - {"cup-report.xlsx", "cup-reasons.txt"}


@pytest.mark.slow
def test_a_second_server_on_the_store_is_refused(serving):
    """Another server on the same store, or on the same INBOX, ends with a sentence that says so, and 5."""
    folder, page, *_ = serving
    code, said = _ended(folder, "serve", "--store", "kept/store", "--port", 0)
    assert (code, said.count("\n")) == (5, 1)
    assert "another flexlash serves the store" in said
    assert f"Its page: {page.base_url}" in said
    code, said = _ended(folder, "watch", "inbox", "--out", "out", "--store", "other")
    assert (code, said.count("\n")) == (5, 1), said
    assert "another flexlash" in said.lower()


@pytest.mark.slow
def test_status_tells_of_a_running_server(serving):
    """`flexlash status` says that a server runs, and what became of what was handed in."""
    folder, page, *_ = serving
    place = _handed_in(page, "nothing.csv", b"variant,torque_Nm\n")
    assert _until(lambda: _told(page, place)["state"] == "rejected")
    code, said = _ended(folder, "status", "--store", "kept/store")
    assert code == 0
    assert "rejected" in said
    assert place.rpartition("/")[2][:8] in _ended(folder, "status", "--store", "kept/store", "--json")[1]


@pytest.mark.slow
@pytest.mark.parametrize("how", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_ends_the_service_in_good_order(tmp_path, how):
    """SIGTERM and Ctrl-C end page and folder within half a minute, with 0, without a trace and without a process left.

    What was at work is handed back and done after the next start.
    """
    (tmp_path / "inbox").mkdir()
    (tmp_path / "inbox" / "many.csv").write_bytes(_many(4000))
    common = ("inbox", "--out", "out", "--store", "store", "--workers", 1)
    process = _begun(tmp_path, "serve", *common, "--port", 0)
    address, _ = _address(process)
    with httpx.Client(base_url=address) as page:
        assert _until(lambda: 'state="working"} 1' in page.get("/metrics").text)
    code, said, seconds = _stopped(process, how)
    assert code == 0
    assert "Traceback" not in said
    assert seconds < 30
    assert none_left(process.pid)
    assert _ended(tmp_path, "watch", *common, "--once")[0] == 0
    assert (tmp_path / "out" / "many-report.xlsx").exists()


def _many(rows):
    keys = [key for key in ROW if key != "backlash_limit_arcmin"]
    lines = [",".join(str(ROW[key]) if key != "variant" else f"v{number}" for key in keys) for number in range(rows)]
    return "\n".join([",".join(keys), *lines, ""]).encode()


@pytest.mark.slow
def test_the_opened_page_is_for_one_browser(tmp_path):
    """`--open` starts the browser with an address that works once; whoever comes without its cookie is asked for it."""
    browser = tmp_path / "browser"
    browser.write_text(f'#!{sys.executable}\nimport sys\nopen("opened", "w").write(sys.argv[1])\n')
    browser.chmod(0o755)
    process = _begun(tmp_path, "serve", "--store", "store", "--port", 0, "--open", BROWSER=f"{browser} %s")
    address, _ = _address(process)
    try:
        opened = _until(lambda: (tmp_path / "opened").exists() and (tmp_path / "opened").read_text())
        file = Path(opened.removeprefix("file://"))
        assert file.stat().st_mode & 0o077 == 0
        once = re.search(r"url=([^\"]+)", file.read_text())[1]
        assert once == address
        with httpx.Client(follow_redirects=True) as mine, httpx.Client(follow_redirects=True) as other:
            first = mine.get(once)
            assert (first.status_code, "Hand in a template" in first.text) == (200, True)
            root = str(first.url)
            assert mine.get(root).status_code == 200
            assert other.get(once).status_code in {401, 403, 404, 410}
            assert other.get(root).status_code == 401
            second = _begun(tmp_path, "serve", "--store", "store", "--port", 0, "--open", BROWSER=f"{browser} %s")
            said, _ = second.communicate(timeout=60)
            assert (second.returncode, said.splitlines()[0]) == (0, "flexlash runs already.")
            again = re.search(r"Page:  (\S+)", said)[1]
            assert again in Path((tmp_path / "opened").read_text().removeprefix("file://")).read_text()
            assert other.get(again).status_code == 200
            assert str(other.get(root).url) == root
    finally:
        assert _stopped(process)[0] == 0
    assert not [*(tmp_path / "store").glob(".page*")]


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["serve", "inbox"], "needs both"),
        (["serve", "--out", "out"], "needs both"),
        (["watch", "inbox"], "--out"),
        (["serve", "--keep", "soon"], "90d"),
        (["serve", "--host", "10.0.0.1"], "--token-file"),
        (["serve", "--scheduler", "somewhere"], "tcp://HOST:PORT"),
        (["serve", "--webhook-key-file", "key"], "--webhook URL"),
        (["serve", "--behind-proxy", "Host"], "no header"),
    ],
)
def test_what_does_not_go_together_is_a_usage_error(arguments, sentence, tmp_path, monkeypatch):
    """Options that cannot be meant end with 2 and a sentence that says what is required; no folder is made."""
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(cli, arguments)
    assert done.exit_code == 2
    assert sentence in done.output
    assert not [*tmp_path.iterdir()]


@pytest.mark.parametrize("command", [["serve"], ["watch", "inbox", "--out", "out"], ["status"], ["retry", "1"]])
def test_a_missing_extra_is_named(command, monkeypatch, tmp_path):
    """Without the libraries of the service each of its commands names the extra that brings them, and ends with 2."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("flexlash.cli.status_command.find_spec", lambda _: None)
    done = CliRunner().invoke(cli, command)
    assert done.exit_code == 2
    assert "pip install 'flexlash[service]'" in done.output


@pytest.mark.slow
def test_a_taken_port_is_a_sentence(serving, tmp_path):
    """A page whose port is taken ends with 5 and says which option chooses another; nothing is left running."""
    _, page, *_ = serving
    process = _begun(tmp_path, "serve", "--store", "store", "--port", page.base_url.port)
    said, _ = process.communicate(timeout=60)
    assert process.returncode == 5
    assert "--port" in said
    assert "Traceback" not in said
    assert none_left(process.pid)
