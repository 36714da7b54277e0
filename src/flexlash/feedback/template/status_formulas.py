"""What the template's row status says: each sentence with its Excel condition and the same test in Python.

The Python twin gives the value that is stored with the formula, so that a viewer which does not calculate
shows the right text.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from flexlash.schema.columns import VARIANTS

__all__ = ["COMPLETE", "status_formula", "status_text"]

COMPLETE = "complete"

Row = Mapping[str, Any]

_KEYS = [column.key for column in VARIANTS]
_NUMBERS = [column.key for column in VARIANTS if column.is_number]


@dataclass(frozen=True, kw_only=True)
class _Rule:
    """A sentence, its Excel condition with `{key}` for a row's cells, and the same condition on a row."""

    text: str
    excel: str
    holds: Callable[[Row, Sequence[Row]], bool]


def _missing(key: str) -> _Rule:
    name = next(column.plain_name for column in VARIANTS if column.key == key)
    return _Rule(text=f"{name.lower()} missing", excel=f'{{{key}}}=""', holds=lambda row, _: not row.get(key))


def _blank(row: Row, key: str) -> bool:
    return row.get(key) in {None, ""}


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _same(one: Any, other: Any) -> bool:
    return str(one).casefold() == str(other).casefold()


def _type(row: Row) -> str:
    return str(row.get("flexspline_type") or "cup").lower()


def _bore(row: Row) -> float:
    """Return the radius of the bore; what is not given counts as 0, as in the formula."""
    mean, bore = row.get("mean_radius_mm") or 0.0, row.get("bore_diameter_mm") or 0.0
    return float(max(mean - row["wall_thickness_mm"] / 2, bore / 2))


def _hub_too_large(row: Row, _: Sequence[Row]) -> bool:
    mean = _bore(row) + row["wall_thickness_mm"] / 2
    return _type(row) == "cup" and row["disk_inner_radius_mm"] >= (row.get("disk_outer_radius_mm") or mean)


_BORE = "MAX({mean_radius_mm}-{wall_thickness_mm}/2,{bore_diameter_mm}/2)"
_CUP = 'OR({flexspline_type}="",{flexspline_type}="cup")'
_RULES = (
    *(_missing(column.key) for column in VARIANTS if column.required),
    _Rule(
        text="material not in Materials",
        excel="COUNTIF(fl_materials,{material})=0",
        holds=lambda row, _: str(row["material"]).casefold() not in row["_materials"],
    ),
    _Rule(
        text="a number is text",
        excel="COUNTA({torque_Nm}:{backlash_limit_arcmin})>COUNT({torque_Nm}:{backlash_limit_arcmin})",
        holds=lambda row, _: any(not _blank(row, key) and not _is_number(row[key]) for key in _NUMBERS),
    ),
    _Rule(
        text="a number is negative",
        excel='COUNTIF({torque_Nm}:{backlash_limit_arcmin},"<0")>0',
        holds=lambda row, _: any(not _blank(row, key) and row[key] < 0 for key in _NUMBERS),
    ),
    _Rule(
        text="mean radius or bore missing",
        excel='AND({mean_radius_mm}="",{bore_diameter_mm}="")',
        holds=lambda row, _: _blank(row, "mean_radius_mm") and _blank(row, "bore_diameter_mm"),
    ),
    _Rule(
        text="mean radius and bore both given",
        excel='AND({mean_radius_mm}<>"",{bore_diameter_mm}<>"")',
        holds=lambda row, _: not _blank(row, "mean_radius_mm") and not _blank(row, "bore_diameter_mm"),
    ),
    _Rule(
        text="disk inner radius missing",
        excel=f'AND({_CUP},{{disk_inner_radius_mm}}="")',
        holds=lambda row, _: _type(row) == "cup" and _blank(row, "disk_inner_radius_mm"),
    ),
    _Rule(
        text="disk outer radius missing",
        excel='AND({flexspline_type}="hat",{disk_outer_radius_mm}="")',
        holds=lambda row, _: _type(row) == "hat" and _blank(row, "disk_outer_radius_mm"),
    ),
    _Rule(
        text="a cylinder has no disk",
        excel='AND({flexspline_type}="cylinder",COUNTA({disk_thickness_mm}:{disk_cone_angle_deg})>0)',
        holds=lambda row, _: (
            _type(row) == "cylinder" and any(not _blank(row, key) for key in _KEYS if key.startswith("disk_"))
        ),
    ),
    _Rule(
        text="exponent needs the thickness at hub",
        excel=f'AND({_CUP},{{disk_thickness_exponent}}<>"",{{disk_hub_thickness_mm}}="")',
        holds=lambda row, _: (
            _type(row) == "cup" and not _blank(row, "disk_thickness_exponent") and _blank(row, "disk_hub_thickness_mm")
        ),
    ),
    _Rule(
        text="exponent and disk thickness both given",
        excel='AND({disk_thickness_exponent}<>"",{disk_thickness_mm}<>"")',
        holds=lambda row, _: not _blank(row, "disk_thickness_exponent") and not _blank(row, "disk_thickness_mm"),
    ),
    _Rule(
        text="wall fills the bore",
        excel=f"{_BORE}<=0",
        holds=lambda row, _: _bore(row) <= 0,
    ),
    _Rule(
        text="hub larger than the disk",
        excel=f'AND({_CUP},{{disk_inner_radius_mm}}>=IF({{disk_outer_radius_mm}}<>"",{{disk_outer_radius_mm}},'
        f"{_BORE}+{{wall_thickness_mm}}/2))",
        holds=_hub_too_large,
    ),
    _Rule(
        text="rim length and thickness belong together",
        excel='({rim_length_mm}="")<>({rim_thickness_mm}="")',
        holds=lambda row, _: _blank(row, "rim_length_mm") != _blank(row, "rim_thickness_mm"),
    ),
    _Rule(
        text="tolerance class not in Tolerances",
        excel='AND({tolerance_class}<>"",COUNTIF(fl_tolerance_rows,{tolerance_class})=0)',
        holds=lambda row, _: (
            not _blank(row, "tolerance_class") and str(row["tolerance_class"]).casefold() not in row["_classes"]
        ),
    ),
    _Rule(
        text="variant used twice",
        excel="COUNTIF(fl_variants,{variant})>1",
        holds=lambda row, rows: sum(_same(other.get("variant"), row["variant"]) for other in rows) > 1,
    ),
)


def status_formula(row: int, letters: Mapping[str, str]) -> str:
    """Return the status formula of a row, the columns standing under these letters."""
    cells = {key: f"${letter}{row}" for key, letter in letters.items()}
    formula = f'"{COMPLETE}"'
    for rule in reversed(_RULES):
        formula = f'IF({rule.excel.format(**cells)},"{rule.text}",{formula})'
    first, last = cells[_KEYS[0]], cells[_KEYS[-1]]
    return f'=IF(COUNTA({first}:{last})=0,"",{formula})'


def status_text(row: Row, rows: Sequence[Row], materials: Sequence[str], classes: Sequence[str]) -> str:
    """Return what the status formula shows for a filled row."""
    known = {
        **row,
        "_materials": {name.casefold() for name in materials},
        "_classes": {name.casefold() for name in classes},
    }
    return next((rule.text for rule in _RULES if rule.holds(known, rows)), COMPLETE)
