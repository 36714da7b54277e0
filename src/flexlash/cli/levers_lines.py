"""The table of levers → lines for the screen: a block a variant, as wide as the screen, with reasons below."""

from __future__ import annotations

import textwrap
from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any

import polars as pl

from flexlash.report.page.excel_texts import number_text
from flexlash.report.wording.lever_table import LEVER_COLUMNS, LeverColumn
from flexlash.report.wording.lever_words import Lever, change_words, followers_words, sentence_start, shown_levers
from flexlash.schema.angle_unit import AngleUnit
from flexlash.schema.findings import shown
from flexlash.schema.number_words import share_words

__all__ = ["levers_lines"]

_NUMBERS = [column for column in LEVER_COLUMNS if column.brief]
_CHANGE = 26
"""Fewest characters of the column of changes, whatever room numbers take."""

_RANK = 4
"""Characters of a rank with the space around it."""

_NAME, _MATERIAL = 200, 60


def levers_lines(
    results: pl.DataFrame, levers: pl.DataFrame, width: int, angles: AngleUnit, hats: Collection[str] = ()
) -> Iterator[tuple[str, str]]:
    """Yield lines, each with its colour or an empty text: the variants in the order of Results, each with its changes.

    `results` are the Results of the submission, `width` how many characters a line may have; `hats` names the hats.
    """
    rows = {row["variant"]: row for row in results.iter_rows(named=True)}
    for variants in shown_levers(levers, hats).partition_by("variant", maintain_order=True):
        changes = variants.to_dicts()
        yield from _block(rows[changes[0]["variant"]], changes, width, angles)
    without = results.filter(pl.col("p97_5_arcmin").is_not_null() & pl.col("backlash_limit_arcmin").is_null()).height
    if without:
        have = "variant has" if without == 1 else "variants have"
        yield f"{without} {have} no backlash limit: there is nothing to meet.", ""


def _block(
    row: Mapping[str, Any], changes: Sequence[Lever], width: int, angles: AngleUnit
) -> Iterator[tuple[str, str]]:
    """Yield the lines of one variant."""
    name, limit = shown(row["variant"], longest=_NAME), angles.entered(row["backlash_limit_arcmin"])
    meets = changes[0]["direction"] == "relax"
    verdict = f"meets its limit of {limit}; how far one change may go" if meets else f"misses its limit of {limit}"
    text = f"{name} {verdict} (units over it now: {share_words(row)})"
    yield from ((line, "bold") for line in textwrap.wrap(text, width, subsequent_indent="  "))
    able = [lever for lever in changes if lever["possible"] == "yes"]
    yield from _table(able, width)
    reasons: dict[str, list[str]] = defaultdict(list)
    for lever in changes:
        if lever["possible"] == "no" and lever["what"] != "material":
            reasons[lever["reason"]].append(change_words(lever))
    for reason, unable in reasons.items():
        yield from _wrapped(f"  not possible: {'; '.join(unable)}: {reason}", width, "bright_black")
    materials = [lever["to_material"] for lever in changes if lever["possible"] == "no" and lever["to_material"]]
    if materials:
        names = ", ".join(shown(name, longest=_MATERIAL) for name in materials)
        yield from _wrapped(f"  not possible: another material: {names}", width, "bright_black")
    yield "", ""


def _table(able: Sequence[Lever], width: int) -> Iterator[tuple[str, str]]:
    """Yield the changes that can do it by rank, their numbers right-aligned as far as the line has room for them."""
    if not able:
        return
    words = [_changed(lever) for lever in able]
    columns = [[column.brief, *(_cell(column, lever) for lever in able)] for column in _NUMBERS]
    widths = [2 + max(map(len, column)) for column in columns]
    room = max(_CHANGE, min(max(map(len, words)), width - _RANK - sum(widths)))
    while widths and _RANK + room + sum(widths) > width:
        widths.pop()
    yield _line("", "", [column[0] for column in columns], room, widths), ""
    for place, (lever, text) in enumerate(zip(able, words, strict=True), start=1):
        first, *more = textwrap.wrap(text, room)
        rank = "" if lever["rank"] is None else f"{lever['rank']:.0f}"
        colour = "green" if lever["rank"] == 1 else ""
        yield _line(rank, first, [column[place] for column in columns], room, widths), colour
        yield from ((f"{'':{_RANK + 2}}{line}", colour) for line in more)
        if lever["range_note"]:
            start = "out of range: " if lever["in_range"] == "no" else "note: "
            yield from _wrapped(f"{'':{_RANK}}{start}{lever['range_note']}", width, "yellow")


def _changed(lever: Lever) -> str:
    """Return a change, of which the line above says whether it is wanted or allowed."""
    return sentence_start(f"{change_words({**lever, 'direction': 'meet'})}{followers_words(lever)}")


def _line(rank: str, text: str, cells: Sequence[str], room: int, widths: Sequence[int]) -> str:
    """Return a line of the table."""
    figures = "".join(f"{cell:>{size}}" for cell, size in zip(cells, widths, strict=False))
    return f"{rank:>{_RANK - 1}} {text:{room}}{figures}".rstrip()


def _cell(column: LeverColumn, lever: Lever) -> str:
    value = column.value(lever)
    return "" if value is None else value if isinstance(value, str) else number_text(value, column.code(value))


def _wrapped(text: str, width: int, colour: str) -> Iterator[tuple[str, str]]:
    indent = " " * (len(text) - len(text.lstrip()))
    for line in textwrap.wrap(text.strip(), max(width - 6, 20)):
        yield f"{indent}{line}", colour
        indent = "      "
