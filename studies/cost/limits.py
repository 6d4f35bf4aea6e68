"""The limit that each theory of the rod tends to, which models of it are held against."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from studies.answers.adapters import answer_release, answer_static
from studies.answers.reference import (
    QUANTITIES,
    NoReference,
    Reference,
    SwingReference,
    largest_errors,
    reference,
    rotation_error,
    sampled,
    swing_reference,
)
from studies.answers.settings import SplineSettings
from studies.cases.design import Design
from studies.cases.problem import Problem
from studies.engine import Row
from studies.kinds import Array

#: Theories of a strip, by what their energies are measured in: bending per reference length without shear,
#: per current length as the paper's Eq 10, and per reference length with shear.
MATERIAL, SPATIAL, SHEAR = "material", "spatial", "shear"
#: Control points of the spatial limit, and of the one below that says how uncertain it is.
SPATIAL_POINTS = (15, 13)
#: Control points and steps [s] of the splines that are the limit of a swing, the finer one first.
SWINGS = {16: 3e-7, 14: 4e-7}
#: Records of these: the strips' own oscillations are some 40 times as fast as the swing, and cubic
#: interpolation between so many errs by less than 1e-6 rad.
RECORDS = 4000
#: Meshes of the limit with shear, a third apart: linear elements, whose waves need finer ones.
SHEAR_MESHES = (36, 54, 81, 121)
#: What the other codes' rods with shear have beside it.
ROTARY = "section_rotary_inertia"


def path_limit(design: Design, theory: str) -> Reference:
    """Return the limit of a theory on the path of a design.

    Material and shear: the elements' limit of refinement, which shares no code with the splines. Spatial: no
    elements have it, so a spline finer than any that is shown, and its distance to a coarser one.

    Raises:
        NoReference: a model does not reach the end of the path.
    """
    if theory != SPATIAL:
        return reference(design, "corotational" if theory == MATERIAL else "reissner")
    paper: dict[str, Any] = {"measure": theory, "stretch": "consistent"}
    fine, coarse = (answer_static(design, SplineSettings(control_points=n, **paper)) for n in SPATIAL_POINTS)
    for path in (fine, coarse):
        if not path.converged:
            raise NoReference(path.message)
    return Reference.of(
        fine, coarse, "spline with {} control points; its distance to one with {}".format(*SPATIAL_POINTS)
    )


def path_limits(design: Design) -> tuple[dict[str, Reference], list[Row]]:
    """Return the limits of all theories, and rows of how certain they are and how far apart."""
    limits = {theory: path_limit(design, theory) for theory in (MATERIAL, SPATIAL, SHEAR)}
    rows = [
        {
            "theory": theory,
            "quantity": name,
            "uncertainty": limit.uncertainty[name],
            "distance_to_material": largest_errors(limit, limits[MATERIAL])[name],
            "source": limit.source,
        }
        for theory, limit in limits.items()
        for name in QUANTITIES
    ]
    return limits, rows


def swing_limit(
    design: Design, instants: Array, integrator: str, steps: Mapping[int, float | None]
) -> SwingReference:
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
        found.append(sampled(motion, instants))
    fine, coarse = found
    uncertainty = {
        "rotation": rotation_error(coarse, fine, instants),
        "frequency": abs(coarse.frequency / fine.frequency - 1.0),
    }
    told = (f"n = {n}" + (f" at {1e6 * step:g} µs" if step else "") for n, step in steps.items())
    return SwingReference(**vars(fine), uncertainty=uncertainty, source=" and ".join(told))


def swing_limits(problem: Problem, instants: Array) -> tuple[dict[str, SwingReference], list[Row]]:
    """Return the swing of either theory at the instants, with rows of how certain they are."""
    with_rotary = replace(problem, effects=problem.effects.renamed([*problem.effects.names, ROTARY]))
    sheared = swing_reference(
        with_rotary,
        duration=float(instants[-1]), instants=instants, meshes=SHEAR_MESHES, element="reissner",
    )  # fmt: skip
    limits = {MATERIAL: swing_limit(problem, instants, "leapfrog", SWINGS), SHEAR: sheared}
    rows = [
        {
            "theory": theory,
            "rotation_rad": limit.uncertainty["rotation"],
            "frequency_error": limit.uncertainty["frequency"],
            "distance_to_material_rad": float(np.abs(limit.rotation - limits[MATERIAL].rotation).max()),
            "source": limit.source,
        }
        for theory, limit in limits.items()
    ]
    return limits, rows
