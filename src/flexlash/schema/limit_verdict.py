"""Whether a variant meets its backlash limit: the one place that decides."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

__all__ = ["MARGINAL", "VERDICTS", "Verdict", "VerdictBounds"]

Verdict = Literal["meets", "marginal", "fails"]
VERDICTS: tuple[Verdict, ...] = ("meets", "marginal", "fails")

MARGINAL = 0.025
"""Greatest share of units over the limit of a variant that is marginal, whatever its target."""

_DIGITS = 12
"""Decimals of a share: (100 − 99.865)/100 is not quite 0.00135."""


@dataclass(frozen=True, kw_only=True)
class VerdictBounds:
    """Greatest share of units over the limit that verdicts allow; `fails` allows any.

    Where a variant meets its limit with as many units over it as a marginal one may have, none is marginal.

    >>> bounds = VerdictBounds.of(99.865)
    >>> bounds.verdict(0.00135), bounds.verdict(0.025), bounds.verdict(0.0251), bounds.verdict(None)
    ('meets', 'marginal', 'fails', None)
    >>> VerdictBounds.of(97.5).verdict(0.025), VerdictBounds.of(99.99).verdict(0.00135)
    ('meets', 'marginal')
    """

    meets: float = 0.00135
    marginal: float = MARGINAL

    def __post_init__(self) -> None:
        if not 0 < self.meets <= self.marginal < 1:
            raise ValueError(f"meets = {self.meets} must be above 0 and at most marginal = {self.marginal}")

    @classmethod
    def of(cls, target_percent: float) -> VerdictBounds:
        """Return the bounds for so many per cent of units that shall be within the limit.

        Raises ValueError for a target below 97.5 %, of which no variant is marginal, or of 100 %.
        """
        return cls(meets=round((100 - target_percent) / 100, _DIGITS))

    @property
    def shares(self) -> tuple[float, ...]:
        """The shares over the limit beyond which the verdict is another one, the least first."""
        return tuple(dict.fromkeys((self.meets, self.marginal)))

    @property
    def any_marginal(self) -> bool:
        """Whether a variant can be marginal."""
        return self.meets < self.marginal

    @property
    def target_words(self) -> str:
        """The share of units within the limit with which a variant meets it.

        >>> VerdictBounds().target_words, VerdictBounds.of(99.9999).target_words
        ('99.865 %', '99.9999 %')
        """
        return f"{100 - 100 * self.meets:.10g} %"

    def verdict(self, over: float | None) -> Verdict | None:
        """Return the verdict on a variant by its share of units over the limit; None without a limit."""
        if over is None:
            return None
        return "meets" if over <= self.meets else "marginal" if over <= self.marginal else "fails"

    def misses(self, over: float | None) -> bool:
        """Return whether a variant has a limit and does not meet it, by its share of units over the limit."""
        return self.verdict(over) not in {"meets", None}

    def straddled(self, low: float | None, high: float | None) -> list[float]:
        """Return the shares at which the verdict changes that an interval of a share has on both sides."""
        return [] if low is None or high is None else [share for share in self.shares if low <= share < high]
