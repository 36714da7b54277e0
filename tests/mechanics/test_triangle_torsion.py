"""The oracle of quadratic triangles against exact solutions, closed-form areas, itself and a table of elasticity."""

import csv
import math
from pathlib import Path

import numpy as np
import pytest
import triangle_torsion
from triangle_torsion import Patch, half_section, mesh, stiffness, stress_integral, twist_integral, windup_integral

CUP = {"mean_radius": 1.0, "wall_thickness": 0.03, "cylinder_length": 1.2, "disk_inner_radius": 0.4}
RIM = {"rim_length": 0.2, "rim_thickness": 0.07}
FILLETS = {"hub_fillet_radius": 0.05, "junction_fillet_radius": 0.15}
TAPER = {"disk_thickness": 0.05, "disk_hub_thickness": 0.1}
HAT = {"mean_radius": 1.0, "wall_thickness": 0.03, "cylinder_length": 1.2, "disk_outer_radius": 1.5}


def _rows(name):
    """Yield the type and the numbers of each row of a table under references."""
    with (Path(__file__).parents[1] / "references" / name).open(encoding="utf-8") as file:
        for row in csv.DictReader(file):
            kind = row.pop("flexspline_type")
            yield kind, {key: float(text) for key, text in row.items() if text}


def both_bounds(body, clamped, loaded):
    """Return I from the twist and from the stress function."""
    return twist_integral(body, clamped, loaded), stress_integral(body, clamped, loaded)


def cup_bounds(size, refinement):
    """Return the two bounds of a cup of mean radius 1."""
    return np.array(both_bounds(*triangle_torsion._meshed("cup", size, refinement)))


def test_tube_is_exact():
    """A tube has I = 4 l/(r_o⁴ − r_b⁴): the twist, linear in z, to ten digits, the stress function, ∝ r⁴, to six."""
    body = mesh([Patch(inner=lambda z: (0.9, z), outer=lambda z: (1.1, z), start=0, end=2)], 1)
    below, above = both_bounds(body, body.points[:, 1] == 0, body.points[:, 1] == 2)
    exact = 4 * 2 / (1.1**4 - 0.9**4)
    assert below == pytest.approx(exact, rel=1e-10)
    assert exact < above < exact * (1 + 1e-6)


def test_annulus_under_shear_at_its_circumference():
    """An even annulus clamped at its bore has I = (1/r_i² − 1/r_o²)/(2t); the twist's error is of fourth order."""
    exact = (1 / 0.4**2 - 1) / (2 * 0.1)
    shortfall = []
    for refinement in (1, 2):
        patch = Patch(inner=lambda r: (r, 0 * r), outer=lambda r: (r, 0 * r - 0.1), start=0.4, end=1)
        body = mesh([patch], refinement)
        below, above = both_bounds(body, body.points[:, 0] == 0.4, body.points[:, 0] == 1)
        assert above == pytest.approx(exact, rel=1e-9)
        shortfall.append(1 - below / exact)
    assert 0 < shortfall[1] < 2e-6
    assert 15 < shortfall[0] / shortfall[1] < 17


def test_hollow_cone_between_spheres():
    """A cone cut by two spheres, φ ∝ 1/ρ³, has I = (1/ρ₁³ − 1/ρ₂³)/(3 ∫sin³θ dθ); the error is of fourth order."""

    def sphere(radius):
        return lambda angle: (radius * np.sin(angle), radius * np.cos(angle))

    def sine_cubed(angle):
        return math.cos(angle) ** 3 / 3 - math.cos(angle)

    exact = (1 / 0.5**3 - 1) / (3 * (sine_cubed(1.0) - sine_cubed(0.6)))
    shortfall = []
    for refinement in (1, 2):
        body = mesh([Patch(inner=sphere(0.5), outer=sphere(1.0), start=0.6, end=1.0)], refinement)
        distance = np.linalg.norm(body.points, axis=1)
        below, above = both_bounds(body, np.abs(distance - 0.5) < 1e-9, np.abs(distance - 1) < 1e-9)
        assert above == pytest.approx(exact, rel=1e-7)
        shortfall.append(1 - below / exact)
    assert 0 < shortfall[1] < 3e-5
    assert 13 < shortfall[0] / shortfall[1] < 17


AREAS = {
    "sharp": ("cup", CUP, 0.03 * 1.2 + (1.015 - 0.4) * 0.03),
    "fillets": (
        "cup",
        CUP | FILLETS,
        0.03 * 1.2 + (1.015 - 0.4) * 0.03 + (1 - math.pi / 4) * (0.05**2 + 0.15**2),
    ),
    "taper and rim": (
        "cup",
        CUP | TAPER | RIM,
        0.03 * 1.2 + 0.04 * 0.2 + 0.1 * 0.615 - 0.05 / 0.6 * 0.615**2 / 2,
    ),
    "power law": (
        "cup",
        CUP | {"disk_hub_thickness": 0.1, "disk_thickness_exponent": 2},
        0.03 * 1.2 + 0.1 * 0.4**2 * (1 / 0.4 - 1 / 1.015),
    ),
    "cone": ("cup", CUP | {"disk_cone_angle": math.pi / 6}, 0.03 * 1.2 + (1.015 - 0.4) * 0.03 / 0.5),
    "hat": ("hat", HAT | RIM | {"disk_thickness": 0.05}, 0.03 * 1.2 + 0.04 * 0.2 + 0.05 * (1.5 - 0.985)),
}


@pytest.mark.parametrize(("kind", "size", "area"), AREAS.values(), ids=AREAS)
def test_area_of_the_half_section(kind, size, area):
    """The triangles cover the drawing's area, ∫|∇r|², once and without cracks: its free edge is one closed line."""
    body = mesh(half_section(kind, size), 1)
    radius = body.points[:, 0]
    assert radius @ stiffness(body, 0) @ radius == pytest.approx(area, rel=1e-6)
    corners = triangle_torsion._boundary(body)[:, :2]
    assert len(np.unique(corners)) == len(corners)


@pytest.mark.slow
@pytest.mark.parametrize("features", [{}, FILLETS | RIM, {"disk_cone_angle": 0.8}], ids=["sharp", "fillets", "cone"])
def test_bounds_close_as_the_mesh_is_refined(features):
    """Twist and stress function bracket I ever closer, within 3e-4 and then a sixth of it, despite the corners."""
    coarse, fine = (cup_bounds(CUP | features, refinement) for refinement in (1, 2))
    assert coarse[0] < fine[0] < fine[1] < coarse[1]
    assert np.ptp(coarse) < 3e-4 * fine[0]
    assert np.ptp(fine) < np.ptp(coarse) / 6


def test_extrapolation_reaches_the_limit():
    """Three values whose error falls eightfold give their limit; one that has settled is kept."""
    assert triangle_torsion.extrapolated([5 - 0.64, 5 - 0.08, 5 - 0.01]) == pytest.approx(5, rel=1e-15)
    assert triangle_torsion.extrapolated([4.9, 5.0, 5.0]) == 5.0


def test_right_angle_is_a_flat_disk():
    """A cone of semi-angle 90° is the flat disk, and one of nearly 90° almost so."""
    flat = windup_integral("cup", CUP, 1)
    assert windup_integral("cup", CUP | {"disk_cone_angle": math.pi / 2}, 1) == flat
    assert windup_integral("cup", CUP | {"disk_cone_angle": math.pi / 2 - 1e-6}, 1) == pytest.approx(flat, rel=1e-5)


def test_scale():
    """Twice as large in every length, I is an eighth."""
    large = {name: 2 * size for name, size in (CUP | FILLETS | RIM).items()}
    assert windup_integral("cup", large, 1) == pytest.approx(windup_integral("cup", CUP | FILLETS | RIM, 1) / 8)


def test_fillets_without_room_are_refused():
    """Fillets that meet on the disk raise instead of folding the mesh."""
    with pytest.raises(ValueError, match="no disk between"):
        windup_integral("cup", CUP | {"hub_fillet_radius": 0.3, "junction_fillet_radius": 0.3}, 1)


TABLE = list(_rows("triangle_torsion.csv"))


def test_table_holds_the_drawn_geometries():
    """The table's dimensions are those the fixed seed draws, each integral within 0.002 %."""
    drawn = list(triangle_torsion.geometries())
    assert [kind for kind, _ in TABLE] == [kind for kind, _ in drawn]
    for (_, row), (_, dimensions) in zip(TABLE, drawn, strict=True):
        assert 0 < row["relative_error"] < 2e-5
        assert {name: row[name] for name in row.keys() & set(triangle_torsion.DIMENSIONS)} == dimensions


@pytest.mark.parametrize("place", [3, 10, 19, 24, 32])
def test_table_is_what_the_coarsest_mesh_gives(place):
    """Five rows of the table, fillets, rim, taper, cone and hat, are met by the coarsest mesh to 2e-4, from below."""
    kind, row = TABLE[place]
    dimensions = {name: size for name, size in row.items() if name in triangle_torsion.DIMENSIONS}
    shortfall = 1 - windup_integral(kind, dimensions, 1) / row["integral_per_m3"]
    assert 0 < shortfall < 2e-4


@pytest.mark.slow
def test_one_row_in_full():
    """The table's first hat has its integral and its error."""
    kind, row = next((kind, row) for kind, row in TABLE if kind == "hat")
    dimensions = {name: size for name, size in row.items() if name in triangle_torsion.DIMENSIONS}
    integral, error = triangle_torsion.checked_windup_integral(kind, dimensions)
    assert integral == pytest.approx(row["integral_per_m3"], rel=1e-7)
    assert error < 1e-6


@pytest.mark.parametrize(
    ("kind", "row"), list(_rows("elasticity_reference.csv")), ids=[f"row{place}" for place in range(2, 10)]
)
def test_published_elasticity(kind, row):
    """The eight published wind-ups lie at most 0.06 % below, the tapered disk's line ending at the outer wall."""
    size = {name.rpartition("_")[0]: value for name, value in row.items() if not name.endswith("_windup_rad")}
    factor = size.pop("torque") / (2 * math.pi * size.pop("shear_modulus"))
    if "disk_hub_thickness" in size:
        hub, disk = size["disk_hub_thickness"], size["disk_thickness"]
        reach = size["mean_radius"] - size["disk_inner_radius"]
        size["disk_thickness"] = hub + (disk - hub) * reach / (reach + size["wall_thickness"] / 2)
    excess = factor * windup_integral(kind, size, 1) / row["elasticity_windup_rad"] - 1
    assert 0 < excess < 6e-4
