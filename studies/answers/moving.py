"""Put a design in motion to either model: its release, how long it is worth following, its natural modes."""

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import numpy as np

from studies.answers.models import Model, built, effects_of, is_given, model_of, refusals
from studies.answers.motion import Motion, motion, no_motion
from studies.answers.settings import Settings, SplineSettings
from studies.answers.spectrum import Spectrum, no_spectrum, spectrum
from studies.cases.design import Design, flexural_scale
from studies.cases.mechanism import Mechanism
from studies.cases.problem import Problem
from studies.errors import BadInput
from studies.record.timing import measure

#: Rotation of the first solve, which only compiles [rad]: small enough for any design and discretisation.
WARM_UP_ROTATION = 1e-3
#: The body of a pivot, as both models call it.
PIVOT_BODY = "body"
#: Duration of the first release, which only compiles [s], unless its step is longer.
WARM_UP_DURATION = 1e-3
#: Swings that are followed beyond what the design is led through, and steps in each.
SWINGS, STEPS = 4, 256
#: Modes that a step resolves, if they are at most so many times as fast as the first: steps in each period.
MODES, FASTEST, LEAST_STEPS = 3, 40.0, 20
#: Duration of what has no first frequency [s].
USUAL = 0.05


def answer_release(
    design: Design,
    settings: Settings,
    *,
    duration: float,
    start: float | None = None,
    records: int | None = None,
    repeat: int = 1,
    check: bool = False,
    **options: Any,
) -> Motion:
    """Let a design go at rest from a static state and follow the motion.

    The start is in equilibrium with the body driven to a rotation, weight and pre-strain in full, and every
    load and driven displacement at its value times its history at t = 0. Then the rotation is let go, unless
    the design leads it on, and driven displacements without a history; loads follow their histories.

    `wall_s` of the motion is the median time of `repeat` releases, less that of releases that are over after
    their first record: so the static path to the start, and what is set up, are left out. A short release
    comes before, and when `repeat` is above 1 a whole one.

    Args:
        design: the pivot or mechanism; of one without a rotation none is driven: it begins where all that
            acts at t = 0 settles it.
        settings: names the model and its discretisation.
        duration: of the motion [s].
        start: rotation at the start [rad]; None for the end of the design's path.
        check: whether a companion motion says how far the model's control points, or elements, resolve it.
        records: largest number of records; None for what the model keeps.
        repeat: timed releases [1].
        options: `step` [s], `integrator` and `accuracy` [rad], as the model names and checks them; None for
            its own choice.

    Raises:
        BadInput: a setting or option that the model refuses, a design without bodies; one line.
    """
    body = _reported(design)
    if body is None:
        expected = (
            "a body whose swing is followed; `export --analysis release` has the motion of strips alone"
        )
        raise BadInput(f"bodies: got none, expected {expected}")
    model = model_of(settings)
    asked, keywords = built(model, design, settings, moving=True)
    given = {name: value for name, value in options.items() if value is not None} | model.release_options
    if records is not None:
        given[model.records] = records
    identity = {"model": settings.model, "settings": keywords, "effects": effects_of(asked)}
    angle = design.rotation if start is None else start
    with refusals(model, settings):
        drive = drive_of(model, design)
    run = _release_of(model, design, asked, drive)

    def release(**changes: Any) -> Any:
        return run(**({"start": angle, "duration": duration, "check": False} | given | changes))

    with suppress(model.errors.InvalidParameter, model.errors.ConvergenceError):
        short = min(duration, max(WARM_UP_DURATION, given.get("step", 0.0)))
        release(start=WARM_UP_ROTATION, duration=short)
    try:
        with refusals(model, settings):
            timing = measure(release, repeat=repeat, warm_up=1 if repeat > 1 else 0, part=solve_s)
    except model.errors.ConvergenceError as error:
        return no_motion(
            f"statics does not reach the start: {error}",
            names=_body_names(design),
            body=body,
            **identity,
        )
    result = timing.result
    if check:
        result = model.dynamics.checked(asked, result, start=angle, body=_reported(design), **drive)
    return motion(
        result,
        bodies=_places(result),
        body=body,
        wall_s=max(timing.median - _wall_of_start(release, timing.result, repeat), 0.0),
        solve_s=timing.median_part,
        energy=flexural_scale(design),
        **identity,
    )


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

    They are of what a release from that state lets go of: the driven rotation, unless it is `held`, and
    driven displacements without a history. In the state weight, pre-strain, driven displacements and loads
    are in full.

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
    model = model_of(settings)
    asked, keywords = built(model, design, settings, moving=is_given(settings))
    options = {} if accuracy is None else {"accuracy": accuracy}
    body = _reported(design)
    state = state_of(design, rotation, held=held)
    identity: dict[str, Any] = {
        "model": settings.model,
        "settings": keywords,
        "effects": effects_of(asked),
        "rotation": rotation or 0.0,
        "body": body,
    }
    try:
        with refusals(model, settings):
            timing = measure(
                lambda: model.modes.natural_frequencies(
                    asked, rotation=state, count=count, held=held, body=body, **options
                ),
                repeat=1,
                warm_up=0,
            )
    except model.errors.ConvergenceError as error:
        return no_spectrum(f"statics does not reach the state: {error}", held=held, **identity)
    names = _body_names(design)
    place = names.index(body) if model.all_shapes and body is not None else 0
    return spectrum(timing.result, place=place, wall_s=timing.median, **identity)


def state_of(design: Design, rotation: float | None, *, held: bool) -> float | None:
    """Return the rotation that is driven in the static state of modes [rad]; None for none."""
    return 0.0 if rotation is None and (held or isinstance(design, Problem)) else rotation


def spline_mechanism(design: Design, settings: SplineSettings) -> Any:
    """Return the spline model's mechanism of a design, as it is in motion; errors as of `answer_release`."""
    asked, _ = built(model_of(settings), design, settings, moving=True)
    return asked


def solve_s(result: Any) -> float:
    """Return what the increments or steps of a solution took, without what is made before and after [s]."""
    return float(result.seconds["solve"])


def _wall_of_start(release: Callable[..., Any], result: Any, repeat: int) -> float:
    """Return the median time of releases that are over after the first record of `result` [s]."""
    if len(result.time) <= 2:
        return 0.0
    # a little longer than the first record, lest round-off make the step longer than the duration
    brief: dict[str, float | None] = {"duration": float(result.time[1]) * (1.0 + 1e-9)}
    if getattr(result, "estimate", None) is not None:  # the step that was chosen, without the search for it
        brief["accuracy"] = None
    brief |= {name: value for name, value in (("step", result.settings.get("step_s")),) if value}
    return measure(lambda: release(**brief), repeat=repeat, warm_up=0).median


def drive_of(model: Model, design: Design) -> dict[str, Any]:
    """Return the model's drive of a rotation that a motion goes on with, by its keyword; none if it lets go.

    Raises:
        BadInput: a mechanism without a rotation; InvalidParameter of the model.
    """
    given = {"history": design.history, "held": design.held}
    given = {name: value for name, value in given.items() if value is not None}
    if not given:
        return {}
    if design.rotation is None:
        raise BadInput("drive.rotation_deg: got none, expected the rotation that a history or held_s leads")
    return {"drive": model.drive(body=_reported(design), angle=design.rotation, **given)}


def _release_of(model: Model, design: Design, asked: Any, drive: Mapping[str, Any]) -> Callable[..., Any]:
    """Return what releases the design in the model, by the keywords `start`, `duration` and options."""
    if isinstance(design, Problem):

        def release_pivot(**keywords: Any) -> Any:
            return model.dynamics.solve_release(asked, **drive, **keywords)

        return release_pivot

    def release(start: float | None, **keywords: Any) -> Any:
        return model.dynamics.solve_motion(asked, start=start, body=design.body, **drive, **keywords)

    return release


def _reported(design: Design) -> str | None:
    """Return the name of the body that is driven and whose swing is reported."""
    return design.body if isinstance(design, Mechanism) else PIVOT_BODY


def _body_names(design: Design) -> list[str]:
    return [body.name for body in design.bodies] if isinstance(design, Mechanism) else [PIVOT_BODY]


def _places(result: Any) -> Mapping[str, Any]:
    """Return the places of all bodies by name, (T, 3), from a trajectory of many or of one."""
    if hasattr(result, "bodies"):
        places: Mapping[str, Any] = result.bodies
        return places
    return {PIVOT_BODY: np.column_stack((result.centre, result.rotation))}


@dataclass(frozen=True, kw_only=True)
class Pace:
    """Duration of a motion [s], and step [s]; None for the model's own."""

    duration: float
    step: float | None


def pace(design: Design, settings: Settings) -> Pace:
    """Return the pace of the design's first mode at rest, after all histories of loads and drives.

    Exact for nothing: of what has no stable mode it is the usual duration in the model's own steps.
    """
    found = answer_modes(design, settings, count=MODES)
    frequency = found.frequency[found.frequency > 0.0]
    led = _last_time(design)
    if not found.converged or not frequency.size:
        return Pace(duration=led + USUAL, step=None)
    first = float(frequency[0])
    last = float(frequency[frequency <= FASTEST * first].max())
    return Pace(duration=led + SWINGS / first, step=1.0 / max(STEPS * first, LEAST_STEPS * last))


def _last_time(design: Design) -> float:
    """Return when the last history of a load or a drive is over [s]."""
    histories = [design.history or ()]
    histories += [design.effects.tables.get(name, {}).get("history") or () for name in design.effects.names]
    times = [float(time) for history in histories for time, _ in np.reshape(history, (-1, 2))]
    return float(max([0.0, *times, *(design.held or ())]))
