"""The template as a worker makes it: whoever gives it away loads nothing that writes workbooks."""

from __future__ import annotations

__all__ = ["template_file"]


def template_file(filling: bytes) -> bytes:
    """Return the template, empty, for `all` with the optional sheets, for `example` filled with the published study."""
    from flexlash.feedback.template.filling import Filling, study
    from flexlash.feedback.template.template_workbook import template_bytes
    from flexlash.schema.columns import OPTIONAL_SHEETS

    made = {b"all": lambda: Filling(optional=OPTIONAL_SHEETS), b"example": study}
    return template_bytes(made.get(filling, Filling)())
