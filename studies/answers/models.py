"""The two models side by side: the one file that knows both, and how a design is put to either."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np

from studies.answers.settings import FeSettings, Settings
from studies.cases.design import Design
from studies.cases.problem import Problem
from studies.errors import BadInput
from studies.kinds import Array


def model_of(settings: Settings) -> Any:
    """Return the package of the settings' model; both have the same public names. The other one is not even
    imported."""
    if isinstance(settings, FeSettings):
        import fe_reference

        return fe_reference
    import spline_model

    return spline_model


def fields_along(settings: Settings, analysis: str) -> Callable[[Any, Any], Any]:
    """Return what makes the fields along the strips from a design in the model and the states of a path
    ("static"), of a motion ("release"), or of what modes are about ("modes")."""
    if isinstance(settings, FeSettings):
        from fe_reference import strip_fields

        return strip_fields
    from spline_model.section_forces import mode_fields, moving_fields, static_fields

    return {"static": static_fields, "release": moving_fields, "modes": mode_fields}[analysis]


@dataclass(frozen=True)
class Asked:
    """A design as it is put to a model: what the functions of the model take, and how they refuse it.

    Attributes:
        design: of the case; settings: of the model.
        moving: whether it is asked in motion, where a spline has another slide stiffness.
        modelled: the design in the model.
    """

    design: Design
    settings: Settings
    moving: bool
    modelled: Any

    @property
    def model(self) -> Any:
        """The package of the model."""
        return model_of(self.settings)

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
        return _refusals(self.settings)

    def static_path(self, **how: Any) -> Any:
        """Return the model's static solution.

        The path is the design's own, unless `rotation`, `increments` or `order` say otherwise; the other
        keywords are those of the model.

        Raises:
            BadInput: what the model refuses; one line.
        """
        design = self.design
        given = {"rotation": design.rotation, "increments": design.increments, "order": design.order} | how
        with self.refusals():
            if isinstance(design, Problem):
                return self.model.solve_statics(self.modelled, **given)
            return self.model.solve_mechanism(self.modelled, body=design.body, **given)


def put(design: Design, settings: Settings, *, moving: bool = False) -> Asked:
    """Return the design as the settings' model has it, discretised for a motion if it is `moving`.

    Raises:
        BadInput: a setting or an effect that the model refuses; one line.
    """
    model = model_of(settings)
    scene = {"effects": design.effects.names, "parameters": design.effects.parameters()}
    with _refusals(settings):
        keywords = scene | _keywords(model, settings.keywords(), moving)
        if isinstance(design, Problem):
            modelled = model.cross_axis_pivot(**design.pivot_parameters(), **keywords)
        else:
            parts = design.mechanism_parameters()
            modelled = model.compliant_mechanism(
                strips=[model.StripDesign(**strip) for strip in parts["strips"]],
                bodies=[model.BodyDesign(**body) for body in parts["bodies"]],
                **keywords,
            )
    return Asked(design, settings, moving, modelled)


def _keywords(model: Any, given: dict[str, Any], moving: bool) -> dict[str, Any]:
    """Return keywords of a discretisation with the slide stiffness of control points that are in motion."""
    if not moving or "control_points" not in given:
        return given
    return {"slide_stiffness": model.swinging_slide_stiffness(given["control_points"])} | given


def effects_of(modelled: Any) -> tuple[str, ...]:
    """Return the names of the effects of a pivot or mechanism of a model."""
    effects = getattr(modelled, "mechanism", modelled).effects
    return tuple(getattr(effects, "names", effects))


@contextmanager
def _refusals(settings: Settings) -> Iterator[None]:
    try:
        yield
    except model_of(settings).InvalidParameter as error:
        raise BadInput(f"{settings.model}: {error}") from None


def mode_bodies(modes: Any, names: Sequence[str]) -> Array:
    """Return the modal displacements of bodies (C, B, 3), which one model holds by name, one by place."""
    count = len(modes.frequency)
    if hasattr(modes, "bodies"):
        return np.array([modes.bodies[name] for name in names]).reshape(-1, count, 3).swapaxes(0, 1)
    return np.asarray(modes.body_shapes, dtype=float).reshape(count, -1, 3)
