"""Rigid motions that nothing resists, and the coordinates that are held in their place.

Strips and bodies can move rigidly along x, along y and about the origin. What the ends of strips, springs and
held coordinates leave free of this is the null space of their rows. As many coordinates more, the first ones
that the null space moves, make a path determinate. In equilibrium they bear nothing.
"""

from collections.abc import Iterable

import numpy as np
from scipy.linalg import null_space

from .arrays import Array, Indices
from .errors import InvalidParameter
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
    first, strips, places = structure.first_body, len(structure.model.strips), structure.points
    motions = [_motions(structure, k, place) for k, place in enumerate(places, start=strips)]
    rates = np.vstack([np.zeros((0, 3 * (strips + len(places)))), *motions])
    free = null_space(np.vstack([*_tied(structure), rates[[at - first for at in held]]]), rcond=RIGID)
    chosen: list[int] = []
    for place, row in enumerate(rates, start=first):
        if np.abs(row @ free).max(initial=0.0) > RIGID:
            chosen.append(place)
            free = free @ null_space((row @ free)[None], rcond=RIGID)
    return np.array(chosen, dtype=np.int64)


def _tied(structure: Structure) -> Iterable[Array]:
    """Yield the rates (K, 3 (G + B)) that ends of strips and springs resist in rigid motions of all parts."""
    model, strips = structure.model, len(structure.model.strips)
    ground = strips + len(model.bodies)
    for (strip, end), there in np.ndenumerate(model.ends):
        if there != FREE:
            place, on = model.rest[strip, -end], ground if there == GROUND else strips + int(there)
            ties = _motions(structure, strip, place) - _motions(structure, on, place)
            yield ties[: 2 if model.strips[strip].hinges[end] else 3]
    (roots, rows, _, stiffnesses, _), centres = structure.links, np.vstack([model.centres, np.zeros(2)])
    for pair, stiffness in zip(rows[roots:] - structure.nodes, stiffnesses[roots:], strict=True):
        one, other = (_motions(structure, strips + b, centres[b]) for b in pair)
        yield (one - other)[stiffness > 0.0]


def _motions(structure: Structure, part: int, point: Array) -> Array:
    """Return the rates (3, 3 (G + B)) of a point [over L] and a turn in the rigid motions of its part.

    Parts are the strips, then the bodies, and last the ground, which does not move.
    """
    many = len(structure.model.strips) + len(structure.model.bodies)
    rates, (x, y) = np.zeros((3, 3 * many + 3)), point / structure.length
    rates[:, 3 * part : 3 * part + 3] = [[1.0, 0.0, -y], [0.0, 1.0, x], [0.0, 0.0, 1.0]]
    return rates[:, : 3 * many]


def require_balance(structure: Structure, props: Indices, residual: Array, load: Array | None) -> None:
    """Check that coordinates that are held for want of anything else bear no force.

    Args:
        structure: reduced model.
        props: these coordinates (P,).
        residual: forces of the state (size,) [N, N m].
        load: factors of the loads (K,) [1], or None.

    Raises:
        NothingHolds: such a coordinate bears a force.
    """
    rest = np.zeros(structure.size)
    largest = 0.0 if load is None else float(np.abs(structure.load_force(rest, load)[0]).max())
    for k in props:
        if abs(residual[k]) > NONE * (structure.scale[k] + largest):
            body, axis = divmod(int(k) - structure.first_body, 3)
            raise NothingHolds(structure.model.body_names[body], axis, abs(float(residual[k])))
