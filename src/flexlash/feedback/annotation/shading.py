"""Conditional formats that keep a mark visible where the user's own conditional formats would paint over it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping

from flexlash.feedback.annotation.appearance import COLOURS
from flexlash.feedback.splicing.sheet_spans import WORKSHEET_ORDER, Area, area_of
from flexlash.feedback.splicing.stylesheet import Stylesheet
from flexlash.feedback.splicing.xml_spans import (
    ElementSpan,
    element_spans,
    in_order,
    prefixed,
    spliced,
    with_attributes,
    xml_text,
)
from flexlash.schema.cell_addresses import column_letters
from flexlash.schema.finding_catalogue import Level

__all__ = ["overrule", "withdraw"]

_ALWAYS = '"flexlash"="flexlash"'
"""A condition that is always true and by which our own rules are known."""

Cell = tuple[int, int]
Run = tuple[int, int, int]
"""Column, first row and last row of cells that stand under each other."""


def withdraw(part: bytes) -> bytes:
    """Return a worksheet without our own rules, the user's at their places again."""
    if _ALWAYS.encode() not in part and xml_text(_ALWAYS) not in part:
        return part
    areas: list[tuple[ElementSpan, list[ElementSpan], set[str]]] = []
    for span in element_spans(part, ("conditionalFormatting", "cfRule", "formula"))[1:]:
        if span.name == "conditionalFormatting":
            areas.append((span, [], set()))
        elif span.name == "cfRule":
            areas[-1][1].append(span)
        elif span.parent == "cfRule":
            areas[-1][2].add(span.text)
    ours = [area for area, _, formulas in areas if formulas == {_ALWAYS}]
    theirs = [rule for _, rules, formulas in areas if formulas != {_ALWAYS} for rule in rules]
    steps = min([len(ours), *(_priority(rule) - 1 for rule in theirs if "priority" in rule.attributes)])
    cut = [(area.start, area.end, b"") for area in ours]
    return spliced(part, [*cut, *_moved(part, theirs, lambda priority: priority - steps)])


def overrule(part: bytes, styles: Stylesheet, cells: Mapping[Level, Iterable[Cell]]) -> bytes:
    """Return a worksheet in which marked cells have a rule before all others, where the user's rules reach them."""
    spans = element_spans(part, ("conditionalFormatting", "cfRule", "sqref"))[1:]
    texts = [one.text if one.name == "sqref" else one.attributes.get("sqref", "") for one in spans]
    taken = [area for text in texts for area in map(area_of, text.split())]
    ours = {level: [run for run in _runs(on_level) if _reached(run, taken)] for level, on_level in cells.items()}
    needed = [(level, " ".join(map(_reference, runs))) for level, runs in ours.items() if runs]
    if not needed:
        return part
    rules = [span for span in spans if span.name == "cfRule"]
    part = spliced(part, _moved(part, rules, lambda priority: priority + len(needed)))
    new = b""
    for priority, (level, areas) in enumerate(needed, start=1):
        colour = COLOURS[level].encode()
        look = b'<@dxf><@fill><@patternFill><@bgColor rgb="%s"/></@patternFill></@fill></@dxf>' % colour
        new += (
            b'<@conditionalFormatting sqref="%s"><@cfRule type="expression" dxfId="%d" priority="%d"><@formula>%s'
            b"</@formula></@cfRule></@conditionalFormatting>"
            % (areas.encode(), styles.add("dxfs", look), priority, xml_text(_ALWAYS))
        )
    # Excel goes by priority, LibreOffice by order.
    first = next((one for one in element_spans(part, ("conditionalFormatting",)) if _is_plain(one)), None)
    if first is None:
        return in_order(part, WORKSHEET_ORDER, "conditionalFormatting", new)
    return spliced(part, [(first.start, first.start, prefixed(new, first.prefix))])


def _is_plain(span: ElementSpan) -> bool:
    return span.name == "conditionalFormatting" and span.parent == "worksheet"


def _priority(rule: ElementSpan) -> int:
    return int(rule.attributes["priority"])


def _moved(part: bytes, rules: Iterable[ElementSpan], moved: Callable[[int], int]) -> Iterator[tuple[int, int, bytes]]:
    """Yield what is to change so that rules have other priorities."""
    for rule in rules:
        if "priority" in rule.attributes:
            tag = with_attributes(part[rule.start : rule.inner], priority=str(moved(_priority(rule))))
            yield rule.start, rule.inner, tag


def _runs(cells: Iterable[Cell]) -> Iterator[Run]:
    """Yield the runs of cells that stand under each other."""
    run: Run | None = None
    for row, column in sorted(cells, key=lambda cell: cell[::-1]):
        if run and (column, row) == (run[0], run[2] + 1):
            run = (column, run[1], row)
        else:
            if run:
                yield run
            run = (column, row, row)
    if run:
        yield run


def _reached(run: Run, areas: Iterable[Area]) -> bool:
    """Whether one of the areas holds a cell of a run."""
    column, first, last = run
    return any(left <= column <= right and top <= last and first <= bottom for top, left, bottom, right in areas)


def _reference(run: Run) -> str:
    letters = column_letters(run[0])
    return f"{letters}{run[1]}:{letters}{run[2]}" if run[1] < run[2] else f"{letters}{run[1]}"
