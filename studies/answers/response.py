"""The neutral answer to a static problem: arrays that do not tell which model they came from."""

import math
from collections.abc import Iterable
from dataclasses import asdict, dataclass, field, fields, replace
from functools import cached_property
from typing import Any, Self

import numpy as np

from studies.answers.models import Asked
from studies.answers.quantities import peak, stress_of
from studies.cases.design import Design
from studies.cases.effects import MOTION_ONLY
from studies.errors import Unanswered
from studies.kinds import Array

#: Parts of an estimate that are no error.
CHOSEN = ("accuracy", "segments", "control_points", "trials", "meshes")
#: What the models call the error of the bodies' places.
PLACES = ("trajectory", "path")


@dataclass(frozen=True, kw_only=True)
class Answered:
    """What every answer says of how it came about.

    Attributes:
        design: that was asked; modelled: the same in the model.
        model: "spline", "fe" or "fe-shear".
        settings: discretisation keywords, and what the model chose beside them.
        effects: names of what was assembled.
        status: "converged", or how it ended early; `message` says why and where or when, or what a path that
            reached its end has passed.
        solution: the model's own, which `answers.fields` makes fields of; None where there is none.
        estimate: what a model that was asked for an accuracy says of its error, by name; None otherwise.
    """

    design: Design
    modelled: Any = field(default=None, repr=False, compare=False)
    model: str
    settings: dict[str, Any]
    effects: tuple[str, ...]
    status: str
    message: str
    solution: Any = field(default=None, repr=False, compare=False)
    estimate: dict[str, Any] | None = None

    @property
    def converged(self) -> bool:
        """Whether all that was asked for was reached."""
        return self.status == "converged"

    def whole(self) -> Self:
        """Return the answer; Unanswered unless all that was asked for was reached."""
        if not self.converged:
            raise Unanswered(self.message)
        return self

    @property
    def errors(self) -> dict[str, float]:
        """Estimated errors by name, NaN of what there is none of; empty where nothing estimates them."""
        return {name: float(e) for name, e in (self.estimate or {}).items() if name not in CHOSEN}

    @property
    def largest_error(self) -> float:
        """The largest estimated error; NaN where nothing estimates one."""
        return float(np.fmax.reduce([math.nan, *self.errors.values()]))

    @property
    def body(self) -> str | None:
        """Name of the body that is driven or let go, or may be; None without one."""
        return self.design.body

    @staticmethod
    def about(asked: Asked, result: Any = None) -> dict[str, Any]:
        """Return what was asked, and of the model's own answer, where there is one, the settings that it has
        chosen for its accuracy and its estimate of its error."""
        parts = asdict(result.estimate) if getattr(result, "estimate", None) else None
        if parts is not None:
            parts |= dict(parts.pop("errors", {}))
        return {
            "design": asked.design,
            "modelled": asked.modelled,
            "model": asked.settings.model,
            "settings": asked.discretised(result),
            "effects": asked.effects,
            "solution": result,
            "estimate": parts,
        }


def read_only(array: Array) -> Array:
    """Return the array, no longer to be written."""
    array.flags.writeable = False
    return array


@dataclass(frozen=True, kw_only=True)
class Solved(Answered):
    """What every path and motion says beside that.

    Attributes:
        resolution: what too coarse a discretisation or step leaves uncertain; empty where it is resolved, and
            of a model that cannot tell.
        counters: work done, by kind.
        wall_s: time of the whole call, from the design to the answer [s].
        solve_s: of it, the increments or steps alone [s].
        bodies: (S, 3) by name, over states or instants: centre of mass x, y [m], rotation, counter-clockwise
            [rad]; a pivot's origin is A1.
    """

    resolution: str = ""
    counters: dict[str, int] = field(default_factory=dict)
    wall_s: float = 0.0
    solve_s: float = 0.0
    bodies: dict[str, Array]

    def __post_init__(self) -> None:
        """Make all arrays read only."""
        for array in (*vars(self).values(), *self.bodies.values()):
            if isinstance(array, np.ndarray):
                read_only(array)

    @property
    def rotation(self) -> Array:
        """(S,) of the body that is driven or let go, counter-clockwise [rad]."""
        return self.bodies[str(self.body)][:, 2]

    @property
    def centre(self) -> Array:
        """(S, 2) centre of mass of that body [m]."""
        return self.bodies[str(self.body)][:, :2]

    @classmethod
    def arrays(cls) -> list[str]:
        """Return the names of the arrays that are taken over from a model's own answer as they are."""
        return [each.name for each in fields(cls) if each.type == Array]

    @classmethod
    def made(cls, asked: Asked, result: Any, **own: Any) -> Self:
        """Return the neutral form of a model's path or motion, which has the arrays by the same names; `own`
        are its times, and what else stands in their place. Only some models say how well they resolve it."""
        arrays = {name: getattr(result, name) for name in cls.arrays() if hasattr(result, name)}
        ended: dict[str, Any] = {
            "bodies": {name: np.asarray(place, dtype=float) for name, place in result.bodies.items()},
            "status": str(result.status.value),
            "message": result.message,
            "resolution": getattr(result, "resolution", ""),
            "counters": dict(result.counters),
        }
        ended |= {name: np.asarray(array, dtype=float) for name, array in arrays.items()}
        return cls(**cls.about(asked, result) | ended | own)


@dataclass(frozen=True, kw_only=True)
class Response(Solved):
    """A static path of S converged states, that of load factor 0 first; G strips, P stations a strip.

    Attributes:
        critical_points: where it loses or regains stability, in its order, each with `kind` ("limit point",
            "turning point" or "bifurcation"), `load_factor` [1] and `rotation` [rad], NaN where none turns.
        load_factor: (S,) share of the loads that acts, of the rotation where there are none [1].
        torque: (S,) driving torque [N m]; stiffness: (S,) its derivative from the tangent [N m / rad]; NaN
            where nothing is driven.
        bending_energy, axial_energy, shear_energy: (S,) of all strips [J]; zero without shear.
        gravity_energy: (S,) against rest [J]; work: (S,) of loads and drives since the first state [J].
        stations: (P,) reference arc length over L [1]; axial_force: (S, G, P) [N]; bending_moment: [N m].
    """

    critical_points: tuple[Any, ...] = ()
    load_factor: Array
    torque: Array
    stiffness: Array
    bending_energy: Array
    axial_energy: Array
    shear_energy: Array
    gravity_energy: Array
    work: Array
    stations: Array
    axial_force: Array
    bending_moment: Array

    @property
    def crossing(self) -> tuple[float, float] | None:
        """Where a pivot's strips cross at rest [m]; None of a mechanism."""
        return getattr(self.design, "crossing_point", None)

    @property
    def places(self) -> Array:
        """(S, 2) load factor [1] and rotation [rad], NaN where no body turns."""
        turns = np.full(len(self.load_factor), np.nan) if self.body is None else self.rotation
        return np.stack((self.load_factor, turns), axis=1)

    @property
    def centres(self) -> dict[str, Array]:
        """(S, 2) centres of mass of the bodies by name [m]."""
        return {name: place[:, :2] for name, place in self.bodies.items()}

    @property
    def centre_shift(self) -> Array:
        """(S, 2) displacement of a pivot's point that lies at the strips' crossing at rest [m]."""
        return centre_shift(np.array(self.crossing), self.rotation, self.centre)

    @property
    def strain_energy(self) -> Array:
        """(S,) bending, axial and shear energy together [J]."""
        return self.bending_energy + self.axial_energy + self.shear_energy

    @cached_property
    def extreme_fibre_stress(self) -> Array:
        """(S, G, P) largest magnitude over the section's depth [Pa]."""
        return read_only(stress_of(self.design.strips, self.axial_force, self.bending_moment))

    @cached_property
    def strip_stress(self) -> Array:
        """(S, G) largest extreme-fibre stress of each strip, between the stations as well [Pa]."""
        return read_only(peak(self.extreme_fibre_stress))

    @property
    def max_stress(self) -> Array:
        """(S,) the largest of all strips [Pa]."""
        return np.asarray(self.strip_stress.max(axis=1, initial=0.0))

    @property
    def yield_share(self) -> Array | None:
        """(S,) largest stress over the yield strength of its strip [1]; None where a strip has none."""
        limits = [strip.yield_strength for strip in self.design.strips]
        if None in limits:
            return None
        worst = self.strip_stress / np.array(limits, dtype=float)
        return np.asarray(worst.max(axis=1))

    @cached_property
    def body_stiffness(self) -> Array:
        """(S, 3, 3) of the body that is driven or may be, about its centre, in x, y and turn, at fixed loads
        [N/m, N, N m/rad]; found when it is first asked for; nan with the paper's printed forces."""
        if self.settings.get("measure") == "printed":
            return read_only(np.full((len(self.load_factor), 3, 3), np.nan))
        return read_only(np.asarray(self.solution.body_stiffness(self.body)))

    @classmethod
    def of(cls, asked: Asked, result: Any, **seconds: float) -> "Response":
        """Return the neutral form of a model's path; seconds: its times."""
        own = {"critical_points": tuple(result.critical_points), "effects": assembled(asked.effects)}
        return cls.made(asked, result, **own, **seconds)._with_shift()

    def _with_shift(self) -> "Response":
        """Return the answer of a pivot that estimates its path with the error of the centre shift as well."""
        found = dict(self.estimate or {})
        known = next((found[name] for name in PLACES if name in found), None)
        if known is None or self.crossing is None:
            return self
        error = float(shift_error(np.array([known]), self.centre[None], self.centre_shift[None])[0])
        above = f"estimated error of the centre shift {error:.1e}, above {found['accuracy']:g}"
        remarks = (self.resolution, above if error > found["accuracy"] else "")
        return replace(
            self, estimate=found | {"centre_shift": error}, resolution="; ".join(filter(None, remarks))
        )


def shift_error(error: Array, centre: Array, shift: Array) -> Array:
    """Return errors of centre shifts (D, S, 2) [m] of D paths to given turns, over the largest (D,) [1].

    The shift errs as the centre (D, S, 2) does, `error` in parts of its largest displacement, but it is much
    smaller, so that it errs more. nan where nothing shifts.
    """
    moved, shifted = (
        np.fmax.reduce(np.linalg.norm(each, axis=2), axis=1) for each in (centre - centre[:, :1], shift)
    )
    return np.asarray(error * moved / np.where(shifted > 0.0, shifted, np.nan))


def assembled(names: Iterable[str]) -> tuple[str, ...]:
    """Return those of a scene's effects that a static path is made of."""
    return tuple(name for name in names if name not in MOTION_ONLY)


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
