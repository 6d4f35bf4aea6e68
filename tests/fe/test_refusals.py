"""What the elements refuse, in one line: models and requests that make no sense; and failed solves."""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest

import fe_reference as fe
from tests import table_one
from tests.fe.scenes import TIP, WIDE, four_bar, free_cantilever, pivot, tipped
from tests.fe.test_solid import strip as solid
from tests.models import refused, scene
from tests.table_one import BARE, SIDES

STILL, LIGHT = scene(("bending", "stretching")), scene(("bending", "stretching", "body_inertia"))
ROTARY = scene(("bending", "stretching", "section_rotary_inertia"))
TWICE, PULL, NAN = ((0.0, 1.0), (0.0, 2.0)), (1.0, 0.0), float("nan")
more = partial(scene, fe.DEFAULT_EFFECTS)
DAMPED = more(strip_damping={"relaxation_time": 2e-3})

#: What the pivot of Table 1 is given beside or in place of its own, and what is said of it.
PIVOTS: list[tuple[dict[str, Any], str]] = [
    ({"poisson_ratio": 0.5}, "poisson_ratio: got 0.5, expected a number between -1 and 0.5, both excluded"),
    ({"centre_offset": (0.0,)}, "centre_offset: got (0.0,), expected two finite numbers [m]"),
    ({"centre_offset": np.array(0.1)}, "centre_offset: got array(0.1), expected two finite numbers [m]"),
    (scene((*fe.DEFAULT_EFFECTS, "magnetism")), "effects: got 'magnetism', expected one of bending,"),
    (scene(("bending", "inextensible")), "effects: got 'inextensible', expected one of bending, stretching,"),
    (scene(("bending", "strip_inertia")), "effects: got ('bending', 'strip_inertia'), expected bending and"),
    (scene((*fe.DEFAULT_EFFECTS, "bending")), "effects: got ('bending', 'stretching', 'strip_inertia',"),
    (ROTARY, "effects: got ... 'section_rotary_inertia'), expected strip_inertia beside"),
    ({"parameters": {"gravity": {}}}, "parameters: got 'gravity', expected one of the named effects"),
    ({"parameters": {"bending": {"rate": 1.0}}}, "bending: got 'rate', expected one of no parameters"),
    (more(gravity={}), "gravity: got {}, expected a value of acceleration [name]"),
    (more(gravity={"acceleration": 9.81}), "acceleration: got 9.81, expected two finite numbers [m/s^2]"),
    (more(gravity={"acceleration": (0.0, NAN)}), "acceleration: got nan, expected a finite number [m/s^2]"),
    (more(gravity={"speed": 1.0}), "gravity: got 'speed', expected one of acceleration [name]"),
    (more(strip_damping={"relaxation_time": -1.0}), "relaxation_time: got -1.0, expected a number not"),
    (more(strip_drag={"rate": -1.0}), "rate: got -1.0, expected a number not below 0 [1/s]"),
    (more(body_damping={"rotation": -1.0}), "rotation: got -1.0, expected a number not below 0 [N m s]"),
    (more(applied_force={"force": PULL, "body": "car"}), "body: got 'car', expected one of body [name]"),
    (more(applied_moment={"moment": 1.0, "body": "car"}), "body: got 'car', expected one of body [name]"),
    (more(applied_moment={"moment": 1.0, "history": TWICE}), "history: got ... expected pairs of ascending"),
    (more(tip_force={"strip": "strip_1", "force": PULL}), "tip_force: got 'strip_1', expected a strip whose"),
    (more(tip_force={"strip": "rope", "force": PULL}), "strip: got 'rope', expected one of strip_1, strip_2"),
]


def alone(**parameters: Any) -> fe.Model:
    """Return a wide strip with a free tip, with effects."""
    return free_cantilever(section=WIDE, parameters=parameters)


def bare(**given: Any) -> fe.Model:
    """Return the pivot without a section but what is given."""
    return fe.cross_axis_pivot(**BARE, **given)


def hung(*, bodies: tuple[str, ...] = ("plate",), strips: int = 1) -> fe.Model:
    """Return strips of one name between ground and a plate."""
    strip = fe.StripDesign(name="strip", start=(0.0, 0.0), end=(0.1, 0.0), tip="plate", **table_one.SECTION)
    made = [fe.BodyDesign(name=name, centre=(0.1, 0.0)) for name in bodies]
    return fe.compliant_mechanism(strips=[strip] * strips, bodies=made)


def apart(ratio: float) -> fe.Model:
    """Return two strips in a chain, of which the one on the ground is softer by a ratio."""
    moduli = {"youngs_modulus": table_one.SECTION["youngs_modulus"] / ratio}
    soft = fe.StripDesign(
        name="soft", start=(0.0, 0.0), end=(0.1, 0.0), tip="a", **table_one.SECTION | moduli
    )
    hard = fe.StripDesign(
        name="hard", start=(0.1, 0.0), end=(0.2, 0.0), root="a", tip="b", **table_one.SECTION
    )
    bodies = [fe.BodyDesign(name=name, centre=end) for name, end in (("a", soft.end), ("b", hard.end))]
    return fe.compliant_mechanism(strips=[soft, hard], bodies=bodies)


def release(given: Any = None, **options: Any) -> object:
    """Release the pivot, given other effects as well."""
    return fe.solve_motion(pivot(**given or {}), **{"start": 0.5, "duration": 1e-4} | options)


def unheld() -> fe.Model:
    """Return a strip that nothing holds."""
    return tipped(TIP, strip={"root": None}, applied_moment={"moment": 1.0})


ALPHA = "generalised-alpha"
INERTIA = "expected strip_inertia or body_inertia for a motion"
NEEDED = "expected strips with width and thickness"
LED, BRIEF = {"displacement": (1e-3, 0.0)}, {"duration": 1e-3}
BENT, CURLED, CLAMPED = {"pre_strain": {"curvature": 1.0}}, {"anticlastic": {}}, {"clamped_width": {}}
VAST = WIDE | {"width": 10.0}
#: A call, and what is said of it.
ASKED: list[tuple[Callable[[], object], str]] = [
    (lambda: bare(width=0.01), "thickness: got None, expected a finite number [m]"),
    (lambda: bare(width=-1.0, thickness=1.0), "width: got -1.0, expected a number above 0 [m]"),
    (lambda: bare(**SIDES, second_moment_of_area=1.05e-10), "got 1.05e-10, expected 1.04167e-10, that of"),
    (lambda: bare(area=5e-5), "second_moment_of_area: got 'nothing', expected it, or width and"),
    (bare, "area: got 'nothing', expected it, or width and thickness of a rectangle [m]"),
    (lambda: four_bar(CLAMPED), f"clamped_width: got 'a', {NEEDED}"),
    (lambda: four_bar(CURLED), f"anticlastic: got 'a', {NEEDED}"),
    (lambda: four_bar({"root_compliance": {"root": 1.0}}), f"root_compliance: got 'a', {NEEDED}"),
    (lambda: alone(**CLAMPED), "clamped_width: got 'strip', expected strips clamped at both ends"),
    (lambda: four_bar(CURLED, rise=0.003, section=WIDE), "got 'a', expected straight strips"),
    (lambda: four_bar(BENT | CURLED, section=WIDE), "anticlastic: got 'natural curvature', expected strips"),
    (
        lambda: four_bar({"root_compliance": {"root": -1.0}}, section=WIDE),
        "root: got -1.0, expected a number",
    ),
    (lambda: fe.solve_statics(four_bar(CLAMPED, section=VAST)), "clamped_width: got 500.0, expected a"),
    *(
        (partial(fe.plate_factors, *each), "ratio")
        for each in ((0.0, 0.3), (np.nan, 0.3), (0.5, -0.1), (0.5, 0.6))
    ),
    (lambda: hung(bodies=("car",)), "tip: got 'plate', expected one of ground, car"),
    (lambda: hung(bodies=("ground",)), "bodies: got 'ground', expected another name"),
    (lambda: hung(strips=2), "strips: got ... expected names that differ"),
    (lambda: tipped(TIP, strip={"end": (0.0, 0.0)}), "ends that coincide"),
    (lambda: tipped(TIP, strip={"start": (0.0, np.inf)}), "start: got inf, expected a finite number"),
    (lambda: fe.BodyDesign(centre=np.array([np.nan, 0.0])), "centre: got nan, expected a finite number"),
    (lambda: tipped(TIP, strip={"density": 0.0}), "above 0"),
    (lambda: fe.Model(strips=()), "one or more strips"),
    (lambda: fe.solve_statics(unheld()), "nothing holds body tip against turning"),
    (lambda: fe.solve_statics(four_bar(), rotation=0.1), "body: got None, expected one of crank, cou"),
    (lambda: fe.solve_statics(free_cantilever(), rotation=0.1), "body: got None, expected one of no"),
    (lambda: alone(driven_displacement=LED), "driven_displacement: got 'no bodies'"),
    (lambda: fe.solve_motion(pivot(), start=0.1, settled=False, **BRIEF), "settled: got False"),
    (lambda: fe.natural_frequencies(pivot(), rotation=None, held=True), "held: got True, expected a driven"),
    (
        lambda: fe.solve_motion(free_cantilever(root=None), settled=False, integrator=ALPHA, **BRIEF),
        "step: got None",
    ),
    (lambda: fe.solve_statics(apart(1e14), body="b", rotation=0.1), "expected clamps that hold it, or"),
    (lambda: fe.natural_frequencies(pivot(**STILL)), INERTIA),
    (lambda: release(STILL), INERTIA),
    (lambda: release(LIGHT), "expected generalised-alpha where strips or bodies have no"),
    (lambda: release(most_steps=0), "most_steps: got 0, expected an integer of at least 1 [1]"),
    (lambda: release(samples=0), "samples: got 0, expected an integer of at least 1 [1]"),
    (lambda: release(duration=1e6), "duration: got 1000000.0, expected at most 2e+07 steps of"),
    (lambda: release(DAMPED, duration=0.05), "2e+07 steps ... generalised-alpha takes about 2.3e+04"),
    (lambda: release(duration=1e-2, most_steps=100), "at most 100 steps"),
    (lambda: release(duration=1.0, samples=10**7), "samples: got "),
]
ASKED += [(partial(pivot, **given), said) for given, said in PIVOTS]
#: What a solid strip is given, and what is said of it.
SOLIDS: list[tuple[dict[str, Any], str]] = [
    ({"law": "hooke"}, "law: got 'hooke', expected one of st-venant-kirchhoff, neo-hookean"),
    ({"element": "linear"}, "element: got 'linear', expected one of serendipity, lagrange"),
    ({"thickness": 0.0}, "thickness: got 0.0, expected a number above 0"),
    ({"poisson_ratio": 0.5}, "poisson_ratio: got 0.5, expected a number between -1 and 0.5, both excluded"),
    ({"support": -1.0}, "support: got -1.0, expected a number not below 0"),
    ({"fineness": 0}, "fineness: got 0, expected an integer of at least 1"),
]
ASKED += [(partial(solid, **given), said) for given, said in SOLIDS]
ONCE, FORCED = "expected one drive or support for each coordinate", {"stiffness": (1.0, 1.0)}
PUSHED, ROLL = {"body": "crank", "displacement": (0.0, None)}, {"body": "crank", "fixed": ["x", "rotation"]}
ROLLED = partial(four_bar, {"support": ROLL})
#: Effects of the four-bar of which there may be several, and what is said of them.
LISTS: list[tuple[dict[str, Any], str]] = [
    ({"gravity": [{"acceleration": (0.0, 1.0)}]}, "gravity: got ... expected the parameters of one effect"),
    ({"applied_moment": []}, "applied_moment: got [], expected parameters, or a sequence of them"),
    ({"support": {"body": "crank", "fixed": "x"}}, "fixed: got 'x', expected one or more of x, y, rotation"),
    ({"support": {"body": "crank", "fixed": ("x", "x")}}, "fixed: got ('x', 'x'), expected one or more"),
    ({"support": {"body": "crank"}}, "support: got ... expected a value of fixed"),
    ({"spring": {"body": "crank"}}, "spring: got 'crank', expected a stiffness or a damping above 0"),
    ({"spring": {"body": "crank", "stiffness": (1.0, -1.0)}}, "stiffness: got -1.0, expected a number not"),
    ({"spring": {"body": "crank", "other": "car", **FORCED}}, "body: got 'car', expected one"),
    ({"spring": {"body": "crank", "other": "crank", **FORCED}}, "other: got 'crank'"),
    ({"tip_force": {"strip": "a", "force": PULL, "follower": 1}}, "follower: got 1, expected True or"),
    ({"support": ROLL, "driven_displacement": PUSHED}, f"prescribed: got 'x of crank', {ONCE}"),
    ({"driven_displacement": [PUSHED, PUSHED]}, f"prescribed: got 'x of crank', {ONCE}"),
]
ASKED += [(partial(four_bar, given), said) for given, said in LISTS]
ASKED += [
    (lambda: fe.solve_statics(ROLLED(), body="crank", rotation=0.1), f"'rotation of crank', {ONCE}"),
    (lambda: fe.natural_frequencies(ROLLED(), body="crank", rotation=0.1), f"'rotation of crank', {ONCE}"),
    (
        lambda: fe.solve_motion(ROLLED(), drive=fe.DrivenRotation(body="crank", angle=0.1), **BRIEF),
        f"'rotation of crank', {ONCE}",
    ),
]


@pytest.mark.parametrize(("ask", "said"), ASKED, ids=[f"{k}: {row[1]}" for k, row in enumerate(ASKED)])
def test_what_makes_no_sense_is_refused(ask: Callable[[], object], said: str) -> None:
    """Bad designs, effects and requests are refused by name with the value, what is expected and the unit."""
    refused(ask, said)
