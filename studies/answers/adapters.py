"""Put a design to either model, and get a neutral answer: its static path, its release, its natural modes."""

from dataclasses import fields, replace
from time import perf_counter
from typing import Any

from studies.answers.answer import Answer
from studies.answers.models import Asked, model_of, put
from studies.answers.motion import MOVED, NOT_JUDGED, NOTHING_MOVES, UNSTABLE, Motion, Spectrum
from studies.answers.response import Response
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.design import Design, flexural_scale
from studies.cases.effects import Effects
from studies.cases.mechanism import Body, Mechanism, Strip
from studies.errors import BadInput
from studies.kinds import Progress


def answer_static(
    design: Design,
    settings: Settings,
    *,
    accuracy: float | None = None,
    progress: Progress | None = None,
) -> Response:
    """Solve the static path of a design from load factor 0 to 1 with the model that `settings` belongs to.

    The path is that of the driven rotation and of the loads in the design's order, or of the loads alone.
    `wall_s` of the response is the time of the whole call, from the design to the answer, set-up included;
    `solve_s` is that of the increments alone.

    Args:
        design: the pivot or mechanism, and its path.
        settings: names the model and its discretisation.
        accuracy: wanted error of trajectory and torque [1], which control points or elements are raised for;
            None for those of the settings.
        progress: called with increments done and increments in all, by the elements.

    Raises:
        BadInput: a setting that the model refuses; one line.
    """
    wanted: dict[str, Any] = {} if accuracy is None else {"accuracy": accuracy}
    if isinstance(settings, FeSettings):
        wanted["progress"] = progress

    begin = perf_counter()
    asked = put(design, settings)
    found = Response.of(asked, asked.static_path(raise_on_failure=False, **wanted))
    return replace(found, wall_s=perf_counter() - begin)


def answer_release(
    design: Design,
    settings: Settings,
    *,
    duration: float,
    start: float | None = None,
    check: bool = False,
    **options: Any,
) -> Motion:
    """Release a design at rest from a static state and return its motion.

    The start is in equilibrium with the body driven to a rotation, weight and pre-strain in full, and every
    load and driven displacement at its value times its history at t = 0. Then the rotation is released,
    unless the design prescribes it further, and driven displacements without a history; loads follow their
    histories.

    `wall_s` of the motion is the time of the whole call, as of `answer_static`: it includes the static path
    to the start, but no companion motion. `solve_s` is the time of the steps only.

    Args:
        design: the pivot or mechanism. If the design has no rotation, none is driven: the motion starts at
            the equilibrium under everything that acts at t = 0.
        settings: the model and its discretisation.
        duration: of the motion [s].
        start: rotation at the start [rad]; None for the end of the design's path.
        check: whether a companion motion estimates how well control points, or elements, resolve the motion.
        options: `step` [s], `integrator`, `accuracy` [rad, of the splines] and the largest number of
            `records`, which the model checks; None for its default.

    Raises:
        BadInput: a setting or option that the model rejects, or a design without bodies; one line.
    """
    if design.body is None:
        raise BadInput("bodies: got none, expected a body whose motion is computed")
    start, model = design.rotation if start is None else start, model_of(settings)
    how = {"duration": duration} | {name: value for name, value in options.items() if value is not None}
    if isinstance(settings, FeSettings):
        if "accuracy" in how:
            expected = "none for a motion of the finite elements, whose --elements are as given [rad]"
            raise BadInput(f"accuracy: got {how['accuracy']!r}, expected {expected}")
        how = {"samples" if name == "records" else name: value for name, value in how.items()}
        how["raise_on_failure"] = False
    begin = perf_counter()
    asked = put(design, settings, moving=True)
    try:
        with asked.refusals():
            at = {"start": start, "body": design.body} | _drive_of(asked)
            result = model.solve_motion(asked.modelled, check=False, **at, **how)
    except model.ConvergenceError as error:
        message = f"statics does not reach the start: {error}"
        return Motion(asked=asked, status="not_converged", message=message)
    wall = perf_counter() - begin
    if check:
        result = model.dynamics.checked(asked.modelled, result, **at)
    answer = Motion.of(asked, result, wall_s=wall)
    return _weighed(answer, settings, start) if answer.starts_still and answer.converged else answer


def answer_modes(
    design: Design,
    settings: Settings,
    *,
    rotation: float | None = None,
    count: int = 10,
    held: bool = False,
    accuracy: float | None = None,
) -> Spectrum:
    """Return the lowest natural modes about a static state, by the settings' model.

    They are of the coordinates that a release from that state frees: the driven rotation, unless it is
    `held`, and driven displacements without a history. In the state weight, pre-strain, driven displacements
    and loads are in full.

    Args:
        design: the pivot or mechanism.
        settings: names the model and its discretisation.
        rotation: of the static state [rad]; None for 0 of a pivot, and for no driven rotation of a mechanism.
        count: of modes [1].
        held: whether the rotation is held; if not, the driving torque acts on as it is.
        accuracy: wanted relative error of the frequencies [1], which control points or elements are raised
            for; None for those of the settings.

    Raises:
        BadInput: a setting or option that the model refuses; one line.
    """
    asked = put(design, settings, moving=True)
    still = rotation is None and (held or design.crossing_point is not None)
    how: dict[str, Any] = {"count": count, "held": held, "rotation": 0.0 if still else rotation}
    how |= {} if accuracy is None else {"accuracy": accuracy}
    state: dict[str, Any] = {"turned": rotation or 0.0, "held": held, "count": count}
    begin = perf_counter()
    try:
        with asked.refusals():
            found = asked.model.natural_frequencies(asked.modelled, body=design.body, **how)
    except asked.model.ConvergenceError as error:
        return Spectrum.of(asked, None, message=f"statics does not reach the state: {error}", **state)
    return Spectrum.of(asked, found, wall_s=perf_counter() - begin, **state)


def _weighed(answer: Motion, settings: Settings, start: float | None) -> Motion:
    """Return a motion that starts in equilibrium; its message reports this, and an unstable equilibrium.

    Not asked where a load or a drive has a history, as modes are about the state under full loads. A load
    that follows its body has no modes: the stability is not judged then, which the message says. Strips of
    extreme slenderness have forces of release below the round-off of their axial forces: the energy of the
    motion decides there whether it moves.
    """
    design, effects = answer.design, answer.design.effects
    every = [own for name in effects.tables for own in effects.every(name)]
    if design.history or design.held or any(own.get("history") for own in every):
        return answer
    if any(own.get("follower") for own in every):
        return replace(answer, message=NOT_JUDGED, resolution="")
    moved = float(answer.kinetic_energy.max(initial=0.0)) > MOVED * flexural_scale(design)
    try:
        fall = answer_modes(design, settings, rotation=start, count=1).falls_in
    except BadInput as refused:
        told = f"the stability of the start is not judged: {refused}" if moved else NOTHING_MOVES
        return replace(answer, message=told)
    if fall is not None:
        return replace(answer, message=UNSTABLE.format(fall), resolution="")
    return answer if moved else replace(answer, message=NOTHING_MOVES, resolution="")


def _drive_of(asked: Asked) -> dict[str, Any]:
    """Return the model's drive of the rotation in a motion, by its keyword; none if the rotation is released.

    Raises:
        BadInput: a mechanism without a rotation; InvalidParameter of the model.
    """
    design = asked.design
    given = {"history": design.history, "held": design.held}
    given = {name: value for name, value in given.items() if value is not None}
    if not given:
        return {}
    if design.rotation is None:
        raise BadInput("drive.rotation_deg: got none, expected the rotation that a history or held_s leads")
    return {"drive": asked.model.DrivenRotation(body=design.body, angle=design.rotation, **given)}


#: What either model calls its answers -> their neutral form.
FORMS = {"StaticSolution": Response, "Trajectory": Motion, "Modes": Spectrum}


def answer_of(solution: Any, modelled: Any) -> Answer:
    """Return the neutral answer of a solution that a model returned directly.

    Args:
        solution: static solution, trajectory or modes of `spline_model` or `fe_reference`.
        modelled: its pivot or mechanism in the model. The answer has a stress if the sections have sides.

    Raises:
        BadInput: another object, or parts of two models; one line.
    """
    package = type(solution).__module__.partition(".")[0]
    form: Any = FORMS.get(type(solution).__name__)
    if form is None or type(modelled).__module__.partition(".")[0] != package:
        got = f"{type(solution).__name__} and {type(modelled).__name__}"
        raise BadInput(
            f"solution: got {got}, expected a static solution, a trajectory or modes, with their design"
        )
    settings = SplineSettings() if package == "spline_model" else FeSettings(element=modelled.element)
    body = getattr(solution, "driven", None) or getattr(solution, "body", None)
    design = _design_of(modelled, body)
    state = {"turned": solution.rotation, "held": solution.held} if form is Spectrum else {}
    found: Answer = form.of(Asked(design, settings, form is not Response, modelled), solution, **state)
    return found


def _design_of(modelled: Any, body: str | None) -> Mechanism:
    """Return the design of a pivot or mechanism of a model."""
    given = getattr(modelled, "design", modelled)
    bodies = tuple(Body(**_taken(Body, each)) for each in given.bodies)
    strips = tuple(Strip(**_taken(Strip, each)) for each in given.strips)
    moved = body or next((each.name for each in bodies), None)
    how: dict[str, Any] = {"rotation": None, "increments": 1, "effects": Effects()}
    return Mechanism(strips=strips, bodies=bodies, body=moved, **how)


def _taken(kind: Any, part: Any) -> dict[str, Any]:
    """Return what a part of a model has of the attributes of a part of a case."""
    return {each.name: getattr(part, each.name) for each in fields(kind) if hasattr(part, each.name)}
