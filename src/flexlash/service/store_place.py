"""Where a store lies: the user's own folder unless another is named, on a disk of this machine, closed to others."""

from __future__ import annotations

import os
import re
import stat
import sys
from pathlib import Path

from flexlash.schema.findings import shown

__all__ = [
    "DATABASE",
    "KEEPING_LOCK",
    "SERVER_LOCK",
    "WEBHOOK_KEY",
    "WORK",
    "StoreError",
    "default_store",
    "foreign",
    "prepared",
    "remote_kind",
]

DATABASE = "flexlash.sqlite"
SERVER_LOCK, KEEPING_LOCK = "server.lock", "keeping.lock"
"""Locks that a server holds as long as it lives, and a backup while blobs must not be swept."""

WEBHOOK_KEY = "webhook.key"
"""The file with the key by which messages are signed, where none was given."""

WORK = "work"
"""The folder for what is done of large tables, until their results are kept."""

_OURS = re.compile(r"flexlash\.sqlite.*|(server|keeping)\.lock|webhook\.key|blobs|work|\..*|lost\+found")
"""What may lie in the folder of a store, or of one whose making was interrupted."""

_REMOTE = re.compile(
    r"nfs\d?|cifs|smb\d?|smbfs|afs|ncpfs|9p|drvfs|vboxsf|davfs|lustre|gpfs|ceph|glusterfs|beegfs|ocfs2|gfs2"
    r"|fuse\.(sshfs|s3fs|rclone|davfs2?|glusterfs|ceph|smbnetfs|curlftpfs|gcsfuse|vmhgfs-fuse)"
)
"""Kinds of file systems whose locks and shared memory do not hold between machines as SQLite needs them."""

_DRIVE_REMOTE = 4


class StoreError(OSError):
    """A store that cannot be used, in one sentence."""


def default_store() -> Path:
    """Return the folder of the user's own store."""
    from platformdirs import user_data_path

    return user_data_path("flexlash", appauthor=False)


def prepared(folder: Path) -> Path:
    """Return the whole path of a folder for a store, made where there is none and closed to other users.

    Raises StoreError for a folder on a network drive, with other files, or that cannot be closed, OSError where it
    cannot be made.
    """
    folder = folder.absolute()
    if kind := remote_kind(folder):
        raise StoreError(
            f"the store {_named(folder)} lies on a network drive ({kind}), whose locks cannot be relied on; "
            "name a folder on a disk of this machine with --store"
        )
    folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    if other := foreign(folder):
        raise StoreError(
            f"the folder {_named(folder)} holds other files ({shown(other)}) and can be no store; "
            "name an empty folder with --store"
        )
    if os.name == "posix" and stat.S_IMODE(folder.stat().st_mode) & 0o077:
        try:
            folder.chmod(0o700)
        except OSError:
            raise StoreError(
                f"the store {_named(folder)} is open to other users and does not belong to this one; "
                "name a folder of your own with --store"
            ) from None
    return folder


def foreign(folder: Path) -> str:
    """Return the name of a file in a folder that is none of a store's, an empty text where there is none."""
    return min((path.name for path in folder.iterdir() if not _OURS.fullmatch(path.name)), default="")


def remote_kind(folder: Path) -> str:
    """Return the kind of network drive that a folder lies on, or would; an empty text for a disk of this machine."""
    if sys.platform == "win32":
        import ctypes

        drive = os.path.splitdrive(folder.resolve())[0]
        if drive.startswith("\\\\"):
            return "a share"
        remote = ctypes.windll.kernel32.GetDriveTypeW(f"{drive}\\") == _DRIVE_REMOTE
        return f"drive {drive}" if remote else ""
    try:
        mounts = Path("/proc/mounts").read_bytes()
    except OSError:
        return ""
    kind = _kind_at(os.fsencode(folder.resolve()), mounts)
    return kind if _REMOTE.fullmatch(kind) else ""


def _kind_at(path: bytes, mounts: bytes) -> str:
    r"""Return the kind of file system that a path is on; of what is mounted at one place the last counts.

    >>> _kind_at(b"/mnt/a b/store", b"/dev/a / ext4 rw 0 0\nhost:/x /mnt/a\\040b nfs4 rw 0 0\n")
    'nfs4'
    """
    longest, kind = b"", b""
    for line in mounts.splitlines():
        _, place, kind_here, *_ = line.split(b" ")
        place = re.sub(rb"\\([0-7]{3})", lambda code: bytes([int(code[1], 8)]), place)
        if len(place) >= len(longest) and (path + b"/").startswith(place.rstrip(b"/") + b"/"):
            longest, kind = place, kind_here
    return kind.decode("ascii", "replace")


def _named(folder: Path) -> str:
    return shown(folder, 4096)
