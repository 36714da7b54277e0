"""Excerpts of a table: together they say what the whole of it says."""

import csv
import datetime
import io
import random
from decimal import Decimal

import polars as pl
import pytest
from excerpts import at_once, in_excerpts
from finding_examples import SUBMISSIONS
from random_rows import rows as random_rows

from flexlash.schema.columns import columns_of

LABELS = {key: column.label for key, column in columns_of("Variants").items()}
SIZES = ((3, 1), (7, 5), (1000, 1000))
"""Rows of an excerpt and of a block."""


def test_excerpts_of_a_plain_table(tmp_path):
    """A few sound rows, an error and a name twice give the same in excerpts; the slow tests hold all the rest."""
    path = tmp_path / "study.csv"
    path.write_text(_text(_cups({}, {"variant": "c-1"}, {"wall_thickness_mm": -1}, {})), encoding="utf-8")
    _same(path, ((2, 3),))


@pytest.mark.parametrize("limits", [("", 5, "", ""), ("", "", "abc", ""), ("", "", "", "")])
def test_a_limit_of_the_drive_is_told_once(limits, tmp_path):
    """That a table has no sources is told at its header, whichever excerpt holds the limit."""
    path = tmp_path / "study.csv"
    path.write_text(_text(_cups(*({"system_limit_arcmin": limit} for limit in limits))), encoding="utf-8")
    whole = _same(path, ((2, 3), (1, 1)))
    assert str(whole).count("W466") == any(limits)


def _same(path, sizes=SIZES, **options):
    """Hold excerpts of several sizes against the whole table."""
    whole = at_once(path, **options)
    for rows, block in sizes:
        pieces = in_excerpts(path, rows, block, **options)
        if isinstance(whole, str) or isinstance(pieces, str):
            assert pieces == whole, (rows, block)
            continue
        assert pieces[0].equals(whole[0]), (rows, block, pieces[0], whole[0])
        assert pieces[0].schema == whole[0].schema
        assert pieces[1] == whole[1], (rows, block, pieces[1] - whole[1], whole[1] - pieces[1])
        assert sorted(map(str, pieces[2])) == sorted(map(str, whole[2])), (rows, block)
        assert pieces[3:] == whole[3:]
    return whole


def _text(records, delimiter=",", headers=LABELS):
    keys = list(dict.fromkeys(key for record in records for key in record))
    buffer = io.StringIO()
    writer = csv.writer(buffer, delimiter=delimiter, lineterminator="\n")
    writer.writerow([headers.get(key, key) for key in keys])
    writer.writerows([record.get(key, "") for key in keys] for record in records)
    return buffer.getvalue()


CUP = {
    "variant": "C",
    "material": "20Cr2Ni4",
    "torque_Nm": 800,
    "cylinder_length_mm": 160,
    "mean_radius_mm": 80,
    "wall_thickness_mm": 1.6,
    "disk_inner_radius_mm": 40,
}


def _cups(*changes):
    return [CUP | {"variant": f"C-{number}"} | change for number, change in enumerate(changes, start=1)]


TABLES = {
    "plain": _text(_cups({}, {}, {"wall_thickness_mm": -1}, {})),
    "a name three times": _text(_cups({"variant": "A"}, {}, {"variant": "a"}, {}, {"variant": "A"}, {"variant": "B"})),
    "a name in all rows": _text(_cups(*[{"variant": "A"}] * 120)),
    "no name": _text(_cups({"variant": ""}, {}, {"variant": ""})),
    "own numbers": _text(_cups({"serial": 1}, {"serial": 2}, {"serial": ""})),
    "own text at last": _text(_cups({"serial": 1}, {"serial": 2.5}, {"serial": "007"})),
    "own decimals at last": _text(_cups({"serial": 1}, {"serial": 2}, {"serial": 2.5})),
    "own without end": _text(_cups({"serial": 1}, {"serial": "1e999"}, {"serial": 2.5})),
    "own column blank": _text(_cups({"serial": ""}, {"serial": " "}, {})),
    "digits for notes": _text(_cups({"notes": 5}, {"notes": 7}, {})),
    "digits but the last": _text(_cups({"notes": 5}, {"notes": 7}, {"notes": "x"})),
    "a comma too many": _text(_cups({}, {}, {})) + "C-9,20Cr2Ni4,800,160,80,1,6,40\n",
    "a blank too many": _text(_cups({"wall_thickness_mm": 2}, {"wall_thickness_mm": 2}))
    + "C-9,20Cr2Ni4,800,160,80,2,40,\n",
    "a point late": _text(_cups({"wall_thickness_mm": 2}, {"wall_thickness_mm": 2}))
    + "C-9,20Cr2Ni4,800,160,80,2,40,\nC-8,20Cr2Ni4,800,160,80,1.6,40\n",
    "commas proven late": _text(_cups(*[{"wall_thickness_mm": "2"}] * 5, {"wall_thickness_mm": "1,6"}), ";"),
    "in doubt": _text(_cups({"torque_Nm": "1.200"}, {}, {"wall_thickness_mm": "1,6"}, {"torque_Nm": "1.200"}), ";"),
    "doubt alone": _text(_cups({"torque_Nm": "1.200"}, {"wall_thickness_mm": 2}), ";").replace("1.6", "2"),
    "doubt in own": _text(_cups({"x": "1.200"}, {"x": "1,5"}, {"wall_thickness_mm": "1,6"}), ";").replace("1.6", "1,6"),
    "gaps": _text(_cups({}, {}, {})).replace("C-2", "\n\nC-2").replace("C-3", "\n" * 70 + "C-3"),
    "remarks": _text(_cups({}, {}, {})).replace("C-2", "\nNote: x,,,\n\nall of these,,,,\nC-2")
    + "\n\nChecked by A\nMean,,800\n",
    "a lone cell": _text(_cups({}, {}, {})).replace("C-2", ",,5\nC-2"),
    "bare rows": _text(_cups({}, {})) + "C-7,20Cr2Ni4\nC-8\n",
    "units": _text([{"variant": "", "material": "", "torque_Nm": "N·m", "mean_radius_mm": "mm"}, *_cups({}, {}, {})]),
    "other units": _text([{"variant": "", "material": "", "torque_Nm": "N·m", "mean_radius_mm": "µm"}, *_cups({}, {})]),
    "units late": _text([*_cups({}, {}, {}), {"torque_Nm": "[N·m]", "mean_radius_mm": "[mm]"}]),
    "a title": "Study of 2020\n\n" + _text(_cups({}, {}, {})),
    "header late": "\n" * 8 + _text(_cups({}, {}, {})),
    "no header": "a,b\n1,2\n3,4\n",
    "no header, commas": "a;b\n1,2;2\n3,4;5\n" * 20,
    "no rows": _text(_cups({}))[: _text(_cups({})).index("\n") + 1] + "\n\n",
    "nameless late": _text(_cups({}, {}, {})).replace("Torque", "Torque", 1) + "C-9,20Cr2Ni4,800,160,80,1.6,40\n",
    "twice, filled late": _text(_cups({"variant ": ""}, {"variant ": ""}, {"variant ": "x"})),
    "twice, blank": _text(_cups({"variant ": ""}, {"variant ": ""}, {"variant ": " "})),
    "tolerance column late": _text(_cups({"Wall tol": ""}, {"Wall tol": ""}, {"Wall tol": "0.1"})),
    "misspelt, blank": _text(_cups({"Rim lenght [mm]": ""}, {"Rim lenght [mm]": ""})),
    "misspelt, late": _text(_cups({"Rim lenght [mm]": ""}, {"Rim lenght [mm]": 3})),
    "unknown materials": _text(
        _cups({"material": "20Cr2Ni5"}, {"material": "20cr2ni4"}, {"material": "20Cr2Ni5"}, {"material": "x"})
    ),
    "unknown classes": _text(_cups({"tolerance_class": "standart"}, {}, {"tolerance_class": "fine"})),
    "quotes": _text(_cups({"notes": 'two\nlines, "quoted"'}, {"notes": "a\r\nb"}, {"notes": "x"})),
    "errors": _text(_cups({"variant": "#N/A"}, {"variant": "#N/A"}, {"material": "#REF!"}, {"x": "#N/A"}, {"x": 1})),
    "blank in all ways": _text(
        _cups({"x": "\u200b"}, {"x": "\u00a0"}, {"variant": "\u200b"}, {"x": "\u2003"}, {"x": 2})
    ),
    "separator line": "sep=;\n" + _text(_cups({}, {}, {}), ";"),
    "a column missing": _text(_cups({}, {})).replace("Torque T", "Torqxe"),
    "unit mistakes": _text(_cups({"wall_thickness_mm": 1600}, {}, {"torque_Nm": 800000}, {})),
    "names of many kinds": _text(
        _cups({"variant": "Ä  1"}, {"variant": "Ä 1"}, {"variant": "Ä 1 "}, {"variant": "a" * 300})
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", TABLES)
def test_excerpts_of_a_text_say_what_the_whole_says(name, tmp_path):
    """Results with own columns, findings and facts of the file are the same for every size of excerpt and block."""
    path = tmp_path / "study.csv"
    path.write_bytes(TABLES[name].encode())
    _same(path, ((1, 3), *SIZES) if TABLES[name].count("\n") < 9 else ((20, 7), *SIZES[1:]))


WRITTEN = {
    "UTF-8 with a mark": lambda text: text.encode("utf-8-sig"),
    "UTF-16": lambda text: text.encode("utf-16"),
    "UTF-16 without a mark": lambda text: text.encode("utf-16-le"),
    "UTF-16, other order": lambda text: b"\xfe\xff" + text.encode("utf-16-be"),
    "UTF-32": lambda text: text.encode("utf-32"),
    "Windows": lambda text: text.replace("µ", "Ü").replace("\u200b", "").encode("cp1252", "replace"),
    "returns": lambda text: text.replace("\n", "\r").encode(),
    "both": lambda text: text.replace("\n", "\r\n").encode(),
    "no last end": lambda text: text.rstrip("\n").encode(),
    "half": lambda text: text[: len(text) // 2].encode(),
    "a zero": lambda text: text.encode() + b"\0",
    "no text": lambda text: text.encode() + b"\xff\x01",
}


@pytest.mark.slow
@pytest.mark.parametrize("how", WRITTEN)
@pytest.mark.parametrize("name", ["quotes", "separator line", "names of many kinds", "commas proven late"])
def test_however_a_text_is_written(name, how, tmp_path):
    """Every encoding and every kind of line end that is read at once is read in excerpts, or refused with that code."""
    path = tmp_path / "study.csv"
    path.write_bytes(WRITTEN[how](TABLES[name]))
    _same(path, SIZES[:2])


@pytest.mark.long
@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_random_rows(seed, tmp_path):
    """Rows on the edges of rules, with names twice, gaps, remarks and own columns, give the same in excerpts."""
    draw = random.Random(seed)  # noqa: S311
    names = ["A", "b", "B", "C-1", "", *(f"V{number}" for number in range(60))]
    records = [
        {
            "variant": draw.choice(names),
            "material": draw.choice(["20Cr2Ni4", "20cr2ni4", "?", "42CrMo4 (Q+T)"]),
            "torque_Nm": 800,
        }
        | {key: "" if value is None else value for key, value in record.items()}
        | {
            "notes": draw.choice(["", "5", "x"]),
            "serial": draw.choice([1, 2, "3.5", ""]),
            "tolerance_class": draw.choice(["", "fine"]),
        }
        for record in random_rows(60, seed)
    ]
    lines = _text(records).splitlines(keepends=True)
    for _ in range(8):
        lines.insert(draw.randrange(1, len(lines)), draw.choice(["\n", "Note: x\n", ",,,5\n", "Mean,,\n"]))
    path = tmp_path / "study.csv"
    path.write_bytes("".join(lines).encode())
    _same(path)


@pytest.mark.slow
@pytest.mark.parametrize("name", SUBMISSIONS)
def test_every_table_with_findings(name, tmp_path):
    """The submissions that have every finding of the catalogue give the same in excerpts, as far as they are tables."""
    path, options = SUBMISSIONS[name](tmp_path)
    if path.suffix in {".csv", ".parquet"} and not {"elasticity", "from_report", "limits"} & options.keys():
        _same(path, SIZES[:2], **options)


KINDS = {
    "whole": pl.Series([1, 2, None, 4, 5, 6, 7, 8, 9]),
    "inexact late": pl.Series([1, 2, 3, 4, 5, 6, 7, 8, 2**60 + 1]),
    "inexact early": pl.Series([2**60 + 1, 2, 3, 4, 5, 6, 7, 8, 9]),
    "without sign": pl.Series([2**64 - 1, 2, 3, 4, 5, 6, 7, 8, 9], dtype=pl.UInt64),
    "no number": pl.Series([1.0, 2.5, float("nan"), None, 5, 6, 7, 8, 9]),
    "endless at last": pl.Series([1.0, 2.5, 3, None, 5, 6, 7, 8, float("inf")]),
    "blank texts": pl.Series(["a", " ", "\u200b", None, "\u2003", "#N/A", "5", "x", ""]),
    "truths": pl.Series([True, None, False] * 3),
    "days": pl.Series([datetime.date(2020, 1, 2), None, datetime.date(9999, 1, 1)] * 3),
    "moments": pl.Series([datetime.datetime(2020, 1, 2, 3), None, datetime.datetime(2020, 1, 2)] * 3),  # noqa: DTZ001
    "times": pl.Series([datetime.time(1), None, datetime.time(2, 3, 4, 5)] * 3),
    "durations": pl.Series([datetime.timedelta(1), None, datetime.timedelta(0, 1, 2)] * 3),
    "categories": pl.Series(["a", "b", None] * 3, dtype=pl.Categorical),
    "a closed list": pl.Series(["a", "b", None] * 3, dtype=pl.Enum(["a", "b"])),
    "bytes": pl.Series([b"a", b"\xff", None] * 3),
    "lists": pl.Series([[1, 2], None, []] * 3),
    "records": pl.Series([{"a": 1}, None, {"a": 2}] * 3),
    "decimals": pl.Series([Decimal("1.10"), None, Decimal(2)] * 3),
    "nothing": pl.Series([None] * 9, dtype=pl.Null),
    "of 32 bits": pl.Series([1.1, None, 2.5] * 3, dtype=pl.Float32),
}


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_a_column_of_every_kind_in_groups_of_rows(kind, tmp_path):
    """A Parquet file's own column keeps what it holds, wherever that stands that decides how it is read."""
    frame = pl.DataFrame(_cups(*[{}] * 9)).with_columns(KINDS[kind].alias("own"))
    path = tmp_path / "study.parquet"
    frame.write_parquet(path, row_group_size=4)
    _same(path)


@pytest.mark.long
@pytest.mark.slow
def test_groups_of_rows_with_gaps_doubles_and_remarks(tmp_path):
    """Rows that are blank, remarks, of one name or without a number are judged alike in every group of rows."""
    records = _cups(*[{}] * 12, {"variant": "C-2"}, {"variant": "c-2"}, {"material": "x"}, {"wall_thickness_mm": -1})
    blank = dict.fromkeys(records[0])
    records[3:3] = [blank, blank, blank | {"variant": "all of these"}]
    records[9:9] = [
        blank | {"variant": "Note: x"},
        blank | {"torque_Nm": 5},
        blank | {"variant": "Mean", "torque_Nm": 5},
    ]
    records += [blank] * 62 + _cups({"variant": "far"}) + [blank] * 3
    for size in (5, 1000):
        path = tmp_path / f"study{size}.parquet"
        pl.DataFrame(records, infer_schema_length=None).write_parquet(path, row_group_size=size)
        _same(path, SIZES[:2])


def test_a_header_that_parquet_calls_a_row(tmp_path):
    """Headers that stand in the first rows of a Parquet file are found in every excerpt."""
    lines = [*csv.reader(_text(_cups({}, {"wall_thickness_mm": 0.001}, {})).splitlines())]
    path = tmp_path / "study.parquet"
    pl.DataFrame({f"c{number}": column for number, column in enumerate(zip(*lines, strict=True))}).write_parquet(path)
    _same(path, SIZES[:2])


BESIDE = "tolerance_class,dimension,lower_deviation,upper_deviation,deviation_unit,grade\n"
STANDARD = (
    "standard,wall_thickness,-0.02,0.02,mm,\nstandard,shear_modulus,-1,1,%,\nstandard,hub_fillet_radius,-0.1,0.1,mm,\n"
)
CLASSES = {
    "nearly the name of one in use": STANDARD + "fin,wall_thickness,-0.01,0.01,mm,\n",
    "leaves dimensions exact": STANDARD + "fine,mean_radius,-0.01,0.01,mm,\n",
    "faulty": STANDARD + "fine,wall_thickness,0.01,-0.01,mm,\n",
    "standard is faulty": "standard,wall_thickness,0.01,-0.01,mm,\nfine,wall_thickness,-0.01,0.01,mm,\n",
}
MATERIALS = {
    "faulty": "material,shear_modulus_GPa,yield_MPa\n20Cr2Ni4,,835\n",
    "in another unit": "material,shear_modulus_GPa,yield_MPa\n20Cr2Ni4,7.99e-7,835\nx,80,800\n",
}


@pytest.mark.slow
@pytest.mark.parametrize("classes", CLASSES)
@pytest.mark.parametrize("materials", [None, *MATERIALS])
def test_with_tables_beside_it(classes, materials, tmp_path):
    """What classes and materials of tables beside it say of the whole table, its excerpts say together."""
    changes = (
        {},
        {"tolerance_class": "fine"},
        {"tolerance_class": "fine", "hub_fillet_radius_mm": 1},
        {},
        {"torque_Nm": 900},
    )
    records = _cups(*changes, {"tolerance_class": "Fine", "material": "x"}, {"tolerance_class": "other"})
    path, beside, named = tmp_path / "study.csv", tmp_path / "classes.csv", tmp_path / "materials.csv"
    path.write_text(_text(records), encoding="utf-8")
    beside.write_text(BESIDE + CLASSES[classes], encoding="utf-8")
    options = {"tolerances": beside}
    if materials:
        named.write_text(MATERIALS[materials], encoding="utf-8")
        options["materials"] = named
    _same(path, SIZES[:2], **options)
