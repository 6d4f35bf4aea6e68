"""Explicit schemes on the reduced coordinates r of a free mechanism: a whole run in compiled code.

leapfrog, with a corrected force:

    w(t + h/2) = w(t - h/2) + h A(r + h^2/12 A(r, w), w),   r(t + h) = r(t) + h w(t + h/2)

Two evaluations a step give fourth order in the phase of every oscillation (effective order, Takahashi and
Imada's scheme with the force gradient as a displacement) and stability up to omega h = sqrt(12), against 2
for one evaluation. The rates that A depends on, by centripetal parts only, are extrapolated. Sources:
Wisdom, Holman and Touma, Fields Inst Comm 10 (1996) 217; Hairer, McLachlan and Skeel, ESAIM: M2AN 43
(2009) 631.

explicit: classical Runge-Kutta, four evaluations a step, fourth order in all, stable up to sqrt(8). Source:
Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I (1993), II.1.

omega is the highest frequency, an axial one; of strips that cannot stretch a bending one, so that their
steps are longer. Clamps hold because they are solved, not enforced. Neither keeps energy to round-off: the
leapfrog changes that of Table 1 with six control points by 1.5e-4 over 0.05 s at steps of 5 microseconds.
Of strips that cannot stretch the leapfrog leaves the correction out: off the states of a step their length is
not kept, so that it would be of first order. One evaluation, second order, stable up to 2.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.errors import InvalidParameter
from spline_model.motion.acceleration import accelerate, move, place
from spline_model.motion.arrays import Scratch, State
from spline_model.motion.grid import Grid, Room, grid_of, room_of
from spline_model.motion.mechanism import Moving, moving
from spline_model.motion.records import ENERGIES, MOST_GAIN_OF_OTHERS, Records, compact, first_gain
from spline_model.motion.run import SLOWEST_SPEED, store
from spline_model.motion.start import Motion, Start, Steps
from spline_model.motion.strip import curve_at
from spline_model.strip.compiled import copy, kernel, part

Array = NDArray[np.float64]

LEAPFROG, RUNGE_KUTTA = range(2)
SCHEMES = {"explicit": RUNGE_KUTTA, "leapfrog": LEAPFROG}
STABILITY_LIMITS = {"explicit": 8.0**0.5, "leapfrog": 12.0**0.5}
"""omega h up to which a step does not amplify an undamped oscillation."""
PLAIN_LIMIT = 2.0
"""The same of the leapfrog with one evaluation, where strips cannot stretch."""
SHARPNESS = 0.1
"""O h of inextensible strips: what a step leaves of their strain dies out over a few steps."""


@part()
def _start_stage(scheme, stage, h, r, w, push, room):
    """Where a stage asks for accelerations, room.x, and the rates there, room.u."""
    x, u, mean = room.x, room.u, room.mean
    for i in range(r.size):
        if scheme == LEAPFROG:
            if stage < 0:
                x[i], u[i] = r[i], w[i]
            elif stage == 0:
                r[i] += h * mean[i]
                x[i], u[i] = r[i], mean[i] + 0.5 * h * push[i]
            else:
                x[i] = r[i] + h * h / 12.0 * push[i]
        elif stage == 0:
            x[i], u[i], room.dr[i], room.dw[i] = r[i], w[i], 0.0, 0.0
        else:
            share = h if stage == 3 else 0.5 * h
            x[i], u[i] = r[i] + share * u[i], w[i] + share * push[i]


@part()
def _end_stage(scheme, stage, last, h, r, w, push, room):
    """What a stage adds."""
    u, mean = room.u, room.mean
    for i in range(r.size):
        if scheme == LEAPFROG:
            if stage < 0:
                mean[i] = w[i] + 0.5 * h * push[i]
            elif last:
                mean[i] += h * push[i]
                w[i] = mean[i] - 0.5 * h * push[i]
        else:
            share = h / 6.0 if stage == 0 or stage == 3 else h / 3.0
            room.dr[i] += share * u[i]
            room.dw[i] += share * push[i]
            if last:
                r[i] += room.dr[i]
                w[i] += room.dw[i]


@part()
def _show(r, w, grid, strips, masses, room, state):
    """The state at r with rates w, axial forces of the last evaluation; False if it is no strip's."""
    poses, n, modes = masses.inertia.size, strips.mass.shape[1], strips.compliance.shape[1]
    own, fine = strips.own, True
    for i in range(poses):
        state.y[i], state.rate[i] = r[i], w[i]
    for b in range(poses // 3):
        room.turns[b, 0], room.turns[b, 1] = np.cos(r[3 * b + 2]), np.sin(r[3 * b + 2])
    for s in range(strips.roots.size):
        at, to = poses + s * own, poses + s * (own + modes)
        place(s, at, r, grid, strips, room)
        move(s, at, w, strips, room)
        for i in range(own):
            state.y[to + i] = r[at + i]
        for k in range(modes):
            state.y[to + own + k] = room.axial[s, k]
        for i in range(n):
            for k in range(2):
                state.points[s, k, i] = room.points[s, k, i]
                state.velocity[s, k, i] = room.speed[s, k, i]
        for e in range(2):
            copy(room.ends[s, e], state.ends[s, e])
            body = strips.roots[s] if e == 0 else strips.tips[s]
            fine = fine and (strips.lead == 1 or body >= strips.free_from or r[at + own - 2 + e] > 0.0)
        for p in range(strips.weight.size):
            curve_at(p, state.points[s], strips.first, strips.d1, strips.d2, state.at[s, p])
            fine = fine and state.at[s, p, 4] > SLOWEST_SPEED * strips.speed[s, p]
    return fine


@kernel()
def _run(scheme, stages, h, every, r, w, push, grid, strips, masses, room, state, work, records):
    """Fill the rows of the records, ``every`` steps of that many stages apart; returns the rows filled.

    A state that diverges or is no strip's ends the run.
    """
    for row in range(records.shape[0]):
        for step in range(every):
            for stage in range(-1 if scheme == LEAPFROG and row + step == 0 else 0, stages):
                _start_stage(scheme, stage, h, r, w, push, room)
                accelerate(room.x, room.u, SHARPNESS / h, grid, strips, masses, room, push)
                _end_stage(scheme, stage, stage == stages - 1, h, r, w, push, room)
            largest = 0.0
            for i in range(r.size):
                largest = max(largest, abs(r[i]) + h * abs(w[i])) if r[i] == r[i] else np.inf
            if not largest < 1e3:  # far outside any pose, or not finite
                return row
        if not _show(r, w, grid, strips, masses, room, state):
            return row
        store(state, strips, masses, work, records[row])
    return records.shape[0]


class Flight(NamedTuple):
    """A motion about to start: scheme, model, r, its rates and acceleration, working arrays, records."""

    scheme: int
    model: Moving
    grid: Grid
    room: Room
    r: Array
    w: Array
    push: Array
    state: State
    work: Scratch
    records: Array

    @property
    def stages(self) -> int:
        """Evaluations of the accelerations in a step."""
        return (1 if self.grid.outer else 2) if self.scheme == LEAPFROG else 4

    def fly(self, step: float, every: int) -> int:
        """Fill the records behind the first, ``every`` steps apart, compiled; returns how many."""
        model = self.model
        return int(
            _run(
                self.scheme, self.stages, step, every, self.r, self.w, self.push, self.grid, model.strips,
                model.masses, self.room, self.state, self.work, self.records[1:],
            )
        )  # fmt: skip


def flight(motion: Motion, z: Array, v: Array, rows: int, integrator: str) -> Flight:
    """The motion from (z, v), which the first record has, with space for ``rows`` more."""
    require_explicit(motion, integrator)
    model = moving(motion)
    strips, masses = model.strips, model.masses
    state, work = model.arrays(z, v, np.zeros(len(v)))
    grid = grid_of(strips)
    r, w = _reduced(model, state)
    records = np.empty((rows + 1, model.width))
    store(state, strips, masses, work, records[0])
    return Flight(
        scheme=SCHEMES[integrator],
        model=model,
        grid=grid,
        room=room_of(strips, masses, grid),
        r=r,
        w=w,
        push=np.zeros_like(r),
        state=state,
        work=work,
        records=records,
    )


def integrate(start: Start, run: Steps, integrator: str) -> Records:
    """The records of a run."""
    begun = flight(start.motion, start.z, start.v, run.records - 1, integrator)
    records = begun.records[: begun.fly(run.step, run.every) + 1]
    kept = first_gain(records[:, -ENERGIES:], 1.0, MOST_GAIN_OF_OTHERS)
    message = ""
    if kept < run.records:
        message = (
            f"unstable near {kept * run.spacing:.6g} s: the step is above the critical one; "
            "take a shorter step"
        )
    done = (kept - 1) * run.every
    counters = {"steps": done, "evaluations": begun.stages * done}
    return compact(start.motion, begun.model, records[:kept], start.z, run.spacing, message, counters)


def stability_limit(integrator: str, motion: Motion) -> float:
    """omega h up to which a step does not amplify an undamped oscillation of a system in motion."""
    tied = bool((np.diag(motion.rigidity) == 0.0).any())
    return PLAIN_LIMIT if tied and integrator == "leapfrog" else STABILITY_LIMITS[integrator]


def require_explicit(motion: Motion, integrator: str) -> None:
    """Refuse a scene whose accelerations do not follow from its state alone."""
    motion.require_compiled(integrator)
    motion.require_conservative(integrator)
    layout = motion.system.layout
    blocks = [motion.mass[at, at][::2, ::2] for at in map(layout.strip, layout.strips)]
    if not all(np.linalg.eigvalsh(block)[0] > 0.0 for block in blocks):
        raise InvalidParameter("integrator", integrator, "an implicit one for strips without mass")


def _reduced(model: Moving, state: State) -> tuple[Array, Array]:
    """Reduced coordinates r and rates w, (R,) each, of a state with its velocities."""
    strips, q, n = model.strips, len(model.masses.inertia), model.strips.mass.shape[1]
    own, lead, modes = strips.own, strips.lead, strips.compliance.shape[1]
    y, rate = state.y, state.rate.copy()
    places, rates = [y[:q]], [rate]
    for s in range(len(strips.roots)):
        at = q + s * (own + modes)
        places.append(y[at : at + own])
        velocity, reaches = state.velocity[s], []
        for e, (body, outer, inner) in enumerate(((strips.roots[s], 0, 1), (strips.tips[s], n - 1, n - 2))):
            along = state.ends[s, e, 2:]
            chord, square = velocity[:, inner] - velocity[:, outer], along @ along
            reaches.append(along @ chord / square)
            if body >= strips.free_from:  # a free end is its own body, without an angle where roots turn
                turn = along[0] * chord[1] - along[1] * chord[0]
                turn = turn / (square * y[at + own - 2 + e]) if lead == 2 else 0.0
                rate[3 * body : 3 * body + 3] = *velocity[:, outer], turn
        rates += [velocity[:, lead : n - lead].T.ravel(), np.array(reaches if lead == 2 else ())]
    return np.concatenate(places), np.concatenate(rates)
