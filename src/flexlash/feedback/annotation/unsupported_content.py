"""What of a workbook openpyxl cannot carry over into its copy, in plain words."""

from __future__ import annotations

import io
import re
import zipfile
from collections import Counter
from typing import Any

__all__ = ["losses"]

_PARTS = {
    "macros": r"xl/vbaproject\.bin",
    "form controls": r"xl/ctrlprops/[^/]+",
    "ActiveX controls": r"xl/activex/[^/]+\.xml",
    "embedded objects": r"xl/embeddings/[^/]+",
    "charts of newer kinds": r"xl/charts/chartex[^/]+",
    "diagrams": r"xl/diagrams/data[^/]+",
    "slicers": r"xl/slicers/[^/]+",
    "timelines": r"xl/timelines/[^/]+",
    "data connections": r"xl/(connections\.xml|querytables/[^/]+)",
    "data model": r"xl/model/[^/]+",
    "custom XML data": r"customxml/item\d+\.xml",
    "dynamic arrays or linked data types": r"xl/metadata\.xml",
    "digital signatures": r"_xmlsignatures/[^/]+\.xml",
    "ribbon of its own": r"customui/[^/]+\.xml",
    "charts": r"xl/charts/chart\d+\.xml",
    "pivot tables": r"xl/pivottables/[^/]+\.xml",
    "external links": r"xl/externallinks/[^/]+\.xml",
}
"""Content that is known by the names of its parts; the last three are carried over where openpyxl reads them."""

_ELEMENTS = {
    r"xl/worksheets/[^/]+\.xml": {
        "sparklines": "x14:sparkline",
        "validations of newer kinds": "x14:dataValidation",
        "conditional formats of newer kinds": "x14:cfRule",
        "pictures in headers or footers": "legacyDrawingHF",
        "background pictures": "picture",
        "custom views": "customSheetView",
    },
    r"xl/drawings/[^/]+\.xml": {
        "pictures": "xdr:pic",
        "text boxes and shapes": "xdr:sp",
        "connecting lines": "xdr:cxnSp",
    },
    r"xl/threadedcomments/[^/]+\.xml": {"threaded comments, their text kept as notes": "threadedComment"},
    r"xl/sharedstrings\.xml": {"phonetic guides": "rPh"},
}
"""Content that is known by elements, by the names of the parts that hold them."""

_FALLBACK = re.compile(rb"<mc:Fallback.*?</mc:Fallback>", re.DOTALL)
_OLD_CONTROL = re.compile(rb'ObjectType="(?!Note)')
_UNCOUNTED = {"macros", "data model", "custom XML data"}


def losses(data: bytes, workbook: Any) -> tuple[str, ...]:
    """Return what a workbook's bytes hold and the workbook as loaded does not, with counts: `sparklines (3)`."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        found = _found(archive)
    sheets = [*workbook.worksheets, *workbook.chartsheets]
    kept = {
        "charts": sum(len(sheet._charts) for sheet in sheets),  # noqa: SLF001
        "pictures": sum(len(sheet._images) for sheet in workbook.worksheets),  # noqa: SLF001
        "pivot tables": sum(len(sheet._pivots) for sheet in workbook.worksheets),  # noqa: SLF001
        "external links": len(workbook._external_links),  # noqa: SLF001
    }
    remade = min(kept["charts"], found["charts"])
    found.subtract(kept)
    found["fine formatting of charts"] = remade
    return tuple(what if what in _UNCOUNTED else f"{what} ({count})" for what, count in found.items() if count > 0)


def _found(archive: zipfile.ZipFile) -> Counter[str]:
    """Return how much an archive holds of each kind of content."""
    counts: Counter[str] = Counter()
    controls = 0
    for part in archive.namelist():
        name = part.lower()
        counts.update(what for what, pattern in _PARTS.items() if re.fullmatch(pattern, name))
        for pattern, elements in _ELEMENTS.items():
            if re.fullmatch(pattern, name):
                # A fallback is shown only by programs that do not know the content it stands for.
                content = _FALLBACK.sub(b"", archive.read(part))
                counts.update({what: _elements(content, tag) for what, tag in elements.items()})
        if re.fullmatch(r"xl/drawings/[^/]+\.vml", name):
            controls += len(_OLD_CONTROL.findall(archive.read(part)))
    counts["text boxes and shapes"] -= counts["form controls"]
    counts["form controls"] = max(counts["form controls"], controls)
    return counts


def _elements(content: bytes, tag: str) -> int:
    """Return how often an element occurs."""
    return sum(content.count(f"<{tag}{end}".encode()) for end in " />")
