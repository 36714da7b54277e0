"""Mutants of real workbooks, each made from a number alone, and what reading makes of them.

Run as a program it reads a range of mutants with little memory and prints what came of each as a line of JSON.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import re
import sys
import time
import traceback
import warnings
import zipfile
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from random import Random

import openpyxl
from edited_workbooks import small_template
from python_calamine import CalamineWorkbook, SheetTypeEnum
from small_workbook import archive_of

from flexlash.reading.cells_json import cells_to_json
from flexlash.reading.raw import Submission
from flexlash.reading.read import Source, submission_of
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.reading.xlsx import Cells

__all__ = ["PARTS_FROM", "main", "mutant", "originals", "outcome_of"]

PARTS_FROM = 1_000
"""Mutants from this number on are mutated inside their parts, those before it as files."""

_ROOT = Path(__file__).parents[2]
_CORPUS = Path(os.environ.get("FLEXLASH_CORPUS", "no such folder"))
_LARGE_EVERY = 50
"""One mutant in so many is of a workbook with thousands of prepared rows, which takes ten times as long to read."""

_SMALL = 12_000
"""Size [bytes] up to which a public workbook is quickly read."""

_MEBI = 2**20
_LIMITS = ReadingLimits()


@cache
def originals() -> tuple[bytes, ...]:
    """Return the small workbooks of which most mutants are made: the template, and public ones that are readable."""
    public = sorted(_CORPUS.glob("*.xlsx"), key=lambda path: (path.stat().st_size, path.name))
    small = [path.read_bytes() for path in public if path.stat().st_size < _SMALL and zipfile.is_zipfile(path)]
    readable = [data for data in small[:: len(small) // 15 + 1] if not outcome_of(data)[0]]
    return (*[_slim(small_template())] * 2, small_template(), *readable)


@cache
def _large() -> tuple[bytes, ...]:
    return tuple(path.read_bytes() for path in sorted((_ROOT / "data").glob("*.xlsx")))


def _parts(data: bytes) -> dict[str, bytes]:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def _slim(data: bytes) -> bytes:
    """Return the template without its notes, which nothing here reads and most of its bytes are for."""
    kept = {name: part for name, part in _parts(data).items() if "comments" not in name and "drawing" not in name}
    kept = {
        name: re.sub(rb"<legacyDrawing [^>]*>", b"", part) for name, part in kept.items() if "sheets/_rels" not in name
    }
    return archive_of(kept)


def mutant(number: int) -> tuple[bytes, bytes]:
    """Return a mutant and the workbook that it was made of."""
    random = Random(number)  # noqa: S311
    original = random.choice(_large() if number % _LARGE_EVERY == 0 else originals())
    if number < PARTS_FROM:
        return _of_file(random, original), original
    parts = _parts(original)
    for _ in range(random.choice((1, 1, 1, 2, 4))):
        _of_parts(random, parts)
    return archive_of(parts), original


def _of_file(random: Random, data: bytes) -> bytes:
    """Return a file with some bytes flipped, inserted, deleted, cut off or doubled."""
    changed = bytearray(data)
    for _ in range(random.choice((1, 1, 1, 2, 8, 64))):
        place = random.randrange(len(changed))
        # The directory at the end tells where everything is.
        place = random.choice((place, max(0, len(changed) - 1 - random.randrange(min(len(changed), 3000)))))
        length = random.choice((1, 2, 7, 100, 4000))
        match random.choice(("flip", "flip", "flip", "byte", "insert", "delete", "double", "cut")):
            case "flip":
                changed[place] ^= 1 << random.randrange(8)
            case "byte":
                changed[place] = random.randrange(256)
            case "insert":
                changed[place:place] = random.randbytes(length)
            case "delete":
                del changed[place : place + length]
            case "double":
                changed[place:place] = changed[place : place + length]
            case _:
                del changed[max(place, 4) :]
        if len(changed) < 8:
            return data[:7]
    return bytes(changed)


_NUMBERS = (
    b"-1", b"0", b"1", b"2", b"7", b"65536", b"1048576", b"1048577", b"4294967295", b"4294967296", b"1e999",
    b"-1e-400", b"1_000",
    b"0x10", b"nan", b"inf", b"1,5", b"", b" ", b" 1 ", b"1.0", b"+1", b"\xd9\xa1", b"99999999999999999999",
    b"true", b"0.1e1",
)  # fmt: skip
_WORDS = (
    b"s", b"b", b"e", b"n", b"str", b"inlineStr", b"d", b"x", b"", b"A1", b"XFD1048576", b"XFE1", b"A0", b"a1",
    b"$A$1", b"A1:B2",
    b"rId1", b"rId99", b"hidden", b"veryHidden", b"1", b"0", b"../../etc/passwd", b"http://example.org/x", b"Variants",
    b"preserve", b"array", b"shared", b"{0}", b"%s", b"&lt;", b"x" * 40_000,
)  # fmt: skip
_INSERTS = (
    b"<!--", b"-->", b"<![CDATA[", b"]]>", b"&#0;", b"&#xD800;", b"&nothing;", b"&#1114112;", b"&amp;",
    b"<?pi x?>", b"\0",
    b"\xff\xfe", b"\xef\xbb\xbf", b"_x0000_", b"_xD800_", b"_x005F_", b"<v>7</v>", b"<f/>",
    b"<is><t>7</t></is>", b"<r/>",
    b"<t>9</t>", b"<row/>", b"</row>", b"<x:y xmlns:x='u'/>", b"<c/>", b"<c><v>5</v></c>", b"<sheetData/>",
    b"9", b".", b"e5",
)  # fmt: skip
_DOCTYPES = (
    b'<!DOCTYPE x [<!ENTITY a "7">]>',
    b'<!DOCTYPE x SYSTEM "file:///etc/passwd">',
    b'<!DOCTYPE x [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;"><!ENTITY c "&b;&b;&b;&b;">]>',
    b"<!doctype html>",
)
_CODECS = ("utf-16", "utf-16-be", "utf-8-sig", "utf-7", "latin-1", "cp037", "utf-32", "cp1252")
_NAMESPACES = (
    (b"http://schemas.openxmlformats.org/spreadsheetml/2006/main", b"http://purl.oclc.org/ooxml/spreadsheetml/main"),
    (b"/spreadsheetml/2006/main", b"/spreadsheetml/2006/other"),
    (b"xmlns=", b"xmlns:x="),
    (b"xmlns:r=", b"xmlns:q="),
)
_TAG = re.compile(rb"<[^<>]+>")
_ATTRIBUTE = re.compile(rb'([\w:]+)="([^"]*)"')
_TEXT = re.compile(rb">([^<>]+)<")
_ELEMENT = re.compile(
    rb"<(c|row|si|xf|sheet|Relationship|Override|numFmt|mergeCell|property|col)\b[^<>]*?(?:/>|>.*?</\1>)", re.DOTALL
)


def _of_parts(random: Random, parts: dict[str, bytes]) -> None:
    """Change one part of a workbook, or which there are; cells, texts and what names them most often."""
    names = list(parts)
    if not names:
        return
    weights = [
        8 if "worksheets/sheet" in name else 4 if name.endswith(("workbook.xml", ".rels", "Strings.xml")) else 1
        for name in names
    ]
    (name,) = random.choices(names, weights)
    change = random.choice(_CHANGES)
    if change is _of_names:
        _of_names(random, parts, name)
    else:
        parts[name] = change(random, parts[name])


def _of_names(random: Random, parts: dict[str, bytes], name: str) -> None:
    """Drop, rename, empty, exchange or double a part."""
    other = random.choice(list(parts))
    match random.randrange(5):
        case 0:
            del parts[name]
        case 1:
            parts[name.swapcase()] = parts.pop(name)
        case 2:
            parts[name] = b""
        case 3:
            parts[name], parts[other] = parts[other], parts[name]
        case _:
            parts[f"xl/{name}"] = parts[name]


def _found(random: Random, pattern: re.Pattern[bytes], part: bytes) -> re.Match[bytes] | None:
    """Return one of a pattern's places, each as likely."""
    found = list(pattern.finditer(part))
    return random.choice(found) if found else None


def _put(part: bytes, start: int, end: int, new: bytes) -> bytes:
    return part[:start] + new + part[end:]


def _attribute(random: Random, part: bytes) -> bytes:
    match = _found(random, _ATTRIBUTE, part)
    return _put(part, *match.span(2), random.choice(_NUMBERS + _WORDS)) if match else part


def _attribute_dropped(random: Random, part: bytes) -> bytes:
    match = _found(random, _ATTRIBUTE, part)
    return (
        _put(part, *match.span(), random.choice((b"", match[0] + b" " + match[0], match[1] + b"2='1'")))
        if match
        else part
    )


def _text(random: Random, part: bytes) -> bytes:
    match = _found(random, _TEXT, part)
    return _put(part, *match.span(1), random.choice((*_NUMBERS, *_WORDS, *_INSERTS))) if match else part


def _reference(random: Random, part: bytes) -> bytes:
    match = _found(random, re.compile(rb'\b(?:r|ref|s|t|sqref)="([^"]*)"'), part)
    new = random.choice((*_WORDS, *_NUMBERS, b"B%d" % random.randrange(30), b"%d" % random.randrange(60)))
    return _put(part, *match.span(1), new) if match else part


def _swapped(random: Random, part: bytes) -> bytes:
    tags = list(_TAG.finditer(part))
    if len(tags) < 2:
        return part
    first, last = sorted(random.sample(tags, 2), key=lambda tag: tag.start())
    return part[: first.start()] + last[0] + part[first.end() : last.start()] + first[0] + part[last.end() :]


def _renamed(random: Random, part: bytes) -> bytes:
    match = _found(random, re.compile(rb"</?(\w+)"), part)
    return (
        part.replace(match[1], random.choice((b"x", match[1] + b"s", match[1].upper())), random.choice((1, 2, -1)))
        if match
        else part
    )


def _dropped(random: Random, part: bytes) -> bytes:
    match = _found(random, random.choice((_TAG, _ELEMENT, _ELEMENT)), part)
    return _put(part, *match.span(), b"") if match else part


def _doubled(random: Random, part: bytes) -> bytes:
    match, other = _found(random, _ELEMENT, part), _found(random, _ELEMENT, part)
    place = random.choice((match, other)).end() if match else 0
    return _put(part, place, place, match[0] * random.choice((1, 1, 3))) if match else part


def _inserted(random: Random, part: bytes) -> bytes:
    match = _found(random, _TAG, part)
    place = random.choice((match.start(), match.end())) if match else 0
    return _put(part, place, place, random.choice(_INSERTS))


def _declared(random: Random, part: bytes) -> bytes:
    end = part.find(b"?>") + 2 if part.startswith(b"<?xml") else 0
    new = _put(part, end, end, random.choice(_DOCTYPES))
    match = _found(random, _TEXT, new)
    return _put(new, *match.span(1), b"&a;") if match and random.random() < 0.7 else new


def _encoded(random: Random, part: bytes) -> bytes:
    codec = random.choice(_CODECS)
    text = part.decode("utf-8", "replace")
    if random.random() < 0.7:
        declared = codec if random.random() < 0.7 else random.choice(_CODECS)
        text = re.sub(r"^<\?xml[^>]*\?>", f'<?xml version="1.0" encoding="{declared}"?>', text)
    return text.encode(codec, "replace")


def _namespaced(random: Random, part: bytes) -> bytes:
    return part.replace(*random.choice(_NAMESPACES))


def _nested(random: Random, part: bytes) -> bytes:
    match = _found(random, _TAG, part)
    depth = random.choice((3, 62, 70, 5000))
    return _put(part, match.end(), match.end(), b"<a>" * depth + b"</a>" * depth) if match else part


def _flipped(random: Random, part: bytes) -> bytes:
    changed = bytearray(part)
    for _ in range(random.choice((1, 3, 20)) if changed else 0):
        changed[random.randrange(len(changed))] ^= 1 << random.randrange(8)
    return bytes(changed)


def _cut(random: Random, part: bytes) -> bytes:
    return part[: random.randrange(len(part) + 1)]


_CHANGES: tuple[Callable[..., bytes | None], ...] = (
    _attribute, _attribute, _attribute_dropped, _text, _text, _reference, _reference, _reference, _swapped, _renamed,
    _dropped, _dropped, _doubled, _inserted, _inserted, _declared, _encoded, _namespaced, _nested, _flipped,
    _cut, _of_names,
)  # fmt: skip


def outcome_of(data: bytes) -> tuple[str, dict[str, object]]:
    """Return the code of the refusal, empty where the mutant was read, and the cells as they left the reader."""
    try:
        submission = submission_of(Source(name="mutant.xlsx", data=data), _LIMITS)
    except Refusal as refusal:
        if refusal.code == "E118":
            traceback.print_exc()
        return refusal.code, {}
    return (
        ("csv", {}) if submission.kind == "csv" else ("", json.loads(json.dumps(cells_to_json(_cells_of(submission)))))
    )


def _cells_of(submission: Submission) -> Cells:
    return Cells(
        sheets=[*submission.sheets.values()],
        modified=submission.modified,
        role=submission.role,
        template_version=submission.template_version,
    )


def _checked(data: bytes) -> str:
    """Return the name of what a whole check of a mutant raised, empty where it raised nothing."""
    from edited_workbooks import reading_here

    from flexlash.pipeline import check

    try:
        with reading_here():
            json.dumps(check(Source(name="mutant.xlsx", data=data)).as_dictionary())
    except Exception as fault:  # noqa: BLE001
        return repr(fault)
    return ""


_FAR = re.compile(rb'\b(?:r|ref)="[^"]*(?:[A-Z]{3}|\d{5})')
"""Cells so far away that openpyxl fills a billion blank ones before them."""


def _number(value: object) -> float | None:
    """Return a cell's value when it is a number, else None."""
    return float(value) if isinstance(value, int | float) and not isinstance(value, bool) else None


def _with_openpyxl(data: bytes) -> dict[tuple[str, int, int], float | None]:
    book = openpyxl.load_workbook(io.BytesIO(data), data_only=True)
    cells = (cell for sheet in book.worksheets for row in sheet.iter_rows() for cell in row)
    return {(cell.parent.title, cell.row, cell.column): _number(cell.value) for cell in cells}


def _with_calamine(data: bytes) -> dict[tuple[str, int, int], float | None]:
    book = CalamineWorkbook.from_filelike(io.BytesIO(data))
    kinds = {sheet.name: sheet.typ for sheet in book.sheets_metadata}
    return {
        (name, row, place): _number(value)
        for name in book.sheet_names
        if kinds[name] == SheetTypeEnum.WorkSheet
        for row, values in enumerate(book.get_sheet_by_name(name).to_python(skip_empty_area=False), start=1)
        for place, value in enumerate(values, start=1)
    }


def _alone(data: bytes, cells: dict[str, list]) -> tuple[bool, list[object]]:
    """Return whether another reader could read a mutant, and the cells whose number none of those has too."""
    ours = {
        (sheet["name"], row, place): _number(value)
        for sheet in cells["sheets"]
        for row, values in sheet["rows"]
        for place, value in values
    }
    theirs = []
    for reader in (_with_openpyxl, _with_calamine):
        # What a mutant does to another reader is not our concern.
        with contextlib.suppress(Exception):
            theirs.append(reader(data))
    places = set(ours).union(*theirs)
    return bool(theirs), [
        (*place, ours.get(place), [one.get(place) for one in theirs])
        for place in sorted(places)
        if theirs and all(ours.get(place) != one.get(place) for one in theirs)
    ][:3]


def _records(first: int, stop: int, check_every: int, compare_every: int) -> Iterator[dict[str, object]]:
    """Yield what came of each mutant: its refusal, seconds, warnings, traceback of an unexpected exception."""
    for number in range(first, stop):
        data, original = mutant(number)
        said = io.StringIO()
        start = time.monotonic()
        with (
            warnings.catch_warnings(record=True) as warned,
            contextlib.redirect_stderr(said),
            contextlib.redirect_stdout(io.StringIO()),
        ):
            warnings.simplefilter("always")
            code, cells = outcome_of(data)
            raised = _checked(data) if code in {"", "csv"} and number % check_every == 0 else ""
        seconds = time.monotonic() - start
        is_compared = number >= PARTS_FROM and not code and number % compare_every == 0 and number % _LARGE_EVERY
        compared, alone = _compared(data, cells) if is_compared else (False, [])
        yield {
            "number": number,
            "code": code,
            "seconds": seconds,
            "warned": [str(one.message) for one in warned],
            "trace": said.getvalue()[-1500:] if code == "E118" else "",
            "raised": raised,
            "altered": number < PARTS_FROM and not code and cells != outcome_of(original)[1],
            "compared": compared,
            "alone": alone,
        }


def _compared(data: bytes, cells: dict[str, list]) -> tuple[bool, list[object]]:
    """Compare without a word of the other readers, nor what one of them would take forever for."""
    if any(_FAR.search(part) for part in _parts(data).values() if b"sheetData" in part):
        return False, []
    with warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()):
        warnings.simplefilter("ignore")
        return _alone(data, cells)


def main(first: int, stop: int, check_every: int, compare_every: int) -> None:
    """Print what came of the mutants, then the most memory that this process used [MiB]."""
    import resource

    # What the libraries take by themselves comes on top.
    _checked(small_template())
    size = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (size + 1024 * _MEBI, resource.RLIM_INFINITY))
    found = list(_records(first, stop, check_every, compare_every))
    # A process's own resource usage starts with the peak of the one that started it; this does not.
    status = Path("/proc/self/status").read_text(encoding="utf-8")
    memory = int(re.search(r"VmHWM:\s*(\d+) kB", status)[1]) // 1024
    sys.stdout.write(json.dumps({"memory": memory, "found": found}))


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
