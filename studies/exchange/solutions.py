"""Fields of what a model has solved: its static solution, its trajectory or its modes."""

from typing import Any

import numpy as np

from studies.answers.fields import Block, Fields, Part, blocks_of, parts_of, section_of, strip_arrays
from studies.answers.models import Model, built, effects_of, model_named, model_of, settings_of
from studies.answers.motion import Motion
from studies.answers.response import Answered, assembled
from studies.answers.spectrum import Spectrum
from studies.cases.design import Design
from studies.cases.keys import GROUND
from studies.cases.problem import Problem
from studies.errors import BadInput
from studies.kinds import Array

#: Arrays of the design, not of its states.
GIVEN = ("arc_length", "rest_shape", "rest_bodies")
#: Energies of a path and of a motion, as solutions name them and as `Fields` does.
OF_PATH = {f"{name}_energy": name for name in ("bending", "axial", "shear", "gravity")}
OF_MOTION = {f"{name}_energy": name for name in ("kinetic", "strain", "gravity")} | {
    "dissipated": "dissipated"
}


def fields_of(answer: Answered, design: Design) -> Fields:
    """Return the fields of what a neutral answer to `design` was made of; BadInput if it has no state."""
    if answer.solution is None:
        raise BadInput(f"{answer.model}: got no state, expected a solution with one: {answer.message}")
    settings = settings_of(answer)
    model = model_of(settings)
    moving = isinstance(answer, Motion | Spectrum)
    asked, keywords = built(model, design, settings, moving=moving)
    about = described(design) | {"model": answer.model, "settings": keywords}
    return solved_fields(model, asked, answer.solution, about)


def described(design: Design) -> dict[str, Any]:
    """Return the parts and blocks of a design, and the place of the driven one among the latter."""
    blocks = blocks_of(design)
    body = None if isinstance(design, Problem) else design.body
    driven = 0 if body is None else [block.name for block in blocks].index(body)
    return {"parts": parts_of(design), "blocks": blocks, "driven": driven}


def own_fields(solution: Any, asked: Any) -> Fields:
    """Return the fields of a solution, trajectory or modes of either model, of a pivot or mechanism of it.

    Args:
        solution: what a function of `spline_model` or `fe_reference` returned.
        asked: the pivot or mechanism that it was called with.

    Raises:
        BadInput: something else, or of two models; one line.
    """
    package = type(solution).__module__.partition(".")[0]
    if type(solution).__name__ not in KINDS or type(asked).__module__.partition(".")[0] != package:
        got = f"{type(solution).__name__} and {type(asked).__name__}"
        raise BadInput(
            f"solution: got {got}, expected a static solution, a trajectory or modes, with their design"
        )
    asked = _as_fine(asked, solution)
    model, name = model_named(package, getattr(asked, "element", ""))
    parts, blocks = _strips_of(asked), _bodies_of(asked)
    body = getattr(solution, "driven", None) or getattr(solution, "body", None)
    driven = [block.name for block in blocks].index(body) if body else 0
    about = {"model": name, "settings": {}, "parts": parts, "blocks": blocks, "driven": driven}
    return solved_fields(model, asked, solution, about)


def _as_fine(asked: Any, solution: Any) -> Any:
    """Return the pivot or mechanism with the control points, or elements, that an accuracy has taken."""
    if hasattr(asked, "with_control_points"):
        chosen = getattr(solution, "settings", {}).get("control_points", asked.design.discretisation.points)
        return asked.with_control_points(getattr(solution, "control_points", chosen))
    from fe_reference.refined import finer

    meshes = getattr(solution.estimate, "meshes", ())
    for _ in meshes[1:]:
        asked = finer(asked)
    return asked


def solved_fields(model: Model, asked: Any, result: Any, about: dict[str, Any]) -> Fields:
    """Return the fields of a model's result.

    Args:
        asked: the design in the model, discretised as the result is.
        about: model, settings, parts, blocks and driven of the fields.
    """
    return KINDS[type(result).__name__](model, asked, result, about)


def _path(model: Model, asked: Any, result: Any, about: dict[str, Any]) -> Fields:
    driven = not np.isnan(result.torque).all()
    along = strip_arrays(model.static_fields(asked, result.states))
    # as the solution has them: by balance of moments, where a spline has chosen its control points
    own = {name: np.asarray(getattr(result, name), dtype=float) for name in ("axial_force", "bending_moment")}
    along |= {name: forces for name, forces in own.items() if forces.shape == along[name].shape}
    return Fields(
        **about,
        **_ended(result),
        analysis="static",
        effects=assembled(effects_of(asked)),
        series="load_factor",
        values=np.asarray(result.load_factor),
        torque=np.asarray(result.torque) if driven else None,
        stiffness=np.asarray(result.stiffness) if driven else None,
        energies=_energies(result, OF_PATH),
        **along,
    )


def _motion(model: Model, asked: Any, result: Any, about: dict[str, Any]) -> Fields:
    return Fields(
        **about,
        **_ended(result),
        analysis="release",
        effects=effects_of(asked),
        series="time_s",
        values=np.asarray(result.time),
        energies=_energies(result, OF_MOTION),
        **strip_arrays(model.moving_fields(asked, result.states)),
    )


def _modes(model: Model, asked: Any, result: Any, about: dict[str, Any]) -> Fields:
    count = len(result.frequency)
    still = strip_arrays(model.static_fields(asked, np.asarray(result.state)[None]))
    moving = {name: np.repeat(array, count, axis=0) for name, array in still.items() if name not in GIVEN}
    return Fields(
        **about,
        analysis="modes",
        status="converged",
        message="",
        effects=effects_of(asked),
        series="mode",
        values=np.arange(1.0, count + 1.0),
        frequency=np.asarray(result.frequency),
        mode_shape=np.asarray(result.shapes),
        mode_bodies=_all_bodies(result, [block.name for block in about["blocks"]]),
        **(still | moving),
    )


#: What either model calls its answers, and who makes fields of them.
KINDS = {"StaticSolution": _path, "Trajectory": _motion, "Modes": _modes}


def _ended(result: Any) -> dict[str, Any]:
    return {"status": str(result.status.value), "message": result.message}


def _energies(result: Any, names: dict[str, str]) -> dict[str, Array]:
    return {
        name: np.asarray(getattr(result, theirs)) for theirs, name in names.items() if hasattr(result, theirs)
    }


def _all_bodies(result: Any, names: list[str]) -> Array:
    """Return the modal displacements of all bodies (C, B, 3), which one model holds by name, one by place."""
    count = len(result.frequency)
    if hasattr(result, "bodies"):
        shapes = np.array([result.bodies[name] for name in names]).reshape(-1, count, 3)
        return shapes.swapaxes(0, 1)
    return np.asarray(result.body_shapes, dtype=float).reshape(count, -1, 3)


def _strips_of(asked: Any) -> tuple[Part, ...]:
    """Return the strips of a pivot or mechanism of a model, their sections taken as rectangles."""
    if hasattr(asked, "design"):
        return tuple(
            Part(name=strip.name, root=strip.root, tip=strip.tip, **section_of(strip))
            for strip in asked.design.strips
        )
    names: dict[int, str | None] = dict(enumerate(asked.body_names))
    names |= {-1: GROUND, -2: None}
    return tuple(
        Part(name=strip.name, root=names[strip.root], tip=names[strip.tip], **section_of(strip.section))
        for strip in asked.strips
    )


def _bodies_of(asked: Any) -> tuple[Block, ...]:
    bodies = asked.design.bodies if hasattr(asked, "design") else asked.bodies
    return tuple(
        Block(name=body.name, mass=body.mass, moment_of_inertia=body.moment_of_inertia) for body in bodies
    )
