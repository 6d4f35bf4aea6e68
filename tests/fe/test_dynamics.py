"""Motion after release: explicit against its stability limit, the implicit scheme, and modes."""

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.optimize import minimize_scalar

from fe_reference.attachments import FREE
from fe_reference.compiled import CompiledForces
from fe_reference.dynamics import Trajectory, solve_release
from fe_reference.errors import ConvergenceError, InvalidParameter
from fe_reference.explicit import Explicit, critical_step
from fe_reference.mass import about_mass_centre, carried_over, lumped_diagonal, lumped_nodes, mass_matrix
from fe_reference.model import ELEMENTS, Body, Model
from fe_reference.modes import natural_frequencies
from fe_reference.motion import Samples
from fe_reference.solution import Status
from fe_reference.statics import static_state
from fe_reference.structure import Structure
from tests.fe.cases import LENGTH, cantilever, hold, observed_order, pivot
from tests.fe.test_gradients import far_state

QUARTER = np.pi / 2.0


@cache
def release(duration: float, integrator: str = "central-difference", **settings: Any) -> Trajectory:
    return solve_release(
        pivot(), start=QUARTER, duration=duration, integrator=integrator, samples=200, **settings
    )


@pytest.mark.parametrize("element", ELEMENTS)
def test_compiled_force_is_the_assembled_one(element: str) -> None:
    """The compiled loop gives the force and energy that scikit-fem assembles, far from rest."""
    structure, _ = about_mass_centre(pivot(elements=6, element=element, crossing_ratio=0.4).structure)
    y = far_state(structure)

    def error(move: float = 0.0) -> float:
        compiled, energy = CompiledForces(structure).forces(y + move * LENGTH)
        assembled = structure.internal_force(y)
        gap = np.abs(compiled - assembled).max() / np.abs(assembled).max()
        return float(max(gap, abs(energy / sum(structure.energies(y)) - 1.0)))

    hold("fe_compiled_force", error)


def test_lumped_mass_is_diagonal_about_the_common_centre() -> None:
    """Body and attached nodes have a constant diagonal mass about their common centre, at any rotation."""
    model = pivot(crossing_ratio=0.3, centre_offset=(0.01, 0.02))
    structure, body = about_mass_centre(model.structure)
    diagonal = np.diag(lumped_diagonal(structure, body))

    def error(shift: float = 0.0) -> float:
        about = Structure(model, body.centre + shift * LENGTH)
        y = far_state(about)
        return float(np.abs(mass_matrix(about, y, "lumped").toarray() - diagonal).max() / diagonal.max())

    hold("fe_lumped_mass_diagonal", error)


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("body", [(0.2, 0.002), (0.0, 0.0), (1e-5, 1e-9)])
def test_critical_step_is_safe_and_sharp(element: str, body: tuple[float, float]) -> None:
    """The estimate is never above 2 / omega_max of the assembled system, whatever the body, and near it."""
    model = pivot(elements=20, element=element, body_mass=body[0], body_moment_of_inertia=body[1])
    structure, rigid = about_mass_centre(model.structure)
    for y in (
        np.zeros(structure.size),
        carried_over(model.structure, static_state(model, QUARTER), structure),
    ):
        mass = np.diag(lumped_diagonal(structure, rigid))
        highest = eigh(structure.tangent_stiffness(y).toarray(), mass, eigvals_only=True)[-1]
        exact, estimate = 2.0 / np.sqrt(highest), critical_step(structure, rigid, y)
        assert estimate <= exact
        assert estimate >= 0.8 * exact
    at_rest = critical_step(structure, rigid, np.zeros(structure.size))
    assert at_rest * 1.1 > 2.0 / np.sqrt(
        eigh(structure.tangent_stiffness(np.zeros(structure.size)).toarray(), mass, eigvals_only=True)[-1]
    )


def test_explicit_is_stable_and_keeps_its_energy() -> None:
    """At 0.9 of the limit the energy after release from 90 degrees stays; at 1.1 it does not."""

    def error(safety: float = 0.9) -> float:
        motion = release(0.01, safety=safety, raise_on_failure=False)
        return motion.energy_error if motion.status is Status.CONVERGED else np.inf

    hold("fe_explicit_energy", error)


def test_explicit_is_unstable_beyond_the_limit() -> None:
    """At 1.1 of the estimate the motion blows up at once; it is stopped, and says when and what to do."""
    with pytest.raises(
        ConvergenceError, match=r"the energy grew from .* use a smaller time step\."
    ) as failure:
        solve_release(pivot(), start=QUARTER, duration=0.002, safety=1.1)
    motion = failure.value.solution
    assert motion.status is Status.UNSTABLE
    assert np.isfinite(motion.rotation).all()
    assert failure.value.load_factor < 0.5
    sound = solve_release(pivot(), start=QUARTER, duration=0.002, safety=0.9)
    assert sound.status is Status.CONVERGED
    assert sound.time[-1] == pytest.approx(0.002, rel=1e-12)


def test_explicit_and_implicit_agree() -> None:
    """Both integrators follow the same motion over 0.01 s, sampled at the same instants."""

    def error(step: float = 2e-6) -> float:
        implicit = release(0.01, "generalised-alpha", step=step)
        explicit = release(0.01, step=1.25e-7)
        return float(np.abs(implicit.rotation - explicit.rotation).max())

    hold("fe_integrators_agree", error)


@pytest.mark.slow
def test_explicit_and_implicit_agree_over_the_paper_s_duration() -> None:
    """Both integrators follow the same motion over 0.05 s, sampled at the same instants."""

    def error(step: float = 1e-6) -> float:
        explicit = solve_release(pivot(), start=QUARTER, duration=0.05, step=1e-7, samples=500)
        implicit = solve_release(
            pivot(), start=QUARTER, duration=0.05, step=step, integrator="generalised-alpha", samples=500
        )
        return float(np.abs(implicit.rotation - explicit.rotation).max())

    hold("fe_integrators_agree_long", error)


@pytest.mark.parametrize("integrator", ["central-difference", "generalised-alpha"])
def test_order_of_the_integrators(integrator: str) -> None:
    """The rotation over 0.0048 s converges with the second power of the step."""

    def error(step: float = 5e-7) -> float:
        runs = [
            solve_release(
                pivot(elements=6),
                start=QUARTER,
                duration=0.0048,
                step=k * step,
                integrator=integrator,
                samples=50,
                raise_on_failure=False,
            )
            for k in (4, 2, 1)
        ]
        if any(run.status is not Status.CONVERGED for run in runs):
            return np.inf
        return abs(observed_order([run.rotation for run in runs]) - 2.0)

    hold(f"fe_order_{integrator.replace('-', '_')}", error)


def free_flight(velocity: float) -> tuple[Explicit, Structure, Samples]:
    """Return the motion of an unclamped strip with a body off its end, thrown, turning and vibrating."""
    body = Body(centre=np.array([1.2 * LENGTH, 0.1 * LENGTH]), mass=0.01, moment_of_inertia=1e-5)
    clamped = cantilever(elements=8)
    model = Model(strips=(replace(clamped.strips[0], root=FREE),), bodies=(body,))
    structure, rigid = about_mass_centre(model.structure)
    scheme, y = Explicit(structure, rigid), np.zeros(structure.size)
    v = velocity * np.random.default_rng(3).standard_normal(structure.size)
    v[2::3] = 20.0 * velocity
    step = 0.5 * critical_step(structure, rigid, y)
    return scheme, structure, scheme.run(y, v, step, [200] * 20, None)


def test_free_flight_conserves_momentum() -> None:
    """A free strip with a body keeps linear and angular momentum to round-off while it bends strongly."""

    def error(drift: float = 0.0) -> float:
        scheme, structure, motion = free_flight(5.0)
        masses = scheme.mass.reshape(-1, 3)
        rest = np.vstack([structure.model.strips[0].nodes[:-1], structure.points])
        assert motion.message == ""
        assert motion.energies("strain").max() > 0.01 * motion.energy[0].kinetic
        momenta = []
        for time, y, v in zip(motion.time, motion.y, motion.v, strict=True):
            (u, rate), place = (y.reshape(-1, 3), v.reshape(-1, 3)), rest + y.reshape(-1, 3)[:, :2]
            linear = masses[:, :2] * (rate[:, :2] + drift * time * u[:, :2])
            spin = place[:, 0] * linear[:, 1] - place[:, 1] * linear[:, 0] + masses[:, 2] * rate[:, 2]
            momenta.append([*linear.sum(axis=0), spin.sum() / LENGTH])
        values = np.array(momenta)
        return float(np.abs(values - values[0]).max() / np.abs(values[0]).max())

    hold("fe_free_flight_momentum", error)


def test_small_release_swings_at_the_linear_frequency() -> None:
    """Let go from 0.001 rad the pivot swings at the first frequency of the linearised lumped system."""
    linear = natural_frequencies(pivot(), count=1, mass="lumped").frequency[0]

    def error(amplitude: float = 1e-3) -> float:
        motion = solve_release(pivot(), start=amplitude, duration=0.06)

        def misfit(frequency: float) -> float:
            phase = 2.0 * np.pi * frequency * motion.time
            basis = np.column_stack([np.cos(phase), np.sin(phase)])
            return float(np.linalg.lstsq(basis, motion.rotation, rcond=None)[1][0])

        span = (0.98 * linear, 1.02 * linear)
        best = minimize_scalar(misfit, bounds=span, method="bounded", options={"xatol": 1e-9 * linear})
        return float(abs(best.x / linear - 1.0))

    hold("fe_small_release_frequency", error)


@pytest.mark.parametrize("integrator", ["central-difference", "generalised-alpha"])
def test_attachments_hold_exactly(integrator: str) -> None:
    """Clamped ends stay and the plate keeps its length at every instant: constraints are eliminated."""

    def error(stretch: float = 0.0) -> float:
        motion = release(0.001, integrator)
        ends = (1.0 + stretch) * motion.shape[:, :, -1]
        plate = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
        assert np.all(motion.shape[:, :, 0] == motion.shape[0, :, 0])
        return float(
            max(np.abs(plate - 0.06).max(), np.abs(ends.mean(axis=1) - motion.centre).max()) / LENGTH
        )

    hold("fe_attachments", error)


def test_mass_of_the_strips_is_complete() -> None:
    """The lumped masses of all nodes add up to the mass of the strips."""
    structure = pivot().structure
    assert lumped_nodes(structure)[:, 0].sum() == pytest.approx(2.0 * 7800.0 * 5e-5 * LENGTH, rel=1e-14)


def test_reissner_motion_is_sound() -> None:
    """Shear-deformable strips swing with the same integrators: both schemes stay together."""
    settings: dict[str, Any] = {"start": QUARTER, "duration": 0.004, "samples": 200}

    def error(step: float = 2e-6) -> float:
        model = pivot(elements=8, element="reissner")
        explicit = solve_release(model, step=5e-7, **settings)
        implicit = solve_release(model, step=step, integrator="generalised-alpha", **settings)
        return float(np.abs(explicit.rotation - implicit.rotation).max())

    hold("fe_integrators_agree_reissner", error)


def test_run_is_described() -> None:
    """A trajectory carries its step, its limit and its work, and samples as asked, the start first."""
    calls: list[tuple[int, int]] = []
    motion = solve_release(
        pivot(), start=0.5, duration=1e-4, samples=10, progress=lambda *call: calls.append(call)
    )
    assert len(motion.time) == 11 == len(calls) + 1
    assert motion.time[0] == 0.0
    assert motion.rotation[0] == 0.5
    assert motion.kinetic_energy[0] == 0.0
    assert motion.settings["step_s"] <= 0.9 * motion.settings["critical_step_s"]
    assert motion.counters["steps"] * motion.settings["step_s"] == pytest.approx(1e-4, rel=1e-12)
    assert not motion.constraint_residual.any()
    assert not motion.velocity_residual.any()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"start": 0.0}, "start: got 0.0, expected a rotation that is not zero [rad]"),
        ({"duration": 0.0}, "duration: got 0.0, expected a number above 0 [s]"),
        ({"step": -1e-6}, "step: got -1e-06, expected a number above 0 [s]"),
        (
            {"integrator": "euler"},
            "integrator: got 'euler', expected one of central-difference, generalised-alpha",
        ),
        ({"samples": 0}, "samples: got 0, expected an integer of at least 1 [1]"),
        ({"duration": 1e6}, "duration: got 1000000.0, expected at most 1e+09 steps of"),
        ({"duration": 1.0, "samples": 10**7}, "samples: got "),
        ({"integrator": "generalised-alpha", "spectral_radius": 1.5}, "spectral_radius: got 1.5, expected"),
    ],
)
def test_bad_release_is_one_clear_line(arguments: dict[str, Any], message: str) -> None:
    """A release that makes no sense, or would not end or fit in memory, is refused in one line."""
    with pytest.raises(InvalidParameter) as refusal:
        solve_release(pivot(), **{"start": 0.5, "duration": 1e-4, **arguments})
    assert str(refusal.value).startswith(message)
    assert "\n" not in str(refusal.value)


def test_start_out_of_reach_is_refused_with_evidence() -> None:
    """A start that statics does not reach is refused with the static path until there."""
    with pytest.raises(ConvergenceError) as failure:
        solve_release(pivot(elements=8), start=40.0, duration=1e-4, increments=2)
    assert failure.value.load_factor < 1.0


def test_implicit_step_without_solution_ends_the_run() -> None:
    """A step that no halving makes solvable ends the run with the motion until then."""
    motion = solve_release(
        pivot(),
        start=QUARTER,
        duration=10.0,
        step=1.0,
        integrator="generalised-alpha",
        raise_on_failure=False,
    )
    assert motion.status is not Status.CONVERGED
    assert motion.message != ""
    assert len(motion.time) >= 1
