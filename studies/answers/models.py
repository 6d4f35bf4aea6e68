"""The two models side by side: the one file that knows both, and how a design is put to either."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, fields
from types import ModuleType
from typing import Any

import numpy as np

from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.design import Design
from studies.cases.problem import Problem
from studies.errors import BadInput
from studies.kinds import Array


@dataclass(frozen=True)
class Model:
    """The modules of one model, the same names in both, and what differs in how they are asked.

    Attributes:
        records: keyword for the largest number of records of a motion.
        release_options: keywords that every release takes.
        drive: of a rotation in a motion.
        static_fields, moving_fields: fields along the strips from the design in the model and its states.
    """

    pivot: ModuleType
    mechanism: ModuleType
    statics: ModuleType
    dynamics: ModuleType
    modes: ModuleType
    errors: ModuleType
    records: str
    release_options: dict[str, Any]
    drive: type
    static_fields: Callable[[Any, Any], Any]
    moving_fields: Callable[[Any, Any], Any]


def model_of(settings: Settings) -> Model:
    """Return the settings' model; the other one is not even imported."""
    if isinstance(settings, FeSettings):
        from fe_reference import dynamics, errors, loads, mechanism, modes, section_forces, statics

        return Model(
            *(mechanism, mechanism, statics, dynamics, modes, errors),
            records="samples",
            release_options={"raise_on_failure": False},
            drive=loads.DrivenRotation,
            static_fields=section_forces.strip_fields,
            moving_fields=section_forces.strip_fields,
        )
    return _spline()


def _spline() -> Model:
    from spline_model import dynamics, effects, errors, mechanism, modes, pivot, section_forces, statics

    return Model(
        *(pivot, mechanism, statics, dynamics, modes, errors),
        records="records",
        release_options={},
        drive=effects.DrivenRotation,
        static_fields=section_forces.static_fields,
        moving_fields=section_forces.moving_fields,
    )


def built(model: Model, design: Design, settings: Settings, *, moving: bool) -> tuple[Any, dict[str, Any]]:
    """Return the design in the model and the keywords of its discretisation, complete for one in motion.

    Raises:
        BadInput: a setting or an effect that the model refuses; one line.
    """
    keywords = settings.keywords()
    if moving and "control_points" in keywords:  # the slide stiffness that goes with those of a spline
        stiffness = model.pivot.swinging_slide_stiffness(keywords["control_points"])
        keywords = {"slide_stiffness": stiffness} | keywords
    scene = {"effects": design.effects.names, "parameters": design.effects.parameters()}
    with refusals(model, settings):
        if isinstance(design, Problem):
            return model.pivot.cross_axis_pivot(**design.pivot_parameters(), **scene, **keywords), keywords
        parts = design.mechanism_parameters()
        mechanism = model.mechanism.mechanism(
            strips=[model.mechanism.StripDesign(**strip) for strip in parts["strips"]],
            bodies=[model.mechanism.BodyDesign(**body) for body in parts["bodies"]],
            **scene,
            **keywords,
        )
        return mechanism, keywords


def is_given(settings: Settings) -> bool:
    """Return whether settings say how fine the discretisation is, or leave that to the model's accuracy."""
    return getattr(settings, "control_points", 0) is not None


def settings_of(answer: Any) -> Settings:
    """Return the settings that a neutral answer was reached with: its model's, with what that chose."""
    kind = SplineSettings if answer.model == "spline" else FeSettings
    return kind(
        **{key.name: answer.settings[key.name] for key in fields(kind) if key.name in answer.settings}
    )


def effects_of(asked: Any) -> tuple[str, ...]:
    """Return the names of the effects of what `built` returned, as the model took them."""
    effects = getattr(asked, "mechanism", asked).effects
    return tuple(getattr(effects, "names", effects))


@contextmanager
def refusals(model: Model, settings: Settings) -> Iterator[None]:
    """Turn what the model refuses into one line."""
    try:
        yield
    except model.errors.InvalidParameter as error:
        raise BadInput(f"{settings.model}: {error}") from None


def static_path(model: Model, design: Design, asked: Any, **how: Any) -> Any:
    """Return the model's static solution of a design, `asked` as `built` returned it.

    The path is the design's own, unless `rotation`, `increments` or `order` say otherwise; the other keywords
    are those of the model.
    """
    given = {"rotation": design.rotation, "increments": design.increments, "order": design.order} | how
    if isinstance(design, Problem):
        return model.statics.solve_statics(asked, **given)
    return model.statics.solve_mechanism(asked, body=design.body, **given)


def mode_bodies(modes: Any, names: Sequence[str]) -> Array:
    """Return the modal displacements of bodies (C, B, 3), which one model holds by name, one by place."""
    count = len(modes.frequency)
    if hasattr(modes, "bodies"):
        return np.array([modes.bodies[name] for name in names]).reshape(-1, count, 3).swapaxes(0, 1)
    return np.asarray(modes.body_shapes, dtype=float).reshape(count, -1, 3)
