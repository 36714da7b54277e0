"""What a form brings: one file and a few fields, spooled as they come."""

from __future__ import annotations

import hashlib
import unicodedata
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass
from typing import BinaryIO

from starlette.datastructures import FormData, UploadFile
from starlette.exceptions import HTTPException
from starlette.requests import Request

from flexlash.schema.findings import shown
from flexlash.service.web.refusals import Refused

__all__ = ["Received", "UnusableForm", "field_of", "form_of", "printed_name", "received"]

_LONGEST_NAME = 200
_LONGEST_FIELD = 4_096
_PIECE = 2**20


class UnusableForm(Refused):
    """The form was filled in in a way that nothing can be made of; the sentence belongs on the form."""


@dataclass(frozen=True, kw_only=True)
class Received:
    """A file that came in by the form, as it lies in memory or, from 1 MiB, on the disk."""

    name: str
    token: str
    action: str
    file: BinaryIO

    def write_into(self, target: BinaryIO) -> None:
        """Write the content of the file into another, piece by piece."""
        self.file.seek(0)
        while piece := self.file.read(_PIECE):
            target.write(piece)

    def content(self) -> bytes:
        """Return the content of the file."""
        self.file.seek(0)
        return self.file.read()

    def sha256(self) -> str:
        """Return the digest of the content."""
        digest = hashlib.sha256()
        self.file.seek(0)
        while piece := self.file.read(_PIECE):
            digest.update(piece)
        return digest.hexdigest()


@asynccontextmanager
async def received(request: Request, fields: int) -> AsyncIterator[Received]:
    """Yield what the form brings; raise Refused or UnusableForm where it is not one file and a few fields."""
    if not request.headers.get("content-type", "").lower().startswith("multipart/form-data"):
        raise Refused(415)
    try:
        yield _only_file(await form_of(request, fields, files=2))
    finally:
        await request.close()


async def form_of(request: Request, fields: int, files: int = 0) -> FormData:
    """Return a form of at most so many fields and files; raise UnusableForm where it cannot be read."""
    try:
        return await request.form(max_files=files, max_fields=fields, max_part_size=_LONGEST_FIELD)
    except (HTTPException, ValueError) as fault:
        if isinstance(fault, HTTPException) and fault.status_code != 400:  # noqa: PLR2004
            raise
        if "Too many files" in str(fault):
            raise UnusableForm(400, "Choose one file at a time: several arrived.") from None
        raise UnusableForm(400, "The form did not arrive as the page sends it: choose the file again.") from None


def _only_file(form: FormData) -> Received:
    """Return the one file of a form; a browser sends a nameless one where none was chosen."""
    files = [value for _, value in form.multi_items() if isinstance(value, UploadFile) and value.filename]
    if not files:
        raise UnusableForm(400, "Choose a file first: none arrived.")
    if len(files) > 1:
        raise UnusableForm(400, "Choose one file at a time: several arrived.")
    if (action := field_of(form, "action") or "run") not in {"run", "check"}:
        raise UnusableForm(400, "Use one of the two buttons of the form.")
    return Received(
        name=printed_name(files[0].filename or ""),
        token=field_of(form, "token"),
        action=action,
        file=files[0].file,
    )


def field_of(form: FormData, name: str) -> str:
    """Return a field of a form, empty where it is absent or a file."""
    value = form.get(name)
    return value if isinstance(value, str) else ""


def printed_name(name: str) -> str:
    r"""Return a file's name as it may be printed: without its folder, in one normal form, 200 characters at most.

    >>> printed_name("C:\\parts\\a.xlsx"), printed_name("a\u202eb\n.xlsx"), printed_name("../..")
    ('a.xlsx', 'a·b·.xlsx', 'submission')
    """
    base = name.replace("\\", "/").rpartition("/")[2]
    text = shown(unicodedata.normalize("NFC", base), _LONGEST_NAME).strip()
    return text if text.strip(". ") else "submission"
