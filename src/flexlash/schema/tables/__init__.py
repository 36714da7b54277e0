"""Tables that the program needs, as CSV files beside this module.

`materials.csv` (elastic constants, density, yield strength, each with its source), `iso286.csv` (tolerance
widths IT5 to IT12 in µm, over a size up to and including the next), `iso2768.csv` (± deviations in mm),
`standard_class.csv` (the built-in tolerance class), `catalogue_stiffness.csv` (K1, K2, K3 of a maker's
catalogue by size and ratio), `catalogue_torque.csv` (rated, repeated-peak and momentary-peak torques of a maker's
drives by size and ratio, each with the data sheet; transcribed in github.com/AimanHaidar/harmonic-drive-selector,
data/reducers_tables.py at e1df012, and held against a second public list and the maker's product pages for fifteen
rows of sizes 14 to 65), `study.csv` (the published B3-160 case and its variations) and `finding_examples.csv`
(a real message of each finding).
"""

from __future__ import annotations

import csv
from functools import cache
from importlib.resources import files

__all__ = ["rows"]


@cache
def rows(name: str) -> tuple[dict[str, str], ...]:
    """Return the rows of a table as texts by heading.

    >>> rows("iso286")[8]["IT7"]
    '40'
    """
    text = files(__name__).joinpath(f"{name}.csv").read_text(encoding="utf-8")
    return tuple(csv.DictReader(text.splitlines()))
