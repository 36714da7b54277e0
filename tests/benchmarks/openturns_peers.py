"""What OpenTURNS takes for the questions of `spread.py`: run by an interpreter that has it, on one thread.

    python openturns_peers.py JSON

Prints one JSON list a run: the answer and the processor time [s] of the whole call, from the formula to the answer.
"""

from __future__ import annotations

import json
import sys
import time

import numpy as np
import openturns as ot

FEW = 1 << 14


def output_of(kind, formula, nominal, half):
    """Return the joint distribution of the inputs and the output; the formula is compiled by OpenTURNS."""
    kinds = {
        "normal": lambda name: ot.Normal(nominal[name], half[name] / 3),
        "uniform": lambda name: ot.Uniform(nominal[name] - half[name], nominal[name] + half[name]),
        "triangular": lambda name: ot.Triangular(nominal[name] - half[name], nominal[name], nominal[name] + half[name]),
    }
    inputs = ot.JointDistribution([kinds[kind](name) for name in nominal])
    return inputs, ot.CompositeRandomVector(ot.SymbolicFunction(list(nominal), [formula]), ot.RandomVector(inputs))


def percentile(output, probability, size):
    """Return a percentile by plain Monte Carlo, in blocks that fit the cache."""
    kept, drawn, floor = [], 0, None
    while drawn < size:
        block = np.asarray(output.getSample(min(FEW, size - drawn))).ravel()
        floor = np.quantile(block, 0.99) if floor is None else floor
        kept.append(block[block > floor])
        drawn += len(block)
    above = size - int(probability * size)
    return np.partition(np.concatenate(kept), -above)[-above]


def probability_above(inputs, output, limit, *, method, block, size):
    """Return a probability by FORM and sampling about its design point, of this many points in blocks."""
    event = ot.ThresholdEvent(output, ot.Greater(), limit)
    solver = ot.AbdoRackwitz()
    solver.setStartingPoint(inputs.getMean())
    form = ot.FORM(solver, event)
    form.run()
    kinds = {
        "importance": ot.PostAnalyticalImportanceSampling,
        "controlled": ot.PostAnalyticalControlledImportanceSampling,
    }
    sampling = kinds[method](form.getResult())
    sampling.setBlockSize(block)
    sampling.setMaximumOuterSampling(-(-size // block))
    # Errors are measured over seeds, so that the number of points is given and none is told to be enough.
    sampling.setMaximumCoefficientOfVariation(-1.0)
    sampling.setMaximumStandardDeviation(-1.0)
    sampling.run()
    return sampling.getResult().getProbabilityEstimate()


def main():
    """Answer what the argument asks for."""
    ot.TBB.SetThreadsNumber(1)
    ot.Log.Show(ot.Log.NONE)
    asked = json.loads(sys.argv[1])
    for seed, *question in asked["runs"]:
        ot.RandomGenerator.SetSeed(seed)
        start = time.process_time()
        inputs, output = output_of(asked["kind"], asked["formula"], asked["nominal"], asked["half"])
        if asked["what"] == "percentile":
            (size,) = question
            answer = percentile(output, asked["probability"], size)
        else:
            method, block, size = question
            answer = probability_above(inputs, output, asked["limit"], method=method, block=block, size=size)
        print(json.dumps([float(answer), time.process_time() - start]), flush=True)


if __name__ == "__main__":
    main()
