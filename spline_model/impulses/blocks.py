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


def make_blocks(system: System, motion: Motion, *, soft: bool, direct: bool) -> Blocks:
    """The blocks of a system, a strip's axial forces first, then its clamps, then the drives.

    soft: the axial forces of extensible strips are rows as well, with their compliance; else
    only those of inextensible ones are. direct: all rows are one block, whose solution is the
    global one of Eq 30.
    """
    layout, scene = system.layout, system.scene
    strips = {name: g for g, name in enumerate(layout.strips)}
    bodies = {name: len(strips) + g for g, name in enumerate(layout.bodies)}
    start = [at for at, _ in layout.strips.values()] + list(layout.bodies.values())
    size = [2 * n for _, n in layout.strips.values()] + [3] * len(bodies)
    _require_mass(motion, start, size, [*strips, *bodies])
    blocks: dict[tuple[str, str], list[tuple[int, int, int]]] = {}

    for (at, count), effect in zip(layout.modes, scene.of(MixedStretching), strict=True):
        if soft or effect.axial_compliance == 0:
            rows = [(at + k, strips[effect.strip], -1) for k in range(count)]
            blocks.setdefault(("axial", effect.strip), []).extend(rows)
    for i, constraint in enumerate(scene.of(Constraint)):
        at, count = layout.multipliers[i]
        if isinstance(constraint, Clamp):
            touched = (strips[constraint.strip], bodies.get(constraint.to, -1))
            name = ("clamp", f"{constraint.strip} {constraint.end}")
        elif isinstance(constraint, DrivenRotation | DrivenDisplacement):
            touched = (bodies[constraint.body], -1)
            name = ("drive", constraint.body)
        else:
            expected = "clamps, driven rotations and displacements"
            raise InvalidParameter("effects", type(constraint).__name__, expected)
        blocks.setdefault(name, []).extend((at + k, *touched) for k in range(count))
    ordered = [
        rows for kind in ("axial", "clamp", "drive") for name, rows in blocks.items() if name[0] == kind
    ]
    flat = np.array([entry for rows in ordered for entry in rows], dtype=np.int64).reshape(-1, 3)
    ends = [len(flat)] if direct else np.cumsum([len(rows) for rows in ordered])
    return Blocks(
        start=np.array(start, dtype=np.int64),
        size=np.array(size, dtype=np.int64),
        row=flat[:, 0].copy(),
        first=np.array([0, *ends], dtype=np.int64),
        groups=flat[:, 1:].copy(),
        drive=np.array(
            [np.flatnonzero(flat[:, 0] == i)[0] for i in motion.tables.drives.row], dtype=np.int64
        ),
        relaxation=_relaxation(motion, layout.coordinate_count),
        grounded=int((motion.tables.clamps.body < 0).any()),
    )


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
