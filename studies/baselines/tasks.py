"""Path and swing of the spline and of other codes: errors against the limit of each theory, and times."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from studies.answers.adapters import answer_release
from studies.answers.reference import RECORDS, Reference, limit_of_swings, sampled
from studies.answers.settings import FeSettings, SplineSettings
from studies.baselines.answer import Followed, SolvedPath
from studies.baselines.exudyn_strips import exudyn_ancf, exudyn_exact
from studies.baselines.openseespy import openseespy_frame
from studies.baselines.own import spline
from studies.baselines.variant import Baseline, Variant
from studies.baselines.variants import NAMES, STATIC, SWINGS, WITH_SHEAR, WITHOUT_SHEAR, tried
from studies.cases.problem import Problem
from studies.kinds import Array
from studies.paper import formulations
from studies.work_precision.limits import limit_of_theory, path_errors

Rows = list[dict[str, Any]]

#: Control points of the limit without shear, and those whose difference is its uncertainty.
REFINED, CHECK = 14, 12
#: Finest settings of the other codes, for the limits that they tend to by themselves.
FINEST: dict[Baseline, dict[str, Any]] = {
    exudyn_ancf: {"elements": 64, "relative_tolerance": 1e-9},
    exudyn_exact: {"elements": 64, "relative_tolerance": 1e-10},
    openseespy_frame: {"elements": 320, "tolerance": 1e-14},
}
#: Timed solves of a path in a pass.
REPEAT = 5

PATH_ERRORS = ("trajectory", "torque", "torque_at_end", "worst", "fineness")
WORK = ("unknowns", "newton_iterations", "factorisations")


def errors_of(path: SolvedPath, limit: SolvedPath | Reference) -> dict[str, float]:
    """Return the largest errors over a path, the torque's at its end, and the worst of both."""
    found = path_errors(path, limit)
    largest = {name: found[f"error_{name}"] for name in ("trajectory", "torque")}
    return largest | {"torque_at_end": found["end_torque"], "worst": max(largest.values())}


def _rotations(problem: Problem) -> Array:
    """Return the states of the case's path [rad]."""
    return np.linspace(0.0, problem.rotation, problem.increments + 1)


def path_limits(problem: Problem) -> tuple[dict[str, SolvedPath | Reference], Rows]:
    """Return the limit of either theory, and rows of how certain they are and how far they are apart.

    Without shear it is a refined spline; with shear that of this repository's Reissner elements.
    """
    turns = _rotations(problem)
    refined = spline.static_path(problem, turns, control_points=REFINED)
    check = spline.static_path(problem, turns, control_points=CHECK)
    reissner = limit_of_theory(problem, "shear")
    found = {WITHOUT_SHEAR: refined, WITH_SHEAR: reissner.path}
    told = [
        ("uncertainty", WITHOUT_SHEAR, errors_of(check, refined)),
        ("uncertainty", WITH_SHEAR, reissner.uncertainty),
        ("difference of the theories", "", errors_of(refined, reissner.path)),
    ]
    for module, settings in FINEST.items():
        if not module.installed():
            continue
        theory = WITH_SHEAR if module.sheared else WITHOUT_SHEAR
        path = module.static_path(problem, turns, **settings)
        away = errors_of(path, found[theory])
        told.append((f"{module.model}, {settings['elements']} elements", theory, away))
    return found, [
        {"what": what, "theory": theory, "trajectory": errors["trajectory"], "torque": errors["torque"]}
        for what, theory, errors in told
    ]


def compared_paths(problem: Problem, against: Mapping[str, SolvedPath | Reference]) -> tuple[Rows, Rows]:
    """Return errors and work, and times, a row a variant."""
    turns = _rotations(problem)

    def solve(variant: Variant) -> tuple[dict[str, Any], Followed]:
        path = variant.baseline.static_path(problem, turns, **variant.settings)
        work = {name: path.work.get(name, np.nan) for name in WORK}
        found = errors_of(path, against[NAMES[variant.theory]])
        fineness = float(variant.count) if variant.settings else np.nan  # a closed form has none
        return found | {"fineness": fineness} | work, path

    return tried(STATIC, solve, PATH_ERRORS, judged="worst", repeat=REPEAT)


#: The same of the swing.
SWING_REFINED, SWING_CHECK = 10, 8
#: Meshes of the limit with shear, a third apart: linear elements, whose waves need finer ones.
SHEAR_MESHES = (36, 54, 81, 121)
#: What the other codes' rods with shear have beside it.
ROTARY = "section_rotary_inertia"
SWING_ERRORS = ("rotation_rad", "uncertainty_rad", "step_s", "fineness")


def swing_limits(problem: Problem) -> tuple[dict[str, Array], Rows]:
    """Return the rotation of either theory at the common instants, with rows of how certain they are."""
    refined, check = (
        sampled(formulations.resolved(SplineSettings(control_points=n)), formulations.INSTANTS).rotation
        for n in (SWING_REFINED, SWING_CHECK)
    )
    with_rotary = replace(problem, effects=problem.effects.renamed([*problem.effects.names, ROTARY]))
    reissner = limit_of_swings(
        [
            answer_release(
                with_rotary,
                FeSettings(elements=n, element="reissner"),
                duration=formulations.DURATION,
                records=RECORDS,
            )
            for n in SHEAR_MESHES
        ],
        formulations.INSTANTS,
    )
    told = (
        ("uncertainty", WITHOUT_SHEAR, np.abs(check - refined)),
        ("uncertainty", WITH_SHEAR, reissner.uncertainty),
        ("difference of the theories", "", np.abs(reissner.swing.rotation - refined)),
    )
    rows = [
        {"what": what, "theory": theory, "rotation_rad": float(error.max())} for what, theory, error in told
    ]
    return {WITHOUT_SHEAR: refined, WITH_SHEAR: reissner.swing.rotation}, rows


def compared_swings(
    problem: Problem, against: dict[str, Array], uncertainty: Mapping[str, float]
) -> tuple[Rows, Rows]:
    """Return errors with the uncertainty of their limit and work, and times, a row a variant."""

    def solve(variant: Variant) -> tuple[dict[str, Any], Followed]:
        motion = variant.baseline.release(
            problem,
            start=problem.rotation,
            duration=formulations.DURATION,
            **variant.settings,
        )
        theory = NAMES[variant.theory]
        unsure = float(uncertainty[theory])
        work = {name: motion.work.get(name, np.nan) for name in ("steps", "newton_iterations")}
        rotation = CubicSpline(motion.time, motion.rotation)(formulations.INSTANTS)
        apart = float(np.abs(rotation - against[theory]).max())
        step = variant.settings["step"]
        errors = {"rotation_rad": apart, "uncertainty_rad": unsure, "step_s": step, "fineness": -step}
        return errors | work, motion

    return tried(SWINGS, solve, SWING_ERRORS, judged="rotation_rad", repeat=1)
