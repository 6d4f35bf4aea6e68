"""Designs of a sweep solved one by one, a row each, whatever becomes of them."""

import copy
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from studies.answers.adapters import answer_modes, answer_release
from studies.answers.models import built, model_of, refusals, static_path
from studies.answers.response import centre_shift
from studies.answers.settings import Settings, settings_of_model
from studies.answers.strength import moduli_of, strains_of
from studies.answers.validity import strips_of
from studies.cases.design import Design
from studies.cases.mechanism import read_mechanism
from studies.cases.problem import Problem, read_problem
from studies.errors import BadInput
from studies.kinds import Array
from studies.sweep import plan, quantities
from studies.sweep.plan import Task
from studies.sweep.quantities import Answer, Paths, Quantity

#: Control points of a spline unless said otherwise.
CONTROL_POINTS = 6
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
    paths = [_paths_of(side, result) for side, result in zip(sides, found, strict=True)]
    return CONVERGED, remark, paths[0] if len(paths) == 1 else joined(*paths)


def _static_result(design: Design, settings: Settings) -> Any:
    model = model_of(settings)
    asked, _ = built(model, design, settings, moving=False)
    with refusals(model, settings):
        return static_path(model, design, asked, raise_on_failure=False)


def _paths_of(design: Design, result: Any) -> Paths:
    """Return the path of one design from a model's solution."""
    states = len(result.torque)
    inertia = getattr(result, "inertia", None)
    energy = result.bending_energy + result.axial_energy + getattr(result, "shear_energy", 0.0)
    places = {name: np.asarray(place)[None] for name, place in result.bodies.items()}
    nowhere = np.full((1, states, 3), np.nan)
    place = places[design.body] if design.body else nowhere
    strain = strains_of(design, result.axial_force, result.bending_moment).max(axis=2)
    shift = nowhere[..., :2]
    if isinstance(design, Problem):
        shift = centre_shift(design.crossing_point, place[..., 2], place[..., :2])
    return Paths(
        rest=0,
        rotation=place[..., 2],
        torque=result.torque[None],
        stiffness=result.stiffness[None],
        stress=(strain * moduli_of(design)).max(axis=1)[None],
        energy=np.asarray(energy)[None],
        defect=np.asarray(getattr(result, "moment_defect", np.full(states, np.nan)))[None],
        unstable=np.array([-1 if inertia is None else np.count_nonzero(inertia)]),
        iterations=np.array([result.counters["newton_iterations"]]),
        shift=shift,
        places=places,
        strips=tuple(
            strip.bent(strain[:, k].max(keepdims=True)) for k, strip in enumerate(strips_of(design))
        ),
        effects=tuple(design.effects.names),
    )


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
        strips=tuple(
            strip.bent(np.maximum(strip.strain, twin.strain))
            for strip, twin in zip(one.strips, other.strips, strict=True)
        ),
        effects=one.effects,
        **{name: both(name) for name in arrays},
    )


REFUSED, FAILED = "refused", "failed"
#: Columns beside keys and quantities.
POINT, STATUS, REASON = "point", "status", "reason"


def stored(task: Task) -> dict[str, Quantity]:
    """Return the quantities that the task stores, by name, in their order."""
    found = known(task.case, task.analysis.kind, task.analysis.options.get("count", 0))
    return {name: found[name] for name in task.quantities}


def known(case: Mapping[str, Any], kind: str, count: int) -> dict[str, Quantity]:
    """Return all quantities of an analysis of the case's document."""
    mechanism = isinstance(case.get("strips"), list)
    bodies = [body["name"] for body in case.get("bodies", [])] if mechanism else None
    return quantities.known(kind, bodies=bodies, count=count)


def solve_each(
    task: Task, designs: list[dict[str, Any]]
) -> tuple[list[str], list[str], dict[str, list[float]]]:
    """Solve designs one by one; returns status, reason and quantities as columns."""
    status, reason = [], []
    found: dict[str, list[float]] = {name: [] for name in task.quantities}
    table = stored(task)
    for design in designs:
        how, why, answer = _answered(task, design)
        status.append(how)
        reason.append(why)
        if answer is None:
            row = dict.fromkeys(task.quantities, np.nan)
        else:
            row = {
                name: values[0] for name, values in quantities.values(table, task.quantities, answer).items()
            }
        for name, value in row.items():
            found[name].append(float(value))
    return status, reason, found


def design_of(task: Task, values: Mapping[str, Any]) -> Design:
    """Return one design of the sweep; CaseError where a value is out of its range."""
    document = copy.deepcopy(task.case)
    plan.put_all(document, values)
    read = read_mechanism if isinstance(document.get("strips"), list) else read_problem
    return read(task.where, document)


def varied_settings(task: Task, values: Mapping[str, Any]) -> dict[str, Any]:
    """Return the keywords of the settings of one design: those of the sweep, and those that it varies."""
    own = {
        key.partition(".")[2]: value for key, value in values.items() if key.startswith(f"{plan.SETTINGS}.")
    }
    usual = {"control_points": CONTROL_POINTS} if task.model == "spline" else {}
    return usual | task.settings | own


def _answered(task: Task, values: Mapping[str, Any]) -> tuple[str, str, Answer | None]:
    """Return status, reason and answer of one design."""
    try:
        design = design_of(task, values)
        settings = settings_of_model(task.model, **varied_settings(task, values))
        return _solved(task, design, settings)
    except BadInput as error:
        return REFUSED, str(error), None
    except Exception as error:  # a fault at one design must not cost the others: it is told in its row
        return FAILED, f"{type(error).__name__}: {error}".splitlines()[0], None


def _solved(task: Task, design: Design, settings: Settings) -> tuple[str, str, Answer | None]:
    options = task.analysis.options
    answer: Answer
    if task.analysis.kind == "static":
        return static_answer(design, settings, both_sides=task.analysis.both_sides)
    if task.analysis.kind == "modes":
        answer = answer_modes(design, settings, **options)
    else:
        answer = answer_release(design, settings, **options)
    return (CONVERGED if answer.converged else NOT_CONVERGED), answer.message, answer
