"""What a moving mechanism is made of, and the arrays that its time steps work on.

All is dimensionless but time: lengths over L, energy over EI/L, masses in s^2 and dampers in s.
"""

from __future__ import annotations

from functools import cache
from typing import Annotated, Any, NamedTuple, TypeVar, get_type_hints

import numpy as np
from numpy.typing import NDArray

from spline_model.motion.start import Motion
from spline_model.tables import DriveTable, LoadTable

Array = NDArray[np.float64]
Places = NDArray[np.int64]


class Flexures(NamedTuple):
    """S strips of n control points, G Gauss points, K axial forces.

    d1, d2 (G, n) derivatives of the basis, pairs (G, 4, n n) the products d1 d1,
    d1 d2, d2 d1, d2 d2; weight (G,); speed, curvature, rigidity (S, G), curl (S, G, 2): the numbers of
    ``curl_law``, stretching, strain (S,), modes (S, G, K), compliance and gain (S, K), roots, tips (S,),
    root, tip (S, 3), reach (S, 2) as in ``spline_model.strip.element``; own: W; outer: leading axial
    forces that stay beside the bodies; free_from: first free end; relaxation (S,) [s]; mass, drag (S, n, n);
    dead (S, 2, n).
    """

    d1: Array
    d2: Array
    pairs: Array
    weight: Array
    speed: Array
    curvature: Array
    rigidity: Array
    curl: Array
    stretching: Array
    strain: Array
    modes: Array
    compliance: Array
    gain: Array
    own: int
    outer: int
    free_from: int
    relaxation: Array
    mass: Array
    drag: Array
    dead: Array
    roots: Places
    tips: Places
    root: Array
    tip: Array
    reach: Array
    measure: int


class Masses(NamedTuple):
    """B bodies, free strip ends among them, and what acts on them: Q = 3 B coordinates.

    inertia, drag, weight (Q,); loads (F) and drives (D) of the motion, these at the coordinates drive_at;
    load_body, load_strip, load_place (F,): body coordinate or -1, strip and place of its control point
    (component n + number).
    """

    inertia: Array
    drag: Array
    weight: Array
    loads: LoadTable
    load_body: Places
    load_strip: Places
    load_place: Places
    drives: DriveTable
    drive_at: Places

    @classmethod
    def of(cls, motion: Motion, poses: int) -> Masses:
        """The bodies and what acts on them; poses: the number of their coordinates."""
        system, loads, drives = motion.system, motion.loads, motion.drives
        layout, length, energy = system.layout, system.scales.length, system.scales.energy
        unit, begin = np.tile(system.scales.pose, poses // 3), layout.poses.start
        inertia, drag, weight = np.zeros((3, poses))
        given = np.diag(motion.mass), np.diag(motion.drag), system.weight
        for mine, acts in zip((inertia, drag, weight), given, strict=True):
            if acts.size:
                mine[: layout.poses.stop - begin] = acts[layout.poses]
        load_strip, load_place = np.full((2, loads.coordinate.size), -1)
        for s, (start, n) in enumerate(layout.strips[strip.name] for strip in system.scene.strips):
            at = loads.coordinate - start
            here = (at >= 0) & (at < 2 * n)
            load_strip[here], load_place[here] = s, (at % 2 * n + at // 2)[here]
        size = np.where(drives.turns == 1, 1.0, length)
        return cls(
            inertia=inertia * unit**2 / energy,
            drag=drag * unit**2 / energy,
            weight=weight * unit / energy,
            loads=loads._replace(value=loads.value * np.where(loads.turns == 1, 1.0, length) / energy),
            load_body=np.where(load_strip < 0, loads.coordinate - begin, -1),
            load_strip=load_strip,
            load_place=load_place,
            drives=drives._replace(origin=drives.origin / size, target=drives.target / size),
            drive_at=drives.coordinate - begin,
        )


class State(NamedTuple):
    """Where the mechanism is, and how it came there; S strips, Q coordinates of bodies, Y of all.

    y: the bodies' poses, own coordinates and axial forces of the strips; points, velocity, acceleration of
    the control points; rate, push: velocity and acceleration of the bodies; at: C', C'' and |C'|; ends: arm
    and s-direction of the clamps; clamped: force and moment of each clamp on its strip; totals: work of loads
    and drives and energy dissipated; reaction of drives.
    """

    y: Annotated[Array, "Y"]
    points: Annotated[Array, "S 2 n"]
    velocity: Annotated[Array, "S 2 n"]
    acceleration: Annotated[Array, "S 2 n"]
    rate: Annotated[Array, "Q"]
    push: Annotated[Array, "Q"]
    at: Annotated[Array, "S G 5"]
    ends: Annotated[Array, "S 2 4"]
    clamped: Annotated[Array, "S 2 3"]
    totals: Annotated[Array, "2"]
    reaction: Annotated[Array, "D"]


class Scratch(NamedTuple):
    """Working arrays of a step; E = W + 6 + outer element coordinates, Q' = Q + S outer at the bodies.

    dy: changes, 2 tan(dphi / 2) of rotations, and the means of the axial forces; pose, points, move, at,
    ends: of the step's end; steady, force, stiff: inertia, drag and loads; maps: D, and derivatives at the
    end; blocks xx, xy, yx, yy of the tangent; half of it in
    element coordinates; pull, along: of the axial forces and of their strains; residual, reduced: of it at
    the bodies with the strips condensed; system and x, free: what is solved; held: 1 where a drive holds.
    """

    dy: Annotated[Array, "Y"]
    pose: Annotated[Array, "Q"]
    points: Annotated[Array, "S 2 n"]
    move: Annotated[Array, "S 2 n"]
    at: Annotated[Array, "S G 5"]
    ends: Annotated[Array, "S 2 4"]
    steady: Annotated[Array, "S 2 n"]
    force: Annotated[Array, "S 2 n"]
    stiff: Annotated[Array, "S n n"]
    maps: Annotated[Array, "S 2 16"]
    blocks: Annotated[Array, "4 nn"]
    half: Annotated[Array, "2n E"]
    pull: Annotated[Array, "K 2n"]
    along: Annotated[Array, "K 2n"]
    g: Annotated[Array, "S E"]
    h: Annotated[Array, "S E E"]
    left: Annotated[Array, "K E"]
    right: Annotated[Array, "S K E"]
    gap: Annotated[Array, "S K"]
    tangent: Annotated[Array, "Q' Q'"]
    residual: Annotated[Array, "Y"]
    reduced: Annotated[Array, "Q'"]
    load: Annotated[Array, "Q"]
    system: Annotated[Array, "Q' Q'"]
    x: Annotated[Array, "Q'"]
    ends_change: Annotated[Array, "E"]
    mix: Annotated[Array, "4"]
    energies: Annotated[Array, "2"]
    free: Annotated[Places, "Q'"]
    held: Annotated[Places, "Q"]


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
    """A record of arrays at zero; sizes: of what its letters stand for."""
    return kind(
        **{
            name: np.zeros([int(sizes.get(size, size)) for size in shape], dtype=number)
            for name, (number, shape) in _shapes_of(kind).items()
        }
    )


def sizes_of(strips: Flexures, masses: Masses) -> dict[str, int]:
    """What the letters of ``State`` and ``Scratch`` stand for."""
    s, g, k = strips.modes.shape
    n, q, own = strips.mass.shape[1], len(masses.inertia), strips.own
    sizes = {"S": s, "G": g, "K": k, "n": n, "2n": 2 * n, "nn": n * n, "Q": q, "D": len(masses.drive_at)}
    return sizes | {"Y": q + s * (own + k), "E": own + 6 + strips.outer, "Q'": q + s * strips.outer}


class Poses(NamedTuple):
    """State of the bodies, Q coordinates and Q' with the axial forces beside them, and working arrays.

    y with the strips' coordinates; rate: velocities; energy: W and the next one; pull, next: reactions g,
    slope: derivative of the gap; totals: work and losses; ahead: the strips' change along the tangent, bent:
    what the last step's, of length last [s], left out; system, x, free; still: places of what has no mass.
    """

    y: Annotated[Array, "Y"]
    rate: Annotated[Array, "Q"]
    energy: Annotated[Array, "2"]
    pull: Annotated[Array, "Q'"]
    next: Annotated[Array, "Q'"]
    slope: Annotated[Array, "Q'"]
    totals: Annotated[Array, "2"]
    trial: Annotated[Array, "Y"]
    dx: Annotated[Array, "Q"]
    load: Annotated[Array, "Q"]
    ahead: Annotated[Array, "Y"]
    bent: Annotated[Array, "Y"]
    last: Annotated[Array, "1"]
    system: Annotated[Array, "Q' Q'"]
    x: Annotated[Array, "Q'"]
    free: Annotated[Places, "Q'"]
    still: Annotated[Places, "0"]

    @classmethod
    def of(cls, y: Array, rate: Array, inertia: Array, all_bodies: int) -> Poses:
        """A state with these coordinates and velocities; inertia (Q,)."""
        still = [*np.flatnonzero(inertia == 0.0), *range(len(rate), all_bodies)]
        poses = zeros(cls, {"Y": len(y), "Q": len(rate), "Q'": all_bodies})
        return poses._replace(
            y=y.copy(), trial=y.copy(), rate=rate, last=np.ones(1), still=np.array(still, dtype=np.int64)
        )
