"""Plays in a drive as angles at its output: along a circumference, radial under a pressure angle, of the input side."""

from __future__ import annotations

from flexlash.mechanics.elementary import tan
from flexlash.schema.arrays import Quantity

__all__ = ["angle_at_output", "play_angle", "play_from_radial"]


def play_angle(play: Quantity, radius: Quantity) -> Quantity:
    """Angle by which a play along the circumference lets a part turn [rad].

    Equation: φ = j/r
    Arguments: play j along the circumference, from one stop to the other, and the radius r at which it acts [m].
    Valid: plays small beside the radius.
    Source: definition of the angle.

    >>> f"{play_angle(0.02e-3, 0.08):.2e}"
    '2.50e-04'
    """
    return play / radius


def play_from_radial(radial_play: Quantity, pressure_angle: Quantity) -> Quantity:
    """Play along the circumference that a radial play gives between teeth [m].

    Equation: j = 2 d tan α
    Arguments: radial play d [m]; pressure angle α of the teeth [rad].
    Valid: teeth with straight flanks where they touch; both flanks open as the distance grows.
    Source: gear geometry: backlash from a change of the centre distance.

    >>> import math
    >>> f"{play_from_radial(0.005e-3, math.radians(20)):.4e}"
    '3.6397e-06'
    """
    return 2 * radial_play * tan(pressure_angle)


def angle_at_output(angle: Quantity, ratio: Quantity) -> Quantity:
    """Angle at the output to which an angle of the input side comes [rad].

    Equation: φ_out = φ_in/i
    Arguments: angle φ_in at the input [rad]; ratio i, turns of the input for one of the output, 1 at the output.
    Valid: any ratio; a maker's table of input couplings has i·φ constant.
    Source: kinematics of the reduction.

    >>> angle_at_output(20.0, 100.0)
    0.2
    """
    return angle / ratio
