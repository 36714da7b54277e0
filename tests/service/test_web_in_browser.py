"""Who is let in, as a browser goes about it: cookies, links from elsewhere, forms of others."""

import re
import threading
import webbrowser
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, HTTPServer

import httpx
import pytest
from served import chromium, needs_chromium
from web_pages import JSON, answering

from flexlash.service.web.access import Access
from flexlash.service.web.serving import open_browser

pytestmark = [pytest.mark.slow, needs_chromium]

TOKEN = "a-token-of-24-characters"  # noqa: S105
FORM = "Hand in a template"


@pytest.fixture(scope="module")
def browser():
    """Run the browser once for all tests."""
    with chromium() as running:
        yield running


@pytest.fixture
def tab(browser):
    """Return a tab without script, with cookies of its own."""
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()
    page.set_default_timeout(20_000)
    yield page
    context.close()


def _served(folder, **access):
    return answering(folder, access=Access.of(port=0, **access))


@contextmanager
def _elsewhere(page):
    """Yield the address of a page of somebody else, on a port of its own."""

    class Other(BaseHTTPRequestHandler):
        def do_GET(self):
            self.send_response(200)
            self.send_header("Content-Type", "text/html")
            self.end_headers()
            self.wfile.write(page.encode())

        def log_message(self, *_):
            pass

    with HTTPServer(("127.0.0.1", 0), Other) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        try:
            yield f"http://localhost:{server.server_port}/"
        finally:
            server.shutdown()
            thread.join(5)


@pytest.fixture
def token_file(tmp_path):
    """Return a token file that its owner alone may read."""
    path = tmp_path / "token"
    path.write_text(TOKEN, encoding="utf-8")
    path.chmod(0o600)
    return path


def test_open_leads_to_the_page(tmp_path, tab, browser, monkeypatch):
    """The file that --open gives to the browser leads to the form, at an address without the token; once."""
    asked = []
    monkeypatch.setattr(webbrowser, "open", lambda address: asked.append(address) or True)
    with _served(tmp_path, opens=True) as (one, server):
        assert open_browser(server.opening, one.store.folder)
        tab.goto(asked[0])
        tab.get_by_text(FORM).first.wait_for()
        assert tab.url == server.address
        tab.get_by_role("link", name="History").click()
        tab.get_by_role("heading", name="History").wait_for()
        other = browser.new_context(java_script_enabled=False)
        again = other.new_page()
        again.goto(server.opening)
        assert "used once already" in again.content()
        other.close()


def test_the_token_is_entered_once(tmp_path, tab, token_file):
    """The token opens the page; a link from elsewhere still finds it open, and the form hands in."""
    with _served(tmp_path, token_file=token_file) as (one, server):
        tab.goto(f"{server.address}history")
        tab.get_by_label("Token").fill(TOKEN)
        tab.get_by_role("button", name="Open").click()
        tab.get_by_role("heading", name="History").wait_for()
        with _elsewhere(f'<a href="{server.address}">there</a>') as other:
            tab.goto(other)
            tab.get_by_text("there").click()
            tab.get_by_text(FORM).first.wait_for()
        tab.locator("#file").set_input_files({"name": "a.csv", "mimeType": "text/csv", "buffer": b"abc"})
        tab.locator("button[value=run]").click()
        tab.get_by_role("heading", name="a.csv").wait_for()
        assert one.store.history()[0].name == "a.csv"


@pytest.mark.parametrize("frame", ["", " target=inside"])
def test_pages_of_others_hand_nothing_in(tmp_path, tab, frame):
    """A form of somebody else's page, with a token that is ours, hands nothing in; nor can it show us in a frame."""
    with _served(tmp_path) as (one, server):
        token = httpx.get(server.address, headers=JSON).json()["token"]
        form = (
            f'<form method=post enctype="multipart/form-data" action="{server.address}submissions"{frame}>'
            f'<input name=token value="{token}"><input type=file name=file id=file><button>go</button></form>'
            f'<iframe name=inside src="{server.address}"></iframe>'
        )
        with _elsewhere(form) as other:
            tab.goto(other)
            assert FORM not in "".join(each.content() for each in tab.frames)
            tab.locator("#file").set_input_files({"name": "a.csv", "mimeType": "text/csv", "buffer": b"abc"})
            with tab.expect_response(re.compile("submissions")) as answer:
                tab.get_by_text("go").click()
            assert answer.value.status == 403
        assert not one.store.history()
