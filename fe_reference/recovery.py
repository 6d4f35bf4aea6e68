"""From reduced coordinates to what an engineer reads: shapes, section forces, clamp reactions."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .structure import Structure

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Recovery:
    """Fields of one state along the strips, as in `solution.StaticSolution` without the state axis."""

    shape: Array
    axial_force: Array
    shear_force: Array
    bending_moment: Array
    clamp_reactions: Array


def nodal_angles(structure: Structure) -> Array:
    """Return the reference direction at the nodes (G, P) [rad] from those of the chords; see `midpoints`."""
    chord = structure.elements.chord.reshape(2, structure.strips, -1)
    return midpoints(np.unwrap(np.arctan2(chord[1], chord[0]), axis=1))


def at_nodes(first: Array, last: Array) -> Array:
    """Merge the end values of the elements (G, E) at the nodes (G, P): the means of the adjacent elements."""
    return np.concatenate([first[:, :1], 0.5 * (first[:, 1:] + last[:, :-1]), last[:, -1:]], axis=1)


def midpoints(values: Array) -> Array:
    """Return values of the elements' middles (G, E) at the nodes (G, P).

    They are the means of the adjacent elements, and at the ends the line through the last two: a force there
    holds the weight or the inertia of the half element that stands at the end node, and a curved strip has
    the direction of its end.
    """
    inner = 0.5 * (values[:, 1:] + values[:, :-1])
    if values.shape[1] == 1:
        return np.repeat(values, 2, axis=1)
    first, last = 1.5 * values[:, :1] - 0.5 * values[:, 1:2], 1.5 * values[:, -1:] - 0.5 * values[:, -2:-1]
    return np.concatenate([first, inner, last], axis=1)


def recover(structure: Structure, y: Array) -> Recovery:
    """Return shape, section forces and reactions of the state y.

    The end forces of an element are those of its own equilibrium: of the part beyond on the element at its
    end, and the opposite at its beginning. Reactions are the section forces at the ends. The shape is in the
    frame of the model.
    """
    grid = (structure.strips, structure.stations)
    nodal = structure.displacement(y).reshape(*grid, 3)
    rest = np.array([strip.nodes for strip in structure.model.strips])
    forces = structure.element_forces(structure.element_displacement(y)).reshape(6, structure.strips, -1)
    force_x, force_y = (midpoints(forces[i]) for i in (3, 4))
    moment = at_nodes(-forces[2], forces[5])
    angle = nodal_angles(structure) + nodal[..., 2]
    c, s = np.cos(angle), np.sin(angle)
    beyond = np.stack([force_x, force_y, moment], axis=-1)
    reactions = np.stack([-beyond[:, 0], beyond[:, -1]], axis=1)
    return Recovery(
        shape=rest + nodal[..., :2],
        axial_force=force_x * c + force_y * s,
        shear_force=force_y * c - force_x * s,
        bending_moment=moment,
        clamp_reactions=reactions,
    )
