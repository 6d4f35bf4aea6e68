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

    None in place of dx or dy leaves that way free, and its row out. A ``steady`` one is there in full at any
    load factor.

    The paper's "two other driving constraints" (section 4). Without a history it holds the start of
    a motion and lets go; with one it goes on holding through the motion, as ``DrivenRotation``. The
    multipliers are the applied force [N].
    """

    body: str
    displacement: tuple[float | None, float | None]
    history: History | None = None
    held: tuple[float, float] = ALWAYS
    steady: bool = False

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
        part = 1.0 if self.history is None else factor_of(self.history, time)
        x, y = (None if moved is None else part * moved for moved in self.displacement)
        return replace(self, displacement=(x, y))
