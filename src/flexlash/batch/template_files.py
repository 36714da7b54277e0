"""The template as a worker makes it: whoever gives it away loads nothing that writes workbooks."""

from __future__ import annotations

__all__ = ["template_file"]


def template_file(filling: bytes) -> bytes:
    """Return the template, empty, or for `example` filled with the published study."""
    from flexlash.feedback.template.template_workbook import study, template_bytes

    return template_bytes(study() if filling == b"example" else None)
