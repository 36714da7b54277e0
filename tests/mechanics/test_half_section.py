"""The half-section against closed-form areas, its own promises about edges and nodes, and shapes without a section."""

import math

import numpy as np
import pytest
from half_sections import (
    CONE,
    CUP,
    FILLETS,
    HAT,
    HUB_FILLET,
    JUNCTION_FILLET,
    RIM,
    TAPER,
    TUBE,
    WEIGHTS,
    jacobians,
    random_shapes,
)
from hypothesis import example, given, settings
from hypothesis import strategies as st

from flexlash.mechanics.elasticity import mesh_lines
from flexlash.mechanics.elasticity.half_section import half_section
from flexlash.mechanics.elasticity.part import section_problem

thorough = settings(deadline=None, max_examples=300, derandomize=True)


def area(section):
    """Return the area of all cells, by Gauss quadrature exact for their curved edges."""
    return float(jacobians(section).sum(axis=0) @ WEIGHTS @ WEIGHTS)


# Areas

AREAS = {
    "tube": ("cylinder", TUBE, 0.03 * 1.2),
    "tube with rim": ("cylinder", TUBE | RIM, 0.03 * 1.2 + 0.04 * 0.2),
    "rim of wall thickness": ("cylinder", TUBE | {"rim_length": 0.2, "rim_thickness": 0.03}, 0.03 * 1.2),
    "sharp": ("cup", CUP, 0.03 * 1.2 + 0.03 * 0.615),
    "hub fillet": ("cup", CUP | HUB_FILLET, 0.03 * 1.2 + 0.03 * 0.615 + (1 - math.pi / 4) * 0.05**2),
    "junction fillet": ("cup", CUP | JUNCTION_FILLET, 0.03 * 1.2 + 0.03 * 0.615 + (1 - math.pi / 4) * 0.15**2),
    "fillets": ("cup", CUP | FILLETS, 0.03 * 1.2 + 0.03 * 0.615 + (1 - math.pi / 4) * (0.05**2 + 0.15**2)),
    "fillets that touch": (
        "cup",
        CUP | {"hub_fillet_radius": 0.3, "junction_fillet_radius": 0.285},
        0.03 * 1.2 + 0.03 * 0.615 + (1 - math.pi / 4) * (0.3**2 + 0.285**2),
    ),
    "hub fillet as wide as the disk": (
        "cup",
        CUP | {"hub_fillet_radius": 0.585},
        0.03 * 1.2 + 0.03 * 0.615 + (1 - math.pi / 4) * 0.585**2,
    ),
    "rim": ("cup", CUP | RIM, 0.03 * 1.2 + 0.03 * 0.615 + 0.04 * 0.2),
    "rim that meets the fillet": (
        "cup",
        CUP | JUNCTION_FILLET | RIM | {"rim_length": 1.05},
        0.03 * 1.2 + 0.03 * 0.615 + (1 - math.pi / 4) * 0.15**2 + 0.04 * 1.05,
    ),
    "taper": ("cup", CUP | TAPER, 0.03 * 1.2 + 0.075 * 0.6 + 0.05 * 0.015),
    "taper, thin at the hub": (
        "cup",
        CUP | FILLETS | {"disk_thickness": 0.1, "disk_hub_thickness": 0.05},
        0.03 * 1.2 + 0.075 * 0.6 + 0.1 * 0.015 + (1 - math.pi / 4) * (0.05**2 + 0.15**2),
    ),
    "power law": (
        "cup",
        CUP | {"disk_hub_thickness": 0.1, "disk_thickness_exponent": 2.0},
        0.03 * 1.2 + 0.1 * 0.4**2 * (1 / 0.4 - 1) + 0.1 * 0.4**2 * 0.015,
    ),
    "power 1": (
        "cup",
        CUP | FILLETS | {"disk_hub_thickness": 0.1, "disk_thickness_exponent": 1.0},
        0.03 * 1.2 + 0.1 * 0.4 * (math.log(2.5) + 0.015) + (1 - math.pi / 4) * (0.05**2 + 0.15**2),
    ),
    "cone": ("cup", CUP | CONE, 0.03 * 1.2 + 0.03 / 0.5 * 0.615),
    "tapered cone": (
        "cup",
        CUP | TAPER | CONE,
        0.03 * 1.2 + ((0.1 - 0.05 / 0.6 * 0.585 / 2) * 0.585 + (0.1 - 0.05 / 0.6 * 0.585) * 0.03) / 0.5,
    ),
    "hat": ("hat", HAT, 0.03 * 1.2 + 0.05 * 0.515),
    "hat with rim": ("hat", HAT | RIM, 0.03 * 1.2 + 0.05 * 0.515 + 0.04 * 0.2),
    "conical hat": ("hat", HAT | CONE, 0.03 * 1.2 + 0.05 / 0.5 * 0.515),
}


@pytest.mark.parametrize(("kind", "size", "expected"), AREAS.values(), ids=AREAS)
def test_area_of_the_half_section(kind, size, expected):
    """The cells cover the drawing's area, to rounding where all edges are straight and to 1e-7 where they bend."""
    bends = "cone" not in str(size) and {"hub_fillet_radius", "junction_fillet_radius", "disk_hub_thickness"} & set(
        size
    )
    assert area(half_section(kind, size, 2)) == pytest.approx(expected, rel=1e-7 if bends else 1e-12)


@pytest.mark.parametrize("name", ["hub fillet", "junction fillet", "fillets that touch"])
def test_area_of_arcs_converges_at_the_fourth_order(name):
    """Every halving of the cells brings the area of a fillet about sixteen times closer."""
    kind, size, expected = AREAS[name]
    coarse, middle, fine = (area(half_section(kind, size, refinement)) - expected for refinement in range(3))
    assert 15 < coarse / middle < 17
    assert 15 < middle / fine < 17


# What holds for every shape

SHAPES = list(random_shapes(300, 1))


def test_random_shapes_have_every_feature():
    """The drawn shapes have tiny and large fillets, fillets and rims that touch, even rims, both tapers and cones."""
    sizes = [size for _, size in SHAPES]

    def count(holds):
        return sum(1 for size in sizes if holds(size))

    def room(size):
        return size["mean_radius"] - size["wall_thickness"] / 2 - size["disk_inner_radius"]

    both = [size for size in sizes if {"hub_fillet_radius", "junction_fillet_radius"} <= set(size)]
    assert count(lambda size: size.get("junction_fillet_radius", 1) < size["wall_thickness"] / 100) > 5
    assert count(lambda size: size.get("junction_fillet_radius", 0) > size["wall_thickness"] * 5) > 5
    assert (
        sum(math.isclose(size["hub_fillet_radius"] + size["junction_fillet_radius"], room(size)) for size in both) > 5
    )
    assert count(lambda size: size.get("rim_thickness") == size["wall_thickness"]) > 5
    assert (
        count(
            lambda size: math.isclose(
                size.get("rim_length", 0) + size.get("junction_fillet_radius", math.inf), size["cylinder_length"]
            )
        )
        > 5
    )
    tapers = [size for size in sizes if {"disk_thickness", "disk_hub_thickness"} <= set(size)]
    assert sum(size["disk_thickness"] < size["disk_hub_thickness"] for size in tapers) > 5
    assert sum(size["disk_thickness"] > size["disk_hub_thickness"] for size in tapers) > 5
    assert count(lambda size: "disk_thickness_exponent" in size) > 5
    assert count(lambda size: size.get("disk_cone_angle", math.inf) < math.radians(45)) > 5


@pytest.mark.slow
@pytest.mark.parametrize("refinement", [0, 1])
def test_cells_are_not_folded(refinement):
    """The biquadratic map of every cell of three hundred random shapes keeps its orientation at all Gauss points."""
    for kind, size in SHAPES:
        assert (jacobians(half_section(kind, size, refinement)) > 0).all(), (kind, size)


def used_nodes(section):
    """Return the nodes of the lattice that a cell uses."""
    used = np.zeros(section.radius.shape, dtype=bool)
    for column, row in zip(*np.nonzero(section.cells), strict=True):
        used[2 * column : 2 * column + 3, 2 * row : 2 * row + 3] = True
    return used


def test_nodes_are_those_of_cells():
    """A node has a place when a cell uses it and else is NaN; marks lie on nodes that have a place."""
    for kind, size in SHAPES[::3]:
        section = half_section(kind, size)
        used = used_nodes(section)
        assert section.radius.shape == (2 * section.cells.shape[0] + 1, 2 * section.cells.shape[1] + 1)
        assert np.array_equal(np.isfinite(section.radius), used)
        assert np.array_equal(np.isfinite(section.height), used)
        assert not ((section.clamped | section.loaded | section.hub_fillet) & ~used).any()


@pytest.mark.slow
def test_section_has_no_cracks():
    """No two nodes have the same place, and the edges of one cell only make a single closed line."""
    for kind, size in SHAPES[::3]:
        section = half_section(kind, size)
        used = used_nodes(section)
        places = np.stack([section.radius[used], section.height[used]], axis=-1) / size["mean_radius"]
        assert len(np.unique(np.round(places, 12), axis=0)) == len(places)
        column, row = np.nonzero(section.cells)
        corners = [(2 * column + right, 2 * row + up) for right, up in ((0, 0), (2, 0), (2, 2), (0, 2))]
        numbers = np.stack([one * section.radius.shape[1] + other for one, other in corners])
        edges = np.sort(np.stack([numbers, np.roll(numbers, -1, axis=0)], axis=-1).reshape(-1, 2), axis=1)
        edges, count = np.unique(edges, axis=0, return_counts=True)
        assert count.max() == 2
        line = edges[count == 1]
        followers = {}
        for one, other in line.tolist():
            followers.setdefault(one, []).append(other)
            followers.setdefault(other, []).append(one)
        assert {len(ends) for ends in followers.values()} == {2}
        before, place, steps = None, line[0, 0], 0
        while steps == 0 or place != line[0, 0]:
            before, place = place, next(end for end in followers[place] if end != before)
            steps += 1
        assert steps == len(line)


def marked(section, mark):
    """Return radius and height of the marked nodes."""
    return section.radius[mark], section.height[mark]


def close(value, expected, size):
    """Return whether values meet a place to 1e-9 of the mean radius."""
    return np.abs(value - expected) < 1e-9 * size["mean_radius"]


def test_clamped_edge():
    """The clamped nodes are those at the hub bore of a cup, the bolt circle of a hat, the closed end of a tube."""
    for kind, size in SHAPES[::3]:
        section = half_section(kind, size)
        if kind == "cylinder":
            expected = close(section.height, 0, size)
        else:
            expected = close(section.radius, size["disk_inner_radius" if kind == "cup" else "disk_outer_radius"], size)
        assert expected.sum() >= 5
        assert np.array_equal(section.clamped, expected)


def test_clamped_edge_is_as_long_as_the_disk_is_thick():
    """The clamped edge of a cup spans its hub fillet and its thickness along the axis."""
    for kind, size in SHAPES[::3]:
        if kind == "cup":
            _, height = marked(section := half_section(kind, size), section.clamped)
            thickness = size.get("disk_hub_thickness", size.get("disk_thickness", size["wall_thickness"]))
            expected = thickness / math.sin(size.get("disk_cone_angle", math.pi / 2))
            assert np.ptp(height) == pytest.approx(expected + size.get("hub_fillet_radius", 0.0), rel=1e-9)


def test_loaded_edge():
    """The loaded nodes are those at the cylinder length, over the wall or the rim."""
    for kind, size in SHAPES[::3]:
        section = half_section(kind, size)
        assert np.array_equal(section.loaded, close(section.height, size["cylinder_length"], size))
        radius, _ = marked(section, section.loaded)
        bore = size["mean_radius"] - size["wall_thickness"] / 2
        assert close(radius.min(), bore, size)
        assert close(radius.max(), bore + size.get("rim_thickness", size["wall_thickness"]), size)


def test_hub_fillet_edge():
    """The hub fillet's nodes run along a quarter of its circle, from the hub bore to the disk, and no others do."""
    filleted = [
        (kind, size) for kind, size in SHAPES if size.get("hub_fillet_radius", 0.0) > 0.01 * size["mean_radius"]
    ]
    assert len(filleted) > 30
    for kind, size in filleted:
        section, fillet = half_section(kind, size), size["hub_fillet_radius"]
        end = size["disk_inner_radius"] + fillet
        circle = close(np.hypot(section.radius - end, section.height - fillet), fillet, size)
        below = (section.radius < end + 1e-9 * size["mean_radius"]) & (
            section.height < fillet + 1e-9 * size["mean_radius"]
        )
        assert np.array_equal(section.hub_fillet, circle & below)
        radius, height = marked(section, section.hub_fillet)
        assert close(radius[0], size["disk_inner_radius"], size)
        assert close(radius[-1], end, size)
        assert close(height[0], fillet, size)
        assert close(height[-1], 0, size)


def test_no_hub_fillet_no_mark():
    """A shape without hub fillet has no node marked as one."""
    plain = [(kind, size) for kind, size in SHAPES[::3] if "hub_fillet_radius" not in size]
    assert len(plain) > 30
    for kind, size in plain:
        assert not half_section(kind, size).hub_fillet.any()


def test_rim_begins_at_its_step():
    """Nodes outside the wall are those of a cup's rim, from its lower edge to the open end."""
    for kind, size in SHAPES[::3]:
        if kind == "cup" and size.get("rim_thickness", 0.0) > size["wall_thickness"]:
            section = half_section(kind, size)
            outside = section.radius > size["mean_radius"] + size["wall_thickness"] / 2 + 1e-9 * size["mean_radius"]
            _, height = marked(section, outside)
            assert close(height.min(), size["cylinder_length"] - size["rim_length"], size)
            assert close(height.max(), size["cylinder_length"], size)


def test_refinement_halves_the_cells():
    """A refined section has four cells for one and keeps the coarse one's nodes and marks at every second place."""
    for kind, size in SHAPES[::5]:
        coarse, fine = half_section(kind, size), half_section(kind, size, 1)
        assert np.array_equal(fine.cells, coarse.cells.repeat(2, axis=0).repeat(2, axis=1))
        for name in ("radius", "height"):
            one, other = getattr(coarse, name), getattr(fine, name)[::2, ::2]
            assert np.allclose(one, other, rtol=0, atol=1e-12 * size["mean_radius"], equal_nan=True)
        for name in ("clamped", "loaded", "hub_fillet"):
            assert np.array_equal(getattr(coarse, name), getattr(fine, name)[::2, ::2])


def test_bore_instead_of_mean_radius():
    """A bore diameter and the wall make the same section as the mean radius that follows from them."""
    size = {name: value for name, value in CUP.items() if name != "mean_radius"} | {"bore_diameter": 1.97}
    assert np.allclose(half_section("cup", size).radius, half_section("cup", CUP).radius, rtol=1e-14, equal_nan=True)


def test_blank_disk_thickness_is_that_of_the_wall():
    """Without a disk thickness the disk is as thick as the wall."""
    given = half_section("cup", CUP | {"disk_thickness": CUP["wall_thickness"]})
    assert np.array_equal(half_section("cup", CUP).height, given.height, equal_nan=True)


# Mesh lines


@pytest.mark.slow
@example(end=1.0, first=0.02, last=0.3, least=2)
@given(
    end=st.floats(0.01, 10),
    first=st.floats(1e-4, 10),
    last=st.floats(1e-4, 10),
    least=st.sampled_from([2, 6]),
)
@thorough
def test_graded_lines(end, first, last, least):
    """Mesh lines rise from end to end; steps grow by the factor, or by its square where they meet in the middle."""
    lines = mesh_lines.graded(0.0, end, first, last, least)
    steps = np.diff(lines)
    assert lines[0] == 0
    assert lines[-1] == end
    assert len(steps) >= least
    assert (steps > 0).all()
    assert steps.max() <= end / least * (1 + 1e-6)
    most = mesh_lines._GROWTH**2 * (1 + 1e-6)
    assert steps[0] <= first * mesh_lines._GROWTH * (1 + 1e-6)
    assert steps[-1] <= last * mesh_lines._GROWTH * (1 + 1e-6)
    assert (np.maximum(steps[1:] / steps[:-1], steps[:-1] / steps[1:]) <= most).all()


# Shapes without a section

PROBLEMS = {
    "no bore": ("cylinder", TUBE | {"wall_thickness": 2.0}, "wall_thickness", "fills its bore"),
    "cup's disk ends in its bore": ("cup", CUP | {"disk_outer_radius": 0.98}, "disk_outer_radius", "within the wall"),
    "cup's disk ends outside": ("cup", CUP | {"disk_outer_radius": 1.02}, "disk_outer_radius", "within the wall"),
    "hat's flange begins outside": ("hat", HAT | {"disk_inner_radius": 1.02}, "disk_inner_radius", "within the wall"),
    "hat's flange begins in its bore": (
        "hat",
        HAT | {"disk_inner_radius": 0.98},
        "disk_inner_radius",
        "within the wall",
    ),
    "hat's flange within the wall": ("hat", HAT | {"disk_outer_radius": 1.015}, "disk_outer_radius", "flange ends"),
    "hub in the wall": ("cup", CUP | {"disk_inner_radius": 0.985}, "disk_inner_radius", "hub reaches"),
    "hub fillet in the wall": ("cup", CUP | {"hub_fillet_radius": 0.6}, "hub_fillet_radius", "hub fillet reaches"),
    "fillets overlap": (
        "cup",
        CUP | {"hub_fillet_radius": 0.3, "junction_fillet_radius": 0.29},
        "junction_fillet_radius",
        "overlap on the disk",
    ),
    "rim in the fillet": ("cup", CUP | JUNCTION_FILLET | RIM | {"rim_length": 1.06}, "rim_length", "longer than"),
    "rim longer than the cylinder": ("hat", HAT | RIM | {"rim_length": 1.21}, "rim_length", "as long as"),
    "rim as long as the cylinder": ("cylinder", TUBE | RIM | {"rim_length": 1.2}, "rim_length", "as long as"),
    "fillet on a cone": ("cup", CUP | FILLETS | {"disk_cone_angle": 0.8}, "disk_cone_angle", "takes no fillet"),
    "foil wall": ("hat", HAT | {"wall_thickness": 5e-5}, "wall_thickness", "foil"),
    "foil disk": (
        "cup",
        CUP | {"disk_inner_radius": 0.25, "disk_hub_thickness": 0.1, "disk_thickness_exponent": 10},
        "disk_hub_thickness",
        "foil",
    ),
    "disk of no thickness": (
        "cup",
        CUP | {"disk_hub_thickness": 0.1, "disk_thickness": -0.01},
        "disk_hub_thickness",
        "foil",
    ),
    "fillet longer than the cylinder": (
        "cup",
        CUP | {"cylinder_length": 0.2, "junction_fillet_radius": 0.25},
        "junction_fillet_radius",
        "longer than",
    ),
}


@pytest.mark.parametrize(("kind", "size", "name", "clause"), PROBLEMS.values(), ids=PROBLEMS)
def test_shape_without_a_section(kind, size, name, clause):
    """A shape that closes nowhere names its dimension and its reason, and makes no half-section."""
    blamed, reason = section_problem(kind, size)
    assert blamed == name
    assert clause in reason
    with pytest.raises(ValueError, match=clause):
        half_section(kind, size)


NO_PROBLEMS = {
    "disk ends at the bore": ("cup", CUP | {"disk_outer_radius": 0.985}),
    "disk ends at the outside": ("cup", CUP | {"disk_outer_radius": 1.015}),
    "hub fillet as wide as the disk": ("cup", CUP | {"hub_fillet_radius": 1 - 0.03 / 2 - 0.4}),
    "fillets touch": ("cup", CUP | {"hub_fillet_radius": 0.3, "junction_fillet_radius": 1 - 0.03 / 2 - 0.4 - 0.3}),
    "rim meets the fillet": ("cup", CUP | JUNCTION_FILLET | RIM | {"rim_length": 1.2 - 0.15}),
    "hub fillet a last digit wider": ("cup", CUP | {"hub_fillet_radius": 0.585 * (1 + 1e-12)}),
    "fillets a last digit larger": (
        "cup",
        CUP | {"hub_fillet_radius": 0.3, "junction_fillet_radius": 0.285 * (1 + 1e-12)},
    ),
    "rim a last digit longer": ("cup", CUP | JUNCTION_FILLET | RIM | {"rim_length": 1.05 * (1 + 1e-12)}),
}


@pytest.mark.parametrize(("kind", "size"), NO_PROBLEMS.values(), ids=NO_PROBLEMS)
def test_shape_at_its_limit(kind, size):
    """A shape that just closes has no problem, and its half-section is sound."""
    assert section_problem(kind, size) is None
    assert (jacobians(half_section(kind, size)) > 0).all()


def test_random_shapes_have_no_problem():
    """The drawn shapes close, those whose fillets or rim touch among them."""
    assert [section_problem(kind, size) for kind, size in SHAPES] == [None] * len(SHAPES)


def test_a_flat_cone_is_a_flat_disk():
    """A cone angle of 90° gives the very lattice of a flat disk."""
    flat, cone = (half_section("cup", CUP | change) for change in ({}, {"disk_cone_angle": math.pi / 2}))
    assert np.array_equal(flat.radius, cone.radius, equal_nan=True)
    assert np.array_equal(flat.height, cone.height, equal_nan=True)


def test_a_taper_that_ends_within_the_wall_goes_on_even():
    """A steep taper to a disk radius short of the wall's middle does not fold under the wall."""
    size = {"mean_radius": 1.0, "wall_thickness": 0.2, "cylinder_length": 1.0, "disk_inner_radius": 0.8}
    taper = {"disk_outer_radius": 0.91, "disk_hub_thickness": 0.2, "disk_thickness": 0.01}
    section = half_section("cup", size | taper)
    under = section.radius[:, 0] >= 0.91
    assert section.height[under, 0] == pytest.approx(-0.01, rel=1e-12)


def test_junction_fillet_edge():
    """The junction fillet's nodes run along a quarter of its circle, from the disk to the wall, and no others do."""
    filleted = [
        (kind, size) for kind, size in SHAPES if size.get("junction_fillet_radius", 0.0) > 0.01 * size["mean_radius"]
    ]
    assert len(filleted) > 30
    for kind, size in filleted:
        section, fillet = half_section(kind, size), size["junction_fillet_radius"]
        bore = size["mean_radius"] - size["wall_thickness"] / 2
        radius, height = marked(section, section.junction_fillet)
        assert close(np.hypot(radius - (bore - fillet), height - fillet), fillet, size).all()
        assert close(radius[0], bore - fillet, size)
        assert close(height[0], 0, size)
        assert close(radius[-1], bore, size)
        assert close(height[-1], fillet, size)


def test_no_junction_fillet_no_mark():
    """A shape without junction fillet has no node marked as one."""
    plain = [(kind, size) for kind, size in SHAPES[::3] if "junction_fillet_radius" not in size]
    assert len(plain) > 30
    for kind, size in plain:
        assert not half_section(kind, size).junction_fillet.any()
