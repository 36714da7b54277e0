"""Vibration of a load on the flexspline, and the stiffness of whole drives beside it."""

import math

import pytest
from grids import for_each
from hypothesis import given, settings
from hypothesis import strategies as st

from flexlash.mechanics import stiffness
from flexlash.schema import tables

thorough = settings(deadline=None, max_examples=60, derandomize=True)

LEAST = {
    14: 3400.0,
    17: 6700.0,
    20: 11_000.0,
    25: 21_000.0,
    32: 49_000.0,
    40: 180_000.0,
    45: 260_000.0,
    50: 340_000.0,
    58: 540_000.0,
    65: 780_000.0,
    80: 1_450_000.0,
    90: 2_060_000.0,
}
"""Least K3 [N·m/rad] of each size, read off the catalogue."""


GREATEST_PEAK = {
    14: 70.0,
    17: 143.0,
    20: 191.0,
    25: 408.0,
    32: 892.0,
    40: 1530.0,
    45: 2483.0,
    50: 3185.0,
    58: 4459.0,
    65: 6175.0,
    80: 7910.0,
    90: 11_300.0,
}
"""Greatest momentary peak torque [N·m] of each size, read off the catalogue."""

ELSEWHERE = {
    (14, 50): (7, 23, 46),
    (14, 80): (10, 30, 61),
    (17, 50): (21, 44, None),
    (17, 80): (29, 56, 113),
    (17, 100): (31, 70, 143),
    (20, 50): (33, 73, 127),
    (20, 100): (52, 107, 191),
    (25, 100): (87, 204, 369),
    (32, 100): (178, 433, 841),
    (32, 120): (178, 459, 892),
    (40, 100): (345, None, None),
    (45, 100): (459, None, None),
    (65, 100): (1236, None, None),
}
"""Rated, repeated-peak and momentary-peak torque [N·m] by size and ratio in other public lists of the same drives."""


def of_size(size):
    """Return what the catalogue says to a flexspline whose mean diameter is a size times 2.54 mm."""
    return stiffness.catalogue_stiffness(size * 0.00254 / 2)


def test_natural_frequency_of_the_published_case():
    """A load of 1 kg·m² on B3-160 swings at 194.39 Hz."""
    assert stiffness.natural_frequency(1.491835e6, 1.0) == pytest.approx(194.39, abs=0.005)


@thorough
@given(stiff=st.floats(1e2, 1e8), inertia=st.floats(1e-5, 1e3))
def test_natural_frequency_is_that_of_one_mass(stiff, inertia):
    """(2πf)² J is the stiffness; four times the inertia halves the frequency."""
    frequency = stiffness.natural_frequency(stiff, inertia)
    assert (2 * math.pi * frequency) ** 2 * inertia == pytest.approx(stiff, rel=1e-14)
    assert stiffness.natural_frequency(stiff, 4 * inertia) == pytest.approx(frequency / 2, rel=1e-15)


@thorough
@given(frequency=st.floats(0.1, 1e5))
def test_two_ripples_per_turn_meet_the_frequency(frequency):
    """At the resonance speed two ripples per turn of the input come as often as the load swings."""
    turns = stiffness.resonance_speed(frequency) / (2 * math.pi)
    assert 2 * turns == pytest.approx(frequency, rel=1e-15)


def test_resonance_speed_of_the_published_case():
    """194.39 Hz are met at 5832 rpm of the input."""
    assert stiffness.resonance_speed(194.39) * 30 / math.pi == pytest.approx(5831.7, abs=0.05)


@pytest.mark.parametrize(("size", "least"), LEAST.items())
def test_catalogue_stiffness_of_each_size(size, least):
    """Each size of the catalogue has its least K3 over the ratios."""
    assert of_size(size) == (size, least)


def test_the_least_ratio_counts():
    """Where several ratios are listed the table's other K3 of a size are no less, and some are greater."""
    listed = [
        (int(row["size"]), float(row["K3_Nm_per_rad"]))
        for row in tables.rows("catalogue_stiffness")
        if row["K3_Nm_per_rad"]
    ]
    assert {size for size, _ in listed} >= set(LEAST)
    assert all(stiff >= LEAST[size] for size, stiff in listed if size in LEAST)
    assert all((size, least) in listed for size, least in LEAST.items())
    assert sum(stiff > LEAST[size] for size, stiff in listed if size in LEAST) > len(LEAST)


@pytest.mark.parametrize(
    ("size", "nearest"),
    [(15.4, 14), (15.5 - 1e-6, 14), (15.5 + 1e-6, 17), (18.4, 17), (18.6, 20), (36.1, 40), (84.9, 80), (94.9, 90)],
)
def test_the_nearest_size_counts(size, nearest):
    """A flexspline between two sizes is compared with the nearer one."""
    assert of_size(size) == (nearest, LEAST[nearest])


@pytest.mark.parametrize("size", [1, 13.9, 13.9999, 14 - 1e-6, 100 + 1e-6, 100.001, 101, 157.5, 1e9])
def test_outside_the_catalogue_nothing_is_compared(size):
    """Below size 14 and above size 100 the catalogue says nothing."""
    assert of_size(size) is None


@pytest.mark.parametrize("radius", [0.01778, 0.014 * 1.27, 14 * 0.00127, 14 * 2.54 / 2 / 1000])
def test_size_14_in_decimals(radius):
    """The smallest size belongs to the catalogue, whatever the last binary digit of its radius."""
    assert stiffness.catalogue_stiffness(radius) == (14, 3400.0)


@pytest.mark.parametrize("radius", [math.nan, math.inf])
def test_a_radius_that_is_none_is_compared_with_nothing(radius):
    """Not-a-number and infinity have no size."""
    assert stiffness.catalogue_stiffness(radius) is None


@pytest.mark.parametrize("size", [95 + 1e-6, 99, 100 - 1e-6, 100, 100 + 1e-12])
def test_a_size_without_a_listed_stiffness_is_compared_with_nothing(size):
    """Size 100 stands in the catalogue without K3, so nothing near it is compared, with no smaller size either."""
    assert of_size(size) is None


@pytest.mark.parametrize(("size", "found"), [(100, (100, 5.0)), (100 + 1e-6, None), (90, None), (14, (14, 3.0))])
def test_the_greatest_size_belongs_to_the_catalogue(monkeypatch, size, found):
    """Were K3 of the greatest size listed it would count, just up to that size; a blank between others would not."""
    monkeypatch.setattr(stiffness, "_least_stiffness", lambda: {14: 3.0, 90: None, 100: 5.0})
    assert of_size(size) == found


def test_a_blank_beside_a_listed_ratio_is_passed_over(monkeypatch):
    """The least K3 of a size is taken over the ratios that list one, in whatever order they stand."""
    texts = [("14", ""), ("14", "7"), ("14", "5"), ("17", "9"), ("17", ""), ("20", "")]
    listed = tuple({"size": size, "K3_Nm_per_rad": text} for size, text in texts)
    monkeypatch.setattr(tables, "rows", lambda _: listed)
    monkeypatch.setattr(stiffness, "_least_stiffness", stiffness._least_stiffness.__wrapped__)
    assert [of_size(size) for size in (14, 17, 20)] == [(14, 5.0), (17, 9.0), None]


def test_a_smaller_radius_counts_with_its_cube():
    """A drive's stiffness at a smaller radius than its own goes as the cube; a greater radius adds nothing."""
    drive = stiffness.WholeDrive(size=80, stiffness=1.45e6)
    assert drive.at_radius(80 * 2.54e-3 / 2) == pytest.approx(1.45e6, rel=1e-12)
    assert drive.at_radius(0.0925) == pytest.approx(1.45e6 * (185 / 203.2) ** 3, rel=1e-12)
    assert drive.at_radius(0.11) == 1.45e6


@pytest.mark.parametrize(("size", "torque"), GREATEST_PEAK.items())
def test_torque_of_the_nearest_size(size, torque):
    """Each size, and a radius a little beside it, has the greatest momentary peak of that size."""
    for beside in (size, max(14, size - 0.4), min(90, size + 0.4)):
        assert stiffness.catalogue_torque(beside * 0.00254 / 2) == (size, torque)


def test_torques_agree_with_other_lists():
    """The catalogue's torques are those of other public lists, and rise from rated over repeated to momentary peak."""
    listed = {
        (int(row["size"]), int(row["ratio"])): tuple(
            float(row[f"{name}_Nm"]) for name in ("rated", "repeated_peak", "momentary_peak")
        )
        for row in tables.rows("catalogue_torque")
    }
    assert all(rated < repeated < momentary for rated, repeated, momentary in listed.values())
    for drive, torques in ELSEWHERE.items():
        for one, other in zip(listed[drive], torques, strict=True):
            assert other in {None, one}, drive


@for_each("row", tables.rows("catalogue_torque"))
def test_no_listed_torque_is_above_the_limit(row):
    """No rated or repeated-peak torque of the catalogue is above the limit that its size has."""
    size, torque = stiffness.catalogue_torque(int(row["size"]) * 0.00254 / 2)
    assert size == int(row["size"])
    assert float(row["rated_Nm"]) < float(row["repeated_peak_Nm"]) < torque


@pytest.mark.parametrize("size", [0, 13.9, 90.1, 1e300, math.inf, math.nan])
def test_no_torque_beyond_the_catalogue(size):
    """Outside sizes 14 to 90 no drive is listed."""
    assert stiffness.catalogue_torque(size * 0.00254 / 2) is None


def test_greatest_torque_where_ratios_differ(monkeypatch):
    """The greatest peak over the ratios counts, a blank does not, and a size without any says nothing."""
    rows = [("20", "25"), ("20", ""), ("20", "30"), ("40", "")]
    listed = [{"size": size, "momentary_peak_Nm": torque} for size, torque in rows]
    monkeypatch.setattr(tables, "rows", lambda _: listed)
    stiffness._greatest_torque.cache_clear()
    assert stiffness.catalogue_torque(0.0254) == (20, 30.0)
    assert stiffness.catalogue_torque(0.0508) is None
    stiffness._greatest_torque.cache_clear()


# By hand from the catalogue: size, 4 % of a rated torque [N·m], 2 M/K1 in arcmin with the least K1 of the size.
LOST_MOTION = [
    (14, 0.28, 2 * 0.28 / 1900 * 10800 / math.pi),
    (32, 4.0, 1.1459155903),
    (65, 32.0, 0.5000358939),
    (100, 140.0, 0.5941784542),
]


@pytest.mark.parametrize(("size", "torque", "arcmin"), LOST_MOTION)
def test_lost_motion_of_whole_drives(size, torque, arcmin):
    """The drive of the nearest size loses 2 M/K1 on its softest ratio, K1 1900, 24 000, 440 000 and 1 620 000."""
    for beside in (size, max(14, size - 0.4), min(100, size + 0.4)):
        found = stiffness.drive_lost_motion(beside * 0.00254 / 2, torque)
        assert found * 10800 / math.pi == pytest.approx(arcmin, rel=1e-9)


@pytest.mark.parametrize(("size", "most"), [(14, 2.0), (32, 29.0), (65, 235.0), (100, 843.0)])
def test_no_lost_motion_beyond_the_first_slope(size, most):
    """Up to T1 the catalogue says what a drive loses, beyond it and outside its sizes it does not."""
    assert stiffness.drive_lost_motion(size * 0.00127, most) is not None
    assert stiffness.drive_lost_motion(size * 0.00127, math.nextafter(most, math.inf)) is None
    for outside in (13.9, 100.1, math.nan, math.inf):
        assert stiffness.drive_lost_motion(outside * 0.00127, 1.0) is None
