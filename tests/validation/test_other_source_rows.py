"""A row of Other sources becomes a source in SI, or a finding at the cell that contradicts another."""

from __future__ import annotations

import math

import pytest
from decided_drives import CASE_3, CYLINDER, SOURCES
from decided_rows import told, validated

from flexlash.reading.raw import RawSheet, Submission
from flexlash.schema.decision_rows import OtherSource
from flexlash.validation.validate import validate

ARCMIN = math.pi / 10800
MM = {"source": "play", "enter_as": "mm at radius", "value_arcmin": 0.01, "radius_mm": 80.0}
RADIAL = MM | {"enter_as": "mm radial play"}
ANGLE = {"source": "play", "value_arcmin": 5.0}
BOTH = {"lower_deviation": -1.0, "upper_deviation": 1.0}


def _found(*rows):
    return validated(other_sources=rows)


def test_sources_in_si():
    """Plays become m or rad as Enter as says, radii m, the pressure angle rad; blank cells take their default."""
    sources = _found(*SOURCES).other_sources
    assert [one.name for one in sources] == ["tooth clearance", "output bearing", "coupling", "runout"]
    clearance, bearing, coupling, runout = sources
    close = pytest.approx
    assert (clearance.value, clearance.lower, clearance.upper) == (close(1e-5), close(-1e-5), close(1e-5))
    assert (clearance.radius, clearance.pressure_angle, clearance.enter_as) == (close(0.08), None, "mm at radius")
    assert (bearing.value, bearing.pressure_angle) == (close(2.5e-6), close(math.radians(20)))
    assert (bearing.distribution, bearing.limits_sigma) == ("uniform", 3.0)
    assert (coupling.value, coupling.lower, coupling.upper) == (
        close(10 * ARCMIN),
        close(-10 * ARCMIN),
        close(10 * ARCMIN),
    )
    assert (coupling.side, coupling.ratio, coupling.radius, coupling.limits_sigma) == ("input", 100.0, None, 2.0)
    assert (runout.kind, runout.value, runout.lower, runout.upper) == (
        "random",
        0.0,
        close(-0.1 * ARCMIN),
        close(0.1 * ARCMIN),
    )
    assert (runout.enter_as, runout.side, runout.ratio, runout.row) == ("arcmin", "output", 1.0, 5)


def test_a_pressure_angle_of_its_own():
    """An entered pressure angle goes before the default."""
    (source,) = _found(RADIAL | {"pressure_angle_deg": 30.0}).other_sources
    assert source.pressure_angle == pytest.approx(math.pi / 6)


def test_a_blank_row_is_its_defaults():
    """A name and a value are enough."""
    assert _found(ANGLE).other_sources == (OtherSource(row=2, name="play", value=5.0 * ARCMIN),)


FAULTS = [
    (MM | {"radius_mm": None}, ("E201", "radius_mm")),
    (RADIAL | {"radius_mm": None}, ("E201", "radius_mm")),
    (ANGLE | {"radius_mm": 80.0}, ("E362", "radius_mm")),
    (MM | {"pressure_angle_deg": 20.0}, ("E362", "pressure_angle_deg")),
    (ANGLE | {"pressure_angle_deg": 20.0}, ("E362", "pressure_angle_deg")),
    (ANGLE | {"side": "input"}, ("E201", "ratio")),
    (ANGLE | {"ratio": 100.0}, ("E362", "ratio")),
    (ANGLE | {"side": "output", "ratio": 100.0}, ("E362", "ratio")),
    (ANGLE | {"side": "input", "ratio": 0.99}, ("E207", "ratio")),
    (ANGLE | {"lower_deviation": -1.0}, ("E201", "upper_deviation")),
    (ANGLE | {"upper_deviation": 0.0}, ("E201", "lower_deviation")),
    (ANGLE | {"lower_deviation": 1.0, "upper_deviation": -1.0}, ("E318", "lower_deviation")),
    (ANGLE | {"value_arcmin": -1.0}, ("E207", "value_arcmin")),
    ({"source": "play", "side": "output"}, ("E363", "value_arcmin")),
    (ANGLE | {"kind": "random", "value_arcmin": None}, ("E363", "lower_deviation")),
    ({"source": "play", "lower_deviation": -1.0, "upper_deviation": 0.9}, ("E364", "lower_deviation")),
    (ANGLE | {"enter_as": "inch"}, ("E209", "enter_as")),
    (ANGLE | {"value_arcmin": "5 arcmin"}, ("E202", "value_arcmin")),
    (ANGLE | {"source": None, "side": "output"}, ("E201", "source")),
]


@pytest.mark.parametrize(("row", "fault"), FAULTS)
def test_a_fault_is_one_error_at_its_cell(row, fault):
    """Each contradiction is told once; the sources are then no budget, the variants are computed all the same."""
    found = _found(ANGLE | {"source": "another"}, row)
    assert told(found) == [(*fault, 3)]
    assert [one.name for one in found.other_sources] == ["another"]
    assert found.sources_are_faulty
    assert len(found.variants) == 2
    assert not found.blocked.everything


WARNINGS = [
    (ANGLE | {"kind": "random", **BOTH}, [("W461", "value_arcmin")]),
    (ANGLE | BOTH | {"distribution": "uniform", "limits_sigma": 3.0}, [("W461", "limits_sigma")]),
    (ANGLE | {"distribution": "uniform"}, [("W461", "distribution")]),
    (ANGLE | {"distribution": "normal", "limits_sigma": 2.0}, [("W461", "distribution"), ("W461", "limits_sigma")]),
    (ANGLE | {"lower_deviation": -5.1, "upper_deviation": 1.0}, [("W462", "lower_deviation")]),
    ({"source": "play", **BOTH}, [("W462", "lower_deviation")]),
    (ANGLE | {"value_arcmin": 601.0}, [("W440", "value_arcmin")]),
    (MM | {"value_arcmin": 20.0}, [("W440", "value_arcmin")]),
    (MM | {"lower_deviation": 0.0, "upper_deviation": 5.0}, [("W440", "upper_deviation")]),
    (ANGLE | {"side": "input", "ratio": 4.0}, [("W440", "ratio")]),
    (RADIAL | {"pressure_angle_deg": 10.0}, [("W440", "pressure_angle_deg")]),
]


@pytest.mark.parametrize(("row", "warnings"), WARNINGS)
def test_what_is_odd_is_a_warning(row, warnings):
    """What takes no part or looks mistaken is told and used as entered."""
    found = _found(row)
    assert told(found) == [(*one, 2) for one in warnings]
    assert len(found.other_sources) == 1
    assert not found.sources_are_faulty


SOUND = [
    ANGLE | {"lower_deviation": -5.0, "upper_deviation": 5.0},
    MM | {"value_arcmin": 0.3, "lower_deviation": -0.3, "upper_deviation": 0.1},
    {"source": "play", "kind": "random", "lower_deviation": -2.0, "upper_deviation": 1.0},
    {"source": "play", "lower_deviation": 0.0, "upper_deviation": 0.0},
    ANGLE | {"value_arcmin": 0.0, "kind": "random", **BOTH},
    {"source": "play", "lower_deviation": 0.1, "upper_deviation": 0.3, "distribution": "triangular"},
]


@pytest.mark.parametrize("row", SOUND)
def test_nothing_sound_is_blamed(row):
    """A least play of 0, deviations alone, a random source about 0 and an exact one have no finding."""
    found = _found(row)
    assert (told(found), len(found.other_sources), found.sources_are_faulty) == ([], 1, False)


def test_a_source_named_twice():
    """Both rows of one name are told with each other, whatever the letters; neither counts."""
    found = _found(ANGLE, ANGLE | {"source": "Play "}, ANGLE | {"source": "plate"})
    assert [one for one in told(found) if one[0] == "E361"] == [("E361", "source", 2), ("E361", "source", 3)]
    assert "is also in A3" in next(one.message for one in found.findings if one.code == "E361")
    assert [one.name for one in found.other_sources] == ["plate"]
    assert found.sources_are_faulty


def test_a_sum_below_the_sources_is_none():
    """A row called Total is told as not read, so that nothing counts twice; a source called Key is one."""
    found = _found(ANGLE, {"source": "Key", "value_arcmin": 1.0}, {"source": "Total", "value_arcmin": 6.0})
    assert told(found) == [("W433", "", 4)]
    assert [one.name for one in found.other_sources] == ["play", "Key"]
    assert not found.sources_are_faulty


def test_a_source_without_any_number_is_no_remark():
    """A name of many words without a number is told as a source that lacks it, not passed over."""
    found = _found({"source": "radial play of the output bearing"})
    assert told(found) == [("E363", "value_arcmin", 2)]
    assert found.sources_are_faulty


def test_a_misspelt_header_over_values_leaves_no_budget():
    """Values under a header that is not understood cannot be left out: no budget, but every variant."""
    sheets = {
        "Variants": RawSheet(
            name="Variants", rows={1: dict(enumerate(CASE_3, 1)), 2: dict(enumerate(CASE_3.values(), 1))}
        ),
        "Other sources": RawSheet(
            name="Other sources",
            rows={1: {1: "Source", 2: "Play", 3: "Enter as"}, 2: {1: "play", 2: 5.0, 3: "arcmin"}},
        ),
    }
    found = validate(Submission(name="a.xlsx", sha256="", kind="workbook", sheets=sheets))
    assert [one.code for one in found.findings if one.level == "error"] == ["E112"]
    assert found.sources_are_faulty
    assert len(found.variants) == 1


@pytest.mark.parametrize("sources", [None, []])
def test_a_system_limit_without_sources_is_told_once(sources):
    """The limit of a whole drive is not judged without sources: told at the header, not row by row."""
    sheets = {} if sources is None else {"other_sources": sources}
    variants = [CASE_3, CYLINDER | {"system_limit_arcmin": 5.0}]
    assert told(validated(variants, **sheets)) == [("W466", "system_limit_arcmin", 1)]
    assert told(validated(variants, other_sources=[ANGLE])) == []
    assert told(validated([CYLINDER], **sheets)) == []
