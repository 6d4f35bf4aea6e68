"""Put a design to either model, and get a neutral answer: static paths here, motions from `moving`."""

from typing import Any

from studies.answers.assembly import MechanismResponse, MechanismResult, mechanism_response
from studies.answers.models import built, effects_of, model_of, refusals
from studies.answers.moving import WARM_UP_ROTATION, answer_modes, answer_release, solve_s, spline_mechanism
from studies.answers.response import Response, StaticResult, assembled, response
from studies.answers.settings import Settings
from studies.cases.mechanism import Mechanism
from studies.cases.problem import Problem
from studies.kinds import Progress
from studies.record.timing import measure

__all__ = ["answer_mechanism", "answer_modes", "answer_release", "answer_static", "spline_mechanism"]


def answer_static(
    problem: Problem,
    settings: Settings,
    *,
    accuracy: float | None = None,
    repeat: int = 1,
    raise_on_failure: bool = False,
    progress: Progress | None = None,
) -> Response:
    """Solve the static path of `problem` with the model that `settings` belongs to.

    `wall_s` of the response is the median time of `repeat` solves of the whole path, without import,
    compilation and set-up: a short solve comes before, and when `repeat` is above 1 a whole one. `solve_s` is
    the median of what the model says its increments alone took.

    Args:
        problem: the design and the path.
        settings: names the model and its discretisation.
        accuracy: wanted error of trajectory and torque [1], which the spline's control points are raised for;
            None for those of the settings.
        repeat: timed solves of the whole path [1].
        raise_on_failure: raise the model's `ConvergenceError` rather than return the converged part of the
            path.
        progress: called with increments done and increments in all.

    Raises:
        BadInput: a setting that the model refuses; one line.
    """
    model = model_of(settings)
    pivot, keywords = built(model, problem, settings, moving=False)

    def solve(rotation: float, increments: int, **options: Any) -> StaticResult:
        result: StaticResult = model.statics.solve_statics(
            pivot, rotation=rotation, increments=increments, order=problem.order, **options
        )
        return result

    def whole_path() -> StaticResult:
        options = {} if accuracy is None else {"accuracy": accuracy}
        return solve(
            problem.rotation,
            problem.increments,
            raise_on_failure=raise_on_failure,
            progress=progress,
            **options,
        )

    with refusals(model, settings):
        solve(WARM_UP_ROTATION, 1, raise_on_failure=False)
        timing = measure(whole_path, repeat=repeat, warm_up=1 if repeat > 1 else 0, part=solve_s)
    return response(
        problem,
        timing.result,
        model=settings.model,
        settings=keywords,
        effects=assembled(effects_of(pivot)),
        wall_s=timing.median,
        solve_s=timing.median_part,
    )


def answer_mechanism(
    mechanism: Mechanism,
    settings: Settings,
    *,
    accuracy: float | None = None,
    repeat: int = 1,
    raise_on_failure: bool = False,
    progress: Progress | None = None,
) -> MechanismResponse:
    """Solve the path of any mechanism from load factor 0 to 1; arguments and errors as of `answer_static`.

    The path is that of the driven rotation and of the loads in the design's order, or of the loads alone.
    """
    model = model_of(settings)
    asked, keywords = built(model, mechanism, settings, moving=False)
    wanted = {} if accuracy is None else {"accuracy": accuracy}

    def whole_path(increments: int = mechanism.increments, **options: Any) -> MechanismResult:
        drive = {"body": mechanism.body, "rotation": mechanism.rotation, "order": mechanism.order}
        result: MechanismResult = model.statics.solve_mechanism(
            asked, **drive, increments=increments, **wanted, **options
        )
        return result

    with refusals(model, settings):
        whole_path(1, raise_on_failure=False)
        timing = measure(
            lambda: whole_path(raise_on_failure=raise_on_failure, progress=progress),
            repeat=repeat,
            warm_up=1 if repeat > 1 else 0,
            part=solve_s,
        )
    return mechanism_response(
        timing.result,
        model=settings.model,
        settings=keywords,
        wall_s=timing.median,
        solve_s=timing.median_part,
    )
