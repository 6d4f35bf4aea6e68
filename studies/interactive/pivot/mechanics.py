"""One design at work: held statically by its body's pose, released, stepped and caught."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from spline_model.content import STEPS_PER_PERIOD
from spline_model.held import HeldPivot, HeldState
from spline_model.modes import natural_frequencies
from studies.interactive.pivot import presets
from studies.interactive.pivot.design import Placing, Reader, Reading, build, free_stiffness, free_turn, pole
from studies.interactive.pivot.motion import MOTIONS, Motion, released
from studies.interactive.pivot.presets import STEP
from studies.kinds import Array

#: Time over which strips follow the hand's velocity at a release [s]: short enough that no pose leaves its
#: branch.
HAND_STEP = 1e-4
#: Rotation up to which the path of a free turn is known [rad].
REACH = 1.8
#: Rotation rate below which a moving body has no instantaneous centre worth drawing, over the step [rad].
LEAST_TURN = 2e-4


@dataclass(frozen=True, kw_only=True, eq=False)
class Snapshot:
    """All that is shown of one instant, in SI units.

    Attributes:
        pose: x, y, theta of the body (3,); velocity (3,), zero while held.
        reading: shapes, stresses and strains of the strips.
        force: what holds the body (3,) [N, N, N m], zero when released; tangent (3, 3) its derivative or
            None.
        stiffness: rotational, with the body's centre free [N m/rad], None when released.
        strain, kinetic, dissipated, lost: energies [J], dissipated by the strips' damping, lost to the
            steps' own.
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
        self._system = released(self.pivot)
        self._reader = Reader.of(values)
        self._motion: Motion | None = None
        self.snapshot = self._static(self._held.reset())

    @cached_property
    def longest_step(self) -> float:
        """Longest step [s] that resolves a swing about rest in phase and amplitude."""
        lowest = natural_frequencies(self.pivot).frequency[0]
        return 1.0 / (STEPS_PER_PERIOD * float(lowest)) if lowest > 0.0 else math.inf

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
        state = self._held.turn(rotation)
        if state.solved:
            self.snapshot = self._static(state)
        return state.reached

    def off_path(self, pose: Array) -> float:
        """Distance of `pose` (3,) from where a moment alone would turn the body to [m]; 0 beyond REACH."""
        if abs(pose[2]) > REACH:
            return 0.0
        angles, centres = self._free_path
        free = [np.interp(pose[2], angles, centres[:, k]) for k in range(2)]
        return float(np.hypot(*(pose[:2] - free)))

    @cached_property
    def _free_path(self) -> tuple[Array, Array]:
        """Rotations (A,) and centres (A, 2) of the body that a moment alone turns."""
        solver, half = HeldPivot(self.pivot), np.linspace(0.0, REACH, 21)
        found: dict[float, Array] = {}
        for side in (1.0, -1.0):
            solver.reset()
            for angle in side * half:
                state = solver.turn(float(angle))
                if state.solved:
                    found[float(angle)] = state.pose[:2]
        angles = sorted(found)
        return np.array(angles), np.array([found[angle] for angle in angles])

    def release(self, velocity: Array, solver: str) -> None:
        """Let go of the held body with a `velocity` (3,) of its pose; the strips follow it."""
        z = self._held.full_state(self._system)
        self._motion = MOTIONS[solver](self.pivot, z, self._rates(velocity))
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

    def _static(self, state: HeldState, iterations: int | None = None) -> Snapshot:
        way = free_turn(state.tangent)
        return Snapshot(
            pose=state.pose,
            velocity=np.zeros(3),
            reading=self._reader.read(self._held.control_points),
            force=state.force,
            tangent=state.tangent,
            stiffness=free_stiffness(state.tangent),
            strain=state.bending_energy + state.axial_energy,
            kinetic=0.0,
            dissipated=0.0,
            lost=0.0,
            centre=pole(state.pose, way, 0.0),
            iterations=state.iterations if iterations is None else iterations,
        )

    def _dynamic(self) -> Snapshot:
        assert self._motion is not None
        state = self._motion.state()
        return Snapshot(
            pose=state.pose,
            velocity=state.velocity,
            reading=self._reader.read(state.points),
            force=np.zeros(3),
            tangent=None,
            stiffness=None,
            strain=state.strain,
            kinetic=state.kinetic,
            dissipated=state.dissipated,
            lost=state.lost,
            centre=pole(state.pose, state.velocity, LEAST_TURN / self.step),
            iterations=state.iterations,
        )


#: Designs that can be undone.
UNDO = 100

Design = tuple[str, dict[str, float]]


class Bench:
    """One design at a time; what cannot be built leaves the former one.

    Args:
        preset: name of the preset that the values began from.
        values: all parameters in SI units; BadInput for one that does not fit.
    """

    mechanics: Mechanics
    placing: Placing

    def __init__(self, preset: str, values: Mapping[str, object]) -> None:
        self.preset = preset
        self._past: list[Design] = []
        self._future: list[Design] = []
        self._rest: NDArray[np.float64] | None = None
        self._build(preset, values)

    @property
    def design(self) -> Design:
        """Preset and values of the present design."""
        return self.preset, dict(self.mechanics.values)

    def change(self, preset: str, values: Mapping[str, object]) -> None:
        """Another design; the present one can be had back by `undo`."""
        known = self.design
        self._build(preset, values)
        self._past = [*self._past[1 - UNDO :], known]
        self._future = []

    def undo(self) -> bool:
        """Back to the design before; False if there is none."""
        return self._swap(self._past, self._future)

    def redo(self) -> bool:
        """Forth to the design that was undone; False if there is none."""
        return self._swap(self._future, self._past)

    def set_rest(self, marker: NDArray[np.float64]) -> None:
        """Markers at `marker` (3,) are those of a pivot at rest, whatever the design."""
        self._rest = np.array(marker, dtype=float)
        self.placing = self.placing.with_rest(self._rest)

    def _swap(self, source: list[Design], target: list[Design]) -> bool:
        if not source:
            return False
        known = self.design
        self._build(*source.pop())
        target.append(known)
        return True

    def _build(self, preset: str, values: Mapping[str, object]) -> None:
        if preset != presets.OWN:  # a recorded one brings its values
            presets.preset(preset)
        self.mechanics = Mechanics(presets.checked(values))
        self.placing = Placing.of(self.mechanics.pivot)
        if self._rest is not None:
            self.placing = self.placing.with_rest(self._rest)
        self.preset = preset
