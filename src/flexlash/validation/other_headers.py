"""Headers of columns that the template does not have, but whose values engineers expect to take part."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Collection, Mapping
from itertools import chain

from flexlash.schema.columns import VARIANTS
from flexlash.schema.spellings import plain
from flexlash.schema.units import find_unit

__all__ = ["radius_of_diameter", "tolerance_columns"]

_WORD = re.compile(r"±|\+\s?/?\s?[-−–]|[^\W_]+")

_STEMS = ("toleran", "tolleran", "deviation", "abweichung", "abmass", "streuung", "ecart", "scostament")
"""Beginnings or ends of words that speak of a tolerance in English, German, French and Italian."""

_TOLERANCES = frozenset({"±", "+/-", "+-", "tol", "tols", "toler", "lsl", "usl"})
_PROCESS = frozenset(
    {"sd", "stdev", "stddev", "stdabw", "cp", "cpk", "cmk", "ppk", "sigma", "σ", "variance", "varianz"}
)
_OPEN = {
    **dict.fromkeys(("dev", "it"), "a tolerance"),
    **dict.fromkeys(
        ("mean", "average", "avg", "mittelwert", "moyenne", "s", "std", "pp", "cm", "spread", "scatter"),
        "a figure of a process",
    ),
}
"""Words that speak of a tolerance or of a process only when they stand alone or beside the name of a dimension."""

_BESIDE = frozenset({"value", "values", "shift", "grade", "of"})
_SIZES = frozenset({"radius", "radii", "radi", "diameter", "diameters"})

_ENDS = {
    "lower": ("min", "minimum", "lower", "low", "lo", "untere", "unteres", "unten", "kleinst"),
    "upper": ("max", "maximum", "upper", "high", "hi", "obere", "oberes", "oben", "größt"),
}
_QUANTITIES = ("length", "torque", "angle", "ratio", "stress")
_DIMENSIONS = frozenset(
    word
    for column in VARIANTS
    if column.is_number
    for word in column.plain_name.casefold().split()
    if len(word) > 3  # noqa: PLR2004
) - {"rated", "load", "limit"}

_DIAMETER = re.compile(r"diamet|diamèt|durchmesser|[øØ⌀∅]")
_DIAMETERS = frozenset({"dia", "diam", "dm", "dmr", "od", "pcd"})
_NOT_A_PART = ("fillet", "rim", "tooth", "teeth", "shaft", "bearing", "wave", "hole", "screw", "thread", "wire", "ball")
_BY_PART = {
    "disk_inner_radius_mm": "hub nabe moyeu mozzo diskinner discinner clamp boss",
    "disk_outer_radius_mm": "boltcircle pitchcircle lochkreis flange flansch diskouter discouter pcd",
    "bore_diameter_mm": "inner inside innen internal intérieur interno",
    "mean_radius_mm": "mean mid mittler moyen medio neutral outer outside außen aussen od cup wall cylinder flexspline "
    "extérieur esterno",
}
"""Letters of headers that name a diameter, by the column that holds its half or, for the bore, itself."""


def _words(name: str) -> list[str]:
    """Return the words of a name without accents and dots, and ± in one spelling."""
    bare = "".join(sign for sign in unicodedata.normalize("NFKD", name) if not unicodedata.combining(sign))
    folded = bare.casefold()
    return [re.sub(r"[\s−–]", lambda sign: "-" if sign[0] in "−–" else "", word) for word in _WORD.findall(folded)]


def radius_of_diameter(name: str, present: Collection[str]) -> str | None:
    """Return the column that a header naming a diameter belongs in; None where it names none, or that is there.

    >>> radius_of_diameter("Hub diameter", ()), radius_of_diameter("Mean Ø", ()), radius_of_diameter("Inner dia.", ())
    ('disk_inner_radius_mm', 'mean_radius_mm', 'bore_diameter_mm')
    >>> radius_of_diameter("Outer diameter", ["mean_radius_mm"]), radius_of_diameter("Hub radius", ())
    (None, None)
    """
    words, letters = _words(name), plain(name)
    if not (_DIAMETER.search(letters) or _DIAMETERS.intersection(words)) or any(
        part in letters for part in _NOT_A_PART
    ):
        return None
    rest = [word for word in words if not _DIAMETER.search(word) and word not in {"dia", "diam", "dm", "mm"}]
    named = (
        key
        for key, parts in _BY_PART.items()
        if any(part in (words if part in _DIAMETERS else letters) for part in parts.split())
    )
    key = next(named, None if rest else "mean_radius_mm")
    radius_is_there = "mean_radius_mm" in present or "bore_diameter_mm" in present
    is_there = radius_is_there if key in {"mean_radius_mm", "bore_diameter_mm"} else key in present
    return None if is_there else key


def tolerance_columns(names: Mapping[int, tuple[str, str | None]]) -> dict[int, str]:
    """Return what each header that seems to hold a tolerance or a figure of a process looks like, by its index.

    `names` are the unknown headers of a row and the units in their brackets.

    >>> tolerance_columns({1: ("Wall thickness tol.", "mm"), 2: ("Cpk", None), 3: ("Specification", None)})
    {1: 'a tolerance', 2: 'a figure of a process'}
    """
    looks = {index: what for index, (name, unit) in names.items() if (what := _looks_like(name, unit))}
    ends: dict[str, dict[tuple[str, ...], int]] = {"lower": {}, "upper": {}}
    for index, (name, _) in names.items():
        words = _words(name)
        for end, spellings in _ENDS.items():
            rest = tuple(word for word in words if word not in spellings)
            if len(rest) < len(words) and _is_dimension(rest):
                ends[end][rest] = index
    for rest in ends["lower"].keys() & ends["upper"].keys():
        looks |= {ends[end][rest]: "a limit" for end in ends}
    return dict(sorted(looks.items()))


def _looks_like(name: str, unit: str | None) -> str:
    """Return what a header looks like by itself, an empty text for none of all this."""
    words = _words(name)
    if unit and _TOLERANCES.intersection(_words(unit)):
        return "a tolerance"
    if not words or (unit and not any(find_unit(unit, quantity) for quantity in _QUANTITIES)):
        return ""
    if _TOLERANCES.intersection(words) or any(
        stem in word for stem in _STEMS for word in words if word != "deviations"
    ):
        return "a standard deviation" if {"standard", "std"} & {*words} else "a tolerance"
    is_stress = bool(unit and find_unit(unit, "stress"))
    if _PROCESS.intersection(words) and not (is_stress and {"sigma", "σ"} & {*words}):
        return "a figure of a process"
    first = next((word for word in (words[0], words[-1]) if word in _OPEN), "")
    rest = [word for word in words if word not in _OPEN.keys() | _BESIDE]
    if not _SIZES.isdisjoint(rest) and first == words[0]:  # Mean radius is no mean of anything
        return ""
    return _OPEN[first] if first and (not rest or _is_dimension(rest)) else ""


def _is_dimension(words: Collection[str]) -> bool:
    """Whether words name a dimension of a flexspline."""
    return not _DIMENSIONS.isdisjoint(chain(words, (word.removesuffix("s") for word in words)))
