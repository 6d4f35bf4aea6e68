"""The two models side by side: the one file that knows both, and how a design is put to either."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from studies.answers.settings import FeSettings, Settings
from studies.cases.design import Design
from studies.errors import BadInput


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
        moving: whether it is asked in motion, where a spline has another penalty stiffness.
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
        effects = getattr(self.modelled, "mechanism", self.modelled).effects
        return tuple(getattr(effects, "names", effects))

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

    def fine(self, result: Any) -> Any:
        """Return the design in the model as a result was reached: in motion, with the control points or
        elements that an accuracy has taken."""
        asked = self.modelled
        if hasattr(asked, "with_control_points"):
            grid = asked.design.discretisation
            chosen = getattr(result, "settings", {}).get("control_points", grid.points)
            points = getattr(result, "control_points", chosen)
            made = asked.on(getattr(result, "segments", grid.segments), points)
            return made.in_motion() if self.moving else made
        from fe_reference.refined import finer

        for _ in getattr(result.estimate, "meshes", ())[1:]:
            asked = finer(asked)
        return asked

    @contextmanager
    def refusals(self) -> Iterator[None]:
        """Turn what the model refuses into one line."""
        try:
            yield
        except self.model.InvalidParameter as error:
            raise BadInput(f"{self.settings.model}: {error}") from None

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
            return self.model.solve_mechanism(self.modelled, **{"body": design.body} | given)


def put(design: Design, settings: Settings, *, moving: bool = False) -> Asked:
    """Return the design as the settings' model has it, discretised for a motion if it is `moving`.

    Raises:
        BadInput: a setting or an effect that the model refuses; one line.
    """
    asked = Asked(design, settings, moving, None)
    scene = {"effects": design.effects.names, "parameters": design.effects.parameters()}
    with asked.refusals():
        modelled = design.modelled(
            asked.model, **scene, **_keywords(asked.model, settings.keywords(), moving)
        )
    return Asked(design, settings, moving, modelled)


def _keywords(model: Any, given: dict[str, Any], moving: bool) -> dict[str, Any]:
    """Return keywords of a discretisation with the penalty stiffness of control points that are in motion."""
    if not moving or "control_points" not in given:
        return given
    return {"penalty_stiffness": model.motion_penalty_stiffness(given["control_points"])} | given
