"""Drive a pivot or a mechanism through a rotation with one of the models and report its path.

    python -m studies solve cross_axis_pivot --control-points 8
    python -m studies solve cross_axis_pivot --model fe --elements 40 --json -
    python -m studies solve four_bar_of_flexures --effects=-gravity --plot four_bar.svg --csv path.csv

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

The shift is the displacement of the body point that coincides with the strip crossing at rest. The
stiffness of the body is the change of forces and moment at its centre by its x, y and turn in the axes of
the ground, the other two held, loads fixed and drives released; the off-axis ratios are those of x and y
times the square of a strip's length over the stiffness of the rotation. It is shown at some of the states,
and of all of them in JSON and CSV. If the case defines `yield_strength_Pa`, the output includes the safety
factor and the rotation or load at first yield.
"""

import argparse
import math
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from itertools import combinations_with_replacement
from typing import Any

import numpy as np

from studies.answers.adapters import answer_static
from studies.answers.named import quantities_of
from studies.answers.quantities import QUANTITIES, Scale
from studies.answers.response import Response
from studies.answers.settings import Settings
from studies.answers.strength import strength
from studies.answers.validity import validity
from studies.cases.effects import GROWING
from studies.commands import answer as tell
from studies.commands import arguments as take
from studies.commands import columns
from studies.commands.columns import Column, fixed, one, quantity
from studies.commands.parser import command
from studies.kinds import Array
from studies.record.progress import Bar

#: Units of the entries of the stiffness of a body, by how many of their two coordinates are turns.
UNITS = ("N_per_m", "N", "Nm_per_rad")
#: States that the table of the stiffness of the body shows.
SHOWN = 4
#: Its digits, and its part that is round-off; displacement below which there is none, in lengths of a strip.
DIGITS, ROUND_OFF, SHIFT_FLOOR = 4, 1e-9, 1e-12


@command(
    *take.MODEL,
    take.ROTATION.but("end of the path, in deg (default: the case's)"),
    take.INCREMENTS,
    take.ACCURACY.but(
        "wanted relative error of path, torque, stiffness and stress: raises the control points (default "
        "1e-4, or none with --control-points) or doubles the elements (default: none is asked for)"
    ),
    take.JSON,
    take.CSV,
    take.PLOT,
    take.EXPORT,
)
def main(arguments: argparse.Namespace) -> int:
    """Solve and report; return the exit code."""
    design = take.driven(take.chosen_design(arguments), arguments)

    def ask(settings: Settings, bar: Bar) -> Response:
        return answer_static(design, settings, accuracy=arguments.accuracy, progress=bar)

    return tell.asked(arguments, ask, _document, _readable, stopped=_stopped)


def _stopped(answer: Response) -> str:
    """Return how far a path came, why it stopped, and what mends a discretisation that is too coarse."""
    buckles = "buckle" in answer.message
    given = answer.resolution and not answer.estimate
    mend = "; without --control-points their number is chosen" if given else ""
    points, asked = _critical(answer), answer.design.rotation
    if points and not buckles:
        mend += f"; it lost its stability before, first at {_passed(points[0])}"
    if answer.model == "spline" and not given and not buckles:
        mend += "; --model fe may go further"
    reached = ""
    if answer.crossing is not None and asked:
        last = math.degrees(answer.rotation[-1]) if len(answer.rotation) else 0.0
        reached = f"reached {fixed(last, 3)} of {math.degrees(asked):.3f} deg: "
    return f"{reached}{answer.message}{mend}"


def _arrays(answer: Response) -> dict[str, Any]:
    """Return what is one number in every state, by names with units."""
    found, pivot = {"load_factor": answer.load_factor, **tell.moved(answer)}, answer.crossing is not None
    if pivot:
        found |= dict(zip(("centre_shift_x_m", "centre_shift_y_m"), answer.centre_shift.T, strict=True))
    found |= {each.key: values for each, values in quantities_of(answer) if not (pivot and each.mechanisms)}
    if answer.body is not None:
        found |= _stiffness_of_body(answer, answer.body_stiffness)
    return found


def _stiffness_of_body(answer: Response, matrix: Array) -> dict[str, Array]:
    """Return stiffnesses of the body (S, 3, 3) by names with units, and those in x and y over that of the
    rotation, whose lever is a strip's length [1].

    In x and y all else is held; the rotation is free to shift.
    """
    turning = np.full(len(matrix), np.nan)
    known = np.flatnonzero(~np.isnan(matrix).any(axis=(1, 2)))
    known = known[np.linalg.matrix_rank(matrix[known]) == 3]  # a body on a hinge turns without a moment
    turning[known] = 1.0 / np.linalg.inv(matrix[known])[:, 2, 2]
    found = {}
    for (i, force), (j, moved) in combinations_with_replacement(enumerate("xyt"), 2):
        unit = UNITS[(force + moved).count("t")]
        found[f"body_stiffness_{force}{moved}_{unit}"] = matrix[:, i, j]
    for place, axis in enumerate("xy"):
        found[f"off_axis_ratio_{axis}"] = _length(answer) ** 2 * matrix[:, place, place] / turning
    return found


def _length(answer: Response) -> float:
    """Return the length of the longest strip [m]."""
    return max(strip.length for strip in answer.design.strips)


def _document(answer: Response) -> dict[str, Any]:
    """Return the answer as the JSON object of the command: of a pivot the one body, of a mechanism all."""
    return {
        **tell.headed(answer),
        "critical_points": _critical(answer),
        **_arrays(answer),
        "strength": _strength(answer),
        "validity": asdict(validity(answer)),
        **({} if answer.estimate is None else {"estimate": answer.estimate}),
        **tell.keyed(answer, "counters", "wall_s"),
    }


def _critical(answer: Response) -> list[dict[str, Any]]:
    """Return the critical points of a path as JSON has them, with the force that acts on a body there [N]."""
    forces = answer.design.effects.acting("applied_force")
    force = math.hypot(*forces[0]["force"]) if len(forces) == 1 else None
    return [
        tell.keyed(point, "kind", "load_factor", "rotation_rad")
        | ({} if force is None else {"force_N": force * point.load_factor})
        for point in answer.critical_points
    ]


def _passed(point: Mapping[str, Any]) -> str:
    """Return where a critical point is: its load factor, the force that acts there, and the rotation."""
    force = f" (force {point['force_N']:.4g} N)" if "force_N" in point else ""
    turn = point["rotation_rad"]
    return f"load factor {point['load_factor']:.6g}{force}" + (
        f", {math.degrees(turn):.6g} deg" if math.isfinite(turn) else ""
    )


def _readable(answer: Response) -> Iterator[str]:
    """Yield the lines of the tables, and what is to be said of the answer: what it passed, how sure it is.

    Why a path stopped early is told on the error stream.
    """
    yield tell.described(answer)
    yield from columns.table([*_states(answer), *_columns(answer)])
    if answer.settings.get("measure") == "published":
        yield "stiffness of the body: none with printed forces, which are of static paths alone"
    elif answer.body is not None:
        body = answer.body if answer.crossing is None else "the body"
        yield f"stiffness of {body} about its centre at fixed loads, and over that of the rotation"
        yield from columns.table(list(_body_columns(answer)))
    yield from _strength_told(answer)
    # of yield the strength has told
    yield from (f"warning: {each}" for each in validity(answer).outside)
    yield from tell.estimated(answer)
    if answer.converged and answer.message:
        yield answer.message
    yield from dict.fromkeys(f"{point['kind']}: {_passed(point)}" for point in _critical(answer))
    if answer.resolution:
        yield answer.resolution
    yield tell.ending(answer)


def _states(answer: Response) -> Iterator[Column]:
    """Yield the columns that say which state it is."""
    if answer.crossing is None or GROWING.keys() & set(answer.effects):
        yield columns.plain("load", (f"{factor:.3f}" for factor in answer.load_factor))
    if answer.crossing is not None:
        yield columns.angle(answer.rotation)


def _columns(answer: Response) -> Iterator[Column]:
    """Yield the columns of places and of the quantities of a path."""
    if answer.crossing is not None:
        yield from quantity("m", highest=-3, x=answer.centre[:, 0], y=answer.centre[:, 1])
        floor = SHIFT_FLOOR * _length(answer)
        yield from quantity("m", highest=-3, floor=floor, digits=6, shift=np.hypot(*answer.centre_shift.T))
    for each, values in quantities_of(answer):
        if not each.mechanisms and np.isfinite(values).any():
            if each.unit == "rad":
                yield columns.angle(values, group=each.group)
                continue
            named: dict[str, Any] = {each.heading: values}
            how: dict[str, Any] = {"floor": each.least(answer.design), "group": each.group}
            yield from quantity(each.unit, highest=each.highest, digits=each.digits, **how, **named)
    if answer.crossing is None:
        for name, place in answer.bodies.items():
            yield from quantity("m", highest=-3, group=name, x=place[:, 0], y=place[:, 1])
            yield columns.angle(place[:, 2], group=name)


def _body_columns(answer: Response) -> Iterator[Column]:
    """Yield the columns of the stiffness of the body, one for each of a few of the states."""
    last = len(answer.load_factor) - 1
    rows = sorted({round(last * part / SHOWN) for part in range(SHOWN + 1)})
    matrix, length = answer.body_stiffness[rows], _length(answer)
    sizes = matrix / np.outer((1.0, 1.0, length), (1.0, 1.0, length))
    noise = ROUND_OFF * np.nanmax(np.abs(sizes[:, :2, :2]), initial=0.0)
    found = _stiffness_of_body(answer, np.where(np.abs(sizes) < noise, 0.0, matrix))
    states = [_state(*answer.places[row]).removeprefix("at ") for row in rows]
    values = [(state, {key: own[k] for key, own in found.items()}) for k, state in enumerate(states)]
    return columns.by_row({key: Scale.of_key(key) for key in found}, values, DIGITS)


def _strength_told(answer: Response) -> Iterator[str]:
    """Yield where the stress is largest and what of it the material bears; round-off is no stress."""
    found = strength(answer)
    if math.isnan(found.stress):
        return
    if found.stress < next(q for q in QUANTITIES if q.unit == "Pa").least(answer.design):
        yield "no stress: nothing is turned, and no load acts"
        return
    at = _state(found.load_factor, found.rotation)
    yield f"largest stress {one(found.stress / 1e6, 5)} MPa, of {found.strip} {found.place}, {at}"
    if found.safety is None:
        return
    limit = f" of {one(found.yield_strength / 1e6, 4)} MPa" if found.yield_strength is not None else ""
    if found.yields is None:
        yield f"safety {one(found.safety, 4)} against the yield strength{limit}, which is not reached"
    else:
        where = _state(found.yields.load_factor, found.yields.rotation, 6).removeprefix("at ")
        error = found.yields.error
        known = f"estimated error {error:.1e}" if math.isfinite(error) else "error not estimated"
        safety = f"safety {one(found.safety, 4)} against the yield strength{limit}"
        yield f"{safety}: it yields from {where} on ({known})"


def _state(load_factor: float, rotation: float, digits: int = 4) -> str:
    """Return which state it is, in degrees, or by its load."""
    if math.isfinite(rotation) and abs(rotation) > columns.ANGLE_FLOOR:
        return f"at {math.degrees(rotation):.{digits}g} deg"
    return f"at load factor {load_factor:.{digits}g}"


def _strength(answer: Response) -> dict[str, Any]:
    """Return the largest stress and what of it the material bears, as JSON has it."""
    found = strength(answer)
    if math.isnan(found.stress):
        return {}
    error = found.yields and {"relative_error": found.yields.error}
    return {
        "max_stress_Pa": found.stress,
        **tell.keyed(found, "strip", "station", "load_factor", "rotation_rad", "yield_strength_Pa", "safety"),
        "yields_from": error and tell.keyed(found.yields, "load_factor", "rotation_rad") | error,
    }
