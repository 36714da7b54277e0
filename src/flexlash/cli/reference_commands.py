"""`flexlash schema` and `flexlash explain`: every column, every finding, in words."""

from __future__ import annotations

import json
from dataclasses import replace

import click

from flexlash.schema.findings import CATALOGUE, shown

__all__ = ["explain", "schema"]

_LEVERS = "Levers table"


@click.command()
@click.option("--json", "as_json", is_flag=True, help="As a JSON array, one object per column.")
def schema(*, as_json: bool) -> None:
    """Print the data dictionary: every column of every sheet, and the rules of its cells."""
    from flexlash.schema.columns import ENTRY_SHEETS
    from flexlash.schema.decision_results import ALLOCATION, LEVERS_TABLE
    from flexlash.schema.part_rules import PART_RULES
    from flexlash.schema.result_columns import FINDINGS, RESULTS
    from flexlash.schema.used_columns import TOLERANCES_USED

    # Levers is a sheet of the template and one of the report.
    levers = [replace(column, sheet=_LEVERS) for column in LEVERS_TABLE]
    told = {"Results": RESULTS, "Tolerances used": TOLERANCES_USED, _LEVERS: levers, "Allocation": ALLOCATION}
    sheets = {**ENTRY_SHEETS, **told, "Findings": FINDINGS}
    columns = [column for sheet in sheets.values() for column in sheet]
    if as_json:
        click.echo(json.dumps([column.as_dictionary() for column in columns], ensure_ascii=False, indent=1))
        return
    for sheet, entries in sheets.items():
        click.echo(f"\n{sheet}")
        for column in entries:
            click.echo(f"  {column.key:32} {column.label}{', required' if column.required else ''}")
            click.echo(f"  {'':32} {column.help}")
            for rule in column.rules.values():
                click.echo(f"  {'':32} {rule.id}: {rule.words}")
    click.echo("\nBetween columns of Variants, each with what breaks it")
    for part_rule in PART_RULES:
        click.echo(f"  {part_rule.id:32} {part_rule.words}")


@click.command()
@click.argument("code", required=False)
def explain(code: str | None) -> None:
    """Say what a finding means and how to fix it; without CODE, list all codes."""
    if code is None:
        for rule in CATALOGUE.values():
            click.echo(f"{rule.code}  {rule.level:8} {rule.title}")
        return
    wanted = code.strip().upper()
    meant = [known for known in CATALOGUE if wanted in {known, known[1:]}]
    if len(meant) != 1:
        raise click.UsageError(f"{shown(code)} is not a finding's code. flexlash explain lists them all.")
    from flexlash.schema.finding_explanations import explanation_of

    for line in explanation_of(meant[0]).lines():
        click.echo(line)
