"""Drives of a motion: a body that is caught off its mass, and the books of what leads it."""

from fe_reference import DrivenRotation, Model, solve_motion
from tests.fe.cases import pivot
from tests.gates import hold


def led_off_its_mass(elements: int = 3) -> Model:
    """Return the pivot with a body whose centre, far from the strips' ends, is led on and back."""
    history = ((0.0, 0.0), (1.03e-4, 1.0), (1.61e-4, 0.5))
    led = {"displacement": (2e-4, -1e-4), "history": history}
    names = ("bending", "stretching", "strip_inertia", "body_inertia", "driven_displacement")
    given = {"effects": names, "parameters": {"driven_displacement": led}}
    return pivot(elements=elements, centre_offset=(0.03, 0.02), body_mass=0.02, **given)


def test_books_of_a_driven_motion() -> None:
    """Requirement: drives of rotation and centre that begin and end balance with the energies, the led body's
    own off the led point among them."""

    def error(step: float = 5e-7) -> float:
        drive = DrivenRotation(angle=0.02, history=((3.3e-5, 0.0), (7.7e-5, 1.0)), held=(3.3e-5, 1.2e-4))
        motion = solve_motion(
            led_off_its_mass(), start=0.0, drive=drive, duration=2e-4, step=step, samples=10, check=False
        )
        assert motion.work.max() > 0.1 * motion.kinetic_energy.max() > 0.0
        return motion.energy_error

    hold("fe_drive_books", error)
