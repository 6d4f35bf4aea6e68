"""Put a design to either model, and get a neutral answer: static paths here, motions from `moving`."""

from collections.abc import Callable
from typing import Any

from studies.answers.models import Model, built, effects_of, model_of, refusals
from studies.answers.moving import WARM_UP_ROTATION, answer_modes, answer_release, solve_s, spline_mechanism
from studies.answers.response import MechanismResponse, Response, mechanism_response, response
from studies.answers.settings import Settings
from studies.cases.design import Design
from studies.cases.mechanism import Mechanism
from studies.cases.problem import Problem
from studies.kinds import Progress
from studies.record.timing import measure

__all__ = [
    "answer_mechanism",
    "answer_modes",
    "answer_path",
    "answer_release",
    "answer_static",
    "spline_mechanism",
]


def answer_static(problem: Problem, settings: Settings, **options: Any) -> Response:
    """Solve the static path of `problem` with the model that `settings` belongs to.

    `wall_s` of the response is the median time of `repeat` solves of the whole path, without import,
    compilation and set-up: a short solve comes before, and when `repeat` is above 1 a whole one. `solve_s` is
    the median of what the model says its increments alone took.

    Args:
        problem: the design and the path.
        settings: names the model and its discretisation.
        options: as of `_timed`.

    Raises:
        BadInput: a setting that the model refuses; one line.
    """
    model = model_of(settings)
    pivot, keywords = built(model, problem, settings, moving=False)

    def path(**how: Any) -> Any:
        given = {"rotation": problem.rotation, "increments": problem.increments, "order": problem.order}
        return model.statics.solve_statics(pivot, **(given | how))

    result, times = _timed(model, settings, path, {"rotation": WARM_UP_ROTATION}, **options)
    return response(
        problem, result, model=settings.model, settings=keywords, effects=effects_of(pivot), **times
    )


def answer_mechanism(mechanism: Mechanism, settings: Settings, **options: Any) -> MechanismResponse:
    """Solve the path of any mechanism from load factor 0 to 1; arguments and errors as of `answer_static`.

    The path is that of the driven rotation and of the loads in the design's order, or of the loads alone.
    """
    model = model_of(settings)
    asked, keywords = built(model, mechanism, settings, moving=False)

    def path(**how: Any) -> Any:
        given = {"body": mechanism.body, "rotation": mechanism.rotation, "order": mechanism.order}
        return model.statics.solve_mechanism(asked, **(given | {"increments": mechanism.increments} | how))

    result, times = _timed(model, settings, path, {}, **options)
    return mechanism_response(mechanism, result, model=settings.model, settings=keywords, **times)


def answer_path(design: Design, settings: Settings, **options: Any) -> Response | MechanismResponse:
    """Solve the static path of any design; arguments and errors as of `answer_static`."""
    if isinstance(design, Problem):
        return answer_static(design, settings, **options)
    return answer_mechanism(design, settings, **options)


def _timed(
    model: Model,
    settings: Settings,
    path: Callable[..., Any],
    short: dict[str, Any],
    *,
    accuracy: float | None = None,
    repeat: int = 1,
    raise_on_failure: bool = False,
    progress: Progress | None = None,
) -> tuple[Any, dict[str, float]]:
    """Return a model's solution of a path, and its times.

    Args:
        path: solves it; short: what makes of it a short one.
        accuracy: wanted error of trajectory and torque [1], which control points or elements are raised for;
            None for those of the settings.
        repeat: timed solves of the whole path [1].
        raise_on_failure: raise the model's `ConvergenceError` rather than return the converged part of the
            path.
        progress: called with increments done and increments in all.
    """
    wanted = {} if accuracy is None else {"accuracy": accuracy}
    with refusals(model, settings):
        path(**short, increments=1, raise_on_failure=False)
        timing = measure(
            lambda: path(raise_on_failure=raise_on_failure, progress=progress, **wanted),
            repeat=repeat,
            warm_up=1 if repeat > 1 else 0,
            part=solve_s,
        )
    return timing.result, {"wall_s": timing.median, "solve_s": timing.median_part}
