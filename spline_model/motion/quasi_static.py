"""Massless strips under bodies with mass: only the bodies' coordinates are dynamic (``motion.massless``)."""

from __future__ import annotations

import numpy as np

from spline_model.compile import System
from spline_model.errors import InvalidParameter
from spline_model.motion import energy_consistent
from spline_model.motion.arrays import masses_of, poses_of
from spline_model.motion.energy_consistent import SMALLEST_STEP
from spline_model.motion.massless import run, settle
from spline_model.motion.records import MOST_GAIN, rows_of
from spline_model.motion.start import Array, Motion, Records
from spline_model.reduced.assembly import working_space
from spline_model.reduced.model import Reduced, from_unknowns, reduced
from spline_model.reduced.states import unknowns_of

TOLERANCE = 1e-11
"""Residual of a step in EI/L^2, EI/L and L."""


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
    return energy_consistent.carry(Stepper(model, motion, z, v), z, step, steps, every)


class Stepper:
    """Bodies on massless strips that the scheme advances; as ``energy_consistent.Stepper``."""

    most_gain = MOST_GAIN

    def __init__(self, model: Reduced, motion: Motion, z: Array, v: Array) -> None:
        self.motion, self._model, scene = motion, model, model.system.scene
        self._masses = masses_of(model.system, motion, len(model.bodies.rest))
        rate = np.zeros(len(model.bodies.rest))
        for i, body in enumerate(scene.bodies):
            rate[3 * i : 3 * i + 3] = v[model.system.layout.body(body.name)] / self._unit
        self._poses = poses_of(from_unknowns(model, z), rate, len(model.bodies.load))
        self._local, self._space = model.local(), working_space(model.bodies, model.size)
        self.counters = np.zeros(6, dtype=np.int64)
        made = self._masses, model.bodies, model.strips, model.shape, self._local, self._space
        self._given = (self._poses, *made, TOLERANCE, self.counters)
        if not settle(*self._given):
            raise InvalidParameter("start", "no equilibrium of the strips", "a static state")

    @property
    def _unit(self) -> Array:
        return np.array([self._model.length, self._model.length, 1.0])

    def advance(self, time: float, duration: float, smallest: float) -> float:
        """Advance by a step of ``duration``, halved at need down to ``smallest`` of it; the time done."""
        return duration * self._run(time, duration, 0, 1, 2, duration * smallest)[0]

    def run(self, step: float, begin: int, end: int, every: int) -> tuple[int, tuple[Array, Array, Array]]:
        """Take the steps ``begin`` ... ``end`` - 1; the next step's number, and records as of ``look``."""
        done, records = self._run(0.0, step, begin, end, every, step * SMALLEST_STEP)
        kept = done // every - begin // every
        return done, self._shown(*(record[:kept] for record in records))

    def _run(
        self, time: float, step: float, begin: int, end: int, every: int, smallest: float
    ) -> tuple[int, list[Array]]:
        """The next step's number, and states, rates and books of the records."""
        bodies, poses = len(self._model.system.scene.bodies), self._poses
        count = end // every - begin // every
        records = [np.zeros((count, k)) for k in (len(poses.y), len(poses.rate), 3)]
        return int(run(time, step, begin, end, every, smallest, bodies, *self._given, *records)), records

    def look(self) -> tuple[Array, Array, Array]:
        """Unknowns (1, N), velocities (1, Q) and row (1, 7) of the present state."""
        poses = self._poses
        books = np.array([[poses.energy[0], *poses.totals]])
        return self._shown(poses.y[None], poses.rate[None], books)

    def switch(self, time: float, span: float) -> None:
        """Nothing begins or ends but loads."""

    def _shown(self, y: Array, rates: Array, books: Array) -> tuple[Array, Array, Array]:
        model = self._model
        z = unknowns_of(model, y, np.zeros((len(y), 0)))
        v = np.zeros((len(y), model.system.layout.coordinate_count))
        for i, body in enumerate(model.system.scene.bodies):
            v[:, model.system.layout.body(body.name)] = rates[:, 3 * i : 3 * i + 3] * self._unit
        energies, weight = books * model.energy, model.system.tables.weight
        if weight.size:
            energies[:, 0] += z[:, : weight.size] @ weight  # W less the weight's potential
        return z, v, rows_of(self.motion, z, v, energies)
