"""Linearised frequencies against closed forms, and their convergence."""

from dataclasses import replace

import numpy as np
import pytest

from fe_reference import ELEMENTS, FREE, Body, natural_frequencies
from fe_reference.model import GROUND
from tests.closed_forms import CANTILEVER_ROOTS, end_body_roots
from tests.fe.cases import LENGTH, SECTION, cantilever, extrapolated, pivot
from tests.gates import hold

#: The paper's section with stretching put out of the way of bending, at the same EI and mass per length.
STIFF = replace(SECTION, area=100.0 * SECTION.area, density=SECTION.density / 100.0)
#: Frequency of z = 1 in z^2 sqrt(EI / (mu L^4)) / (2 pi) [Hz].
UNIT = np.sqrt(STIFF.flexural_rigidity / (STIFF.linear_density * LENGTH**4)) / (2.0 * np.pi)


def relative(value: np.ndarray, exact: np.ndarray) -> float:
    return float(np.abs(value / exact - 1.0).max())


def test_cantilever() -> None:
    """The first five bending frequencies of a cantilever are those of the roots beta L."""

    def error(elements: int = 40) -> float:
        modes = natural_frequencies(cantilever(elements=elements, section=STIFF), count=5)
        return relative(modes.frequency, UNIT * CANTILEVER_ROOTS**2)

    hold("fe_cantilever_frequencies", error)


def test_lumped_masses_tend_to_the_same_frequencies() -> None:
    """Lumped masses, as the explicit integrator has them, extrapolate to the same frequencies."""

    def error(elements: tuple[int, ...] = (20, 40, 80)) -> float:
        values = [
            natural_frequencies(cantilever(elements=n, section=STIFF), count=5, mass="lumped").frequency
            for n in elements
        ]
        return relative(extrapolated(values), UNIT * CANTILEVER_ROOTS**2)

    hold("fe_cantilever_frequencies_lumped", error)


@pytest.mark.parametrize(("eta", "zeta"), [(1.0, 0.0), (1.0, 0.1), (0.2, 0.5)])
def test_strip_with_end_body(eta: float, zeta: float) -> None:
    """A strip with a rigid end body has the frequencies of the transcendental equation."""
    mass = STIFF.linear_density * LENGTH
    body = Body(centre=np.array([LENGTH, 0.0]), mass=eta * mass, moment_of_inertia=zeta * mass * LENGTH**2)

    def error(elements: int = 40) -> float:
        model = replace(cantilever(elements=elements, section=STIFF), bodies=(body,))
        roots = end_body_roots(eta, zeta, 3)
        return relative(natural_frequencies(model, count=3).frequency, UNIT * roots**2)

    hold("fe_end_body_frequencies", error)


def test_published_roots_of_the_end_body() -> None:
    """The equation used above has the published first roots 1.24792 and 1.19567."""

    def error(inertia: float = 0.1) -> float:
        found = (end_body_roots(1.0, each, 1)[0] for each in (0.0, inertia))
        return max(abs(one - other) for one, other in zip(found, (1.24792, 1.19567), strict=True))

    hold("fe_published_roots", error)


@pytest.mark.parametrize("element", ELEMENTS)
def test_both_masses_extrapolate_to_the_same_frequencies(element: str) -> None:
    """At rest and at 60 degrees the frequencies do not depend on how the mass is put on the mesh."""

    def error(elements: tuple[int, ...] = (20, 40, 80)) -> float:
        worst = 0.0
        for rotation in (0.0, np.pi / 3.0):
            limits = []
            for mass in ("consistent", "lumped"):
                values = [
                    natural_frequencies(
                        pivot(elements=n, element=element),
                        rotation=rotation,
                        count=5,
                        mass=mass,
                        increments=5,
                    ).frequency
                    for n in elements
                ]
                limits.append(extrapolated(values))
            worst = max(worst, relative(*limits))
        return worst

    hold(f"fe_frequencies_by_mass_{element}", error)


def test_holding_the_rotation_interlaces_the_frequencies() -> None:
    """With the rotation held each frequency lies between two of the released pivot."""
    model = pivot(elements=10)
    free = natural_frequencies(model, rotation=1.0, count=6)
    held = natural_frequencies(model, rotation=1.0, count=5, held=True)
    assert np.all(held.frequency >= free.frequency[:5])
    assert np.all(held.frequency <= free.frequency[1:])
    assert np.all(held.body_shapes[:, 2] == 0.0)


def test_shapes_move_with_the_body() -> None:
    """In every mode the strips' ends move rigidly with the body and the clamps stay."""
    modes = natural_frequencies(pivot(elements=10), rotation=0.8, count=4)
    ends = modes.shapes[:, :, -1] - modes.body_shapes[:, None, :2]
    plate = ends[:, 1] - ends[:, 0]
    turned = 0.06 * np.array(
        [np.sin(0.8), -np.cos(0.8)]
    )  # B2 - B1 = (-0.06, 0) turned, and once more by 90 deg
    assert np.abs(plate - modes.body_shapes[:, 2:] * turned).max() < 1e-12 * np.abs(modes.shapes).max()
    assert np.all(modes.shapes[:, :, 0] == 0.0)


def test_free_strip_has_three_rigid_motions() -> None:
    """The rigid motions of a free strip have the frequency zero, one strip clamped at an end has none."""

    def rigid(root: int) -> int:
        clamped = cantilever(elements=10)
        free = replace(clamped, strips=(replace(clamped.strips[0], root=root),))
        return int((natural_frequencies(free, count=4).frequency == 0.0).sum())

    assert (rigid(FREE), rigid(GROUND)) == (3, 0)


def test_small_meshes_give_all_their_modes() -> None:
    """A mesh too small for the sparse solver is solved densely, and has no more modes than coordinates."""
    model = pivot(elements=2)
    many = natural_frequencies(model, count=9)
    few = natural_frequencies(model, count=3)
    assert many.frequency.shape == (9,)
    assert few.frequency == pytest.approx(many.frequency[:3], rel=1e-9)
    assert natural_frequencies(model, count=10).frequency == pytest.approx(many.frequency, rel=1e-9)
    assert natural_frequencies(model, count=10, accuracy=0.1).frequency.shape == (9,)
