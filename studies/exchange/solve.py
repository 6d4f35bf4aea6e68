"""Solve a design by either model for the fields along its strips: static path, motion or natural modes."""

from typing import Any

from studies.answers.adapters import answer_path
from studies.answers.fields import Fields
from studies.answers.models import as_solved, built, is_given, model_of, refusals
from studies.answers.moving import drive_of, state_of
from studies.answers.settings import Settings
from studies.cases.design import Design
from studies.cases.problem import Problem
from studies.exchange.solutions import described, fields_of, solved_fields
from studies.kinds import Progress


class NoState(ValueError):
    """Statics does not reach the state that a motion or modes begin at; the text says where it stops."""


def static_fields(design: Design, settings: Settings, *, progress: Progress | None = None) -> Fields:
    """Return the fields of the states of a design's static path, the converged part if it stops early.

    Raises:
        BadInput: a setting that the model refuses; one line.
    """
    return fields_of(answer_path(design, settings, progress=progress), design)


def release_fields(
    design: Design, settings: Settings, *, duration: float, records: int, **options: Any
) -> Fields:
    """Return the fields of the records of a motion after a release from the end of the design's static path.

    Args:
        design, settings: as in `static_fields`.
        duration: of the motion [s].
        records: largest number of records [1], the start apart.
        options: `step` [s] and `integrator`; None for the model's own choice.

    Raises:
        BadInput: a setting or option that the model refuses; one line.
        NoState: statics does not reach the start.
    """
    model = model_of(settings)
    asked, _ = built(model, design, settings, moving=True)
    given = {name: value for name, value in options.items() if value is not None} | model.release_options
    given |= {"duration": duration, model.records: records, "check": False}
    with refusals(model, settings):
        given |= drive_of(model, design)
        try:
            if isinstance(design, Problem):
                result = model.dynamics.solve_release(asked, start=design.rotation, **given)
            else:
                begin = design.rotation
                result = model.dynamics.solve_motion(asked, start=begin, body=design.body, **given)
        except model.errors.ConvergenceError as error:
            raise NoState(f"statics does not reach the start: {error}") from None
    asked, keywords = as_solved(model, design, settings, result, moving=True)
    return solved_fields(model, asked, result, _about(design, settings, keywords | dict(result.settings)))


def mode_fields(design: Design, settings: Settings, *, count: int, held: bool) -> Fields:
    """Return the fields of the lowest modes about the end of a design's static path, or about rest.

    Args:
        design, settings: as in `static_fields`; loads act in full.
        count: of modes [1].
        held: whether the rotation is held.

    Raises:
        BadInput: a setting or option that the model refuses; one line.
        NoState: statics does not reach the rotation.
    """
    model = model_of(settings)
    asked, keywords = built(model, design, settings, moving=is_given(settings))
    body = "body" if isinstance(design, Problem) else design.body
    about = state_of(design, design.rotation, held=held)
    with refusals(model, settings):
        try:
            result = model.modes.natural_frequencies(asked, rotation=about, count=count, held=held, body=body)
        except model.errors.ConvergenceError as error:
            raise NoState(f"statics does not reach the state: {error}") from None
    asked, keywords = as_solved(model, design, settings, result, moving=True)
    return solved_fields(model, asked, result, _about(design, settings, keywords))


def _about(design: Design, settings: Settings, keywords: dict[str, Any]) -> dict[str, Any]:
    return described(design) | {"model": settings.model, "settings": keywords}
