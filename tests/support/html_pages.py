"""What every page of the service owes its reader, told of its HTML as a browser takes it."""

from __future__ import annotations

from html.parser import HTMLParser
from itertools import pairwise

__all__ = ["HtmlPage", "faults_of"]

_VOID = {"meta", "link", "input", "br", "hr", "img"}
_EMPTY_IN_SVG = {"rect", "line", "polygon", "text", "title", "desc"}
_FIELDS = {"input", "select", "textarea"}
_ADDRESSES = ("href", "src", "action", "formaction", "poster", "data", "xlink:href")


class HtmlPage(HTMLParser):
    """Elements, attributes and texts of a page, and what is wrong with how they are nested."""

    def __init__(self, html: str) -> None:
        super().__init__(convert_charrefs=True)
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.texts: list[str] = []
        self.comments: list[str] = []
        self.open: list[str] = []
        self.faults: list[str] = []
        self.feed(html)
        self.close()
        self.faults += [f"<{tag}> is never closed" for tag in self.open]

    def handle_starttag(self, tag, attrs):
        """Keep an element."""
        names = [name for name, _ in attrs]
        self.faults += [f"<{tag}> has {name} twice" for name in {name for name in names if names.count(name) > 1}]
        self.elements.append((tag, dict(attrs)))
        if tag not in _VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        """Keep an element without content."""
        self.elements.append((tag, dict(attrs)))
        if tag not in _VOID | _EMPTY_IN_SVG:
            self.faults.append(f"<{tag}/> is no element without content")

    def handle_endtag(self, tag):
        """Say where the nesting is wrong."""
        if not self.open or self.open.pop() != tag:
            self.faults.append(f"</{tag}> closes another element")

    def handle_data(self, data):
        """Keep a text."""
        self.texts.append(data)

    def handle_comment(self, data):
        """Keep a comment."""
        self.comments.append(data)

    def all(self, tag: str) -> list[dict[str, str | None]]:
        """Return the attributes of every element of a kind."""
        return [attributes for name, attributes in self.elements if name == tag]

    @property
    def text(self) -> str:
        """All that is said on the page."""
        return " ".join(" ".join(self.texts).split())


def faults_of(html: str) -> list[str]:
    """Return what is wrong with a page: its nesting, its IDs and labels, what a strict policy would not let it do."""
    page = HtmlPage(html)
    return page.faults + _names(page) + _policy(page) + _headings(page) + _landmarks(page)


def _names(page: HtmlPage) -> list[str]:
    """Return IDs that are there twice, and references to none; fields without a label."""
    ids = [one["id"] for _, one in page.elements if "id" in one]
    faults = [f"id {name} is there twice" for name in set(ids) if ids.count(name) > 1]
    for tag, one in page.elements:
        wanted = [*(one.get("for") or "").split(), *(one.get("aria-labelledby") or "").split()]
        wanted += [one["href"][1:]] if (one.get("href") or "").startswith("#") else []
        faults += [f"<{tag}> leads to {name}, which is nowhere" for name in wanted if name not in ids]
    labels = {one.get("for") for one in page.all("label")}
    for tag, one in page.elements:
        is_seen = tag in _FIELDS and one.get("type") not in {"hidden", "submit"}
        if is_seen and one.get("id") not in labels and "aria-label" not in one:
            faults.append(f"<{tag} name={one.get('name')}> has no label")
        if tag in {"progress", "nav"} and "aria-label" not in one:
            faults.append(f"<{tag}> has no name")
        if tag == "th" and "scope" not in one:
            faults.append("<th> does not say whether it is of a row or a column")
    return faults


def _policy(page: HtmlPage) -> list[str]:
    """Return what the policy forbids: scripts, inline style, frames, anything of another server."""
    faults = [f"<{tag}>" for tag, _ in page.elements if tag in {"script", "style", "iframe", "object", "embed", "base"}]
    for tag, one in page.elements:
        faults += [f"<{tag} {name}>" for name in one if name == "style" or name.startswith("on")]
        for name in _ADDRESSES:
            address = one.get(name)
            if address is not None and not (address.startswith("#") or address[:1] == "/" != address[1:2]):
                faults.append(f"<{tag} {name}={address}> leaves this server")
    return faults + [f"a comment: {comment[:40]}" for comment in page.comments]


def _headings(page: HtmlPage) -> list[str]:
    """Return headings that leave out a level, and more or less than one of the first."""
    levels = [int(tag[1]) for tag, _ in page.elements if len(tag) == 2 and tag[0] == "h" and tag[1].isdigit()]
    faults = [] if levels.count(1) == 1 and levels[0] == 1 else [f"headings {levels} do not begin with the only h1"]
    return faults + [f"a heading {b} follows one {a}" for a, b in pairwise(levels) if b > a + 1]


def _landmarks(page: HtmlPage) -> list[str]:
    """Return what a reader by ear would miss."""
    faults = [f"{len(page.all(tag))} <{tag}>" for tag in ("main", "header", "footer") if len(page.all(tag)) != 1]
    if page.all("html") != [{"lang": "en"}]:
        faults.append("the page does not say its language")
    if not any(one.get("class") == "skip" and one.get("href") == "#main" for one in page.all("a")):
        faults.append("there is no link to the content")
    if not any(one.get("name") == "viewport" for one in page.all("meta")):
        faults.append("a telephone is not told its width")
    return faults
