"""The limit that each theory of the rod tends to, which models of it are held against."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from studies.answers.adapters import answer_release
from studies.answers.metrics import swing_frequency
from studies.answers.reference import MESHES, QUANTITIES, NoReference, errors, reference, swing_reference
from studies.answers.settings import SplineSettings
from studies.cases.design import Design
from studies.cases.problem import Problem
from studies.cost.own import spline
from studies.engine import Row
from studies.kinds import Array

#: Theories of a strip, by what their energies are measured in: bending per reference length without shear,
#: per current length as the paper's Eq 10, and per reference length with shear.
MATERIAL, SPATIAL, SHEAR = "material", "spatial", "shear"
#: Control points of the spatial limit, and of the one below that says how uncertain it is.
SPATIAL_POINTS = (15, 13)


@dataclass(frozen=True, kw_only=True)
class Limit:
    """The limit of a theory: what was found, its uncertainty by quantity, and what it was taken from."""

    found: Any
    uncertainty: dict[str, float]
    source: str


def largest_errors(path: Any, against: Any) -> dict[str, float]:
    """Return the largest magnitude of each error over a path [1], of what both give."""
    return {name: float(np.abs(values).max()) for name, values in errors(path, against).items()}


def path_limit(design: Design, theory: str) -> Limit:
    """Return the limit of a theory on the path of a design.

    Material and shear: the elements' limit of refinement, which shares no code with the splines. Spatial: no
    elements have it, so a spline finer than any that is shown, and its distance to a coarser one.

    Raises:
        NoReference: the elements do not reach the end of the path.
    """
    if theory == SPATIAL:
        paper: dict[str, Any] = {"measure": theory, "stretch": "consistent"}
        fine, coarse = (spline.path(design, control_points=n, **paper) for n in SPATIAL_POINTS)
        source = "spline with {} control points; its distance to one with {}".format(*SPATIAL_POINTS)
        return Limit(found=fine, uncertainty=largest_errors(coarse, fine), source=source)
    element = "corotational" if theory == MATERIAL else "reissner"
    limit = reference(design, element)
    source = f"{element} elements, {', '.join(map(str, MESHES))} a strip, extrapolated"
    return Limit(found=limit, uncertainty=dict(limit.uncertainty), source=source)


def path_limits(design: Design) -> tuple[dict[str, Limit], list[Row]]:
    """Return the limits of all theories, and rows of how certain they are and how far apart."""
    limits = {theory: path_limit(design, theory) for theory in (MATERIAL, SPATIAL, SHEAR)}
    rows = [
        {
            "theory": theory,
            "quantity": name,
            "uncertainty": limit.uncertainty[name],
            "distance_to_material": largest_errors(limit.found, limits[MATERIAL].found)[name],
            "source": limit.source,
        }
        for theory, limit in limits.items()
        for name in QUANTITIES
    ]
    return limits, rows


#: Control points and steps [s] of the splines that are the limit of a swing, the finer one first.
SWINGS = {16: 3e-7, 14: 4e-7}
#: Records of these: the strips' own oscillations are some 40 times as fast as the swing, and cubic
#: interpolation between so many errs by less than 1e-6 rad.
RECORDS = 4000
#: Meshes of the limit with shear, a third apart: linear elements, whose waves need finer ones.
SHEAR_MESHES = (36, 54, 81, 121)
#: What the other codes' rods with shear have beside it.
ROTARY = "section_rotary_inertia"


def at(motion: Any, instants: Array) -> Array:
    """Return the rotation at `instants` [s] by cubic interpolation.

    A last record may fall short of the last instant by round-off.
    """
    spline_of = CubicSpline(motion.time, motion.rotation)
    return np.asarray(spline_of(np.minimum(instants, motion.time[-1])))


def frequency_error(rotation: Array, limit: Array, instants: Array) -> float:
    """Return the relative error of the frequency of the swing [1]."""
    found, right = (swing_frequency(instants, each).value for each in (rotation, limit))
    return abs(found / right - 1.0)


def swing_limit(design: Design, instants: Array, integrator: str, steps: dict[int, float | None]) -> Limit:
    """Return the swing without shear, by the finest splines: control points and steps, the finer one first.

    Raises:
        NoReference: one of them stops early.
    """
    found = []
    for n, step in steps.items():
        motion = answer_release(
            *(design, SplineSettings(control_points=n)),
            duration=float(instants[-1]), records=RECORDS, integrator=integrator, step=step,
        )  # fmt: skip
        if not motion.converged:
            raise NoReference(f"reference with {n} control points: {motion.message}")
        found.append(at(motion, instants))
    fine, coarse = found
    uncertainty = {
        "rotation": float(np.abs(fine - coarse).max()),
        "frequency": frequency_error(coarse, fine, instants),
    }
    told = (f"n = {n}" + (f" at {1e6 * step:g} µs" if step else "") for n, step in steps.items())
    return Limit(found=fine, uncertainty=uncertainty, source=" and ".join(told))


def swing_limits(problem: Problem, instants: Array) -> tuple[dict[str, Limit], list[Row]]:
    """Return the rotation of either theory at the instants, with rows of how certain they are."""
    material = swing_limit(problem, instants, "leapfrog", dict(SWINGS))
    with_rotary = replace(problem, effects=problem.effects.renamed([*problem.effects.names, ROTARY]))
    reissner = swing_reference(
        with_rotary,
        duration=float(instants[-1]),
        instants=instants,
        meshes=SHEAR_MESHES,
        element="reissner",
    )
    uncertainty = {
        "rotation": float(reissner.uncertainty.max()),
        "frequency": float(reissner.frequency_uncertainty),
    }
    source = f"reissner elements, {', '.join(map(str, SHEAR_MESHES))} a strip, extrapolated"
    sheared = Limit(found=reissner.swing.rotation, uncertainty=uncertainty, source=source)
    limits = {MATERIAL: material, SHEAR: sheared}
    rows = [
        {
            "theory": theory,
            "rotation_rad": limit.uncertainty["rotation"],
            "frequency_error": limit.uncertainty["frequency"],
            "distance_to_material_rad": float(np.abs(limit.found - material.found).max()),
            "source": limit.source,
        }
        for theory, limit in limits.items()
    ]
    return limits, rows
