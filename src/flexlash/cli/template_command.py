"""`flexlash template`: the workbook that submissions are made from, empty or filled."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import click

from flexlash.cli.click_types import planned
from flexlash.cli.terminal import named, print_refusal
from flexlash.outputs.naming import template_output
from flexlash.schema.findings import finding, shown

__all__ = ["template"]


@click.command()
@click.option(
    "-o", "--output", type=click.Path(dir_okay=False, path_type=Path), metavar="FILE.xlsx",
    help="Where to write it. Default: flexlash-template.xlsx; with --upgrade OLD-v2.xlsx beside OLD.",
)  # fmt: skip
@click.option("--example", is_flag=True, help="Fill it with the published B3-160 study.")
@click.option(
    "--upgrade", "old", type=click.Path(path_type=Path, readable=False), metavar="OLD",
    help="Fill it with everything of an older template, or of a table (.csv, .parquet).",
)  # fmt: skip
@click.option("--force", is_flag=True, help="Replace an existing file.")
def template(output: Path | None, *, example: bool, old: Path | None, force: bool) -> None:
    """Write the Excel template that submissions are made from."""
    if example and old:
        raise click.UsageError("--example and --upgrade both fill the template; choose one.")
    target = planned(template_output, output, old, force=force)
    target.require()
    from flexlash.feedback.template.template_workbook import study, template_bytes

    data = _upgraded(old) if old else template_bytes(study() if example else None)
    written = target.write(data).path
    click.echo(f"Template written: {named(written)}")
    follow = "Look it over, then: flexlash check" if old else "Fill it in, then: flexlash run"
    click.echo(f"{follow} {named(written)}", err=True)


def _upgraded(old: Path) -> bytes:
    """Return a new template filled with what an old file holds, and say what it could not hold."""
    from flexlash.feedback.template.upgrade import upgraded
    from flexlash.reading.refusal import Refusal

    try:
        upgrade = upgraded(old)
    except Refusal as refusal:
        facts: dict[str, Any] = {"file": old.name, **refusal.facts}
        found = finding(refusal.code, **facts)
        print_refusal(found, old.name)
        sys.exit(refusal.exit_code)
    made = f", made from template version {upgrade.version}" if upgrade.version else ""
    click.echo(f"{named(old)}{made}: {upgrade.rows} {'row' if upgrade.rows == 1 else 'rows'} of Variants carried over.")
    for remark in upgrade.remarks:
        click.echo(f"  {shown(remark, longest=400)}", err=True)
    return upgrade.data
