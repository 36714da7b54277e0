"""What the public functions accept: every argument is checked at the door, and a refusal says its name.

Each check returns the argument as Python's own type, so that numbers of NumPy serve as well. A TypeError is raised for
another kind of thing, a ValueError for a value out of range: `samples = 1.5: a whole number of at least 1 is required`.
"""

from __future__ import annotations

import difflib
import inspect
import math
import os
import reprlib
from collections.abc import Callable, Collection, Iterable
from functools import wraps
from numbers import Integral, Real
from pathlib import Path
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

if TYPE_CHECKING:
    import numpy.typing as npt

    from flexlash.schema.arrays import Array

__all__ = [
    "file_path",
    "flag",
    "function",
    "known",
    "named_arguments",
    "number",
    "number_within",
    "numbers",
    "of_type",
    "one_of",
    "whole_number",
]

_NEAR = 0.7
"""Likeness from which a word is taken for a slip of another one."""

_Arguments = ParamSpec("_Arguments")
_Result = TypeVar("_Result")


def whole_number(name: str, value: object, *, least: int, most: int | None = None) -> int:
    """Return a whole number between two others.

    >>> whole_number("jobs", 2, least=1)
    2
    >>> whole_number("jobs", 0, least=1)
    Traceback (most recent call last):
    ValueError: jobs = 0: a whole number of at least 1 is required
    """
    required = f"a whole number of at least {least}" + ("" if most is None else f" and at most {most}")
    if isinstance(value, bool) or not isinstance(value, Integral):
        raise TypeError(_refusal(name, value, required))
    whole = int(value)
    if whole < least or (most is not None and whole > most):
        raise ValueError(_refusal(name, value, required))
    return whole


def number(name: str, value: object, *, finite: bool = True) -> float:
    """Return a number, which is never NaN and endless only where `finite` says so.

    >>> number("sd", "0.1")
    Traceback (most recent call last):
    TypeError: sd = '0.1': a finite number is required
    """
    required = "a finite number" if finite else "a number"
    if isinstance(value, bool) or not isinstance(value, Real):
        raise TypeError(_refusal(name, value, required))
    try:
        real = float(value)
    except OverflowError:
        real = math.inf
    if math.isnan(real) or (finite and math.isinf(real)):
        raise ValueError(_refusal(name, value, required))
    return real


def number_within(name: str, value: object, *, least: float, most: float) -> float:
    """Return a number from one to another.

    >>> number_within("target_percent", 90, least=97.5, most=99.9999)
    Traceback (most recent call last):
    ValueError: target_percent = 90: a number from 97.5 to 99.9999 is required
    """
    required = f"a number from {least:.10g} to {most:.10g}"
    if isinstance(value, bool) or not isinstance(value, Real):
        raise TypeError(_refusal(name, value, required))
    real = float(value)
    if not least <= real <= most:
        raise ValueError(_refusal(name, value, required))
    return real


def numbers(name: str, value: npt.ArrayLike, *, least: float = -math.inf, most: float = math.inf) -> Array:
    """Return a number, or an array of them, none of which is NaN or beyond two others.

    >>> numbers("probability", [0.5, 2.0], least=0, most=1)
    Traceback (most recent call last):
    ValueError: probability = [0.5, 2.0]: numbers between 0 and 1 are required
    """
    import numpy as np  # not by the command line's help, which is to answer at once

    required = "numbers" if math.isinf(most) else f"numbers between {least:g} and {most:g}"
    try:
        array = np.asarray(value)
    except ValueError as fault:
        raise TypeError(_refusal(name, value, required, plural=True)) from fault
    if array.size and array.dtype.kind not in "iuf":
        raise TypeError(_refusal(name, value, required, plural=True))
    reals = array.astype(float)
    if not np.all((reals >= least) & (reals <= most)):
        raise ValueError(_refusal(name, value, required, plural=True))
    return reals


def one_of(name: str, value: object, choices: Collection[str]) -> str:
    """Return one of some words; a refusal names the nearest.

    >>> one_of("method", "sobl", ["line", "sobol", "random"])
    Traceback (most recent call last):
    ValueError: method = 'sobl': one of line, sobol, random is required; did you mean sobol?
    """
    required = f"one of {', '.join(choices)}"
    if not isinstance(value, str):
        raise TypeError(_refusal(name, value, required))
    if value not in choices:
        raise ValueError(_refusal(name, value, required) + _meant(value, choices))
    return str(value)


def flag(name: str, value: object) -> bool:
    """Return True or False.

    >>> flag("strict", "x")
    Traceback (most recent call last):
    TypeError: strict = 'x': True or False is required
    """
    if isinstance(value, bool):
        return value
    import numpy as np

    if not isinstance(value, np.bool_):
        raise TypeError(_refusal(name, value, "True or False"))
    return bool(value)


def file_path(name: str, value: object) -> Path:
    """Return the path of a file.

    >>> file_path("output", 5)
    Traceback (most recent call last):
    TypeError: output = 5: the path of a file, as a text or a pathlib.Path, is required
    """
    path = os.fspath(value) if isinstance(value, os.PathLike) else value
    if not isinstance(path, str):
        raise TypeError(_refusal(name, value, "the path of a file, as a text or a pathlib.Path,"))
    return Path(path)


def of_type(name: str, value: object, wanted: type | tuple[type, ...], required: str) -> Any:
    """Return a thing of some type; `required` says what that is in words."""
    if not isinstance(value, wanted):
        raise TypeError(_refusal(name, value, required))
    return value


def function(name: str, value: object, *, required: str) -> Any:
    """Return a function; `required` says of what."""
    if not callable(value):
        raise TypeError(_refusal(name, value, required))
    return value


def known(what: str, names: Iterable[str], accepted: Collection[str]) -> None:
    """Raise TypeError for the first name that is not among the accepted ones, with the nearest of them.

    >>> known("run()", ["sede"], ["seed", "samples"])
    Traceback (most recent call last):
    TypeError: run() takes no argument sede; did you mean seed?
    """
    for name in names:
        if name not in accepted:
            there = _meant(str(name), accepted) or f"; there are {', '.join(accepted)}"
            raise TypeError(f"{what} takes no argument {name}{there}")


def named_arguments(of: Callable[_Arguments, _Result]) -> Callable[_Arguments, _Result]:
    """Return the function, which now names the nearest of its arguments for one that it does not take."""
    accepted = list(inspect.signature(of).parameters)

    @wraps(of)
    def checked(*arguments: _Arguments.args, **named: _Arguments.kwargs) -> _Result:
        known(f"{of.__name__}()", named, accepted)
        return of(*arguments, **named)

    return checked


def _meant(name: str, names: Collection[str]) -> str:
    """Return the question after the nearest of some names; an empty text where none is near."""
    near = difflib.get_close_matches(name[:80].lower(), names, n=1, cutoff=_NEAR)
    return f"; did you mean {near[0]}?" if near else ""


def _refusal(name: str, value: object, required: str, *, plural: bool = False) -> str:
    """Return argument, what was given and what is required."""
    return f"{name} = {reprlib.repr(value)}: {required} {'are' if plural else 'is'} required"
