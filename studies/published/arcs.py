"""Paths of frames by either model: critical points, and branches that cross there.

The spline follows them in arc length. The elements raise the load to its limit, and beyond it lead the loaded
body along the force, as far as the displacement grows.
"""

import math
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline

from fe_reference.control import Control, equilibrate
from fe_reference.model import Model
from fe_reference.path import Path, follow
from fe_reference.response import respond
from fe_reference.structure import structure_of
from studies.answers.models import put
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.errors import BadInput
from studies.kinds import Array
from studies.published.case import Frame

LIMIT, BIFURCATION = "limit point", "bifurcation"
#: How a path ended.
REACHED, STOPPED = "converged", "not_converged"
#: Increments of elements over those of a frame where a column bends. Splines take the steps that curves need.
FINER = 20
#: Part of the displacement at a limit load by which a body is led on, and how often at most.
PART, STEPS = 0.1, 60


class _Critical(NamedTuple):
    """A critical point: "limit point" or "bifurcation", and its load."""

    kind: str
    load: float


@dataclass(frozen=True, kw_only=True)
class Arc:
    """A path of S states.

    Attributes:
        load: (S,) load factor times the load of the frame, in its units.
        place: (S, 3) of the reported body: x, y [length] and turn [rad].
        energy: (S,) stored, in its unit.
        inertia: (S,) number of negative eigenvalues of the tangent.
        critical: the critical points in order.
        status: "converged", or how it ended early; message: what the model says of the path; resolution: and
            of its own resolution; empty: nothing.
    """

    load: Array
    place: Array
    energy: Array
    inertia: NDArray[np.int64]
    critical: tuple[_Critical, ...]
    status: str
    message: str
    resolution: str = ""

    def critical_load(self, kind: str, place: int = 0) -> float:
        """Return the load of a critical point of a kind, 0 the first, in the frame's unit; NaN if none."""
        found = [point.load for point in self.critical if point.kind == kind]
        return found[place] if place < len(found) else math.nan

    @property
    def turned(self) -> float:
        """How far the body has turned at the end [deg], to either side: branches are mirror images."""
        return abs(math.degrees(self.place[-1, 2]))


def arc_of(frame: Frame, settings: Settings, *, follow_branch: bool = False) -> Arc:
    """Return the path to load factor 1, on the branch that crosses at a bifurcation or on the primary one.

    The spline follows the branch. The elements do not: they are led onto it by a small side load, or by a
    tilt of the body that is released.

    Raises:
        BadInput: what the model refuses to be asked; forces without a potential have no stability.
    """
    if not isinstance(settings, FeSettings):
        return _of_spline(frame, settings, "follow" if follow_branch else "primary")
    leant = follow_branch and not frame.tilt
    model: Model = put(frame.aside() if leant else frame.design, settings).modelled
    control = _led(model, frame)
    if follow_branch and frame.tilt:
        return _of_elements(model, frame, _let_turn(model, frame, control))
    increments = frame.design.increments * (FINER if follow_branch else 1)
    return _of_elements(model, frame, follow([control], increments))


def _of_spline(frame: Frame, settings: SplineSettings, branch: str) -> Arc:
    asked = put(frame.design, settings)
    how: dict[str, Any] = {"increments": frame.design.increments, "control": "arc-length", "branch": branch}
    with asked.refusals():
        path = asked.model.solve_statics(asked.modelled, raise_on_failure=False, **how)
    if (path.inertia < 0).any():
        raise BadInput(
            f"spline: measure: got {settings.measure}, expected one with a potential: stability has no other"
        )
    return Arc(
        load=frame.load * path.load_factor,
        place=path.bodies[frame.body],
        energy=path.bending_energy + path.axial_energy,
        inertia=path.inertia,
        critical=_critical(frame, path.critical_points),
        status=path.status.value,
        message=path.message,
        resolution=path.resolution,
    )


def _critical(frame: Frame, points: Iterable[Any]) -> tuple[_Critical, ...]:
    """Return the critical points of a model's path by their loads."""
    return tuple(_Critical(point.kind, frame.load * point.load_factor) for point in points)


def _led(model: Model, frame: Frame) -> Control:
    """Return the control of a frame: its supports, its load or the displacement of its body growing."""
    structure, ends = structure_of(model), {}
    for at, (end, _) in model.prescribed(model.body_index(frame.body)).items():
        ends[structure.body_slice(at // 3).start + at % 3] = end
    held = np.array(sorted(ends), dtype=np.int64)
    values = np.array([[0.0] * len(held), [ends[int(at)] for at in held]])
    return Control(structure=structure, held=held, values=values, load=structure.loads.factors())


def _let_turn(model: Model, frame: Frame, control: Control) -> Path:
    """Return the path whose one state, at load factor 1, is found from a tilted body, or why there is none.

    The body is turned, then led to its displacement while it is turned, then let turn. So a branch is reached
    that the path from rest crosses.
    """
    turn = structure_of(model).body_slice(model.body_index(frame.body)).stop - 1
    held = np.append(control.held, turn)
    values = np.zeros((3, len(held)))
    values[1:, -1], values[2, :-1] = frame.tilt, control.values[1]
    parts = ((0.0, 0.5), (0.5, 1.0))
    legs = [
        replace(control, held=held, values=values[leg : leg + 2], span=part, shares=part)
        for leg, part in enumerate(parts)
    ]
    before = follow(legs, frame.design.increments)
    outcome = equilibrate(control, before.states[-1].y, control.span[1], Counter())
    found = before.states[-1] if outcome.failure else respond(control, outcome)
    return Path(control=control, states=[found], message=before.message or outcome.failure)


def _led_on(path: Path, load: Array) -> tuple[Path, Array]:
    """Return the path on from a limit of the load: the loaded body is led along the force in its place.

    It ends where the load is reached, or where the displacement has a limit as well. Beside it: the load
    factor of its states and the rate of that in its parameter, (2, S).
    """
    at = int(np.abs(load).argmax())
    held, last = np.append(path.control.held, at), path.trail[-1]
    ends = last.y[held] + np.outer((0.0, 1.0), np.where(held == at, STEPS * PART * last.y[at], 0.0))
    on = Path(control=path.control)
    on.begin(replace(path.control, held=held, values=ends, load=None), last.y)
    unit = load[at] * on.control.slope[-1]
    for k in range(1, STEPS + 1):
        if not on.advance(k / STEPS) or on.states[-1].conjugate >= unit:
            break
    return on, np.array([(state.conjugate, state.slope) for state in on.states]).T / unit


def _of_elements(model: Model, frame: Frame, path: Path) -> Arc:
    """Return the states of a path, and those on from the limit of its load if that is what stopped it."""
    structure, states, message = structure_of(model), list(path.states), path.message
    load = frame.load * np.array([state.parameter for state in states])
    inertia = np.array([state.inertia for state in states])
    critical = _critical(frame, path.critical)
    if message and critical and critical[-1].kind == LIMIT:
        assert path.control.load is not None
        on, factors = _led_on(path, structure.load_force(np.zeros(structure.size), path.control.load)[0])
        if len(on.states) > 1:
            further, slope = frame.load * factors
            pulled = CubicHermiteSpline([state.parameter for state in on.states], further, slope)
            turns = pulled.derivative().roots(extrapolate=False)
            critical = (*critical[:-1], *(_Critical(LIMIT, float(pulled(turn))) for turn in turns))
            reached = bool(further[-1] >= frame.load)
            message = "" if reached else f"{frame.body} is led no further than load {further[-1]:.6g}"
            unstable = [state.inertia for state in on.states] + (slope < 0.0)
            states, load, inertia = (
                [*states, *on.states],
                np.append(load, further),
                np.append(inertia, unstable),
            )
    at = structure.body_slice(model.body_index(frame.body))
    return Arc(
        load=load,
        place=np.array([*frame.rest, 0.0]) + np.array([state.y[at] for state in states]),
        energy=np.array([sum(structure.evaluate(state.y).strain) for state in states]),
        inertia=inertia,
        critical=critical,
        status=STOPPED if message else REACHED,
        message=message or "; ".join(f"{point.kind} at {point.load:.6g}" for point in critical),
    )
