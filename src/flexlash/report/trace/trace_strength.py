"""The stresses of Trace: shear and von Mises of each section, the torque at which one yields or the wall buckles."""

from __future__ import annotations

from flexlash.mechanics import strength
from flexlash.mechanics.strength import GREATEST_SLENDERNESS, KNOCK_DOWN, LEAST_CURVATURE
from flexlash.report.formula.closed_forms import worked
from flexlash.report.formula.functions import AND, IF, ISNUMBER, MAX
from flexlash.report.trace.trace_mechanics import in_disk, only
from flexlash.report.trace.trace_page import Page
from flexlash.report.trace.trace_steps import Steps, shear

__all__ = ["write_buckling", "write_stresses"]

_NAMES = (("wall", "Wall"), ("rim", "Tooth rim"), ("hub", "Disk"))


def write_stresses(page: Page, steps: Steps) -> None:
    """Write shear and von Mises stress of each section, and what governs."""
    page.section("5  Stresses")
    _write_shears(page, steps)
    for key, name in _NAMES:
        words = (f"{name}: von Mises", f"σ_{name[0].lower()}", "MPa", "√3 τ")
        page.line(f"{key}_von_mises", worked(strength.von_mises_stress, page[f"{key}_shear"]), words)
    wall, rim, hub = (page[f"{key}_von_mises"] for key, _ in _NAMES)
    section = IF(AND(wall >= rim, wall >= hub), "wall", IF(rim >= hub, "tooth rim", "disk"))
    words = ("Governing section", "", "", "the one with the greatest von Mises stress")
    page.line("governing_section", section, words, "plain")
    stress = page.line("von_mises", MAX(wall, rim, hub), ("Greatest von Mises", "σ", "MPa", "of the three"))
    limit = worked(strength.limit_torque, page["torque"], stress, page["yield_strength"])
    page.line(
        "elastic_limit_torque",
        only(page["yield_strength"] > 0, limit),
        ("Elastic limit torque", "T_el", "N·m", "T σ_y / σ"),
    )


def _write_shears(page: Page, steps: Steps) -> None:
    """Write the shear stress of wall, rim and disk: in a disk without fillet it is greatest at an end."""
    torque, radius = page["torque"], page["mean_radius"]
    in_wall = shear(torque, radius, page["wall_thickness"])
    page.line("wall_shear", in_wall, ("Wall: shear", "τ_w", "MPa", "T / (2π r_m² Δ)"))
    in_rim = only(page["rim_length"] > 0, shear(torque, page["rim_radius"], page["rim_thickness"]))
    page.line("rim_shear", in_rim, ("Tooth rim: shear", "τ_t", "MPa", "T / (2π r_b² t_b)"))
    start, outer = page["disk_start"], page["disk_outer_radius"]
    at_start = in_disk(page, shear(torque, start, page["start_thickness"]))
    page.line("start_shear", at_start, ("Disk at r_s: shear", "", "MPa", "T / (2π r_s² t_s)"))
    at_outer = in_disk(page, shear(torque, outer, page["outer_thickness"]))
    page.line("outer_shear", at_outer, ("Disk at r_co: shear", "", "MPa", "T / (2π r_co² t_o)"))
    in_fillet, radius_in_fillet = steps.hub_fillet_shear()
    in_fillet = in_disk(page, only(page["hub_fillet_radius"] > 0, in_fillet))
    words = ("Hub fillet: greatest shear", "", "MPa", "searched along the fillet, see Trace steps")
    page.line("fillet_shear", in_fillet, words)
    greatest = MAX(page["start_shear"], page["outer_shear"], page["fillet_shear"])
    words = ("Disk: greatest shear", "τ_d", "MPa", "of fillet and both ends: between the ends it is never greater")
    page.line("hub_shear", greatest, words)
    at_end = IF(page["start_shear"] >= page["outer_shear"], start, outer)
    is_end = page["fillet_shear"] < MAX(page["start_shear"], page["outer_shear"])
    acts = only(page["hub_shear"] > 0, IF(is_end, at_end, radius_in_fillet))
    page.line("shear_radius", acts, ("Radius where it acts", "", "mm", "its place in the disk"))


def write_buckling(page: Page) -> None:
    """Write at which shear stress and torque the wall buckles."""
    page.section("6  Buckling of the wall (NASA SP-8007)")
    modulus, ratio = page["youngs_modulus"] * 1000, page["poisson_ratio"]
    radius, wall, length = page["mean_radius"], page["wall_thickness"], page["cylinder_length"]
    is_known = AND(page["youngs_modulus"] > 0, ISNUMBER(ratio))
    curvature = worked(strength.curvature_parameter, ratio, radius, wall, length)
    words = ("Curvature", "γZ", "", f"{KNOCK_DOWN:g}^(4/3) l² √(1 − ν²) / (r_m Δ)")
    curvature = page.line("curvature", only(is_known, curvature), words)
    words = ("Slenderness", "", "", "(l/r_m) / √(r_m/Δ)")
    slender = page.line("slenderness", worked(strength.slenderness, radius, wall, length), words)
    equation = f"shorter: γZ ≤ {LEAST_CURVATURE:g}; longer: slenderness ≥ {GREATEST_SLENDERNESS:g}; else yes"
    span = worked(strength.by_buckling_range, curvature, slender, shorter="shorter", usual="yes", longer="longer")
    page.line("buckling_range", IF(is_known, span, "none"), ("Formula applies", "", "", equation), "plain")
    usual = worked(strength.buckling_shear, modulus, radius, wall, length)
    words = ("Usual cylinder", "τ_1", "MPa", f"0.747 · {KNOCK_DOWN:g} E (r_m/Δ)^(−5/4) (l/r_m)^(−1/2)")
    usual = page.line("usual_buckling", only(is_known, usual), words)
    plate = worked(strength.plate_buckling_shear, modulus, ratio, wall, length)
    words = ("Long plate", "τ_2", "MPa", "5.35 π² E / (12 (1 − ν²)) (Δ/l)²")
    plate = page.line("plate_buckling", only(is_known, plate), words)
    tube = worked(strength.tube_buckling_shear, modulus, ratio, radius, wall)
    words = ("Long tube", "τ_3", "MPa", f"0.272 · {KNOCK_DOWN:g} E (1 − ν²)^(−3/4) (Δ/r_m)^(3/2)")
    tube = page.line("tube_buckling", only(is_known, tube), words)
    stress = worked(strength.by_buckling_range, curvature, slender, shorter=MAX(usual, plate), usual=usual, longer=tube)
    words = ("Wall buckles at shear", "τ_cr", "MPa", "τ_1; shorter: the greater of τ_1 and τ_2; longer: τ_3")
    stress = page.line("buckling_shear", only(is_known, stress), words)
    torque = worked(strength.limit_torque, page["torque"], page["wall_shear"], stress)
    page.line("buckling_torque", torque, ("Wall buckles at torque", "", "N·m", "T τ_cr / τ_w"))
