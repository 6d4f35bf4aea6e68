"""What a moving mechanism is made of, and the arrays that its time steps work on.

All is dimensionless but time: lengths over L, energy over EI/L, masses in s^2 and dampers in s.
"""

from __future__ import annotations

from functools import cache
from typing import Annotated, Any, NamedTuple, TypeVar, get_type_hints

import numpy as np
from numpy.typing import NDArray

from spline_model.frames import Frames
from spline_model.motion.start import Motion
from spline_model.reduced.model import GAIN, LEAST_COMPLIANCE, Reduced, in_units
from spline_model.strip.element import FIRST, SECOND
from spline_model.tables import DriveTable, LoadTable

Array = NDArray[np.float64]
Places = NDArray[np.int64]


RECORDED = 3
"""Leading arrays of ``State`` that stand in a record."""


class Masses(NamedTuple):
    """What a mechanism in motion has beside its elasticity: B bodies, free strip ends among them, S strips.

    inertia, drag (Q,) of the bodies, Q = 3 B; across: drag between them over the poses of the scene's bodies,
    or (0, 0); points, damping (S, n, n): mass and drag of control points,
    along x as along y, in the order of elimination; relaxation (S,) [s]; pairs (G, 4, n n): products d1 d1,
    d1 d2, d2 d1, d2 d2 of the basis. loads (F) and drives (D) of the motion, at the coordinates load_at and
    drive_at of the bodies. gain (S, K): stiffness by which axial forces are condensed, of which the
    first ``outer`` stay beside the bodies; frames: as in ``Bodies``; free_from: first free end.
    """

    inertia: Array
    drag: Array
    points: Array
    damping: Array
    relaxation: Array
    pairs: Array
    loads: LoadTable
    load_at: Places
    drives: DriveTable
    drive_at: Places
    gain: Array
    across: Array
    frames: Frames
    outer: int
    free_from: int

    @classmethod
    def of(cls, motion: Motion, model: Reduced) -> Masses:
        """Return those of a motion of the reduced mechanism."""
        layout, length, energy = model.system.layout, model.length, model.energy
        strips, loads, drives, mass = model.strips, motion.loads, motion.drives, motion.system.mass
        drag = motion.system.drag if motion.system.drag.size else np.zeros_like(mass)
        (inertia, points, _), (friction, damping, across) = (_parts(model, each) for each in (mass, drag))
        basis = model.shape.tables[FIRST : SECOND + 1]
        pairs = [np.einsum("gi,gj->gij", one, other) for one in basis for other in basis]
        c = strips.compliance
        small = c < LEAST_COMPLIANCE
        outer = c.shape[1] if small[:, strips.split :].any() else strips.split if small.any() else 0
        small[:, :outer] = True
        size = np.where(drives.turns == 1, 1.0, length)
        return cls(
            inertia=inertia,
            drag=friction,
            points=points,
            damping=damping,
            relaxation=np.full(len(layout.strips), model.system.relaxation_time),
            pairs=np.stack(pairs, axis=1).reshape(len(pairs[0]), 4, -1),
            loads=loads._replace(value=loads.value * np.where(loads.turns == 1, 1.0, length) / energy),
            load_at=loads.coordinate - layout.poses.start,
            drives=drives._replace(origin=drives.origin / size, target=drives.target / size),
            drive_at=drives.coordinate - layout.poses.start,
            gain=np.where(small, GAIN, 1.0 / np.where(small, 1.0, c)),
            across=across if across.any() else across[:0, :0],
            frames=model.bodies.frames,
            outer=outer,
            free_from=len(model.system.scene.bodies),
        )


def _parts(model: Reduced, matrix: Array) -> tuple[Array, Array, Array]:
    """Of mass or drag: diagonal (Q,) of the bodies, blocks (S, n, n) of the strips along one axis,
    and what there is between bodies."""
    layout, order = model.system.layout, model.shape.order
    bodies, own = np.zeros(len(model.bodies.rest)), in_units(model.system, matrix[layout.poses, layout.poses])
    bodies[: len(own)] = np.diag(own)
    blocks = [matrix[at, at][::2, ::2][np.ix_(order, order)] for at in map(layout.strip, layout.strips)]
    return bodies, np.array(blocks) * (model.length**2 / model.energy), own - np.diag(np.diag(own))


class State(NamedTuple):
    """Where the mechanism is, and how it came there; S strips, Q coordinates of bodies, Y of all.

    y: the bodies' poses, own coordinates and axial forces of the strips; rate, velocity: of the bodies and of
    the control points, which stand in a record with y. acceleration, push: of control points and bodies;
    curve: C', C'' and |C'|; map: of the ends; totals: work of loads and drives and energy dissipated.
    """

    y: Annotated[Array, "Y"]
    rate: Annotated[Array, "Q"]
    velocity: Annotated[Array, "S 2n"]
    acceleration: Annotated[Array, "S 2n"]
    push: Annotated[Array, "Q"]
    curve: Annotated[Array, "S G 5"]
    map: Annotated[Array, "S 16"]
    totals: Annotated[Array, "2"]


class Scratch(NamedTuple):
    """Working arrays of a step; E = W + 6 + outer element coordinates, Q' = Q + S outer at the bodies.

    dy: changes, 2 tan(dphi / 2) of rotations, and the means of the axial forces; y: of the step's end; move:
    of the control points; mean, end: maps D, and derivatives at the end; steady, force, stiff: inertia, drag
    and loads; t: the tangent in x', y', x'', y'' at a Gauss point; lost: by the strips, over the step; blocks
    xx, xy, yx, yy of the tangent, a line of them; half: these in control points, ends' rows in coordinates;
    pull, along: of the axial forces and of their strains; residual, reduced: of it at the bodies with the
    strips condensed, which tangent solves; moved: see ``spline_model.motion.step``; load, turned: loads and
    followers on bodies; change: of a strip; held: 1 where a drive or a body holds; arms, ends: of frames;
    follow: values of followers.
    """

    dy: Annotated[Array, "Y"]
    y: Annotated[Array, "Y"]
    move: Annotated[Array, "S 2n"]
    mean: Annotated[Array, "S 16"]
    end: Annotated[Array, "16"]
    steady: Annotated[Array, "S 2n"]
    force: Annotated[Array, "S 2n"]
    stiff: Annotated[Array, "S n n"]
    t: Annotated[Array, "16"]
    lost: Annotated[Array, "S"]
    blocks: Annotated[Array, "4 nn"]
    line: Annotated[Array, "2n"]
    half: Annotated[Array, "2n 2n"]
    pull: Annotated[Array, "K 2n"]
    along: Annotated[Array, "K 2n"]
    g: Annotated[Array, "S E"]
    h: Annotated[Array, "S E E"]
    left: Annotated[Array, "K E"]
    right: Annotated[Array, "S K E"]
    tangent: Annotated[Array, "Q' Q'"]
    residual: Annotated[Array, "Y"]
    reduced: Annotated[Array, "Q'"]
    moved: Annotated[Array, "4 Q"]
    turned: Annotated[Array, "Q"]
    load: Annotated[Array, "Q"]
    change: Annotated[Array, "E"]
    held: Annotated[Places, "Q"]
    arms: Annotated[Array, "Q"]
    ends: Annotated[Array, "Q"]
    follow: Annotated[Array, "F"]


Kind = TypeVar("Kind", bound=tuple[Any, ...])


@cache
def _shapes_of(kind: type) -> dict[str, tuple[type, list[str]]]:
    """Type of number and sizes, by letters, of each array of a record that names them in its annotations."""
    hints = get_type_hints(kind, include_extras=True)
    return {
        name: (np.int64 if hint.__origin__ == Places else np.float64, hint.__metadata__[0].split())
        for name, hint in hints.items()
    }


def zeros(kind: type[Kind], sizes: dict[str, int]) -> Kind:
    """Return a record of arrays at zero; sizes: number of each letter in their shapes."""
    return kind(
        **{
            name: np.zeros([int(sizes.get(size, size)) for size in shape], dtype=number)
            for name, (number, shape) in _shapes_of(kind).items()
        }
    )


def sizes_of(model: Reduced, masses: Masses) -> dict[str, int]:
    """Return the number that each letter in the shapes of ``State`` and ``Scratch`` stands for."""
    (s, g, k), n, q = model.strips.modes.shape, len(model.shape.order), len(masses.inertia)
    sizes = {"S": s, "G": g, "K": k, "n": n, "2n": 2 * n, "nn": n * n, "Q": q, "D": len(masses.drive_at)}
    sizes |= {"F": len(masses.load_at), "Y": model.size, "E": 2 * n + masses.outer}
    return sizes | {"Q'": q + s * masses.outer}
