"""The page as an application: its addresses, and who answers at each."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from importlib.resources import files

from starlette.applications import Starlette
from starlette.exceptions import HTTPException
from starlette.middleware import Middleware
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from flexlash.service.log import Log
from flexlash.service.store import Store
from flexlash.service.web.access import Access
from flexlash.service.web.forms import Forms
from flexlash.service.web.guard import Guard
from flexlash.service.web.health import Health
from flexlash.service.web.pages import Pages
from flexlash.service.web.refusals import Refused
from flexlash.service.web.signing import Signer, stored_key
from flexlash.service.web.site import Limits, Site, Works, page_templates
from flexlash.service.web.upload import field_of, form_of
from flexlash.service.web.visitors import OPENING, Visitors

__all__ = ["application"]

_KINDS = {".css": "text/css", ".js": "text/javascript", ".svg": "image/svg+xml", ".png": "image/png"}


def application(
    store: Store,
    works: Works,
    access: Access,
    options_digest: str,
    started_at: float,
    *,
    log: Log | None = None,
    limits: Limits | None = None,
    troubles: Callable[[], Sequence[str]] = tuple,
) -> Starlette:
    """Return the page over a store and whoever works on it; `troubles` are told by /health.

    Raises OSError where its key cannot be read or made.
    """
    signer = Signer(stored_key(store.folder))
    site = Site(
        store=store, works=works, access=access, signer=signer, options=options_digest, started_at=started_at,
        log=log or Log(), limits=limits or Limits(), troubles=troubles, templates=page_templates(),
    )  # fmt: skip
    visitors = Visitors(access, signer, store.folder)
    app = Starlette(
        routes=_routes(site, visitors),
        middleware=[Middleware(Guard, site, visitors)],
        exception_handlers={HTTPException: lambda request, fault: site.refusal(request, Refused.of(fault))},
    )
    app.router.redirect_slashes = False
    return app


def _routes(site: Site, visitors: Visitors) -> list[Route]:
    pages, forms, health = Pages(site), Forms(site), Health(site)
    one = "/submissions/{id}"
    small = site.limits.form

    async def login(request: Request) -> Response:
        form = await form_of(request, site.limits.fields)
        return visitors.entered(request, field_of(form, "access"), field_of(form, "wanted"))

    return [
        Route("/", pages.hand_in),
        Route("/submissions", forms.submissions, methods=["POST"], max_body_size=site.limits.body),
        Route(one, pages.submission),
        Route(one + "/variants/{number}", pages.variant),
        Route(one + "/files/{role}", pages.file),
        Route(one + "/difference", pages.difference),
        Route(one + "/retry", forms.retry, methods=["POST"], max_body_size=small),
        Route(one + "/forget", forms.forget, methods=["POST"], max_body_size=small),
        Route("/history", pages.history),
        Route("/rules", pages.rules),
        Route("/findings/{code}", pages.explained),
        Route("/template", pages.template),
        Route("/template/all", pages.whole_template),
        Route("/example", pages.example),
        Route("/help", pages.help),
        Route("/static/{name}", _static()),
        Route("/health", health.health),
        Route("/metrics", health.metrics),
        Route("/login", login, methods=["POST"], max_body_size=small),
        Route(OPENING + "{token}", visitors.opened, methods=["GET"]),
    ]


def _static() -> Callable[[Request], Response]:
    """Return what gives the package's own files away: read once, found by their names alone."""
    folder = files("flexlash.service.web").joinpath("static")
    kept = {file.name: file.read_bytes() for file in folder.iterdir() if file.name.endswith(tuple(_KINDS))}

    def static(request: Request) -> Response:
        name = request.path_params["name"]
        if name not in kept:
            raise Refused(404)
        return Response(kept[name], media_type=_KINDS["." + name.rpartition(".")[2]])

    return static
