"""Effects: present ones are exact, absent ones cost nothing, and a new one is one class and one line."""

import os
import subprocess
import sys
from dataclasses import dataclass

import numpy as np
import pytest

from spline_model.compile import compile_scene
from spline_model.dynamics import solve_motion
from spline_model.effects import DrivenRotation, registry
from spline_model.effects.base import OpenPotential
from spline_model.effects.registry import DEFAULT_EFFECTS, REGISTRY
from spline_model.errors import InvalidParameter
from spline_model.integrators.motion import set_in_motion
from spline_model.kernels import bending, energy_step
from spline_model.kernels.assemble import assemble
from spline_model.mechanism import StripDesign, mechanism
from spline_model.modes import natural_frequencies
from spline_model.newton import Workspace
from spline_model.pivot import cross_axis_pivot, swinging_slide_stiffness
from spline_model.statics import solve_mechanism
from tests import gates
from tests.table_one import TABLE_ONE

#: Parameters with which each registered effect is tried; a new effect without its own is tried without.
PARAMETERS = {
    "gravity": {"acceleration": (300.0, -500.0)},
    "strip_damping": {"relaxation_time": 1e-5},
    "strip_drag": {"rate": 30.0},
    "body_damping": {"translation": 2.0, "rotation": 0.01},
    "applied_force": {"force": (30.0, -50.0)},
    "applied_moment": {"moment": 30.0, "history": ((0.0, 0.0), (0.005, 1.0), (0.02, -1.0))},
    "tip_force": {"strip": "free", "force": (3.0, 5.0)},
    "driven_displacement": {"displacement": (-0.0148, -0.0011)},  # near the free path at 0.5 rad
    "pre_strain": {"curvature": 1.0, "strain": 1e-4},
}
#: The same effects at zero: legal, and the same answer as without them.
ZERO = {
    "gravity": {"acceleration": (0.0, 0.0)},
    "strip_damping": {"relaxation_time": 0.0},
    "strip_drag": {"rate": 0.0},
    "body_damping": {},
    "applied_force": {"force": (0.0, 0.0)},
    "applied_moment": {"moment": 0.0},
    "pre_strain": {"curvature": 0.0, "strain": 0.0},
}
EXTRA = [name for name in REGISTRY if name not in (*DEFAULT_EFFECTS, "inextensible")]


def scene_with(*names, parameters=None, **settings):
    """Table 1 with a free strip on its body, whose scene holds the default effects and the named ones."""
    pivot = cross_axis_pivot(**TABLE_ONE).mechanism.design
    strips = list(pivot.strips)
    if "tip_force" in names:
        strips.append(
            StripDesign(
                name="free",
                start=(0.03, 0.06),
                end=(0.03, 0.12),
                root="body",
                area=5e-6,
                second_moment_of_area=1e-12,
                youngs_modulus=206e9,
                density=7800.0,
            )
        )
    given = PARAMETERS if parameters is None else parameters
    effects = tuple(n for n in DEFAULT_EFFECTS if not (n == "stretching" and "inextensible" in names))
    return mechanism(
        strips=strips,
        bodies=pivot.bodies,
        effects=effects + names,
        parameters={name: given[name] for name in names if name in given},
        **settings,
    )


def static_balance(increments, **more):
    """Imbalance of work and energies over 0 to 0.5 rad with every static effect, over the energy."""
    names = ("gravity", "applied_force", "applied_moment", "driven_displacement", "tip_force")
    solution = solve_mechanism(scene_with(*names, **more), rotation=0.5, increments=increments)
    energy = solution.bending_energy + solution.axial_energy + solution.gravity_energy
    return np.abs(energy - energy[0] - solution.work).max() / energy.max()


def motion_balance(step=5e-5):
    """Imbalance of work, energies and loss over 0.05 s with every effect and a catch, over the energy."""
    names = (
        "gravity",
        "section_rotary_inertia",
        "strip_damping",
        "strip_drag",
        "body_damping",
        "applied_force",
        "applied_moment",
    )
    scene = scene_with(*names, slide_stiffness=swinging_slide_stiffness(6))
    drive = DrivenRotation(body="body", angle=1.0, history=((0.02, 0.0), (0.03, -0.6)), held=(0.02, 0.035))
    run = solve_motion(scene, start=1.2, duration=0.05, step=step, drive=drive)
    assert run.status.value == "converged", run.message
    assert run.dissipated[-1] > 10  # J: the damping and the catch do take part
    assert abs(run.work[-1]) > 10
    energy = run.kinetic_energy + run.strain_energy + run.gravity_energy
    return np.abs(energy - energy[0] - run.work + run.dissipated).max() / energy[0]


def test_static_work_is_the_change_of_energy():
    """Requirement: work of loads and drives = change of strain and gravity energy."""
    gates.check("spline_static_balance", static_balance(increments=160))


def test_static_balance_has_teeth():
    """Requirement: coarse increments, whose quadrature of the work errs, do not pass."""
    with pytest.raises(AssertionError, match="x the gate"):
        gates.check("spline_static_balance", static_balance(**gates.teeth("spline_static_balance")))


def test_work_in_motion_is_the_change_of_energy_and_the_loss():
    """Requirement: with damping, loads, a catch and a drive, the balance holds at the default step."""
    gates.check("spline_motion_balance", motion_balance())


def test_motion_balance_has_teeth(monkeypatch):
    """Requirement: a Newton that stops early shows in the balance."""
    from spline_model.integrators import energy_consistent

    monkeypatch.setattr(energy_consistent, "TOLERANCE", gates.teeth("spline_motion_balance")["tolerance"])
    with pytest.raises(AssertionError, match="x the gate"):
        gates.check("spline_motion_balance", motion_balance())


@pytest.mark.parametrize("name", EXTRA)
def test_each_effect_has_a_consistent_step(name):
    """Requirement: for every member of the registry the step's tangent is its residual's derivative."""
    scene = scene_with(name).scene
    system = compile_scene(scene)
    motion = set_in_motion(system)
    generator = np.random.default_rng(5)
    size, count = system.layout.size, system.layout.coordinate_count
    unit, energy = motion.unit, motion.energy
    y0, y1 = (system.rest / unit + generator.uniform(-0.02, 0.02, size) for _ in range(2))
    active = np.ones(motion.tables.drives.row.size, dtype=np.int64)

    def residual(y):
        gradient, hessian = np.empty(size), np.empty((size, size))
        z0, z1 = y0 * unit, y * unit
        delta, v0 = (z1 - z0)[:count], np.zeros(count)
        energy_step.assemble_step(z0, z1, delta, v0, 1e-3, 2e-4, active, motion, gradient, hessian)
        return gradient * unit / energy, hessian * unit[:, None] * unit / energy

    tangent, worst = residual(y1)[1], 0.0
    for i in range(size):
        e = np.zeros(size)
        e[i] = 2e-4
        f = [residual(y1 + k * e)[0] for k in (-2, -1, 1, 2)]
        column = (8 * (f[2] - f[1]) - f[3] + f[0]) / (12 * 2e-4)
        worst = max(worst, np.abs(column - tangent[:, i]).max() / np.abs(tangent[:, i]).max())
    gates.check("spline_step_tangent", worst)
    eigenvalues = np.linalg.eigvalsh(motion.mass)
    assert eigenvalues[0] > -1e-12 * eigenvalues[-1]  # inertia is never negative
    if motion.drag.size:
        assert np.linalg.eigvalsh(motion.drag)[0] > -1e-12 * np.abs(motion.drag).max()


@pytest.mark.parametrize("name", ZERO)
def test_zero_equals_absent(name):
    """Requirement: an effect with zero coefficients gives the answer of a scene without it."""
    plain = solve_mechanism(scene_with(), rotation=1.0, increments=8)
    zero = solve_mechanism(scene_with(name, parameters=ZERO), rotation=1.0, increments=8)
    assert np.abs(zero.torque - plain.torque).max() <= 1e-14 * np.abs(plain.torque).max()
    run, same = (
        solve_motion(scene, start=1.0, duration=0.002)
        for scene in (scene_with(), scene_with(name, parameters=ZERO))
    )
    assert np.abs(run.rotation - same.rotation).max() <= 1e-14


def test_unnamed_kinds_have_tables_of_length_zero():
    """Requirement: what the scene does not name is not there: no row, no matrix."""
    system = compile_scene(scene_with().scene)
    motion = set_in_motion(system)
    empty = (
        system.tables.stretching.first,
        system.tables.drives.row,
        system.tables.loads.coordinate,
        system.tables.weight,
        motion.drag,
        motion.bending_damping.first,
        motion.stretching_damping.first,
        motion.axial_relaxation,
    )
    assert [array.size for array in empty] == [0] * len(empty)
    full = set_in_motion(compile_scene(scene_with(*(n for n in EXTRA if n != "driven_displacement")).scene))
    assert full.drag.size and full.bending_damping.first.size and full.axial_relaxation.size


def test_no_combination_recompiles():
    """Requirement: every scene runs the same compiled code."""
    if not hasattr(energy_step.run, "signatures"):
        pytest.skip("the compiler is switched off")
    solve_motion(scene_with(), start=0.5, duration=2e-4)
    before = [len(kernel.signatures) for kernel in (assemble, energy_step.run, bending.add_bending)]
    for name in EXTRA:
        solve_motion(scene_with(name), start=0.5, duration=2e-4)
    after = [len(kernel.signatures) for kernel in (assemble, energy_step.run, bending.add_bending)]
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
import spline_model.kernels.stretching as stretching, spline_model.kernels.drives as drives
def poison(*_):
    raise RuntimeError("not in the scene")
stretching.point_stretching = drives.factor_at = poison
from spline_model.pivot import cross_axis_pivot
from spline_model.statics import solve_statics
from tests.table_one import TABLE_ONE
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
    pivot = cross_axis_pivot(**TABLE_ONE).mechanism.design
    scene = mechanism(
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


@pytest.mark.parametrize(
    "effects, parameters, line",
    [
        (("bending", "gravty"), {}, "effects: got 'gravty', expected one of bending, .*nearest: gravity"),
        (("bending", "stretching", "inextensible"), {}, "not both"),
        (("bending",), {}, "stretching or inextensible beside bending"),
        (("stretching",), {}, "bending, without which"),
        (DEFAULT_EFFECTS, {"gravity": {}}, "an effect of the scene"),
        ((*DEFAULT_EFFECTS, "strip_drag"), {"strip_drag": {"speed": 1.0}}, "only rate"),
        ((*DEFAULT_EFFECTS, "strip_drag"), {"strip_drag": {"rate": -1.0}}, "rate: got -1.0"),
        ((*DEFAULT_EFFECTS, "bending"), {}, "each name once"),
    ],
    ids=str,
)
def test_senseless_scenes_are_refused(effects, parameters, line):
    """Requirement: unknown, contradictory and missing effects are one clear line that lists what there is."""
    with pytest.raises(InvalidParameter, match=line):
        cross_axis_pivot(**TABLE_ONE, effects=effects, parameters=parameters)


def test_a_motion_without_inertia_is_refused():
    """Requirement: dynamics without any inertia says which effects would give it some."""
    pivot = cross_axis_pivot(**TABLE_ONE, effects=("bending", "stretching"))
    with pytest.raises(InvalidParameter, match="strip_inertia, section_rotary_inertia, body_inertia"):
        solve_motion(pivot.mechanism, start=0.5)


@dataclass(frozen=True, kw_only=True)
class GroundSpring(OpenPotential):
    """The toy of CONTRIBUTING: a linear spring from a body's centre to the point where it rests."""

    body: str
    stiffness: float
    rest: tuple[float, float]

    def derivatives(self, q, layout):
        """V = 1/2 k |r - r0|^2."""
        at = layout.body(self.body)
        place = np.arange(at.start, at.start + 2)
        gap = q[place] - self.rest
        gradient, hessian = np.zeros(len(q)), np.zeros((len(q), len(q)))
        gradient[place] = self.stiffness * gap
        hessian[place, place] = self.stiffness
        return 0.5 * self.stiffness * gap @ gap, gradient, hessian


def ground_spring(design, stiffness):
    """The registry's entry of the toy effect."""
    for body in design.bodies:
        yield GroundSpring(body=body.name, stiffness=stiffness, rest=body.centre)


def test_a_new_effect_is_one_class_and_one_line(monkeypatch):
    """Requirement: an effect added by the recipe of CONTRIBUTING works in statics, modes and motion."""
    monkeypatch.setitem(registry.REGISTRY, "ground_spring", ground_spring)
    names = (*DEFAULT_EFFECTS, "ground_spring")
    pivot = cross_axis_pivot(**TABLE_ONE, effects=names, parameters={"ground_spring": {"stiffness": 1e5}})
    plain = solve_mechanism(scene_with(), rotation=1.0)
    sprung = solve_mechanism(pivot.mechanism, rotation=1.0)
    assert sprung.torque[-1] > 1.05 * plain.torque[-1]
    assert natural_frequencies(pivot).frequency[0] >= natural_frequencies(scene_with()).frequency[0]
    run = solve_motion(pivot.mechanism, start=1.0, duration=0.002, integrator="generalised-alpha")
    assert run.status.value == "converged"
    with pytest.raises(InvalidParameter, match="generalised-alpha"):
        solve_motion(pivot.mechanism, start=1.0, duration=0.002)
    work = Workspace.of(compile_scene(pivot.scene))
    assert work.system.open_potentials[0].stiffness == 1e5


def frame_difference(turned_by=0.7):
    """Difference of a scene with every effect and its image turned by 0.7 rad: rotations, over 20 ms."""
    names = (
        "gravity",
        "section_rotary_inertia",
        "strip_damping",
        "strip_drag",
        "body_damping",
        "applied_force",
    )
    turn = np.array([[np.cos(turned_by), -np.sin(turned_by)], [np.sin(turned_by), np.cos(turned_by)]])
    given = {name: PARAMETERS[name] for name in names if name in PARAMETERS}
    turned = given | {
        "gravity": {"acceleration": tuple(turn @ given["gravity"]["acceleration"])},
        "applied_force": {"force": tuple(turn @ given["applied_force"]["force"])},
    }
    runs = [
        solve_motion(
            cross_axis_pivot(
                **TABLE_ONE, orientation=angle, effects=DEFAULT_EFFECTS + names, parameters=parameters
            ).mechanism,
            start=1.2,
            duration=0.02,
        )
        for angle, parameters in ((0.0, given), (0.7, turned))
    ]
    return np.abs(runs[0].rotation - runs[1].rotation).max()


def test_effects_are_frame_indifferent():
    """Requirement: a scene turned as a whole, with its loads, moves in the same way."""
    gates.check("spline_effects_frame", frame_difference())


def test_frame_gate_has_teeth():
    """Requirement: loads that do not turn with the scene do not pass."""
    with pytest.raises(AssertionError, match="x the gate"):
        gates.check("spline_effects_frame", frame_difference(**gates.teeth("spline_effects_frame")))
