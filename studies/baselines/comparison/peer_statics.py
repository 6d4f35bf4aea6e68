"""Static paths of the spline and of other codes: errors against the limit of each one's theory, and times."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from studies.answers.adapters import answer_static
from studies.answers.metrics import relative_error, trajectory_error
from studies.answers.reference import MESHES, limit_of
from studies.answers.settings import FeSettings
from studies.baselines import spline
from studies.baselines.comparison.variants import (
    WITH_SHEAR,
    WITHOUT_SHEAR,
    Variant,
    static_variants,
    tried,
)
from studies.baselines.peers import exudyn_ancf, exudyn_exact, openseespy_frame
from studies.cases.problem import Problem
from studies.kinds import Array

#: Control points of the limit without shear, and those whose difference is its uncertainty.
REFINED, CHECK = 14, 12
#: Finest settings of the other codes, for the limits that they tend to by themselves.
FINEST: dict[Any, dict[str, Any]] = {
    exudyn_ancf: {"elements": 64, "relative_tolerance": 1e-9},
    exudyn_exact: {"elements": 64, "relative_tolerance": 1e-10},
    openseespy_frame: {"elements": 320, "tolerance": 1e-14},
}
#: Timed solves of a path in a pass.
REPEAT = 9

ERRORS = ("trajectory", "torque", "torque_at_end", "worst")


@dataclass(frozen=True, kw_only=True)
class Limit:
    """What a path is held against: centre (S, 2) [m] and torque (S,) [N m]."""

    centre: Array
    torque: Array

    def errors(self, centre: Array, torque: Array) -> dict[str, float]:
        """Return the largest errors over the path, the torque's at its end, and the worst of both."""
        trajectory = float(trajectory_error(centre, self.centre).max())
        by_state = np.abs(relative_error(torque[1:], self.torque[1:]))  # at rest there is none
        return {
            "trajectory": trajectory,
            "torque": float(by_state.max()),
            "torque_at_end": float(by_state[-1]),
            "worst": max(trajectory, float(by_state.max())),
        }


def rotations(problem: Problem) -> Array:
    """Return the states of the case's path [rad]."""
    return np.linspace(0.0, problem.rotation, problem.increments + 1)


def limits(problem: Problem) -> tuple[dict[str, Limit], list[dict[str, Any]]]:
    """Return the limit of either theory, and rows of how certain they are and how far they are apart.

    Without shear it is a refined spline; with shear that of this repository's Reissner elements.
    """
    turns = rotations(problem)
    refined = spline.static_path(problem, turns, control_points=REFINED)
    check = spline.static_path(problem, turns, control_points=CHECK)
    reissner = limit_of([answer_static(problem, FeSettings(elements=n, element="reissner")) for n in MESHES])
    found = {
        WITHOUT_SHEAR: Limit(centre=refined.centre, torque=refined.torque),
        WITH_SHEAR: Limit(centre=reissner.centre, torque=reissner.torque),
    }
    unsure = {name: reissner.uncertainty[name] for name in ("trajectory", "torque")}
    apart = found[WITH_SHEAR].errors(refined.centre, refined.torque)
    rows = [
        _row("uncertainty", WITHOUT_SHEAR, found[WITHOUT_SHEAR].errors(check.centre, check.torque)),
        _row("uncertainty", WITH_SHEAR, unsure),
        _row("difference of the theories", "", apart),
    ]
    for module, settings in FINEST.items():
        if not module.installed():
            continue
        theory = WITH_SHEAR if module is exudyn_exact else WITHOUT_SHEAR
        path = module.static_path(problem, turns, **settings)
        away = found[theory].errors(path.centre, path.torque)
        rows.append(_row(f"{module.MODEL}, {settings['elements']} elements", theory, away))
    return found, rows


def compared(
    problem: Problem, against: dict[str, Limit]
) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
    """Return errors and work, and times, a row a variant."""
    turns = rotations(problem)

    def solve(variant: Variant) -> tuple[dict[str, Any], float]:
        path = variant.module.static_path(problem, turns, repeat=REPEAT, **variant.settings)
        return against[variant.theory].errors(path.centre, path.torque) | dict(path.work), path.solve_s

    return tried(static_variants(), solve, ERRORS)


def _row(what: str, theory: str, errors: dict[str, float]) -> dict[str, Any]:
    return {"what": what, "theory": theory} | {name: errors[name] for name in ("trajectory", "torque")}
