"""What paths are held against: the limit of each theory, and how uncertain it is."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from studies.answers.adapters import answer_static
from studies.answers.reference import MESHES, limit_of
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.problem import Problem
from studies.work_precision.paths import SolvedPath, of_settings, path_errors, unsolved

#: Theories of a strip, by what their energies are measured in.
THEORIES = {
    "material": "bending per reference length, no shear",
    "spatial": "bending per current length, as the paper's Eq 10, no shear",
    "shear": "bending per reference length, with shear",
}
#: Control points of the spatial limit, and of the one below that says how uncertain it is.
SPATIAL = (15, 13)


@dataclass(frozen=True, kw_only=True)
class Limit:
    """The limit of a theory.

    Attributes:
        path: the limit; its times mean nothing.
        uncertainty: largest relative error of it over the path, of trajectory, torque and stiffness [1].
        source: what it was taken from.
    """

    path: SolvedPath
    uncertainty: Mapping[str, float]
    source: str


def limit_of_theory(problem: Problem, theory: str) -> Limit:
    """Return the limit of a theory on a problem.

    Material and shear: the elements' limit of refinement, which shares no code with the splines. Spatial: no
    elements have it, so a spline finer than any that is shown, and its distance to a coarser one.

    Raises:
        NoReference: the elements do not reach the end of the path.
    """
    if theory == "spatial":
        return _spatial(problem)
    element = "corotational" if theory == "material" else "reissner"
    answers = [answer_static(problem, FeSettings(elements=count, element=element)) for count in MESHES]
    limit = limit_of(answers)
    return Limit(
        path=_path(limit.centre, limit.torque, limit.stiffness),
        uncertainty=limit.uncertainty,
        source=f"{element} elements, {', '.join(map(str, MESHES))} a strip, extrapolated",
    )


def _spatial(problem: Problem) -> Limit:
    fine, coarse = (
        of_settings(SplineSettings(control_points=n, measure="spatial"), "", n).solve(problem, 1)
        for n in SPATIAL
    )
    gap = path_errors(coarse, fine)
    return Limit(
        path=fine,
        uncertainty={name: gap[f"error_{name}"] for name in ("trajectory", "torque", "stiffness")},
        source=f"spline with {SPATIAL[0]} control points; its distance to one with {SPATIAL[1]}",
    )


def _path(centre: np.ndarray, torque: np.ndarray, stiffness: np.ndarray) -> SolvedPath:
    """Return arrays as a path that is whole."""
    empty = unsolved("")
    return SolvedPath(
        status="converged",
        message="",
        centre=centre,
        torque=torque,
        stiffness=stiffness,
        solve_s=empty.solve_s,
        wall_s=empty.wall_s,
        work=empty.work,
    )
