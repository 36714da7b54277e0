"""A file that is written beside the report where it is asked for; loads nothing heavy."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

__all__ = ["ExportKind", "ExportedFile"]

ExportKind = Literal["samples", "pictures"]


@dataclass(frozen=True, kw_only=True)
class ExportedFile:
    """A file of samples or a picture: what follows its submission's name in its own, its bytes, its stamp's role."""

    kind: ExportKind
    name: str
    data: bytes
    role: str
