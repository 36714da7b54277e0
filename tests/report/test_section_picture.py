"""The picture of a half-section: it shows every corner, is the same each time, and marks what is stressed."""

from __future__ import annotations

import io

import numpy as np
import pytest
from b3_160 import NOMINAL

pytest.importorskip("skfem", reason="scikit-fem is not installed here")
pytest.importorskip("matplotlib", reason="matplotlib is not installed here")

from matplotlib.image import imread

from flexlash.mechanics.elasticity.twist import elasticity_check
from flexlash.report.section_picture import PICTURE_SIZE, _triangles, section_png

FILLETS = {"hub_fillet_radius": 0.0035, "junction_fillet_radius": 0.0035}
RIM = {"rim_length": 0.02, "rim_thickness": 0.0032}


@pytest.fixture(scope="module")
def check():
    """Return the check of B3-160 with fillets and rim."""
    return elasticity_check("cup", NOMINAL | FILLETS | RIM)


def _pixels(data):
    return imread(io.BytesIO(data), format="png")[:, :, :3]


@pytest.mark.slow
def test_the_picture_has_its_size_and_its_bytes(check):
    """The picture is a PNG of the stated size, the same bytes each time, whatever settings matplotlib has."""
    import matplotlib as mpl

    data = section_png(check, 60e6)
    assert _pixels(data).shape[:2] == PICTURE_SIZE[::-1]
    with mpl.rc_context({"font.size": 30, "savefig.dpi": 50}):
        assert section_png(check, 60e6) == data


@pytest.mark.slow
def test_colours_follow_the_stress(check):
    """A scale that ends far above the stress gives a dark picture, one that ends far below a bright one."""
    dark, fitting, bright = (_pixels(section_png(check, end)).mean(axis=2) for end in (1e10, 60e6, 1e5))
    from matplotlib import colormaps

    low, high = (np.mean(colormaps["cividis"](end)[:3]) for end in (0.0, 1.0))
    drawn = (np.abs(dark - low) < 0.01) & (np.abs(bright - high) < 0.01)
    assert drawn.sum() > 2000
    assert low + 0.02 < fitting[drawn].mean() < high - 0.02
    assert fitting[drawn].std() > 0.05


def test_the_triangles_cover_the_half_section(check):
    """The triangles have positive area, together that of disk, wall, rim and fillets, with stress above zero."""
    radius, height, triangles, stress = _triangles(check)
    (a, b, c) = (np.stack([radius[corner], height[corner]]) for corner in triangles.T)
    area = ((b - a)[0] * (c - a)[1] - (b - a)[1] * (c - a)[0]) / 2
    assert np.abs(area).min() > 0
    mean = NOMINAL["mean_radius"] * 1e3
    disk = (mean + 0.8 - 40) * 1.6
    wall = 160 * 1.6 + 20 * 1.6
    assert abs(area.sum()) == pytest.approx(disk + wall + 2 * (1 - np.pi / 4) * 3.5**2, rel=2e-3)
    assert stress.min() > 0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "change", "names"),
    [
        ("cup", {}, ["hub", "junction"]),
        ("cup", RIM, ["hub", "junction", "rim step"]),
        ("hat", {"disk_outer_radius": 0.11}, ["bolt circle", "junction"]),
        ("cylinder", {}, []),
        ("cylinder", RIM, ["rim step"]),
    ],
)
def test_every_corner_is_shown_from_near(kind, change, names):
    """Hub or bolt circle, junction and rim step have a detail of their own where the part has them."""
    dimensions = {
        name: value for name, value in (NOMINAL | change).items() if kind == "cup" or name != "disk_inner_radius"
    }
    found = elasticity_check(kind, dimensions)
    assert [name for name, *_ in found.section.details] == names
    assert _pixels(section_png(found, 60e6)).std() > 0.01
