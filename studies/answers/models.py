"""The two models side by side: the one file that knows both, and how a design is put to either."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any

from studies.answers.settings import FeSettings, Settings
from studies.cases.design import Design
from studies.errors import BadInput


def model_of(settings: Settings) -> Any:
    """Return the package of the settings' model; both packages have the same public names.

    Only this package is imported.
    """
    if isinstance(settings, FeSettings):
        import fe_reference

        return fe_reference
    import spline_model

    return spline_model


@dataclass(frozen=True)
class Asked:
    """A design in the form of a model, with the calls of the model and the translation of its errors.

    Attributes:
        design: of the case; settings: of the model.
        moving: whether the design is used in a motion, where a spline has another penalty stiffness.
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
        """Names of the effects that the model uses."""
        effects = self.modelled.effects
        return tuple(getattr(effects, "names", effects))

    def discretised(self, result: Any) -> dict[str, Any]:
        """Return the keywords of the discretisation of a result, and other settings that the model chose.

        Control points or elements that were chosen for an accuracy are among them.
        """
        given = self.settings.keywords()
        if meshes := getattr(getattr(result, "estimate", None), "meshes", ()):
            given["elements"] = meshes[-1]
        elif hasattr(result, "control_points"):
            given["control_points"] = result.control_points
            given["segments"] = getattr(result, "segments", given["segments"])
        return _keywords(self.model, given, self.moving) | dict(getattr(result, "settings", {}))

    def fine(self, result: Any) -> Any:
        """Return the design in the model with the discretisation of a result, also of a motion with an
        accuracy."""
        asked = self.modelled
        if hasattr(asked, "in_motion"):
            grid = asked.design.discretisation
            chosen = getattr(result, "settings", {}).get("control_points", grid.points)
            points = getattr(result, "control_points", chosen)
            made = asked.on(getattr(result, "segments", grid.segments), points)
            return made.in_motion() if self.moving else made
        meshes = getattr(result.estimate, "meshes", ())
        return replace(asked, elements=meshes[-1]) if meshes else asked

    def fields(self, result: Any, states: Any, analysis: str) -> Any:
        """Return the fields along the strips of states of a result, as `studies.answers.answer.Answer.along`.

        analysis: "static" for states of a path, "release" for states of a motion, "modes" for the static
        state of modes.
        """
        how = {} if isinstance(self.settings, FeSettings) else {"analysis": analysis}
        return self.model.strip_fields(self.fine(result), states, **how)

    @contextmanager
    def refusals(self) -> Iterator[None]:
        """Raise BadInput, in one line, for an error of the model."""
        try:
            yield
        except self.model.InvalidParameter as error:
            raise BadInput(f"{self.settings.model}: {error}") from None

    def static_path(self, **how: Any) -> Any:
        """Return the model's static solution.

        The path is the design's own unless `rotation` [rad], `increments` or `order` are given; the other
        keywords are those of the model.

        Raises:
            BadInput: an input that the model rejects; one line.
        """
        design = self.design
        given = {"rotation": design.rotation, "increments": design.increments, "order": design.order} | how
        with self.refusals():
            return self.model.solve_statics(self.modelled, **{"body": design.body} | given)


def put(design: Design, settings: Settings, *, moving: bool = False) -> Asked:
    """Return the design in the form of the settings' model, discretised for a motion if it is `moving`.

    Raises:
        BadInput: a setting or an effect that the model rejects; one line.
    """
    asked = Asked(design, settings, moving, None)
    scene = {"effects": design.effects.names, "parameters": design.effects.parameters()}
    grid = _keywords(asked.model, settings.keywords(), moving)
    with asked.refusals():
        return replace(asked, modelled=design.modelled(asked.model, **scene, **grid))


def _keywords(model: Any, given: dict[str, Any], moving: bool) -> dict[str, Any]:
    """Return keywords of a discretisation with the penalty stiffness of control points that are in motion."""
    if not moving or "control_points" not in given:
        return given
    return {"penalty_stiffness": model.motion_penalty_stiffness(given["control_points"])} | given
