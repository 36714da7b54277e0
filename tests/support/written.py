"""An outcome written as `run` would write it, for tests that have made one by hand."""

from flexlash.outputs.naming import REPORTS, named_output
from flexlash.outputs.plan import Plan
from flexlash.report.output import outcome_bytes


def write_outcome(outcome, path):
    """Write an outcome in the form that the path's ending names; return where."""
    output = named_output(Plan(inputs=[]), path, REPORTS)
    return output.write(*outcome_bytes(outcome, output.ending)).path
