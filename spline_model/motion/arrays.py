"""What a moving mechanism is made of, and the arrays that its time steps work on.

All is dimensionless but time: lengths over L, energy over EI/L, masses in s^2 and dampers in s.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.motion.start import Motion

Array = NDArray[np.float64]
Places = NDArray[np.int64]


class Flexures(NamedTuple):
    """S strips of n control points, G Gauss points with W basis functions each, K axial forces.

    first (G,) of the basis functions; d1, d2 (G, W) their derivatives, pairs (G, 4, W W) the products d1 d1,
    d1 d2, d2 d1, d2 d2; weight (G,); speed, curvature, rigidity (S, G), curl (S, G, 2): the numbers of
    ``curl_law``, stretching, strain (S,), modes (S, G, K), compliance and gain (S, K), roots, tips (S,),
    root, tip (S, 3), reach (S, 2) as in ``spline_model.strip.element``; outer: leading axial forces that stay
    beside the bodies; free_from: first free end; relaxation (S,) [s]; mass, drag (S, n, n); dead (S, 2, n).
    """

    first: Places
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

    inertia, drag, weight (Q,). Loads (F,): body coordinate or -1, strip and place of its control point
    (component n + number), value, pieces (first, pairs) of times and factors. Drives (D,): coordinate,
    origin, target, pieces, times and factors as those of the scene.
    """

    inertia: Array
    drag: Array
    weight: Array
    load_body: Places
    load_strip: Places
    load_place: Places
    load_value: Array
    load_first: Places
    load_pairs: Places
    load_times: Array
    load_factors: Array
    drive_at: Places
    drive_origin: Array
    drive_target: Array
    drive_first: Places
    drive_pairs: Places
    drive_times: Array
    drive_factors: Array


def masses_of(system: System, motion: Motion, poses: int) -> Masses:
    """The bodies and what acts on them; poses: the number of their coordinates."""
    scene, layout, tables = system.scene, system.layout, system.tables
    length, energy, loads, drives = system.scales.length, system.scales.energy, tables.loads, tables.drives
    unit = np.tile([length, length, 1.0], poses // 3)
    inertia, drag, weight = (np.zeros(poses) for _ in range(3))
    body_at: dict[int, int] = {}
    strip_at: dict[int, int] = {}
    place: dict[int, int] = {}
    for i, body in enumerate(scene.bodies):
        at, mine = layout.body(body.name), slice(3 * i, 3 * i + 3)
        inertia[mine] = np.diag(motion.mass)[at]
        drag[mine] = np.diag(motion.drag)[at] if motion.drag.size else 0.0
        weight[mine] = tables.weight[at] if tables.weight.size else 0.0
        body_at |= {at.start + k: 3 * i + k for k in range(3)}
    for s, strip in enumerate(scene.strips):
        start, n = layout.strips[strip.name]
        strip_at |= {start + k: s for k in range(2 * n)}
        place |= {start + 2 * i + k: k * n + i for i in range(n) for k in range(2)}
    turning = np.where(drives.turns == 1, 1.0, length)
    return Masses(
        inertia=inertia * unit**2 / energy,
        drag=drag * unit**2 / energy,
        weight=weight * unit / energy,
        load_body=np.array([body_at.get(int(c), -1) for c in loads.coordinate], dtype=np.int64),
        load_strip=np.array([strip_at.get(int(c), -1) for c in loads.coordinate], dtype=np.int64),
        load_place=np.array([place.get(int(c), -1) for c in loads.coordinate], dtype=np.int64),
        load_value=loads.value * np.where(loads.turns == 1, 1.0, length) / energy,
        load_first=loads.first,
        load_pairs=loads.pairs,
        load_times=loads.times,
        load_factors=loads.factors,
        drive_at=np.array([body_at[int(c)] for c in drives.coordinate], dtype=np.int64),
        drive_origin=drives.origin / turning,
        drive_target=drives.target / turning,
        drive_first=drives.first,
        drive_pairs=drives.pairs,
        drive_times=drives.times,
        drive_factors=drives.factors,
    )


class State(NamedTuple):
    """Where the mechanism is, and how it came there.

    y (Y,): the bodies' poses (Q,), own coordinates (S, W) and axial forces (S, K) of the strips;
    points, velocity, acceleration (S, 2, n) of the control points; rate, push (Q,) velocity and
    acceleration of the bodies; at (S, G, 5) C', C'' and |C'|; ends (S, 2, 4) arm and s-direction of the
    clamps; clamped (S, 2, 3) force and moment of each clamp on its strip; totals (2,) work of loads and
    drives and energy dissipated; reaction (D,) of drives.
    """

    y: Array
    points: Array
    velocity: Array
    acceleration: Array
    rate: Array
    push: Array
    at: Array
    ends: Array
    clamped: Array
    totals: Array
    reaction: Array


class Scratch(NamedTuple):
    """Working arrays of a step; E = W + 6 + outer element coordinates, Q' = Q + S outer at the bodies.

    dy (Y,): changes, 2 tan(dphi / 2) of rotations, and the means of the axial forces; pose (Q,), points,
    move (S, 2, n), at (S, G, 5), ends (S, 2, 4): of the step's end; steady, force (S, 2, n), stiff
    (S, n, n): inertia, drag and loads; maps (S, 2, 16): D, and derivatives at the end; blocks (4, n n) xx,
    xy, yx, yy of the tangent; half (2 n, E) of it in element coordinates; pull, along (K, 2 n) of the axial
    forces and of their strains; g (S, E), h (S, E, E), left (K, E), right (S, K, E), gap (S, K);
    residual (Y,), reduced (Q',) of it at the bodies with the strips condensed, tangent (Q', Q'); load (Q,);
    system (Q', Q') and x, free (Q',): what is solved; ends_change (E,), mix (4,), energies (2,); held (Q,)
    1 where a drive holds.
    """

    dy: Array
    pose: Array
    points: Array
    move: Array
    at: Array
    ends: Array
    steady: Array
    force: Array
    stiff: Array
    maps: Array
    blocks: Array
    half: Array
    pull: Array
    along: Array
    g: Array
    h: Array
    left: Array
    right: Array
    gap: Array
    tangent: Array
    residual: Array
    reduced: Array
    load: Array
    system: Array
    x: Array
    ends_change: Array
    mix: Array
    energies: Array
    free: Places
    held: Places


def state_of(strips: Flexures, masses: Masses) -> State:
    """An empty state."""
    s, g, k = strips.modes.shape
    n, q = strips.mass.shape[1], len(masses.inertia)
    size = q + s * (2 * n - 6 + k)
    return State(
        y=np.zeros(size),
        points=np.zeros((s, 2, n)),
        velocity=np.zeros((s, 2, n)),
        acceleration=np.zeros((s, 2, n)),
        rate=np.zeros(q),
        push=np.zeros(q),
        at=np.zeros((s, g, 5)),
        ends=np.zeros((s, 2, 4)),
        clamped=np.zeros((s, 2, 3)),
        totals=np.zeros(2),
        reaction=np.zeros(len(masses.drive_at)),
    )


def scratch_of(strips: Flexures, masses: Masses) -> Scratch:
    """Working arrays."""
    s, g, k = strips.modes.shape
    n, q = strips.mass.shape[1], len(masses.inertia)
    own, outer = 2 * n - 6, strips.outer
    size, element, bodies = q + s * (own + k), own + 6 + outer, q + s * outer
    return Scratch(
        dy=np.zeros(size),
        pose=np.zeros(q),
        points=np.zeros((s, 2, n)),
        move=np.zeros((s, 2, n)),
        at=np.zeros((s, g, 5)),
        ends=np.zeros((s, 2, 4)),
        steady=np.zeros((s, 2, n)),
        force=np.zeros((s, 2, n)),
        stiff=np.zeros((s, n, n)),
        maps=np.zeros((s, 2, 16)),
        blocks=np.zeros((4, n * n)),
        half=np.zeros((2 * n, element)),
        pull=np.zeros((k, 2 * n)),
        along=np.zeros((k, 2 * n)),
        g=np.zeros((s, element)),
        h=np.zeros((s, element, element)),
        left=np.zeros((k, element)),
        right=np.zeros((s, k, element)),
        gap=np.zeros((s, k)),
        tangent=np.zeros((bodies, bodies)),
        residual=np.zeros(size),
        reduced=np.zeros(bodies),
        load=np.zeros(q),
        system=np.zeros((bodies, bodies)),
        x=np.zeros(bodies),
        ends_change=np.zeros(element),
        mix=np.zeros(4),
        energies=np.zeros(2),
        free=np.zeros(bodies, dtype=np.int64),
        held=np.zeros(q, dtype=np.int64),
    )


class Poses(NamedTuple):
    """State of the bodies, Q coordinates and Q' with the axial forces beside them, and working arrays.

    y (Y,) with the strips' coordinates; rate (Q,) velocities; energy (2,) W and the next one; pull, next
    (Q',) reactions g, slope (Q',) derivative of the gap; totals (2,) work and losses; trial (Y,), dx, load
    (Q,); ahead (Y,) the strips' change along the tangent, bent (Y,) what the last step's, of length last (1,)
    [s], left out; system (Q', Q'), x, free (Q',); still: places of what has no mass.
    """

    y: Array
    rate: Array
    energy: Array
    pull: Array
    next: Array
    slope: Array
    totals: Array
    trial: Array
    dx: Array
    load: Array
    ahead: Array
    bent: Array
    last: Array
    system: Array
    x: Array
    free: Places
    still: Places


def poses_of(y: Array, rate: Array, inertia: Array, all_bodies: int) -> Poses:
    """A state with these coordinates and velocities; inertia (Q,)."""
    count, q = all_bodies, len(rate)
    return Poses(
        y=y,
        rate=rate,
        energy=np.zeros(2),
        totals=np.zeros(2),
        last=np.ones(1),
        trial=y.copy(),
        **{name: np.zeros_like(y) for name in ("ahead", "bent")},
        **{name: np.zeros(count) for name in ("pull", "next", "slope", "x")},
        **{name: np.zeros(q) for name in ("dx", "load")},
        system=np.zeros((count, count)),
        free=np.zeros(count, dtype=np.int64),
        still=np.array([*np.flatnonzero(inertia == 0.0), *range(q, count)], dtype=np.int64),
    )
