"""What impulses act on: groups of coordinates that have inertia of their own, and blocks of rows."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.effects import Clamp, DrivenDisplacement, DrivenRotation, MixedStretching
from spline_model.effects.base import Constraint
from spline_model.errors import InvalidParameter
from spline_model.kernels.motion import Motion

Indices = NDArray[np.int64]


IMPULSES = ("direct", "strips", "constraints")
"""What is solved as one: everything (Eq 30), a strip with its axial forces and both clamps, or a
single constraint."""


class Blocks(NamedTuple):
    """G groups of coordinates, R rows in B blocks.

    start, size (G,): slice in q of each strip's control points and of each body's pose; no
    inertia couples one group with another. row (R,) index in z of each row's multiplier, in the order
    of the sweep; first (B + 1,) where each block begins in it, blocks being solved as one;
    groups (R, 2) the groups that a row acts on, -1 for none; drive (D,) place in row of each
    drive's; relaxation (M,) beta [s] of each axial mode; grounded: 1 if the ground holds
    anything.
    """

    start: Indices
    size: Indices
    row: Indices
    first: Indices
    groups: Indices
    drive: Indices
    relaxation: NDArray[np.float64]
    grounded: int


def make_blocks(system: System, motion: Motion, *, soft: bool, impulses: str) -> Blocks:
    """The blocks of a system, the strips' axial forces and clamps first, then the drives.

    soft: the axial forces of extensible strips are rows as well, with their compliance; else
    only those of inextensible ones are. impulses: one of IMPULSES.
    """
    layout = system.layout
    strips = {name: g for g, name in enumerate(layout.strips)}
    bodies = {name: len(strips) + g for g, name in enumerate(layout.bodies)}
    start = [at for at, _ in layout.strips.values()] + list(layout.bodies.values())
    size = [2 * n for _, n in layout.strips.values()] + [3] * len(bodies)
    _require_mass(motion, start, size, [*strips, *bodies])
    constraints = _constraints(system, soft, strips, bodies)
    blocks = list(constraints.values())
    if impulses == "strips":
        owners = dict.fromkeys(owner for owner, _ in constraints)
        blocks = [
            [row for (owner, _), rows in constraints.items() if owner == one for row in rows]
            for one in owners
        ]
    flat = np.array([row for rows in blocks for row in rows], dtype=np.int64).reshape(-1, 3)
    ends = [len(flat)] if impulses == "direct" else np.cumsum([len(rows) for rows in blocks])
    place = {row: r for r, row in enumerate(flat[:, 0])}
    return Blocks(
        start=np.array(start, dtype=np.int64),
        size=np.array(size, dtype=np.int64),
        row=flat[:, 0].copy(),
        first=np.array([0, *ends], dtype=np.int64),
        groups=flat[:, 1:].copy(),
        drive=np.array([place[row] for row in motion.tables.drives.row], dtype=np.int64),
        relaxation=_relaxation(motion, layout.coordinate_count),
        grounded=int((motion.tables.clamps.body < 0).any()),
    )


def _constraints(
    system: System, soft: bool, strips: dict[str, int], bodies: dict[str, int]
) -> dict[tuple[str, str], list[tuple[int, int, int]]]:
    """Rows of each constraint, with the groups they act on; the key is its strip or body, and which it is."""
    layout, scene = system.layout, system.scene
    found: dict[tuple[str, str], list[tuple[int, int, int]]] = {}
    for (at, count), effect in zip(layout.modes, scene.of(MixedStretching), strict=True):
        if soft or effect.axial_compliance == 0:
            rows = [(at + k, strips[effect.strip], -1) for k in range(count)]
            found.setdefault((effect.strip, "axial"), []).extend(rows)
    for i, constraint in enumerate(scene.of(Constraint)):
        at, count = layout.multipliers[i]
        if isinstance(constraint, Clamp):
            key: tuple[str, str] = (constraint.strip, constraint.end)
            touched = (strips[constraint.strip], bodies.get(constraint.to, -1))
        elif isinstance(constraint, DrivenRotation | DrivenDisplacement):
            key, touched = (constraint.body, "drive"), (bodies[constraint.body], -1)
        else:
            expected = "clamps, driven rotations and displacements"
            raise InvalidParameter("effects", type(constraint).__name__, expected)
        found.setdefault(key, []).extend((at + k, *touched) for k in range(count))
    return found


def _require_mass(motion: Motion, start: list[int], size: list[int], names: list[str]) -> None:
    """Refuse a group without inertia: an impulse would change its velocity without bound."""
    for at, count, name in zip(start, size, names, strict=True):
        block = motion.mass[at : at + count, at : at + count]
        if np.linalg.eigvalsh(block)[0] <= 0:
            raise InvalidParameter("effects", f"no inertia of {name}", "inertia of every strip and body")


def _relaxation(motion: Motion, start: int) -> NDArray[np.float64]:
    """Relaxation time of each axial mode, that of its strip (M,) [s]."""
    times, table = np.zeros(len(motion.rigidity)), motion.tables.axial_force
    for p, time in enumerate(motion.axial_relaxation):
        first = table.mode_first[p] - start
        times[first : first + table.mode_width[p]] = time
    return times
