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

import numpy as np
from numpy.typing import NDArray

from spline_model.motion.arrays import RECORDED, Masses, Scratch, State, sizes_of, zeros
from spline_model.motion.moves import MOST_HALVED, MOST_HALVED_A_STEP, Moves
from spline_model.motion.records import ENERGIES
from spline_model.motion.start import Array, Start
from spline_model.motion.step import FOLDS, HALVED, MOVED, REFUSED, STEPS, WHOLE, newton
from spline_model.motion.strip import keep_curve, quadratic
from spline_model.reduced.arrays import AXIAL, BENDING, DEAD, SPARE
from spline_model.reduced.assembly import begin
from spline_model.reduced.model import Reduced, from_unknowns, require_reduced
from spline_model.reduced.states import unknowns_of
from spline_model.strip.compiled import copy, kernel, part
from spline_model.strip.element import ON_POINTS, POINTS, SPEED, SPEED_AT
from spline_model.strip.ends import place_points
from spline_model.strip.points import evaluate_residual, forces_of_strains, take_strains

TOLERANCE = 1e-11
"""Residual of a step, in EI/L^2, EI/L, L and rad; the energy of a step is exact to this."""
SLOWEST_SPEED = 0.1
"""|C'| below which, over that at rest, a strip is folded."""


@part()
def forward(y, arrays, masses):
    """True if every clamped end's tangent points forwards and |C'| is above a tenth of that at rest."""
    strips, local = arrays.strips, arrays.local
    own, modes = 2 * arrays.shape.order.size - 6, strips.compliance.shape[1]
    for s in range(strips.roots.size):
        at = arrays.bodies.rest.size + s * (own + modes) + own
        if strips.roots[s] < masses.free_from and not y[at - 2] > 0.0:
            return False
        if strips.tips[s] < masses.free_from and not y[at - 1] > 0.0:
            return False
        for p in range(local.lanes.shape[2]):
            if not local.lanes[s, SPEED_AT, p] > SLOWEST_SPEED * strips.along[s, p, SPEED]:
                return False
    return True


@part()
def _accept(h, active, state, arrays, masses, work):
    """Take the solved step: energy balance of work and losses, velocities, coordinates."""
    strips, local, dy, totals = arrays.strips, arrays.local, work.dy, state.totals
    for d in range(masses.drive_at.size):
        if active[d] == 1:
            totals[0] += work.residual[masses.drive_at[d]] * dy[masses.drive_at[d]]
    for i in range(masses.inertia.size):
        mean = dy[i] / h
        totals[0] += work.load[i] * work.moved[MOVED, i] + work.turned[i] * dy[i]
        totals[1] += h * masses.drag[i] * mean * mean
        state.push[i] = 2.0 * (mean - state.rate[i]) / h
        state.rate[i] = 2.0 * mean - state.rate[i]
    for i in range(masses.across.shape[0]):
        for j in range(masses.across.shape[0]):
            totals[1] += masses.across[i, j] * dy[i] * dy[j] / h
    own, modes = work.line.size - 6, strips.compliance.shape[1]
    for s in range(strips.roots.size):
        at, move = masses.inertia.size + s * (own + modes) + own, work.move[s]
        totals[1] += work.lost[s] + quadratic(masses.damping[s], move) / h
        for i in range(move.size):
            mean = move[i] / h
            state.acceleration[s, i] = 2.0 * (mean - state.velocity[s, i]) / h
            state.velocity[s, i] = 2.0 * mean - state.velocity[s, i]
        for i in range(at, at + modes):
            work.y[i] = dy[i]
        keep_curve(s, strips, local, state)
    copy(work.y, state.y)


@part()
def book(y, rate, strips_kinetic, potential, totals, masses, arrays, row):
    """Fill the record of a state whose points are placed: y, rates of the bodies and, last, energies in EI/L.

    These are kinetic energy, potential of the weight, energy of strains and springs, work, losses.
    strips_kinetic: kinetic energy of the strips; potential: of weight, strains and springs.
    """
    kinetic, weight, last = strips_kinetic, 0.0, row[row.size - ENERGIES :]
    copy(y, row)
    copy(rate, row[y.size :])
    for i in range(rate.size):
        kinetic += 0.5 * masses.inertia[i] * rate[i] * rate[i]
        weight -= arrays.bodies.weight[i] * y[i]
    for s in range(arrays.strips.roots.size):
        for i in range(2 * arrays.shape.order.size):
            weight -= arrays.strips.numbers[s, ON_POINTS + i] * arrays.local.nodal[s, POINTS, i]
    last[0], last[1], last[2], last[3], last[4] = kinetic, weight, potential - weight, totals[0], totals[1]


@kernel()
def store(state, arrays, masses, row):
    """Keep map and curve of a state that is given by its coordinates, and fill its record.

    It is that of ``book``, with the velocity of the control points before the energies.
    """
    strips, shape, local, points = arrays.strips, arrays.shape, arrays.local, state.velocity.shape[1]
    out, spare, n = arrays.space.out, arrays.space.states[SPARE], shape.order.size
    own, modes, kinetic = 2 * n - 6, strips.compliance.shape[1], 0.0
    begin(state.y, 0.0, arrays.bodies, arrays.space)
    for s in range(strips.roots.size):
        first = state.rate.size + s * (own + modes)
        a = spare[first + own : first + own + modes]
        place_points(s, state.y[first : first + own], state.y, strips, local)
        take_strains(s, shape, strips, local)
        keep_curve(s, strips, local, state)
        forces_of_strains(s, strips, local, a)
        evaluate_residual(s, a, n, shape, strips, local, out)
        kinetic += 0.5 * quadratic(masses.points[s], state.velocity[s])
        copy(state.velocity[s], row[state.y.size + state.rate.size + s * points :])
    potential = out[BENDING] + out[AXIAL] + out[DEAD]
    book(state.y, state.rate, kinetic, potential, state.totals, masses, arrays, row)


@kernel()
def _run(time, step, begin, end, every, active, state, arrays, masses, tolerance, work, counters, records):
    """Take the steps ``begin`` ... ``end`` - 1 after a time; returns the first that fails, or end.

    records: filled at the ends of steps whose number ``every`` divides.
    """
    for k in range(begin, end):
        now = time + k * step
        solved = newton(now, step, active, state, arrays, masses, tolerance, work, counters)
        if not solved or not forward(work.y, arrays, masses):
            counters[REFUSED] = FOLDS if solved else 0
            return k
        _accept(step, active, state, arrays, masses, work)
        counters[STEPS] += 1
        if (k + 1) % every == 0:
            store(state, arrays, masses, records[(k + 1) // every - begin // every - 1])
    return end


def standing(model: Reduced, y: Array, s: int) -> str:
    """At how many degrees the bodies stand that a strip joins, in a state y (Y,)."""
    scene, ends = model.system.scene, (model.strips.roots[s], model.strips.tips[s])
    bodies = [i for i in ends if 0 <= i < len(scene.bodies)]
    angles = [f"{math.degrees(y[3 * i + 2]):.3g} degrees of {scene.bodies[i].name}" for i in bodies]
    return " and ".join(angles) or "its free end"


def why(counters: NDArray[np.int64], model: Reduced, y: Array, s: int) -> str:
    """Return why a step from y (Y,) [m, rad, N] was given up, by the counted events, and what helps.

    s: the first strip to fold.
    """
    strip, where = model.system.scene.strips[s], standing(model, y, s)
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

    name = "energy"

    def __init__(self, start: Start) -> None:
        self.motion = start.motion
        self.model = model = require_reduced(self.motion.system)
        self._begin()
        self.state, self._work = zeros(State, self._sizes), zeros(Scratch, self._sizes)
        self._work.held[self._masses.frames.carried] = 1
        self.state.y[:] = from_unknowns(model, start.z)
        self.state.rate[:], self.state.velocity[:] = self._rates(start.v)
        self.state.push[:], self.state.acceleration[:] = self._rates(start.acceleration)
        self.width = sum(each.size for each in self.state[:RECORDED]) + ENERGIES
        self.record()

    def _begin(self) -> None:
        """Make what a motion of the model has at all times."""
        self._arrays, self._masses = self.model.arrays(), Masses.of(self.motion, self.model)
        self._sizes = sizes_of(self.model, self._masses)
        self.counters = np.zeros(6, dtype=np.int64)
        self.active = np.zeros(self._sizes["D"], dtype=np.int64)

    def _rates(self, given: Array) -> tuple[Array, Array]:
        """Rates of the bodies (Q,) and control points (S, 2 n) from those (Q,) of the scene."""
        model, layout, rates = self.model, self.model.system.layout, np.zeros(len(self._masses.inertia))
        moved = given[layout.poses] / np.tile(model.system.scales.pose, len(layout.bodies))
        rates[: len(moved)] = moved
        points = [given[layout.strip(name)].reshape(-1, 2)[model.shape.order] for name in layout.strips]
        return rates, np.array(points).reshape(len(points), -1) / model.length

    def steps(self, time: float, step: float, begin: int, end: int, every: int, records: Array) -> int:
        """The number of the first step that fails."""
        asked = time, step, begin, end, every, self.active
        given = self.state, self._arrays, self._masses, TOLERANCE, self._work, self.counters
        return int(_run(*asked, *given, records))

    def record(self) -> Array:
        """Return the present state's record (W,): lengths over L, energies over EI/L [1]."""
        record = np.zeros(self.width)
        store(self.state, self._arrays, self._masses, record)
        return record

    def unknowns(self, records: Array) -> tuple[Array, Array]:
        """Return unknowns (R, N) [m, rad, N] and velocities (R, Q) [m/s, rad/s] of records (R, W).

        Axial forces are the means of the steps that end there. With moving strips multipliers are zero:
        clamps are solved.
        """
        model, layout, size = self.model, self.model.system.layout, self.model.size
        poses, points = 3 * len(layout.bodies), records[:, size + self._sizes["Q"] : -ENERGIES]
        z = unknowns_of(model, records[:, :size].copy(), np.zeros((len(records), len(self.active))))
        v = np.zeros((len(records), layout.coordinate_count))
        v[:, layout.poses] = records[:, size : size + poses] * np.tile(model.system.scales.pose, poses // 3)
        if not points.size:
            return z, v
        z[:, layout.multiplier_start :] = 0.0
        velocity = points.reshape(len(z), len(layout.strips), -1, 2) * model.length
        for s, name in enumerate(layout.strips):
            v[:, layout.strip(name)].reshape(len(z), -1, 2)[:, model.shape.order] = velocity[:, s]
        return z, v

    def reason(self) -> str:
        """Why the last step was given up, and what helps."""
        model, own = self.model, 2 * len(self.model.shape.order) - 6
        slowest = np.nan_to_num(self._arrays.local.lanes[:, SPEED_AT] / model.strips.speed).min(axis=1)
        ends = self._work.y[len(model.bodies.rest) :].reshape(len(slowest), -1)[:, own - 2 : own]
        slowest = np.minimum(slowest, np.nan_to_num(ends).min(axis=1))
        return why(self.counters, model, self.state.y, int(np.argmin(slowest)))

    def switch(self, time: float, span: float) -> None:
        """Let drives begin, change or end at ``time``; they then hold for at least ``span`` [s]."""
        if not len(self.active):
            return
        before, self.active = self.active, self.motion.drives_at(time + 0.5 * span)
        held = self._work.held
        held[self._masses.drive_at], held[self._masses.drive_at[self.active == 1]] = 0, 1
        if not self.active.any():
            return
        (z,), (v,), _ = self.look()
        self.motion = self.motion.from_here(z, self.active, before, time)
        self._masses = Masses.of(self.motion, self.model)
        v, lost = self.motion.catch(z, v, self.active, time, span)
        self.state.rate[:], self.state.velocity[:] = self._rates(v)
        lost /= self.model.energy
        # energy is lost where a drive catches a body, not where it changes its own rate; gained it is by work
        if lost > 0.0 and (self.active > before).any():
            self.state.totals[1] += lost
        else:
            self.state.totals[0] -= lost
