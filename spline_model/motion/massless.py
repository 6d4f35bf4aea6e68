"""Bodies on massless strips, in equilibrium at the bodies' poses x, which alone are dynamic: one energy W(x).

    M (v1 - v0) / h + D (v0 + v1) / 2 + DW(x0, x1) - f = 0,   (v0 + v1) / 2 = (x1 - x0) / h,
    DW = (g0 + g1) / 2 + (W1 - W0 - (g0 + g1)/2 . dx) / (dx . M dx) M dx

with g the strips' reactions, so that the energy is the same before and after a step of any size.
Poses and strips are solved for together, the strips condensed as in statics
(``spline_model.reduced.assembly``); coordinates without mass, of free strip ends, are in equilibrium
at the step's end. A step begins along the last tangent, renews it there, and goes on with gradients alone
while the residual shrinks: with an older tangent Newton's method converges to the same equilibrium, and an
evaluation costs a quarter. All are parts of one kernel: a call that passes the tables takes as long.
Where a strip snaps through there is no equilibrium to go on in, and the run ends: what follows is a motion of
the strip, which has its inertia.
Source of the discrete gradient: Gonzalez, J Nonlinear Sci 6 (1996) 449.
"""

from __future__ import annotations

import math
from typing import Annotated, NamedTuple

import numpy as np
from scipy.linalg import eigh

from spline_model.effects import Spring
from spline_model.errors import InvalidParameter
from spline_model.motion import energy_consistent
from spline_model.motion.arrays import Array, Places, zeros
from spline_model.motion.energy_consistent import TOLERANCE, book, forward, standing, why
from spline_model.motion.records import ENERGIES
from spline_model.motion.start import Motion, Start
from spline_model.motion.step import (
    FACTORISATIONS,
    FOLDS,
    MOST_ITERATIONS,
    NEWTON,
    REFUSED,
    SNAPS,
    STEPS,
    load_at,
    solve_rows,
)
from spline_model.reduced.arrays import AXIAL, BENDING, DEAD, FORCE, MOVE, NEGATIVE, RATE
from spline_model.reduced.assembly import assemble, factorise, move_strips
from spline_model.reduced.beside import condense_again, take_residual
from spline_model.reduced.equilibrium import entry
from spline_model.reduced.model import Reduced, from_unknowns, reduced
from spline_model.reduced.states import whole_tangents
from spline_model.strip.compiled import copy, kernel, part
from spline_model.strip.element import LAST
from spline_model.strip.ends import place_points

STILL = 1e-6
"""Residual of the strips at the start, which is in equilibrium, in EI/L^2, EI/L and L."""
LEAST = 1e-9
"""Compliance in L^2/EI that stands for none where the stiffness of strips is asked for."""
SOFT = 0.5
"""Least stiffness of a strip over that at rest below which it is what stops a motion."""
ROUND_OFF = 1e-14
"""Part of the energy below which the gap between its change and the mean gradient's work is round-off: the
gap goes with the third power of a step, and divided by the second it would drown a short one."""
NEARLY, CLOSE = 1e-6, 1e-4
"""Residuals from which one more correction ends below round-off, so that nothing is evaluated behind it: with
a new tangent, and with an older one, if it shrinks fast enough for that."""
AFTER = 1e-9
"""Residual that the last correction with an older tangent may leave: its work in a step is round-off."""
POOR = 0.1
"""Residual over the one before from which the tangent is renewed."""


class _State(NamedTuple):
    """State of the bodies, Q coordinates and Q' with the axial forces beside them, and working arrays.

    y with the strips' coordinates; rate: velocities; energy: W and the next one; pull, next: reactions g,
    slope: derivative of the gap; totals: work and losses; ahead: the strips' change along the tangent, bent:
    the curvature that the tangent of the last step, of length last [s], neglects; system, x: what is solved;
    still: what has no mass.
    """

    y: Annotated[Array, "Y"]
    rate: Annotated[Array, "Q"]
    energy: Annotated[Array, "2"]
    pull: Annotated[Array, "Q'"]
    next: Annotated[Array, "Q'"]
    slope: Annotated[Array, "Q'"]
    totals: Annotated[Array, "2"]
    trial: Annotated[Array, "Y"]
    dx: Annotated[Array, "Q"]
    load: Annotated[Array, "Q"]
    ahead: Annotated[Array, "Y"]
    bent: Annotated[Array, "Y"]
    last: Annotated[Array, "1"]
    system: Annotated[Array, "Q' Q'"]
    x: Annotated[Array, "Q'"]
    still: Annotated[Places, "M"]


@part()
def _stored(y, arrays):
    """The potential W at a state just assembled: stationary in the strips' coordinates and forces."""
    bodies, strips, shape = arrays.bodies, arrays.strips, arrays.shape
    local, space = arrays.local, arrays.space
    total = space.out[BENDING] + space.out[AXIAL] + space.out[DEAD]
    own, modes = 2 * shape.order.size - 6, strips.compliance.shape[1]
    for s in range(strips.roots.size):
        at = bodies.rest.size + s * (own + modes) + own
        for k in range(modes):
            total += y[at + k] * local.gap[s, k]
    return total


@part()
def _look_ahead(poses, arrays):
    """W and reactions behind the last correction, to the second and first order in it.

    What the strips were off their equilibrium raises W by g^2 / 2 d a pivot, and lowers it by gap^2 / 2 c.
    """
    strips, shape = arrays.strips, arrays.shape
    local, space = arrays.local, arrays.space
    for s in range(strips.roots.size):
        for i in range(2 * shape.order.size - 6):
            poses.energy[1] -= 0.5 * local.reduced[s, LAST, i] ** 2 / local.reduced[s, i, i]
        for k in range(strips.compliance.shape[1]):
            poses.energy[1] += 0.5 * strips.gain[s, k] * local.gap[s, k] ** 2
    force, move = space.vectors[FORCE], space.vectors[MOVE]
    for i in range(poses.next.size):
        change = 0.0
        for j in range(poses.next.size):
            change += entry(space.tangent, i, j) * move[j]
        poses.energy[1] += (force[i] + 0.5 * change) * move[i]
        poses.next[i] += change


@part()
def _mean_gradient(poses, masses, space):
    """The mean gradient's correction along M dx, dx . M dx, and the gap's derivative, less the metric's."""
    force, dx = space.vectors[FORCE], poses.dx
    metric, gap = 0.0, poses.energy[1] - poses.energy[0]
    for i in range(dx.size):
        metric += masses.inertia[i] * dx[i] * dx[i]
        if masses.inertia[i] > 0.0:
            gap -= 0.5 * (poses.pull[i] + force[i]) * dx[i]
    if metric == 0.0 or abs(gap) <= ROUND_OFF * abs(poses.energy[0]):
        return 0.0, metric
    push = gap / metric
    for i in range(poses.slope.size):
        total = force[i]
        if i < dx.size and masses.inertia[i] > 0.0:
            total -= 0.5 * (poses.pull[i] + force[i]) + 2.0 * push * masses.inertia[i] * dx[i]
        for j in range(dx.size):
            if masses.inertia[j] > 0.0:
                total -= 0.5 * entry(space.tangent, j, i) * dx[j]
        poses.slope[i] = total
    return push, metric


@part()
def _balance(h, poses, masses, space):
    """Fill the rows of the step's residual, negative, and its tangent; returns the largest residual."""
    force, x, dx, system = space.vectors[FORCE], poses.x, poses.dx, poses.system
    push, metric = _mean_gradient(poses, masses, space)
    norm = 0.0
    for i in range(x.size):
        heavy = i < dx.size and masses.inertia[i] > 0.0
        share, residual = 0.5 if heavy else 1.0, force[i]
        for c in range(x.size):
            system[i, c] = share * entry(space.tangent, i, c)
        if heavy:
            mass, mean = masses.inertia[i], dx[i] / h
            residual = 0.5 * (poses.pull[i] + force[i]) + push * mass * dx[i]
            residual += 2.0 / h * mass * (mean - poses.rate[i]) + masses.drag[i] * mean
            system[i, i] += 2.0 * mass / (h * h) + masses.drag[i] / h + push * mass
            if push != 0.0:
                for c in range(x.size):
                    system[i, c] += mass * dx[i] / metric * poses.slope[c]
        if i < dx.size:
            residual -= poses.load[i]
        norm = max(norm, abs(residual)) if residual == residual else math.inf
        x[i] = -residual
    for f in range(masses.frames.place.shape[0]):
        for i in range(masses.frames.place[f, 0], masses.frames.place[f, 0] + masses.frames.place[f, 2]):
            system[i, i] = 1.0
    return norm


@part()
def _move_all(share, poses, arrays):
    """Move by the solution x of the rows, the strips with the bodies; share: 1 with their own residual."""
    space, dx, y = arrays.space, poses.dx, poses.trial
    move, rate = space.vectors[MOVE], space.states[RATE]
    for i in range(poses.x.size):
        move[i] = poses.x[i]
    for i in range(dx.size):
        dx[i] += poses.x[i]
        y[i] = poses.y[i] + dx[i]
    move_strips(share, arrays, rate)
    for i in range(dx.size, y.size):
        y[i] += rate[i]


@part()
def _bend_on(h, poses):
    """What the strips bent away from the tangent in the last step they bend again, by its square."""
    again = h * h / (poses.last[0] * poses.last[0])
    for i in range(poses.dx.size, poses.y.size):
        poses.ahead[i] = poses.trial[i] - poses.y[i]
        poses.trial[i] += again * poses.bent[i]


@part()
def _evaluate(fresh, poses, arrays):
    """Return the energy and reactions at ``trial``, with a fresh tangent or an older one; the strips'
    residual."""
    if fresh:
        norm = assemble(poses.trial, 0.0, arrays)
    else:
        norm = take_residual(poses.trial, 0.0, arrays)
        condense_again(arrays)
    poses.energy[1] = _stored(poses.trial, arrays)
    for i in range(poses.next.size):
        poses.next[i] = arrays.space.vectors[FORCE, i]
    return norm


@part()
def _solve(h, poses, masses, arrays, tolerance, counters):
    """Solve a step of length h for the state ``trial``, from the last one along its tangent; True if done.

    dx is the bodies' change, kept apart as their inertia would drown in its round-off.
    """
    norm = before = math.inf
    for i in range(poses.dx.size):
        poses.dx[i] = 0.0
    copy(poses.y, poses.trial)
    copy(poses.pull, arrays.space.vectors[FORCE])
    poses.energy[1] = poses.energy[0]
    if not _balance(h, poses, masses, arrays.space) < 1e12:
        return False
    if not solve_rows(poses.x.size, poses.system, poses.x):
        return False
    _move_all(0.0, poses, arrays)
    _bend_on(h, poses)
    for trial in range(MOST_ITERATIONS):
        fresh, before = trial == 0 or norm > POOR * before, norm
        counters[FACTORISATIONS] += fresh
        strain = _evaluate(fresh, poses, arrays)
        norm = max(strain, _balance(h, poses, masses, arrays.space)) if strain == strain else math.inf
        if norm <= tolerance or (norm <= 1e3 * tolerance and norm > 0.5 * before):
            return True
        if not norm < 1e12 or not solve_rows(poses.x.size, poses.system, poses.x):
            return False
        _move_all(1.0, poses, arrays)
        counters[NEWTON] += 1
        small = norm <= NEARLY if fresh else norm <= CLOSE and norm * norm <= AFTER * before
        if small and arrays.strips.coupled == 0:
            _look_ahead(poses, arrays)
            return True
    return False


@part()
def _refused(poses, masses, arrays):
    """Why a solved state is refused, or 0: FOLDS, or SNAPS where the strips' equilibrium is unstable.

    At held masses no direction lowers the energy: coordinates without mass would leave such a state at once.
    """
    bodies, space = arrays.bodies, arrays.space
    if not forward(poses.trial, arrays, masses):
        return FOLDS
    outer = bodies.load.size - bodies.rest.size
    negative = factorise(poses.still, space.tangent, space.factors, outer)
    return 0 if negative + space.out[NEGATIVE] == 0.0 else SNAPS


@part()
def _accept(h, poses, masses):
    """Take the solved step: books, velocities, coordinates."""
    for i in range(poses.dx.size):
        change = poses.dx[i]
        poses.totals[0] += poses.load[i] * change
        poses.totals[1] += masses.drag[i] * change * change / h
        poses.rate[i] = 2.0 * change / h - poses.rate[i] if masses.inertia[i] > 0.0 else 0.0
    for i in range(poses.dx.size, poses.y.size):
        poses.bent[i] = poses.trial[i] - poses.y[i] - poses.ahead[i]
    poses.last[0] = h
    _settle(poses)


@part()
def _settle(poses):
    """Take the equilibrium that was found."""
    copy(poses.trial, poses.y)
    copy(poses.next, poses.pull)
    poses.energy[0] = poses.energy[1]


@part()
def _store(poses, masses, arrays, row):
    """A record: y, the bodies' rates and its energies."""
    y, rate, strips, own = poses.y, poses.rate, arrays.strips, 2 * arrays.shape.order.size - 6
    for s in range(strips.roots.size):
        at = rate.size + s * (own + strips.compliance.shape[1])
        place_points(s, y[at : at + own], y, strips, arrays.local)
    book(y, rate, 0.0, poses.energy[0], poses.totals, masses, arrays, row)


@kernel()
def _begin(poses, masses, arrays, row):
    """Energy, reactions and record of a state in equilibrium; returns the strips' residual."""
    copy(poses.y, poses.trial)
    norm = _evaluate(True, poses, arrays)
    _settle(poses)
    _store(poses, masses, arrays, row)
    return norm


@kernel()
def _run(time, step, begin, end, every, poses, masses, arrays, tolerance, counters, records):
    """Take the steps ``begin`` ... ``end`` - 1 after a time; returns the first that fails, or end.

    records (R, Y + Q + 5): of ``_store``, at the ends of steps whose number ``every`` divides.
    """
    for k in range(begin, end):
        for i in range(poses.load.size):
            poses.load[i] = 0.0
        for f in range(masses.load_at.size):
            poses.load[masses.load_at[f]] += load_at(f, time + k * step + 0.5 * step, masses)
        solved = _solve(step, poses, masses, arrays, tolerance, counters)
        counters[REFUSED] = _refused(poses, masses, arrays) if solved else 0
        if not solved or counters[REFUSED] != 0:
            assemble(poses.y, 0.0, arrays)  # the tangent to begin along
            return k
        _accept(step, poses, masses)
        counters[STEPS] += 1
        if (k + 1) % every == 0:
            _store(poses, masses, arrays, records[(k + 1) // every - begin // every - 1])
    return end


def _require_known(motion: Motion) -> None:
    """Refuse effects that need the inertia of the strips."""
    system = motion.system
    system.require_dead("effects", "strip_inertia")
    beside = system.layout.poses.start + 3 * len(system.scene.own_bodies)
    across = any(any(spring.damping) and spring.other for spring in system.scene.of(Spring))
    for found, what, expected in (
        (system.relaxation_time > 0.0, "strip_damping", "with it: massless strips have no rate"),
        (across, "a damper between bodies", "for one in a motion"),
        (motion.drives.row.size > 0, "a drive", "for a driven motion"),
        (
            (motion.loads.coordinate >= beside).any(),
            "a load at a tip or point",
            "for it: with massless strips loads act at centres of bodies",
        ),
    ):
        if found:
            raise InvalidParameter("effects", what, f"strip_inertia {expected}")


def _softness(model: Reduced, y: Array, strip: int) -> float:
    """Return the least stiffness [1] of a strip between held ends at a state y (Y,), over that at rest.

    It is the smallest ratio over all shapes of the strip's own coordinates: 0 where it buckles or snaps
    through, negative where it is unstable.
    """
    w, a = model.places(strip)
    parts = []
    for hessian in whole_tangents(model, np.array([y, model.start]), np.zeros(2))[1]:
        coupling = hessian[a, w]
        compliance = -hessian[a, a] + LEAST * np.eye(len(coupling))
        parts.append(hessian[w, w] + coupling.T @ np.linalg.solve(compliance, coupling))
    return float(eigh(*parts, eigvals_only=True)[0])


class Stepper(energy_consistent.Stepper):
    """Bodies on massless strips that the scheme advances, from their part of the velocity."""

    name = "quasi-static strips"

    def __init__(self, start: Start) -> None:
        self.motion, system = start.motion, start.motion.system
        _require_known(self.motion)
        model, y = start.known.last or (reduced(system), None)
        if model is None:
            raise InvalidParameter("strips", "massless ones of this kind", "strip_inertia")
        y = from_unknowns(model, start.known.array[-1]) if y is None else y
        self.model = model = model.let_go(system)
        self._begin()
        masses, sizes = self._masses, self._sizes | {"Q'": len(model.bodies.load)}
        light = np.flatnonzero(masses.inertia == 0.0)
        still = [*np.setdiff1d(light, masses.frames.carried), *range(sizes["Q"], sizes["Q'"])]
        self.state = zeros(_State, sizes | {"M": len(still)})
        self.state.y[:] = self.state.trial[:] = y
        self.state.rate[:], self.state.last[:], self.state.still[:] = self._rates(start.v)[0], 1.0, still
        self.width = model.size + sizes["Q"] + ENERGIES

    def steps(self, time: float, step: float, begin: int, end: int, every: int, records: Array) -> int:
        """The number of the first step that fails."""
        given = self.state, self._masses, self._arrays, TOLERANCE, self.counters
        return int(_run(time, step, begin, end, every, *given, records))

    def record(self) -> Array:
        """The present state's record (W,), in equilibrium."""
        record = np.zeros(self.width)
        self.counters[FACTORISATIONS] += 1
        if not _begin(self.state, self._masses, self._arrays, record) < STILL:
            raise InvalidParameter("start", "no equilibrium of the strips", "a static state")
        return record

    def reason(self) -> str:
        """Why the last step was given up: where none folds, a strip that is soft by now snaps through."""
        model, y = self.model, self.state.y
        least = [_softness(model, y, s) for s in range(len(model.strips.roots))]
        soft = int(np.argmin(least))
        if self.counters[REFUSED] == FOLDS or least[soft] > SOFT:
            return why(self.counters, model, y, soft)
        return (
            f"{model.system.scene.strips[soft].name} snaps through at {standing(model, y, soft)}: without "
            "mass it goes from equilibrium to equilibrium, and there is none to go on to; give the strips "
            "their inertia (strip_inertia)"
        )
