"""Loads: gravity, and forces and moments in proportion to the load factor or to a history.

A ``steady`` load acts in full at any load factor, like gravity.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal, Self

from spline_model.effects.base import Load, Potential
from spline_model.effects.history import STEADY, History, checked, factor_of

if TYPE_CHECKING:
    from spline_model.scene import Layout


@dataclass(frozen=True, kw_only=True, slots=True)
class Sized(Load):
    """A load of a size x load factor, in a motion x history(t)."""

    history: History = STEADY
    steady: bool = False

    def __post_init__(self) -> None:
        checked(self.history)

    def _times(self, factor: float) -> Self:
        """The load times a factor."""
        raise NotImplementedError

    def at(self, time: float) -> Self:
        """The load as it is at an instant [s] of a motion."""
        return self._times(factor_of(self.history, time))

    def components(self, layout: Layout) -> list[tuple[int, float, int]]:
        """Place in z, value and kind (1: a moment) of each component."""
        raise NotImplementedError


@dataclass(frozen=True, kw_only=True, slots=True)
class AppliedForce(Sized):
    """Dead force on a body at its centre: (fx, fy) x load factor, in a motion x history(t).  [N]"""

    body: str
    force: tuple[float, float]

    def _times(self, factor: float) -> Self:
        return replace(self, force=(factor * self.force[0], factor * self.force[1]))

    def components(self, layout: Layout) -> list[tuple[int, float, int]]:
        """fx and fy of the body."""
        return [(layout.bodies[self.body] + k, force, 0) for k, force in enumerate(self.force)]


@dataclass(frozen=True, kw_only=True, slots=True)
class AppliedMoment(Sized):
    """Moment on a body, counter-clockwise positive: x load factor, in a motion x history(t).  [N m]"""

    body: str
    moment: float

    def _times(self, factor: float) -> Self:
        return replace(self, moment=factor * self.moment)

    def components(self, layout: Layout) -> list[tuple[int, float, int]]:
        """The moment of the body."""
        return [(layout.bodies[self.body] + 2, self.moment, 1)]


@dataclass(frozen=True, kw_only=True, slots=True)
class TipForce(Sized):
    """Dead force at one end of a strip: (fx, fy) x load factor, in a motion x history(t).    [N]"""

    strip: str
    end: Literal["start", "end"]
    force: tuple[float, float]

    def _times(self, factor: float) -> Self:
        return replace(self, force=(factor * self.force[0], factor * self.force[1]))

    def components(self, layout: Layout) -> list[tuple[int, float, int]]:
        """fx and fy of the strip's end."""
        start, count = layout.strips[self.strip]
        end = start if self.end == "start" else start + 2 * count - 2
        return [(end + k, force, 0) for k, force in enumerate(self.force)]


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
