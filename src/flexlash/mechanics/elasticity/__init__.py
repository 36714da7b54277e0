"""The optional check of a wind-up by two-dimensional elasticity: a half-section, a mesh, a finite-element solution."""

from __future__ import annotations

from importlib.util import find_spec

from flexlash.schema.exit_codes import ExitCode

__all__ = ["MISSING", "MissingLibrariesError", "is_available", "require_libraries"]

MISSING = "The elasticity check needs scikit-fem and matplotlib: pip install 'flexlash[elasticity]'."


def is_available() -> bool:
    """Whether the libraries of the check are installed: scikit-fem to solve, matplotlib to draw."""
    return all(find_spec(name) is not None for name in ("skfem", "matplotlib"))


class MissingLibrariesError(ModuleNotFoundError):
    """The libraries of the check are not installed."""

    exit_code = ExitCode.USAGE

    def __init__(self) -> None:
        super().__init__(MISSING)


def require_libraries() -> None:
    """Raise MissingLibrariesError where the libraries of the check are not installed."""
    if not is_available():
        raise MissingLibrariesError
