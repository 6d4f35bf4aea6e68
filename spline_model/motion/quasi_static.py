"""Massless strips under bodies with mass: only the bodies' coordinates are dynamic (``motion.massless``)."""

from __future__ import annotations

import numpy as np
from scipy.linalg import eigh

from spline_model.compile import System
from spline_model.errors import InvalidParameter
from spline_model.motion import energy_consistent
from spline_model.motion.arrays import masses_of, poses_of
from spline_model.motion.energy_consistent import turned, why
from spline_model.motion.massless import settle
from spline_model.motion.massless_run import run, store
from spline_model.motion.records import ENERGIES, Records
from spline_model.motion.start import Array, Motion
from spline_model.motion.step import FOLDS, REFUSED
from spline_model.reduced.assembly import working_space
from spline_model.reduced.model import Reduced, at_rest, from_unknowns, reduced
from spline_model.reduced.states import unknowns_of
from spline_model.reduced.whole import whole_tangents

TOLERANCE = 1e-11
"""Residual of a step in EI/L^2, EI/L and L."""
LEAST = 1e-9
"""Compliance in L^2/EI that stands for none where the stiffness of strips is asked for."""
SOFT = 0.5
"""Least stiffness of a strip over that at rest below which it is what stops a motion."""


def integrate(
    system: System, motion: Motion, z: Array, v: Array, *, step: float, steps: int, every: int
) -> Records:
    """Take ``steps`` steps from z and the bodies' part of v, recording every ``every``-th one."""
    if motion.damped:
        raise InvalidParameter(
            "effects", "strip_damping", "strip_inertia with it: massless strips have no rate"
        )
    if system.tables.drives.row.size:
        raise InvalidParameter("effects", "a drive", "strip_inertia for a driven motion")
    bodies = {at + k for at in system.layout.bodies.values() for k in range(3)}
    if not bodies.issuperset(system.tables.loads.coordinate.tolist()):
        raise InvalidParameter("effects", "tip_force", "loads on bodies only, with massless strips")
    model = reduced(system)
    if model is None:
        raise InvalidParameter(
            "strips", "massless ones of this kind", "strip_inertia for printed forces or long B-splines"
        )
    return energy_consistent.carry(Stepper(model, motion, z, v), None, step, steps, every)


def softness(model: Reduced, y: Array, strip: int) -> float:
    """Least stiffness of a strip between held ends at a state y (Y,), over that at rest in the same shape.

    Over all shapes of its own coordinates: 0 where it buckles or snaps through, below where it is unstable.
    """
    w, a = model.places(strip)
    parts = []
    for hessian in whole_tangents(model, np.array([y, at_rest(model)]))[1]:
        coupling = hessian[a, w]
        compliance = -hessian[a, a] + LEAST * np.eye(len(coupling))
        parts.append(hessian[w, w] + coupling.T @ np.linalg.solve(compliance, coupling))
    return float(eigh(*parts, eigvals_only=True)[0])


class Stepper(energy_consistent.Moves):
    """Bodies on massless strips that the scheme advances."""

    def __init__(self, model: Reduced, motion: Motion, z: Array, v: Array) -> None:
        self.motion, self._model, scene = motion, model, model.system.scene
        self._masses = masses_of(model.system, motion, len(model.bodies.rest))
        self.unit = np.array([model.length, model.length, 1.0])
        rate = np.zeros(len(model.bodies.rest))
        for i, body in enumerate(scene.bodies):
            rate[3 * i : 3 * i + 3] = v[model.system.layout.body(body.name)] / self.unit
        self._poses = poses_of(from_unknowns(model, z), rate, self._masses.inertia, len(model.bodies.load))
        self._local, self._space = model.local(), working_space(model.bodies, model.size)
        self.width = model.size + len(rate) + ENERGIES
        self.counters = np.zeros(6, dtype=np.int64)
        made = self._masses, model.bodies, model.strips, model.shape, self._local, self._space
        self._given = (self._poses, *made, TOLERANCE, self.counters)
        if not settle(*self._given):
            raise InvalidParameter("start", "no equilibrium of the strips", "a static state")

    def take(
        self, time: float, step: float, begin: int, end: int, every: int, smallest: float, records: Array
    ) -> int:
        """The next step's number."""
        bodies = len(self._model.system.scene.bodies)
        return int(run(time, step, begin, end, every, smallest, bodies, *self._given, records))

    def record(self) -> Array:
        """The present state's record (W,)."""
        record, model = np.zeros(self.width), self._model
        store(self._poses, self._masses, model.bodies, model.strips, model.shape, self._local, record)
        return record

    def switch(self, time: float, span: float) -> None:
        """Nothing begins or ends but loads."""

    def reason(self) -> str:
        """Why the last step was given up: where none folds, a strip that is soft by now snaps through."""
        model, y = self._model, self._poses.y
        scene, strips = model.system.scene, model.strips
        least = [softness(model, y, s) for s in range(len(strips.roots))]
        soft = int(np.argmin(least))
        if self.counters[REFUSED] == FOLDS or least[soft] > SOFT:
            return why(self.counters, scene, strips, y, soft)
        return (
            f"{scene.strips[soft].name} snaps through at {turned(scene, strips, y, soft)}: without "
            "mass it goes from equilibrium to equilibrium, and there is none to go on to; give the strips "
            "their inertia (strip_inertia)"
        )

    def unknowns(self, records: Array) -> tuple[Array, Array]:
        """Unknowns (R, N) and velocities (R, Q) of records."""
        model, size = self._model, len(self._poses.y)
        v = np.zeros((len(records), model.system.layout.coordinate_count))
        for i, body in enumerate(model.system.scene.bodies):
            begin = size + 3 * i
            v[:, model.system.layout.body(body.name)] = records[:, begin : begin + 3] * self.unit
        y = np.ascontiguousarray(records[:, :size])
        return unknowns_of(model, y, np.zeros((len(y), 0))), v
