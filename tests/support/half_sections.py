"""Shapes of half-sections, and what is read from their lattice."""

import math

import numpy as np

TUBE = {"mean_radius": 1.0, "wall_thickness": 0.03, "cylinder_length": 1.2}

CUP = TUBE | {"disk_inner_radius": 0.4}

HAT = TUBE | {"disk_outer_radius": 1.5, "disk_thickness": 0.05}

HUB_FILLET, JUNCTION_FILLET = {"hub_fillet_radius": 0.05}, {"junction_fillet_radius": 0.15}

FILLETS = HUB_FILLET | JUNCTION_FILLET

TAPER = {"disk_thickness": 0.05, "disk_hub_thickness": 0.1}

RIM = {"rim_length": 0.2, "rim_thickness": 0.07}

CONE = {"disk_cone_angle": math.pi / 6}

GAUSS, WEIGHTS = np.polynomial.legendre.leggauss(3)

VALUES = np.stack([GAUSS * (GAUSS - 1) / 2, 1 - GAUSS**2, GAUSS * (GAUSS + 1) / 2])

SLOPES = np.stack([GAUSS - 0.5, -2 * GAUSS, GAUSS + 0.5])


def _disk_draw(draw, radius, wall):
    """Return an even, tapered, power-law or conical disk without fillets, thicker or thinner at the hub."""
    inner = {"disk_inner_radius": radius * draw(0.1, 0.85)}
    profile = draw(0, 5)
    if profile < 1:
        return inner
    if profile < 2:
        # A disk that thins with a power of the radius would be a foil at the wall if its hub were small.
        inner = {"disk_inner_radius": radius * draw(0.4, 0.85)}
        return inner | {"disk_hub_thickness": wall * draw(1, 4), "disk_thickness_exponent": draw(0.2, 4)}
    size = inner | {"disk_thickness": wall * draw(0.5, 4)}
    if profile > 3:
        size["disk_hub_thickness"] = wall * draw(0.5, 5)
    if profile > 4:
        size["disk_cone_angle"] = math.radians(draw(30, 90))
    return size


def _fillets_draw(draw, width):
    """Return fillets from a ten-thousandth of the disk's width to the whole of it, one, both or none of them."""
    choice = draw(0, 5)
    hub = width * (draw(0.1, 0.9) if choice < 1 else 10 ** draw(-4, 0))
    junction = width - hub if choice < 1 else (width - hub) * 10 ** draw(-4, 0)
    if choice > 4:
        return {}
    both = {"hub_fillet_radius": hub, "junction_fillet_radius": junction}
    if choice > 3:
        del both["hub_fillet_radius" if choice > 3.5 else "junction_fillet_radius"]
    return both


def _length_draw(draw, size):
    """Return the length and perhaps a rim, as thick as the wall or thicker, sometimes right from the fillet on."""
    fillet = size.get("junction_fillet_radius", 0.0)
    length = fillet + size["mean_radius"] * draw(0.2, 3)
    choice = draw(0, 4)
    if choice > 3:
        return {"cylinder_length": length}
    rim = length - fillet if choice < 1 and fillet else (length - fillet) * draw(0.05, 0.95)
    thickness = size["wall_thickness"] * (1 if choice > 2 else draw(1, 3))
    return {"cylinder_length": length, "rim_length": rim, "rim_thickness": thickness}


def random_shapes(count, seed):
    """Yield the type and the dimensions [SI] of cups, hats and cylinders with all their features, always the same."""
    generator = np.random.default_rng(seed)

    def draw(low, high):
        return float(generator.uniform(low, high))

    for place in range(count):
        kind = ("cup", "cup", "cup", "hat", "cylinder")[place % 5]
        radius = math.exp(draw(math.log(0.01), math.log(0.15)))
        wall = radius * math.exp(draw(math.log(0.005), math.log(0.15)))
        size = {"mean_radius": radius, "wall_thickness": wall}
        if kind == "cup":
            size |= _disk_draw(draw, radius, wall)
            if "disk_cone_angle" not in size:
                size |= _fillets_draw(draw, radius - wall / 2 - size["disk_inner_radius"])
        elif kind == "hat":
            size |= {"disk_thickness": wall * draw(0.5, 4), "disk_outer_radius": radius * draw(1.1, 1.8)}
            size |= {"disk_cone_angle": math.radians(draw(30, 90))} if draw(0, 1) < 0.3 else {}
        yield kind, size | _length_draw(draw, size)


def cell_nodes(section):
    """Return the places of every cell's nodes (cells, 3, 3, 2)."""
    column, row = np.nonzero(section.cells)
    steps = np.arange(3)
    columns, rows = (2 * column[:, None] + steps)[:, :, None], (2 * row[:, None] + steps)[:, None, :]
    return np.stack([section.radius[columns, rows], section.height[columns, rows]], axis=-1)


def jacobians(section):
    """Return the Jacobian of every cell's biquadratic map at three by three Gauss points (cells, 3, 3)."""
    nodes = cell_nodes(section)
    along = np.einsum("ia,jb,cijx->cabx", SLOPES, VALUES, nodes)
    across = np.einsum("ia,jb,cijx->cabx", VALUES, SLOPES, nodes)
    return along[..., 0] * across[..., 1] - along[..., 1] * across[..., 0]
