"""The Findings sheet of a marked copy: what was found, where, and how to fix it, worst first."""

from __future__ import annotations

import textwrap
from collections.abc import Collection, Sequence

from flexlash.feedback.annotation.appearance import COLOURS, FILLS, plain, solid
from flexlash.feedback.annotation.guilty_cells import LEVELS
from flexlash.feedback.annotation.marks_record import quoted
from flexlash.feedback.splicing.sheet_spans import cell_xml
from flexlash.feedback.splicing.stylesheet import Stylesheet
from flexlash.feedback.splicing.xml_spans import xml_text
from flexlash.reading.elements import MAIN
from flexlash.schema.cell_addresses import CellAddress, column_letters
from flexlash.schema.findings import Finding
from flexlash.schema.result_columns import FINDINGS

__all__ = ["MOST_LISTED", "counted", "findings_sheet"]

MOST_LISTED = 5_000
"""Findings beyond this number are counted, not listed."""

_WIDTHS = {"code": 8, "message": 62, "fix": 46, "suggestion": 18, "variant": 20, "column": 24, "value": 20}
_LETTERS_ACROSS = 150
_LINE = 15
_AS_ENTERED = {"variant", "value", "suggestion"}
_LAST = column_letters(len(FINDINGS))

_NAME = '<@name val="Calibri"/><@family val="2"/></@font>'
_FONTS = {
    "title": f'<@font><@b/><@sz val="16"/><@color rgb="FF1F3A5F"/>{_NAME}',
    "text": f'<@font><@sz val="11"/>{_NAME}',
    "head": f'<@font><@b/><@sz val="11"/>{_NAME}',
    "link": f'<@font><@u/><@sz val="11"/><@color rgb="FF0072B2"/>{_NAME}',
}
_EDGE = '<@{side} style="thin"><@color rgb="FF8EA9C1"/></@{side}>'
_BOX = "".join(_EDGE.format(side=side) for side in ("left", "right", "top", "bottom"))
_BORDERS = {
    "none": "<@border><@left/><@right/><@top/><@bottom/><@diagonal/></@border>",
    "box": f"<@border>{_BOX}<@diagonal/></@border>",
    "line": '<@border><@left/><@right/><@top/><@bottom style="hair"><@color rgb="FF8EA9C1"/></@bottom><@diagonal/>'
    "</@border>",
}
_HEAD_FILL = solid("FFD9E2EC")
_CENTRE = '<@alignment horizontal="center" vertical="center" wrapText="1"/>'
_WRAP, _MIDDLE = '<@alignment vertical="center" wrapText="1"/>', '<@alignment vertical="center"/>'


def counted(findings: Sequence[Finding]) -> str:
    """Return in words how many errors and warnings there are.

    >>> counted([])
    'no errors and no warnings'
    """
    words = []
    for level in ("error", "warning"):
        number = sum(one.level == level for one in findings)
        words.append(f"{number:,} {level}{'' if number == 1 else 's'}" if number else f"no {level}s")
    return " and ".join(words)


def findings_sheet(
    findings: Sequence[Finding], lines: Sequence[str], styles: Stylesheet, reachable: Collection[str]
) -> tuple[bytes, int, int]:
    """Return a worksheet that lists findings under a title and further lines, and its header's and last row.

    Cells of the `reachable` sheets are linked.
    """
    looks = _looks(styles)
    rows = [_row(1, [cell_xml("A1", plain(lines[0]), "", looks["title"])], 24)]
    top = [part for line in lines[1:] for part in textwrap.wrap(line, _LETTERS_ACROSS)]
    for row, text in enumerate(top, start=2):
        rows.append(_row(row, [cell_xml(f"A{row}", plain(text), "", looks["text"])]))
    header = len(top) + 3
    heads = [
        cell_xml(str(CellAddress(header, place)), plain(one.label), "", looks["head"])
        for place, one in enumerate(FINDINGS, 1)
    ]
    rows.append(_row(header, heads, 22))
    order = sorted(findings, key=lambda one: (LEVELS.index(one.level), one.code))
    links = []
    for row, one in enumerate(order[:MOST_LISTED], start=header + 1):
        is_linked = bool(one.cell) and one.sheet in reachable
        rows.append(_finding_row(row, one, looks, is_linked=is_linked))
        if is_linked:
            there = xml_text(f"{quoted(one.sheet)}!{one.cell}")
            links.append(b'<hyperlink ref="%s" location="%s" tooltip="Go to the cell"/>' % (_LINKED % row, there))
    last = header + max(1, min(len(order), MOST_LISTED))
    if not order:
        rows.append(_row(last, [cell_xml(f"A{last}", "Nothing was found.")]))
    elif len(order) > MOST_LISTED:
        more = f"{len(order) - MOST_LISTED:,} more findings are not listed. Fix these first."
        rows.append(_row(last + 1, [cell_xml(f"A{last + 1}", more)]))
    return _sheet(rows, links, header, last), header, last


_LINKED = column_letters(1 + [column.key for column in FINDINGS].index("cell")).encode() + b"%d"
"""Address of a finding's linked cell by its row."""


def _row(number: int, cells: Sequence[bytes], height: int = 0) -> bytes:
    size = b' ht="%d" customHeight="1"' % height if height else b""
    return b'<row r="%d"%s>%s</row>' % (number, size, b"".join(cells))


def _finding_row(row: int, found: Finding, looks: dict[str, str], *, is_linked: bool) -> bytes:
    """Return one finding as a row, its level coloured and its cell linked."""
    lines, cells = 1, []
    for place, (key, text) in enumerate(found.as_dictionary().items(), start=1):
        look = "link" if key == "cell" and is_linked else found.level if key == "level" else key
        cells.append(cell_xml(str(CellAddress(row, place)), plain(text) if text else None, "", looks[look]))
        lines = max(lines, -(-len(text) // (_WIDTHS[key] - 4)) if key in _WIDTHS and text else 1)
    return _row(row, cells, _LINE * lines + 4)


def _looks(styles: Stylesheet) -> dict[str, str]:
    """Return the cell format of each kind of cell."""
    fonts = {name: styles.add("fonts", font.encode()) for name, font in _FONTS.items()}
    borders = {name: styles.add("borders", border.encode()) for name, border in _BORDERS.items()}
    fills = {level: styles.add("fills", fill) for level, fill in FILLS.items()}

    def look(font: str, border: str = "none", alignment: str = "", fill: int = 0, number: int = 0) -> str:
        start = f'<@xf numFmtId="{number}" fontId="{fonts[font]}" fillId="{fill}" borderId="{borders[border]}"'
        use = f'{start} applyNumberFormat="1" applyFont="1" applyFill="1" applyBorder="1"'
        text = f'{use} applyAlignment="1">{alignment}</@xf>' if alignment else f"{use}/>"
        return str(styles.add("cellXfs", text.encode()))

    looks = {"title": look("title"), "text": look("text")}
    looks["head"] = look("head", "box", _CENTRE, styles.add("fills", _HEAD_FILL))
    for level in LEVELS:
        looks[level] = look("text", "line", _MIDDLE, fills.get(level, 0))
    for column in FINDINGS:
        alignment = _WRAP if column.key in _WIDTHS else _MIDDLE
        looks[column.key] = look("text", "line", alignment, 0, 49 if column.key in _AS_ENTERED else 0)
    return {**looks, "link": look("link", "line", _MIDDLE)}


def _sheet(rows: Sequence[bytes], links: Sequence[bytes], header: int, last: int) -> bytes:
    """Return a worksheet with its header frozen, set up to print one page wide."""
    columns = "".join(
        f'<col min="{place}" max="{place}" width="{_WIDTHS.get(column.key, 11)}" customWidth="1"/>'
        for place, column in enumerate(FINDINGS, start=1)
    )
    head = (
        f'<?xml version="1.0" encoding="UTF-8" standalone="yes"?><worksheet xmlns="{MAIN}"><sheetPr>'
        f'<tabColor rgb="{COLOURS["error"]}"/><pageSetUpPr fitToPage="1"/></sheetPr><sheetViews>'
        f'<sheetView showGridLines="0" tabSelected="1" workbookViewId="0"><pane ySplit="{header}" '
        f'topLeftCell="A{header + 1}" activePane="bottomLeft" state="frozen"/><selection pane="bottomLeft"/>'
        f"</sheetView></sheetViews><cols>{columns}</cols><sheetData>"
    )
    foot = (
        f'</sheetData><autoFilter ref="A{header}:{_LAST}{last}"/>',
        f"<hyperlinks>{b''.join(links).decode()}</hyperlinks>" if links else "",
        '<pageMargins left="0.75" right="0.75" top="1" bottom="1" header="0.5" footer="0.5"/>'
        '<pageSetup paperSize="9" fitToHeight="0" orientation="landscape"/>'
        "<headerFooter><oddFooter>&amp;L&amp;A&amp;C&amp;P / &amp;N</oddFooter></headerFooter></worksheet>",
    )
    return head.encode() + b"".join(rows) + "".join(foot).encode()
