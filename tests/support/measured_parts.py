"""Sheets of measured parts: sixty walls as the issue has them, and what engineers do to such sheets."""

from __future__ import annotations

import math
from collections.abc import Sequence
from statistics import NormalDist
from typing import Any

__all__ = ["HEADERS", "LIMITS", "measured_rows", "samples_of", "scattered"]

HEADERS = ["Sample", "Part", "Use as", "Wall thickness Δ [mm]", "Disk thickness [mm]"]

LIMITS = ["Tolerance class", "Dimension", "Lower deviation", "Upper deviation", "Deviation unit", "Sample"]


def scattered(count: int, mean: float = 1.607, sd: float = 0.0041, turn: int = 0) -> list[float]:
    """Return values with exactly this mean and standard deviation, in an order that `turn` shuffles."""
    scores = [NormalDist().inv_cdf((place - 0.375) / (count + 0.25)) for place in range(1, count + 1)]
    scale = math.sqrt(math.fsum(score**2 for score in scores) / max(count - 1, 1)) or 1.0
    step = next(step for step in range(count // 3 + turn + 1, 3 * count + turn + 3) if math.gcd(step, count) == 1)
    return [mean + sd * scores[place * step % count] / scale for place in range(count)]


def measured_rows(count: int = 60, sample: str = "wall", use: str | None = None) -> list[list[Any]]:
    """Return rows under HEADERS with two dimensions of sound parts."""
    columns = zip(scattered(count), scattered(count, turn=7), strict=True)
    return [[sample, number, use, wall, disk] for number, (wall, disk) in enumerate(columns, start=1)]


def samples_of(*uses: tuple[str, str, str]) -> list[Sequence[Any]]:
    """Return a Tolerances sheet in which classes use samples for dimensions, all within ± 0.02 mm."""
    return [LIMITS, *([name, dimension, -0.02, 0.02, "mm", sample] for name, dimension, sample in uses)]
