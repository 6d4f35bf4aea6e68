"""The two models side by side: the one file that knows both, and how a design is put to either."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, fields, replace
from types import ModuleType
from typing import Any

from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.design import Design
from studies.cases.problem import Problem
from studies.errors import BadInput


@dataclass(frozen=True, kw_only=True)
class Model:
    """The modules of one model, the same names in both, and what differs in how they are asked.

    Attributes:
        records: keyword for the largest number of records of a motion.
        release_options: keywords that every release takes.
        moving: discretisation keywords of a pivot in motion, from its settings, where they say nothing.
        all_shapes: whether modes hold the shapes of all bodies side by side, or of one.
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
    moving: Callable[[Settings], dict[str, Any]]
    all_shapes: bool
    drive: type
    static_fields: Callable[[Any, Any], Any]
    moving_fields: Callable[[Any, Any], Any]


def model_of(settings: Settings) -> Model:
    """Return the settings' model; the other one is not even imported."""
    if isinstance(settings, FeSettings):
        import fe_reference.drives
        import fe_reference.dynamics
        import fe_reference.errors
        import fe_reference.mechanism
        import fe_reference.modes
        import fe_reference.pivot
        import fe_reference.section_forces
        import fe_reference.statics

        return Model(
            pivot=fe_reference.pivot,
            mechanism=fe_reference.mechanism,
            statics=fe_reference.statics,
            dynamics=fe_reference.dynamics,
            modes=fe_reference.modes,
            errors=fe_reference.errors,
            records="samples",
            release_options={"raise_on_failure": False},
            moving=lambda settings: {},
            all_shapes=True,
            drive=fe_reference.drives.DrivenRotation,
            static_fields=fe_reference.section_forces.strip_fields,
            moving_fields=fe_reference.section_forces.strip_fields,
        )
    import spline_model.dynamics
    import spline_model.effects
    import spline_model.errors
    import spline_model.mechanism
    import spline_model.modes
    import spline_model.pivot
    import spline_model.section_forces
    import spline_model.statics

    return Model(
        pivot=spline_model.pivot,
        mechanism=spline_model.mechanism,
        statics=spline_model.statics,
        dynamics=spline_model.dynamics,
        modes=spline_model.modes,
        errors=spline_model.errors,
        records="records",
        release_options={},
        moving=_swinging_spline,
        all_shapes=False,
        drive=spline_model.effects.DrivenRotation,
        static_fields=spline_model.section_forces.static_fields,
        moving_fields=spline_model.section_forces.moving_fields,
    )


def model_named(package: str, element: str = "") -> tuple[Model, str]:
    """Return the model that is the package of that name, and what it is called with these elements."""
    settings = SplineSettings() if package == "spline_model" else FeSettings(element=element)
    return model_of(settings), settings.model


def _swinging_spline(settings: Settings) -> dict[str, Any]:
    """Return the slide stiffness that goes with the control points of a spline in motion, where given."""
    from spline_model.pivot import swinging_slide_stiffness

    points = settings.keywords().get("control_points")
    return {} if points is None else {"slide_stiffness": swinging_slide_stiffness(points)}


def built(model: Model, design: Design, settings: Settings, *, moving: bool) -> tuple[Any, dict[str, Any]]:
    """Return the design in the model and the keywords of its discretisation, complete for one in motion.

    Raises:
        BadInput: a setting or an effect that the model refuses; one line.
    """
    keywords = settings.keywords()
    if moving:
        keywords = model.moving(settings) | keywords
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


def as_solved(
    model: Model, design: Design, settings: Settings, result: Any, *, moving: bool
) -> tuple[Any, dict[str, Any]]:
    """Return what `built` does, with the control points that a result was answered with."""
    if isinstance(settings, SplineSettings) and not is_given(settings):
        settings = replace(settings, control_points=result.control_points)
    return built(model, design, settings, moving=moving)


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
