"""What a scene may name, what it is refused, and that it pays for nothing else."""

from functools import cache
from typing import Any

import numpy as np
import pytest

from fe_reference import (
    DEFAULT_EFFECTS,
    BodyDesign,
    InvalidParameter,
    StripDesign,
    compliant_mechanism,
    natural_frequencies,
    solve_mechanism,
    solve_motion,
    solve_release,
    solve_statics,
)
from tests.fe.cases import pivot
from tests.fe.scenes import NOTHING, SECTION, four_bar, free_cantilever, guide
from tests.gates import hold

STILL = ("gravity", "applied_force", "applied_moment", "pre_strain")


#: Motions of the four-bar, by either scheme.
MOVED: tuple[dict[str, Any], ...] = tuple(
    {"body": "crank", "duration": 1e-5, "step": step, "increments": 5, "integrator": integrator}
    for integrator, step in (("central-difference", 5e-8), ("generalised-alpha", 1e-6))
)


@cache
def without_it() -> tuple[Any, list[Any]]:
    """Path and motions of the four-bar without any of the effects."""
    bare = four_bar(elements=4)
    path = solve_mechanism(bare, body="crank", rotation=0.4, increments=5)
    return path, [solve_motion(bare, **settings, start=0.4) for settings in MOVED]


@pytest.mark.parametrize("name", NOTHING)
def test_zero_equals_absent(name: str) -> None:
    """An effect with a coefficient of zero leaves statics, motion and frequencies as they are without it."""

    def error(turn: float = 0.4) -> float:
        named, (path, motions) = four_bar({name: NOTHING[name]}, elements=4), without_it()
        gaps = []
        if name in STILL:
            other = solve_mechanism(named, body="crank", rotation=turn, increments=5)
            gaps = [(path.torque[-1] - other.torque[-1]) / path.torque[-1]]
            gaps += [np.abs(path.shape[-1] - other.shape[-1]).max() / 0.1]
        for settings, motion in zip(MOVED, motions, strict=True):
            other_way = solve_motion(named, **settings, start=turn)
            gaps.append(np.abs(motion.shape - other_way.shape).max() / 0.1)
        # the same operations in the same order leave nothing: one unit in the last place stands for it
        return max(*(float(abs(gap)) for gap in gaps), float(np.finfo(float).eps))

    hold("fe_zero_equals_absent", error)


BAD: list[tuple[dict[str, Any], str]] = [
    (
        {"effects": (*DEFAULT_EFFECTS, "magnetism")},
        "effects: got 'magnetism', expected one of bending, stretching, strip_inertia",
    ),
    (
        {"effects": ("bending", "inextensible")},
        "effects: got 'inextensible', expected one of bending, stretching, strip_inertia",
    ),
    (
        {"effects": ("bending", "strip_inertia")},
        "effects: got ('bending', 'strip_inertia'), expected bending and",
    ),
    ({"effects": (*DEFAULT_EFFECTS, "bending")}, "effects: got ('bending', 'stretching', 'strip_inertia',"),
    (
        {"effects": ("bending", "stretching", "section_rotary_inertia")},
        "effects: got ('bending', 'stretching', 'section_rotary_inertia'), expected strip_inertia beside",
    ),
    (
        {"parameters": {"gravity": {}}},
        "parameters: got 'gravity', expected one of the named effects bending,",
    ),
    ({"parameters": {"bending": {"rate": 1.0}}}, "bending: got 'rate', expected one of no parameters [name]"),
    (
        {"effects": (*DEFAULT_EFFECTS, "gravity")},
        "gravity: got {}, expected a value of acceleration [name]",
    ),
]
BAD += [
    (
        {"effects": (*DEFAULT_EFFECTS, name), "parameters": {name: parameters}},
        message,
    )
    for name, parameters, message in (
        ("gravity", {"acceleration": 9.81}, "acceleration: got 9.81, expected two finite numbers [m/s^2]"),
        (
            "gravity",
            {"acceleration": (0.0, np.nan)},
            "acceleration: got nan, expected a finite number [m/s^2]",
        ),
        ("gravity", {"speed": 1.0}, "gravity: got 'speed', expected one of acceleration [name]"),
        (
            "strip_damping",
            {"relaxation_time": -1.0},
            "relaxation_time: got -1.0, expected a number not below 0",
        ),
        ("strip_drag", {"rate": -1.0}, "rate: got -1.0, expected a number not below 0 [1/s]"),
        ("body_damping", {"rotation": -1.0}, "rotation: got -1.0, expected a number not below 0 [N m s]"),
        (
            "applied_force",
            {"force": (1.0, 0.0), "body": "car"},
            "body: got 'car', expected one of body [name]",
        ),
        ("applied_moment", {"moment": 1.0, "body": "car"}, "body: got 'car', expected one of body [name]"),
        (
            "applied_moment",
            {"moment": 1.0, "history": ((0.0, 1.0), (0.0, 2.0))},
            "history: got ((0.0, 1.0), (0.0, 2.0)), expected pairs of ascending instants [s]",
        ),
        (
            "tip_force",
            {"strip": "strip_1", "force": (1.0, 0.0)},
            "tip_force: got 'strip_1', expected a strip whose",
        ),
        (
            "tip_force",
            {"strip": "rope", "force": (1.0, 0.0)},
            "strip: got 'rope', expected one of strip_1, strip_2",
        ),
    )
]


@pytest.mark.parametrize(("changes", "message"), BAD)
def test_bad_effects_are_one_clear_line(changes: dict[str, Any], message: str) -> None:
    """Unknown, contradictory or incomplete effects are refused in one line that says what there is."""
    with pytest.raises(InvalidParameter) as refusal:
        pivot(**changes)
    assert str(refusal.value).startswith(message)
    assert "\n" not in str(refusal.value)


def test_motion_needs_inertia() -> None:
    """A motion of nothing that has inertia is refused; massless parts are refused in the explicit scheme."""
    still = pivot(effects=("bending", "stretching"))
    with pytest.raises(InvalidParameter, match="expected strip_inertia or body_inertia for a motion"):
        solve_release(still, start=0.1, duration=1e-3)
    with pytest.raises(InvalidParameter, match="expected strip_inertia or body_inertia for a motion"):
        natural_frequencies(still)
    assert solve_statics(still, rotation=0.1).status.value == "converged"
    light = pivot(effects=("bending", "stretching", "body_inertia"))
    with pytest.raises(InvalidParameter, match="expected generalised-alpha where strips or bodies have no"):
        solve_release(light, start=0.1, duration=1e-3)


def test_bad_requests_of_mechanisms() -> None:
    """Bodies and strips that are not there, drives without a body and freedom without a step are refused."""
    strip = StripDesign(name="strip", start=(0.0, 0.0), end=(0.1, 0.0), tip="plate", **SECTION)
    plate = BodyDesign(name="plate", centre=(0.1, 0.0))
    with pytest.raises(InvalidParameter, match="tip: got 'plate', expected one of ground, car"):
        compliant_mechanism(strips=[strip], bodies=[BodyDesign(name="car", centre=(0.0, 0.0))])
    with pytest.raises(InvalidParameter, match="bodies: got 'ground', expected another name"):
        compliant_mechanism(strips=[strip], bodies=[BodyDesign(name="ground", centre=(0.0, 0.0))])
    with pytest.raises(InvalidParameter, match=r"strips: got .* expected names that differ"):
        compliant_mechanism(strips=[strip, strip], bodies=[plate])
    with pytest.raises(InvalidParameter, match="body: got None, expected one of crank, coupler, rocker"):
        solve_mechanism(four_bar(), rotation=0.1)
    with pytest.raises(InvalidParameter, match="body: got None, expected one of no bodies"):
        solve_mechanism(free_cantilever(), rotation=0.1)
    with pytest.raises(InvalidParameter, match="driven_displacement: got 'no bodies'"):
        free_cantilever(parameters={"driven_displacement": {"displacement": (0.0, 0.0)}})
    led = guide({"driven_displacement": {"displacement": (1e-3, 0.0)}})
    with pytest.raises(InvalidParameter, match="expected none beside the effect driven_displacement"):
        solve_mechanism(led, displacement=(1e-3, 0.0))
    with pytest.raises(InvalidParameter, match="settled: got False, expected True for a start at a held"):
        solve_motion(guide(), start=0.1, settled=False, duration=1e-3)
    with pytest.raises(InvalidParameter, match="held: got True, expected a driven rotation to hold"):
        natural_frequencies(guide(), rotation=None, held=True)
    loose = free_cantilever(root=None)
    with pytest.raises(InvalidParameter, match="step: got None, expected a step: the model can move freely"):
        solve_motion(loose, settled=False, duration=1e-3, integrator="generalised-alpha")
