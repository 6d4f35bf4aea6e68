"""From a system in motion to the arrays of its reduced coordinates, and back to the scene's unknowns."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.basis import SplineBasis
from spline_model.compile import System
from spline_model.effects import Bending, Clamp, MixedStretching, Stretching, StripDamping
from spline_model.effects.base import Constraint
from spline_model.effects.elastic import MEASURES
from spline_model.errors import InvalidParameter
from spline_model.motion.arrays import Flexures, Masses, Scratch, State, masses_of, scratch_of, state_of
from spline_model.motion.records import ENERGIES
from spline_model.motion.run import set_points
from spline_model.motion.start import Motion
from spline_model.quadrature import CURL, DROP
from spline_model.reduced.axial import len_modes, natural_strain, orthonormal_modes
from spline_model.reduced.ends import Ends, ends_of, frames_of
from spline_model.reduced.model import GAIN, LEAST_COMPLIANCE

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Moving:
    """A scene in reduced coordinates y: the bodies' poses, free strip ends among them, then w and a a strip.

    to_modes (S, K, K): the scene's axial forces from the strips'; length L [m] and energy EI/L [J].
    """

    system: System
    strips: Flexures
    masses: Masses
    to_modes: Array
    length: float
    energy: float

    @property
    def width(self) -> int:
        """Numbers in a record (``spline_model.motion.run.store``)."""
        state = state_of(self.strips, self.masses)
        shown = (state.y, state.rate, state.points, state.velocity, state.clamped, state.reaction)
        return sum(array.size for array in shown) + ENERGIES

    def with_drives(self, motion: Motion) -> Moving:
        """The same with the drives starting where those of a motion do."""
        origin = motion.tables.drives.origin / self._turning
        return replace(self, masses=self.masses._replace(drive_origin=origin))

    def arrays(self, z: Array, v: Array, acceleration: Array) -> tuple[State, Scratch]:
        """The state of unknowns z (N,) with velocity v and acceleration (Q,), and working arrays."""
        state, work = state_of(self.strips, self.masses), scratch_of(self.strips, self.masses)
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
        for i, body in enumerate(self.system.scene.bodies):
            of_bodies[3 * i : 3 * i + 3] = given[layout.body(body.name)] / self.unit
        for s, strip in enumerate(self.system.scene.strips):
            of_points[s] = given[layout.strip(strip.name)].reshape(n, 2).T / self.length

    @property
    def unit(self) -> Array:
        """Of a pose (3,) [m, rad]."""
        return np.array([self.length, self.length, 1.0])

    @property
    def _turning(self) -> Array:
        return np.where(self.system.drives.turns == 1, 1.0, self.length)

    def _coordinates(self, z: Array) -> Array:
        system, strips, n = self.system, self.strips, self.strips.mass.shape[1]
        pose, own = np.zeros(len(self.masses.inertia)), []
        for i, body in enumerate(system.scene.bodies):
            pose[3 * i : 3 * i + 3] = z[system.layout.body(body.name)] / self.unit
        for s, strip in enumerate(system.scene.strips):
            points = z[system.layout.strip(strip.name)].reshape(n, 2) / self.length
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
                np.linalg.solve(self.to_modes[s], forces) * self.length / self.energy,
            ]
        return np.concatenate((pose, *own))

    def unknowns(self, records: Array) -> tuple[Array, Array]:
        """Unknowns z (R, N) and velocities v (R, Q) of records.

        Axial forces and multipliers are the means of the steps that end there.
        """
        system, count = self.system, len(records)
        scene, layout, drives = system.scene, system.layout, system.drives
        (s_count, n), k = self.strips.mass.shape[:2], self.strips.modes.shape[2]
        q, own = len(self.masses.inertia), 2 * n - 6
        z, v = np.zeros((count, layout.size)), np.zeros((count, layout.coordinate_count))
        at = 2 * q + s_count * (own + k)
        for i, body in enumerate(scene.bodies):
            place = layout.body(body.name)
            z[:, place] = records[:, 3 * i : 3 * i + 3] * self.unit
            v[:, place] = records[:, at - q + 3 * i : at - q + 3 * i + 3] * self.unit
        rows: dict[tuple[str, str], slice] = {
            (c.strip, c.end): layout.rows(i)
            for i, c in enumerate(scene.of(Constraint))
            if isinstance(c, Clamp)
        }
        force = self.energy / self.length
        unit = force * np.array([1.0, 1.0, self.length])
        for s, strip in enumerate(scene.strips):
            place = layout.strip(strip.name)
            both = records[:, at : at + 4 * n].reshape(count, 2 * n, 2) * self.length
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


def moving(system: System, motion: Motion) -> Moving:
    """The reduced coordinates of a system in motion, whose strips have one basis and one quadrature."""
    ends = ends_of(system)
    poses = _poses(system)
    return Moving(
        system=system,
        masses=masses_of(system, motion, poses),
        length=system.scales.length,
        energy=system.scales.energy,
        **_strips(system, motion, ends),
    )


def _poses(system: System) -> int:
    """Number of the bodies' coordinates, free strip ends among the bodies."""
    free = sum(
        system.scene.clamp_of(strip.name, end) is None
        for strip in system.scene.strips
        for end in ("start", "end")
    )
    return 3 * (len(system.scene.bodies) + free)


def _strips(system: System, motion: Motion, ends: Ends) -> dict[str, Any]:
    scene, tables, layout = system.scene, system.tables, system.layout
    length, energy = system.scales.length, system.scales.energy
    basis, points = _grid(system)
    grid = _tables(basis, points)
    gauss, n, count = len(grid["weight"]), basis.control_points, len(scene.strips)
    order = {e.strip: i for i, e in enumerate(scene.of(Bending))}
    rows = [slice(order[s.name] * gauss, (order[s.name] + 1) * gauss) for s in scene.strips]
    speed = np.array([tables.points.speed[r] for r in rows]) / length
    mixed = [[e for e in scene.of(MixedStretching) if e.strip == s.name] for s in scene.strips]
    consistent = {e.strip: e for e in scene.of(Stretching)}
    parts = [tuple(e.modes for e in each) for each in mixed]
    modes, to_modes = orthonormal_modes(parts, basis, points, speed)
    compliances = [[e.axial_compliance for e in parts for _ in range(e.modes.count)] for parts in mixed]
    c = np.array(compliances).reshape(count, -1) * energy / length
    small, split = c < LEAST_COMPLIANCE, len_modes(mixed[0], slide=False)
    outer = c.shape[1] if small[:, split:].any() else split if small.any() else 0
    small[:, :outer] = True
    time = {e.strip: e.relaxation_time for e in scene.of(StripDamping)}
    places = [layout.strip(s.name) for s in scene.strips]
    weight = tables.weight if tables.weight.size else np.zeros(layout.coordinate_count)
    mass = length**2 / energy
    drag = motion.drag if motion.drag.size else np.zeros_like(motion.mass)
    names = [s.name for s in scene.strips]
    strips = Flexures(
        first=grid["first"],
        d1=grid["d1"],
        d2=grid["d2"],
        pairs=grid["pairs"],
        weight=grid["weight"],
        speed=speed,
        curvature=np.array([tables.points.curvature[r] for r in rows]) * length,
        rigidity=np.array([tables.points.rigidity[r] for r in rows]) / (energy * length),
        curl=np.array([tables.points.numbers[r, DROP : CURL + 1] for r in rows]) / [1.0, length],
        stretching=np.array([consistent[s].axial_rigidity if s in consistent else 0.0 for s in names])
        / (energy / length),
        strain=np.array(
            [natural_strain(parts, consistent.get(s)) for s, parts in zip(names, mixed, strict=True)]
        ),
        modes=modes,
        compliance=c,
        gain=np.where(small, GAIN, 1.0 / np.where(small, 1.0, c)),
        outer=outer,
        free_from=len(scene.bodies),
        relaxation=np.array([time.get(s, 0.0) for s in names]),
        mass=np.array([motion.mass[at, at][::2, ::2] for at in places]) * mass,
        drag=np.array([drag[at, at][::2, ::2] for at in places]) * mass,
        dead=np.array([weight[at].reshape(n, 2).T for at in places]) / (energy / length),
        roots=np.array([ends[s, "start"].body for s in names], dtype=np.int64),
        tips=np.array([ends[s, "end"].body for s in names], dtype=np.int64),
        root=frames_of([ends[s, "start"] for s in names], length),
        tip=frames_of([ends[s, "end"] for s in names], length),
        reach=np.array(
            [
                [np.hypot(*(p[1] - p[0])), np.hypot(*(p[-1] - p[-2]))]
                for p in (s.control_points for s in scene.strips)
            ]
        )
        / length,
        measure=min(1, MEASURES.index(scene.of(Bending)[0].measure)),  # printed forces: of the spatial energy
    )
    return {"strips": strips, "to_modes": to_modes}


def _grid(system: System) -> tuple[SplineBasis, int]:
    """Basis and Gauss points of all strips."""
    scene = system.scene
    elastic: list[Bending | MixedStretching | Stretching] = [
        *scene.of(Bending),
        *scene.of(MixedStretching),
        *scene.of(Stretching),
    ]
    bases = {strip.basis for strip in scene.strips}
    kinds = {(e.gauss_points, e.measure) for e in elastic}
    if len(bases) != 1 or len(kinds) != 1:
        raise InvalidParameter("strips", f"{len(bases)} bases, {len(kinds)} quadratures", "one of each")
    if sorted(e.strip for e in scene.of(Bending)) != sorted(s.name for s in scene.strips):
        raise InvalidParameter("effects", "bending of some strips", "bending of each strip, once")
    return next(iter(bases)), next(iter(kinds))[0]


@lru_cache(maxsize=64)
def _tables(basis: SplineBasis, points: int) -> dict[str, Any]:
    u, weight = basis.gauss_rule(points)
    first, width = basis.first_of_support(u), basis.degree + 1
    places = first[:, None] + np.arange(width)
    d1, d2 = (np.take_along_axis(basis.evaluate(u, k), places, axis=1) for k in (1, 2))
    pairs = [np.einsum("gi,gj->gij", a, b).reshape(len(u), -1) for a in (d1, d2) for b in (d1, d2)]
    return {
        "u": u,
        "weight": weight,
        "first": first,
        "d1": np.ascontiguousarray(d1),
        "d2": np.ascontiguousarray(d2),
        "pairs": np.ascontiguousarray(np.stack(pairs, axis=1)),
    }
