"""From a system in motion to the arrays of its reduced coordinates, and back to the scene's unknowns."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.basis import Bezier
from spline_model.compile import System
from spline_model.effects import Bending, Clamp, MixedStretching, StrainEnergy, StripDamping
from spline_model.effects.base import Constraint
from spline_model.errors import InvalidParameter
from spline_model.motion.arrays import Flexures, Masses, Scratch, State, sizes_of, zeros
from spline_model.motion.records import ENERGIES
from spline_model.motion.start import Motion
from spline_model.motion.strip import set_points
from spline_model.reduced.numbers import GAIN, LEAST_COMPLIANCE, Ends, ends_of, shape_of, strips_of
from spline_model.strip.element import CURL, DROP

Array = NDArray[np.float64]

AS_IN_STATICS = (
    "speed", "curvature", "rigidity", "modes", "compliance", "stretching", "strain", "roots", "tips", "root",
    "tip", "reach",
)  # fmt: skip
"""Arrays of a motion's strips that are those of statics."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Moving:
    """A scene in reduced coordinates y: the bodies' poses, free strip ends among them, then w and a a strip.

    to_modes (S, K, K): the scene's axial forces from the strips'.
    """

    system: System
    strips: Flexures
    masses: Masses
    to_modes: Array

    @property
    def width(self) -> int:
        """Numbers in a record (``spline_model.motion.energy_consistent.store``)."""
        state = zeros(State, sizes_of(self.strips, self.masses))
        shown = (state.y, state.rate, state.points, state.velocity, state.clamped, state.reaction)
        return sum(array.size for array in shown) + ENERGIES

    def with_drives(self, motion: Motion) -> Moving:
        """The same with the drives starting where those of a motion do."""
        return replace(self, masses=Masses.of(motion, len(self.masses.inertia)))

    def arrays(self, z: Array, v: Array, acceleration: Array) -> tuple[State, Scratch]:
        """The state of unknowns z (N,) with velocity v and acceleration (Q,), and working arrays."""
        sizes = sizes_of(self.strips, self.masses)
        state, work = zeros(State, sizes), zeros(Scratch, sizes)
        state.y[:] = self._coordinates(z)
        set_points(state, self.strips, self.masses)
        self.set_velocity(state, v)
        self._place(acceleration, state.push, state.acceleration)
        return state, work

    def set_velocity(self, state: State, v: Array) -> None:
        """Give a state the velocity v (Q,)."""
        self._place(v, state.rate, state.velocity)

    def _place(self, given: Array, of_bodies: Array, of_points: Array) -> None:
        layout, n = self.system.layout, self.strips.mass.shape[1]
        of_bodies[: len(self._units)] = given[layout.poses] / self._units
        for s, strip in enumerate(self.system.scene.strips):
            of_points[s] = given[layout.strip(strip.name)].reshape(n, 2).T / self.system.scales.length

    @cached_property
    def _units(self) -> Array:
        return np.tile(self.system.scales.pose, len(self.system.scene.bodies))

    def _coordinates(self, z: Array) -> Array:
        system, strips, n = self.system, self.strips, self.strips.mass.shape[1]
        length, energy = system.scales.length, system.scales.energy
        pose, own = np.zeros(len(self.masses.inertia)), []
        pose[: len(self._units)] = z[system.layout.poses] / self._units
        for s, strip in enumerate(system.scene.strips):
            points = z[system.layout.strip(strip.name)].reshape(n, 2) / length
            chords = points[1] - points[0], points[-1] - points[-2]
            for body, frame, at, chord in (
                (strips.roots[s], strips.root[s], 0, chords[0]),
                (strips.tips[s], strips.tip[s], -1, chords[1]),
            ):
                if body >= strips.free_from:  # a free end is its own body
                    turn = np.arctan2(chord[1], chord[0]) - frame[2]
                    turn = np.arctan2(np.sin(turn), np.cos(turn))
                    pose[3 * body : 3 * body + 3] = *points[at], turn
            reach = np.hypot(*np.transpose(chords)) / strips.reach[s]
            effects = [i for i, e in enumerate(system.scene.of(MixedStretching)) if e.strip == strip.name]
            forces = np.concatenate([z[system.layout.axial_modes(i)] for i in effects] or [np.zeros(0)])
            own += [
                points[2:-2].ravel(),
                reach,
                np.linalg.solve(self.to_modes[s], forces) * length / energy,
            ]
        return np.concatenate((pose, *own))

    def unknowns(self, records: Array) -> tuple[Array, Array]:
        """Unknowns z (R, N) and velocities v (R, Q) of records.

        Axial forces and multipliers are the means of the steps that end there.
        """
        system, count = self.system, len(records)
        scene, layout, drives = system.scene, system.layout, system.drives
        (s_count, n), k = self.strips.mass.shape[:2], self.strips.modes.shape[2]
        q, own = len(self.masses.inertia), self.strips.own
        z, v = np.zeros((count, layout.size)), np.zeros((count, layout.coordinate_count))
        at = 2 * q + s_count * (own + k)
        z[:, layout.poses] = records[:, : len(self._units)] * self._units
        v[:, layout.poses] = records[:, at - q : at - q + len(self._units)] * self._units
        rows: dict[tuple[str, str], slice] = {
            (c.strip, c.end): layout.rows(i)
            for i, c in enumerate(scene.of(Constraint))
            if isinstance(c, Clamp)
        }
        length = system.scales.length
        force = system.scales.energy / length
        unit = force * np.array([1.0, 1.0, length])
        for s, strip in enumerate(scene.strips):
            place = layout.strip(strip.name)
            both = records[:, at : at + 4 * n].reshape(count, 2 * n, 2) * length
            z[:, place], v[:, place] = both[:, :, 0], both[:, :, 1]
            for e, end in enumerate(("start", "end")):
                if (strip.name, end) in rows:
                    begin = at + 4 * n + 3 * e
                    z[:, rows[strip.name, end]] = records[:, begin : begin + 3] * unit
            at += 4 * n + 6
            begin, done = q + s * (own + k) + own, 0
            forces = records[:, begin : begin + k] @ self.to_modes[s].T * force
            for i, effect in enumerate(scene.of(MixedStretching)):
                if effect.strip == strip.name:
                    z[:, layout.axial_modes(i)] = forces[:, done : done + effect.modes.count]
                    done += effect.modes.count
        z[:, drives.row] = records[:, at : at + len(drives.row)] * unit[2 * drives.turns]
        return z, v

    @classmethod
    def of(cls, motion: Motion) -> Moving:
        """The reduced coordinates of a system in motion, whose strips have one basis and one quadrature."""
        system = motion.system
        ends = ends_of(system)
        poses = 3 * max(len(system.scene.bodies), 1 + max(end.body for end in ends.values()))
        return cls(
            system=system,
            masses=Masses.of(motion, poses),
            **_strips(motion, ends),
        )


def _strips(motion: Motion, ends: Ends) -> dict[str, Any]:
    """Those of statics, and what they have in motion."""
    system = motion.system
    scene, layout, weight = system.scene, system.layout, system.weight
    length, energy, names = system.scales.length, system.scales.energy, [s.name for s in scene.strips]
    basis, points = _grid(system)
    made, _, to_modes = strips_of(system, shape_of(basis, points), basis, points, ends)
    n, count, c = basis.control_points, len(names), made.compliance
    small = c < LEAST_COMPLIANCE
    outer = c.shape[1] if small[:, made.split :].any() else made.split if small.any() else 0
    small[:, :outer] = True
    time = {e.strip: e.relaxation_time for e in scene.of(StripDamping)}
    places = [layout.strip(name) for name in names]
    weight = weight if weight.size else np.zeros(layout.coordinate_count)
    mass, drag = length**2 / energy, motion.drag if motion.drag.size else np.zeros_like(motion.mass)
    strips = Flexures(
        **_tables(basis, points),
        **{name: np.ascontiguousarray(getattr(made, name)) for name in AS_IN_STATICS},
        curl=np.ascontiguousarray(made.along[..., DROP : CURL + 1]),
        gain=np.where(small, GAIN, 1.0 / np.where(small, 1.0, c)),
        own=2 * n - 6,
        outer=outer,
        free_from=len(scene.bodies),
        relaxation=np.array([time.get(name, 0.0) for name in names]),
        mass=np.array([motion.mass[at, at][::2, ::2] for at in places]) * mass,
        drag=np.array([drag[at, at][::2, ::2] for at in places]) * mass,
        dead=np.array([weight[at].reshape(n, 2).T for at in places]).reshape(count, 2, n) / (energy / length),
        measure=made.measure,
    )
    return {"strips": strips, "to_modes": to_modes}


def _grid(system: System) -> tuple[Bezier, int]:
    """Basis and Gauss points of all strips."""
    scene = system.scene
    bases = {strip.basis for strip in scene.strips}
    kinds = {(e.gauss_points, e.measure) for e in scene.of(StrainEnergy)}
    if len(bases) != 1 or len(kinds) != 1:
        raise InvalidParameter("strips", f"{len(bases)} bases, {len(kinds)} quadratures", "one of each")
    if sorted(e.strip for e in scene.of(Bending)) != sorted(s.name for s in scene.strips):
        raise InvalidParameter("effects", "bending of some strips", "bending of each strip, once")
    return next(iter(bases)), next(iter(kinds))[0]


@lru_cache(maxsize=64)
def _tables(basis: Bezier, points: int) -> dict[str, Any]:
    u, weight = basis.gauss_rule(points)
    d1, d2 = (basis.evaluate(u, k) for k in (1, 2))
    pairs = [np.einsum("gi,gj->gij", a, b).reshape(len(u), -1) for a in (d1, d2) for b in (d1, d2)]
    whole = {"d1": d1, "d2": d2, "pairs": np.stack(pairs, axis=1)}
    return {"weight": weight} | {name: np.ascontiguousarray(t) for name, t in whole.items()}
