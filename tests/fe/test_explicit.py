"""The explicit scheme: its forces and masses, its stability limit, and free flight."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigh

from fe_reference import ELEMENTS, FREE, Body, ConvergenceError, Model, Status, solve_release
from fe_reference.loads import drive_spans
from fe_reference.mass import about_mass_centre, carried_over, lumped_nodes, mass_matrix
from fe_reference.motion import Samples, course
from fe_reference.schemes import Explicit, critical_step
from fe_reference.statics import settled_state
from fe_reference.structure import Structure, structure_of
from tests.fe.cases import LENGTH, cantilever, pivot
from tests.fe.test_gradients import far_state
from tests.gates import hold

QUARTER = np.pi / 2.0


def test_lumped_mass_is_diagonal_about_the_common_centre() -> None:
    """Body and attached nodes have a constant diagonal mass about their common centre, at any rotation."""
    model = pivot(crossing_ratio=0.3, centre_offset=(0.01, 0.02))
    structure, body = about_mass_centre(structure_of(model))
    diagonal = np.diag(body.diagonal(structure))

    def error(shift: float = 0.0) -> float:
        about = Structure(model, body.centre + shift * LENGTH)
        y = far_state(about)
        return float(
            np.abs(mass_matrix(about, y, "lumped").sparse().toarray() - diagonal).max() / diagonal.max()
        )

    hold("fe_lumped_mass_diagonal", error)


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("body", [(0.2, 0.002), (0.0, 0.0), (1e-5, 1e-9)])
def test_critical_step_is_safe_and_sharp(element: str, body: tuple[float, float]) -> None:
    """The estimate is never above 2 / omega_max of the assembled system, whatever the body, and near it."""
    model = pivot(elements=20, element=element, body_mass=body[0], body_moment_of_inertia=body[1])
    structure, rigid = about_mass_centre(structure_of(model))
    for y in (
        np.zeros(structure.size),
        carried_over(structure_of(model), settled_state(model, QUARTER)[0], structure),
    ):
        mass = np.diag(rigid.diagonal(structure))
        highest = eigh(structure.evaluate(y).tangent.sparse().toarray(), mass, eigvals_only=True)[-1]
        exact, estimate = 2.0 / np.sqrt(highest), critical_step(structure, rigid, y)
        assert estimate <= exact
        assert estimate >= 0.8 * exact
    at_rest = critical_step(structure, rigid, np.zeros(structure.size))
    stiffness = structure.evaluate(np.zeros(structure.size)).tangent.sparse().toarray()
    assert at_rest * 1.1 > 2.0 / np.sqrt(eigh(stiffness, mass, eigvals_only=True)[-1])


def test_explicit_is_stable_and_keeps_its_energy() -> None:
    """At 0.9 of the limit the energy after release from 90 degrees stays; at 1.1 it does not."""

    def error(safety: float = 0.9) -> float:
        motion = solve_release(
            pivot(), start=QUARTER, duration=0.01, samples=200, safety=safety, raise_on_failure=False
        )
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


def free_flight(velocity: float) -> tuple[Explicit, Structure, Samples]:
    """Return the motion of an unclamped strip with a body off its end, thrown, turning and vibrating."""
    body = Body(centre=np.array([1.2 * LENGTH, 0.1 * LENGTH]), mass=0.01, moment_of_inertia=1e-5)
    clamped = cantilever(elements=8)
    model = Model(strips=(replace(clamped.strips[0], root=FREE),), bodies=(body,))
    structure, rigid = about_mass_centre(structure_of(model))
    scheme, y = Explicit(structure, rigid), np.zeros(structure.size)
    v = velocity * np.random.default_rng(3).standard_normal(structure.size)
    v[2::3] = 20.0 * velocity
    step = 0.5 * critical_step(structure, rigid, y)
    spans = drive_spans(model, None, 4000 * step)
    return scheme, structure, course(lambda led: scheme, spans, y, v, step, [200] * 20)


def test_free_flight_conserves_momentum() -> None:
    """A free strip with a body keeps linear and angular momentum to round-off while it bends strongly."""

    def error(drift: float = 0.0) -> float:
        scheme, structure, motion = free_flight(5.0)
        masses = scheme.mass.reshape(-1, 3)
        rest = np.vstack([structure.model.strips[0].nodes[:-1], structure.points])
        assert motion.message == ""
        assert np.array(motion.energy)[:, 1].max() > 0.01 * motion.energy[0][0]
        momenta = []
        for time, y, v in zip(motion.time, motion.y, motion.v, strict=True):
            (u, rate), place = (y.reshape(-1, 3), v.reshape(-1, 3)), rest + y.reshape(-1, 3)[:, :2]
            linear = masses[:, :2] * (rate[:, :2] + drift * time * u[:, :2])
            spin = place[:, 0] * linear[:, 1] - place[:, 1] * linear[:, 0] + masses[:, 2] * rate[:, 2]
            momenta.append([*linear.sum(axis=0), spin.sum() / LENGTH])
        values = np.array(momenta)
        return float(np.abs(values - values[0]).max() / np.abs(values[0]).max())

    hold("fe_free_flight_momentum", error)


def test_mass_of_the_strips_is_complete() -> None:
    """The lumped masses of all nodes add up to the mass of the strips."""
    structure = structure_of(pivot())
    assert lumped_nodes(structure)[:, 0].sum() == pytest.approx(2.0 * 7800.0 * 5e-5 * LENGTH, rel=1e-14)
