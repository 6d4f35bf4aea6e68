"""Compiled elements: the weak forms that scikit-fem assembles, derivatives of every effect far from rest."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from skfem import Basis, BilinearForm, DiscreteField, Functional, LinearForm

from fe_reference import ELEMENTS
from fe_reference.arrays import Array
from fe_reference.law import FORCES, TANGENT, elements
from fe_reference.mass import about_mass_centre
from fe_reference.motion import Scheme
from fe_reference.structure import Structure, structure_of
from tests.fe.scenes import PARAMETERS, SIDED_SCENE, WIDE, four_bar
from tests.gates import hold
from tests.models import rotation_matrix
from tests.table_one import LENGTH

NATURAL = PARAMETERS["pre_strain"]
#: Points that integrate an element's energy exactly: one by definition, and two of a parabola.
POINTS = {
    "reissner": (np.array([[0.5]]), np.array([1.0])),
    "corotational": (0.5 + np.array([[-0.5, 0.5]]) / np.sqrt(3.0), np.array([0.5, 0.5])),
}


def slopes(v: Any, w: Any) -> tuple[Any, Any, Any, Any]:
    """Return u' along the section's normal and across it, the turn and its slope."""
    x, y = v.grad[0, 0], v.grad[1, 0]
    return x * w.c + y * w.s, y * w.c - x * w.s, v[2], v.grad[2, 0]


def sections(w: Any) -> tuple[Any, Any, Any]:
    """Return N, M and the third force: shear, or the moment of the turns from the chord."""
    return w.EA * (w.eps - w.e0), w.EI * (w.kappa - w.k0), w.third * w.turn


def variations(v: Any, w: Any) -> tuple[Any, Any, Any]:
    """Return the first variations of eps, kappa and the third strain."""
    along, across, turn, slope = slopes(v, w)
    if w.shear:
        return along + turn * w.turn, slope, across - turn * (1.0 + w.eps)
    return along, slope, turn - across / (1.0 + w.eps)


def second(u: Any, v: Any, w: Any) -> tuple[Any, Any]:
    """Return the second variations of eps and the third strain."""
    (a, b, p, _), (c, d, q, _) = slopes(u, w), slopes(v, w)
    if w.shear:
        return p * d + q * b - p * q * (1.0 + w.eps), -p * c - q * a - p * q * w.turn
    return b * d / (1.0 + w.eps), (a * d + b * c) / (1.0 + w.eps) ** 2


@Functional
def energy(w: Any) -> Any:
    axial, moment, third = sections(w)
    bending = moment * (w.kappa - w.k0) if w.shear else w.EI * w.k0 * (w.k0 - 2.0 * w.kappa)
    return 0.5 * (axial * (w.eps - w.e0) + bending + third * w.turn)


@LinearForm
def force(v: Any, w: Any) -> Any:
    (axial, moment, third), (eps, kappa, turn) = sections(w), variations(v, w)
    return axial * eps + (moment if w.shear else -w.EI * w.k0) * kappa + third * turn


@BilinearForm
def stiffness(u: Any, v: Any, w: Any) -> Any:
    (axial, _, third), (eps, turn) = sections(w), second(u, v, w)
    (a, b, c), (d, e, f) = variations(u, w), variations(v, w)
    bending = w.EI * b * e if w.shear else 0.0
    return w.EA * a * d + bending + w.third * c * f + axial * eps + third * turn


def fields(structure: Structure, basis: Basis, vector: np.ndarray) -> dict[str, Any]:
    """Return strains and directions at the points; 12 EI / l^2 holds the turns of a corotational element."""
    e, field = structure.elements, basis.interpolate(vector)
    (x, y, kappa), turn = field.grad[:, 0], field[2]
    t = (e.chord / e.length)[:, :, None] + np.stack([x, y])
    angle = np.arctan2(*e.chord[::-1])[:, None] + turn
    if structure.shear:
        c, s = np.cos(angle), np.sin(angle)
        eps, third, held = t[0] * c + t[1] * s - 1.0, t[1] * c - t[0] * s, e.shear_rigidity
    else:
        stretch = np.hypot(*t)
        (c, s), eps = t / stretch, stretch - 1.0
        third = np.angle(np.exp(1j * angle) * (c - 1j * s))
        held = 12.0 * e.flexural_rigidity / e.length**2
    rigidities = {"EA": e.axial_rigidity, "EI": e.flexural_rigidity, "third": held}
    constant = {name: DiscreteField(value[:, None] + 0.0 * kappa) for name, value in rigidities.items()}
    moving = {"eps": eps, "turn": third, "kappa": kappa, "c": c, "s": s}
    natural = {"e0": NATURAL["strain"], "k0": NATURAL["curvature"], "shear": structure.shear}
    return {name: DiscreteField(value) for name, value in moving.items()} | constant | natural


def bent(structure: Structure) -> np.ndarray:
    """Return displacements and turns of the nodes (nodes, 3): turned by 100 deg and scattered."""
    rest = structure.model.rest.reshape(-1, 2)
    noise = np.random.default_rng(3).standard_normal((len(rest), 3))
    moved = rest @ rotation_matrix(1.7).T - rest + 0.05 * LENGTH / structure.stations * noise[:, :2]
    return np.column_stack([moved, 1.7 + 0.2 * noise[:, 2]])


@pytest.mark.parametrize("element", ELEMENTS)
def test_elements_are_what_scikit_fem_assembles(element: str) -> None:
    """Energy, forces and tangent of both elements are those of scikit-fem's own assembly, far from rest."""
    model = four_bar({"pre_strain": NATURAL}, rise=0.003, elements=4, element=element)
    structure = structure_of(model)
    basis = Basis(structure.basis.mesh, structure.basis.elem, quadrature=POINTS[element])

    def error(move: float = 0.0) -> float:
        u, many = bent(structure), len(structure.elements.length)
        nodal, ends, own = np.empty_like(u), np.empty((many, 5)), np.empty((many, 6, 6))
        written = (nodal, ends, own, np.empty((4, 4)))
        energies = elements(structure.given, 1.0, TANGENT, u + move * LENGTH * u, written)
        vector, dofs = np.zeros(basis.N), basis.element_dofs
        vector[basis.nodal_dofs] = u.T
        given = fields(structure, basis, vector)
        matrix, loads = stiffness.assemble(basis, **given).toarray(), force.assemble(basis, **given)
        mine = np.zeros_like(matrix)
        np.add.at(mine, (dofs.T[:, :, None], dofs.T[:, None, :]), own)
        gaps = (
            sum(energies) / energy.assemble(basis, **given) - 1.0,
            np.abs(nodal.T - loads[basis.nodal_dofs]).max() / np.abs(loads).max(),
            np.abs(mine - matrix).max() / np.abs(matrix).max(),
        )
        return float(max(abs(gap) for gap in gaps))

    hold("fe_compiled_force", error)


@pytest.mark.parametrize("element", ELEMENTS)
def test_what_resists_a_motion_is_the_gradient_with_loads_and_dampers(element: str) -> None:
    """The compiled resistance is the gradient of the potential, damping matrix times velocity, less loads."""
    model = four_bar(PARAMETERS, rise=0.003, elements=3, element=element)
    scheme, generator = Scheme(model), np.random.default_rng(5)
    structure = scheme.structure
    y, v = 0.002 * generator.standard_normal((2, structure.size))
    y[structure.turns] = [1.1, -0.7, 2.0]

    def error(time: float = 5e-4) -> float:
        acting, here = scheme.resist(y, v, time), structure.evaluate(y, asked=FORCES)
        viscous = structure.damping_matrix(y).times(v)
        loads = here.gradient + viscous - acting.force
        # half of (2, 1) kN on the coupler's centre, from 1 to -1 over 2 ms; 30 N m on the crank
        expected, at = np.zeros(structure.size), structure.body_slice(1).start
        c, s = np.cos(y[at + 2]), np.sin(y[at + 2])
        arm = np.array([[c, -s], [s, c]]) @ (model.bodies[1].centre - structure.points[1])
        pull = 0.5 * np.array([2000.0, 1000.0])
        expected[at : at + 3] = *pull, arm[0] * pull[1] - arm[1] * pull[0]
        expected[structure.turns[0]] = 30.0
        gaps = (
            np.abs(loads - expected).max() / np.abs(acting.force).max(),
            acting.strain / (sum(here.strain) + here.spring) - 1.0,
            acting.gravity / here.gravity - 1.0,
            acting.loss_power / (v @ viscous) - 1.0,
            acting.load_power / (v @ expected) - 1.0,
        )
        return float(max(abs(gap) for gap in gaps))

    hold("fe_compiled_scene", error)


#: Sixth-order central difference of a first derivative, offsets 1 to 3.
WEIGHTS = (3.0 / 4.0, -3.0 / 20.0, 1.0 / 60.0)


def derivative(function: Callable[[np.ndarray], np.ndarray], y: np.ndarray, step: np.ndarray) -> np.ndarray:
    """Return d f / d y of shape (..., size) by sixth-order differences with a step for every coordinate."""
    columns = []
    for j, h in enumerate(step):
        unit = np.eye(len(y))[j] * h
        columns.append(
            sum(
                w / h * (function(y + k * unit) - function(y - k * unit))
                for k, w in enumerate(WEIGHTS, start=1)
            )
        )
    return np.stack(columns, axis=-1)


#: Effects and sections of the strips: curved ones with natural strains; straight ones that are as wide as
#: they are long, with the effects of that; and such with roots alone that give way, and natural strains.
SCENES: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "curved": (PARAMETERS, {"rise": 0.003}),
    "wide": (SIDED_SCENE, {"section": WIDE}),
    "rooted": (PARAMETERS | {"root_compliance": {"root": 3.0}}, {"section": WIDE}),
}


def scene(element: str, about_mass: bool, kind: str) -> Structure:
    """Return a four-bar with every effect, about the bodies' centres or those of mass."""
    effects, strips = SCENES[kind]
    model = four_bar(effects, elements=3, element=element, **strips)
    structure = structure_of(model)
    return about_mass_centre(structure)[0] if about_mass else structure


def far(structure: Structure) -> np.ndarray:
    """Return coordinates far from rest."""
    generator = np.random.default_rng(11)
    y = 0.002 * generator.standard_normal(structure.size)
    y[2::3] = 0.4 * generator.standard_normal(structure.size // 3)
    y[structure.turns] = [1.1, -0.7, 2.0]
    return y


def sizes(structure: Structure, step: float) -> np.ndarray:
    return step * np.where(structure.scale == structure.force_unit, LENGTH, 1.0)


def potential(structure: Structure, y: Array, share: float) -> float:
    """Return the energy of strips and weight in the given share, and that of springs [J]."""
    here = structure.evaluate(y, share)
    return math.fsum(here.strain) + here.spring + share * here.gravity


@pytest.mark.parametrize("kind", SCENES)
@pytest.mark.parametrize("about_mass", [False, True])
@pytest.mark.parametrize("element", ELEMENTS)
def test_force_and_tangent_are_derivatives(element: str, about_mass: bool, kind: str) -> None:
    """With every effect and several bodies the force is the gradient of the potential, the tangent the
    derivative of the force, in the coordinates and in the share."""
    structure = scene(element, about_mass, kind)
    y, size, short = far(structure), sizes(structure, 1.0), 1e-3 if kind == "curved" else 1e-4
    here = structure.evaluate(y, 0.7)

    def of_force(step: float = short) -> float:
        slope = derivative(lambda z: np.array(potential(structure, z, 0.7)), y, sizes(structure, step))
        return float(np.abs((slope - here.gradient) * size).max() / np.abs(here.gradient * size).max())

    def of_tangent(step: float = short) -> float:
        slope = derivative(lambda z: structure.evaluate(z, 0.7).gradient, y, sizes(structure, step))
        tangent, scale = here.tangent.sparse().toarray(), size * size[:, None]
        return float(np.abs((slope - tangent) * scale).max() / np.abs(tangent * scale).max())

    hold("fe_scene_force_is_gradient", of_force)
    hold("fe_scene_tangent_is_derivative", of_tangent)
    full, none = structure.evaluate(y, 1.0).gradient, structure.evaluate(y, 0.0).gradient
    force, slope, bend = structure.share_rates(y)
    assert np.allclose(full - none, force, rtol=0.0, atol=1e-11 * np.abs(full).max())
    rate = (potential(structure, y, 0.8) - potential(structure, y, 0.6)) / 0.2
    # a parabola of the share, nearly so where roots of shear-deformable elements give way
    nearly = 1e-6 if (kind, element) == ("rooted", "reissner") else 1e-8
    assert slope - 0.3 * bend == pytest.approx(rate, rel=nearly)
