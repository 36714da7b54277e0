"""The sheet Trace steps: the sums over points, and the search, that stand behind single lines of Trace."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from flexlash.mechanics import tapered_disk
from flexlash.mechanics.fillets import ARC_RULE, GRADED_RULE, JUNCTION_RULE, UNLIKE, WIDE, added_thickness, arc_radius
from flexlash.mechanics.flexspline import power_law_thickness, tapered_thickness
from flexlash.mechanics.strength import PASSES, STATIONS, shear_stress
from flexlash.mechanics.tapered_disk import TAPER_NODES, TAPER_WEIGHTS
from flexlash.mechanics.windup import wall_integral
from flexlash.report.formula.closed_forms import worked
from flexlash.report.formula.functions import (
    ABS,
    COS,
    EXP,
    IF,
    INDEX,
    LN,
    MATCH,
    MAX,
    MIN,
    OR,
    PI,
    SIN,
    SQRT,
    SUM,
    on_sheet,
)
from flexlash.report.formula.live import Live, Operand, live
from flexlash.report.trace.blocks import Block
from flexlash.report.trace.trace_page import Lines, Page
from flexlash.report.trace.trace_rules import RULES_WIDTH, write_rules

__all__ = ["STEPS", "Steps", "Sums", "set_widths", "shear", "thickness_at"]

STEPS = "Trace steps"
_TITLE_ROW = 3
_WIDTH = 15.5
_JUNCTION, _HUB, _DISK, _SEARCH, _END = RULES_WIDTH + 1, RULES_WIDTH + 7, RULES_WIDTH + 14, RULES_WIDTH + 19, 26
_PROFILE_WORDS = "(t_1 + k (r − r_ci)) (r_ci/r)^n"


def set_widths(sheet: Any) -> None:
    """Set the widths of the columns of sums and search."""
    sheet.set_column(_JUNCTION, _END - 1, _WIDTH)
    for gap in (_JUNCTION, _HUB, _DISK, _SEARCH):
        sheet.set_column(gap - 1, gap - 1, 3)


class Sums:
    """The sums over points behind some lines, on a sheet of this title, side by side below a row."""

    def __init__(self, page: Lines, sheet: Any, title: str, top: int) -> None:
        self.page = page
        self.sheet = sheet
        self.title = title
        self.top = top

    def _block(self, left: int, title: str, formula: str) -> Block:
        return Block(self.page, self.sheet, left=left, row=self.top, heads=(title, formula))

    def junction_fillet(self) -> Live:
        """Return the integral of the junction fillet [1/mm³]."""
        block = self._block(
            _JUNCTION,
            "Junction fillet: ∫ dz/(r³ t), angle p from the wall",
            "a = R (1 − cos p), r = r_m − a/2, t = Δ + a",
        )
        radius, wall, fillet = block.links(r_m="mean_radius", Δ="wall_thickness", R_j="junction_fillet_radius")
        block.heads("cos p", "weight w", "a", "r", "w cos p/(r³ t)")
        for _, cosine_, weight_ in JUNCTION_RULE:
            block.row += 1
            turn, weight = block.cell(0, cosine_), block.cell(1, weight_)
            added = block.cell(2, fillet * (1 - turn))
            middle = block.cell(3, radius - added / 2)
            block.cell(4, worked(wall_integral, weight * turn, middle, wall + added))
        usual = block.entry(f"{len(JUNCTION_RULE)} points: R × sum", fillet * SUM(block.column(4)))

        def height_at(along: Live, _: Live) -> Live:
            added = block.cell(3, worked(added_thickness, fillet, along))
            return worked(wall_integral, 1.0, radius - added / 2, wall + added)

        thin = block.entry("Thin end: width of m", SQRT(wall / (wall + 2 * fillet)))
        ends = graded(block, (thin, live(1.0)), ("a",), height_at)
        taken = IF(fillet > WIDE * wall, fillet * (ends[0] + ends[1]), usual)
        return on_sheet(self.title, block.entry(f"Taken (graded if R > {WIDE:g} Δ)", taken))

    def hub_fillet(self) -> Live:
        """Return the integral of the hub fillet [1/mm³]."""
        block = self._block(
            _HUB,
            "Hub fillet: ∫ dr/(r³ t), angle q from the hub",
            f"r = r_ci + R (1 − cos q), t = {_PROFILE_WORDS} + R (1 − sin q)",
        )
        fillet, inner, *profile = block.links(R_h="hub_fillet_radius", **_PROFILE)
        block.heads("sin q", "cos q", "weight w", "r", "t", "w sin q/(r³ t)")
        for sine_, cosine_, weight_ in ARC_RULE:
            block.row += 1
            rise, turn, weight = (block.cell(column, number) for column, number in enumerate((sine_, cosine_, weight_)))
            radius = block.cell(3, inner + fillet * (1 - turn))
            thickness = block.cell(4, thickness_at(radius, inner, *profile) + fillet * (1 - rise))
            block.cell(5, worked(wall_integral, weight * rise, radius, thickness))
        usual = block.entry(f"{len(ARC_RULE)} points: R × sum", fillet * SUM(block.column(5)))
        last = block.entry("t_e = t at r_ci + R", thickness_at(inner + fillet, inner, *profile))

        def height_at(along: Live, back: Live) -> Live:
            radius = block.cell(3, worked(arc_radius, inner, fillet, along, back))
            added = worked(added_thickness, fillet, along)
            thickness = block.cell(4, thickness_at(radius, inner, *profile) + added)
            return worked(wall_integral, 1.0, radius, thickness)

        ends = graded(block, _hub_widths(block, fillet, inner, profile, last), ("r", "t"), height_at)
        first = profile[0]
        unlike = OR(fillet > UNLIKE * inner, MAX(first, last) > UNLIKE * MIN(first, last))
        steep = OR(fillet > WIDE * MIN(first, last), unlike)
        words = f"Taken (graded if R > {WIDE:g} t or {UNLIKE:g} r_ci, or t_1, t_e unlike)"
        return on_sheet(self.title, block.entry(words, IF(steep, fillet * (ends[0] + ends[1]), usual)))

    def taper(self) -> Live:
        """Return the integral of a disk that thins in a straight line [1/mm³]."""
        block = self._block(_DISK, "Straight taper: ∫ v dv/t between r_s and r_co", "v = 1/r, t = a + b r")
        start, outer, inner_thickness, outer_thickness = block.links(
            r_s="disk_start", r_co="disk_outer_radius", t_s="start_thickness", t_o="outer_thickness"
        )
        low, high = block.entry("v_o = 1/r_co", 1 / outer), block.entry("v_s = 1/r_s", 1 / start)
        reach = block.entry("v_s − v_o", high - low)
        first, last = block.entry("t_o v_o", low * outer_thickness), block.entry("t_s v_s", high * inner_thickness)
        growth = block.entry("t_s v_s − t_o v_o", last - first)
        on_axis = worked(tapered_disk.axis_thickness, first, last, reach)
        on_axis = block.entry("a (1: not used)", on_axis)
        slope = block.entry("b/a", worked(tapered_disk.relative_slope, start, inner_thickness, on_axis))
        closed = worked(tapered_disk.closed_integral, low, high, first, last, on_axis, slope)
        closed = block.entry("Closed form", closed)
        block.heads("place u", "weight w", "v", "w v²/(v t)")
        for node_, weight_ in zip(TAPER_NODES.tolist(), TAPER_WEIGHTS.tolist(), strict=True):
            block.row += 1
            node, weight = block.cell(0, node_), block.cell(1, weight_)
            curvature = block.cell(2, low + reach * node)
            block.cell(3, worked(tapered_disk.summand, weight, curvature, first + growth * node))
        points = block.entry("By points", reach * SUM(block.column(3)))
        is_nearly = worked(tapered_disk.is_nearly_proportional, first, last)
        return on_sheet(self.title, block.entry("Taken (points: t ~ r)", IF(is_nearly, points, closed)))


class Steps(Sums):
    """The sheet Trace steps, written as Trace asks for its results."""

    page: Page

    def __init__(self, page: Page) -> None:
        super().__init__(page, page.book.sheet(STEPS, landscape=False, tab="stored"), STEPS, _TITLE_ROW)
        self.sheet.write_string(0, 0, "Steps behind Trace", page.book.format("title"))
        self.sheet.set_row(0, 28)
        note = (
            "Nothing to enter here: the inputs come from Trace, the results go back there. Lengths in mm, stresses in "
            "MPa. Points and weights are those of the program. Sums and search stand to the right; they do not print."
        )
        self.sheet.merge_range(1, 0, 1, RULES_WIDTH - 1, note, page.book.format("wrap"))
        self.sheet.set_row(1, 47)
        set_widths(self.sheet)
        self.sheet.freeze_panes(_TITLE_ROW, 0)

    def fault(self) -> Live:
        """Write what the inputs must be to make a part; return the first that they are not, else an empty text."""
        said, last = write_rules(self.page, self.sheet, _TITLE_ROW)
        self.sheet.print_area(0, 0, last, RULES_WIDTH - 1)
        return on_sheet(STEPS, said)

    def hub_fillet_shear(self) -> tuple[Live, Live]:
        """Return the greatest shear stress in the hub fillet [MPa] and the radius where it acts [mm]."""
        block = self._block(
            _SEARCH,
            f"Greatest shear in the hub fillet: {PASSES} passes of {STATIONS} stations",
            "Thickness t as for the hub fillet; each pass around the best station before",
        )
        torque, fillet_radius, outer, inner, *profile = block.links(
            T="torque", R_h="hub_fillet_radius", r_co="disk_outer_radius", **_PROFILE
        )
        fillet = block.entry("R = R_h, at most r_co − r_ci", MIN(fillet_radius, outer - inner))
        low, high = block.entry("from place", live(0.0)), block.entry("to place", live(1.0))
        for number in range(1, PASSES + 1):
            block.heads("place 2q/π", "r", "t", "T/(2π r² t)")
            for station in range(STATIONS):
                block.row += 1
                fraction = block.cell(0, low + (high - low) * (station / live(STATIONS - 1.0)))
                angle = fraction * PI / 2
                radius = block.cell(1, inner + fillet * (1 - COS(angle)))
                thickness = block.cell(2, thickness_at(radius, inner, *profile) + fillet * (1 - SIN(angle)))
                block.cell(3, shear(torque, radius, thickness))
            fractions, radii, _, stresses = (block.column(column) for column in range(4))
            best = block.entry(f"best of pass {number}", MATCH(MAX(stresses), stresses, 0))
            if number < PASSES:
                centre, step = INDEX(fractions, best), (high - low) / (STATIONS - 1)
                low, high = (
                    block.entry("from place", MAX(centre - step, 0.0)),
                    block.entry("to place", MIN(centre + step, 1.0)),
                )
        greatest = block.entry("Greatest shear", MAX(stresses))
        radius = block.entry("at radius", INDEX(radii, best))
        return on_sheet(STEPS, greatest), on_sheet(STEPS, radius)


def _hub_widths(block: Block, fillet: Live, inner: Live, profile: Sequence[Live], last: Live) -> tuple[Live, Live]:
    """Write over which widths of m the hub fillet's integrand changes, at its thin end and at its steep one."""
    even = block.entry("Thin end: w_1 of an even disk", SQRT(last / (last + 2 * fillet)))
    radius = worked(arc_radius, inner, fillet, even / 2, 1 - even / 2)
    rise = block.entry("(t − t_e)/w_1 at m = w_1/2", MAX(thickness_at(radius, inner, *profile) - last, 0.0) / even)
    thin = block.entry("Thin end: width of m", last / (last + rise + SQRT(rise**2 + 2 * fillet * last)))
    whole = profile[0] + fillet
    share = MIN(inner / (inner + fillet / 2), whole / (whole + ABS(last - profile[0]) / 2))
    return thin, block.entry("Steep end: width of 1 − m", SQRT(share))


def graded(
    block: Block, widths: tuple[Live, Live], heads: tuple[str, ...], height_at: Callable[[Live, Live], Live]
) -> tuple[Live, Live]:
    """Write the graded points between both ends of an arc and its middle; return the sum of either side."""
    sums = []
    for end, width in zip(("m", "1 − m"), widths, strict=True):
        half = 0.5 / width
        reach = block.entry(f"v at {end} = 1/2, {end} = width sinh v", LN(half + SQRT(half**2 + 1)))
        block.heads("place u", "weight w", end, *heads, "summand")
        for node_, weight_ in GRADED_RULE:
            block.row += 1
            node, weight = block.cell(0, node_), block.cell(1, weight_)
            growth, decay = EXP(reach * node), EXP(-(reach * node))
            near = block.cell(2, width * (growth - decay) / 2)
            along, back = (near, 1 - near) if end == "m" else (1 - near, near)
            height = height_at(along, back)
            pace = weight * reach * width * (growth + decay) / 2
            arc = 2 * back * (1 + along) / (1 + along**2) ** 2
            block.cell(3 + len(heads), pace * arc * height)
        sums.append(block.entry(f"Sum up to {end} = 1/2", SUM(block.column(3 + len(heads)))))
    return sums[0], sums[1]


_PROFILE = {"r_ci": "disk_inner_radius", "t_1": "hub_thickness", "k": "thinning", "n": "thinning_exponent"}


def thickness_at(radius: Operand, inner: Live, thickness: Live, thinning: Live, exponent: Live) -> Live:
    """Return the disk's own thickness at a radius, for every profile [mm]."""
    straight = worked(tapered_thickness, radius, inner, thickness, thinning)
    return worked(power_law_thickness, radius, inner, straight, exponent)


def shear(torque: Live, radius: Live, thickness: Live) -> Live:
    """Return the shear stress of a ring [MPa]."""
    return worked(shear_stress, 1000 * torque, radius, thickness)
