"""One design at work: held statically by its body's pose, released, stepped and caught."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from spline_model.compile import compile_scene
from spline_model.content import STEPS_PER_PERIOD
from spline_model.held import HeldPivot, HeldState
from spline_model.modes import natural_frequencies
from spline_model.pivot import BODY, STRIPS
from studies.interactive.design import PLACES, REACH, Curve, build, chosen, read, scales
from studies.interactive.motion import Motion, Pull, motion
from studies.interactive.presets import STEP
from studies.kinds import Array

#: Time over which strips follow the hand's velocity at a release [s]: short enough that no pose leaves its
#: branch.
HAND_STEP = 1e-4
#: Rotation rate below which a moving body has no instantaneous centre worth drawing, over the step [rad].
LEAST_TURN = 2e-4

#: Part of a standard deviation over which a stiffness is taken to be linear.
PART = 1e-3
#: A step that the solver cannot take is tried at this part of it, then at the part's part, down to the least.
SHORTER, SHORTEST = 0.25, 2.0**-10


@dataclass(frozen=True, kw_only=True, eq=False)
class Snapshot:
    """All that is shown of one instant, in SI units.

    Attributes:
        pose: x, y, theta of the body (3,); velocity (3,), zero while held.
        shape (2, P, 2) [m], stress (2, P) [Pa]: of the strips, as `design.read` says.
        force: what holds the body (3,) [N, N, N m], zero when released; tangent (3, 3) its derivative or
            None.
        stiffness: rotational, with the body's centre free [N m/rad], None when released.
        energy: by what has it [J]: strain, kinetic, potential of the load from rest on, dissipated by the
            strips' damping, lost to the steps' own.
        centre: the instantaneous centre of rotation, None where the body does not turn.
        iterations: of Newton's method.
    """

    pose: Array
    velocity: Array = field(default_factory=lambda: np.zeros(3))
    shape: Array
    stress: Array
    force: Array = field(default_factory=lambda: np.zeros(3))
    tangent: Array | None = None
    stiffness: float | None = None
    energy: dict[str, float]
    centre: tuple[float, float] | None
    iterations: int


class Mechanics:
    """The pivot of some parameters; `snapshot` is always the last good state.

    Args:
        values: all parameters in SI units, as `presets.checked` returns them.

    Attributes:
        control_points: of a strip; doubt: what is to be said of the error that they leave, empty if nothing.
        begun: energy [J] of strips, body and load at the release, or where the solver was changed.
    """

    def __init__(self, values: Mapping[str, float]) -> None:
        self.values = dict(values)
        self.control_points, self.doubt = chosen(values)
        self.pivot = build(values, self.control_points)
        self.step = STEP * values["time_scale"]
        self._held = HeldPivot(self.pivot)
        self._acting = build(values, self.control_points, loaded=True)
        self._system = compile_scene(self._acting.released())
        self._load = np.array([0.0, -values["load"], 0.0])
        self._motion: Motion | None = None
        self._part, self.begun = 1.0, 0.0
        self._unheld: Array | None = None
        self.snapshot = self._static(self._held.reset())

    @cached_property
    def longest_step(self) -> float:
        """Longest step [s] that resolves a swing about rest in phase and amplitude."""
        lowest = natural_frequencies(self.pivot).frequency[0]
        return 1.0 / (STEPS_PER_PERIOD * float(lowest)) if lowest > 0.0 else math.inf

    def pace(self, time_scale: float) -> None:
        """From now on so many simulated seconds in one."""
        self.values["time_scale"], self.step, self._part = time_scale, STEP * time_scale, 1.0

    @property
    def moving(self) -> bool:
        """Whether the body is released."""
        return self._motion is not None

    def reset(self) -> None:
        """Back to rest, held."""
        self._motion = None
        self.snapshot = self._static(self._held.reset())

    def hold(self, pose: Array) -> float:
        """Hold the body at `pose` (3,); returns the part of the way that was solved, 1 for all of it.

        Where no equilibrium follows from the last state, a way from rest is tried: first turned, then pushed.
        """
        state = self._held.hold(*pose)
        work = state.iterations
        if not state.solved:
            known, reached = self._held.unknowns, state.reached
            self._held.reset()
            self._held.turn(float(pose[2]))
            state = self._held.hold(*pose)
            work += state.iterations
            if not state.solved:
                self._held.restore(known)
                return reached
        self.snapshot = self._static(state, work)
        return 1.0

    def turn(self, rotation: float) -> float:
        """Hold the rotation alone; returns as `hold`."""
        if self._load.any():
            return self.grip(np.array([*self.pivot.centre, rotation]), 0.0)
        state = self._held.turn(rotation)
        if state.solved:
            self.snapshot = self._static(state)
        return state.reached

    def grip(self, pose: Array, stiffness: float, *, turns: bool = False) -> float:
        """Hold the centre by a spring of `stiffness` [N/m] to `pose` (3,), and the turn unless it `turns`;
        as `hold`.

        The pose minimises the energy of strips, spring and load, sought from where no force acts on it.
        """
        held, known = self._held, self._held.unknowns
        if self._unheld is not None:
            held.restore(self._unheld)
        state = held.turn(float(self.snapshot.pose[2] if turns else pose[2]))
        if not state.solved:
            held.restore(known)
            return state.reached
        self._unheld = held.unknowns
        pull = Pull(pose, stiffness, self.values["length"], turns, self._load)
        found, work = pull.balanced(held, state, scales(self.values)["force"])
        if found is None:
            held.restore(known)
            return 0.0
        self.snapshot = self._static(found, state.iterations + work)
        return 1.0

    def stiffness_spread(self, ways: Array) -> float:
        """Return the standard deviation of the stiffness [N m/rad] where the pose's is the sum of the
        independent columns of `ways` (3, k), to first order; nan where a state beside is not found."""
        known, here, total = self._held.unknowns, self.snapshot, 0.0
        for way in PART * ways.T:
            state = self._held.hold(*(here.pose + way))
            change = _free_stiffness(state.tangent) - (here.stiffness or 0.0) if state.solved else math.nan
            total += (change / PART) ** 2
            self._held.restore(known)
        return math.sqrt(total)

    @cached_property
    def curve(self) -> Curve:
        """What a moment alone does to the design, and its load; without any turn whatever is found."""
        other = Mechanics(self.values)
        rows: list[list[float]] = []
        for angle in np.linspace(0.0, REACH, PLACES):
            if other.turn(float(angle)) < 1.0 and rows:
                break
            now = other.snapshot
            shift, stress = now.pose[:2] - self.pivot.centre, now.stress.max()
            rows.append([now.pose[2], *shift, now.force[2], stress])
        table = np.array(rows)
        return Curve(rotation=table[:, 0], shift=table[:, 1:3], moment=table[:, 3], stress=table[:, 4])

    def release(self, velocity: Array, solver: str, sweeps: int) -> None:
        """Let go of the held body with a `velocity` (3,) of its pose; the strips follow it."""
        self._move(solver, sweeps, self._held.full_state(self._system), self._rates(velocity))

    def change_solver(self, solver: str, sweeps: int) -> None:
        """Let a released body move on by another solver, from where it is."""
        if self._motion is not None:
            now = self._motion.state()
            self._move(solver, sweeps, now.z, now.v)

    def _move(self, solver: str, sweeps: int, z: Array, v: Array) -> None:
        """Move from unknowns z and velocities v (Q,) on; energies are counted from there."""
        self._motion, self._part = motion(solver, sweeps, self._acting, z, v), 1.0
        now = self._motion.state()
        self.begun = now.strain + now.kinetic + self._potential(now.z[self._system.layout.body(BODY)])
        self.snapshot = self._dynamic(self._motion)

    @property
    def resolved(self) -> bool:
        """Whether a moving body's steps resolve its swing."""
        moving = self._motion
        return moving is None or min(self._part * self.step, moving.longest) <= self.longest_step

    def advance(self, steps: int) -> float:
        """Take steps of the released body, shorter ones where the solver cannot take them; returns the time
        done [s], 0 where it gives up, the last state being kept."""
        moving = self._motion
        while moving is not None and self._part >= SHORTEST:
            if done := moving.advance(steps, self._part * self.step):
                self.snapshot = self._dynamic(moving)
                return done
            self._part *= SHORTER
        return 0.0

    def catch(self) -> bool:
        """Hold the moving body where it is; False, and still moving, where no static state is found there."""
        caught = self.hold(self.snapshot.pose.copy()) == 1.0
        self._motion = None if caught else self._motion
        return caught

    def _rates(self, velocity: Array) -> Array:
        """Velocities of all coordinates (Q,) when the body moves with `velocity` through static states."""
        count = self._system.layout.coordinate_count
        if not velocity.any():
            return np.zeros(count)
        known, pose, ends = self._held.unknowns, self._held.pose.copy(), []
        for sign in (1.0, -1.0):
            state = self._held.hold(*(pose + sign * HAND_STEP * velocity))
            ends.append(self._held.full_state(self._system)[:count] if state.solved else None)
            self._held.restore(known)
        if ends[0] is None or ends[1] is None:
            return np.zeros(count)
        return np.asarray((ends[0] - ends[1]) / (2.0 * HAND_STEP))

    def _potential(self, pose: Array) -> float:
        """Energy of the load [J] from the body's place at rest on."""
        return float(self._load[:2] @ (self.pivot.centre - pose[:2]))

    def _static(self, state: HeldState, iterations: int | None = None) -> Snapshot:
        return Snapshot(
            **self._shown(state.pose, self._held.control_points, state.bending_energy + state.axial_energy),
            force=state.force - self._load,
            tangent=state.tangent,
            stiffness=_free_stiffness(state.tangent),
            centre=_pole(state.pose, _free_turn(state.tangent), 0.0),
            iterations=state.iterations if iterations is None else iterations,
        )

    def _dynamic(self, moving: Motion) -> Snapshot:
        now, layout = moving.state(), self._system.layout
        pose, velocity = now.z[layout.body(BODY)].copy(), now.v[layout.body(BODY)].copy()
        points = np.stack([now.z[layout.strip(name)].reshape(-1, 2) for name in STRIPS])
        known = self._shown(pose, points, now.strain, now.kinetic, now.dissipated)
        known["energy"]["lost"] = self.begun - sum(known["energy"].values())
        centre = _pole(pose, velocity, LEAST_TURN / self.step)
        return Snapshot(**known, velocity=velocity, centre=centre, iterations=now.iterations)

    def _shown(
        self, pose: Array, points: Array, strain: float, kinetic: float = 0.0, dissipated: float = 0.0
    ) -> dict[str, Any]:
        """Return what follows from the pose, the control points of the strips (2, n, 2) and the energies."""
        shape, stress = read(self.values, points)
        energy = {"strain": strain, "kinetic": kinetic, "potential": self._potential(pose)}
        energy |= {"dissipated": dissipated, "lost": 0.0}
        return {"pose": pose, "shape": shape, "stress": stress, "energy": energy}


def _pole(pose: Array, velocity: Array, least: float) -> tuple[float, float] | None:
    """Return the instantaneous centre of a body at `pose` (3,) with `velocity` (3,) [m], None below `least`
    rad/s."""
    vx, vy, omega = velocity
    if not abs(omega) > least:
        return None
    return float(pose[0] - vy / omega), float(pose[1] + vx / omega)


def _free_turn(tangent: Array) -> Array:
    """Return the velocity (3,) of a body that is turned at 1 rad/s by a moment alone, from its tangent (3,
    3)."""
    shift = -np.linalg.solve(tangent[:2, :2], tangent[:2, 2])
    return np.array([shift[0], shift[1], 1.0])


def _free_stiffness(tangent: Array) -> float:
    """Return the rotational stiffness of a body whose centre is free [N m/rad] (Eq 20)."""
    return float(tangent[2] @ _free_turn(tangent))
