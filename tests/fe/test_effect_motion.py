"""Motion with effects: closed forms, balance of energies, the stable step with dampers, massless strips."""

import numpy as np
import pytest

from fe_reference import ELEMENTS, BodyDesign, StripDesign, compliant_mechanism, solve_motion
from tests.fe.scenes import GUIDE, PARAMETERS, SECTION, SIDED_SCENE, THICK, four_bar, free_cantilever
from tests.gates import hold

EXPLICIT, IMPLICIT = "central-difference", "generalised-alpha"


@pytest.mark.parametrize("integrator", [EXPLICIT, pytest.param(IMPLICIT, marks=pytest.mark.slow)])
def test_free_fall_against_drag(integrator: str) -> None:
    """A free strip that falls against drag follows g/a^2 (a t - 1 + exp(-a t)) and does not bend."""
    gravity, rate, duration = 9.81, 300.0, 5e-3
    given = {"gravity": {"acceleration": (0.0, -gravity)}, "strip_drag": {"rate": rate}}
    exact = gravity / rate**2 * (rate * duration - 1.0 + np.exp(-rate * duration))

    def error(step: float = 1e-6) -> float:
        model = free_cantilever(length=1.0, parameters=given, root=None, elements=4)
        motion = solve_motion(model, settled=False, duration=duration, step=step, integrator=integrator)
        fallen = -motion.shape[-1, 0, :, 1]
        return float(np.abs(fallen / exact - 1.0).max())

    hold(f"fe_free_fall_{integrator.replace('-', '_')}", error)


def test_impulse_of_a_load() -> None:
    """The momentum of a free strip with a body is the integral of the force on it, whatever its history."""
    history = ((0.0, 0.0), (1e-4, 1.0), (3e-4, -0.5), (4e-4, 0.0))
    force = {"force": (30.0, -20.0), "history": history}

    def error(step: float = 1e-6) -> float:
        ends = {"start": (0.0, 0.0), "end": (GUIDE, 0.0), "root": None, "tip": "body"}
        model = compliant_mechanism(
            strips=[StripDesign(name="strip", **ends, **SECTION)],
            bodies=[BodyDesign(name="body", centre=(1.2 * GUIDE, 0.01), mass=0.01, moment_of_inertia=1e-5)],
            effects=("bending", "stretching", "strip_inertia", "body_inertia", "applied_force"),
            parameters={"applied_force": force},
            elements=5,
        )
        motion = solve_motion(model, duration=2e-3, step=step, samples=4, settled=False, check=False)
        masses = SECTION["area"] * SECTION["density"] * GUIDE / 5.0 * np.array([0.5, 1.0, 1.0, 1.0, 1.0, 0.5])
        moments = masses @ motion.shape[:, 0] + 0.01 * motion.bodies["body"][:, :2]
        momentum = (moments[-1] - moments[1]) / (motion.time[-1] - motion.time[1])  # behind the force
        times, factors = np.transpose(history)
        impulse = np.trapezoid(factors, times) * np.array(force["force"])
        return float(np.abs(momentum / impulse - 1.0).max())

    hold("fe_impulse", error)


@pytest.mark.parametrize("wide", [False, True], ids=["every", "sides"])
@pytest.mark.parametrize("element", ELEMENTS)
def test_motion_balance(element: str, wide: bool) -> None:
    """With every effect the energies balance with work and dissipation in the explicit integrator, those of
    wide strips and their roots in place of the natural strains."""
    parameters, section = (SIDED_SCENE, THICK) if wide else (PARAMETERS, SECTION)

    def error(integrator: str = EXPLICIT, step: float | None = None) -> float:
        model = four_bar(parameters, section=section, elements=5, element=element)
        motion = solve_motion(
            model, body="crank", start=0.5, duration=2e-3, integrator=integrator, step=step, samples=100
        )
        assert motion.dissipated[-1] > 0.05 * motion.strain_energy[0]
        assert np.abs(motion.work).max() > 0.02 * motion.strain_energy[0]
        return motion.energy_error

    hold(f"fe_motion_balance_{element}", error)


def test_start_from_rest_and_settled() -> None:
    """Under gravity a scene starts in equilibrium and stays there, or starts at rest and falls."""
    gravity = {"gravity": {"acceleration": (0.0, -200.0)}}
    model = four_bar(gravity, elements=4)
    still = solve_motion(model, duration=1e-4)
    assert still.kinetic_energy.max() < 1e-12 * abs(still.gravity_energy[0])
    falling = solve_motion(model, duration=1e-4, settled=False)
    assert falling.kinetic_energy[-1] > 0.0
    assert falling.gravity_energy[-1] < 0.0
    assert falling.effects[-1] == "gravity"
    assert falling.bodies["crank"].shape == falling.rates["crank"].shape == (len(falling.time), 3)


def test_rates_are_the_derivatives_of_the_places() -> None:
    """The reported rates of the bodies are the slopes of their motion."""

    def error(samples: int = 400) -> float:
        motion = solve_motion(four_bar(elements=4), body="crank", start=0.5, duration=1e-4, samples=samples)
        places, rates = (np.array(list(each.values())) for each in (motion.bodies, motion.rates))
        slopes = np.gradient(places, motion.time, axis=1, edge_order=2)
        apart = np.abs(slopes - rates).max(axis=(1, 2)) / np.abs(rates).max(axis=(1, 2))
        return float(apart.max())

    hold("fe_rates", error)
