"""An independent oracle for the torsion of cups and hats: quadratic triangles on the half-section.

A body of revolution under the torque T twists by φ(r, z) with ∇·(G r³ ∇φ) = 0 on its half-section, φ = 0 on the
clamped edge, no flux through the free edges and the flux density r³/∫r³dr at the open end. Its wind-up is
U = T/(2πG) · I with I [1/m³] the flux-weighted mean of φ at the open end. Everything here is written from these
equations; nothing comes from flexlash.

The half-section is a chain of ruled patches, each between an inner and an outer curve. Their quadrilaterals are
halved into curved six-node triangles whose size shrinks by a power law towards the corners where the gradient is
singular. The twist gives I from below; the stress function ψ, which solves ∇·(r⁻³ ∇ψ) = 0, gives it from above.

`python tests/support/triangle_torsion.py` rewrites `references/triangle_torsion.csv`.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import splu
from scipy.spatial import cKDTree

TABLE = Path(__file__).parents[1] / "references" / "triangle_torsion.csv"
DIMENSIONS = (
    "mean_radius",
    "wall_thickness",
    "cylinder_length",
    "disk_thickness",
    "disk_hub_thickness",
    "disk_thickness_exponent",
    "disk_cone_angle",
    "disk_inner_radius",
    "disk_outer_radius",
    "hub_fillet_radius",
    "junction_fillet_radius",
    "rim_length",
    "rim_thickness",
)
REFINEMENTS = (1, 2, 4)
FEATURES = (
    (3, "sharp corners"),
    (4, "fillets"),
    (2, "large fillets"),
    (2, "rim"),
    (4, "fillets rim"),
    (2, "taper"),
    (3, "taper fillets rim"),
    (1, "power 1"),
    (1, "power 2"),
    (1, "power 3"),
    (1, "power 2 fillets rim"),
    (1, "cone 45"),
    (1, "cone 60"),
    (1, "cone 75"),
    (1, "cone 60 taper rim"),
    (3, "hat"),
    (3, "hat rim"),
)

# Quadratic elements keep their order beside a 270° corner, where φ ~ d^(2/3), when the grading exceeds 2/(2/3) = 3.
_GRADING = 3.5
_SAME_POINT = 1e-11  # of the mean radius; the smallest element is ten thousand times larger
_CORNERS = np.array([[0, 1, 2], [1, 2, 0]])
_GAUSS, _GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(4)


@dataclass(frozen=True, kw_only=True)
class Patch:
    """A piece of the half-section, ruled between two curves of one parameter, finest beside its marks."""

    inner: Callable[[np.ndarray], tuple]
    outer: Callable[[np.ndarray], tuple]
    start: float
    end: float
    marks: tuple[tuple[float, float], ...] = ()
    even: float = 12.0


@dataclass(frozen=True, kw_only=True)
class Mesh:
    """Points (points, 2) and six-node triangles (triangles, 6): three corners, then the middles of sides 01, 12, 20."""

    points: np.ndarray
    triangles: np.ndarray


def spacing(start: float, end: float, marks: Sequence[tuple[float, float]], even: float, refinement: int) -> np.ndarray:
    """Return growing places from start to end: even elements and four a mark (place, scale), graded."""

    def elements_before(place: np.ndarray) -> np.ndarray:
        total = even * (place - start) / (end - start)
        for mark, scale in marks:
            distance = np.abs(place - mark) / scale
            near = np.minimum(distance, 1) ** (1 / _GRADING)
            total = total + 4 * np.sign(place - mark) * (near + np.log(np.maximum(distance, 1)) / _GRADING)
        return total

    first, last = elements_before(np.array([start, end]))
    wanted = np.linspace(first, last, math.ceil(last - first) * refinement + 1)[1:-1]
    low, high = np.full(wanted.shape, start), np.full(wanted.shape, end)
    for _ in range(80):
        middle = (low + high) / 2
        short = elements_before(middle) < wanted
        low, high = np.where(short, middle, low), np.where(short, high, middle)
    return np.concatenate([[start], low, [end]])


def _with_middles(places: np.ndarray) -> np.ndarray:
    """Return the places with the middle of every two neighbours between them."""
    both = np.empty(2 * places.size - 1)
    both[::2], both[1::2] = places, (places[1:] + places[:-1]) / 2
    return both


def _patch_mesh(patch: Patch, refinement: int) -> Mesh:
    """Return the triangles of one patch, two a quadrilateral."""
    along = _with_middles(spacing(patch.start, patch.end, patch.marks, patch.even, refinement))
    across = _with_middles(spacing(0, 1, ((0, 1), (1, 1)), 0, refinement))
    inner, outer = (
        np.stack(np.broadcast_arrays(*curve(along)), axis=-1)[:, None] for curve in (patch.inner, patch.outer)
    )
    points = inner + across[:, None] * (outer - inner)
    steps = np.stack(np.meshgrid(np.arange(0, along.size - 1, 2), np.arange(0, across.size - 1, 2)), axis=-1)
    steps = steps.reshape(-1, 1, 2)
    halves = [steps + np.array(half) for half in ([(0, 0), (2, 0), (2, 2)], [(0, 0), (2, 2), (0, 2)])]
    corners = np.concatenate(halves)
    nodes = np.concatenate([corners, (corners[:, _CORNERS[0]] + corners[:, _CORNERS[1]]) // 2], axis=1)
    return Mesh(points=points.reshape(-1, 2), triangles=nodes[..., 0] * across.size + nodes[..., 1])


def mesh(patches: Sequence[Patch], refinement: int) -> Mesh:
    """Return the triangles of all patches, joined where their points coincide."""
    pieces = [_patch_mesh(patch, refinement) for patch in patches]
    points = np.concatenate([piece.points for piece in pieces])
    shifts = np.cumsum([0, *(len(piece.points) for piece in pieces[:-1])])
    triangles = np.concatenate([piece.triangles + shift for piece, shift in zip(pieces, shifts, strict=True)])
    pairs = cKDTree(points).query_pairs(_SAME_POINT, output_type="ndarray")
    same = coo_array((np.ones(len(pairs)), pairs.T), shape=(len(points),) * 2)
    _, names = connected_components(same, directed=False)
    _, chosen = np.unique(names, return_index=True)
    return Mesh(points=points[chosen], triangles=names[triangles])


def _shapes(first: float, second: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the six quadratic shape functions (6,) and their slopes (6, 2) at a point of the unit triangle."""
    area = np.array([1 - first - second, first, second])
    slope = np.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]])
    one, other = _CORNERS
    values = np.concatenate([area * (2 * area - 1), 4 * area[one] * area[other]])
    middles = 4 * (area[one, None] * slope[other] + area[other, None] * slope[one])
    return values, np.concatenate([(4 * area - 1)[:, None] * slope, middles])


def _inside_points() -> Iterator[tuple[float, float, float]]:
    """Yield the points and weights of a sixteen-point rule on the unit triangle, exact to the sixth degree."""
    for place, weight in zip((1 + _GAUSS) / 2, _GAUSS_WEIGHTS / 2, strict=True):
        for fraction, share in zip((1 + _GAUSS) / 2, _GAUSS_WEIGHTS / 2, strict=True):
            yield place, fraction * (1 - place), weight * share * (1 - place)


def _solve(matrix: csr_array, given: np.ndarray, known: np.ndarray, load: np.ndarray) -> np.ndarray:
    """Return the values at all points from a load, the given points' values being known."""
    free = np.flatnonzero(~given)
    values = np.where(given, known, 0.0)
    rest = (load - matrix @ values)[free]
    inner = matrix[free][:, free].tocsc()
    values[free] = splu(
        inner, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
    ).solve(rest)
    return values


def stiffness(body: Mesh, power: int) -> csr_array:
    """Return the matrix of ∫ r^power ∇u·∇v over the half-section; raise ValueError where a triangle is folded."""
    corners = body.points[body.triangles]
    entries = np.zeros((len(corners), 6, 6))
    orientations = []
    for first, second, weight in _inside_points():
        values, slopes = _shapes(first, second)
        (a, b), (c, d) = np.moveaxis(corners.transpose(0, 2, 1) @ slopes, 0, -1)
        area = a * d - b * c
        inverse = np.moveaxis(np.array([[d, -b], [-c, a]]), -1, 0)
        gradient = slopes @ inverse
        factor = weight * (corners[..., 0] @ values) ** power / np.abs(area)
        entries += factor[:, None, None] * (gradient @ gradient.transpose(0, 2, 1))
        orientations.append(np.sign(area))
    if np.ptp(orientations, axis=0).any():
        raise ValueError("a triangle is folded: the fillets leave no room for each other")
    rows, columns = np.repeat(body.triangles, 6, axis=1), np.tile(body.triangles, 6)
    shape = (len(body.points),) * 2
    return coo_array((entries.ravel(), (rows.ravel(), columns.ravel())), shape=shape).tocsr()


def _boundary(body: Mesh) -> np.ndarray:
    """Return the edges (edges, 3) of one triangle only: two ends and the middle."""
    sides = np.concatenate([body.triangles[:, [0, 1, 3]], body.triangles[:, [1, 2, 4]], body.triangles[:, [2, 0, 5]]])
    _, first, count = np.unique(sides[:, 2], return_index=True, return_counts=True)
    return sides[first[count == 1]]


def _end_flux(body: Mesh, loaded: np.ndarray) -> np.ndarray:
    """Return the share of the unit flux that enters at each point, its density ∝ r³ along the loaded edges."""
    edges = _boundary(body)
    edges = edges[loaded[edges].all(axis=1)]
    ends = body.points[edges]
    load = np.zeros(len(body.points))
    for place, weight in zip(_GAUSS, _GAUSS_WEIGHTS, strict=True):
        values = np.array([place * (place - 1) / 2, place * (place + 1) / 2, 1 - place**2])
        slopes = np.array([place - 0.5, place + 0.5, -2 * place])
        length = np.linalg.norm(np.einsum("eni,n->ei", ends, slopes), axis=1)
        flux = weight * length * (ends[..., 0] @ values) ** 3
        np.add.at(load, edges, flux[:, None] * values)
    return load / load.sum()


def twist_integral(body: Mesh, clamped: np.ndarray, loaded: np.ndarray) -> float:
    """Return I from the twist φ, a lower bound; clamped and loaded mark points (points,) of the two edges."""
    load = _end_flux(body, loaded)
    twist = _solve(stiffness(body, 3), clamped, np.zeros(len(load)), load)
    return float(load @ twist)


def stress_integral(body: Mesh, clamped: np.ndarray, loaded: np.ndarray) -> float:
    """Return I from the stress function ψ, an upper bound; ψ is 0 on one free edge, 1 on the other."""
    edges = _boundary(body)
    free = edges[~loaded[edges].all(axis=1) & ~clamped[edges].all(axis=1)]
    links = coo_array((np.ones(2 * len(free)), np.concatenate([free[:, [0, 2]], free[:, [1, 2]]]).T))
    links.resize((len(body.points),) * 2)
    _, names = connected_components(links, directed=False)
    place = np.flatnonzero(loaded)
    corners = place[np.isin(place, free)]
    place = place[np.argsort(np.linalg.norm(body.points[place] - body.points[corners[0]], axis=1))]
    radius, step = body.points[place, 0], np.linalg.norm(np.diff(body.points[place], axis=0), axis=1)
    flux = step * (radius[1:] ** 3 + (radius[1:] + radius[:-1]) ** 3 / 2 + radius[:-1] ** 3) / 6
    known = (names == names[corners[1]]).astype(float)
    known[place] = np.concatenate([[0], np.cumsum(flux)]) / flux.sum()
    given = loaded | np.isin(names, names[corners])
    matrix = stiffness(body, -3)
    stress = _solve(matrix, given, known, np.zeros(len(known)))
    return float(stress @ matrix @ stress)


def _disk_thickness(size: dict[str, float]) -> Callable[[np.ndarray], np.ndarray]:
    """Return the thickness of the disk over the radius, both in mean radii."""
    if "disk_thickness_exponent" in size:
        return lambda r: size["disk_hub_thickness"] * (size["disk_inner_radius"] / r) ** size["disk_thickness_exponent"]
    even = size.get("disk_thickness", size["wall_thickness"])
    hub = size.get("disk_hub_thickness", even)
    if hub == even:
        return lambda r: even + 0 * r
    return lambda r: hub + (even - hub) * (r - size["disk_inner_radius"]) / (1 - size["disk_inner_radius"])


def _disk_faces(size: dict[str, float]) -> tuple[Callable, Callable]:
    """Return the inner and the lower face of a cup's disk without its fillets, z over r, in mean radii."""
    thickness = _disk_thickness(size)
    bore, angle = 1 - size["wall_thickness"] / 2, size.get("disk_cone_angle", math.pi / 2)
    if angle == math.pi / 2:
        return lambda r: 0 * r, lambda r: -thickness(r)

    def inner(r: np.ndarray) -> np.ndarray:
        return np.minimum(r - bore, 0) / math.tan(angle)

    return inner, lambda r: inner(r) - thickness(np.minimum(r, bore)) / math.sin(angle)


def _disk_patches(size: dict[str, float]) -> Iterator[Patch]:
    """Yield a cup's disk from the hub, with its fillet, to the wall's bore or to the junction fillet."""
    inner, lower = _disk_faces(size)
    start, fillet = size["disk_inner_radius"], size.get("hub_fillet_radius", 0.0)
    if fillet:
        yield Patch(
            inner=lambda q: (start + fillet * (1 - np.cos(q)), fillet * (1 - np.sin(q))),
            outer=lambda q: (start + fillet * q * 2 / math.pi, lower(start + fillet * q * 2 / math.pi)),
            start=0,
            end=math.pi / 2,
        )
    ends = (start + fillet, 1 - size["wall_thickness"] / 2 - size.get("junction_fillet_radius", 0.0))
    if ends[0] >= ends[1]:
        raise ValueError("the fillets leave no disk between them")
    yield Patch(
        inner=lambda r: (r, inner(r)),
        outer=lambda r: (r, lower(r)),
        start=ends[0],
        end=ends[1],
        marks=tuple((end, 2 * float(inner(end) - lower(end))) for end in ends),
    )


def _corner_patches(size: dict[str, float]) -> Iterator[Patch]:
    """Yield a cup's corner of disk and wall: one block, or the two halves of the bend round the junction fillet."""
    _, lower = _disk_faces(size)
    wall, fillet = size["wall_thickness"], size.get("junction_fillet_radius", 0.0)
    bore, outside = 1 - wall / 2, 1 + wall / 2
    if not fillet:
        yield _block(bore, wall, lower)
        return

    def arc(q: np.ndarray) -> tuple:
        return bore - fillet * (1 - np.sin(q)), fillet * (1 - np.cos(q))

    def below(q: np.ndarray) -> tuple:
        radius = bore - fillet + (fillet + wall) * q * 4 / math.pi
        return radius, lower(radius)

    def beside(q: np.ndarray) -> tuple:
        return outside, lower(outside) + (fillet - lower(outside)) * (q * 4 / math.pi - 1)

    yield Patch(inner=arc, outer=below, start=0, end=math.pi / 4)
    yield Patch(inner=arc, outer=beside, start=math.pi / 4, end=math.pi / 2)


def _block(bore: float, wall: float, lower: Callable) -> Patch:
    """Return the block under the wall, as fine from left to right as every patch is from face to face."""
    return Patch(
        inner=lambda u: (bore + wall * u, 0 * u),
        outer=lambda u: (bore + wall * u, lower(bore + wall * u)),
        start=0,
        end=1,
        marks=((0, 1), (1, 1)),
        even=0,
    )


def _flange_patches(size: dict[str, float]) -> Iterator[Patch]:
    """Yield a hat's block under the wall and its flange out to the clamped edge."""
    wall, thickness = size["wall_thickness"], _disk_thickness(size | {"disk_inner_radius": 0.0})
    ends = (1 + wall / 2, size["disk_outer_radius"])
    yield _block(1 - wall / 2, wall, lambda r: -thickness(r))
    yield Patch(
        inner=lambda r: (r, 0 * r),
        outer=lambda r: (r, -thickness(r)),
        start=ends[0],
        end=ends[1],
        marks=tuple((end, 2 * float(thickness(end))) for end in ends),
    )


def _tube(inner: float, outer: float, start: float, end: float, marks: tuple) -> Patch:
    """Return a piece of wall between two radii."""
    return Patch(inner=lambda z: (inner, z), outer=lambda z: (outer, z), start=start, end=end, marks=marks)


def _wall_patches(size: dict[str, float]) -> Iterator[Patch]:
    """Yield the wall above the disk's inner face or fillet, and the rim round its end."""
    wall, length, start = size["wall_thickness"], size["cylinder_length"], size.get("junction_fillet_radius", 0.0)
    bore, outside = 1 - wall / 2, 1 + wall / 2
    if "rim_length" not in size:
        yield _tube(bore, outside, start, length, ((start, 2 * wall),))
        return
    step = length - size["rim_length"]
    yield _tube(bore, outside, start, step, ((start, 2 * wall), (step, 2 * wall)))
    yield _tube(bore, outside, step, length, ((step, 2 * wall),))
    yield _tube(outside, bore + size["rim_thickness"], step, length, ((step, 2 * wall),))


def half_section(flexspline_type: str, size: dict[str, float]) -> list[Patch]:
    """Return the patches of a cup or hat whose dimensions are in mean radii."""
    if flexspline_type == "hat":
        return [*_flange_patches(size), *_wall_patches(size)]
    return [*_disk_patches(size), *_corner_patches(size), *_wall_patches(size)]


def _in_mean_radii(dimensions: dict[str, float]) -> dict[str, float]:
    """Return the dimensions with every length over the mean radius."""
    pure = {"disk_cone_angle", "disk_thickness_exponent"}
    return {name: size if name in pure else size / dimensions["mean_radius"] for name, size in dimensions.items()}


def _meshed(flexspline_type: str, size: dict[str, float], refinement: int) -> tuple[Mesh, np.ndarray, np.ndarray]:
    """Return the mesh and the marks of its clamped and its loaded points."""
    body = mesh(half_section(flexspline_type, size), refinement)
    held = size["disk_outer_radius" if flexspline_type == "hat" else "disk_inner_radius"]
    clamped, loaded = np.abs(body.points - (held, size["cylinder_length"])).T < _SAME_POINT
    return body, clamped, loaded


def windup_integral(flexspline_type: str, dimensions: dict[str, float], refinement: int) -> float:
    """Return the wind-up integral I [1/m³] on one mesh, from below; U = T/(2πG) · I."""
    integral = twist_integral(*_meshed(flexspline_type, _in_mean_radii(dimensions), refinement))
    return integral / dimensions["mean_radius"] ** 3


def extrapolated(values: Sequence[float]) -> float:
    """Return the limit of three values on meshes each twice as fine as the last (Richardson)."""
    coarse, middle, fine = values
    ratio = (middle - coarse) / (fine - middle) if fine != middle else math.inf
    return fine + (fine - middle) / (min(max(ratio, 4.0), 16.0) - 1)


def checked_windup_integral(flexspline_type: str, dimensions: dict[str, float]) -> tuple[float, float]:
    """Return I [1/m³] extrapolated from three meshes, and the relative error it may have.

    The error is the farther of the two bounds, twist and stress function, on the finest mesh.
    """
    size = _in_mean_radii(dimensions)
    bodies = [_meshed(flexspline_type, size, refinement) for refinement in REFINEMENTS]
    from_below = [twist_integral(*body) for body in bodies]
    limit = extrapolated(from_below)
    error = max(limit - from_below[-1], abs(stress_integral(*bodies[-1]) - limit)) / limit
    return limit / dimensions["mean_radius"] ** 3, error


def _disk_draw(features: str, radius: float, wall: float, draw: Callable[[float, float], float]) -> dict[str, float]:
    """Return the thickness of a disk, in metres, for the words taper, power and a number, cone and degrees."""
    words = features.split()
    if "power" in words:
        exponent = float(words[words.index("power") + 1])
        return {"disk_hub_thickness": wall * draw(1.2, 3), "disk_thickness_exponent": exponent}
    size = {} if draw(0, 1) < 0.3 and "taper" not in words else {"disk_thickness": wall * draw(0.8, 2.5)}
    if "taper" in words:
        size["disk_hub_thickness"] = size["disk_thickness"] * draw(1.2, 3)
    if "cone" in words:
        size["disk_cone_angle"] = math.radians(float(words[words.index("cone") + 1]))
    if "hat" in words:
        size = {"disk_thickness": wall * draw(1, 3), "disk_outer_radius": radius * draw(1.2, 1.7)}
    return size


def _draw(features: str, draw: Callable[[float, float], float]) -> dict[str, float]:
    """Return the dimensions of one cup or hat with the named features, lengths rounded to 0.01 mm."""
    radius = math.exp(draw(math.log(0.015), math.log(0.120)))
    wall = radius * draw(0.01, 0.03)
    size = {"mean_radius": radius, "wall_thickness": wall, "cylinder_length": radius * draw(0.7, 2.2)}
    size |= _disk_draw(features, radius, wall, draw)
    if "hat" not in features:
        # A disk that thins with a power of the radius would be a foil at the wall if its hub were small.
        size["disk_inner_radius"] = radius * (draw(0.5, 0.6) if "power" in features else draw(0.3, 0.6))
    if "fillets" in features:
        low, high = (3, 6) if "large" in features else (0.5, 3)
        size["hub_fillet_radius"] = size.get("disk_thickness", wall) * draw(low, high)
        size["junction_fillet_radius"] = wall * draw(low, high)
    if "rim" in features:
        size |= {"rim_length": size["cylinder_length"] * draw(0.1, 0.25), "rim_thickness": wall * draw(1.5, 2.5)}
    pure = {"disk_cone_angle", "disk_thickness_exponent"}
    return {name: value if name in pure else round(value, 5) for name, value in size.items()}


def geometries() -> Iterator[tuple[str, dict[str, float]]]:
    """Yield the type and the dimensions [SI] of every drawn geometry of the table, always the same ones."""
    generator = np.random.default_rng(20260401)
    for count, features in FEATURES:
        for _ in range(count):
            yield "hat" if "hat" in features else "cup", _draw(features, lambda *ends: float(generator.uniform(*ends)))


def write_table() -> None:
    """Write the drawn geometries with I [1/m³] and its error."""
    with TABLE.open("w", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(
            file, ["flexspline_type", *DIMENSIONS, "integral_per_m3", "relative_error"], lineterminator="\n"
        )
        table.writeheader()
        for flexspline_type, dimensions in geometries():
            integral, error = checked_windup_integral(flexspline_type, dimensions)
            found = {"integral_per_m3": repr(integral), "relative_error": f"{error:.1e}"}
            table.writerow({"flexspline_type": flexspline_type} | dimensions | found)


if __name__ == "__main__":
    write_table()
