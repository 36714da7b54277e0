"""The fields of Variants: what is entered of one flexspline, each field once."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from flexlash.schema.column import FILLET, LENGTH, POSITIVE, RADIUS, TORQUE, Column

__all__ = ["VARIANTS"]

_identity: Callable[..., Column] = partial(Column.entry, "Variants", "identity")
_dimension: Callable[..., Column] = partial(Column.entry, "Variants", "dimension")
_requirement: Callable[..., Column] = partial(Column.entry, "Variants", "requirement")
_remark: Callable[..., Column] = partial(Column.entry, "Variants", "remark")

VARIANTS = (
    _identity(
        "variant",
        "Variant",
        "Name of the variant, used once. The report names each row by it.",
        type="text",
        required=True,
        group="Variant",
        also_called="variante name bezeichnung nom nome part partname version design",
    ),
    _identity(
        "flexspline_type",
        "Flexspline type",
        "cup: disk inwards to the hub. hat: flange outwards to the bolt circle. cylinder: pin, tooth or jaw "
        "connection, no disk. Blank means cup.",
        type="choice",
        choices=("cup", "hat", "cylinder"),
        default="cup",
        group="Variant",
        also_called="flexsplineshape bauform",
    ),
    _identity(
        "material",
        "Material",
        "A material of the Materials sheet. Add a row there for your own.",
        type="text",
        required=True,
        group="Variant",
        also_called="werkstoff matériau materiau matière materiale steel steelgrade stahl",
    ),
    _dimension(
        "torque_Nm",
        "Torque T [N·m]",
        "Output torque at which the wind-up is wanted. The backlash is the lag when it reverses.",
        **TORQUE,
        required=True,
        group="Load",
        also_called="drehmoment moment couple coppia load loadtorque outputtorque peaktorque torsionalmoment",
    ),
    _dimension(
        "cylinder_length_mm",
        "Cylinder length l [mm]",
        "Inside depth: from the inner face of the disk to the open end, tooth rim included.",
        **LENGTH,
        required=True,
        group="Cylinder",
        also_called="länge laenge zylinderlänge zylinderlaenge longueur lunghezza cuplength cupdepth depth l "
        "flexsplinelength walllength barrellength insidedepth height cupheight höhe tiefe bechertiefe",
    ),
    _dimension(
        "mean_radius_mm",
        "Mean radius r_m [mm]",
        "Radius of the middle of the wall. Give this or the bore diameter, not both.",
        **RADIUS,
        group="Cylinder",
        also_called="mittlererradius rayon rayonmoyen raggio raggiomedio midradius middleradius middlesurfaceradius "
        "neutralradius neutrallineradius nominalradius cylinderradius flexsplineradius cupradius meanr r",
    ),
    _dimension(
        "bore_diameter_mm",
        "Bore diameter [mm]",
        "Inside diameter of the wall; give this or the mean radius. The mean radius is then bore/2 + wall/2 and "
        "follows both tolerances.",
        **LENGTH,
        group="Cylinder",
        also_called="innendurchmesser bohrungsdurchmesser bohrung innerdiameter insidediameter bore borediam boredia "
        "alésage flexsplinebore",
    ),
    _dimension(
        "wall_thickness_mm",
        "Wall thickness Δ [mm]",
        "Thickness of the cylinder wall.",
        **LENGTH,
        required=True,
        group="Cylinder",
        also_called="wanddicke wandstärke wandstaerke wallthk s épaisseur epaisseur spessore cupthickness "
        "shellthickness cylinderthickness cupwall cylinderwall",
    ),
    _dimension(
        "disk_thickness_mm",
        "Disk thickness [mm]",
        "Thickness of the disk or flange. Blank: the same as the wall, cut in one pass, one tolerance for both.",
        **LENGTH,
        group="Disk",
        also_called="bottomthickness diaphragmthickness basethickness bodendicke membrandicke scheibendicke "
        "flangethickness",
    ),
    _dimension(
        "disk_inner_radius_mm",
        "Disk inner radius r_ci [mm]",
        "Cup: radius of the hub, where the disk is clamped; required. Hat: blank means the mean radius.",
        **RADIUS,
        group="Disk",
        also_called="innenradius nabenradius innerradius rayonintérieur raggiointerno hubradius hubr hubrad rhub "
        "innerr radiusathub radiusofhub hubouterradius innerradiusofdisk innerdiskradius discinnerradius "
        "bossradius clampingradius clampradius diskinnerr diaphragminnerradius",
    ),
    _dimension(
        "disk_outer_radius_mm",
        "Disk outer radius r_co [mm]",
        "Cup: blank means the mean radius, as it should be. Hat: radius of the bolt circle; required.",
        **RADIUS,
        group="Disk",
        also_called="boltcircleradius flangeradius flangeouterradius lochkreisradius outerradiusofdisk outerdiskradius",
    ),
    _dimension(
        "disk_hub_thickness_mm",
        "Disk thickness at hub [mm]",
        "Cup only. Disk that thins in a straight line from here to the disk thickness at its rim. Blank: even.",
        **LENGTH,
        group="Refinements",
        also_called="hubthickness thicknessathub nabendicke",
    ),
    _dimension(
        "disk_thickness_exponent",
        "Disk thickness exponent n [-]",
        "Cup only. Disk that thins as t = t_hub (r_ci/r)^n from the thickness at hub; leave the disk thickness blank. "
        "2: the same shear stress at every radius.",
        quantity="ratio",
        minimum=0,
        maximum=10,
        group="Refinements",
        since=2,
    ),
    _dimension(
        "disk_cone_angle_deg",
        "Disk cone angle [°]",
        "Angle between a conical disk or flange and the axis; it falls away from the open end. Thicknesses are normal "
        "to it. Blank or 90: flat.",
        quantity="angle",
        minimum=30,
        maximum=90,
        group="Refinements",
        since=2,
    ),
    _dimension(
        "hub_fillet_radius_mm",
        "Hub fillet radius [mm]",
        "Cup only. Fillet between hub and inner face of the disk. Blank or 0: sharp corner.",
        **FILLET,
        group="Refinements",
        also_called="hubfillet filletathub",
    ),
    _dimension(
        "junction_fillet_radius_mm",
        "Junction fillet radius [mm]",
        "Cup only. Fillet inside the corner of disk and wall. Blank or 0: sharp corner.",
        **FILLET,
        group="Refinements",
        also_called="junctionfillet cornerradius cornerfillet innercornerradius",
    ),
    _dimension(
        "rim_length_mm",
        "Tooth rim length [mm]",
        "Length of the thicker toothed rim at the open end. Give length and thickness, or neither.",
        **LENGTH,
        group="Refinements",
        also_called="toothrimwidth rimwidth",
    ),
    _dimension(
        "rim_thickness_mm",
        "Tooth rim thickness [mm]",
        "Total thickness of the rim over the same bore, teeth counted to their root or pitch circle.",
        **LENGTH,
        group="Refinements",
    ),
    _dimension(
        "tooth_face_width_mm",
        "Tooth face width [mm]",
        "Length over which the teeth take up the torque, from the open end on. Blank: at the open end itself, which "
        "gives 2 to 18 % more wind-up.",
        **LENGTH,
        group="Refinements",
        since=5,
        also_called="facewidth toothwidth teethwidth zahnbreite verzahnungsbreite largeurdedenture larghezzadentatura",
    ),
    _requirement(
        "bearing_width_mm",
        "Wave generator bearing width [mm]",
        "Length over which the wave generator holds the bore round, in the middle of the tooth face. For the option "
        "--elasticity. Blank: 0.7 times the tooth face width.",
        **LENGTH,
        group="Wave generator",
        since=5,
        usual=(0.5, 200),
        also_called="bearingwidth wavegeneratorwidth wälzlagerbreite lagerbreite",
    ),
    _requirement(
        "engaged_teeth_percent",
        "Engaged teeth [%]",
        "Share of all teeth that carry torque, in two opposite arcs. For the option --elasticity. Blank: 30.",
        quantity="ratio",
        **POSITIVE,
        maximum=100,
        default=30,
        group="Wave generator",
        since=5,
        usual=(5, 60),
    ),
    _requirement(
        "radial_deflection_mm",
        "Radial deflection w₀ [mm]",
        "How far the wave generator presses the wall out of round: w = w₀ cos 2θ. About the module of the teeth where "
        "flexspline and circular spline differ by two of them. Gives the cyclic bending stress.",
        **LENGTH,
        group="Wave generator",
        since=5,
        usual=(0.01, 10),
        also_called="radialdeflection deflection radialdeformation w0",
    ),
    _requirement(
        "rated_torque_Nm",
        "Rated torque [N·m]",
        "Gives the lost motion of the flexspline alone, and of a catalogue drive, at a few per cent of it: see "
        "lost_motion_percent on the sheet Settings.",
        **TORQUE,
        group="Requirements",
        also_called="nenndrehmoment nominaltorque ratedload",
    ),
    _requirement(
        "load_inertia_kg_m2",
        "Load inertia J [kg·m²]",
        "Moment of inertia on the output. Gives the natural frequency of the load on the flexspline.",
        quantity="inertia",
        **POSITIVE,
        group="Requirements",
        since=2,
        usual=(1e-07, 1e06),
    ),
    _requirement(
        "backlash_limit_arcmin",
        "Backlash limit [arcmin]",
        "Greatest backlash allowed. Gives verdict, share of units over it, ppm and Ppk.",
        quantity="angle",
        **POSITIVE,
        group="Requirements",
        usual=(0.001, 600),
        also_called="maxbacklash backlashmax allowablebacklash permissiblebacklash backlashspec spielgrenze "
        "zulässigesspiel",
    ),
    _requirement(
        "system_limit_arcmin",
        "System backlash limit [arcmin]",
        "Greatest backlash allowed of the whole drive: wind-up and the sheet Other sources together.",
        quantity="angle",
        **POSITIVE,
        group="Requirements",
        since=6,
        usual=(0.001, 600),
        also_called="systemlimit systembacklash totalbacklashlimit systemspielgrenze",
    ),
    _identity(
        "tolerance_class",
        "Tolerance class",
        "A class of the Tolerances sheet. Blank means standard.",
        type="text",
        default="standard",
        group="Requirements",
        also_called="toleranzklasse classedetolérance tolclass",
    ),
    _remark("notes", "Notes", "Free text. Shown in the report.", type="text", group="Requirements"),
)
