"""Solve a design by either model for the fields along its strips: static path, motion or natural modes."""

from typing import Any

import numpy as np

from studies.answers.fields import Fields, blocks_of, parts_of, strip_arrays
from studies.answers.models import as_solved, built, effects_of, is_given, model_of, refusals
from studies.answers.moving import drive_of, state_of
from studies.answers.response import assembled
from studies.answers.settings import Settings
from studies.cases.design import Design
from studies.cases.problem import Problem
from studies.kinds import Array, Progress

#: Arrays of the design, not of its states.
GIVEN = ("arc_length", "rest_shape", "rest_bodies")


class NoState(ValueError):
    """Statics does not reach the state that a motion or modes begin at; the text says where it stops."""


def static_fields(design: Design, settings: Settings, *, progress: Progress | None = None) -> Fields:
    """Return the fields of the states of a design's static path, the converged part if it stops early.

    Raises:
        BadInput: a setting that the model refuses; one line.
    """
    model = model_of(settings)
    asked, keywords = built(model, design, settings, moving=False)
    how: dict[str, Any] = {"increments": design.increments, "order": design.order, "progress": progress}
    how["raise_on_failure"] = False
    with refusals(model, settings):
        if isinstance(design, Problem):
            result = model.statics.solve_statics(asked, rotation=design.rotation, **how)
        else:
            drive = {"body": design.body, "rotation": design.rotation}
            result = model.statics.solve_mechanism(asked, **drive, **how)
    asked, keywords = as_solved(model, design, settings, result, moving=False)
    return Fields(
        **_identity("static", design, settings, keywords),
        **_ended(result),
        effects=assembled(effects_of(asked)),
        series="load_factor",
        values=np.asarray(result.load_factor),
        torque=None if np.isnan(result.torque).all() else np.asarray(result.torque),
        **strip_arrays(model.static_fields(asked, result.states)),
    )


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
    asked, keywords = built(model, design, settings, moving=True)
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
    return Fields(
        **_identity("release", design, settings, keywords | dict(result.settings)),
        **_ended(result),
        effects=effects_of(asked),
        series="time_s",
        values=np.asarray(result.time),
        **strip_arrays(model.moving_fields(asked, result.states)),
    )


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
    count = len(result.frequency)
    still = strip_arrays(model.static_fields(asked, np.asarray(result.state)[None]))
    moving = {name: np.repeat(array, count, axis=0) for name, array in still.items() if name not in GIVEN}
    return Fields(
        **_identity("modes", design, settings, keywords),
        status="converged",
        message="",
        effects=effects_of(asked),
        series="mode",
        values=np.arange(1.0, count + 1.0),
        frequency=np.asarray(result.frequency),
        mode_shape=np.asarray(result.shapes),
        mode_bodies=_all_bodies(result, [block.name for block in blocks_of(design)]),
        **(still | moving),
    )


def _identity(analysis: str, design: Design, settings: Settings, keywords: dict[str, Any]) -> dict[str, Any]:
    return {
        "analysis": analysis,
        "model": settings.model,
        "settings": keywords,
        "parts": parts_of(design),
        "blocks": blocks_of(design),
        "driven": 0 if isinstance(design, Problem) or design.body is None else _place(design.body, design),
    }


def _place(body: str, design: Design) -> int:
    return [block.name for block in blocks_of(design)].index(body)


def _ended(result: Any) -> dict[str, Any]:
    return {"status": str(result.status.value), "message": result.message}


def _all_bodies(result: Any, names: list[str]) -> Array:
    """Return the modal displacements of all bodies (C, B, 3), which one model holds by name, one by place."""
    count = len(result.frequency)
    if hasattr(result, "bodies"):
        shapes = np.array([result.bodies[name] for name in names]).reshape(-1, count, 3)
        return shapes.swapaxes(0, 1)
    return np.asarray(result.body_shapes, dtype=float).reshape(count, -1, 3)
