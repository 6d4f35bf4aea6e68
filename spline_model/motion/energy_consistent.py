"""The default integrator: a discrete-gradient scheme that cannot create energy.

    D^T (M (v1 - v0) / h + D V(q0, q1)) = 0,   (v0 + v1) / 2 = (q1 - q0) / h = D dy / h

T + V is the same before and after a step of any size, up to the residual of Newton's method,
and so are the momenta of a free scene. Clamps hold by construction: D moves control points and
bodies by their own coordinates y (``spline_model.motion.strip``). Second order; implicit; a step
whose Newton fails, or that turns an end tangent backwards, is halved; one in which a drive or a
load changes abruptly is cut there.
Source: Gonzalez, Time integration and discrete Hamiltonian systems, J Nonlinear Sci 6 (1996)
449; for constraints, Betsch, The discrete null space method, CMAME 194 (2005) 5159.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.motion.mechanism import Moving
from spline_model.motion.moves import MOST_HALVED, MOST_HALVED_A_STEP, Moves
from spline_model.motion.start import Array, Start
from spline_model.motion.step import FOLDS, HALVED, REFUSED, STEPS, WHOLE, cayley, load_at, newton
from spline_model.motion.strip import look_at, place_strip
from spline_model.scene import Scene
from spline_model.strip.compiled import kernel, part

TOLERANCE = 1e-11
"""Residual of a step, in EI/L^2, EI/L, L and rad; the energy of a step is exact to this."""
SLOWEST_SPEED = 0.1
"""|C'| below which, over that at rest, a strip is folded."""


@part()
def forward(state, strips, masses, work):
    """True if every clamped end's tangent points forwards and |C'| is above a tenth of that at rest."""
    own, modes = strips.own, strips.compliance.shape[1]
    for s in range(strips.roots.size):
        at = masses.inertia.size + s * (own + modes) + own - 2
        for e in range(2):
            body = strips.roots[s] if e == 0 else strips.tips[s]
            if body < strips.free_from and not state.y[at + e] + work.dy[at + e] > 0.0:
                return False
        for p in range(strips.weight.size):
            if not work.at[s, p, 4] > SLOWEST_SPEED * strips.speed[s, p]:
                return False
    return True


@part()
def clamp_forces(s, state, strips, work):
    """What the clamps do to a strip, from the forces of the step just solved."""
    n = strips.mass.shape[1]
    for e in range(2):
        end, inner = (0, 1) if e == 0 else (n - 1, n - 2)
        maps, force = work.maps[s, e], work.force[s]
        body = strips.roots[s] if e == 0 else strips.tips[s]
        for k in range(2):
            state.clamped[s, e, k] = force[k, end] + force[k, inner]
        state.clamped[s, e, 2] = (maps[0] * force[1, inner] - maps[1] * force[0, inner]) / (
            maps[7] if body >= 0 else 1.0
        )


@part()
def _count_work(time, h, active, state, strips, masses, work):
    """What loads and drives did in the solved step, and what the drives' reactions were."""
    n, dy, totals = strips.mass.shape[1], work.dy, state.totals
    for f in range(masses.load_body.size):
        value, i = load_at(f, time + 0.5 * h, masses), masses.load_body[f]
        if i >= 0:
            totals[0] += value * (2.0 * math.atan(0.5 * dy[i]) if i % 3 == 2 else dy[i])
        else:
            place = masses.load_place[f]
            totals[0] += value * work.move[masses.load_strip[f], place // n, place % n]
    for d in range(masses.drive_at.size):
        state.reaction[d] = 0.0
        if active[d] == 1:
            i = masses.drive_at[d]
            totals[0] += work.residual[i] * dy[i]
            state.reaction[d] = work.residual[i] / (cayley(dy[i])[0] if i % 3 == 2 else 1.0)


@part()
def _accept(time, h, active, state, strips, masses, work):
    """Take the solved step: books of work and losses, velocities, coordinates."""
    poses, n, modes = masses.inertia.size, strips.mass.shape[1], strips.compliance.shape[1]
    own, dy, y, totals = strips.own, work.dy, state.y, state.totals
    _count_work(time, h, active, state, strips, masses, work)
    for i in range(poses):
        mean = dy[i] / h
        totals[1] += h * masses.drag[i] * mean * mean
        state.push[i] = 2.0 * (mean - state.rate[i]) / h
        state.rate[i] = 2.0 * mean - state.rate[i]
        y[i] = work.pose[i]
    work.energies[1] = 0.0
    for s in range(strips.roots.size):
        at = poses + s * (own + modes)
        if strips.relaxation[s] > 0.0:
            look_at(s, state.at[s], work.at[s], h, strips, work.energies)
        for k in range(2):
            for i in range(n):
                mean = work.move[s, k, i] / h
                lost = 0.0
                for j in range(n):
                    lost += strips.drag[s, i, j] * work.move[s, k, j]
                work.energies[1] += mean * lost
                state.acceleration[s, k, i] = 2.0 * (mean - state.velocity[s, k, i]) / h
                state.velocity[s, k, i] = 2.0 * mean - state.velocity[s, k, i]
        for i in range(at, at + own):
            y[i] += dy[i]
        for i in range(at + own, at + own + modes):
            y[i] = dy[i]
        place_strip(s, y, at, strips, state.points[s], state.ends[s])
        for p in range(strips.weight.size):
            for i in range(5):
                state.at[s, p, i] = work.at[s, p, i]
        clamp_forces(s, state, strips, work)
    totals[1] += work.energies[1]


@kernel()
def store(state, strips, masses, work, row):
    """A record: y, the bodies' rates, points, velocities, clamps, reactions, and its energies.

    These are, in EI/L: kinetic energy, potential of the weight, strain energy, work and losses.
    """
    at, n = 0, strips.mass.shape[1]
    for i in range(state.y.size):
        row[at + i] = state.y[i]
    at += state.y.size
    for i in range(state.rate.size):
        row[at + i] = state.rate[i]
    at += state.rate.size
    work.energies[0] = 0.0
    for s in range(strips.roots.size):
        look_at(s, state.at[s], state.at[s], 0.0, strips, work.energies)
        for i in range(n):
            for k in range(2):
                row[at], row[at + 1] = state.points[s, k, i], state.velocity[s, k, i]
                at += 2
        for e in range(2):
            for k in range(3):
                row[at] = state.clamped[s, e, k]
                at += 1
    for d in range(state.reaction.size):
        row[at] = state.reaction[d]
        at += 1
    row[at] = row[at + 1] = 0.0
    for i in range(state.rate.size):
        row[at] += 0.5 * masses.inertia[i] * state.rate[i] * state.rate[i]
        row[at + 1] -= masses.weight[i] * state.y[i]
    for s in range(strips.roots.size):
        for k in range(2):
            for i in range(n):
                total = 0.0
                for j in range(n):
                    total += strips.mass[s, i, j] * state.velocity[s, k, j]
                row[at] += 0.5 * total * state.velocity[s, k, i]
                row[at + 1] -= strips.dead[s, k, i] * state.points[s, k, i]
    row[at + 2], row[at + 3], row[at + 4] = work.energies[0], state.totals[0], state.totals[1]


@kernel()
def _run(time, step, begin, end, every, active, state, strips, masses, tolerance, work, counters, records):
    """Take the steps ``begin`` ... ``end`` - 1 after a time; returns the first that fails, or end.

    records: filled at the ends of steps whose number ``every`` divides.
    """
    for i in range(work.held.size):
        work.held[i] = 0
    for d in range(active.size):
        if active[d] == 1:
            work.held[masses.drive_at[d]] = 1
    for k in range(begin, end):
        now = time + k * step
        solved = newton(now, step, active, state, strips, masses, tolerance, work, counters)
        if not solved or not forward(state, strips, masses, work):
            counters[REFUSED] = FOLDS if solved else 0
            return k
        _accept(now, step, active, state, strips, masses, work)
        counters[STEPS] += 1
        if (k + 1) % every == 0:
            store(state, strips, masses, work, records[(k + 1) // every - begin // every - 1])
    return end


def turned(scene: Scene, strips: Any, y: Array, s: int) -> str:
    """At how many degrees the bodies stand that a strip joins, in a state y (Y,)."""
    bodies = [i for i in (strips.roots[s], strips.tips[s]) if 0 <= i < len(scene.bodies)]
    angles = [f"{math.degrees(y[3 * i + 2]):.3g} degrees of {scene.bodies[i].name}" for i in bodies]
    return " and ".join(angles) or "its free end"


def why(counters: NDArray[np.int64], scene: Scene, strips: Any, y: Array, s: int) -> str:
    """Why a step from y (Y,) was given up, by what was counted, and what helps; s: the first to fold."""
    strip, where = scene.strips[s], turned(scene, strips, y, s)
    helps = f"take a shorter step, or more control points than {strip.basis.control_points}"
    if counters[HALVED] > MOST_HALVED + MOST_HALVED_A_STEP * counters[WHOLE]:
        return f"steps at {where} are halved too often; {helps}"
    if counters[REFUSED] == FOLDS:
        return f"{strip.name} folds at {where}; {helps}"
    return f"no step, however short, goes on from {where}, where {strip.name} is nearest to fold; {helps}"


class Stepper(Moves):
    """A scene that the scheme advances; active (D,) is 1 for each drive that holds.

    Drives begin and end at their times and start from where the body is. A body that is caught
    changes its velocity at once: energy that it loses counts as dissipated, energy that it gains as work.
    """

    def __init__(self, start: Start) -> None:
        self.motion, self.first = start.motion, start.z
        self._model = Moving.of(self.motion)
        self.width = self._model.width
        self._state, self._work = self._model.arrays(start.z, start.v, start.acceleration)
        self.counters = np.zeros(6, dtype=np.int64)
        self.active = np.zeros(self.motion.drives.row.size, dtype=np.int64)

    def steps(self, time: float, step: float, begin: int, end: int, every: int, records: Array) -> int:
        """The number of the first step that fails."""
        model, asked = self._model, (time, step, begin, end, every, self.active)
        given = self._state, model.strips, model.masses, TOLERANCE, self._work, self.counters
        return int(_run(*asked, *given, records))

    def record(self) -> Array:
        """The present state's record (W,)."""
        record = np.zeros(self.width)
        store(self._state, self._model.strips, self._model.masses, self._work, record)
        return record

    def unknowns(self, records: Array) -> tuple[Array, Array]:
        """Unknowns (R, N) and velocities (R, Q) of records."""
        return self._model.unknowns(records)

    def reason(self) -> str:
        """Why the last step was given up, and what helps."""
        model, own = self._model, self._model.strips.own
        slowest = np.nan_to_num(self._work.at[:, :, 4] / model.strips.speed).min(axis=1)
        after = (self._state.y + self._work.dy)[len(model.masses.inertia) :]
        ends = after.reshape(len(slowest), -1)[:, own - 2 : own]
        slowest = np.minimum(slowest, np.nan_to_num(ends).min(axis=1))
        return why(self.counters, model.system.scene, model.strips, self._state.y, int(np.argmin(slowest)))

    def switch(self, time: float, span: float) -> None:
        """Let drives begin, change or end at ``time``; they then hold for at least ``span`` [s]."""
        before, self.active = self.active, self.motion.drives_at(time + 0.5 * span)
        if not self.active.any():
            return
        (z,), (v,), _ = self.look()
        self.motion = self.motion.from_here(z, self.active, before, time)
        self._model = self._model.with_drives(self.motion)
        v, lost = self.motion.catch(z, v, self.active, time, span)
        self._model.set_velocity(self._state, v)
        lost /= self.motion.system.scales.energy
        # energy is lost where a drive catches a body, not where it changes its own rate; gained it is by work
        if lost > 0.0 and (self.active > before).any():
            self._state.totals[1] += lost
        else:
            self._state.totals[0] -= lost

    def kept(self) -> list[Array]:
        """Copies of the state's arrays, for ``take_back``."""
        return [array.copy() for array in self._state]

    def take_back(self, kept: list[Array]) -> None:
        """Return to a state that was kept."""
        for array, value in zip(self._state, kept, strict=True):
            array[:] = value
