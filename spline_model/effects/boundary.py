"""What acts from outside: clamps, drives (Eqs 5 to 7) and loads, and how they change in time.

Loads grow in proportion to the load factor or by a history; a ``steady`` one acts in full at any load factor,
like gravity.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, ClassVar, Literal, Self

import numpy as np
from numpy.typing import NDArray

from spline_model.effects.base import Constraint, Load, Potential
from spline_model.errors import InvalidParameter, require_finite
from spline_model.layout import Layout
from spline_model.strip.compiled import kernel

Array = NDArray[np.float64]
History = tuple[tuple[float, float], ...]
"""(time [s], factor) pairs in order of time; linear between them, constant before and after."""

STEADY: History = ((0.0, 1.0),)
GROUND = "ground"
ALWAYS = (0.0, math.inf)


def _factor_of(history: History, time: float) -> float:
    """The factor at an instant [s]."""
    times, factors = zip(*history, strict=True)
    return float(np.interp(time, times, factors))


@kernel()
def factor_at(time: float, first: int, count: int, times: Array, factors: Array) -> Any:
    """The factor at an instant [s] of a history in a table: ``count`` pairs from ``first`` on."""
    if time <= times[first]:
        return factors[first]
    for i in range(first + 1, first + count):
        if time <= times[i]:
            share = (time - times[i - 1]) / (times[i] - times[i - 1])
            return factors[i - 1] + share * (factors[i] - factors[i - 1])
    return factors[first + count - 1]


@dataclass(frozen=True, kw_only=True, slots=True)
class Clamp(Constraint):
    """One end of a strip built into the ground or into a body, where it stands at rest.

    Rows: the end point (Eq 5, two rows in m) and the end direction (Eq 6). For the
    direction the signed angle from m to C' is the row (rad): it has the Jacobian of
    Eq 6 over |C'| where it vanishes, so that its multiplier is the end moment, and
    unlike Eq 6 it does not vanish for a reversed tangent.

    The multipliers are the force [N] and the moment [N m] of the clamp on the strip.
    """

    rows: ClassVar[int] = 3
    strip: str
    end: Literal["start", "end"]
    to: str = GROUND


@dataclass(frozen=True, kw_only=True, slots=True)
class DrivenRotation(Constraint):
    """The rotation of a body prescribed as angle x load factor, one row in rad.

    In a motion it acts in ``held`` and changes by angle x the change of history(t) from where the body is
    when it begins. A body that is re-clamped loses the velocity that the drive does not have. The multiplier
    is the torque on the body [N m], positive counter-clockwise.

    Parameters
    ----------
    body : str
    angle : float, rad
    history : pairs of s and 1, default ((0, 1),)
        Times and factors of the angle in a motion.
    held : (2,) s, default (0, inf)
        Begin and end of the drive in a motion.
    prop : bool, default False
        The drive only keeps a free rigid motion from being indeterminate (``spline_model.rigid``).

    Raises
    ------
    InvalidParameter
        An angle or history that is not finite, or an interval that ends before it begins.

    References
    ----------
    Valentini and Pezzuti (2013), Eq 7.

    Examples
    --------
    >>> DrivenRotation(body="body", angle=0.1, history=((0.0, 1.0), (0.01, 0.0)), held=(0.0, 0.02)).angle
    0.1
    """

    rows: ClassVar[int] = 1
    body: str
    angle: float
    history: History = STEADY
    held: tuple[float, float] = ALWAYS
    prop: bool = False

    def __post_init__(self) -> None:
        require_finite("angle", self.angle, "rad")
        if not self.held[0] < self.held[1]:
            raise InvalidParameter("held", self.held, "two instants, the first before the second [s]")


@dataclass(frozen=True, kw_only=True, slots=True)
class DrivenDisplacement(Constraint):
    """The displacement of a body's centre prescribed as (dx, dy) x load factor, two rows in m.

    Without a history it holds the start of a motion and then is released; with one it goes on holding
    through the motion, as ``DrivenRotation``. The multipliers are the applied force [N].

    Parameters
    ----------
    body : str
    displacement : (2,) m
        None in place of dx or dy leaves this direction free, without a row.
    history : pairs of s and 1, default None
        Times and factors of the displacement in a motion.
    held : (2,) s, default (0, inf)
        Begin and end of the drive in a motion.
    steady : bool, default False
        In full at any load factor.
    prop : bool, default False
        As in ``DrivenRotation``.

    Raises
    ------
    InvalidParameter
        No direction, or a value that is not finite.

    References
    ----------
    Valentini and Pezzuti (2013), section 4: "two other driving constraints".

    Examples
    --------
    >>> DrivenDisplacement(body="body", displacement=(1e-3, None)).displacement
    (0.001, None)
    """

    body: str
    displacement: tuple[float | None, float | None]
    history: History | None = None
    held: tuple[float, float] = ALWAYS
    steady: bool = False
    prop: bool = False

    def __post_init__(self) -> None:
        if not self.parts or not all(math.isfinite(part) for part in self.parts.values()):
            expected = "two finite numbers [m], or one and None where the body is free"
            raise InvalidParameter("displacement", self.displacement, expected)

    @property
    def parts(self) -> dict[int, float]:
        """The prescribed parts by their axis, 0 or 1 [m]."""
        return {axis: part for axis, part in enumerate(self.displacement) if part is not None}

    @property
    def rows(self) -> int:  # type: ignore[override]
        """One for each prescribed part."""
        return len(self.parts)

    @property
    def lets_go(self) -> bool:
        """Whether it holds the start of a motion alone."""
        return self.history is None and self.held == ALWAYS

    def at(self, time: float) -> DrivenDisplacement:
        """The drive with the displacement that it has at an instant [s] of a motion."""
        part = 1.0 if self.history is None else _factor_of(self.history, time)
        x, y = (None if moved is None else part * moved for moved in self.displacement)
        return replace(self, displacement=(x, y))


@dataclass(frozen=True, kw_only=True, slots=True)
class Sized(Load):
    """A load of a size x load factor, in a motion x history(t)."""

    history: History = STEADY
    steady: bool = False

    def __post_init__(self) -> None:
        if not self.history or any(b[0] <= a[0] for a, b in pairwise(self.history)):
            raise InvalidParameter("history", self.history, "(time, factor) pairs with increasing times [s]")

    def _times(self, factor: float) -> Self:
        """The load times a factor."""
        raise NotImplementedError

    def at(self, time: float) -> Self:
        """The load as it is at an instant [s] of a motion."""
        return self._times(_factor_of(self.history, time))

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
