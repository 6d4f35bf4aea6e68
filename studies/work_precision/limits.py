"""The limit that each theory tends to, and the errors and work of what models answer."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from studies.answers.adapters import answer_static
from studies.answers.metrics import swing_frequency
from studies.answers.motion import Motion
from studies.answers.reference import MESHES, QUANTITIES, Reference, errors, limit_of
from studies.answers.settings import FeSettings
from studies.baselines.answer import Followed, SolvedMotion, SolvedPath
from studies.baselines.own import spline
from studies.cases.design import Design
from studies.kinds import Array

#: Names of columns of work in the counters of a baseline, where they differ.
THEIRS = {"iterations": "newton_iterations"}
#: Errors of a path and of a motion, as columns of tables.
PATH_ERRORS = [f"{kind}_{name}" for kind in ("error", "end") for name in QUANTITIES]
MOTION_ERRORS = ("error_rotation_rad", "end_rotation_rad", "error_frequency")


def counted(columns: Iterable[str], work: Mapping[str, float]) -> dict[str, float]:
    """Return the columns of work from a model's counters, NaN of those that it does not count."""
    return {name: float(work.get(name, work.get(THEIRS.get(name, ""), math.nan))) for name in columns}


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
        fine, coarse = (spline.path(problem, 1, control_points=n, measure=theory) for n in SPATIAL)
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

    Keys: `MOTION_ERRORS`, largest over the motion, at its end, and relative.
    """
    if not motion.converged:
        return dict.fromkeys(MOTION_ERRORS, math.nan)
    # a last record may fall short of the end by round-off
    gap = np.abs(at(motion, np.minimum(instants, motion.time[-1])) - rotation)
    frequency = swing_frequency(motion.time, motion.rotation).value
    exact = swing_frequency(instants, rotation).value
    values = (float(gap.max()), float(gap[-1]), abs(frequency / exact - 1.0))
    return dict(zip(MOTION_ERRORS, values, strict=True))
