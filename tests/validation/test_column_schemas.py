"""The pandera schemas: made of the columns once, every check by the id of its rule; Results keep their contract."""

from __future__ import annotations

import re

import polars as pl
import pytest

import flexlash
from flexlash.analysis import results as analysis_results
from flexlash.schema.columns import ENTRY_SHEETS
from flexlash.schema.result_columns import RESULTS, result_columns
from flexlash.validation.column_schemas import ResultsError, checked_results, entry_schema, failures

ROWS = 2


def test_every_check_bears_the_id_of_its_rule():
    """The checks of an entry sheet are the rules of its columns, each by its id, and are made once."""
    for sheet, columns in ENTRY_SHEETS.items():
        schema = entry_schema(sheet)
        assert schema is entry_schema(sheet)
        for column in columns:
            checked = {check.name for check in schema.columns[column.key].checks}
            required = set() if schema.columns[column.key].nullable else {f"{column.key}|required"}
            assert checked | required == {rule.id for rule in column.rules.values()}


@pytest.mark.parametrize(
    ("key", "value", "rule"),
    [
        ("torque_Nm", None, "torque_Nm|required"),
        ("torque_Nm", 0.0, "torque_Nm|minimum"),
        ("hub_fillet_radius_mm", -0.1, "hub_fillet_radius_mm|minimum"),
        ("disk_cone_angle_deg", 91.0, "disk_cone_angle_deg|maximum"),
        ("flexspline_type", "tub", "flexspline_type|choices"),
    ],
)
def test_a_broken_rule_is_named_with_its_row(key, value, rule):
    """A cell off its bounds or list fails the rule of its column, at its row; a sound one fails none."""
    sound = {"variant": "A", "material": "M", "torque_Nm": 1.0, "cylinder_length_mm": 1.0, "wall_thickness_mm": 1.0}
    rows = [sound, {**sound, key: value}]
    types = {column.key: pl.Float64 if column.is_number else pl.String for column in ENTRY_SHEETS["Variants"]}
    frame = pl.DataFrame([{name: row.get(name) for name in types} for row in rows], schema=types)
    assert list(failures(entry_schema("Variants"), frame)) == [(rule, 1)]


def _results() -> pl.DataFrame:
    """Return Results of two rows without a number."""
    types = {column.key: pl.Float64 if column.is_number else pl.String for column in RESULTS}
    return pl.DataFrame([dict.fromkeys(types)] * ROWS, schema=types)


def test_results_are_checked_on_their_way_out(tmp_path, monkeypatch):
    """Results of a run, a faulty row among them, keep their contract; were one of its columns another, it would end."""
    path = tmp_path / "two.csv"
    path.write_text(
        "variant,material,torque_Nm,cylinder_length_mm,mean_radius_mm,wall_thickness_mm,disk_inner_radius_mm\n"
        "A,20Cr2Ni4,800,160,80,1.6,40\nB,20Cr2Ni4,-1,160,80,1.6,40\n",
        encoding="utf-8",
    )
    results = flexlash.run(path).results
    assert results.height == ROWS
    assert checked_results(results, result_columns()) is results
    monkeypatch.setitem(analysis_results._STEMS, "disk_share", ("stiffness", 1.0))
    with pytest.raises(ResultsError, match=r"disk_share\|maximum"):
        flexlash.run(path)


@pytest.mark.parametrize(
    ("change", "rule"),
    [
        (lambda results: results.drop("windup_rad"), "windup_rad|column_in_dataframe"),
        (lambda results: results.with_columns(extra=1.0), "extra|column_in_schema"),
        (lambda results: results.select(reversed(results.columns)), "findings|column_ordered"),
        (lambda results: results.with_columns(pl.col("windup_rad").cast(pl.String)), "Float64"),
        (lambda results: results.with_columns(status=pl.lit("fine")), "status|choices"),
        (lambda results: results.with_columns(disk_share=1.5), "disk_share|maximum"),
        (lambda results: results.with_columns(sd_arcmin=-1.0), "sd_arcmin|minimum"),
    ],
)
def test_other_results_are_refused(change, rule):
    """Results with a column too few, too many, elsewhere, of another type or off its bounds are a fault, named."""
    with pytest.raises(ResultsError, match=re.escape(rule)):
        checked_results(change(_results()), RESULTS)
