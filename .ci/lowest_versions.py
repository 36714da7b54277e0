"""Print every lower bound in pyproject.toml as the only version allowed, for `pip install --constraint`."""

import re
import sys
import tomllib
from pathlib import Path

_BOUND = re.compile(r"(?P<name>[\w.-]+)(?:\[.*\])?>=(?P<lowest>[\w.]+)")


def main() -> None:
    """Print one line for each requirement; one without a lower bound is an error, since nobody could test it."""
    project = tomllib.loads(Path("pyproject.toml").read_text(encoding="utf-8"))["project"]
    for requirements in (project["dependencies"], *project["optional-dependencies"].values()):
        for requirement in requirements:
            bound = _BOUND.match(requirement)
            if bound:
                print(f"{bound['name']}=={bound['lowest']}")
            elif not requirement.startswith("flexlash["):
                sys.exit(f"pyproject.toml: {requirement} has no lower bound")


if __name__ == "__main__":
    main()
