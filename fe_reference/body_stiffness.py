"""Stiffness of a body against small displacements and turns, about any static state of a mesh."""

import numpy as np
from numpy.typing import NDArray

from .effects import DrivenDisplacement
from .matrix import Singular, Symmetric
from .model import Model
from .structure import structure_of

Array = NDArray[np.float64]


def body_stiffness(
    model: Model, states: Array, body: str | None = None, *, driven: str | None = None
) -> Array:
    """Return the stiffness (S, 3, 3) of a body's x, y and turn about its centre at balanced states (S, size).

    It is the change of what must be exerted on the body, forces [N] and a moment [N m], by displacements [m]
    and a turn [rad] in the axes of the ground: each of the three is prescribed in turn, the others held, and
    all other coordinates follow by the consistent tangent, under loads that stay. What is prescribed to the
    body is let go, what is prescribed to others holds them.

    Args:
        model: the mesh that the states belong to. body: its name; None: the only one. driven: name of the
            body whose turn is led, if there is one.

    Exact for the mesh: dead loads act at centres and have no stiffness there. nan where the tangent is
    singular.
    """
    structure, which = structure_of(model), model.body_index(body)
    place = structure.body_slice(which)
    held = np.zeros(structure.size, dtype=bool)
    held[place] = True
    if driven is not None:
        held[structure.turns[model.body_index(driven)]] = True
    led = model.effects.find(DrivenDisplacement)
    if led is not None and led.body is not None:  # without a name it is of the body that is asked for
        other = structure.body_slice(model.body_index(led.body))
        held[other.start : other.start + 2] = True
    prescribed = np.zeros((3, structure.size))
    prescribed[:, place] = np.eye(3)
    return np.array([_stiffness(structure.evaluate(y).tangent, held, prescribed) for y in np.asarray(states)])


def _stiffness(tangent: Symmetric, held: NDArray[np.bool_], prescribed: Array) -> Array:
    """Return the forces (3, 3) on what is prescribed, (3, size) displacements, all that is not held free."""
    try:
        factors = tangent.factors(held)
    except Singular:
        return np.full((3, 3), np.nan)
    moves = prescribed - factors.solve(tangent.times(prescribed))
    return np.asarray(moves @ tangent.times(moves).T)  # errors of the solve enter squared
