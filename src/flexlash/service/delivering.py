"""What is to leave the store → OUT: each file whole under a name that nothing else has, the original last.

All files of a submission get the same number. One that is there already with the same bytes counts as delivered, so
that whatever was cut short is done again without harm; nothing is ever overwritten.
"""

from __future__ import annotations

import errno
import hashlib
import os
import stat
from collections.abc import Callable
from itertools import count
from pathlib import Path, PurePath
from typing import BinaryIO

from flexlash.outputs.writing import Filling, put_new, sync_folder, temporary
from flexlash.schema.file_faults import reason
from flexlash.service.log import Log
from flexlash.service.original import KeptPart
from flexlash.service.out_names import longest_name, number_of, numbered, out_name
from flexlash.service.patience import Patience
from flexlash.service.places import Places
from flexlash.service.reasons import answered_again_text
from flexlash.service.records import Delivery, StoredFile, StoredSubmission, new_id
from flexlash.service.repeated import back_off
from flexlash.service.settling import Identity, identity
from flexlash.service.store import Store

__all__ = ["Delivering"]

_PIECE = 2**20
_MOST = 9_999
"""Files of one name, numbered, beyond which none is written."""

_MOVED_WITHIN = 100
"""Names tried for an original where something lies in its folder."""


class Delivering:
    """The deliveries of a store into OUT. `claimed` is told of each folder that holds a submission without a row."""

    def __init__(
        self,
        store: Store,
        places: Places,
        log: Log,
        *,
        kept: KeptPart,
        claimed: Callable[[Path], object],
        clock: Callable[[], float],
    ) -> None:
        self._store = store
        self._places = places
        self._log = log
        self._kept = kept
        self._claimed = claimed
        self._own = places.work / store.name
        self._patience = Patience(log, clock)
        self._longest = longest_name(places.out)
        self._same: dict[Path, Identity] = {}

    def begin(self) -> None:
        """Find again what was left half delivered; raise OSError where OUT cannot be read."""
        undelivered = {one.submission for one in self._store.undelivered()}
        for folder in self._places.claimed(self._store.name):
            known = self._store.submission(folder.name)
            if known is None or not known.has_ended or known.id in undelivered:
                continue
            # Its deliveries ended without it: it had changed, and this service ended before it was handed in anew.
            for path in _files(folder):
                self._hand_in_anew(path, known)
            folder.rmdir()

    def step(self) -> bool:
        """Deliver what is due; return whether anything was."""
        try:
            self._places.require()
        except OSError as fault:
            self._patience.failed("OUT", fault, self._places.out)
            return False
        self._patience.went_well("OUT", self._places.out)
        delivered = 0
        for delivery in self._store.deliveries():
            if delivery.kind == "message":
                continue
            try:
                self._deliver(delivery)
                delivered += 1
            except OSError as fault:
                self._postpone(delivery, fault)
        return delivered > 0

    def _postpone(self, delivery: Delivery, fault: OSError) -> None:
        words = reason(fault)
        self._store.postpone(delivery, back_off(delivery.tries + 1), words)
        if words != delivery.trouble:
            what = delivery.file.name if delivery.file else "original"
            self._log.say("fault", delivery.submission, what=what, why=words)

    def _deliver(self, delivery: Delivery) -> None:
        submission = self._store.submission(delivery.submission)
        if submission is None or not self._is_due(delivery, submission) or self._is_replaced(submission):
            return
        if (file := delivery.file) is None:
            self._tell_repetition(submission)
            self._move_original(delivery, submission)
            return
        if not delivery.target or self._is_taken(delivery.target, file):
            delivery = self._store.choose_target(delivery, self._free_name(file, submission))
        self._put(delivery.target, file, self._copied(file))
        self._store.delivered(delivery)
        self._log.say("delivered", submission.id, file=delivery.target)

    def _is_due(self, delivery: Delivery, submission: StoredSubmission) -> bool:
        """Whether a submission was not retried since it was looked at: then its last result leaves, once it has one."""
        file = delivery.file
        return submission.has_ended and (file is None or self._store.files(submission.id).get(file.role) == file)

    # Names

    def _free_name(self, file: StoredFile, submission: StoredSubmission) -> str:
        """Return the name for a file: with the number that others of its submission have, else with one free for all.

        Raises OSError where ten thousand are taken.
        """
        targets, files = self._store.targets(submission.id), self._store.files(submission.id)
        numbers = [number_of(target) for target in targets.values() if target]
        together = [file] if numbers else [files[role] for role in targets if role in files]
        names = [(out_name(one.name, self._longest), one) for one in together]
        for number in range(max(numbers, default=1), _MOST):
            if not any(self._is_taken(numbered(name, number), one) for name, one in names):
                return numbered(out_name(file.name, self._longest), number)
        raise FileExistsError(errno.EEXIST, "too many files of this name", file.name)

    def _is_taken(self, name: str, file: StoredFile) -> bool:
        """Whether something else than this file has a name."""
        path = self._places.out / name
        try:
            status = path.lstat()
        except FileNotFoundError:
            return False
        if not stat.S_ISREG(status.st_mode) or status.st_size != file.size:
            return True
        try:
            return _digest(path) != file.sha256
        except OSError:
            return True

    # Files

    def _put(self, name: str, file: StoredFile, fill: Filling) -> None:
        """Put a file under a name that nothing else has, or where it is already; raise OSError."""
        path = self._places.out / name
        try:
            path.lstat()
        except FileNotFoundError:
            with temporary(self._places.out, fill) as made:
                if put_new(made, path):
                    return
        if self._is_taken(name, file):
            raise FileExistsError(errno.EEXIST, "another file came to have this name", str(path))
        sync_folder(self._places.out)

    def _copied(self, file: StoredFile) -> Filling:
        """Return what writes a kept file; a damaged one is not delivered."""

        def fill(copy: BinaryIO) -> None:
            with self._store.blobs.checked(file.sha256).open("rb") as kept:
                while piece := kept.read(_PIECE):
                    copy.write(piece)

        return fill

    def _tell_repetition(self, submission: StoredSubmission) -> None:
        """Say, where the sender looks, that a submission was answered with the result of an earlier one."""
        if not submission.same_as:
            return
        targets = self._store.targets(submission.id)
        text = answered_again_text(submission, [target for target in targets.values() if target])
        name = out_name(f"{PurePath(submission.name).stem}-reasons.txt", self._longest)
        told = StoredFile(role="reasons", sha256=hashlib.sha256(text).hexdigest(), size=len(text), name=name)
        first = max((number_of(target) for target in targets.values()), default=1)
        free = next(number for number in count(first) if not self._is_taken(numbered(name, number), told))
        self._put(numbered(name, free), told, lambda file: file.write(text))

    # Originals

    def _move_original(self, delivery: Delivery, submission: StoredSubmission) -> None:
        """Move the original to done/ or rejected/, under its ID, where nothing of that name lies."""
        place = f"{submission.state}/{submission.id}"
        folder, target = self._own / submission.id, self._places.out / submission.state / submission.id
        delivery = self._store.choose_target(delivery, place)
        files = _files(folder)
        if files:
            target.parent.mkdir(exist_ok=True)
            target.mkdir(exist_ok=True)
            sync_folder(target.parent)
            for path in files:
                _move(path, target)
            sync_folder(target)
            sync_folder(folder)
            folder.rmdir()
        elif not _files(target):
            self._log.say("original is gone", submission.id, name=submission.name, why="somebody moved it out of work")
        self._same.pop(folder, None)
        self._store.delivered(delivery)
        self._log.say("delivered", submission.id, original=place)

    def _is_replaced(self, submission: StoredSubmission) -> bool:
        """Whether the original is no longer what was computed, since its writer went on: it is handed in anew.

        Then nothing of the result is delivered: it is that of a piece of the file.
        """
        files = _files(self._own / submission.id)
        changed = [path for path in files if not self._is_as_computed(path, submission)]
        if not changed:
            return False
        if len(changed) == len(files):
            self._store.drop_deliveries(submission.id, "the file was still being written; it is handed in anew")
        for path in changed:
            self._hand_in_anew(path, submission)
        return len(changed) == len(files)

    def _is_as_computed(self, path: Path, submission: StoredSubmission) -> bool:
        status = path.lstat()
        if not stat.S_ISREG(status.st_mode) or self._same.get(path.parent) == identity(status):
            return True
        if not self._kept.is_of(path, submission):
            return False
        self._same[path.parent] = identity(status)
        return True

    def _hand_in_anew(self, path: Path, submission: StoredSubmission) -> None:
        """Give a file an ID of its own; it is accepted once it has settled."""
        folder = self._own / new_id()
        folder.mkdir()
        sync_folder(self._own)
        path.rename(folder / path.name)
        sync_folder(folder)
        self._claimed(folder)
        self._log.say("changed after it was claimed", submission.id, handed_in_anew_as=folder.name)


def _files(folder: Path) -> list[Path]:
    """Return what lies in a folder, nothing where there is none."""
    try:
        return sorted(folder.iterdir())
    except FileNotFoundError:
        return []


def _move(path: Path, folder: Path) -> None:
    """Move an original into a folder, under a number where its name is taken there."""
    for number in range(1, _MOVED_WITHIN):
        target = folder / numbered(path.name, number)
        if not os.path.lexists(target):
            path.rename(target)
            return
    raise FileExistsError(errno.EEXIST, "too many files of this name", str(folder))


def _digest(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
