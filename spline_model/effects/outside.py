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
    """Yield a force [N] on a body: dead, or a follower that rotates with the body.

    body: None is the only one. at: point of the body (x, y) at rest [m]; None is its centre.
    """
    acts_on, moment = design.body_named(body), 0.0
    if at is not None and follower:  # turned with its lever, its moment stays
        (x, y), (left, low) = at, next(each.centre for each in design.bodies if each.name == acts_on)
        moment = (x - left) * force[1] - (y - low) * force[0]
    elif at is not None:
        name = f"point {tuple(at)} of {acts_on}"
        yield Body(name=name, centre=np.array(at, dtype=float), joint=True, on=acts_on, turns=False)
        acts_on = name
    yield boundary.AppliedLoad(body=acts_on, force=force, moment=moment, history=history, follower=follower)


def applied_moment(
    design: Design, moment: float, body: str | None = None, history: History = STEADY
) -> Iterator[Effect]:
    """Yield a moment [N m] on a body; None is the only body."""
    yield boundary.AppliedLoad(body=design.body_named(body), moment=moment, history=history)


def tip_force(
    design: Design,
    strip: str,
    force: Vector,
    moment: float = 0.0,
    history: History = STEADY,
    follower: bool = False,
) -> Iterator[Effect | Body]:
    """Yield a force [N] and a moment [N m] at the free end of a strip, on a frame there.

    The force is dead, or a follower that rotates with the section.

    Raises
    ------
    InvalidParameter
        An unknown strip, or one without a free end.
    """
    whole = next((s for s in design.strips if s.name == strip and s.tip is None), None)
    if whole is None:
        raise InvalidParameter("strip", strip, "a strip with a free end")
    frame = f"tip of {strip}"
    yield Body(name=frame, centre=np.asarray(whole.end, dtype=float), joint=True)
    yield boundary.AppliedLoad(body=frame, force=force, moment=moment, history=history, follower=follower)


def driven_displacement(
    design: Design,
    displacement: tuple[float | None, float | None],
    body: str | None = None,
    history: History | None = None,
) -> Iterator[Effect]:
    """Yield a prescribed displacement [m] of a body's centre in addition to its rotation.

    A direction with None is free. In a motion, it needs a history.
    """
    yield boundary.DrivenDisplacement(
        body=design.body_named(body), displacement=displacement, history=history
    )


def driven_rotation(
    design: Design, angle: float, body: str | None = None, history: History | None = None
) -> Iterator[Effect]:
    """Yield a prescribed rotation [rad] of a body in addition to the one that drives the path.

    In a motion, it needs a history.
    """
    yield boundary.DrivenRotation(body=design.body_named(body), angle=angle, history=history, beside=True)


def support(design: Design, fixed: Sequence[str], body: str | None = None) -> Iterator[Effect]:
    """Yield the locked coordinates of a body, of "x", "y" and "rotation"; they are locked in a motion too.

    Raises
    ------
    InvalidParameter
        An unknown coordinate, or none.
    """
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
    """Yield a spring and damper between a body's centre and another's or the ground, in axes of the ground.

    stiffness (2,) [N/m], rotational_stiffness [N m/rad], damping (2,) [N s/m], rotational_damping [N m
    s/rad].
    """
    yield boundary.Spring(
        body=design.body_named(body),
        other=None if other is None else design.body_named(other),
        stiffness=(*stiffness, rotational_stiffness),
        damping=(*damping, rotational_damping),
    )


LOADS = applied_force, applied_moment, tip_force
PLACES = driven_displacement, driven_rotation, support, spring
SEVERAL = {each.__name__: each for each in (*LOADS, *PLACES)}
"""Effects that may act several times, each with parameters of its own."""
