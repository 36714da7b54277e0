"""Names of variants → short labels, distinct where the names are."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from functools import partial

from flexlash.schema.findings import shown
from flexlash.schema.unused_names import unused_name

__all__ = ["distinct_labels"]

_WHOLE = 10**6
"""More characters than a cell holds."""


def distinct_labels(names: Sequence[str], longest: int) -> list[str]:
    """Return a label for each of several names: its start; where others have the same, its start and end, or a number.

    >>> distinct_labels(["sleeve", "sleeve of steel, wide", "sleeve of steel, long"], 12)
    ['sleeve', 'sleeve… wide', 'sleeve… long']
    >>> distinct_labels(["long rim, wall 1.6, steel", "long rim, wall 1.8, steel"], 12)
    ['long r…steel', 'long r…ste…2']
    """
    starts = [shown(name, longest=longest) for name in names]
    often = Counter(starts)
    labels = [
        start if often[start] == 1 else _both_ends(name, longest) for name, start in zip(names, starts, strict=True)
    ]
    seen, taken = set[str](), set(labels)
    for index, label in enumerate(labels):
        if label in seen:
            labels[index] = unused_name(taken, numbered=partial(_numbered, label, longest))
            taken.add(labels[index])
        seen.add(label)
    return labels


def _both_ends(name: str, longest: int) -> str:
    """Return the start and the end of a name, as much of each."""
    text = shown(name, longest=_WHOLE)
    if len(text) <= longest:
        return text
    end = (longest - 1) // 2
    return f"{text[: longest - 1 - end]}…{text[-end:]}"


def _numbered(label: str, longest: int, number: int) -> str:
    """Return a label with a number at its end."""
    ending = f"…{number}"
    return f"{label[: longest - len(ending)].removesuffix('…')}{ending}"
