"""The finite elements of a half-section: scikit-fem's mesh of its lattice, and what loads and holds the nodes."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from flexlash.mechanics.elasticity.half_section import HalfSection
from flexlash.schema.arrays import Array

__all__ = ["face_shares", "section_mesh"]


def face_shares(section: HalfSection) -> Array:
    """Return the length of the loaded face that belongs to each node of the lattice [m]: the integral of its shape."""
    shares = np.zeros_like(section.radius)
    low, middle, high = slice(None, -2, 2), slice(1, -1, 2), slice(2, None, 2)
    for axis in (0, 1):
        along, height, loaded = (np.moveaxis(nodes, axis, 0) for nodes in (shares, section.height, section.loaded))
        is_edge = np.logical_and.reduce([loaded[nodes] for nodes in (low, middle, high)])
        length = np.where(is_edge, np.abs(height[high] - height[low]), 0.0)
        for nodes, share in ((low, 1 / 6), (middle, 4 / 6), (high, 1 / 6)):
            along[nodes] += share * length
    return shares


def section_mesh(section: HalfSection) -> tuple[Any, Any]:
    """Return the mesh of a half-section, its cells in the lattice's order, and the number of each node, -1 for none."""
    from skfem import ElementQuad2, MeshQuad1, MeshQuad2
    from skfem.assembly import Dofs

    columns, rows = np.nonzero(section.cells)
    shape = section.radius.shape
    turns = ((0, 0), (2, 0), (2, 2), (0, 2))
    corners = np.stack([(2 * columns + right) * shape[1] + 2 * rows + up for right, up in turns])
    lattice, cells = np.unique(corners, return_inverse=True)
    straight = MeshQuad1(
        np.stack([section.radius.ravel()[lattice], section.height.ravel()[lattice]]), cells.reshape(corners.shape)
    )
    node = np.stack(np.unravel_index(lattice, shape))
    nodes = Dofs(straight, ElementQuad2())
    positions = np.empty((2, nodes.N), dtype=np.int64)
    positions[:, nodes.nodal_dofs[0]] = node
    positions[:, nodes.facet_dofs[0]] = node[:, straight.facets].sum(axis=1) // 2
    positions[:, nodes.interior_dofs[0]] = node[:, straight.t].sum(axis=1) // 4
    columns, rows = positions
    number = np.full(shape, -1)
    number[columns, rows] = np.arange(nodes.N)
    curved = replace(
        MeshQuad2.from_mesh(straight), doflocs=np.stack([section.radius[columns, rows], section.height[columns, rows]])
    )
    return curved, number
