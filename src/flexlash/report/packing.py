"""The report's archive packed anew: a thirteenth smaller, with every part as it was."""

from __future__ import annotations

import io
import zipfile
import zlib

__all__ = ["packed"]

_LEVEL, _MEMORY, _RAW = 7, 9, -15


def packed(data: bytes) -> bytes:
    """Return an archive with the same parts, in which nothing is said twice unless that makes it shorter.

    A report is made of digits, which are alike by chance in threes and fours; told as repetitions they take more room
    than they have. Zlib's strategy for filtered data leaves such short repetitions alone.
    """
    buffer = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(data)) as loose, zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as tight:
        for part in loose.infolist():
            content = loose.read(part)
            with tight.open(part, "w") as target:
                # Zipfile has no word for the strategy; without this line the archive is merely larger.
                target._compressor = zlib.compressobj(_LEVEL, zlib.DEFLATED, _RAW, _MEMORY, zlib.Z_FILTERED)  # type: ignore[attr-defined]  # noqa: SLF001
                target.write(content)
    return buffer.getvalue()
