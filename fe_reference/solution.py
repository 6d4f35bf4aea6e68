"""Answers of the static solution: a status that says what to do, and arrays over the converged states."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Status(StrEnum):
    """How a solve ended."""

    CONVERGED = "converged"
    NOT_CONVERGED = "not_converged"
    UNSTABLE = "unstable"

    @property
    def text(self) -> str:
        """One sentence, ending with a remedy."""
        return {
            Status.CONVERGED: "converged: the whole path was solved; nothing to do.",
            Status.NOT_CONVERGED: "not converged: the path ends early; use more increments or a finer mesh.",
            Status.UNSTABLE: "unstable: the energy grew without bound; use a smaller time step.",
        }[self]


@dataclass(frozen=True, kw_only=True)
class CriticalPoint:
    """Where a path loses or regains stability, or where its torque is stationary.

    kind: "limit point" of the load factor, or of a driven rotation's torque; "turning point" of a drive,
    where the driven coordinate itself goes back; "bifurcation" otherwise. load_factor [1]; rotation of the
    driven body [rad], nan without one; inertia: negative eigenvalues after it; text: what happens at which
    load, "" for a stationary torque, which is not unstable.
    """

    kind: str
    load_factor: float
    rotation: float
    inertia: int
    text: str


@dataclass(frozen=True, kw_only=True, eq=False)
class StaticSolution:
    """Converged states of a static path, the unloaded one first: S states, G strips, P nodes a strip.

    Attributes:
        status, message: how the solve ended; why and where it stopped, what was critical on the way ("" if
            nothing was).
        inertia (S,): negative eigenvalues of the tangent with the drives held, 0 for a stable state.
        critical_points: in the order of the path.
        load_factor (S,): fraction of the path, or of the load in load control [1].
        rotation (S,): turn of the body [rad].
        centre (S, 2): centre of mass of the body, origin at the ground end of the first strip [m].
        torque (S,): generalised force on the rotation [N m]: the driving torque, or the applied moment.
        stiffness (S,): d torque / d rotation from the consistent tangent, all else free [N m/rad].
        bending_energy, axial_energy, shear_energy (S,): strain energy of all strips by part [J].
        clamp_reactions (S, G, 2, 3): force x, y [N] and moment [N m] exerted on the strip at its ground end
            (0) and by the body at the other end (1).
        stations (P,): reference arc length of the nodes over the strip's length, 0 at ground [1].
        shape (S, G, P, 2): positions of the nodes, same origin as the centre [m].
        axial_force, shear_force (S, G, P): N = n.t, V = n.normal [N] at the nodes: n is the force of the part
            beyond on the part before, t the normal of the cross-section, normal = t turned by
            +90 deg.
        bending_moment (S, G, P): M at the nodes [N m], positive for counter-clockwise curvature from ground.
            Forces and moments at a node are those of nodal equilibrium: the means of the end values of the
            adjacent elements, which agree to the residual.
        gravity_energy (S,): energy of the weight, zero in the shape at rest [J].
        work (S,): of drives and loads since the first state, by Hermite's rule over the increments [J].
        seconds: by part, see `fe_reference.stopwatch`.
        states (S, size): reduced coordinates, for `section_forces`.
        counters: increments, halvings, newton_iterations, residual_evaluations, tangent_evaluations,
            factorisations.
        history: dimensionless residual norms of every accepted increment.
    """

    status: Status
    message: str
    inertia: NDArray[np.int64]
    critical_points: tuple[CriticalPoint, ...]
    load_factor: Array
    rotation: Array
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
    states: Array
    counters: Mapping[str, int]
    history: tuple[tuple[float, ...], ...]
    seconds: Mapping[str, float]

    @property
    def strain_energy(self) -> Array:
        """Sum of the three parts (S,) [J]."""
        return self.bending_energy + self.axial_energy + self.shear_energy


@dataclass(frozen=True, kw_only=True, eq=False)
class MechanismSolution:
    """Converged states of a mechanism: S states from load factor 0 on, G strips, P nodes a strip.

    Attributes:
        status, message, inertia, critical_points, history: as in `StaticSolution`.
        load_factor (S,): [1].
        bodies: by name, place of the centre [m] and turn [rad], (S, 3) x, y, theta.
        torque, stiffness (S,): of the driven rotation [N m], [N m/rad]; nan if no rotation is driven.
        bending_energy, axial_energy, shear_energy (S,): strain energy of all strips by part [J].
        gravity_energy (S,): energy of the weight, zero in the shape at rest [J].
        work (S,): of drives and loads since the first state [J].
        shape (S, G, P, 2): positions of the nodes [m]. bending_moment (S, G, P): [N m].
        clamp_reactions (S, G, 2, 3): force x, y [N] and moment [N m] on the strip at its root and its tip.
        states (S, size): reduced coordinates, for `section_forces`.
        effects: names of the effects of the scene.
        seconds: as in `StaticSolution`.
        counters: as in `StaticSolution`, and settling_increments: of the way to the first state.
    """

    status: Status
    message: str
    inertia: NDArray[np.int64]
    critical_points: tuple[CriticalPoint, ...]
    load_factor: Array
    bodies: Mapping[str, Array]
    torque: Array
    stiffness: Array
    bending_energy: Array
    axial_energy: Array
    shear_energy: Array
    gravity_energy: Array
    work: Array
    shape: Array
    bending_moment: Array
    clamp_reactions: Array
    states: Array
    effects: tuple[str, ...]
    counters: Mapping[str, int]
    history: tuple[tuple[float, ...], ...]
    seconds: Mapping[str, float]

    @property
    def strain_energy(self) -> Array:
        """Sum of the three parts (S,) [J]."""
        return self.bending_energy + self.axial_energy + self.shear_energy
