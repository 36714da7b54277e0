"""A text's bytes → its characters: Unicode of every kind that Excel and its neighbours write, else Windows-1252."""

from __future__ import annotations

import codecs
import re

from flexlash.reading.refusal import Refusal

__all__ = ["CONTROL", "MARKS", "WINDOWS", "decoded", "unmarked_utf_16"]

WINDOWS = "Windows-1252"
"""The encoding that is taken when a text is no Unicode; only its reader can tell whether that was right."""

MARKS = (
    (codecs.BOM_UTF8, "utf-8-sig", "UTF-8"),
    (codecs.BOM_UTF32_LE, "utf-32", "UTF-32"),
    (codecs.BOM_UTF32_BE, "utf-32", "UTF-32"),
    (codecs.BOM_UTF16_LE, "utf-16", "UTF-16"),
    (codecs.BOM_UTF16_BE, "utf-16", "UTF-16"),
)
CONTROL = re.compile(r"[\x00-\x08\x0e-\x19\x1b-\x1f]")
"""Control characters that no program writes into a table; 1A ended the files of DOS."""

_SAMPLE = 4096
_MOST = 0.5
"""Share of zeros in the upper halves from which on a text is UTF-16: the letters of most tables are ASCII."""


def decoded(data: bytes) -> tuple[str, str]:
    """Return a text and the name of its encoding; raise Refusal when it has none that is known."""
    marked = ((codec, name) for mark, codec, name in MARKS if data.startswith(mark))
    codec, encoding = next(marked, (unmarked_utf_16(data) or "utf-8", "UTF-16" if unmarked_utf_16(data) else "UTF-8"))
    try:
        text = data.decode(codec)
    except UnicodeDecodeError as fault:
        if codec != "utf-8":
            raise Refusal("E107") from fault
        text, encoding = _as_windows(data), WINDOWS
    if "\0" in text:
        raise Refusal("E102")
    return text, encoding


def unmarked_utf_16(data: bytes) -> str:
    """Return the codec of a text in UTF-16 without its mark, by the zeros beside its ASCII letters; else nothing."""
    sample = data[:_SAMPLE]
    first, second = sample[::2], sample[1::2]
    if len(data) % 2 or b"\0\0" in (first[:1] + second[:1], sample[-2:]):
        return ""
    if second.count(0) > _MOST * len(second) and 0 not in first:
        return "utf-16-le"
    return "utf-16-be" if first.count(0) > _MOST * len(first) and 0 not in second else ""


def _as_windows(data: bytes) -> str:
    """Return a text in the encoding of Excel's plain CSV, when every byte has a meaning there."""
    try:
        text = data.decode("cp1252")
    except UnicodeDecodeError as fault:
        raise Refusal("E107") from fault
    if CONTROL.search(text):
        raise Refusal("E107")
    return text
