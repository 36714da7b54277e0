"""Notes on cells: a worksheet's comments part and the drawing that holds their boxes, ours put in and taken out."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Mapping
from dataclasses import dataclass

from flexlash.feedback.splicing.sheet_spans import WORKSHEET_ORDER
from flexlash.feedback.splicing.workbook_parts import WorkbookParts
from flexlash.feedback.splicing.xml_spans import (
    ElementSpan,
    appended,
    element_spans,
    in_order,
    prefixed,
    spliced,
    xml_text,
)
from flexlash.reading.elements import MAIN
from flexlash.schema.cell_addresses import CellAddress, cell_address

__all__ = ["add_notes", "clear_notes"]

_AUTHOR = "flexlash"
_HEAD = "— flexlash —"
_BETWEEN = "\n\n"
_LONGEST_TEXT = 32_000
_THREAD = "tc="
"""How the author of a note begins that only stands for a thread of comments."""

_WIDTH = 330
_LETTERS = 50
_LINE_HEIGHT = 17
_MOST_LINES = 34

_EMPTY_COMMENTS = (
    '<?xml version="1.0" encoding="UTF-8" standalone="yes"?>'
    f'<comments xmlns="{MAIN}"><authors></authors><commentList></commentList></comments>'
).encode()
_EMPTY_DRAWING = (
    b'<xml xmlns:v="urn:schemas-microsoft-com:vml" xmlns:o="urn:schemas-microsoft-com:office:office" '
    b'xmlns:x="urn:schemas-microsoft-com:office:excel"><o:shapelayout v:ext="edit"><o:idmap v:ext="edit" data="1"/>'
    b"</o:shapelayout></xml>"
)
_BOX_TYPE = (
    '<v:shapetype id="_x0000_t202" coordsize="21600,21600" o:spt="202" path="m,l,21600r21600,l21600,xe">'
    '<v:stroke joinstyle="miter"/><v:path gradientshapeok="t" o:connecttype="rect"/></v:shapetype>'
)
_BOX = (
    '<v:shape id="_x0000_s{number}" type="#_x0000_t202" style="position:absolute;margin-left:59.25pt;margin-top:1.5pt;'
    'width:{width}px;height:{height}px;z-index:1;visibility:hidden" fillcolor="#ffffe1" o:insetmode="auto">'
    '<v:fill color2="#ffffe1"/><v:shadow color="black" obscured="t"/><v:path o:connecttype="none"/>'
    '<v:textbox style="mso-direction-alt:auto"><div style="text-align:left"></div></v:textbox>'
    '<x:ClientData ObjectType="Note"><x:MoveWithCells/><x:SizeWithCells/><x:AutoFill>False</x:AutoFill>'
    "<x:Row>{row}</x:Row><x:Column>{column}</x:Column></x:ClientData></v:shape>"
)
_NUMBER = re.compile(r"_x0000_s(\d+)")
_NAMES = {"v": "urn:schemas-microsoft-com:vml", "o": "urn:schemas-microsoft-com:office:office",
          "x": "urn:schemas-microsoft-com:office:excel"}  # fmt: skip
_NAMED = re.compile(r"(?<=[</ ])([vox])(?=:\w)")
_SIZES = re.compile(r"(?<![\w-])(?:width|height)\s*:[^;\"']*;?")
_STYLE = re.compile(r"""\bstyle\s*=\s*(["'])(.*?)\1""", re.DOTALL)

Cell = tuple[int, int]
"""Row and column."""


@dataclass(frozen=True, kw_only=True)
class _Note:
    """A note as it stands in its part: its author, its text's element, and that one's runs and pieces of text."""

    author: str
    comment: ElementSpan
    body: ElementSpan
    runs: tuple[ElementSpan, ...]
    pieces: tuple[ElementSpan, ...]

    @property
    def text(self) -> str:
        """The whole text without its formats."""
        return "".join(piece.text for piece in self.pieces)


def add_notes(book: WorkbookParts, sheet: str, texts: Mapping[Cell, str]) -> int:
    """Put notes on cells of a worksheet, below what is there; return how many could not be, beside a thread."""
    if not texts:
        return 0
    comments = book.related(sheet, "comments") or _new_comments(book, sheet)
    part = _with_author(book.read(comments))
    notes = _notes(part)
    spans = element_spans(part, ("authors", "commentList"), parents=("authors",))
    number = [span.text for span in spans if span.parent == "authors"].index(_AUTHOR)
    changes, added, boxes = [], [], {}
    threads = 0
    for cell, told in texts.items():
        text = f"{_HEAD}\n{told}"[:_LONGEST_TEXT]
        if cell not in notes:
            added.append(_comment(cell, number, text))
            boxes[cell] = text
        elif notes[cell].author.startswith(_THREAD):
            threads += 1
        else:
            before = f"{notes[cell].text}{_BETWEEN}" if notes[cell].text else ""
            changes.append(_extended(notes[cell], f"{_BETWEEN if before else ''}{text}"))
            boxes[cell] = f"{before}{text}"
    book.write(comments, appended(spliced(part, changes), "commentList", b"".join(added)))
    _set_boxes(book, sheet, boxes)
    return threads


def clear_notes(book: WorkbookParts, sheet: str) -> None:
    """Leave of a worksheet's notes what is the user's."""
    comments = book.related(sheet, "comments")
    if not comments:
        return
    part = book.read(comments)
    changes: list[tuple[int, int, bytes]] = []
    boxes: dict[Cell, str] = {}
    for cell, note in _notes(part).items():
        theirs, head, _ = note.text.rpartition(_HEAD)
        if head:
            is_theirs = bool(theirs.strip() or (theirs and note.author != _AUTHOR))
            boxes[cell] = theirs.removesuffix(_BETWEEN) if is_theirs else ""
            whole = (note.comment.start, note.comment.end, b"")
            changes += _shortened(note, len(boxes[cell]), part) if boxes[cell] else [whole]
    book.write(comments, spliced(part, changes))
    _set_boxes(book, sheet, boxes)


def _new_comments(book: WorkbookParts, sheet: str) -> str:
    part = book.free_name(f"{book.folder}/comments{{}}.xml")
    book.add(sheet, "comments", part, _EMPTY_COMMENTS)
    return part


def _with_author(part: bytes) -> bytes:
    authors = [span.text for span in element_spans(part, parents=("authors",))[1:]]
    return part if _AUTHOR in authors else appended(part, "authors", b"<@author>%s</@author>" % _AUTHOR.encode())


def _notes(part: bytes) -> dict[Cell, _Note]:
    """Return the notes of a comments part by their cells."""
    spans = element_spans(part, ("author", "comment", "text", "r", "t"))[1:]
    authors = [span.text for span in spans if span.name == "author"]
    groups: list[list[ElementSpan]] = []
    for span in spans:
        if span.name == "comment":
            groups.append([span])
        elif groups and groups[-1][0].holds(span):
            groups[-1].append(span)
    found: dict[Cell, _Note] = {}
    for comment, *inside in groups:
        body = next((span for span in inside if span.name == "text"), None)
        cell = cell_address(comment.attributes.get("ref", ""))
        if body and cell:
            found[cell] = _Note(
                author=authors[int(comment.attributes.get("authorId", "0"))],
                comment=comment,
                body=body,
                runs=tuple(span for span in inside if span.name == "r"),
                pieces=tuple(span for span in inside if span.name == "t" and span.parent in {"r", "text"}),
            )
    return found


def _comment(cell: Cell, author: int, text: str) -> bytes:
    address = str(CellAddress(*cell)).encode()
    words = b'<@text><@t xml:space="preserve">%s</@t></@text>' % xml_text(text)
    return b'<@comment ref="%s" authorId="%d">%s</@comment>' % (address, author, words)


def _extended(note: _Note, addition: str) -> tuple[int, int, bytes]:
    """Return what is to change so that a note ends with more words."""
    text = xml_text(addition)
    if not note.runs and len(note.pieces) == 1 and note.pieces[0].close < note.pieces[0].end:
        return note.pieces[0].close, note.pieces[0].close, text
    new = b'<@r><@t xml:space="preserve">%s</@t></@r>' % text
    if note.body.close == note.body.end:
        new = b"<@text>%s</@text>" % new
        return note.body.start, note.body.end, prefixed(new, note.body.prefix)
    place = max((span.end for span in (*note.runs, *note.pieces)), default=note.body.inner)
    return place, place, prefixed(new, note.body.prefix)


def _shortened(note: _Note, length: int, part: bytes) -> list[tuple[int, int, bytes]]:
    """Return what is to change so that a note ends after so many characters."""
    changes = []
    for piece in note.pieces:
        kept = max(0, min(length, len(piece.text)))
        length -= len(piece.text)
        if kept == 0 and piece.text:
            run = next((run for run in note.runs if run.holds(piece)), piece)
            changes.append((run.start, run.end, b""))
        elif kept < len(piece.text):
            changes.append((piece.inner, piece.close, _cut(piece.contents(part), piece.text[:kept])))
    return changes


def _cut(contents: bytes, kept: str) -> bytes:
    """Return the beginning of a piece of text, in the bytes in which it stands where our own follow it."""
    theirs, head, _ = contents.rpartition(xml_text(_HEAD))
    return theirs.removesuffix(_BETWEEN.encode()) if head else xml_text(kept)


def _set_boxes(book: WorkbookParts, sheet: str, texts: Mapping[Cell, str]) -> None:
    """Make the boxes of notes as large as their texts, those of notes that are not there yet, and remove empty ones."""
    if not texts:
        return
    drawing = _drawing(book, sheet)
    content = book.read(drawing).decode("utf-8", "surrogateescape")
    names = _names(content)
    row_of, column_of = (re.compile(f"<{names['x']}:{word}>\\s*(\\d+)\\s*<") for word in ("Row", "Column"))
    pieces, waiting, end = [], dict(texts), 0
    opening, closing = f"<{names['v']}:shape ", f"</{names['v']}:shape>"
    while (start := content.find(opening, end)) >= 0 and (close := content.find(closing, start)) >= 0:
        close += len(closing)
        box = content[start:close]
        row, column = row_of.search(box), column_of.search(box)
        cell = (int(row[1]) + 1, int(column[1]) + 1) if row and column and 'ObjectType="Note"' in box else (0, 0)
        pieces.append(content[end:start])
        text = waiting.pop(cell, None)
        pieces.append(box if text is None else _sized(box, text, names["x"]) if text else "")
        end = close
    before, close_tag, after = content[end:].rpartition("</xml>")
    pieces.append(before)
    number = max([1024, *(int(found) for piece in pieces for found in _NUMBER.findall(piece))])
    new = [
        _BOX.format(number=number + place, row=row - 1, column=column - 1, width=_WIDTH, height=_height(text))
        for place, ((row, column), text) in enumerate(waiting.items(), start=1)
        if text
    ]
    if new and 'id="_x0000_t202"' not in content:
        new.insert(0, _BOX_TYPE)
    own = _NAMED.sub(lambda found: names[found[1]], "".join(new))
    result = "".join([*pieces, own, close_tag, after])
    book.write(drawing, result.encode("utf-8", "surrogateescape"))


def _names(content: str) -> dict[str, str]:
    """Return the prefixes of a drawing's three vocabularies; raise ValueError where one has none."""
    found = {}
    for usual, name in _NAMES.items():
        prefix = re.search(rf"""xmlns:([\w.-]+)\s*=\s*["']{re.escape(name)}["']""", content)
        if prefix is None or "</xml>" not in content:
            raise ValueError("a drawing of notes in unusual words")
        found[usual] = prefix[1]
    return found


def _drawing(book: WorkbookParts, sheet: str) -> str:
    """Return the part that holds the boxes of a worksheet's notes, which is made where there is none."""
    if drawing := book.legacy_drawing(sheet):
        return drawing
    part = book.free_name(f"{book.folder}/drawings/vmlDrawing{{}}.vml")
    relation = book.add(sheet, "vmlDrawing", part, _EMPTY_DRAWING)
    book.write(
        sheet, in_order(book.read(sheet), WORKSHEET_ORDER, "legacyDrawing", book.reference("legacyDrawing", relation))
    )
    return part


def _sized(box: str, text: str, name: str) -> str:
    """Return a box as large as its text, in its own place and looks."""
    tag, end, rest = box.partition(">")
    style = _STYLE.search(tag)
    if style:
        words = f"{_SIZES.sub('', style[2]).rstrip('; ')};width:{_WIDTH}px;height:{_height(text)}px"
        tag = tag[: style.start(2)] + words + tag[style.end(2) :]
    return tag + end + re.sub(f"<{name}:Anchor>[^<]*</{name}:Anchor>\\s*", "", rest)


def _height(text: str) -> int:
    lines = sum(max(1, len(textwrap.wrap(line, _LETTERS))) for line in text.splitlines())
    return _LINE_HEIGHT * (min(lines, _MOST_LINES) + 1)
