"""Motion and modes: closed forms, balance of energies, drives, masses, steps that are too long."""

from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import fe_reference as fe
from fe_reference.mass import about_mass_centre, mass_matrix
from fe_reference.motion import drive_spans
from fe_reference.structure import Structure, structure_of
from tests.fe.scenes import (
    GUIDE,
    MASSLESS,
    PARAMETERS,
    SIDED_SCENE,
    THICK,
    four_bar,
    free_cantilever,
    pivot,
    tipped,
)
from tests.gates import hold
from tests.models import extrapolated
from tests.table_one import LENGTH, MOMENT, SECTION, TABLE_ONE

QUARTER = np.pi / 2.0


def test_run_is_described() -> None:
    """A trajectory carries its step, its limit and its work, and samples as asked, the start first."""
    calls: list[tuple[int, int]] = []
    motion = fe.solve_motion(
        pivot(), start=0.5, duration=1e-4, samples=10, progress=lambda *call: calls.append(call)
    )
    assert len(motion.time) == 11 == len(calls) + 1
    assert motion.time[0] == 0.0
    assert motion.rotation[0] == 0.5
    assert motion.kinetic_energy[0] == 0.0
    assert motion.settings["step_s"] <= 0.9 * motion.settings["critical_step_s"]
    assert motion.counters["steps"] * motion.settings["step_s"] == pytest.approx(1e-4, rel=1e-12)


def test_implicit_step_without_solution_ends_the_run() -> None:
    """A step that no halving makes solvable ends the run with the motion until then."""
    how: dict[str, Any] = {"integrator": "generalised-alpha", "raise_on_failure": False}
    motion = fe.solve_motion(pivot(), start=QUARTER, duration=10.0, step=1.0, **how)
    assert motion.status is not fe.Status.CONVERGED
    assert motion.message != ""
    assert len(motion.time) >= 1


def test_an_implicit_step_that_is_too_long_is_told() -> None:
    """A step of 1 ms on a swing whose strips follow within it: halved where it gains energy, and told."""
    settings = {"start": 1.0, "duration": 0.02, "integrator": "generalised-alpha", "check": False}
    motion = fe.solve_motion(pivot(elements=10), **settings, step=1e-3)
    assert motion.counters["halvings"] > 0
    assert motion.energy_error < 0.01
    assert "steps in a mean period" in motion.resolution
    sound = fe.solve_motion(pivot(elements=10), **settings, step=1e-4)
    assert motion.rotation[-1] == pytest.approx(sound.rotation[-1], abs=0.05)
    assert sound.resolution == ""
    assert list(sound.columns())[:4] == ["time_s", "x_m", "y_m", "rotation_rad"]


def test_explicit_is_stable_and_keeps_its_energy() -> None:
    """At 0.9 of the limit the energy after release from 90 degrees stays; at 1.1 it does not."""

    brief = fe.solve_motion(pivot(), start=QUARTER, duration=1e-5, check=False)
    limit = float(brief.settings["critical_step_s"])

    def error(safety: float = 0.9) -> float:
        motion = fe.solve_motion(
            pivot(), start=QUARTER, duration=0.01, samples=200, step=safety * limit, raise_on_failure=False
        )
        return motion.energy_error if motion.status is fe.Status.CONVERGED else np.inf

    hold("fe_explicit_energy", error)
    with pytest.raises(
        fe.ConvergenceError, match=r"the energy grew from .* use a smaller time step"
    ) as failure:
        fe.solve_motion(pivot(), start=QUARTER, duration=0.002, step=1.1 * limit)
    assert failure.value.solution.status is fe.Status.UNSTABLE


EXPLICIT, IMPLICIT = "central-difference", "generalised-alpha"


@pytest.mark.parametrize("integrator", [EXPLICIT, pytest.param(IMPLICIT, marks=pytest.mark.slow)])
def test_free_fall_against_drag(integrator: str) -> None:
    """A free strip that falls against drag follows g/a^2 (a t - 1 + exp(-a t)) and does not bend."""
    gravity, rate, duration = 9.81, 300.0, 5e-3
    given = {"gravity": {"acceleration": (0.0, -gravity)}, "strip_drag": {"rate": rate}}
    exact = gravity / rate**2 * (rate * duration - 1.0 + np.exp(-rate * duration))

    def error(step: float = 1e-6) -> float:
        model = free_cantilever(length=1.0, parameters=given, root=None, elements=4)
        motion = fe.solve_motion(model, settled=False, duration=duration, step=step, integrator=integrator)
        fallen = -motion.shape[-1, 0, :, 1]
        return float(np.abs(fallen / exact - 1.0).max())

    hold(f"fe_free_fall_{integrator.replace('-', '_')}", error)


def test_impulse_of_a_load() -> None:
    """The momentum of a free strip with a body is the integral of the force on it, whatever its history."""
    history = ((0.0, 0.0), (1e-4, 1.0), (3e-4, -0.5), (4e-4, 0.0))
    force = {"force": (30.0, -20.0), "history": history}

    def error(step: float = 1e-6) -> float:
        body = fe.BodyDesign(centre=(1.2 * GUIDE, 0.01), mass=0.01, moment_of_inertia=1e-5)
        model = tipped(body, strip={"root": None}, elements=5, applied_force=force)
        motion = fe.solve_motion(model, duration=2e-3, step=step, samples=4, settled=False, check=False)
        masses = SECTION["area"] * SECTION["density"] * GUIDE / 5.0 * np.array([0.5, 1.0, 1.0, 1.0, 1.0, 0.5])
        moments = masses @ motion.shape[:, 0] + 0.01 * motion.bodies["body"][:, :2]
        momentum = (moments[-1] - moments[1]) / (motion.time[-1] - motion.time[1])  # behind the force
        times, factors = np.transpose(history)
        impulse = np.trapezoid(factors, times) * np.array(force["force"])
        return float(np.abs(momentum / impulse - 1.0).max())

    hold("fe_impulse", error)


@pytest.mark.parametrize("wide", [False, True], ids=["every", "sides"])
@pytest.mark.parametrize("element", fe.ELEMENTS)
def test_motion_balance(element: str, wide: bool) -> None:
    """With every effect the energies balance with work and dissipation in the explicit integrator, those of
    wide strips and their roots in place of the natural strains."""
    parameters, section = (SIDED_SCENE, THICK) if wide else (PARAMETERS, SECTION)

    def error(integrator: str = EXPLICIT, step: float | None = None) -> float:
        model = four_bar(parameters, section=section, elements=5, element=element)
        how = {"integrator": integrator, "step": step, "samples": 100, "check": False}
        motion = fe.solve_motion(model, body="crank", start=0.5, duration=2e-3, **how)
        assert motion.dissipated[-1] > 0.05 * motion.strain_energy[0]
        assert np.abs(motion.work).max() > 0.02 * motion.strain_energy[0]
        return motion.energy_error

    hold(f"fe_motion_balance_{element}", error)


def test_start_from_rest_and_settled() -> None:
    """Under gravity a scene starts in equilibrium and stays there, or starts at rest and falls."""
    gravity = {"gravity": {"acceleration": (0.0, -200.0)}}
    model = four_bar(gravity, elements=4)
    still = fe.solve_motion(model, duration=1e-4)
    assert still.kinetic_energy.max() < 1e-12 * abs(still.gravity_energy[0])
    falling = fe.solve_motion(model, duration=1e-4, settled=False)
    assert falling.kinetic_energy[-1] > 0.0
    assert falling.gravity_energy[-1] < 0.0
    assert falling.bodies["crank"].shape == falling.rates["crank"].shape == (len(falling.time), 3)


def test_rates_are_the_derivatives_of_the_places() -> None:
    """The reported rates of the bodies are the slopes of their motion."""

    def error(samples: int = 400) -> float:
        motion = fe.solve_motion(
            four_bar(elements=4), body="crank", start=0.5, duration=1e-4, samples=samples
        )
        places, rates = (np.array(list(each.values())) for each in (motion.bodies, motion.rates))
        slopes = np.gradient(places, motion.time, axis=1, edge_order=2)
        apart = np.abs(slopes - rates).max(axis=(1, 2)) / np.abs(rates).max(axis=(1, 2))
        return float(apart.max())

    hold("fe_rates", error)


#: Displacements that a centre is led to: both ways, or one.
WAYS = pytest.mark.parametrize("way", [(2e-4, -1e-4), (2e-4, None), (None, -1e-4)])


def led_off_its_mass(way: tuple[float | None, float | None], elements: int = 3) -> fe.Model:
    """Return the pivot with a body whose centre, far from the strips' ends, is led on and back."""
    history = ((0.0, 0.0), (1.03e-4, 1.0), (1.61e-4, 0.5))
    led = {"displacement": way, "history": history}
    names = ("bending", "stretching", "strip_inertia", "body_inertia", "driven_displacement")
    given = {"effects": names, "parameters": {"driven_displacement": led}}
    return pivot(elements=elements, centre_offset=(0.03, 0.02), body_mass=0.02, **given)


@WAYS
@pytest.mark.parametrize("drive", [None, fe.DrivenRotation(angle=0.1, history=((0.0, 0.0), (1e-4, 1.0)))])
def test_a_catch_gives_momentum_to_what_is_led_alone(
    way: tuple[float | None, float | None], drive: fe.DrivenRotation | None
) -> None:
    """Requirement: impulses act on led coordinates alone, though a body's mass is off the led point."""
    model = led_off_its_mass(way)
    (span, *_), own = drive_spans(model, drive, 1e-3), structure_of(model)
    structure, _ = about_mass_centre(own, span.led)
    y, v = 1e-2 * np.random.default_rng(5).standard_normal((2, structure.size))
    y[structure.turns] = 1.1
    change = span.caught(structure, y, v) - v
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
        drive = fe.DrivenRotation(angle=0.02, history=((3.3e-5, 0.0), (7.7e-5, 1.0)), held=(3.3e-5, 1.2e-4))
        motion = fe.solve_motion(
            led_off_its_mass(way), start=0.0, drive=drive, duration=2e-4, step=step, samples=10, check=False
        )
        assert motion.work.max() > 0.1 * motion.kinetic_energy.max() > 0.0
        return motion.energy_error

    hold("fe_drive_books", error)


def relative(value: np.ndarray, exact: np.ndarray) -> float:
    return float(np.abs(value / exact - 1.0).max())


@pytest.mark.parametrize("element", fe.ELEMENTS)
def test_both_masses_extrapolate_to_the_same_frequencies(element: str) -> None:
    """At rest and at 60 degrees the frequencies do not depend on how the mass is put on the mesh."""

    def limit(rotation: float, mass: str, elements: tuple[int, ...]) -> Any:
        how: dict[str, Any] = {"rotation": rotation, "count": 5, "mass": mass, "increments": 5}
        meshes = [pivot(elements=n, element=element) for n in elements]
        return extrapolated([fe.natural_frequencies(mesh, **how).frequency for mesh in meshes])

    def error(elements: tuple[int, ...] = (20, 40, 80)) -> float:
        pairs = [
            [limit(rotation, mass, elements) for mass in ("consistent", "lumped")]
            for rotation in (0.0, np.pi / 3.0)
        ]
        return max(relative(*pair) for pair in pairs)

    hold(f"fe_frequencies_by_mass_{element}", error)


def test_holding_the_rotation_interlaces_the_frequencies() -> None:
    """With the rotation held each frequency lies between two of the released pivot."""
    model = pivot(elements=10)
    free = fe.natural_frequencies(model, rotation=1.0, count=6)
    held = fe.natural_frequencies(model, rotation=1.0, count=5, held=True)
    assert np.all(held.frequency >= free.frequency[:5])
    assert np.all(held.frequency <= free.frequency[1:])
    assert np.all(held.bodies["body"][:, 2] == 0.0)


def test_small_meshes_give_all_their_modes() -> None:
    """A mesh too small for the sparse solver is solved densely, and has no more modes than coordinates."""
    model = pivot(elements=2)
    many = fe.natural_frequencies(model, count=9)
    few = fe.natural_frequencies(model, count=3)
    assert many.frequency.shape == (9,)
    assert few.frequency == pytest.approx(many.frequency[:3], rel=1e-9)
    assert fe.natural_frequencies(model, count=10).frequency == pytest.approx(many.frequency, rel=1e-9)
    assert fe.natural_frequencies(model, count=10, accuracy=0.1).frequency.shape == (9,)


#: A thick section, so that its rotary inertia is felt; stretching is put out of the way at the same rho A.
STOUT = SECTION | {"second_moment_of_area": SECTION["area"] * (0.02 * GUIDE) ** 2}


def rayleigh_frequency() -> float:
    """Return the second frequency [Hz] of a cantilever with rotary inertia.

    EI w'''' + rho I W^2 w'' - mu W^2 w = 0, clamped at 0; w'' = 0 and EI w''' + rho I W^2 w' = 0 at L. With
    w = exp(k s) this has the roots k = +-a and k = +-i b.
    """
    ei = STOUT["youngs_modulus"] * STOUT["second_moment_of_area"]
    mu, rotary = STOUT["density"] * STOUT["area"], STOUT["density"] * STOUT["second_moment_of_area"]

    def condition(omega: float) -> float:
        half, all_of = 0.5 * rotary * omega**2 / ei, mu * omega**2 / ei
        root = np.sqrt(half**2 + all_of)
        a, b = np.sqrt(root - half), np.sqrt(root + half)
        ch, sh, c, s = np.cosh(a * GUIDE), np.sinh(a * GUIDE), np.cos(b * GUIDE), np.sin(b * GUIDE)
        # w = A (cosh - cos) + B (sinh - a/b sin) satisfies the clamp
        moment = [a**2 * ch + b**2 * c, a**2 * sh + a * b * s]
        slope = [a * sh + b * s, a * ch - a * c]
        third = [a**3 * sh - b**3 * s, a**3 * ch + a * b**2 * c]
        shear = [p + 2.0 * half * q for p, q in zip(third, slope, strict=True)]
        return float((moment[0] * shear[1] - moment[1] * shear[0]) / (ch * ch))

    unit = np.sqrt(ei / mu) / GUIDE**2
    return float(brentq(condition, 18.0 * unit, 24.0 * unit, xtol=1e-9)) / (2.0 * np.pi)


def test_section_rotary_inertia() -> None:
    """Consistent and lumped masses with rotary inertia tend to the Rayleigh beam, without it they do not."""
    exact = rayleigh_frequency()

    def error(effects: tuple[str, ...] = ("section_rotary_inertia",)) -> float:
        names, worst = (*fe.DEFAULT_EFFECTS, *effects), 0.0
        meshes = [free_cantilever(section=STOUT, elements=n, effects=names) for n in (20, 40, 80)]
        for mass in ("consistent", "lumped"):
            how: dict[str, Any] = {"rotation": None, "count": 2, "mass": mass}
            seen = [fe.natural_frequencies(mesh, **how).frequency[1] for mesh in meshes]
            worst = max(worst, abs(float(extrapolated(seen)) / exact - 1.0))
        return float(worst)

    hold("fe_rayleigh_beam", error)


def test_body_on_massless_strips() -> None:
    """Bodies on strips without inertia have their own modes only, at the closed-form frequency."""
    inertia = TABLE_ONE["body_moment_of_inertia"] + TABLE_ONE["body_mass"] * 0.03**2
    exact = np.sqrt(2.0 * MOMENT / inertia) / (2.0 * np.pi)

    def error(area: float = 1e3) -> float:
        model = pivot(effects=MASSLESS, area=area * TABLE_ONE["area"])
        return abs(fe.natural_frequencies(model, count=1).frequency[0] / exact - 1.0)

    hold("fe_massless_strips", error)
    assert len(fe.natural_frequencies(pivot(effects=MASSLESS), count=4).frequency) == 3
