"""A delimited text of any size → its lines, one by one, each with its bytes: nothing else of it is held."""

from __future__ import annotations

import codecs
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import BinaryIO

from flexlash.reading.encodings import CONTROL, MARKS, WINDOWS, unmarked_utf_16
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal

__all__ = ["Lines", "TextForm", "longest_line", "text_form"]

_CHUNK = 2**20
_LINE_END = re.compile(r"\r\n|\r|\n")
_ASCII = frozenset({"utf-8", "cp1252"})
"""Codecs in which a line ends with the same bytes as in ASCII, and nowhere else."""

_UNMARKED = {
    codecs.BOM_UTF8: "utf-8",
    codecs.BOM_UTF32_LE: "utf-32-le",
    codecs.BOM_UTF32_BE: "utf-32-be",
    codecs.BOM_UTF16_LE: "utf-16-le",
    codecs.BOM_UTF16_BE: "utf-16-be",
}
"""The codec of what stands behind a mark."""


@dataclass(frozen=True, kw_only=True)
class TextForm:
    """How the bytes of a text are characters: `codec`, the name of its `encoding`, and where it begins.

    `has_quotes` says whether a quote stands anywhere in it.
    """

    codec: str
    encoding: str
    start: int
    has_quotes: bool = True


def longest_line(limits: ReadingLimits) -> int:
    """Return how many characters a line or a record may have: as many as all cells of a row, twice for quotes."""
    return 2 * limits.columns * limits.characters


def text_form(file: BinaryIO, size: int) -> TextForm:
    """Return how a text of so many bytes is encoded, as `decoded` tells it of its bytes: all of it is read.

    Raises Refusal when it has no encoding that is known.
    """
    file.seek(0)
    head = file.read(_CHUNK)
    mark = next((mark for mark, _, _ in MARKS if head.startswith(mark)), b"")
    if mark:
        encoding = next(name for known, _, name in MARKS if known == mark)
        form = TextForm(codec=_UNMARKED[mark], encoding=encoding, start=len(mark))
    elif codec := "" if size % 2 else unmarked_utf_16(head[: len(head) // 2 * 2]):
        form = TextForm(codec=codec, encoding="UTF-16", start=0)
    else:
        form = TextForm(codec="utf-8", encoding="UTF-8", start=0)
    if found := _in_form(file, form):
        return found
    if mark or form.codec != "utf-8":
        raise Refusal("E107")
    return _windows(file)


def _in_form(file: BinaryIO, form: TextForm) -> TextForm | None:
    """Return a form in which all bytes of a text have a meaning, else None; raise Refusal at a zero."""
    file.seek(form.start)
    decoder = codecs.getincrementaldecoder(form.codec)()
    has_quotes = False
    try:
        while chunk := file.read(_CHUNK):
            has_quotes = has_quotes or b'"' in chunk
            if "\0" in decoder.decode(chunk):
                raise Refusal("E102")
        decoder.decode(b"", final=True)
    except UnicodeDecodeError:
        return None
    return replace(form, has_quotes=has_quotes)


def _windows(file: BinaryIO) -> TextForm:
    """Return the form of Excel's plain CSV, when every byte has a meaning there; else raise Refusal."""
    file.seek(0)
    has_quotes = False
    while chunk := file.read(_CHUNK):
        has_quotes = has_quotes or b'"' in chunk
        try:
            text = chunk.decode("cp1252")
        except UnicodeDecodeError as fault:
            raise Refusal("E107") from fault
        if CONTROL.search(text):
            raise Refusal("E107")
    return TextForm(codec="cp1252", encoding=WINDOWS, start=0, has_quotes=has_quotes)


class Lines:
    r"""The lines of a text from a byte on, each ending in \n where it ended at all.

    `position` is where the line behind the last one begins; `pieces` are the bytes of lines that were not `taken`.
    Raises Refusal for a line that no row can be, and for lines that are not taken.
    """

    def __init__(self, file: BinaryIO, form: TextForm, limits: ReadingLimits, start: int | None = None) -> None:
        self.file = file
        self.form = form
        self.limits = limits
        self.position = form.start if start is None else start
        self.pieces: list[bytes] = []
        self.held = 0

    def taken(self) -> bytes:
        """Return the bytes of the lines since this was last asked."""
        taken = b"".join(self.pieces)
        self.pieces.clear()
        self.held = 0
        return taken

    def __iter__(self) -> Iterator[str]:
        """Yield line after line."""
        codec = self.form.codec
        most = _CHUNK + 2 * longest_line(self.limits)
        for piece in self._ascii_lines() if codec in _ASCII else self._wide_lines():
            self.position += len(piece)
            self.pieces.append(piece)
            self.held += len(piece)
            self._require(self.held, most)
            line = piece.decode(codec)
            if line.endswith("\n"):
                yield line if not line.endswith("\r\n") else f"{line[:-2]}\n"
            else:
                yield f"{line[:-1]}\n" if line.endswith("\r") else line

    def _ascii_lines(self) -> Iterator[bytes]:
        """Yield the bytes of lines that end as in ASCII."""
        self.file.seek(self.position)
        rest, most = b"", longest_line(self.limits)
        while chunk := self.file.read(_CHUNK):
            lines = (rest + chunk).splitlines(keepends=True)
            rest = b"" if lines[-1].endswith(b"\n") else lines.pop()
            yield from lines
            self._require(len(rest), most)
        if rest:
            yield from rest.splitlines(keepends=True)

    def _wide_lines(self) -> Iterator[bytes]:
        """Yield the bytes of lines whose characters have more than one byte each."""
        self.file.seek(self.position)
        codec = self.form.codec
        decoder = codecs.getincrementaldecoder(codec)()
        rest, most = "", longest_line(self.limits)
        is_last = False
        while not is_last:
            chunk = self.file.read(_CHUNK)
            is_last = not chunk
            text = rest + decoder.decode(chunk, final=is_last)
            start = 0
            # What follows a return that stands last may belong to it.
            for end in _LINE_END.finditer(text, 0, len(text) - (text.endswith("\r") and not is_last)):
                yield text[start : end.end()].encode(codec)
                start = end.end()
            rest = text[start:]
            self._require(len(rest), most)
        if rest:
            yield rest.encode(codec)

    def _require(self, length: int, most: int) -> None:
        if length > most:
            raise self.limits.exceeded("characters")
