"""Gradients of a sizing question held against differences of its answers."""

import numpy as np

from studies.design.optimise import Programme
from tests.models import extrapolated

#: First step of differences, of a variable's bounds, and how often it is halved.
STEP, LEVELS = 0.01, 4


def gradient_error(task, values, levels=LEVELS):
    """Return the largest error of the gradients that the optimiser is given at a design (N,), against
    differences [1].

    Central differences of halved steps, extrapolated; relative to the largest derivative of the same rows by
    any variable, over the bounds.
    """
    programme = Programme(question=task)
    y = np.append(task.scaled(values), 1.0)
    exact = programme.rows(y)[1]
    errors = np.zeros_like(exact)
    for i, unit in enumerate(np.eye(len(y))):
        found = []
        for step in (STEP / 2**level * unit for level in range(levels)):
            up, down = (programme.rows(each)[0] for each in (y + step, y - step))
            found.append((up - down) / (2.0 * step[i]))
        errors[:, i] = np.abs(exact[:, i] - extrapolated(found))
    limits = programme.limits(y, programme.answers(y))
    names = np.array([name for rows in limits for name in [rows.name] * len(rows.margin)])
    parts = [(errors[names == name].max(), np.abs(exact[names == name]).max()) for name in set(names)]
    return float(max(error / largest for error, largest in parts if largest > 0.0))
