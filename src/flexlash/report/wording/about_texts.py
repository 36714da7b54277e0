"""What the sheet About says of every report: what each sheet is for, the model, its proof, its limits, errata."""

from __future__ import annotations

from flexlash.report.wording.review_sentences import FINITE_ELEMENTS, TWO_TERMS, WITH_FILLETS_AND_RIM

__all__ = ["CHECKSUMS", "ERRATA", "HOW_TO_SHOW", "LEFT_OUT", "MODEL", "PROOF", "SHEETS", "TABS"]

SHEETS = {
    "Summary": "One page: what was computed, what fails, by how much, why and what to change.",
    "Failing variants": "One printed page for each variant that misses its limit: by how much, why, what to change.",
    "Allocation": (
        "What the tolerances of each class may be, at the least cost, with all of its variants within their limits."
    ),
    "Levers": "Which single change brings a failing variant within its limit; how far a passing one may still change.",
    "Results": "Every number of every variant, in submitted order, to filter and to copy.",
    "Explorer": "One variant picked from a list: the share over any limit, the limit for any share, its curves.",
    "Compare": "Variants side by side: percentile boxes against their limits.",
    "Ranking": "Variants worst first, each beside a base variant that you pick.",
    "Contributions": (
        "How much of each variant's spread each dimension causes, and how much of the backlash the disk adds."
    ),
    "Sweep": "Parametric studies: backlash and spread over one dimension or two, and where they cross the limit.",
    "Trade-offs": (
        "Backlash against mass and cost, with the variants that no other beats; the worst variant by each dimension."
    ),
    "Trace": "One variant worked through in formulas, from its inputs to backlash and stress; inputs can be changed.",
    "Trace spread": "The tolerances of that variant added up to the first-order standard deviation, in formulas.",
    "Trace steps": "The sums over points and the search behind single lines of Trace.",
    "Sensitivity": "Which dimension causes the spread: tornado of the worst variant, shares of all.",
    "Tolerances used": "Limits, mean and scatter of every dimension of every variant, and where they come from.",
    "Samples": (
        "What the measured parts say about each dimension: mean, scatter, Cp, Cpk with 95 % intervals, normality."
    ),
    "Sections": "Where along the part the nominal backlash arises.",
    "Strength": "Stress in each section, when it yields or buckles, how stiff the part is.",
    "Drive": "The whole drive: wind-up and other sources added up in formulas by five rules; the catalogue's curve.",
    "Elasticity": "The formula beside two-dimensional elasticity, and the bounds under two lobes.",
    "Stress": "Shear stress in the half-section of the worst checked variants, as pictures.",
    "Findings": "What was found in the submission: each rule with its fix, then every cell.",
    "Submission": "Sheet Variants as read, cell by cell; a coloured cell has a comment that says what is wrong.",
    "Materials": "The materials used, as read or built in.",
    "Tolerances": "The tolerance classes used, as read or built in.",
    "Settings": "The settings as read.",
    "Measurements": "The measured parts as read, one row a part.",
    "Correlations": "The correlations as read, one row a pair of dimensions.",
    "Other sources": "The other sources of the drive's backlash as read.",
    "Levers entered": "What may change, how far and at which cost, as read.",
    "Sweep entered": "The parametric studies as read.",
    "About": "This page: where the numbers come from and what they mean.",
    "Curves": "Stored percentiles behind Summary and Explorer.",
    "Compared": "Stored figures behind Compare, Ranking and Contributions.",
    "Pages": "Stored figures behind Failing variants.",
    "Swept": "Stored curves behind the charts of Sweep.",
    "Inputs": "What was entered and what the program found, behind Trace.",
    "Scatter": "How each dimension scatters, behind Trace spread.",
    "Tied": "Which dimensions scatter together, behind Trace spread.",
    "Drives": "Stored figures behind Drive.",
    "Trace slope": "The formulas of Trace in the middle of the tolerances, with one dimension moved.",
}
"""What each sheet is for, in one line."""

HOW_TO_SHOW = (
    "To see one: right-click the tab of any sheet, Unhide (in LibreOffice: Show Sheet), and pick it from the list."
)
"""How a reader gets at a hidden sheet."""

TABS = "Sheets with orange tabs have yellow cells to change; sheets with grey tabs hold stored numbers."

MODEL = (
    "Backlash here is the lag of the output when the torque reverses: twice the torsional wind-up U of the flexspline.",
    "U = T/(2πG) ∫ ds/(r³ t) along the meridian: tooth rim, wall, junction fillet, disk or flange, hub fillet.",
    "With a tooth face width the torque enters over it from the open end on, and the band of the teeth counts a third: "
    "2 to 7 % less wind-up with a thickened tooth rim, 7 to 18 % without. Blank: it enters at the open end.",
    "Without refinements this is U_cylinder = T l/(G 2π r_m³ Δ) plus U_disk = T/(4π t G) (1/r_ci² − 1/r_co²).",
    "G = E/(2(1 + ν)) unless the material gives G. The wall is thin; its torsion constant is low by (Δ/2r_m)².",
    "A disk that thins as a power of the radius: t = t_hub (r_ci/r)^n. A cone winds up 1/sin of its angle as much.",
    "Shear stress T/(2π r² t); von Mises √3 times it; wall buckling by NASA SP-8007 with its knock-down factor 0.67.",
    "Bending: the wave generator presses the wall out of round by w₀ cos 2θ, twice a turn: 1.5 E Δ w₀/(r_m² (1 − ν²)), "
    "without coning of the mouth and notches. All other stresses are of torsion only.",
    "Two lobes, with --elasticity, of cups with a tooth face width: a bracket from harmonics of elasticity on a "
    "rigid, tight wave generator. Low: all engaged teeth turn by the same angle, the bore is held over the bearing's "
    "width. High: two single teeth carry everything, the bore is held in the bearing's middle alone. There is no "
    "factor for two lobes.",
    "With 25 to 50 % of the teeth engaged, parts of catalogue-like proportions so come to 4 % below to 9 % above the "
    "number without face width, which lies low in the bracket: two single teeth are further up than any drive.",
    "A blank disk thickness is the wall thickness and a blank disk radius the mean radius: one dimension, one scatter.",
)
PROOF = (
    f"B3-160, published finite elements with fillets and tooth rim: 2U = {FINITE_ELEMENTS:.3f}′.",
    f"Two-term formula as published: {TWO_TERMS:.3f}′; at the true mean radius 80.8 mm: 3.635′, by elasticity 3.636′.",
    "With its fillets R 3.5 mm: meridian integral 3.537′, elasticity 3.537′.",
    f"With a tooth rim of 20 mm × 3.2 mm too: meridian integral {WITH_FILLETS_AND_RIM:.3f}′, elasticity 3.411′; of "
    "30 mm: 3.339′ and 3.345′.",
    "So the gap to finite elements is mean radius 1.4 %, fillets 3 %, tooth rim 4 to 6 % (its size is not published).",
    "Against an independent finite-element program usual cups and hats of 1 to 3 % wall were within 1.3 % of the "
    "meridian integral; short thick hats with a rim, cones and strongly thinning disks up to 3 %. The option "
    "--elasticity checks each variant.",
    "Calibration: published finite elements over the two-term formula give 0.907 (cylinder) and 0.936 (disk). Such "
    "factors contain fillets and rim already; relative to the finite elements the formula is 10.0 and 7.07 % high.",
)
LEFT_OUT = (
    "Buckling of the disk; notches, except the fillets' peaks in the elasticity check; an elastic hub; fatigue, except "
    "the warning of an alternating stress.",
    "Two lobes, but for that bracket: backlash and its spread count the load as even around the axis.",
    "The wave generator's fit: radial play of a few µm, or a soft bearing, can add 20 to 130 %, most without a "
    "thickened tooth rim. It is not known from a drawing of the flexspline, and in no number here.",
    "Hub bolts, wave generator bearing and teeth: the wind-up is a lower bound on the drive's total compliance.",
    "Tooth clearance, radial play, couplings and hysteresis: they come on top of this backlash, except what is entered "
    "in Other sources: that counts in the columns System, which no verdict judges.",
    "Plastic deformation: a von Mises stress above yield is flagged, the number stays elastic.",
    "What ties dimensions together beyond the correlations that are entered or measured; a process that drifts.",
)
ERRATA = (
    "The published B3-160 study prints G = 8.10769e10 Pa; its E and ν give 8.11538e10. Its U_cylinder 3.058e-4 rad "
    "follows from neither: with G from E and ν it is 3.064e-4, with the printed G 3.067e-4.",
    "Its cases 4 and 5 print a disk wind-up that falls with r_co; by the formula it rises (2.574e-4 and 1.702e-4 rad).",
    "Its intermediate displacement lacks a factor r_co, its simplified ratio a power of r_m, and the equilibrium "
    "equation it quotes is the radial one.",
    "Its 80 mm is the radius of the bore, not of the middle of the wall: with 80.8 mm the backlash is 1.4 % less.",
    "Its errors of 9.1, 6.6 and 8.0 % are relative to the formula; relative to finite elements they are 10.0, 7.07 "
    "and 8.72 %.",
)

CHECKSUMS = {
    "workbook": "Every part of the workbook was compared with the checksum that its archive holds for it.",
    "csv": "A text table carries no checksum: a digit changed on the way is another number. The sha256 above is that "
    "of the bytes that were read; compare it with the sender's.",
    "parquet": "Pages are compared with their checksums where a Parquet file has them; many programs, Polars among "
    "them, write none. The sha256 above is that of the bytes that were read; compare it with the sender's.",
}
"""What tells whether a file of each kind was read as it was written."""
