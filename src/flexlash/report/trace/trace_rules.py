"""What the inputs of Trace must be to make a part: the rules of a submission, as live conditions with their words.

Tolerances are no matter here: a part that is possible only without them is traced.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from xlsxwriter.utility import xl_range_abs

from flexlash.report.formula.functions import (
    AND,
    CONCATENATE,
    IF,
    IFERROR,
    INDEX,
    ISNUMBER,
    MATCH,
    NOT,
    OR,
    N,
    on_sheet,
)
from flexlash.report.formula.live import Live, Range, Value, fill, live, put
from flexlash.report.trace.inputs import ENTERED
from flexlash.report.trace.trace_page import LEFT_OUT, SHEET, Page
from flexlash.schema.columns import VARIANTS
from flexlash.schema.entry_words import wrong_number
from flexlash.schema.part_row import PartRow
from flexlash.schema.part_rules import PART_RULES

__all__ = ["ALWAYS", "RULES_WIDTH", "TYPES", "InputRow", "write_rules"]

ALWAYS = frozenset({
    "torque", "cylinder_length", "wall_thickness", "cylinder_calibration", "disk_calibration",
    "lost_motion_percent",
})  # fmt: skip
"""Inputs that cannot be left out."""

TYPES = next(column.choices for column in VARIANTS if column.key == "flexspline_type")
RULES_WIDTH = 3
"""Columns that the rules take."""

_INSTEAD = {"mean_radius": "bore_diameter", "bore_diameter": "mean_radius"}
"""Inputs of which the one typed takes the place of the other, submitted one."""

_HEADS = (("The inputs make no part when …", 72), ("So?", 9), ("Finding", 9))


@dataclass(frozen=True, kw_only=True)
class _Rule:
    """A fault in words, whether it is there, and the code of the finding that a submission would get for it."""

    words: str
    broken: Live
    code: Live


class InputRow(PartRow):
    """The inputs of Trace as its steps refer to them; a bore or radius that is typed takes the other's place."""

    def __init__(self, page: Page) -> None:
        self._page = page
        self.names = [name for name in page.entries if name in ENTERED]

    def __getitem__(self, name: str) -> Live:
        """Return the value used, 0 for none."""
        return N(on_sheet(SHEET, self._page[name]))

    def entered(self, name: str) -> Live:
        """Return the value used: Trace itself says what a blank stands for."""
        return self[name]

    def change(self, name: str) -> Live:
        """Return the cell for a change."""
        return on_sheet(SHEET, self._page.entries[name][1])

    def given(self, name: str) -> Live:
        """Return whether a number was typed or, without a change, submitted."""
        submitted, change = (on_sheet(SHEET, cell) for cell in self._page.entries[name])
        stands = [change.equals(""), ISNUMBER(submitted)]
        if other := _INSTEAD.get(name):
            stands.append(NOT(ISNUMBER(self.change(other))))
        return OR(ISNUMBER(change), AND(*stands))

    def blank(self, name: str) -> Live:
        """Return whether there is no number."""
        return NOT(self.given(name))

    def is_type(self, *types: str) -> Live:
        """Return whether the flexspline is of one of these types."""
        used = on_sheet(SHEET, self._page["flexspline_type"])
        return OR(*(used.equals(name) for name in types))

    def when(self, condition: Live, then: Live, otherwise: Live) -> Live:
        """Return one of two inputs."""
        return IF(condition, then, otherwise)

    def all_of(self, *conditions: Live) -> Live:
        """Return whether all conditions hold."""
        return AND(*conditions)

    def any_of(self, *conditions: Live) -> Live:
        """Return whether at least one condition holds."""
        return OR(*conditions)


def write_rules(page: Page, sheet: Any, top: int) -> tuple[Live, int]:
    """Write the rules below a row; return the words of the first that is broken, else "", and the last row."""
    inputs = InputRow(page)
    rules = [*_entries(inputs), _constants(inputs), *_of_part(inputs)]
    for column, (heading, width) in enumerate(_HEADS):
        sheet.set_column(column, column, width)
        sheet.write_string(top, column, heading, page.book.format("header"))
    style, so = page.book.format("text"), page.book.format("figure", '"yes";;"no"')
    for row, rule in enumerate(rules, start=top + 1):
        fill(sheet, row, 0, rule.words, style)
        put(sheet, row, 1, IF(rule.broken, 1.0, 0.0), so)
        put(sheet, row, 2, rule.code, page.book.format("figure"))
    last = top + len(rules)
    entries: tuple[Sequence[Value], ...] = (
        [rule.words for rule in rules],
        [float(bool(rule.broken.value)) for rule in rules],
        [rule.code.value for rule in rules],
    )
    columns = [Range(xl_range_abs(top + 1, column, last, column), values) for column, values in enumerate(entries)]
    sheet.write_string(last + 1, 0, "The first of these lines that applies; 0 for none", page.book.format("label"))
    first = put(sheet, last + 1, 1, IFERROR(MATCH(1.0, columns[1], 0), 0.0), page.book.format("figure"))
    words = INDEX(columns[0], first)
    code = INDEX(columns[2], first)
    fault = put(sheet, last + 2, 0, IF(first > 0, CONCATENATE(words, " (", code, ")"), ""), style)
    return fault, last + 2


def _rule(code: str, words: str, *broken: Live) -> _Rule:
    """Return a rule that is broken when all conditions hold."""
    return _Rule(words=words, broken=AND(*broken), code=live(code))


def _entries(inputs: InputRow) -> Iterator[_Rule]:
    """Yield that a change is an entry of the list, or a number within the bounds of its column."""
    change = inputs.change("flexspline_type")
    known = OR(*(change.equals(word) for word in ("", *TYPES)))
    yield _rule("E209", "the flexspline type is unknown", NOT(known))
    for name in inputs.names:
        column, change = ENTERED[name], inputs.change(name)
        least = column.minimum or 0.0
        below = change <= least if column.exclusive_minimum else change < least
        wrong = below if column.maximum is None else OR(below, change > column.maximum)
        size = "E207" if column.maximum is None else IF(below, "E207", "E208")
        left_out = change.equals(LEFT_OUT)
        blank = change.equals("") if name in ALWAYS else OR(change.equals(""), left_out)
        yield _Rule(
            words=wrong_number(column),
            broken=AND(NOT(blank), OR(NOT(ISNUMBER(change)), wrong)),
            code=IF(ISNUMBER(change), size, IF(left_out, "E201", "E202") if name in ALWAYS else "E202"),
        )


def _constants(inputs: InputRow) -> _Rule:
    """Return that a material has elastic constants."""
    young_or_poisson = OR(inputs.blank("youngs_modulus"), inputs.blank("poisson_ratio"))
    return _rule("E322", "neither E with ν nor G is given", inputs.blank("shear_modulus"), young_or_poisson)


def _of_part(inputs: InputRow) -> Iterator[_Rule]:
    """Yield the rules of a submission that make no part."""
    for rule in PART_RULES:
        if rule.is_error:
            yield _rule(rule.code, rule.words, *rule.broken(inputs))
