"""The book of rules: whoever asks, in whatever notation, gets the same answer to every rule of every row."""

import math
from collections import Counter
from types import SimpleNamespace

import openpyxl
import polars as pl
import pytest
from libreoffice import convert, needs_libreoffice
from random_rows import rows

from flexlash.feedback.template.entry_rules import FIRST_ROW
from flexlash.feedback.template.template_workbook import Filling, template_bytes
from flexlash.mechanics.elasticity.part import section_problem
from flexlash.report.formula.live import Live
from flexlash.report.trace import trace_rules
from flexlash.report.trace.inputs import ENTERED
from flexlash.schema.columns import DIMENSIONS, VARIANTS
from flexlash.schema.findings import CATALOGUE
from flexlash.schema.part_row import first_broken
from flexlash.schema.part_rules import PART_RULES, said_before
from flexlash.schema.variant import Variant
from flexlash.tolerance.dimension_limits import shape_problems
from flexlash.tolerance.gaps import gaps
from flexlash.validation.relations import RELATIONS, FrameRow, numbers_of

KEYS = [column.key for column in VARIANTS]
ERRORS = [rule for rule in PART_RULES if rule.is_error]
EVERY = [dict.fromkeys(KEYS) | row for row in rows(6000, seed=11)]
NUMBERS = [numbers_of(row) for row in EVERY]
LENGTHS = [rule for rule in ERRORS if rule.compares_lengths and rule.code != "E306"]


BEFORE = {rule.id: said_before(rule) for rule in LENGTHS}


def _broken(row):
    """Return which rules plain numbers break."""
    return [row.all_of(*rule.broken(row)) for rule in PART_RULES]


BROKEN = [_broken(row) for row in NUMBERS]


def test_every_rule_is_broken_and_kept_often():
    """The random rows break each rule and keep each rule, and hundreds of them break none that is an error."""
    for rule, broken in zip(PART_RULES, zip(*BROKEN, strict=True), strict=True):
        assert 10 < sum(broken) < len(EVERY) - 10, rule.id
    sound = [row for row in NUMBERS if first_broken(ERRORS, row) is None]
    assert len(sound) > 400
    assert {row.type for row in sound} == {"cup", "hat", "cylinder"}


def test_frame_and_numbers_decide_alike():
    """Each rule is broken in the same rows as an expression on a frame and as plain numbers."""
    types = {column.key: pl.Float64 if column.is_number else pl.String for column in VARIANTS}
    row = FrameRow()
    broken = [row.all_of(*rule.broken(row)).fill_null(value=False).alias(rule.id) for rule in PART_RULES]
    frame = pl.DataFrame(EVERY, schema=types).select(broken)
    assert [list(one) for one in frame.iter_rows()] == BROKEN


@pytest.mark.slow
def test_a_relation_tells_what_no_rule_before_it_tells():
    """A relation is a broken rule in whose row none of the rules is broken that it stands after, or they after."""
    types = {column.key: pl.Float64 if column.is_number else pl.String for column in VARIANTS}
    frame = pl.DataFrame(EVERY, schema=types).select(one.broken.alias(name) for name, one in RELATIONS.items())
    for told, broken in zip(frame.iter_rows(named=True), BROKEN, strict=True):
        codes = {rule.code for rule, one in zip(PART_RULES, broken, strict=True) if one}
        silenced = [bool(codes & _codes_before(rule)) for rule in PART_RULES]
        assert list(told.values()) == [one and not silent for one, silent in zip(broken, silenced, strict=True)]


def _codes_before(rule):
    """Return the codes that silence a rule, those which silence these among them."""
    codes = set(rule.after)
    while more := {code for one in PART_RULES if one.code in codes for code in one.after} - codes:
        codes |= more
    return codes


def _page(row):
    """Return a stand-in for Trace's page on which this row was submitted."""
    lines = {"flexspline_type": Live("$C$1", row.type)}
    entries = {}
    for name in ENTERED:
        entry = row.entries.get(name, "")
        value = row[name] if name in DIMENSIONS else math.nan
        lines[name] = Live("$C$2", 0.0 if math.isnan(value) else value)
        entries[name] = Live("$F$2", entry), Live("$G$2", "")
    page = SimpleNamespace(entries=entries)
    return type("Lines", (dict,), {"entries": page.entries})(lines)


@pytest.mark.slow
def test_trace_decides_alike():
    """Trace's live rules name the rule that plain numbers break first."""
    for row in NUMBERS[:1000]:
        inputs = trace_rules.InputRow(_page(row))
        rule = first_broken(ERRORS, row)
        live = next((one for one in ERRORS if inputs.all_of(*one.broken(inputs)).value), None)
        assert live is rule, row


def _filled(count):
    """Return the first rows as a template takes them."""
    base = {"material": "20Cr2Ni4", "torque_Nm": 800.0}
    return [
        {"variant": f"row {number}", **base, **{key: value for key, value in row.items() if value is not None}}
        for number, row in enumerate(EVERY[:count])
    ]


def _statuses(path, count):
    sheet = openpyxl.load_workbook(path, data_only=True)["Variants"]
    place = len(VARIANTS) + 1
    return [row[0] for row in sheet.iter_rows(FIRST_ROW + 1, FIRST_ROW + count, place, place, values_only=True)]


@pytest.mark.slow
@needs_libreoffice
def test_the_template_decides_alike(tmp_path):
    """The template's status names the rule that plain numbers break first, stored and recalculated."""
    path, count = tmp_path / "random.xlsx", 2500
    path.write_bytes(template_bytes(Filling(variants=_filled(count))))
    broken = [first_broken(ERRORS, row) for row in NUMBERS[:count]]
    wanted = [rule.words if rule else "complete" for rule in broken]
    assert _statuses(path, count) == wanted
    assert _statuses(convert(path, "xlsx", tmp_path), count) == wanted


def _variant(row):
    """Return a row as a variant [SI], what is 0 left out."""
    dimensions = {name: size * DIMENSIONS[name].si_unit.si for name, size in row.entries.items() if size}
    return Variant(row=2, name="one", flexspline_type=row.type, material="", tolerance_class="", dimensions=dimensions)


def _makes_a_row(row):
    """Whether a row has all that its type needs, and nothing else, so that only its lengths may be at odds."""
    rule = first_broken(ERRORS, row)
    return rule is None or rule in LENGTHS


@pytest.mark.slow
def test_exact_limits_decide_alike():
    """Without tolerances the check at the limits finds what the rules of lengths refuse, where nothing just touches."""
    found = Counter()
    for row in filter(_makes_a_row, NUMBERS):
        variant = _variant(row)
        if any(abs(_room(gap, variant)) < 1e-11 for gap in gaps(variant.flexspline_type, variant.dimensions)):
            continue
        broken = [rule for rule in LENGTHS if row.all_of(*rule.broken(row))]
        first = [rule for rule in broken if not any(one in broken for one in BEFORE[rule.id])]
        told = {(problem.kind, problem.detail) for problem in shape_problems(variant, {})[1]}
        assert _reached(first) <= told <= _reached(broken), row
        found.update(rule.code for rule in first)
    assert set(found) == {rule.code for rule in LENGTHS}


def _room(gap, variant):
    """Return how far a gap is open [m]."""
    return sum(factor * variant.dimensions[name] for name, factor in gap.factors.items())


def _reached(rules):
    """Return kind and words of what these rules say at the limits."""
    return {(rule.reached.kind, rule.reached.words) for rule in rules}


@pytest.mark.slow
def test_no_refused_part_has_a_half_section():
    """What the rules of lengths refuse closes to no half-section, and hundreds of sound rows do close."""
    closed = Counter()
    for row in filter(_makes_a_row, NUMBERS):
        if "disk_hub_thickness" in row.entries:
            continue
        rule = first_broken(LENGTHS, row)
        is_closed = section_problem(row.type, _variant(row).dimensions) is None
        closed[rule.code if rule else "", is_closed] += 1
    assert {code for code, is_closed in closed if is_closed} == {""}
    assert closed["", True] > 300


def test_rules_stand_in_order():
    """Ids are unique, codes are in the catalogue, and a rule stands after those that silence it."""
    ids = [rule.id for rule in PART_RULES]
    assert len(set(ids)) == len(ids)
    before = set()
    for rule in PART_RULES:
        assert rule.code in CATALOGUE
        assert set(rule.after) <= before, rule.id
        before.add(rule.code)
