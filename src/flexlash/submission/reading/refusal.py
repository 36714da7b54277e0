"""The one exception of reading: a file as a whole cannot be used."""

from __future__ import annotations

__all__ = ["Refusal"]


class Refusal(Exception):
    """The submission as a whole cannot be used: a finding code and what its message needs."""

    def __init__(self, code: str, **facts: object) -> None:
        super().__init__(code)
        self.code = code
        self.facts = facts
