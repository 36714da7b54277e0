"""The names that people and scripts rely on, typed in from the contract, not taken from the program."""

import json

import pytest
from grids import for_each

from flexlash.schema.columns import (
    CORRELATIONS,
    DIMENSIONS,
    ENTRY_SHEETS,
    LEVERS,
    MATERIALS,
    MEASUREMENTS,
    OPTIONAL_SHEETS,
    OTHER_SOURCES,
    SETTINGS,
    SWEEP,
    TOLERANCES,
    VARIANTS,
    Column,
    columns_of,
)
from flexlash.schema.result_columns import CROSS_CHECK, FINDINGS, RESULTS, result_columns
from flexlash.schema.units import find_unit

VARIANT_LABELS = {
    "variant": "Variant",
    "flexspline_type": "Flexspline type",
    "material": "Material",
    "torque_Nm": "Torque T [N·m]",
    "cylinder_length_mm": "Cylinder length l [mm]",
    "mean_radius_mm": "Mean radius r_m [mm]",
    "bore_diameter_mm": "Bore diameter [mm]",
    "wall_thickness_mm": "Wall thickness Δ [mm]",
    "disk_thickness_mm": "Disk thickness [mm]",
    "disk_inner_radius_mm": "Disk inner radius r_ci [mm]",
    "disk_outer_radius_mm": "Disk outer radius r_co [mm]",
    "disk_hub_thickness_mm": "Disk thickness at hub [mm]",
    "disk_thickness_exponent": "Disk thickness exponent n [-]",
    "disk_cone_angle_deg": "Disk cone angle [°]",
    "hub_fillet_radius_mm": "Hub fillet radius [mm]",
    "junction_fillet_radius_mm": "Junction fillet radius [mm]",
    "rim_length_mm": "Tooth rim length [mm]",
    "rim_thickness_mm": "Tooth rim thickness [mm]",
    "tooth_face_width_mm": "Tooth face width [mm]",
    "bearing_width_mm": "Wave generator bearing width [mm]",
    "engaged_teeth_percent": "Engaged teeth [%]",
    "radial_deflection_mm": "Radial deflection w₀ [mm]",
    "rated_torque_Nm": "Rated torque [N·m]",
    "load_inertia_kg_m2": "Load inertia J [kg·m²]",
    "backlash_limit_arcmin": "Backlash limit [arcmin]",
    "system_limit_arcmin": "System backlash limit [arcmin]",
    "tolerance_class": "Tolerance class",
    "notes": "Notes",
}
MATERIAL_KEYS = [
    "material",
    "youngs_modulus_GPa",
    "poisson_ratio",
    "shear_modulus_GPa",
    "density_kg_m3",
    "yield_MPa",
    "source",
]
TOLERANCE_KEYS = [
    "tolerance_class",
    "dimension",
    "lower_deviation",
    "upper_deviation",
    "deviation_unit",
    "grade",
    "distribution",
    "limits_sigma",
    "mean_shift",
    "standard_deviation",
    "cp",
    "cpk",
    "sample",
    "scatters_between",
    "based_on",
]
SETTING_DEFAULTS = {
    "seed": 0,
    "coverage_percent": 95,
    "method": "line",
    "samples": None,
    "lost_motion_percent": 4,
    "cylinder_calibration": 1,
    "disk_calibration": 1,
    "acceptable_ppm": 1350,
    "target_percent": 99.865,
    "mean_shift_factor": 0.3,
    "angle_unit": "arcmin",
}
DIMENSION_NAMES = [
    "torque",
    "cylinder_length",
    "mean_radius",
    "bore_diameter",
    "wall_thickness",
    "disk_thickness",
    "disk_inner_radius",
    "disk_outer_radius",
    "disk_hub_thickness",
    "disk_thickness_exponent",
    "disk_cone_angle",
    "hub_fillet_radius",
    "junction_fillet_radius",
    "rim_length",
    "rim_thickness",
    "tooth_face_width",
    "youngs_modulus",
    "poisson_ratio",
    "shear_modulus",
    "cylinder_calibration",
    "disk_calibration",
]
RESULT_KEYS = [
    "variant",
    "status",
    "cylinder_windup_rad",
    "disk_windup_rad",
    "windup_rad",
    "backlash_rad",
    "backlash_arcmin",
    "backlash_arcsec",
    "disk_share",
    "cylinder_only_backlash_arcmin",
    "stiffness_Nm_per_rad",
    "stiffness_Nm_per_arcmin",
    "wall_shear_MPa",
    "hub_shear_MPa",
    "lost_motion_arcmin",
    "mean_arcmin",
    "sd_arcmin",
    "p0_135_arcmin",
    "p2_5_arcmin",
    "p5_arcmin",
    "p50_arcmin",
    "p95_arcmin",
    "p97_5_arcmin",
    "p99_865_arcmin",
    "p97_5_standard_error_arcmin",
    "p99_865_standard_error_arcmin",
    "coverage_low_arcmin",
    "coverage_high_arcmin",
    "worst_case_low_arcmin",
    "worst_case_high_arcmin",
    "first_order_sd_arcmin",
    "probability_over_limit",
    "probability_over_limit_low",
    "probability_over_limit_high",
    "ppm_over_limit",
    "ppk",
    "main_contributor",
    "main_contributor_share",
    "backlash_limit_arcmin",
]
FURTHER_PERCENTILES = ["p1", "p25", "p75", "p99"]
ERROR_KEYS = [
    "mean",
    "sd",
    "p0_135",
    "p2_5",
    "p5",
    "p50",
    "p95",
    "p97_5",
    "p99_865",
    "coverage_low",
    "coverage_high",
    *FURTHER_PERCENTILES,
]
FURTHER_KEYS = [
    "rim_windup_rad",
    "wall_windup_rad",
    "junction_fillet_windup_rad",
    "disk_body_windup_rad",
    "hub_fillet_windup_rad",
    "von_mises_MPa",
    "two_term_backlash_arcmin",
    "rim_shear_MPa",
    "hub_shear_radius_mm",
    "governing_section",
    "elastic_limit_torque_Nm",
    "buckling_shear_MPa",
    "buckling_range",
    "natural_frequency_Hz",
    "resonance_speed_rpm",
    "catalogue_size",
    "catalogue_stiffness_Nm_per_rad",
    "drive_lost_motion_arcmin",
    *(f"{name}_arcmin" for name in FURTHER_PERCENTILES),
    "skewness",
    "skewness_standard_error",
    "kurtosis",
    "kurtosis_standard_error",
    *(
        f"{name}{error}"
        for name in ("within_lot_sd", "between_lots_sd", "lots_failing")
        for error in (("", "_standard_error") if name == "lots_failing" else ("_arcmin", "_standard_error_arcmin"))
    ),
    *(f"probability_over_limit_sample_{end}" for end in ("low", "high")),
    *(f"p99_865_sample_{end}_arcmin" for end in ("low", "high")),
    "tooth_band_windup_rad",
    "bending_stress_MPa",
    "rim_bending_stress_MPa",
    "alternating_stress_MPa",
    "combined_stress_MPa",
    "ppm_over_limit_low",
    "ppm_over_limit_high",
    "ppk_normal",
    "first_order_valid",
    "interaction_share",
    "spread_method",
    "spread_points",
    "spread_note",
    *(
        f"system_{name}_arcmin"
        for name in ("mean", "rss_high", "bender_high", "mean_shift_high", "worst_case_high", "p99_865", "limit")
    ),
    "system_p99_865_standard_error_arcmin",
    *(f"system_probability_over_limit{error}" for error in ("", "_standard_error")),
    "notes",
    "findings",
]
CROSS_CHECK_KEYS = [
    *(
        f"random_{name}{end}_arcmin"
        for name in ("mean", "sd", "p2_5", "p50", "p97_5", "p99_865")
        for end in ("", "_standard_error")
    ),
    "random_probability_over_limit",
    "random_points",
    "cross_check_deviation",
    "cross_check",
]
FINDING_KEYS = ["level", "code", "sheet", "cell", "variant", "column", "value", "message", "fix", "suggestion"]
POSITIVE_LENGTH = "a length in mm above 0"
REQUIREMENTS = {
    ("Variants", "notes"): "text",
    ("Variants", "variant"): "a name",
    ("Variants", "flexspline_type"): "cup, hat or cylinder",
    ("Variants", "torque_Nm"): "a torque in N·m above 0",
    ("Variants", "cylinder_length_mm"): POSITIVE_LENGTH,
    ("Variants", "mean_radius_mm"): POSITIVE_LENGTH,
    ("Variants", "wall_thickness_mm"): POSITIVE_LENGTH,
    ("Variants", "disk_hub_thickness_mm"): POSITIVE_LENGTH,
    ("Variants", "disk_thickness_exponent"): "a number from 0 to 10",
    ("Variants", "disk_cone_angle_deg"): "an angle in ° from 30 to 90",
    ("Variants", "load_inertia_kg_m2"): "a number in kg·m² above 0",
    ("Variants", "hub_fillet_radius_mm"): "a length in mm of 0 or more",
    ("Variants", "junction_fillet_radius_mm"): "a length in mm of 0 or more",
    ("Variants", "backlash_limit_arcmin"): "an angle in arcmin above 0",
    ("Materials", "youngs_modulus_GPa"): "a number in GPa above 0",
    ("Materials", "poisson_ratio"): "a number from 0 to 0.5",
    ("Tolerances", "lower_deviation"): "a number",
    ("Tolerances", "dimension"): "a name from the list",
    ("Tolerances", "cp"): "a number above 0 and at most 100",
    ("Tolerances", "distribution"): "normal, truncated normal, uniform, triangular or measured",
    ("Tolerances", "limits_sigma"): "a number from 0.5 to 100",
}
EVERY = [column for columns in (*ENTRY_SHEETS.values(), SETTINGS, RESULTS, CROSS_CHECK, FINDINGS) for column in columns]


def _key(column):
    return f"{column.sheet}.{column.key}"


def test_entry_sheets():
    """The sheets are Variants, Materials, Tolerances and Settings, in this order, then the optional ones."""
    assert tuple(OPTIONAL_SHEETS) == ("Measurements", "Correlations", "Other sources", "Levers", "Sweep")
    assert list(ENTRY_SHEETS) == ["Variants", "Materials", "Tolerances", "Settings", *OPTIONAL_SHEETS]


def test_variants():
    """Variants has the contract's keys and labels, in its order."""
    assert {column.key: column.label for column in VARIANTS} == VARIANT_LABELS
    assert [column.key for column in VARIANTS] == list(VARIANT_LABELS)


def test_what_variants_requires():
    """Name, material, torque, length and wall are required; what depends on the type is not required of all."""
    required = {column.key for column in VARIANTS if column.required}
    assert required == {"variant", "material", "torque_Nm", "cylinder_length_mm", "wall_thickness_mm"}


def test_materials():
    """Materials has the contract's keys and requires only the name."""
    assert [column.key for column in MATERIALS] == MATERIAL_KEYS
    assert [column.key for column in MATERIALS if column.required] == ["material"]


def test_tolerances():
    """Tolerances has the contract's keys and requires the class; a row without a dimension takes over another class."""
    assert [column.key for column in TOLERANCES] == TOLERANCE_KEYS
    assert [column.key for column in TOLERANCES if column.required] == ["tolerance_class"]


def test_measurements():
    """Measurements has sample, part and use, then every dimension of Variants under its key; the sample is required."""
    dimensions = [column.key for column in VARIANTS if column.role == "dimension"]
    assert [column.key for column in MEASUREMENTS] == ["sample", "part", "use_as", *dimensions]
    assert [column.key for column in MEASUREMENTS if column.required] == ["sample"]


def test_correlations():
    """Correlations has the contract's keys and requires all but the reason."""
    keys = ["tolerance_class", "dimension_1", "dimension_2", "correlation", "reason"]
    assert [column.key for column in CORRELATIONS] == keys
    assert [column.key for column in CORRELATIONS if not column.required] == ["reason"]


def test_other_sources():
    """Other sources has the contract's keys, then its own; only the name is required, a value may be blank."""
    keys = [
        "source", "enter_as", "value_arcmin", "radius_mm", "pressure_angle_deg", "lower_deviation", "upper_deviation",
        "distribution", "limits_sigma", "side", "ratio", "kind",
    ]  # fmt: skip
    assert [column.key for column in OTHER_SOURCES] == keys
    assert [column.key for column in OTHER_SOURCES if column.required] == ["source"]
    assert columns_of("Other sources")["value_arcmin"].label == "Value"
    choices = {column.key: column.choices for column in OTHER_SOURCES if column.choices}
    assert choices == {
        "enter_as": ("arcmin", "mm at radius", "mm radial play"),
        "distribution": ("normal", "truncated normal", "uniform", "triangular"),
        "side": ("output", "input"),
        "kind": ("systematic", "random"),
    }


def test_levers_and_sweep():
    """Both name dimensions of Variants, Levers another material too; the contract's keys stand in its order."""
    sizes = [column.dimension for column in VARIANTS if column.role == "dimension"]
    keys = ["dimension", "may_change", "lowest", "highest", "step", "cost_per_step"]
    assert [column.key for column in LEVERS][: len(keys)] == keys
    assert columns_of("Levers")["dimension"].choices == (*sizes, "material")
    first = ["dimension", "from", "to", "step"]
    assert [column.key for column in SWEEP] == ["variant", *first, *(f"second_{key}" for key in first)]
    assert columns_of("Sweep")["dimension"].choices == columns_of("Sweep")["second_dimension"].choices == tuple(sizes)


def test_settings():
    """Settings has the contract's names and defaults, on a sheet of setting and value."""
    assert {column.key: column.default for column in SETTINGS} == SETTING_DEFAULTS
    assert list(columns_of("Settings")) == ["setting", "value"]
    assert columns_of("Settings")["setting"].choices == tuple(SETTING_DEFAULTS)


def test_results_keep_their_order():
    """Results begins with the contract's columns in its order; more may follow."""
    assert [column.key for column in RESULTS][: len(RESULT_KEYS)] == RESULT_KEYS


def test_results_hold_what_scripts_read_of_them():
    """Behind the contract's columns stand the further ones, a standard error for mean, sd and every percentile."""
    keys = [column.key for column in RESULTS]
    assert len(keys) == len(set(keys))
    errors = {f"{name}_standard_error_arcmin" for name in ERROR_KEYS}
    assert set(keys) == {*RESULT_KEYS, *errors, *FURTHER_KEYS}


def test_a_cross_check_adds_columns_behind_the_others():
    """A run with --cross-check has the same columns and then those of plain Monte Carlo; one without has none."""
    assert [column.key for column in CROSS_CHECK] == CROSS_CHECK_KEYS
    assert result_columns() == result_columns(cross_check=False) == RESULTS
    assert result_columns(cross_check=True) == (*RESULTS, *CROSS_CHECK)


@pytest.mark.parametrize(
    ("key", "choices"),
    [
        ("status", ("error", "warning", "ok")),
        ("first_order_valid", ("yes", "no")),
        ("cross_check", ("agrees", "differs")),
        ("buckling_range", ("yes", "shorter", "longer")),
    ],
)
def test_result_choices(key, choices):
    """A Results column of words names the words that it can hold, and its help tells each of them."""
    (column,) = (column for column in result_columns(cross_check=True) if column.key == key)
    assert (column.type, column.choices, column.is_number) == ("choice", choices, False)
    assert choices[0] in column.help


def test_governing_sections():
    """The governing section is wall, tooth rim or disk."""
    (column,) = (column for column in RESULTS if column.key == "governing_section")
    assert (column.type, column.choices, column.is_number) == ("choice", ("wall", "tooth rim", "disk"), False)


def test_findings_keep_their_order():
    """Findings has the contract's columns in its order."""
    assert [column.key for column in FINDINGS] == FINDING_KEYS


def test_dimensions():
    """Every dimension may have a tolerance, elastic constants too, but not the requirements on a variant."""
    assert list(DIMENSIONS) == DIMENSION_NAMES
    assert columns_of("Tolerances")["dimension"].choices == tuple(DIMENSION_NAMES)


@pytest.mark.parametrize(
    ("sheet", "key", "choices", "default"),
    [
        ("Variants", "flexspline_type", ("cup", "hat", "cylinder"), "cup"),
        ("Tolerances", "distribution", ("normal", "truncated normal", "uniform", "triangular", "measured"), "normal"),
    ],
)
def test_choices(sheet, key, choices, default):
    """Each drop-down list has the contract's entries and default."""
    column = columns_of(sheet)[key]
    assert (column.type, column.choices, column.default) == ("choice", choices, default)


def test_other_defaults():
    """A blank class means standard, blank limits mean three sigma, the method is one of three."""
    assert columns_of("Variants")["tolerance_class"].default == "standard"
    assert columns_of("Tolerances")["limits_sigma"].default == 3
    assert {column.key: column.choices for column in SETTINGS}["method"] == ("line", "sobol", "random")


@for_each("place", REQUIREMENTS)
def test_requirement(place):
    """What a cell must hold is said in words."""
    sheet, key = place
    assert columns_of(sheet)[key].requirement == REQUIREMENTS[place]


@pytest.mark.parametrize(
    ("key", "words"),
    [
        ("seed", "a whole number from 0 to 4294967295"),
        ("coverage_percent", "a number in % from 50 to 99.99"),
        ("method", "line, sobol or random"),
        ("samples", "a whole number from 1 to 4194304"),
        ("cylinder_calibration", "a number from 0.1 to 10"),
    ],
)
def test_requirement_of_a_setting(key, words):
    """What a setting must hold is said in words."""
    assert next(column for column in SETTINGS if column.key == key).requirement == words


def test_requirement_with_an_upper_bound_alone():
    """A column that only has a greatest value says so without 'and'."""
    assert (
        Column(sheet="x", role="result", key="x", label="x", help="x", maximum=5).requirement == "a number of at most 5"
    )


@for_each("column", EVERY)
def test_a_label_names_its_unit(column):
    """The brackets of a label hold the column's unit, and the key ends with it."""
    bracketed = column.label.rpartition(" [")[2].removesuffix("]") if column.label.endswith("]") else ""
    if column.sheet != "Settings":
        assert bracketed == column.unit
    if column.quantity not in {"", "ratio"}:
        assert column.si_unit == find_unit(column.unit, column.quantity)
    # A unit of several words stays in the key: density_kg_m3, load_inertia_kg_m2.
    if column.quantity not in {"", "ratio", "density", "inertia"}:
        assert column.dimension != column.key
        assert column.key.startswith(column.dimension)


@for_each("column", EVERY)
def test_a_column_explains_itself(column):
    """Every column has a help text of whole sentences that fits Excel's 255-character hint."""
    assert column.help.endswith((".", ")"))
    assert len(column.help) <= 255
    assert column.label


@pytest.mark.parametrize("sheet", ENTRY_SHEETS)
def test_no_two_columns_answer_to_one_name(sheet):
    """Within a sheet no header could mean two columns, whether given by key, label or plain name."""
    spoken = [{column.key, column.dimension, column.name, column.plain_name} for column in ENTRY_SHEETS[sheet]]
    folded = [{"".join(name.casefold().split()).replace("_", "") for name in names} for names in spoken]
    assert sum(map(len, folded)) == len(set().union(*folded))


@pytest.mark.parametrize(
    ("sheet", "key", "name", "plain", "dimension"),
    [
        ("Variants", "variant", "Variant", "Variant", "variant"),
        ("Variants", "torque_Nm", "Torque T", "Torque", "torque"),
        ("Variants", "wall_thickness_mm", "Wall thickness Δ", "Wall thickness", "wall_thickness"),
        ("Variants", "disk_inner_radius_mm", "Disk inner radius r_ci", "Disk inner radius", "disk_inner_radius"),
        ("Variants", "backlash_limit_arcmin", "Backlash limit", "Backlash limit", "backlash_limit"),
        ("Variants", "disk_cone_angle_deg", "Disk cone angle", "Disk cone angle", "disk_cone_angle"),
        (
            "Variants",
            "disk_thickness_exponent",
            "Disk thickness exponent n",
            "Disk thickness exponent",
            "disk_thickness_exponent",
        ),
        ("Materials", "youngs_modulus_GPa", "Young's modulus E", "Young's modulus", "youngs_modulus"),
        ("Materials", "poisson_ratio", "Poisson's ratio ν", "Poisson's ratio", "poisson_ratio"),
        ("Tolerances", "lower_deviation", "Lower deviation", "Lower deviation", "lower_deviation"),
    ],
)
def test_names(sheet, key, name, plain, dimension):
    """A column is named without its unit, plainly without its symbol, and as a dimension without its unit."""
    column = columns_of(sheet)[key]
    assert (column.name, column.plain_name, column.dimension) == (name, plain, dimension)


@for_each("column", EVERY)
def test_dictionary_entry(column):
    """An entry of the data dictionary begins with the contract's fields in its order and is plain JSON."""
    entry = column.as_dictionary()
    contract = ["sheet", "key", "label", "unit", "type", "required", "minimum", "maximum", "choices", "default", "help"]
    assert list(entry)[: len(contract)] == contract
    assert json.loads(json.dumps(entry)) == entry
    assert entry["type"] in {"number", "integer", "text", "choice"}


def test_dictionary_entry_of_the_wall():
    """The wall thickness reads in the data dictionary as the contract describes it."""
    entry = columns_of("Variants")["wall_thickness_mm"].as_dictionary()
    told = {key: entry[key] for key in ("sheet", "label", "unit", "type", "required", "minimum", "maximum", "default")}
    assert told == {
        "sheet": "Variants",
        "label": "Wall thickness Δ [mm]",
        "unit": "mm",
        "type": "number",
        "required": True,
        "minimum": 0,
        "maximum": None,
        "default": None,
    }
    assert entry["choices"] == []
    assert entry["exclusive_minimum"] is True


def test_a_text_has_no_unit():
    """Asking a text column for its unit fails loudly, and so does a unit that does not exist."""
    with pytest.raises(LookupError):
        _ = columns_of("Variants")["notes"].si_unit
    wrong = Column.entry("Variants", "dimension", "width_furlong", "Width [furlong]", "x", quantity="length")
    with pytest.raises(LookupError, match=r"Variants\.width_furlong"):
        _ = wrong.si_unit
