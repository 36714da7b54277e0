"""A row of Levers → the cells of the table that report, page and screen show of it, alike in words and digits."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from flexlash.report.wording.lever_words import (
    Lever,
    change_words,
    followers_words,
    sentence_start,
    shown_unit,
    shown_value,
)

__all__ = ["LEVER_COLUMNS", "LeverColumn"]


@dataclass(frozen=True, kw_only=True)
class LeverColumn:
    """A column: its heading, what it holds of a row, in which number format, its width, whether its text is wrapped.

    `brief` is its heading on the screen, empty where it has no place there, or a place of its own.
    `is_in_words` where the change in words says the same: for who filters or sorts.
    """

    heading: str
    value: Callable[[Lever], str | float | None]
    code: Callable[[float], str] = lambda _: "General"
    width: float = 9.0
    wraps: bool = False
    is_in_words: bool = False
    brief: str = ""


_PPM = ((10.0, "#,##0"), (1.0, "0.0"), (0.0, "0.00"))
"""Units per million from which on they are told in a number format."""


def _ppm(value: float) -> str:
    return next(code for least, code in _PPM if value >= least)


def _change(_: float) -> str:
    return "+0.0;-0.0;0.0"


def _changed(lever: Lever) -> str:
    """Return the change as a line of a table, with the dimensions that follow it."""
    return sentence_start(f"{change_words(lever)}{followers_words(lever)}")


LEVER_COLUMNS = (
    LeverColumn(heading="Variant", value=lambda lever: lever["variant"], width=22.0, is_in_words=True),
    LeverColumn(heading="Change", value=_changed, width=40.0, wraps=True),
    LeverColumn(heading="Drawn value", value=lambda lever: shown_value(lever, "drawing_value"), is_in_words=True),
    LeverColumn(heading="Exact value", value=lambda lever: shown_value(lever, "to_value")),
    LeverColumn(heading="Unit", value=lambda lever: shown_unit(lever).strip() or None, width=6.0, is_in_words=True),
    LeverColumn(
        heading="Over limit after [ppm]",
        brief="ppm over",
        value=lambda lever: lever["ppm_after"],
        code=_ppm,
        width=10.0,
    ),
    LeverColumn(
        heading="Mass [%]", brief="mass %", value=lambda lever: lever["mass_change_percent"], code=_change, width=8.0
    ),
    LeverColumn(
        heading="Stiffness [%]",
        brief="stiff %",
        value=lambda lever: lever["stiffness_change_percent"],
        code=_change,
    ),
    LeverColumn(
        heading="von Mises after, torsion only [MPa]",
        brief="MPa",
        value=lambda lever: lever["von_mises_MPa_after"],
        code=lambda _: "0.0",
        width=12.0,
    ),
    LeverColumn(
        heading="Bending [%]",
        brief="bend %",
        value=lambda lever: lever["bending_stress_change_percent"],
        code=_change,
    ),
    LeverColumn(heading="In range", value=lambda lever: lever["in_range"], width=7.0),
    LeverColumn(
        heading="Relative cost", brief="cost", value=lambda lever: lever["relative_cost"], code=lambda _: "0.0"
    ),
    LeverColumn(heading="Rank", value=lambda lever: lever["rank"], code=lambda _: "0", width=6.0),
    LeverColumn(
        heading="Why not, or what to mind",
        value=lambda lever: lever["reason"] or lever["range_note"],
        width=41.0,
        wraps=True,
    ),
)
