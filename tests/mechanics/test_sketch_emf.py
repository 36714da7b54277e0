"""A drawing as EMF: records that say what they hold, and the size at which a workbook shows it."""

import io
import struct

import pytest
from half_sections import CUP, FILLETS, HAT, RIM, TUBE
from xlsxwriter.image import Image

from flexlash.mechanics.sketch.drawing_marks import Label
from flexlash.mechanics.sketch.part_sketch import part_sketch
from flexlash.mechanics.sketch.sketch_emf import emf

SHAPES = {"cup": ("cup", CUP | FILLETS | RIM), "hat": ("hat", HAT | RIM), "cylinder": ("cylinder", TUBE)}


def _emf_records(data):
    place = 0
    while place < len(data):
        kind, size = struct.unpack_from("<II", data, place)
        assert size % 4 == 0
        yield kind, data[place : place + size]
        place += size


@pytest.mark.parametrize("shape", SHAPES)
def test_emf_keeps_what_its_header_says(shape):
    """Sizes and counts of the metafile are true, each tool is made before it is taken, and all words are in it."""
    drawing = part_sketch(*SHAPES[shape])
    data = emf(drawing)
    records = [*_emf_records(data)]
    length, number, handles = struct.unpack_from("<IIH", data, 48)
    assert (length, number) == (len(data), len(records))
    assert (records[0][0], data[40:44], records[-1][0]) == (1, b" EMF", 14)
    made = set()
    words = []
    for kind, record in records:
        (first,) = struct.unpack_from("<I", record, 8) if len(record) > 8 else (0,)
        if kind in {39, 82, 95}:
            made.add(first)
        elif kind == 37:
            assert first in made or first == 0x80000008
        elif kind == 84:
            letters, start = struct.unpack_from("<II", record, 44)
            words.append(record[start : start + 2 * letters].decode("utf-16-le"))
    assert made == {*range(1, handles)}
    assert words == [mark.words for mark in drawing.marks if isinstance(mark, Label)]


def test_a_workbook_takes_the_metafile_at_its_size():
    """XlsxWriter reads width and height of the metafile as those of the drawing, at 96 dots an inch."""
    drawing = part_sketch(*SHAPES["cup"])
    read = Image(io.BytesIO(emf(drawing)))
    assert (read._width, read._height) == (round(drawing.width), round(drawing.height))
    assert (read._x_dpi, read._y_dpi) == pytest.approx((96, 96), rel=0.01)
