"""Motion with effects: closed forms, balance of energies, the stable step with dampers, massless strips."""

from typing import Any

import numpy as np
import pytest

from fe_reference import (
    ELEMENTS,
    BodyDesign,
    StripDesign,
    compliant_mechanism,
    natural_frequencies,
    solve_motion,
)
from tests.fe.cases import EI
from tests.fe.scenes import (
    GUIDE,
    PARAMETERS,
    SECTION,
    SIDED_SCENE,
    THICK,
    decay_and_frequency,
    four_bar,
    free_cantilever,
)
from tests.gates import hold

EXPLICIT, IMPLICIT = "central-difference", "generalised-alpha"
#: A force that bends the cantilever by a millionth of its length, let go within the first step.
PLUCK = {"strip": "strip", "force": (0.0, 3e-6 * EI / GUIDE**2), "history": ((0.0, 1.0), (1e-9, 0.0))}


def plucked(name: str, key: str, ratio: float) -> tuple[float, float]:
    """Return damping ratio and frequency over omega that the first mode of a plucked cantilever shows.

    Args:
        name: of the damper. key: of its one coefficient, which is chosen for the damping ratio `ratio`.
    """
    bare = free_cantilever(elements=12)
    modes = natural_frequencies(bare, rotation=None, count=1, mass="lumped")
    omega, steps = 2.0 * np.pi * modes.frequency[0], 500
    given = {key: 2.0 * ratio / omega if name == "strip_damping" else 2.0 * ratio * omega}
    motion = solve_motion(
        free_cantilever(elements=12, parameters={name: given, "tip_force": PLUCK}),
        duration=8.0 / modes.frequency[0],
        step=1.0 / (steps * modes.frequency[0]),
        samples=8 * steps,
        integrator=IMPLICIT,
    )
    # the share of the first mode alone: the others are orthogonal to it in the equal masses of the nodes
    masses = np.ones(13)
    masses[[0, -1]] = 0.5
    share = (motion.shape[:, 0, :, 1] - motion.shape[0, 0, 0, 1]) @ (masses * modes.shapes[0, 0, :, 1])
    rate, frequency = decay_and_frequency(share[:: steps // 10], 0.1 / modes.frequency[0])
    return rate / omega, frequency / omega


@pytest.mark.slow
@pytest.mark.parametrize("name", ["strip_damping", "strip_drag"])
def test_damping_ratio_of_a_cantilever(name: str) -> None:
    """The first mode decays with beta omega / 2 of the material, or alpha / (2 omega) of the drag."""
    key = {"strip_damping": "relaxation_time", "strip_drag": "rate"}[name]

    def error(ratio: float = 0.03) -> float:
        shown, frequency = plucked(name, key, ratio)
        seen.append(frequency)
        return abs(shown / 0.03 - 1.0)

    seen: list[float] = []
    hold(f"fe_{name}_ratio", error)
    hold("fe_damped_frequency", lambda ratio=0.03: abs(seen[0] / np.sqrt(1.0 - ratio**2) - 1.0))


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
        model = compliant_mechanism(
            strips=[
                StripDesign(
                    name="strip", start=(0.0, 0.0), end=(GUIDE, 0.0), root=None, tip="body", **SECTION
                )
            ],
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


@pytest.mark.slow
@pytest.mark.parametrize("element", ELEMENTS)
def test_integrators_agree_on_a_scene(element: str) -> None:
    """Both integrators follow the same motion of a mechanism with every effect."""

    def error(step: float = 1e-6) -> float:
        model = four_bar(PARAMETERS, elements=5, element=element)
        settings: dict[str, Any] = {"body": "crank", "start": 0.5, "duration": 1e-3, "samples": 50}
        explicit = solve_motion(model, **settings, step=1e-8)
        implicit = solve_motion(model, **settings, step=step, integrator=IMPLICIT)
        return float(
            max(np.abs(explicit.bodies[name] - implicit.bodies[name])[:, 2].max() for name in explicit.bodies)
        )

    hold("fe_scene_integrators_agree", error)


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
