"""`--vary NAME=FROM:TO:STEP` and `--vary NAME=V1,V2,…` → the values that a dimension takes."""

from __future__ import annotations

import math
from collections.abc import Sequence

import click

from flexlash.schema.swept_columns import swept_column
from flexlash.schema.swept_values import MOST_POINTS, swept_count, swept_values

__all__ = ["sentence", "varied"]

_PARTS = 3
_FORMS = "NAME=FROM:TO:STEP, such as cylinder_length_mm=100:200:20, or NAME=V1,V2,…"


def varied(texts: Sequence[str]) -> dict[str, tuple[float, ...]]:
    """Return the values of each dimension by the key of its column; raise a usage error that names the text."""
    found: dict[str, tuple[float, ...]] = {}
    for text in texts:
        key, values = _of_text(text)
        if key in found:
            raise click.UsageError(f"--vary {text}: {key} is swept twice; name two dimensions.")
        found[key] = values
    if len(found) > 2:  # noqa: PLR2004
        raise click.UsageError(f"--vary: one or two dimensions can be swept together, not {len(found)}.")
    return found


def _of_text(text: str) -> tuple[str, tuple[float, ...]]:
    name, equals, values = text.partition("=")
    if not (name.strip() and equals and values.strip()):
        raise click.UsageError(sentence(f"--vary {text}: write {_FORMS}"))
    try:
        key = swept_column(name.strip()).key
        return key, _listed(values) if ":" not in values else _stepped(values)
    except ValueError as fault:
        raise click.UsageError(sentence(f"--vary {text}: {fault}")) from fault


def sentence(words: str) -> str:
    """Return words with a full stop, unless they end in a mark of their own."""
    return words if words.endswith(("?", "…", ".")) else f"{words}."


def _listed(values: str) -> tuple[float, ...]:
    """Return numbers separated by commas, each once."""
    numbers = tuple(dict.fromkeys(_number(value) for value in values.split(",")))
    if len(numbers) > MOST_POINTS:
        raise ValueError(f"that is {len(numbers):,} values; at most {MOST_POINTS:,} are computed at once")
    return numbers


def _stepped(values: str) -> tuple[float, ...]:
    """Return the numbers from one to another by a step."""
    parts = values.split(":")
    if len(parts) != _PARTS:
        raise ValueError(f"write {_FORMS}")
    first, last, step = map(_number, parts)
    if not step > 0:
        raise ValueError(
            f"the step must be greater than 0, not {step:.10g}; to count down write the greater value first"
        )
    if step > abs(last - first) > 0:
        raise ValueError(f"the step {step:.10g} is greater than the range of {abs(last - first):.10g}")
    if (count := swept_count(first, last, step)) > MOST_POINTS:
        words = f"{count:,}" if count < MOST_POINTS**2 else f"more than {MOST_POINTS**2:,}"
        raise ValueError(f"that is {words} values; at most {MOST_POINTS:,} are computed at once. Take a larger step")
    return swept_values(first, last, step)


def _number(text: str) -> float:
    """Return a number with a decimal point."""
    try:
        value = float(text)
    except ValueError:
        point = "; decimals have a point" if "," in text else ""
        raise ValueError(f'"{text.strip()}" is not a number{point}') from None
    if not math.isfinite(value):
        raise ValueError(f'"{text.strip()}" is not a number')
    return value
