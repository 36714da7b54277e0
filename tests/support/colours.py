"""Colours as eyes see them: contrast by WCAG, difference by CIEDE2000, and what people who are colour-blind see.

Sources: WCAG 2.2, "relative luminance" and "contrast ratio"; Sharma, Wu and Dalal, The CIEDE2000 color-difference
formula, Color Res. Appl. 30 (2005); Machado, Oliveira and Fernandes, A physiologically-based model for simulation of
color vision deficiency, IEEE TVCG 15 (2009), table of severity 1.0.
"""

from __future__ import annotations

import math

import numpy as np

__all__ = ["SIGHTS", "contrast", "difference", "lab_difference", "seen"]

SIGHTS = {
    "all colours": np.eye(3),
    "no red (protanopia)": np.array([
        [0.152286, 1.052583, -0.204868],
        [0.114503, 0.786281, 0.099216],
        [-0.003882, -0.048116, 1.051998],
    ]),
    "no green (deuteranopia)": np.array([
        [0.367322, 0.860646, -0.227968],
        [0.280085, 0.672501, 0.047413],
        [-0.011820, 0.042940, 0.968881],
    ]),
    "no blue (tritanopia)": np.array([
        [1.255528, -0.076749, -0.178779],
        [-0.078411, 0.930809, 0.147602],
        [0.004733, 0.691367, 0.303900],
    ]),
}  # fmt: skip
"""How linear red, green and blue are seen, by those who see all colours and by those who lack one kind of cone."""

_TO_XYZ = np.array([
    [0.4124564, 0.3575761, 0.1804375],
    [0.2126729, 0.7151522, 0.0721750],
    [0.0193339, 0.1191920, 0.9503041],
])  # fmt: skip


def _linear(colour: str) -> np.ndarray:
    parts = np.array([int(colour[at : at + 2], 16) / 255 for at in (1, 3, 5)])
    return np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)


def contrast(one: str, other: str) -> float:
    """Return the contrast of two colours by WCAG, from 1 to 21."""
    low, high = sorted(float(_linear(colour) @ (0.2126, 0.7152, 0.0722)) for colour in (one, other))
    return (high + 0.05) / (low + 0.05)


def seen(colour: str, sight: str) -> np.ndarray:
    """Return the CIELAB coordinates (L*, a*, b*) of a colour as a sight of `SIGHTS` sees it, under D65."""
    light = np.clip(SIGHTS[sight] @ _linear(colour), 0, 1)
    ratios = _TO_XYZ @ light / (_TO_XYZ @ np.ones(3))
    bent = np.where(ratios > (6 / 29) ** 3, np.cbrt(ratios), ratios / (3 * (6 / 29) ** 2) + 4 / 29)
    return np.array([116 * bent[1] - 16, 500 * (bent[0] - bent[1]), 200 * (bent[1] - bent[2])])


def difference(one: str, other: str, sight: str = "all colours") -> float:
    """Return the difference CIEDE2000 of two colours; about 1 can just be seen side by side."""
    return lab_difference(seen(one, sight), seen(other, sight))


def lab_difference(one: np.ndarray, other: np.ndarray) -> float:
    """Return the difference CIEDE2000 of two CIELAB colours."""
    (l1, a1, b1), (l2, a2, b2) = map(tuple, (one, other))
    mean = (math.hypot(a1, b1) + math.hypot(a2, b2)) / 2
    grey = 0.5 * (1 - math.sqrt(mean**7 / (mean**7 + 25**7)))
    a1, a2 = (1 + grey) * a1, (1 + grey) * a2
    c1, c2 = math.hypot(a1, b1), math.hypot(a2, b2)
    h1, h2 = (math.degrees(math.atan2(b, a)) % 360 for a, b in ((a1, b1), (a2, b2)))
    turn = 0.0 if c1 * c2 == 0 else (h2 - h1 + 180) % 360 - 180
    lightness, chroma, hue = l2 - l1, c2 - c1, 2 * math.sqrt(c1 * c2) * math.sin(math.radians(turn / 2))
    middle, c = (l1 + l2) / 2, (c1 + c2) / 2
    h = h1 + h2 if c1 * c2 == 0 else h1 + turn / 2
    t = 1.0
    for weight, times, shift in ((-0.17, 1, -30), (0.24, 2, 0), (0.32, 3, 6), (-0.20, 4, -63)):
        t += weight * math.cos(math.radians(times * h + shift))
    by_lightness = 1 + 0.015 * (middle - 50) ** 2 / math.sqrt(20 + (middle - 50) ** 2)
    by_chroma, by_hue = 1 + 0.045 * c, 1 + 0.015 * c * t
    bend = -2 * math.sqrt(c**7 / (c**7 + 25**7))
    turned = bend * math.sin(math.radians(60 * math.exp(-((((h % 360) - 275) / 25) ** 2))))
    x, y, z = lightness / by_lightness, chroma / by_chroma, hue / by_hue
    return math.sqrt(x * x + y * y + z * z + turned * y * z)
