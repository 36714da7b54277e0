"""Trace spread: its formulas come to the program's first-order sd, and any of its slopes to that of the formulas."""

from __future__ import annotations

import io
import math
import re

import numpy as np
import openpyxl
import pytest
from filled import SOUND
from libreoffice import convert_all, needs_libreoffice
from report_entries import error_cells, typed, values_of
from traced_rows import MATERIALS, ROWS, rows_of
from traced_spreads import slope_audited, spread_traced

from flexlash.feedback.template.template_workbook import Filling, template_bytes
from flexlash.pipeline import check, run
from flexlash.report.trace.spread_table import HEADER
from flexlash.report.trace.trace_spread import AGREES, CHANGED
from flexlash.schema.entry_words import dimension_title
from flexlash.schema.units import ARCMIN

CUP = {**SOUND, "disk_thickness_mm": 1.8, "hub_fillet_radius_mm": 3.0}
LIMITS = {
    "cylinder_length": (-0.1, 0.3), "wall_thickness": (-0.02, 0.02), "mean_radius": (-0.05, 0.05),
    "disk_inner_radius": (-0.03, 0.01), "disk_thickness": (-0.02, 0.04), "torque": (-8, 8),
}  # fmt: skip


def _rows(name, **processes):
    """Return rows of Tolerances of a class, with further cells by dimension."""
    return [
        {"tolerance_class": name, "dimension": dimension, "lower_deviation": low, "upper_deviation": high,
         **processes.get(dimension, {})}
        for dimension, (low, high) in LIMITS.items()
    ]  # fmt: skip


PROCESSES = {
    "plain": {},
    "shapes": {
        "wall_thickness": {"distribution": "uniform"},
        "disk_thickness": {"distribution": "triangular"},
        "mean_radius": {"distribution": "truncated normal", "limits_sigma": 1.0},
        "cylinder_length": {"limits_sigma": 4.0},
    },
    "shop": {
        "wall_thickness": {"mean_shift": 0.007, "standard_deviation": 0.0041},
        "disk_thickness": {"cp": 1.1, "cpk": 0.9},
        "mean_radius": {"distribution": "truncated normal", "standard_deviation": 0.04, "mean_shift": -0.03},
        "torque": {"scatters_between": "lots"},
        "disk_inner_radius": {"distribution": "truncated normal", "standard_deviation": 0.03},
    },
    "far": {"wall_thickness": {"lower_deviation": -0.3, "upper_deviation": 0.3, "standard_deviation": 0.25}},
    "measured": {"wall_thickness": {"sample": "S"}, "disk_thickness": {"sample": "S", "distribution": "measured"}},
}


@pytest.fixture(scope="module")
def outcome(tmp_path_factory):
    """Return the outcome of a cup in classes of every distribution and process, measured and correlated ones too."""
    path, draw = tmp_path_factory.mktemp("spread") / "submission.xlsx", np.random.default_rng(7)
    measured = []
    for part in range(25):
        common = draw.normal(0, 0.003)
        wall, disk = (size + common + draw.normal(0, 0.003) for size in (1.607, 1.806))
        measured.append(
            {"sample": "S", "part": part, "wall_thickness_mm": float(wall), "disk_thickness_mm": float(disk)}
        )
    tied = [
        {"tolerance_class": "shapes", "dimension_1": one, "dimension_2": other, "correlation": correlation}
        for one, other, correlation in (("wall_thickness", "disk_thickness", 0.6), ("torque", "mean_radius", -0.4))
    ]
    filling = Filling(
        variants=[{**CUP, "variant": name, "tolerance_class": name} for name in PROCESSES],
        tolerances=[row for name, processes in PROCESSES.items() for row in _rows(name, **processes)],
        measurements=measured,
        correlations=tied,
    )
    path.write_bytes(template_bytes(filling))
    found = run(path, samples=256)
    assert len(found.computed) == len(PROCESSES), [one.message for one in found.findings if one.level == "error"]
    return found


@pytest.fixture(scope="module")
def every(outcome):
    """Return the results of Trace spread of each class, and the bytes of its workbook."""
    return [spread_traced(outcome, place) for place in range(len(PROCESSES))]


def _lines(values):
    """Return the lines of the table by dimension, from the values of a sheet."""
    letters = {values[f"{letter}{HEADER + 1}"]: letter for letter in "ABCDEFGHIJKLMNO"}
    lines = {}
    for row in range(HEADER + 2, HEADER + 20):
        if isinstance(name := values.get(f"A{row}"), str) and f"B{row}" in values:
            lines[name] = {head: values.get(f"{letter}{row}") for head, letter in letters.items()}
    return lines


def _stored(data):
    book = openpyxl.load_workbook(io.BytesIO(data), data_only=True)
    return {cell.coordinate: cell.value for row in book["Trace spread"] for cell in row if cell.value is not None}


def test_the_sum_is_the_programs(outcome, every):
    """In every class each s and the first-order sd are the program's to 1e-9; correlated pairs are among them."""
    for one, (found, data) in zip(outcome.computed.values(), every, strict=True):
        expected = one.spread.numbers["first_order_sd"] / ARCMIN
        assert found["first_order_sd"].value == pytest.approx(expected, rel=1e-9), one.variant.name
        assert found["verdict"].value == AGREES, one.variant.name
        assert not [value for value in _stored(data).values() if str(value).startswith("#")]
    assert outcome.computed[min(outcome.computed) + 1].correlation
    squares = [sum(line["(c·s)² [arcmin²]"] for line in _lines(_stored(data)).values()) for _, data in every]
    apart = [
        abs(found["first_order_sd"].value ** 2 / total - 1) > 1e-3
        for (found, _), total in zip(every, squares, strict=True)
    ]
    assert [name for name, is_apart in zip(PROCESSES, apart, strict=True) if is_apart] == ["shapes", "measured"]


def test_a_standard_deviation_follows_from_its_limits(every):
    """Each s is the closed form of its limits and process, and said so in words."""
    shapes, shop = (_lines(_stored(every[place][1])) for place in (1, 2))
    assert shapes["Wall thickness"]["Standard deviation s"] == pytest.approx(0.04 / math.sqrt(12), rel=1e-9)
    assert shapes["Disk thickness"]["Standard deviation s"] == pytest.approx(0.06 / math.sqrt(24), rel=1e-9)
    assert shapes["Cylinder length"]["Standard deviation s"] == pytest.approx(0.4 / 8, rel=1e-9)
    cut = 1 - 2 * math.exp(-0.5) / math.sqrt(2 * math.pi) / math.erf(math.sqrt(0.5))
    assert shapes["Mean radius"]["Standard deviation s"] == pytest.approx(0.05 * math.sqrt(cut), rel=1e-9)
    assert shapes["Mean radius"]["Standard deviation from"] == "width/(2k), k = 1.00, cut"
    assert shapes["Wall thickness"]["Standard deviation from"] == "width/√12"
    assert shop["Wall thickness"]["Standard deviation s"] == pytest.approx(0.0041, rel=1e-9)
    assert shop["Wall thickness"]["Mean"] == pytest.approx(1.607, rel=1e-9)
    assert shop["Disk thickness"]["Standard deviation s"] == pytest.approx(0.06 / 6.6, rel=1e-9)
    assert shop["Disk thickness"]["Standard deviation from"] == "width/(2k), k = 3.30"
    measured = _lines(_stored(every[4][1]))
    assert measured["Wall thickness"]["Standard deviation from"] == "s of S"


def test_slopes_are_those_of_calculus(every):
    """Backlash is proportional to torque, so that its slope is backlash over torque; contributions are c times s."""
    for _, data in every:
        lines, values = _lines(_stored(data)), _stored(data)
        row = next(cell[1:] for cell, value in values.items() if str(value).startswith("Backlash h above"))
        middle = values[f"I{row}"]
        slope = "Slope c of the backlash [arcmin per unit]"
        assert lines["Torque"][slope] == pytest.approx(middle / 800, rel=1e-4)
        for line in lines.values():
            assert line["Contribution c·s [arcmin]"] == pytest.approx(
                line[slope] * line["Standard deviation s"], rel=1e-12
            )


def test_lots_and_parts_make_up_the_whole(outcome, every):
    """Within and between lots are those dimensions alone, squared they make up all; the engine's are near."""
    for one, (found, data) in zip(outcome.computed.values(), every, strict=True):
        whole, within, between = (found[key].value for key in ("first_order_sd", "within_lot_sd", "between_lots_sd"))
        assert within**2 + between**2 == pytest.approx(whole**2, rel=1e-9)
        lots = [line for line in _lines(_stored(data)).values() if line["Scatters between"] == "lots"]
        alone = math.sqrt(sum(line["(c·s)² [arcmin²]"] for line in lots))
        assert between == pytest.approx(alone, rel=1e-9, abs=1e-12)
        assert len(lots) == (one.variant.name == "shop")
        # With walls that scatter by a sixth nothing is first order.
        near = 2 if one.variant.name == "far" else 0.02
        assert one.spread.numbers["within_lot_sd"] / ARCMIN == pytest.approx(within, rel=near)


SHAPES = [
    "refined",
    "taper",
    "power law",
    "tapering cone",
    "wide hub fillet",
    "conical hat",
    "rimmed cylinder",
    "given G",
]


@pytest.mark.long
@pytest.mark.slow
def test_every_slope_of_many_shapes_comes_out_of_the_formulas(tmp_path):
    """Whatever the shape and the dimension, the slope by the formulas of Trace is the program's."""
    path, audited = tmp_path / "shapes.xlsx", 0
    path.write_bytes(
        template_bytes(Filling(variants=rows_of({name: ROWS[name] for name in SHAPES}), materials=MATERIALS))
    )
    outcome = check(path)
    assert len(outcome.computed) == len(SHAPES)
    for one in outcome.computed.values():
        for name in one.limits:
            found = slope_audited(outcome, one, dimension_title(name))
            assert found["slope verdict"].value == AGREES, (one.variant.name, name, found["slope difference"].value)
            audited += 1
    assert audited > 45


@pytest.mark.slow
@needs_libreoffice
def test_stored_values_are_those_of_a_recalculation(every, tmp_path):
    """Every formula of both sheets holds what LibreOffice makes of it."""
    paths = [tmp_path / f"{place}.xlsx" for place in range(len(every))]
    for path, (_, data) in zip(paths, every, strict=True):
        path.write_bytes(data)
    beside = {_cell(found, key) for found, _ in every for key in ("difference", "slope difference")}
    for before, after in zip(paths, convert_all(paths, "xlsx", tmp_path), strict=True):
        for sheet in ("Trace spread", "Trace slope"):
            stored, again = values_of(before, sheet), values_of(after, sheet)
            assert stored.keys() == again.keys()
            assert not error_cells(again)
            for cell, value in stored.items():
                # Differences beside the program's are what rounding leaves.
                least = 1e-9 if cell in beside or cell[0] == "O" else 1e-15
                near = pytest.approx(value, rel=1e-9, abs=least) if isinstance(value, float) else value
                assert again[cell] == near, f"{sheet}!{cell}"


def _cell(found, key):
    return found[key].text.replace("$", "")


@pytest.mark.slow
@needs_libreoffice
def test_a_reader_may_pick_and_change(outcome, every, tmp_path):
    """Another variant, another dimension, half the width of one: each comes to what the program makes of it."""
    found, data = every[0]
    (tmp_path / "report.xlsx").write_bytes(data)
    picks = list(PROCESSES)[1:]
    paths = [typed(tmp_path / "report.xlsx", tmp_path / f"{name}.xlsx", "Trace", {"B3": name}) for name in picks]
    picked = _cell(found, "picked")
    paths.append(typed(tmp_path / "report.xlsx", tmp_path / "other.xlsx", "Trace spread", {picked: "Disk thickness"}))
    rows = {name: row for row, name in enumerate(_lines(_stored(data)), start=HEADER + 2)}
    typing = {f"E{rows['Wall thickness']}": 0.01}
    paths.append(typed(tmp_path / "report.xlsx", tmp_path / "own.xlsx", "Trace spread", typing))
    *others, dimension, own = (values_of(path, "Trace spread") for path in convert_all(paths, "xlsx", tmp_path))
    computed = {one.variant.name: one for one in outcome.computed.values()}
    for name, values in zip(picks, others, strict=True):
        assert values["B4"] == name
        expected = computed[name].spread.numbers["first_order_sd"] / ARCMIN
        assert values[_cell(found, "first_order_sd")] == pytest.approx(expected, rel=1e-9)
        assert [values[_cell(found, key)] for key in ("verdict", "slope verdict")] == [AGREES, AGREES]
    assert dimension[_cell(found, "slope verdict")] == AGREES
    assert dimension[_cell(found, "slope")] == pytest.approx(
        _lines(_stored(data))["Disk thickness"]["Slope c of the backlash [arcmin per unit]"], rel=1e-7
    )
    assert own[_cell(found, "verdict")] == CHANGED
    halved = tmp_path / "halved.xlsx"
    rows = [{**row, "lower_deviation": -0.01, "upper_deviation": 0.01} if row["dimension"] == "wall_thickness" else row
            for row in _rows("plain")]  # fmt: skip
    halved.write_bytes(template_bytes(Filling(variants=[{**CUP, "tolerance_class": "plain"}], tolerances=rows)))
    expected = run(halved, samples=256).results["first_order_sd_arcmin"][0]
    assert own[_cell(found, "first_order_sd")] == pytest.approx(expected, rel=1e-9)


@pytest.mark.slow
@needs_libreoffice
def test_what_cannot_be_picked_has_no_numbers(every, tmp_path):
    """A variant that is not in the list, or a dimension that it does not have, gives no number and no error."""
    found, data = every[0]
    (tmp_path / "report.xlsx").write_bytes(data)
    paths = [
        typed(tmp_path / "report.xlsx", tmp_path / "absent.xlsx", "Trace", {"B3": "absent"}),
        typed(tmp_path / "report.xlsx", tmp_path / "rim.xlsx", "Trace spread", {_cell(found, "picked"): "Rim"}),
    ]
    absent, rim = convert_all(paths, "xlsx", tmp_path)
    for path in (absent, rim):
        assert not error_cells(values_of(path, "Trace spread") | values_of(path, "Trace slope"))
    values = values_of(absent, "Trace spread")
    assert values["B4"] == "pick one on Trace"
    assert values.get(_cell(found, "first_order_sd")) == 0
    assert values_of(rim, "Trace spread").get(_cell(found, "slope")) is None
    assert values_of(rim, "Trace spread")[_cell(found, "verdict")] == AGREES


def test_nothing_that_scatters_is_said(tmp_path):
    """Without any tolerance the sheet says so, and there are no formulas."""
    path = tmp_path / "exact.xlsx"
    rows = [{"tolerance_class": "none", "dimension": "torque", "lower_deviation": 0, "upper_deviation": 0}]
    path.write_bytes(template_bytes(Filling(variants=[{**SOUND, "tolerance_class": "none"}], tolerances=rows)))
    found, data = spread_traced(check(path))
    assert found == {}
    assert "Nothing scatters." in _stored(data).values()


def test_formulas_are_plain(every):
    """Functions are those of Excel 2013, none an array formula; constants have at most 15 digits."""
    book = openpyxl.load_workbook(io.BytesIO(every[1][1]))
    formulas = [
        cell.value
        for title in ("Trace spread", "Trace slope")
        for row in book[title]
        for cell in row
        if cell.data_type == "f"
    ]
    assert len(formulas) > 900
    functions = {name for one in formulas for name in re.findall(r"([A-Z.a-z_]+)\(", one)}
    assert functions <= {
        "ABS", "AND", "COUNTA", "EXP", "FIXED", "IF", "IFERROR", "INDEX", "ISNUMBER", "LN", "MATCH", "MAX", "MIN",
        "OR", "PI", "SIN", "SQRT", "SUM", "_xlfn.NORM.S.DIST",
    }  # fmt: skip
    assert not [one for one in formulas for number in re.findall(r"\d[\d.]*", one) if len(number) > 15]
