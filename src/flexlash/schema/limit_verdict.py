"""Whether a variant meets its backlash limit: the one place that decides."""

from __future__ import annotations

from typing import Literal

__all__ = ["BOUNDS", "VERDICTS", "Verdict", "limit_verdict", "misses_limit"]

Verdict = Literal["meets", "marginal", "fails"]
VERDICTS: tuple[Verdict, ...] = ("meets", "marginal", "fails")

BOUNDS: dict[Verdict, float] = {"meets": 0.00135, "marginal": 0.025}
"""Greatest share of units over the limit that each verdict allows; `fails` allows any."""


def limit_verdict(over: float | None) -> Verdict | None:
    """Return the verdict on a variant by its share of units over the limit; None without a limit.

    >>> limit_verdict(0.00135), limit_verdict(0.025), limit_verdict(0.0251), limit_verdict(None)
    ('meets', 'marginal', 'fails', None)
    """
    if over is None:
        return None
    return next((verdict for verdict, most in BOUNDS.items() if over <= most), "fails")


def misses_limit(over: float | None) -> bool:
    """Return whether a variant has a limit and does not meet it, by its share of units over the limit."""
    return limit_verdict(over) not in {"meets", None}
