"""Effects that a scene does not name cost nothing: no row, no kernel, no degree of freedom."""

import numpy as np

from spline_model import (
    compliant_mechanism,
    cross_axis_pivot,
    natural_frequencies,
    solve_motion,
)
from tests import gates
from tests.spline.effect_scenes import scene_with
from tests.table_one import SIX


def test_massless_strips_leave_the_body_alone_dynamic():
    """Requirement: without strip inertia three degrees of freedom are dynamic, and energy is kept."""
    pivot = cross_axis_pivot(**SIX).design
    scene = compliant_mechanism(
        strips=pivot.strips, bodies=pivot.bodies, effects=("bending", "stretching", "body_inertia")
    )
    massive = natural_frequencies(scene_with(), count=1).frequency[0]
    modes = natural_frequencies(scene, count=10)
    assert len(modes.frequency) == 3
    assert 0 < modes.frequency[0] / massive - 1 < 0.02  # the strips weigh a third of the body
    run = solve_motion(scene, start=1.2, duration=0.01)
    assert run.settings["integrator"] == "quasi-static strips"
    energy = run.kinetic_energy + run.strain_energy
    gates.check("spline_motion_balance", np.abs(energy / energy[0] - 1).max())
