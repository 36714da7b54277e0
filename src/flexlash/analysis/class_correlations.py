"""Which dimensions of a tolerance class scatter together: as entered, else as measured on the same parts.

entered         a row of Correlations of the class, or of a class that it is based on
measured        the correlation of two dimensions whose rows of Tolerances take the same sample
crossed         a pair of which one dimension is one value for a whole lot, and the other is not
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

from flexlash.analysis.contradicting_correlations import Pair, contradictions, without_contradiction
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.entry_words import dimension_words
from flexlash.schema.spellings import plain
from flexlash.schema.variant import CorrelationRow, ToleranceRow
from flexlash.tolerance.sample_statistics import MeasuredCorrelation, measured_correlation
from flexlash.validation.ledger import Ledger
from flexlash.validation.validated import Validated

__all__ = ["class_correlations"]

_LISTED = 4
"""Most pairs that a message lists."""

_SHARP = 5e-4
"""What the three digits of a correlation in a message leave open."""


def class_correlations(validated: Validated, ledger: Ledger) -> dict[str, dict[Pair, float]]:
    """Return the correlations of each class that has some, by its plain name, and record what is wrong with them.

    An entered correlation goes before a measured one; 0 is left out. A class with an error in them is spoiled.
    """
    known = _Known(validated)
    found = {}
    for key, rows in validated.classes.items():
        if key not in ledger.classes:
            correlations = _of_class(known, key, rows, ledger)
            if correlations and key not in ledger.classes:
                found[key] = correlations
    return found


class _Known:
    """What is entered and measured, by class and by pair; each pair of columns of a sample is looked at once."""

    def __init__(self, validated: Validated) -> None:
        self.validated = validated
        self._entered: dict[str, list[CorrelationRow]] = defaultdict(list)
        for row in validated.correlation_rows:
            self._entered[plain(row.tolerance_class)].append(row)
        self._bases: dict[str, list[str]] = defaultdict(list)
        if validated.tolerances is not None and self._entered:
            for name, base in validated.tolerances.frame.select("tolerance_class", "based_on").drop_nulls().iter_rows():
                self._bases[plain(name)].append(plain(base))
        self._measured: dict[tuple[str, Pair, bool], MeasuredCorrelation | None] = {}

    def entered(self, key: str) -> dict[Pair, CorrelationRow]:
        """Return what is entered for a class; what it does not hold itself is that of the classes it is based on."""
        found: dict[Pair, CorrelationRow] = {}
        pending, seen = [key], {key}
        while pending:
            one = pending.pop(0)
            for row in self._entered.get(one, ()):
                found.setdefault((row.first, row.second), row)
            further = [base for base in self._bases.get(one, ()) if base not in seen]
            pending += further
            seen.update(further)
        return found

    def measured(self, first: ToleranceRow, second: ToleranceRow) -> MeasuredCorrelation | None:
        """Return how the parts of one sample scatter in the dimensions of two rows, None where that cannot be told."""
        if first.sample is None or second.sample is None:
            return None
        sample, by_scores = plain(first.sample.sample), "measured" in {first.distribution, second.distribution}
        if sample != plain(second.sample.sample):
            return None
        pair = sample, (first.dimension, second.dimension), by_scores
        if pair not in self._measured:
            self._measured[pair] = measured_correlation(first.sample, second.sample, by_scores=by_scores)
        return self._measured[pair]


def _of_class(known: _Known, key: str, rows: Sequence[ToleranceRow], ledger: Ledger) -> dict[Pair, float]:
    """Return the correlations of a class, and record what is wrong with them."""
    by_name = {row.dimension: row for row in rows if row.scatters}
    ordered = {name: by_name[name] for name in DIMENSIONS if name in by_name}
    entered = {pair: row for pair, row in known.entered(key).items() if ordered.keys() >= set(pair)}
    sampled = [row for row in ordered.values() if row.sample is not None]
    pairs = {(one.dimension, other.dimension): known.measured(one, other) for one, other in combinations(sampled, 2)}
    measured = {pair: found for pair, found in pairs.items() if found is not None}
    if not entered and not measured:
        return {}
    told = {name for pair in (*entered, *measured) for name in pair}
    names = [row.tolerance_class for row in entered.values()] + [ordered[name].tolerance_class for name in told]
    one = _Class(known.validated, key, ordered, ledger, takes_over_all=key not in map(plain, names))
    merged = one.usable(measured, entered) | {pair: row.correlation for pair, row in entered.items()}
    one.judge(entered, measured, merged)
    return {pair: merged[pair] for pair in combinations(ordered, 2) if merged.get(pair)}


@dataclass(frozen=True)
class _Class:
    """A class with the rows of its scattering dimensions, of whose correlations something is said.

    Of one that takes over all that it ties nothing is said, since that is said of the class which it is based on.
    """

    validated: Validated
    key: str
    rows: Mapping[str, ToleranceRow]
    ledger: Ledger
    takes_over_all: bool

    @property
    def name(self) -> str:
        """Its name as entered; the plain one where it takes over all of its rows."""
        names = (row.tolerance_class for row in self.rows.values())
        return next((name for name in names if plain(name) == self.key), self.key)

    def crossed(self, pair: Pair) -> bool:
        """Whether one of a pair is one value for a whole lot, and the other is not."""
        first, second = pair
        return self.rows[first].scatters_between != self.rows[second].scatters_between

    def usable(
        self, measured: Mapping[Pair, MeasuredCorrelation], entered: Mapping[Pair, CorrelationRow]
    ) -> dict[Pair, float]:
        """Return the measured correlations that hold, and say which do, and which do not as they were measured."""
        values = {pair: found.correlation for pair, found in measured.items() if not self.crossed(pair)}
        fixed = without_contradiction(values)
        used = [pair for pair in values if pair not in entered]
        lost = [pair for pair in measured if self.crossed(pair) and pair not in entered]
        changed = [pair for pair in used if abs(fixed[pair] - values[pair]) > _SHARP]
        self._tell("I531", used, lambda pair: f"{_named(pair)} {_told(measured[pair])}")
        self._tell("W449", lost, lambda pair: f"{_named(pair)} left out, since one scatters between lots")
        self._tell("W449", changed, lambda pair: f"{_named(pair)} {fixed[pair]:.3g} instead of {values[pair]:.3g}")
        return {pair: fixed[pair] for pair in used}

    def _tell(self, code: str, pairs: Sequence[Pair], words: Callable[[Pair], str]) -> None:
        """Record what becomes of measured pairs, once a sample, at the first row of the class that takes it."""
        by_sample: dict[str, list[Pair]] = defaultdict(list)
        numbers: dict[str, list[int]] = defaultdict(list)
        for pair in pairs:
            rows = [self.rows[name] for name in pair]
            own = [row.row for row in rows if plain(row.tolerance_class) == self.key]
            if own and rows[0].sample:
                by_sample[rows[0].sample.sample].append(pair)
                numbers[rows[0].sample.sample] += own
        table = self.validated.tolerances
        if table is None:
            return
        for sample, some in by_sample.items():
            more = f"; {len(some) - _LISTED} more pairs" if len(some) > _LISTED else ""
            facts = {"value": sample, "other": self.name, "detail": "; ".join(map(words, some[:_LISTED])) + more}
            self.ledger.add_in(table, code, min(numbers[sample]), "sample", **facts)

    def judge(
        self,
        entered: Mapping[Pair, CorrelationRow],
        measured: Mapping[Pair, MeasuredCorrelation],
        merged: Mapping[Pair, float],
    ) -> None:
        """Say which entered correlations cannot be, and which the measured parts speak against."""
        crossed = [pair for pair in entered if self.crossed(pair)]
        for pair in crossed:
            lot, part = sorted(pair, key=lambda name: self.rows[name].scatters_between)
            self._refuse("E349", entered[pair], "dimension_2", value=dimension_words(lot), detail=dimension_words(part))
        faults = [] if crossed else contradictions(entered, merged)
        for pair, nearest, alone in faults:
            detail = "" if alone else ", if the other rows named here are corrected too,"
            facts = {"value": merged[pair], "detail": detail, "suggestion": f"{nearest:.10g}"}
            self._refuse("E348", entered[pair], "correlation", **facts)
        for pair, found in measured.items():
            if pair in entered and not found.low <= merged[pair] <= found.high:
                self._add("W448", entered[pair], "correlation", value=merged[pair], detail=_told(found))

    def _refuse(self, code: str, row: CorrelationRow, key: str, **facts: Any) -> None:
        """Record an error in a row of Correlations, for which the class waits."""
        sheet = self._add(code, row, key, **facts)
        self.ledger.spoil("class", self.key, sheet, row.row)

    def _add(self, code: str, row: CorrelationRow, key: str, **facts: Any) -> str:
        """Record a finding in a row of Correlations, unless another class has it; return the name of the sheet."""
        table = self.validated.correlations
        if table is None:
            raise LookupError("a correlation without its table")
        if not self.takes_over_all:
            self.ledger.add_in(table, code, row.row, key, other=self.name, **facts)
        return table.sheet


def _named(pair: Pair) -> str:
    return f"{dimension_words(pair[0])} with {dimension_words(pair[1])}"


def _told(found: MeasuredCorrelation) -> str:
    """Return a measured correlation with its interval."""
    return f"{found.correlation:.2f} (95 %: {found.low:.2f} to {found.high:.2f}, {found.count} parts)"
