"""The worked sections of Trace: shape, integrals, wind-ups and sums, in N, mm and rad."""

from __future__ import annotations

from flexlash.mechanics import flexspline, windup
from flexlash.mechanics.stiffness import lost_motion, torsional_stiffness
from flexlash.report.formula.closed_forms import worked
from flexlash.report.formula.functions import AND, IF, ISNUMBER, PI
from flexlash.report.formula.live import Live
from flexlash.report.trace.trace_page import Lines
from flexlash.report.trace.trace_steps import Sums, thickness_at

__all__ = ["in_disk", "only", "write_integrals", "write_shape", "write_sums", "write_windups"]

_ARCMIN = PI / 10800


def only(condition: Live, value: Live) -> Live:
    """Return a number where it has a meaning, else 0, which a line shows as none."""
    return IF(condition, value, 0.0)


def in_disk(page: Lines, value: Live) -> Live:
    """Return a number of the disk, else 0 where there is none."""
    return IF(page["profile"].equals("none"), 0.0, value)


def write_shape(page: Lines) -> None:
    """Write what follows from the inputs alone."""
    page.section("2  Material and shape")
    inner, outer, hub = page["disk_inner_radius"], page["disk_outer_radius"], page["disk_hub_thickness"]
    exponent, edge = page["disk_thickness_exponent"], page["disk_thickness"]
    words = ("Torque over modulus", "T/(2πG)", "mm³", "T / (2π G); N·m over GPa is mm³")
    page.line("torque_over_modulus", worked(windup.torque_over_modulus, page["torque"], page["shear_modulus"]), words)
    has_power = AND(ISNUMBER(exponent), hub > 0)
    shaped = IF(has_power, "power law", IF(hub > 0, "straight taper", "even"))
    profile = page.line(
        "profile",
        IF(page["flexspline_type"].equals("cylinder"), "none", shaped),
        ("Disk profile", "", "", "even, straight taper or power law, from t_h and n"),
        "plain",
    )
    page.line(
        "hub_thickness", IF(hub > 0, hub, edge), ("Disk thickness at r_ci", "t_1", "mm", "t_h where given, else t")
    )
    straight = worked(flexspline.thickness_slope, inner, outer, page["hub_thickness"], edge)
    words = ("Change of thickness", "k", "mm/mm", "straight taper: (t − t_h) / (r_co − r_ci)")
    page.line("thinning", only(profile.equals("straight taper"), straight), words, "fine")
    words = ("Exponent that counts", "n", "", "power law: n, else 0")
    page.line("thinning_exponent", only(profile.equals("power law"), exponent), words, "size")
    page.line("disk_start", inner + page["hub_fillet_radius"], ("Plain disk starts at", "r_s", "mm", "r_ci + R_h"))
    shape = (inner, page["hub_thickness"], page["thinning"], page["thinning_exponent"])
    equation = "t(r) = (t_1 + k (r − r_ci)) (r_ci/r)^n at r_s"
    words = ("Disk thickness there", "t_s", "mm", equation)
    page.line("start_thickness", thickness_at(page["disk_start"], *shape), words)
    page.line("outer_thickness", thickness_at(outer, *shape), ("Disk thickness at r_co", "t_o", "mm", "t(r) at r_co"))
    face_width, rim_length = page["tooth_face_width"], page["rim_length"]
    words = ("Tooth face on the rim", "c", "mm", "least of b_f and b")
    on_rim = page.line("face_on_rim", worked(windup.face_on_rim, face_width, rim_length), words, "size")
    plain = page["cylinder_length"] - rim_length - page["junction_fillet_radius"] - (face_width - on_rim)
    page.line("plain_length", plain, ("Plain wall", "l_w", "mm", "l − b − R_j − (b_f − c)"))
    rim = worked(windup.rim_radius, page["mean_radius"], page["wall_thickness"], page["rim_thickness"])
    words = ("Mean radius of the rim", "r_b", "mm", "r_m − Δ/2 + t_b/2")
    page.line("rim_radius", only(rim_length > 0, rim), words)


def write_integrals(page: Lines, steps: Sums) -> None:
    """Write the integral of each segment."""
    page.section("3  Wind-up of each segment: U = c T/(2πG) · I,  I = ∫ ds/(r³ t) along the meridian")
    has_rim = page["rim_length"] > 0
    face_width, on_rim, wall = page["tooth_face_width"], page["face_on_rim"], page["wall_thickness"]
    thickness = IF(has_rim, page["rim_thickness"], wall)
    band = worked(windup.tooth_band_integral, face_width, on_rim, page["mean_radius"], wall, thickness)
    words = ("Tooth face: integral", "I_f", "b_f/3 · (s³/(r_b³ t_b) + (1 − s³)/(r_m³ Δ)), s = c/b_f")
    _integral(page, "tooth_band", only(face_width > 0, band), words)
    beyond = page["rim_length"] - on_rim
    rim = worked(windup.wall_integral, beyond, page["rim_radius"], page["rim_thickness"])
    _integral(page, "rim", only(has_rim, rim), ("Tooth rim: integral", "I_b", "(b − c) / (r_b³ t_b)"))
    plain = worked(windup.wall_integral, page["plain_length"], page["mean_radius"], page["wall_thickness"])
    _integral(page, "wall", plain, ("Wall: integral", "I_w", "l_w / (r_m³ Δ)"))
    points = "sum over points, see Trace steps"
    _integral(page, "junction_fillet", steps.junction_fillet(), ("Junction fillet: integral", "I_j", points))
    profile, start, outer = page["profile"], page["disk_start"], page["disk_outer_radius"]
    thickness = page["start_thickness"]
    words = ("Even disk: integral", "I_e", "(1/r_s² − 1/r_co²) / (2 t)")
    even = worked(windup.annulus_integral, start, outer, thickness)
    _integral(page, "even", only(profile.equals("even"), even), words)
    words = ("Straight taper: integral", "I_t", "∫ v dv/t with v = 1/r, see Trace steps")
    _integral(page, "taper", only(profile.equals("straight taper"), steps.taper()), words)
    is_power = profile.equals("power law")
    growth = worked(windup.power_law_growth, start, outer, page["thinning_exponent"])
    growth_words = ("Power law: growth", "g", "", "((r_co/r_s)^(n−2) − 1)/(n − 2); ln(r_co/r_s) at n = 2")
    growth = page.line("power_law_growth", only(is_power, growth), growth_words)
    power_law = only(is_power, worked(windup.growth_integral, growth, start, thickness))
    _integral(page, "power_law", power_law, ("Power law: integral", "I_p", "g / (t_s r_s²)"))
    flat = page["even_integral"] + page["taper_integral"] + page["power_law_integral"]
    words = ("Disk with its cone: integral", "I_d", "(I_e + I_t + I_p) / sin α")
    _integral(page, "disk_body", worked(windup.cone_integral, flat, page["disk_cone_angle"] * PI / 180), words)
    hub = in_disk(page, only(page["hub_fillet_radius"] > 0, steps.hub_fillet()))
    _integral(page, "hub_fillet", hub, ("Hub fillet: integral", "I_h", points))


def _integral(page: Lines, segment: str, value: Live, words: tuple[str, str, str]) -> None:
    name, symbol, equation = words
    page.line(f"{segment}_integral", value, (name, symbol, "1/mm³", equation), "integral")


_SEGMENTS = (
    ("tooth_band", "Tooth face", "f", "cylinder_calibration", "c_c"),
    ("rim", "Tooth rim", "b", "cylinder_calibration", "c_c"),
    ("wall", "Wall", "w", "cylinder_calibration", "c_c"),
    ("junction_fillet", "Junction fillet", "j", "cylinder_calibration", "c_c"),
    ("disk_body", "Disk", "d", "disk_calibration", "c_d"),
    ("hub_fillet", "Hub fillet", "h", "disk_calibration", "c_d"),
)


def write_windups(page: Lines) -> None:
    """Write the wind-up of each segment, in rad and arcmin."""
    for segment, name, index, calibration, factor in _SEGMENTS:
        angle = page[calibration] * page["torque_over_modulus"] * page[f"{segment}_integral"]
        words = (f"{name}: wind-up", f"U_{index}", "", f"{factor} T/(2πG) I_{index}")
        page.line(f"{segment}_windup", angle, words, "angle")


def write_sums(page: Lines) -> None:
    """Write wind-up, backlash, stiffness and the formulas that leave something out."""
    page.section("4  Sum")
    of_teeth = page["tooth_band_windup"] + page["rim_windup"]
    cylinder = of_teeth + page["wall_windup"] + page["junction_fillet_windup"]
    page.line("cylinder_windup", cylinder, ("Cylinder wind-up", "U_cyl", "", "U_f + U_b + U_w + U_j"), "angle")
    of_disk = page["disk_body_windup"] + page["hub_fillet_windup"]
    page.line("disk_windup", of_disk, ("Disk wind-up", "U_disk", "", "U_d + U_h"), "angle")
    total = page["cylinder_windup"] + page["disk_windup"]
    page.line("windup", total, ("Wind-up", "U", "", "U_cyl + U_disk"), "angle")
    page.line("backlash", 2 * page["windup"], ("Backlash", "2U", "", "lag when the torque reverses"), "angle")
    share = page["disk_windup"] / page["windup"]
    page.line("disk_share", share, ("Disk share", "", "", "U_disk / U"), "share")
    stiffness = worked(torsional_stiffness, page["torque"], page["windup"])
    stiffness = page.line("stiffness", stiffness, ("Stiffness", "K", "N·m/rad", "T / U"))
    page.line("stiffness_arcmin", stiffness * _ARCMIN, ("Stiffness", "K", "N·m/arcmin", "K π/10800"))
    plain = worked(windup.wall_integral, page["cylinder_length"], page["mean_radius"], page["wall_thickness"])
    words = ("Cylinder-only formula", "2U_0", "", "2 T/(2πG) · l / (r_m³ Δ)")
    page.line("cylinder_only_backlash", 2 * page["torque_over_modulus"] * plain, words, "angle")
    disk = page["disk_inner_radius"], page["disk_outer_radius"], page["outer_thickness"]
    even = worked(windup.annulus_integral, *disk)
    added = in_disk(page, 2 * page["torque_over_modulus"] * even)
    words = ("Two-term formula", "2U_1", "", "2U_0 + 2 T/(2πG) · (1/r_ci² − 1/r_co²) / (2 t_o)")
    page.line("two_term_backlash", page["cylinder_only_backlash"] + added, words, "angle")
    lost = worked(lost_motion, stiffness, page["lost_motion_percent"] / 100 * page["rated_torque"])
    page.line("lost_motion", lost / _ARCMIN, ("Lost motion, flexspline alone", "", "arcmin", "2 p T_r / K"))
    limit = page["backlash_limit"]
    reserve = only(limit > 0, page["backlash"] / _ARCMIN / limit)
    page.line("limit_share", reserve, ("Backlash over its limit", "", "", "2U / limit; without tolerances"), "share")
