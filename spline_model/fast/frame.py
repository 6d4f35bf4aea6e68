"""Straight mixed Bezier strips from the ground to one body, as the leapfrog's kernels take them."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from spline_model.basis import bezier
from spline_model.design import Design
from spline_model.effects.constraints import GROUND
from spline_model.effects.registry import MOTION_ONLY
from spline_model.mechanism import Mechanism

Array = NDArray[np.float64]

FAST_EFFECTS = {"bending", "stretching", *MOTION_ONLY}
LEAST_COMPLIANCE = 1e-9
"""Axial compliance in L^2/EI below which the condensed stiffness would drown in round-off (beyond a
slenderness L/h of 9000, and for inextensible strips)."""


class Grid(NamedTuple):
    """Basis at the Gauss points: d0, d1, d2 (G, n), modes (G, K), weight (G,)."""

    d0: Array
    d1: Array
    d2: Array
    modes: Array
    weight: Array


class Frame(NamedTuple):
    """G strips from the ground to one body, in SI units.

    root (G, 2) clamped points; axis (G, 2) the clamp directions at rest; length (G,);
    rigidity (G,) EI; arm (G, 2) tips from the body's centre at rest; compliance (G, K) of
    the axial modes in L^2/EI; centre (2,) of the body at rest.
    """

    root: Array
    axis: Array
    length: Array
    rigidity: Array
    arm: Array
    compliance: Array
    centre: Array


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
