"""The optional check of a wind-up by two-dimensional elasticity: a half-section, a mesh, a finite-element solution."""

from __future__ import annotations

from importlib.util import find_spec

__all__ = ["MISSING", "is_available"]

MISSING = "The elasticity check needs scikit-fem and matplotlib: pip install 'flexlash[elasticity]'."


def is_available() -> bool:
    """Whether the libraries of the check are installed: scikit-fem to solve, matplotlib to draw."""
    return all(find_spec(name) is not None for name in ("skfem", "matplotlib"))
