"""`flexlash template`: the workbook that submissions are made from, empty or filled."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import click

from flexlash.cli.click_types import planned
from flexlash.cli.terminal import named, print_refusal
from flexlash.outputs.naming import template_output
from flexlash.schema.columns import OPTIONAL_SHEETS
from flexlash.schema.findings import finding, shown

__all__ = ["template"]


_SHEETS = {name.lower().replace(" ", "-"): name for name in OPTIONAL_SHEETS}
_ALL = "all"


def _optional(context: click.Context, option: click.Parameter, value: tuple[str, ...]) -> tuple[str, ...]:
    """Return the optional sheets that are named, in any of the options, with commas between them."""
    del context, option
    asked = {name.strip().lower() for names in value for name in names.split(",") if name.strip()}
    there = f"There are {', '.join(_SHEETS)} and {_ALL}."
    for name in sorted(asked - {*_SHEETS, _ALL}):
        raise click.BadParameter(f"there is no optional sheet {shown(name)}. {there}")
    return tuple(sheet for name, sheet in _SHEETS.items() if asked & {name, _ALL})


@click.command(
    help="Write the Excel template that submissions are made from.\n\n"
    "\b\nOptional sheets, added by --with NAME; --upgrade OLD adds them to a filled template:\n"
    + "\n".join(f"  {name:15}{OPTIONAL_SHEETS[sheet]}" for name, sheet in _SHEETS.items())
)
@click.option(
    "-o", "--output", type=click.Path(dir_okay=False, path_type=Path), metavar="FILE.xlsx",
    help="Where to write it. Default: flexlash-template.xlsx; with --upgrade beside OLD, as OLD-vVERSION.xlsx.",
)  # fmt: skip
@click.option("--example", is_flag=True, help="Fill it with the published B3-160 study.")
@click.option(
    "--upgrade", "old", type=click.Path(path_type=Path, readable=False), metavar="OLD",
    help="Fill it with the contents of an older template, or of a table (.csv, .parquet).",
)  # fmt: skip
@click.option(
    "--with", "optional", multiple=True, callback=_optional, metavar="SHEETS",
    help=f"Add optional sheets: {', '.join(_SHEETS)} (with commas between them), or {_ALL}.",
)  # fmt: skip
@click.option("--force", is_flag=True, help="Replace an existing file.")
def template(output: Path | None, *, example: bool, old: Path | None, optional: tuple[str, ...], force: bool) -> None:
    """Write the Excel template that submissions are made from."""
    if example and old:
        raise click.UsageError("--example and --upgrade both fill the template; choose one.")
    target = planned(template_output, output, old, force=force)
    target.require()
    from flexlash.feedback.template.template_workbook import Filling, study, template_bytes

    filling = replace(study() if example else Filling(), optional=optional)
    data = _upgraded(old, optional) if old else template_bytes(filling)
    written = target.write(data).path
    click.echo(f"Template written: {named(written)}")
    fresh = "It is filled already. Next: flexlash run" if example else "Fill it in, then: flexlash run"
    follow = "Look it over, then: flexlash check" if old else fresh
    click.echo(f"{follow} {named(written)}", err=True)


def _upgraded(old: Path, optional: tuple[str, ...]) -> bytes:
    """Return a new template filled with what an old file holds, and say what it could not hold."""
    from flexlash.feedback.template.upgrade import upgraded
    from flexlash.reading.refusal import Refusal

    try:
        upgrade = upgraded(old, optional=optional)
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
