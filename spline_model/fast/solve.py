"""From a pivot to its fast path and back to the unknowns of the multiplier path."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from spline_model.basis import bezier
from spline_model.compile import System
from spline_model.continuation.critical import between
from spline_model.continuation.integration import Finer
from spline_model.continuation.point import stand
from spline_model.continuation.remark import Place, remark
from spline_model.design import Design
from spline_model.effects.constraints import GROUND
from spline_model.effects.registry import MOTION_ONLY
from spline_model.fast.body import Frame, Space
from spline_model.fast.path import EVALUATIONS, HALVED, ITERATIONS, Answer, follow
from spline_model.fast.states import states_of
from spline_model.fast.strip import Grid, local_arrays
from spline_model.laps import Laps
from spline_model.mechanism import Mechanism
from spline_model.newton import Workspace
from spline_model.solution import CriticalPoint, Path, Status
from spline_model.work import external_work

Array = NDArray[np.float64]

TOLERANCE = 1e-11
"""Residual of a solved state in EI/L^2 and L, as on the multiplier path."""
FAST_EFFECTS = {"bending", "stretching", *MOTION_ONLY}
"""Effects that a fast path may have; of these statics asks for the first two only."""
LEAST_COMPLIANCE = 1e-9
"""Axial compliance in L^2/EI below which the condensed stiffness would drown in round-off (beyond a
slenderness L/h of 9000, and for inextensible strips): the multiplier path takes these."""


def is_fast(mechanism: Mechanism) -> bool:
    """Whether a mechanism has a fast path: straight Bezier strips from the ground to one body, no loads."""
    design = mechanism.design
    grid = design.discretisation
    return (
        set(mechanism.effects) <= FAST_EFFECTS
        and len(design.bodies) == 1
        and (grid.basis, grid.measure) == ("bezier", "material")
        and grid.stretch != "consistent"
        and all(s.root == GROUND and s.tip == design.bodies[0].name for s in design.strips)
        and all(s.rise == 0.0 for s in design.strips)
        and all(
            s.flexural_rigidity >= LEAST_COMPLIANCE * s.axial_rigidity * s.length**2 for s in design.strips
        )
    )


def grid_of(design: Design) -> Grid:
    """Basis and modes at the Gauss points of a strip of unit length."""
    settings = design.discretisation
    return _grid(settings.control_points, settings.points_a_span, mode_count(design))


@lru_cache(maxsize=64)
def _grid(control_points: int, gauss_points: int, modes: int) -> Grid:
    basis = bezier(control_points)
    u, weight = basis.gauss_rule(gauss_points)
    return Grid(
        d0=np.ascontiguousarray(basis.evaluate(u)),
        d1=np.ascontiguousarray(basis.evaluate(u, 1)),
        d2=np.ascontiguousarray(basis.evaluate(u, 2)),
        modes=np.ascontiguousarray(legendre.legvander(2 * u - 1, modes - 1)),
        weight=weight,
    )


def mode_count(design: Design) -> int:
    """Axial modes and slide modes together."""
    settings = design.discretisation
    return settings.control_points - 1 if settings.slide > 0 else settings.modes.count


def compliances(design: Design, axial: Array) -> Array:
    """Compliance of each mode, (D, K) [L^2/EI]: the strips' axial one (D,), and the slide stiffness's."""
    settings = design.discretisation
    table = np.repeat(axial[:, None], mode_count(design), axis=1)
    if settings.slide > 0:
        table[:, settings.modes.count :] = 1.0 / settings.slide
    return table


def frame_of(mechanism: Mechanism) -> Frame:
    """Geometry and rigidities of the strips."""
    design = mechanism.design
    centre = np.array(design.bodies[0].centre, dtype=float)
    start = np.array([s.start for s in design.strips], dtype=float)
    end = np.array([s.end for s in design.strips], dtype=float)
    length = np.array([s.length for s in design.strips])
    rigidity = np.array([s.flexural_rigidity for s in design.strips])
    axial = rigidity / (np.array([s.axial_rigidity for s in design.strips]) * length**2)
    along = end - start
    return Frame(
        root=start,
        axis=along / length[:, None],
        length=length,
        rigidity=rigidity,
        arm=end - centre,
        compliance=compliances(design, axial),
        centre=centre,
    )


def arrays(strips: int, grid: Grid) -> tuple[tuple[Any, ...], Space]:
    """Working arrays of a path, to be used again for others of the same size."""
    (points, control_points), modes = grid.d1.shape, grid.modes.shape[1]
    own = 2 * control_points - 6
    size = 2 + strips * (own + modes)
    locals_ = tuple(local_arrays(control_points, modes, points) for _ in range(strips))
    space = Space(
        body=np.zeros((3, 4)),
        change=np.zeros(3),
        known_at=np.zeros(3),
        known_y=np.zeros((3, size)),
        known_rate=np.zeros((3, size)),
        y=np.zeros(size),
        rate=np.zeros(size),
        predicted=np.zeros(size),
        out=np.zeros(4),
    )
    return locals_, space


def at_rest(frame: Frame, control_points: int, modes: int) -> Array:
    """The state y at rest."""
    u = np.arange(2, control_points - 2) / (control_points - 1)
    own = np.concatenate(([1.0], np.column_stack((u, np.zeros(len(u)))).ravel(), [1.0]))
    strip = np.concatenate((own, np.zeros(modes)))
    return np.concatenate((frame.centre / frame.length[0], np.tile(strip, len(frame.length))))


def fast_path(mechanism: Mechanism, rotations: Sequence[float], laps: Laps) -> tuple[int, Answer]:
    """Follow the path through the rotations [rad]; returns the converged states and the answer."""
    design = mechanism.design
    n, modes, strips = design.discretisation.control_points, mode_count(design), len(design.strips)
    frame, grid = frame_of(mechanism), grid_of(design)
    locals_, space = arrays(strips, grid)
    answer = empty_answer(len(rotations) + 1, len(space.y))
    targets = np.asarray(rotations, dtype=float)
    start = at_rest(frame, n, modes)
    laps.lap("compile")
    done = follow(start, targets, frame, grid, locals_, space, TOLERANCE, answer)
    laps.lap("solve")
    return done, answer


def _critical_points(
    system: System, factors: Array, states: Array, answer: Answer
) -> tuple[CriticalPoint, ...] | None:
    """The critical points between rows of another inertia or another sign of the stiffness.

    None where one is not found: the multiplier path, whose steps are smaller there, does it.
    """
    steps = np.diff(factors)
    turned = (np.diff(answer.inertia) != 0) | (answer.stiffness[1:] * answer.stiffness[:-1] < 0.0)
    work = Workspace.of(system)
    found: list[CriticalPoint] = []
    for row in np.flatnonzero(turned):
        before, after = (
            stand(work, states[i], factors[i], work.evaluate(states[i], factors[i])) for i in (row, row + 1)
        )
        points = between(work, before, after, steps[row])
        if not points or not Finer(work).confirms(work, before, after, steps[row]):
            return None
        found += points
    return tuple(replace(point, load_factor=abs(point.load_factor)) for point in found)


def empty_answer(states: int, size: int) -> Answer:
    """Arrays for that many states."""
    return Answer(
        y=np.zeros((states, size)),
        torque=np.zeros(states),
        stiffness=np.zeros(states),
        energies=np.zeros((states, 2)),
        inertia=np.zeros(states, dtype=np.int64),
        defect=np.zeros(states),
        counters=np.zeros(3, dtype=np.int64),
    )


def follow_fast(
    mechanism: Mechanism,
    system: System,
    rotations: Sequence[float],
    laps: Laps,
    progress: Callable[[int, int], None] | None = None,
) -> Path | None:
    """The path as the multiplier path would give it, or None where the fast one stops."""
    done, answer = fast_path(mechanism, rotations, laps)
    if done <= len(rotations):
        return None
    if progress is not None:
        for increment in range(len(rotations)):
            progress(increment + 1, len(rotations))
    return path_of(mechanism, system, rotations, answer)


def path_of(mechanism: Mechanism, system: System, rotations: Sequence[float], answer: Answer) -> Path | None:
    """A complete fast answer as a path of the multiplier path's unknowns, or None where that has doubts.

    ``system`` is the mechanism compiled with its driven rotation; load factors are those of
    its drive. Of the rates only the drive's multiplier is filled.
    """
    drive = system.tables.drives
    angles = np.concatenate(([0.0], rotations))
    rates = np.zeros((len(angles), system.layout.size))
    rates[:, drive.row[0]] = answer.stiffness * drive.target[0]
    increments, counters = len(rotations), answer.counters
    states, factors = states_of(system, frame_of(mechanism), angles, answer), angles / drive.target[0]
    critical = _critical_points(system, factors, states, answer)
    if critical is None:
        return None
    return Path(
        status=Status.CONVERGED,
        message=remark(system, Place(system=system), critical, int(answer.inertia[-1])),
        load_factor=factors,
        states=states,
        rates=rates,
        stiffness=answer.stiffness,
        energies=answer.energies,
        work=external_work(system, factors, states, rates),
        inertia=answer.inertia,
        moment_defect=answer.defect,
        critical_points=critical,
        counters={
            "increments": increments,
            "halved_increments": int(counters[HALVED]),
            "newton_iterations": int(counters[ITERATIONS]),
            "residual_evaluations": int(counters[EVALUATIONS]),
            "tangent_evaluations": int(counters[EVALUATIONS]),
            "factorisations": int(counters[EVALUATIONS]),
        },
        history=(),
    )
