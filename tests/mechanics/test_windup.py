"""Each segment's share of the meridian integral, against slow quadrature and against its own shape."""

import math

import numpy as np
import pytest
from grids import for_each
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from flexlash.mechanics import fillets, windup
from flexlash.mechanics.tapered_disk import tapered_disk_integral

thorough = settings(deadline=None, max_examples=60, derandomize=True)

radii = st.floats(0.010, 0.150)
widths = st.floats(0.2, 4.0)
thicknesses = st.floats(0.0003, 0.008)
factors = st.floats(1.0, 3.0)


def tapered_hub_fillet(inner, fillet, first, slope):
    """Return the integral of a hub fillet on a disk that thins in a straight line from its thickness at the hub."""
    return fillets.hub_fillet_integral(inner, fillet, lambda radius: first + slope * (radius - inner))


# Functions whose arguments may be arrays, each with arguments [SI] of a plausible segment.
SEGMENTS = {
    windup.shear_modulus: (211e9, 0.3),
    windup.mean_radius_from_bore: (0.16, 0.0016),
    windup.segment_windup: (800.0, 8.1e10, 1.2e5),
    windup.wall_integral: (0.16, 0.08, 0.0016),
    windup.annulus_integral: (0.04, 0.08, 0.0016),
    windup.cone_integral: (1.5e5, 0.6),
    windup.power_law_disk_integral: (0.04, 0.08, 0.004, 2.0),
    tapered_disk_integral: (0.04, 0.08, 0.004, 0.0016),
    tapered_hub_fillet: (0.04, 0.0035, 0.0016, -0.02),
    fillets.junction_fillet_integral: (0.0808, 0.0016, 0.0035),
    windup.rim_integral: (0.02, 0.0808, 0.0016, 0.0032),
    windup.face_on_rim: (0.03, 0.02),
    windup.tooth_band_integral: (0.03, 0.02, 0.0808, 0.0016, 0.0032),
}
each_segment = pytest.mark.parametrize(
    ("function", "arguments"), SEGMENTS.items(), ids=[function.__name__ for function in SEGMENTS]
)


def slow(integrand, start, end):
    """Return an integral by adaptive quadrature to about twelve digits."""
    return quad(integrand, start, end, epsabs=0, epsrel=1e-12, limit=500)[0]


def slow_hub_fillet(inner, fillet, thickness_at):
    """Return ∫ dr/(r³ t) over a hub fillet, the arc written as in the drawing, in √(r − r_ci)."""

    def integrand(root):
        advance = root * root
        arc = fillet - math.sqrt(max(fillet**2 - (fillet - advance) ** 2, 0.0))
        return 2 * root / ((inner + advance) ** 3 * (thickness_at(inner + advance) + arc))

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
        assert np.shape(one) == ()
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
@given(flat=st.floats(1.0, 1e7), angle=st.floats(0.05, math.pi / 2))
def test_cone_winds_up_as_its_flat_disk_over_the_sine(flat, angle):
    """A cone is longer than the flat disk between the same radii by its sine, so it never winds up less."""
    cone = windup.cone_integral(flat, angle)
    assert cone == pytest.approx(flat / math.sin(angle), rel=1e-15)
    assert cone >= flat


def test_cone_of_a_right_angle_is_the_flat_disk():
    """A cone of semi-angle 90° has the very bits of the flat disk."""
    assert windup.cone_integral(1.2345678901234567e5, math.pi / 2) == 1.2345678901234567e5


def slow_taper(inner, outer, first, last):
    """Return ∫ dr/(r³ t) of a straight taper by twenty Gauss points in each of fifty pieces of log r."""
    slope = (last - first) / (outer - inner)
    edges = np.linspace(0, math.log(outer / inner), 51)
    nodes, weights = np.polynomial.legendre.leggauss(20)
    half = np.diff(edges)[:, None] / 2
    radius = inner * np.exp((edges[:-1, None] + edges[1:, None]) / 2 + half * nodes)
    return math.fsum((half * weights / (radius * radius * (first + slope * (radius - inner)))).flat)


RATIOS = np.geomspace(1.05, 20, 12)
"""Outer over inner radius of a disk."""


@for_each("radius_ratio", RATIOS)
@for_each("thickness_ratio", [*np.geomspace(0.05, 20, 15), 0.999, 1.0, 1.001])
def test_taper_by_quadrature(radius_ratio, thickness_ratio):
    """A straight taper agrees with quadrature to 1e-13 and lies between the even disks of its ends."""
    inner, outer, first, last = 0.04, 0.04 * radius_ratio, 0.004, 0.004 * thickness_ratio
    found = float(tapered_disk_integral(inner, outer, first, last))
    assert found == pytest.approx(slow_taper(inner, outer, first, last), rel=1e-13)
    ends = sorted(float(windup.annulus_integral(inner, outer, thickness)) for thickness in (first, last))
    assert ends[0] * (1 - 1e-13) <= found <= ends[1] * (1 + 1e-13)


@for_each("radius_ratio", RATIOS)
@for_each("off", [0.0, 1e-15, 1e-9, -1e-5, 1e-2, -0.0999, 0.0999, -0.1, 0.1, -0.1001, 0.1001, 0.15])
def test_taper_close_to_a_thickness_that_grows_with_the_radius(radius_ratio, off):
    """A disk whose thickness is proportional to the radius, or nearly so, agrees with quadrature to 1e-13."""
    inner, outer, first, last = 0.04, 0.04 * radius_ratio, 0.004, 0.004 * radius_ratio * (1 + off)
    found = float(tapered_disk_integral(inner, outer, first, last))
    assert found == pytest.approx(slow_taper(inner, outer, first, last), rel=1e-13)


@for_each("radius_ratio", RATIOS)
def test_taper_of_a_thickness_proportional_to_the_radius(radius_ratio):
    """A thickness b r winds up by (1/r_i³ − 1/r_o³)/(3 b)."""
    inner, outer = 0.04, 0.04 * radius_ratio
    exact = (1 / inner**3 - 1 / outer**3) / (3 * 0.1)
    assert tapered_disk_integral(inner, outer, 0.1 * inner, 0.1 * outer) == pytest.approx(exact, rel=1e-13)


def test_taper_of_no_width_winds_up_nothing():
    """A disk that ends where it starts, as beneath a fillet of its whole width, has an integral of 0."""
    assert tapered_disk_integral(0.04, 0.04, 0.004, 0.004) == 0
    assert tapered_disk_integral(0.04, 0.04, 0.004, 0.004 * (1 + 2e-16)) == 0


@thorough
@given(inner=radii, width=widths, thickness=thicknesses)
def test_taper_without_taper_is_an_annulus(inner, width, thickness):
    """A taper whose two thicknesses are equal is the even annulus to 1e-13."""
    outer = inner * (1 + width)
    even = windup.annulus_integral(inner, outer, thickness)
    assert tapered_disk_integral(inner, outer, thickness, thickness) == pytest.approx(float(even), rel=1e-13)


@thorough
@given(inner=radii, thickness=thicknesses, multiple=st.floats(0.05, 2.0), slope=st.floats(-0.05, 0.05))
def test_hub_fillet_by_quadrature(inner, thickness, multiple, slope):
    """A hub fillet up to twice the disk's thickness agrees with quadrature over the drawn arc to 1e-9."""
    fillet = min(multiple * thickness, inner)

    def tapered(radius):
        return thickness + slope * (radius - inner)

    found = fillets.hub_fillet_integral(inner, fillet, tapered)
    assert found == pytest.approx(slow_hub_fillet(inner, fillet, tapered), rel=1e-9)


@pytest.mark.parametrize(("greatest", "error"), [(2.0, 1e-9), (10.0, 3e-8)])
@thorough
@given(inner=radii, thickness=thicknesses, share=st.floats(0.01, 1.0), exponent=st.floats(0.0, 10.0))
def test_hub_fillet_on_a_power_law_disk_by_quadrature(greatest, error, inner, thickness, share, exponent):  # noqa: PLR0917
    """On a power-law disk a hub fillet up to twice, or 10 times, its least thickness agrees with quadrature."""
    fillet = min(share * greatest * thickness * 0.8**exponent, inner / 4)

    def power_law(radius):
        return thickness * (inner / radius) ** exponent

    found = fillets.hub_fillet_integral(inner, fillet, power_law)
    assert found == pytest.approx(slow_hub_fillet(inner, fillet, power_law), rel=error)


def test_hub_fillet_follows_the_thickness_of_the_disk():
    """A disk that is thicker outwards winds up less beneath its hub fillet than an even one."""
    even = fillets.hub_fillet_integral(0.04, 0.0035, lambda _: 0.0016)
    rising = fillets.hub_fillet_integral(0.04, 0.0035, lambda radius: 0.0016 + (radius - 0.04))
    assert rising == pytest.approx(slow_hub_fillet(0.04, 0.0035, lambda radius: 0.0016 + (radius - 0.04)), rel=1e-10)
    assert rising < 0.75 * even


@pytest.mark.parametrize(("multiple", "error"), [(2, 1e-10), (20, 1e-7)])
def test_hub_fillet_has_the_stated_quadrature_error(multiple, error):
    """The hub fillet's quadrature error is what its docstring says: 1e-10 at R = 2t, 1e-7 at R = 20t."""
    found = fillets.hub_fillet_integral(0.04, multiple * 0.0016, lambda _: 0.0016)
    assert found == pytest.approx(slow_hub_fillet(0.04, multiple * 0.0016, lambda _: 0.0016), rel=error)


@thorough
@given(inner=radii, thickness=thicknesses, multiple=st.just(0.0) | st.floats(0.01, 10.0), factor=factors)
def test_hub_fillet_never_adds_windup(inner, thickness, multiple, factor):
    """The ring under a hub fillet never winds up more than the even ring, and a thicker disk never more."""
    fillet = multiple * thickness
    ring = fillets.hub_fillet_integral(inner, fillet, lambda _: thickness)
    assert 0 <= ring <= windup.annulus_integral(inner, inner + fillet, thickness) * (1 + 1e-9)
    assert fillets.hub_fillet_integral(inner, fillet, lambda _: thickness * factor) <= ring


@pytest.mark.parametrize("multiple", [20.1, 50, 200, 1000])
def test_a_wide_hub_fillet_takes_the_fine_rule(multiple):
    """Beyond twenty thicknesses the hub fillet is integrated to 1e-9, and its neighbours keep their bits."""
    thickness = 0.03 / multiple
    found = fillets.hub_fillet_integral(np.array([0.04, 0.04]), np.array([0.03, thickness]), lambda _: thickness)
    exact = quad(
        lambda q: 0.03 * np.sin(q) / ((0.04 + 0.03 * (1 - np.cos(q))) ** 3 * (thickness + 0.03 * (1 - np.sin(q)))),
        0,
        np.pi / 2,
        epsabs=0,
        epsrel=1e-11,
        limit=500,
    )[0]
    assert found[0] == pytest.approx(exact, rel=1e-9)
    assert found[1] == fillets.hub_fillet_integral(0.04, thickness, lambda _: thickness)


@pytest.mark.parametrize("ratio", [0.003, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2])
@pytest.mark.parametrize(
    ("multiples", "error"),
    [((1e-6, 0.01, 0.1, 0.3, 0.6, 1, 1.5, 2, 2.5, 3), 1e-9), ((4, 5, 7, 10, 14, 17, 20), 1e-6)],
    ids=["up to 3 walls", "up to 20 walls"],
)
def test_junction_fillet_has_the_stated_error(ratio, multiples, error):
    """Within the bore the error is what the docstring says: 1e-9 up to R = 3Δ and 1e-6 up to R = 20Δ."""
    wall = ratio * 0.08
    radii = [multiple * wall for multiple in multiples if multiple * wall <= 0.08 - wall / 2]
    assert radii
    for fillet in radii:
        found = fillets.junction_fillet_integral(0.08, wall, fillet)
        assert found == pytest.approx(slow_junction_fillet(0.08, wall, fillet), rel=error), fillet / wall


@pytest.mark.parametrize("ratio", [0.003, 0.01, 0.03, 0.06, 0.08, 0.1, 0.15, 0.2])
def test_junction_fillet_as_wide_as_the_bore(ratio):
    """A junction fillet that reaches the axis, the widest allowed, agrees with quadrature to 1e-6."""
    wall = ratio * 0.08
    fillet = 0.08 - wall / 2
    found = fillets.junction_fillet_integral(0.08, wall, fillet)
    assert found == pytest.approx(slow_junction_fillet(0.08, wall, fillet), rel=1e-6)


@thorough
@given(mean=radii, ratio=st.floats(0.005, 0.2), reach=st.just(0.0) | st.floats(0.001, 0.3), factor=st.floats(1.0, 1.5))
def test_junction_fillet_never_adds_windup(mean, ratio, reach, factor):
    """The wall over a junction fillet never winds up more than the plain wall, and a thicker wall never more."""
    wall, fillet = ratio * mean, reach * mean
    ring = fillets.junction_fillet_integral(mean, wall, fillet)
    assert 0 <= ring <= windup.wall_integral(fillet, mean, wall) * (1 + 1e-9)
    assert fillets.junction_fillet_integral(mean, wall * factor, fillet) <= ring


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
@given(inner=radii, width=widths, thickness=thicknesses, exponent=st.floats(-3.0, 10.0))
def test_power_law_by_quadrature(inner, width, thickness, exponent):
    """A disk that thins with any power of the radius agrees with quadrature, also close to n = 2."""
    outer = inner * (1 + width)
    exact = slow(lambda r: (r / inner) ** exponent / (r**3 * thickness), inner, outer)
    assert windup.power_law_disk_integral(inner, outer, thickness, exponent) == pytest.approx(exact, rel=1e-11)


def test_power_law_of_several_exponents_at_once():
    """Exponents in an array, constant shear stress among them, each have their own closed form."""
    exponents = np.array([0.0, 1.0, 2.0, 3.0])
    found = windup.power_law_disk_integral(0.04, 0.08, 0.004, exponents)
    closed = [
        (1 / 0.04**2 - 1 / 0.08**2) / 2 / 0.004,
        (1 / 0.04 - 1 / 0.08) / 0.04 / 0.004,
        math.log(2) / 0.04**2 / 0.004,
        (0.08 - 0.04) / 0.04**3 / 0.004,
    ]
    assert found == pytest.approx(np.array(closed), rel=1e-14)


@pytest.mark.parametrize("distance", [1e-6, 1e-9, 1e-12, 1e-15])
def test_power_law_is_continuous_at_constant_shear(distance):
    """A power that is all but 2 winds up as the disk of constant shear stress does."""
    exact = windup.power_law_disk_integral(0.04, 0.08, 0.004, 2)
    for exponent in (2 - distance, 2 + distance):
        near = windup.power_law_disk_integral(0.04, 0.08, 0.004, exponent)
        assert near == pytest.approx(exact, rel=1e-14 + distance)


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
