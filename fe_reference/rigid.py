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

from .arrays import Array, Indices
from .errors import InvalidParameter
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
    """Return coordinates of bodies that, held beside the `held` ones, leave no rigid motion free."""
    chosen: list[int] = []
    for bodies in _parts(structure.model):
        places = np.concatenate([np.arange(3) + structure.body_slice(b).start for b in bodies])
        motions = np.vstack([_motions(structure, b) for b in bodies])
        free = null_space(motions[np.isin(places, list(held))], rcond=RIGID) if len(bodies) else np.eye(3)
        for place, row in zip(places.tolist(), motions, strict=True):
            if np.abs(row @ free).max(initial=0.0) > RIGID:
                chosen.append(place)
                free = free @ null_space((row @ free)[None], rcond=RIGID)
    return np.array(sorted(chosen), dtype=np.int64)


def require_balance(structure: Structure, props: Indices, residual: Array, load: Array | None) -> None:
    """Refuse a state in which coordinates that are held for want of anything else bear something."""
    largest = 0.0 if load is None else float(np.abs(load).max())
    for k in props:
        if abs(residual[k]) > NONE * (structure.scale[k] + largest):
            body, axis = divmod(int(k) - structure.first_body, 3)
            raise NothingHolds(structure.model.body_names[body], axis, abs(float(residual[k])))


def _parts(model: Model) -> list[Indices]:
    """Return the bodies of each part that hangs together by strips but not with the ground."""
    count = len(model.bodies)
    joined = np.where(model.ends == GROUND, count, model.ends)
    rows, columns = joined[(joined != FREE).all(axis=1)].T
    graph = coo_matrix((np.ones(len(rows)), (rows, columns)), shape=(count + 1, count + 1))
    label = connected_components(graph, directed=False)[1]
    loose = sorted(set(label[:count].tolist()) - {int(label[count])})
    return [np.flatnonzero(label[:count] == each) for each in loose]


def _motions(structure: Structure, body: int) -> Array:
    """Return the rates of a body's coordinates in the rigid motions of its part (3, 3), lengths over L."""
    x, y = structure.points[body] / structure.length
    return np.array([[1.0, 0.0, -y], [0.0, 1.0, x], [0.0, 0.0, 1.0]])
