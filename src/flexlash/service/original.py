"""What the store keeps of an original: all of it, or of one that is too large to be read its beginning, as a reason.

A file of gigabytes in INBOX would fill the disk of the store and hold up all others while it is copied.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from flexlash.outputs.writing import Filling
from flexlash.service.records import StoredSubmission

__all__ = ["KeptPart"]

_PIECE = 2**20


@dataclass(frozen=True, kw_only=True)
class KeptPart:
    """How much of an original is kept: `most` bytes are read of a submission, and one more says that there are more."""

    most: int

    def content(self, path: Path) -> Path | Filling:
        """Return what the store is given of an original; raise OSError."""
        return path if path.stat().st_size <= self.most else lambda copy: copy.writelines(self._pieces(path))

    def is_of(self, path: Path, submission: StoredSubmission) -> bool:
        """Whether an original still is what was kept of it; raise OSError where it cannot be read."""
        size = path.stat().st_size
        if min(size, self.most + 1) != submission.size:
            return False
        digest = hashlib.sha256()
        for piece in self._pieces(path):
            digest.update(piece)
        return digest.hexdigest() == submission.sha256

    def _pieces(self, path: Path) -> Iterator[bytes]:
        left = self.most + 1
        with path.open("rb") as file:
            while piece := file.read(min(_PIECE, left)):
                yield piece
                left -= len(piece)
