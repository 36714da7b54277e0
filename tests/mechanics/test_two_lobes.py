"""Two lobes: rigid motions, balance with the torsion check, bounds that order, converge and scale, and refusals."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flexlash.mechanics.elasticity.half_section import half_section, section_of
from flexlash.mechanics.elasticity.lobes import lobes_of
from flexlash.mechanics.elasticity.part import BENDING, part_of
from flexlash.mechanics.elasticity.section_mesh import section_mesh
from flexlash.mechanics.elasticity.tooth_loads import (
    HARMONICS,
    all_compliances,
    engaged_arc,
    half_sine_ratios,
    lobe_factor,
    rigid_contact_factor,
    uniform_ratios,
)
from flexlash.mechanics.elasticity.twist import elasticity_check, unit_twist
from flexlash.mechanics.elasticity.two_lobes import (
    SOLVED,
    _lobe_factors,
    bracket_problem,
    two_lobe_bracket,
)
from flexlash.mechanics.flexspline import windups

pytest.importorskip("skfem", reason="scikit-fem is not installed")

CUP = {
    "torque": 30.0, "cylinder_length": 0.03, "mean_radius": 0.025, "wall_thickness": 0.6e-3, "disk_thickness": 0.9e-3,
    "disk_inner_radius": 0.013, "tooth_face_width": 0.009, "youngs_modulus": 206e9, "poisson_ratio": 0.3,
}  # fmt: skip
RIM = {"rim_length": 0.01, "rim_thickness": 1.1e-3}
FILLETS = {"hub_fillet_radius": 1e-3, "junction_fillet_radius": 1.2e-3}
SHAPES = {
    "plain": CUP,
    "rim": CUP | RIM,
    "fillets": CUP | RIM | FILLETS,
    "face beyond the rim": CUP | RIM | {"tooth_face_width": 0.012},
    "taper": CUP | {"disk_hub_thickness": 2e-3},
    "cone": CUP | {"disk_cone_angle": math.radians(75)},
    "face as long as the cup": CUP | {"tooth_face_width": 0.03},
}
each_shape = pytest.mark.parametrize("size", SHAPES.values(), ids=SHAPES)
fewer = settings(deadline=None, max_examples=8, derandomize=True)


def factors(size, **arguments):
    """Return what two lobes do to a cup."""
    return two_lobe_bracket("cup", size, **arguments).factors


def motion(mesh, harmonic):
    """Yield the rigid motions of a harmonic: along and about the axis, or across and about an axis across."""
    radius, height = mesh.doflocs
    zero, one = np.zeros_like(radius), np.ones_like(radius)
    if harmonic == 0:
        yield np.stack([zero, radius, zero], axis=1)
        yield np.stack([zero, zero, one], axis=1)
    else:
        yield np.stack([one, one, zero], axis=1)
        yield np.stack([height, height, -radius], axis=1)


@pytest.mark.parametrize("harmonic", [0, 1])
@each_shape
def test_rigid_motions_meet_no_resistance(size, harmonic):
    """No stiffness meets a body that moves or turns as a whole, whatever its shape."""
    section = half_section("cup", size)
    lobes, (mesh, _) = lobes_of(section, 0.3), section_mesh(section)
    stiffness = sum(harmonic**power * matrix for power, matrix in enumerate(lobes.stiffness))
    for moved in motion(mesh, harmonic):
        assert abs(stiffness @ moved.ravel()).max() < 1e-9 * abs(stiffness).max() * abs(moved).max()


@each_shape
def test_stretch_of_a_whole_body(size):
    """A body that swells evenly, U = r and W = z, stores 3(1 − 2ν)⁻¹/2 of its volume over 2π, since E = 1."""
    section = half_section("cup", size)
    lobes, (mesh, _) = lobes_of(section, 0.3), section_mesh(section)
    radius, height = mesh.doflocs
    swollen = np.stack([radius, np.zeros_like(radius), height], axis=1).ravel()
    volume = _volume(section)
    assert swollen @ lobes.stiffness[0] @ swollen == pytest.approx(3 / (1 - 2 * 0.3) * volume, rel=1e-9)


def _volume(section):
    """Return ∫ r dr dz of a half-section, by its cells' own quadrature."""
    from skfem import Basis, ElementQuad2

    basis = Basis(section_mesh(section)[0], ElementQuad2(), intorder=6)
    return float((basis.dx * np.asarray(basis.global_coordinates())[0]).sum())


@pytest.mark.slow
@each_shape
def test_even_load_winds_up_as_the_torsion_check(size):
    """The harmonic 0 is the torsion of the elasticity check, to what the coarser corners leave."""
    found = factors(size).even_windup * size["torque"] / size["youngs_modulus"]
    assert found == pytest.approx(elasticity_check("cup", size).windup, rel=8e-4)


def test_even_load_is_that_of_the_torsion_check_on_one_mesh():
    """On one mesh both ways to solve torsion give one wind-up to rounding, since both balance the same load."""
    section = half_section("cup", CUP | RIM)
    windup = lobes_of(section, 0.3).even_windup()
    assert windup == pytest.approx(unit_twist(section).integral * 2 * 1.3 / (2 * math.pi), rel=2e-4)


@pytest.mark.slow
@each_shape
def test_bounds_order(size):
    """Even ≤ low ≤ uniform load on the held bore ≤ single teeth on it ≤ high, and compliances fall with n."""
    bracket = two_lobe_bracket("cup", size)
    found, arc = bracket.factors, engaged_arc(0.3)
    held = all_compliances(SOLVED, found.held)
    uniform = lobe_factor(held, uniform_ratios(HARMONICS, arc))
    assert 1 <= found.low <= uniform <= lobe_factor(held, half_sine_ratios(HARMONICS, arc)) <= found.high
    assert lobe_factor(held, np.full_like(held, 2.0)) <= found.high
    for compliances in (found.held, found.on_mid_line):
        assert compliances[-1] > 0
        assert (np.diff(compliances) < 0).all()
    assert (found.held <= found.on_mid_line).all()
    assert (bracket.low, bracket.high) == (bracket.even * found.low, bracket.even * found.high)
    assert bracket.even == pytest.approx(sum(windups("cup", size).values()), rel=1e-14)
    assert bracket.face_factor < 1


def test_what_the_bounds_are_made_of():
    """High is two single teeth, 1 + 2 Σ ρ_n, on a twentieth of the bearing; low is rigid contact on the whole of it."""
    found, narrow = factors(CUP, bearing_width=0.006), factors(CUP, bearing_width=0.0003)
    assert found.on_mid_line == pytest.approx(narrow.held, rel=1e-2)
    assert found.high == pytest.approx(1 + 2 * all_compliances(SOLVED, found.on_mid_line).sum(), rel=1e-12)
    rigid = rigid_contact_factor(HARMONICS, all_compliances(SOLVED, found.held), math.radians(27))
    assert found.low == pytest.approx(rigid, rel=1e-9)


@pytest.mark.slow
def test_more_support_never_raises_a_compliance():
    """A wider bearing makes every harmonic stiffer, and none stiffer than the even load's own shear."""
    narrow, middle, wide = (factors(CUP | RIM, bearing_width=width).held for width in (0.002, 0.005, 0.009))
    assert (wide < middle).all()
    assert (middle < narrow).all()


@pytest.mark.slow
def test_more_engaged_teeth_lower_the_low_bound_alone():
    """Rigid contact on more teeth winds up less; single teeth do not know how many others there are."""
    few, many = (two_lobe_bracket("cup", CUP, engaged_share=share) for share in (0.2, 0.5))
    assert many.low < few.low
    assert many.high == few.high


@pytest.mark.slow
@fewer
@given(
    length=st.floats(0.5, 20.0),
    torque=st.floats(0.1, 10.0),
    modulus=st.floats(0.2, 5.0),
    name=st.sampled_from([*SHAPES]),
)
def test_factors_know_no_size(length, torque, modulus, name):
    """A part of another size, torque or modulus has the same factors, to how its mesh lines fall."""
    size = SHAPES[name]
    scaled = {
        key: value * length if key in DIMENSIONS_OF_LENGTH else value for key, value in size.items()
    }  # fmt: skip
    scaled |= {"torque": size["torque"] * torque, "youngs_modulus": size["youngs_modulus"] * modulus}
    one, other = two_lobe_bracket("cup", size), two_lobe_bracket("cup", scaled)
    assert (other.factors.low, other.factors.high) == pytest.approx((one.factors.low, one.factors.high), rel=1e-4)
    assert other.low == pytest.approx(one.low * torque / modulus / length**3, rel=1e-4)


DIMENSIONS_OF_LENGTH = {
    "cylinder_length", "mean_radius", "wall_thickness", "disk_thickness", "disk_inner_radius", "tooth_face_width",
    "rim_length", "rim_thickness", "hub_fillet_radius", "junction_fillet_radius", "disk_hub_thickness",
}  # fmt: skip


def refined(size, refinement):
    """Return the factors of a cup on a mesh each of whose cells is halved both ways so often."""
    shape = tuple((name, value) for name, value in size.items() if name in DIMENSIONS_OF_LENGTH | {"disk_cone_angle"})
    return _lobe_factors(shape, 0.3, 0.006, 0.3, refinement)


def assert_near(coarse, fine, share):
    """Assert that a mesh and a finer one agree to a share of what the docstring says."""
    assert coarse.even_windup == pytest.approx(fine.even_windup, rel=8e-4 * share)
    assert coarse.held == pytest.approx(fine.held, rel=5e-3 * share)
    assert coarse.low == pytest.approx(fine.low, rel=6e-4 * share)
    assert coarse.high == pytest.approx(fine.high, rel=4e-3 * share)


@pytest.mark.slow
@each_shape
def test_mesh_is_fine_enough(size):
    """On a mesh with every cell halved compliances change by 5e-3 at most, the low bound by 6e-4, the high by 4e-3."""
    assert_near(refined(size, 0), refined(size, 1), 1.0)


@pytest.mark.slow
def test_convergence():
    """Halving every cell once more changes compliances and bounds by less than a third of that."""
    assert_near(refined(CUP, 1), refined(CUP, 2), 0.33)


def test_without_a_bearing_the_cup_is_far_softer():
    """A cup that nothing holds round gives way to the second harmonic ten times as much as to the even load."""
    part = replace(part_of("cup", CUP), grading=BENDING)
    section = section_of(part)
    lobes = lobes_of(section, 0.3)
    free, held = (lobes.compliances([2], section.bore & is_held)[0] for is_held in (False, True))
    assert free > 10
    assert held < 1


REFUSED = {
    "hat": ("hat", {"disk_outer_radius": 0.04}, {}, "only cups have been checked; a hat is held at its bolt circle"),
    "cylinder": ("cylinder", {}, {}, "only cups have been checked; a cylinder is held at the end of its wall"),
    "no face width": ("cup", {"tooth_face_width": 0.0}, {}, "the tooth face width is not given"),
    "rubber": ("cup", {"poisson_ratio": 0.499}, {}, "so incompressible a material cannot be solved"),
    "wide bearing": ("cup", {}, {"bearing_width": 0.055}, "bearing of the wave generator reaches into the disk"),
    "face in the fillet": ("cup", FILLETS | {"tooth_face_width": 0.0295}, {}, "reaches into the junction fillet"),
    "odd disk": ("cup", {"disk_outer_radius": 0.03}, {}, "the disk does not end within the wall"),
}


@pytest.mark.parametrize(("kind", "change", "arguments", "words"), REFUSED.values(), ids=REFUSED)
def test_refusals(kind, change, arguments, words):
    """What the method was not checked for, or cannot mesh, is refused with its reason."""
    size = CUP | change
    assert words in (bracket_problem(kind, size, **arguments) or "")
    with pytest.raises(ValueError, match=words):
        two_lobe_bracket(kind, size, **arguments)


@pytest.mark.slow
def test_poisson_ratio_beside_a_shear_modulus():
    """A material with its shear modulus alone needs Poisson's ratio beside it; with it the factors are the same."""
    by_shear = {name: value for name, value in CUP.items() if name not in ("youngs_modulus", "poisson_ratio")}
    by_shear["shear_modulus"] = 206e9 / 2.6
    assert bracket_problem("cup", by_shear) == "Poisson's ratio of the material is not given"
    found = two_lobe_bracket("cup", by_shear, poisson_ratio=0.3)
    assert found.low == pytest.approx(two_lobe_bracket("cup", CUP).low, rel=1e-12)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"bearing_width": 0.0}, "bearing_width = 0"),
        ({"engaged_share": 0.0}, "engaged_share = 0"),
        ({"engaged_share": 1.1}, "engaged_share = 1.1"),
        ({"engaged_share": math.nan}, "engaged_share"),
    ],
)
def test_arguments_that_are_none(arguments, words):
    """An argument out of range is refused by its name."""
    with pytest.raises(ValueError, match=words):
        two_lobe_bracket("cup", CUP, **arguments)


@pytest.mark.slow
def test_parts_of_one_shape_are_solved_once():
    """Another torque and modulus of the same shape take the factors that are there."""
    first = two_lobe_bracket("cup", CUP)
    assert two_lobe_bracket("cup", CUP | {"torque": 7.0, "youngs_modulus": 1e11}).factors is first.factors
