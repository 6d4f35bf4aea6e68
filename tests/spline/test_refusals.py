"""What the splines refuse, in one line: designs and scenes that make no sense, and what is asked of them."""

import math
from functools import cache, partial

import pytest

from spline_model import (
    DEFAULT_EFFECTS,
    BodyDesign,
    HeldPivot,
    StripDesign,
    compliant_mechanism,
    cross_axis_pivot,
    natural_frequencies,
    sensitivities,
    solve_impulses,
    solve_many,
    solve_motion,
    solve_statics,
)
from tests.frames import opposed
from tests.models import refused, scene
from tests.spline.test_batch_of_mechanisms import linkage
from tests.table_one import BARE, SIDES, SIX, TABLE_ONE

CURLED = {"effects": (*DEFAULT_EFFECTS, "anticlastic")}
PRINTED = {"measure": "published", "stretch": "consistent"}
SPATIAL = {"measure": "spatial", "stretch": "consistent"}
UNSTEADY = "measure: got 'published', expected material or spatial"
TAPERED = SIDES | {"thickness_end": 2.0 * SIDES["thickness"]}
ROOT = 'expected "monolithic" or a number >= 0, its length over the thickness'


def more(**parameters):
    """Return the default effects and these with their parameters as keywords."""
    return scene(DEFAULT_EFFECTS, **parameters)


#: What the pivot of Table 1 is given beside or in place of its own, and what is said of it.
PIVOTS = [
    ({"axial_modes": 6}, "axial_modes: got 6, expected an integer >= 1 and <= 5"),
    ({"axial_modes": 2, "stretch": "consistent"}, "axial_modes: got 2, expected none"),
    ({"measure": "published"}, "stretch: got 'mixed', expected consistent"),
    ({"measure": "spatial"}, "stretch: got 'mixed', expected consistent, ... measure = spatial"),
    ({"control_points": 8, "gauss_points": 5}, "5 Gauss points see 5 of 6 shapes of bending"),
    ({"control_points": 4, "gauss_points": 2, "stretch": "consistent"}, "2 of 3 shapes of stretching"),
    ({"penalty_stiffness": 0.0}, "4 axial modes leave 1 of 5 strains free"),
    ({"segments": 0}, "segments: got 0, expected an integer >= 1"),
    (scene(("bending", "gravty")), "effects: got 'gravty', expected one of bending, ... nearest: gravity"),
    (scene(("bending", "stretching", "shear")), "'shear', expected ... (use --model fe-shear)"),
    (scene(("bending", "stretching", "inextensible")), "not both"),
    (scene(("bending",)), "stretching or inextensible beside bending"),
    (scene(("stretching",)), "bending, without which"),
    ({"parameters": {"gravity": {}}}, "an effect of the scene"),
    (scene((*DEFAULT_EFFECTS, "bending")), "each name once"),
    (more(strip_drag={"speed": 1.0}), "only rate"),
    (more(strip_drag={"rate": -1.0}), "rate: got -1.0"),
    (more(gravity=[{}, {}]), "parameters of gravity: got [{}, {}], expected one mapping"),
    (more(support={"fixed": ("x", "z")}), "fixed: got 'z', expected one of x, y, rotation"),
    (more(support={"fixed": "x"}), "fixed: got 'x', expected a sequence of x, y, rotation"),
    (more(support=[{"fixed": ("x",)}, {"fixed": ("y", "x")}]), "x of body: got 'two', expected one drive"),
    (SIDES | more(root_compliance={"root": "sharp"}), f"root: got 'sharp', {ROOT}"),
    (more(root_compliance={"root": 0.4}), "thickness of strip_1: got None, expected width and"),
    (TAPERED | SPATIAL, "stretch: got 'consistent', expected mixed for the tapered strip_1"),
    (SIDES | {"width_end": 0.0}, "width_end: got 0.0, expected a finite number > 0 [m]"),
    ({"thickness_end": 1e-3}, "width: got None, expected width and thickness, both or neither"),
    (SIDES | CURLED | SPATIAL, "measure: got 'spatial', expected material for anticlastic"),
    (SIDES | more(clamped_width={}, pre_strain={"curvature": 1.0}), "natural curvature of pre_strain: got 1"),
]


LIKE = "got 'a load that follows its body', expected a fixed direction"


def followed():
    """Return the pivot under a force that turns with its body."""
    return cross_axis_pivot(**SIX | more(applied_force={"force": (1.0, 0.0), "follower": True}))


def clamped(**changed):
    """Return a strip with a clamped width between ground and a stage."""
    strip = {"name": "strip_0", "start": (0.0, 0.0), "end": (1.0, 0.0), "tip": "stage"}
    strip |= {"width": 0.4, "thickness": 1e-3, "youngs_modulus": 2e11, "density": 7800.0}
    stage = BodyDesign(name="stage", centre=(1.0, 0.0))
    effects = (*DEFAULT_EFFECTS, "clamped_width")
    return compliant_mechanism(strips=[StripDesign(**strip | changed)], bodies=[stage], effects=effects)


NO_SIDES = {"width": None, "thickness": None, "area": 1e-5, "second_moment_of_area": 1e-16}


bare = partial(cross_axis_pivot, **BARE)


def pivot(**given):
    """Return the pivot of Table 1."""
    return cross_axis_pivot(**SIX | given)


def release(integrator="energy", given=None, **options):
    """Release the pivot, given other things as well."""
    return solve_motion(pivot(**given or {}), integrator=integrator, **{"start": math.pi / 2} | options)


def impulses(**options):
    """Release the pivot by sequential impulses."""
    return solve_impulses(pivot(), **options)


def linked(values):
    """Solve a batch of the linkage."""
    return solve_many(linkage(), values, body="crank", rotation=0.1)


@cache
def path():
    """Return a path of the pivot."""
    return solve_statics(pivot(), rotation=0.3, increments=2)


def derived(parameters=("length",), given=None, of=None):
    """Return the sensitivities of a pivot along a path, its own or of another."""
    made = pivot(**given or {})
    along = of if of is not None else solve_statics(made, rotation=0.3, increments=2)
    return sensitivities(made, along, parameters=parameters)


MASSLESS = scene(("bending", "stretching", "body_inertia"))
STILL = scene(("bending", "stretching"))
DAMPED = more(strip_damping={"relaxation_time": 1e-6})
TIMED = more(applied_force={"force": (1.0, 0.0), "history": ((0.0, 1.0), (1.0, 0.0))})
UNREACHED = {"control_points": 8, "penalty_stiffness": 10.0}
LONG = {"duration": 1e6, "step": 1e-6}
WITHIN = "duration: got 1000000.0, expected records within 2 GB"
MOMENT = more(applied_moment={"moment": 1.0})
AT = {"rotation": 0.1}
TO_AND_FRO = {"rotation": [0.2, -0.1], "order": "together"}
ASKED = [
    *((partial(pivot, **given), said) for given, said in PIVOTS),
    (lambda: bare(width=0.01), "thickness: got None, expected width and thickness, both or neither"),
    (lambda: bare(width=-1.0, thickness=1.0), "width: got -1.0, expected a finite number > 0 [m]"),
    (lambda: bare(**SIDES, area=6e-5), "area: got 6e-05, expected 5e-05, that of width and thickness, or"),
    (lambda: bare(area=5e-5), "area: got 'none', expected area and second_moment_of_area, or width and"),
    (lambda: clamped(tip=None), "tip of strip_0: got None, expected ground or a body for clamped_width"),
    (lambda: clamped(tip=None, tip_joint="hinge"), "tip_joint of strip_0: got 'hinge', expected clamp of a"),
    (lambda: clamped(rise=math.nan), "rise of strip_0: got nan, expected a finite number [m]"),
    (lambda: clamped(rise=0.1), "rise of strip_0: got 0.1, expected 0, a straight strip, for clamped_width"),
    (lambda: clamped(width=5.0), "width over length of strip_0: got 5.0, expected 0.005 to 4"),
    (lambda: clamped(**NO_SIDES), "width of strip_0: got None, expected width and thickness [m] for"),
    (lambda: solve_many(followed(), {}, rotation=0.1), f"designs: {LIKE}"),
    (lambda: sensitivities(followed(), solve_statics(followed(), rotation=0.1)), f"asked: {LIKE}"),
    (lambda: natural_frequencies(followed()), f"effects: {LIKE}"),
    (lambda: solve_motion(followed(), integrator="leapfrog"), "expected energy (the default) for damping"),
    (lambda: solve_statics(pivot(**MOMENT), **TO_AND_FRO), "rotation: got [-0.1, 0.2], expected turns"),
    (lambda: solve_many(pivot(), {}, order="first", **AT), "one of loads first, together"),
    (lambda: solve_many(pivot(), {"length": [0.1, -1.0]}, rotation=1.0), "design 1: length: got -1.0"),
    (lambda: solve_many(pivot(), {"length": [0.1] * 3}, rotation=[1.0, 0.5]), "rotation"),
    (lambda: solve_many(pivot(), {}, rotation=[1.0, math.nan]), "design 1: rotation: got nan"),
    (lambda: solve_many(TABLE_ONE, {}, rotation=1.0), "mechanism: got"),
    (
        lambda: solve_many(pivot(), {}, section_depth=0.0, **AT),
        "section_depth: got 0.0, expected a finite number > 0",
    ),
    (lambda: linked({"crank.length": 1.0}), "values: got 'crank.length', expected one of area"),
    (lambda: linked({"thickness": [1e-4, -1.0]}), "design 1: thickness: got -1.0, expected a finite num"),
    (
        lambda: solve_many(clamped(), {"strip_0.width": [9.0]}, body="stage", **AT),
        "width over length of strip_0",
    ),
    (lambda: derived(given=TAPERED), "taper of strip_1: got (1.0, 2.0), expected none, a constant section"),
    (lambda: solve_many(cross_axis_pivot(**BARE | TAPERED), {}, **AT), "taper of strip_1: got (1.0,"),
    (lambda: solve_statics(pivot(), rotation=1e-13), "rotation: got 1e-13, expected 0, or legs of 1e-12"),
    (
        lambda: solve_statics(pivot(axial_modes=3), accuracy=1e-3, **AT),
        "axial_modes: got 3, expected none beside accuracy",
    ),
    # which of both is up to round-off: a drive against inextensible strips that cannot give way
    (lambda: solve_statics(opposed(stretch="inextensible", control_points=10), rotation=-0.1), "tangent"),
    (lambda: natural_frequencies(pivot(**PRINTED)), f"{UNSTEADY} for motions and modes"),
    (lambda: solve_statics(pivot(**PRINTED), rotation=0.1).body_stiffness(), f"{UNSTEADY}: published"),
    (lambda: release(step=1.0), "step: got 1.0, expected at most the duration"),
    (lambda: release(**LONG), WITHIN),
    (lambda: release(records=0), "records: got 0, expected an integer >= 1"),
    (lambda: release(given=UNREACHED, start=math.radians(230)), "not resolved with 8 control points"),
    (lambda: release(given=SPATIAL, start=0.1), "measure: got 'spatial', expected material, or ... leapfrog"),
    (lambda: release("leapfrog", DAMPED, start=0.1), "integrator: got 'leapfrog', expected energy"),
    (lambda: release("leapfrog", {"stretch": "inextensible"}), "for strips that cannot stretch"),
    (lambda: release(accuracy=1e-2, step=1e-5), "accuracy: got 0.01, expected no step"),
    (lambda: release(accuracy=0.0), "accuracy: got 0.0, expected a finite number > 0 [rad]"),
    (lambda: solve_motion(pivot(**STILL), start=0.5), "strip_inertia, section_rotary_inertia, b"),
    (lambda: impulses(sweeps=30), "sweeps: got 30, expected none of the stable form"),
    (lambda: impulses(sweeps=0), "sweeps: got 0, expected an integer >= 1"),
    (lambda: impulses(body="lid"), "body: got 'lid'"),
    (lambda: solve_impulses(pivot(**MASSLESS)), "no inertia of strip_1"),
    (lambda: solve_impulses(pivot(**SIDES | CURLED)), "effects: got 'anticlastic'"),
    (lambda: solve_impulses(pivot(segments=2)), "segments: got 2, expected 1 for sequential impulses"),
    (lambda: solve_impulses(pivot(**TIMED)), "effects: got 'a drive or a load that changes in time'"),
    (lambda: HeldPivot(pivot()).hold(math.nan, 0.0, 0.0), "pose: got"),
    (lambda: HeldPivot(pivot()).turn(math.nan), "rotation: got nan"),
    (lambda: HeldPivot(pivot(stretch="consistent")), "bodies on strips"),
    (lambda: derived(("depth",)), "parameters: got 'depth', expected one of length, "),
    (lambda: derived(()), "parameters: got [], expected at least one name, each once"),
    (lambda: derived(given=PRINTED), f"{UNSTEADY}: published forces are for static paths only"),
    (lambda: derived(("strip_3.area",)), "parameters: got 'strip_3.area', expected one of length, "),
    (lambda: derived(given={"length": 0.09}, of=path()), "solution: got 'state 0 with residual"),
    (lambda: derived(given={"control_points": 7}, of=path()), "unknowns', expected a solution of this pivot"),
]


@pytest.mark.parametrize(("ask", "said"), ASKED, ids=[f"{k}: {row[1]}" for k, row in enumerate(ASKED)])
def test_what_makes_no_sense_is_refused(ask, said):
    """Requirement: choices that are unknown, contradictory, missing or singular, sides that do not fit a
    section, and what a solver cannot answer are refused with name, value and expectation."""
    refused(ask, said)
