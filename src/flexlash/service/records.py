"""What the store has of a submission: plain values, which the page, the drop folder and the terminal show alike."""

from __future__ import annotations

import secrets
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal, get_args

__all__ = [
    "STATES",
    "Delivery",
    "Door",
    "Ending",
    "FileRole",
    "HandedIn",
    "RuleCount",
    "State",
    "StoredFile",
    "StoredSubmission",
    "new_id",
]

State = Literal["waiting", "working", "done", "rejected"]
STATES: tuple[State, ...] = get_args(State)

Door = Literal["page", "folder"]
"""How a submission came in."""

FileRole = Literal["report", "results", "findings", "checked", "fixed", "reasons", "outcome", "page"]
"""What a file of a result is.

`report`, `results` (.csv or .parquet), `findings` (.csv, of a large table), `checked` (the marked copy), `fixed` and
`reasons` (a plain text) go to people; `outcome` is the object that `--json` prints, `page` what the page shows, both
JSON.
"""


def new_id() -> str:
    """Return 128 random bits as a submission's ID, never made of its name."""
    return secrets.token_hex(16)


@dataclass(frozen=True, kw_only=True)
class HandedIn:
    """A submission as it comes in.

    `name` is that of the file as it may be printed, `options` the digest of all on which outputs depend beside its
    content and name, `sender` who handed it in as far as that is known.
    """

    id: str = field(default_factory=new_id)
    name: str
    options: str
    door: Door
    sender: str = ""


@dataclass(frozen=True, kw_only=True)
class StoredFile:
    """A file of a result: what it is, the digest by which its bytes are kept, its size, the name that people see."""

    role: FileRole
    sha256: str
    size: int
    name: str


@dataclass(frozen=True, kw_only=True)
class RuleCount:
    """How often a rule was broken in a column of a sheet: the number of cells, and the first of them."""

    level: str
    code: str
    sheet: str = ""
    column: str = ""
    cells: int = 1
    first: str = ""


@dataclass(frozen=True, kw_only=True)
class StoredSubmission:
    """A submission as the store has it, times in seconds since 1970.

    `number` rises with each one that is accepted. `tries` are the workers that it has lost; `alone` says that it was
    at work when a server ended, and `server_ends` how often since it runs alone. `not_before` is when it may be begun
    again after a fault of this machine, which `trouble` names. `words` say in short how it ended, `reason` why it was
    rejected. `same_as` is the ID of the submission whose result this one was answered with. `counts` are those of
    `--json`.
    """

    id: str
    number: int
    name: str
    sha256: str
    size: int
    options: str
    door: Door
    sender: str
    received_at: float
    state: State
    tries: int = 0
    alone: bool = False
    server_ends: int = 0
    not_before: float = 0.0
    trouble: str = ""
    began_at: float | None = None
    ended_at: float | None = None
    rows_done: int = 0
    rows: int = 0
    exit_code: int | None = None
    words: str = ""
    reason: str = ""
    same_as: str = ""
    counts: Mapping[str, int] = field(default_factory=dict)

    @property
    def has_ended(self) -> bool:
        """Whether it is done or rejected."""
        return self.state in {"done", "rejected"}


@dataclass(frozen=True, kw_only=True)
class Ending:
    """How a submission ended: all that is written down at once.

    `is_repeatable` says that the same submission is answered with it; a refusal by clock, memory or lost workers is
    not.
    """

    state: Literal["done", "rejected"]
    exit_code: int
    words: str
    reason: str = ""
    counts: Mapping[str, int] = field(default_factory=dict)
    files: Sequence[StoredFile] = ()
    rules: Sequence[RuleCount] = ()
    is_repeatable: bool = True


@dataclass(frozen=True, kw_only=True)
class Delivery:
    """Something that is to leave the store, in the order of `number`: files first, the original last, then a message.

    `kind` is `file`, `original` (moved to done/ or rejected/) or `message` (to the webhook). `target` is the name that
    was chosen for it, empty before. `tries` are those that failed, the last because of a `trouble`, `not_before` when
    the next may be made.
    """

    number: int
    submission: str
    kind: Literal["file", "original", "message"]
    file: StoredFile | None = None
    target: str = ""
    tries: int = 0
    not_before: float = 0.0
    trouble: str = ""
