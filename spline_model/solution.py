"""Results: frozen arrays with a status."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from spline_model.errors import InvalidParameter
from spline_model.estimate import resolution

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


@dataclass(frozen=True, kw_only=True, eq=False)
class Path:
    """An equilibrium path, S converged states, the unloaded one first.

    load_factor (S,); states (S, N) unknowns z; rates (S, N) dz/d(load factor), from the
    tangent; stiffness (S,) d(torque)/d(rotation) of a driven rotation at fixed loads, nan without
    one [N m/rad]; energies (S, 2) bending and axial [J]; work (S,) of loads and drives since the
    first state [J]; history: residual norms by increment.
    inertia (S,): negative eigenvalues of the reduced tangent with the drives held, 0 for a
    stable state, -1 where the printed forces have no potential; moment_defect (S,): what the
    strips' moments differ from balance by, relative (``continuation.resolution``);
    critical_points in the order of the path.
    """

    status: Status
    message: str
    load_factor: Array
    states: Array
    rates: Array
    stiffness: Array
    energies: Array
    work: Array
    inertia: NDArray[np.int64]
    moment_defect: Array
    critical_points: tuple[CriticalPoint, ...]
    counters: dict[str, int]
    history: tuple[tuple[float, ...], ...]


ERRORS = ("trajectory", "torque", "stiffness", "section_forces", "stress")
"""What an accuracy of a static path is about."""


@dataclass(frozen=True, kw_only=True)
class ErrorEstimate:
    """Estimated error of a static path that was solved to an ``accuracy``, all relative [1].

    trajectory: largest error of a body's place over the largest displacement, and of its turn where that is
    not driven; torque, stiffness, section_forces, stress (the largest over a strip of the rectangular section
    that A and I imply): largest error over the largest magnitude on the path.
    control_points that were chosen; trials: numbers of control points that were tried.
    Leaves out what more control points do not mend: the theory's own simplifications.
    """

    accuracy: float
    trajectory: float
    torque: float
    stiffness: float
    section_forces: float
    stress: float
    control_points: int
    trials: tuple[int, ...]

    @property
    def largest(self) -> float:
        """The largest of the errors, which ``accuracy`` is about."""
        return max(float(getattr(self, name)) for name in ERRORS)

    @property
    def remark(self) -> str:
        """Empty, or what is more uncertain than the accuracy."""
        missed = [name for name in ERRORS if not getattr(self, name) <= self.accuracy]
        if not missed:
            return ""
        errors = ", ".join(f"{name.replace('_', ' ')} {getattr(self, name):.1e}" for name in missed)
        return f"estimated error above {self.accuracy:g} with {self.control_points} control points: {errors}"


@dataclass(frozen=True, kw_only=True)
class FrequencyEstimate:
    """Estimated error of natural frequencies that were solved to an ``accuracy``, relative [1].

    frequency: the largest of all modes; control_points and trials as of ``ErrorEstimate``.
    """

    accuracy: float
    frequency: float
    control_points: int
    trials: tuple[int, ...]


@dataclass(frozen=True, kw_only=True)
class MotionEstimate:
    """Estimated error of the rotation of a motion that was solved to an ``accuracy`` [rad].

    rotation: its largest error over the motion, of the steps (``time``) and of the control points
    (``space``) together, which may cancel in part; control_points that were chosen; runs that
    it took.
    """

    accuracy: float
    rotation: float
    time: float
    space: float
    control_points: int
    runs: int


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

    load_factor (S,) share of the loads that acts; bodies: x, y, theta (S, 3) by name [m, m, rad]; driven:
    the body whose rotation is driven, if there is one;
    torque (S,) lambda_13 [N m], and stiffness (S,) d(torque)/d(rotation) [N m/rad] (Eq 20) at fixed loads
    and driven displacements, from the tangent, of the driven rotation, nan without one;
    bending_energy, axial_energy (S,) [J];
    gravity_energy (S,) [J] against rest, work (S,) of drives and loads since the first state;
    clamp_reactions (S, G, 2, 3): force [N] and moment [N m] of the clamp at the root and at the tip of a
    strip, zero at a free end; stations (P,) reference arc length over L;
    shape (S, G, P, 2) [m]; axial_force, bending_moment, shear_force (S, G, P) [N, N m, N];
    effects: names of what was assembled;
    inertia, moment_defect, critical_points and states as in ``Path``;
    seconds: by part, see ``spline_model.laps``; control_points: of a strip;
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
    gravity_energy: Array
    work: Array
    clamp_reactions: Array
    stations: Array
    shape: Array
    axial_force: Array
    bending_moment: Array
    shear_force: Array
    effects: tuple[str, ...]
    inertia: NDArray[np.int64]
    moment_defect: Array
    critical_points: tuple[CriticalPoint, ...]
    states: Array
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
    def shear_energy(self) -> Array:
        """None: strips are rigid in shear (S,) [J]."""
        return np.zeros(len(self.load_factor))

    @property
    def resolution(self) -> str:
        """Empty, or how uncertain the control points make the answer: by its estimate, or by its moments."""
        return resolution(self.moment_defect) if self.estimate is None else self.estimate.remark

    @property
    def _watched(self) -> Array:
        if self.driven is None and len(self.bodies) != 1:
            raise InvalidParameter("bodies", list(self.bodies), "one body, or the name of one in ``bodies``")
        return next(iter(self.bodies.values())) if self.driven is None else self.bodies[self.driven]

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
