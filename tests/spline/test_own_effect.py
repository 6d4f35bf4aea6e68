"""A new effect is one function and one line; scenes that make no sense are refused."""

import pytest

from spline_model import (
    DEFAULT_EFFECTS,
    REGISTRY,
    cross_axis_pivot,
    natural_frequencies,
    solve_mechanism,
    solve_motion,
)
from spline_model.effects.boundary import AppliedForce
from tests.table_one import SIX


def counterweight(design, mass):
    """The toy of CONTRIBUTING: a weight [kg] on a cord over a pulley pulls every body up."""
    for body in design.bodies:
        yield AppliedForce(body=body.name, force=(0.0, 9.81 * mass), steady=True)


def test_a_new_effect_is_one_function_and_one_line(monkeypatch):
    """Requirement: an effect added by the recipe of CONTRIBUTING works in statics, modes and motions."""
    monkeypatch.setitem(REGISTRY, "counterweight", counterweight)
    names = (*DEFAULT_EFFECTS, "counterweight")
    pulled = cross_axis_pivot(**SIX, effects=names, parameters={"counterweight": {"mass": 5.0}})
    plain = cross_axis_pivot(**SIX)
    torque, without = (solve_mechanism(each, rotation=0.7).torque[-1] for each in (pulled, plain))
    assert torque != pytest.approx(without, rel=1e-3)
    assert natural_frequencies(pulled).frequency[0] > natural_frequencies(plain).frequency[0]
    for integrator in ("energy", "leapfrog"):
        run = solve_motion(pulled, start=0.7, duration=2e-4, integrator=integrator, check=False)
        energy = run.kinetic_energy + run.strain_energy + run.gravity_energy
        assert energy == pytest.approx(energy[0], rel=1e-4), integrator
