"""What tolerance grade a text means, as drawings of all kinds write grades."""

from __future__ import annotations

import re
import unicodedata

from flexlash.schema.tolerance_grades import is_grade

__all__ = ["meant_grade"]

_GENERAL = re.compile(r"(?:DIN)?(?:EN)?(?:ISO)?2?2768-?(?:T1|1)?-?([FMCV])[HKL]?", re.IGNORECASE)
"""General tolerances as drawings name them; the second letter is for straightness and the like, not for lengths."""

_GRADE = re.compile(r"(IT|JS|H)-?0?(\d+)", re.IGNORECASE)


def meant_grade(text: str) -> str:
    """Return the grade that a text means, or an empty text.

    >>> meant_grade("it 7"), meant_grade("H 7"), meant_grade("ISO 2768-mK"), meant_grade("7"), meant_grade("g6")
    ('IT7', 'H7', '2768-m', 'IT7', '')
    """
    kept = "".join(unicodedata.normalize("NFKC", text).split())
    if general := _GENERAL.fullmatch(kept):
        return f"2768-{general[1].lower()}"
    kept = f"IT{kept}" if kept.isdecimal() else kept
    match = _GRADE.fullmatch(kept)
    if match is None:
        return ""
    letters = match[1] if match[1] in {"h", "H", "js"} else match[1].upper()
    grade = f"{letters}{match[2]}"
    return grade if is_grade(grade) else ""
