"""Entries that may stand in a cell and are hardly meant: slipped units, wide tolerances, odd limits and torques."""

from pathlib import Path

import pytest

from flexlash.pipeline import check
from flexlash.schema.columns import columns_of
from flexlash.schema.findings import spelled_out

HAT = {"flexspline_type": "hat", "disk_inner_radius_mm": "", "disk_outer_radius_mm": 120}
TUBE = {"flexspline_type": "cylinder", "disk_inner_radius_mm": ""}
BORE = {"mean_radius_mm": "", "bore_diameter_mm": 160}
FULL = {
    "disk_thickness_mm": 1.6,
    "disk_hub_thickness_mm": 3,
    "hub_fillet_radius_mm": 3.5,
    "junction_fillet_radius_mm": 3.5,
    "rim_length_mm": 25,
    "rim_thickness_mm": 3.2,
}
DATA = Path(__file__).parents[2] / "data"
STEEL = {"youngs_modulus_GPa": 211, "poisson_ratio": 0.3, "yield_MPa": 1080}
OWN = {"W418", "W419", "W420", "W421", "W422", "W423", "W424", "W440", "W441"}


@pytest.fixture
def judge(table, tmp_path, sound):
    """Return a function that checks changed rows in a class of the given tolerance rows and gives the outcome.

    Class standard scatters nothing there, so that a class may be as short as a test needs it.
    """

    def judged(*changes, tolerances=(), materials=None):
        options = {}
        rows = [{**sound, "variant": f"V{number}", **change} for number, change in enumerate(changes, start=1)]
        for name, text in (
            ("tolerances", ["tolerance_class,dimension,lower_deviation,upper_deviation,deviation_unit,grade"]),
            ("materials", [",".join(columns_of("Materials"))]),
        ):
            classes = [*(f"own,{line}" for line in tolerances), "standard,torque,0,0,,"] if tolerances else []
            own = {"tolerances": classes, "materials": materials or []}[name]
            if own:
                options[name] = tmp_path / f"{name}.csv"
                options[name].write_text("\n".join(text + own), encoding="utf-8")
        if tolerances:
            rows = [{**row, "tolerance_class": "own"} for row in rows]
        return check(table(rows), **options)

    return judged


def _material(**values):
    record = {"material": "20Cr2Ni4", **STEEL, **values}
    return [",".join(str(record.get(key, "")) for key in columns_of("Materials"))]


def _told(outcome):
    return [(found.code, found.column, found.suggestion) for found in outcome.findings]


@pytest.mark.parametrize("change", [{}, HAT, TUBE, BORE, FULL, FULL | BORE], ids=str)
@pytest.mark.parametrize("radius", [5, 20, 80, 150, 300])
def test_parts_of_every_size_are_plausible(judge, sound, change, radius):
    """A cup, hat, cylinder and cup in full detail of 5 to 300 mm radius with plausible shares has no finding."""
    row = {**sound, **change}
    lengths = {key: row[key] * radius / 80 for key in row if key.endswith("_mm") and row[key] != ""}
    exact = ["poisson_ratio,-0.01,0.01,-,"]
    assert _told(judge({**change, **lengths, "torque_Nm": 800 * (radius / 80) ** 3}, tolerances=exact)) == []


@pytest.mark.parametrize(("length", "wall"), [(0.3, 0.012), (3, 0.012), (0.3, 0.2), (3, 0.2)])
@pytest.mark.parametrize("radius", [5, 300])
@pytest.mark.parametrize("hub", [0.1, 0.95])
def test_unusual_parts_have_no_slip(judge, length, wall, radius, hub):
    """Short, long, thin and thick parts with small and large hubs are never taken for a slip of units."""
    change = {
        "mean_radius_mm": radius,
        "cylinder_length_mm": length * radius,
        "wall_thickness_mm": wall * radius,
        "disk_inner_radius_mm": hub * (1 - wall / 2) * radius,
        "torque_Nm": 800 * (radius / 80) ** 3,
    }
    assert "W420" not in {found.code for found in judge(change).findings}


@pytest.mark.parametrize(
    ("base", "key", "value", "meant"),
    [
        ({}, "wall_thickness_mm", 0.0016, "1.6"),
        ({}, "wall_thickness_mm", 1600, "1.6"),
        ({}, "cylinder_length_mm", 0.16, "160"),
        ({}, "cylinder_length_mm", 160000, "160"),
        ({}, "mean_radius_mm", 80000, "80"),
        ({}, "disk_inner_radius_mm", 0.04, "40"),
        (TUBE, "wall_thickness_mm", 0.0016, "1.6"),
        (TUBE, "cylinder_length_mm", 0.16, "160"),
        (TUBE, "mean_radius_mm", 0.08, "80"),
        (TUBE, "mean_radius_mm", 80000, "80"),
        (HAT, "wall_thickness_mm", 1600, "1.6"),
        (HAT, "disk_outer_radius_mm", 120000, "120"),
        (BORE, "bore_diameter_mm", 160000, "160"),
        (BORE, "wall_thickness_mm", 0.0016, "1.6"),
        (FULL, "disk_thickness_mm", 0.0016, "1.6"),
        (FULL, "disk_hub_thickness_mm", 3000, "3"),
        (FULL, "hub_fillet_radius_mm", 0.0035, "3.5"),
        (FULL, "junction_fillet_radius_mm", 0.0035, "3.5"),
        (FULL, "rim_length_mm", 0.025, "25"),
        (FULL, "rim_thickness_mm", 3200, "3.2"),
    ],
)
def test_a_length_slipped_by_1000(judge, base, key, value, meant):
    """A length in metres or micrometres has one finding at its cell, with the value that was meant."""
    outcome = judge({**base, key: value}, tolerances=["poisson_ratio,-0.01,0.01,-,"])
    (found,) = outcome.findings
    times = "too small" if float(meant) > value else "too large"
    assert (found.column, found.suggestion) == (key, meant)
    assert found.message.endswith(f"did you mean {meant}?")
    assert found.code in {"W420", "E324", "E329", "E330"}
    assert found.code in {"E324", "E330"} or f"= {spelled_out(value)} mm is about 1000 times {times}" in found.message
    assert found.variant == "V1"
    assert outcome.results["status"].to_list() == ["warning" if found.code == "W420" else "error"]


@pytest.mark.parametrize(
    ("change", "code", "column", "meant"),
    [
        ({"disk_inner_radius_mm": 40000}, "E303", "disk_inner_radius_mm", "40"),
        (FULL | {"rim_length_mm": 25000}, "E305", "rim_length_mm", "25"),
        (FULL | {"rim_thickness_mm": 0.0032}, "E306", "rim_thickness_mm", "3.2"),
        (FULL | {"hub_fillet_radius_mm": 3500}, "E312", "hub_fillet_radius_mm", "3.5"),
        (TUBE | {"mean_radius_mm": 0.08, "wall_thickness_mm": 0.5}, "E329", "mean_radius_mm", "80"),
        ({"wall_thickness_mm": 1600}, "E330", "wall_thickness_mm", "1.6"),
        (FULL | {"wall_thickness_mm": 1600}, "E330", "wall_thickness_mm", "1.6"),
    ],
)
def test_an_error_at_a_slipped_cell_asks_for_the_meant_value(judge, change, code, column, meant):
    """Where the slip is an error already, that error alone stands at the cell, with the suggestion."""
    outcome = judge(change, tolerances=["poisson_ratio,-0.01,0.01,-,"])
    assert [one for one in _told(outcome) if one[0][0] == "E"] == [(code, column, meant)]
    assert [found.column for found in outcome.findings].count(column) == 1


def test_the_limits_of_a_slipped_wall(judge):
    """A wall of 0.0016 mm, whose grade reaches 0, is one error with the meant value."""
    assert _told(judge({"wall_thickness_mm": 0.0016})) == [("E314", "wall_thickness_mm", "1.6")]


@pytest.mark.parametrize(
    ("change", "column", "meant"),
    [
        ({"mean_radius_mm": 0.08}, "mean_radius_mm", "80"),
        (FULL | {"mean_radius_mm": 0.08}, "mean_radius_mm", "80"),
        (FULL | {"cylinder_length_mm": 0.16}, "cylinder_length_mm", "160"),
    ],
)
def test_a_slip_that_contradicts_a_sound_cell(judge, change, column, meant):
    """A radius in metres makes no part with its hub: one error stands at the radius, none at the hub."""
    outcome = judge(change, tolerances=["poisson_ratio,-0.01,0.01,-,"])
    assert _told(outcome) == [("E329", column, meant)]
    assert outcome.counts["computed"] == 0


def test_a_whole_row_in_metres(judge):
    """A row whose every length is in metres has one finding at each of them."""
    row = {"cylinder_length_mm": 0.16, "mean_radius_mm": 0.08, "wall_thickness_mm": 0.0016}
    outcome = judge({**row, "disk_inner_radius_mm": 0.04}, tolerances=["poisson_ratio,-0.01,0.01,-,"])
    meant = {"cylinder_length_mm": "160", "wall_thickness_mm": "1.6", "disk_inner_radius_mm": "40"}
    meant["mean_radius_mm"] = "80"
    assert {column: suggestion for _, column, suggestion in _told(outcome)} == meant
    assert len(outcome.findings) == 4


def test_a_row_that_says_nothing_of_its_size(judge):
    """Where as many lengths are odd as agree, nobody is accused."""
    outcome = judge(TUBE | {"cylinder_length_mm": 0.16, "wall_thickness_mm": 60})
    assert "W420" not in {found.code for found in outcome.findings}


def test_a_slip_under_a_header_in_another_unit(table, sound, tmp_path):
    """The suggestion is in the unit of the cell's own header, and the message says both values."""
    row = {"wall_thickness [m]" if key == "wall_thickness_mm" else key: value for key, value in sound.items()}
    exact = tmp_path / "exact.csv"
    exact.write_text("tolerance_class,dimension,grade\nstandard,mean_radius,IT7\n", encoding="utf-8")
    outcome = check(table([{**row, "wall_thickness [m]": 1.6e-6}]), tolerances=exact)
    (found,) = [found for found in outcome.findings if found.level != "info"]
    assert (found.code, found.value, found.suggestion) == ("W420", "1.6e-06", "0.0016")
    assert "= 1.6e-06 (0.0016 mm) is about 1000 times too small" in found.message


@pytest.mark.parametrize(
    ("key", "value", "meant"),
    [
        ("youngs_modulus_GPa", 211000, "211"),
        ("youngs_modulus_GPa", 2.11e11, "211"),
        ("shear_modulus_GPa", 81000, "81"),
        ("shear_modulus_GPa", 8.1e10, "81"),
        ("yield_MPa", 1.08, "1080"),
        ("yield_MPa", 1.08e9, "1080"),
        ("youngs_modulus_GPa", 2400, "2.4"),
    ],
)
def test_a_slipped_material(judge, key, value, meant):
    """A modulus in MPa or Pa, or a yield strength in GPa or Pa, is told once, at its material, for all rows."""
    outcome = judge({}, {}, materials=_material(**{key: value}))
    assert _told(outcome) == [("W420", key, meant)]
    assert outcome.findings[0].sheet == "Materials"
    assert outcome.findings[0].message.endswith(f"for any material; did you mean {meant}?")


def test_a_slipped_material_beyond_all_meaning(judge):
    """Where the slip leaves no meaningful backlash, that one error stands at the material, and stops its rows."""
    rows = [{"torque_Nm": 8}, {"torque_Nm": 9}, {}]
    outcome = judge(*rows, materials=_material(youngs_modulus_GPa=2.11e11))
    assert _told(outcome) == [("E324", "youngs_modulus_GPa", "211")]
    assert outcome.results["status"].to_list() == ["error", "error", "ok"]
    assert all("E324" in listed for listed in outcome.results["findings"][:2])
    assert outcome.results["findings"][2] is None


@pytest.mark.parametrize(
    "values",
    [
        {"youngs_modulus_GPa": 1200, "yield_MPa": 10000},
        {"youngs_modulus_GPa": 2.4, "yield_MPa": 6000},
        {"youngs_modulus_GPa": 0.5, "yield_MPa": 6000},
    ],
)
def test_real_materials_are_plausible(judge, values):
    """Diamond and plastics are no slips of units."""
    assert "W420" not in {found.code for found in judge({}, materials=_material(**values)).findings}


def test_a_slipped_modulus_silences_its_disagreement(judge):
    """E in MPa does not also disagree with G."""
    materials = _material(youngs_modulus_GPa=211000, shear_modulus_GPa=81.1538)
    assert _told(judge({}, materials=materials)) == [("W420", "youngs_modulus_GPa", "211")]


@pytest.mark.parametrize("base", [{}, HAT, TUBE], ids=["cup", "hat", "cylinder"])
@pytest.mark.parametrize("key", ["torque_Nm", "rated_torque_Nm"])
def test_a_torque_in_newton_millimetres(judge, base, key):
    """A thousandfold torque that no wall bears is told as such, and not also as yield or buckling."""
    assert _told(judge({**base, key: 800_000})) == [("W420", key, "800")]


@pytest.mark.parametrize("key", ["torque_Nm", "rated_torque_Nm"])
@pytest.mark.parametrize("base", [{}, HAT, TUBE, BORE], ids=["cup", "hat", "cylinder", "bore"])
def test_a_torque_in_kilonewton_metres(judge, base, key):
    """A torque of 0.8 on a drive for 800 N·m is told with the thousandfold, and computed as entered."""
    outcome = judge({**base, key: 0.8})
    assert _told(outcome) == [("W420", key, "800")]
    assert "= 0.8 N·m is about 1000 times too small for this radius" in outcome.findings[0].message
    assert outcome.counts["computed"] == 1


@pytest.mark.parametrize("factor", [10, 25.4])
@pytest.mark.parametrize("base", [{}, HAT, TUBE, BORE, FULL], ids=["cup", "hat", "cylinder", "bore", "full"])
def test_lengths_in_another_unit(judge, sound, base, factor):
    """Lengths that all are in cm or inches do not blame the torque alone: the unit of the lengths is told, once."""
    lengths = {key: value / factor for key, value in (sound | base).items() if key.endswith("_mm") and value != ""}
    outcome = judge({**base, **lengths}, tolerances=["poisson_ratio,-0.01,0.01,-,"])
    (found,) = [found for found in outcome.findings if found.code in {"W420", "E324"}]
    assert (found.column, found.suggestion) == ("bore_diameter_mm" if base is BORE else "mean_radius_mm", "")
    assert "torque_Nm" not in {found.column for found in outcome.findings}
    assert found.code == "E324" or "check the unit of all lengths" in found.message


@pytest.mark.parametrize("torque", [5, 74_000])
def test_a_torque_that_may_be_meant(judge, torque):
    """A small torque, or one that only a stout part would bear, is no slip of units."""
    assert "W420" not in {found.code for found in judge({"torque_Nm": torque}).findings}


@pytest.mark.parametrize("base", [{}, HAT, TUBE], ids=["cup", "hat", "cylinder"])
@pytest.mark.parametrize(
    ("tolerance", "expected"),
    [
        ("wall_thickness,-0.16,0.16,mm,", []),
        ("wall_thickness,-0.161,0.16,mm,", [("W421", "wall_thickness_mm", "10")]),
        ("wall_thickness,0,0.321,mm,", [("W421", "wall_thickness_mm", "10")]),
        ("cylinder_length,-11,11,%,", [("W421", "cylinder_length_mm", "11")]),
        ("mean_radius,-10,10,%,", []),
        ("torque,-100,100,N·m,", [("W421", "torque_Nm", "12.5")]),
        ("youngs_modulus,-10,10,%,", []),
        ("youngs_modulus,-10.1,10.1,%,", [("W421", "material", "10.1")]),
        ("poisson_ratio,-0.04,0.04,-,", [("W421", "material", "13.3")]),
        ("cylinder_calibration,-0.3,0.3,-,", []),
        ("wall_thickness,,,,2768-f", [("W422", "wall_thickness_mm", "3.12")]),
        ("wall_thickness,,,,2768-c", [("W422", "wall_thickness_mm", "12.5")]),
        ("wall_thickness,,,,IT12", []),
        ("cylinder_length,,,,2768-v", []),
    ],
)
def test_wide_tolerances(judge, base, tolerance, expected):
    """Limits wider than 10 % of a dimension, or 2 % by ISO 2768 on a thickness, are told once with their width."""
    outcome = judge(base, tolerances=[tolerance])
    assert [(found.code, found.column) for found in outcome.findings] == [one[:2] for one in expected]
    for found, (_, _, width) in zip(outcome.findings, expected, strict=True):
        assert f"± {width}" in found.message


@pytest.mark.parametrize(
    ("dimension", "value", "told"),
    [
        ("wall_thickness", 2.5, False),
        ("wall_thickness", 2.49, True),
        ("disk_thickness", 2.5, False),
        ("disk_thickness", 2.49, True),
        ("disk_hub_thickness", 2.5, False),
        ("disk_hub_thickness", 2.49, True),
        ("rim_thickness", 2.5, False),
        ("rim_thickness", 2.49, True),
    ],
)
def test_a_general_tolerance_on_a_thin_part(judge, dimension, value, told):
    """2768-f, ± 0.05 mm, is 2 % of 2.5 mm: thinner walls, disks, hubs and rims are told."""
    changes = {"rim_length_mm": 20, "rim_thickness_mm": 3} if dimension == "rim_thickness" else {}
    outcome = judge({**changes, f"{dimension}_mm": value}, tolerances=[f"{dimension},,,,2768-f"])
    assert _told(outcome) == [("W422", f"{dimension}_mm", "")][:told]


def test_standard_fillets_are_at_the_edge(judge):
    """Fillets of the class standard have exactly ± 10 %, and are not told."""
    assert _told(judge(FULL, FULL | {"hub_fillet_radius_mm": 1.7}, FULL | {"hub_fillet_radius_mm": 0})) == []


@pytest.mark.parametrize(
    ("tolerance", "code"),
    [("wall_thickness,-0.7,0.7,mm,", "W405"), ("wall_thickness,-1.7,0.7,mm,", "E314")],
)
def test_a_stronger_word_on_the_limits_stands_alone(judge, tolerance, code):
    """Limits whose tail is cut, or that are impossible, are not also told as wide."""
    assert _told(judge({}, tolerances=[tolerance])) == [(code, "wall_thickness_mm", "")]


@pytest.mark.parametrize(
    ("change", "tolerance", "column"),
    [
        ({"wall_thickness_mm": 0.5}, "wall_thickness,-0.6,0.6,mm,", "wall_thickness_mm"),
        ({"disk_inner_radius_mm": 79}, "disk_inner_radius,-2,2,mm,", "disk_inner_radius_mm"),
    ],
)
def test_an_error_of_the_limits_stands_alone(judge, change, tolerance, column):
    """A wall or hub whose limits are impossible is not also told as unusual."""
    assert [found.code for found in judge(change, tolerances=[tolerance]).findings if found.column == column] == [
        "E314"
    ]


@pytest.mark.parametrize(("limit", "told"), [(3.687, False), (3.6869, True), ("", False)])
def test_a_limit_below_the_nominal_backlash(judge, limit, told):
    """A limit below the nominal 3.68700 arcmin is told with both numbers."""
    outcome = judge({"backlash_limit_arcmin": limit})
    assert _told(outcome) == [("W423", "backlash_limit_arcmin", "")][:told]
    if told:
        assert "= 3.6869 arcmin is below the nominal backlash 3.687 arcmin" in outcome.findings[0].message


@pytest.mark.parametrize("base", [{}, HAT, TUBE], ids=["cup", "hat", "cylinder"])
@pytest.mark.parametrize(
    ("radius", "torque", "told"),
    [(31.75, 408, False), (31.75, 408.1, True), (17.78, 71, True), (114.3, 11300, False), (114.4, 12000, False)],
)
def test_a_torque_above_catalogue_drives(judge, base, radius, torque, told):
    """More than the momentary peak of the nearest size is told, where the part is strong enough for it."""
    outer = {"disk_outer_radius_mm": 1.5 * radius} if base is HAT else {}
    part = {"mean_radius_mm": radius, "torque_Nm": torque, "backlash_limit_arcmin": ""} | outer
    part |= {"wall_thickness_mm": 0.04 * radius, "cylinder_length_mm": radius}
    part |= {} if outer or base is TUBE else {"disk_inner_radius_mm": radius / 2}
    outcome = judge(base | part)
    assert _told(outcome) == [("W424", "torque_Nm", "")][:told]
    if told:
        size, listed = {31.75: (25, 408), 17.78: (14, 70)}[radius]
        assert (
            f"= {torque:g} N·m exceeds {listed:g} N·m, the momentary peak allowed to catalogue drives of size {size}"
            in (outcome.findings[0].message)
        )


def test_yield_outweighs_the_catalogue(judge):
    """A torque beyond yield is told as that alone."""
    assert _told(judge({"torque_Nm": 12000, "backlash_limit_arcmin": ""})) == [("W402", "torque_Nm", "")]


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("b3-160-calibrated", []),
        ("b3-160-proof", ["W423 Y5", "W423 Y6", "W423 Y7"]),
        ("b3-160-study", ["W423 Y7", "W423 Y9", "W423 Y10"]),
        ("catalogue-sizes", ["W423 Y17"]),
        ("needs-fixing", []),
    ],
)
def test_the_examples_are_plausible(name, expected):
    """The shipped examples have limits below nominal and nothing else."""
    found = check(DATA / f"{name}.xlsx").findings
    assert [f"{one.code} {one.cell}" for one in found if one.code in OWN] == expected


@pytest.mark.parametrize("value", [0, -80, 1e-300, 1e300, 5e-324, 1.7e308])
@pytest.mark.parametrize("key", ["mean_radius_mm", "wall_thickness_mm", "cylinder_length_mm", "torque_Nm"])
def test_absurd_entries_are_told(judge, key, value):
    """A number that no computation holds has a finding at some cell, and neither stops the check nor has two there."""
    cells = [found.cell for found in judge({key: value}).findings if found.level == "error"]
    assert cells
    assert len(set(cells)) == len(cells)


def test_a_bad_cell_is_no_measure(judge):
    """A radius with an error of its own accuses no other length."""
    assert _told(judge({"mean_radius_mm": "x"})) == [("E202", "mean_radius_mm", "")]


def test_findings_change_no_number(judge):
    """A row with every warning gives the numbers of its formula, as a sound row does."""
    slipped = judge({"wall_thickness_mm": 0.0016}, tolerances=["poisson_ratio,-0.01,0.01,-,"]).results
    plain = judge({}, tolerances=["poisson_ratio,-0.01,0.01,-,"]).results
    assert slipped["cylinder_windup_rad"][0] == pytest.approx(plain["cylinder_windup_rad"][0] * 1000, rel=1e-12)


def test_many_slips_are_found_in_linear_time(judge):
    """Three hundred rows in metres give their findings once each."""
    outcome = judge(*[TUBE | {"cylinder_length_mm": 0.16}] * 300, tolerances=["poisson_ratio,-0.01,0.01,-,"])
    assert len(outcome.findings) == 300
