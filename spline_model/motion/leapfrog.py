"""The leapfrog, with a corrected force, on the coordinates y of a free mechanism: all steps compiled.

    w(t + h/2) = w(t - h/2) + h A(y + h^2/12 A(y, w), w),   y(t + h) = y(t) + h w(t + h/2)

Two evaluations a step give fourth order in the phase of every oscillation (effective order, Takahashi and
Imada's scheme with the force gradient as a displacement) and stability up to omega h = sqrt(12), against 2
for one evaluation. The rates that A depends on, by centripetal parts only, are extrapolated. Sources:
Wisdom, Holman and Touma, Fields Inst Comm 10 (1996) 217; Hairer, McLachlan and Skeel, ESAIM: M2AN 43
(2009) 631.

omega is the highest frequency, an axial one. Clamps hold because they are solved, not enforced. Energy is not
kept to round-off: that of Table 1 with six control points changes by 1.5e-4 over 0.05 s at steps of 5
microseconds.
Strips that cannot stretch are refused: off the states of a step nothing keeps their length.
"""

from __future__ import annotations

import math
from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.errors import InvalidParameter
from spline_model.modes import linear_modes
from spline_model.motion import energy_consistent
from spline_model.motion.acceleration import accelerate
from spline_model.motion.arrays import Masses, zeros
from spline_model.motion.energy_consistent import forward, store
from spline_model.motion.moves import STEP
from spline_model.motion.start import Motion, Start
from spline_model.reduced.model import Reduced
from spline_model.reduced.states import coordinates_by
from spline_model.strip.compiled import kernel, part
from spline_model.strip.ends import move_points, place_points

Array = NDArray[np.float64]

NAME = "leapfrog"
"""What the integrator is called."""
STABILITY_LIMIT = 12.0**0.5
"""omega h up to which a step does not amplify an undamped oscillation."""
PART = 0.9
"""Default step over the longest stable one, which is that of the highest frequency at start and at rest:
stress stiffens the strips on the way."""
LARGEST_GAIN = 1e-2
"""Of energy over that at the start: it is kept in the limit of short steps only."""


class _Grid(NamedTuple):
    """Constants of S strips with I inner points.

    frames (S, 2, 4) point and direction of root and tip in the frame of their body or the ground; inverse
    (S, I, I) B_ii^-1; follow (S, 4, I) W^T, ends (S, 4, 4) the end points' mass.
    """

    frames: Array
    inverse: Array
    follow: Array
    ends: Array

    @classmethod
    def of(cls, model: Reduced, masses: Masses) -> _Grid:
        """The constants of strips with mass."""
        inner, mass = masses.points.shape[1] - 4, masses.points
        inverse = np.asarray(np.linalg.inv(mass[:, :inner, :inner]), dtype=float)
        across = mass[:, :inner, inner:]
        follow = inverse @ across
        frames = np.stack((model.strips.root, model.strips.tip), axis=1).take([0, 1, 2, 2], axis=2)
        frames[..., 2], frames[..., 3] = np.cos(frames[..., 2]), np.sin(frames[..., 3])
        return cls(
            frames=frames,
            inverse=inverse,
            follow=np.ascontiguousarray(follow.transpose(0, 2, 1)),
            ends=mass[:, inner:, inner:] - across.transpose(0, 2, 1) @ follow,
        )


class _Room(NamedTuple):
    """Working arrays: x, u, push where accelerations are asked for, rates and the accelerations; mean of a
    step; turns: cosine and sine of the bodies; ends: frames; drift: accelerations of the end points by the
    rates; covector of the end points, along: of all points; g, h, solved of a strip; tangent, load of the
    bodies.
    """

    x: Annotated[Array, "Y"]
    u: Annotated[Array, "Y"]
    push: Annotated[Array, "Y"]
    mean: Annotated[Array, "Y"]
    turns: Annotated[Array, "B 2"]
    ends: Annotated[Array, "2 6"]
    drift: Annotated[Array, "S 8"]
    covector: Annotated[Array, "8"]
    along: Annotated[Array, "2n"]
    g: Annotated[Array, "S 8"]
    h: Annotated[Array, "S 8 8"]
    solved: Annotated[Array, "8"]
    tangent: Annotated[Array, "Q Q"]
    load: Annotated[Array, "Q"]


@part()
def _start_stage(stage, h, y, w, push, room):
    """Where a stage asks for accelerations, room.x, and the rates there, room.u; stage -1 begins a run."""
    x, u, mean = room.x, room.u, room.mean
    for i in range(y.size):
        if stage < 0:
            x[i], u[i] = y[i], w[i]
        elif stage == 0:
            y[i] += h * mean[i]
            x[i], u[i] = y[i], mean[i] + 0.5 * h * push[i]
        else:
            x[i] = y[i] + h * h / 12.0 * push[i]


@part()
def _end_stage(stage, h, w, push, room):
    """What a stage adds."""
    mean = room.mean
    for i in range(w.size):
        if stage < 0:
            mean[i] = w[i] + 0.5 * h * push[i]
        elif stage == 1:
            mean[i] += h * push[i]
            w[i] = mean[i] - 0.5 * h * push[i]


@part()
def _show(w, arrays, room, state):
    """The state at y with rates w, with the axial forces of the last evaluation."""
    strips, n, poses = arrays.strips, arrays.shape.order.size, state.rate.size
    modes = strips.compliance.shape[1]
    for i in range(poses):
        state.rate[i] = w[i]
    for s in range(strips.roots.size):
        at = poses + s * (2 * n - 6 + modes)
        for i in range(at + 2 * n - 6, at + 2 * n - 6 + modes):
            state.y[i] = room.x[i]
        place_points(s, state.y[at : at + 2 * n - 6], state.y, strips, arrays.local)
        move_points(s, at, w, strips, arrays.local, state.velocity[s])


@kernel()
def _run(h, every, w, push, grid, arrays, masses, room, state, records):
    """Fill the rows of the records, ``every`` steps apart; returns the rows filled.

    A state that diverges or is no strip's ends the run.
    """
    y = state.y
    for row in range(records.shape[0]):
        for step in range(every):
            for stage in range(-1 if row + step == 0 else 0, 2):
                _start_stage(stage, h, y, w, push, room)
                accelerate(room.x, room.u, grid, arrays, masses, room, push)
                _end_stage(stage, h, w, push, room)
            largest = 0.0
            for i in range(y.size):
                moved = abs(y[i]) + h * abs(w[i]) if w[i] != 0.0 else 0.0
                largest = max(largest, moved) if moved == moved else np.inf
            if not largest < 1e3:  # far outside any pose, or not finite
                return row
        _show(w, arrays, room, state)
        store(state, arrays, masses, records[row])
        if not forward(y, arrays, masses):
            return row
    return records.shape[0]


class Stepper(energy_consistent.Stepper):
    """A free scene that the scheme advances, all steps in one call; the first that fails ends the run."""

    name = NAME
    most_gain = LARGEST_GAIN
    smallest = 1.0

    def __init__(self, start: Start) -> None:
        require_explicit(start.motion)
        super().__init__(start)
        model, masses, state = self.model, self._masses, self.state
        w = np.zeros(model.size)
        if start.v.any():
            w[:] = np.linalg.lstsq(coordinates_by(model, state.y), start.v, rcond=None)[0]
        room = zeros(_Room, self._sizes | {"B": self._sizes["Q"] // 3})
        self._start = start
        self._given = w, np.zeros_like(w), _Grid.of(model, masses), self._arrays, masses, room, state

    def default_step(self) -> float:
        """Return the default, or a stable step where that is shorter [s]."""
        return min(STEP, PART * critical_step(self.motion, self._start.z))

    def steps(self, time: float, step: float, begin: int, end: int, every: int, records: Array) -> int:
        """Take the steps from the first on; at any time, as nothing that acts has a history."""
        return every * int(_run(step, every, *self._given, records))

    def counted(self, steps: int) -> dict[str, int]:
        """Steps and evaluations of the good records."""
        return {"steps": steps, "evaluations": 2 * steps}

    def stopped(self, record: float, reached: float, *, grows: bool) -> str:
        """Where it became unstable, and what helps."""
        return f"unstable near {record:.6g} s: the step is above the critical one; take a shorter step"


def critical_step(motion: Motion, z: Array) -> float:
    """Return the longest stable step [s], by the highest frequency at a state and at rest."""
    return STABILITY_LIMIT / highest_frequency(motion, z)


def highest_frequency(motion: Motion, z: Array) -> float:
    """Return the highest circular frequency at a state and at rest [rad/s]."""
    system = motion.system
    return math.sqrt(max(linear_modes(system, state)[0][-1] for state in (z, system.rest)))


def require_explicit(motion: Motion) -> None:
    """Refuse a scene whose accelerations do not follow from its state alone."""
    damped = motion.system.drag.size or motion.system.relaxation_time > 0.0
    if damped or motion.drives.row.size or motion.loads.coordinate.size:
        expected = "energy (the default) for damping, loads, drives and supports"
        raise InvalidParameter("integrator", NAME, expected)
    if motion.inextensible:
        raise InvalidParameter("integrator", NAME, "energy (the default) for strips that cannot stretch")
    layout = motion.system.layout
    blocks = [motion.system.mass[at, at][::2, ::2] for at in map(layout.strip, layout.strips)]
    if not all(np.linalg.eigvalsh(block)[0] > 0.0 for block in blocks):
        raise InvalidParameter("integrator", NAME, "energy for strips without mass")
