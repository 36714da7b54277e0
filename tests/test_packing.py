"""The report's archive packed anew: the same parts in fewer bytes."""

from __future__ import annotations

import io
import random
import zipfile

from flexlash.report.packing import packed


def _archive(parts):
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in parts.items():
            archive.writestr(zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0)), text, zipfile.ZIP_DEFLATED)
    return buffer.getvalue()


def _numbers():
    """Return what a sheet of numbers looks like inside."""
    source = random.Random(1)  # noqa: S311
    cells = (f'<c r="C{row}" s="8"><v>{source.random():.16G}</v></c>' for row in range(5000))
    return "".join(cells)


def test_every_part_stays_as_it_was():
    """Names, order, dates and contents of the parts are the same, and the archive is whole."""
    parts = {"[Content_Types].xml": "<a/>", "xl/sheet.xml": _numbers(), "empty": ""}
    made = _archive(parts)
    with zipfile.ZipFile(io.BytesIO(made)) as before, zipfile.ZipFile(io.BytesIO(packed(made))) as after:
        assert after.testzip() is None
        assert after.namelist() == list(parts)
        for old, new in zip(before.infolist(), after.infolist(), strict=True):
            assert (old.date_time, old.CRC, old.file_size) == (new.date_time, new.CRC, new.file_size)
            assert before.read(old) == after.read(new)


def test_digits_take_less_room():
    """An archive of numbers is at least a twentieth smaller, and the same one whenever it is made."""
    made = _archive({"xl/sheet.xml": _numbers()})
    assert len(packed(made)) < 0.95 * len(made)
    assert packed(made) == packed(made)
