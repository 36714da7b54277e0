"""What is done by a form: hand in, check, compute anew, forget, enter the token."""

from __future__ import annotations

import json
import threading
from collections.abc import Callable

from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import JSONResponse, RedirectResponse, Response

from flexlash.service.records import HandedIn
from flexlash.service.web import views
from flexlash.service.web.asking import answer_of
from flexlash.service.web.negotiation import wants_json
from flexlash.service.web.refusals import Refused
from flexlash.service.web.site import Site
from flexlash.service.web.told import submission_told
from flexlash.service.web.upload import Received, UnusableForm, field_of, form_of, received

__all__ = ["Forms"]


class Forms:
    """The handlers of POST."""

    def __init__(self, site: Site) -> None:
        self._site = site
        self._accepting = threading.Lock()

    async def submissions(self, request: Request) -> Response:
        """Take a submission in, or only check it; what is wrong with the form is said on the form."""
        try:
            async with received(request, self._site.limits.fields) as one:
                if one.action == "check":
                    return await self._checked(request, one)
                return await run_in_threadpool(self._handed_in, request, one)
        except UnusableForm as fault:
            if wants_json(request):
                raise
            return await run_in_threadpool(self._form_again, request, fault)

    def _form_again(self, request: Request, fault: UnusableForm) -> Response:
        context = views.hand_in(self._site.store, fault=fault.sentence)
        return self._site.page(request, "hand_in", context, status=fault.status_code)

    def _handed_in(self, request: Request, one: Received) -> Response:
        """Keep a submission under the ID that its form's token is, and lead to its page."""
        store = self._site.store
        id_ = self._require_token(request, one.token)
        with self._accepting:
            known = store.submission(id_)
            if known and (known.name != one.name or known.sha256 != one.sha256()):
                # A form that the browser still had, with another file chosen in it: not the same submission again.
                id_ = self._site.signer.derived(id_, one.name, one.sha256())
                known = store.submission(id_)
            if known is None:
                self._require_room()
                sender = request.scope["state"]["sender"]
                handed = HandedIn(id=id_, name=one.name, options=self._site.options, door="page", sender=sender)
                stored = store.accept(handed, one.write_into)
                again = {"answered_as": stored.same_as} if stored.same_as else {}
                self._site.log.say("received", id_, name=stored.name, **again)
        self._site.works.wake()
        found = known or self._site.known(id_)
        headers = {"Location": f"/submissions/{id_}"}
        if wants_json(request):
            return JSONResponse(submission_told(store, found), 200 if known else 201, headers)
        return RedirectResponse(headers["Location"], 303)

    def _require_room(self) -> None:
        """Refuse where too much waits already."""
        store, limits = self._site.store, self._site.limits
        if store.totals()["waiting"] >= limits.most_waiting or store.waiting_bytes() >= limits.waiting_bytes:
            raise Refused(503, "The queue is full: try again in a few minutes.", retry_after="120")

    async def _checked(self, request: Request, one: Received) -> Response:
        """Show what is found in a submission, of which nothing is kept."""
        self._require_token(request, one.token)
        data = await run_in_threadpool(one.content)
        answer = await answer_of(lambda: self._site.works.check(one.name, data), self._site.limits.answer_seconds)
        if not answer.page:
            raise Refused(500, "This file could not be checked: that is a fault of flexlash.")
        page = json.loads(answer.page)
        if wants_json(request):
            told = {**answer.told, "exit_code": int(answer.exit_code), "outputs": [], "words": answer.words}
            return JSONResponse({**told, "page": page})
        return await run_in_threadpool(self._site.page, request, "checked", views.checked(one.name, page))

    async def retry(self, request: Request) -> Response:
        """Have a submission computed anew."""
        return await self._changed(request, self._site.store.retry, "It has not finished yet: wait until it has.", "")

    async def forget(self, request: Request) -> Response:
        """Forget a submission."""
        return await self._changed(
            request, self._site.store.forget, "It has not finished, or its files are still being delivered.", "/history"
        )

    async def _changed(self, request: Request, change: Callable[[str], bool], not_yet: str, then: str) -> Response:
        """Change a submission, if the form is ours, and lead to an address, its own where none is given."""
        form = await form_of(request, self._site.limits.fields)
        self._require_token(request, field_of(form, "token"))
        id_ = request.path_params["id"]
        await run_in_threadpool(self._site.known, id_)
        if not await run_in_threadpool(change, id_):
            raise Refused(409, not_yet)
        self._site.works.wake()
        if wants_json(request):
            return JSONResponse({"id": id_})
        return RedirectResponse(then or f"/submissions/{id_}", 303)

    def _require_token(self, request: Request, token: str) -> str:
        """Return the ID that the token of a form of ours is; raise UnusableForm where it is none."""
        id_ = self._site.form_value(request, token)
        if id_ is None:
            raise UnusableForm(
                400, ("This form is more than a day old, or did not come from this page: open the page and try again.")
            )
        return id_
