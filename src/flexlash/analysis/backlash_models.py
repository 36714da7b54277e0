"""The backlash as a function of the dimensions alone, for each type of flexspline."""

from __future__ import annotations

from functools import partial

from flexlash.mechanics.flexspline import backlash

__all__ = ["BACKLASH_OF"]

BACKLASH_OF = {kind: partial(backlash, kind) for kind in ("cup", "hat", "cylinder")}
"""One model for each type, the same object each time, since rows are alike whose model is."""
