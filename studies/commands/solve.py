"""Drive a pivot or a mechanism through a rotation with one of the models and report its path.

    python -m studies solve cross_axis_pivot --control-points 8
    python -m studies solve cross_axis_pivot --model fe --elements 40 --json -
    python -m studies solve four_bar_of_flexures --effects=-gravity

Of a pivot coordinates have their origin at A1, the ground clamp of strip 1; rotation is counter-clockwise.
Control points of the spline are added until the estimated error of path, torque, stiffness, stress and
section forces is below --accuracy, 1e-4 unless said otherwise; --control-points alone are just that number,
and with --accuracy the first that are tried. Finite elements are doubled from --elements on where --accuracy
asks for it, and the answer is the limit of the meshes. Loads come on before the rotation, unless the case
says order = "together"; load is their share. The arrays of the JSON run over the increments, the state of
load factor 0 first, and effects are those that were assembled. Critical points that were passed, and what the
model remarks on the path, stand below the table. A mechanism without a rotation follows the loads of its
scene. Exit code 0: converged; 2: bad input; 3: not converged, and then the converged part of the path is
reported with where and why it stopped.
"""

import argparse
import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from studies.answers.adapters import answer_mechanism, answer_static
from studies.answers.response import MechanismResponse, Response
from studies.cases.design import Design, flexural_scale
from studies.cases.problem import Problem
from studies.commands.answer import (
    deliver,
    described,
    ending,
    estimated,
    headed,
    number,
    places,
    remarks,
    require_target,
)
from studies.commands.arguments import (
    ACCURACY,
    INCREMENTS,
    JSON,
    MODEL,
    REPEAT,
    ROTATION,
    chosen_design,
    chosen_settings,
    driven,
)
from studies.commands.columns import (
    ENERGY_FLOOR,
    FORCE_FLOOR,
    STRAIN_FLOOR,
    Column,
    angle,
    plain,
    quantity,
    table,
)
from studies.commands.parser import command
from studies.record.progress import Bar

#: Effects whose share a table shows beside the rotation.
LOADS = {"applied_force", "applied_moment", "tip_force", "driven_displacement"}


def share(answer: Response | MechanismResponse) -> Column:
    """Return the column of the share of the loads that acts."""
    return plain("load", (f"{factor:.3f}" for factor in answer.load_factor))


@command(
    *MODEL,
    ROTATION.but(help="end of the path, in deg (default: the case's)"),
    INCREMENTS,
    REPEAT,
    ACCURACY.but(
        help="wanted relative error of path, torque, stiffness and stress, and of section forces (spline) or "
        "energy (fe): raises the control points (default 1e-4, or none with --control-points) or doubles "
        "the elements (default: none is asked for)"
    ),
    JSON,
)
def main(arguments: argparse.Namespace) -> int:
    """Solve and report; return the exit code."""
    design = driven(chosen_design(arguments), arguments)
    settings = chosen_settings(arguments)
    require_target(arguments)
    with Bar(f"solve {settings.model}") as bar:
        how = {"repeat": arguments.repeat, "accuracy": arguments.accuracy}
        answer: Response | MechanismResponse
        if isinstance(design, Problem):
            answer = answer_static(design, settings, progress=bar, **how)
            failure = None if answer.converged else _stopped(design, answer)
        else:
            answer = answer_mechanism(design, settings, progress=bar, **how)
            failure = None if answer.converged else answer.message
    return deliver(arguments, as_document(answer), _readable(design, answer), failure=failure)


def as_document(answer: Response | MechanismResponse) -> dict[str, Any]:
    """Return the answer as the JSON object of the command: of a pivot the one body, of a mechanism all."""
    if isinstance(answer, Response):
        place = {
            "rotation_rad": answer.rotation.tolist(),
            "com_x_m": answer.centre[:, 0].tolist(),
            "com_y_m": answer.centre[:, 1].tolist(),
        }
        beside = {"max_stress_Pa": answer.max_stress.tolist()}
    else:
        place = {"bodies": places(answer.bodies)}
        beside = {"gravity_energy_J": answer.gravity_energy.tolist(), "work_J": answer.work.tolist()}
    return {
        **headed(answer),
        "load_factor": answer.load_factor.tolist(),
        **place,
        "torque_Nm": [number(value) for value in answer.torque.tolist()],
        "stiffness_Nm_per_rad": [number(value) for value in answer.stiffness.tolist()],
        "strain_energy_J": answer.strain_energy.tolist(),
        **beside,
        **({} if answer.estimate is None else {"estimate": answer.estimate}),
        "counters": answer.counters,
        "wall_s": answer.wall_s,
    }


def _stopped(problem: Problem, answer: Response) -> str:
    """Return how far a path came, why it stopped, and what mends a discretisation that is too coarse."""
    last = math.degrees(answer.rotation[-1]) if len(answer.rotation) else 0.0
    given = answer.resolution and not answer.estimate
    mend = "; without --control-points their number is chosen" if given else ""
    return f"reached {last:.3f} of {math.degrees(problem.rotation):.3f} deg: {answer.message}{mend}"


def _readable(design: Design, answer: Response | MechanismResponse) -> Iterator[str]:
    """Yield the lines of a short table: torque and energy, and the place of the body, or of every one."""
    yield described(answer.model, answer.settings, answer.effects)
    scale = flexural_scale(design)
    pivot = isinstance(answer, Response)
    columns = [] if pivot and not LOADS & set(answer.effects) else [share(answer)]
    if isinstance(answer, Response):
        columns.append(angle(answer.rotation))
        columns += quantity("m", highest=-3, x=answer.centre[:, 0], y=answer.centre[:, 1])
    if pivot or np.isfinite(answer.torque).any():
        columns += quantity("N m", floor=FORCE_FLOOR * scale, torque=answer.torque)
    if pivot:
        columns += quantity("N m/rad", floor=FORCE_FLOOR * scale, stiffness=answer.stiffness)
    columns += quantity("J", floor=ENERGY_FLOOR * scale, energy=answer.strain_energy)
    if isinstance(answer, Response) and isinstance(design, Problem):
        floor = STRAIN_FLOOR * design.youngs_modulus
        columns += quantity("Pa", floor=floor, highest=6, digits=6, stress=answer.max_stress)
    elif isinstance(answer, MechanismResponse):
        for name, place in answer.bodies.items():
            columns += quantity("m", highest=-3, group=name, x=place[:, 0], y=place[:, 1])
            columns.append(angle(place[:, 2], group=name))
    yield from table(columns)
    yield from estimated(answer.estimate)
    yield from remarks(answer)
    yield ending(answer.status, answer.counters, answer.wall_s)
