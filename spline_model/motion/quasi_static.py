"""Bodies on massless strips: only their coordinates are dynamic, by ``spline_model.motion.massless``.

Strips without mass stand in stable equilibrium at every instant. Where one snaps through there is none to go
on in, and the run ends: what follows is a motion of the strip, which has its inertia.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import eigh

from spline_model.effects import Spring
from spline_model.errors import InvalidParameter
from spline_model.motion.arrays import Masses, Poses
from spline_model.motion.energy_consistent import forward, standing, why
from spline_model.motion.massless import evaluate, solve
from spline_model.motion.moves import Moves
from spline_model.motion.records import ENERGIES
from spline_model.motion.start import Array, Motion, Start
from spline_model.motion.step import FACTORISATIONS, FOLDS, REFUSED, SNAPS, STEPS, load_at
from spline_model.reduced.arrays import NEGATIVE
from spline_model.reduced.assembly import assemble, factorise
from spline_model.reduced.model import Reduced, from_unknowns, reduced
from spline_model.reduced.states import unknowns_of, whole_tangents
from spline_model.strip.compiled import copy, kernel, part
from spline_model.strip.element import ON_POINTS, POINTS
from spline_model.strip.ends import place_points

NAME = "quasi-static strips"
"""What the energy integrator is called where only the bodies are dynamic."""
TOLERANCE = 1e-11
"""Residual of a step in EI/L^2, EI/L and L."""
STILL = 1e-6
"""The same of the strips at the start, which is in equilibrium."""
LEAST = 1e-9
"""Compliance in L^2/EI that stands for none where the stiffness of strips is asked for."""
SOFT = 0.5
"""Least stiffness of a strip over that at rest below which it is what stops a motion."""


def softness(model: Reduced, y: Array, strip: int) -> float:
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
    """A record: y, the bodies' rates and its energies, as of ``energy_consistent.store``."""
    bodies, strips = arrays.bodies, arrays.strips
    shape, local = arrays.shape, arrays.local
    y, rate, n = poses.y, poses.rate, shape.order.size
    own, modes = 2 * n - 6, strips.compliance.shape[1]
    kinetic = weight = 0.0
    for i in range(y.size):
        row[i] = y[i]
    for i in range(rate.size):
        row[y.size + i] = rate[i]
        kinetic += 0.5 * masses.inertia[i] * rate[i] * rate[i]
        weight -= bodies.weight[i] * y[i]
    for s in range(strips.roots.size):
        at = rate.size + s * (own + modes)
        dead = 0.0
        for i in range(2 * n):
            dead += abs(strips.numbers[s, ON_POINTS + i])
        if dead == 0.0:
            continue
        place_points(s, y[at : at + own], y, strips, local)
        for i in range(2 * n):
            weight -= strips.numbers[s, ON_POINTS + i] * local.nodal[s, POINTS, i]
    at = y.size + rate.size
    row[at], row[at + 1], row[at + 2] = kinetic, weight, poses.energy[0] - weight
    row[at + 3], row[at + 4] = poses.totals[0], poses.totals[1]


@kernel()
def _begin(poses, masses, arrays, row):
    """Energy, reactions and record of a state in equilibrium; returns the strips' residual."""
    copy(poses.y, poses.trial)
    norm = evaluate(True, poses, arrays)
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
        solved = solve(step, poses, masses, arrays, tolerance, counters)
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
    if motion.damped:
        expected = "strip_inertia with it: massless strips have no rate"
        raise InvalidParameter("effects", "strip_damping", expected)
    if any(any(spring.damping) and spring.other for spring in system.scene.of(Spring)):
        raise InvalidParameter("effects", "a damper between bodies", "strip_inertia for one in a motion")
    system.require_dead("effects", "strip_inertia")
    if motion.drives.row.size:
        raise InvalidParameter("effects", "a drive", "strip_inertia for a driven motion")
    if (motion.loads.coordinate >= system.layout.poses.start + 3 * len(system.scene.own_bodies)).any():
        expected = "strip_inertia for it: with massless strips loads act at centres of bodies"
        raise InvalidParameter("effects", "a load at a tip or point", expected)


class Stepper(Moves):
    """Bodies on massless strips that the scheme advances, from their part of the velocity."""

    name = NAME

    def __init__(self, start: Start) -> None:
        self.motion, system = start.motion, start.motion.system
        _require_known(self.motion)
        model, y = start.known.last or (reduced(system), None)
        if model is None:
            raise InvalidParameter("strips", "massless ones of this kind", "strip_inertia")
        y = from_unknowns(model, start.known.array[-1]) if y is None else y
        self._model = model = model.let_go(system)
        self._masses = Masses.of(self.motion, model)
        rate, moved = np.zeros((len(model.bodies.rest) // 3, 3)), model.system.layout.poses
        rate[: len(model.system.scene.bodies)] = start.v[moved].reshape(-1, 3) / model.system.scales.pose
        self._poses = Poses.of(y, rate.ravel(), self._masses, len(model.bodies.load))
        self.width = model.size + rate.size + ENERGIES
        self.counters = np.zeros(6, dtype=np.int64)
        self._arrays = model.arrays()

    def steps(self, time: float, step: float, begin: int, end: int, every: int, records: Array) -> int:
        """The number of the first step that fails."""
        given = self._poses, self._masses, self._arrays, TOLERANCE, self.counters
        return int(_run(time, step, begin, end, every, *given, records))

    def record(self) -> Array:
        """The present state's record (W,), in equilibrium."""
        record = np.zeros(self.width)
        self.counters[FACTORISATIONS] += 1
        if not _begin(self._poses, self._masses, self._arrays, record) < STILL:
            raise InvalidParameter("start", "no equilibrium of the strips", "a static state")
        return record

    def reason(self) -> str:
        """Why the last step was given up: where none folds, a strip that is soft by now snaps through."""
        model, y = self._model, self._poses.y
        scene, strips = model.system.scene, model.strips
        least = [softness(model, y, s) for s in range(len(strips.roots))]
        soft = int(np.argmin(least))
        if self.counters[REFUSED] == FOLDS or least[soft] > SOFT:
            return why(self.counters, scene, strips, y, soft)
        return (
            f"{scene.strips[soft].name} snaps through at {standing(scene, strips, y, soft)}: without "
            "mass it goes from equilibrium to equilibrium, and there is none to go on to; give the strips "
            "their inertia (strip_inertia)"
        )

    def unknowns(self, records: Array) -> tuple[Array, Array]:
        """Unknowns (R, N) and velocities (R, Q) of records."""
        model, size = self._model, len(self._poses.y)
        layout, count = model.system.layout, 3 * len(model.system.scene.bodies)
        v = np.zeros((len(records), layout.coordinate_count))
        v[:, layout.poses] = records[:, size : size + count] * np.tile(model.system.scales.pose, count // 3)
        y = np.ascontiguousarray(records[:, :size])
        return unknowns_of(model, y, np.zeros((len(y), 0))), v
