"""The unit in which a reader is told angles, arc minutes or arc seconds; all numbers behind it are in arc minutes."""

from __future__ import annotations

from dataclasses import dataclass

from flexlash.schema.findings import spelled_out
from flexlash.schema.number_words import glance, rounded
from flexlash.schema.units import ARCMIN

__all__ = ["ANGLE_UNITS", "ARC_MINUTES", "AngleUnit", "angle_sign"]


@dataclass(frozen=True, kw_only=True)
class AngleUnit:
    """A unit of angles: its name in headings, its sign behind a number, how many of it make an arc minute.

    `fewer` is how many decimals fewer than of arc minutes say about the same.
    """

    name: str
    sign: str
    per_arcmin: float
    fewer: int

    def of(self, arcmin: float) -> float:
        """Return an angle [arcmin] in this unit."""
        return arcmin * self.per_arcmin

    def of_radians(self, angle: float) -> float:
        """Return an angle [rad] in this unit."""
        return self.of(angle / ARCMIN)

    def decimals(self, of_arcmin: int) -> str:
        """Return the number format that has the digits of arc minutes with so many decimals.

        >>> ARC_MINUTES.decimals(4), ANGLE_UNITS["arcsec"].decimals(4), ANGLE_UNITS["arcsec"].decimals(1)
        ('0.0000', '0.00', '0')
        """
        zeros = "0" * (of_arcmin - self.fewer)
        return f"0.{zeros}" if zeros else "0"

    def words(self, arcmin: float, error: float | None = None) -> str:
        """Return an angle [arcmin] in four digits, or fewer where its standard error [arcmin] is greater.

        >>> [ARC_MINUTES.words(*angle) for angle in ((6.261963, 1e-6), (6.261963, 0.02), (0.0123456,))]
        ['6.262′', '6.26′', '0.01235′']
        >>> [ANGLE_UNITS["arcsec"].words(*angle) for angle in ((6.261963, 1e-6), (6.261963, 0.02), (0.0123456,))]
        ['375.7″', '376″', '0.7407″']
        """
        value = self.of(arcmin)
        return f"{rounded(value, max(self.of(error or 0.0), glance(value)))}{self.sign}"

    def entered(self, arcmin: float) -> str:
        """Return an angle [arcmin] that somebody chose, such as a limit, in no more digits than it has.

        >>> ARC_MINUTES.entered(3.8), ANGLE_UNITS["arcsec"].entered(3.8)
        ('3.8′', '228″')
        """
        return f"{self.of(arcmin):g}{self.sign}"

    def spelled_out(self, arcmin: float, digits: int) -> str:
        """Return an angle [arcmin] in so many digits, never as a power of ten.

        >>> ANGLE_UNITS["arcsec"].spelled_out(0.001234, 2)
        '0.074″'
        """
        return f"{spelled_out(self.of(arcmin), digits)}{self.sign}"


ARC_MINUTES = AngleUnit(name="arcmin", sign="′", per_arcmin=1.0, fewer=0)
ANGLE_UNITS = {unit.name: unit for unit in (ARC_MINUTES, AngleUnit(name="arcsec", sign="″", per_arcmin=60.0, fewer=2))}
"""Units by the name that the setting `angle_unit` has for them."""


def angle_sign(name: str) -> str:
    """Return the sign behind angles in a unit by name, that of arc minutes for a name of none.

    >>> angle_sign("arcsec"), angle_sign("arcmin"), angle_sign("furlong")
    ('″', '′', '′')
    """
    return ANGLE_UNITS.get(name, ARC_MINUTES).sign
