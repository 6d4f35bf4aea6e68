"""Effects that a scene does not name cost nothing: no row, no kernel, no degree of freedom."""

import os
import subprocess
import sys

import numpy as np
import pytest

from spline_model import (
    DEFAULT_EFFECTS,
    REGISTRY,
    compliant_mechanism,
    cross_axis_pivot,
    natural_frequencies,
    solve_mechanism,
    solve_motion,
    swinging_slide_stiffness,
)
from spline_model.bordered import assemble
from spline_model.compile import compile_scene
from spline_model.effects import registry
from spline_model.motion import energy_consistent
from spline_model.motion.start import set_in_motion
from spline_model.quadrature import STRETCHING
from tests import gates
from tests.spline.effect_scenes import EXTRA, scene_with
from tests.table_one import SIX


def test_unnamed_kinds_have_tables_of_length_zero():
    """Requirement: what the scene does not name is not there: no row, no matrix."""
    system = compile_scene(scene_with().scene)
    motion = set_in_motion(system)
    empty = (
        np.flatnonzero(system.points.numbers[:, STRETCHING]),
        system.tables.drives.row,
        system.tables.loads.coordinate,
        system.tables.weight,
        motion.drag,
        np.flatnonzero(motion.relaxation),
    )
    assert [array.size for array in empty] == [0] * len(empty) and not motion.damped
    alone = ("driven_displacement", "clamped_width", "anticlastic")  # a drive, and what refuses a bent strip
    full = set_in_motion(compile_scene(scene_with(*(n for n in EXTRA if n not in alone)).scene))
    assert full.drag.size and full.damped and full.relaxation.all()


def test_no_combination_recompiles():
    """Requirement: every scene runs the same compiled code."""
    if not hasattr(energy_consistent._run, "signatures"):
        pytest.skip("the compiler is switched off")
    solve_motion(scene_with(), start=0.5, duration=2e-4)
    before = [len(kernel.signatures) for kernel in (assemble, energy_consistent._run)]
    for name in EXTRA:
        solve_motion(scene_with(name), start=0.5, duration=2e-4)
    after = [len(kernel.signatures) for kernel in (assemble, energy_consistent._run)]
    assert after == before


def test_an_unnamed_effect_is_never_asked(monkeypatch):
    """Requirement: with the makers of all other effects poisoned, a scene runs on its own."""

    def poison(*_, **__):
        raise RuntimeError("this effect is not in the scene")

    for name in REGISTRY:
        if name not in DEFAULT_EFFECTS:
            monkeypatch.setitem(registry.REGISTRY, name, poison)
    solution = solve_mechanism(scene_with(), rotation=1.0, increments=4)
    run = solve_motion(scene_with(), start=0.5, duration=2e-4)
    assert solution.effects == ("bending", "stretching")  # statics asks for no inertia
    assert run.effects == DEFAULT_EFFECTS
    with pytest.raises(RuntimeError, match="not in the scene"):
        scene_with("gravity")


POISONED = """
import spline_model.effects.boundary as history, spline_model.strip.laws as laws
def poison(*_):
    raise RuntimeError("not in the scene")
laws.stretching_law = history.factor_at = poison
from spline_model.pivot import cross_axis_pivot
from spline_model.statics import solve_statics
from tests.table_one import SIX, TABLE_ONE
for stretch in ("mixed", "consistent"):
    pivot = cross_axis_pivot(**TABLE_ONE, control_points=4, stretch=stretch)
    solve_statics(pivot, rotation=0.1, increments=1)
    print(stretch, "runs")
"""


def test_an_unnamed_kernel_is_never_entered():
    """Requirement: without the compiler, a poisoned kernel stops the scenes that name it and no other."""
    environment = os.environ | {"NUMBA_DISABLE_JIT": "1"}
    run = subprocess.run([sys.executable, "-c", POISONED], env=environment, capture_output=True, text=True)
    assert run.stdout.split() == ["mixed", "runs"]
    assert "RuntimeError: not in the scene" in run.stderr


def test_inextensible_strips_have_no_axial_modes():
    """Requirement: dropping the stretch lowers the highest frequency at least twofold for n = 4 to 8."""
    for control_points in (4, 5, 6, 7, 8):
        slide = swinging_slide_stiffness(control_points)
        grid = {"control_points": control_points, "slide_stiffness": slide}
        highest = []
        for names in ((), ("inextensible",)):
            modes = natural_frequencies(scene_with(*names, **grid), count=100)
            highest.append(max(modes.frequency.max(), modes.slide_frequency.max()))
        assert highest[0] > 2 * highest[1], (control_points, highest)


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
