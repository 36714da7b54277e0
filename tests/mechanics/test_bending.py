"""The stress of a wall that the wave generator bends, against geometry, plate theory and elasticity of a ring."""

import math

import numpy as np
import pytest
from grids import for_each
from hypothesis import given, settings
from hypothesis import strategies as st

from flexlash.mechanics.bending import alternating_stress, bending_stress, combined_stress
from flexlash.mechanics.strength import von_mises_stress

thorough = settings(deadline=None, max_examples=60, derandomize=True)
STEEL = {"youngs_modulus": 206e9, "poisson_ratio": 0.3}
RING = {"radius": 0.025, "thickness": 0.55e-3, "deflection": 1e-5}


def curvature(radius, deflection):
    """Return the greatest change of curvature [1/m] of a ring that bends without stretch, from its bent shape alone."""
    angle = np.linspace(0, 2 * math.pi, 4097)[:-1]
    outwards, along = deflection * np.cos(2 * angle), -deflection / 2 * np.sin(2 * angle)
    places = (radius + outwards + 1j * along) * np.exp(1j * angle)
    frequency = np.fft.fftfreq(len(angle), 1 / len(angle))
    first, second = (np.fft.ifft((1j * frequency) ** order * np.fft.fft(places)) for order in (1, 2))
    return np.abs((first.conj() * second).imag / np.abs(first) ** 3 - 1 / radius).max()


@thorough
@given(radius=st.floats(0.01, 0.2), share=st.floats(1e-5, 1e-3), wall=st.floats(0.005, 0.05))
def test_bending_by_the_shape_of_the_bent_ring(radius, share, wall):
    """The stress is that of a plate which takes the change of curvature that the bent ring has, at its face."""
    deflection, thickness = share * radius, wall * radius
    stiff = 206e9 / (1 - 0.3**2)
    expected = stiff * curvature(radius, deflection) * thickness / 2
    found = bending_stress(radius=radius, thickness=thickness, deflection=deflection, **STEEL)
    assert found == pytest.approx(expected, rel=4 * share + 1e-6)


def test_bending_of_a_thin_ring_by_plane_elasticity():
    """A ring that two-lobed tractions bend in plane strain has the stress of its deflection, to its thinness."""
    for wall in (0.02, 0.01):
        deflection, stress = plane_ring(wall)
        found = bending_stress(radius=1.0, thickness=wall, deflection=deflection, youngs_modulus=1.0, poisson_ratio=0.3)
        assert found == pytest.approx(stress, rel=0.55 * wall)


def plane_ring(wall):
    """Return deflection and hoop stress at the outer face of a ring of radius 1 under the pressure cos 2θ outside.

    Michell's stress function (a r² + b r⁴ + c/r² + d) cos 2θ in plane strain, E = 1, ν = 0.3.
    """
    inner, outer = 1 - wall / 2, 1 + wall / 2

    def radial(r):
        return np.array([-2.0, 0.0, -6 / r**4, -4 / r**2])

    def shear(r):
        return np.array([2.0, 6 * r**2, -6 / r**4, -2 / r**2])

    equations = np.array([radial(inner), shear(inner), radial(outer), shear(outer)])
    law = np.linalg.solve(equations, [0.0, 0.0, 1.0, 0.0])
    hoop = law @ np.array([2.0, 12 * outer**2, 6 / outer**4, 0.0])
    shear_modulus, kappa = 1 / 2.6, 3 - 4 * 0.3
    # 2 G u_r of each term, of Michell's solution.
    moved = np.array([-2.0, -(3 - kappa), 2.0, kappa + 1]) / (2 * shear_modulus)
    return abs(law @ moved), abs(hoop)


@for_each("factor", (0.5, 2.0, 3.0))
def test_proportions(factor):
    """The stress goes as thickness, deflection and modulus, and against the square of the radius."""
    stress = bending_stress(**RING, **STEEL)
    for name in ("thickness", "deflection"):
        assert bending_stress(**RING | {name: RING[name] * factor}, **STEEL) == pytest.approx(stress * factor)
    assert bending_stress(**RING | {"radius": 0.025 * factor}, **STEEL) == pytest.approx(stress / factor**2)
    stiffer = STEEL | {"youngs_modulus": 206e9 * factor}
    assert bending_stress(**RING, **stiffer) == pytest.approx(stress * factor)


@thorough
@given(bending=st.floats(0, 1e9), poisson=st.floats(0, 0.5), shear=st.floats(0, 1e9))
def test_combination_is_the_von_mises_stress_of_the_whole_state(bending, poisson, shear):
    """Hoop and axial bending with shear have the von Mises stress that alternating and torsional stress combine to."""
    state = np.array([[bending, shear, 0], [shear, poisson * bending, 0], [0, 0, 0]])
    deviator = state - np.trace(state) / 3 * np.eye(3)
    expected = math.sqrt(1.5 * (deviator**2).sum())
    found = combined_stress(alternating_stress(bending, poisson), von_mises_stress(shear))
    assert found == pytest.approx(expected, rel=1e-12, abs=1e-3)


def test_arrays_meet_scalars_to_the_bit():
    """A column of parts gives the numbers that each part has alone."""
    radii = np.array([0.01, 0.025, 0.08])
    column = bending_stress(**RING | {"radius": radii}, **STEEL)
    assert column.tolist() == [bending_stress(**RING | {"radius": radius}, **STEEL) for radius in radii.tolist()]
    poisson = np.full(3, 0.3)
    both = combined_stress(alternating_stress(column, poisson), column)
    alone = [float(combined_stress(alternating_stress(one, 0.3), one)) for one in column.tolist()]
    assert both.tolist() == alone
