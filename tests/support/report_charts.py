"""What stands in the charts of a report: the points that viewers without calculation draw."""

from __future__ import annotations

import re
import zipfile
from pathlib import Path

__all__ = ["chart_titled", "points_of"]


def chart_titled(path: Path, title: str) -> str:
    """Return the XML of the chart with this title; raise ValueError when there is none, or more than one."""
    with zipfile.ZipFile(path) as archive:
        texts = [archive.read(name).decode() for name in archive.namelist() if name.startswith("xl/charts/chart")]
    (found,) = [text for text in texts if f"<a:t>{title}</a:t>" in text]
    return found


def points_of(chart: str, cells: str) -> dict[int, float]:
    """Return the stored points of a range by their place, of all ranges that begin with `cells`."""
    formula = re.escape(cells)
    (cache,) = re.findall(rf"<c:f>{formula}</c:f><c:numCache>(.*?)</c:numCache>", chart)[:1]
    count = int(re.search(r'<c:ptCount val="(\d+)"/>', cache)[1])
    points = {
        int(place): float(value) for place, value in re.findall(r'<c:pt idx="(\d+)"><c:v>(.*?)</c:v></c:pt>', cache)
    }
    assert not points or max(points) < count
    return points
