"""What is asked for by an address: pages, or the same as JSON, files to take away, and how flexlash fares."""

from __future__ import annotations

import json
import re

from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import JSONResponse, Response

from flexlash.service.records import STATES, StoredFile, StoredSubmission
from flexlash.service.web import views
from flexlash.service.web.asking import answer_of
from flexlash.service.web.downloads import attachment, download
from flexlash.service.web.negotiation import wants_json
from flexlash.service.web.refusals import Refused
from flexlash.service.web.site import Site
from flexlash.service.web.told import history_told, submission_told

__all__ = ["Pages"]

_NUMBER = re.compile(r"[0-9]{1,9}")
_LONGEST_TEXT = 100
_REMEMBERED = 32


class Pages:
    """The handlers of GET."""

    def __init__(self, site: Site) -> None:
        self._site = site
        self._compared: dict[tuple[str, str], bytes] = {}
        self._made: dict[bytes, bytes] = {}

    def hand_in(self, request: Request) -> Response:
        """Show the form; as JSON give the token that it holds."""
        if wants_json(request):
            return JSONResponse({"token": self._site.form_token(request), "most_bytes": self._site.limits.body})
        return self._site.page(request, "hand_in", views.hand_in(self._site.store))

    def submission(self, request: Request) -> Response:
        """Show how far a submission is, or what came of it."""
        one = self._site.known(request.path_params["id"])
        if wants_json(request):
            return JSONResponse(submission_told(self._site.store, one))
        return self._site.page(request, "submission", views.submission(self._site.store, one))

    def variant(self, request: Request) -> Response:
        """Show one variant of a submission."""
        one = self._site.known(request.path_params["id"])
        number = _number(request.path_params["number"])
        context = None if number is None else views.variant(self._site.store, one, number)
        if context is None:
            raise Refused(404, "This submission has no such variant.")
        return self._site.page(request, "variant", context)

    def file(self, request: Request) -> Response:
        """Give a file of a submission's result away."""
        one = self._site.known(request.path_params["id"])
        file = self._site.store.files(one.id).get(request.path_params["role"])
        if file is None:
            raise Refused(404, "This submission has no such file.")
        return download(self._site.store.blobs, file)

    async def difference(self, request: Request) -> Response:
        """Show what changed against the previous submission of the same name."""
        one = await run_in_threadpool(self._site.known, request.path_params["id"])
        previous, pair = await run_in_threadpool(self._reports, one)
        told = json.loads(await self._difference(*pair)) if pair else None
        if wants_json(request):
            return JSONResponse({"id": one.id, "previous": previous and previous.id, "difference": told})
        context = views.difference(one, previous, told)
        return await run_in_threadpool(self._site.page, request, "difference", context)

    def _reports(self, one: StoredSubmission) -> tuple[StoredSubmission | None, tuple[StoredFile, StoredFile] | None]:
        """Return the previous submission of the same name, and both reports where there are such."""
        store = self._site.store
        previous = store.previous(one)
        old = store.files(previous.id).get("report") if previous else None
        new = store.files(one.id).get("report")
        return previous, (old, new) if old and new else None

    async def _difference(self, old: StoredFile, new: StoredFile) -> bytes:
        """Return the differences of two reports as a worker tells them, once for each pair."""
        pair = (old.sha256, new.sha256)
        if pair not in self._compared:
            told = await answer_of(lambda: self._site.works.compare(old, new), self._site.limits.answer_seconds)
            while len(self._compared) >= _REMEMBERED:
                self._compared.pop(next(iter(self._compared)))
            self._compared[pair] = told
        return self._compared[pair]

    def history(self, request: Request) -> Response:
        """Show what was handed in, the latest first."""
        asked = request.query_params
        text, state = asked.get("text", "")[:_LONGEST_TEXT], asked.get("state", "")
        before = _number(asked.get("before", ""))
        state = state if state in STATES else ""
        if wants_json(request):
            return JSONResponse(history_told(self._site.store.history(text=text, state=state, before=before)))
        return self._site.page(
            request, "history", views.history(self._site.store, text=text, state=state, before=before)
        )

    def rules(self, request: Request) -> Response:
        """Show which rules are broken most."""
        if wants_json(request):
            return JSONResponse({"rules": [dict(one) for one in self._site.store.failing_most()]})
        return self._site.page(request, "rules", views.rules(self._site.store))

    def explained(self, request: Request) -> Response:
        """Show what a finding means."""
        context = views.explained(request.path_params["code"])
        if context is None:
            raise Refused(404, "There is no finding with this code.")
        return self._site.page(request, "explained", context)

    def help(self, request: Request) -> Response:
        """Show how the template is filled in."""
        return self._site.page(request, "help", views.how_to_fill())

    async def template(self, _: Request) -> Response:
        """Give the empty template away."""
        return attachment(await self._template(b""), "flexlash-template.xlsx")

    async def whole_template(self, _: Request) -> Response:
        """Give the empty template away with its optional sheets."""
        return attachment(await self._template(b"all"), "flexlash-template-all-sheets.xlsx")

    async def example(self, _: Request) -> Response:
        """Give the template away, filled with the published study."""
        return attachment(await self._template(b"example"), "flexlash-example.xlsx")

    async def _template(self, filling: bytes) -> bytes:
        """Return the template as a worker makes it, once."""
        if filling not in self._made:
            from flexlash.batch.template_files import template_file

            self._made[filling] = await answer_of(
                lambda: self._site.works.ask(template_file, filling), self._site.limits.answer_seconds
            )
        return self._made[filling]


def _number(text: str) -> int | None:
    return int(text) if _NUMBER.fullmatch(text) else None
