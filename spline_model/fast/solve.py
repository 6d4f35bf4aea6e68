"""From a pivot to its fast path and back to the unknowns of the multiplier path."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from spline_model.basis import bezier
from spline_model.design import Design
from spline_model.effects.constraints import GROUND
from spline_model.fast.path import Answer, Frame, Grid, Space, follow
from spline_model.fast.strip import local_arrays
from spline_model.mechanism import Mechanism

Array = NDArray[np.float64]

TOLERANCE = 1e-10
"""Residual of a solved state in EI/L^2 and L: the one of the multiplier path, less the room that the
condensed axial stiffness needs for round-off."""
FAST_EFFECTS = {"bending", "stretching", "inextensible", "strip_inertia", "section_rotary_inertia"}
FAST_EFFECTS |= {"body_inertia", "strip_damping", "strip_drag", "body_damping"}


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
    )


def grid_of(design: Design) -> Grid:
    """Basis and modes at the Gauss points of a strip of unit length."""
    settings = design.discretisation
    basis = bezier(settings.control_points)
    u, weight = basis.gauss_rule(settings.points_a_span)
    return Grid(
        d1=np.ascontiguousarray(basis.evaluate(u, 1)),
        d2=np.ascontiguousarray(basis.evaluate(u, 2)),
        modes=np.ascontiguousarray(legendre.legvander(2 * u - 1, mode_count(design) - 1)),
        weight=weight,
    )


def mode_count(design: Design) -> int:
    """Axial modes and slide modes together."""
    settings = design.discretisation
    return settings.control_points - 1 if settings.slide_stiffness > 0 else settings.modes.count


def frame_of(mechanism: Mechanism) -> Frame:
    """Geometry and rigidities of the strips."""
    design, inextensible = mechanism.design, "inextensible" in mechanism.effects
    centre = np.array(design.bodies[0].centre, dtype=float)
    start = np.array([s.start for s in design.strips], dtype=float)
    end = np.array([s.end for s in design.strips], dtype=float)
    length = np.array([s.length for s in design.strips])
    rigidity = np.array([s.flexural_rigidity for s in design.strips])
    compliance = np.empty((len(length), mode_count(design)))
    settings = design.discretisation
    for i, strip in enumerate(design.strips):
        compliance[i] = 0.0 if inextensible else rigidity[i] / (strip.axial_rigidity * length[i] ** 2)
        if settings.slide_stiffness > 0:
            compliance[i, settings.modes.count :] = 1.0 / settings.slide_stiffness
    along = end - start
    return Frame(
        root=start,
        angle=np.arctan2(along[:, 1], along[:, 0]),
        length=length,
        rigidity=rigidity,
        arm=end - centre,
        compliance=compliance,
        centre=centre,
    )


def arrays(strips: int, control_points: int, modes: int) -> tuple[tuple[Any, ...], Space]:
    """Working arrays of a path, to be used again for others of the same size."""
    own = 2 * control_points - 6
    size = 2 + strips * (own + modes)
    locals_ = tuple(local_arrays(control_points, modes) for _ in range(strips))
    space = Space(
        body=np.zeros((3, 4)),
        pose=np.zeros(3),
        change=np.zeros(3),
        scratch=np.zeros((2 * control_points, own + 3)),
        known_at=np.zeros(3),
        known_y=np.zeros((3, size)),
        known_rate=np.zeros((3, size)),
        y=np.zeros(size),
        rate=np.zeros(size),
        predicted=np.zeros(size),
    )
    return locals_, space


def at_rest(frame: Frame, control_points: int, modes: int) -> Array:
    """The state y at rest."""
    u = np.arange(2, control_points - 2) / (control_points - 1)
    own = np.concatenate(([1.0], np.column_stack((u, np.zeros(len(u)))).ravel(), [1.0]))
    strip = np.concatenate((own, np.zeros(modes)))
    return np.concatenate((frame.centre / frame.length[0], np.tile(strip, len(frame.angle))))


def fast_path(mechanism: Mechanism, rotations: Sequence[float]) -> tuple[int, Answer]:
    """Follow the path through the rotations [rad]; returns the converged states and the answer."""
    design = mechanism.design
    n, modes, strips = design.discretisation.control_points, mode_count(design), len(design.strips)
    frame, grid = frame_of(mechanism), grid_of(design)
    locals_, space = arrays(strips, n, modes)
    answer = empty_answer(len(rotations) + 1, len(space.y))
    targets = np.asarray(rotations, dtype=float)
    done = follow(at_rest(frame, n, modes), targets, frame, grid, locals_, space, TOLERANCE, answer)
    return done, answer


def empty_answer(states: int, size: int) -> Answer:
    """Arrays for that many states."""
    return Answer(
        y=np.zeros((states, size)),
        torque=np.zeros(states),
        stiffness=np.zeros(states),
        energies=np.zeros((states, 2)),
        counters=np.zeros(3, dtype=np.int64),
    )
