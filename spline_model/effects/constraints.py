"""Constraints: clamped and pinned strip ends, driven bodies (Eqs 5 to 7)."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import ClassVar, Literal

from spline_model.effects.base import Constraint
from spline_model.effects.history import STEADY, History, factor_of
from spline_model.errors import InvalidParameter, require_finite

GROUND = "ground"
ALWAYS = (0.0, math.inf)


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
    """The rotation of a body prescribed as angle x load factor (Eq 7), one row in rad.

    In a motion it acts in ``held``, from - to [s], and changes by angle x the change of
    history(t) from where the body is when it begins; a body that is caught loses the velocity
    that the drive does not have. Its multiplier is the torque
    that has to be applied to the body [N m]; positive counter-clockwise.
    """

    rows: ClassVar[int] = 1
    body: str
    angle: float
    history: History = STEADY
    held: tuple[float, float] = ALWAYS

    def __post_init__(self) -> None:
        require_finite("angle", self.angle, "rad")
        if not self.held[0] < self.held[1]:
            raise InvalidParameter("held", self.held, "two instants, the first before the second [s]")


@dataclass(frozen=True, kw_only=True, slots=True)
class DrivenDisplacement(Constraint):
    """The displacement of a body's centre prescribed as (dx, dy) x load factor, two rows in m.

    A ``steady`` one is there in full at any load factor.

    The paper's "two other driving constraints" (section 4). Without a history it holds the start of
    a motion and lets go; with one it goes on holding through the motion, as ``DrivenRotation``. The
    multipliers are the applied force [N].
    """

    rows: ClassVar[int] = 2
    body: str
    displacement: tuple[float, float]
    history: History | None = None
    held: tuple[float, float] = ALWAYS
    steady: bool = False

    def __post_init__(self) -> None:
        if not all(math.isfinite(part) for part in self.displacement):
            raise InvalidParameter("displacement", self.displacement, "two finite numbers [m]")

    @property
    def lets_go(self) -> bool:
        """Whether it holds the start of a motion alone."""
        return self.history is None and self.held == ALWAYS

    def at(self, time: float) -> DrivenDisplacement:
        """The drive with the displacement that it has at an instant [s] of a motion."""
        part = 1.0 if self.history is None else factor_of(self.history, time)
        return replace(self, displacement=(part * self.displacement[0], part * self.displacement[1]))
