"""The facts of a whole table: rows beyond doubt are taken by a quick test, with the same outcome as one by one."""

import random

import pytest

from flexlash.reading import survey as surveys
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.survey import survey
from flexlash.validation.whole_tables import Gatherer

LIMITS = ReadingLimits()
CELLS = {
    "variant": ["A", "a", "B", "C-1", "", " D", "Note: x", "Mean", "\u200b", "#N/A", "Ä", "007"],
    "material": ["20Cr2Ni4", "20Cr2Ni4", "20Cr2Ni4", "20cr2ni4", "", "x y", "#REF!"],
    "torque_Nm": ["800", "800.5", "1.200", "1,5", "", "abc", " ", "-3"],
    "tolerance_class": ["", "fine", "Fine", "standard"],
    "notes": ["5", "", "17"],
    "serial": ["1", "2.5", "", "007", "1e5", "1,5", "1.200"],
}


def _table(seed):
    """Return a table of which most rows are plain, with cells beyond its headers, blank lines and remarks."""
    draw = random.Random(seed)  # noqa: S311
    delimiter = draw.choice([";", ";", ","])
    wildness = draw.choice([0.0, 0.01, 0.3])
    lines = [delimiter.join([*CELLS, *draw.choice([[], [""], ["", "extra"]])])]
    for number in range(draw.randrange(1, 90)):
        plain = [f"V{number}", "20Cr2Ni4", draw.choice(["800", "12.5"]), "", draw.choice(["5", ""]), str(number)]
        cells = [
            draw.choice(CELLS[key]) if draw.random() < wildness else cell
            for key, cell in zip(CELLS, plain, strict=True)
        ]
        cells += draw.choice([[], [], [""], ["", "x"]]) if draw.random() < wildness else []
        lines += [delimiter.join(cells if delimiter == ";" else [cell.replace(",", "") for cell in cells])]
        lines += draw.choice([[""], [f"all of these{delimiter}"]]) if draw.random() < wildness else []
    return "\n".join(lines) + "\n"


@pytest.mark.parametrize(
    "seeds", [range(60), pytest.param(range(60, 600), marks=pytest.mark.slow)], ids=["few", "many"]
)
def test_quick_or_one_by_one(seeds, tmp_path, monkeypatch):
    """Whether rows are taken together or one by one, in blocks of whatever size, the facts are the same."""
    path = tmp_path / "study.csv"
    quick = Gatherer._is_plain
    taken = 0

    def counted(*arguments):
        nonlocal taken
        found = quick(*arguments)
        taken += found
        return found

    for seed in seeds:
        path.write_text(_table(seed), encoding="utf-8")
        found = []
        for size, test in ((1, counted), (4, counted), (1000, lambda *_: False), (3, lambda *_: False)):
            monkeypatch.setattr(surveys, "_ROWS", size)
            monkeypatch.setattr(Gatherer, "_is_plain", test)
            one = survey(path, LIMITS)
            doubles = one.doubles.rows.tolist(), one.doubles.starts.tolist(), one.doubles.ranges
            whole = {
                key: sorted(map(str, value.items())) if isinstance(value, dict) else value
                for key, value in vars(one.whole).items()
            }
            found.append((whole, one.entries, sorted(doubles[0]), len(doubles[1]), one.rows, one.last, one.text))
        assert all(other == found[0] for other in found), (seed, found)
    assert taken > len(seeds)
