"""Every effect's force against its energy, tangent against force, damping against velocity, far from rest."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from fe_reference import ELEMENTS
from fe_reference.arrays import Array
from fe_reference.mass import about_mass_centre
from fe_reference.structure import Structure, structure_of
from tests.fe.scenes import PARAMETERS, SIDED_SCENE, WIDE, four_bar
from tests.gates import hold
from tests.table_one import LENGTH

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
