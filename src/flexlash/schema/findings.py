"""What flexlash finds in a submission: one record a finding, worded by the catalogue."""

from __future__ import annotations

import datetime
import re
from dataclasses import dataclass
from typing import Any

from flexlash.schema.cell_addresses import CellAddress, cell_address
from flexlash.schema.finding_catalogue import CATALOGUE, Level

__all__ = ["CATALOGUE", "Finding", "finding", "readable", "shown", "spelled_out"]


@dataclass(frozen=True, kw_only=True)
class Finding:
    """One thing found in a submission, at the address that its user sees.

    `suggestion` is what was probably meant, in words; `certain_value` what to write where nothing else can be meant.
    """

    level: Level
    code: str
    sheet: str = ""
    cell: str = ""
    variant: str = ""
    column: str = ""
    value: str = ""
    message: str
    fix: str
    suggestion: str = ""
    certain_value: str | float | None = None

    def as_dictionary(self) -> dict[str, str]:
        """Return the fields in the order of the Findings sheet."""
        return {key: value for key, value in vars(self).items() if key != "certain_value"}

    @property
    def place(self) -> str:
        """Sheet and cell as Excel writes them: `Variants!D7`."""
        return f"{self.sheet}!{self.cell}" if self.cell else self.sheet

    @property
    def address(self) -> CellAddress | None:
        """Row and column of the cell, None for a finding without one."""
        return cell_address(self.cell)

    @property
    def row(self) -> int:
        """Row of the cell, 0 for a finding without one."""
        return self.address.row if self.address else 0


_LONGEST = 400
"""Most characters of a text that a message quotes from outside."""


def finding(code: str, *, sheet: str = "", cell: CellAddress | str = "", column: str = "", **facts: Any) -> Finding:
    """Return a finding with the catalogue's words filled in.

    `facts` are what the message names; `variant`, `value`, `suggestion` and `certain_value` also become fields.
    `entered` is the value as entered, where the message names another.
    """
    rule = CATALOGUE[code]
    place = f"{sheet}!{cell}" if sheet and cell else sheet or str(facts.get("file", ""))
    value = facts.get("value", "")
    inert = {key: _inert(fact) for key, fact in facts.items()}
    kind = "date" if isinstance(value, datetime.date) else "time"
    words = {"file": "The file", "kind": kind, **inert, "place": shown(place, _LONGEST), "value": shown(value)}
    suggestion = str(inert.get("suggestion", ""))
    message = rule.message.format(**words)
    if suggestion and "{suggestion}" not in rule.message:
        message = f"{message.removesuffix('.')}; did you mean {suggestion}?"
    return Finding(
        level=rule.level,
        code=code,
        sheet=sheet,
        cell=str(cell),
        column=column,
        variant=str(inert.get("variant", "")),
        value=shown(facts.get("entered", value)),
        message=message,
        fix=rule.fix.format(**words),
        suggestion=suggestion,
        certain_value=facts.get("certain_value"),
    )


def _inert(fact: Any) -> Any:
    """Return a fact as a message names it: a text without harm, a number without a power of ten."""
    if isinstance(fact, float):
        return spelled_out(fact, 6)
    return shown(fact, _LONGEST) if isinstance(fact, str) else fact


_NO_CHARACTER = re.compile(r"[\ud800-\udfff]")
_BYTES = range(0xDC80, 0xDD00)
"""What Python takes for the bytes of a name that are no UTF-8."""


def readable(text: object) -> str:
    r"""Return a text, such as a path, with what is no character in it escaped: a file's name need not be UTF-8.

    >>> readable("caf\udce9.csv")
    'caf\\xe9.csv'
    """
    return _NO_CHARACTER.sub(lambda match: _escaped(ord(match[0])), str(text))


def _escaped(code: int) -> str:
    """Return a byte that is no UTF-8, or half a character of UTF-16, as Python writes it."""
    return f"\\x{code - 0xDC00:02x}" if code in _BYTES else f"\\u{code:04x}"


def shown(value: Any, longest: int = 60) -> str:
    """Return a value as a message shows it: short, on one line, without control characters.

    >>> shown(1.50), shown(True), shown("a" * 99)[-3:]
    ('1.5', 'TRUE', 'aa…')
    """
    if isinstance(value, bool):
        return str(value).upper()
    text = f"{value:.10g}" if isinstance(value, float) else str(value)
    text = readable(text)
    text = text if len(text) <= longest else text[: longest - 1] + "…"
    return text if text.isprintable() else "".join(letter if letter.isprintable() else "·" for letter in text)


def spelled_out(value: float, digits: int = 4) -> str:
    """Return a number rounded to so many digits, without a power of ten unless it is tiny.

    >>> spelled_out(80000.0), spelled_out(0.0016), spelled_out(1600.0)
    ('80000', '0.0016', '1600')
    """
    rounded = float(f"{value:.{digits}g}")
    return f"{rounded:.15g}"
