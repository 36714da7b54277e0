"""The one exception of reading: a file as a whole cannot be used."""

from __future__ import annotations

from typing import Any

from flexlash.schema.exit_codes import ExitCode

__all__ = ["Refusal"]


class Refusal(Exception):
    """The submission as a whole cannot be used: a finding code and what its message needs."""

    exit_code = ExitCode.NOTHING

    def __init__(self, code: str, **facts: Any) -> None:
        super().__init__(code)
        self.code = code
        self.facts = facts

    def __reduce__(self) -> tuple[Any, ...]:
        return _refusal, (self.code, self.facts)


def _refusal(code: str, facts: dict[str, Any]) -> Refusal:
    """Return a refusal that came from another process."""
    return Refusal(code, **facts)
