"""The cells of a row as operands that print the formula they stand for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from decimal import Decimal
from typing import TypeAlias

from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.part_row import PartRow

__all__ = ["CellRow", "Expression"]


@dataclass(frozen=True)
class Expression:
    """An expression of Excel: an atom, or operands with a sign between them."""

    text: str
    is_atom: bool = True

    def __str__(self) -> str:
        return self.text

    def __add__(self, other: Printed) -> Expression:
        return self._joined("+", other)

    def __radd__(self, other: float) -> Expression:
        return _expression(other)._joined("+", self)

    def __sub__(self, other: Printed) -> Expression:
        return self._joined("-", other)

    def __truediv__(self, other: Printed) -> Expression:
        return self._joined("/", other)

    def __lt__(self, other: Printed) -> Expression:
        return self._joined("<", other)

    def __le__(self, other: Printed) -> Expression:
        return self._joined("<=", other)

    def __gt__(self, other: Printed) -> Expression:
        return self._joined(">", other)

    def __ge__(self, other: Printed) -> Expression:
        return self._joined(">=", other)

    def _joined(self, sign: str, other: Printed) -> Expression:
        return Expression(f"{self.inside}{sign}{_expression(other).inside}", is_atom=False)

    @property
    def inside(self) -> str:
        """The expression as it stands inside another."""
        return self.text if self.is_atom else f"({self.text})"


Printed: TypeAlias = "Expression | float"


def _expression(operand: Printed) -> Expression:
    return operand if isinstance(operand, Expression) else Expression(f"{Decimal(f'{operand:.15g}'):f}")


def _call(name: str, *arguments: Printed) -> Expression:
    return Expression(f"{name}({','.join(str(_expression(argument)) for argument in arguments)})")


class CellRow(PartRow):
    """Cells by the key of their column as operands; a blank one counts as 0."""

    def __init__(self, cells: Mapping[str, str]) -> None:
        self._cells = cells

    def __getitem__(self, name: str) -> Expression:
        """Return the dimension that counts; what a blank counts as needs no word."""
        return self.entered(name) if self._blank_value(name) == 0 else super().__getitem__(name)

    def given(self, name: str) -> Expression:
        """Return whether a cell has an entry."""
        return Expression(f'{self.entered(name)}<>""', is_atom=False)

    def blank(self, name: str) -> Expression:
        """Return whether a cell has no entry."""
        return Expression(f'{self.entered(name)}=""', is_atom=False)

    def entered(self, name: str) -> Expression:
        """Return a cell."""
        return Expression(self._cells[DIMENSIONS[name].key])

    def is_type(self, *types: str) -> Expression:
        """Return whether the flexspline is of one of these types; a blank one is a cup."""
        cell = f"TRIM({self._cells['flexspline_type']})"
        words = [word for name in types for word in ({"cup": ["", "cup"]}.get(name, [name]))]
        return self.any_of(*(Expression(f'{cell}="{word}"', is_atom=False) for word in words))

    def when(self, condition: Expression, then: Printed, otherwise: Printed) -> Expression:
        """Return one of two operands."""
        return _call("IF", condition, then, otherwise)

    def all_of(self, *conditions: Expression) -> Expression:
        """Return whether all conditions hold."""
        return conditions[0] if len(conditions) == 1 else _call("AND", *conditions)

    def any_of(self, *conditions: Expression) -> Expression:
        """Return whether at least one condition holds."""
        return conditions[0] if len(conditions) == 1 else _call("OR", *conditions)
