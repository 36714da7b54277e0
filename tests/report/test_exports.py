"""Samples and pictures beside a report: what they hold is what Results say, and every program can read them."""

from __future__ import annotations

import csv
import io
import struct
from xml.etree import ElementTree

import polars as pl
import pytest
from filled import SOUND

from flexlash import run
from flexlash.report import exports
from flexlash.report.exports import export_notes, exported_files
from flexlash.report.pictures import raster
from flexlash.schema.stamps import stamped

pytestmark = pytest.mark.slow

SVG = "{http://www.w3.org/2000/svg}"
KINDS = ("part", "density", "causes", "segments")


@pytest.fixture(scope="module")
def outcome(tmp_path_factory):
    """Return the outcome of three variants, two of which have names that no file can have, alike without them."""
    path = tmp_path_factory.mktemp("exports") / "gear.csv"
    walls = {'C/12 "a"': 1.6, "c:12 A": 1.7, "$B$": 2}
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, [*SOUND])
        writer.writeheader()
        for name, wall in walls.items():
            writer.writerow(SOUND | {"variant": name, "wall_thickness_mm": wall, "backlash_limit_arcmin": 4})
    found = run(path)
    assert len(found.computed) == 3, found.findings
    return found


@pytest.fixture(scope="module")
def files(outcome):
    """Return all files of the outcome by name."""
    return {file.name: file for file in exported_files(outcome, samples=True, pictures=True)}


def test_random_units_agree_with_results(outcome, files):
    """Mean, standard deviation and percentiles of the units are those of Results within five standard errors."""
    units = pl.read_parquet(io.BytesIO(files["-samples.parquet"].data))
    for row in outcome.results.to_dicts():
        values = units.filter(pl.col("variant") == row["variant"])["backlash_arcmin"]
        number, sd = values.len(), row["sd_arcmin"]
        assert number == 10_000
        assert values.mean() == pytest.approx(row["mean_arcmin"], abs=5 * sd / number**0.5)
        assert values.std() == pytest.approx(sd, rel=5 / (2 * number) ** 0.5)
        for share, key in ((0.025, "p2_5"), (0.5, "p50"), (0.975, "p97_5")):
            below = (values <= row[f"{key}_arcmin"]).mean()
            assert below == pytest.approx(share, abs=5 * (share * (1 - share) / number) ** 0.5)


def test_many_variants_share_a_million_units(outcome, monkeypatch):
    """Above the most units in a file each variant has fewer, the first of the same; the note says how many."""
    whole = pl.read_parquet(io.BytesIO(exported_files(outcome, samples=True, pictures=False)[0].data))
    monkeypatch.setattr(exports, "UNITS_IN_ALL", 300)
    (file,) = exported_files(outcome, samples=True, pictures=False)
    fewer = pl.read_parquet(io.BytesIO(file.data))
    assert fewer.equals(whole.filter(pl.col("unit") <= 100))
    assert [*export_notes(outcome, samples=True, pictures=False)] == ["Samples: 100 random units of each variant."]


def test_each_variant_has_its_pictures_under_names_for_every_system(files):
    """Part, density, causes and segments of each, and one of all; no letter that Windows refuses, none the same."""
    svgs = {name for name in files if name.endswith(".svg")}
    labels = ("C-12-a-row-2", "c-12-A-row-3", "$B$")
    assert svgs == {"-comparison.svg"} | {f"-{label}-{kind}.svg" for label in labels for kind in KINDS}
    assert len({name.casefold() for name in files}) == len(files)


def test_an_svg_stands_alone_and_is_told_in_words(outcome, files):
    """It is XML with a size, a title that names its variant, a description, and nothing that comes from elsewhere."""
    for name, file in files.items():
        if not name.endswith(".svg"):
            continue
        root = ElementTree.fromstring(file.data)  # noqa: S314
        x, y, width, height = map(float, root.get("viewBox").split())
        assert (float(root.get("width")), float(root.get("height"))) == (width, height)
        words = {root.find(f"{SVG}{tag}").get("id"): root.find(f"{SVG}{tag}").text for tag in ("title", "desc")}
        assert root.get("aria-labelledby").split() == [*words]
        assert all(len(text) > 10 for text in words.values()), name
        assert root.get("font-family").endswith("sans-serif")
        for one in root.iter():
            assert not {"href", "style", "class"} & one.attrib.keys()
            assert not any("%" in value for key, value in one.attrib.items() if key != "fill"), (name, one.attrib)
        for text in root.iter(f"{SVG}text"):
            assert x <= float(text.get("x")) <= x + width
            assert y <= float(text.get("y")) <= y + height
    told = ElementTree.fromstring(files["-$B$-density.svg"].data)  # noqa: S314
    shown = [text.text for text in told.iter(f"{SVG}text")]
    row = outcome.results.row(by_predicate=pl.col("variant") == "$B$", named=True)
    for what, key in (("limit", "backlash_limit"), ("nominal", "backlash"), ("mean", "mean")):
        assert any(text.startswith(f"{what} {row[f'{key}_arcmin']:.4g}′") for text in shown)
    assert "$B$" in told.find(f"{SVG}title").text


def test_a_png_is_its_svg(files):
    """Every picture is there as PNG of twice its size, with its title; without matplotlib it is not."""
    pytest.importorskip("matplotlib")
    for name, file in files.items():
        if name.endswith(".svg"):
            png = files[name.replace(".svg", ".png")].data
            root = ElementTree.fromstring(file.data)  # noqa: S314
            width, height = struct.unpack(">II", png[16:24])
            assert png.startswith(b"\x89PNG\r\n\x1a\n")
            assert abs(width - 2 * float(root.get("width"))) <= 2
            assert abs(height - 2 * float(root.get("height"))) <= 2
            assert b"Software" not in png


def test_without_matplotlib_there_is_svg_alone(outcome, monkeypatch):
    """The same SVG, and no PNG."""
    monkeypatch.setattr(raster, "find_spec", lambda _: None)
    assert {file.name[-4:] for file in exported_files(outcome, samples=False, pictures=True)} == {".svg"}


def test_the_same_outcome_has_the_same_bytes_with_their_stamp(outcome, files):
    """A second time every byte is the same, and each file has room for its stamp."""
    again = exported_files(outcome, samples=True, pictures=True)
    assert {file.name: file.data for file in again} == {name: file.data for name, file in files.items()}
    assert all(stamped(file.data, file.role) != file.data for file in again)
