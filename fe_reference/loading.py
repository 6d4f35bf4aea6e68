"""Effects of which a model definition may have any number: loads, drives, supports and springs."""

from dataclasses import dataclass, field
from typing import Annotated, Any

import numpy as np

from .errors import (
    Checked,
    History,
    InvalidParameter,
    Pair,
    finite,
    flag,
    not_negative,
    not_negatives,
    optional,
    pair,
    partly,
    read_history,
)

#: The history of what does not change.
ALWAYS_FULL: History = ((0.0, 1.0),)
#: Coordinates of a body: those of its centre, and its turn.
WAYS = ("x", "y", "rotation")


@dataclass(frozen=True, kw_only=True)
class Effect(Checked):
    """An effect without parameters."""


@dataclass(frozen=True, kw_only=True)
class Several(Effect):
    """An effect of which a model definition may have any number, each with its own parameters."""


@dataclass(frozen=True, kw_only=True)
class Load(Several):
    """A force (f_x, f_y) [N] and a moment [N m], times load factor or history.

    body: that it acts on, None: the only one. at: point of the body (x, y) [m] at rest where the force acts,
    by default its centre. A dead force keeps its direction; a follower turns with what it acts on.
    """

    body: str | None = None
    history: Annotated[History, read_history] = ALWAYS_FULL
    force: Annotated[Pair, pair, "N"] = (0.0, 0.0)
    moment: Annotated[float, finite, "N m"] = 0.0
    at: Annotated[Pair | None, optional, pair, "m"] = None
    follower: Annotated[bool, flag] = False


@dataclass(frozen=True, kw_only=True)
class AppliedForce(Load):
    """Force on a body.

    Attributes:
        force: (F_x, F_y) [N].
        moment: none; the inherited point `at` [m] of the body may be off its centre.
    """

    force: Annotated[Pair, pair, "N"] = field()
    moment: float = field(init=False, default=0.0)


@dataclass(frozen=True, kw_only=True)
class AppliedMoment(Load):
    """Moment on a body.

    Attributes:
        moment: positive counter-clockwise [N m].
        force, at, follower: none, for a moment has no point and turns with nothing.
    """

    moment: Annotated[float, finite, "N m"] = field()
    force: Pair = field(init=False, default=(0.0, 0.0))
    at: None = field(init=False, default=None)
    follower: bool = field(init=False, default=False)


@dataclass(frozen=True, kw_only=True)
class TipForce(Load):
    """Force and moment at the free end of a strip; a follower turns with the section there."""

    strip: str
    force: Annotated[Pair, pair, "N"] = field()
    body: None = field(init=False, default=None)
    at: None = field(init=False, default=None)


@dataclass(frozen=True, kw_only=True)
class Prescribed(Several):
    """Coordinates of a body that are led, times the load factor.

    body: None for the one whose rotation is driven, or the only one. In a motion it releases at the start, or
    with a history goes on leading, times that.
    """

    body: str | None = None
    history: Annotated[History | None, optional, read_history] = None

    @property
    def ends(self) -> tuple[float | None, ...]:
        """Displacement x, y [m] and turn [rad] that the body is led to (3,), None where it is free."""
        raise NotImplementedError


@dataclass(frozen=True, kw_only=True)
class DrivenDisplacement(Prescribed):
    """Displacement that the centre of a body is led to.

    Attributes:
        displacement: (d_x, d_y) [m]. None in place of one of them leaves the body free that way.
    """

    displacement: Annotated[tuple[float | None, float | None], partly, "m"]

    @property
    def ends(self) -> tuple[float | None, ...]:
        """Both displacements [m], and None for the free turn."""
        return (*self.displacement, None)


@dataclass(frozen=True, kw_only=True)
class PrescribedRotation(Prescribed):
    """Rotation that a body is led to, besides the body whose rotation is driven.

    Attributes:
        angle: positive counter-clockwise [rad].
    """

    angle: Annotated[float, finite, "rad"]

    @property
    def ends(self) -> tuple[float | None, ...]:
        """None for both free displacements, and the angle [rad]."""
        return None, None, self.angle


def _ways(name: str, value: Any) -> tuple[str, ...]:
    """Return the names of coordinates of a body, each once and one at least."""
    if not isinstance(value, list | tuple) or not value or len(set(value) & set(WAYS)) != len(value):
        raise InvalidParameter(name, value, f"one or more of {', '.join(WAYS)}, each once [name]")
    return tuple(value)


@dataclass(frozen=True, kw_only=True)
class Support(Prescribed):
    """Coordinates of a body, of WAYS, that stay where they are at rest, in a motion too."""

    history: History | None = field(init=False, default=ALWAYS_FULL)
    fixed: Annotated[tuple[str, ...], _ways]

    @property
    def ends(self) -> tuple[float | None, ...]:
        """Zeros [m, rad] where the body is fixed, None where it is free."""
        return tuple(0.0 if way in self.fixed else None for way in WAYS)


@dataclass(frozen=True, kw_only=True)
class Spring(Several):
    """Spring and damper between the centre of a body and that of another, or the ground.

    In axes of the ground, of displacements and turns since rest. In full at any load factor.

    Attributes:
        other: name of the other body; None: the ground.
        stiffness, damping: of the displacements, (k_x, k_y) [N/m] and (c_x, c_y) [N s/m].
        rotational_stiffness, rotational_damping: of the turns [N m/rad, N m s/rad].
    """

    body: str | None = None
    other: str | None = None
    stiffness: Annotated[Pair, not_negatives, "N/m"] = (0.0, 0.0)
    rotational_stiffness: Annotated[float, not_negative, "N m/rad"] = 0.0
    damping: Annotated[Pair, not_negatives, "N s/m"] = (0.0, 0.0)
    rotational_damping: Annotated[float, not_negative, "N m s/rad"] = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        own = (*self.stiffness, self.rotational_stiffness, *self.damping, self.rotational_damping)
        if not any(own):
            raise InvalidParameter("spring", self.body, "a stiffness or a damping above 0 [N/m]")
        if self.other is not None and self.other == self.body:
            raise InvalidParameter("other", self.other, "another body, or None for the ground [name]")


def factor_of(points: History, time: float) -> float:
    """Return the factor at an instant [s]: constant before the first and after the last."""
    return float(np.interp(time, *np.transpose(points)))
