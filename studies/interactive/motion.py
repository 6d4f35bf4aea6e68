"""What moves the body: an elastic hand or a load, to where strips, spring and load balance; and, released,
step after step, the sequential impulses of section 4.1 at once, in their form that is stable at any step."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from spline_model import sequential_impulse
from spline_model.compile import compile_scene
from spline_model.held import HeldPivot, HeldState
from spline_model.mechanism import Mechanism
from spline_model.motion.records import KINETIC, STRAIN
from spline_model.motion.start import Start, set_in_motion
from spline_model.solution import Later
from studies.kinds import Array

#: Most steps of the centre in the balance, the longest over the strips' length, how often one is halved, and
#: the force that is none, over EI / L^2.
MOST_PULLS, LONGEST_PULL, HALVINGS, BALANCED = 40, 0.1, 12, 1e-7
#: Stiffness of a finger's grip [N/m]; share of EI / L^2 that the spread of a seen place may show as a force;
#: that spread where a pointer shows the place [m].
FINGER, SHARE, POINTER = 1e3, 0.04, 2e-4


class Motion:
    """The motion of a released design from unknowns z (N or more,) [SI] and velocities v (Q,) [SI] on.

    Attributes:
        iterations: the solutions for impulses of the last frame.
    """

    def __init__(self, design: Mechanism, z: Array, v: Array) -> None:
        system = compile_scene(design.released())
        start = Start(set_in_motion(system), Later(z[None, : system.layout.size].copy), v)
        self._stepper, self.iterations = sequential_impulse.Stepper(start), 0

    def advance(self, steps: int, step: float) -> float:
        """Take `steps` steps of `step` seconds; returns the time done [s], 0 where the solver fails, the last
        good state being kept."""
        stepper = self._stepper
        before, kept = stepper.counted(0)["sweeps"], stepper.kept()
        if stepper.take(0.0, step, 0, steps, steps + 1, np.zeros((0, stepper.width))) < steps:
            stepper.take_back(kept)
            return 0.0
        self.iterations = stepper.counted(0)["sweeps"] - before
        return steps * step

    def state(self) -> tuple[Array, Array, float, float]:
        """Return the present unknowns (N,) and velocities (Q,), and strain and kinetic energy [J]."""
        (z,), (v,), (row,) = self._stepper.look()
        return z, v, float(row[STRAIN]), float(row[KINETIC])


@dataclass(frozen=True, eq=False)
class Pull:
    """A spring of some stiffness [N/m] from the body's centre to `pose` (3,), and a dead `load` (3,) on it.

    The turn, where the body `turns` freely, is measured by the way of a point at `length` [m].
    """

    pose: Array
    stiffness: float
    length: float
    turns: bool
    load: Array

    def balanced(self, held: HeldPivot, state: HeldState, least: float) -> tuple[HeldState | None, int]:
        """Return the state in which no force is out of balance, sought from the held `state` on, None where
        none is found, and the iterations; `least`: the size of forces [N]."""
        work = 0
        for _ in range(MOST_PULLS):
            force, tangent, _ = self._pulled(state)
            far = self.stiffness * math.dist(self.pose[:2], state.pose[:2])
            if np.linalg.norm(force) <= BALANCED * (least + far):
                return state, work
            values, ways = np.linalg.eigh(tangent)
            step = -ways @ ((ways.T @ force) / np.abs(values))
            step *= min(1.0, LONGEST_PULL * self.length / max(float(np.linalg.norm(step)), 1e-300))
            lower = self._lower(held, state, step)
            if lower is None:
                return None, work
            state = lower
            work += max(1, state.iterations)
        return None, work

    def _lower(self, held: HeldPivot, state: HeldState, step: Array) -> HeldState | None:
        """Return the state after a step of the pose, or the part of it that lowers the energy, or the force;
        None where no part does."""
        known, (force, _, before) = held.unknowns, self._pulled(state)
        for halved in range(HALVINGS):
            x, y, turn = 0.5**halved * np.append(step, np.zeros(3 - len(step)))
            pose = state.pose + np.array([x, y, turn / self.length])
            found = held.hold(float(pose[0]), float(pose[1]), float(pose[2]))
            if found.solved:
                there, _, energy = self._pulled(found)
                if energy < before or np.linalg.norm(there) < np.linalg.norm(force):
                    return found
            held.restore(known)
        return None

    def _pulled(self, state: HeldState) -> tuple[Any, Any, float]:
        """Return the force that is out of balance, (2,) or (3,) where the body turns, its derivative, and the
        energy of strips, spring and load [J]."""
        unit, spring = np.array([1.0, 1.0, 1.0 / self.length]), self.stiffness * np.array([1.0, 1.0, 0.0])
        count, away = 3 if self.turns else 2, state.pose - self.pose
        force = (state.force - self.load + spring * away) * unit
        tangent = (state.tangent + np.diag(spring)) * np.outer(unit, unit)
        stored = state.bending_energy + state.axial_energy + 0.5 * float(spring @ away**2)
        return force[:count], tangent[:count, :count], stored - float(self.load[:2] @ away[:2])


def softness(spread: Array | None, force: float) -> float:
    """Return the stiffness [N/m] of the spring from the centre to the place where the hand is seen.

    It is that of a finger, in series with a spring that turns the `spread` (3, K) of the pose [m, rad] into
    no more force than the bending of the strips hides; force: EI / L^2 [N].
    """
    seen = POINTER if spread is None else float(np.linalg.norm(spread[:2], axis=1).max())
    return 1.0 / (1.0 / FINGER + seen / (SHARE * force))


def ways(tangent: Array | None, drive: str, stiffness: float) -> Array:
    """Return the body's pose over that of the hand (3, 3) [1, m, 1/m], to first order.

    tangent: (3, 3) stiffness of the body, None if it is free; stiffness: of the hand's spring [N/m].
    """
    rigid = np.eye(3)
    if drive == "pose" or tangent is None:
        return rigid
    spring = stiffness * np.diag([1.0, 1.0, 0.0])
    if drive == "pull":
        return np.asarray(np.linalg.solve(tangent + spring, spring))
    spring = spring[:2, :2] if drive == "grip" else np.zeros((2, 2))
    rigid[:2] = np.linalg.solve(tangent[:2, :2] + spring, np.hstack((spring, -tangent[:2, 2:])))
    return rigid
