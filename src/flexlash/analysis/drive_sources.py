"""The rows of Other sources as plays at the output of the drive: what each adds on average, and how it scatters."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from flexlash.mechanics.clearances import angle_at_output, play_angle, play_from_radial
from flexlash.schema.arrays import Array
from flexlash.schema.decision_rows import OtherSource
from flexlash.schema.variant import Limits
from flexlash.tolerance.dimension_limits import distribution_of
from flexlash.tolerance.tolerance_chains import Contribution, inflation_of

__all__ = ["DriveModel", "OutputPlay", "at_output", "output_plays"]


@dataclass(frozen=True, kw_only=True)
class OutputPlay:
    """A source at the output [rad]: `entered` is its value, `low` and `high` its ends; they coincide without scatter.

    Of a random source the value has no part: its ends are its deviations.
    """

    name: str
    entered: float
    low: float
    high: float
    limits: Limits | None

    @property
    def mean(self) -> float:
        """What it adds to the mean backlash: the middle of its ends."""
        return (self.low + self.high) / 2

    @property
    def tolerance(self) -> float:
        """Half the distance between its ends."""
        return (self.high - self.low) / 2

    @cached_property
    def inflation(self) -> float:
        """3σ/T of its scatter, 1 without one."""
        return 1.0 if self.limits is None else inflation_of(self.limits)

    @cached_property
    def sd(self) -> float:
        """Standard deviation of its scatter."""
        return 0.0 if self.limits is None else distribution_of(self.limits).standard_deviation

    def contribution(self, shift: float) -> Contribution:
        """Return it as a link of the chain of deviations, `shift` of whose tolerance a mean may lie off."""
        return Contribution(tolerance=self.tolerance, inflation=self.inflation, shift=shift)


def at_output(source: OtherSource, play: float) -> float:
    """Return a play of a source, an angle [rad] or a length [m] as it is entered, as angle at the output [rad]."""
    if source.enter_as == "mm radial play":
        play = float(play_from_radial(play, source.pressure_angle or 0.0))
    if source.radius is not None:
        play = float(play_angle(play, source.radius))
    return float(angle_at_output(play, source.ratio))


def output_plays(sources: Sequence[OtherSource]) -> tuple[OutputPlay, ...]:
    """Return the sources as plays at the output, in their order."""
    return tuple(_output_play(source) for source in sources)


def _output_play(source: OtherSource) -> OutputPlay:
    """Return a source as a play at the output."""
    base = source.value if source.kind == "systematic" else 0.0
    low, high = at_output(source, base + source.lower), at_output(source, base + source.upper)
    limits = None
    if low < high:
        limits = Limits(low=low, high=high, distribution=source.distribution, sigma=source.limits_sigma)
    return OutputPlay(name=source.name, entered=at_output(source, source.value), low=low, high=high, limits=limits)


@dataclass(frozen=True)
class DriveModel:
    """The backlash of the whole drive as a function of dimensions and plays: that from wind-up, and every play."""

    backlash: Callable[[Mapping[str, Array | float]], Array]
    plays: tuple[str, ...]

    def __call__(self, numbers: Mapping[str, Array | float]) -> Array:
        """Return the backlash [rad] at dimensions [SI] and plays [rad], arrays of one shape."""
        total = self.backlash({name: value for name, value in numbers.items() if name not in self.plays})
        for name in self.plays:
            total = total + numbers[name]
        return total
