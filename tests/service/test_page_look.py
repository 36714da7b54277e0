"""How the pages look: letters stand out, the focus is seen, nothing is asked of another server."""

from __future__ import annotations

import re
from importlib.resources import files

import pytest
from grids import for_each


def _luminance(colour):
    parts = [int(colour[at : at + 2], 16) / 255 for at in (1, 3, 5)]
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    return sum(weight * part for weight, part in zip((0.2126, 0.7152, 0.0722), linear, strict=True))


def contrast(one, other):
    """Return the contrast of two colours by WCAG, from 1 to 21."""
    low, high = sorted((_luminance(one), _luminance(other)))
    return (high + 0.05) / (low + 0.05)


def _css():
    return files("flexlash.service.web").joinpath("static", "flexlash.css").read_text(encoding="utf-8")


def _rules():
    """Yield each rule of the style sheet: its selector and declarations, with colours instead of their names."""
    css = re.sub(r"/\*.*?\*/", "", _css(), flags=re.DOTALL)
    names = dict(re.findall(r"(--[\w-]+): (#[0-9a-f]{6});", css))
    css = re.sub(r"var\((--[\w-]+)\)", lambda found: names[found[1]], css)
    for selector, body in re.findall(r"([^{}]+)\{([^{}]*)\}", css):
        yield selector.strip(), dict(part.split(":", 1) for part in body.split(";") if ":" in part)


def _colours():
    """Yield selector, letters and ground of every rule that colours letters; without a ground, both of the page."""
    for selector, body in _rules():
        told = {key.strip(): re.search(r"#[0-9a-f]{6}", value) for key, value in body.items()}
        letters, ground = told.get("color"), told.get("background")
        if letters and ground:
            yield selector, letters[0], ground[0]
        elif letters:
            for behind in ("#ffffff", "#f7f9fc"):
                yield selector, letters[0], behind


@for_each("selector, letters, ground", _colours())
def test_letters_stand_out_from_their_ground(selector, letters, ground):
    """Every pair of colours of the style sheet has a contrast of 4.5 or more."""
    assert contrast(letters, ground) >= 4.5, f"{selector}: {contrast(letters, ground):.2f}"


def test_contrast_is_that_of_wcag():
    """Black on white has 21, and the grey that is known for it 4.54."""
    assert contrast("#000000", "#ffffff") == pytest.approx(21)
    assert contrast("#767676", "#ffffff") == pytest.approx(4.54, abs=0.005)


def test_the_style_sheet_asks_for_nothing_and_keeps_the_focus_visible():
    """No other resource is asked for; what has the focus has an outline; who wants no motion gets none."""
    css = _css()
    assert "url(" not in css
    assert "@import" not in css
    assert ":focus-visible { outline: 3px" in css
    assert css.count("transition") == 1
    assert css.index("prefers-reduced-motion: no-preference") < css.index("transition")
