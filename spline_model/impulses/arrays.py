"""What the compiled steps work on, in few arrays: each costs every kernel that they are passed to."""

from __future__ import annotations

from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.effects import Clamp, Driven, MixedStretching
from spline_model.effects.base import Constraint
from spline_model.effects.elastic import ANTICLASTIC
from spline_model.errors import InvalidParameter
from spline_model.motion.start import Motion
from spline_model.quadrature import CURL, PointTable
from spline_model.tables import BODY, ClampTable, DriveTable, LoadTable

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

STEPS, SOLVES, SWEEPS, HALVED, LIMITED = range(5)
"""Places of the counters: steps, linear systems, sweeps over the blocks, steps that were halved, and
steps whose velocity was reduced so that no energy is gained."""
COUNTS, ENERGY, LOST = range(3)
"""Places of ``Moving.status``."""


class Problem(NamedTuple):
    """What does not change in a run: N unknowns, Q coordinates, M axial modes, R rows of constraints.

    points, clamps: of the scene. held_at, held_row (D,): place of each coordinate that a support holds and of
    its multiplier, held_to (D,) where. mass, drag (Q, Q); force (Q,): weight and loads; rigidity (M, M)
    inverse compliance and relaxation (M,) [s] of the axial modes; unit (N,) makes residuals dimensionless,
    energy is EI/L [J]; turns: the rotations' places. groups (G, 2): start and size in q of each strip's
    control points and of each body's pose; no inertia couples one group with another. rows (R, 3): place in z
    of each row's multiplier, in the order of the sweep, and the two groups that it acts on, -1 for none;
    first (B + 1,): where each block begins in them, blocks being solved as one. grounded: 1 if the ground
    holds anything. sweeps: of a linear system, at most; tolerance [1].
    """

    points: PointTable
    clamps: ClampTable
    held_at: Indices
    held_row: Indices
    held_to: Array
    mass: Array
    drag: Array
    force: Array
    rigidity: Array
    relaxation: Array
    unit: Array
    energy: float
    turns: Indices
    groups: Indices
    rows: Indices
    first: Indices
    grounded: int
    sweeps: int
    tolerance: float

    @classmethod
    def of(cls, motion: Motion, *, soft: bool, sweeps: int | None, tolerance: float) -> Problem:
        """The problem of a system: rows of the strips' axial forces and clamps, then those of the supports.

        soft: the axial forces of extensible strips are rows as well, with their compliance; else
        only those of inextensible ones are. sweeps: over single constraints, at most; None solves all as
        one block.
        """
        system, drives = motion.system, motion.drives
        layout, clamps, count = system.layout, system.clamps, system.layout.coordinate_count
        strips = {name: g for g, name in enumerate(layout.strips)}
        bodies = {name: len(strips) + g for g, name in enumerate(layout.bodies)}
        start = [at for at, _ in layout.strips.values()] + list(layout.bodies.values())
        size = [2 * n for _, n in layout.strips.values()] + [3] * len(bodies)
        _require_known(motion)
        _require_mass(motion, start, size, [*strips, *bodies])
        blocks = list(_constraints(system, soft, strips, bodies).values())
        rows = np.array([row for block in blocks for row in block], dtype=np.int64).reshape(-1, 3)
        ends = [len(rows)] if sweeps is None else np.cumsum([len(block) for block in blocks])
        return cls(
            points=system.points,
            clamps=clamps,
            held_at=drives.coordinate,
            held_row=drives.row,
            held_to=drives.origin + drives.factors[drives.first] * drives.target,
            mass=motion.system.mass,
            drag=motion.system.drag if motion.system.drag.size else np.zeros((count, count)),
            force=loads_of(motion) + (system.weight if system.weight.size else 0.0),
            rigidity=motion.rigidity,
            relaxation=motion.relaxation,
            unit=system.scales.unit / system.scales.energy,
            energy=system.scales.energy,
            turns=motion.turns,
            groups=np.array((start, size), dtype=np.int64).T.copy(),
            rows=rows,
            first=np.array([0, *ends], dtype=np.int64),
            grounded=int((clamps.place[:, BODY] < 0).any() or drives.row.size > 0),
            sweeps=sweeps or 1,
            tolerance=float(tolerance),
        )


class Space(NamedTuple):
    """Arrays that a step fills.

    z, gradient, matrix of the unknowns; v, base, drift, x of the coordinates, drag all damping of them;
    schur, mu, change, gap of the rows; strains of the axial modes.
    """

    z: Annotated[Array, "N"]
    gradient: Annotated[Array, "N"]
    matrix: Annotated[Array, "N N"]
    v: Annotated[Array, "Q"]
    base: Annotated[Array, "Q"]
    drift: Annotated[Array, "Q"]
    x: Annotated[Array, "Q"]
    drag: Annotated[Array, "Q Q"]
    schur: Annotated[Array, "R R"]
    mu: Annotated[Array, "R"]
    change: Annotated[Array, "R"]
    gap: Annotated[Array, "R"]
    strains: Annotated[Array, "M"]
    work: Annotated[Array, "5 4"]


class Moving(NamedTuple):
    """A motion on its way, advanced in place.

    z (N,) unknowns, v (Q,) velocities; earlier (2, Q) coordinates and velocities of the step before; begun
    (Q,) coordinates at the start; status (3,): 1 if ``earlier`` counts, the energy with the potential of
    weight and loads since the start [J], and the energy dissipated [J]; counters (5,).
    """

    z: Array
    v: Array
    earlier: Array
    begun: Array
    status: Array
    counters: Indices


def loads_of(motion: Motion) -> Array:
    """Return the loads as a generalised force (Q,) [N, N m]."""
    loads, force = motion.loads, np.zeros(motion.system.layout.coordinate_count)
    np.add.at(force, loads.coordinate, loads.value * loads.factors[loads.first])
    return force


def _require_known(motion: Motion) -> None:
    """Refuse what the paper's impulses do not have; ``solve_motion`` has all of it."""
    system, drives = motion.system, motion.drives
    system.require_dead("effects")
    segments = max((len(pieces) for pieces in system.scene.whole.values()), default=1)
    if segments > 1:
        raise InvalidParameter("segments", segments, "1 for sequential impulses")
    timed = drives.begin.any() or np.isfinite(drives.until).any()
    for name, has in (
        (ANTICLASTIC, system.points.numbers[:, CURL].any()),
        ("spring", system.springs.size > 0),
        ("a drive or a load that changes in time", timed or _changes(drives) or _changes(motion.loads)),
    ):
        if has:
            raise InvalidParameter("effects", name, "a motion by solve_motion, for impulses know none")


def _changes(table: DriveTable | LoadTable) -> bool:
    """Whether the history of any row has more than one instant."""
    return bool((table.pairs > 1).any())


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
        else:
            assert isinstance(constraint, Driven), "there are no others"
            key, touched = (constraint.body, "support"), (bodies[constraint.body], -1)
        found.setdefault(key, []).extend((at + k, *touched) for k in range(count))
    return found


def _require_mass(motion: Motion, start: list[int], size: list[int], names: list[str]) -> None:
    """Refuse a group without inertia: an impulse would change its velocity without bound."""
    for at, count, name in zip(start, size, names, strict=True):
        block = motion.system.mass[at : at + count, at : at + count]
        if np.linalg.eigvalsh(block)[0] <= 0:
            raise InvalidParameter("effects", f"no inertia of {name}", "inertia of every strip and body")
