"""Flexsplines of every shape [SI], that several tests of the mechanics compute."""

import math


def without(dimensions, *names):
    """Return dimensions without some of them."""
    return {name: size for name, size in dimensions.items() if name not in names}


REFINEMENTS = (
    "disk_hub_thickness",
    "hub_fillet_radius",
    "junction_fillet_radius",
    "rim_length",
    "rim_thickness",
)

B3_160 = {
    "torque": 800.0,
    "cylinder_length": 0.16,
    "mean_radius": 0.08,
    "wall_thickness": 0.0016,
    "disk_inner_radius": 0.04,
    "youngs_modulus": 211e9,
    "poisson_ratio": 0.3,
}

REFINED = B3_160 | {
    "mean_radius": 0.0808,
    "disk_thickness": 0.0018,
    "disk_outer_radius": 0.081,
    "disk_hub_thickness": 0.003,
    "hub_fillet_radius": 0.0035,
    "junction_fillet_radius": 0.003,
    "rim_length": 0.02,
    "rim_thickness": 0.0032,
}

POWER_LAW = without(REFINED, "disk_thickness") | {"disk_thickness_exponent": 1.7}

CONE = B3_160 | {"disk_thickness": 0.0018, "disk_hub_thickness": 0.003, "disk_cone_angle": math.radians(60)}

HAT = {name: size for name, size in B3_160.items() if name != "disk_inner_radius"} | {"disk_outer_radius": 0.12}

CYLINDER = {name: size for name, size in B3_160.items() if name != "disk_inner_radius"}

FROM_BORE = {name: size for name, size in REFINED.items() if name != "mean_radius"} | {"bore_diameter": 0.16}

SHAPES = {
    "cup": ("cup", B3_160),
    "refined cup": ("cup", REFINED),
    "cup from bore": ("cup", FROM_BORE),
    "hat": ("hat", HAT),
    "hat with own flange": ("hat", HAT | {"disk_thickness": 0.002, "disk_inner_radius": 0.0795}),
    "power-law cup": ("cup", POWER_LAW),
    "constant shear cup": ("cup", B3_160 | {"disk_hub_thickness": 0.004, "disk_thickness_exponent": 2.0}),
    "conical cup": ("cup", CONE),
    "conical power-law cup": ("cup", without(CONE, "disk_thickness") | {"disk_thickness_exponent": 1.2}),
    "cup with a tooth face": ("cup", B3_160 | {"tooth_face_width": 0.03}),
    "tooth face on the rim": ("cup", REFINED | {"tooth_face_width": 0.015}),
    "tooth face beyond the rim": ("cup", REFINED | {"tooth_face_width": 0.03}),
    "hat with a tooth face": ("hat", HAT | {"tooth_face_width": 0.02}),
    "cylinder of tooth face": ("cylinder", CYLINDER | {"tooth_face_width": 0.16}),
    "conical hat": ("hat", HAT | {"disk_thickness": 0.002, "disk_cone_angle": math.radians(60)}),
    "cylinder": ("cylinder", CYLINDER),
    "cylinder with rim": ("cylinder", CYLINDER | {"rim_length": 0.02, "rim_thickness": 0.0032}),
}
