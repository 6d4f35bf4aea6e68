"""One design at work: held statically by its body's pose, released, stepped and caught."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from spline_model.content import STEPS_PER_PERIOD
from spline_model.held import HeldPivot, HeldState
from spline_model.modes import natural_frequencies
from studies.interactive.pivot.design import (
    PLACES,
    REACH,
    Curve,
    Reader,
    Reading,
    build,
    free_stiffness,
    free_turn,
    pole,
    scales,
)
from studies.interactive.pivot.motion import MOTIONS, Motion, released
from studies.interactive.pivot.presets import STEP
from studies.interactive.pivot.pull import Pull
from studies.kinds import Array

#: Time over which strips follow the hand's velocity at a release [s]: short enough that no pose leaves its
#: branch.
HAND_STEP = 1e-4
#: Rotation rate below which a moving body has no instantaneous centre worth drawing, over the step [rad].
LEAST_TURN = 2e-4

#: Part of a standard deviation over which a stiffness is taken to be linear.
PART = 1e-3


@dataclass(frozen=True, kw_only=True, eq=False)
class Snapshot:
    """All that is shown of one instant, in SI units.

    Attributes:
        pose: x, y, theta of the body (3,); velocity (3,), zero while held.
        reading: shapes, stresses and strains of the strips.
        force: what holds the body (3,) [N, N, N m], zero when released; tangent (3, 3) its derivative or
            None.
        stiffness: rotational, with the body's centre free [N m/rad], None when released.
        strain, kinetic, potential, dissipated, lost: energies [J], potential of the load from rest on,
            dissipated by the strips' damping, lost to the steps' own.
        centre: the instantaneous centre of rotation, None where the body does not turn.
        iterations: of Newton's method.
    """

    pose: Array
    velocity: Array
    reading: Reading
    force: Array
    tangent: Array | None
    stiffness: float | None
    strain: float
    kinetic: float
    potential: float
    dissipated: float
    lost: float
    centre: tuple[float, float] | None
    iterations: int


class Mechanics:
    """The pivot of some parameters; `snapshot` is always the last good state.

    Args:
        values: all parameters in SI units, as `presets.checked` returns them.
    """

    def __init__(self, values: Mapping[str, float]) -> None:
        self.values = dict(values)
        self.pivot = build(values)
        self.step = STEP * values["time_scale"]
        self._held = HeldPivot(self.pivot)
        self._acting = build(values, loaded=True)
        self._system = released(self._acting)
        self._load = np.array([0.0, -values["load"], 0.0])
        self._reader = Reader(values=self.values)
        self._motion: Motion | None = None
        self._unheld: Array | None = None
        self.snapshot = self._static(self._held.reset())

    @cached_property
    def longest_step(self) -> float:
        """Longest step [s] that resolves a swing about rest in phase and amplitude."""
        lowest = natural_frequencies(self.pivot).frequency[0]
        return 1.0 / (STEPS_PER_PERIOD * float(lowest)) if lowest > 0.0 else math.inf

    def pace(self, time_scale: float) -> None:
        """From now on so many simulated seconds in one."""
        self.values["time_scale"], self.step = time_scale, STEP * time_scale

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
        state = self._held.hold(float(pose[0]), float(pose[1]), float(pose[2]))
        work = state.iterations
        if not state.solved:
            known, reached = self._held.unknowns, state.reached
            self._held.reset()
            self._held.turn(float(pose[2]))
            state = self._held.hold(float(pose[0]), float(pose[1]), float(pose[2]))
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
            change = free_stiffness(state.tangent) - (here.stiffness or 0.0) if state.solved else math.nan
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
            shift, stress = now.pose[:2] - self.pivot.centre, now.reading.stress.max()
            rows.append([now.pose[2], *shift, now.force[2], stress])
        table = np.array(rows)
        return Curve(rotation=table[:, 0], shift=table[:, 1:3], moment=table[:, 3], stress=table[:, 4])

    def release(self, velocity: Array, solver: str) -> None:
        """Let go of the held body with a `velocity` (3,) of its pose; the strips follow it."""
        z = self._held.full_state(self._system)
        self._motion = MOTIONS[solver](self._acting, z, self._rates(velocity))
        self._begun = self._potential(self.snapshot.pose)
        self.snapshot = self._dynamic()

    def advance(self, steps: int) -> bool:
        """Take steps of the released body; False where the solver gives up, the last state being kept."""
        if self._motion is None or not self._motion.advance(steps, self.step):
            return False
        self.snapshot = self._dynamic()
        return True

    def catch(self) -> bool:
        """Hold the moving body where it is; False, and still moving, where no static state is found there."""
        pose = self.snapshot.pose.copy()
        known = self._held.unknowns
        if self.hold(pose) < 1.0:
            self._held.restore(known)
            return False
        self._motion = None
        return True

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
        way = free_turn(state.tangent)
        return Snapshot(
            pose=state.pose,
            velocity=np.zeros(3),
            reading=self._reader.read(self._held.control_points),
            force=state.force - self._load,
            tangent=state.tangent,
            stiffness=free_stiffness(state.tangent),
            strain=state.bending_energy + state.axial_energy,
            kinetic=0.0,
            potential=self._potential(state.pose),
            dissipated=0.0,
            lost=0.0,
            centre=pole(state.pose, way, 0.0),
            iterations=state.iterations if iterations is None else iterations,
        )

    def _dynamic(self) -> Snapshot:
        assert self._motion is not None
        state = self._motion.state()
        potential = self._potential(state.pose)
        return Snapshot(
            pose=state.pose,
            velocity=state.velocity,
            reading=self._reader.read(state.points),
            force=np.zeros(3),
            tangent=None,
            stiffness=None,
            strain=state.strain,
            kinetic=state.kinetic,
            potential=potential,
            dissipated=state.dissipated,
            lost=state.lost - (potential - self._begun),
            centre=pole(state.pose, state.velocity, LEAST_TURN / self.step),
            iterations=state.iterations,
        )
