"""The compiled elements against the same energies as weak forms that scikit-fem integrates and assembles."""

from typing import Any

import numpy as np
import pytest
from skfem import Basis, BilinearForm, DiscreteField, Functional, LinearForm

from fe_reference import ELEMENTS
from fe_reference.actions import Actions
from fe_reference.law import FORCES, TANGENT, elements
from fe_reference.mass import about_mass_centre
from fe_reference.structure import Structure, structure_of
from tests.fe.scenes import PARAMETERS, four_bar
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
    structure = about_mass_centre(structure_of(model))[0]
    actions, generator = Actions(structure), np.random.default_rng(5)
    y, v = 0.002 * generator.standard_normal((2, structure.size))
    y[structure.turns] = [1.1, -0.7, 2.0]

    def error(time: float = 5e-4) -> float:
        acting, here = actions.resist(y, v, time), structure.evaluate(y, asked=FORCES)
        viscous = actions.damping_matrix(y).times(v)
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
