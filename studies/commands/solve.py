"""Drive a pivot or a mechanism through a rotation with one of the models and report its path.

    python -m studies solve cross_axis_pivot --control-points 8
    python -m studies solve cross_axis_pivot --model fe --elements 40 --json -
    python -m studies solve four_bar_of_flexures --effects=-gravity --plot four_bar.svg --csv path.csv
    python -m studies solve cross_axis_pivot --model spline,fe

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

The shift is the distance of the body's point that lies at the strips' crossing at rest from that place. The
stiffness of the body is the change of forces and moment at its centre by its x, y and turn in the axes of
the ground, the other two held, loads fixed and drives let go; "x over" and "y over" are those of x and y
times the square of a strip's length over the stiffness of the rotation. It is shown at some of the states,
and of all of them in JSON and CSV. With a yield_strength_Pa in the case the answer says how safe it is, and
from which angle or load on it yields. Several models, as in --model spline,fe, are answered one after
another, with their largest differences over the path, each in parts of the largest value by the first.
"""

import argparse
import math
from collections.abc import Iterator, Sequence
from typing import Any

from studies.answers.adapters import answer_static
from studies.answers.metrics import differences
from studies.answers.response import Response
from studies.commands import arguments as take
from studies.commands.answer import deliver, pictured
from studies.commands.columns import fixed
from studies.commands.parser import command
from studies.commands.path_output import as_document, as_frame, critical, passed, readable
from studies.record.progress import Bar


@command(
    *take.SEVERAL_MODELS,
    take.ROTATION.but("end of the path, in deg (default: the case's)"),
    take.INCREMENTS,
    take.REPEAT,
    take.ACCURACY.but(
        "wanted relative error of path, torque, stiffness and stress, and of section forces (spline) or "
        "energy (fe): raises the control points (default 1e-4, or none with --control-points) or doubles "
        "the elements (default: none is asked for)"
    ),
    take.JSON,
    take.CSV,
    take.PLOT,
)
def main(arguments: argparse.Namespace) -> int:
    """Solve and report; return the exit code."""
    design = take.driven(take.chosen_design(arguments), arguments)
    every = take.chosen_settings(arguments)
    how, answers = {"repeat": arguments.repeat, "accuracy": arguments.accuracy}, []
    for settings in every:
        with Bar(f"solve {settings.model}") as bar:
            answers.append(answer_static(design, settings, progress=bar, **how))
    stopped = [_stopped(answer) for answer in answers if not answer.converged]
    pictured(arguments, *answers)
    return deliver(
        arguments,
        _document(answers),
        _table(answers),
        failure="; ".join(stopped) or None,
        frame=lambda: _frame(answers),
    )


def _stopped(answer: Response) -> str:
    """Return how far a path came, why it stopped, and what mends a discretisation that is too coarse."""
    given = answer.resolution and not answer.estimate
    mend = "; without --control-points their number is chosen" if given else ""
    points, asked = critical(answer), answer.design.rotation
    if points and "buckle" not in answer.message:
        mend += f"; it lost its stability before, first at {passed(points[0])}"
    if answer.model == "spline" and not given:
        mend += "; --model fe may go further"
    if answer.crossing is not None and asked:
        last = math.degrees(answer.rotation[-1]) if len(answer.rotation) else 0.0
        mend = f"{answer.message}{mend}"
        return f"reached {fixed(last, 3)} of {math.degrees(asked):.3f} deg: {mend}"
    return f"{answer.message}{mend}"


def _document(answers: Sequence[Response]) -> dict[str, Any]:
    """Return the JSON object: of one answer, or of several with their differences."""
    if len(answers) == 1:
        return as_document(answers[0])
    return {
        "answers": [as_document(answer) for answer in answers],
        "differences": {answer.model: differences(answer, answers[0]) for answer in answers[1:]},
    }


def _frame(answers: Sequence[Response]) -> Any:
    """Return the rows of all answers as a table of pandas, which only who asks for one waits for."""
    import pandas as pd

    return pd.concat([as_frame(answer) for answer in answers])


def _table(answers: Sequence[Response]) -> Iterator[str]:
    """Yield the lines to read: every answer, and how far those after the first are from it."""
    for answer in answers:
        yield from readable(answer)
        yield from [""] * (len(answers) > 1)
    for answer in answers[1:]:
        apart = differences(answer, answers[0])
        told = (f"{name.replace('_', ' ')} {value:.1e}" for name, value in apart.items() if value is not None)
        yield f"{answer.model} differs from {answers[0].model} by: {', '.join(told)}"
