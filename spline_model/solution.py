"""Results: frozen arrays with a status."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from spline_model.estimate import resolution

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


@dataclass(frozen=True, kw_only=True)
class ErrorEstimate:
    """Estimated error of a static path that was solved to an ``accuracy``, all relative [1].

    trajectory: largest distance of the centre from where it should be, over its largest
    displacement; torque, stiffness: largest error over the largest magnitude on the path.
    control_points that were chosen; trials: numbers of control points that were tried.
    Leaves out what more control points do not mend: the theory's own simplifications.
    """

    accuracy: float
    trajectory: float
    torque: float
    stiffness: float
    control_points: int
    trials: tuple[int, ...]

    @property
    def largest(self) -> float:
        """The larger error of trajectory and torque, which ``accuracy`` is about."""
        return max(self.trajectory, self.torque)


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


@dataclass(frozen=True, kw_only=True, eq=False)
class StaticSolution:
    """Answer of a pivot under a driven rotation; S states, G strips, P stations.

    rotation (S,) [rad]; load_factor (S,) share of the loads that acts; centre (S, 2) [m], origin at
    A1; torque (S,) lambda_13 [N m];
    stiffness (S,) d(torque)/d(rotation) [N m/rad] (Eq 20) at fixed loads and driven displacements,
    from the tangent;
    bending_energy, axial_energy, shear_energy (S,) [J], the last zero: no shear here;
    gravity_energy (S,) [J] against rest, work (S,) of drive and loads since the first state;
    clamp_reactions (S, G, 2, 3): force [N] and moment [N m] of the clamp at the ground
    and at the body end on the strip; stations (P,) reference arc length over L;
    shape (S, G, P, 2) [m]; axial_force, bending_moment, shear_force (S, G, P) [N, N m, N];
    inertia, moment_defect, critical_points and states as in ``Path``;
    seconds: by part, see ``spline_model.laps``;
    estimate: of the error, where an accuracy was asked for.
    """

    status: Status
    message: str
    rotation: Array
    load_factor: Array
    centre: Array
    torque: Array
    stiffness: Array
    bending_energy: Array
    axial_energy: Array
    shear_energy: Array
    gravity_energy: Array
    work: Array
    clamp_reactions: Array
    stations: Array
    shape: Array
    axial_force: Array
    bending_moment: Array
    shear_force: Array
    inertia: NDArray[np.int64]
    moment_defect: Array
    critical_points: tuple[CriticalPoint, ...]
    states: Array
    counters: dict[str, int]
    history: tuple[tuple[float, ...], ...]
    seconds: dict[str, float]
    estimate: ErrorEstimate | None = None

    @property
    def resolution(self) -> str:
        """Empty, or how uncertain too few control points make the answer (``spline_model.estimate``)."""
        return resolution(self.moment_defect)


@dataclass(frozen=True, kw_only=True, eq=False)
class MechanismSolution:
    """Answer of any mechanism; S states, G strips, P stations.

    load_factor (S,); bodies: x, y, theta (S, 3) by name [m, m, rad]; torque, stiffness (S,)
    of the driven rotation [N m, N m/rad], as of ``StaticSolution``, nan without one; bending_energy,
    axial_energy, gravity_energy, work (S,) [J]; stations (P,); shape (S, G, P, 2) [m]; axial_force,
    bending_moment, shear_force (S, G, P); effects: names of what was assembled;
    inertia, moment_defect, critical_points and states as in ``Path``; seconds: by
    part, see ``spline_model.laps``.
    """

    status: Status
    message: str
    load_factor: Array
    bodies: dict[str, Array]
    torque: Array
    stiffness: Array
    bending_energy: Array
    axial_energy: Array
    gravity_energy: Array
    work: Array
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

    @property
    def resolution(self) -> str:
        """Empty, or how uncertain too few control points make the answer (``spline_model.estimate``)."""
        return resolution(self.moment_defect)
