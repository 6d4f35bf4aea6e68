"""The neutral answer to what a design is asked, whatever the model; its fields along the strips."""

import math
from dataclasses import asdict, dataclass, field
from functools import cached_property
from typing import Any, ClassVar, Self

import numpy as np

from studies.answers.models import Asked
from studies.answers.quantities import peak, stress_of
from studies.cases.design import Design
from studies.cases.effects import MOTION_ONLY
from studies.errors import BadInput, Unanswered
from studies.kinds import Array

#: Parts of an estimate that are no error.
CHOSEN = ("accuracy", "segments", "control_points", "trials", "meshes")


def read_only(array: Array) -> Array:
    """Return the array, of any shape and unit, after a change of its flag: it cannot be written any more."""
    array.flags.writeable = False
    return array


def own(name: str) -> "cached_property[Array]":
    """Return the property that is an array of the model's own answer, in its shape and unit.

    The array is empty (0,) where there is no answer.
    """
    return cached_property(
        lambda answer: read_only(np.array(getattr(answer.solution, name, ()), dtype=float))
    )


@dataclass(frozen=True, kw_only=True)
class Answer:
    """Neutral answer of a model, with its settings and status; arrays run over S states.

    Attributes:
        asked: the design in the form of the model.
        solution: the model's own answer; None if there is none.
        status: "converged", or how the solution ended early; `message` has the reason and the place or time,
            or critical points that a complete path has passed.
        resolution: message on errors of a discretisation or step that is too coarse; empty if it is resolved,
            or if the model has no such check.
        wall_s: time of the whole call, from the design to the answer [s]; solve_s: time of the increments or
            steps only [s].
    """

    #: "static", "release" or "modes"; name of what runs over the states, and parts of the energy.
    analysis: ClassVar[str] = "static"
    series: ClassVar[str] = "load_factor"
    parts: ClassVar[tuple[str, ...]] = ()

    asked: Asked = field(repr=False)
    solution: Any = field(default=None, repr=False, compare=False)
    status: str
    message: str = ""
    resolution: str = ""
    wall_s: float = 0.0
    solve_s: float = 0.0

    @classmethod
    def of(cls, asked: Asked, result: Any, **given: Any) -> Self:
        """Return the neutral form of a model's own answer; `given` are its time [s] and other known
        attributes."""
        ended = {
            "status": str(result.status.value),
            "message": result.message,
            "resolution": getattr(result, "resolution", ""),
            "solve_s": float(result.seconds["solve"]),
        }
        return cls(asked=asked, solution=result, **ended | given)

    @property
    def design(self) -> Design:
        """The design that was asked."""
        return self.asked.design

    @property
    def model(self) -> str:
        """Return "spline", "fe" or "fe-shear"."""
        return self.asked.settings.model

    @property
    def body(self) -> str | None:
        """Name of the driven or released body; None without one."""
        return self.design.body

    @property
    def crossing(self) -> tuple[float, float] | None:
        """Point x, y [m] where a pivot's strips cross at rest; None for a mechanism."""
        return self.design.crossing_point

    @cached_property
    def settings(self) -> dict[str, Any]:
        """Discretisation keywords, and settings that the model chose."""
        return self.asked.discretised(self.solution)

    @property
    def effects(self) -> tuple[str, ...]:
        """Names of the assembled effects; a static path has no effects of inertia and damping."""
        moving = self.analysis in ("release", "modes")
        return tuple(each for each in self.asked.effects if moving or each not in MOTION_ONLY)

    @cached_property
    def estimate(self) -> dict[str, Any] | None:
        """Estimated errors of a model that was given an accuracy, by name [1]; None otherwise."""
        parts = getattr(self.solution, "estimate", None)
        if parts is None:
            return None
        found = asdict(parts)
        found.pop("stopped", None)  # the message states it
        found |= dict(found.pop("errors", {}))
        return found | self._errors_beside(found)

    def _errors_beside(self, estimate: dict[str, Any]) -> dict[str, float]:
        """Return the errors that follow from those that the model estimates."""
        return {}

    @property
    def converged(self) -> bool:
        """Whether all requested states were reached."""
        return self.status == "converged"

    def whole(self) -> Self:
        """Return the answer; Unanswered unless all requested states were reached."""
        if not self.converged:
            raise Unanswered(self.message)
        return self

    @property
    def errors(self) -> dict[str, float]:
        """Estimated errors by name [1]; NaN where no error is estimated, empty if none is."""
        return {name: float(e) for name, e in (self.estimate or {}).items() if name not in CHOSEN}

    @property
    def largest_error(self) -> float:
        """Largest estimated error [1]; NaN if no error is estimated."""
        return float(np.fmax.reduce([math.nan, *self.errors.values()]))

    @property
    def counters(self) -> dict[str, int]:
        """Operation counts by kind [1]; empty for modes."""
        return dict(getattr(self.solution, "counters", {}))

    @cached_property
    def bodies(self) -> dict[str, Array]:
        """(S, 3) by name: centre of mass x, y [m], rotation, counter-clockwise [rad]; a pivot's origin is
        A1."""
        found = getattr(self.solution, "bodies", {each.name: np.zeros((0, 3)) for each in self.design.bodies})
        return {name: read_only(np.array(place, dtype=float)) for name, place in found.items()}

    @property
    def rotation(self) -> Array:
        """(S,) of the driven or released body, counter-clockwise [rad]."""
        return self.bodies[str(self.body)][:, 2]

    @property
    def centre(self) -> Array:
        """(S, 2) centre of mass of that body [m]."""
        return self.bodies[str(self.body)][:, :2]

    @property
    def driven(self) -> bool:
        """Whether the answer is a path with a driven rotation."""
        return False

    @property
    def values(self) -> Array:
        """Coordinate of the states (S,): load factor [1], time [s] or number of the mode [1]."""
        found: Array = getattr(self, self.series.removesuffix("_s"))
        return found

    @property
    def energies(self) -> dict[str, Array]:
        """Parts of the energy (S,) by name [J]."""
        return {name: getattr(self, f"{name}_energy") for name in self.parts}

    @cached_property
    def along(self) -> Any:
        """Fields along G strips at P stations, and B bodies, of the states.

        arc_length (G, P) at rest [m]; rest_shape (G, P, 2), rest_bodies (B, 2) [m]; shape (S, G, P, 2) [m];
        rotation (S, G, P) of the sections from rest [rad]; curvature [1/m]; stretch [1]; axial_force,
        shear_force [N]; bending_moment [N m]; reactions (S, G, 2, 3) force x, y [N] and moment [N m] on the
        strip at root and tip; bodies (S, B, 3) [m, m, rad]. Those of modes are of the static state that the
        motion is about, the same in all.
        """
        if self.solution is None:
            raise BadInput(f"{self.model}: got no state, expected a solution with one: {self.message}")
        return self._in_full(self.asked.fields(self.solution, self._states, self.analysis))

    @property
    def _states(self) -> Array:
        """States of the model that the fields are of."""
        states: Array = self.solution.states
        return states

    def _in_full(self, along: Any) -> Any:
        """Return the fields with what is known better than by them."""
        return along

    @cached_property
    def stress(self) -> Array:
        """(S, G, P) larger magnitude of axial and bending stress together at the two outer fibres [Pa]."""
        return read_only(stress_of(self.design.strips, self.along.axial_force, self.along.bending_moment))

    @cached_property
    def strip_stress(self) -> Array:
        """(S, G) largest stress of each strip, between the stations as well [Pa]."""
        return read_only(peak(self.stress))

    @property
    def max_stress(self) -> Array:
        """(S,) the largest of all strips [Pa]."""
        return np.asarray(self.strip_stress.max(axis=1, initial=0.0))

    @property
    def shift(self) -> Array | None:
        """Distance (S,) that the body point at the strip crossing moves [m].

        None unless the design is one body on two strips from the ground whose chords cross.
        """
        crossing, bodies = self.design.crossing_of_chords, self.along.bodies
        if crossing is None:
            return None
        rest, place = self.along.rest_bodies[:1], bodies[:, 0]
        return np.asarray(np.hypot(*centre_shift(crossing, place[:, 2], place[:, :2], rest).T))


def centre_shift(crossing: Any, rotation: Array, centre: Array, rest: Array | None = None) -> Array:
    """Return the displacement of the body's point that lies at the strips' crossing at rest.

    With x_c the crossing point at rest, g the centre of mass and R the rotation of the body,
    shift = g + R (x_c - g_0) - x_c, where g_0 is the centre at rest.

    Args:
        crossing: x_c (..., 2) [m], of one path or side by side of several.
        rotation: (..., S) [rad].
        centre: (..., S, 2) [m]; rest: g_0 (..., 1, 2) [m], that of the first state by default.

    Returns:
        (..., S, 2) [m].
    """
    crossing = np.asarray(crossing)[..., None, :]
    arm = crossing - (centre[..., :1, :] if rest is None else rest)
    cosine, sine = np.cos(rotation), np.sin(rotation)
    along, across = cosine * arm[..., 0] - sine * arm[..., 1], sine * arm[..., 0] + cosine * arm[..., 1]
    turned = np.stack((along, across), axis=-1)
    return np.asarray(centre + turned - crossing)
