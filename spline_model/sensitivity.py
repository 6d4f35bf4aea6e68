"""Derivatives of everything a static path answers, from the factorised tangent of its states."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System, compile_scene
from spline_model.effects.plate import STEP
from spline_model.errors import InvalidParameter
from spline_model.mechanism import Mechanism, require_mechanism
from spline_model.parameters import KEYWORDS, Given, require_names
from spline_model.pivot import turned
from spline_model.reduced.model import Reduced, from_unknowns, require_reduced
from spline_model.reduced.states import products, section_forces, unknowns_of, whole_tangents
from spline_model.sections import STATIONS
from spline_model.static_answers import StaticSolution

Array = NDArray[np.float64]
Complex = NDArray[Any]

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
    """Return derivatives of a solved path by the design, at constant rotations, loads and displacements.

    With the residual R(y; p) of the strips' elements and its tangent K at a converged state

        dy/dp = -K^-1 dR/dp,    dT/dp = dR_driven/dp,    dk/dp = y_t^T (dK/dp) y_t,    y_t = dy/d(theta)

    where dT/dp and dK/dp count the change of the state too: one factorisation a state, one
    back-substitution a parameter and one for the rate y_t.

    Parameters
    ----------
    asked : Mechanism
    solution : StaticSolution
        Of this mechanism.
    parameters : sequence of str
        Names of ``spline_model.parameters``, P of them. For area and second moment the depth of the section
        follows as sqrt(12 I / A); for thickness and width it is the thickness.
    stations : (Q,) 1
        Reference arc length over L where stresses are taken.
    body : str, default None
        Driven and reported body; None is the only one.

    Returns
    -------
    Sensitivities
        Values and derivatives (..., P) per SI unit: torque (S, P), stiffness (S, P), centre (S, 2, P), ...

    Raises
    ------
    InvalidParameter
        Forces as published (measure "published"), which are not supported, or a path of another design.

    Notes
    -----
    The parameters enter through the arrays of the strips, by a complex step with which the kernels of the
    path are evaluated again: exact to round-off for the discrete answer, in either measure, under loads and
    pre-strain, with lateral clamping, anticlastic stiffening and support compliance. The penalty stiffness
    changes with the design. Bodies keep their mass.

    References
    ----------
    Implicit function theorem; Haftka and Guerdal, Elements of Structural Optimization (1992), ch. 7.

    Examples
    --------
    With ``pivot`` of the example of ``spline_model.pivot.cross_axis_pivot``:

    >>> path = solve_statics(pivot, rotation=0.1, increments=1)
    >>> sensitivities(pivot, path, parameters=("thickness",)).torque.derivative.shape
    (2, 1)
    """
    require_mechanism(asked)
    if asked.design.discretisation.control_points is None:
        asked = asked.on(solution.segments, solution.control_points)
    asked.design.require_uncut("sensitivities")
    given = _stepped(asked, parameters)
    driven = not np.isnan(solution.torque).all()
    system = compile_scene(asked.driven(1.0, body) if driven else asked.scene)
    system.require_dead("asked")
    z = solution.states
    model, base = _model_of(system, z), Given.of(asked.design)
    units = np.full(len(parameters), model.length), np.full(len(parameters), model.energy)
    numbers = given.numbers(base, system.scene)
    designs = model.designs(numbers, *units)
    models = [model.of_design(designs, p) for p in range(len(parameters))]
    changes, rate = _differentiate(model, models, solution, designs.start[:, model.bodies.held].imag / STEP)
    y = from_unknowns(model, z) + 1j * STEP * changes
    force, product, energies = _products(models, y, solution.load_factor, rate)
    reaction = force[..., model.bodies.held]
    unknowns = np.stack([unknowns_of(*each) for each in zip(models, y, reaction, strict=True)])
    states = _quantity(unknowns)
    stiffness = _quantity(model.energy * np.sum(rate * product, axis=-1))
    bending, axial = (_quantity(model.energy * energies[..., k]).derivative for k in range(2))
    torque = Quantity(value=solution.torque, derivative=np.full((len(z), len(parameters)), np.nan))
    if driven:
        row = system.drives.row[model.bodies.driven]
        torque = replace(torque, derivative=states.derivative[:, row])
    at = model.at_stations(np.asarray(stations, dtype=float))
    designs = at.designs(numbers, *units, gauss=model.shape)
    at_stations = (at.of_design(designs, p) for p in range(len(models)))
    stress = [_fibre_stress(*each) for each in zip(at_stations, given.section, y, strict=True)]
    return Sensitivities(
        parameters=tuple(parameters),
        torque=torque,
        stiffness=stiffness if driven else torque,
        **_shifts(asked, given, unknowns, system, body),
        bending_energy=Quantity(value=solution.bending_energy, derivative=bending),
        axial_energy=Quantity(value=solution.axial_energy, derivative=axial),
        fibre_stress=_quantity(np.stack(stress)),
        stations=np.asarray(stations, dtype=float),
        states=states.derivative,
        counters={"factorisations": len(z), "back_substitutions": len(z) * (len(parameters) + 1)},
    )


def _stepped(asked: Mechanism, names: Sequence[str]) -> Given:
    """P designs with a step in one parameter each; refuses unknown and doubled ones."""
    if not names or len(set(names)) != len(names):
        raise InvalidParameter("parameters", list(names), "at least one name, each once")
    require_names(asked, names, "parameters")
    given = Given.of(asked.design, len(names), complex)
    given.put(asked, dict(zip(names, 1j * STEP * np.eye(len(names)), strict=True)), own=1.0)
    return given


def _model_of(system: System, z: Array) -> Reduced:
    """The strips' elements of a system; refuses what they do not know, and z (S, N) of another system."""
    model = require_reduced(system)
    if z.shape[1:] != (system.layout.size,):
        got = f"{z.shape[1:]} unknowns"
        raise InvalidParameter("solution", got, f"a solution of this pivot with {system.layout.size}")
    return model


def _products(models: Sequence[Reduced], y: Complex, load: Array, rate: Array) -> list[Complex]:
    """``products`` of P designs at their states (P, S, Y) along the same rates (S, Y)."""
    found = (products(model, each, load, rate + 0j) for model, each in zip(models, y, strict=True))
    return [np.stack(each) for each in zip(*found, strict=True)]


def _differentiate(
    model: Reduced, models: Sequence[Reduced], solution: StaticSolution, held: Array
) -> tuple[Array, Array]:
    """Derivatives (P, S, Y) by the parameters, ``held`` (P, D) of held coordinates, and (S, Y) by the
    rotation."""
    z, load, bodies = solution.states, solution.load_factor, model.bodies
    y = from_unknowns(model, z)
    left, tangent = whole_tangents(model, y, load)
    force = _products(models, np.repeat(y[None], len(models), axis=0) + 0j, load, 0.0 * y)[0]
    count, unit = model.system.layout.coordinate_count, model.system.scales.unit
    again = unknowns_of(model, y, np.zeros((len(y), len(bodies.held))))
    apart = np.abs(again - z)[:, :count] / unit[:count]
    free = np.delete(np.arange(model.size), model.fixed)
    wrong = np.maximum(np.abs(left[:, free]).max(axis=1), apart.max(axis=1))
    if not wrong.max() <= LARGEST_RESIDUAL:  # what of a residual moves nothing is round-off of stiff strips
        moved = np.linalg.solve(tangent[:, free[:, None], free], left[:, free, None])[..., 0]
        wrong = np.maximum(np.abs(moved).max(axis=1), apart.max(axis=1))
    if not wrong.max() <= LARGEST_RESIDUAL:
        s = int(np.argmax(~(wrong <= LARGEST_RESIDUAL)))
        expected = f"at most {LARGEST_RESIDUAL:g}: a solution of this pivot"
        raise InvalidParameter("solution", f"state {s} with residual {wrong[s]:.1e}", expected)
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
    return changes[:-1], changes[-1]


def _shifts(
    asked: Mechanism, given: Given, unknowns: Complex, system: System, body: str | None
) -> dict[str, Quantity]:
    """Centre of the body, its displacement, and that of its point in a pivot's crossing at rest; nan without
    a body."""
    if not asked.design.bodies:
        none = _quantity(np.full((*unknowns.shape[:-1], 2), np.nan + 0j))
        return {"centre": none, "body_shift": none, "centre_shift": none}
    name = asked.design.body_named(body)
    place = [each.name for each in asked.design.bodies].index(name)
    pose, rest = unknowns[..., system.layout.body(name)], given.centres[:, None, place]
    point = given.crossing[:, None] if asked.placing else rest
    x, y = np.moveaxis(point - rest, -1, 0)
    arm = np.stack(turned(x, y, pose[..., 2]), axis=-1)
    return {
        "centre": _quantity(pose[..., :2]),
        "body_shift": _quantity(pose[..., :2] - rest),
        "centre_shift": _quantity(pose[..., :2] + arm - point),
    }


def _fibre_stress(at: Reduced, section: NDArray[Any], y: Complex) -> Complex:
    """Stress [Pa] at both extreme fibres of G strips at a model's Q stations, (S, G, Q, 2).

    N / A -+ M h / (2 I) with h = sqrt(12 I / A) of the rectangular section, left fibre first: signed,
    so that both are smooth in state and design. Plane sections, without the clamps' notches.
    """
    area, second_moment, _ = section.T[..., None]
    force, moment = section_forces(at, y)
    side = moment * at.energy * np.sqrt(3.0 / (area * second_moment))
    mean = force * (at.energy / at.length / area)
    return np.stack((mean - side, mean + side), axis=-1)


def _quantity(found: NDArray[Any]) -> Quantity:
    """Values (...) and derivatives (..., P) of what a complex step gave, (P, ...)."""
    return Quantity(value=found[0].real, derivative=np.moveaxis(found.imag / STEP, 0, -1))


@dataclass(frozen=True, kw_only=True, eq=False)
class Quantity:
    """Values (...) of a quantity in SI units, and its derivatives (..., P) by the parameters, per SI unit."""

    value: Array
    derivative: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class Sensitivities:
    """Derivatives of a path of S states by P parameters, each per SI unit of the parameter.

    Attributes
    ----------
    parameters : tuple of str
        Names, the last axis of every derivative.
    torque, stiffness : Quantity, (S,) N m and N m/rad
    centre, body_shift : Quantity, (S, 2) m
        Of the body, and its displacement from rest.
    centre_shift : Quantity, (S, 2) m
        Displacement of the body point that coincides with the strip crossing at rest.
    bending_energy, axial_energy : Quantity, (S,) J
    fibre_stress : Quantity, (S, G, Q, 2) Pa
        Of G strips at Q stations, both extreme fibres.
    stations : (Q,) 1
    states : (S, N, P)
        Derivatives of the unknowns.
    counters : mapping of str to int
        Factorisations and back-substitutions.
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
        """Return the largest magnitude of the fibre stress (S,) [Pa].

        Its derivative is that of the point where it is, exact as long as there is one such point.
        """
        flat = self.fibre_stress.value.reshape(len(self.torque.value), -1)
        by = self.fibre_stress.derivative.reshape(*flat.shape, len(self.parameters))
        rows, where = np.arange(len(flat)), np.abs(flat).argmax(axis=1)
        sign = np.sign(flat[rows, where])
        return Quantity(value=np.abs(flat[rows, where]), derivative=sign[:, None] * by[rows, where])
