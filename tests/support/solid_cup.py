"""A quarter of a cup as a solid of hexahedra, apart from `flexlash.mechanics` and without Fourier series.

The displacement is that of elasticity in x, y and z on curved hexahedra of second order (scikit-fem's 27 nodes); only
the unknowns are turned into radial, tangential and axial ones, since the bearing holds the bore in radial direction.
Two opposite arcs are loaded, so that a quarter is enough: on both of its planes radial and axial displacement vanish.
Corners are sharp; a cup has a rim.
"""

from dataclasses import replace

import numpy as np
from scipy.sparse import bmat, diags
from scipy.sparse.linalg import spsolve
from skfem import Basis, BilinearForm, ElementHex2, FacetBasis, LinearForm, MeshHex1, MeshHex2

__all__ = ["solid_windup"]


def _lines(*stretches):
    """Return mesh lines over stretches (start, end, pieces), finer towards both ends of each."""
    lines = [stretches[0][0]]
    for start, end, pieces in stretches:
        share = np.arange(1, pieces + 1) / pieces
        lines.extend(start + (end - start) * (1 - np.cos(np.pi * share)) / 2)
    return np.array(lines)


def _box(size, bearing_width, fineness):
    """Return the mesh of the quarter in radius, angle and height."""
    bore, outside = size["mean_radius"] - size["wall_thickness"] / 2, size["mean_radius"] + size["wall_thickness"] / 2
    rim, length = bore + size["rim_thickness"], size["cylinder_length"]
    step, middle = length - size["rim_length"], length - size["tooth_face_width"] / 2
    low, high = middle - bearing_width / 2, middle + bearing_width / 2
    radii = _lines((size["disk_inner_radius"], bore, 3 * fineness), (bore, outside, fineness), (outside, rim, fineness))
    heights = _lines(
        (-size["disk_thickness"], 0.0, fineness),
        (0.0, step, 3 * fineness),
        (step, low, fineness),
        (low, high, 2 * fineness),
        (high, length, fineness),
    )
    box = MeshHex1.init_tensor(radii, np.linspace(0, np.pi / 2, 6 * fineness + 1), heights)
    radius, _, height = box.p[:, box.t].mean(axis=1)
    in_disk, in_wall, in_rim = height < 0, radius > bore, height > step
    return box.restrict(np.nonzero(np.where(in_disk, radius < outside, in_wall & (in_rim | (radius < outside))))[0])


def _stiffness(basis, youngs_modulus, poisson_ratio):
    """Return the stiffness of an isotropic solid in x, y and z, block by block."""
    shear = youngs_modulus / (2 * (1 + poisson_ratio))
    lame = youngs_modulus * poisson_ratio / ((1 + poisson_ratio) * (1 - 2 * poisson_ratio))
    products = [
        [BilinearForm(lambda u, v, _, a=a, b=b: v.grad[a] * u.grad[b]).assemble(basis) for b in range(3)]
        for a in range(3)
    ]
    trace = products[0][0] + products[1][1] + products[2][2]
    return bmat(
        [[lame * products[a][b] + shear * products[b][a] + (shear * trace if a == b else 0 * trace) for b in range(3)]
         for a in range(3)]
    ).tocsr()  # fmt: skip


def solid_windup(size, *, bearing_width, arc, fineness):
    """Return the wind-up over the torque [rad/(N·m)] of a cup with a rim as long as its teeth are wide.

    The load on the face goes as cos(π θ/(2 arc)) over ± arc. A bearing of no width holds nothing.
    """
    box = _box(size, bearing_width, fineness)
    straight = MeshHex2.from_mesh(box)
    radius, angle, height = straight.doflocs
    solid = replace(straight, doflocs=np.stack([radius * np.cos(angle), radius * np.sin(angle), height]))
    element, slack = ElementHex2(), 1e-9
    basis = Basis(solid, element, intorder=5)
    x, y, height = basis.doflocs
    radius, angle = np.hypot(x, y), np.arctan2(y, x)
    bore = size["mean_radius"] - size["wall_thickness"] / 2
    rim, start = bore + size["rim_thickness"], size["cylinder_length"] - size["tooth_face_width"]
    middle = size["cylinder_length"] - size["tooth_face_width"] / 2

    def on_face(x):
        return (np.hypot(x[0], x[1]) > rim - 0.3 * (rim - bore) / fineness) & (x[2] > start + slack)

    facets = solid.facets_satisfying(on_face, boundaries_only=True)
    facets = facets[np.abs(np.hypot(*solid.p[:2, solid.facets[:, facets]]) - rim).max(axis=0) < 1e-6]
    face = FacetBasis(solid, element, facets=facets, intorder=7)

    def traction(w):
        at = np.arctan2(w.x[1], w.x[0])
        return np.where(at < arc, np.cos(np.pi * at / (2 * arc)), 0.0)

    def tangent(w, axis):
        return (-w.x[1], w.x[0])[axis] / np.hypot(w.x[0], w.x[1])

    load = [LinearForm(lambda v, w, axis=axis: traction(w) * tangent(w, axis) * v).assemble(face) for axis in (0, 1)]
    torque = (LinearForm(lambda v, w: traction(w) * np.hypot(w.x[0], w.x[1]) * v).assemble(face)).sum()
    cosine, sine, one = diags(np.cos(angle)), diags(np.sin(angle)), diags(np.ones(len(angle)))
    turn = bmat([[cosine, -sine, None], [sine, cosine, None], [None, None, one]]).tocsr()
    stiffness = turn.T @ _stiffness(basis, size["youngs_modulus"], size["poisson_ratio"]) @ turn
    force = turn.T @ np.concatenate([*load, np.zeros(basis.N)])
    on_plane = (angle < slack) | (angle > np.pi / 2 - slack)
    hub = radius < size["disk_inner_radius"] * (1 + 1e-6)
    held = (np.abs(radius - bore) < 1e-6 * bore) & (np.abs(height - middle) <= bearing_width / 2 + slack)
    held &= bearing_width > 0
    fixed = np.concatenate([on_plane | hub | held, hub, on_plane | hub])
    free = np.nonzero(~fixed)[0]
    moved = spsolve(stiffness[free][:, free].tocsc(), force[free])
    # The torque of all four quarters.
    return force[free] @ moved / torque / (4 * torque)
