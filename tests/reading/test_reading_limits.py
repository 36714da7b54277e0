"""The limits of reading: each at its value and one above, named with its setting, changed by it."""

import dataclasses
import random
import zipfile

import pytest
from click.testing import CliRunner
from small_workbook import MAIN, SHEET, STRINGS, WORKBOOK, book_of, parts_of, sheet_of, workbook_part

from flexlash.cli import cli
from flexlash.pipeline import check
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.schema.findings import finding

PROMISED = {
    "file_mebibytes": 20,
    "parquet_mebibytes": 100,
    "parts": 1_000,
    "part_mebibytes": 100,
    "unpacked_mebibytes": 200,
    "compression": 100,
    "depth": 64,
    "attributes": 256,
    "sheets": 100,
    "cells": 1_000_000,
    "table_rows": 1_048_576,
    "table_cells": 1_500_000,
    "merged_areas": 100_000,
    "characters": 32_767,
    "rows": 20_000,
    "columns": 256,
    "seconds": 60,
    "processor_seconds": 20,
    "memory_mebibytes": 1_024,
}
MEBI = 2**20
WHOLE = "a whole number of at least 1"
VARIANTS = workbook_part(['<sheet name="Variants" sheetId="1" r:id="rId1"/>'])


def _with_part(size):
    """Return a workbook, not compressed, with a part of a size."""
    return book_of(method=zipfile.ZIP_STORED, **{"xl/media/image.bin": b"\0" * size})


def _unpacking_to(size):
    """Return a workbook whose parts unpack to a size in all."""
    return _with_part(size - sum(map(len, parts_of().values())))


def _shrinking_by(ratio):
    """Return a workbook with a large part that shrinks by hardly less than a ratio."""
    noise = random.Random(3).randbytes(16 * MEBI // ratio)  # noqa: S311
    return book_of(**{"xl/media/image.bin": noise + b" " * (16 * MEBI + 1 - len(noise))})


def _sheets(number):
    return book_of(
        **{WORKBOOK: workbook_part(f'<sheet name="S{n}" sheetId="{n + 1}" r:id="rId1"/>' for n in range(number))}
    )


def _row_of(number):
    return f'<row r="1">{"<c><v>1</v></c>" * number}</row>'


def _merged(number):
    return book_of(**{SHEET: sheet_of("", after='<mergeCell ref="A1:B1"/>' * number)})


def _filled(rows, columns):
    cells = "<c><v>1</v></c>" * columns
    return book_of(f"<row>{cells}</row>" * rows, **{WORKBOOK: VARIANTS})


AT_LIMIT = {
    "file_mebibytes": (1, b"a" * MEBI, b"a" * (MEBI + 1)),
    "parts": (9, book_of(a="", b=""), book_of(a="", b="", c="")),
    "part_mebibytes": (1, _with_part(MEBI), _with_part(MEBI + 1)),
    "unpacked_mebibytes": (1, _unpacking_to(MEBI), _unpacking_to(MEBI + 1)),
    "depth": (7, book_of("<a>" * 5 + "</a>" * 5), book_of("<a>" * 6 + "</a>" * 6)),
    "attributes": (4, book_of('<row a="" b="" c="" d=""/>'), book_of('<row a="" b="" c="" d="" e=""/>')),
    "sheets": (2, _sheets(2), _sheets(3)),
    "cells": (3, book_of(_row_of(3)), book_of(_row_of(4))),
    "merged_areas": (2, _merged(2), _merged(3)),
    "characters": (
        9,
        *(book_of(**{STRINGS: f'<sst xmlns="{MAIN}"><si><t>{"x" * size}</t></si></sst>'}) for size in (9, 10)),
    ),
    "rows": (3, _filled(3, 1), _filled(4, 1)),
    "columns": (3, _filled(1, 3), _filled(1, 4)),
}


def _refusals(path, data, **limits):
    """Return the codes of a submission's errors and the first message."""
    path.write_bytes(data)
    outcome = check(path, limits=ReadingLimits(**limits))
    return [found.code for found in outcome.findings if found.level == "error"], outcome.findings[0].message


@pytest.mark.parametrize("setting", AT_LIMIT)
def test_at_the_limit_and_one_above(setting, tmp_path):
    """What lies at a limit is read; one more is refused by limit, value and setting; a higher limit lets it in."""
    value, within, above = AT_LIMIT[setting]
    path = tmp_path / "a.xlsx"
    assert "E110" not in _refusals(path, within, **{setting: value})[0]
    codes, message = _refusals(path, above, **{setting: value})
    assert codes == ["E110"]
    assert f"at most {value:,}" in message
    assert f"(setting {setting})" in message
    assert "E110" not in _refusals(path, above, **{setting: value + 1})[0]


def test_compression_at_its_limit(tmp_path):
    """A part that shrinks by a little more than a limit is refused by it and let in by the next."""
    data = _shrinking_by(20)
    assert _refusals(tmp_path / "a.xlsx", data, compression=19)[0] == ["E110"]
    assert "E110" not in _refusals(tmp_path / "a.xlsx", data, compression=20)[0]


def test_every_limit_has_a_test():
    """No limit is left out: those of the process and of tables are tested with them."""
    of_the_process = {"seconds", "processor_seconds", "memory_mebibytes"}
    of_tables = {"parquet_mebibytes", "table_rows", "table_cells"}
    assert AT_LIMIT.keys() | of_the_process | of_tables | {"compression"} == PROMISED.keys()


def test_limits_are_the_promised_ones():
    """The limits are those that were measured and promised."""
    assert dataclasses.asdict(ReadingLimits()) == PROMISED


@pytest.mark.parametrize("setting", PROMISED)
def test_a_limit_lets_in_its_value_alone(setting):
    """A number at the limit is let in, one above is refused in a message that can be printed."""
    limits = ReadingLimits()
    limits.require(setting, PROMISED[setting])
    with pytest.raises(Refusal) as caught:
        limits.require(setting, PROMISED[setting] + 1)
    told = finding(caught.value.code, file="a.xlsx", **caught.value.facts)
    assert f"{PROMISED[setting] + 1:,}" in told.message
    assert f"--limit {setting}=NUMBER" in told.fix
    assert len(told.message.split()) <= 25


def test_limits_are_whole_numbers_above_nothing():
    """Limits come from texts as well; what is no whole number above 0, or no limit, is refused."""
    assert ReadingLimits.of({"cells": "7", "rows": 8}) == ReadingLimits(cells=7, rows=8)
    for wrong in ("0", "-1", "1.5", "", "many", "٣", "1_0", " 7", "9" * 40, "9" * 15):
        with pytest.raises(ValueError, match=r"cells = .*: a whole number"):
            ReadingLimits.of({"cells": wrong})
    with pytest.raises(ValueError, match="at most 86400 is required"):
        ReadingLimits(seconds=10**20)
    with pytest.raises(ValueError, match=r"cell is not a limit; the limits are .*cells"):
        ReadingLimits.of({"cell": "7"})
    with pytest.raises(dataclasses.FrozenInstanceError):
        ReadingLimits().cells = 1


@pytest.mark.parametrize("command", ["check", "run"])
def test_limits_on_the_command_line(command, tmp_path):
    """A limit given on the command line, or in FLEXLASH_LIMIT, is the one that refuses and is named."""
    path = tmp_path / "a.xlsx"
    path.write_bytes(book_of(_row_of(4)))
    for arguments, environment in ((["--limit", "cells=3"], {}), ([], {"FLEXLASH_LIMIT": "cells=3 rows=5"})):
        done = CliRunner().invoke(cli, [command, str(path), *arguments], env=environment)
        assert done.exit_code == 4
        assert "the number of cells is 4; at most 3 is allowed (setting cells)" in " ".join(done.output.split())
    done = CliRunner().invoke(cli, [command, str(path), "--limit", "cells=4"])
    assert "setting cells" not in done.output


@pytest.mark.parametrize(
    ("given", "words"),
    [("cell=3", "cell is not a limit"), ("cells=0", WHOLE), ("cells", WHOLE),
     ("seconds=99999999999999999999", WHOLE), ("cells=7\x1b[31m", "7·[31m"),
     ("seconds=86401", "at most 86400"), ("cells=x", WHOLE), ("=3", "is not a limit")],
)  # fmt: skip
def test_a_limit_that_is_none_is_a_usage_error(given, words, tmp_path):
    """An unknown limit, or one that is no whole number in its bounds, is a usage error that says where it is set."""
    path = tmp_path / "a.csv"
    path.write_bytes(b"x")
    for arguments, environment, where in (
        (["--limit", given], {}, "--limit: "),
        ([], {"FLEXLASH_LIMIT": given}, "FLEXLASH_LIMIT: "),
    ):
        done = CliRunner().invoke(cli, ["check", str(path), *arguments], env=environment)
        said = " ".join(done.output.split())
        assert (done.exit_code, where in said, words in said, "\x1b" in said) == (2, True, True, False)
