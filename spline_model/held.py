"""A pivot whose body is held in a pose or turned about where it likes, state after state: ``HeldPivot``."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.errors import InvalidParameter
from spline_model.fast import pose as compiled
from spline_model.fast.body import assemble
from spline_model.fast.path import EVALUATIONS, HALVED, ITERATIONS, SMALLEST_STEP, newton, tangent
from spline_model.fast.solve import (
    TOLERANCE,
    arrays,
    at_rest,
    empty_answer,
    frame_of,
    grid_of,
    is_fast,
    mode_count,
)
from spline_model.fast.states import states_of
from spline_model.fast.strip import place_points
from spline_model.mechanism import Mechanism

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class HeldState:
    """A static state of a held body; G strips of n control points.

    solved: whether the wanted pose was reached; if not, the state is the one before and
    ``reached`` the fraction of the way that was solved. pose (3,): x, y [m], theta [rad];
    force (3,): what holds the body, forces [N] and moment about its centre [N m]; tangent
    (3, 3): its derivative in the pose; bending_energy, axial_energy [J]; unstable: negative
    pivots of the strips at the held pose; iterations, evaluations, halved: work of this call.
    """

    solved: bool
    reached: float
    pose: Array
    force: Array
    tangent: Array
    bending_energy: float
    axial_energy: float
    unstable: int
    iterations: int
    evaluations: int
    halved: int


class HeldPivot:
    """Static states of one body on Bezier strips, each found from the one before.

    ``hold`` prescribes x, y and theta (a body in the hand: Eq 7 and the driven displacements),
    ``turn`` theta alone. Exact for the discretised equations to TOLERANCE, as the multiplier
    path with the same drives is; leaves out gravity and loads. A call that finds no
    equilibrium in a bounded number of iterations leaves the state as it was and says so.
    """

    def __init__(self, mechanism: Mechanism) -> None:
        if not is_fast(mechanism):
            raise InvalidParameter("mechanism", list(mechanism.effects), "straight Bezier strips on one body")
        design = mechanism.design
        n, modes = design.discretisation.control_points, mode_count(design)
        self.frame, self.grid = frame_of(mechanism), grid_of(design)
        self._locals, self._space = arrays(len(design.strips), self.grid)
        self._rest = at_rest(self.frame, n, modes)
        size = len(self._rest)
        own = 2 * n - 6
        self._room = compiled.Room(
            tip=np.zeros(3), change=np.zeros(3), step=np.zeros(own + modes),
            last=np.zeros(size), here=np.zeros(3), start=np.zeros(size),
        )  # fmt: skip
        self._y, self.pose = self._rest.copy(), np.zeros(3)
        self._out = np.zeros(4)
        self.reset()

    def reset(self) -> HeldState:
        """Back to rest, unloaded."""
        self._y[:] = self._rest
        self.pose[:] = (*self.frame.centre, 0.0)
        return self._state(1.0, np.zeros(3, dtype=np.int64))

    @property
    def unknowns(self) -> Array:
        """A copy of the state, to be handed to ``restore``."""
        return np.concatenate((self.pose, self._y))

    def restore(self, unknowns: Array) -> HeldState:
        """Back to a state that ``unknowns`` gave."""
        self.pose[:], self._y[:] = unknowns[:3], unknowns[3:]
        return self._state(1.0, np.zeros(3, dtype=np.int64))

    def hold(self, x: float, y: float, rotation: float) -> HeldState:
        """Hold the body's centre at (x, y) [m] and its rotation [rad]."""
        target = np.array([x, y, rotation])
        if not np.isfinite(target).all():
            raise InvalidParameter("pose", [x, y, rotation], "finite numbers [m, m, rad]")
        counters = np.zeros(3, dtype=np.int64)
        reached = compiled.hold(
            self._y, self.pose, target, self.frame, self.grid, self._locals, self._room, TOLERANCE, counters
        )
        return self._state(float(reached), counters)

    def turn(self, rotation: float) -> HeldState:
        """Hold the rotation [rad] only; the body's centre goes where no force is needed."""
        if not math.isfinite(rotation):
            raise InvalidParameter("rotation", rotation, "a finite number [rad]")
        counters = np.zeros(3, dtype=np.int64)
        start, begin = self._y.copy(), float(self.pose[2])
        whole = rotation - begin
        parts = max(1, math.ceil(abs(whole) / compiled.LONGEST_TURN))
        done, step = 0.0, 1.0 / parts
        while done < 1.0:
            goal = 1.0 if done + step > 1.0 - 1e-9 else done + step
            if self._turn(begin + goal * whole, counters):
                done, step = goal, 2.0 * step
                continue
            counters[HALVED] += 1
            step *= 0.5
            if step < SMALLEST_STEP or counters[ITERATIONS] > compiled.MOST_WORK:
                self._y[:] = start
                self.pose[:] = (*(start[:2] * self.frame.length[0]), begin)
                return self._state(done, counters)
        return self._state(1.0, counters)

    def _turn(self, rotation: float, counters: NDArray[np.int64]) -> bool:
        """One part of the way of ``turn``, predicted by the tangent; the state stays if it fails."""
        before = self._y.copy()
        assemble(self._y, self.pose[2], self.frame, self.grid, self._locals, self._space, self._out)
        tangent(self._y, self.pose[2], self.frame, self.grid, self._locals, self._space)
        self._y += (rotation - self.pose[2]) * self._space.rate
        solved = newton(
            self._y,
            rotation,
            self.frame,
            self.grid,
            self._locals,
            self._space,
            self._out,
            TOLERANCE,
            counters,
        )
        strips, own = len(self.frame.length), len(self._room.step) - self.frame.compliance.shape[1]
        strip = self._y[2:].reshape(strips, -1)
        forward = (strip[:, 0] > 0).all() and (strip[:, own - 1] > 0).all()
        if solved and forward and self._out[2] > compiled.SLOWEST_SPEED:
            self.pose[:] = (*(self._y[:2] * self.frame.length[0]), rotation)
            return True
        self._y[:] = before
        return False

    def _state(self, reached: float, counters: NDArray[np.int64]) -> HeldState:
        body, out = self._space.body, self._out
        assemble(self._y, self.pose[2], self.frame, self.grid, self._locals, self._space, out)
        stiffness = np.triu(body[:, :3])
        return HeldState(
            solved=reached == 1.0,
            reached=reached,
            pose=self.pose.copy(),
            force=body[:, 3].copy(),
            tangent=stiffness + np.triu(stiffness, 1).T,
            bending_energy=float(out[0]),
            axial_energy=float(out[1]),
            unstable=int(out[3]),
            iterations=int(counters[ITERATIONS]),
            evaluations=int(counters[EVALUATIONS]),
            halved=int(counters[HALVED]),
        )

    @property
    def control_points(self) -> Array:
        """Control points of the strips in the ground's frame, (G, n, 2) [m]."""
        frame, strips = self.frame, len(self.frame.length)
        own = len(self._room.step) - frame.compliance.shape[1]
        points = np.zeros((strips, own // 2 + 3, 2))
        for s in range(strips):
            compiled.tip_of(frame, s, self.pose, self._room.tip)
            x, y, angle = self._room.tip
            at = 2 + s * len(self._room.step)
            place_points(self._y[at : at + own], x, y, math.cos(angle), math.sin(angle), points[s])
            c, d = frame.axis[s]
            points[s] = frame.root[s] + frame.length[s] * points[s] @ np.array([[c, d], [-d, c]])
        return points

    def full_state(self, system: System) -> Array:
        """The unknowns z (N,) of a compiled scene of the same mechanism, clamp reactions included."""
        answer = empty_answer(1, len(self._y))
        answer.y[0] = self._y
        answer.torque[0] = self._space.body[2, 3]
        return np.asarray(states_of(system, self.frame, self.pose[2:], answer)[0])
