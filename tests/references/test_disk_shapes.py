"""Disks, cones, rims and hats in closed form.

Source: the meridian integral U = T/(2πG) · ∫ ds/(r³ t) and its closed forms for each shape, with values
recomputed at T = 800 N·m and G = 8.1153846e10 Pa to more than thirty digits.
"""

import math
from fractions import Fraction

import numpy as np
import pytest
from scipy.integrate import quad

from flexlash.mechanics import strength, windup
from flexlash.mechanics.flexspline import windups
from flexlash.mechanics.tapered_disk import tapered_disk_integral

MODULUS = 211e9 / 2.6
INNER, OUTER = 0.040, 0.080


def angle(integral):
    """Return the wind-up [rad] of an integral [1/m³] at 800 N·m."""
    return 800 / (2 * math.pi * MODULUS) * float(integral)


def slow(thickness, inner=INNER, outer=OUTER):
    """Return ∫ dr/(r³ t(r)) by adaptive quadrature."""
    return quad(lambda r: 1 / (r**3 * thickness(r)), inner, outer, epsabs=0, epsrel=1e-12)[0]


def taper_in_closed_form(inner, outer, first, last):
    """Return F(r_o) − F(r_i) of a straight taper t = a + b r."""
    b = (last - first) / (outer - inner)
    a = first - b * inner

    def antiderivative(r):
        return -1 / (2 * a * r**2) + b / (a**2 * r) + b**2 / a**3 * math.log(r / (a + b * r))

    return antiderivative(outer) - antiderivative(inner)


def test_linear_taper_from_4_to_1_6_mm():
    """An annulus 40 → 80 mm that thins from 4.0 to 1.6 mm winds up by 1.2086009619e-4 rad."""
    assert angle(tapered_disk_integral(INNER, OUTER, 0.004, 0.0016)) == pytest.approx(1.2086009619e-4, rel=5e-11)


def test_linear_taper_as_a_disk_of_a_cup():
    """A cup whose disk thins from 4.0 mm at the hub to 1.6 mm has the taper's disk wind-up."""
    cup = {"torque": 800.0, "cylinder_length": 0.16, "mean_radius": OUTER, "wall_thickness": 0.0016}
    cup |= {"disk_inner_radius": INNER, "disk_hub_thickness": 0.004, "shear_modulus": MODULUS}
    assert windups("cup", cup)["disk_body"] == pytest.approx(1.2086009619e-4, rel=5e-11)


def test_mean_thickness_is_no_shortcut_for_a_taper():
    """Calculating the taper 4.0 → 1.6 mm with its mean thickness overstates the wind-up by 8.7 %."""
    taper = tapered_disk_integral(INNER, OUTER, 0.004, 0.0016)
    assert windup.annulus_integral(INNER, OUTER, 0.0028) / taper - 1 == pytest.approx(0.087, abs=5e-4)


@pytest.mark.parametrize(("first", "last"), [(0.004, 0.0016), (0.0016, 0.004), (0.003, 0.002), (0.0005, 0.004)])
def test_linear_taper_in_closed_form(first, last):
    """Tapers that thin or thicken towards the rim agree with the closed form in radii and with quadrature."""
    found = tapered_disk_integral(INNER, OUTER, first, last)
    slope = (last - first) / (OUTER - INNER)
    assert found == pytest.approx(taper_in_closed_form(INNER, OUTER, first, last), rel=1e-11)
    assert found == pytest.approx(slow(lambda r: first + slope * (r - INNER)), rel=1e-12)


@pytest.mark.parametrize("difference", [1e-6, 1e-9, 1e-12, 0.0])
def test_vanishing_taper_is_an_even_annulus(difference):
    """As a taper vanishes its wind-up tends to the even annulus's, where the closed form loses its digits."""
    found = tapered_disk_integral(INNER, OUTER, 0.002 + difference, 0.002)
    even = windup.annulus_integral(INNER, OUTER, 0.002)
    assert found == pytest.approx(float(even), rel=difference / 0.002 + 1e-13)
    assert found <= even * (1 + 1e-13)


@pytest.mark.parametrize(
    ("exponent", "exact"),
    [
        (1, (1 / INNER - 1 / OUTER) / (0.004 * INNER)),
        (2, math.log(2) / (0.004 * INNER**2)),
        (3, (OUTER - INNER) / (0.004 * INNER**3)),
    ],
)
def test_power_law_disks_in_closed_form(exponent, exact):
    """Disks with t = t₁(r_i/r)^n have the three closed forms of n = 1, 2 and 3."""
    assert windup.power_law_disk_integral(INNER, OUTER, 0.004, exponent) == pytest.approx(exact, rel=1e-13)


@pytest.mark.parametrize("exponent", [-1.0, 0.5, 1.999, 2.5, 4.0])
def test_power_law_disks_by_quadrature(exponent):
    """Power laws with any other exponent agree with quadrature."""
    exact = slow(lambda r: 0.004 * (INNER / r) ** exponent)
    assert windup.power_law_disk_integral(INNER, OUTER, 0.004, exponent) == pytest.approx(exact, rel=1e-11)


def test_power_law_with_exponent_zero_is_an_even_annulus():
    """A power law with n = 0 is the even annulus."""
    even = windup.annulus_integral(INNER, OUTER, 0.004)
    assert windup.power_law_disk_integral(INNER, OUTER, 0.004, 0) == pytest.approx(float(even), rel=1e-14)


def test_constant_shear_disk():
    """A disk with t ∝ 1/r² from 4 mm winds up by 1.699207821e-4 rad under one shear stress everywhere."""
    assert angle(windup.power_law_disk_integral(INNER, OUTER, 0.004, 2)) == pytest.approx(1.699207821e-4, rel=3e-10)
    radius = np.linspace(INNER, OUTER, 9)
    stress = strength.shear_stress(800.0, radius, 0.004 * (INNER / radius) ** 2)
    assert stress == pytest.approx(float(stress[0]), rel=1e-14)


@pytest.mark.parametrize("degrees", [10, 30, 45, 80])
def test_cone_is_an_annulus_over_the_sine(degrees):
    """A cone of semi-angle a has the annulus's integral over sin a, by quadrature along its meridian."""
    semi_angle = math.radians(degrees)
    length = (OUTER - INNER) / math.sin(semi_angle)
    along = quad(lambda s: 1 / ((INNER + s * math.sin(semi_angle)) ** 3 * 0.002), 0, length, epsabs=0, epsrel=1e-12)
    flat = windup.annulus_integral(INNER, OUTER, 0.002)
    assert windup.cone_integral(flat, semi_angle) == pytest.approx(along[0], rel=1e-11)


def test_flat_cone_is_an_annulus():
    """A cone of semi-angle 90° is the flat annulus."""
    flat = windup.annulus_integral(INNER, OUTER, 0.002)
    assert windup.cone_integral(flat, math.pi / 2) == flat


@pytest.mark.parametrize("degrees", [30, 60])
def test_tapered_cone_by_quadrature(degrees):
    """A cone that thins from 4.0 to 1.6 mm has the taper's integral over sin a, by quadrature along its meridian."""
    sine = math.sin(math.radians(degrees))
    length = (OUTER - INNER) / sine

    def integrand(s):
        return 1 / ((INNER + s * sine) ** 3 * (0.004 - 0.0024 * s / length))

    along = quad(integrand, 0, length, epsabs=0, epsrel=1e-12)[0]
    taper = tapered_disk_integral(INNER, OUTER, 0.004, 0.0016)
    assert windup.cone_integral(taper, math.radians(degrees)) == pytest.approx(along, rel=1e-11)


def test_cone_of_30_degrees_as_a_disk_of_a_cup():
    """A cup whose disk is a cone at 30° to the axis winds up twice as far in its disk; the wall is the same."""
    cup = {"torque": 800.0, "cylinder_length": 0.16, "mean_radius": OUTER, "wall_thickness": 0.0016}
    cup |= {"disk_inner_radius": INNER, "shear_modulus": MODULUS}
    flat, cone = windups("cup", cup), windups("cup", cup | {"disk_cone_angle": math.pi / 6})
    assert cone["disk_body"] == pytest.approx(2 * float(flat["disk_body"]), rel=1e-14)
    assert cone["wall"] == flat["wall"]


def test_constant_shear_disk_as_a_disk_of_a_cup():
    """A cup whose disk thins as 1/r² from 4.0 mm at the hub has the closed form's disk wind-up."""
    cup = {"torque": 800.0, "cylinder_length": 0.16, "mean_radius": OUTER, "wall_thickness": 0.0016}
    cup |= {"disk_inner_radius": INNER, "disk_hub_thickness": 0.004, "disk_thickness_exponent": 2.0}
    assert windups("cup", cup | {"shear_modulus": MODULUS})["disk_body"] == pytest.approx(1.699207821e-4, rel=3e-10)


def test_even_annulus_in_exact_fractions():
    """An even annulus 40 → 80 mm of 2 mm has exactly (1/r_i² − 1/r_o²)/(2t) = 117 187.5 /m³."""
    exact = (1 / Fraction(40, 1000) ** 2 - 1 / Fraction(80, 1000) ** 2) / (2 * Fraction(2, 1000))
    assert exact == Fraction(234375, 2)
    assert windup.annulus_integral(INNER, OUTER, 0.002) == pytest.approx(117_187.5, rel=1e-14)


def test_tooth_rim_over_the_same_bore():
    """A rim of length b and thickness t_r over the wall's bore has b/((r_i + t_r/2)³ t_r)."""
    exact = Fraction(20, 1000) / ((Fraction(80) + Fraction(32, 20)) ** 3 / 10**9 * Fraction(32, 10_000))
    assert windup.rim_integral(0.020, 0.0808, 0.0016, 0.0032) == pytest.approx(float(exact), rel=1e-14)


def test_hat_flange_is_an_outward_annulus():
    """A hat's flange winds up as the annulus from the mean radius out to the bolt circle."""
    hat = {"torque": 800.0, "cylinder_length": 0.16, "mean_radius": INNER, "wall_thickness": 0.0016}
    hat |= {"disk_thickness": 0.002, "disk_outer_radius": OUTER, "shear_modulus": MODULUS}
    exact = (1 / INNER**2 - 1 / OUTER**2) / (2 * 0.002)
    assert windups("hat", hat)["disk_body"] == pytest.approx(angle(exact), rel=1e-13)
