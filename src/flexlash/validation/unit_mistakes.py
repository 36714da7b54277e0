"""Units mistaken by a factor of 1000: numbers that suit no material, or not the rest of their row."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import polars as pl

from flexlash.schema.columns import columns_of
from flexlash.schema.findings import Finding, finding, spelled_out
from flexlash.schema.spellings import plain
from flexlash.validation.ledger import Ledger
from flexlash.validation.validated import Table, UnitMistake

__all__ = ["SHARES", "find_unit_mistakes", "report_contradiction", "settled"]

_THOUSAND = 1000.0
_RADII = {"mean_radius_mm": 1.0, "bore_diameter_mm": 0.5}
_REACH = (0.5, 4000.0)
"""Mean radius [mm] that can be meant; a thousandth or a thousandfold of 5 to 300 mm lies outside."""

SHARES = {
    "cylinder_length_mm": (0.1, 20.0),
    "wall_thickness_mm": (0.005, 0.2),
    "disk_thickness_mm": (0.005, 0.5),
    "disk_inner_radius_mm": (0.05, 1.5),
    "disk_outer_radius_mm": (0.5, 5.0),
    "disk_hub_thickness_mm": (0.01, 1.0),
    "hub_fillet_radius_mm": (0.002, 0.2),
    "junction_fillet_radius_mm": (0.002, 0.2),
    "rim_length_mm": (0.03, 5.0),
    "rim_thickness_mm": (0.01, 1.0),
    "tooth_face_width_mm": (0.03, 5.0),
}
"""What a length can be in mean radii. A length is mistaken when it lies outside, and inside if shifted by 1000; each
span is at most 250-fold, so that between the two there is room where nothing is said."""

_DOUBTS = frozenset({"W405", "W418", "W419", "W440"})
"""Warnings about unusual values and far tails, which come before the errors that limits and numbers show."""

_TORQUES = ("torque_Nm", "rated_torque_Nm")
_UNBEARABLE_SHEAR = 1500.0
"""Wall shear [MPa] beyond the yield of the strongest steels."""

_UNUSUAL_TORQUE = 0.15
"""Torque [N·m] per cubed mean radius [mm³]: a hundred times where a catalogue drive's second slope ends."""


_FIRST_SLOPE = 4e-4
"""Torque [N·m] per cubed mean radius [mm³] where a catalogue drive's first slope ends; sizes 14 to 100 agree."""

_FEEBLE = (_FIRST_SLOPE / 30_000, _FIRST_SLOPE / 100)
"""Torque per cubed mean radius that says nothing of a drive, though a thousand times as much does."""

_GREATEST_RADIUS = 130.0
"""Mean radius [mm] of the largest catalogue drives; lengths that give less when tenfold may be in centimetres."""

_TENFOLD = 10.0


class _Span(NamedTuple):
    """What a material's value can be, beyond which entries one is mistaken, and by which factors."""

    least: float
    most: float
    below: float
    above: float
    factors: tuple[float, ...]


_MATERIAL = {
    "youngs_modulus_GPa": _Span(1.0, 1300.0, 0.0, 1500.0, (1e-3, 1e-9)),
    "shear_modulus_GPa": _Span(0.3, 550.0, 0.0, 600.0, (1e-3, 1e-9)),
    "yield_MPa": _Span(20.0, 5000.0, 3.0, 1e6, (1e3, 1e-6)),
}


def find_unit_mistakes(table: Table, ledger: Ledger) -> None:
    """Put the cells of Variants or Materials whose unit is mistaken into the ledger; `settled` tells them."""
    find = {"Variants": _variant_factors, "Materials": _material_factors}.get(table.schema)
    if find is None:
        return
    faulty: dict[int, dict[str, None]] = defaultdict(dict)
    for row, key in table.faulty:
        faulty[row][key] = None
    frame = (
        table.frame
        if table.schema == "Materials"
        else table.frame.filter(_may_be_mistaken() | pl.col("row").is_in([*faulty]))
    )
    for record in frame.iter_rows(named=True):
        sound = {**record, **faulty.get(record["row"], {})}
        for mistaken in find(sound):
            ledger.unit_mistakes[table.sheet, record["row"], mistaken[0]] = _unit_mistake(table, sound, mistaken)


def _may_be_mistaken() -> pl.Expr:
    """Return where `_variant_factors` may find a cell of a row: its numbers are not all what they can be."""
    radius = pl.coalesce(pl.col(key) * share for key, share in _RADII.items())
    beside = [(pl.col(key) / radius).is_between(*span) | (pl.col(key) == 0) for key, span in SHARES.items()]
    torques = [pl.col(key) / radius.pow(3) for key in _TORQUES]
    usual = [(torque > 2 * _FEEBLE[1]) & (torque < _UNUSUAL_TORQUE / 2) for torque in torques]
    return ~pl.all_horizontal(radius.is_between(*_REACH), *(one.fill_null(value=True) for one in (*beside, *usual)))


def _facts(mistake: UnitMistake) -> dict[str, Any]:
    """Return what a finding says of a mistaken cell."""
    return {
        "sheet": mistake.sheet,
        "cell": mistake.cell,
        "column": mistake.column,
        "name": columns_of(mistake.schema)[mistake.column].name,
        "variant": mistake.variant,
        "value": mistake.shown,
        "entered": mistake.entered,
        "other": mistake.times,
        "detail": mistake.beside,
    }


def settled(findings: Sequence[Finding], mistakes: Iterable[UnitMistake], file: str) -> list[Finding]:
    """Return findings with each cell's error alone: doubts about its value go, and only other mistakes are added."""
    wrong = {(known.sheet, known.cell) for known in findings if known.level == "error"}
    kept = [known for known in findings if known.code not in _DOUBTS or (known.sheet, known.cell) not in wrong]
    return kept + [
        finding("W420", file=file, suggestion=mistake.suggestion, **_facts(mistake))
        for mistake in mistakes
        if (mistake.sheet, str(mistake.cell)) not in wrong
    ]


def report_contradiction(mistake: UnitMistake, contradicted: str, ledger: Ledger) -> None:
    """Record, once, that a mistaken cell of Variants makes its row contradictory; the other cell is not blamed."""
    if any((known.sheet, known.cell) == (mistake.sheet, str(mistake.cell)) for known in ledger.findings):
        ledger.rows.add(mistake.row)
        return
    ledger.add("E329", contradicted=contradicted, rows=[mistake.row], **_facts(mistake))


def _unit_mistake(table: Table, record: Mapping[str, Any], mistaken: tuple[str, float, str]) -> UnitMistake:
    """Return a mistake with what to say of it; the suggestion is in the unit of the cell's own header."""
    key, factor, beside = mistaken
    row, conversion, unit = record["row"], table.heading.factors[key], columns_of(table.schema)[key].unit
    entered = record[key] / conversion
    given = spelled_out(entered, 10)
    shown = f"{given} {unit}" if conversion == 1 else f"{given} ({spelled_out(record[key])} {unit})"
    times = f"{max(factor, 1 / factor):.10g} times too {'small' if factor > 1 else 'large'}"
    return UnitMistake(
        sheet=table.sheet,
        schema=table.schema,
        cell=table.address(row, key),
        column=key,
        variant=record["variant"] or "" if table.schema == "Variants" else "",
        material=plain(record["material"] or "") if table.schema == "Materials" else "",
        row=row,
        shown=shown,
        entered=table.entered(row, key),
        times=times,
        beside=beside,
        suggestion="" if factor == _TENFOLD else f"{entered * factor:.10g}",
    )


def _variant_factors(record: Mapping[str, Any]) -> Iterator[tuple[str, float, str]]:
    """Yield the mistaken cells of a Variants row, each with the factor that fixes it."""
    mistaken = _length_factors(record)
    for key, factor in mistaken.items():
        yield key, factor, "beside the other lengths of the row"
    (key, radius), wall = _radius(record), record["wall_thickness_mm"]
    if mistaken or radius is None or wall is None or not _REACH[0] <= radius <= _REACH[1]:
        return
    mistakes = {name: _torque_factor(record[name], radius, wall) for name in _TORQUES}
    in_doubt = 1 / _THOUSAND in mistakes.values() and radius * _TENFOLD <= _GREATEST_RADIUS
    if in_doubt:
        yield key, _TENFOLD, "for this torque: check the unit of all lengths, or of the torque"
    for name, by in mistakes.items():
        if by is not None and not in_doubt:
            yield name, by, "for this wall" if by < 1 else "for this radius"


def _torque_factor(torque: float | None, radius: float, wall: float) -> float | None:
    """Return by what a torque [N·m] must be multiplied to suit radius and wall [mm]; None where it may be meant."""
    if torque is None:
        return None
    if _FEEBLE[0] <= torque / radius**3 <= _FEEBLE[1]:
        return _THOUSAND
    shear = torque * _THOUSAND / (2 * math.pi * radius**2 * wall)
    mistaken = torque >= _UNUSUAL_TORQUE * radius**3 and shear > _UNBEARABLE_SHEAR >= shear / _THOUSAND
    return 1 / _THOUSAND if mistaken else None


def _radius(record: Mapping[str, Any]) -> tuple[str, float | None]:
    """Return the cell that gives the radius [mm] and its value; the wall's half does not matter here."""
    for key, share in _RADII.items():
        if record[key] is not None:
            return key, record[key] * share
    return "", None


def _length_factors(record: Mapping[str, Any]) -> dict[str, float]:
    """Return the factors that fix the lengths of a row, none where it cannot be told which are wrong.

    The radius is what most of the lengths agree with: as entered, else a thousandfold or a thousandth of it.
    """
    key, radius = _radius(record)
    if radius is None:
        return {}
    lengths = {name: record[name] for name in SHARES if record[name]}
    readings: list[dict[str, float | None]] = []
    for factor in (1.0, _THOUSAND, 1 / _THOUSAND):
        if _REACH[0] <= radius * factor <= _REACH[1]:
            factors = {name: _factor(name, value / (radius * factor)) for name, value in lengths.items()}
            readings.append({key: factor, **factors})
    if not readings:
        return {}
    best = min(readings, key=lambda reading: sum(factor != 1 for factor in reading.values()))
    mistaken = {name: factor for name, factor in best.items() if factor not in {None, 1.0}}
    kept, odd = list(best.values()).count(1.0), list(best.values()).count(None)
    return {} if odd and kept <= len(mistaken) else {name: factor for name, factor in mistaken.items() if factor}


def _factor(key: str, share: float) -> float | None:
    """Return by what a length, as a share of the mean radius, must be multiplied; None where nothing helps."""
    least, most = SHARES[key]
    factor = 1.0 if least <= share <= most else _THOUSAND if share < least else 1 / _THOUSAND
    return factor if least <= share * factor <= most else None


def _material_factors(record: Mapping[str, Any]) -> Iterator[tuple[str, float, str]]:
    """Yield the mistaken cells of a Materials row, each with the factor that fixes it."""
    for key, span in _MATERIAL.items():
        value = record[key]
        if value is not None and not span.below <= value <= span.above:
            meant = (factor for factor in span.factors if span.least <= value * factor <= span.most)
            if factor := next(meant, None):
                yield key, factor, "for any material"
