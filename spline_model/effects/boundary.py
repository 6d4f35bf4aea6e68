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
from spline_model.errors import InvalidParameter, require_finite, require_not_negative
from spline_model.strip.compiled import kernel

Array = NDArray[np.float64]
History = tuple[tuple[float, float], ...]
"""(time [s], factor) pairs in order of time; linear between them, constant before and after."""

STEADY: History = ((0.0, 1.0),)
GROUND = "ground"
ALWAYS = (0.0, math.inf)
FORCE, MOMENT, FOLLOWER = range(3)
"""Kinds of components of loads; a follower's two stand one behind the other."""


def _factor_of(history: History | None, time: float) -> float:
    """The factor at an instant [s]; 1 without a history."""
    times, factors = zip(*(history or STEADY), strict=True)
    return float(np.interp(time, times, factors))


@kernel()
def factor_at(time: float, first: int, count: int, times: Array, factors: Array) -> Any:
    """Return the factor [1] at an instant [s] of a history: ``count`` pairs from ``first`` on of the table.

    times, factors (H,): instants [s] and factors [1] of all histories.
    """
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

    The multipliers are the force [N] and the moment [N m] of the clamp on the strip. free: whether it is a
    free end, whose frame only carries what acts there.
    """

    rows: ClassVar[int] = 3
    strip: str
    end: Literal["start", "end"]
    to: str = GROUND
    free: bool = False


@dataclass(frozen=True, kw_only=True, slots=True)
class Driven(Constraint):
    """Coordinates of a body that are prescribed, each from where it is at rest by a part x load factor.

    Without a history it holds the start of a motion and then is released; with one it acts in the motion, and
    changes by its part x the change of history(t) from where the body is when it begins. A body that is
    re-clamped loses the velocity that the drive does not have. The multipliers are the force [N] or the
    torque [N m], counter-clockwise positive, on the body.

    Parameters
    ----------
    body : str
    history : pairs of s and 1
        Times and factors in a motion.
    held : (2,) s, default (0, inf)
        Begin and end of the drive in a motion.
    steady : bool, default False
        In full at any load factor.
    beside : bool
        Whether another rotation than this is what a path is driven by.
    prop : bool, default False
        The drive only keeps a free rigid motion from being indeterminate (``spline_model.rigid``).

    References
    ----------
    Valentini and Pezzuti (2013), Eq 7 and section 4.
    """

    body: str
    history: History | None = None
    held: tuple[float, float] = ALWAYS
    steady: bool = False
    beside: bool = True
    prop: bool = False

    @property
    def parts(self) -> dict[int, float]:
        """The prescribed parts by their axis, 0, 1 and 2 for x, y and rotation [m, rad]."""
        raise NotImplementedError

    @property
    def rows(self) -> int:  # type: ignore[override]
        """One for each prescribed part."""
        return len(self.parts)

    @property
    def moves(self) -> bool:
        """Whether any of them changes."""
        return any(self.parts.values())

    @property
    def lets_go(self) -> bool:
        """Whether it holds the start of a motion alone."""
        return self.history is None and self.held == ALWAYS

    def at(self, time: float) -> Self:
        """The drive with what it has at an instant [s] of a motion."""
        raise NotImplementedError


@dataclass(frozen=True, kw_only=True, slots=True)
class DrivenRotation(Driven):
    """The rotation of a body prescribed as angle x load factor (Eq 7), one row in rad.

    Parameters
    ----------
    angle : float, rad
    body, history, held, steady, beside, prop
        As of ``Driven``.

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

    angle: float
    history: History | None = STEADY
    beside: bool = False

    def __post_init__(self) -> None:
        require_finite("angle", self.angle, "rad")
        if not self.held[0] < self.held[1]:
            raise InvalidParameter("held", self.held, "two instants, the first before the second [s]")

    @property
    def parts(self) -> dict[int, float]:
        """The rotation [rad] under its axis, 2."""
        return {2: self.angle}

    def at(self, time: float) -> Self:
        """The drive with what it has at an instant [s] of a motion."""
        return replace(self, angle=_factor_of(self.history, time) * self.angle)


@dataclass(frozen=True, kw_only=True, slots=True)
class DrivenDisplacement(Driven):
    """The displacement of a body's centre prescribed as (dx, dy) x load factor, two rows in m.

    Parameters
    ----------
    displacement : (2,) m
        None in place of dx or dy leaves this direction free, without a row.
    body, history, held, steady, beside, prop
        As of ``Driven``.

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

    displacement: tuple[float | None, float | None]

    def __post_init__(self) -> None:
        if not self.parts or not all(math.isfinite(part) for part in self.parts.values()):
            expected = "two finite numbers [m], or one and None where the body is free"
            raise InvalidParameter("displacement", self.displacement, expected)

    @property
    def parts(self) -> dict[int, float]:
        """The prescribed displacements [m] under their axes, 0 and 1."""
        return {axis: part for axis, part in enumerate(self.displacement) if part is not None}

    def at(self, time: float) -> Self:
        """The drive with what it has at an instant [s] of a motion."""
        x, y = (part and _factor_of(self.history, time) * part for part in self.displacement)
        return replace(self, displacement=(x, y))


@dataclass(frozen=True, kw_only=True, slots=True)
class AppliedLoad(Load):
    """Force at the centre of a body and moment on it, x load factor, in a motion x history(t).

    The force is dead, or a ``follower`` that turns with the body: it has no potential then.

    Parameters: body, force (fx, fy) [N], moment, counter-clockwise positive [N m], history, follower, steady:
    in full at any load factor.
    """

    body: str
    force: tuple[float, float] = (0.0, 0.0)
    moment: float = 0.0
    history: History = STEADY
    follower: bool = False
    steady: bool = False

    def __post_init__(self) -> None:
        if not self.history or any(b[0] <= a[0] for a, b in pairwise(self.history)):
            raise InvalidParameter("history", self.history, "(time, factor) pairs with increasing times [s]")

    def at(self, time: float) -> Self:
        """The load as it is at an instant [s] of a motion."""
        factor = _factor_of(self.history, time)
        x, y = self.force
        return replace(self, force=(factor * x, factor * y), moment=factor * self.moment)

    @property
    def components(self) -> list[tuple[int, float, int]]:
        """Axis, value [N, N m] and kind of each component."""
        kind = FOLLOWER if self.follower else FORCE
        found = [(axis, part, kind) for axis, part in enumerate(self.force) if any(self.force)]
        return [*found, (2, self.moment, MOMENT)] if self.moment else found


@dataclass(frozen=True, kw_only=True, slots=True)
class Spring(Potential):
    """A spring and damper between the centres of two bodies, or of one and the ground.

    It acts on ``body`` by -k (u - u') - d d(u - u')/dt and on ``other`` by the opposite, u and u' their
    displacements and turns since rest in axes of the ground; in full at any load factor. Parameters:
    stiffness k, two in N/m and one in N m/rad; damping d, two in N s/m and one in N m s.
    """

    body: str
    other: str | None
    stiffness: tuple[float, float, float]
    damping: tuple[float, float, float]

    def __post_init__(self) -> None:
        for name, values in (("stiffness", self.stiffness), ("damping", self.damping)):
            for value in values:
                require_not_negative(name, value, "N/m, N m, with s of damping")
        if not any((*self.stiffness, *self.damping)):
            raise InvalidParameter("stiffness", self.stiffness, "a spring or damper with a constant above 0")
