"""A path of a compiled scene on the strips' elements, as the bordered path would give it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from spline_model.effects import Stretching
from spline_model.newton import TOLERANCE
from spline_model.reduced.assembly import working_space
from spline_model.reduced.equilibrium import EVALUATIONS, HALVED, ITERATIONS
from spline_model.reduced.model import Reduced, from_unknowns
from spline_model.reduced.path import Answer, Route, empty_answer, follow
from spline_model.reduced.states import unknowns_of
from spline_model.solution import Path, Status

Array = NDArray[np.float64]


def follow_reduced(model: Reduced, load_factors: Sequence[float], start: tuple[float, Array]) -> Path | None:
    """The path from a stable equilibrium, load factor and unknowns (N,), through load factors.

    None where it does not reach its end, or meets a critical point: the bordered path says why.
    Of the rates those of bodies and drives are filled.
    """
    bodies, system = model.bodies, model.system
    drives = system.tables.drives
    length = np.where(drives.turns == 1, 1.0, model.length)
    route = Route(
        factor=np.array([start[0], *load_factors]),
        origin=drives.origin / length,
        target=drives.target / length,
        load=0.0,
        growth=1.0,
    )
    if len(route.factor) < 2 or (np.diff(route.factor) == 0.0).any():
        return None
    answer = empty_answer(len(route.factor), model.size, len(bodies.rest), len(bodies.held))
    done = follow(
        from_unknowns(model, start[1]),
        route,
        not system.scene.of(Stretching),
        bodies,
        model.strips,
        model.shape,
        model.local(),
        working_space(bodies, model.size),
        TOLERANCE,
        answer,
    )
    return _path_of(model, route.factor, answer, start[1]) if done == len(route.factor) else None


def _path_of(model: Reduced, factors: Array, answer: Answer, begin: Array) -> Path:
    """A complete answer in the scene's unknowns and in SI units; begin (N,): its first state, as given."""
    system, energy = model.system, model.energy
    layout, drives, loads = system.layout, system.tables.drives, system.tables.loads
    states = unknowns_of(model, answer, len(factors))
    states[0] = begin
    rates = np.zeros_like(states)
    for i, body in enumerate(system.scene.bodies):
        rates[:, layout.body(body.name)] = answer.rate[:, 3 * i : 3 * i + 3] * [
            model.length,
            model.length,
            1.0,
        ]
    rates[:, drives.row] = answer.reaction_rate * (energy / np.where(drives.turns == 1, 1.0, model.length))
    by_loads = factors * ((states - system.rest)[:, loads.coordinate] @ loads.value)
    counters = answer.counters
    return Path(
        status=Status.CONVERGED,
        message="",
        load_factor=factors,
        states=states,
        rates=rates,
        stiffness=answer.stiffness * energy,
        energies=answer.energies * energy,
        work=by_loads - by_loads[0] + answer.done * energy,
        inertia=answer.inertia,
        moment_defect=answer.defect,
        critical_points=(),
        counters={
            "increments": len(factors) - 1,
            "halved_increments": int(counters[HALVED]),
            "newton_iterations": int(counters[ITERATIONS]),
            "residual_evaluations": int(counters[EVALUATIONS]),
            "tangent_evaluations": int(counters[EVALUATIONS]),
            "factorisations": int(counters[EVALUATIONS]),
        },
        history=(),
    )
