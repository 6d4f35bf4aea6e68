"""The limit that each theory tends to, and the errors of what models answer.

`path_limits` and `swing_limits` are those of the comparison with other codes.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from studies.answers.adapters import answer_static
from studies.answers.metrics import swing_frequency
from studies.answers.motion import Motion
from studies.answers.reference import (
    MESHES,
    QUANTITIES,
    Reference,
    errors,
    limit_of,
    sampled,
    swing_reference,
)
from studies.answers.settings import FeSettings, SplineSettings
from studies.baselines.answer import Followed, SolvedMotion, SolvedPath
from studies.baselines.exudyn_strips import exudyn_ancf, exudyn_exact
from studies.baselines.openseespy import openseespy_frame
from studies.baselines.own import spline
from studies.baselines.variant import Baseline
from studies.cases.design import Design
from studies.cases.problem import Problem
from studies.kinds import Array
from studies.paper import formulations

#: Errors of a path and of a motion, as columns of tables.
PATH_ERRORS = [f"{kind}_{name}" for kind in ("error", "end") for name in QUANTITIES]
MOTION_ERRORS = ("error_rotation_rad", "error_frequency")


def path_errors(path: Any, against: SolvedPath | Reference) -> dict[str, float]:
    """Return the largest and the end errors of a whole path, NaN of one that stopped early and of what a
    model does not give.

    Keys: error_ with each of `QUANTITIES` (largest magnitude over the path), and the same with end_ for its
    last state.
    """
    nothing = dict.fromkeys(PATH_ERRORS, math.nan)
    if isinstance(path, Followed) and not path.converged:
        return nothing
    found = {name: np.abs(values) for name, values in errors(path, against).items()}
    largest = {f"error_{name}": float(values.max()) for name, values in found.items()}
    return nothing | largest | {f"end_{name}": float(values[-1]) for name, values in found.items()}


#: Control points of the spatial limit, and of the one below that says how uncertain it is.
SPATIAL = (15, 13)


@dataclass(frozen=True, kw_only=True)
class Limit:
    """The limit of a theory.

    Attributes:
        path: the limit; its times mean nothing.
        uncertainty: largest relative error of it over the path, of each of `QUANTITIES` [1].
        source: what it was taken from.
    """

    path: SolvedPath | Reference
    uncertainty: Mapping[str, float]
    source: str


def limit_of_theory(problem: Design, theory: str) -> Limit:
    """Return the limit of a theory on a problem.

    Material and shear: the elements' limit of refinement, which shares no code with the splines. Spatial: no
    elements have it, so a spline finer than any that is shown, and its distance to a coarser one.

    Raises:
        NoReference: the elements do not reach the end of the path.
    """
    if theory == "spatial":
        paper: dict[str, Any] = {"measure": theory, "stretch": "consistent"}
        fine, coarse = (spline.path(problem, 1, control_points=n, **paper) for n in SPATIAL)
        gap = path_errors(coarse, fine)
        return Limit(
            path=fine,
            uncertainty={name: gap[f"error_{name}"] for name in QUANTITIES},
            source=f"spline with {SPATIAL[0]} control points; its distance to one with {SPATIAL[1]}",
        )
    element = "corotational" if theory == "material" else "reissner"
    limit = limit_of([answer_static(problem, FeSettings(elements=n, element=element)) for n in MESHES])
    source = f"{element} elements, {', '.join(map(str, MESHES))} a strip, extrapolated"
    return Limit(path=limit, uncertainty=limit.uncertainty, source=source)


def at(motion: SolvedMotion | Motion, instants: Array) -> Array:
    """Return the rotation at `instants` [s] by cubic interpolation, NaN beyond the last record."""
    if len(motion.time) < 2:
        return np.full(len(instants), math.nan)
    return np.asarray(CubicSpline(motion.time, motion.rotation, extrapolate=False)(instants))


def motion_errors(motion: Any, rotation: Array, instants: Array) -> dict[str, float]:
    """Return the errors of a whole motion against a rotation (T,) at `instants`, NaN of one that stopped.

    Keys: `MOTION_ERRORS`, largest over the motion, and relative.
    """
    if not motion.converged:
        return dict.fromkeys(MOTION_ERRORS, math.nan)
    # a last record may fall short of the end by round-off
    gap = np.abs(at(motion, np.minimum(instants, motion.time[-1])) - rotation)
    frequency = swing_frequency(motion.time, motion.rotation).value
    exact = swing_frequency(instants, rotation).value
    values = (float(gap.max()), abs(frequency / exact - 1.0))
    return dict(zip(MOTION_ERRORS, values, strict=True))


def errors_of(path: SolvedPath, limit: SolvedPath | Reference) -> dict[str, float]:
    """Return the largest errors over a path, the torque's at its end, and the worst of both."""
    found = path_errors(path, limit)
    largest = {name: found[f"error_{name}"] for name in ("trajectory", "torque")}
    return largest | {"torque_at_end": found["end_torque"], "worst": max(largest.values())}


#: Theories of the rod in the comparison with other codes.
WITHOUT_SHEAR, WITH_SHEAR = "without shear", "with shear"
#: Control points of the limit without shear, and those whose difference is its uncertainty.
REFINED, CHECK = 14, 12
#: Finest settings of the other codes, for the limits that they tend to by themselves.
FINEST: dict[Baseline, dict[str, Any]] = {
    exudyn_ancf: {"elements": 64, "relative_tolerance": 1e-9},
    exudyn_exact: {"elements": 64, "relative_tolerance": 1e-10},
    openseespy_frame: {"elements": 320, "tolerance": 1e-14},
}


def path_limits(problem: Problem) -> tuple[dict[str, SolvedPath | Reference], list[dict[str, Any]]]:
    """Return the limit of either theory, and rows of how certain they are and how far they are apart.

    Without shear it is a refined spline; with shear that of this repository's Reissner elements.
    """
    turns = np.linspace(0.0, problem.rotation, problem.increments + 1)
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
        {"what": what, "theory": theory, "trajectory": off["trajectory"], "torque": off["torque"]}
        for what, theory, off in told
    ]


#: The same of the swing.
SWING_REFINED, SWING_CHECK = 10, 8
#: Meshes of the limit with shear, a third apart: linear elements, whose waves need finer ones.
SHEAR_MESHES = (36, 54, 81, 121)
#: What the other codes' rods with shear have beside it.
ROTARY = "section_rotary_inertia"


def swing_limits(problem: Problem) -> tuple[dict[str, Array], list[dict[str, Any]]]:
    """Return the rotation of either theory at the common instants, with rows of how certain they are."""
    refined, check = (
        sampled(formulations.resolved(SplineSettings(control_points=n)), formulations.INSTANTS).rotation
        for n in (SWING_REFINED, SWING_CHECK)
    )
    with_rotary = replace(problem, effects=problem.effects.renamed([*problem.effects.names, ROTARY]))
    reissner = swing_reference(
        with_rotary,
        duration=formulations.DURATION,
        instants=formulations.INSTANTS,
        meshes=SHEAR_MESHES,
        element="reissner",
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
