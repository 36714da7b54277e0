"""The fields of the report: one `Column` per heading of Results and Findings."""

from __future__ import annotations

from typing import Any

from flexlash.schema.columns import Column

__all__ = ["CROSS_CHECK", "ELASTICITY", "FINDINGS", "RESULTS", "result_columns"]


def _result(key: str, label: str, text: str, unit: str = "", quantity: str = "", **rest: Any) -> Column:
    """Return a numeric Results column; angles and percentiles say so in their unit."""
    heading = f"{label} [{unit}]" if unit else label
    fields = {"role": "result", **rest}
    return Column(sheet="Results", key=key, label=heading, help=text, unit=unit, quantity=quantity, **fields)


def _angle(key: str, label: str, text: str, unit: str = "arcmin", **rest: Any) -> Column:
    return _result(f"{key}_{unit}", label, text, unit, "angle", **rest)


def _share(key: str, label: str, text: str) -> Column:
    return _result(key, label, text, minimum=0, maximum=1)


def _percentile(key: str, share: str) -> Column:
    return _angle(key, f"P{share}", f"Backlash that {share} % of units stay below.")


def _error(key: str, label: str) -> Column:
    text = f"Standard error of {label}: ± 1.96 of them is a 95 % interval."
    return _angle(f"{key}_standard_error", f"{label} standard error", text, minimum=0)


def _plain_draws(key: str, label: str) -> tuple[Column, ...]:
    return (
        _angle(f"random_{key}", f"{label} by plain draws", f"{label} by plain Monte Carlo."),
        _error(f"random_{key}", f"{label} by plain draws"),
    )


RESULTS = (
    _result("variant", "Variant", "Name of the variant as submitted.", type="text", role="identity"),
    _result(
        "status",
        "Status",
        "error: not computed. warning: computed, see Findings. ok: no error, no warning.",
        type="choice",
        choices=("error", "warning", "ok"),
    ),
    _angle("cylinder_windup", "Cylinder wind-up", "Wind-up of wall, junction fillet and tooth rim.", "rad"),
    _angle("disk_windup", "Disk wind-up", "Wind-up of disk or flange, taper and hub fillet.", "rad"),
    _angle("windup", "Wind-up", "Cylinder and disk together.", "rad"),
    _angle("backlash", "Backlash", "Twice the wind-up, at the entered dimensions.", "rad"),
    _angle("backlash", "Backlash", "Twice the wind-up, at the entered dimensions."),
    _angle("backlash", "Backlash", "Twice the wind-up, at the entered dimensions.", "arcsec"),
    _share("disk_share", "Disk share", "Disk wind-up over wind-up, a fraction."),
    _angle(
        "cylinder_only_backlash",
        "Cylinder-only backlash",
        "What the classical formula gives: 2Tl/(G 2π r_m³ Δ), no disk, no refinements.",
    ),
    _result("stiffness_Nm_per_rad", "Stiffness", "Torque over wind-up.", "N·m/rad"),
    _result("stiffness_Nm_per_arcmin", "Stiffness", "Torque over wind-up.", "N·m/arcmin"),
    _result("wall_shear_MPa", "Wall shear", "T/(2π r_m² Δ). Torsion only.", "MPa", "stress"),
    _result("hub_shear_MPa", "Hub shear", "Greatest T/(2π r² t) in the disk. Torsion only.", "MPa", "stress"),
    _angle(
        "lost_motion",
        "Lost motion of the flexspline alone",
        "2U at the set per cent of the rated torque: the flexspline's part; teeth, bearing and hub add theirs.",
    ),
    _angle("mean", "Mean", "Mean backlash over the tolerances."),
    _angle("sd", "Standard deviation", "Standard deviation of the backlash over the tolerances.", minimum=0),
    _percentile("p0_135", "0.135"),
    _percentile("p2_5", "2.5"),
    _percentile("p5", "5"),
    _percentile("p50", "50"),
    _percentile("p95", "95"),
    _percentile("p97_5", "97.5"),
    _percentile("p99_865", "99.865"),
    _error("p97_5", "P97.5"),
    _error("p99_865", "P99.865"),
    _angle("coverage_low", "Coverage low", "Lower end of the coverage interval (Settings: coverage_percent)."),
    _angle("coverage_high", "Coverage high", "Upper end of the coverage interval."),
    _angle("worst_case_low", "Worst case low", "Every dimension at the limit that lowers the backlash."),
    _angle("worst_case_high", "Worst case high", "Every dimension at the limit that raises the backlash."),
    _angle("first_order_sd", "First-order sd", "First-order (GUM) standard uncertainty at mid-limits."),
    _share("probability_over_limit", "Probability over limit", "Share of units over the limit, a fraction."),
    _share("probability_over_limit_low", "Probability low", "Lower end of its 95 % interval."),
    _share("probability_over_limit_high", "Probability high", "Upper end of its 95 % interval."),
    _result("ppm_over_limit", "Over limit", "Units over the limit per million.", "ppm", minimum=0, maximum=1_000_000),
    _result("ppk", "Ppk upper", "(limit − P50)/(P99.865 − P50), ISO 22514-2."),
    _result("main_contributor", "Main contributor", "Dimension that causes most of the spread.", type="text"),
    _share("main_contributor_share", "Main contributor share", "Its share of the variance, a fraction."),
    _angle("backlash_limit", "Backlash limit", "The limit as submitted.", role="requirement"),
    _angle("rim_windup", "Rim wind-up", "Part of the wind-up in the tooth rim.", "rad"),
    _angle("wall_windup", "Wall wind-up", "Part of the wind-up in the plain wall.", "rad"),
    _angle("junction_fillet_windup", "Junction fillet wind-up", "Part in the junction fillet.", "rad"),
    _angle("disk_body_windup", "Disk body wind-up", "Part in the disk outside its hub fillet, or flange.", "rad"),
    _angle("hub_fillet_windup", "Hub fillet wind-up", "Part of the wind-up in the hub fillet.", "rad"),
    _result("von_mises_MPa", "Von Mises stress", "√3 times the greatest shear stress. Torsion only.", "MPa", "stress"),
    _angle(
        "two_term_backlash",
        "Two-term backlash",
        "What a plain wall and a disk as thick as at its edge give: the published formula, without refinements.",
    ),
    _result("rim_shear_MPa", "Rim shear", "Shear stress in the tooth rim. Torsion only.", "MPa", "stress"),
    _result("hub_shear_radius_mm", "Radius of hub shear", "Where in the disk the hub shear acts.", "mm", "length"),
    _result(
        "governing_section",
        "Governing section",
        "Section with the greatest von Mises stress of torsion.",
        type="choice",
        choices=("wall", "tooth rim", "disk"),
    ),
    _result(
        "elastic_limit_torque_Nm",
        "Elastic limit torque",
        "Torque at which the governing section begins to yield, without notch factors.",
        "N·m",
        "torque",
    ),
    _result(
        "buckling_shear_MPa",
        "Buckling shear",
        "Wall shear stress at which the cylinder buckles under torque, NASA SP-8007.",
        "MPa",
        "stress",
    ),
    _result(
        "buckling_range",
        "Buckling formula applies",
        "yes; shorter: the cylinder is too short for it and the stress a lower bound; longer: a long tube's is given.",
        type="choice",
        choices=("yes", "shorter", "longer"),
    ),
    _result(
        "natural_frequency_Hz",
        "Natural frequency",
        "Of the load inertia on the flexspline alone: an upper bound for the drive.",
        "Hz",
    ),
    _result(
        "resonance_speed_rpm",
        "Resonance speed",
        "Input speed at which two torque ripples per turn meet the natural frequency.",
        "rpm",
    ),
    _result("catalogue_size", "Catalogue size", "Nearest size of a maker's catalogue: mean diameter over 2.54 mm."),
    _result(
        "catalogue_stiffness_Nm_per_rad",
        "Catalogue stiffness",
        "Least K3 of whole drives of that size; the flexspline alone must be stiffer.",
        "N·m/rad",
    ),
    _angle(
        "drive_lost_motion",
        "Lost motion of a catalogue drive",
        "Of the whole drive of the nearest catalogue size at the same torque: 2 p T_rated/K1, its least K1. Blank "
        "outside sizes 14 to 100 and where that torque exceeds T1, the end of the first slope.",
    ),
    _percentile("p1", "1"),
    _percentile("p25", "25"),
    _percentile("p75", "75"),
    _percentile("p99", "99"),
    _error("mean", "Mean"),
    _error("sd", "Standard deviation"),
    *(_error(key, label) for key, label in (("p0_135", "P0.135"), ("p1", "P1"), ("p2_5", "P2.5"), ("p5", "P5"))),
    *(_error(key, label) for key, label in (("p25", "P25"), ("p50", "P50"), ("p75", "P75"))),
    *(_error(key, label) for key, label in (("p95", "P95"), ("p99", "P99"))),
    *(_error(key, label) for key, label in (("coverage_low", "Coverage low"), ("coverage_high", "Coverage high"))),
    _result("skewness", "Skewness", "Third central moment over the cube of the standard deviation; 0 for a normal."),
    _result("skewness_standard_error", "Skewness standard error", "Standard error of the skewness."),
    _result(
        "kurtosis",
        "Excess kurtosis",
        "Fourth central moment over the fourth power of the standard deviation, less 3: 0 for a normal, below it for "
        "short tails, above it for long ones.",
    ),
    _result("kurtosis_standard_error", "Excess kurtosis standard error", "Standard error of the excess kurtosis."),
    _result(
        "ppm_over_limit_low", "Over limit low", "Lower end of its 95 % interval.", "ppm", minimum=0, maximum=1_000_000
    ),
    _result(
        "ppm_over_limit_high", "Over limit high", "Upper end of its 95 % interval.", "ppm", minimum=0, maximum=1_000_000
    ),
    _result("ppk_normal", "Ppk upper, normal theory", "(limit − mean)/(3 sd): right only for a normal backlash."),
    _result(
        "first_order_valid",
        "First order enough",
        "yes: backlash at mid-limits ± k·(first-order sd) meets the coverage interval within half a unit in the second "
        "digit of the first-order sd in arcmin (JCGM 101 clause 8).",
        type="choice",
        choices=("yes", "no"),
    ),
    _share("interaction_share", "Interaction", "Share of the variance that no dimension causes by itself."),
    _result("spread_method", "Spread by", "line, sobol or random: what made the spread of this row.", type="text"),
    _result("spread_points", "Lines or points", "Lines (method line) or points behind the spread of this row."),
    _result("spread_note", "Note on the spread", "Why not lines, or which precision was not reached.", type="text"),
    _angle("within_lot_sd", "Within-lot sd", "Standard deviation of the parts of one lot, over all lots.", minimum=0),
    _error("within_lot_sd", "Within-lot sd"),
    _angle("between_lots_sd", "Between-lots sd", "Standard deviation of the means of lots.", minimum=0),
    _error("between_lots_sd", "Between-lots sd"),
    _share(
        "lots_failing",
        "Lots failing",
        "Share of lots with more units over the limit than acceptable (Settings: acceptable_ppm), a fraction.",
    ),
    _result("lots_failing_standard_error", "Lots failing standard error", "Standard error of that share."),
    _share(
        "probability_over_limit_sample_low",
        "Probability by measured parts low",
        "Lower end of the 95 % interval of the probability over limit that the number of measured parts leaves.",
    ),
    _share(
        "probability_over_limit_sample_high",
        "Probability by measured parts high",
        "Upper end of that interval.",
    ),
    _angle(
        "p99_865_sample_low",
        "P99.865 by measured parts low",
        "Lower end of the 95 % interval of P99.865 that the number of measured parts leaves.",
    ),
    _angle("p99_865_sample_high", "P99.865 by measured parts high", "Upper end of that interval."),
    _angle("tooth_band_windup", "Tooth face wind-up", "Part of the wind-up where the teeth load the cylinder.", "rad"),
    _result(
        "bending_stress_MPa",
        "Bending stress",
        "Amplitude of the hoop stress at the wall by the wave generator: 1.5 E Δ w₀/(r_m² (1 − ν²)), twice a turn.",
        "MPa",
        "stress",
    ),
    _result(
        "rim_bending_stress_MPa", "Rim bending stress", "The same at the tooth rim, without notches.", "MPa", "stress"
    ),
    _result(
        "alternating_stress_MPa",
        "Alternating stress",
        "Equivalent amplitude of the bending stress, the greater of wall and rim: √(1 − ν + ν²) of it.",
        "MPa",
        "stress",
    ),
    _result(
        "combined_stress_MPa",
        "Combined stress",
        "Greatest equivalent stress of a turn: √(alternating² + von Mises² of torsion), the greater of wall and rim.",
        "MPa",
        "stress",
    ),
    _angle(
        "system_mean",
        "System mean",
        "Mean backlash of the whole drive: that of the wind-up's spread and the middle of every one of Other sources.",
    ),
    _angle(
        "system_rss_high",
        "System RSS high",
        "That mean and the root of the sum of squares of all deviations, of the wind-up three standard deviations.",
    ),
    _angle(
        "system_bender_high", "System Bender high", "That mean and 1.5 times that root, at most the sum of deviations."
    ),
    _angle(
        "system_mean_shift_high",
        "System mean shift high",
        "That mean, a part η of each deviation (Settings: mean_shift_factor) and the root of the rest squared.",
    ),
    _angle("system_worst_case_high", "System worst case high", "That mean and the sum of all deviations."),
    _angle("system_p99_865", "System P99.865", "Backlash of the whole drive that 99.865 % of units stay below."),
    _angle("system_p99_865_standard_error", "System P99.865 error", "Its standard error."),
    _angle("system_limit", "System limit", "Greatest backlash of the whole drive, as entered."),
    _share("system_probability_over_limit", "System over limit", "Share of units of the whole drive over that limit."),
    _share("system_probability_over_limit_standard_error", "System over limit error", "Standard error of that share."),
    _result("notes", "Notes", "Notes as submitted.", type="text", role="remark"),
    _result(
        "findings", "Findings", "Codes and cells of the errors and warnings of this row.", type="text", role="remark"
    ),
)

CROSS_CHECK = (
    *_plain_draws("mean", "Mean"),
    *_plain_draws("sd", "Standard deviation"),
    *_plain_draws("p2_5", "P2.5"),
    *_plain_draws("p50", "P50"),
    *_plain_draws("p97_5", "P97.5"),
    *_plain_draws("p99_865", "P99.865"),
    _share("random_probability_over_limit", "Over limit by plain draws", "Share of plain draws over the limit."),
    _result("random_points", "Plain draws", "Number of plain Monte Carlo draws."),
    _result(
        "cross_check_deviation",
        "Greatest difference",
        "Greatest difference between the spread and plain draws, in combined standard errors of a normal: at most 37.",
    ),
    _result(
        "cross_check",
        "Cross-check",
        "agrees: all within 5 combined standard errors, which chance exceeds in fewer than one row in 10,000. "
        "differs: otherwise.",
        type="choice",
        choices=("agrees", "differs"),
    ),
)
"""Further columns of a run with --cross-check."""


ELASTICITY = (
    _angle("elasticity_windup", "Wind-up by elasticity", "Wind-up by two-dimensional elasticity.", "rad"),
    _result(
        "elasticity_difference_percent",
        "Difference from elasticity",
        "Wind-up by the formula, without calibration, over that by elasticity, minus one.",
        "%",
        "ratio",
    ),
    _result(
        "elasticity_error_percent",
        "Error of elasticity",
        "Change of the elasticity result from the mesh before, and 5e-4 %: greater than the error that remains.",
        "%",
        "ratio",
    ),
    _result(
        "elasticity_hub_fillet_shear_MPa",
        "Hub fillet shear by elasticity",
        "Greatest shear stress along the hub fillet; blank without fillet, or where it has not settled to 3 %.",
        "MPa",
        "stress",
    ),
    _result(
        "elasticity_junction_fillet_shear_MPa",
        "Junction fillet shear by elasticity",
        "Greatest shear stress along the junction fillet; blank as for the hub fillet.",
        "MPa",
        "stress",
    ),
    _angle(
        "two_lobe_low",
        "Two-lobe backlash low",
        "Of cups with a tooth face width, on a rigid, tightly fitting wave generator: all engaged teeth turn by the "
        "same angle. What the wave generator's fit adds is not in it.",
    ),
    _angle("two_lobe_high", "Two-lobe backlash high", "The same where two single teeth carry the whole torque."),
    _result(
        "face_width_change_percent",
        "Change by the tooth face",
        "Backlash with the torque over the tooth face width, over that with the torque at the open end, minus one.",
        "%",
        "ratio",
    ),
)
"""Further columns of a run with --elasticity."""


def result_columns(*, cross_check: bool = False, elasticity: bool = False) -> tuple[Column, ...]:
    """Return the columns of the Results of a run."""
    return (*RESULTS, *(CROSS_CHECK if cross_check else ()), *(ELASTICITY if elasticity else ()))


FINDINGS = tuple(
    Column(sheet="Findings", role="result", key=key, label=label, help=text, type="text")
    for key, label, text in (
        (
            "level",
            "Level",
            "error: row not computed. warning: computed and flagged. info: repaired or noted.",
        ),
        ("code", "Code", "E1xx workbook, E2xx cell, E3xx relation, W4xx engineering, I5xx repair."),
        ("sheet", "Sheet", "Sheet of the submission."),
        ("cell", "Cell", "Address in the submission."),
        ("variant", "Variant", "Variant of that row."),
        ("column", "Column", "Key of the column."),
        ("value", "Value", "What the cell holds, as entered."),
        ("message", "Message", "Where, what was found, what is required."),
        ("fix", "Fix", "What to do."),
        ("suggestion", "Suggestion", "What was probably meant."),
    )
)
