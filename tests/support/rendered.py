"""Pages of the service as its templates render them, of submissions and facts that are made up."""

from __future__ import annotations

from typing import Literal, get_args, get_origin, get_type_hints, is_typeddict

from flexlash.service.records import StoredFile, StoredSubmission
from flexlash.service.web.site import page_templates

__all__ = ["COUNTS", "FILES", "NOW", "made", "render", "submission"]

NOW = 1_800_000_000.0
COUNTS = {"rows": 27, "computed": 24, "errors": 3, "warnings": 2, "meets": 1, "marginal": 1, "fails": 2}


def made(kind, text):
    """Return a value of a type of the facts: every text in it is the one given, every list has two of its kind."""
    if is_typeddict(kind):
        return {key: made(value, text) for key, value in get_type_hints(kind).items()}
    if get_origin(kind) is list:
        return [made(*get_args(kind), text)] * 2
    if get_origin(kind) is dict:
        return dict(COUNTS)
    if get_origin(kind) is Literal:
        return get_args(kind)[0]
    if get_args(kind):
        return made(get_args(kind)[0], text)
    return {str: text, int: 1, float: 1.5, bool: True}[kind]


def submission(**known):
    """Return a submission as the store has it."""
    usual = {"id": "a" * 32, "number": 7, "name": "cup.xlsx", "sha256": "9c1f" * 16, "size": 34_567, "options": "o",
             "door": "page", "sender": "", "received_at": NOW - 130, "state": "waiting"}  # fmt: skip
    return StoredSubmission(**usual | known)


def render(name, path="/", **context):
    """Return a page as the service renders it."""
    template = page_templates().env.get_template(f"{name}.html")
    return template.render(version="0.5.0", path=path, token=path, **context)


FILES = {role: StoredFile(role=role, sha256="a" * 64, size=9, name=f"x{ending}") for role, ending in {
    "report": ".xlsx", "results": ".csv", "findings": ".csv", "checked": ".xlsx", "mended": ".xlsx", "reasons": ".txt",
    "page": ".json"}.items()}  # fmt: skip
