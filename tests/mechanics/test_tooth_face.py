"""Teeth that load the cylinder over their face width: closed forms, limits, and two-dimensional elasticity."""

import math
from dataclasses import replace

import numpy as np
import pytest
from flexsplines import B3_160, REFINED, without
from hypothesis import given, settings
from hypothesis import strategies as st

from flexlash.mechanics import windup
from flexlash.mechanics.elasticity.half_section import half_section, section_of
from flexlash.mechanics.elasticity.part import Grading, part_of
from flexlash.mechanics.flexspline import backlash, windups

thorough = settings(deadline=None, max_examples=60, derandomize=True)
UNIT = {"torque": 2 * math.pi, "shear_modulus": 1.0}
RIMMED = B3_160 | {"rim_length": 0.03, "rim_thickness": 0.0032}
shares = st.floats(0.01, 0.99)


def integral(cup):
    """Return the meridian integral of a cup [1/m³]."""
    return sum(windups("cup", without(cup, "torque", "youngs_modulus", "poisson_ratio") | UNIT).values())


def test_the_band_counts_a_third():
    """Where face and rim are equally long the cup winds up by disk, wall without the band, and a third of the rim."""
    mean, wall, rim, band = 0.08, 0.0016, 0.0032, 0.03
    disk = (1 / 0.04**2 - 1 / mean**2) / (2 * wall)
    plain = (0.16 - band) / (mean**3 * wall)
    third = band / 3 / ((mean - wall / 2 + rim / 2) ** 3 * rim)
    assert integral(RIMMED | {"tooth_face_width": band}) == pytest.approx(disk + plain + third, rel=1e-14)


def test_a_blank_face_width_loads_the_open_end():
    """Without a face width there is no tooth band and nothing else changes; a vanishing one changes nothing either."""
    assert "tooth_band" not in windups("cup", REFINED)
    assert integral(REFINED | {"tooth_face_width": 1e-12}) == pytest.approx(integral(REFINED), rel=1e-9)


@thorough
@given(share=shares, wider=st.floats(1.001, 1.5))
def test_a_wider_face_winds_up_less(share, wider):
    """The wider the face, the less the wind-up, on the rim and beyond it."""
    face = share * 0.157
    narrow, wide = (integral(REFINED | {"tooth_face_width": width}) for width in (face, min(face * wider, 0.157)))
    assert wide < narrow


@thorough
@given(share=shares)
def test_the_wind_up_follows_the_face_smoothly_over_the_rim(share):
    """Where the face passes the end of the rim neither the wind-up nor its slope jumps."""
    rim = 0.02 + 0.1 * share
    cup, step = REFINED | {"rim_length": rim}, 1e-6
    below, at, above = (integral(cup | {"tooth_face_width": rim + move}) for move in (-step, 0.0, step))
    assert (at - below) == pytest.approx(above - at, rel=1e-3)


@thorough
@given(share=shares)
def test_a_rim_as_thick_as_the_wall_is_no_rim(share):
    """With a rim of the wall's thickness the wind-up is that without rim, whichever is longer."""
    cup = B3_160 | {"tooth_face_width": 0.16 * share}
    even = cup | {"rim_length": 0.05, "rim_thickness": 0.0016}
    assert integral(even) == pytest.approx(integral(cup), rel=1e-13)


def test_every_number_of_an_array_is_that_of_its_own_cup():
    """A column of face widths on both sides of the rim's end gives the numbers that each cup has alone."""
    faces = np.array([0.001, 0.015, 0.02, 0.021, 0.12])
    column = {name: np.full(5, size) for name, size in REFINED.items()} | {"tooth_face_width": faces}
    alone = [float(backlash("cup", REFINED | {"tooth_face_width": face})) for face in faces.tolist()]
    assert backlash("cup", column).tolist() == alone


def test_tooth_band_as_the_whole_cylinder():
    """Teeth over the whole length of a tube leave a third of its wind-up, in one segment."""
    tube = {"torque": 1.0, "shear_modulus": 1.0, "cylinder_length": 0.3, "mean_radius": 1.0, "wall_thickness": 0.1}
    found = windups("cylinder", tube | {"tooth_face_width": 0.3})
    assert found["wall"] == pytest.approx(0, abs=1e-18)
    assert found["tooth_band"] == pytest.approx(windups("cylinder", tube)["wall"] / 3, rel=1e-14)
    assert windup.tooth_band_integral(0.3, 0.0, 1.0, 0.1, 0.1) == pytest.approx(1.0, rel=1e-15)


# Against elasticity


def random_cups(count, *, has_rim, thickest):
    """Yield cups of usual proportions, with disks of 0.8 walls to so many, that wind up by their integral."""
    generator = np.random.default_rng(19)
    draw = generator.uniform
    for _ in range(count):
        radius = draw(0.015, 0.12)
        wall, length = radius * draw(0.015, 0.025), radius * draw(0.8, 2.2)
        face = length * draw(0.15, 0.4)
        cup = {"mean_radius": radius, "wall_thickness": wall, "cylinder_length": length, "tooth_face_width": face}
        cup |= {"disk_inner_radius": radius * draw(0.4, 0.6), "disk_thickness": wall * draw(0.8, thickest)}
        yield cup | ({"rim_length": face, "rim_thickness": wall * draw(1.5, 2.5)} if has_rim else {}) | UNIT


def elastic(cup):
    """Return the integral of a cup by two-dimensional elasticity, on a mesh whose corners take 1e-4 from it."""
    from flexlash.mechanics.elasticity.twist import unit_twist

    part = replace(part_of("cup", cup), grading=Grading(corner=0.1, smooth=0.3, stop=0.3, longest=math.inf, cells=6))
    return unit_twist(section_of(part)).integral


@pytest.mark.slow
@pytest.mark.parametrize(
    ("has_rim", "thickest", "whole", "change"),
    [(True, 1.5, 0.013, 0.003), (False, 5.0, 0.025, 0.006)],
    ids=["rim, disk to 1.5 walls", "no rim, disk to 5 walls"],
)
def test_random_cups_against_elasticity(has_rim, thickest, whole, change):
    """A hundred cups wind up as by elasticity to so much, and what the face width changes is right to a part of it."""
    pytest.importorskip("skfem", reason="scikit-fem is not installed")
    for cup in random_cups(100, has_rim=has_rim, thickest=thickest):
        at_the_end = without(cup, "tooth_face_width")
        formula, elasticity = (
            np.array([solve(cup), solve(at_the_end)])
            for solve in (lambda size: sum(windups("cup", size).values()), elastic)
        )
        error = formula / elasticity - 1
        assert abs(error[0]) < whole, cup
        assert abs(error[0] - error[1]) < change, cup


@pytest.mark.parametrize("refined", [B3_160, REFINED, RIMMED], ids=["plain", "refined", "rim"])
@pytest.mark.parametrize("face", [0.01, 0.02, 0.03, 0.05, 0.15])
def test_the_loaded_face_of_a_half_section(refined, face):
    """What the teeth load is the outer face over their width, whether it ends on rim or wall, and nothing else."""
    from flexlash.mechanics.elasticity.section_mesh import face_shares

    cup = without(refined, "disk_outer_radius") | {"tooth_face_width": face}
    section = half_section("cup", cup)
    shares = face_shares(section)
    assert shares.sum() == pytest.approx(face, rel=1e-9)
    length, rim = cup["cylinder_length"], cup.get("rim_length", 0.0)
    bore = cup["mean_radius"] - cup["wall_thickness"] / 2
    outside = bore + np.where(section.height > length - rim, cup.get("rim_thickness", 0.0), cup["wall_thickness"])
    loaded = shares > 0
    at_step = np.abs(section.height - (length - rim)) < 1e-9
    assert np.abs(section.radius - outside)[loaded & ~at_step] == pytest.approx(0, abs=1e-9)
    assert section.height[loaded].min() == pytest.approx(length - face, abs=1e-9)
