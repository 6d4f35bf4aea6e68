"""A path that is followed in its arc length, by finite elements: its places and its critical points."""

from collections import Counter
from dataclasses import replace

import numpy as np

from fe_reference.arc_length import ArcPath, follow_arc
from fe_reference.control import Control, equilibrate
from fe_reference.effects import DrivenDisplacement
from fe_reference.errors import ConvergenceError
from fe_reference.follow import follow
from fe_reference.loads import full_load
from fe_reference.model import Model
from fe_reference.structure import structure_of
from studies.answers.models import built, model_of
from studies.answers.settings import FeSettings
from studies.stability.frames import Arc, Critical, Frame


def element_arc(frame: Frame, settings: FeSettings) -> Arc:
    """Return the path to load factor 1; BadInput for what the model refuses to be asked."""
    model, _ = built(model_of(settings), frame.design, settings, moving=False)
    message = ""
    try:
        path = follow_arc(_led(model, frame), increments=frame.design.increments)
    except ConvergenceError as stop:
        path, message = stop.solution, str(stop)
    return _arc(model, frame, path, message)


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


def tilted_state(frame: Frame, settings: FeSettings, tilt: float) -> Arc:
    """Return the state at load factor 1 that is found from a body turned by `tilt` [rad] first.

    The body is turned, then led to its displacement while it is turned, then let turn. So a branch is reached
    that the path from rest crosses; the path has this one state.
    """
    model, _ = built(model_of(settings), frame.design, settings, moving=False)
    control = _led(model, frame)
    turn = structure_of(model).body_slice(model.body_index(frame.body)).stop - 1
    held = np.append(control.held, turn)
    values = np.zeros((3, len(held)))
    values[1:, -1], values[2, :-1] = tilt, control.values[1]
    legs = [
        replace(control, held=held, values=values[leg : leg + 2], span=(leg / 2, (leg + 1) / 2))
        for leg in range(2)
    ]
    before = follow(legs, frame.design.increments)
    message = before.message
    outcome = equilibrate(control, before.states[-1].y, control.span[1], Counter())
    y = outcome.y[None, :]
    path = ArcPath(
        parameter=np.array([control.span[1]]),
        y=y,
        torque=np.array([np.nan]),
        negative=np.array([0 if outcome.factors is None else outcome.factors.negative]),
        critical=(),
    )
    return _arc(model, frame, path, message or outcome.failure)


def _arc(model: Model, frame: Frame, path: ArcPath, message: str) -> Arc:
    at = structure_of(model).body_slice(model.body_index(frame.body))
    rest = np.array([*next(body.centre for body in frame.design.bodies if body.name == frame.body), 0.0])
    critical = tuple(
        Critical(kind=point.kind, load=frame.load * point.parameter, place=rest + point.y[at])
        for point in path.critical
    )
    return Arc(
        load=frame.load * path.parameter,
        place=rest + path.y[:, at],
        energy=np.array([sum(structure_of(model).evaluate(y).strain) for y in path.y]),
        inertia=path.negative,
        critical=critical,
        reached=not message,
        message=message or "; ".join(f"{point.kind} at {point.load:.6g}" for point in critical),
    )
