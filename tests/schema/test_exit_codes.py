"""Which exit code a submission and several of them end with."""

from __future__ import annotations

import itertools
import json

import pytest
from click.testing import CliRunner

from flexlash.cli import cli
from flexlash.pipeline import check, run
from flexlash.schema.exit_codes import ExitCode, most_severe


def _call(*arguments):
    return CliRunner().invoke(cli, list(map(str, arguments)))


def test_the_order_of_severity():
    """Of any two codes the one that stands first in 1, 5, 4, 3, 6, 0 wins; of none there was nothing to compute."""
    order = [1, 5, 4, 3, 6, 0]
    for codes in itertools.product(order, repeat=2):
        assert most_severe(map(ExitCode, codes)) == min(codes, key=order.index)
    assert most_severe([]) == 4


LIMITS = {"meets": 5.0, "marginal": 3.75, "fails": 3.7, "has none": ""}


@pytest.mark.slow
@pytest.mark.parametrize("verdict", LIMITS)
def test_over_the_limit_is_an_exit_code_where_that_is_asked(table, sound, tmp_path, verdict):
    """--fail-over-limit ends with 6 unless every variant with a limit meets it; without it the code is 0."""
    path = table(
        [{**sound, "backlash_limit_arcmin": 5.0}, {**sound, "variant": "b", "backlash_limit_arcmin": LIMITS[verdict]}]
    )
    asked, plain = ([*options, "--json", "-o", tmp_path / "out.csv"] for options in (["--fail-over-limit"], []))
    done = _call("run", path, *asked)
    counts = json.loads(done.stdout)["counts"]
    assert done.exit_code == (6 if verdict in {"marginal", "fails"} else 0)
    assert [counts[one] for one in ("meets", "marginal", "fails")] == [
        1 + (verdict == "meets"), int(verdict == "marginal"), int(verdict == "fails"),
    ]  # fmt: skip
    assert _call("run", path, *plain).exit_code == 0


@pytest.mark.slow
def test_the_exit_code_of_a_function_call(table, sound):
    """The Python function knows the same codes; check, which samples nothing, has no verdicts."""
    path = table([{**sound, "backlash_limit_arcmin": 3.0}])
    outcome = run(path, samples=64, fail_over_limit=True)
    assert outcome.exit_code is ExitCode.OVER_LIMIT
    assert outcome.counts["fails"] == 1
    checked = check(path, fail_over_limit=True)
    assert (checked.exit_code, checked.counts["fails"]) == (0, 0)


@pytest.mark.slow
def test_rows_that_failed_weigh_more_than_a_limit(table, sound):
    """Of 3 and 6 the row that was not computed decides."""
    rows = [{**sound, "backlash_limit_arcmin": 3.0}, {**sound, "variant": "b", "torque_Nm": ""}]
    assert _call("run", table(rows), "--samples", 64, "--fail-over-limit").exit_code == 3


@pytest.mark.slow
def test_an_error_is_never_code_0(table, sound, monkeypatch):
    """Where an error stands, the code is 3 though every row was computed, and the next step is to fix it."""
    from flexlash.schema.findings import finding

    found = finding("E112", sheet="Variants", cell="Z1", value="Rim lenght", label="Tooth rim length [mm]", name="x")
    monkeypatch.setattr("flexlash.analysis.run_result.in_order", lambda *_: (found,))
    for command in ("check", "run"):
        done = _call(command, table([sound]))
        assert done.exit_code == 3
    assert "Next: fix that and check again" in _call("check", table([sound])).stdout
