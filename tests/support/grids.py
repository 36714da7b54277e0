"""Many like cases in one test: each runs, and the test names all that fail."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Iterable
from typing import Any

import pytest

__all__ = ["for_each"]


def for_each(names: str, cases: Iterable[Any]) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Run a test for each case, as `pytest.mark.parametrize` does, but as one item that lists the offenders.

    An item costs pytest some milliseconds, a case of a grid mostly less. Fixtures are made once for all cases, so that
    a test that writes a file or replaces a name stays with `parametrize`.
    """
    keys = [name.strip() for name in names.split(",")]
    rows = [dict(zip(keys, (case,) if len(keys) == 1 else case, strict=True)) for case in cases]

    def decorate(test: Callable[..., None]) -> Callable[..., None]:
        signature = inspect.signature(test)
        own = [parameter for name, parameter in signature.parameters.items() if name not in keys]

        @functools.wraps(test)
        def loop(**fixtures: Any) -> None:
            offenders = [told for row in rows if (told := _failure(test, row, fixtures))]
            assert rows, "there is no case"
            assert not offenders, f"{len(offenders)} of {len(rows)} cases fail\n" + "\n".join(offenders)

        loop.__signature__ = signature.replace(parameters=own)
        return loop

    return decorate


def _failure(test: Callable[..., None], row: dict[str, Any], fixtures: dict[str, Any]) -> str:
    try:
        test(**row, **fixtures)
    except (AssertionError, pytest.fail.Exception) as error:
        return f"{', '.join(f'{name}={case!r:.80}' for name, case in row.items())}: {error}"
    except Exception as error:
        error.add_note(f"in the case {row}")
        raise
    return ""
