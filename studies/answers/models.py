"""The two models side by side: the one file that knows both, and how a design is put to either."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from types import ModuleType
from typing import Any

import numpy as np

from studies.answers.settings import FeSettings, Settings
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
        static_fields, moving_fields, mode_fields: fields along the strips from the design in the model and
            the states of a path, of a motion, and of what modes are about.
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
    mode_fields: Callable[[Any, Any], Any]


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
            mode_fields=section_forces.strip_fields,
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
        mode_fields=section_forces.mode_fields,
    )


@dataclass(frozen=True)
class Asked:
    """A design as it is put to a model: what the functions of the model take, and how they refuse it.

    Attributes:
        design: of the case; settings: of the model.
        model: its modules.
        moving: whether it is asked in motion, where a spline has another slide stiffness.
        modelled: the design in the model.
    """

    design: Design
    settings: Settings
    model: Model
    moving: bool
    modelled: Any

    @property
    def effects(self) -> tuple[str, ...]:
        """Names of the effects, as the model took them."""
        return effects_of(self.modelled)

    def discretised(self, result: Any) -> dict[str, Any]:
        """Return the keywords of the discretisation that a result was reached with, and what else the model
        has set: control points or elements among them that it has chosen for its accuracy."""
        given = self.settings.keywords()
        if meshes := getattr(getattr(result, "estimate", None), "meshes", ()):
            given["elements"] = meshes[-1]
        elif hasattr(result, "control_points"):
            given["control_points"] = result.control_points
            given["segments"] = getattr(result, "segments", given["segments"])
        return _keywords(self.model, given, self.moving) | dict(getattr(result, "settings", {}))

    def refusals(self) -> AbstractContextManager[None]:
        """Turn what the model refuses into one line."""
        return _refusals(self.model, self.settings)

    def static_path(self, **how: Any) -> Any:
        """Return the model's static solution.

        The path is the design's own, unless `rotation`, `increments` or `order` say otherwise; the other
        keywords are those of the model.

        Raises:
            BadInput: what the model refuses; one line.
        """
        design, statics = self.design, self.model.statics
        given = {"rotation": design.rotation, "increments": design.increments, "order": design.order} | how
        with self.refusals():
            if isinstance(design, Problem):
                return statics.solve_statics(self.modelled, **given)
            return statics.solve_mechanism(self.modelled, body=design.body, **given)


def put(design: Design, settings: Settings, *, moving: bool = False) -> Asked:
    """Return the design as the settings' model has it, discretised for a motion if it is `moving`.

    Raises:
        BadInput: a setting or an effect that the model refuses; one line.
    """
    model = model_of(settings)
    keywords = _keywords(model, settings.keywords(), moving)
    scene = {"effects": design.effects.names, "parameters": design.effects.parameters()}
    with _refusals(model, settings):
        if isinstance(design, Problem):
            modelled = model.pivot.cross_axis_pivot(**design.pivot_parameters(), **scene, **keywords)
        else:
            parts = design.mechanism_parameters()
            modelled = model.mechanism.compliant_mechanism(
                strips=[model.mechanism.StripDesign(**strip) for strip in parts["strips"]],
                bodies=[model.mechanism.BodyDesign(**body) for body in parts["bodies"]],
                **scene,
                **keywords,
            )
    return Asked(design, settings, model, moving, modelled)


def _keywords(model: Model, given: dict[str, Any], moving: bool) -> dict[str, Any]:
    """Return keywords of a discretisation with the slide stiffness of control points that are in motion."""
    if not moving or "control_points" not in given:
        return given
    return {"slide_stiffness": model.pivot.swinging_slide_stiffness(given["control_points"])} | given


def effects_of(modelled: Any) -> tuple[str, ...]:
    """Return the names of the effects of a pivot or mechanism of a model."""
    effects = getattr(modelled, "mechanism", modelled).effects
    return tuple(getattr(effects, "names", effects))


@contextmanager
def _refusals(model: Model, settings: Settings) -> Iterator[None]:
    try:
        yield
    except model.errors.InvalidParameter as error:
        raise BadInput(f"{settings.model}: {error}") from None


def mode_bodies(modes: Any, names: Sequence[str]) -> Array:
    """Return the modal displacements of bodies (C, B, 3), which one model holds by name, one by place."""
    count = len(modes.frequency)
    if hasattr(modes, "bodies"):
        return np.array([modes.bodies[name] for name in names]).reshape(-1, count, 3).swapaxes(0, 1)
    return np.asarray(modes.body_shapes, dtype=float).reshape(count, -1, 3)
