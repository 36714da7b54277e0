"""A workbook's parts, and what it is to say of itself → the parts with that document property."""

from __future__ import annotations

import re

from flexlash.feedback.fixing.splices import before_end, xml_text
from flexlash.reading.elements import Listing
from flexlash.reading.reading_limits import ReadingLimits

__all__ = ["with_property"]

_PART = "docProps/custom.xml"
_TYPES, _RELATIONS = "[Content_Types].xml", "_rels/.rels"
_OFFICE = b"http://schemas.openxmlformats.org/officeDocument/2006"
_TYPE = b"application/vnd.openxmlformats-officedocument.custom-properties+xml"
_FORMAT = b"{D5CDD505-2E9C-101B-9397-08002B2CF9AE}"
_EMPTY = (
    b'<?xml version="1.0" encoding="UTF-8" standalone="yes"?>'
    b'<Properties xmlns="%s/custom-properties"></Properties>' % _OFFICE
)


def with_property(parts: dict[str, bytes], name: str, value: str, limits: ReadingLimits) -> dict[str, bytes]:
    """Return the parts with a document property, the earlier one of this name replaced.

    Properties of unusual writing stay as they are.
    """
    part = parts.get(_PART, _EMPTY)
    element = rb"<((?:[\w.-]+:)?)property\b[^<>]*\bname\s*=\s*([\"'])%s\2[^<>]*>.*?</\1property\s*>" % name.encode()
    part = re.sub(element, b"", part, flags=re.DOTALL)
    numbers = [int(one.get("pid", "1")) for one in Listing(part, limits, "property").found]
    new = b'<@property fmtid="%s" pid="%d" name="%s"><vt:lpwstr xmlns:vt="%s/docPropsVTypes">%s</vt:lpwstr></@property>'
    try:
        added = {
            _PART: before_end(
                part,
                "Properties",
                new % (_FORMAT, max(numbers, default=1) + 1, name.encode(), _OFFICE, xml_text(value)),
            )
        }
        return parts | added | ({} if _PART in parts else _announced(parts, limits))
    except ValueError:
        return parts


def _announced(parts: dict[str, bytes], limits: ReadingLimits) -> dict[str, bytes]:
    """Return the lists of a workbook that name a new part; raise ValueError where they cannot be extended."""
    known = {one.get("Id", "") for one in Listing(parts[_RELATIONS], limits, "Relationship").found}
    relation = next(name for number in range(1, len(known) + 2) if (name := f"rIdOwn{number}") not in known)
    return {
        _TYPES: before_end(
            parts[_TYPES], "Types", b'<@Override PartName="/%s" ContentType="%s"/>' % (_PART.encode(), _TYPE)
        ),
        _RELATIONS: before_end(
            parts[_RELATIONS],
            "Relationships",
            b'<@Relationship Id="%s" Type="%s/relationships/custom-properties" Target="%s"/>'
            % (relation.encode(), _OFFICE, _PART.encode()),
        ),
    }
