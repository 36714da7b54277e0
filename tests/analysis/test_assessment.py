"""What only limits and numbers can show: impossible shapes, missing grades, cut tails, yield, calibrations."""

from dataclasses import replace

import openpyxl
import pytest

from flexlash.analysis.assessment import assess
from flexlash.pipeline import check, run

BORE = {"mean_radius_mm": "", "bore_diameter_mm": 128}
PLAUSIBILITY = {f"W{number}" for number in (*range(418, 425), 440, 441)}
"""What `test_plausibility` looks at; odd rows that serve other rules have such findings as well."""

ALONE = PLAUSIBILITY | {"E314", "E315", "W402", "W403", "W405", "W407", "W411", "W412", "W415", "W460", "I506"}


@pytest.fixture
def judge(table, tmp_path, sound):
    """Return a function that checks changed rows in a class of the given tolerance rows and gives the outcome.

    Class standard scatters nothing there, so that a class may be as short as a test needs it.
    """

    def judged(*changes, tolerances=(), materials=None):
        options = {}
        rows = [{**sound, "variant": f"V{number}", **change} for number, change in enumerate(changes, start=1)]
        if tolerances:
            rows = [{**row, "tolerance_class": "own"} for row in rows]
            options["tolerances"] = tmp_path / "tolerances.csv"
            lines = ["tolerance_class,dimension,lower_deviation,upper_deviation,deviation_unit,grade,distribution"]
            lines += [*(f"own,{line}" for line in tolerances), "standard,torque,0,0,,,"]
            options["tolerances"].write_text("\n".join(lines), encoding="utf-8")
        if materials:
            options["materials"] = tmp_path / "materials.csv"
            options["materials"].write_text(materials, encoding="utf-8")
        return check(table(rows), **options)

    return judged


def _found(outcome):
    """Return code and column of the findings that only assessment and the wall's proportion can give, doubts aside."""
    assert {found.code for found in outcome.findings} <= ALONE
    return [(found.code, found.column) for found in outcome.findings if found.code not in PLAUSIBILITY]


def test_a_sound_row_has_nothing_to_tell(judge):
    """The published case in the standard class has no engineering finding."""
    outcome = judge({})
    assert outcome.findings == ()
    assert outcome.results["status"].to_list() == ["ok"]
    assert outcome.exit_code == 0


@pytest.mark.parametrize(("strength", "told"), [(86.15, False), (86.14, True)])
def test_beyond_yield(judge, strength, told):
    """A von Mises stress above the yield strength is a warning: 800 N·m give 86.145 MPa."""
    materials = f"material,youngs_modulus_GPa,poisson_ratio,yield_MPa\n20Cr2Ni4,211,0.3,{strength}\n"
    outcome = judge({}, materials=materials)
    assert _found(outcome) == [("W402", "torque_Nm")][:told]
    assert outcome.results["status"].to_list() == ["warning" if told else "ok"]
    assert outcome.results["backlash_arcmin"][0] > 0
    assert outcome.exit_code == 0
    if told:
        (found,) = outcome.findings
        assert found.place == "Variants!D2"
        assert found.variant == "V1"
        assert (
            found.message == "Variants!D2: von Mises stress 86.15 MPa in the disk exceeds the yield strength 86.14 MPa."
        )


def test_the_governing_section_is_named(judge):
    """The section that yields first is named: the disk of a cup, the wall of a tube."""
    tube = {"flexspline_type": "cylinder", "disk_inner_radius_mm": "", "torque_Nm": 45000}
    for change, section in (({"torque_Nm": 12000}, "disk"), (tube, "wall")):
        found = next(found for found in judge(change).findings if found.code == "W402")
        assert f"in the {section} exceeds" in found.message


@pytest.mark.parametrize(("wall", "told"), [(0.18, True), (0.2, False)])
def test_a_wall_that_buckles(judge, wall, told):
    """A wall shear above the buckling stress of NASA SP-8007 is a warning; both stresses are said."""
    outcome = judge({"wall_thickness_mm": wall, "disk_thickness_mm": 1.6, "torque_Nm": 300})
    buckling = [found for found in outcome.findings if found.code == "W411"]
    assert len(buckling) == told
    row = outcome.results.row(0, named=True)
    assert (row["wall_shear_MPa"] > row["buckling_shear_MPa"]) == told
    if told:
        assert buckling[0].column == "torque_Nm"
        assert f"{row['wall_shear_MPa']:.4g} MPa" in buckling[0].message
        assert f"{row['buckling_shear_MPa']:.4g} MPa" in buckling[0].message


def test_buckling_needs_e_and_nu(judge):
    """Of a material known by its shear modulus alone no buckling stress is given, and none is missed."""
    materials = "material,shear_modulus_GPa\n20Cr2Ni4,81\n"
    outcome = judge({"wall_thickness_mm": 0.1, "disk_thickness_mm": 1.6, "torque_Nm": 300}, materials=materials)
    assert outcome.results["buckling_shear_MPa"].to_list() == [None]
    assert outcome.results["buckling_range"].to_list() == [None]
    assert "W411" not in {found.code for found in outcome.findings}


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({}, False),
        ({"wall_thickness_mm": 0.9, "disk_thickness_mm": 0.9, "disk_inner_radius_mm": 20}, True),
        ({"wall_thickness_mm": 0.9, "disk_thickness_mm": 0.9, "disk_inner_radius_mm": 20} | BORE, True),
        ({"wall_thickness_mm": 0.16, "disk_thickness_mm": 0.16, "mean_radius_mm": 130}, False),
    ],
)
def test_softer_than_a_whole_drive(judge, change, told):
    """A cup softer than drives of its size is a warning at its radius; beyond the catalogue's sizes nothing is said."""
    outcome = judge(change)
    row = outcome.results.row(0, named=True)
    assert [found.code for found in outcome.findings].count("W412") == told
    if told:
        found = next(found for found in outcome.findings if found.code == "W412")
        assert found.column == ("bore_diameter_mm" if "bore_diameter_mm" in change else "mean_radius_mm")
        assert f"size {row['catalogue_size']:.0f}" in found.message
        assert row["stiffness_Nm_per_rad"] < row["catalogue_stiffness_Nm_per_rad"]
    else:
        listed = row["catalogue_stiffness_Nm_per_rad"]
        assert listed is None or listed < row["stiffness_Nm_per_rad"]


@pytest.mark.parametrize(("inertia", "told"), [(1.75, False), (1.85, True)])
def test_resonance_within_usual_speeds(judge, inertia, told):
    """Whole drives have 710,000 N·m/rad at 80 mm radius: from 1.80 kg·m² on they may resonate below 3000 rpm."""
    outcome = judge({"load_inertia_kg_m2": inertia})
    row = outcome.results.row(0, named=True)
    assert row["natural_frequency_Hz"] == pytest.approx(194.39 / inertia**0.5, rel=1e-4)
    assert row["resonance_speed_rpm"] == pytest.approx(30 * row["natural_frequency_Hz"], rel=1e-12)
    assert _found(outcome) == [("W415", "load_inertia_kg_m2")][:told]
    if told:
        low = 30 * (780_000 * (160 / 165.1) ** 3 / inertia) ** 0.5 / (2 * 3.141592653589793)
        span = [f"{float(f'{speed:.2g}'):.0f}" for speed in (low, row["resonance_speed_rpm"])]
        assert f"at {' to '.join(span)} rpm" in outcome.findings[0].message


@pytest.mark.parametrize(("deflection", "told"), [(5.55, False), (5.65, True)])
def test_bending_that_may_tire_the_part(judge, deflection, told):
    """20Cr2Ni4 yields at 1080 MPa: a wall of 1.6 mm at 80 mm may tire from 432 MPa on, a deflection of 5.59 mm."""
    outcome = judge({"radial_deflection_mm": deflection})
    row = outcome.results.row(0, named=True)
    bent = 1.5 * 211e3 * 1.6 * deflection / (80**2 * 0.91)
    assert row["bending_stress_MPa"] == pytest.approx(bent, rel=1e-12)
    assert row["alternating_stress_MPa"] == pytest.approx(bent * 0.79**0.5, rel=1e-12)
    assert (row["alternating_stress_MPa"] > 0.4 * 1080) is told
    assert _found(outcome) == [("W460", "radial_deflection_mm")][:told]


def test_resonance_beyond_the_catalogue(judge):
    """Where no drive is listed the resonance is that of the flexspline alone."""
    outcome = judge({"load_inertia_kg_m2": 1e4, "mean_radius_mm": 130})
    (found,) = [one for one in outcome.findings if one.code == "W415"]
    assert f" at {outcome.results['resonance_speed_rpm'][0]:.2g} rpm." in found.message


def test_without_a_yield_strength(judge):
    """Of a material without yield strength nothing is said, whatever the stress."""
    materials = "material,youngs_modulus_GPa,poisson_ratio\n20Cr2Ni4,211,0.3\n"
    assert _found(judge({"torque_Nm": 20000}, materials=materials)) == []


@pytest.mark.parametrize(
    ("change", "told", "status"),
    [
        ({"wall_thickness_mm": 3.2}, [], "ok"),
        ({"wall_thickness_mm": 8}, [("W418", "wall_thickness_mm")], "warning"),
        ({"wall_thickness_mm": 8.1}, [("I506", "wall_thickness_mm")], "ok"),
        ({"wall_thickness_mm": 16}, [("I506", "wall_thickness_mm")], "ok"),
        ({"wall_thickness_mm": 16.1}, [("W403", "wall_thickness_mm")], "warning"),
        ({"wall_thickness_mm": 14.2} | BORE, [("I506", "wall_thickness_mm")], "ok"),
        ({"wall_thickness_mm": 14.3} | BORE, [("W403", "wall_thickness_mm")], "warning"),
    ],
)
def test_thick_walls(judge, change, told, status):
    """A wall above 0.1 of the mean radius is noted, above 0.2 warned of; both are computed, and told once."""
    outcome = judge(change)
    assert [(found.code, found.column) for found in outcome.findings] == told
    assert outcome.results["status"].to_list() == [status]
    assert outcome.results["backlash_arcmin"][0] > 0


@pytest.mark.parametrize(
    ("tolerance", "told"),
    [
        ("wall_thickness,-0.57,0.57,mm,,normal", False),
        ("wall_thickness,-0.58,0.58,mm,,normal", True),
        ("wall_thickness,-1.5,1.5,mm,,truncated normal", False),
        ("wall_thickness,-1.5,1.5,mm,,uniform", False),
        ("wall_thickness,-1.5,1.5,mm,,triangular", False),
        ("disk_inner_radius,-10.8,10.8,mm,,normal", False),
        ("disk_inner_radius,-10.9,10.9,mm,,normal", True),
    ],
)
def test_a_tail_that_is_cut(judge, tolerance, told):
    """A normal whose middle lies less than 8.3 sigma from an impossible shape is cut there, with a warning."""
    outcome = judge({"disk_inner_radius_mm": 50}, tolerances=[tolerance])
    dimension = tolerance.split(",")[0]
    assert _found(outcome) == [("W405", f"{dimension}_mm")][:told]
    limits = outcome.computed[2].limits[dimension]
    assert (limits.cut is not None) == told
    assert outcome.exit_code == 0


def test_tails_of_hub_and_wall_that_meet(judge):
    """Where the tails of hub and wall could cross, both are cut at one radius between their limits."""
    tolerances = ["disk_inner_radius,-0.1,0.1,mm,,normal", "mean_radius,-0.1,0.1,mm,,normal"]
    outcome = judge({"disk_inner_radius_mm": 79.5}, tolerances=tolerances)
    assert _found(outcome) == [("W405", "mean_radius_mm"), ("W405", "disk_inner_radius_mm")]
    limits = outcome.computed[2].limits
    fence = limits["disk_inner_radius"].cut[1]
    assert fence == limits["mean_radius"].cut[0] == pytest.approx(0.07975, abs=1e-9)
    assert outcome.results["status"].to_list() == ["warning"]


IMPOSSIBLE = [
    ({}, "wall_thickness,-1.6,1.6,mm,,uniform", "wall_thickness_mm", "1.6", "reaches 0."),
    ({}, "wall_thickness,-100,0,%,,uniform", "wall_thickness_mm", "1.6", "reaches 0."),
    ({}, "wall_thickness,-2,1,mm,,normal", "wall_thickness_mm", "1.6", "reaches 0."),
    ({"wall_thickness_mm": 0.02}, "wall_thickness,,,,IT11,normal", "wall_thickness_mm", "0.02", "reaches 0."),
    ({}, "poisson_ratio,-0.2,0.21,-,,uniform", "material", "0.3", "reaches 0.5."),
    ({}, "youngs_modulus,-100,0,%,,uniform", "material", "211", "reaches 0."),
    ({}, "torque,-800,0,N·m,,uniform", "torque_Nm", "800", "reaches 0."),
    (
        {"disk_inner_radius_mm": 79.9},
        "disk_inner_radius,-0.1,0.1,mm,,uniform",
        "disk_inner_radius_mm",
        "79.9",
        "reaches the other radius of the disk.",
    ),
    (
        {"disk_inner_radius_mm": 79.9},
        "mean_radius,-0.1,0.1,mm,,uniform",
        "disk_inner_radius_mm",
        "79.9",
        "reaches the other radius of the disk.",
    ),
    (
        {"flexspline_type": "cylinder", "wall_thickness_mm": 155, "disk_inner_radius_mm": ""},
        "wall_thickness,-5,5,mm,,uniform",
        "wall_thickness_mm",
        "155",
        "reaches the axis: no bore is left.",
    ),
    (
        {"junction_fillet_radius_mm": 79, "cylinder_length_mm": 300},
        "junction_fillet_radius,0,0.3,mm,,uniform",
        "junction_fillet_radius_mm",
        "79",
        "reaches beyond the axis.",
    ),
    (
        {"flexspline_type": "hat", "disk_inner_radius_mm": 90, "disk_outer_radius_mm": 90.1},
        "disk_outer_radius,-0.1,0.1,mm,,uniform",
        "disk_inner_radius_mm",
        "90",
        "reaches the other radius of the disk.",
    ),
]


@pytest.mark.parametrize(("change", "tolerance", "expected"), [(row[0], row[1], row[2:]) for row in IMPOSSIBLE])
def test_limits_that_reach_an_impossible_shape(judge, change, tolerance, expected):
    """A tolerance that reaches a thickness of 0, or brings the hub to the wall, stops the row and says so."""
    column, value, words = expected
    outcome = judge(change, tolerances=[tolerance])
    # A hat's flange off its wall is told as well, and odd proportions.
    (found,) = [one for one in outcome.findings if one.level == "error"]
    assert (found.code, found.column) == ("E314", column)
    assert found.value == value
    assert found.message.endswith(f" = {value}: its tolerance in class own {words}")
    assert outcome.exit_code == 4
    assert outcome.results["status"].to_list() == ["error"]


@pytest.mark.parametrize(
    ("change", "tolerance"),
    [
        ({}, "wall_thickness,-1.599,1.599,mm,,uniform"),
        ({}, "poisson_ratio,-0.2,0.2,-,,uniform"),
        ({"disk_inner_radius_mm": 79.1}, "disk_inner_radius,-0.1,0.099,mm,,uniform"),
        ({"flexspline_type": "cylinder", "disk_inner_radius_mm": ""}, "disk_inner_radius,-90,90,mm,,uniform"),
        ({}, "bore_diameter,-999,0,mm,,uniform"),
        ({}, "disk_thickness,-999,0,mm,,uniform"),
        ({}, "shear_modulus,-999,0,GPa,,uniform"),
    ],
)
def test_limits_that_stay_possible(judge, change, tolerance):
    """Limits just short of an impossible shape, and rows for dimensions that the variant lacks, are no fault."""
    assert _found(judge(change, tolerances=[tolerance])) == []


@pytest.mark.parametrize(
    ("change", "tolerance", "told"),
    [
        ({"mean_radius_mm": 250, "disk_inner_radius_mm": 100}, "mean_radius,,,,IT7,", None),
        ({"mean_radius_mm": 250.1, "disk_inner_radius_mm": 100}, "mean_radius,,,,IT7,", "grade IT7 of class own"),
        ({"cylinder_length_mm": 500}, "cylinder_length,,,,js11,", None),
        ({"cylinder_length_mm": 501}, "cylinder_length,,,,js11,", "grade js11 of class own"),
        ({"wall_thickness_mm": 0.5}, "wall_thickness,,,,2768-f,", None),
        ({"wall_thickness_mm": 0.49}, "wall_thickness,,,,2768-f,", "grade 2768-f of class own"),
        ({"cylinder_length_mm": 2001}, "cylinder_length,,,,2768-f,", "grade 2768-f of class own"),
        ({"cylinder_length_mm": 2001}, "cylinder_length,,,,2768-m,", None),
        ({"cylinder_length_mm": 2.9}, "cylinder_length,,,,2768-v,", "grade 2768-v of class own"),
    ],
)
def test_a_grade_without_entry(judge, change, tolerance, told):
    """A grade that the standard does not tabulate for the size stops the row; at the edge of the table it holds."""
    outcome = judge(change, tolerances=[tolerance])
    column = f"{tolerance.split(',')[0]}_mm"
    # A cylinder of half a metre is softer than a whole drive, which W412 says as well.
    assert [found for found in _found(outcome) if found[0] != "W412"] == [("E315", column)][: bool(told)]
    assert outcome.exit_code == (4 if told else 0)
    assert not told or told in next(found.message for found in outcome.findings if found.code == "E315")


def test_one_row_stops_alone(judge):
    """Of three rows in one class only that whose limits are impossible is stopped."""
    changes = [{}, {"disk_inner_radius_mm": 79}, {"disk_inner_radius_mm": 50}]
    outcome = judge(*changes, tolerances=["disk_inner_radius,-1.5,1.5,mm,,uniform"])
    assert [(found.code, found.cell, found.variant) for found in outcome.findings] == [("E314", "H3", "V2")]
    assert outcome.results["status"].to_list() == ["ok", "error", "ok"]
    assert outcome.results["findings"].to_list() == [None, "E314 H3", None]
    assert outcome.exit_code == 3


def test_every_problem_of_the_limits_at_once(judge):
    """All dimensions whose limits are impossible or untabulated are told together."""
    tolerances = [
        "wall_thickness,-2,2,mm,,uniform",
        "cylinder_length,-200,0,mm,,uniform",
        "mean_radius,,,,IT7,",
    ]
    outcome = judge({"mean_radius_mm": 300}, tolerances=tolerances)
    assert _found(outcome) == [
        ("E314", "cylinder_length_mm"),
        ("E315", "mean_radius_mm"),
        ("E314", "wall_thickness_mm"),
    ]


@pytest.mark.parametrize(
    ("setting", "change", "told"),
    [
        ("cylinder_calibration", {}, None),
        ("cylinder_calibration", {"hub_fillet_radius_mm": 2}, "hub_fillet_radius_mm"),
        ("disk_calibration", {"junction_fillet_radius_mm": 2}, "junction_fillet_radius_mm"),
        ("disk_calibration", {"disk_hub_thickness_mm": 2}, "disk_hub_thickness_mm"),
        ("disk_calibration", {"rim_length_mm": 20, "rim_thickness_mm": 3}, "rim_length_mm"),
        ("disk_calibration", {"hub_fillet_radius_mm": 0, "junction_fillet_radius_mm": 0}, None),
        ("seed", {"hub_fillet_radius_mm": 2}, None),
    ],
)
def test_calibration_with_refinements(tmp_path, sound, setting, change, told):
    """A calibration other than 1 together with a fillet, taper or rim is a warning; both are computed."""
    row = {**sound, "backlash_limit_arcmin": 9, **change}
    book = openpyxl.Workbook()
    book.active.title = "Variants"
    book.active.append(list(row))
    book.active.append(list(row.values()))
    settings = book.create_sheet("Settings")
    settings.append(["Setting", "Value"])
    settings.append([setting, 2])
    path = tmp_path / "a.xlsx"
    book.save(path)
    outcome = check(path)
    assert [found.column for found in outcome.findings if found.code == "W407"] == ([told] if told else [])
    assert {found.code for found in outcome.findings} <= {"I505", "W407"}
    assert outcome.results["status"].to_list() == ["warning" if told else "ok"]
    assert outcome.exit_code == 0


def test_a_hat_whose_wall_reaches_its_bolt_circle(judge):
    """A hat with a blank inner radius whose mean radius may reach the bolt circle is stopped with a finding."""
    change = {"flexspline_type": "hat", "disk_inner_radius_mm": "", "disk_outer_radius_mm": 80.05}
    outcome = judge(change, tolerances=["mean_radius,-0.1,0.1,mm,,uniform"])
    assert [found.code for found in outcome.findings] == ["E314"]
    assert outcome.exit_code == 4


def test_findings_need_a_table(judge):
    """A finding about a variant whose table is gone is a fault of the program, and loud."""
    outcome = judge({"torque_Nm": 20_000})
    with pytest.raises(LookupError):
        assess(replace(outcome.validated, table=None), outcome.settings)


@pytest.mark.parametrize("change", [{"rim_length_mm": 159.9, "rim_thickness_mm": 3}])
@pytest.mark.parametrize("tolerance", ["rim_length,-0.2,0.2,mm,,uniform", "cylinder_length,-0.2,0.2,mm,,uniform"])
def test_a_rim_that_may_outgrow_the_cylinder(judge, change, tolerance):
    """Limits at which the tooth rim is longer than the cylinder are computed, and told."""
    assert "W409" in {found.code for found in judge(change, tolerances=[tolerance]).findings}


def test_a_tail_cut_at_both_ends_is_told_once(judge):
    """A hub whose tails reach both 0 and the wall has one finding."""
    outcome = judge({}, tolerances=["disk_inner_radius,-15,15,mm,,normal"])
    assert _found(outcome) == [("W405", "disk_inner_radius_mm")]


def test_a_wall_that_reaches_0_in_decimals(judge):
    """A wall of 0.02 mm with ± 0.02 mm from its grade reaches 0, whatever the last binary digit says."""
    outcome = judge({"wall_thickness_mm": 0.02}, tolerances=["wall_thickness,,,,IT10,uniform"])
    assert "E314" in {found.code for found in outcome.findings}


@pytest.mark.parametrize("torque", [1e300, 5e-324])
def test_a_size_that_no_computation_holds(table, sound, torque):
    """A torque so large or small that squares and quotients lose it is told in its row, and others are computed."""
    outcome = run(table([{**sound, "torque_Nm": torque}, {**sound, "variant": "B"}]), samples=16)
    assert "D2" in {found.cell for found in outcome.findings if found.level == "error"}
    assert outcome.results["status"].to_list() == ["error", "ok"]


def test_a_faulty_class_that_nobody_uses(table, sound, tmp_path):
    """An error in a class that no row names stops no row, but the exit code is never 0 where an error stands."""
    beside = tmp_path / "tolerances.csv"
    beside.write_text("tolerance_class,dimension,grade\nunused,wall_thickness,IT13\n")
    outcome = check(table([sound]), tolerances=beside)
    assert outcome.results["status"].to_list() == ["ok"]
    assert outcome.exit_code == 3


SHOP = ["wall_thickness,-0.0125,0.0125,mm,,normal"]
OTHERS = "Cylinder length, Mean radius, Disk inner radius, Young's modulus, Poisson's ratio"


def _exact(outcome):
    return [(found.place, found.message) for found in outcome.findings if found.code == "W438"]


@pytest.fixture
def shop(table, tmp_path, sound):
    """Return a function that checks rows in classes of their own beside the built-in class standard."""

    def checked(rows, *lines):
        path = tmp_path / "tolerances.csv"
        head = "tolerance_class,dimension,lower_deviation,upper_deviation,deviation_unit,grade,distribution"
        path.write_text("\n".join([head, *lines]), encoding="utf-8")
        rows = [sound | {"variant": f"V{number}", "tolerance_class": "shop"} | row for number, row in enumerate(rows)]
        return check(table(rows), tolerances=path)

    return checked


def test_a_class_that_leaves_dimensions_exact_is_told_once(shop):
    """A class that lists the wall alone is one warning at its first row, however many variants use it."""
    outcome = shop([{}, {}], "other,rim_length,-1,1,,,", *(f"shop,{line}" for line in SHOP), "shop,torque,-1,1,,,")
    ((place, message),) = _exact(outcome)
    assert place == "Tolerances!A3"
    assert f'class "shop" has no row for {OTHERS}, which class standard scatters; taken as exact.' in message
    assert outcome.exit_code == 0


@pytest.mark.parametrize(
    ("change", "less", "more"),
    [
        ({"mean_radius_mm": "", "bore_diameter_mm": 158.4}, "Mean radius", "Bore diameter"),
        ({"disk_thickness_mm": 1.6}, "", "Disk thickness"),
        ({"disk_outer_radius_mm": 80}, "", "Disk outer radius"),
        ({"flexspline_type": "cylinder", "disk_inner_radius_mm": ""}, "Disk inner radius", ""),
        ({"hub_fillet_radius_mm": 3}, "", "Hub fillet radius"),
        ({"hub_fillet_radius_mm": 0}, "", ""),
    ],
)
def test_only_dimensions_that_a_variant_has_count(shop, change, less, more):
    """A dimension that the variant lacks or takes from another is not left exact by its class."""
    ((_, message),) = _exact(shop([change], *(f"shop,{line}" for line in SHOP)))
    named = message.partition("no row for ")[2].partition(", which class")[0].split(", ")
    assert set(named) == {*OTHERS.split(", "), more} - {less, ""}


def test_dimensions_of_all_variants_of_a_class_are_named(shop):
    """What one variant of a class has and another has not is named all the same."""
    outcome = shop([{}, {"rim_length_mm": 20, "rim_thickness_mm": 3}], *(f"shop,{line}" for line in SHOP))
    ((_, message),) = _exact(outcome)
    assert "Tooth rim length, Tooth rim thickness" in message


@pytest.mark.slow
def test_a_row_of_zero_deviations_is_deliberate(shop):
    """Zero deviations say that a dimension is exact, and a full class or the class standard has nothing to tell."""
    names = ("cylinder_length", "mean_radius", "disk_inner_radius", "youngs_modulus", "poisson_ratio")
    zeros = [f"shop,{name},0,0,,," for name in names]
    assert _exact(shop([{}], *(f"shop,{line}" for line in SHOP), *zeros)) == []
    assert _exact(shop([{"tolerance_class": ""}], "standard,wall_thickness,,,,IT9,")) == []


def test_the_class_standard_of_the_submission_counts(shop):
    """Where the submission has a class standard of its own, only what that one scatters can be left exact."""
    lines = [*(f"shop,{line}" for line in SHOP), "standard,youngs_modulus,-2,2,%,,", "standard,poisson_ratio,0,0,,,"]
    ((_, message),) = _exact(shop([{}], *lines))
    assert "no row for Young's modulus, which class standard scatters" in message


@pytest.mark.slow
def test_a_shear_modulus_that_is_given_is_named_alone(shop, tmp_path):
    """E and ν do not count where the material gives G, which class standard does not scatter."""
    materials = tmp_path / "materials.csv"
    materials.write_text("material,shear_modulus_GPa\n20Cr2Ni4,81\n", encoding="utf-8")
    outcome = shop([{}], *(f"shop,{line}" for line in SHOP))
    again = check(tmp_path / "submission.csv", tolerances=tmp_path / "tolerances.csv", materials=materials)
    assert "Young's modulus" in _exact(outcome)[0][1]
    assert "modulus" not in _exact(again)[0][1]


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("wall_thickness,0,1.61,mm,,uniform", None),
        ("wall_thickness,0,3.21,mm,,uniform", "E333"),
        ("wall_thickness,0,5,mm,,normal", "E333"),
        ("wall_thickness,0,1e300,m,,uniform", "E314"),
        ("torque,0,1601,,,uniform", "E333"),
        ("cylinder_calibration,0,9,,,uniform", "E333"),
        ("wall_thickness,-1e-300,1e-300,mm,,normal", "W441"),
        ("wall_thickness,-1.5e-6,1.5e-6,mm,,normal", "W441"),
        ("wall_thickness,-1.7e-6,1.7e-6,mm,,normal", None),
        ("wall_thickness,0,0,mm,,normal", None),
        ("wall_thickness,0.01,0.01,mm,,normal", None),
    ],
)
def test_absurd_tolerances(judge, line, code):
    """A tolerance wider than its value stops the row; one too narrow to be measured is a warning."""
    outcome = judge({}, tolerances=[line])
    found = {one.code for one in outcome.findings} - {"W410", "W421"}
    assert found == ({code} if code else set())
    assert outcome.exit_code == (4 if code and code[0] == "E" else 0)
