"""The static path of one design by either model, as a sweep stores it."""

from dataclasses import replace
from typing import Any

import numpy as np

from studies.answers.models import built, model_of, refusals
from studies.answers.response import centre_shift, extreme_fibre_strain
from studies.answers.settings import Settings
from studies.cases.design import Design
from studies.cases.mechanism import Mechanism
from studies.cases.problem import Problem
from studies.kinds import Array
from studies.sweep.quantities import Paths

CONVERGED, NOT_CONVERGED = "converged", "not_converged"


def static_answer(design: Design, settings: Settings, *, both_sides: bool) -> tuple[str, str, Paths | None]:
    """Return status, reason and static path of one design, to its rotation and, if asked, its opposite."""
    sides = [design]
    if both_sides:
        sides.append(replace(design, rotation=-(design.rotation or 0.0)))
    found: list[Any] = []
    for side in sides:
        result = _static_result(side, settings)
        if result.status.value != CONVERGED:
            words = "" if not both_sides else "to the other side: " if found else "to the one side: "
            return NOT_CONVERGED, words + result.message, None
        found.append(result)
    remark = "; ".join(dict.fromkeys(result.message for result in found if result.message))
    paths = [paths_of(side, result) for side, result in zip(sides, found, strict=True)]
    return CONVERGED, remark, paths[0] if len(paths) == 1 else joined(*paths)


def _static_result(design: Design, settings: Settings) -> Any:
    model = model_of(settings)
    asked, _ = built(model, design, settings, moving=False)
    how = {"rotation": design.rotation, "increments": design.increments, "order": design.order}
    how |= {"raise_on_failure": False}
    with refusals(model, settings):
        if isinstance(design, Problem):
            return model.statics.solve_statics(asked, **how)
        return model.statics.solve_mechanism(asked, body=design.body, **how)


def paths_of(design: Design, result: Any) -> Paths:
    """Return the path of one design from a model's solution."""
    states = len(result.torque)
    inertia = getattr(result, "inertia", None)
    energy = result.bending_energy + result.axial_energy + getattr(result, "shear_energy", 0.0)
    if isinstance(design, Problem):
        rotation, places = result.rotation, {}
        shift = centre_shift(design, result.rotation, result.centre)
        strain = extreme_fibre_strain(design, result.axial_force, result.bending_moment)
        stress = design.youngs_modulus * strain.max(axis=(1, 2))
    else:
        places = {name: np.asarray(place)[None] for name, place in result.bodies.items()}
        rotation = result.bodies[design.body][:, 2] if design.body else np.full(states, np.nan)
        shift = np.full((states, 2), np.nan)
        stress = _stress(design, result)
    return Paths(
        rest=0,
        rotation=np.asarray(rotation)[None],
        torque=result.torque[None],
        stiffness=result.stiffness[None],
        stress=stress[None],
        energy=np.asarray(energy)[None],
        defect=np.asarray(getattr(result, "moment_defect", np.full(states, np.nan)))[None],
        unstable=np.array([-1 if inertia is None else np.count_nonzero(inertia)]),
        iterations=np.array([result.counters["newton_iterations"]]),
        shift=shift[None],
        places=places,
    )


def _stress(mechanism: Mechanism, result: Any) -> Array:
    """Return |N| / A + |M| d / (2 I) of a rectangle, the largest over the strips, (S,) [Pa]."""
    each = []
    for i, strip in enumerate(mechanism.strips):
        depth = np.sqrt(12.0 * strip.second_moment_of_area / strip.area)
        axial = np.abs(result.axial_force[:, i]) / strip.area
        bending = np.abs(result.bending_moment[:, i]) * depth / (2.0 * strip.second_moment_of_area)
        each.append((axial + bending).max(axis=1))
    return np.asarray(np.max(each, axis=0))


def joined(one: Paths, other: Paths) -> Paths:
    """Return the paths to both sides as one, from the end of `other` through rest to that of `one`."""

    def both(name: str) -> Array:
        return np.concatenate((getattr(other, name)[:, :0:-1], getattr(one, name)), axis=1)

    arrays = ("rotation", "torque", "stiffness", "stress", "energy", "defect", "shift")
    unstable = np.where(one.unstable < 0, -1, one.unstable + other.unstable)
    return Paths(
        rest=one.rotation.shape[1] - 1,
        unstable=unstable,
        iterations=one.iterations + other.iterations,
        places=one.places,
        **{name: both(name) for name in arrays},
    )
