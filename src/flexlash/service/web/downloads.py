"""Files that people take away: attachments under names of our own, read from the blob piece by piece."""

from __future__ import annotations

import unicodedata
from pathlib import PurePosixPath
from urllib.parse import quote

from starlette.responses import FileResponse, Response

from flexlash.service.blobs import Blobs
from flexlash.service.records import StoredFile
from flexlash.service.web.refusals import Refused

__all__ = ["attachment", "download", "safe_name"]

_LONGEST, _LAST = 120, 12
"""Signs of a name, and how many of its last ones are kept: they say whether it is the report or the marked copy."""

_SIGNS = frozenset("-_.()")
_KINDS = {
    ".xlsx": "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet",
    ".xlsm": "application/vnd.ms-excel.sheet.macroEnabled.12",
    ".csv": "text/csv; charset=utf-8",
    ".txt": "text/plain; charset=utf-8",
    ".json": "application/json",
    ".parquet": "application/vnd.apache.parquet",
}


def safe_name(name: str) -> str:
    r"""Return a file's name of letters, digits and -_.() alone, whatever it was; its ending stays.

    >>> safe_name("../a b\r\n.xlsx"), safe_name("Prüfling 3 (neu).xlsx"), safe_name("…")
    ('a_b__.xlsx', 'Prüfling_3_(neu).xlsx', 'flexlash')
    """
    base = unicodedata.normalize("NFC", name).replace("\\", "/").rpartition("/")[2]
    kept = "".join(sign if sign.isalnum() or sign in _SIGNS else "_" for sign in base).lstrip(".")
    ending = PurePosixPath(kept).suffix[:10]
    stem = kept[: len(kept) - len(PurePosixPath(kept).suffix)]
    if len(stem) > _LONGEST - len(ending):
        stem = f"{stem[: _LONGEST - len(ending) - _LAST]}{stem[-_LAST:]}"
    return f"{stem}{ending}" if stem.strip("_.") else f"flexlash{ending}"


def _headers(name: str) -> dict[str, str]:
    """Return the headers of an attachment; old programs get a name of ASCII."""
    safe = safe_name(name)
    plain = "".join(sign if sign.isascii() else "_" for sign in safe)
    return {"content-disposition": f"attachment; filename=\"{plain}\"; filename*=UTF-8''{quote(safe, safe='-_.()')}"}


def _kind(name: str) -> str:
    return _KINDS.get(PurePosixPath(name.lower()).suffix, "application/octet-stream")


def attachment(data: bytes, name: str) -> Response:
    """Return bytes as a file to take away."""
    return Response(data, headers=_headers(name), media_type=_kind(name))


def download(blobs: Blobs, file: StoredFile) -> Response:
    """Return a kept file as one to take away; raise Refused where its bytes are not there, or others."""
    try:
        path = blobs.checked(file.sha256)
        status = path.stat()
    except OSError:
        raise Refused(
            503, "The file is listed, but its bytes cannot be read: tell the person who runs flexlash."
        ) from None
    headers = {**_headers(file.name), "etag": f'"{file.sha256}"'}
    return FileResponse(path, headers=headers, media_type=_kind(file.name), stat_result=status)
