"""How teeth share the torque: ratios against quadrature, factors against closed forms and against each other."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from flexlash.mechanics.elasticity.tooth_loads import (
    HARMONICS,
    all_compliances,
    engaged_arc,
    half_sine_ratios,
    lobe_factor,
    rigid_contact_factor,
    single_tooth_ratios,
    uniform_ratios,
)
from flexlash.mechanics.elasticity.two_lobes import SOLVED

thorough = settings(deadline=None, max_examples=40, derandomize=True)
arcs = st.floats(0.05, math.pi / 2)


def slow_ratio(load, harmonic, arc):
    """Return q_n/q₀ of a load within ± arc by quadrature: Fourier's coefficient of two arcs over its mean."""
    weighted, _ = quad(lambda angle: load(angle) * math.cos(harmonic * angle), -arc, arc, epsabs=1e-13, limit=400)
    return 2 * weighted / quad(load, -arc, arc)[0]


@thorough
@given(arc=arcs, harmonic=st.integers(1, 20).map(lambda half: 2 * half))
def test_uniform_ratios_by_quadrature(arc, harmonic):
    """The ratios of an even load within arcs are Fourier's coefficients."""
    found = uniform_ratios(np.array([float(harmonic)]), arc)
    assert found == pytest.approx(slow_ratio(lambda _: 1.0, harmonic, arc), abs=1e-9)


@thorough
@given(arc=arcs, harmonic=st.integers(1, 20).map(lambda half: 2 * half))
def test_half_sine_ratios_by_quadrature(arc, harmonic):
    """The ratios of half a sine wave over each arc are Fourier's coefficients."""
    found = half_sine_ratios(np.array([float(harmonic)]), arc)
    assert found == pytest.approx(
        slow_ratio(lambda angle: math.cos(math.pi * angle / (2 * arc)), harmonic, arc), abs=1e-9
    )


def test_half_sine_ratio_where_its_fraction_is_0_over_0():
    """Where 2na is π the ratio is π/2, and its neighbours lie beside it."""
    arc = math.pi / 8
    assert half_sine_ratios(np.array([4.0]), arc) == pytest.approx(math.pi / 2, rel=1e-14)
    assert half_sine_ratios(np.array([4.0]), arc * (1 + 1e-9)) == pytest.approx(math.pi / 2, rel=1e-8)


def test_narrow_arcs_are_single_teeth():
    """Any load within a vanishing arc has the ratios of two single teeth."""
    for ratios in (uniform_ratios, half_sine_ratios):
        assert ratios(HARMONICS[:20], 1e-6) == pytest.approx(single_tooth_ratios(HARMONICS[:20]), rel=1e-8)


def test_all_teeth_evenly_engaged_are_the_even_load():
    """An even load over ± 90° is the even load: its factor is 1, and all teeth are engaged."""
    assert engaged_arc(1.0) == math.pi / 2
    assert lobe_factor(1 / HARMONICS, uniform_ratios(HARMONICS, math.pi / 2)) == pytest.approx(1, abs=1e-15)
    assert rigid_contact_factor(HARMONICS, 1 / HARMONICS, math.pi / 2) == pytest.approx(1, abs=1e-12)


falling = st.tuples(st.floats(0.001, 3.0), st.floats(1.05, 3.0))
"""Compliance of the second harmonic, and the power with which compliances fall."""


@thorough
@given(arc=st.floats(0.1, 1.5), law=falling)
def test_rigid_contact_is_the_least(arc, law):
    """Rigid contact winds up no more than even or half-sine loads over the same arcs, and never less than 1."""
    compliances = law[0] * (2 / HARMONICS) ** law[1]
    rigid = rigid_contact_factor(HARMONICS, compliances, arc)
    for ratios in (uniform_ratios, half_sine_ratios):
        assert 1 <= rigid <= lobe_factor(compliances, ratios(HARMONICS, arc)) * (1 + 2e-4)
    assert rigid_contact_factor(HARMONICS, compliances, arc * 0.9) >= rigid * (1 - 1e-6)


def test_rigid_contact_turns_all_teeth_by_the_same_angle():
    """With two harmonics the least factor is that of the least-squares loads found by brute force over many shares."""
    harmonics, compliances, arc = np.array([2.0, 4.0]), np.array([0.3, 0.1]), 0.6
    places = np.linspace(0, arc, 81)
    ratios = 2 * np.cos(harmonics[:, None] * places)
    # Loads at two places reach every corner of what convex combinations of the ratios can give.
    first, second = np.triu_indices(len(places))
    share = np.linspace(0, 1, 101)[:, None]
    mixed = [share * row[first] + (1 - share) * row[second] for row in ratios]
    brute = 1 + 0.5 * sum(weight * part**2 for weight, part in zip(compliances, mixed, strict=True)).min()
    assert rigid_contact_factor(harmonics, compliances, arc) == pytest.approx(brute, rel=2e-4)


@thorough
@given(law=falling)
def test_power_laws_are_interpolated_and_continued_exactly(law):
    """Compliances that fall with a power of n are told exactly between the solved harmonics and beyond them."""
    found = all_compliances(SOLVED, law[0] * (2 / np.array(SOLVED, dtype=float)) ** law[1])
    assert found == pytest.approx(law[0] * (2 / HARMONICS) ** law[1], rel=1e-11)
