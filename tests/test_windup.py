"""Each segment's share of the meridian integral, against slow quadrature and against its own shape."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from flexlash.mechanics import windup

thorough = settings(deadline=None, max_examples=60, derandomize=True)

radii = st.floats(0.010, 0.150)
widths = st.floats(0.2, 4.0)
thicknesses = st.floats(0.0003, 0.008)
factors = st.floats(1.0, 3.0)

# Functions whose arguments may be arrays, each with arguments [SI] of a plausible segment.
SEGMENTS = {
    windup.shear_modulus: (211e9, 0.3),
    windup.mean_radius_from_bore: (0.16, 0.0016),
    windup.segment_windup: (800.0, 8.1e10, 1.2e5),
    windup.wall_integral: (0.16, 0.08, 0.0016),
    windup.annulus_integral: (0.04, 0.08, 0.0016),
    windup.cone_integral: (0.04, 0.08, 0.0016, 0.6),
    windup.tapered_disk_integral: (0.04, 0.08, 0.004, 0.0016),
    windup.hub_fillet_integral: (0.04, 0.0035, 0.0016, -0.02),
    windup.junction_fillet_integral: (0.0808, 0.0016, 0.0035),
    windup.rim_integral: (0.02, 0.0808, 0.0016, 0.0032),
}
each_segment = pytest.mark.parametrize(
    ("function", "arguments"), SEGMENTS.items(), ids=[function.__name__ for function in SEGMENTS]
)


def slow(integrand, start, end):
    """Return an integral by adaptive quadrature to about twelve digits."""
    return quad(integrand, start, end, epsabs=0, epsrel=1e-12, limit=500)[0]


def slow_hub_fillet(inner, fillet, first, slope):
    """Return ∫ dr/(r³ t) over a hub fillet, the arc written as in the drawing, in √(r − r_ci)."""

    def integrand(root):
        advance = root * root
        arc = fillet - math.sqrt(max(fillet**2 - (fillet - advance) ** 2, 0.0))
        return 2 * root / ((inner + advance) ** 3 * (first + slope * advance + arc))

    return slow(integrand, 0, math.sqrt(fillet))


def slow_junction_fillet(mean, wall, fillet):
    """Return ∫ dz/(r³ t) over a junction fillet that thickens the wall inwards, in √z."""

    def integrand(root):
        along = root * root
        arc = fillet - math.sqrt(max(fillet**2 - (fillet - along) ** 2, 0.0))
        return 2 * root / ((mean - arc / 2) ** 3 * (wall + arc))

    return slow(integrand, 0, math.sqrt(fillet))


@each_segment
def test_arrays_equal_scalars_bit_for_bit(function, arguments):
    """A call with arrays of shape (variants,) or (variants, draws) equals scalar calls bit for bit."""
    generator = np.random.default_rng(7)
    table = [argument * (1 + 0.1 * generator.random((3, 4))) for argument in arguments]
    together = function(*table)
    assert together.shape == (3, 4)
    for place in np.ndindex(3, 4):
        one = function(*(float(column[place]) for column in table))
        assert one.shape == ()
        assert float(one) == together[place]
    assert np.array_equal(function(*(column[:, 0] for column in table)), together[:, 0])


@each_segment
def test_nominal_column_meets_draws(function, arguments):
    """A dimension that is exact, of shape (variants, 1), meets draws of shape (variants, draws)."""
    generator = np.random.default_rng(8)
    drawn = arguments[0] * (1 + 0.1 * generator.random((2, 5)))
    exact = [np.array([[argument], [argument * 1.01]]) for argument in arguments[1:]]
    found = function(drawn, *exact)
    full = function(drawn, *(np.repeat(column, 5, axis=1) for column in exact))
    assert found.shape == (2, 5)
    assert np.array_equal(found, full)


@thorough
@given(torque=st.floats(0.1, 1e5), modulus=st.floats(1e10, 2e11), integral=st.floats(1.0, 1e7))
def test_windup_is_proportional_to_torque_and_compliance(torque, modulus, integral):
    """Twice the torque winds up twice as far, twice the shear modulus half as far."""
    angle = windup.segment_windup(torque, modulus, integral)
    assert angle == pytest.approx(torque * integral / (modulus * math.tau), rel=1e-14)
    assert windup.segment_windup(2 * torque, modulus, integral) == 2 * angle
    assert windup.segment_windup(torque, 2 * modulus, integral) == angle / 2


@thorough
@given(length=st.floats(0.005, 0.5), radius=radii, thickness=thicknesses, factor=factors)
def test_wall_is_the_thin_tube(length, radius, thickness, factor):
    """A wall winds up as Bredt's tube; longer never less, thicker and wider never more."""
    integral = windup.wall_integral(length, radius, thickness)
    assert integral == pytest.approx(length / (radius**3 * thickness), rel=1e-14)
    assert windup.wall_integral(length * factor, radius, thickness) >= integral
    assert windup.wall_integral(length, radius * factor, thickness) <= integral
    assert windup.wall_integral(length, radius, thickness * factor) <= integral


@pytest.mark.parametrize("ratio", [0.02, 0.1, 0.2])
def test_thin_wall_is_low_by_a_quarter_of_the_ratio_squared(ratio):
    """The thin wall's polar moment is lower than the thick tube's by exactly (Δ/2r_m)²."""
    outer, inner = 1 + ratio / 2, 1 - ratio / 2
    thick = math.pi / 2 * (outer**4 - inner**4)
    thin = math.tau / float(windup.wall_integral(1.0, 1.0, ratio))
    assert thick / thin - 1 == pytest.approx((ratio / 2) ** 2, rel=1e-10)


@thorough
@given(inner=radii, width=widths, thickness=thicknesses, factor=factors)
def test_annulus_by_quadrature(inner, width, thickness, factor):
    """An annulus agrees with quadrature; thicker never winds up more, a larger rim never less."""
    outer = inner * (1 + width)
    integral = windup.annulus_integral(inner, outer, thickness)
    assert integral == pytest.approx(slow(lambda r: 1 / (r**3 * thickness), inner, outer), rel=1e-11)
    assert windup.annulus_integral(inner, outer, thickness * factor) <= integral
    assert windup.annulus_integral(inner, outer * factor, thickness) >= integral


@thorough
@given(inner=radii, width=widths, thickness=thicknesses, angle=st.floats(0.05, math.pi / 2))
def test_cone_never_winds_up_less_than_its_annulus(inner, width, thickness, angle):
    """A cone is longer than the annulus between the same radii, so it never winds up less."""
    outer = inner * (1 + width)
    cone = windup.cone_integral(inner, outer, thickness, angle)
    assert cone >= windup.annulus_integral(inner, outer, thickness)


@thorough
@given(inner=radii, width=st.floats(0.2, 1.0), first=thicknesses, ratio=st.floats(0.4, 2.5))
def test_taper_by_quadrature(inner, width, first, ratio):
    """A straight taper agrees with quadrature to 1e-10 and lies between the even disks of its ends."""
    outer, last = inner * (1 + width), first * ratio
    slope = (last - first) / (outer - inner)
    found = windup.tapered_disk_integral(inner, outer, first, last)
    assert found == pytest.approx(slow(lambda r: 1 / (r**3 * (first + slope * (r - inner))), inner, outer), rel=1e-10)
    ends = sorted(float(windup.annulus_integral(inner, outer, thickness)) for thickness in (first, last))
    assert ends[0] * (1 - 1e-12) <= found <= ends[1] * (1 + 1e-12)


@pytest.mark.parametrize(
    ("inner", "outer", "first", "last", "error"),
    [(0.04, 0.08, 0.004, 0.0016, 1e-12), (0.02, 0.08, 0.004, 0.001, 1e-7)],
)
def test_taper_has_the_stated_quadrature_error(inner, outer, first, last, error):
    """The taper's quadrature error is what its docstring says: 1e-12 for 4 to 1.6 mm, 1e-7 for 4 to 1 mm."""
    slope = (last - first) / (outer - inner)
    exact = slow(lambda r: 1 / (r**3 * (first + slope * (r - inner))), inner, outer)
    assert windup.tapered_disk_integral(inner, outer, first, last) == pytest.approx(exact, rel=error)


@thorough
@given(inner=radii, width=widths, thickness=thicknesses)
def test_taper_without_taper_is_an_annulus(inner, width, thickness):
    """A taper whose two thicknesses are equal is the even annulus to 1e-12."""
    outer = inner * (1 + width)
    even = windup.annulus_integral(inner, outer, thickness)
    assert windup.tapered_disk_integral(inner, outer, thickness, thickness) == pytest.approx(float(even), rel=1e-12)


@thorough
@given(inner=radii, thickness=thicknesses, multiple=st.floats(0.05, 2.0), slope=st.floats(-0.05, 0.05))
def test_hub_fillet_by_quadrature(inner, thickness, multiple, slope):
    """A hub fillet up to twice the disk's thickness agrees with quadrature over the drawn arc to 1e-9."""
    fillet = min(multiple * thickness, inner)
    found = windup.hub_fillet_integral(inner, fillet, thickness, slope)
    assert found == pytest.approx(slow_hub_fillet(inner, fillet, thickness, slope), rel=1e-9)


@pytest.mark.parametrize(("multiple", "error"), [(2, 1e-10), (20, 1e-7)])
def test_hub_fillet_has_the_stated_quadrature_error(multiple, error):
    """The hub fillet's quadrature error is what its docstring says: 1e-10 at R = 2t, 1e-7 at R = 20t."""
    found = windup.hub_fillet_integral(0.04, multiple * 0.0016, 0.0016, 0.0)
    assert found == pytest.approx(slow_hub_fillet(0.04, multiple * 0.0016, 0.0016, 0.0), rel=error)


@thorough
@given(inner=radii, thickness=thicknesses, multiple=st.just(0.0) | st.floats(0.01, 10.0), factor=factors)
def test_hub_fillet_never_adds_windup(inner, thickness, multiple, factor):
    """The ring under a hub fillet never winds up more than the even ring, and a thicker disk never more."""
    fillet = multiple * thickness
    ring = windup.hub_fillet_integral(inner, fillet, thickness, 0.0)
    assert 0 <= ring <= windup.annulus_integral(inner, inner + fillet, thickness) * (1 + 1e-9)
    assert windup.hub_fillet_integral(inner, fillet, thickness * factor, 0.0) <= ring


@thorough
@given(mean=radii, ratio=st.floats(0.005, 0.2), multiple=st.floats(0.05, 2.0))
def test_junction_fillet_by_quadrature(mean, ratio, multiple):
    """A junction fillet up to twice the wall agrees with quadrature over the drawn arc to 1e-9."""
    wall = ratio * mean
    fillet = multiple * wall
    found = windup.junction_fillet_integral(mean, wall, fillet)
    assert found == pytest.approx(slow_junction_fillet(mean, wall, fillet), rel=1e-9)


@thorough
@given(mean=radii, ratio=st.floats(0.005, 0.2), reach=st.just(0.0) | st.floats(0.001, 0.3), factor=st.floats(1.0, 1.5))
def test_junction_fillet_never_adds_windup(mean, ratio, reach, factor):
    """The wall over a junction fillet never winds up more than the plain wall, and a thicker wall never more."""
    wall, fillet = ratio * mean, reach * mean
    ring = windup.junction_fillet_integral(mean, wall, fillet)
    assert 0 <= ring <= windup.wall_integral(fillet, mean, wall) * (1 + 1e-9)
    assert windup.junction_fillet_integral(mean, wall * factor, fillet) <= ring


@thorough
@given(bore=radii, wall=thicknesses, factor=factors, length=st.floats(0.005, 0.1))
def test_rim_never_adds_windup(bore, wall, factor, length):
    """A rim at least as thick as the wall over the same bore never winds up more than the wall it replaces."""
    mean = bore + wall / 2
    rim = windup.rim_integral(length, mean, wall, wall * factor)
    exact = length / ((bore + wall * factor / 2) ** 3 * wall * factor)
    assert rim == pytest.approx(exact, rel=1e-12)
    assert rim <= windup.wall_integral(length, mean, wall) * (1 + 1e-14)


@thorough
@given(inner=radii, width=widths, thickness=thicknesses, exponent=st.floats(-3.0, 6.0))
def test_power_law_by_quadrature(inner, width, thickness, exponent):
    """A disk that thins with any power of the radius agrees with quadrature, also close to n = 2."""
    outer = inner * (1 + width)
    exact = slow(lambda r: (r / inner) ** exponent / (r**3 * thickness), inner, outer)
    assert windup.power_law_disk_integral(inner, outer, thickness, exponent) == pytest.approx(exact, rel=1e-9)


@pytest.mark.parametrize("distance", [1e-6, 1e-9, 1e-12, 1e-15])
def test_power_law_is_continuous_at_constant_shear(distance):
    """A power that is all but 2 winds up as the disk of constant shear stress does."""
    exact = windup.power_law_disk_integral(0.04, 0.08, 0.004, 2)
    for exponent in (2 - distance, 2 + distance):
        near = windup.power_law_disk_integral(0.04, 0.08, 0.004, exponent)
        assert near == pytest.approx(exact, rel=1e-9 + 2 * distance)


@thorough
@given(young=st.floats(1e10, 5e11), poisson=st.floats(0.0, 0.5))
def test_shear_modulus_lies_between_a_third_and_half(young, poisson):
    """The shear modulus is Young's modulus over 2(1 + ν), between a third and half of it."""
    modulus = windup.shear_modulus(young, poisson)
    assert modulus == pytest.approx(young / (2 + 2 * poisson), rel=1e-15)
    assert young / 3 * (1 - 1e-15) <= modulus <= young / 2


@thorough
@given(bore=st.floats(0.01, 0.5), wall=thicknesses)
def test_mean_radius_from_bore_is_half_a_wall_outside_the_bore(bore, wall):
    """The mean radius is the bore's radius and half the wall."""
    assert windup.mean_radius_from_bore(bore, wall) == pytest.approx(bore / 2 + wall / 2, rel=1e-15)
