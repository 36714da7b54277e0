"""The catalogue of findings: the one place where a code gets its words.

Terminal, report, `flexlash explain` and the notes of a checked workbook print from here.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

__all__ = ["CATALOGUE", "Level", "Rule"]

Level = Literal["error", "warning", "info"]


@dataclass(frozen=True, kw_only=True)
class Rule:
    """A code of the catalogue: its title, message and fix, and what it means at length.

    `message` and `fix` are format strings; `{place}` and `{name}` are the address and the column's name.
    """

    code: str
    title: str
    message: str
    fix: str
    explanation: str

    @property
    def level(self) -> Level:
        """The level that the code's letter stands for."""
        levels: dict[str, Level] = {"E": "error", "W": "warning", "I": "info"}
        return levels[self.code[0]]


def _rules(*entries: tuple[str, str, str, str, str]) -> dict[str, Rule]:
    return {
        code: Rule(code=code, title=title, message=message, fix=fix, explanation=explanation)
        for code, title, message, fix, explanation in entries
    }


CATALOGUE = _rules(
    (
        "E101",
        "not a submission",
        "{file} cannot be read as a submission: {found}.",
        "Submit a filled template (.xlsx), or a table as .csv or .parquet.",
        "flexlash judges a file by its content, not its name. It reads Excel workbooks, CSV text and Parquet.",
    ),
    (
        "E102",
        "damaged file",
        "{file} is damaged: a part of it is missing, altered or out of order.",
        "Open it in Excel, let Excel repair it, save it as .xlsx and submit that.",
        "A half-finished copy, a broken transfer or a tool that writes faulty workbooks can cause this. "
        "A damaged file is never read in part, since a number in it might be wrong.",
    ),
    (
        "E103",
        "password-protected file",
        "{file} is protected by a password and cannot be read.",
        "In Excel: File, Info, Protect Workbook, remove the password; then save and submit again.",
        "flexlash never asks for passwords. Sheet protection without encryption does no harm.",
    ),
    (
        "E104",
        "other workbook format",
        "{file} is {found}; an .xlsx workbook is required.",
        "Open it in Excel or LibreOffice and save it as Excel Workbook (.xlsx).",
        "Old Excel files (.xls), binary workbooks (.xlsb) and OpenDocument files (.ods) are refused by name.",
    ),
    (
        "E105",
        "unsafe content",
        "{file} holds hidden instructions for other programs, which an Excel workbook never needs.",
        "Copy the cells into a fresh template and submit that.",
        "Such instructions are used to attack programs that read the file. Excel never writes them.",
    ),
    (
        "E106",
        "unknown kind of workbook",
        "{file} looks like a workbook, but names its parts in a way that flexlash does not know.",
        "Open it in Excel and save it as Excel Workbook (.xlsx).",
        "Workbooks saved as Strict Open XML are read; some programs write yet another kind, never guessed at.",
    ),
    (
        "E107",
        "text encoding",
        "{file} is a text table whose characters cannot be decoded: neither Unicode nor Windows-1252.",
        "In Excel: Save As, type CSV UTF-8.",
        "UTF-8, UTF-16 with its mark and Windows-1252 are read. In other encodings µ, Δ and names with accents would "
        "be misread.",
    ),
    (
        "E108",
        "sheet missing",
        "{file} has no sheet Variants; it has {found}.",
        "Start from the template (flexlash template) or rename the sheet to Variants.",
        "The Variants sheet holds one row per flexspline variant. Materials, Tolerances and Settings may be absent.",
    ),
    (
        "E109",
        "header row not found",
        "{place}: rows 1 to 15 hold no header row of the template.",
        "Copy the header row of the template above the data.",
        "Headers are recognised by the template's label or by the column's key, in any order.",
    ),
    (
        "E110",
        "too large",
        "{file} exceeds a limit: {what} is {found}; at most {limit} is allowed (setting {setting}){detail}.",
        "Split the submission, copy the cells into a fresh template, or raise the limit: --limit {setting}=NUMBER.",
        "Limits keep one damaged or hostile file from stopping the work of others.",
    ),
    (
        "E111",
        "column missing",
        "{place}: the header row lacks the required column {name}.",
        "Add the column with this header: {label}.",
        "Required columns are tinted in the template. Optional columns may be left out.",
    ),
    (
        "E112",
        "misspelt header",
        '{place}: the header "{value}" is unknown.',
        "Write {label}, or a name that does not resemble a column of the template.",
        "A misspelt optional column would otherwise be left out of the calculation silently; a required one would be "
        "missing. Rows that hold a value under it are not computed.",
    ),
    (
        "E113",
        "unknown unit",
        '{place}: the unit in the header "{value}" is unknown; {name} is measured in {unit}.',
        "Write {label} and enter the values in {unit}.",
        "Units that measure the same quantity are converted; flexlash does not guess at others. "
        "Rows that hold a value under it are not computed.",
    ),
    (
        "E114",
        "column twice",
        "{place}: {name} is already in column {other}.",
        "Delete one of the two columns.",
        "With two columns of one meaning flexlash cannot know which one applies.",
    ),
    (
        "E115",
        "no variants",
        "{place}: there is no row with data below the header row.",
        "Enter one row per variant below the header row.",
        "A row that holds only white space or the template's own status formula counts as empty.",
    ),
    (
        "E116",
        "newer template",
        "{file} was made from template version {found}; this program knows up to version {known}.",
        "Update flexlash, or copy the rows into a template of this version.",
        "A newer template may hold columns that this program would not take into account.",
    ),
    (
        "E117",
        "two sheets of one name",
        "{file} has two sheets whose names differ only in case or spaces: {other} and {found}.",
        "Rename or delete one of them.",
        "With two sheets of one name flexlash cannot know which one applies.",
    ),
    (
        "E118",
        "reading failed",
        "{file} stopped the program that reads it; nothing of it was used.",
        "Open it in Excel, save it under a new name as .xlsx and submit that, or copy the cells into a fresh template.",
        "Files are read by a separate process with little memory and time, so that a faulty file stops only itself.",
    ),
    (
        "E120",
        "not a report",
        "{file} is not a report made by flexlash.",
        "Give a report, <name>-report.xlsx; a submission is computed without --from-report.",
        "With --from-report everything is computed anew from a report alone, without the file it was made from.",
    ),
    (
        "E121",
        "report without its inputs",
        "{file} carries no inputs: an older version made it, or its hidden sheet Carried was deleted.",
        "Run the submission that it was made from; its name is on the report's sheet About.",
        "A report carries what was read on a hidden sheet, with every digit, so that the report alone is enough.",
    ),
    (
        "E122",
        "inputs of a report unreadable",
        "{file} carries inputs that cannot be read: {found}.",
        "Take the report as flexlash wrote it, or run the submission that it was made from.",
        "The hidden sheet Carried is checked as every submission is; nothing of it is used when one part is wrong.",
    ),
    (
        "E127",
        "several sheets of one kind",
        "{place}: several sheets have the headers of {other}, but not one has its name: {found}.",
        "Rename the one that is meant to {other}, and delete the others or submit them on their own.",
        "A sheet of another name is read when it alone has the headers of an entry sheet. Of several, only their "
        "author knows which one applies.",
    ),
    (
        "E128",
        "diameter instead of a radius",
        '{place}: the header "{value}" names a diameter, but flexlash takes the {name}.',
        "Enter half of each value under {label}{detail}.",
        "Cylinder and disk are entered by their radii; the bore alone may be given as a diameter. Rows that hold a "
        "value under such a header are not computed.",
    ),
    (
        "E201",
        "required cell empty",
        "{place} {name} is empty: {requirement} is required.",
        "Fill in the cell.",
        "Required columns are tinted in the template.",
    ),
    (
        "E202",
        "text instead of a number",
        '{place} {name} = "{value}": {requirement} is required.',
        "Type the number alone, without unit, with the decimal sign that your program uses.",
        "A cell can look like a number and be text: a comma where Excel expects a point, a unit behind the "
        "number, a stray space, a leading apostrophe. In a table separated by semicolons, tabs or bars 1.050 may be "
        "1.05 or 1050, unless a number with one, two or more than three decimals shows that the point is the decimal "
        "sign. flexlash never guesses at a dimension.",
    ),
    (
        "E203",
        "date or time instead of an entry",
        "{place} {name} holds the {kind} {value}: {requirement} is required.",
        "Format the cell as Number (or Text for a name), then type the entry again.",
        "Excel turns entries such as 1/4 or 1-2 into dates unless the cell was formatted beforehand.",
    ),
    (
        "E204",
        "TRUE or FALSE instead of an entry",
        "{place} {name} = {value}: {requirement} is required.",
        "Type the entry itself.",
        "A truth value is not a number and not a name.",
    ),
    (
        "E205",
        "error in a cell",
        "{place} {name} shows {value}: {requirement} is required.",
        "Correct the formula, or type the value.",
        "The cell's formula failed, so there is no value to compute with.",
    ),
    (
        "E206",
        "formula without a result",
        "{place} {name} holds a formula without a stored result.",
        "Open the file in Excel, let it calculate, save it; or type the value.",
        "Programs that write workbooks often store a formula without its result. flexlash reads results.",
    ),
    (
        "E207",
        "number too small",
        "{place} {name} = {value}: {requirement} is required.",
        "Check the value and its unit.",
        "Dimensions, torques and moduli are greater than 0; fillets and exponents may be 0, a cone starts at 30°.",
    ),
    (
        "E208",
        "number too large",
        "{place} {name} = {value}: {requirement} is required.",
        "Check the value and its unit.",
        "The value is greater than any that makes sense here.",
    ),
    (
        "E209",
        "not in the list",
        '{place} {name} = "{value}": {requirement} is required.',
        "Choose one of these: {choices}.",
        "Letter case and spaces do not matter; the word must be on the list.",
    ),
    (
        "E210",
        "unknown grade",
        '{place} {name} = "{value}" is not a grade; IT7, js7, h7, H7 or 2768-m, for instance, is required.',
        "Enter such a grade, or lower and upper deviation instead.",
        "Grades are IT, js, h or H with 5 to 12, and 2768-f, -m, -c, -v. h lies below the nominal value, H above, js "
        "and IT on both sides. Letter case matters: h is not H.",
    ),
    (
        "E211",
        "unit does not fit",
        '{place} {name} = "{value}": {dimension} takes {unit} or % of the entered value.',
        "Enter a unit that measures the dimension, or leave the cell blank for {unit}.",
        "Lengths take any length unit, torque and moduli their own, ratios and calibrations - .",
    ),
    (
        "E212",
        "value not usable",
        "{place} {name} = {value}: {requirement} is required; this is not finite.",
        "Type a number that Excel can show.",
        "Infinity and numbers too large for a computer, such as 1e400, cannot be used.",
    ),
    (
        "E213",
        "not a whole number",
        "{place} {name} = {value}: {requirement} is required.",
        "Type a whole number.",
        "A count, such as seed or samples, has no decimals.",
    ),
    (
        "E214",
        "merged cells",
        "{place} {name} is hidden under the merged cells {other}: {requirement} is required.",
        "Unmerge the cells and fill each of them.",
        "Merged cells hold one value at their top left corner; the others are empty, whatever they seem to show.",
    ),
    (
        "E215",
        "more cells than headers",
        '{place} = "{value}": the row has more cells than there are headers; {detail}.',
        "Separate the columns by semicolons, or write decimal points; clear the cell if it is stray.",
        "In a table separated by commas 1,6 without quotes fills two cells and moves all that follow under the wrong "
        "headers. Nothing of such a row is used but its first column.",
    ),
    (
        "E216",
        "percentage instead of a number",
        "{place} {name} shows {value}: {requirement} is required.",
        "Format the cell as Number and type the value; for a tolerance in per cent choose % as its deviation unit.",
        "Excel stores 5% as 0.05. For a length, torque or modulus it is not certain which of the two is meant.",
    ),
    (
        "E217",
        "nothing but a name",
        '{place}: the row "{value}" holds no number, so it is not a variant.',
        "Fill the row, or delete it.",
        "A variant needs a torque, a length, a radius and a wall. A row that lacks them all is reported once, not "
        "cell by cell.",
    ),
    (
        "E219",
        "units differ",
        "{place}: the row of units gives {value} for {name}, but its header is read in {other}.",
        "Write the unit in the header's brackets, then delete the row of units.",
        "A row of units below the headers is read only to compare it with them. Rows that hold a value in such a "
        "column are not computed, since it is not certain which of the two applies.",
    ),
    (
        "E220",
        "numbers stored as text",
        "{place} {name} holds {suggestion} as text, not as a number.",
        "In Excel (green corner): select the cells, click the sign beside them, Convert to Number. Or let flexlash "
        "check --apply-fixes fix all of them.",
        "Exports, a leading apostrophe and cells formatted as Text store a number as text. It looks the same, but no "
        "program calculates with it.",
    ),
    (
        "E221",
        "no value",
        '{place} {name} = "{value}" stands for no value; {detail}.',
        "Leave the cell blank where the column is optional; else enter the value.",
        "n/a, TBD, a dash, a question mark and what programs write for a missing number say that there is no value. A "
        "blank optional cell means its default; the template's notes say which.",
    ),
    (
        "E222",
        "text too long",
        "{place} {name} has {found} characters; at most {limit} are allowed.",
        "Shorten the text.",
        "Names may have 200 characters, notes and sources 1,000.",
    ),
    (
        "E223",
        "unknown sample",
        '{place} {name} = "{value}": {detail} is not in Measurements.',
        "Write the name of a sample as Measurements has it, or add its rows and the column of the dimension there.",
        "A row of Tolerances takes mean and standard deviation from the values of its dimension in a sample of "
        "Measurements; letter case and spaces of the name do not matter.",
    ),
    (
        "E224",
        "unknown class to base on",
        '{place} {name} = "{value}" is not a class of Tolerances.',
        "Write the name of a class as Tolerances has it, or add rows for it.",
        "A class takes over every row of the class it is based on that it does not have itself. Class standard is "
        "built in and may be named even though it has no rows.",
    ),
    (
        "E301",
        "no radius",
        "{place}: neither {name} nor Bore diameter is given; one of them is required.",
        "Enter the mean radius, or the bore diameter from which it follows.",
        "Mean radius = bore/2 + wall/2. Give the one that the drawing tolerances.",
    ),
    (
        "E302",
        "two radii",
        "{place}: {name} = {value} and Bore diameter = {other} are both given; one of them is required.",
        "Clear one of the two cells.",
        "Mean radius = bore/2 + wall/2, so a second entry could only repeat or contradict the first.",
    ),
    (
        "E303",
        "hub outside the disk",
        "{place} {name} = {value} mm: less than the disk's outer radius {other} mm is required.",
        "Check for a diameter entered as a radius.",
        "The disk reaches from its inner to its outer radius. A blank outer radius is the mean radius.",
    ),
    (
        "E304",
        "half a rim",
        "{place}: Tooth rim length and thickness belong together; {name} is empty.",
        "Fill both cells, or clear both.",
        "The tooth rim replaces a part of the wall; its length alone or thickness alone says nothing.",
    ),
    (
        "E305",
        "rim longer than the cylinder",
        "{place} {name} = {value} mm: less than the cylinder length {other} mm is required.",
        "Check both lengths; the cylinder length includes the rim.",
        "The cylinder length runs from the disk's inner face to the open end.",
    ),
    (
        "E306",
        "rim thinner than the wall",
        "{place} {name} = {value} mm: at least the wall thickness {other} mm is required.",
        "Enter the total thickness of the rim, wall included.",
        "Rim and wall have the same bore; the rim is the thicker part.",
    ),
    (
        "E307",
        "unknown material",
        '{place} {name} = "{value}" is not a row of Materials.',
        "Write the name of a material as Materials has it, or add a row to Materials (sheet, or file of --materials).",
        "The name must be that of a row of Materials; letter case and spaces do not matter.",
    ),
    (
        "E308",
        "variant twice",
        '{place} {name} = "{value}" is also in {other}.',
        "Give each variant a name of its own.",
        "The report names rows by their variant; letter case does not make two names. All rows of a name are marked.",
    ),
    (
        "E309",
        "unknown tolerance class",
        '{place} {name} = "{value}" is not a class of Tolerances.',
        "Write the name of a class as Tolerances has it, or add rows to Tolerances (sheet, or file of --tolerances).",
        "Blank means standard. A class consists of the Tolerances rows that carry its name.",
    ),
    (
        "E310",
        "does not belong to this type",
        "{place} {name} = {value}: a {other} has no such dimension.",
        "Clear the cell, or change the flexspline type.",
        "A cylinder has no disk. Fillets, the disk taper and its exponent are those of a cup.",
    ),
    (
        "E311",
        "disk radius missing",
        "{place}: {name} is empty; a {other} requires it.",
        "Enter the radius in mm.",
        "A cup is clamped at its hub (inner radius), a hat at its bolt circle (outer radius).",
    ),
    (
        "E312",
        "hub fillet too large",
        "{place} {name} = {value} mm: at most the width of the disk, {other} mm, is required.",
        "Check the fillet radius and the disk radii.",
        "The fillet starts at the hub and must end before the disk does.",
    ),
    (
        "E313",
        "junction fillet too large",
        "{place} {name} = {value} mm: with the tooth rim it exceeds the cylinder length {other} mm.",
        "Check fillet, rim length and cylinder length.",
        "Junction fillet and tooth rim lie on the cylinder one after the other.",
    ),
    (
        "E314",
        "impossible at the limits",
        "{place} {name} = {value}: its tolerance in class {other} reaches {detail}.",
        "Check the value and its unit; else narrow the tolerance, or correct the deviation unit.",
        "At the tolerance limits every thickness must stay above 0 and the hub inside the disk.",
    ),
    (
        "E315",
        "grade not tabulated",
        "{place} {name} = {value}: grade {detail} of class {other} has no entry for this size.",
        "Check the value and its unit; if they are right, give lower and upper deviation instead of the grade.",
        "ISO 286 is tabulated to 500 mm, ISO 2768 from 0.5 mm; class v starts at 3 mm, f ends at 2000 mm. "
        "A radius takes the grade of its diameter.",
    ),
    (
        "E316",
        "grade and deviations",
        "{place}: a grade and deviations are both given; one of them is required.",
        "Clear the grade, or both deviations.",
        "A grade stands for two deviations.",
    ),
    (
        "E317",
        "deviation missing",
        "{place} {name} is empty: lower and upper deviation, or a grade, are required.",
        "Fill both deviations (0 is a value), or enter a grade.",
        "Each dimension of a class needs a lower and an upper limit. Delete the row of an exact dimension.",
    ),
    (
        "E318",
        "deviations reversed",
        "{place} {name} = {value} is greater than the upper deviation {other}.",
        "Swap the two; deviations are signed.",
        "For −0.02/+0.01 the lower deviation is −0.02 and the upper 0.01.",
    ),
    (
        "E319",
        "tolerance twice",
        "{place}: {name} {value} of this class is also in {other}.",
        "Keep one row per class and dimension.",
        "With two rows flexlash cannot know which one applies.",
    ),
    (
        "E320",
        "no grade for this dimension",
        "{place} {name} = {value}: grades do not apply to {other}.",
        "Enter lower and upper deviation instead.",
        "Grades apply to lengths, diameters and radii, not to fillets, torque, moduli or factors.",
    ),
    (
        "E321",
        "material twice",
        '{place} {name} = "{value}" is also in {other}.',
        "Give each material a name of its own.",
        "Variants refer to materials by name.",
    ),
    (
        "E322",
        "elastic constants missing",
        "{place}: {name} is empty; E and ν, or G, are required.",
        "Enter Young's modulus and Poisson's ratio, or the shear modulus.",
        "The wind-up depends on the shear modulus, which is given or follows from E and ν.",
    ),
    (
        "E323",
        "setting twice",
        "{place} {name} = {value} is also in {other}.",
        "Keep one row per setting.",
        "With two rows flexlash cannot know which one applies.",
    ),
    (
        "E324",
        "no meaningful result",
        "{place}: the row gives a backlash of {value} rad, which no flexspline can have.",
        "Check the values of this row and their units, and the elastic constants of its material.",
        "Each cell is within its bounds, but together they give a backlash below 1e-12 or above 10 rad.",
    ),
    (
        "E325",
        "exponent without thickness at hub",
        "{place}: {name} is empty; a disk with a thickness exponent requires it.",
        "Enter the thickness at the hub, or clear the exponent.",
        "A disk that thins as a power of the radius starts from its thickness at the hub.",
    ),
    (
        "E326",
        "two disk profiles",
        "{place} {name} = {value} mm: the exponent {other} gives the thickness at every radius already.",
        "Clear the disk thickness, or the exponent for a straight taper.",
        "Thickness at hub with a disk thickness is a straight taper; with an exponent it is a power of the radius.",
    ),
    (
        "E327",
        "fillet on a cone",
        "{place} {name} = {value} mm: a disk at {other}° to the axis takes no fillet.",
        "Clear the fillet, or the cone angle for a flat disk.",
        "The fillets of the model are quarter circles between a flat disk and its hub or wall.",
    ),
    (
        "E328",
        "junction fillet wider than the bore",
        "{place} {name} = {value} mm: at most the radius of the bore, {other} mm, is required.",
        "Check the fillet radius and its unit.",
        "A fillet between disk and wall cannot reach beyond the axis.",
    ),
    (
        "E329",
        "wrong unit, contradictory row",
        "{place} {name} = {value} is about {other} and contradicts {contradicted}.",
        "Enter the value in the unit of the header, or correct the unit in the header.",
        "Metres in a column of millimetres, for instance. This one value makes the row a part that cannot be, so it is "
        "not computed; the cell that it contradicts is probably right.",
    ),
    (
        "E330",
        "no inside",
        "{place} {name} = {value} mm: less than twice the mean radius, {other} mm, is required, else there is no bore.",
        "Check the wall and the mean radius, and their units.",
        "The mean radius is that of the middle of the wall, so half the wall reaches inwards from it. A wall of twice "
        "the mean radius fills the bore: the part is a rod, not a flexspline.",
    ),
    (
        "E333",
        "tolerance wider than the value",
        "{place} {name} = {value}: class {other} allows ± {detail} % of it; at most 100 % is possible.",
        "Check the deviations and their unit in Tolerances.",
        "Half the distance between the limits exceeds the entered value, so the unit of the deviations must be wrong: "
        "micrometres entered as millimetres, for instance.",
    ),
    (
        "E334",
        "row that stops its process",
        "{place}: computing this row stopped its process three times, so it was not computed.",
        "Look for an implausible value; if the row is right, compute it alone and report the fault.",
        "A large table is computed in chunks. A chunk that loses its process three times is halved until the row is "
        "found; all other rows are computed. This is a fault of the program or of the machine, such as too little "
        "memory, not of the file.",
    ),
    (
        "E335",
        "process given twice",
        "{place} {name} = {value}, beside {other}: only one of them may be given.",
        "Clear one of the two cells.",
        "Limits at ± sigma, Standard deviation, Cp and Sample each give the standard deviation, and Sample the mean "
        "as well. With two of them flexlash cannot know which one applies.",
    ),
    (
        "E336",
        "Cpk does not go with Cp",
        "{place} {name} = {value}: {detail}.",
        "Enter Cp, or correct one of the two; without Cpk the process lies in the middle of the limits.",
        "Cp tells how a process scatters within its limits, Cpk how much of that room it has on its nearer side. Off "
        "the middle Cpk is less than Cp, in the middle the two are equal; it is never greater.",
    ),
    (
        "E337",
        "no process of its own",
        "{place} {name} = {value}: {detail}.",
        "Clear the cell, or change the distribution or the deviations.",
        "Mean shift, Standard deviation, Cp and Cpk are those of a normal or truncated normal process between limits "
        "that differ; a measured one has those of its sample.",
    ),
    (
        "E338",
        "invalid base of a class",
        "{place} {name} = {value}: {detail}.",
        "Keep one row per class that names its base, leave all else in that row blank, and let no class lead back to "
        "itself.",
        "A class takes over every row of the class it is based on that it does not have itself, and what that one "
        "takes over in turn.",
    ),
    (
        "E339",
        "process far off its limits",
        "{place} {name} = {value}: {detail}.",
        "Check mean, standard deviation and sample of the row of Tolerances, their unit, and the limits.",
        "Such a process has nothing to do with the limits of the drawing, so an entry must be wrong: a unit off by a "
        "thousand, deviations taken for values, the sample of another dimension. Parts that were made wrong lie "
        "nearer to their limits; they are computed, with a warning.",
    ),
    (
        "E340",
        "too few measured parts",
        "{place}: sample {value} has {found} of {dimension}; at least 5 are required.",
        "Measure more parts, or enter what is known of the process as Standard deviation or Cp instead.",
        "So few parts say next to nothing about how a dimension scatters: of two, the true standard deviation may be "
        "thirty times what was found. Rows whose class uses the sample are not computed.",
    ),
    (
        "E341",
        "measured values without scatter",
        "{place}: all {found} of {dimension} in sample {value} are {detail}; some must differ.",
        "Measure with a finer gauge; for an exact dimension enter 0 for both deviations and no sample.",
        "Parts that scatter less than a gauge shows all measure the same. That says how coarse the gauge is, and "
        "nothing of the process.",
    ),
    (
        "E342",
        "values and deviations in one sample",
        '{place} {name} = "{value}" ({detail}), but most rows of sample {found} hold a {other}.',
        "Write the same under Use as in every row of a sample; blank means value.",
        "The rows of a sample are parts of one process and are worked up together: either all hold what was measured, "
        "or all hold what was measured above the entered value.",
    ),
    (
        "E343",
        "deviations taken for values",
        "{place}: {found} values of {name} in sample {other} are not above 0 ({detail}).",
        "Write deviation under Use as in every row of the sample, or correct the values.",
        "A dimension of a part is greater than 0. What was measured above and below the entered value is a deviation: "
        "say so under Use as.",
    ),
    (
        "E345",
        "correlation twice",
        "{place}: the same pair of this class is also in {other}.",
        "Keep one row per class and pair; which of the two dimensions comes first does not matter.",
        "With two rows flexlash cannot know which one applies.",
    ),
    (
        "E346",
        "dimension correlated with itself",
        "{place} {name} = {value}: another dimension than the first of the row is required.",
        "Enter the dimension that it scatters together with, or delete the row.",
        "A correlation ties two different dimensions of one part.",
    ),
    (
        "E347",
        "correlation of an exact dimension",
        "{place} {name} = {value}: class {other} leaves this dimension exact, so it cannot scatter with another.",
        "Add its row to Tolerances, or delete this row.",
        "Only dimensions that scatter can scatter together. A variant that lacks one of the two, or takes it from "
        "another, such as a blank disk thickness, does without the pair.",
    ),
    (
        "E348",
        "correlations contradict one another",
        "{place} {name} = {value} contradicts the other correlations of class {other}; the nearest admissible "
        "value{detail} is {suggestion}.",
        "Enter {suggestion}, or correct one of the others.",
        "Two dimensions that both follow a third closely follow one another: where each has 0.9 with it, they have at "
        "least 0.62 with one another. In matrix terms, no eigenvalue may be negative.",
    ),
    (
        "E349",
        "lot correlated with a part",
        "{place}: in class {other}, {value} scatters between lots and {detail} between parts.",
        "Let both scatter between lots or both between parts (Tolerances, Scatters between), or delete the row.",
        "A dimension that all parts of a lot share cannot follow one that each of them has for itself.",
    ),
    (
        "E360",
        "tooth face too wide",
        "{place} {name} = {value} mm: at most {other} mm is required, the cylinder length without the junction fillet.",
        "Check tooth face width, cylinder length and fillet, and their units.",
        "The tooth face lies on the cylinder, from the open end on; it may be as wide as the cylinder is long.",
    ),
    (
        "E361",
        "row twice",
        '{place} {name} = "{value}" is also in {other}.',
        "Keep one row for each of them, or give each source a name of its own.",
        "With two rows of one name flexlash cannot know which one applies. Other sources with an error give no budget "
        "of the drive; a dimension whose row of Levers has one is left out of the levers.",
    ),
    (
        "E362",
        "does not belong to this row",
        "{place} {name} = {value}: {detail}.",
        "Clear the cell, or correct the cell that contradicts it.",
        "Beside the other cells of the row the number has no meaning, so one of the two must be wrong: a radius "
        "beside an angle in arcmin, a ratio on the output side, a range of another material.",
    ),
    (
        "E363",
        "source without a number",
        "{place} {name} is empty: {detail} are required.",
        "Enter the play, its deviations, or both; delete the row if the source has no play.",
        "A source adds its value to the drive's backlash and its deviations to the spread of it. A row with neither "
        "would look as if the source had been counted.",
    ),
    (
        "E364",
        "play below 0",
        "{place} {name} = {value}: the middle between the least and the greatest play is {detail}; at least 0 is "
        "required.",
        "Check value, deviations and their unit; for what scatters about 0 choose the kind random.",
        "A systematic source that is negative on average would make the drive's backlash less, which no clearance "
        "does. A press fit has a play of 0.",
    ),
    (
        "E365",
        "range reversed",
        "{place} {name} = {value} is greater than the highest value {other}.",
        "Swap the two.",
        "Lowest and highest are the ends of the range in which the drawing may change the dimension.",
    ),
    (
        "E366",
        "unknown variant",
        '{place} {name} = "{value}" is not a row of Variants.',
        "Write the name as Variants has it; leave the cell blank for every variant.",
        "The name must be that of a row of Variants; letter case and spaces do not matter. The study of this row is "
        "left out.",
    ),
    (
        "E367",
        "one dimension swept twice",
        "{place} {name} = {value}: another dimension than the first of the row is required.",
        "Enter another dimension, or clear the four cells of the second one.",
        "A study over two dimensions computes every combination of their values.",
    ),
    (
        "E368",
        "step greater than the range",
        "{place} {name} = {value} reaches no second value: from the first to the last it is {other}.",
        "Enter a smaller step; for a single value let both ends be the same.",
        "Values run from the first by the step up to the last, or down to it where that is smaller. The step is "
        "always above 0.",
    ),
    (
        "E369",
        "too many rows in studies",
        "{place} {name} = {value}: the study computes {found} rows{detail}; at most {limit} are possible.",
        "Widen the steps, name one variant, or split the sweep over several submissions.",
        "Each row of a study is computed with its whole spread, values times values of the second dimension times "
        "variants. The limit holds for all rows of Sweep together.",
    ),
    (
        "E370",
        "no value makes a part",
        "{place} {name} = {value}: no value of this study makes a part of {other}: {detail}.",
        "Choose a dimension that the variant has, or other values.",
        "Each value is put in place of what the variant has entered, everything else kept. A variant given by its bore "
        "has no mean radius of its own, a cylinder no disk; a dimension that another one bounds cannot pass it.",
    ),
    (
        "E385",
        "too many sources",
        "{place}: {known} sources of a drive are entered; at most {other} can be combined.",
        "Put sources of one kind into one row: add their values; of deviations take the root of the sum of squares.",
        "Every source that scatters is drawn with every variant. A real drive has a handful that count.",
    ),
    (
        "W401",
        "disk does not meet the wall",
        "{place} {name} = {value} mm differs from the mean radius {other} mm.",
        "Leave the cell blank, unless a published model is to be reproduced.",
        "A cup's disk ends where the wall begins, and a hat's flange begins there. The value is used as entered.",
    ),
    (
        "W402",
        "beyond yield",
        "{place}: von Mises stress {value} MPa in the {detail} exceeds the yield strength {other} MPa.",
        "Keep the torque below the elastic limit torque (Results), thicken that section, or choose a stronger "
        "material.",
        "Linear elasticity no longer holds: the real wind-up is greater and part of it stays.",
    ),
    (
        "W403",
        "thick wall",
        "{place} {name}: {value} times the mean radius; the thin-wall formula is meant for up to 0.2.",
        "Check for a diameter entered as a radius or a thickness in another unit.",
        "Above 0.2 the thin-wall torsion constant is more than one per cent low.",
    ),
    (
        "W404",
        "elastic constants disagree",
        "{place} {name} = {value} GPa, but E and ν give {other} GPa; the entered value is used.",
        "Clear the shear modulus or correct E and ν.",
        "For an isotropic material G = E/(2(1 + ν)). A difference over 0.05 % is reported.",
    ),
    (
        "W405",
        "normal tail cut",
        "{place} {name} = {value}: the normal tail of class {other} is cut where the shape becomes impossible.",
        "Choose a truncated normal distribution, or narrow the tolerance.",
        "A normal distribution has no end. Where it would reach a thickness of 0, or a hub outside the disk, "
        "within 8.3 standard deviations, it is cut there.",
    ),
    (
        "W407",
        "calibration with refinements",
        "{place}: a calibration other than 1 is used together with refinement columns.",
        "Set the calibrations to 1, or leave the refinement columns blank.",
        "Factors fitted to the plain two-term formula already contain fillets and rim; together they count twice. The "
        "same holds for the mean radius: a factor fitted with the bore's radius already contains the half wall.",
    ),
    (
        "W408",
        "lone cell",
        '{place} holds "{value}" in an otherwise empty row, which was not read as an entry.',
        "Clear the cell, or complete the row.",
        "A stray character far below the table should not stop the work; it is reported in case it was meant.",
    ),
    (
        "W409",
        "refinements overlap at the limits",
        "{place} {name} = {value}: at its limit in class {other} it exceeds {detail}.",
        "Check the lengths and tolerances of rim and fillets.",
        "The entered dimensions fit, but some units would not. Their wind-up is computed by continuing the formula.",
    ),
    (
        "W410",
        "shift without scatter",
        "{place} {name} = {value} equals the lower deviation: the dimension is shifted, but does not scatter.",
        "For ± {value} enter -{value} as the lower deviation.",
        "Deviations are signed: +0.02 and +0.02 mean that every part is larger by 0.02.",
    ),
    (
        "W411",
        "wall buckles",
        "{place}: the wall shear {value} MPa exceeds the buckling stress {other} MPa.",
        "Lower the torque, shorten the cylinder or thicken the wall.",
        "A thin cylinder under torque folds into oblique waves at 0.747 · 0.67 E (r/t)^(−5/4) (l/r)^(−½), NASA "
        "SP-8007. Results say whether the cylinder is within the range of that formula.",
    ),
    (
        "W412",
        "softer than a whole drive",
        "{place}: stiffness {value} N·m/rad, but whole drives like size {detail} reach {other} N·m/rad at this radius.",
        "Check radius, thicknesses and their units, and the elastic constants.",
        "A flexspline alone is stiffer than the drive that contains it. Compared with the least K3 of a maker's "
        "catalogue at the nearest size, the mean diameter over 2.54 mm; a smaller radius counts with its cube.",
    ),
    (
        "W413",
        "no elasticity check",
        "{place} {name} = {value}: not checked by elasticity, since {detail}.",
        "Check the value; the wind-up by the formula is reported without a check.",
        "The check by two-dimensional elasticity needs a part that could be made: disk, wall and fillets must meet, "
        "and no thickness may be a foil.",
    ),
    (
        "W414",
        "elasticity differs",
        "{place}: the formula is {value} two-dimensional elasticity; the spread keeps the formula.",
        "Use the elasticity result for the nominal value, and allow for the difference in the spread.",
        "Short, thick or strongly stepped parts depart from the thin shell of the formula. Both are compared without "
        "calibration. More than 2 % is reported.",
    ),
    (
        "W415",
        "resonance within usual input speeds",
        "{place}: the load's natural frequency is at most {value} Hz; the input meets it at {other} rpm.",
        "Avoid dwelling near that input speed, stiffen the flexspline or reduce the inertia.",
        "A strain wave gear's torque ripples twice per turn of its input. The higher speed is that of the flexspline "
        "alone, the lower that of a whole drive of its size. Below 3000 rpm it is reported.",
    ),
    (
        "W416",
        "fillets overlap on the disk",
        "{place} {name} = {value} mm: fillets take more than the {other} mm of disk between hub and bore.",
        "Check both fillet radii and the disk inner radius.",
        "Such a part cannot be made as drawn. The wind-up adds both fillets by formula; it is an approximation.",
    ),
    (
        "W417",
        "fillet beyond yield",
        "{place} {name} = {value} mm: peak von Mises stress {detail} MPa exceeds the yield strength {other} MPa.",
        "Enlarge the fillet, thicken the disk there, or lower the torque.",
        "By two-dimensional elasticity, which adds to the thin disk's stress what the fillet concentrates. A ductile "
        "part yields there before its section does; under alternating torque it fatigues there.",
    ),
    (
        "W418",
        "unusual wall",
        "{place} {name} = {value} mm is {detail} of the mean diameter {other} mm; 0.01 to 0.015 is usual.",
        "Check wall and radius for a diameter entered as a radius, or the other way round, and for the decimal point.",
        "Flexsplines have walls of 0.01 to 0.015 of their diameter. Outside 0.006 to 0.02 it is reported; above 0.05 "
        "I506 and W403 report it instead.",
    ),
    (
        "W419",
        "large hub",
        "{place} {name} = {value} mm exceeds 0.7 of the bore radius {other} mm.",
        "Check for a diameter entered as a radius.",
        "A hub of about half the bore is usual. A much narrower disk is barely flexible enough.",
    ),
    (
        "W420",
        "probably a wrong unit",
        "{place} {name} = {value} is about {other} {detail}.",
        "Enter the value in the unit of the header, or correct the unit in the header.",
        "Metres in a column of millimetres, MPa or Pa in a column of GPa, N·mm or kN·m in a column of N·m: each value "
        "is compared with the rest of its row, or with real materials. It is used as entered.",
    ),
    (
        "W421",
        "wide tolerance",
        "{place} {name} = {value}: class {other} allows ± {detail} % of it; up to 10 % is usual.",
        "Check the deviations and their unit in Tolerances.",
        "Half the distance between the limits is compared with the entered value. The limits are used as entered.",
    ),
    (
        "W422",
        "general tolerance on a thin part",
        "{place} {name} = {value}: the general tolerance of class {other} is ± {detail} % of it; up to 2 % suits thin "
        "parts.",
        "Enter a closer grade or deviations for this thickness in Tolerances.",
        "ISO 2768 is meant for dimensions without a tolerance of their own. Wind-up goes with the inverse of a "
        "thickness, so 2768-m on a wall of 1.6 mm already spreads it by 6 %.",
    ),
    (
        "W423",
        "limit below the nominal backlash",
        "{place} {name} = {value} arcmin is below the nominal backlash {other} arcmin: about half of the units or "
        "more exceed it.",
        "Raise the limit, or stiffen the flexspline.",
        "Units scatter about a value near the nominal one. When that is over the limit already, closer tolerances do "
        "not help.",
    ),
    (
        "W424",
        "torque above catalogue drives",
        "{place} {name} = {value} N·m exceeds {other} N·m, the momentary peak allowed to catalogue drives of size "
        "{detail}.",
        "Check torque and radius, and their units.",
        "Harmonic Drive SE lists for each size and ratio a rated torque, a limit for repeated and one for momentary "
        "peaks: 87, 204 and 369 N·m at size 25 and ratio 100. The nearest size (the mean diameter over 2.54 mm) "
        "counts, with its greatest momentary peak over the ratios; sizes 14 to 90 are listed.",
    ),
    (
        "W425",
        "hidden row with data",
        "{place}: {detail} hidden, but used.",
        "Show the rows and check them, or delete them.",
        "Rows hidden by hand, by a filter or by an outline hold data like any others.",
    ),
    (
        "W426",
        "hidden sheet",
        "{place}: the sheet is hidden, but its rows with data ({value}) are used.",
        "Show the sheet and check it, or delete it.",
        "Nobody sees what a hidden sheet says, yet its entries count.",
    ),
    (
        "W427",
        "row far below",
        "{place} is {detail} empty rows below row {other}; it is used like the others.",
        "Check that the row was meant; delete it, or move it up.",
        "A forgotten row below the visible end of a table is easily submitted by accident.",
    ),
    (
        "W428",
        "second table not read",
        "{place}: this sheet holds the headers of {other} as well, but only the sheet {other} is read.",
        "Move its rows to the sheet {other}, submit it as a file of its own, or delete it.",
        "Excel names the copy of a sheet Variants (2); its contents take no part in the calculation.",
    ),
    (
        "W429",
        "class resembles another",
        '{place} {name} = "{value}": no variant uses this class.',
        "Correct the spelling in every row of the class, or delete these rows.",
        "A dimension without a row in a variant's class is exact, so a misspelt class silently loses its tolerances. "
        "An unused class with a name of its own is not a fault.",
    ),
    (
        "W430",
        "digits instead of remarks",
        '{place} {name} = "{value}": this column holds only a few digits a row, as split decimal commas leave behind.',
        "Write decimal points, or separate the columns by semicolons; if the digits are meant, add a word.",
        "In a table separated by commas 40,5 without quotes fills two cells. Where the last cell of a row was left "
        "out, the row has as many cells as there are headers, and the digits of the decimals are in its last column.",
    ),
    (
        "W433",
        "not a row of the table",
        '{place}: this row was not read, since it looks like {detail}: "{value}".',
        "Nothing to do; if it is an entry, complete the row or give it another name.",
        "Sums and means below a table, notes and legends are not entries. A row is taken for one of these only when "
        "it lacks what every entry needs.",
    ),
    (
        "W434",
        "column takes no part",
        '{place}: the column "{value}" looks like {detail}, but takes no part in the calculation.',
        "Enter lower and upper deviation, or a grade, on Tolerances (beside a text table: --tolerances FILE.csv).",
        "Scatter comes from the sheet Tolerances alone: one row per class and dimension, with the limits of the "
        "drawing and, where it is known, the process between them: Limits at ± sigma, Mean shift, Standard deviation, "
        "Cp, Cpk or a sample of measured parts. The column is carried to the report.",
    ),
    (
        "W435",
        "misspelt header, empty column",
        '{place}: the header "{value}" is not understood, but its column is empty.',
        "Write {label}, or leave it: nothing is lost.",
        "A header that is nearly that of the template, or with an unknown unit. Over values it would be an error.",
    ),
    (
        "W436",
        "empty column twice",
        "{place}: {name} is already in column {other}; this one is empty and was not read.",
        "Delete the empty column.",
        "With values in both columns flexlash could not know which one applies, and would compute nothing.",
    ),
    (
        "W438",
        "class leaves dimensions exact",
        '{place}: class "{value}" has no row for {detail}, which class standard scatters; taken as exact.',
        "Add a row for each, or one that bases the class on standard (Based on class); for a dimension that is meant "
        "to be exact, a row with both deviations 0.",
        "A dimension without a row in a variant's class does not scatter, so that a class of your own that lists only "
        "the walls loses the scatter of the material. Only dimensions that a variant of the class has count.",
    ),
    (
        "W440",
        "implausible value",
        "{place} {name} = {value}: {detail} is plausible; used as entered.",
        "Check the value and its unit.",
        "Moduli and densities are compared with real materials, lengths with the mean radius, the rated torque with "
        "the torque, the other values with what flexsplines have. A calibration of 0.5 to 2.5 covers fillets, rims and "
        "play under the teeth; makers state the lost motion at 3 to 4 % of the rated torque; limits lie 1 to 12 "
        "standard deviations from the middle.",
    ),
    (
        "W441",
        "tolerance too narrow to measure",
        "{place} {name} = {value}: class {other} allows only ± {detail} of it.",
        "Check the deviations and their unit in Tolerances; for an exact dimension enter 0 for both.",
        "Half the distance between the limits is less than a millionth of the entered value, closer than parts can be "
        "measured: often a deviation in metres in a column of millimetres.",
    ),
    (
        "W442",
        "mean outside the limits",
        "{place} {name} = {value}: {detail} outside the limits.",
        "Check the mean shift, Cpk or sample of the row of Tolerances, their unit, and the limits.",
        "More than half of the parts of such a process are outside the limits of the drawing. It is computed as "
        "entered; worst case and share outside the limits are those of the drawing.",
    ),
    (
        "W443",
        "Cpk and mean shift disagree",
        "{place} {name} = {value}: {detail}; the mean shift is used.",
        "Clear the mean shift to take the mean from Cp and Cpk, or clear Cpk.",
        "Cp and Cpk give how far the mean lies off the middle, and the harmful side is taken. A mean shift says it "
        "itself, with its side.",
    ),
    (
        "W444",
        "implausible standard deviation",
        "{place} {name} = {value}: {detail} standard deviations; 1 to 12 are plausible.",
        "Check the standard deviation and its unit, that of the deviations.",
        "Half the width of the limits over the standard deviation is three times Cp. Far more or less is often a "
        "standard deviation in another unit. It is used as entered.",
    ),
    (
        "W445",
        "few measured parts",
        "{place}: sample {value} has only {found} of {dimension}; the true standard deviation lies between {detail} "
        "what they show.",
        "Measure at least 20 parts, better 50.",
        "What a few parts say about a process is uncertain. The report shows the interval that their number leaves "
        "beside every figure that depends on it.",
    ),
    (
        "W446",
        "measured value far from the others",
        "{place} {name} = {value}: the other values of sample {other} lie within {detail}.",
        "Compare with the measurement record; correct the cell, or leave it if the value is right.",
        "One misplaced decimal point, wrong unit or swapped pair of digits makes the standard deviation many times "
        "that of the process. A value is reported when it lies more than twelve standard deviations from the median, "
        "as judged by the middle half of the sample. It is used as entered.",
    ),
    (
        "W447",
        "measured values that are not normal",
        "{place}: {found} of {dimension} in sample {value} do not look normal (Anderson–Darling {detail}).",
        "Choose the distribution measured, or look for the reason: two machines, drift, sorted parts, a coarse gauge.",
        "Of normal processes one in twenty has p below 0.05. Where values are not normal, the tails of the normal "
        "distribution of their mean and standard deviation are wrong, and with them shares over the limit of a few per "
        "mille or less.",
    ),
    (
        "W448",
        "correlation beside the measured one",
        "{place} {name} = {value} is used in class {other}, but the parts measured together give {detail}.",
        "Check the entered value; delete the row to use the measured one.",
        "An entered correlation overrides a measured one. It lies outside the interval that holds the true "
        "correlation in 95 of 100 samples.",
    ),
    (
        "W449",
        "measured correlation not as measured",
        "{place}: class {other} differs from sample {value}: {detail}.",
        "Measure all dimensions on the same parts, let all of them scatter between lots or all between parts, or enter "
        "their correlations in Correlations.",
        "Correlations of different parts can contradict one another; the nearest that do not are then used. A "
        "dimension that a whole lot shares cannot follow one that differs from part to part.",
    ),
    (
        "W452",
        "sheet without a table",
        "{place}: this sheet has the name of an entry sheet, but no header row of {other}; nothing of it is used.",
        "Copy the header row of the template above the data (flexlash template --with), or rename the sheet.",
        "Measurements, Correlations, Other sources, Levers and Sweep are read wherever they are. A sheet that has such "
        "a name and holds something else does no harm.",
    ),
    (
        "W453",
        "sample resembles another",
        '{place} {name} = "{value}": no class uses this sample.',
        "Correct the spelling in every row of the sample, or delete these rows.",
        "Rows of a misspelt sample are missing from the one that was meant. A sample with a name of its own that no "
        "class uses is not a fault.",
    ),
    (
        "W454",
        "measured in another unit or way",
        "{place}: the values of {name} in sample {other} are {detail}.",
        "Write the unit of the measurement into the header; under Use as, value for sizes, deviation for what was "
        "measured above the entered value.",
        "A column of micrometres under a header in millimetres, or sizes called deviations, put the whole process "
        "beside its drawing. The values are used as entered.",
    ),
    (
        "W460",
        "bending fatigue",
        "{place} {name}: alternating stress {value} MPa exceeds {detail} of the yield strength {other} MPa.",
        "Choose a thinner wall or rim, a smaller deflection or a stronger material; a thicker wall bends under more "
        "stress.",
        "Twice a turn the wave generator bends wall and rim; the stresses of torsion do not show it. Polished steels "
        "endure half of their tensile strength, ground ones about 0.4 of the yield strength; tooth roots are notches "
        "and endure less.",
    ),
    (
        "W461",
        "entry takes no part",
        "{place} {name} = {value} takes no part: {detail}.",
        "Nothing to do; or clear the cell, or correct the cell beside it.",
        "Another cell of the row makes this one irrelevant. The row is used without it.",
    ),
    (
        "W462",
        "least play below 0",
        "{place} {name} = {value}: the least play is {detail}; it is used as entered.",
        "Check the deviations; for what scatters about 0 choose the kind random, for a press fit a play of 0.",
        "A play is 0 or more. A negative one counts as if it took away from the other sources, which parts that are "
        "pressed together do not.",
    ),
    (
        "W463",
        "coarse drawing step",
        "{place} {name} = {value}: {detail}.",
        "Check the step and its unit, that of the dimension's column in Variants.",
        "The values that levers offer are multiples of the step within the range. A step wider than the range, or "
        "than every entered value, leaves one value at most; often it is in another unit.",
    ),
    (
        "W464",
        "range misses every variant",
        "{place} {name} = {value}: {other} is {detail} in Variants, outside the range of Levers.",
        "Check the range and its unit, that of the dimension's column in Variants.",
        "Lowest and highest say which values the drawing may have. When the drawings of all variants lie outside, the "
        "range is probably in another unit or one of another dimension. It is used as entered.",
    ),
    (
        "W465",
        "variants left out of a study",
        "{place} {name} = {value}: no value of this study makes a part of {other}: {detail}.",
        "Nothing to do; or name in a row of its own each variant that is meant.",
        "A study without a variant's name is one of every variant. Those that lack the dimension, or to which no "
        "value fits, are left out of it.",
    ),
    (
        "W466",
        "system limit without sources",
        "{place}: {name} is given, but Other sources has no source, so it is not judged.",
        "Enter the drive's other sources of backlash (flexlash template --with other-sources), or take this as "
        "the Backlash limit of the wind-up alone.",
        "The system limit is that of the whole drive: the wind-up of the flexspline and the sheet Other sources "
        "together.",
    ),
    (
        "W470",
        "system limit below the average",
        "{place} {name} = {value} arcmin is below the average {other} arcmin of wind-up and other sources; about half "
        "or more exceed it.",
        "Raise the limit, or lower the backlash: the sheet Drive of the report shows what each source contributes.",
        "The average is the nominal backlash of the wind-up and the middle of every source of the sheet Other sources.",
    ),
    (
        "W471",
        "drives over the system limit",
        "{place} {name} = {value} arcmin: only {detail} % of drives are within it; {other} % are wanted.",
        "Narrow the deviations of the source, or of the dimension, that has most of the variance: the sheet Drive of "
        "the report shows it.",
        "Wind-up and other sources are drawn together by the method of the run. The wanted share is target_percent of "
        "Settings. Verdicts and exit codes judge the backlash limit of the flexspline alone.",
    ),
    (
        "W472",
        "system limit below the backlash limit",
        "{place} {name} = {value} arcmin is below the backlash limit {other} arcmin of the flexspline alone.",
        "Check which limit is meant: the system limit is that of the whole drive.",
        "The wind-up of the flexspline is a part of the whole drive's backlash, so the backlash limit could never be "
        "used in full.",
    ),
    (
        "I501",
        "unit converted",
        "{place}: {name} is given in {value} and was converted to {unit}.",
        "Nothing to do.",
        "The unit in the header's brackets is read; each value of the column was converted.",
    ),
    (
        "I502",
        "extra column",
        '{place}: the column "{value}" is not one of the template; the report carries it on its sheet Submission.',
        "Nothing to do.",
        "Extra columns do not take part in the calculation.",
    ),
    (
        "I503",
        "unit assumed",
        '{place}: the header "{value}" names no unit; {unit} was assumed.',
        "Write the unit in brackets: {label}.",
        "Without a unit the template's own is taken.",
    ),
    (
        "I504",
        "spelling repaired",
        '{place} {name} = "{value}" was read as "{suggestion}".',
        "Nothing to do.",
        "Letter case, outer spaces and non-breaking spaces in names do not matter.",
    ),
    (
        "I505",
        "built-in table used",
        "{file} has no {value}; used instead: the built-in {other}.",
        "Nothing to do, or add the sheet from the template.",
        "Built-in are the materials of the template and the tolerance class standard.",
    ),
    (
        "I506",
        "rather thick wall",
        "{place} {name}: {value} times the mean radius; flexsplines are usually thinner.",
        "Check the values and their units.",
        "Up to 0.2 the thin-wall formula is within one per cent.",
    ),
    (
        "I507",
        "delimiter recognised",
        "{file} was read as {detail} text with columns separated by {value}.",
        "Nothing to do.",
        "Comma, semicolon, tab and the bar | are recognised, and a first line such as sep=; is obeyed.",
    ),
    (
        "I508",
        "report skipped",
        "{file} is a report of flexlash, not a submission; it was skipped.",
        "Submit the filled template, or compute the report's own inputs anew: flexlash run --from-report.",
        "Reports carry a mark by which they are recognised when a whole folder is submitted.",
    ),
    (
        "I509",
        "values without a header",
        "{place}: the values of column {value} have no header and were not read.",
        "Write a header above them, or clear them.",
        "A column takes part, or passes through to the report, by its header.",
    ),
    (
        "I510",
        "decimal comma recognised",
        '{file} writes numbers with a decimal comma: {place} "{value}" was read as {suggestion}.',
        "Nothing to do, if the report shows your numbers.",
        "In a table separated by semicolons, tabs or bars a comma is taken as the decimal sign when commas that can "
        "be nothing else outnumber such points by at least three to one. Numbers with a point, such as 1.200, are "
        "then errors.",
    ),
    (
        "I511",
        "encoding assumed",
        '{file} was read as Windows-1252 text, since it is not Unicode; {place} shows "{value}".',
        "Check accents and symbols. In Excel: Save As, type CSV UTF-8, keeps every letter.",
        "A plain CSV from Excel does not say which encoding it uses. Numbers are the same in any case; names, notes "
        "and symbols of units may be shown wrongly.",
    ),
    (
        "I513",
        "marked copy skipped",
        "{file} is a marked copy of a submission; it was skipped.",
        "Fix and submit your own file, or take the copy itself with --marked-copies.",
        "Marked copies carry a mark by which they are recognised when a whole folder is submitted. A copy is "
        "never computed by mistake: fix your own file.",
    ),
    (
        "I514",
        "percentage read",
        "{place} {name} shows {value} and was read as {detail} %.",
        "Nothing to do.",
        "Excel stores 5% as 0.05; where per cent are wanted, what the cell shows is read.",
    ),
    (
        "I515",
        "row of units",
        "{place}: this row holds the units of the columns ({value}) and was not read as data.",
        "Nothing to do. A unit belongs in the brackets of its header.",
        "A row of units right below the headers is skipped when its units are those that the headers name or imply.",
    ),
    (
        "I520",
        "sheet of another name",
        "{place}: this sheet was read as {other}, since it alone has the headers of that sheet.",
        "Nothing to do, or rename the sheet to {other}.",
        "Other programs and copies rename sheets: Sheet1, Variants (2), Variants - Table 1-1. The headers tell what a "
        "sheet holds.",
    ),
    (
        "I525",
        "lock file skipped",
        "{file} is a lock file by which Excel marks a workbook as open; it was skipped.",
        "Submit the workbook itself, whose name is the same without ~$.",
        "Excel writes a small hidden file beside a workbook that is open and removes it when the workbook is closed.",
    ),
    (
        "I526",
        "fixed file skipped",
        "{file} is a fixed copy of a file that is also submitted; it was skipped.",
        "To compute the fixed file, submit it without its original.",
        "Both hold the same variants. A fixed workbook names the file it was made from, even after somebody has "
        "worked in it; a fixed table is known by its name, <name>-autofixed.csv, beside <name>.csv.",
    ),
    (
        "I527",
        "results skipped",
        "{file} is a table of results written by flexlash, not a submission; it was skipped.",
        "Submit the filled template or table from which it was computed.",
        "A table whose header row is that of Results holds what flexlash computed, not what it computes from.",
    ),
    (
        "I529",
        "sample not used",
        "{place}: no row of Tolerances uses sample {value}.",
        "Nothing to do; to use it, write its name under Sample in a row of Tolerances.",
        "Measured parts take part in the calculation only where a tolerance class names their sample.",
    ),
    (
        "I530",
        "part measured more than once",
        "{place}: {found} more than once in sample {other}, such as {value} ({detail}); each row counts as a part.",
        "Nothing to do if these are different parts; else keep one row of each part.",
        "Measuring one part again says something about the gauge, not about the process: the sample looks larger than "
        "it is, and its interval narrower.",
    ),
    (
        "I531",
        "dimensions measured together",
        "{place}: in class {other} the parts of sample {value} scatter together as measured: {detail}.",
        "Nothing to do; a row of Correlations overrides it, if the correlation is known better.",
        "Two dimensions that are measured on the same parts have the correlation of these parts. That of few parts is "
        "uncertain, as its interval says.",
    ),
    (
        "I532",
        "sample named by its file",
        "{file} has no column Sample: its parts are the sample {value}.",
        "Nothing to do where a class of Tolerances names that sample; else add the column Sample.",
        "A measuring machine writes the parts of one sample into one file. A column Sample lets a file hold several.",
    ),
    (
        "I540",
        "no bounds for two lobes",
        "{place} {name} = {value} mm: no bounds for two lobes, since {detail}.",
        "Nothing to do; the backlash counts the face width, its load even around the axis.",
        "What two opposite arcs of engaged teeth change was checked against solid elasticity for cups on a rigid, "
        "tightly fitting wave generator. For other parts flexlash gives no bounds instead of doubtful ones.",
    ),
)
