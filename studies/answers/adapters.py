"""Put a problem to either model: the one file that knows both."""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from types import ModuleType
from typing import Any

from studies.answers.motion import Motion, Spectrum, motion, no_motion, no_spectrum, spectrum
from studies.answers.response import Response, StaticResult, response
from studies.answers.settings import FeSettings, Settings
from studies.cases.problem import Problem
from studies.errors import BadInput
from studies.record.timing import measure

Progress = Callable[[int, int], None]

#: Rotation of the first solve, which only compiles [rad]: small enough for any design and discretisation.
WARM_UP_ROTATION = 1e-3
#: Duration of the first release, which only compiles [s], unless its step is longer.
WARM_UP_DURATION = 1e-3


def answer_static(
    problem: Problem,
    settings: Settings,
    *,
    repeat: int = 1,
    raise_on_failure: bool = False,
    progress: Progress | None = None,
) -> Response:
    """Solve the static path of `problem` with the model that `settings` belongs to.

    `wall_s` of the response is the median time of `repeat` solves of the whole path, without import,
    compilation and set-up: a short solve comes before, and when `repeat` is above 1 a whole one.

    Args:
        problem: the design and the path.
        settings: names the model and its discretisation.
        repeat: timed solves of the whole path [1].
        raise_on_failure: raise the model's `ConvergenceError` rather than return the converged part of the
            path.
        progress: called with increments done and increments in all.

    Raises:
        BadInput: a setting that the model refuses; one line.
    """
    model = _model(settings)
    pivot, keywords = _pivot(model, problem, settings, moving=False)

    def solve(rotation: float, increments: int, **options: Any) -> StaticResult:
        result: StaticResult = model.statics.solve_statics(
            pivot, rotation=rotation, increments=increments, **options
        )
        return result

    def whole_path() -> StaticResult:
        return solve(
            problem.rotation, problem.increments, raise_on_failure=raise_on_failure, progress=progress
        )

    solve(WARM_UP_ROTATION, 1, raise_on_failure=False)
    timing = measure(whole_path, repeat=repeat, warm_up=1 if repeat > 1 else 0)
    return response(problem, timing.result, model=settings.model, settings=keywords, wall_s=timing.median)


def answer_release(
    problem: Problem,
    settings: Settings,
    *,
    duration: float,
    start: float | None = None,
    records: int | None = None,
    repeat: int = 1,
    **options: Any,
) -> Motion:
    """Drive the pivot to a rotation, let it go at rest and follow its motion.

    `wall_s` of the motion is the median time of `repeat` releases, less that of releases that are over after
    their first record: so the static path to the start, and what is set up, are left out. A short release
    comes before, and when `repeat` is above 1 a whole one.

    Args:
        problem: the design.
        settings: names the model and its discretisation.
        duration: of the motion [s].
        start: rotation at the start [rad]; None for the end of the problem's path.
        records: largest number of records; None for what the model keeps.
        repeat: timed releases [1].
        options: `step` [s], `integrator` and `accuracy` [rad], as the model names and checks them; None for
            its own choice.

    Raises:
        BadInput: a setting or option that the model refuses; one line.
    """
    model = _model(settings)
    pivot, keywords = _pivot(model, problem, settings, moving=True)
    given = {name: value for name, value in options.items() if value is not None} | model.release_options
    if records is not None:
        given[model.records] = records
    angle = problem.rotation if start is None else start

    def release(**changes: Any) -> Any:
        keywords = {"start": angle, "duration": duration} | given | changes
        return model.dynamics.solve_release(pivot, **keywords)

    with suppress(model.errors.InvalidParameter, model.errors.ConvergenceError):
        short = min(duration, max(WARM_UP_DURATION, given.get("step", 0.0)))
        release(start=WARM_UP_ROTATION, duration=short)
    try:
        timing = measure(release, repeat=repeat, warm_up=1 if repeat > 1 else 0)
    except model.errors.InvalidParameter as error:
        raise BadInput(f"{settings.model}: {error}") from None
    except model.errors.ConvergenceError as error:
        message = f"statics does not reach the start: {error}"
        return no_motion(message, model=settings.model, settings=keywords)
    wall = timing.median
    if len(timing.result.time) > 2:
        # a little longer than the first record, lest round-off make the step longer than the duration
        brief = {"duration": float(timing.result.time[1]) * (1.0 + 1e-9)}
        brief |= {name: value for name, value in (("step", timing.result.settings.get("step_s")),) if value}
        wall -= measure(lambda: release(**brief), repeat=repeat, warm_up=0).median
    return motion(timing.result, model=settings.model, settings=keywords, wall_s=max(wall, 0.0))


def answer_modes(
    problem: Problem,
    settings: Settings,
    *,
    rotation: float = 0.0,
    count: int = 10,
    held: bool = False,
) -> Spectrum:
    """Return the lowest natural modes about the static state at a rotation, by the settings' model.

    Args:
        problem: the design.
        settings: names the model and its discretisation.
        rotation: of the static state [rad].
        count: of modes [1].
        held: whether the rotation is held; if not, the driving torque acts on as it is.

    Raises:
        BadInput: a setting or option that the model refuses; one line.
    """
    model = _model(settings)
    pivot, keywords = _pivot(model, problem, settings, moving=True)
    try:
        timing = measure(
            lambda: model.modes.natural_frequencies(pivot, rotation=rotation, count=count, held=held),
            repeat=1,
            warm_up=0,
        )
    except model.errors.InvalidParameter as error:
        raise BadInput(f"{settings.model}: {error}") from None
    except model.errors.ConvergenceError as error:
        message = f"statics does not reach the state: {error}"
        return no_spectrum(message, model=settings.model, settings=keywords, rotation=rotation, held=held)
    return spectrum(timing.result, model=settings.model, settings=keywords, wall_s=timing.median)


@dataclass(frozen=True, kw_only=True)
class _Model:
    """The modules of one model, the same names in both, and what differs in how they are asked.

    Attributes:
        records: keyword for the largest number of records of a motion.
        release_options: keywords that every release takes.
        moving: discretisation keywords of a pivot in motion, from its settings, where they say nothing.
    """

    pivot: ModuleType
    statics: ModuleType
    dynamics: ModuleType
    modes: ModuleType
    errors: ModuleType
    records: str
    release_options: dict[str, Any]
    moving: Callable[[Settings], dict[str, Any]]


def _model(settings: Settings) -> _Model:
    """Return the settings' model; the other one is not even imported."""
    if isinstance(settings, FeSettings):
        import fe_reference.dynamics
        import fe_reference.errors
        import fe_reference.modes
        import fe_reference.pivot
        import fe_reference.statics

        return _Model(
            pivot=fe_reference.pivot,
            statics=fe_reference.statics,
            dynamics=fe_reference.dynamics,
            modes=fe_reference.modes,
            errors=fe_reference.errors,
            records="samples",
            release_options={"raise_on_failure": False},
            moving=lambda settings: {},
        )
    import spline_model.dynamics
    import spline_model.errors
    import spline_model.modes
    import spline_model.pivot
    import spline_model.statics

    return _Model(
        pivot=spline_model.pivot,
        statics=spline_model.statics,
        dynamics=spline_model.dynamics,
        modes=spline_model.modes,
        errors=spline_model.errors,
        records="records",
        release_options={},
        moving=_swinging_spline,
    )


def _swinging_spline(settings: Settings) -> dict[str, Any]:
    """Return the slide stiffness of a spline in motion, which goes with the number of control points."""
    from spline_model.design import Discretisation
    from spline_model.pivot import swinging_slide_stiffness

    given = settings.keywords().get("control_points", Discretisation.control_points)
    return {"slide_stiffness": swinging_slide_stiffness(given)}


def _pivot(
    model: _Model, problem: Problem, settings: Settings, *, moving: bool
) -> tuple[Any, dict[str, Any]]:
    """Return the pivot and the keywords of its discretisation, with the model's defaults for one in motion.

    Raises:
        BadInput: a setting that the model refuses; one line.
    """
    keywords = settings.keywords()
    if moving:
        keywords = model.moving(settings) | keywords
    try:
        return model.pivot.cross_axis_pivot(**problem.pivot_parameters(), **keywords), keywords
    except model.errors.InvalidParameter as error:
        raise BadInput(f"{settings.model}: {error}") from None
