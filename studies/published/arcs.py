"""Paths of frames in arc length, by either model: critical points, and branches that cross there."""

import math
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fe_reference.arc_length import ArcPath, follow_arc
from fe_reference.control import Control, equilibrate
from fe_reference.effects import DrivenDisplacement
from fe_reference.errors import ConvergenceError
from fe_reference.loads import full_load
from fe_reference.model import Model
from fe_reference.path import follow
from fe_reference.response import respond
from fe_reference.structure import structure_of
from studies.answers.models import put
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.errors import BadInput
from studies.kinds import Array
from studies.published.case import Frame

LIMIT, BIFURCATION = "limit point", "bifurcation"


@dataclass(frozen=True, kw_only=True)
class _Critical:
    """A critical point: "limit point" or "bifurcation", its load and the place (3,) of the reported body."""

    kind: str
    load: float
    place: Array


@dataclass(frozen=True, kw_only=True)
class Arc:
    """A path of S states.

    Attributes:
        load: (S,) load factor times the load of the frame, in its units.
        place: (S, 3) of the reported body: x, y [length] and turn [rad].
        energy: (S,) stored, in its unit.
        inertia: (S,) number of negative eigenvalues of the tangent.
        critical: the critical points in order.
        message: what the model says of the path; warning: and of its own resolution; empty: nothing.
    """

    load: Array
    place: Array
    energy: Array
    inertia: NDArray[np.int64]
    critical: tuple[_Critical, ...]
    reached: bool
    message: str
    warning: str = ""
    counters: Mapping[str, int] = field(default_factory=dict)

    def critical_load(self, kind: str, place: int = 0) -> float:
        """Return the load of a critical point of a kind, 0 the first; NaN if there is none."""
        found = [point.load for point in self.critical if point.kind == kind]
        return found[place] if place < len(found) else math.nan

    @property
    def turned(self) -> float:
        """How far the body has turned at the end [deg], to either side: branches are mirror images."""
        return abs(math.degrees(self.place[-1, 2]))


def arc_of(frame: Frame, settings: Settings, *, follow_branch: bool = False) -> Arc:
    """Return the path to load factor 1, on the branch that crosses at a bifurcation or on the primary one.

    The spline follows the branch. The elements do not: they are led onto it by a small side load, or by a
    tilt of the body that is let go.

    Raises:
        BadInput: what the model refuses to be asked; forces without a potential have no stability.
    """
    if not isinstance(settings, FeSettings):
        return _of_spline(frame, settings, "follow" if follow_branch else "primary")
    leant = follow_branch and not frame.tilt
    model: Model = put(frame.aside() if leant else frame.design, settings).modelled
    control, message = _led(model, frame), ""
    if follow_branch and frame.tilt:
        path, message = _let_turn(model, frame, control)
    else:
        try:
            path = follow_arc(control, increments=frame.design.increments)
        except ConvergenceError as stop:
            path, message = stop.solution, str(stop)
    return _of_elements(model, frame, path, message)


def _of_spline(frame: Frame, settings: SplineSettings, branch: str) -> Arc:
    asked = put(frame.design, settings)
    how: dict[str, Any] = {"increments": frame.design.increments, "control": "arc-length", "branch": branch}
    with asked.refusals():
        path = asked.model.statics.solve_mechanism(
            asked.modelled.pinned(*frame.pins), raise_on_failure=False, **how
        )
    if (path.inertia < 0).any():
        raise BadInput(
            f"spline: measure: got {settings.measure}, expected one with a potential: stability has no other"
        )
    at = path.system.layout.body(frame.body)
    return Arc(
        load=frame.load * path.load_factor,
        place=path.bodies[frame.body],
        energy=path.bending_energy + path.axial_energy,
        inertia=path.inertia,
        critical=tuple(
            _Critical(kind=point.kind, load=frame.load * point.load_factor, place=point.z[at])
            for point in path.critical_points
        ),
        reached=path.status.value == "converged",
        message=path.message,
        warning=path.resolution,
        counters=path.counters,
    )


def _led(model: Model, frame: Frame) -> Control:
    """Return the control of a frame: its pins held, its load or the displacement of its body growing."""
    structure = structure_of(model)
    ways: dict[str, tuple[float | None, float | None]] = {name: (0.0, 0.0) for name in frame.pins}
    named = model.effects.find(DrivenDisplacement)
    if named is not None:
        ways[frame.body] = named.displacement
    ends = {
        structure.body_slice(model.body_index(name)).start + k: part
        for name, way in ways.items()
        for k, part in enumerate(way)
        if part is not None
    }
    held = np.array(sorted(ends), dtype=np.int64)
    values = np.array([[0.0] * len(held), [ends[int(at)] for at in held]])
    return Control(structure=structure, held=held, values=values, load=full_load(structure))


def _let_turn(model: Model, frame: Frame, control: Control) -> tuple[ArcPath, str]:
    """Return the state at load factor 1 that is found from a tilted body, and why it was not reached.

    The body is turned, then led to its displacement while it is turned, then let turn. So a branch is reached
    that the path from rest crosses; the path has this one state.
    """
    turn = structure_of(model).body_slice(model.body_index(frame.body)).stop - 1
    held = np.append(control.held, turn)
    values = np.zeros((3, len(held)))
    values[1:, -1], values[2, :-1] = frame.tilt, control.values[1]
    legs = [
        replace(control, held=held, values=values[leg : leg + 2], span=(leg / 2, (leg + 1) / 2))
        for leg in range(2)
    ]
    before = follow(legs, frame.design.increments)
    outcome = equilibrate(control, before.states[-1].y, control.span[1], Counter())
    found = before.states[-1] if outcome.failure else respond(control, outcome)
    return ArcPath(states=(found,)), before.message or outcome.failure


def _of_elements(model: Model, frame: Frame, path: ArcPath, message: str) -> Arc:
    structure = structure_of(model)
    at, rest = structure.body_slice(model.body_index(frame.body)), np.array([*frame.rest, 0.0])
    critical = tuple(
        _Critical(kind=point.kind, load=frame.load * point.parameter, place=rest + point.y[at])
        for point in path.critical
    )
    return Arc(
        load=frame.load * np.array([state.parameter for state in path.states]),
        place=rest + np.array([state.y[at] for state in path.states]),
        energy=np.array([sum(structure.evaluate(state.y).strain) for state in path.states]),
        inertia=np.array([state.inertia for state in path.states]),
        critical=critical,
        reached=not message,
        message=message or "; ".join(f"{point.kind} at {point.load:.6g}" for point in critical),
    )
