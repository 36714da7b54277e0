"""What every answer of the page says to the browser: also a refusal, a fault, a static file."""

from __future__ import annotations

from importlib.resources import files

__all__ = ["HEADERS"]

_SCRIPT = files("flexlash.service.web").joinpath("static", "flexlash.js")

_POLICY = (
    "default-src 'none'",
    *(("script-src 'self'", "connect-src 'self'") if _SCRIPT.is_file() else ()),
    "style-src 'self'",
    "img-src 'self' data:",
    "form-action 'self'",
    "frame-ancestors 'none'",
    "base-uri 'none'",
)

HEADERS = {
    "content-security-policy": "; ".join(_POLICY),
    "x-content-type-options": "nosniff",
    "x-frame-options": "DENY",
    "cache-control": "no-store",
    "referrer-policy": "no-referrer",
    "cross-origin-resource-policy": "same-origin",
    "cross-origin-opener-policy": "same-origin",
}
