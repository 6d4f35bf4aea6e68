"""Rigid motions that nothing resists, and the coordinates that are held in their place.

Parts of a model that hang on no clamp can move rigidly along x, along y and about the origin. What their held
coordinates leave free of this is the null space of their rows. As many coordinates more, the first ones that
the null space moves, make a path determinate. In equilibrium they bear nothing.
"""

from collections.abc import Iterable

import numpy as np
from scipy.linalg import null_space
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from .arrays import Array, Flags, Indices
from .errors import InvalidParameter
from .loads import Load
from .model import Model
from .places import FREE, GROUND
from .structure import Structure

#: Largest part of a row of unit size that is round-off.
RIGID = 1e-9
#: Largest force over EI/L^2, or moment over EI/L, that is none, beside that part of the largest load.
NONE = 1e-8
WAYS = ("in the direction x", "in the direction y", "against turning")
UNITS = ("N", "N", "N m")


class NothingHolds(InvalidParameter):
    """A load along a rigid motion that nothing resists."""

    def __init__(self, body: str, axis: int, load: float) -> None:
        expected = f"none, or a clamp or a drive that bears it: nothing holds body {body} {WAYS[axis]}"
        super().__init__(f"load on body {body}", f"{load:.4g} {UNITS[axis]}", f"{expected} [{UNITS[axis]}]")


def loose_coordinates(structure: Structure, held: Iterable[int]) -> Indices:
    """Return the coordinates (P,) of bodies that remove all free rigid motions if they are locked too.

    held: coordinates that are locked already.
    """
    part, many = _parts(structure.model)
    if not many:
        return np.zeros(0, dtype=np.int64)
    first, bodies = structure.first_body, part[len(structure.model.strips) : -1]
    own = [_motions(structure, *each, many) for each in zip(bodies, structure.points, strict=True)]
    motions = np.vstack([np.zeros((0, 3 * many)), *own])
    ties = [motions[[at - first for at in held]], *_tied(structure, part, many)]
    free = null_space(np.vstack([*ties, np.zeros((1, 3 * many))]), rcond=RIGID)
    chosen: list[int] = []
    for place, row in enumerate(motions, start=first):
        if np.abs(row @ free).max(initial=0.0) > RIGID:
            chosen.append(place)
            free = free @ null_space((row @ free)[None], rcond=RIGID)
    return np.array(chosen, dtype=np.int64)


def _parts(model: Model) -> tuple[Indices, int]:
    """Return the part of strips, bodies and ground (G + B + 1,), and how many there are beside the ground's.

    A part hangs together by ends that are not hinged. The ground's is the last one.
    """
    first, size = len(model.strips), len(model.strips) + len(model.bodies) + 1
    strip, end = np.nonzero((model.ends != FREE) & ~_hinged(model))
    there = np.where(model.ends == GROUND, size - 1, first + model.ends)[strip, end]
    graph = coo_matrix((np.ones(len(strip)), (strip, there)), shape=(size, size))
    many, label = connected_components(graph, directed=False)
    return (label - label[-1] - 1) % many, many - 1


def _hinged(model: Model) -> Flags:
    """Return which ends of the strips are hinged (G, 2)."""
    return np.array([strip.hinges for strip in model.strips])


def _tied(structure: Structure, part: Indices, many: int) -> Iterable[Array]:
    """Yield the rates (K, 3 many) that hinges and springs resist in the rigid motions of the parts."""
    model, first = structure.model, len(structure.model.strips)
    for strip, end in np.argwhere(_hinged(model)):
        place, there = model.rest[strip, -end], model.ends[strip, end]
        ends = part[strip], part[-1 if there == GROUND else first + there]
        yield np.subtract(*(_motions(structure, each, place, many) for each in ends))[:2]
    centres = np.vstack([model.centres, np.zeros(2)])
    for pair, stiffness in zip(structure.links[0], structure.links[2], strict=True):
        one, other = (_motions(structure, part[first:][b], centres[b], many) for b in pair)
        yield (one - other)[stiffness > 0.0]


def _motions(structure: Structure, part: int, point: Array, many: int) -> Array:
    """Return the rates of a point [over L] and a turn in the rigid motions of its part (3, 3 many).

    Nothing moves in the part of the ground, which is the last.
    """
    rates, (x, y) = np.zeros((3, 3 * many + 3)), point / structure.length
    rates[:, 3 * part : 3 * part + 3] = [[1.0, 0.0, -y], [0.0, 1.0, x], [0.0, 0.0, 1.0]]
    return rates[:, : 3 * many]


def require_balance(structure: Structure, props: Indices, residual: Array, load: Load | None) -> None:
    """Raise InvalidParameter if coordinates that are locked only to remove rigid motions carry a force.

    props: these coordinates (P,). residual: (size,) [N, N m]. load: that acts, if any.
    """
    largest = 0.0 if load is None else float(np.abs(load.constant).max())
    for k in props:
        if abs(residual[k]) > NONE * (structure.scale[k] + largest):
            body, axis = divmod(int(k) - structure.first_body, 3)
            raise NothingHolds(structure.model.body_names[body], axis, abs(float(residual[k])))
