"""Fields along the strips of any design, and its bodies, of what a model has solved: its static solution,
its trajectory or its modes. The arrays do not tell which model they are of."""

from dataclasses import dataclass, field, fields, replace
from typing import Any

import numpy as np

from studies.answers.models import effects_of, fields_along, mode_bodies
from studies.answers.quantities import peak, stress_of
from studies.answers.response import Answered, assembled
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.mechanism import Strip
from studies.cases.section import Sectioned
from studies.errors import BadInput
from studies.kinds import Array

#: Arrays of the design, not of its states.
GIVEN = ("arc_length", "rest_shape", "rest_bodies")
#: What either model calls its answers -> analysis, what runs over its states, and its energies.
KINDS = {
    "StaticSolution": ("static", "load_factor", ("bending", "axial", "shear", "gravity")),
    "Trajectory": ("release", "time_s", ("kinetic", "strain", "gravity", "dissipated")),
    "Modes": ("modes", "mode", ()),
}


@dataclass(frozen=True, kw_only=True)
class _Part(Sectioned):
    """A strip as its fields need it: what its root and its tip are on, and its section.

    Attributes:
        root, tip: "ground", the name of a body, or None for a free end.
    """

    name: str
    root: str | None
    tip: str | None
    youngs_modulus: float
    area: float
    second_moment_of_area: float
    section_depth: None = None
    width: None = None


@dataclass(frozen=True, kw_only=True)
class Fields:
    """Fields of a static path, a motion or natural modes: S states, G strips, P stations, B bodies.

    Attributes:
        model, settings, effects, status, message: as of any answer.
        analysis: "static", "release" or "modes".
        parts: the strips. blocks: the bodies, as the model has them: `name`, `mass` [kg] and
            `moment_of_inertia` about the centre [kg m^2].
        driven: place of the body that is driven or let go among them; 0 where there is none.
        series: name of what runs over the states, "load_factor" [1], "time_s" [s] or "mode" [1].
        values: (S,) of it.
        arc_length: (G, P) at rest [m]; rest_shape: (G, P, 2) [m]; rest_bodies: (B, 2) centres at rest [m].
        shape: (S, G, P, 2) [m]; rotation: (S, G, P) of the sections from rest [rad]; curvature: [1/m];
            stretch: [1]; axial_force, shear_force: [N]; bending_moment: [N m].
        reactions: (S, G, 2, 3) force x, y [N] and moment [N m] on the strip at root and tip.
        bodies: (S, B, 3) centre x, y [m], rotation [rad].
        torque, stiffness: (S,) of the drive of a static path [N m], [N m/rad]; None without one.
        energies: (S,) by name [J]: "bending", "axial", "shear", "gravity" of a path; "kinetic", "strain",
            "gravity" of a motion, with what was lost to damping, "dissipated"; none of modes.
        frequency: (S,) of modes [Hz]; mode_shape: (S, G, P, 2), mode_bodies: (S, B, 3) displacement and
            rotation at unit modal mass; None of other analyses. The other fields of modes are those of the
            static state that the motion is about, the same in all.
    """

    model: str
    settings: dict[str, Any]
    effects: tuple[str, ...]
    status: str
    message: str
    analysis: str
    parts: tuple[_Part | Strip, ...]
    blocks: tuple[Any, ...]
    driven: int
    series: str
    values: Array
    arc_length: Array
    rest_shape: Array
    rest_bodies: Array
    shape: Array
    rotation: Array
    curvature: Array
    stretch: Array
    axial_force: Array
    shear_force: Array
    bending_moment: Array
    reactions: Array
    bodies: Array
    torque: Array | None = None
    stiffness: Array | None = None
    energies: dict[str, Array] = field(default_factory=dict)
    frequency: Array | None = None
    mode_shape: Array | None = None
    mode_bodies: Array | None = None

    @property
    def displacement(self) -> Array:
        """(S, G, P, 2) from rest [m]."""
        return np.asarray(self.shape - self.rest_shape)

    @property
    def stress(self) -> Array:
        """(S, G, P) larger magnitude of axial and bending stress together at the two outer fibres [Pa]."""
        return stress_of(self.parts, self.axial_force, self.bending_moment)

    @property
    def strain_energy(self) -> Array:
        """(S,) of all strips [J]."""
        parts = ("strain",) if "strain" in self.energies else ("bending", "axial", "shear")
        return np.asarray(sum(self.energies[name] for name in parts if name in self.energies))

    @property
    def gravity_energy(self) -> Array | None:
        """(S,) against rest [J]; None without weight."""
        return self.energies.get("gravity")

    @property
    def max_stress(self) -> Array:
        """(S,) largest of all strips, between the stations as well [Pa]."""
        return np.asarray(peak(self.stress).max(axis=1))


def fields_of(answer: Answered) -> Fields:
    """Return the fields of what a neutral answer was made of; BadInput if it has no state."""
    if answer.solution is None:
        raise BadInput(f"{answer.model}: got no state, expected a solution with one: {answer.message}")
    found = own_fields(answer.solution, answer.modelled)
    return replace(
        found,
        model=answer.model,
        settings=answer.settings,
        driven=[block.name for block in found.blocks].index(answer.body) if answer.body else 0,
        parts=answer.design.strips,
    )


def own_fields(solution: Any, modelled: Any) -> Fields:
    """Return the fields of a solution, trajectory or modes of either model, of a pivot or mechanism of it.

    Args:
        solution: what a function of `spline_model` or `fe_reference` returned.
        modelled: the pivot or mechanism that it was called with.

    Raises:
        BadInput: something else, or of two models; one line.
    """
    package = type(solution).__module__.partition(".")[0]
    if type(solution).__name__ not in KINDS or type(modelled).__module__.partition(".")[0] != package:
        got = f"{type(solution).__name__} and {type(modelled).__name__}"
        raise BadInput(
            f"solution: got {got}, expected a static solution, a trajectory or modes, with their design"
        )
    analysis, series, energies = KINDS[type(solution).__name__]
    asked = _as_fine(modelled, solution, analysis)
    settings = SplineSettings() if package == "spline_model" else FeSettings(element=asked.element)
    body = getattr(solution, "driven", None) or getattr(solution, "body", None)
    blocks = tuple(asked.design.bodies if hasattr(asked, "design") else asked.bodies)
    names = [block.name for block in blocks]
    states = np.asarray(solution.state)[None] if series == "mode" else solution.states
    along = fields_along(settings, analysis)(asked, states)
    arrays = {each.name: np.asarray(getattr(along, each.name), dtype=float) for each in fields(along)}
    own = {
        "static": _path,
        "release": lambda motion, *_: {"values": np.asarray(motion.time)},
        "modes": _modes,
    }
    found = own[analysis](solution, arrays, names)
    known = {name: getattr(solution, f"{name}_energy", getattr(solution, name, None)) for name in energies}
    named = effects_of(asked)
    return Fields(
        model=settings.model,
        settings={},
        effects=assembled(named) if analysis == "static" else named,
        status=str(solution.status.value) if series != "mode" else "converged",
        message=getattr(solution, "message", ""),
        analysis=analysis,
        parts=_strips_of(asked),
        blocks=blocks,
        driven=names.index(body) if body else 0,
        series=series,
        energies={name: np.asarray(array) for name, array in known.items() if array is not None},
        **arrays | found,
    )


def _as_fine(asked: Any, solution: Any, analysis: str) -> Any:
    """Return the pivot or mechanism as it was solved: in motion, with the control points or elements that an
    accuracy has taken."""
    if hasattr(asked, "with_control_points"):
        grid = asked.design.discretisation
        chosen = getattr(solution, "settings", {}).get("control_points", grid.points)
        points = getattr(solution, "control_points", chosen)
        fine = asked.on(getattr(solution, "segments", grid.segments), points)
        return fine if analysis == "static" else fine.in_motion()
    from fe_reference.refined import finer

    for _ in getattr(solution.estimate, "meshes", ())[1:]:
        asked = finer(asked)
    return asked


def _path(result: Any, along: dict[str, Array], names: list[str]) -> dict[str, Any]:
    """Return what a path has of its own: forces by balance, where a spline has chosen its points."""
    given = {name: np.asarray(getattr(result, name), float) for name in ("axial_force", "bending_moment")}
    found: dict[str, Any] = {name: own for name, own in given.items() if own.shape == along[name].shape}
    if not np.isnan(result.torque).all():
        found |= {"torque": np.asarray(result.torque), "stiffness": np.asarray(result.stiffness)}
    return found | {"values": np.asarray(result.load_factor)}


def _modes(result: Any, along: dict[str, Array], names: list[str]) -> dict[str, Any]:
    """Return modes, and the state that they are about as often as there are any."""
    count = len(result.frequency)
    still = {name: np.repeat(array, count, axis=0) for name, array in along.items() if name not in GIVEN}
    return still | {
        "values": np.arange(1.0, count + 1.0),
        "frequency": np.asarray(result.frequency),
        "mode_shape": np.asarray(result.shapes),
        "mode_bodies": mode_bodies(result, names),
    }


def _strips_of(asked: Any) -> tuple[_Part, ...]:
    """Return the strips of a pivot or mechanism of a model, their sections taken as rectangles."""
    given = getattr(asked, "design", asked).strips
    taken = ("name", "root", "tip", "youngs_modulus", "area", "second_moment_of_area")
    return tuple(_Part(**{each: getattr(strip, each) for each in taken}) for strip in given)
