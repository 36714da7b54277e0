"""Rows of every kind and the Trace that is written of them."""

from __future__ import annotations

import io

import xlsxwriter

from flexlash.report.layout.styles import Book
from flexlash.report.trace.inputs import INPUTS_NOTE, stored_inputs
from flexlash.report.trace.trace_sheet import trace_sheet, write_trace

CUP = {
    "flexspline_type": "cup", "material": "given E", "torque_Nm": 800.0, "cylinder_length_mm": 160.0,
    "mean_radius_mm": 80.0, "wall_thickness_mm": 1.6, "disk_inner_radius_mm": 40.0,
}  # fmt: skip

FROM_BORE = CUP | {"mean_radius_mm": None, "bore_diameter_mm": 160.0}

REFINED = FROM_BORE | {
    "disk_thickness_mm": 1.8, "hub_fillet_radius_mm": 3.5, "junction_fillet_radius_mm": 3.0, "rim_length_mm": 20.0,
    "rim_thickness_mm": 3.2, "rated_torque_Nm": 700.0, "backlash_limit_arcmin": 3.5,
}  # fmt: skip

TAPER = REFINED | {"disk_hub_thickness_mm": 3.0}

POWER = TAPER | {"disk_thickness_mm": None}

HAT = CUP | {"flexspline_type": "hat", "disk_inner_radius_mm": None, "disk_outer_radius_mm": 120.0}

CYLINDER = CUP | {"flexspline_type": "cylinder", "disk_inner_radius_mm": None}

ROWS = {
    "cup": CUP,
    "cup 1": CUP | {"torque_Nm": 799.0},
    "cup *": CUP | {"torque_Nm": 798.0},
    "third": CUP | {"torque_Nm": 800 / 3, "wall_thickness_mm": 1.6 + 1e-14},
    "refined": REFINED,
    "taper": TAPER,
    "taper without fillet": TAPER | {"hub_fillet_radius_mm": None},
    "taper outwards": CUP | {"disk_hub_thickness_mm": 1.2, "disk_thickness_mm": 1.8},
    "thickness as radius": CUP | {"disk_hub_thickness_mm": 0.8, "disk_thickness_mm": 1.6},
    "thickness nearly as radius": TAPER | {"disk_hub_thickness_mm": 1.3, "disk_thickness_mm": 1.8},
    "power law": POWER | {"disk_thickness_exponent": 1.7},
    "same shear everywhere": POWER | {"disk_thickness_exponent": 2.0},
    "nearly 2": POWER | {"disk_thickness_exponent": 2.0000001},
    "power 0": POWER | {"disk_thickness_exponent": 0.0},
    "steep": POWER | {"disk_thickness_exponent": 8.0, "hub_fillet_radius_mm": None, "disk_hub_thickness_mm": 20.0},
    "cone": CUP | {"disk_cone_angle_deg": 60.0},
    "tapering cone": CUP | {"disk_cone_angle_deg": 45.0, "disk_hub_thickness_mm": 3.0},
    "wide hub fillet": REFINED | {"hub_fillet_radius_mm": 38.0},
    "wide hub fillet on a taper": TAPER | {"wall_thickness_mm": 0.5, "disk_thickness_mm": 0.5,
                                           "disk_hub_thickness_mm": 1.0, "hub_fillet_radius_mm": 30.0},
    "wide hub fillet where the disk thins": POWER | {"disk_thickness_exponent": 10.0, "hub_fillet_radius_mm": 38.0,
                                                     "disk_hub_thickness_mm": 2.0},
    "hub fillet on a steep taper": TAPER | {"disk_hub_thickness_mm": 12.0, "disk_thickness_mm": 0.4,
                                            "hub_fillet_radius_mm": 7.0, "disk_inner_radius_mm": 70.0},
    "small hub": CUP | {"disk_inner_radius_mm": 2.0, "hub_fillet_radius_mm": 30.0, "disk_thickness_mm": 5.0},
    "wide junction fillet": REFINED | {"junction_fillet_radius_mm": 60.0},
    "fillet as wide as the disk": CUP | {"hub_fillet_radius_mm": 40.0},
    "odd edge": CUP | {"disk_outer_radius_mm": 82.0},
    "hat": HAT,
    "hat with an inner radius": HAT | {"disk_inner_radius_mm": 79.0, "disk_thickness_mm": 2.0},
    "conical hat": HAT | {"disk_cone_angle_deg": 70.0, "rim_length_mm": 20.0, "rim_thickness_mm": 3.0},
    "cylinder": CYLINDER,
    "rimmed cylinder": CYLINDER | {"rim_length_mm": 20.0, "rim_thickness_mm": 3.0},
    "short": CUP | {"cylinder_length_mm": 30.0},
    "tooth face": CUP | {"tooth_face_width_mm": 30.0},
    "tooth face on the rim": TAPER | {"tooth_face_width_mm": 15.0},
    "tooth face beyond the rim": REFINED | {"tooth_face_width_mm": 25.0},
    "tooth face of a hat": HAT | {"tooth_face_width_mm": 20.0, "rim_length_mm": 20.0, "rim_thickness_mm": 3.0},
    "very short": CYLINDER | {"cylinder_length_mm": 10.0},
    "long": CYLINDER | {"cylinder_length_mm": 500.0, "mean_radius_mm": 10.0, "wall_thickness_mm": 0.5,
                        "torque_Nm": 5.0},
    "given G": REFINED | {"material": "given G"},
    "given both": REFINED | {"material": "given both"},
    "no Poisson effect": CUP | {"material": "cork"},
}  # fmt: skip

MATERIALS = [
    {"material": "given E", "youngs_modulus_GPa": 211.0, "poisson_ratio": 0.3, "yield_MPa": 1080.0},
    {"material": "given G", "shear_modulus_GPa": 79.3},
    {"material": "given both", "youngs_modulus_GPa": 206.0, "poisson_ratio": 0.29, "shear_modulus_GPa": 80.0},
    {"material": "cork", "youngs_modulus_GPa": 100.0, "poisson_ratio": 0.0},
]


def rows_of(changes):
    """Return rows by name as the template takes them."""
    return [{"variant": name, **{key: value for key, value in row.items() if value is not None}}
            for name, row in changes.items()]  # fmt: skip


def _written(workbook, outcome, picked):
    """Write the Trace and its data sheet; return its lines by key."""
    book = Book(workbook)
    stored = stored_inputs(list(outcome.computed.values()), outcome.settings.lost_motion_percent)
    lines = write_trace(book, trace_sheet(book), stored, len(outcome.computed), picked)
    stored.write(book, INPUTS_NOTE)
    return lines


def traced(outcome, picked=0):
    """Return the trace of a variant by its place: the lines by key, and the workbook's bytes."""
    buffer = io.BytesIO()
    with xlsxwriter.Workbook(buffer, {"in_memory": True, "strings_to_urls": False}) as workbook:
        lines = _written(workbook, outcome, picked)
    return lines, buffer.getvalue()


LINES = {"poisson_ratio": "poisson_ratio", "yield_MPa": "yield_strength", "rated_torque_Nm": "rated_torque"}
