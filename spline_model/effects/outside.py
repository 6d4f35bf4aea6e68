"""Values of a design for loads, supports, springs and drives, each of which may act several times."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from spline_model.effects import boundary
from spline_model.effects.boundary import STEADY, History
from spline_model.errors import InvalidParameter, require_choice
from spline_model.scene import AXES, Body, Effect

if TYPE_CHECKING:
    from spline_model.design import Design

Vector = tuple[float, float]


def applied_force(
    design: Design,
    force: Vector,
    body: str | None = None,
    history: History = STEADY,
    at: Vector | None = None,
    follower: bool = False,
) -> Iterator[Effect | Body]:
    """Force [N] on a body, the only one if it is not named, at its centre or at a point of it that lies
    ``at`` (x, y) [m] at rest; dead, or a follower that turns with the body."""
    acts_on = design.body_named(body)
    if at is not None and follower:  # turned with its lever, its moment stays
        (x, y), (left, low) = at, next(each.centre for each in design.bodies if each.name == acts_on)
        moment = (x - left) * force[1] - (y - low) * force[0]
        yield boundary.AppliedMoment(body=acts_on, moment=moment, history=history)
    elif at is not None:
        name = f"point {tuple(at)} of {acts_on}"
        yield Body(name=name, centre=np.array(at, dtype=float), joint=True, on=acts_on)
        acts_on = name
    yield boundary.AppliedForce(body=acts_on, force=force, history=history, follower=follower)


def applied_moment(
    design: Design, moment: float, body: str | None = None, history: History = STEADY
) -> Iterator[Effect]:
    """Moment [N m] on a body, the only one if it is not named."""
    yield boundary.AppliedMoment(body=design.body_named(body), moment=moment, history=history)


def tip_force(
    design: Design,
    strip: str,
    force: Vector,
    moment: float = 0.0,
    history: History = STEADY,
    follower: bool = False,
) -> Iterator[Effect | Body]:
    """Force [N] and moment [N m] at the free end of a strip, on a frame there; the force dead, or a follower
    that turns with the section."""
    whole = next((s for s in design.strips if s.name == strip and s.tip is None), None)
    if whole is None:
        raise InvalidParameter("strip", strip, "a strip with a free end")
    frame = Body(name=tip_of(strip), centre=np.asarray(whole.end, dtype=float), joint=True)
    yield frame
    yield boundary.AppliedForce(body=frame.name, force=force, history=history, follower=follower)
    if moment != 0.0:
        yield boundary.AppliedMoment(body=frame.name, moment=moment, history=history)


def tip_of(strip: str) -> str:
    """What the frame at the free end of a strip is called."""
    return f"tip of {strip}"


def driven_displacement(
    design: Design,
    displacement: tuple[float | None, float | None],
    body: str | None = None,
    history: History | None = None,
) -> Iterator[Effect]:
    """Displacement [m] of a body's centre prescribed beside its rotation, None where it is free; in a motion
    only with a history."""
    yield boundary.DrivenDisplacement(
        body=design.body_named(body), displacement=displacement, history=history
    )


def driven_rotation(
    design: Design, angle: float, body: str | None = None, history: History | None = None
) -> Iterator[Effect]:
    """Rotation [rad] of a body prescribed beside the one that drives the path; in a motion only with a
    history."""
    yield boundary.DrivenRotation(body=design.body_named(body), angle=angle, history=history, beside=True)


def support(design: Design, fixed: Sequence[str], body: str | None = None) -> Iterator[Effect]:
    """Coordinates of a body, "x", "y" and "rotation", that stay where they are at rest, in a motion too."""
    name = design.body_named(body)
    if isinstance(fixed, str) or not fixed:
        raise InvalidParameter("fixed", fixed, "a sequence of x, y, rotation, one at least")
    for each in fixed:
        require_choice("fixed", each, AXES)
    x, y = (0.0 if axis in fixed else None for axis in AXES[:2])
    if x is not None or y is not None:
        yield boundary.DrivenDisplacement(body=name, displacement=(x, y), history=STEADY)
    if "rotation" in fixed:
        yield boundary.DrivenRotation(body=name, angle=0.0, beside=True)


def spring(
    design: Design,
    body: str | None = None,
    other: str | None = None,
    stiffness: Vector = (0.0, 0.0),
    rotational_stiffness: float = 0.0,
    damping: Vector = (0.0, 0.0),
    rotational_damping: float = 0.0,
) -> Iterator[Effect]:
    """Spring and damper between a body's centre and another's or the ground, in axes of the ground."""
    yield boundary.Spring(
        body=design.body_named(body),
        other=None if other is None else design.body_named(other),
        stiffness=(*stiffness, rotational_stiffness),
        damping=(*damping, rotational_damping),
    )
