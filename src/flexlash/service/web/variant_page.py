"""What the page of a variant shows: how its backlash is spread, what causes that, where the wind-up arises."""

from __future__ import annotations

from dataclasses import dataclass

from markupsafe import Markup

from flexlash.mechanics.sketch.drawing_marks import Area, Drawing, Label, Mark, Stroke
from flexlash.mechanics.sketch.sketch_svg import svg
from flexlash.report.page.shape import PageFacts, Sketch, SketchMark, VariantPage
from flexlash.report.pictures.variant_charts import variant_charts
from flexlash.service.records import StoredSubmission

__all__ = ["VariantView", "sketch_picture", "variant_view"]


@dataclass(frozen=True, kw_only=True)
class VariantView:
    """A variant's own page; `place` is from 0 among so many, `before` and `after` the names of its neighbours."""

    id: str
    name: str
    page: VariantPage
    place: int
    of: int
    before: str
    after: str
    sketch: Markup | None
    density: Markup
    causes: Markup | None
    segments: Markup | None


def variant_view(submission: StoredSubmission, facts: PageFacts, place: int) -> VariantView | None:
    """Return the page of the variant at a place, from 0; None where there is none."""
    pages = facts["variants"]
    if not 0 <= place < len(pages):
        return None
    page = pages[place]
    charts = variant_charts(page["density"], page["shares"], page["segments"])
    markup = {name: Markup(picture.inline()) for name, picture in charts.items()}  # noqa: S704
    return VariantView(
        id=submission.id,
        name=submission.name,
        page=page,
        place=place,
        of=len(pages),
        before=pages[place - 1]["variant"] if place else "",
        after=pages[place + 1]["variant"] if place + 1 < len(pages) else "",
        sketch=sketch_picture(page["sketch"]) if "sketch" in page else None,
        density=markup["density"],
        causes=markup.get("causes"),
        segments=markup.get("segments"),
    )


def sketch_picture(sketch: Sketch) -> Markup:
    """Return the sketch of the part as SVG, in which everything is escaped as XML."""
    drawing = Drawing(
        width=sketch["width"],
        height=sketch["height"],
        title=sketch["title"],
        description=sketch["description"],
        marks=tuple(map(_mark, sketch["marks"])),
    )
    return Markup(svg(drawing))  # noqa: S704


def _mark(mark: SketchMark) -> Mark:
    points = tuple((x, y) for x, y in mark["points"])
    if mark["kind"] == "area":
        return Area(points=points, fill=mark["colour"], hatch=mark["hatch"])
    if mark["kind"] == "stroke":
        return Stroke(points=points, colour=mark["colour"], width=mark["width"], dashed=mark["dashed"])
    (x, y), *_ = points
    return Label(x=x, y=y, words=mark["words"], colour=mark["colour"], anchor=mark["anchor"])
