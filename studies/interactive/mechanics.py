"""One design at work: held statically by its body's pose, released, stepped and caught."""

import math
from functools import cached_property
from typing import Any

import numpy as np

from spline_model.accuracy import FIRST
from spline_model.accurate_motion import STEPS_PER_PERIOD
from spline_model.compile import compile_scene
from spline_model.held import HeldPivot, HeldState
from spline_model.modes import natural_frequencies
from spline_model.section_forces import StripFields, strip_fields
from spline_model.solution import Status
from spline_model.statics import solve_statics
from studies.cases.design import flexural_scale
from studies.interactive.design import PRINTED, Curve, Placing, Snapshot
from studies.interactive.motion import Motion, Pull
from studies.interactive.presets import STEP, Piece
from studies.kinds import Array

#: Rotation up to which a design is known [rad], and at how many places; increments of the path to there by
#: which control points are chosen: 11 ms, 32 ms at most of 60 designs.
REACH, PLACES, INCREMENTS = 1.8, 25, 4
#: The same of a mechanism that its case does not turn [rad].
LITTLE = 1e-3
#: Of the stations along a strip, every how many-th is shown.
EVERY = 2
#: Load in EI/L^2 above which they are chosen without it: a path that loses its stability takes seconds.
HEAVY = 10.0
#: Time over which strips follow the hand's velocity at a release [s]: short enough that no pose leaves its
#: branch.
HAND_STEP = 1e-4
#: Rotation rate below which a moving body has no instantaneous centre worth drawing, over the step [rad].
LEAST_TURN = 2e-4
#: Part of a standard deviation over which a stiffness is taken to be linear.
PART = 1e-3


class Mechanics:
    """One design; `snapshot` is always the last good state.

    Attributes:
        control_points: of a strip; doubt: what is to be said of the error that they leave, empty if nothing.
        length: the longest strip [m]; scale: sizes of moment [N m], force [N], energy [J] and stress [Pa] of
            the design's bending. placing: of its markers. begun: energy [J] of strips, body and load at the
            release.
    """

    def __init__(self, piece: Piece, rest: Any = PRINTED) -> None:
        self.piece, self._body = piece, piece.body.name
        self.placed(rest)
        self._load = np.array([0.0, -(piece.values["load"] or 0.0), 0.0])
        bending, strips = flexural_scale(piece.design), piece.design.strips
        self.length = max(strip.length for strip in strips)
        self.scale = {"moment": bending, "force": bending / self.length, "energy": bending}
        self.scale["stress"] = max(strip.youngs_modulus * strip.depth for strip in strips) / self.length
        self.control_points, self.doubt = self._chosen()
        self._free = piece.modelled(self.control_points, loaded=False)
        self._held = HeldPivot(self._free, self._body)
        self._acting = piece.modelled(self.control_points) if self._load.any() else self._free
        self._system = compile_scene(self._acting.released())
        self._motion: Motion | None = None
        self.begun = 0.0
        self._unheld: Array | None = None
        self.pace(piece)
        self.reset()

    @property
    def _reach(self) -> float:
        """Rotation up to which the design is known [rad]: of several bodies, that of the case."""
        design = self.piece.design
        if design.rotation is None:
            return LITTLE
        return REACH if len(design.bodies) == 1 else min(REACH, abs(design.rotation))

    def _chosen(self) -> tuple[int, str]:
        """Return how many control points a strip takes, on the path by a moment alone to `REACH`, and what is
        to be said of their error; empty if it is below that of all answers."""
        design = self.piece.design
        if design.rotation is None and len(design.bodies) > 1:  # a path to so stiff a rotation takes a minute
            return FIRST, "not estimated: the case turns another body"
        heavy = bool(abs(self._load[1]) > HEAVY * self.scale["force"])
        how: dict[str, Any] = {"body": self._body, "increments": INCREMENTS, "raise_on_failure": False}
        path = solve_statics(self.piece.modelled(loaded=not heavy), rotation=self._reach, **how)
        if path.status is not Status.CONVERGED or path.segments != 1:
            why = path.message or "its strips want segments, which a body in the hand does not take"
            return FIRST, f"not estimated: {why}"
        return path.control_points, path.resolution or "estimated without the load" * heavy

    @cached_property
    def longest_step(self) -> float:
        """Longest step [s] that resolves a swing about rest in phase and amplitude."""
        lowest = natural_frequencies(self._free, body=self._body).frequency[0]
        return 1.0 / (STEPS_PER_PERIOD * float(lowest)) if lowest > 0.0 else math.inf

    def pace(self, piece: Piece) -> None:
        """From now on as many simulated seconds in one as a design has that differs in this alone."""
        self.piece, self.step = piece, STEP * (piece.values["time_scale"] or 1.0)

    @property
    def moving(self) -> bool:
        """Whether the body is released."""
        return self._motion is not None

    def placed(self, rest: Any) -> None:
        """Markers at `rest` (3,) are those of the design at rest."""
        self.placing = Placing(self.piece.design, rest, self._body)

    def reset(self) -> None:
        """Back to rest, held."""
        self._motion = None
        self.snapshot = self._static(self._held.reset())

    def hold(self, pose: Array) -> float:
        """Hold the body at `pose` (3,) [m, m, rad]; return the part of the way that was solved [1].

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
        """Hold the rotation [rad] alone; return the part of the way that was solved [1]."""
        if self._load.any():
            return self.grip(np.array([*self.placing.centre, rotation]), 0.0)
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
        pull = Pull(pose, stiffness, self.length, turns, self._load)
        found, work = pull.balanced(held, state, self.scale["force"])
        if found is None or self.grounded(found.pose):
            held.restore(known)
            return 0.0
        self.snapshot = self._static(found, state.iterations + work)
        return 1.0

    def marker_at(self, rotation: float) -> Array:
        """Return marker 1's pose (3,) [m, m, rad] in marker 0's frame at a rotation [rad] without force."""
        self.turn(rotation)
        return self.placing.marker(self.snapshot.pose)

    def grounded(self, pose: Array) -> bool:
        """Return whether the centre of a body at `pose` (3,) [m, m, rad] lies beyond the ground's clamps."""
        ground, centre = self.placing.base, self.placing.centre
        return bool((pose[:2] - ground) @ (centre - ground) < 0.0)

    def stiffness_spread(self, ways: Array) -> float:
        """Return the standard deviation of the stiffness [N m/rad] where the pose's is the sum of the
        independent columns of `ways` (3, k), to first order; nan where a state beside is not found."""
        known, here, total = self._held.unknowns, self.snapshot, 0.0
        for way in PART * ways.T:
            state = self._held.hold(*(here.pose + way))
            beside = Snapshot.free_stiffness(state.tangent) if state.solved else math.nan
            total += ((beside - (here.stiffness or 0.0)) / PART) ** 2
            self._held.restore(known)
        return math.sqrt(total)

    @cached_property
    def curve(self) -> Curve:
        """What a moment alone does to the design, and its load; without any turn whatever is found."""
        other = Mechanics(self.piece)
        rows: list[list[float]] = []
        for angle in np.linspace(0.0, self._reach, PLACES):
            if other.turn(float(angle)) < 1.0 and rows:
                break
            now = other.snapshot
            shift, stress = now.pose[:2] - self.placing.centre, now.stress.max()
            rows.append([now.pose[2], *shift, now.force[2], stress])
        table = np.array(rows)
        return Curve(rotation=table[:, 0], shift=table[:, 1:3], moment=table[:, 3], stress=table[:, 4])

    def release(self, velocity: Array) -> None:
        """Release the held body with a `velocity` (3,) [m/s, m/s, rad/s] of its pose, which the strips
        follow; energies are counted from there."""
        z, v = self._held.full_state(self._system), self._rates(velocity)
        self._motion = Motion(self._acting, z, v)
        z, _, strain, kinetic = self._motion.state()
        self.begun = strain + kinetic + self._potential(z[self._system.layout.body(self._body)])
        self.snapshot = self._dynamic(self._motion)

    @property
    def resolved(self) -> bool:
        """Whether a moving body's steps resolve its swing."""
        return self._motion is None or self.step <= self.longest_step

    def advance(self, steps: int) -> float:
        """Take steps of the released body; returns the time done [s], 0 where the solver cannot take them and
        the last state is kept."""
        if self._motion is None or not (done := self._motion.advance(steps, self.step)):
            return 0.0
        self.snapshot = self._dynamic(self._motion)
        return done

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
        return float(self._load[:2] @ (self.placing.centre - pose[:2]))

    def _static(self, state: HeldState, iterations: int | None = None) -> Snapshot:
        along = strip_fields(self._acting, self._held.full_state(self._system)[None], "modes")
        return Snapshot(
            **self._shown(along, state.bending_energy + state.axial_energy),
            force=state.force - self._load,
            tangent=state.tangent,
            centre=Snapshot.pole(state.pose, Snapshot.free_turn(state.tangent), 0.0),
            iterations=state.iterations if iterations is None else iterations,
        )

    def _dynamic(self, moving: Motion) -> Snapshot:
        z, v, *energies = moving.state()
        known = self._shown(strip_fields(self._acting, z[None], "release"), *energies)
        known["energy"]["dissipated"] = self.begun - sum(known["energy"].values())
        velocity = v[self._system.layout.body(self._body)].copy()
        centre = Snapshot.pole(known["pose"], velocity, LEAST_TURN / self.step)
        return Snapshot(**known, velocity=velocity, centre=centre, iterations=moving.iterations)

    def _shown(self, along: StripFields, strain: float, kinetic: float = 0.0) -> dict[str, Any]:
        """Return what follows from the poses of the bodies, what is along the strips, and the energies."""
        poses, strips = along.bodies[0], self.piece.design.strips
        pose = poses[self.placing.number]
        area = np.array([[strip.area] for strip in strips])
        modulus = np.array([[2.0 * strip.second_moment_of_area / strip.depth] for strip in strips])
        axial, moment = (np.abs(each[0, :, ::EVERY]) for each in (along.axial_force, along.bending_moment))
        energy = {"strain": strain, "kinetic": kinetic, "potential": self._potential(pose), "dissipated": 0.0}
        shape, stress = along.shape[0, :, ::EVERY], axial / area + moment / modulus
        return {"pose": pose, "poses": poses, "shape": shape, "stress": stress, "energy": energy}
