"""Ways to spoil a valid submission, each with the findings it must give: a table of kinds, drawn at random."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from random import Random

from edited_workbooks import HEADER, LETTERS, last_row, records

from flexlash.schema.cell_addresses import column_letters
from flexlash.schema.columns import ENTRY_SHEETS, OPTIONAL_SHEETS, SETTINGS, Column

__all__ = ["KINDS", "Corruption", "corruption"]

Place = tuple[str, str]


@dataclass(frozen=True, kw_only=True)
class Corruption:
    """Cells to replace, the findings to expect, and the cells whose judgement it needs for itself.

    `is_harmless` says that every row stays as it was.
    """

    kind: str
    cells: dict[Place, tuple[str, str]] = field(default_factory=dict)
    expected: tuple[tuple[str, str, str], ...]
    needs: frozenset[tuple[str, int, str]]
    hidden: tuple[tuple[str, int], ...] = ()
    merged: tuple[tuple[str, str], ...] = ()
    is_harmless: bool = False


Kind = Callable[[Random], Corruption]

_NOT_NUMBERS = (
    "1,6", "1.6", "1.6 mm", "1,6 mm", "±0.02", "IT7", "1.600,5", "1'600", "5%", "1/4", "\u22121.6",
    "１.６", "\u00a01.6",
    "0x10", "1e5", "nan", "inf", "-", "?", "TRUE ", "1.6.2", "١٫٦", "1_000", "=1.6", "Ø3", "n/a", "0.02/-0.01", "1 6",
)  # fmt: skip
_ERRORS = ("#REF!", "#DIV/0!", "#VALUE!", "#NAME?", "#N/A", "#NUM!", "#NULL!", "#SPILL!")
_BLANKS = ("", " ", "\u00a0", "\t", " \n ", "\u200b")

_MORE_HEADERS = frozenset({("", HEADER, "more headers")})


def _cell(sheet: str, key: str, row: int) -> Place:
    return sheet, f"{LETTERS[sheet][key]}{row}"


def _row_of(sheet: str, row: int) -> frozenset[tuple[str, int, str]]:
    return frozenset((sheet, row, key) for key in LETTERS[sheet])


def _column_of(sheet: str, key: str) -> frozenset[tuple[str, int, str]]:
    return frozenset((sheet, row, key) for row in range(HEADER, last_row(sheet) + 1))


def _one(
    code: str,
    at: tuple[str, str, int],
    content: tuple[str, str],
    *,
    kind: str = "",
    whole: bool = False,
    **rest: object,
) -> Corruption:
    """Return the corruption of the cell `at` sheet, key and row; `whole` tells that its row must be sound beside it."""
    sheet, key, row = at
    place = _cell(sheet, key, row)
    needs = _row_of(sheet, row) if whole else frozenset({(sheet, row, key)})
    name = f"{code} {kind or key}"
    return Corruption(kind=name, cells={place: content}, expected=((*place, code),), needs=needs, **rest)


@cache
def _entries() -> list[tuple[str, int, Column, bool]]:
    """Return sheet, row, column and whether it is filled of every cell that can be entered, settings by their own."""
    own = {column.key: column for column in SETTINGS}
    found = []
    for sheet, columns in ENTRY_SHEETS.items():
        for row, record in records(sheet).items():
            for column in columns:
                meant = own[record["setting"]] if column.key == "value" else column
                found.append((sheet, row, meant, column.key in record))
    return found


def _drawn(
    random: Random, wanted: Callable[[Column], bool], filled: Callable[[bool], bool] = bool
) -> tuple[str, int, Column, str]:
    """Return sheet, row, column and key of a cell; sheets are equally likely."""
    fitting = [one for one in _entries() if wanted(one[2]) and filled(one[3])]
    sheet = random.choice(sorted({one[0] for one in fitting}))
    _, row, column, _ = random.choice([one for one in fitting if one[0] == sheet])
    return sheet, row, column, column.key if column.key in LETTERS[sheet] else "value"


def _anything(content: Callable[[Random], tuple[str, str]], code: str, wanted: Callable[[Column], bool]) -> Kind:
    """Return the kind that puts something into any cell of some columns, filled or not."""

    def make(random: Random) -> Corruption:
        sheet, row, column, key = _drawn(random, wanted, lambda _: True)
        # Names of the rows of Settings and Tolerances decide what the cells beside them mean.
        whole = sheet in {"Settings", "Tolerances", "Correlations"} and not column.is_number
        return _one(code, (sheet, key, row), content(random), kind=column.key, whole=whole)

    return make


def _is_number(column: Column) -> bool:
    return column.is_number


def _text(random: Random) -> tuple[str, str]:
    return "text", random.choice(_NOT_NUMBERS)


def _error(random: Random) -> tuple[str, str]:
    return random.choice(("error", "text")), random.choice(_ERRORS)


def _date(random: Random) -> tuple[str, str]:
    return "date", str(random.choice((1, 61, 45000, 45000.25, 0.5)))


def _too_small(random: Random) -> Corruption:
    sheet, row, column, key = _drawn(random, lambda one: one.is_number and one.minimum is not None)
    low = column.minimum if column.exclusive_minimum else column.minimum - 1
    near = low - (1 if column.type == "integer" else 1e-9)
    return _one("E207", (sheet, key, row), ("number", str(random.choice((low, low - 3, near)))))


def _too_large(random: Random) -> Corruption:
    sheet, row, column, key = _drawn(random, lambda one: one.is_number and one.maximum is not None)
    return _one("E208", (sheet, key, row), ("number", str(random.choice((2, 1e9)) * column.maximum)))


def _required(random: Random) -> Corruption:
    sheet, row, _, key = _drawn(random, lambda one: one.required and one.key != "setting")
    text = random.choice(_BLANKS)
    content = ("text", text) if text else ("blank", "")
    return _one("E201", (sheet, key, row), content, whole=sheet in {"Tolerances", "Correlations"})


def _choice(random: Random) -> Corruption:
    sheet, row, column, key = _drawn(random, lambda one: bool(one.choices))
    text = random.choice((column.choices[0][:-1] + "zz", f"{column.choices[-1]}x", "other", "0"))
    return _one("E209", (sheet, key, row), ("text", text), whole=key != "distribution")


def _wrong_text(sheet: str, key: str, code: str, *texts: str) -> Kind:
    """Return the kind that puts a text into a column of a sheet; the rest of its row must be sound."""

    def make(random: Random) -> Corruption:
        rows = [row for row, record in records(sheet).items() if key in record]
        return _one(code, (sheet, key, random.choice(rows)), ("text", random.choice(texts)), whole=True)

    return make


def _exact_dimension(random: Random) -> Corruption:
    """Tie a dimension that the class leaves exact, which only a sound class tells."""
    row = random.choice(list(records("Correlations")))
    place = _cell("Correlations", "dimension_2", row)
    return Corruption(
        kind="E347 dimension_2",
        cells={place: ("text", random.choice(("rim_length", "hub_fillet_radius", "rim_thickness")))},
        expected=((*place, "E347"),),
        needs=_row_of("Correlations", row).union(*(_row_of("Tolerances", one) for one in records("Tolerances")), *(
            _row_of("Measurements", one) for one in records("Measurements"))),
    )  # fmt: skip


def _relation(
    code: str, blamed: str, rows: Callable[[dict], bool], changed: Callable[[dict], dict], sheet: str = "Variants"
) -> Kind:
    """Return the kind that changes cells of one row so that they contradict each other; None clears one."""

    def make(random: Random) -> Corruption:
        fitting = [(row, record) for row, record in records(sheet).items() if rows(record)]
        row, record = random.choice(fitting)
        contents = {
            _cell(sheet, key, row): ("blank", "") if value is None else _content(value)
            for key, value in changed(record).items()
        }
        expected = ((*_cell(sheet, blamed, row), code),)
        return Corruption(kind=f"{code} {blamed}", cells=contents, expected=expected, needs=_row_of(sheet, row))

    return make


def _content(value: object) -> tuple[str, str]:
    return ("text", value) if isinstance(value, str) else ("number", repr(value))


def _twice(sheet: str, code: str, blamed: str, *names: str) -> Kind:
    """Return the kind that repeats a row below the last one; both are marked."""

    def make(random: Random) -> Corruption:
        row, record = random.choice([(row, one) for row, one in records(sheet).items() if blamed in one])
        new = last_row(sheet) + 1
        copy = {**record, **{key: _respelt(random, str(record[key])) for key in names}}
        return Corruption(
            kind=f"{code} row twice",
            cells={_cell(sheet, key, new): _content(value) for key, value in copy.items() if value is not None},
            expected=tuple((*_cell(sheet, blamed, one), code) for one in (row, new)),
            needs=_row_of(sheet, row) | _row_of(sheet, new),
        )

    return make


def _respelt(random: Random, text: str) -> str:
    return random.choice((text, text.upper(), f" {text} ", text.replace(" ", "\u00a0")))


def _same_name(random: Random) -> Corruption:
    one, other = random.sample(list(records("Variants")), 2)
    name = str(records("Variants")[one]["variant"])
    places = [_cell("Variants", "variant", row) for row in (one, other)]
    return Corruption(
        kind="E308 name twice",
        cells={places[1]: ("text", _respelt(random, name))},
        expected=tuple((*place, "E308") for place in places),
        needs=frozenset({("Variants", one, "variant"), ("Variants", other, "variant")}),
    )


def _misspelt_reference(key: str, code: str) -> Kind:
    def make(random: Random) -> Corruption:
        rows = [row for row, record in records("Variants").items() if key in record]
        row = random.choice(rows)
        name = str(records("Variants")[row][key])
        text = random.choice((name[:-1], name + "x", name[1:], "unobtainium"))
        return _one(code, ("Variants", key, row), ("text", text))

    return make


def _respelt_name(random: Random) -> Corruption:
    row = random.choice(list(records("Variants")))
    name = str(records("Variants")[row]["variant"])
    text = random.choice((f"  {name}", name.replace(" ", "\u00a0"), f"{name}_x0007_", f"{name}\u202e", f"{name}\u200b"))
    return _one("I504", ("Variants", "variant", row), ("text", text), is_harmless=True)


def _huge(random: Random) -> Corruption:
    row = random.choice(list(records("Variants")))
    place = _cell("Variants", "torque_Nm", row)
    # Only a row that is computed shows it, so nothing that it depends on may be spoilt.
    others = {(sheet, number) for sheet in LETTERS if sheet != "Variants" for number in records(sheet)}
    return Corruption(
        kind="E324 huge",
        cells={place: ("number", random.choice(("1e300", "1e30")))},
        expected=((*place, "E324"),),
        needs=_row_of("Variants", row).union(_MORE_HEADERS, *(_row_of(*other) for other in others)),
    )


def _infinite(random: Random) -> Corruption:
    sheet, row, _, key = _drawn(random, _is_number)
    return _one("E212", (sheet, key, row), ("number", random.choice(("1e999", "-1E400"))), kind="infinite")


def _lone(random: Random) -> Corruption:
    sheet = random.choice(list(LETTERS))
    letters = random.choice(list(LETTERS[sheet].values())[1:])
    cell = f"{letters}{last_row(sheet) + random.randint(3, 5000)}"
    contents = random.choice((("text", "x"), ("number", "7"), ("date", "45000"), ("error", "#N/A")))
    return Corruption(
        kind="lone cell",
        cells={(sheet, cell): contents},
        expected=((sheet, cell, "W408"),),
        needs=frozenset({(sheet, 0, "lone")}),
        is_harmless=True,
    )


def _far(random: Random) -> Corruption:
    row = last_row("Variants") + random.randint(90, 900)
    copy = {**random.choice(list(records("Variants").values())), "variant": "Far below"}
    return Corruption(
        kind="row far below",
        cells={_cell("Variants", key, row): _content(value) for key, value in copy.items()},
        expected=(("Variants", f"A{row}", "W427"),),
        needs=frozenset({("Variants", 0, "lone")}),
        is_harmless=True,
    )


def _hidden(random: Random) -> Corruption:
    sheet = random.choice(list(LETTERS))
    row = random.choice(list(records(sheet)))
    # Hidden rows that follow one another are told at the first of them.
    needs = frozenset((sheet, number, "hidden") for number in (row - 1, row, row + 1))
    expected = ((sheet, f"A{row}", "W425"),)
    return Corruption(kind="hidden row", expected=expected, needs=needs, hidden=((sheet, row),), is_harmless=True)


def _merged(random: Random) -> Corruption:
    sheet = random.choice(("Variants", "Materials", "Tolerances", "Measurements", "Correlations"))
    fitting = [
        (row, column.key)
        for row, column in ((row, column) for row in list(records(sheet))[1:] for column in ENTRY_SHEETS[sheet])
        if column.key in records(sheet)[row - 1] and column.key not in {"notes", "source", "part", "reason"}
    ]
    row, key = random.choice(fitting)
    letters = LETTERS[sheet][key]
    return Corruption(
        kind="merged cells",
        cells={_cell(sheet, key, row): ("blank", "")},
        expected=((sheet, f"{letters}{row}", "E214"),),
        needs=_row_of(sheet, row) | _row_of(sheet, row - 1),
        merged=((sheet, f"{letters}{row - 1}:{letters}{row}"),),
    )


def _header(
    code: str, changed: Callable[[Random, Column], str], wanted: Callable[[Column], bool], *, is_harmless: bool = False
) -> Kind:
    """Return the kind that writes something else in the place of a header."""

    def make(random: Random) -> Corruption:
        columns = [one for columns in ENTRY_SHEETS.values() for one in columns if wanted(one) and _is_filled(one)]
        sheet = random.choice(sorted({one.sheet for one in columns}))
        column = random.choice([one for one in columns if one.sheet == sheet])
        place = _cell(sheet, column.key, HEADER)
        needs = _column_of(sheet, column.key)
        if not is_harmless and column.required:
            # Without names in Materials or Tolerances nobody can say which references are wrong.
            needs |= _column_of("Variants", column.key) if column.key in LETTERS["Variants"] else frozenset()
            needs = needs.union(*(_row_of(sheet, row) for row in records(sheet))) if sheet != "Variants" else needs
        content = ("text", changed(random, column))
        return Corruption(
            kind=f"{code} header",
            cells={place: content},
            expected=((*place, code),),
            needs=needs,
            is_harmless=is_harmless,
        )

    return make


def _is_filled(column: Column) -> bool:
    """Whether a column has an entry; of an empty one a slip in the header is another finding."""
    optional = column.sheet in OPTIONAL_SHEETS or column.since > 3
    return not optional or any(column.key in record for record in records(column.sheet).values())


def _mistyped(random: Random, column: Column) -> str:
    """Return a header with one slip of the keyboard in its longest word."""
    word = max(column.name.replace("'", " ").split(), key=len)
    place = random.randrange(1, len(word) - 2)
    slips = (
        word[:place] + word[place + 1 :],
        word[:place] + word[place] + word[place:],
        word[:place] + "q" + word[place + 1 :],
    )
    return column.label.replace(word, random.choice(slips), 1)


def _in_a_strange_unit(random: Random, column: Column) -> str:
    return f"{column.name} [{random.choice(('furlong', 'kg', 'stone', '%%', 'mm²'))}]"


def _header_twice(random: Random) -> Corruption:
    sheet = random.choice(list(LETTERS))
    column = random.choice(ENTRY_SHEETS[sheet])
    place = column_letters(len(ENTRY_SHEETS[sheet]) + 3)
    name = random.choice((column.label, column.key, column.label.upper()))
    return Corruption(
        kind="W436 header twice, over an empty column",
        cells={(sheet, f"{place}{HEADER}"): ("text", name)},
        expected=((sheet, f"{place}{HEADER}", "W436"),),
        needs=_MORE_HEADERS,
        is_harmless=True,
    )


def _header_missing(random: Random) -> Corruption:
    sheet = random.choice(("Variants", "Materials", "Tolerances"))
    column = random.choice([one for one in ENTRY_SHEETS[sheet] if one.required])
    # Told at the first free header cell; that of the row status is the last one on Variants and Tolerances.
    free = column_letters(len(ENTRY_SHEETS[sheet]) + (1 if sheet == "Materials" else 2))
    needs = _MORE_HEADERS.union(*(_row_of(sheet, row) for row in records(sheet)))
    return Corruption(
        kind="E111 header missing",
        cells={_cell(sheet, column.key, HEADER): ("blank", "")},
        expected=((sheet, f"{free}{HEADER}", "E111"),),
        needs=needs | _column_of("Variants", "material") | _column_of("Variants", "tolerance_class"),
    )


def _extra_column(random: Random) -> Corruption:
    sheet = random.choice(list(LETTERS))
    place = column_letters(len(ENTRY_SHEETS[sheet]) + 3)
    row = random.choice(list(records(sheet)))
    return Corruption(
        kind="I502 extra column",
        cells={(sheet, f"{place}{HEADER}"): ("text", "Drawing 4711"), (sheet, f"{place}{row}"): ("text", "=1+1")},
        expected=((sheet, f"{place}{HEADER}", "I502"),),
        needs=_MORE_HEADERS,
        is_harmless=True,
    )


def _has(**wanted: object) -> Callable[[dict], bool]:
    """Return the test whether a row holds these values; True stands for any value, None for a blank cell."""
    return lambda row: all((key in row) if value is True else row.get(key) == value for key, value in wanted.items())


_CUP = _has(flexspline_type="cup", mean_radius_mm=True)
_HAT = _has(flexspline_type="hat")
_DEVIATIONS = _has(lower_deviation=True)
_FOREIGN = ("disk_thickness_mm", "disk_inner_radius_mm", "disk_outer_radius_mm", "disk_cone_angle_deg")

KINDS: tuple[Kind, ...] = (
    _anything(_text, "E202", _is_number),
    _anything(_text, "E202", _is_number),
    _anything(lambda random: ("boolean", random.choice("01")), "E204", lambda _: True),
    _anything(_error, "E205", lambda _: True),
    _anything(_date, "E203", lambda _: True),
    _anything(lambda _: ("unstored", ""), "E206", lambda _: True),
    _anything(lambda _: ("text", "x" * 1001), "E222", lambda column: not column.is_number),
    _too_small,
    _too_large,
    _infinite,
    _huge,
    _required,
    _choice,
    _respelt_name,
    _same_name,
    _misspelt_reference("material", "E307"),
    _misspelt_reference("tolerance_class", "E309"),
    _wrong_text("Tolerances", "grade", "E210", "IT77", "K7", "h 13", "7", "2768-x", "js4"),
    _wrong_text("Tolerances", "deviation_unit", "E211", "kg", "%%", "millimetre?", "s"),
    _wrong_text("Tolerances", "sample", "E223", "lathe", "lathe 33", "other", "gauge 2"),
    _wrong_text("Tolerances", "based_on", "E224", "care", "shopp", "unobtainium"),
    _wrong_text("Correlations", "tolerance_class", "E309", "shopp", "unobtainium", "gaugedd"),
    _exact_dimension,
    _wrong_text("Measurements", "use_as", "E342", "value"),
    _twice("Variants", "E308", "variant", "variant"),
    _twice("Materials", "E321", "material", "material"),
    _twice("Tolerances", "E319", "dimension", "tolerance_class"),
    _twice("Settings", "E323", "setting"),
    _twice("Correlations", "E345", "dimension_2", "tolerance_class"),
    _relation("E301", "mean_radius_mm", lambda _: True, lambda _: {"mean_radius_mm": None, "bore_diameter_mm": None}),
    _relation("E302", "mean_radius_mm", _CUP, lambda row: {"bore_diameter_mm": 1.98 * row["mean_radius_mm"]}),
    _relation("E303", "disk_inner_radius_mm", _CUP, lambda row: {"disk_inner_radius_mm": 1.1 * row["mean_radius_mm"]}),
    _relation("E303", "disk_inner_radius_mm", _HAT, lambda row: {"disk_outer_radius_mm": 0.9 * row["mean_radius_mm"]}),
    _relation("E304", "rim_thickness_mm", _has(rim_length_mm=True), lambda _: {"rim_thickness_mm": None}),
    _relation("E304", "rim_length_mm", _has(rim_length_mm=True), lambda _: {"rim_length_mm": None}),
    _relation("E305", "rim_length_mm", _has(rim_length_mm=True),
              lambda row: {"rim_length_mm": row["cylinder_length_mm"]}),
    _relation("E306", "rim_thickness_mm", _has(rim_length_mm=True), lambda _: {"rim_thickness_mm": 0.9}),
    *(
        _relation("E310", key, _has(flexspline_type="cylinder"), lambda _, key=key: {key: 45.0})
        for key in _FOREIGN
    ),
    _relation("E310", "hub_fillet_radius_mm", _HAT, lambda _: {"hub_fillet_radius_mm": 1.5}),
    _relation("E311", "disk_inner_radius_mm", _CUP, lambda _: {"disk_inner_radius_mm": None}),
    _relation("E311", "disk_outer_radius_mm", _HAT, lambda _: {"disk_outer_radius_mm": None}),
    _relation("E312", "hub_fillet_radius_mm", _has(hub_fillet_radius_mm=True),
              lambda _: {"hub_fillet_radius_mm": 40.0}),
    _relation("E360", "tooth_face_width_mm", lambda _: True,
              lambda row: {"tooth_face_width_mm": 1.2 * row["cylinder_length_mm"]}),
    _relation("E313", "junction_fillet_radius_mm", _has(hub_fillet_radius_mm=True),
              lambda _: {"junction_fillet_radius_mm": 110.0}),
    _relation("E325", "disk_hub_thickness_mm", _has(disk_thickness_exponent=True),
              lambda _: {"disk_hub_thickness_mm": None}),
    _relation("E326", "disk_thickness_mm", _has(disk_thickness_exponent=True), lambda _: {"disk_thickness_mm": 1.2}),
    _relation("E327", "hub_fillet_radius_mm", _has(disk_cone_angle_deg=True), lambda _: {"hub_fillet_radius_mm": 1.0}),
    _relation("E316", "grade", _DEVIATIONS, lambda _: {"grade": "IT7"}, "Tolerances"),
    _relation("E317", "upper_deviation", _DEVIATIONS, lambda _: {"upper_deviation": None}, "Tolerances"),
    _relation("E317", "lower_deviation", _DEVIATIONS, lambda _: {"lower_deviation": None}, "Tolerances"),
    _relation("E318", "lower_deviation", _DEVIATIONS, lambda row: {
        "lower_deviation": row["upper_deviation"], "upper_deviation": row["lower_deviation"]}, "Tolerances"),
    _relation("E320", "grade", _has(dimension="torque"), lambda _: {
        "grade": "IT7", "lower_deviation": None, "upper_deviation": None}, "Tolerances"),
    _relation("E322", "youngs_modulus_GPa", _has(shear_modulus_GPa=None), lambda _: {"youngs_modulus_GPa": None},
              "Materials"),
    _relation("E322", "poisson_ratio", _has(shear_modulus_GPa=None), lambda _: {"poisson_ratio": None}, "Materials"),
    _relation("E335", "cp", _has(cp=True), lambda _: {"limits_sigma": 3.0}, "Tolerances"),
    _relation("E335", "cp", _has(cp=True), lambda _: {"standard_deviation": 0.01}, "Tolerances"),
    _relation("E335", "sample", _has(sample=True, distribution=None), lambda _: {"cp": 1.1}, "Tolerances"),
    _relation("E335", "mean_shift", _has(sample=True, distribution=None), lambda _: {"mean_shift": 0.001},
              "Tolerances"),
    _relation("E336", "cpk", _has(cp=True), lambda _: {"cp": None}, "Tolerances"),
    _relation("E336", "cpk", _has(cp=True), lambda row: {"cpk": row["cp"] + 0.1}, "Tolerances"),
    _relation("E337", "cp", _has(distribution="uniform"), lambda _: {"cp": 1.2}, "Tolerances"),
    _relation("E337", "standard_deviation", _has(distribution="measured"), lambda _: {"standard_deviation": 0.01},
              "Tolerances"),
    _relation("E338", "grade", _has(based_on=True), lambda _: {"grade": "IT7"}, "Tolerances"),
    _relation("E338", "based_on", _has(dimension="cylinder_length"), lambda _: {"based_on": "coarse"}, "Tolerances"),
    _relation("E338", "based_on", _has(based_on="careful"), lambda _: {"based_on": "shop"}, "Tolerances"),
    _relation("E339", "mean_shift", _has(mean_shift=True), lambda _: {"mean_shift": 5000.0}, "Tolerances"),
    _relation("E346", "dimension_2", _has(dimension_1=True), lambda row: {"dimension_2": row["dimension_1"]},
              "Correlations"),
    _relation("E207", "wall_thickness_mm", _has(sample="gauge"), lambda row: {
        "wall_thickness_mm": -row["wall_thickness_mm"]}, "Measurements"),
    _relation("W446", "wall_thickness_mm", _has(sample="gauge"), lambda row: {
        "wall_thickness_mm": 10 * row["wall_thickness_mm"]}, "Measurements"),
    _lone,
    _far,
    _hidden,
    _merged,
    _header("E112", _mistyped, lambda column: len(column.name) > 9),
    _header("E113", _in_a_strange_unit, lambda column: column.is_number and column.unit not in {"", "-"}),
    _header("I503", lambda _, column: column.name, lambda column: column.is_number and column.unit not in {"", "-"},
            is_harmless=True),
    _header("I501", lambda *_: "Backlash limit [deg]", lambda column: column.key == "backlash_limit_arcmin",
            is_harmless=True),
    _header_twice,
    _header_missing,
    _extra_column,
)  # fmt: skip
"""Every kind; those that spoil a cell by itself know no other cell of its row."""


def corruption(random: Random, most: int) -> list[Corruption]:
    """Return one to `most` corruptions that do not hide one another."""
    found: list[Corruption] = []
    for _ in range(random.randint(1, most)):
        new = random.choice(KINDS)(random)
        needed = frozenset().union(*(one.needs for one in found))
        if not new.needs & needed:
            found.append(new)
    return found
