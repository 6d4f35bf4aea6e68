"""Roots that turn: a rotational spring at each clamped end."""

from dataclasses import replace

import numpy as np
import pytest

from spline_model import (
    DEFAULT_EFFECTS,
    compliant_mechanism,
    cross_axis_pivot,
    natural_frequencies,
    solve_many,
    solve_mechanism,
    solve_motion,
    solve_statics,
)
from spline_model.compile import compile_scene
from spline_model.design import NOT_GIVEN
from spline_model.reduced.model import at_rest, reduced
from spline_model.reduced.states import whole_tangents
from tests import gates
from tests.spline.swings import drift
from tests.table_one import SIDES, SIX, TABLE_ONE

ROOTS = (*DEFAULT_EFFECTS, "root_compliance")
GIVEN = {"root_compliance": {"root": "monolithic"}}


def rooted(root="monolithic", **changed):
    """Table 1 with roots of that length over the thickness."""
    given = {"effects": ROOTS, "parameters": {"root_compliance": {"root": root}}}
    return cross_axis_pivot(**SIX | SIDES | given | changed)


SPATIAL = {"measure": "spatial", "stretch": "consistent"}


@pytest.mark.parametrize("grid", [{}, SPATIAL], ids=["material", "spatial"])
def test_tangent_is_the_gradients_derivative(grid):
    """The tangent of strips whose roots turn is the derivative of their gradient, off equilibrium as well.

    In equilibrium the force that turns with a root is none along the stretch of its clamp, and not felt.
    """
    model = reduced(compile_scene(rooted(**grid).driven(1.5)))
    y = at_rest(model)[None] + 0.05 * np.random.default_rng(0).standard_normal((1, model.size))
    step = 1e-6 * np.eye(model.size)
    there, back = (whole_tangents(model, y + sign * step)[0] for sign in (1.0, -1.0))
    tangent = whole_tangents(model, y)[1][0]
    assert np.abs((there - back) / 2e-6 - tangent).max() < 1e-7 * np.abs(tangent).max()


def test_work_is_the_energy_of_strips_and_roots():
    """Over a quarter turn the energy of strips and roots is the work of the drive, and roots soften."""

    def error(increments=20):
        path = solve_statics(rooted(), rotation=np.pi / 2, increments=increments)
        assert path.inertia.max() == 0
        return np.abs(path.bending_energy + path.axial_energy - path.work).max() / path.work[-1]

    gates.hold("spline_root_work", error)


def test_roots_of_no_length_are_none():
    """A root of no length is a clamp: the same scene, to the last digit."""
    none, plain = (
        solve_statics(pivot, rotation=1.0, increments=4)
        for pivot in (rooted(0.0), rooted(effects=DEFAULT_EFFECTS, parameters=None))
    )
    assert np.array_equal(none.torque, plain.torque)


def test_modes_know_the_roots():
    """The swing of a heavy body at rest goes with the root of its stiffness, and so with its roots."""
    swing = [
        natural_frequencies(rooted(root, body_moment_of_inertia=10.0)).frequency[0] for root in (0.0, 0.416)
    ]
    series = 1.0 + 2.0 * 0.416 * SIDES["thickness"] / TABLE_ONE["length"]
    assert (swing[0] / swing[1]) ** 2 == pytest.approx(series, rel=1e-6)


def test_a_batch_scales_the_roots():
    """Designs of other sides, moduli and lengths of strip have their own roots in a batch, stress too."""

    def error(root="monolithic"):
        changed = {"thickness": 0.004, "width": 0.012, "youngs_modulus": 1.1e11}
        sides = dict.fromkeys(("area", "second_moment_of_area"), NOT_GIVEN)
        given = {name: [value] for name, value in changed.items()} | {"strip_1.end_y": [0.061]}
        found = solve_many(rooted(root, **sides), given, rotation=1.2, increments=4, section_depth=0.004)
        one, other = rooted(**sides | changed).design.strips
        strips = [replace(one, end=(one.end[0], 0.061)), other]
        made = compliant_mechanism(
            strips=strips, bodies=rooted().design.bodies, effects=ROOTS, parameters=GIVEN, control_points=6
        )
        path = solve_mechanism(made, rotation=1.2, increments=4)
        stress = np.abs(path.axial_force) / one.area
        stress += np.abs(path.bending_moment) * 0.002 / one.second_moment_of_area
        apart = [
            np.abs(found.torque[0] - path.torque).max() / path.torque.max(),
            np.abs(found.stiffness[0] / path.stiffness - 1.0).max(),
            np.abs(found.strain[0] * one.youngs_modulus - stress.max(axis=(1, 2))).max() / stress.max(),
        ]
        return max(apart)

    gates.hold("spline_batch_roots", error)


def turned(integrator, **given):
    """The run of half a millisecond after a release from 1 rad."""
    run = solve_motion(
        rooted(**given), start=1.0, duration=5e-4, integrator=integrator, step=1e-6, check=False
    )
    assert run.status.value == "converged", run.message
    return run


def test_every_scheme_turns_the_roots_alike():
    """The integrators agree within their steps, none loses energy, and clamped ends keep their places."""
    found = {name: turned(name) for name in ("energy", "leapfrog")}
    for name, run in found.items():
        assert run.rotation[-1] == pytest.approx(found["leapfrog"].rotation[-1], abs=2e-7), name
        assert drift(run) < (1e-10 if name == "energy" else 1e-6), name
        assert run.constraint_residual.max() < 1e-15


def test_massless_strips_turn_their_roots():
    """Without mass in the strips the body swings on strips and roots, and the energy stays."""
    light = tuple(name for name in ROOTS if name != "strip_inertia")
    run = turned("energy", effects=light)
    assert drift(run) < 1e-10
    assert run.rotation[-1] == pytest.approx(turned("energy").rotation[-1], abs=2e-3)
    held = solve_statics(rooted(effects=light), rotation=run.rotation[-1], increments=10)
    assert run.strain_energy[-1] == pytest.approx((held.bending_energy + held.axial_energy)[-1], rel=1e-2)
