"""Put a problem to either model: the one file that knows both."""

from collections.abc import Callable
from types import ModuleType
from typing import Any

from studies.answers.response import Response, StaticResult, response
from studies.answers.settings import FeSettings, Settings
from studies.cases.problem import Problem
from studies.errors import BadInput
from studies.record.timing import measure

Progress = Callable[[int, int], None]

#: Rotation of the first solve, which only compiles [rad]: small enough for any design and discretisation.
WARM_UP_ROTATION = 1e-3


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
    pivots, statics, refusal = _model(settings)
    try:
        pivot = pivots.cross_axis_pivot(**problem.pivot_parameters(), **settings.keywords())
    except refusal as error:
        raise BadInput(f"{settings.model}: {error}") from None

    def solve(rotation: float, increments: int, **keywords: Any) -> StaticResult:
        result: StaticResult = statics.solve_statics(
            pivot, rotation=rotation, increments=increments, **keywords
        )
        return result

    def whole_path() -> StaticResult:
        return solve(
            problem.rotation, problem.increments, raise_on_failure=raise_on_failure, progress=progress
        )

    solve(WARM_UP_ROTATION, 1, raise_on_failure=False)
    timing = measure(whole_path, repeat=repeat, warm_up=1 if repeat > 1 else 0)
    return response(
        problem,
        timing.result,
        model=settings.model,
        settings=settings.keywords(),
        wall_s=timing.median,
    )


def _model(settings: Settings) -> tuple[ModuleType, ModuleType, type[Exception]]:
    """Return the settings' model, its pivot and statics modules and what it raises for a refused parameter.

    The other model is not even imported.
    """
    if isinstance(settings, FeSettings):
        import fe_reference.errors
        import fe_reference.pivot
        import fe_reference.statics

        return fe_reference.pivot, fe_reference.statics, fe_reference.errors.InvalidParameter
    import spline_model.errors
    import spline_model.pivot
    import spline_model.statics

    return spline_model.pivot, spline_model.statics, spline_model.errors.InvalidParameter
