"""Results: frozen arrays with a status."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from spline_model.body_stiffness import body_stiffness
from spline_model.compile import System
from spline_model.errors import InvalidParameter
from spline_model.estimate import ErrorEstimate, resolution
from spline_model.sections import ENDS, STATIONS, Sections, clamp_reactions, sections

if TYPE_CHECKING:
    import pandas as pd

Array = NDArray[np.float64]


class Status(Enum):
    """How a solve ended; the text ends with a remedy."""

    CONVERGED = "converged"
    NOT_CONVERGED = "not_converged"

    @property
    def text(self) -> str:
        """The outcome in a sentence."""
        if self is Status.CONVERGED:
            return "every increment converged"
        return (
            "the path stopped before its end and its last state is the last good one; "
            "try more increments, more control points or gauss_points, or axial_modes = control_points - 2"
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class CriticalPoint:
    """Where a path loses or regains stability, or where its load or torque is stationary.

    kind: "limit point" of the load factor, or of a driven rotation's torque, where its stiffness
    at fixed loads vanishes; "turning point" of a drive, where the driven coordinate itself goes
    back; "bifurcation" otherwise.
    load_factor; rotation of the driven body [rad], nan without one; z (N,) unknowns; mode (Q,)
    change of the coordinates, its largest entry one strip length or 1 rad (for a limit of the
    torque the turn at fixed loads); inertia: that of the tangent after it.
    """

    kind: str
    load_factor: float
    rotation: float
    z: Array
    mode: Array
    inertia: int


@dataclass(frozen=True, eq=False)
class Later:
    """An array that is made when it is first asked for; last: the model and what its last row is in it."""

    make: Callable[[], Array]
    last: tuple[Any, Array] | None = None

    @cached_property
    def array(self) -> Array:
        """It."""
        return self.make()


@dataclass(frozen=True, kw_only=True, eq=False)
class Path:
    """An equilibrium path, S converged states, the unloaded one first.

    load_factor (S,); bodies (S, 3 B): x, y, theta of each [m, rad]; reactions (S, D) of the drives, as
    multipliers; unknowns: z (S, N) of all states; stiffness (S,) d(torque)/d(rotation) of a driven rotation
    at fixed loads, nan without one [N m/rad]; energies (S, 2) bending and axial, (S, 3) where strips shear
    [J]; work (S,) of loads and drives since the first state [J]; history: residual norms by increment.
    inertia (S,): negative eigenvalues of the reduced tangent with the drives held, 0 for a
    stable state, -1 where the printed forces have no potential; moment_defect (S,): what the
    strips' moments differ from balance by, relative (``continuation.resolution``);
    critical_points in the order of the path.
    """

    status: Status
    message: str
    load_factor: Array
    bodies: Array
    reactions: Array
    unknowns: Later
    stiffness: Array
    energies: Array
    work: Array
    inertia: NDArray[np.int64]
    moment_defect: Array
    critical_points: tuple[CriticalPoint, ...]
    counters: dict[str, int]
    history: tuple[tuple[float, ...], ...]

    @property
    def states(self) -> Array:
        """The unknowns z of all states (S, N)."""
        return self.unknowns.array

    def rows(self, kept: slice) -> dict[str, Any]:
        """What it has by state, of some of them."""
        unknowns = self.unknowns
        return {name: getattr(self, name)[kept] for name in BY_STATE} | {
            "unknowns": Later(partial(_some, unknowns, kept))
        }


BY_STATE = (
    "load_factor",
    "bodies",
    "reactions",
    "stiffness",
    "energies",
    "work",
    "inertia",
    "moment_defect",
)


def _some(unknowns: Later, kept: slice) -> Array:
    return unknowns.array[kept]


def joined(parts: Sequence[Later]) -> Array:
    """Rows of several arrays, one after another."""
    return np.concatenate([part.array for part in parts])


class Tabulated:
    """An answer with a ``status`` whose ``columns`` make a table and, their last row, its line."""

    status: Status

    def columns(self) -> dict[str, Array]:
        """What is one number in every row, by names with units."""
        raise NotImplementedError

    def to_frame(self) -> pd.DataFrame:
        """The columns as a table."""
        import pandas as pd

        return pd.DataFrame(self.columns())

    def __repr__(self) -> str:
        columns = self.columns()
        rows = len(next(iter(columns.values())))
        told = ", ".join(f"{name} = {values[-1]:.6g}" for name, values in columns.items())
        return f"<{type(self).__name__} {self.status.value}, {rows} rows, the last one: {told}>"


def body_columns(bodies: Mapping[str, Array]) -> dict[str, Array]:
    """Columns of x, y, theta (S, 3) of bodies, named after them where there are several."""
    return {
        part if len(bodies) == 1 else f"{name}_{part}": place[:, k]
        for name, place in bodies.items()
        for k, part in enumerate(("x_m", "y_m", "rotation_rad"))
    }


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class StaticSolution(Tabulated):
    """Answer of a mechanism, a pivot or any other; S states, G strips, P stations.

    load_factor (S,) share of the loads that acts, below zero where they act the other way; bodies: x, y,
    theta (S, 3) by name [m, m, rad]; driven: the body whose rotation is driven, if there is one;
    torque (S,) lambda_13 [N m], and stiffness (S,) d(torque)/d(rotation) [N m/rad] (Eq 20) at fixed loads
    and driven displacements, from the tangent, of the driven rotation, nan without one;
    bending_energy, axial_energy and, of strips that shear, shear_energy (S,) [J];
    gravity_energy (S,) [J] against rest, work (S,) of drives and loads since the first state;
    what is known along the strips is made when it is asked for; balanced: see ``Sections``;
    effects: names of what was assembled;
    inertia, moment_defect, critical_points and states (S, N) as in ``Path``;
    seconds: by part, see ``spline_model.newton.Laps``; control_points: of a strip;
    estimate: of the error, where the control points were chosen for an accuracy.
    """

    status: Status
    message: str
    load_factor: Array
    bodies: dict[str, Array]
    driven: str | None
    torque: Array
    stiffness: Array
    bending_energy: Array
    axial_energy: Array
    shear_energy: Array
    gravity_energy: Array
    work: Array
    system: System
    unknowns: Later
    balanced: bool
    effects: tuple[str, ...]
    inertia: NDArray[np.int64]
    moment_defect: Array
    critical_points: tuple[CriticalPoint, ...]
    counters: dict[str, int]
    history: tuple[tuple[float, ...], ...]
    seconds: dict[str, float]
    control_points: int
    estimate: ErrorEstimate | None = None

    @property
    def rotation(self) -> Array:
        """Rotation of the driven body, or of the only one (S,) [rad]."""
        return self._watched[:, 2]

    @property
    def centre(self) -> Array:
        """Centre of the driven body, or of the only one (S, 2) [m]."""
        return self._watched[:, :2]

    @property
    def states(self) -> Array:
        """The unknowns z of all states (S, N), to go on from."""
        return self.unknowns.array

    @cached_property
    def clamp_reactions(self) -> Array:
        """Force [N] and moment [N m] of the clamps at root and tip of the strips (S, G, 2, 3)."""
        names = [strip.name for strip in self.system.scene.strips]
        ends = [[clamp_reactions(self.system, self.states, name, end) for end in ENDS] for name in names]
        return np.asarray(np.array(ends).transpose(2, 0, 1, 3))

    @property
    def stations(self) -> Array:
        """Where sections are recovered (P,), reference arc length over L."""
        return STATIONS

    @cached_property
    def sections(self) -> Sections:
        """Shapes and section forces."""
        return sections(self.system, self.states, STATIONS, balanced=self.balanced)

    @property
    def shape(self) -> Array:
        """Points of the strips (S, G, P, 2) [m]."""
        return self.sections.shape

    @property
    def axial_force(self) -> Array:
        """N (S, G, P) [N]."""
        return self.sections.axial_force

    @property
    def bending_moment(self) -> Array:
        """M (S, G, P) [N m]."""
        return self.sections.bending_moment

    @property
    def shear_force(self) -> Array:
        """V (S, G, P) [N]."""
        return self.sections.shear_force

    def body_stiffness(self, body: str | None = None) -> Array:
        """Stiffness (S, 3, 3) of a body's x, y, theta [N/m, N, N m/rad]: ``body_stiffness``.

        body: its name; None for the driven one, or the only one.
        """
        return body_stiffness(self.system, self.states, body or self._watched_name)

    @property
    def resolution(self) -> str:
        """Empty, or how uncertain the control points make the answer: by its estimate, or by its moments."""
        return resolution(self.moment_defect) if self.estimate is None else self.estimate.remark

    @property
    def _watched(self) -> Array:
        return self.bodies[self._watched_name]

    @property
    def _watched_name(self) -> str:
        if self.driven is None and len(self.bodies) != 1:
            raise InvalidParameter("bodies", list(self.bodies), "one body, or the name of one in ``bodies``")
        return next(iter(self.bodies)) if self.driven is None else self.driven

    def columns(self) -> dict[str, Array]:
        """What is one number in every state, by names with units."""
        energies = ("bending_energy", "axial_energy", "gravity_energy", "work")
        return {
            "load_factor": self.load_factor,
            **body_columns(self.bodies),
            "torque_Nm": self.torque,
            "stiffness_Nm_per_rad": self.stiffness,
            **{f"{name}_J": getattr(self, name) for name in energies},
            "inertia": self.inertia,
            "moment_defect": self.moment_defect,
        }
