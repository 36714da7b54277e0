"""The XML of a part → its elements one by one, or those of one name, within limits."""

from __future__ import annotations

from xml.parsers import expat

from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal

__all__ = ["MAIN", "Elements", "Listing", "Texts", "local"]

MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"


def local(name: str) -> str:
    """Return an element's name without its namespace."""
    return name.rpartition(" ")[2]


class Elements:
    """Feeds a part to expat and calls back for each element; no document type, no deep nesting.

    Names come as `namespace name`. Raises Refusal when the part is no XML or exceeds a limit.
    """

    def __init__(self, data: bytes, limits: ReadingLimits) -> None:
        self.limits = limits
        self.depth = 0
        self.root = ""
        parser = expat.ParserCreate(namespace_separator=" ")
        parser.StartDoctypeDeclHandler = self._refuse
        parser.StartElementHandler = self._open
        parser.EndElementHandler = self._close
        parser.CharacterDataHandler = self.text
        parser.buffer_text = True
        try:
            parser.Parse(data, True)
        except (expat.ExpatError, ValueError, LookupError) as fault:
            raise Refusal("E102") from fault

    @staticmethod
    def _refuse(*_: object) -> None:
        raise Refusal("E105")

    def _open(self, name: str, attributes: dict[str, str]) -> None:
        self.depth += 1
        if self.depth > self.limits.depth:
            raise self.limits.exceeded("depth")
        if len(attributes) > self.limits.attributes:
            raise self.limits.exceeded("attributes", len(attributes))
        self.root = self.root or name
        self.start(name, attributes)

    def _close(self, name: str) -> None:
        self.depth -= 1
        self.end(name)

    def start(self, name: str, attributes: dict[str, str]) -> None:
        """React to an opening element."""

    def end(self, name: str) -> None:
        """React to a closing element."""

    def text(self, text: str) -> None:
        """React to character data."""


class Listing(Elements):
    """Collects the attributes of elements of one name, within elements of another when `inside` is given."""

    def __init__(self, data: bytes, limits: ReadingLimits, wanted: str, inside: str = "") -> None:
        self.wanted = wanted
        self.inside = inside
        self.open = not inside
        self.attributes: list[dict[str, str]] = []
        super().__init__(data, limits)

    def start(self, name: str, attributes: dict[str, str]) -> None:
        """Keep the attributes of a wanted element."""
        if self.open and local(name) == self.wanted:
            self.attributes.append(attributes)
        elif local(name) == self.inside:
            self.open = True

    def end(self, name: str) -> None:
        """Leave the element that contains the wanted ones."""
        if self.inside and local(name) == self.inside:
            self.open = False


class Texts(Elements):
    """Collects the text of each element of one name, that of its children included."""

    def __init__(self, data: bytes, limits: ReadingLimits, wanted: str) -> None:
        self.wanted = wanted
        self.open = False
        self.texts: list[str] = []
        self.pieces: list[str] = []
        super().__init__(data, limits)

    def start(self, name: str, attributes: dict[str, str]) -> None:  # noqa: ARG002
        """Begin a wanted element."""
        if local(name) == self.wanted:
            self.open = True
            self.pieces = []

    def end(self, name: str) -> None:
        """Complete a wanted element."""
        if local(name) == self.wanted:
            self.open = False
            self.texts.append("".join(self.pieces))

    def text(self, text: str) -> None:
        """Keep the text of a wanted element."""
        if self.open:
            self.pieces.append(text)
