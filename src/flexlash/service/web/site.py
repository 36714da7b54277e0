"""What every page is made of: the store, whoever works, and the templates."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future
from dataclasses import dataclass, field
from typing import Any, Protocol

import jinja2
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.templating import Jinja2Templates

from flexlash import __version__
from flexlash.batch.answer import Answer
from flexlash.batch.executor import Work
from flexlash.schema.findings import readable
from flexlash.schema.number_words import grouped
from flexlash.service.log import Log
from flexlash.service.records import StoredFile, StoredSubmission, new_id
from flexlash.service.store import Store
from flexlash.service.web.access import Access
from flexlash.service.web.negotiation import wants_json
from flexlash.service.web.refusals import Refused
from flexlash.service.web.signing import Signer

__all__ = ["Limits", "Site", "Works", "page_templates"]

_MiB = 2**20


class Works(Protocol):
    """What the pages want of the dispatcher."""

    @property
    def workers(self) -> int:
        """How many workers there are."""

    @property
    def busy(self) -> int:
        """How many of them work."""

    @property
    def is_alive(self) -> bool:
        """Whether it takes what waits."""

    def wake(self) -> None:
        """Have it look for what waits."""

    def check(self, name: str, data: bytes) -> Future[Answer]:
        """Return what will be found in a submission, of which nothing is kept."""

    def compare(self, old: StoredFile, new: StoredFile) -> Future[bytes]:
        """Return what will be the differences of two reports, as JSON."""

    def ask(self, work: Work, data: bytes) -> Future[bytes]:
        """Return what a worker will answer."""


@dataclass(frozen=True, kw_only=True)
class Limits:
    """How much the page takes; `most_waiting` submissions and `waiting_bytes` may wait in all, `seconds` are of one."""

    body: int = 20 * _MiB + 64 * 1024
    form: int = 64 * 1024
    fields: int = 8
    most_waiting: int = 1_000
    waiting_bytes: int = 2_048 * _MiB
    free_bytes: int = 128 * _MiB
    requests: int = 64
    idle_seconds: float = 20.0
    body_seconds: float = 300.0
    answer_seconds: float = 120.0


@dataclass(frozen=True, kw_only=True)
class Site:
    """What the handlers share; `troubles` tells in words what keeps other doors from their work."""

    store: Store
    works: Works
    access: Access
    signer: Signer
    options: str
    started_at: float
    log: Log
    limits: Limits = field(default_factory=Limits)
    troubles: Callable[[], Sequence[str]] = tuple
    templates: Jinja2Templates

    def page(
        self,
        request: Request,
        name: str,
        context: Mapping[str, Any],
        *,
        status: int = 200,
        headers: Mapping[str, str] | None = None,
    ) -> Response:
        """Return a page; every template also has `version`, `path` and `token`, which forms send back."""
        shared = {"version": __version__, "path": readable(request.scope["path"]), "token": self.form_token(request)}
        return self.templates.TemplateResponse(
            request, f"{name}.html", {**shared, **context}, status_code=status, headers=headers
        )

    def form_token(self, request: Request) -> str:
        """Return a token for the forms of a page, which is of use to nobody but whom the page is for."""
        return self.signer.issue(_purpose(request))

    def form_value(self, request: Request, token: str) -> str | None:
        """Return the ID that the token of a form is, None where it is not one that was issued to this visitor.

        Who has said a token of access in a header of the request needs none: no foreign page can have that said.
        """
        if not token and request.scope["state"].get("bearer"):
            return new_id()
        return self.signer.value(_purpose(request), token)

    def refusal(self, request: Request, refused: Refused) -> Response:
        """Return why a request is refused, as a page or as JSON."""
        told = {"status": refused.status_code, "title": refused.title, "sentence": refused.sentence}
        if wants_json(request):
            return JSONResponse({"error": told}, refused.status_code, refused.headers)
        name = "login" if refused.asks_for_token else "refused"
        again = request.headers.get("sec-fetch-site") == "cross-site"
        asked = {"wanted": readable(request.scope["path"]), "again": again, "has_token": bool(self.access.token)}
        context = told | (asked if refused.asks_for_token else {})
        return self.page(request, name, context, status=refused.status_code, headers=refused.headers)

    def known(self, id_: str) -> StoredSubmission:
        """Return a submission by its ID; raise Refused where there is none, or none any more."""
        if found := self.store.submission(id_):
            return found
        if self.store.was_forgotten(id_):
            raise Refused(410)
        raise Refused(404)


def _purpose(request: Request) -> str:
    """Return what the token of a form is for: this visitor's forms."""
    state = request.scope["state"]
    return f"form {state.get('session', '')} {state.get('sender', '')}"


def page_templates() -> Jinja2Templates:
    """Return the templates, which escape everything and know no undefined name."""
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("flexlash.service.web"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["grouped"] = grouped
    return Jinja2Templates(env=environment)
