"""Pages of the service as its templates render them, of submissions and facts that are made up."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal, get_args, get_origin, get_type_hints, is_typeddict

from flexlash.report.page.shape import PageFacts
from flexlash.schema.columns import ENTRY_SHEETS
from flexlash.service.records import StoredFile, StoredSubmission
from flexlash.service.web import lists
from flexlash.service.web.site import page_templates
from flexlash.service.web.submission_page import checked_view, submission_view
from flexlash.service.web.variant_page import variant_view
from flexlash.service.web.words import Moment

__all__ = ["COUNTS", "FILES", "NOW", "made", "pages", "render", "submission"]

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
    return template.render(version="0.10.0", path=path, token=path, **context)


FILES = {role: StoredFile(role=role, sha256="a" * 64, size=9, name=f"x{ending}") for role, ending in {
    "report": ".xlsx", "results": ".csv", "findings": ".csv", "checked": ".xlsx", "fixed": ".xlsx", "reasons": ".txt",
    "page": ".json"}.items()}  # fmt: skip


def pages(text):
    """Return every page, with a text in each of its fields, by a name."""
    facts = made(PageFacts, text)
    done = submission(name=text, sender=text, state="done", words=text, reason=text, counts=COUNTS, ended_at=NOW)
    event = {"number": 1, "at": NOW, "kind": text, "submission": "", "text": text}
    rule = {"level": "error", "code": "E202", "sheet": text, "column": text, "cells": 3, "submissions": 2}
    at_work = {"began_at": NOW - 9, "rows": 100, "rows_done": 41, "counts": COUNTS}
    shown = {"working": at_work, "waiting": {"trouble": text}, "done": {}, "rejected": {"words": text, "reason": text}}
    made_pages = {
        "hand in": render("hand_in", view=lists.hand_in_view([done] * 3, NOW, waiting=2), fault=text),
        "history": render("history", "/history", view=lists.history_view(
            [done] * 51, NOW, text=text, state="done", before=9, totals={"done": 3})),
        "rules": render("rules", "/rules", view=lists.rules_view([rule])),
        "explained": render("explained", explanation=lists.explained("E202")),
        "help": render("help", "/help", sheets=ENTRY_SHEETS, codes=lists.codes_by_level()),
        "login": render("login", title=text, sentence=text, status=401, wanted=text, has_token=True, again=True),
        "refused": render("refused", title=text, sentence=text, status=410),
        "checked": render("checked", view=checked_view(text, facts)),
        "difference": render("difference", submission=done, previous=done, when=Moment.of(NOW, NOW),
                             told={"lines": [text] * 3, "refused": None}),
        "no comparison": render("difference", submission=done, previous=done, when=Moment.of(NOW, NOW),
                                told={"lines": [text], "refused": {"code": text, "message": text, "fix": text}}),
        "no difference": render("difference", submission=done, previous=None, when=None, told=None),
        "variant": render("variant", view=variant_view(done, facts, 1)),
        "empty": render("submission", view=submission_view(submission(), NOW)),
    }  # fmt: skip
    for state, known in shown.items():
        one = replace(done, state=state, **known)
        view = submission_view(one, NOW, facts=facts, files=FILES, first=done, previous=done, events=[event], waiting=3)
        made_pages[state] = render("submission", view=view)
    return made_pages
