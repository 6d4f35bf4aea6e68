"""The bodies of a moving mechanism, loads and drives, from its scene."""

from __future__ import annotations

import numpy as np

from spline_model.compile import System
from spline_model.kernels.motion import Motion
from spline_model.motion.arrays import Masses


def masses_of(system: System, motion: Motion, poses: int) -> Masses:
    """The bodies and what acts on them; poses: the number of their coordinates."""
    scene, layout, tables = system.scene, system.layout, system.tables
    length, energy, loads, drives = (
        system.scales.length,
        system.scales.energy,
        system.tables.loads,
        system.tables.drives,
    )
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
