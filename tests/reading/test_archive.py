"""The archive inside a workbook: every part checked before anything reads it, and nothing unpacked beyond its claim."""

import io
import struct
import tracemalloc
import zipfile
import zlib

import pytest
from small_workbook import SHEET, WORKBOOK, archive_of, book_of, overwritten, parts_of

from flexlash.reading.archive import packed, unpacked
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal

CENTRAL, LOCAL = b"PK\x01\x02", b"PK\x03\x04"


def _refused(data, **limits):
    """Return the code by which an archive is refused, or None."""
    try:
        unpacked(data, ReadingLimits(**limits))
    except Refusal as refusal:
        return refusal.code
    return None


def _deflated(data):
    stream = zlib.compressobj(9, zlib.DEFLATED, -15)
    return stream.compress(data) + stream.flush()


def _local(name, content, packed_content):
    return (
        struct.pack(
            "<4s5H3L2H", LOCAL, 20, 0, 8, 0, 33, zlib.crc32(content), len(packed_content), len(content), len(name), 0
        )
        + name.encode()
    )


def _directory(entries, start):
    """Return the directory of (name, content, packed size, place)."""
    listed = b"".join(
        struct.pack("<4s6H3L5H2L", CENTRAL, 20, 20, 0, 8, 0, 33, zlib.crc32(content), size, len(content), len(name), 0,
                    0, 0, 0, 0, place) + name.encode()
        for name, content, size, place in entries
    )  # fmt: skip
    count = len(entries)
    return listed + struct.pack("<4s4H2LH", b"PK\x05\x06", 0, 0, count, count, len(listed), start, 0)


def _quoting(names):
    """Return an archive in which each part quotes the header of the next and then continues as that part.

    No name and no checksum is wrong, and every part unpacks to all that follow it: the bomb that grows by squares.
    """
    content = b"kernel"
    body = _deflated(content)
    pieces = []
    for name in reversed(names):
        header = _local(name, content, body)
        pieces.insert(0, (name, content, body, header))
        content = header + content
        body = b"\0" + struct.pack("<2H", len(header), len(header) ^ 0xFFFF) + header + body
    data, entries, place = b"", [], 0
    for name, content, body, header in pieces:
        entries.append((name, content, len(body), place))
        place += len(header) + 5
    first = pieces[0]
    data = first[3] + first[2]
    return data + _directory(entries, len(data))


def _swallowing():
    """Return an archive whose first, uncompressed part covers the whole of its second one."""
    inner = _local("b.xml", b"<b/>", _deflated(b"<b/>")) + _deflated(b"<b/>")
    outer = bytearray(_local("a.xml", inner, inner))
    outer[8:10] = b"\0\0"
    directory = bytearray(_directory([
        ("a.xml", inner, len(inner), 0), ("b.xml", b"<b/>", len(_deflated(b"<b/>")), len(outer))
    ], len(outer) + len(inner)))  # fmt: skip
    directory[10:12] = b"\0\0"
    return bytes(outer) + inner + bytes(directory)


def _into_directory():
    """Return an archive whose only part reaches into the directory."""
    data = _local("a.xml", b"x", b"x") + b"x"
    return data + _directory([("a.xml", b"x" * 100, 100, 0)], len(data))


def _same_place():
    """Return an archive of two names for one stretch of bytes."""
    data = _local("a.xml", b"<a/>", _deflated(b"<a/>")) + _deflated(b"<a/>")
    entries = [(name, b"<a/>", len(_deflated(b"<a/>")), 0) for name in ("a.xml", "a.xml2")]
    return data + _directory(entries, len(data))


def _renamed_in_directory():
    data = archive_of(parts_of(), zipfile.ZIP_STORED)
    place = data.rfind(b"xl/sharedStrings.xml")
    return data[:place] + b"xl/sharedStringz.xml" + data[place + 20 :]


def _longer_than_claimed():
    """Return an archive whose part unpacks to a mebibyte, of which it claims the first ten bytes, checksum and all."""
    content, body = b" " * 2**20, _deflated(b" " * 2**20)
    data = _local("a.xml", content, body) + body
    return data + _directory([("a.xml", content[:10], len(body), 0)], len(data))


def _streamed(*, zip64=False):
    """Return an archive written to a stream that cannot go back: sizes stand behind each part."""

    class Stream:
        def __init__(self):
            self.file = io.BytesIO()

        def write(self, data):
            return self.file.write(data)

        def flush(self):
            """Have nothing to flush."""

    stream = Stream()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in parts_of().items():
            with archive.open(name, "w", force_zip64=zip64) as file:
                file.write(text.encode())
    return stream.file.getvalue()


def _long_form():
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in parts_of().items():
            with archive.open(name, "w", force_zip64=True) as file:
                file.write(text.encode())
    return buffer.getvalue()


REFUSED = {
    "a half copy": ("E102", book_of()[:900]),
    "a copy that lacks its end": ("E102", book_of()[:-10]),
    "a changed digit": ("E102", book_of(method=zipfile.ZIP_STORED).replace(b"<v>1</v>", b"<v>7</v>")),
    "two parts of one name": ("E102", archive_of([*parts_of().items(), (SHEET, "<worksheet/>")])),
    "names that differ in case": ("E102", archive_of([*parts_of().items(), (SHEET.upper(), "<worksheet/>")])),
    "a part called otherwise in the directory": ("E102", _renamed_in_directory()),
    "a path that climbs": ("E102", book_of(**{"../evil.xml": "<a/>"})),
    "a path that climbs inside": ("E102", book_of(**{"xl/../../evil.xml": "<a/>"})),
    "an absolute path": ("E102", book_of(**{"/evil.xml": "<a/>"})),
    "a backslash in a path": ("E102", book_of(**{"xl\\evil.xml": "<a/>"})),
    "a colon in a path": ("E102", book_of(**{"C:evil.xml": "<a/>"})),
    "compression other than deflate": ("E102", archive_of(parts_of(), zipfile.ZIP_LZMA)),
    "an encrypted part": ("E103", overwritten(overwritten(book_of(), CENTRAL, 8, 1, 2), LOCAL, 6, 1, 2)),
    "a part that quotes the next": ("E102", _quoting(["a.xml", "b.xml", "c.xml"])),
    "a part inside another": ("E102", _swallowing()),
    "a part that reaches into the directory": ("E102", _into_directory()),
    "two names of one part": ("E102", _same_place()),
    "a part larger than it claims": ("E102", _longer_than_claimed()),
    "a part smaller than it claims": ("E102", overwritten(book_of(), CENTRAL, 24, 10_000, 4)),
    "a directory with fewer parts than it says": ("E102", overwritten(book_of(), b"PK\5\6", 10, 99, 2)),
    "a wrong checksum": ("E102", overwritten(book_of(), CENTRAL, 16, 1, 4)),
    "a place beyond the file": ("E102", overwritten(book_of(), CENTRAL, 42, 10**6, 4)),
    "a place that is no part": ("E102", overwritten(book_of(), CENTRAL, 42, 7, 4)),
    "a packed size beyond the file": ("E102", overwritten(book_of(), CENTRAL, 20, 10**6, 4)),
    "no stream where one is claimed": ("E102", overwritten(book_of(method=zipfile.ZIP_STORED), CENTRAL, 10, 8, 2)),
    "nothing but the end": ("E102", b"PK\x03\x04" + b"\0" * 100),
}  # fmt: skip


@pytest.mark.parametrize("what", REFUSED)
def test_refused_by_its_code(what):
    """What is damaged, locked, ambiguous or leads out of the archive is refused by its code."""
    code, data = REFUSED[what]
    assert _refused(data) == code


def test_the_hostile_archives_are_as_dangerous_as_they_claim():
    """Python of this version, or a reader without our checks, unpacks the archives that overlap: they do overlap."""
    for data in (_quoting(["a.xml", "b.xml", "c.xml"]), _swallowing()):
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            places = sorted((part.header_offset, part.compress_size) for part in archive.infolist())
        assert places[0][0] + places[0][1] > places[1][0]


ACCEPTED = {
    "compressed": book_of(),
    "not compressed": book_of(method=zipfile.ZIP_STORED),
    "sizes behind the parts": _streamed(),
    "sizes behind the parts in the long form": _streamed(zip64=True),
    "sizes in the long form": _long_form(),
    "a folder": archive_of([("xl/", ""), *parts_of().items()]),
    "a comment at the end": book_of()[:-2] + b"\x05\x00hello",
}


@pytest.mark.parametrize("what", ACCEPTED)
def test_every_way_of_writing_gives_the_same_parts(what):
    """However an archive was written, its parts are those that went in."""
    assert unpacked(ACCEPTED[what], ReadingLimits()) == {name: text.encode() for name, text in parts_of().items()}


@pytest.mark.slow
def test_bytes_that_vary_by_claim_are_not_unpacked_first():
    """A part that claims ten bytes and holds a gibibyte is refused without unpacking the gibibyte."""
    stream = zlib.compressobj(9, zlib.DEFLATED, -15)
    body = b"".join(stream.compress(b" " * 2**20) for _ in range(1024)) + stream.flush()
    data = _local("a.xml", b"", body) + body
    data += _directory([("a.xml", b" " * 10, len(body), 0)], len(data))

    tracemalloc.start()
    assert _refused(data) == "E102"
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert len(data) < 1.2 * 2**20
    assert peak < 20 * 2**20


def test_a_gibibyte_of_blanks_that_is_declared():
    """A sheet of a gibibyte of blanks in a file of a megabyte is refused by the size that it declares."""
    data = overwritten(book_of(), CENTRAL, 24, 2**30, 4)
    with pytest.raises(Refusal) as caught:
        unpacked(data, ReadingLimits())
    assert caught.value.code == "E110"
    assert caught.value.facts["setting"] == "part_mebibytes"
    assert caught.value.facts["found"] == "1,024 MiB"


def test_a_torn_copy_is_never_read():
    """However much of a workbook's end is missing, it is refused as damaged."""
    data = book_of()
    for length in range(4, len(data), 37):
        assert _refused(data[:length]) == "E102"


def test_compression_is_measured_above_a_mebibyte():
    """A part of up to 1 MiB may shrink as it will; a larger one by no more than like rows do."""
    assert _refused(book_of(**{"xl/media/image.bin": b"\0" * 2**20})) is None
    assert _refused(book_of(**{"xl/media/image.bin": b"\0" * (2**20 + 1)})) == "E110"


def _alike(mebibytes):
    """Return the texts of a sheet of hand-written remarks, most of which are alike."""
    text = "".join(f"<si><t>Test piece, hardened and tempered by drawing {number % 9}</t></si>" for number in range(99))
    return f"<sst>{text * (mebibytes * 2**20 // len(text) + 1)}</sst>"


def test_honest_parts_of_like_rows_are_let_through():
    """A part of like rows shrinks by hundreds to 1 and is no bomb; a large one is refused all the same."""
    small, large = (archive_of({"xl/sharedStrings.xml": _alike(size)}) for size in (3, 17))
    (part,) = zipfile.ZipFile(io.BytesIO(small)).infolist()
    assert part.file_size > 150 * part.compress_size
    assert _refused(small) is None
    assert _refused(large) == "E110"


APPLE = b"\0\5\x16\7\0\2\0\0Mac OS X        " + b"\0" * 100
LITTER = {
    "a Mac's": {"__MACOSX/": "", **{f"__MACOSX/._{name}": APPLE for name in parts_of()}, ".DS_Store": b"\0\0\0\1Bud1"},
    "a Mac's beside each part": {
        "xl/._workbook.xml": APPLE + b"<!DOCTYPE plist>", "xl/.DS_Store": b"Bud1", "Icon\r": b"",
    },
    "a Mac's whose names have colons": {"__MACOSX/xl/._a:b.xml": APPLE},
    "a large one": {"__MACOSX/._photo": b"\0" * (2**20 + 1)},
    "Windows'": {"Thumbs.db": b"\xd0\xcf\x11\xe0", "xl/desktop.ini": "[.ShellClassInfo]"},
    "folders": {"xl/": "", "xl/worksheets/": "", "_rels/": ""},
}  # fmt: skip


@pytest.mark.parametrize("what", LITTER)
def test_what_file_managers_leave_behind_is_no_part(what):
    """What macOS or Windows put into an archive is passed over, wherever it stands and whatever it holds."""
    parts = {name: text.encode() for name, text in parts_of().items()}
    assert unpacked(archive_of(parts | LITTER[what]), ReadingLimits()) == parts


def test_litter_hides_no_part():
    """What is passed over still has a place of its own in the archive."""
    assert _refused(_swallowing().replace(b"b.xml", b"._b.x")) == "E102"


@pytest.mark.parametrize("compressed", [False, True])
def test_packed_parts_come_back(compressed):
    """What is packed unpacks to the same parts, and the same parts give the same bytes."""
    parts = {name: text.encode() for name, text in parts_of(**{WORKBOOK: "Δ" * 1000}).items()}
    data = packed(parts, compressed=compressed)
    assert unpacked(data, ReadingLimits()) == parts
    assert packed(parts, compressed=compressed) == data
