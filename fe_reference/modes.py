"""Natural frequencies and shapes of small motion about a static state: K x = omega^2 M x."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import eigsh

from .errors import InvalidParameter, choice, finite
from .errors import count as at_least_one
from .mass import MASSES, mass_matrix
from .model import Model
from .statics import driven_state
from .structure import Structure

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Modes:
    """The lowest modes of small motion, C modes of G strips with P nodes.

    Attributes:
        rotation: rotation of the static state [rad].
        held: whether the rotation of the body is held; if not, the driving torque stays on as it is.
        mass: "consistent" or "lumped".
        frequency (C,): [Hz], ascending; negative where the state is unstable: -growth rate / (2 pi).
        shapes (C, G, P, 2): displacements of the nodes, of unit modal mass [m / sqrt(kg m^2)].
        body_shapes (C, 3): displacement of the body's centre of mass and its rotation, in the same scale.
    """

    rotation: float
    held: bool
    mass: str
    frequency: Array
    shapes: Array
    body_shapes: Array


def natural_frequencies(
    pivot: Model,
    *,
    rotation: float = 0.0,
    count: int = 10,
    held: bool = False,
    mass: str = "consistent",
    increments: int = 20,
) -> Modes:
    """Return the lowest natural frequencies and shapes about the state at a driven rotation.

    Args:
        pivot: the model. rotation: of the static state [rad]. count: number of modes.
        held: whether the rotation of the body stays held; if not the torque of the drive stays on unchanged.
        mass: "consistent" (default) or "lumped", the one of the explicit integrator.
        increments: of the static path to the state.

    Exact for small motion; leaves out damping.

    Raises:
        InvalidParameter: more modes than there are coordinates, an unknown kind of mass.
        ConvergenceError: the static state cannot be reached.
    """
    kind = choice("mass", mass, MASSES)
    structure = pivot.structure
    y = driven_state(structure, finite("rotation", rotation, "rad"), increments)
    n = structure.size - (1 if held else 0)
    wanted = _modes_wanted(count, n)
    stiffness = structure.tangent_stiffness(y)[:n, :n].tocsc()
    values, vectors = _lowest(structure, stiffness, mass_matrix(structure, y, kind)[:n, :n].tocsc(), wanted)
    full = np.zeros((wanted, structure.size))
    full[:, :n] = vectors.T
    full *= np.sign(full[np.arange(wanted), np.abs(full).argmax(axis=1)])[:, None]
    return Modes(
        rotation=float(rotation),
        held=held,
        mass=kind,
        frequency=np.sign(values) * np.sqrt(np.abs(values)) / (2.0 * np.pi),
        shapes=_nodal_shapes(structure, full, y[-1]),
        body_shapes=full[:, -3:],
    )


def _modes_wanted(wanted: int, available: int) -> int:
    if at_least_one("count", wanted) > available:
        raise InvalidParameter("count", wanted, f"at most {available} modes of this mesh [1]")
    return wanted


def _lowest(
    structure: Structure, stiffness: csc_matrix, mass: csc_matrix, wanted: int
) -> tuple[Array, Array]:
    """Return the `wanted` lowest eigenvalues [1/s^2], ascending, and vectors of unit modal mass.

    Inverse iteration (Lanczos) keeps the lowest modes free of the round-off of the stiffest ones. It is
    shifted a little below zero, so that rigid motions do not make it singular.
    """
    if wanted >= stiffness.shape[0] - 1:
        values, vectors = eigh(stiffness.toarray(), mass.toarray())
        return values[:wanted], vectors[:, :wanted]
    shift = -0.01 * structure.force_unit / float(np.abs(mass.diagonal()[0::3]).sum())
    shift /= max(strip.length for strip in structure.model.strips)
    start = np.ones(stiffness.shape[0])
    values, vectors = eigsh(stiffness, wanted, mass, sigma=shift, which="LM", v0=start, tol=0.0)
    order = np.argsort(values)
    return values[order], vectors[:, order]


def _nodal_shapes(structure: Structure, full: Array, theta: float) -> Array:
    """Return the displacements (C, G, P, 2) of the nodes for modes (C, size) at the rotation theta."""
    shapes = np.zeros((len(full), structure.strips * structure.stations, 2))
    shapes[:, structure.free_nodes] = full[:, :-3].reshape(len(full), -1, 3)[..., :2]
    arms = structure.arms(theta)
    slope = np.stack([-arms[:, 1], arms[:, 0]], axis=1)
    shapes[:, structure.attached] = full[:, None, -3:-1] + full[:, None, -1:] * slope
    return shapes.reshape(len(full), structure.strips, structure.stations, 2)
