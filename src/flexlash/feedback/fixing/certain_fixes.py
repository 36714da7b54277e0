"""Which findings can be fixed without asking: the value to write where nothing else can be meant."""

from __future__ import annotations

from flexlash.schema.findings import Finding

__all__ = ["certain_value_of"]


def certain_value_of(finding: Finding) -> str | float | None:
    """Return what to write into the cell of a finding, numbers as float; None where a person must decide.

    The stage that finds a fault knows what else could be meant and records the fix; this is its rule:

    | code | entered | written |
    |---|---|---|
    | E202 | 1,6 · 1.6 mm · 0.0016 m · 0,8 kNm · 1.600,5 · 1 600 · wide digits, other minuses, stray spaces | number |
    | E202 | 5 % where the unit is known: 5 in a column of per cent, 0.05 in a ratio | number |
    | E202 | R3.5 for a radius, Ø80 for a diameter | number |
    | E202 | 1,600 · ~1.6 · ca. 1.6 · ±0.02 · 1/4 · Ø80 for a radius · out of bounds · unknown unit | nothing |
    | E202 | 5 % beside a blank deviation unit · a table's number whose decimal sign is in doubt | nothing |
    | E203 | a date | nothing |
    | E112 | a header that resembles one column only, with a unit that is known or not needed | header |
    | E209, E307, E309 | a name at least 85 % like one of the list, no other as near, digits alike | name |
    | E210 | IT 7 · it7 · H 7 · ISO 2768-mK · 2768 m | grade |
    | E210 | 7 | nothing |
    | I504 | other letter case or spaces in a name | name |

    >>> from flexlash.schema.findings import finding
    >>> certain_value_of(finding("E203", name="Torque", value="2026-04-01", requirement="a number in N·m")) is None
    True
    """
    return finding.certain_value
