"""Effects: balance of work and energies of all of them; gradients and Hessians of every operator."""

import numpy as np
import pytest

import spline_model as spline
from spline_model.compile import compile_scene
from spline_model.paper import CURVATURE, STRAIN, evaluate, strips_of
from tests import gates
from tests.models import rotation_matrix
from tests.spline.scenes import PARAMETERS, drift, scene_with
from tests.table_one import BARE, SIDES, SIX, TABLE_ONE

#: What damps, weighs and loads a motion, with the inertia of the sections.
MOVING = ("gravity", "section_rotary_inertia", "strip_damping", "strip_drag", "body_damping", "applied_force")


def static_balance(increments=160):
    """Imbalance of work and energies over 0 to 0.5 rad with every static effect, over the energy."""
    names = ("gravity", "applied_force", "applied_moment", "driven_displacement", "tip_force")
    solution = spline.solve_statics(scene_with(*names), rotation=0.5, increments=increments)
    energy = solution.bending_energy + solution.axial_energy + solution.gravity_energy
    return np.abs(energy - energy[0] - solution.work).max() / energy.max()


def root_balance(increments=20):
    """The same of strips and roots that turn, over a quarter turn, over the work."""
    given = {"effects": (*spline.DEFAULT_EFFECTS, "root_compliance")}
    given |= {"parameters": {"root_compliance": {"root": "monolithic"}}}
    path = spline.solve_statics(
        spline.cross_axis_pivot(**SIX | SIDES | given), rotation=np.pi / 2, increments=increments
    )
    assert path.inertia.max() == 0
    return np.abs(path.bending_energy + path.axial_energy - path.work).max() / path.work[-1]


def motion_balance(booked=1.0):
    """Imbalance of work, energies and loss over 0.05 s with every effect and a catch, over the energy.

    booked : the share of the loss that is counted, 1 being right.
    """
    scene = scene_with(*MOVING, "applied_moment", penalty_stiffness=spline.motion_penalty_stiffness(6))
    drive = spline.DrivenRotation(
        body="body", angle=1.0, history=((0.02, 0.0), (0.03, -0.6)), held=(0.02, 0.035)
    )
    run = spline.solve_motion(scene, start=1.2, duration=0.05, step=5e-5, drive=drive)
    assert run.status.value == "converged", run.message
    assert run.dissipated[-1] > 10  # J: the damping and the catch do take part
    assert abs(run.work[-1]) > 10
    energy = run.kinetic_energy + run.strain_energy + run.gravity_energy
    return np.abs(energy - energy[0] - run.work + booked * run.dissipated).max() / energy[0]


@pytest.mark.parametrize(
    ("gate", "error"), [("spline_static_balance", static_balance), ("spline_root_work", root_balance)]
)
def test_static_work_is_the_change_of_energy(gate, error):
    """Requirement: work of loads and drives = change of strain and gravity energy, that of roots included."""
    gates.hold(gate, error)


def test_work_in_motion_is_the_change_of_energy_and_the_loss():
    """Requirement: with damping, loads, a catch and a drive, the balance holds at the default step."""
    gates.hold("spline_motion_balance", motion_balance)


def moving_energy(step, steps, effects, start, **given):
    """Largest relative change of the energy of a pivot over some steps by default."""
    pivot = spline.cross_axis_pivot(**given, effects=(*spline.DEFAULT_EFFECTS, *effects))
    return drift(spline.solve_motion(pivot, start=start, duration=steps * step, step=step, check=False))


def test_pre_strained_strips_keep_their_energy():
    """Requirement: strips whose natural strain is in the law of a point move without losing energy."""
    given = {"parameters": {"pre_strain": {"curvature": 1.0, "strain": 1e-3}}, "stretch": "consistent"}
    error = moving_energy(5e-5, 40, ("pre_strain",), 0.5, **TABLE_ONE, control_points=5, **given)
    gates.check("spline_motion_balance", error)


@pytest.mark.parametrize("step", [5e-5, 1e-3])
def test_strips_that_curl_keep_their_energy(step):
    """Requirement: so do strips with both effects of the curl, in steps of any length."""
    body = {"body_mass": 0.05, "body_moment_of_inertia": 1e-4, "width": 0.02, "thickness": 1e-3}
    pivot = BARE | body | {"control_points": 6}
    assert moving_energy(step, 5, ("clamped_width", "anticlastic"), np.pi / 2, **pivot) < 1e-10


def frame_difference(turned_by=0.7):
    """Difference of a scene with every effect and its image turned by 0.7 rad: rotations, over 20 ms."""
    given = {name: PARAMETERS[name] for name in MOVING if name in PARAMETERS}

    def rotation(orientation, turn):
        turned = {
            name: {key: tuple(rotation_matrix(turn) @ given[name][key])}
            for name, key in (("gravity", "acceleration"), ("applied_force", "force"))
        }
        scene = {"effects": spline.DEFAULT_EFFECTS + MOVING, "parameters": given | turned}
        pivot = spline.cross_axis_pivot(**TABLE_ONE, **scene, orientation=orientation)
        return spline.solve_motion(pivot, start=1.2, duration=0.02).rotation

    return np.abs(rotation(0.0, 0.0) - rotation(0.7, turned_by)).max()


def test_effects_are_frame_indifferent():
    """Requirement: a scene turned as a whole, with its loads, moves in the same way."""
    gates.hold("spline_effects_frame", frame_difference)


CURVED = {"area": 5e-5, "second_moment_of_area": 1e-10, "youngs_modulus": 2e9, "density": 1200.0}


def kinetic_energy(rise, *effects, chord=0.1):
    """Twice the kinetic energy of a strip that turns rigidly with 1 rad/s about its root [kg m^2]."""
    strip = spline.StripDesign(
        name="strip", start=(0.0, 0.0), end=(chord, 0.0), rise=rise, tip=None, **CURVED
    )
    names = ("bending", "stretching", "strip_inertia", *effects)
    system = compile_scene(spline.compliant_mechanism(strips=[strip], effects=names, control_points=12).scene)
    velocity = np.zeros(system.layout.coordinate_count)
    for at in map(system.layout.strip, system.layout.strips):
        points = system.rest[at].reshape(-1, 2)
        velocity[at] = np.column_stack((-points[:, 1], points[:, 0])).ravel()
    return float(velocity @ system.mass @ velocity)


@pytest.mark.parametrize("rise", [0.0, 0.01, -0.03, 0.045, 0.1])
def test_sections_of_a_curved_strip_turn_with_their_own_inertia(rise):
    """Requirement: a rigid turn of any arc has rho I times its length beside the inertia of its line."""
    chord = 0.1
    half = 2.0 * np.arctan(2.0 * abs(rise) / chord)  # of the arc's angle
    length = chord if rise == 0.0 else chord * half / np.sin(half)
    own = kinetic_energy(rise, "section_rotary_inertia") - kinetic_energy(rise)
    assert own == pytest.approx(CURVED["density"] * CURVED["second_moment_of_area"] * length, rel=1e-7)


FORMS = {
    "material mixed": {},
    "inextensible": {"stretch": "inextensible"},
    "material consistent": {"stretch": "consistent"},
    "spatial consistent": {"stretch": "consistent", "measure": "spatial"},
    "published": {"stretch": "consistent", "measure": "published"},
    "segments": {"segments": 2, "control_points": 5, "axial_modes": 2},
    "curling": {
        "effects": (*spline.DEFAULT_EFFECTS, "clamped_width", "anticlastic"),
        "width": 0.04,
        "thickness": 0.001,
        "area": 4e-5,
        "second_moment_of_area": 4e-11 / 12.0,
    },
}


class Operator:
    """The assembled operator in dimensionless unknowns around a crooked state."""

    def __init__(self, settings):
        pivot = spline.cross_axis_pivot(**(SIX | settings))
        system, generator = compile_scene(pivot.driven(0.8)), np.random.default_rng(7)
        strips = strips_of(system)  # as if they were bent and longer at rest
        strips.along[..., CURVATURE], strips.own[:, STRAIN] = 20.0, 0.01
        self.system = system
        self.unit, self.energy_unit = self.system.scales.unit, self.system.scales.energy
        noise = generator.uniform(-0.03, 0.03, self.system.layout.size)
        noise[self.system.layout.coordinate_count :] *= 30
        self.y = self.system.rest / self.unit + noise

    def evaluate(self, y):
        """Energy, gradient and Hessian in units of EI/L."""
        gradient, hessian = np.empty(len(y)), np.empty((len(y), len(y)))
        energies = evaluate(self.system, y * self.unit, 1.0, gradient, hessian)
        scale = self.unit / self.energy_unit
        return sum(energies) / self.energy_unit, gradient * scale, hessian * scale[:, None] * self.unit


def fourth_order(function, y, i, step):
    """Fourth-order central difference of a function in its i-th variable."""
    e = np.zeros(len(y))
    e[i] = step
    return (8 * (function(y + e) - function(y - e)) - function(y + 2 * e) + function(y - 2 * e)) / (12 * step)


def hessian_error(step=1e-4, **settings):
    """Largest error of a column of the Hessian, over the largest entry of that column."""
    operator = Operator(settings)
    hessian = operator.evaluate(operator.y)[2]
    columns = [
        fourth_order(lambda y: operator.evaluate(y)[1], operator.y, i, step) for i in range(len(operator.y))
    ]
    return max(
        np.abs(column - hessian[:, i]).max() / np.abs(hessian[:, i]).max() for i, column in enumerate(columns)
    )


def gradient_error(step=2e-4, **settings):
    """Largest error of the gradient's rows without multipliers, over its largest entry."""
    operator = Operator(settings)
    operator.y[operator.system.layout.multiplier_start :] = 0.0  # psi is no part of the energy
    gradient, rows = operator.evaluate(operator.y)[1], operator.system.layout.coordinate_count
    found = [fourth_order(lambda y: operator.evaluate(y)[0], operator.y, i, step) for i in range(rows)]
    return np.abs(np.array(found) - gradient[:rows]).max() / np.abs(gradient[:rows]).max()


@pytest.mark.parametrize("form", FORMS)
def test_hessian_is_the_gradients_derivative(form):
    """Requirement: the tangent of every operator is consistent, also of the printed forces."""
    gates.hold("spline_hessian", lambda **coarse: hessian_error(**FORMS[form] | coarse))


@pytest.mark.parametrize("form", [form for form in FORMS if form != "published"])
def test_gradient_is_the_energys_derivative(form):
    """Requirement: the forces of every energy are its exact gradient, the printed ones are not."""
    gates.check("spline_gradient", gradient_error(**FORMS[form]))
    gates.refuse("spline_gradient", gradient_error)
