"""The files that were written, in words: pictures are many, so that they are counted."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from flexlash.schema.findings import shown

__all__ = ["file_words", "is_picture", "picture_words"]

_LONGEST = 4096


def file_words(paths: Sequence[Path]) -> Iterator[str]:
    """Yield files by name, the pictures of a folder as how many there are."""
    yield from (shown(path, longest=_LONGEST) for path in paths if not is_picture(path))
    yield from picture_words(paths)


def picture_words(paths: Iterable[Path]) -> Iterator[str]:
    """Yield how many of these files are pictures, for each folder.

    >>> [*picture_words([Path("out/a.svg"), Path("out/a.png"), Path("b.svg"), Path("a.xlsx")])]
    ['2 pictures in out', '1 picture in .']
    """
    folders = Counter(path.parent for path in paths if is_picture(path))
    for folder, number in folders.items():
        yield f"{number} picture{'s' * (number != 1)} in {shown(folder, longest=_LONGEST)}"


def is_picture(path: Path) -> bool:
    """Whether a file is a picture, by its name."""
    return path.suffix in {".svg", ".png"}
