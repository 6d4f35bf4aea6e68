"""Stretches of a path on the strips' elements along which nothing happens, compiled."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from spline_model.newton import TOLERANCE
from spline_model.reduced.assembly import Bodies, working_space
from spline_model.reduced.elements import Elements
from spline_model.reduced.equilibrium import CONFIRMED, EVALUATIONS, HALVED, ITERATIONS
from spline_model.reduced.many import Share, follow_all
from spline_model.reduced.model import at_rest
from spline_model.reduced.path import Answer, Route, empty_answer
from spline_model.strip.element import Strips

Array = NDArray[np.float64]

ALONE = Share.none()


def run(work: Elements, load_factors: Array, start: Array) -> Answer:
    """The states from ``start`` (Y,) at the first load factor on, until stability or a check ends it."""
    target = work.model.drives[1]
    return _run(work, load_factors, target, start, work.model.bodies, work.model.strips, swells=False)


def grown(work: Elements) -> Array | None:
    """The state (Y,) under all weight and pre-strain, grown from nothing; None where something happens."""
    shares = np.array([0.0, 1.0])
    answer = _run(work, shares, 0.0 * work.model.drives[1], at_rest(work.model), *work.loose, swells=True)
    return answer.y[1] if len(answer.y) == 2 else None


def _run(
    work: Elements,
    factors: Array,
    target: Array,
    start: Array,
    bodies: Bodies,
    strips: Strips,
    *,
    swells: bool,
) -> Answer:
    model, count = work.model, work.counters
    answer = empty_answer(len(factors), model.size, len(bodies.held))
    route = Route(factors, model.drives[0], target, 0.0 if swells else 1.0, swells)
    parts = bodies, strips, model.shape, work.local, working_space(bodies, model.size)
    done = follow_all(ALONE, start, route, work.judged, work.preload, *parts, TOLERANCE, answer)
    count.halved_increments += int(answer.counters[HALVED])
    count.newton_iterations += int(answer.counters[ITERATIONS])
    evaluations = int(answer.counters[EVALUATIONS])
    count.residual_evaluations += evaluations + int(answer.counters[CONFIRMED])
    count.tangent_evaluations += evaluations
    count.factorisations += evaluations
    return answer.rows(slice(done))
