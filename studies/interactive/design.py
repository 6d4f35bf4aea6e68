"""What is known of a design at work: of one instant, of the curve of a moment alone, and where its markers
sit."""

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from studies.answers.answer import centre_shift
from studies.cases.design import Design
from studies.cases.keys import GROUND
from studies.kinds import Array

#: Distance of the ground's marker from the clamped plate it is glued to [m], as on the printed sheet.
STANDOFF = 0.045
#: Side of the black square [m], as printed.
SIDE = 0.06
#: Pose of marker 1 in marker 0's frame [m, m, rad] as printed: that of a pivot at rest, whatever the design.
PRINTED = (0.0, 0.15, 0.0)


@dataclass(frozen=True, kw_only=True, eq=False)
class Snapshot:
    """All that is shown of one instant, in SI units.

    Attributes:
        pose: x, y, theta of the body (3,); velocity (3,), zero while held; poses (B, 3) of all bodies.
        shape (S, P, 2) [m], stress (S, P), largest in the section [Pa]: of the strips, evenly along each.
        force: what holds the body (3,) [N, N, N m], zero when released; tangent (3, 3) its derivative or
            None.
        energy: by what has it [J]: strain, kinetic, potential of the load from rest on, and dissipated since
            the release, by the strips' damping and the steps.
        centre: the instantaneous centre of rotation, None where the body does not turn.
        iterations: of Newton's method.
    """

    pose: Array
    poses: Array
    velocity: Array = field(default_factory=lambda: np.zeros(3))
    shape: Array
    stress: Array
    force: Array = field(default_factory=lambda: np.zeros(3))
    tangent: Array | None = None
    energy: dict[str, float]
    centre: tuple[float, float] | None
    iterations: int

    @staticmethod
    def pole(pose: Array, velocity: Array, least: float) -> tuple[float, float] | None:
        """Return the instantaneous centre [m] of a body at `pose` (3,) with `velocity` (3,), None below
        `least` rad/s."""
        vx, vy, omega = velocity
        if not abs(omega) > least:
            return None
        return float(pose[0] - vy / omega), float(pose[1] + vx / omega)

    @staticmethod
    def free_stiffness(tangent: Array) -> float:
        """Return the rotational stiffness of a body whose centre is free [N m/rad] (Eq 20).

        tangent: (3, 3) of its x, y and rotation [N/m, N, N m].
        """
        return float(tangent[2] @ Snapshot.free_turn(tangent))

    @staticmethod
    def free_turn(tangent: Array) -> Array:
        """Return the velocity (3,) of a body that a moment alone turns at 1 rad/s; tangent (3, 3)."""
        shift = -np.linalg.solve(tangent[:2, :2], tangent[:2, 2])
        return np.array([shift[0], shift[1], 1.0])

    @cached_property
    def stiffness(self) -> float | None:
        """Rotational stiffness with the body's centre free [N m/rad] (Eq 20), None when released."""
        return None if self.tangent is None else self.free_stiffness(self.tangent)

    def stable(self, length: float) -> bool:
        """Return whether the body would stay if its pose, or its rotation alone, were released.

        length: of the strips [m], which makes the units of the tangent equal.
        """
        if self.tangent is None:
            return True
        unit = np.array([1.0, 1.0, 1.0 / length])
        return bool(np.linalg.eigvalsh(self.tangent * np.outer(unit, unit))[0] > 0.0)


@dataclass(frozen=True, kw_only=True, eq=False)
class Curve:
    """A rotations [rad] from 0 on as far as the body goes; the other side is the mirror's picture.

    shift (A, 2): of the centre from rest [m]; moment (A,) [N m]; stress (A,): largest in the strips [Pa].
    """

    rotation: Array
    shift: Array
    moment: Array
    stress: Array

    def gap(self, displacement: Array) -> float:
        """Return the distance [m] of a displacement (3,) from the path; 0 beyond its end."""
        x, y, turn = displacement
        if abs(turn) > self.rotation[-1]:
            return 0.0
        along, across = (float(np.interp(abs(turn), self.rotation, self.shift[:, k])) for k in range(2))
        return math.hypot(x - math.copysign(1.0, turn) * along, y - across)

    def where(self, stress: float | None) -> tuple[float, float] | None:
        """Return rotation [rad] and moment [N m] at which the largest stress is `stress` [Pa], None where it
        stays below."""
        if stress is None or self.stress[-1] < stress:
            return None
        turn, moment = (float(np.interp(stress, self.stress, y)) for y in (self.rotation, self.moment))
        return turn, moment


def turn(angle: float) -> Array:
    """Return the matrix (2, 2) that turns vectors by `angle` [rad]."""
    cos, sin = math.cos(angle), math.sin(angle)
    return np.array([[cos, -sin], [sin, cos]])


class Placing:
    """Rest places of a design in its own frame, and of the markers' centres there, both upright.

    Attributes:
        clamps: of the strips, both ends (S, 2, 2) [m]; ends (S, 2): the bodies there by number, -1 of the
            ground; centres (B, 2) of the bodies [m]; number, centre: of the held one.
        base: mean of the ground's clamps, ground: of marker 0 (2,) [m]; rest: pose (3,) of marker 1 in marker
            0's frame, as on the printed sheet or as it was taken.
    """

    def __init__(self, design: Design, rest: Any = PRINTED, body: str | None = None) -> None:
        self.clamps = np.array([(strip.start, strip.end) for strip in design.strips])
        self.names = [each.name for each in design.bodies]
        number: dict[str | None, int] = {GROUND: -1, **{name: k for k, name in enumerate(self.names)}}
        self.ends = np.array([(number[strip.root], number[strip.tip]) for strip in design.strips])
        self.centres, self.number = np.array([each.centre for each in design.bodies]), number.get(body, 0)
        self.centre, self.rest = self.centres[self.number], np.array(rest, dtype=float)
        self.base = self.clamps[self.ends < 0].mean(axis=0)
        self.ground = self.base - np.array([0.0, STANDOFF])
        self._crossing = design.crossing_of_chords

    @property
    def _arm(self) -> Array:
        """From marker 1 to the body's centre (2,) [m], at rest."""
        return np.asarray(self.centre - self.ground - self.rest[:2])

    def crossing_shift(self, body: Array) -> float | None:
        """Return the displacement [m] of the body point that lies in the strips' crossing at rest.

        body: pose (3,) [m, m, rad]. None for a design that has not one body on two strips that cross.
        """
        if self._crossing is None:
            return None
        (shift,) = centre_shift(self._crossing, body[2:], body[None, :2], self.centres)
        return math.hypot(*shift)

    def body(self, marker: Array, near: float = 0.0) -> Array:
        """Return the body's pose (3,) [m, m, rad] for marker 1 at `marker` (3,) in marker 0's frame.

        Its rotation is counted on from `near` [rad].
        """
        angle = near + math.remainder(marker[2] - self.rest[2] - near, math.tau)
        return np.array([*(self.ground + marker[:2] + turn(angle) @ self._arm), angle])

    def marker(self, body: Array) -> Array:
        """Return the pose (3,) of marker 1 in marker 0's frame for the body's pose (3,) [m, m, rad]."""
        return np.array([*(body[:2] - self.ground - turn(body[2]) @ self._arm), body[2] + self.rest[2]])

    def spread(self, sd: Array, angle: float) -> Array:
        """Return the body's pose over those of the marker's x, y and turn (3, 3), in standard deviations, at
        the body's turn [rad]."""
        arm = turn(angle) @ self._arm
        return np.array([[1.0, 0.0, -arm[1]], [0.0, 1.0, arm[0]], [0.0, 0.0, 1.0]]) * sd
