"""Both models let go from the same start and move alike, whatever acts there."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import fe_reference
import spline_model
from studies.answers.adapters import answer_release
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.design import named_design
from studies.cases.effects import Effects
from studies.cases.problem import named_case
from tests import gates
from tests.table_one import TABLE_ONE

BASE = ("bending", "stretching", "strip_inertia", "body_inertia")
#: Histories that are nothing, half and all of a load at the start.
GROWING, HALF, WHOLE = ((0.0, 0.0), (1e-3, 1.0)), ((0.0, 0.5), (1e-2, 1.0)), ((0.0, 1.0), (1e-2, 0.2))
FORCE, MOMENT = {"force": (300.0, 200.0)}, {"moment": 50.0}
LED = "driven_displacement"
#: Where the centre is led, beside where it would be at a rotation of 20 deg of either sign [m].
ASIDE, SHIFT = (1e-5, -1e-5), (-0.01046916, -0.00062642)
SCENES = {
    "nothing": {},
    "force": {"applied_force": FORCE},
    "growing force": {"applied_force": FORCE | {"history": GROWING}},
    "half a force": {"applied_force": FORCE | {"history": HALF}},
    "falling force": {"applied_force": FORCE | {"history": WHOLE}},
    "moment": {"applied_moment": MOMENT},
    "growing moment": {"applied_moment": MOMENT | {"history": GROWING}},
    "weight": {"gravity": {"acceleration": (500.0, -981.0)}},
    "pre-strain": {"pre_strain": {"curvature": 1.0, "strain": 1e-4}},
    "led": {LED: {}},
    "all": {
        LED: {},
        "applied_force": FORCE | {"history": HALF},
        "applied_moment": MOMENT | {"history": GROWING},
        "gravity": {"acceleration": (500.0, -981.0)},
        "pre_strain": {"curvature": 1.0},
    },
}
STARTS = {"none": None, "-20": math.radians(-20.0), "0": 0.0, "20": math.radians(20.0)}
LENGTH = TABLE_ONE["length"]
DURATION, RECORDS = 1e-3, 20
EXACT = 1e-10


def scene_of(name, start):
    """Effects of a scene for a start [rad]; its centre is led a little aside of where it would be."""
    parameters = dict(SCENES[name])
    if LED in parameters:
        sign = np.sign(start or 0.0)
        displacement = (ASIDE[0] + sign * SHIFT[0], ASIDE[1] + abs(sign) * SHIFT[1])
        parameters[LED] = {"displacement": displacement}
    return {"effects": (*BASE, *parameters), "parameters": parameters}


def apart(one, other, records=slice(None)):
    """Largest distance of two motions of the body, in rad and strip lengths."""
    assert np.abs(one.time - other.time).max() < 1e-12
    rotation = np.abs(one.rotation - other.rotation)[records].max()
    return max(rotation, np.abs(one.centre - other.centre)[records].max() / LENGTH)


@cache
def released(scene, start, elements):
    """The pivot of Table 1 let go with the effects of a scene, by both models."""
    effects = scene_of(scene, STARTS[start])
    curve = spline_model.cross_axis_pivot(**TABLE_ONE, **effects, control_points=7)
    beam = fe_reference.cross_axis_pivot(**TABLE_ONE, **effects, elements=elements)
    run = {"start": STARTS[start], "duration": DURATION, "check": False}
    one = spline_model.solve_release(curve, **run, step=1e-5, records=RECORDS)
    other = fe_reference.solve_release(beam, **run, step=5e-7, samples=RECORDS)
    return one, other


QUICK = ("growing force", "moment", "led", "all")
ALL = [
    pytest.param(scene, start, marks=() if scene in QUICK and start in ("none", "-20") else pytest.mark.slow)
    for scene in SCENES
    for start in STARTS
]


@pytest.mark.parametrize("scene, start", ALL)
def test_both_models_start_from_the_same_state_and_move_alike(scene, start):
    """Requirement: what holds a start, what lets go and which loads act there are the same in both models."""
    one, other = released(scene, start, 12)
    # a start that is the shape at rest, or led there, is exact in both, and so is rest
    if (difference := apart(one, other, slice(1))) > EXACT:
        gates.check("agreement_release_start", difference)
    if (difference := apart(one, other)) > EXACT:
        gates.check("agreement_release_motion", difference)


@pytest.mark.parametrize("gate", ["agreement_release_start", "agreement_release_motion"])
def test_release_gates_have_teeth(gate):
    """Requirement: three elements do not pass."""
    records = slice(1) if gate.endswith("start") else slice(None)
    with pytest.raises(AssertionError, match="x the gate"):
        gates.check(gate, apart(*released("moment", "-20", **gates.teeth(gate)), records))


def test_constant_loads_keep_a_pivot_still_that_no_rotation_held():
    """Requirement: without a driven rotation the start is in equilibrium with its loads: nothing moves."""
    for run in released("moment", "none", 12):
        assert abs(run.rotation[0]) > 0.05
        assert np.abs(run.rotation - run.rotation[0]).max() < 1e-10


@cache
def led_mode_difference(control_points):
    """Relative difference of the first modes about rest with the centre led aside, which is let go."""
    led = {LED: {"displacement": (0.5e-3, -0.5e-3)}}
    effects = {"effects": (*BASE, *led), "parameters": led}
    curve = spline_model.cross_axis_pivot(**TABLE_ONE, **effects, control_points=control_points)
    beam = fe_reference.cross_axis_pivot(**TABLE_ONE, **effects, elements=40)
    ours = spline_model.natural_frequencies(curve, rotation=0.0, count=1).frequency[0]
    theirs = fe_reference.natural_frequencies(beam, rotation=0.0, count=1).frequency[0]
    assert theirs < 0.0
    return abs(ours / theirs - 1.0)


def test_modes_are_of_what_a_release_lets_go():
    """Requirement: about a state with its centre led aside both models free it, and none holds it at rest."""
    gates.check("agreement_led_mode", led_mode_difference(control_points=10))


def test_led_mode_gate_has_teeth():
    """Requirement: six control points do not pass."""
    with pytest.raises(AssertionError, match="x the gate"):
        gates.check("agreement_led_mode", led_mode_difference(**gates.teeth("agreement_led_mode")))


def loaded(design, name, **parameters):
    """A design with one effect more."""
    names = [*(each for each in design.effects.names if each != name), name]
    return replace(design, effects=Effects(names=tuple(names), tables={name: parameters}))


def motions(design, **run):
    """The design let go by both models, 8 control points and 16 elements."""
    settings = SplineSettings(control_points=8), FeSettings(elements=16)
    return [answer_release(design, each, **run, records=20) for each in settings]


@pytest.mark.parametrize("degrees", [60.0, -60.0])
def test_load_that_begins_from_nothing_changes_nothing_at_the_start(degrees):
    """Requirement: a polymer pivot starts with 0.05 N of history 0 where it starts without, in both."""
    bare = named_case("polymer_pivot")
    growing = loaded(bare, "applied_force", force=(0.05, 0.02), history=((0.0, 0.0), (0.1, 1.0)))
    run = {"start": math.radians(degrees), "duration": 5e-5}
    for one, other in zip(motions(bare, **run), motions(growing, **run), strict=True):
        assert np.abs(one.centre[0] - other.centre[0]).max() < 1e-12


def test_guide_under_a_constant_load_stands_still():
    """Requirement: not driven and loaded from the start, a guide begins in equilibrium in both models."""
    guide = named_design("parallel_strip_guide")
    one, other = motions(loaded(guide, "applied_force", force=(5.0, 0.0)), duration=5e-4)
    assert one.centre[0, 0] - guide.bodies[0].centre[0] > 5e-3
    gates.check("agreement_release_start", np.abs(one.centre[0] - other.centre[0]).max() / 0.1)
    for motion in (one, other):
        assert motion.message.startswith("nothing moves")
        assert motion.resolution == ""


FREE_TIP = {
    "strips": (
        {"name": "foot", "start": (0.0, 0.0), "end": (0.1, 0.0), "tip": "body"},
        {"name": "arm", "start": (0.12, 0.0), "end": (0.12, 0.1), "root": "body", "tip": None},
    ),
    "section": {
        "area": 5e-6,
        "second_moment_of_area": 1.0416667e-13,
        "youngs_modulus": 206e9,
        "poisson_ratio": 0.29,
        "density": 7800.0,
    },
    "body": {"name": "body", "centre": (0.11, 0.0), "mass": 0.05, "moment_of_inertia": 5e-6},
}


@pytest.mark.parametrize("start", [None, -0.3])
@pytest.mark.parametrize("history", [None, GROWING, HALF])
def test_force_at_a_free_tip_acts_at_the_start_as_its_history_says(start, history):
    """Requirement: so does a force at a free tip: both models start and move alike."""
    effects = (*BASE, "tip_force")
    force = {"strip": "arm", "force": (0.3, 0.1)} | ({} if history is None else {"history": history})
    ends = []
    for package, more in ((spline_model, {"control_points": 8}), (fe_reference, {"elements": 16})):
        design = package.compliant_mechanism(
            strips=[
                package.mechanism.StripDesign(**strip, **FREE_TIP["section"]) for strip in FREE_TIP["strips"]
            ],
            bodies=[package.mechanism.BodyDesign(**FREE_TIP["body"])],
            effects=effects,
            parameters={"tip_force": force},
            **more,
        )
        run = package.dynamics.solve_motion(design, start=start, duration=1e-3, check=False)
        ends.append(run.bodies["body"][[0, -1]])
    pose = np.abs(ends[0] - ends[1]).max(axis=1)
    if pose[0] > EXACT:
        gates.check("agreement_release_start", pose[0])
    gates.check("agreement_release_motion", pose[1])
