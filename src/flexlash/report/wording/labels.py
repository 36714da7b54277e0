"""Short names of variants that stay distinct where the names do."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import count

from flexlash.schema.findings import shown

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
    wanted, given = Counter(labels), set[str]()
    for place, label in enumerate(labels):
        if wanted[label] > 1 and label in given:
            labels[place] = next(one for one in _numbered(label, longest) if one not in given and one not in wanted)
        given.add(labels[place])
    return labels


def _both_ends(name: str, longest: int) -> str:
    """Return the start and the end of a name, as much of each."""
    text = shown(name, longest=_WHOLE)
    if len(text) <= longest:
        return text
    end = (longest - 1) // 2
    return f"{text[: longest - 1 - end]}…{text[-end:]}"


def _numbered(label: str, longest: int) -> Iterator[str]:
    """Yield a label with a number from 2 at its end."""
    for number in count(2):
        mark = f"…{number}"
        yield f"{label[: longest - len(mark)].removesuffix('…')}{mark}"
