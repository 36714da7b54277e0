"""How much memory the record of a stage holds: Python's objects by tracemalloc, frames by their own size."""

import gc
import tracemalloc

import numpy as np
import polars as pl

__all__ = ["held"]


def held(make, known):
    """Return what a stage returns, and how many bytes it holds beyond the frames that are `known`; its own become so.

    NumPy's arrays are left out, since the frames that are made of them tell their size.
    """
    gc.collect()
    tracemalloc.start()
    try:
        made = make()
        gc.collect()
        traces = tracemalloc.take_snapshot().filter_traces([tracemalloc.DomainFilter(False, np.lib.tracemalloc_domain)])
    finally:
        tracemalloc.stop()
    new = [frame for frame in _frames(made) if not any(frame is one for one in known)]
    known += new
    return made, sum(trace.size for trace in traces.traces) + sum(frame.estimated_size() for frame in new)


def _frames(made):
    """Return the frames that a record and those in it hold, each once."""
    found = {}
    for value in vars(made).values():
        if isinstance(value, pl.DataFrame):
            found[id(value)] = value
        elif hasattr(value, "__dataclass_fields__"):
            found |= {id(frame): frame for frame in _frames(value)}
    return found.values()
