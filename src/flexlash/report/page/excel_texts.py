"""Numbers as texts in the report's own number formats, for a page that has no Excel to show them."""

from __future__ import annotations

from flexlash.report.layout.styles import number_code

__all__ = ["number_text"]


def number_text(value: float, number: str) -> str:
    """Return a number as Excel shows it in a number format of the report, given by name or in Excel's letters.

    >>> number_text(0.0123, "share"), number_text(12345.678, "stiffness"), number_text(0.00125, "rad")
    ('1.23%', '12,345.7', '1.2500E-03')
    >>> number_text(50.72, "#,##0.0##"), number_text(3.0, "#,##0.0##"), number_text(5, "count")
    ('50.72', '3.0', '5')
    >>> number_text(-16.72, "+0.0;-0.0;0.0"), number_text(0.0, "+0.0;-0.0;0.0")
    ('-16.7', '0.0')
    """
    code = number_code(number)
    positive, *others = code.split(";")
    if others:
        chosen = [positive, *others, positive][0 if value > 0 else 1 if value < 0 else 2]
        sign = chosen[:1] if chosen[:1] in {"+", "-"} else ""
        return f"{sign}{number_text(abs(value), chosen.removeprefix(sign))}"
    if code == "General":
        return f"{value:.10g}"
    body, percent = code.removesuffix("%"), "%" if code.endswith("%") else ""
    mantissa, power, _ = body.partition("E+")
    decimals = mantissa.partition(".")[2]
    shown = f"{100 * value if percent else value:{',' if ',' in body else ''}.{len(decimals)}{'E' if power else 'f'}}"
    for _ in range(decimals.count("#")):
        shown = shown.removesuffix("0")
    return f"{shown}{percent}"
