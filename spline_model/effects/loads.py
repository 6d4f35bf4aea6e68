"""Loads: gravity, and forces and moments in proportion to the load factor or to a history.

A ``steady`` load acts in full at any load factor, like gravity.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

from spline_model.effects.base import Load, Potential
from spline_model.effects.history import STEADY, History, checked, factor_of


@dataclass(frozen=True, kw_only=True, slots=True)
class AppliedForce(Load):
    """Dead force on a body at its centre: (fx, fy) x load factor, in a motion x history(t).  [N]"""

    body: str
    force: tuple[float, float]
    history: History = STEADY
    steady: bool = False

    def __post_init__(self) -> None:
        checked(self.history)

    def at(self, time: float) -> AppliedForce:
        """The force as it is at an instant [s] of a motion."""
        part = factor_of(self.history, time)
        return replace(self, force=(part * self.force[0], part * self.force[1]))


@dataclass(frozen=True, kw_only=True, slots=True)
class AppliedMoment(Load):
    """Moment on a body, counter-clockwise positive: x load factor, in a motion x history(t).  [N m]"""

    body: str
    moment: float
    history: History = STEADY
    steady: bool = False

    def __post_init__(self) -> None:
        checked(self.history)

    def at(self, time: float) -> AppliedMoment:
        """The moment as it is at an instant [s] of a motion."""
        return replace(self, moment=factor_of(self.history, time) * self.moment)


@dataclass(frozen=True, kw_only=True, slots=True)
class TipForce(Load):
    """Dead force at one end of a strip: (fx, fy) x load factor, in a motion x history(t).    [N]"""

    strip: str
    end: Literal["start", "end"]
    force: tuple[float, float]
    history: History = STEADY
    steady: bool = False

    def __post_init__(self) -> None:
        checked(self.history)

    def at(self, time: float) -> TipForce:
        """The force as it is at an instant [s] of a motion."""
        part = factor_of(self.history, time)
        return replace(self, force=(part * self.force[0], part * self.force[1]))


@dataclass(frozen=True, kw_only=True, slots=True)
class StripGravity(Potential):
    """Weight of a strip, V = - int mu g . C ds0 [J], linear in the control points.

    It acts in full at any load factor. Parameters: strip, linear_density mu [kg/m],
    acceleration g [m/s^2].
    """

    strip: str
    linear_density: float
    acceleration: tuple[float, float]


@dataclass(frozen=True, kw_only=True, slots=True)
class BodyGravity(Potential):
    """Weight of a body at its centre, V = - m g . r [J]; in full at any load factor."""

    body: str
    mass: float
    acceleration: tuple[float, float]
