"""What number a text probably means: suggested, never applied without being asked."""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Iterator
from dataclasses import dataclass

from flexlash.schema.columns import Column, columns_of
from flexlash.schema.units import Unit, find_unit

__all__ = ["Meant", "Measure", "is_both_ways", "meant_number"]

_MINUS = "\u2010\u2011\u2012\u2013\u2014\u2212\ufe63\uff0d"
_SIGNS = str.maketrans(dict.fromkeys(_MINUS, "-") | {"\u066b": ".", "\u066c": "'", "\u2019": "'"})
_FRACTIONS = str.maketrans({"¼": " 1/4", "½": " 1/2", "¾": " 3/4", "\u2044": "/"})
_WIDE = range(0xFF01, 0xFF5F)
"""Full-width forms of the ASCII characters."""

_ROUGHLY = re.compile(r"(?:[~≈≅]|(?:circa|ca|approx|about|etwa|env|abt)\b\.?)\s*", re.IGNORECASE)
_BOTH_WAYS = re.compile(r"(?:±|\+\s*/\s*-|\+-)\s*")
_ROUND = re.compile(r"(?:[Øø⌀∅Φφ]|[DdRr](?=\s*[\d.,]))\s*")
_RADIUS_MARK = frozenset("Rr")

_SIGN = r"(?P<sign>[+-]?)\s*"
_POWER = r"(?P<power>[eE][+-]?\d{1,3})?"
_REST = r"\s*(?P<unit>[^\d\s].*)?"
_PLAIN = re.compile(_SIGN + r"(?P<digits>\d+(?:\.\d*|,\d+)?|[.,]\d+)" + _POWER + _REST, re.ASCII | re.DOTALL)
_GROUPED = re.compile(
    _SIGN + r"(?P<whole>[1-9]\d{0,2}(?P<group>[ '.,])\d{3}(?:(?P=group)\d{3})*)"
    r"(?:(?!(?P=group))[.,](?P<decimals>\d+))?" + _REST,
    re.ASCII | re.DOTALL,
)
_FRACTION = re.compile(_SIGN + r"(?:(?P<whole>\d+)\s+)?(?P<over>\d{1,2})\s*/\s*(?P<under>[1-9]\d?)" + _REST, re.ASCII)
_TWO_READINGS = re.compile(r"[1-9]\d{0,2}[.,]\d{3}", re.ASCII)
_DEVIATION = columns_of("Tolerances")["upper_deviation"]
_DEVIATIONS = frozenset({"lower_deviation", "upper_deviation"})
_NO_UNIT = re.compile(r"(?<![A-Za-z^])\d|[014-9]")
"""A digit that is no exponent of a unit."""


@dataclass(frozen=True, kw_only=True)
class Measure:
    """What the numbers of a cell stand for: quantity, size of 1 in SI, and the bounds of the column in SI.

    `unit_is_open` where a cell beside it, still blank, may say that they are per cent.
    """

    quantity: str
    si: float
    minimum: float = -math.inf
    maximum: float = math.inf
    unit_is_open: bool = False

    @classmethod
    def of(cls, column: Column, factor: float = 1.0) -> Measure:
        """Return the measure of a column whose header names a unit `factor` times the printed one."""
        low = -math.inf if column.minimum is None else column.minimum
        high = math.inf if column.maximum is None else column.maximum
        printed = column.si_unit.si if column.quantity else 1.0
        return cls(quantity=column.quantity, si=printed * factor, minimum=low * printed, maximum=high * printed)

    def unit(self, text: str) -> Unit | None:
        """Return the unit that a text names, None where it is none of this quantity."""
        if self.quantity == "angle":
            text = text.replace('"', "″")
        return find_unit(text, self.quantity) if self.quantity else None


@dataclass(frozen=True, kw_only=True)
class Meant:
    """The numbers that a text may mean, in the unit of its cell; `certain` when it can be no other.

    `entries` says in words what to write where that takes more than one cell.
    """

    numbers: tuple[str, ...] = ()
    certain: bool = False
    entries: str = ""

    @property
    def words(self) -> str:
        """The suggestion as a message names it: `1.6`, or `1.6 or 1600`."""
        return self.entries or " or ".join(self.numbers)

    @property
    def certain_value(self) -> float | None:
        """The number to write where nothing else can be meant."""
        return float(self.numbers[0]) if self.certain and len(self.numbers) == 1 else None


def meant_number(text: str, column: Column, measure: Measure | None = None) -> Meant:
    """Return what number a text in a column probably means.

    >>> from flexlash.schema.columns import columns_of
    >>> wall = columns_of("Variants")["wall_thickness_mm"]
    >>> meant_number("0.0016 m", wall).certain_value
    1.6
    >>> meant_number("1,600", wall).words, meant_number("1.6 kg", wall).words
    ('1.6 or 1600', '')
    """
    measure = measure or Measure.of(column)
    if column.key in _DEVIATIONS and (entries := _deviations(_plain(text), measure)):
        return Meant(entries=entries)
    bare, certain = _plain(text), True
    if rough := _ROUGHLY.match(bare):
        bare, certain = bare[rough.end() :], False
    factor = 1.0
    if both := _BOTH_WAYS.match(bare):
        bare, certain = bare[both.end() :], False
    elif mark := _ROUND.match(bare):
        round_factor = _round_factor(mark[0].strip(), column)
        if round_factor is None:
            return Meant()
        bare, certain, factor = bare[mark.end() :], certain and round_factor == 1, round_factor
    readings = (_in_cell(digits, unit, column, measure, factor) for digits, unit in _readings(bare))
    numbers = dict(filter(None, readings))
    fitting = [number for number, fits in numbers.items() if fits]
    certain = certain and len(fitting) == 1 and not _FRACTION.fullmatch(bare)
    return Meant(numbers=tuple(fitting or numbers), certain=certain)


def is_both_ways(text: str) -> bool:
    """Whether a text begins with ± or the like, and so says two deviations at once."""
    return bool(_BOTH_WAYS.match(_plain(text)))


def _deviations(bare: str, measure: Measure) -> str:
    """Return what to write for ±0.1 or 5 % in the cell of a deviation; empty where its number alone says it."""
    both = _BOTH_WAYS.match(bare)
    bare = bare[both.end() :] if both else bare
    per_cent = measure.unit_is_open and bare.endswith("%")
    readings = dict(_readings(bare.removesuffix("%").rstrip() if per_cent else bare))
    if len(readings) != 1 or not (both or per_cent):
        return ""
    entered = _in_cell(*readings.popitem(), _DEVIATION, measure, 1.0)
    if entered is None:
        return ""
    number = entered[0].lstrip("-") if both else entered[0]
    entry = f"-{number} in lower and {number} in upper" if both else number
    return f"{entry}, and % as the deviation unit" if per_cent else entry


def _plain(text: str) -> str:
    """Return a text with one kind of digits, spaces and minus signs, without invisible characters and last dots."""
    signs = []
    for character in text.translate(_FRACTIONS).translate(_SIGNS):
        if character.isdecimal():
            signs.append(str(unicodedata.decimal(character)))
        elif ord(character) in _WIDE:
            signs.append(chr(ord(character) - 0xFEE0))
        elif character.isspace():
            signs.append(" ")
        elif unicodedata.category(character) not in {"Cc", "Cf"}:
            signs.append(character)
    bare = " ".join("".join(signs).split())
    return bare.removeprefix("'").rstrip(".…").strip()


def _round_factor(mark: str, column: Column) -> float | None:
    """Return by what a radius or diameter is to be multiplied for its column; None where neither belongs."""
    radius = mark in _RADIUS_MARK
    if "radius" in column.key:
        return 1.0 if radius else 0.5
    if "diameter" in column.key:
        return 2.0 if radius else 1.0
    return None


def _readings(text: str) -> Iterator[tuple[str, str]]:
    """Yield the numbers, as Python writes them, that a text can be read as, each with the unit behind it."""
    if match := _match(_FRACTION, text):
        value = int(match["whole"] or 0) + int(match["over"]) / int(match["under"])
        yield f"{match['sign']}{value:.12g}", match["unit"] or ""
        return
    if match := _match(_PLAIN, text):
        digits, two = match["digits"].replace(",", "."), _TWO_READINGS.fullmatch(match["digits"])
        digits = digits.rstrip("0").rstrip(".") if two else digits
        yield f"{match['sign']}{digits}{match['power'] or ''}", match["unit"] or ""
        if match["power"] or not two:
            return
    if match := _match(_GROUPED, text):
        whole = match["whole"].replace(match["group"], "")
        yield f"{match['sign']}{whole}{'.' if match['decimals'] else ''}{match['decimals'] or ''}", match["unit"] or ""


def _match(pattern: re.Pattern[str], text: str) -> re.Match[str] | None:
    """Return how a text is a number of this kind, None where what follows it cannot be a unit."""
    match = pattern.fullmatch(text)
    return match if match and not _NO_UNIT.search(match["unit"] or "") else None


def _in_cell(digits: str, unit_text: str, column: Column, measure: Measure, factor: float) -> tuple[str, bool] | None:
    """Return a number in the unit of its cell and whether it is within bounds; None where its unit is unknown."""
    value = float(digits) * factor
    size = measure.si
    if unit_text:
        unit = measure.unit(unit_text)
        if unit is None:
            return None
        size = unit.si
    scale = size / measure.si
    if not math.isfinite(value * scale) or (column.type == "integer" and value * scale != round(value * scale)):
        return None
    fits = measure.minimum <= value * size <= measure.maximum and not (column.exclusive_minimum and value <= 0)
    if scale == factor == 1:
        return digits.removeprefix("+").removesuffix("."), fits
    return f"{value * scale:.12g}", fits
