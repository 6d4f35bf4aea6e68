"""Derivatives of everything a static path answers, from the factorised tangent of its states."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System, compile_scene
from spline_model.discretisation import require_uncut
from spline_model.effects import Bending, MixedStretching
from spline_model.effects.plate import STEP
from spline_model.errors import InvalidParameter
from spline_model.layout import Layout
from spline_model.mechanism import Mechanism, require_mechanism
from spline_model.pivot import Pivot
from spline_model.reduced.model import Reduced, from_unknowns, require_reduced
from spline_model.reduced.numbers import in_order
from spline_model.reduced.states import gathered, whole_tangents
from spline_model.sections import STATIONS
from spline_model.sensitivity.element import Curve, Elements, times_each, turned
from spline_model.sensitivity.parameters import KEYWORDS, Rates, Varied
from spline_model.static_answers import StaticSolution
from spline_model.strip import laws

Array = NDArray[np.float64]

LARGEST_RESIDUAL = 1e-7
"""Residual [EI/L^2, EI/L, L, rad] above which states are not the design's: solved ones are below 1e-8."""


def sensitivities(
    asked: Mechanism,
    solution: StaticSolution,
    *,
    parameters: Sequence[str] = KEYWORDS,
    stations: Array = STATIONS,
    body: str | None = None,
) -> Sensitivities:
    """Derivatives of a solved path by the design, at constant rotations, loads and driven displacements.

    parameters: names as of ``spline_model.sensitivity.parameters.PARAMETERS``; for area and second
    moment the section's depth follows as sqrt(12 I / A), for thickness and width it is the
    thickness. stations: where stresses are taken, reference arc length over L. body: of a mechanism, the
    one that was driven and is reported, or the only one.

    With the residual R(y; p) of the strips' elements and its tangent K at a converged state

        dy/dp = -K^-1 dR/dp,    dT/dp = dR_driven/dp,    dk/dp = y_t^T (dK/dp) y_t,    y_t = dy/d(theta)

    where dT/dp and dK/dp count the change of the state too: one factorisation a state, one
    back-substitution a parameter and one for the rate y_t. The parameters enter through the end frames,
    reach, speed, EI, compliance and dead load of the strips, by a complex step: exact to round-off for
    the discrete answer, in either measure, under loads and pre-strain, with clamps over the whole width (by
    the plate's own solution), sections that flatten and roots that turn. The slide stiffness goes
    with the design. Bodies keep their mass. Refuses what the elements do not know: printed
    forces. Source: implicit function theorem; Haftka and Guerdal, Elements of Structural Optimization (1992),
    ch. 7.
    """
    require_mechanism(asked)
    if asked.design.discretisation.control_points is None:
        asked = asked.on(solution.segments, solution.control_points)
    require_uncut(asked.design.discretisation, "sensitivities")
    rates = Rates.of(asked, parameters)
    driven = not np.isnan(solution.torque).all()
    system = compile_scene(asked.driven(1.0, body) if driven else asked.scene)
    z = solution.states
    model = _model_of(system, z)
    y, varied = from_unknowns(model, z), Varied.of(model, asked.design, rates)
    still = Elements(model=model, varied=varied, y=y[None] + 0j)
    changes, rate = _differentiate(still, solution, rates.held(model))
    moved = Elements(model=model, varied=varied, y=y + 1j * STEP * changes)
    unknowns = _unknowns(moved)
    states, stiffness = _quantity(unknowns), _quantity(model.energy * moved.second_along(rate))
    bending, axial = (_quantity(model.energy * each).derivative for each in moved.energies)
    torque = Quantity(value=solution.torque, derivative=np.full((len(z), len(parameters)), np.nan))
    if driven:
        row = system.drives.row[model.bodies.driven]
        torque = replace(torque, derivative=states.derivative[:, row])
    return Sensitivities(
        parameters=tuple(parameters),
        torque=torque,
        stiffness=stiffness if driven else torque,
        **_shifts(asked, rates, unknowns, system.layout, body),
        bending_energy=Quantity(value=solution.bending_energy, derivative=bending),
        axial_energy=Quantity(value=solution.axial_energy, derivative=axial),
        fibre_stress=_quantity(_fibre_stress(moved, stations)),
        stations=np.asarray(stations, dtype=float),
        states=states.derivative,
        counters={"factorisations": len(z), "back_substitutions": len(z) * (len(parameters) + 1)},
    )


def _model_of(system: System, z: Array) -> Reduced:
    """The strips' elements of a system; refuses what they do not know, and z (S, N) of another system."""
    model = require_reduced(system)
    if z.shape[1:] != (system.layout.size,):
        got = f"{z.shape[1:]} unknowns"
        raise InvalidParameter("solution", got, f"a solution of this pivot with {system.layout.size}")
    return model


def _unknowns(elements: Elements) -> NDArray[Any]:
    """The scene's unknowns z (P, S, N), reactions of drives without the loads, which no parameter moves."""
    force, at_clamps = elements.residual()
    points = elements.points.transpose(3, 4, 2, 0, 1)
    points, forces = points.reshape(*points.shape[:3], -1), at_clamps.transpose(3, 4, 2, 0, 1)
    return gathered(elements.model, elements.y, points, forces, force[..., elements.model.bodies.held])


def _differentiate(still: Elements, solution: StaticSolution, held: Array) -> tuple[Array, Array]:
    """Derivatives (P, S, Y) by the parameters, ``held`` (P, D) of held coordinates, and (1, S, Y) by the
    rotation."""
    model, y = still.model, still.y[0].real
    bodies, scene, poses = model.bodies, model.system.scene, len(model.bodies.rest)
    force = still.residual()[0]
    left = force[0].real.copy()
    left[:, :poses] -= np.multiply.outer(solution.load_factor, bodies.load[:poses]) + bodies.weight[:poses]
    at = [solution.states[:, model.system.layout.strip(strip.name)] for strip in scene.strips]
    order = model.shape.order
    given = np.stack(at, axis=-1).reshape(len(y), -1, 2, len(at))[:, order] / model.length
    apart = still.points[..., 0, :].real.transpose(3, 0, 1, 2) - given
    free = np.setdiff1d(np.arange(model.size), bodies.held)
    wrong = np.maximum(np.abs(left[:, free]).max(axis=1), np.abs(apart).max(axis=(1, 2, 3)))
    if not wrong.max() <= LARGEST_RESIDUAL:
        s = int(np.argmax(~(wrong <= LARGEST_RESIDUAL)))
        expected = f"at most {LARGEST_RESIDUAL:g}: a solution of this pivot"
        raise InvalidParameter("solution", f"state {s} with residual {wrong[s]:.1e}", expected)
    tangent = whole_tangents(model, y)[1]
    changes = np.zeros((len(held) + 1, *y.shape))
    changes[:-1, :, bodies.held] = held[:, None]
    if bodies.driven >= 0:
        changes[-1, :, bodies.held[bodies.driven]] = 1.0
    right = -np.einsum("sfd,psd->psf", tangent[:, free[:, None], bodies.held], changes[..., bodies.held])
    right[:-1] -= force[..., free].imag / STEP
    try:
        found = np.linalg.solve(tangent[:, free[:, None], free], right.transpose(1, 2, 0))
    except np.linalg.LinAlgError:
        raise InvalidParameter("solution", "a state with a singular tangent", "regular states") from None
    changes[..., free] = found.transpose(2, 0, 1)
    return changes[:-1], changes[-1:]


def _shifts(
    asked: Mechanism, rates: Rates, unknowns: NDArray[Any], layout: Layout, body: str | None
) -> dict[str, Quantity]:
    """Centre of the body, its displacement, and that of its point in a pivot's crossing at rest; nan without
    a body."""
    design, step = asked.design, 1j * STEP
    if not design.bodies:
        none = _quantity(np.full((*unknowns.shape[:-1], 2), np.nan + 0j))
        return {"centre": none, "body_shift": none, "centre_shift": none}
    name = design.body_named(body)
    place = [each.name for each in design.bodies].index(name)
    centre, angle = unknowns[..., layout.body(name)][..., :2], unknowns[..., layout.body(name)][..., 2]
    rest = np.asarray(design.bodies[place].centre) + step * rates.centres[:, place]
    point = rest
    if isinstance(asked, Pivot):
        ratio, length = asked.crossing_reach
        crossing = asked.clamp_points[0, 0] + ratio * length * asked.clamp_directions[0, 0]
        point = crossing + step * rates.crossing
    arm = (point - rest).T[..., None]
    swung = np.moveaxis(turned(angle, arm[0], arm[1]), 1, -1)
    return {
        "centre": _quantity(centre),
        "body_shift": _quantity(centre - rest[:, None]),
        "centre_shift": _quantity(centre + swung - point[:, None]),
    }


def _fibre_stress(elements: Elements, stations: Array) -> NDArray[Any]:
    """Stress [Pa] at both extreme fibres of G strips at Q stations, (P, S, G, Q, 2).

    N / A -+ M h / (2 I) with h = sqrt(12 I / A) of the rectangular section, left fibre first: signed,
    so that both are smooth in state and design. Plane sections, without the clamps' notches.
    """
    model, varied, strips = elements.model, elements.varied, elements.model.strips
    scene, basis = model.system.scene, model.system.scene.strips[0].basis
    d1, d2 = (in_order(basis.evaluate(stations, k)[..., None], model.shape)[..., 0] for k in (1, 2))
    still = np.stack([in_order(s.control_points, model.shape) for s in scene.strips], axis=-1)
    at_rest = still[..., None, None] / model.length
    rest, curve = Curve.of(d1, d2, at_rest), Curve.of(d1, d2, elements.points)
    natural = {e.strip: model.length * e.natural_curvature for e in scene.of(Bending)}
    curvature = np.array([natural[s.name] for s in scene.strips])[:, None, None]
    curvature, speed = curvature + rest.turning / rest.speed, rest.speed * varied.longer
    bend = curve.turning / (curve.speed if strips.measure else speed) - curvature
    rigidity, drop = varied.along(model, stations)
    curled = laws.curl_factors(bend, drop, varied.curl)[1] if varied.curl.any() else 1.0
    moment = rigidity * bend * curled
    side = moment * model.energy * np.sqrt(3.0 / (varied.area * varied.second_moment))
    force: Any = 0.0
    if strips.stretching.any():
        force = varied.stretching * (curve.speed / speed - 1.0 - strips.strain[:, None, None])
    if len(elements.axial):
        parts = [e.modes for e in scene.of(MixedStretching) if e.strip == scene.strips[0].name]
        shown = np.column_stack([modes.evaluate(stations) for modes in parts]) @ model.to_modes
        force = force + times_each(shown, elements.axial)
    mean = force * (model.energy / model.length / varied.area)
    return np.stack((mean - side, mean + side)).transpose(3, 4, 2, 1, 0)


def _quantity(found: NDArray[Any]) -> Quantity:
    """Values (...) and derivatives (..., P) of what a complex step gave, (P, ...)."""
    return Quantity(value=found[0].real, derivative=np.moveaxis(found.imag / STEP, 0, -1))


@dataclass(frozen=True, kw_only=True, eq=False)
class Quantity:
    """Values (...) of a quantity and its derivatives (..., P) by the parameters."""

    value: Array
    derivative: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class Sensitivities:
    """Derivatives of a path of S states by P parameters, each over the parameter's SI unit.

    parameters: names, the last axis of every derivative. torque (S,) [N m]; stiffness (S,)
    [N m/rad]; centre (S, 2) of the body and body_shift (S, 2) from rest [m]; centre_shift (S, 2):
    displacement of the body's point that lies in the strips' crossing at rest, what the
    literature calls the pivot's centre shift [m]; bending_energy, axial_energy (S,) [J];
    fibre_stress (S, G, Q, 2) of G strips at Q stations, both extreme fibres [Pa]; stations (Q,);
    states: derivatives of the unknowns (S, N, P); counters: factorisations and back_substitutions.
    """

    parameters: tuple[str, ...]
    torque: Quantity
    stiffness: Quantity
    centre: Quantity
    body_shift: Quantity
    centre_shift: Quantity
    bending_energy: Quantity
    axial_energy: Quantity
    fibre_stress: Quantity
    stations: Array
    states: Array
    counters: dict[str, int]

    def largest_stress(self) -> Quantity:
        """Largest magnitude of the fibre stress (S,) [Pa]; its derivative is that of the point where it
        is, exact as long as there is one such point."""
        flat = self.fibre_stress.value.reshape(len(self.torque.value), -1)
        by = self.fibre_stress.derivative.reshape(*flat.shape, len(self.parameters))
        rows, where = np.arange(len(flat)), np.abs(flat).argmax(axis=1)
        sign = np.sign(flat[rows, where])
        return Quantity(value=np.abs(flat[rows, where]), derivative=sign[:, None] * by[rows, where])
