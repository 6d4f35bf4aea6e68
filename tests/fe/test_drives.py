"""Mass and drives of a body: about the common centre, caught off it, and the books of what leads it."""

import numpy as np
import pytest

from fe_reference import DrivenRotation, Model, solve_motion
from fe_reference.drives import drive_spans
from fe_reference.mass import about_mass_centre, mass_matrix
from fe_reference.structure import Structure, structure_of
from tests.fe.cases import LENGTH, pivot
from tests.gates import hold

#: Displacements that a centre is led to: both ways, or one.
WAYS = pytest.mark.parametrize("way", [(2e-4, -1e-4), (2e-4, None), (None, -1e-4)])


def led_off_its_mass(way: tuple[float | None, float | None], elements: int = 3) -> Model:
    """Return the pivot with a body whose centre, far from the strips' ends, is led on and back."""
    history = ((0.0, 0.0), (1.03e-4, 1.0), (1.61e-4, 0.5))
    led = {"displacement": way, "history": history}
    names = ("bending", "stretching", "strip_inertia", "body_inertia", "driven_displacement")
    given = {"effects": names, "parameters": {"driven_displacement": led}}
    return pivot(elements=elements, centre_offset=(0.03, 0.02), body_mass=0.02, **given)


@WAYS
def test_a_catch_gives_momentum_to_what_is_led_alone(way: tuple[float | None, float | None]) -> None:
    """Requirement: impulses act on led coordinates alone, though a body's mass is off the led point."""
    model = led_off_its_mass(way)
    (span, *_), own = drive_spans(model, None, 1e-3), structure_of(model)
    structure, bodies = about_mass_centre(own, span.led)
    y, v = 1e-2 * np.random.default_rng(5).standard_normal((2, structure.size))
    y[structure.turns] = 1.1
    change = span.caught(structure, bodies, y, v) - v
    momentum = mass_matrix(structure, y, "lumped").sparse() @ change
    held = span.held(structure)
    assert np.abs(momentum[held]).min() > 1e-3 * np.abs(momentum).max()
    assert np.abs(momentum[~held]).max() < 1e-13 * np.abs(momentum).max()


def test_lumped_mass_is_diagonal_about_the_common_centre() -> None:
    """Requirement: body and attached nodes have a constant diagonal mass about their common centre."""
    model = pivot(crossing_ratio=0.3, centre_offset=(0.01, 0.02))
    structure, body = about_mass_centre(structure_of(model))
    diagonal = np.diag(body.diagonal(structure))

    def error(shift: float = 0.0) -> float:
        about = Structure(model, body.centre + shift * LENGTH)
        y = np.random.default_rng(7).standard_normal(about.size)
        gap = mass_matrix(about, y, "lumped").sparse().toarray() - diagonal
        return float(np.abs(gap).max() / diagonal.max())

    hold("fe_lumped_mass_diagonal", error)


@WAYS
def test_books_of_a_driven_motion(way: tuple[float | None, float | None]) -> None:
    """Requirement: drives of rotation and centre that begin and end balance with the energies, the led body's
    own off the led point among them."""

    def error(step: float = 5e-7) -> float:
        drive = DrivenRotation(angle=0.02, history=((3.3e-5, 0.0), (7.7e-5, 1.0)), held=(3.3e-5, 1.2e-4))
        motion = solve_motion(
            led_off_its_mass(way), start=0.0, drive=drive, duration=2e-4, step=step, samples=10, check=False
        )
        assert motion.work.max() > 0.1 * motion.kinetic_energy.max() > 0.0
        return motion.energy_error

    hold("fe_drive_books", error)
