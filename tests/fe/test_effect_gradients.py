"""Every effect's force against its energy, tangent against force, damping against velocity, far from rest."""

import numpy as np
import pytest

from fe_reference.compiled import CompiledForces
from fe_reference.effects.actions import Actions
from fe_reference.effects.loads import applied
from fe_reference.mass import about_mass_centre
from fe_reference.model import ELEMENTS
from fe_reference.structure import Structure
from tests.fe.cases import LENGTH, hold
from tests.fe.scenes import PARAMETERS, four_bar
from tests.fe.test_gradients import derivative


def scene(element: str, about_mass: bool) -> Structure:
    """Return a four-bar of curved strips with every effect, about the bodies' centres or those of mass."""
    structure = four_bar(PARAMETERS, rise=0.003, elements=3, element=element).structure
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


@pytest.mark.parametrize("about_mass", [False, True])
@pytest.mark.parametrize("element", ELEMENTS)
def test_force_is_the_gradient_of_the_potential(element: str, about_mass: bool) -> None:
    """With gravity, natural strains and several bodies the force is the gradient of the potential."""
    structure = scene(element, about_mass)
    y, size = far(structure), sizes(structure, 1.0)

    def error(step: float = 1e-3) -> float:
        slope = derivative(lambda z: np.array(structure.potential(z, 0.7)), y, sizes(structure, step))
        force = structure.internal_force(y, 0.7)
        return float(np.abs((slope - force) * size).max() / np.abs(force * size).max())

    hold("fe_scene_force_is_gradient", error)


@pytest.mark.parametrize("about_mass", [False, True])
@pytest.mark.parametrize("element", ELEMENTS)
def test_tangent_is_the_derivative_of_the_force(element: str, about_mass: bool) -> None:
    """The tangent is the derivative of that force, in the coordinates and in the share."""
    structure = scene(element, about_mass)
    y, size = far(structure), sizes(structure, 1.0)

    def error(step: float = 1e-3) -> float:
        slope = derivative(lambda z: structure.internal_force(z, 0.7), y, sizes(structure, step))
        tangent = structure.tangent_stiffness(y, 0.7).toarray()
        gap = np.abs((slope - tangent) * size * size[:, None]).max()
        return float(gap / np.abs(tangent * size * size[:, None]).max())

    hold("fe_scene_tangent_is_derivative", error)
    full, none = structure.internal_force(y, 1.0), structure.internal_force(y, 0.0)
    assert np.allclose(full - none, structure.share_force(y), rtol=0.0, atol=1e-11 * np.abs(full).max())
    rate = (structure.potential(y, 0.8) - structure.potential(y, 0.6)) / 0.2
    assert structure.share_energy(y, 0.7)[0] == pytest.approx(rate, rel=1e-8)


@pytest.mark.parametrize("about_mass", [False, True])
def test_loads_are_the_gradients_of_their_work(about_mass: bool) -> None:
    """Each load's generalised force is the gradient of its work, and its curvature the derivative of that."""
    structure = scene("corotational", about_mass)
    y, size = far(structure), sizes(structure, 1.0)

    def error(scale: float = 1.0) -> float:
        worst = 0.0
        for load, _ in applied(structure):
            slope = derivative(lambda z, load=load: np.array(load.work(z)), y, sizes(structure, 1e-2))
            worst = max(worst, np.abs((slope - scale * load.generalised(y)) * size).max())
        return float(worst / LENGTH / 2000.0)

    hold("fe_load_is_gradient", error)


@pytest.mark.parametrize("element", ELEMENTS)
def test_compiled_scene_is_the_assembled_one(element: str) -> None:
    """The compiled force with all effects is the assembled one; so are loads and dampers."""
    structure = scene(element, True)
    compiled, y = CompiledForces(structure), far(structure)
    actions, v = Actions(compiled), np.random.default_rng(5).standard_normal(structure.size)

    def error(time: float = 5e-4) -> float:
        force, energy = compiled.forces(y)
        assembled = structure.internal_force(y)
        loads = sum(
            np.interp(5e-4, *np.transpose(history)) * load.generalised(y)
            for load, history in applied(structure)
        )
        acting = actions.resist(y, v, time)
        viscous = actions.damping_matrix(y) @ v
        gaps = (
            (force - assembled) / np.abs(assembled).max(),
            energy / sum(structure.energies(y)) - 1.0,
            (acting.force - viscous + loads) / np.abs(acting.force).max(),
            acting.loss_power / (v @ viscous) - 1.0,
            acting.load_power / (v @ loads) - 1.0,
        )
        return float(max(np.abs(gap).max() for gap in gaps))

    hold("fe_compiled_scene", error)
