"""Every load, in statics, modes and releases: what starts, holds and ends is alike in both models."""

from dataclasses import replace
from functools import cache, partial
from typing import Any

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from studies.answers.adapters import answer_modes, answer_release
from studies.answers.motion import Motion
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.design import Design
from tests import gates
from tests.agreement import loaded
from tests.agreement.loaded import LOADS, ROTATION, angle, apart, design

HELD = (ROTATION, -ROTATION, 0.0)
EFFECTS = pytest.mark.parametrize("effect", LOADS)
MODELS = pytest.mark.parametrize(
    "settings", [SplineSettings(control_points=10), FeSettings(elements=10)], ids=lambda s: s.model
)
#: The loads whose errors a gate is about: a body that is led is stiff, and its errors are larger.
STIFF = "driven_displacement"
QUANTITIES = ("torque", "stiffness", "path", "moments", "axial", "energy")


@EFFECTS
@pytest.mark.parametrize("rotation", [*HELD, None], ids=angle)
def test_loaded_statics_agree(effect, rotation):
    """Requirement: torque, stiffness, path, clamp moments, axial forces and energy agree under every load."""
    found = apart(design(effect, rotation))
    for name in QUANTITIES:
        if rotation is None and name in ("torque", "stiffness"):
            assert np.isnan(found[name])
        elif rotation != 0.0 or name != "path":  # at rotation 0 some bodies do not move at all
            gates.check("loads_led" if effect == STIFF else f"loads_{name}", max(found[name], 1e-16))


@pytest.mark.parametrize(
    "gate, effect", [*((f"loads_{name}", "applied_force") for name in QUANTITIES), ("loads_led", STIFF)]
)
def test_fewer_control_points_are_apart(gate, effect):
    """Requirement: fewer control points do not pass."""
    names = QUANTITIES if effect == STIFF else [gate.removeprefix("loads_")]
    gates.refuse(gate, lambda **grid: max(apart(design(effect), **grid)[name] for name in names))


def quotient(effect, rotation, settings, by=3e-4):
    """Difference of the stiffness from that of torques of two paths of their own, over EI/L."""
    asked = design(effect, rotation)
    torques = [
        loaded.state(replace(asked, rotation=rotation + turn), settings)["torque"] for turn in (by, -by)
    ]
    slope = (torques[0] - torques[1]) / (2.0 * by)
    return abs(loaded.state(asked, settings)["stiffness"] - slope) / loaded.MOMENT_UNIT


@MODELS
@EFFECTS
@pytest.mark.parametrize("rotation", [pytest.param(ROTATION, marks=pytest.mark.slow), -ROTATION], ids=angle)
def test_stiffness_is_the_slope_of_the_torque_at_fixed_loads(effect, rotation, settings):
    """Requirement: stiffness is the difference quotient of the torques of paths with the same full load."""
    gate = "loads_quotient_led" if effect == STIFF else "loads_quotient"
    gates.check(gate, quotient(effect, rotation, settings))
    if effect in ("applied_force", STIFF) and settings.model == "fe":
        gates.refuse(gate, partial(quotient, effect, rotation, settings))


def frequencies(asked: Design, settings: Settings, count: int = 3) -> np.ndarray:
    """Lowest frequencies about the state that the design is driven to, which is then released [Hz]."""
    answer = answer_modes(asked, settings, rotation=asked.rotation or 0.0, count=count)
    assert answer.converged, answer.message
    return answer.frequency


def modes_apart(asked: Design, control_points: int = 8, meshes: tuple[int, int] = (5, 10)) -> float:
    """Largest relative difference of the lowest frequencies from the limit of two meshes."""
    coarse, fine = (frequencies(asked, FeSettings(elements=count)) for count in meshes)
    found = frequencies(asked, SplineSettings(control_points=control_points))
    return float(np.abs(found / ((4.0 * fine - coarse) / 3.0) - 1.0).max())


@pytest.mark.parametrize("effect", LOADS)
@pytest.mark.parametrize(
    "rotation",
    [-ROTATION, *(pytest.param(each, marks=pytest.mark.slow) for each in (ROTATION, 0.0, None))],
    ids=angle,
)
def test_modes_about_loaded_states_agree(effect, rotation):
    """Requirement: the first three modes about a released state agree under every load."""
    gate, meshes = ("loads_modes_led", (10, 20)) if effect == STIFF else ("loads_modes", (5, 10))
    error = partial(modes_apart, design(effect, rotation), meshes=meshes)
    gates.check(gate, error())
    if effect in ("applied_force", STIFF) and rotation == -ROTATION:
        gates.refuse(gate, error)


DURATION, RECORDS = 0.01, 200
INSTANTS = np.linspace(0.0, DURATION, 21)
#: Step of the spline [s], of second order, and control points; elements take their explicit step.
STEP, SPLINE, ELEMENTS = 2.5e-5, SplineSettings(control_points=8), FeSettings(elements=8)
BOTH = pytest.mark.parametrize("settings", [SPLINE, ELEMENTS], ids=lambda s: s.model)
LED, UNSTEADY = "driven_displacement", ("applied_force", "applied_moment", "tip_force")
#: Histories of a load, with its value at the start.
HISTORIES: dict[str, tuple[tuple[tuple[float, float], ...] | None, float]] = {
    "constant": (None, 1.0),
    "raised": (((0.0, 0.0), (0.004, 1.0)), 0.0),
    "begins late": (((0.002, 0.5), (0.006, 1.0)), 0.5),
    "dropped": (((0.0, 1.0), (0.003, -0.5)), 1.0),
}
#: One history of every load for the quick set, on either side by turns.
QUICK = [
    ("applied_force", "raised", -ROTATION),
    ("applied_moment", "begins late", ROTATION),
    ("tip_force", "raised", ROTATION),
    ("tip_force", "dropped", None),
    ("gravity", "constant", -ROTATION),
    (LED, "constant", -ROTATION),
]


def asked(effect: str, history: str, rotation: float | None) -> Design:
    """Return the design whose load has a history."""
    points = HISTORIES[history][0]
    return loaded.design(effect, rotation, **({} if points is None else {"history": points}))


def at_start(effect: str, history: str, rotation: float | None) -> Design:
    """Return the design with the load that acts at the first instant, as a static one."""
    share = HISTORIES[history][1]
    scaled = {
        name: value if isinstance(value, str) else tuple(share * np.atleast_1d(value))
        for name, value in LOADS[effect].items()
    }
    if "moment" in scaled:
        scaled["moment"] = scaled["moment"][0]
    return loaded.design(effect, rotation, **(scaled if effect in UNSTEADY else {}))


@cache
def released(design: Design, settings: Settings, **options: Any) -> Motion:
    """Return the motion after the release, with RECORDS records."""
    if isinstance(settings, SplineSettings):
        options = {"step": STEP} | options
    answer = answer_release(design, settings, duration=DURATION, records=RECORDS, **options)
    assert answer.converged, answer.message
    return answer


def largest(one: np.ndarray, other: np.ndarray) -> float:
    """Return the largest difference of places, over the strips' length and in rad."""
    return float(np.abs((one - other) / [loaded.LENGTH, loaded.LENGTH, 1.0]).max())


def places(motion: Motion) -> np.ndarray:
    """Return the body's places at INSTANTS, (T, 3) [m, m, rad], by cubic interpolation."""
    return np.asarray(CubicSpline(motion.time, motion.bodies["body"])(INSTANTS))


def moves_apart(design: Design, step: float = STEP, meshes: tuple[int, int] = (8, 12)) -> float:
    """Return the largest difference of the body's place over the motion, in both models."""
    coarse, fine = (released(design, FeSettings(elements=count)) for count in meshes)
    found = released(design, SPLINE, step=step)
    weight = (meshes[1] / meshes[0]) ** 2
    return largest(places(found), (weight * places(fine) - places(coarse)) / (weight - 1.0))


@pytest.mark.parametrize("effect, history, rotation", QUICK)
def test_motions_under_loads_agree(effect, history, rotation):
    """Requirement: both models start alike and move alike for 10 ms under every load."""
    error = partial(moves_apart, asked(effect, history, rotation))
    gates.check("loads_release", error())
    if effect == "gravity":
        gates.refuse("loads_release", error)


@BOTH
@pytest.mark.parametrize("effect, history, rotation", QUICK)
def test_a_release_starts_in_equilibrium_with_the_loads_of_its_first_instant(
    effect, history, rotation, settings
):
    """Requirement: the first record is the static state under each load times its history at t = 0."""
    motion = released(asked(effect, history, rotation), settings)
    static = loaded.state(at_start(effect, history, rotation), settings)
    assert largest(motion.bodies["body"][0], static["path"][-1]) < 1e-6
    assert motion.kinetic_energy[0] < 1e-12 * loaded.MOMENT_UNIT


@BOTH
def test_a_led_body_is_let_go(settings):
    """Requirement: a displacement without a history ends at the release: the centre moves."""
    centre = released(loaded.design(LED, ROTATION), settings).bodies["body"][:, :2]
    assert np.hypot(*(centre - centre[0]).T).max() > 1e-3 * loaded.LENGTH


@BOTH
def test_a_load_is_constant_before_and_after_its_history(settings):
    """Requirement: a history is constant before its first and after its last instant."""
    force = loaded.design("applied_force", ROTATION)
    same = loaded.design("applied_force", ROTATION, history=((0.004, 1.0), (0.005, 1.0)))
    one, other = (released(each, settings).bodies["body"] for each in (force, same))
    assert largest(one, other) < 1e-9


#: A rotation that is held and then released, one that is led back and released as it moves, and the centre
#: led on. Corners are off the grid of steps.
HELD_FOR, LED_BACK = (0.0, 0.00301), ((0.0, 1.0), (0.00503, 0.7))
AWAY = ((0.0, 1.0), (0.00307, 0.8), (0.00611, 1.0))


def driven(name: str, sign: float = 1.0) -> Design:
    """Return a loaded design whose motion is driven in part."""
    centre = {"history": AWAY} if "centre" in name else {}
    asked = loaded.design(LED if centre else "gravity", sign * ROTATION, **centre)
    return {
        "held": replace(asked, held=HELD_FOR),
        "led back": replace(asked, history=LED_BACK, held=(0.0, 0.00503)),
        "caught": replace(asked, held=(0.00211, 0.00701)),
        "led centre": asked,
        "held, led centre": replace(asked, held=HELD_FOR),
    }[name]


@pytest.mark.parametrize(
    "name, sign",
    [
        ("held", -1.0),
        pytest.param("led back", 1.0, marks=pytest.mark.slow),
        ("led back", -1.0),
        pytest.param("led centre", 1.0, marks=pytest.mark.slow),
    ],
)
def test_motions_that_are_driven_in_part_agree(name, sign):
    """Requirement: drives hold, lead and end at the same instants in both models, which move alike."""
    error = partial(moves_apart, driven(name, sign))
    gates.check("drives_release", error())
    if (name, sign) == ("led back", -1.0):
        gates.refuse("drives_release", error)


@pytest.mark.parametrize("name", ["caught", "held, led centre"])
@pytest.mark.parametrize("settings", [SPLINE, ELEMENTS], ids=lambda s: s.model)
def test_what_is_held_stays_and_the_books_close(name, settings):
    """Requirement: a held rotation stays, what the catch costs is dissipated, and the energies balance."""
    motion = released(driven(name), settings)
    inside = (motion.time > 0.00212) & (motion.time < 0.003)
    assert np.ptp(motion.rotation[inside]) < 1e-10
    assert motion.dissipated[-1] > 0.0 or name != "caught"
    gates.check("drives_books", max(motion.energy_error, 1e-16))
    if settings is ELEMENTS and name == "caught":
        coarse = partial(released, driven(name), settings)
        gates.refuse("drives_books", lambda **options: coarse(**options).energy_error)
    other = released(driven(name), SPLINE if settings is ELEMENTS else ELEMENTS)
    assert motion.dissipated[-1] == pytest.approx(other.dissipated[-1], rel=0.02, abs=1e-12)


def schemes_apart(step: float = 0.4 * STEP) -> float:
    """Return how far the motions of the implicit and the explicit scheme of the elements are moves_apart."""
    design, mesh = driven("held, led centre"), FeSettings(elements=4)
    implicit = released(design, mesh, integrator="generalised-alpha", step=step)
    return largest(places(implicit), places(released(design, mesh)))


def test_both_schemes_of_the_elements_follow_the_same_drives():
    """Requirement: the implicit integrator of the elements moves as the explicit one does."""
    gates.hold("drives_schemes", schemes_apart)


#: Rotation of the start [rad], small enough for a linear swing; distance of the centre from the crossing [m].
START, ARM, SWINGS = 1e-3, 0.05, 2
DAMPERS = {"translation": {"translation": 0.8}, "rotation": {"rotation": 2e-3}}
DAMPED = [
    (SplineSettings(control_points=7), {}),
    (FeSettings(elements=8), {"integrator": "generalised-alpha"}),
]


def swinging(damper):
    """A heavy body on light crossed strips, its centre beside the crossing, with one soft motion."""
    design = loaded.whiskered(loaded.scene(), START)
    light = [replace(strip, density=1e-3) for strip in design.strips if strip.name != "whisker"]
    body = replace(design.bodies[0], centre=(0.03 + ARM, 0.03))
    effects = replace(
        design.effects, names=(*design.effects.names, "body_damping"), tables={"body_damping": damper}
    )
    return replace(design, strips=tuple(light), bodies=(body,), effects=effects)


def decay(damper, settings, **options):
    """Relative difference of the rate at which the energy falls in whole swings from its closed form."""
    design = swinging(damper)
    moment = loaded.BODY_MOMENT_OF_INERTIA + loaded.BODY_MASS * ARM**2
    grip = damper.get("rotation", 0.0) + damper.get("translation", 0.0) * ARM**2
    rate = grip / (2.0 * moment)
    first = 2.0 * np.pi * answer_modes(design, settings, rotation=START, count=1).frequency[0]
    duration = SWINGS * 2.0 * np.pi / np.sqrt(first**2 - rate**2)
    step = {"step": duration / 1600} | options
    motion = answer_release(design, settings, duration=duration, records=20, **step)
    energy = motion.kinetic_energy + motion.strain_energy
    return abs(np.log(energy[0] / energy[-1]) / (2.0 * rate * duration) - 1.0)


@pytest.mark.slow
@pytest.mark.parametrize("settings, options", DAMPED, ids=["spline", "fe"])
@pytest.mark.parametrize("damper", DAMPERS)
def test_body_damping_makes_a_swing_die_away_at_its_rate(damper, settings, options):
    """Requirement: energy falls by exp(-(c_r + c_t d^2) / (J + m d^2) t), from either part of the damping."""
    error = partial(decay, DAMPERS[damper], settings, **options)
    gates.check("body_damping_decay", error())
    if settings.model == "spline":
        gates.refuse("body_damping_decay", error)


@pytest.mark.slow
@BOTH
@pytest.mark.parametrize("effect, history, rotation", QUICK)
def test_motions_under_loads_keep_their_energy_books(effect, history, rotation, settings):
    """Requirement: strain, kinetic and gravity energy gained are the work of the loads."""
    design = replace(asked(effect, history, rotation), increments=10)
    gates.check("loads_motion_books", max(released(design, settings).energy_error, 1e-16))
    if effect == "gravity" and settings is ELEMENTS:
        implicit = partial(released, design, settings, integrator="generalised-alpha")
        gates.refuse("loads_motion_books", lambda step: implicit(step=step).energy_error)
