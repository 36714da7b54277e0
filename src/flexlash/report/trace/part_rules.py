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
from flexlash.schema.columns import VARIANTS, Column

__all__ = ["ALWAYS", "RULES_WIDTH", "TYPES", "write_rules"]

ALWAYS = frozenset({
    "torque", "cylinder_length", "wall_thickness", "cylinder_calibration", "disk_calibration",
    "lost_motion_percent",
})  # fmt: skip
"""Inputs that cannot be left out."""

TYPES = next(column.choices for column in VARIANTS if column.key == "flexspline_type")
RULES_WIDTH = 3
"""Columns that the rules take."""

_HEADS = (("The inputs make no part when …", 72), ("So?", 9), ("Finding", 9))
_FLAT = 89.9999
"""Angle to the axis [°] from which on a disk counts as flat, as for a submission."""

_EDGE = 1e-9
"""What counts as on an edge [mm], as for a submission."""


@dataclass(frozen=True, kw_only=True)
class _Rule:
    """A fault in words, whether it is there, and the code of the finding that a submission would get for it."""

    words: str
    broken: Live
    code: Live


class _Inputs:
    """The inputs of Trace as its steps refer to them."""

    def __init__(self, page: Page) -> None:
        self._page = page
        self.names = [name for name in page.entries if name in ENTERED]

    def __getitem__(self, name: str) -> Live:
        """Return the value used, 0 for none."""
        return N(on_sheet(SHEET, self._page[name]))

    def change(self, name: str) -> Live:
        """Return the cell for a change."""
        return on_sheet(SHEET, self._page.entries[name][1])

    def is_given(self, name: str) -> Live:
        """Return whether a number was typed or, without a change, submitted."""
        submitted, change = (on_sheet(SHEET, cell) for cell in self._page.entries[name])
        return OR(ISNUMBER(change), AND(change.equals(""), ISNUMBER(submitted)))

    def is_blank(self, name: str) -> Live:
        """Return whether there is no number."""
        return NOT(self.is_given(name))

    def is_type(self, *names: str) -> Live:
        """Return whether the flexspline is of one of these types."""
        used = on_sheet(SHEET, self._page["flexspline_type"])
        return OR(*(used.equals(name) for name in names))


def write_rules(page: Page, sheet: Any, top: int) -> tuple[Live, int]:
    """Write the rules below a row; return the words of the first that is broken, else "", and the last row."""
    inputs = _Inputs(page)
    rules = [*_entries(inputs), *_belonging(inputs), *_missing(inputs), *_profile(inputs), *_shape(inputs)]
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
    sheet.write_string(last + 1, 0, "The first of these lines that is so; 0 for none", page.book.format("label"))
    first = put(sheet, last + 1, 1, IFERROR(MATCH(1.0, columns[1], 0), 0.0), page.book.format("figure"))
    words = INDEX(columns[0], first)
    code = INDEX(columns[2], first)
    fault = put(sheet, last + 2, 0, IF(first > 0, CONCATENATE(words, " (", code, ")"), ""), style)
    return fault, last + 2


def _rule(code: str, words: str, *broken: Live) -> _Rule:
    """Return a rule that is broken when all conditions hold."""
    return _Rule(words=words, broken=AND(*broken), code=live(code))


def _entries(inputs: _Inputs) -> Iterator[_Rule]:
    """Yield that a change is an entry of the list, or a number within the bounds of its column."""
    change = inputs.change("flexspline_type")
    known = OR(*(change.equals(word) for word in ("", *TYPES)))
    yield _rule("E209", "the type is not one of its list", NOT(known))
    for name in inputs.names:
        column, change = ENTERED[name], inputs.change(name)
        least = column.minimum or 0.0
        below = change <= least if column.exclusive_minimum else change < least
        wrong = below if column.maximum is None else OR(below, change > column.maximum)
        size = "E207" if column.maximum is None else IF(below, "E207", "E208")
        left_out = change.equals(LEFT_OUT)
        blank = change.equals("") if name in ALWAYS else OR(change.equals(""), left_out)
        yield _Rule(
            words=f"{_word(column)} is not {_bounds(column)}",
            broken=AND(NOT(blank), OR(NOT(ISNUMBER(change)), wrong)),
            code=IF(ISNUMBER(change), size, IF(left_out, "E201", "E202") if name in ALWAYS else "E202"),
        )


def _word(column: Column) -> str:
    """Return a column's name inside a sentence."""
    name = column.plain_name.replace("_", " ")
    return name if name.startswith(("Young", "Poisson")) else name[0].lower() + name[1:]


def _bounds(column: Column) -> str:
    """Return what a number must be: `a number from 30 to 90 °`."""
    unit = "" if column.unit in {"", "-"} else f" {column.unit}"
    least = f"{column.minimum:.15g}"
    if column.maximum is None:
        return f"a number above {least}{unit}" if column.exclusive_minimum else f"a number of at least {least}{unit}"
    most = f"{column.maximum:.15g}{unit}"
    return f"a number above {least}, at most {most}" if column.exclusive_minimum else f"a number from {least} to {most}"


def _belonging(inputs: _Inputs) -> Iterator[_Rule]:
    """Yield that a flexspline has only dimensions of its type."""
    for name in ("disk_thickness", "disk_inner_radius", "disk_outer_radius", "disk_cone_angle"):
        yield _rule(
            "E310", f"a cylinder has no {_word(ENTERED[name])}", inputs.is_type("cylinder"), inputs.is_given(name)
        )
    for name in ("disk_hub_thickness", "disk_thickness_exponent", "hub_fillet_radius", "junction_fillet_radius"):
        has = inputs.is_given(name) if name == "disk_thickness_exponent" else inputs[name] > 0
        yield _rule("E310", f"only a cup has a {_word(ENTERED[name])}", inputs.is_type("cylinder", "hat"), has)


def _missing(inputs: _Inputs) -> Iterator[_Rule]:
    """Yield that what is needed is given, once."""
    constants = OR(inputs.is_blank("youngs_modulus"), inputs.is_blank("poisson_ratio"))
    yield _rule("E322", "neither E with ν nor G is given", inputs.is_blank("shear_modulus"), constants)
    blank = inputs.is_blank("mean_radius"), inputs.is_blank("bore_diameter")
    yield _rule("E301", "neither mean radius nor bore diameter is given", *blank)
    typed = ISNUMBER(inputs.change("mean_radius")), ISNUMBER(inputs.change("bore_diameter"))
    yield _rule("E302", "mean radius and bore diameter are both typed", *typed)
    is_cup, is_hat = inputs.is_type("cup"), inputs.is_type("hat")
    yield _rule("E311", "a cup without a disk inner radius", is_cup, inputs.is_blank("disk_inner_radius"))
    yield _rule("E311", "a hat without a disk outer radius", is_hat, inputs.is_blank("disk_outer_radius"))
    length, thickness = "rim_length", "rim_thickness"
    yield _rule("E304", "a tooth rim without a thickness", inputs.is_given(length), inputs.is_blank(thickness))
    yield _rule("E304", "a tooth rim without a length", inputs.is_given(thickness), inputs.is_blank(length))


def _profile(inputs: _Inputs) -> Iterator[_Rule]:
    """Yield that a disk has one profile, and that a cone has no fillets."""
    is_cup, hub = inputs.is_type("cup"), "disk_hub_thickness"
    power = is_cup, inputs.is_given("disk_thickness_exponent")
    yield _rule("E325", "an exponent without a thickness at hub", *power, inputs.is_blank(hub))
    both = inputs.is_given(hub), inputs.is_given("disk_thickness")
    yield _rule("E326", "an exponent and a disk thickness are both given", *power, *both)
    is_cone = inputs["disk_cone_angle"] < _FLAT
    for name in ("hub_fillet_radius", "junction_fillet_radius"):
        words = f"a conical disk with a {_word(ENTERED[name])}"
        yield _rule("E327", words, is_cup, is_cone, inputs[name] > 0)


def _shape(inputs: _Inputs) -> Iterator[_Rule]:
    """Yield that one dimension leaves room for another."""
    is_cup, wall, length = inputs.is_type("cup"), inputs["wall_thickness"], inputs["cylinder_length"]
    inner, outer, rim = inputs["disk_inner_radius"], inputs["disk_outer_radius"], inputs["rim_length"]
    hub, junction, mean = inputs["hub_fillet_radius"], inputs["junction_fillet_radius"], inputs["mean_radius"]
    bore = mean - wall / 2
    yield _rule("E330", "wall is not below twice the mean radius: no bore", bore <= _EDGE)
    has_disk = inputs.is_type("cup", "hat")
    yield _rule("E303", "disk inner radius is not below disk outer radius", has_disk, inner >= outer)
    yield _rule("E305", "tooth rim is not shorter than the cylinder", inputs.is_given("rim_length"), rim >= length)
    thin = inputs.is_given("rim_thickness"), inputs["rim_thickness"] < wall
    yield _rule("E306", "tooth rim is thinner than the wall", *thin)
    too_wide = hub > outer - inner + _EDGE
    yield _rule("E312", "hub fillet is wider than the disk", is_cup, inner < outer, too_wide)
    too_long = length > rim, junction + rim > length + _EDGE
    yield _rule("E313", "junction fillet and tooth rim exceed the length", is_cup, junction > 0, *too_long)
    yield _rule("E328", "junction fillet is wider than the bore", is_cup, junction > bore + _EDGE)
