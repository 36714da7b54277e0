"""Who is let in: hosts, proxies, foreign forms, tokens; and with what the page refuses to start."""

import os
import re

import pytest
from web_pages import ADDRESS, JSON, OWN, page

from flexlash.service.running_page import new_key
from flexlash.service.web.access import Access, AccessError
from flexlash.service.web.signing import Signer
from flexlash.service.web.site import Limits

TOKEN = "a-token-of-24-characters"  # noqa: S105
ANYWHERE = "0.0.0.0"  # noqa: S104


@pytest.fixture
def token_file(tmp_path):
    """Return a token file that its owner alone may read."""
    path = tmp_path / "token"
    path.write_text(f"{TOKEN}\n", encoding="utf-8")
    path.chmod(0o600)
    return path


@pytest.mark.parametrize("host", [ANYWHERE, "::", "192.168.1.5", "pc42", "10.0.0.1"])
def test_other_machines_need_a_token_or_a_proxy(host, token_file):
    """An address that others reach is refused at the start with the reason, unless something says who they are."""
    with pytest.raises(AccessError, match="--token-file FILE, or --behind-proxy HEADER"):
        Access.of(host=host)
    assert Access.of(host=host, token_file=token_file).token == TOKEN
    assert Access.of(host=host, behind_proxy="Remote-User").sender_header == "remote-user"


@pytest.mark.parametrize("host", ["127.0.0.1", "127.8.8.8", "::1", "localhost"])
def test_this_machine_needs_none(host):
    """Loopback is served without more."""
    assert not Access.of(host=host).asks


@pytest.mark.parametrize("text", ["short", "", "fifteen-letters", "with a space in it", "päßwörter-sechzehn"])
def test_poor_tokens_are_refused(tmp_path, text):
    """A token below sixteen printable characters without spaces is refused."""
    path = tmp_path / "token"
    path.write_text(text, encoding="utf-8")
    path.chmod(0o600)
    with pytest.raises(AccessError, match="at least 16"):
        Access.of(token_file=path)


@pytest.mark.skipif(os.name != "posix", reason="files have an owner alone on POSIX")
@pytest.mark.parametrize("mode", [0o640, 0o604, 0o644, 0o660])
def test_a_token_that_others_read_is_refused(token_file, mode):
    """A token file that group or others may read is refused, and the message says how to fix it."""
    token_file.chmod(mode)
    with pytest.raises(AccessError, match="chmod 600"):
        Access.of(token_file=token_file)


def test_odd_options_are_refused(tmp_path):
    """Headers that mean something else, addresses and names that are none, and a missing file are refused."""
    for wrong in ({"behind_proxy": "Host"}, {"behind_proxy": "a b"}, {"host_names": ["http://a"]},
                  {"behind_proxy": "X-User", "proxy_addresses": ["proxy"]}, {"token_file": tmp_path / "none"},
                  {"behind_proxy": "X-User", "opens": True}):  # fmt: skip
        with pytest.raises(AccessError):
            Access.of(**wrong)


@pytest.mark.parametrize(
    "host",
    ["evil.example", "127.0.0.1.evil.example", "localhost.evil", "evil.example:8765", "", "127.0.0.1@evil.example",
     "localhost.", "10.1.2.3", "[::2]", "127.0.0.2", "127.1", "2130706433", "a b", "localhost:8765:1"],
)  # fmt: skip
def test_foreign_hosts_are_refused(tmp_path, host):
    """A name that somebody else has led here (DNS rebinding) is answered by a refusal, on every address."""
    with page(tmp_path) as one:
        for path in ("/", "/health", "/static/flexlash.css", "/submissions"):
            answer = one.visitor().get(path, headers={"host": host})
            assert answer.status_code == 421, path
            assert "flexlash printed" in answer.text


def test_own_hosts_are_answered(tmp_path):
    """Loopback, with or without a port, and names that were given are ours."""
    with page(tmp_path, access=Access.of(host_names=["Flexlash.example"])) as one:
        for host in ("127.0.0.1", "127.0.0.1:8765", "localhost:9", "LOCALHOST", "flexlash.example:443"):
            assert one.visitor().get("/", headers={"host": host}).status_code == 200, host
        for address in ("http://[::1]:8765", "http://192.168.1.5:8765"):
            assert one.visitor(address=address).get("/").status_code == 200, address
            assert one.visitor(address=address).hand_in(headers={"origin": address}).status_code == 303


@pytest.mark.parametrize(
    "headers",
    [{"sec-fetch-site": "cross-site"}, {"sec-fetch-site": "same-site"}, {"sec-fetch-site": "", "origin": "http://e"},
     {"origin": "http://evil.example"}, {"origin": "http://127.0.0.1:9999"}, {"origin": "http://127.0.0.1"},
     {"sec-fetch-site": "cross-site", "origin": ADDRESS}],
)  # fmt: skip
def test_foreign_forms_are_refused(tmp_path, headers):
    """What another page has the browser send changes nothing, though its token were right."""
    with page(tmp_path) as one:
        visitor = one.visitor()
        answer = visitor.hand_in(headers=headers)
        assert answer.status_code == 403
        assert not one.store.history()
        id_ = visitor.hand_in().headers["location"]
        for path in (f"{id_}/forget", f"{id_}/retry", "/login"):
            assert visitor.post(path, data={"token": visitor.token()}, headers=headers).status_code == 403, path


@pytest.mark.parametrize("headers", [OWN, {"sec-fetch-site": "none"}, {"origin": ADDRESS}, {"origin": "null"}, {}])
def test_own_forms_are_taken(tmp_path, headers):
    """The page's own form works in every browser; where nothing tells where it came from its token does."""
    with page(tmp_path) as one:
        assert one.visitor().hand_in(headers=headers).status_code == 303
        assert one.visitor().hand_in(headers=headers, token="").status_code == 400
        assert len(one.store.history()) == 1


def test_a_token_is_of_no_use_to_others(tmp_path):
    """The token of one sender's form does not do for another's: nobody can have it sent by somebody else's browser."""
    with page(tmp_path, access=Access.of(behind_proxy="Remote-User")) as one:
        mallory, anna = one.visitor(remote_user="mallory"), one.visitor(remote_user="anna")
        assert anna.hand_in(token=mallory.token(), headers={}).status_code == 400
        assert not one.store.history()


def test_the_proxy_says_who_sends(tmp_path):
    """Behind a proxy the sender is what its header says, in UTF-8, made harmless; no other header counts."""
    with page(tmp_path, access=Access.of(behind_proxy="Remote-User")) as one:
        visitor = one.visitor(remote_user="Jörg \u202e<b>".encode(), x_forwarded_for="10.9.9.9")
        assert visitor.hand_in().status_code == 303
        assert one.store.history()[0].sender == "Jörg ·<b>"
        assert "<b>" not in visitor.get("/history").text


@pytest.mark.parametrize("path", ["/", "/history", "/static/flexlash.css", "/login"])
def test_only_the_proxy_is_believed(tmp_path, path):
    """A header from another address than the proxy's, without the header, or with two is refused."""
    with page(tmp_path, access=Access.of(host=ANYWHERE, behind_proxy="Remote-User")) as one:
        assert one.visitor(client="10.0.0.9", remote_user="anna").get(path).status_code == 403
        assert one.visitor().get(path).status_code == 403
        assert one.visitor(remote_user=" ").get(path).status_code == 403
        two = [("remote-user", "anna"), ("remote-user", "root")]
        assert one.visitor().get(path, headers=two).status_code == 403
        for client in ("127.0.0.1", "::1", "::ffff:127.0.0.1"):
            assert one.visitor(client=client, remote_user="anna").get(path).status_code in {200, 405}


def test_a_token_is_asked(tmp_path, token_file):
    """With a token no address shows anything without it, but what the form for it needs and what names nobody."""
    with page(tmp_path, access=Access.of(token_file=token_file)) as one:
        for path in ("/", "/history", "/submissions/1", "/template", "/rules", "/nix", "/history/..%2flogin"):
            answer = one.visitor().get(path)
            assert answer.status_code == 401, path
            assert 'action="/login"' in answer.text
            assert one.visitor().get(path, headers=JSON).headers["www-authenticate"] == "Bearer"
        assert one.visitor().hand_in(token="").status_code == 401
        for path in ("/health", "/metrics", "/static/flexlash.css"):
            assert one.visitor().get(path).status_code == 200, path


def test_the_token_opens_the_page(tmp_path, token_file):
    """The right token gives a cookie that no script and no other site gets, and leads to where one wanted to go."""
    with page(tmp_path, access=Access.of(token_file=token_file)) as one:
        visitor = one.visitor()
        answer = visitor.post("/login", data={"access": TOKEN, "wanted": "/history"})
        assert (answer.status_code, answer.headers["location"]) == (303, "/history")
        cookie = answer.headers["set-cookie"].lower()
        assert re.search("httponly.*samesite=strict", cookie)
        assert "secure" not in cookie
        assert TOKEN not in cookie
        assert visitor.get("/history").status_code == 200
        assert visitor.hand_in().status_code == 303
        assert one.visitor().get("/history").status_code == 401


@pytest.mark.parametrize("wanted", ["//evil.example", "https://evil.example", "/\\evil", "/a?b", "javascript:1", ""])
def test_the_token_leads_nowhere_else(tmp_path, token_file, wanted):
    """After the token comes a page of ours, whatever the form says."""
    with page(tmp_path, access=Access.of(token_file=token_file)) as one:
        answer = one.visitor().post("/login", data={"access": TOKEN, "wanted": wanted})
        assert answer.headers["location"] == "/"


def test_a_token_that_is_no_text_is_wrong(tmp_path, token_file):
    """Half a character, as an encoding of old lets it be written, is a wrong token and no fault."""
    body = b'--b\r\nContent-Disposition: form-data; name="access"\r\n\r\n\\ud800\r\n--b--\r\n'
    kind = {**OWN, "content-type": "multipart/form-data; boundary=b; charset=unicode_escape"}
    with page(tmp_path, access=Access.of(token_file=token_file)) as one:
        assert one.visitor().post("/login", content=body, headers=kind).status_code == 401


def test_forged_cookies_open_nothing(tmp_path, token_file):
    """A cookie that was changed, is of another store or of a token that no longer holds, or is a form's is none."""
    with page(tmp_path, access=Access.of(token_file=token_file)) as one:
        visitor = one.visitor()
        visitor.post("/login", data={"access": TOKEN, "wanted": ""})
        ((name, right),) = visitor.cookies.items()
        form = visitor.token()
        token_file.write_text("another-token-of-24-char", encoding="utf-8")
        for wrong in (right[:-1] + ("0" if right[-1] != "0" else "1"), form, "", right.replace("-", "-1", 1)):
            assert one.visitor(cookie=f"{name}={wrong}").get("/").status_code == 401
    with page(tmp_path, access=Access.of(token_file=token_file)) as one:
        assert one.visitor(cookie=f"{name}={right}").get("/").status_code == 401
    with page(tmp_path / "other", access=Access.of(token_file=token_file)) as one:
        assert one.visitor(cookie=f"{name}={right}").get("/").status_code == 401


def test_a_program_sends_the_token(tmp_path, token_file):
    """A program says the token in a header, and then needs no form."""
    with page(tmp_path, access=Access.of(token_file=token_file)) as one:
        program = one.visitor(authorization=f"Bearer {TOKEN}", accept="application/json")
        answer = program.hand_in(token="", headers={})
        assert answer.status_code == 201
        assert program.get(answer.headers["location"]).json()["state"] == "waiting"
        assert one.visitor(authorization="Bearer wrong-token-of-24-char").get("/").status_code == 401
        assert one.visitor(authorization=f"Basic {TOKEN}").get("/").status_code == 401


def test_a_program_needs_no_form(tmp_path):
    """Where no token is asked, a program that says one, which no foreign page can have said, needs no form either."""
    with page(tmp_path) as one:
        assert one.visitor(authorization="Bearer any").hand_in(token="", headers=JSON).status_code == 201
        for other in ("Basic YTpi", "Bearer", "Bearer ", ""):
            assert one.visitor(authorization=other).hand_in(token="", headers=JSON).status_code == 400, other
        foreign = {**JSON, "sec-fetch-site": "cross-site"}
        assert one.visitor(authorization="Bearer any").hand_in(token="", headers=foreign).status_code == 403


def test_wrong_tokens_are_not_tried_for_ever(tmp_path, token_file):
    """After five wrong tokens in a minute an address is not listened to, though the next were right; others are."""
    with page(tmp_path, access=Access.of(host=ANYWHERE, token_file=token_file)) as one:
        guesser = one.visitor(client="10.0.0.9")
        for _ in range(5):
            assert guesser.post("/login", data={"access": "wrong"}).status_code == 401
        answer = guesser.post("/login", data={"access": TOKEN})
        assert (answer.status_code, answer.headers["retry-after"]) == (429, "60")
        assert one.visitor(client="10.0.0.9", authorization=f"Bearer {TOKEN}").get("/").status_code == 429
        assert one.visitor(client="10.0.0.8").post("/login", data={"access": TOKEN}).status_code == 303


def test_who_comes_by_a_link_is_known(tmp_path, token_file):
    """A link elsewhere brings no strict cookie along: the page asks for itself once more, from here."""
    with page(tmp_path, access=Access.of(token_file=token_file)) as one:
        assert 'http-equiv="refresh"' in one.visitor().get("/", headers={"sec-fetch-site": "cross-site"}).text
        assert 'http-equiv="refresh"' not in one.visitor().get("/", headers={"sec-fetch-site": "same-origin"}).text


def test_open_lets_in_once(tmp_path):
    """With --open nobody comes in but by its address, which works once and leads to one without the token."""
    access = Access.of(opens=True)
    with page(tmp_path, access=access) as one:
        first, second = one.visitor(), one.visitor()
        assert first.get("/").status_code == 401
        assert first.get(f"/open/{access.once[:-1]}x").status_code == 401
        assert first.ask("HEAD", f"/open/{access.once}").status_code == 405
        answer = first.get(f"/open/{access.once}")
        assert (answer.status_code, answer.headers["location"]) == (303, "/")
        assert re.search("httponly.*samesite=strict", answer.headers["set-cookie"].lower())
        assert first.get("/").status_code == 200
        used = second.get(f"/open/{access.once}")
        assert (used.status_code, second.get("/").status_code) == (403, 401)
        assert access.once not in one.said.getvalue()
        assert "by a double click or with --open" in used.text
        assert "by a double click or with --open" in second.get("/").text
        assert 'name="access"' not in second.get("/").text
        assert second.post("/login", data={"access": ""}).status_code == 401
        assert second.post("/login", data={"access": access.once}).status_code == 401


def test_a_key_left_in_the_store_lets_its_owner_in_once_more(tmp_path):
    """What a second start leaves in the store opens the page once, also after the first address; nothing else does."""
    access = Access.of(opens=True)
    with page(tmp_path, access=access) as one:
        assert one.visitor().get(f"/open/{access.once}").status_code == 303
        key = new_key(one.store.folder)
        assert one.visitor().get(f"/open/{key[:-1]}x").status_code == 403
        again = one.visitor()
        assert (again.get(f"/open/{key}").status_code, again.get("/").status_code) == (303, 200)
        assert one.visitor().get(f"/open/{key}").status_code == 403
        assert one.visitor().get("/open/ ").status_code == 403
    with page(tmp_path / "other") as one:
        assert one.visitor().get(f"/open/{new_key(one.store.folder)}").status_code == 401


def test_nobody_keeps_the_owner_out(tmp_path):
    """However many wrong tokens others of this machine send, the owner's address works."""
    access = Access.of(opens=True)
    with page(tmp_path, access=access) as one:
        for number in range(20):
            assert one.visitor().get(f"/open/{number}").status_code == 401
            one.visitor().post("/login", data={"access": "wrong"})
        assert one.visitor().get(f"/open/{access.once}").status_code == 303


def test_open_is_not_there_otherwise(tmp_path):
    """Without --open no address lets anybody in."""
    with page(tmp_path) as one:
        assert one.visitor().get("/open/").status_code == 404
        assert one.visitor().get("/open/x").status_code == 401


def test_the_cookie_is_secure_behind_https(tmp_path, token_file):
    """The proxy's word that it was asked by https makes the cookie secure; anybody else's does not."""
    for behind in ("Remote-User", ""):
        with page(tmp_path, access=Access.of(token_file=token_file, behind_proxy=behind)) as one:
            visitor = one.visitor(remote_user="anna", x_forwarded_proto="https")
            answer = visitor.post("/login", data={"access": TOKEN, "wanted": ""})
            assert ("Secure" in answer.headers["set-cookie"]) == bool(behind)
            assert answer.headers["set-cookie"].startswith("__Host-flexlash=") == bool(behind)


def test_only_so_many_are_answered_at_once(tmp_path):
    """More requests than the limit are asked to come again, in words."""
    with page(tmp_path, limits=Limits(requests=0)) as one:
        answer = one.visitor().get("/")
        assert (answer.status_code, answer.headers["retry-after"]) == (503, "30")
        assert "busy" in answer.text


def test_the_key_is_its_owners(tmp_path):
    """The key of all tokens lies in the store's folder, for its owner alone, and outlives the server."""
    with page(tmp_path) as one:
        token = one.visitor().token()
        key = one.store.folder / ".web.key"
        assert os.name != "posix" or key.stat().st_mode & 0o777 == 0o600
    with page(tmp_path) as one:
        assert one.visitor().hand_in(token=token).status_code == 303
    if os.name == "posix":
        key.chmod(0o644)
        with pytest.raises(OSError, match="its owner alone"), page(tmp_path):
            pass


def test_a_token_is_good_for_a_day():
    """A token holds for a day and not longer, for its purpose alone, under its key alone, and none is of tomorrow."""
    now = 1e9
    signer = Signer(b"k" * 32, lambda: now)
    token = signer.issue("form")
    later = {seconds: Signer(b"k" * 32, lambda seconds=seconds: now + seconds) for seconds in (86_399, 86_401, -60)}
    assert later[86_399].value("form", token) == token[:32]
    for other in (later[86_401], later[-60], Signer(b"j" * 32, lambda: now)):
        assert other.value("form", token) is None
    changed = [token.replace("-1", "-2", 1), "0" * 32 + token[32:], token[:-1], token + "0", token.upper(), "", "--"]
    assert [signer.value("form", one) for one in changed] == [None] * len(changed)
    assert signer.value("session", token) is None
    assert len({signer.issue("form") for _ in range(100)}) == 100
