"""The torsional stiffness of a thin cup in an independent public model, to its printed digits.

Source: a public model of another maker: mean radius R 20 mm, wall 0.4 mm, length l 30 mm, disk 2.0 mm, hub radius
r_ci 11 mm, shear modulus G 76.9 GPa. It states K_cylinder 5.153887e7, K_disk 3.352798e8 and both in series
4.467195e7 N·mm/rad. The half-section is plain: no fillets and no rim.
"""

import pytest

from flexlash.mechanics.flexspline import backlash, windups

CUP = {
    "torque": 1.0,
    "cylinder_length": 0.030,
    "mean_radius": 0.020,
    "wall_thickness": 0.0004,
    "disk_thickness": 0.0020,
    "disk_inner_radius": 0.011,
    "shear_modulus": 76.9e9,
}
CYLINDER, DISK, SERIES = 5.153887e4, 3.352798e5, 4.467195e4
"""Torsional stiffness [N·m/rad]: the printed N·mm/rad over 1000."""


def stiffness(kind="cup", **changes):
    """Return the stiffness [N·m/rad] of each segment."""
    dimensions = CUP | changes
    return {segment: dimensions["torque"] / float(angle) for segment, angle in windups(kind, dimensions).items()}


def test_cylinder_and_disk_stiffness():
    """Wall and disk have the stiffness that the public model prints for each."""
    found = stiffness()
    assert set(found) == {"wall", "disk_body"}
    assert found["wall"] == pytest.approx(CYLINDER, abs=0.005)
    assert found["disk_body"] == pytest.approx(DISK, abs=0.05)


def test_series_stiffness():
    """The whole cup has the series stiffness that the public model prints."""
    assert 1 / sum(1 / part for part in stiffness().values()) == pytest.approx(SERIES, abs=0.005)
    assert 2 / float(backlash("cup", CUP)) == pytest.approx(SERIES, abs=0.005)


def test_printed_stiffnesses_are_in_series():
    """The three printed stiffnesses agree with one another to their last digit."""
    assert pytest.approx(SERIES, abs=0.01) == CYLINDER * DISK / (CYLINDER + DISK)


@pytest.mark.parametrize("torque", [0.5, 8.0, 100.0])
def test_stiffness_does_not_depend_on_the_torque(torque):
    """The stiffness is the same at any torque."""
    assert stiffness(torque=torque) == pytest.approx(stiffness(), rel=1e-14)


def test_cylinder_type_has_the_cylinder_stiffness_alone():
    """The same tube without a disk has the public model's cylinder stiffness."""
    assert stiffness("cylinder") == pytest.approx({"wall": CYLINDER}, abs=0.005)


def test_blank_disk_thickness_is_the_wall():
    """A disk as thin as the wall, left blank, is five times as soft as the model's of 2.0 mm."""
    blank = {name: size for name, size in CUP.items() if name != "disk_thickness"}
    disk = CUP["torque"] / float(windups("cup", blank)["disk_body"])
    assert disk == pytest.approx(DISK / 5, abs=0.01)
