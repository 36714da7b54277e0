"""Excel in, tolerance-spread report out: torsional backlash of strain wave gear flexsplines.

Data flow one way, and each room is one folder. It imports those before it alone:

    schema       columns, rules, units, findings: what every room shares
    reading      a file ─► cells with addresses
    validation   cells ─► variants and findings
    mechanics    dimensions ─► wind-up, backlash, stress
    tolerance    limits and a model ─► spread
    analysis     variants ─► nominal numbers, spread, results
    feedback     findings ─► marked copy, fixed file; the template
    report       the outcome ─► a workbook
    comparison   two files ─► what differs
    outputs      where files go, written whole
    cli          the commands

`pipeline` alone knows the order of the stages. A submission goes through like this:

>>> import flexlash, pathlib, tempfile
>>> from flexlash.feedback.template.template_workbook import study, template_bytes
>>> folder = pathlib.Path(tempfile.mkdtemp())
>>> _ = (folder / "study.xlsx").write_bytes(template_bytes(study()))
>>> outcome = flexlash.run(folder / "study.xlsx")
>>> outcome.counts
{'rows': 11, 'computed': 11, 'errors': 0, 'warnings': 5, 'meets': 8, 'marginal': 0, 'fails': 3}
>>> row = outcome.results.row(0, named=True)
>>> row["variant"], round(row["backlash_arcmin"], 3), row["main_contributor"]
('B3-160 case 1', 3.687, 'youngs_modulus')
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from flexlash.analysis.outcome import Outcome
    from flexlash.pipeline import check, distribution, fix, levers, run, sweep

__all__ = ["Outcome", "__version__", "check", "distribution", "fix", "levers", "run", "sweep"]

__version__ = "0.10.0"


def __getattr__(name: str) -> Any:
    """Load the pipeline only when it is used, so that the command line answers at once."""
    if name in {"Outcome", "check", "distribution", "levers", "fix", "run", "sweep"}:
        from flexlash import pipeline

        return getattr(pipeline, name)
    raise AttributeError(f"module 'flexlash' has no attribute {name!r}")
