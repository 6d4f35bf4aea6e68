"""Derivatives of everything a static path answers, from the factorised tangent of its states."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System, compile_scene
from spline_model.effects import DrivenRotation
from spline_model.effects.base import Constraint
from spline_model.effects.registry import MOTION_ONLY
from spline_model.errors import InvalidParameter
from spline_model.newton import getrf, getrs
from spline_model.operator import evaluate
from spline_model.pivot import BODY, Pivot
from spline_model.sensitivity.clamps import ClampRows
from spline_model.sensitivity.model import axial_points, bending_points
from spline_model.sensitivity.parameters import (
    KEYWORDS,
    Geometry,
    Rates,
    check_parameters,
    rates_of,
)
from spline_model.sensitivity.result import Quantity, Sensitivities
from spline_model.sensitivity.stress import fibre_stress
from spline_model.solution import StaticSolution
from spline_model.statics import STATIONS

Array = NDArray[np.float64]

EFFECTS = {"bending", "stretching", "inextensible", "pre_strain", *MOTION_ONLY}
"""Effects whose dependence on the design is known here."""
LARGEST_RESIDUAL = 1e-7
"""Residual [EI/L^2, EI/L, L, rad] above which states are not the pivot's: solved ones are below 1e-8."""


def sensitivities(
    pivot: Pivot,
    solution: StaticSolution,
    *,
    parameters: Sequence[str] = KEYWORDS,
    stations: Array = STATIONS,
) -> Sensitivities:
    """Derivatives of a solved path by the design, at constant rotations.

    parameters: names of ``spline_model.sensitivity.parameters.PARAMETERS``; for area and second
    moment the section's depth follows as sqrt(12 I / A), for thickness and width it is the
    thickness. stations: where stresses are taken, reference arc length over L.

    With the residual R(z; p) = dL/dz, L = V - lambda psi, and its tangent K at a converged state

        dz/dp = -K^-1 dR/dp,    dT/dp = d(lambda_13)/dp,    dk/dp = z_t^T (dK/dp) z_t,    z_t = dz/d(theta)

    where dK/dp counts the change of the state too: one factorisation a state, one back-substitution
    a parameter and one for the rate z_t. Exact for the discrete answer: the slide stiffness, the
    axial modes and the clamps go with the design as in ``cross_axis_pivot``. Both strips change
    alike. Refuses the spatial and printed measures, loads and open potentials.
    Source: implicit function theorem; Haftka and Guerdal, Elements of Structural Optimization
    (1992), ch. 7.
    """
    names = check_parameters(parameters)
    _check(pivot)
    system = compile_scene(pivot.driven(1.0))
    rates = rates_of(pivot, names)
    bending, axial = bending_points(pivot, system, rates), axial_points(pivot, system, rates)
    clamps = ClampRows.of(system, rates)
    z = _states(system, solution)
    partial = bending.residual(z) + axial.residual(z) + clamps.residual(z)
    rate, by_state = _differentiate(system, z, solution.rotation, partial)
    changes = np.ascontiguousarray(by_state.transpose(2, 0, 1))
    row, (x, turn) = _drive_row(system), (system.layout.body(BODY).start, system.layout.body(BODY).stop - 1)
    stiffness = sum(part.third(z, rate, changes) for part in (bending, axial, clamps))
    centre = Quantity(value=z[:, x : x + 2], derivative=by_state[:, x : x + 2])
    stress = fibre_stress(system, pivot.mechanism.design.strips[0], rates, z, changes, stations)
    return Sensitivities(
        parameters=names,
        torque=Quantity(value=z[:, row], derivative=by_state[:, row]),
        stiffness=Quantity(value=rate[:, row], derivative=np.asarray(stiffness)),
        centre=centre,
        body_shift=_shift(centre, z[:, turn], pivot.centre, rates.centre, pivot.centre, rates.centre),
        centre_shift=_shift(centre, z[:, turn], pivot.centre, rates.centre, *_crossing(pivot, rates)),
        bending_energy=Quantity(value=solution.bending_energy, derivative=bending.energy(z, changes)),
        axial_energy=Quantity(value=solution.axial_energy, derivative=axial.energy(z, changes)),
        fibre_stress=Quantity(value=stress[0], derivative=stress[1]),
        stations=np.asarray(stations, dtype=float),
        states=by_state,
        counters={"factorisations": len(z), "back_substitutions": len(z) * (len(names) + 1)},
    )


def _check(pivot: Pivot) -> None:
    """Refuse what the derivatives are not known for."""
    mechanism = pivot.mechanism
    unknown = [name for name in mechanism.effects if name not in EFFECTS]
    if unknown:
        raise InvalidParameter("effects", unknown[0], "only " + ", ".join(sorted(EFFECTS)))
    if mechanism.design.discretisation.measure != "material":
        raise InvalidParameter("measure", mechanism.design.discretisation.measure, "material")


def _states(system: System, solution: StaticSolution) -> Array:
    if solution.states.shape[1:] != (system.layout.size,):
        got = f"{solution.states.shape[1:]} unknowns"
        raise InvalidParameter("solution", got, f"a solution of this pivot with {system.layout.size}")
    return solution.states


def _differentiate(system: System, states: Array, rotations: Array, partial: Array) -> tuple[Array, Array]:
    """Rates by the rotation (S, N) and derivatives by the parameters (S, N, P) of the states."""
    size, unit, energy = system.layout.size, system.scales.unit, system.scales.energy
    gradient, hessian = np.empty(size), np.empty((size, size))
    scale = unit[:, None] * unit / energy
    push = np.zeros((size, 1))
    push[_drive_row(system)] = -1.0  # -dR/d(theta): the drive's row is -(theta - rotation)
    rate, by_state = np.empty_like(states), np.empty_like(partial)
    for s, z in enumerate(states):
        evaluate(system, z, float(rotations[s]), gradient, hessian)
        residual = float(np.abs(gradient * unit).max() / energy)
        if not residual <= LARGEST_RESIDUAL:
            expected = f"at most {LARGEST_RESIDUAL:g}: a solution of this pivot"
            raise InvalidParameter("solution", f"state {s} with residual {residual:.1e}", expected)
        factors, pivots, failed = getrf(hessian * scale)
        if failed:
            raise InvalidParameter("solution", f"state {s} with a singular tangent", "a regular state")
        right = np.concatenate((push, -partial[s]), axis=1) * (unit / energy)[:, None]
        found = unit[:, None] * getrs(factors, pivots, right)[0]
        rate[s], by_state[s] = found[:, 0], found[:, 1:]
    return rate, by_state


def _drive_row(system: System) -> int:
    """Place of the drive's multiplier in the unknowns."""
    constraints = system.scene.of(Constraint)
    place = next(i for i, c in enumerate(constraints) if isinstance(c, DrivenRotation))
    return system.layout.multipliers[place][0]


def _crossing(pivot: Pivot, rates: Rates) -> tuple[Array, Array]:
    """The strips' crossing at rest (2,) [m], and its rates (P, 2)."""
    return pivot.clamp_points[0, 0] + Geometry.of(pivot).crossing, rates.crossing


def _shift(
    centre: Quantity, rotation: Array, rest: Array, by_rest: Array, point: Array, by_point: Array
) -> Quantity:
    """Displacement (S, 2) of the body's point that lies in ``point`` at rest: g + R (x - g_0) - x."""
    cos, sin = np.cos(rotation), np.sin(rotation)
    turn = np.stack((np.stack((cos, -sin), -1), np.stack((sin, cos), -1)), axis=1)
    by_arm = np.einsum("sij,pj->sip", turn, by_point - by_rest)
    return Quantity(
        value=centre.value + turn @ (point - rest) - point,
        derivative=centre.derivative + by_arm - by_point.T,
    )
