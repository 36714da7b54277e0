"""A picture of a half-section coloured by shear stress: the whole to scale, and its corners from near."""

from __future__ import annotations

import io
from typing import Any

import numpy as np

from flexlash.mechanics.elasticity.twist import ElasticityCheck
from flexlash.report.layout.styles import PALETTE
from flexlash.schema.arrays import Array

__all__ = ["PICTURE_SIZE", "section_png"]

PICTURE_SIZE = (640, 540)
"""Width and height of the picture [px]."""

_DOTS = 100
_MILLIMETRE = 1e-3
_MEGAPASCAL = 1e6


def section_png(check: ElasticityCheck, greatest: float) -> bytes:
    """Return the picture as PNG; colours end at `greatest` [Pa], beyond which only singular corners lie."""
    import matplotlib as mpl
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.tri import Triangulation

    radius, height, triangles, stress = _triangles(check)
    with mpl.rc_context(), io.BytesIO() as buffer:
        mpl.rcParams.update(mpl.rcParamsDefault)
        figure = Figure(figsize=(PICTURE_SIZE[0] / _DOTS, PICTURE_SIZE[1] / _DOTS), dpi=_DOTS, layout="constrained")
        FigureCanvasAgg(figure)
        mesh = Triangulation(radius, height, triangles)
        details = check.section.details
        whole, *near = _axes(figure, len(details))
        for axes, size in ((whole, 8), *((axes, 7) for axes in near)):
            drawn = axes.tripcolor(mesh, stress, shading="gouraud", cmap="cividis", vmin=0, vmax=greatest / _MEGAPASCAL)
            axes.set_aspect("equal")
            axes.tick_params(labelsize=size)
        middle, half = (radius.min() + radius.max()) / 2, max(0.55 * np.ptp(radius), 0.2 * np.ptp(height))
        whole.set_xlim(middle - half, middle + half)
        whole.set_xlabel("radius [mm]", fontsize=8)
        whole.set_ylabel("height over the disk [mm]", fontsize=8)
        for axes, (name, radius_there, level, reach) in zip(near, details, strict=True):
            axes.set_title(name, fontsize=8, color=PALETTE["ink"])
            axes.set_xlim((radius_there - reach) / _MILLIMETRE, (radius_there + reach) / _MILLIMETRE)
            axes.set_ylim((level - reach) / _MILLIMETRE, (level + reach) / _MILLIMETRE)
        bar = figure.colorbar(drawn, ax=[whole, *near], extend="max", shrink=0.9, pad=0.02)
        bar.set_label("shear stress [MPa]", fontsize=8)
        bar.ax.tick_params(labelsize=8)
        figure.savefig(buffer, format="png", metadata={"Software": None})
        return buffer.getvalue()


def _axes(figure: Any, details: int) -> list[Any]:
    """Return the axes of the whole on the left and of the details one above the other on the right."""
    if not details:
        return [figure.add_subplot()]
    grid = figure.add_gridspec(details, 2, width_ratios=(1, 1))
    return [figure.add_subplot(grid[:, 0]), *(figure.add_subplot(grid[row, 1]) for row in range(details))]


def _triangles(check: ElasticityCheck) -> tuple[Array, Array, Any, Array]:
    """Return radius and height [mm] of the nodes, triangles of three nodes each, and the shear stress there [MPa].

    A node takes the mean of the Gauss points nearest to it in the cells around.
    """
    section = check.section
    columns, rows = np.nonzero(section.cells)
    across, along = np.meshgrid(range(3), range(3), indexing="ij")
    point = np.ravel_multi_index(
        (2 * columns[:, None] + across.ravel(), 2 * rows[:, None] + along.ravel()), section.radius.shape
    )
    nodes, number = np.unique(point, return_inverse=True)
    number = number.reshape(point.shape)
    counts = np.bincount(number.ravel())
    stress = np.bincount(number.ravel(), weights=check.shear.ravel()) / counts
    corners = number.reshape(-1, 3, 3)
    low, right, high, left = corners[:, :-1, :-1], corners[:, 1:, :-1], corners[:, 1:, 1:], corners[:, :-1, 1:]
    triangles = np.concatenate(
        [np.stack([low, right, high], -1).reshape(-1, 3), np.stack([low, high, left], -1).reshape(-1, 3)]
    )
    return (
        section.radius.ravel()[nodes] / _MILLIMETRE,
        section.height.ravel()[nodes] / _MILLIMETRE,
        triangles,
        stress / _MEGAPASCAL,
    )
