"""Static paths are watched: one state for any increments, and told where it is or became unstable."""

import re

import numpy as np
import pytest

import fe_reference
from fe_reference import DEFAULT_EFFECTS, Model, cross_axis_pivot, solve_mechanism, solve_statics
from tests.fe.scenes import pivot
from tests.frames import heavy
from tests.gates import hold
from tests.models import extrapolated
from tests.refusals import scene
from tests.table_one import BARE


def pressed(force: float = 20e3, elements: int = 20) -> Model:
    """Return a pivot of steel strips, 300 x 50 x 3 mm at 60 deg, crossing in the middle, pressed down."""
    sides = {"length": 0.3, "inclination": np.pi / 3.0, "width": 50e-3, "thickness": 3e-3}
    loaded = scene(DEFAULT_EFFECTS, applied_force={"force": (0.0, -force)})
    return cross_axis_pivot(**BARE | sides | loaded, elements=elements)


#: Load at which the clamped strips of the pressed pivot buckle [N].
STRIPS_BUCKLE = 4.0 * np.pi**2 * 206e9 * 50e-3 * 3e-3**3 / 12.0 / 0.3**2 * 2.0 * np.sin(np.pi / 3.0)


def test_a_hanging_column_does_not_gain_whole_turns() -> None:
    """At twelve times Euler's load the body hangs in one place for any increments, turned by under pi."""
    hanging = heavy(fe_reference, 30.0, elements=10)
    places = [solve_mechanism(hanging, increments=k).bodies["tip"][-1] for k in (3, 10)]
    assert np.allclose(*places, rtol=1e-8, atol=1e-12)
    assert -np.pi < places[0][2] < -0.9 * np.pi


def test_strips_of_a_pressed_pivot_buckle_where_euler_says() -> None:
    """With its rotation held the pivot's strips buckle at 2 sin 60 deg times the load of one of them."""

    def error(elements: tuple[int, ...] = (10, 20, 40)) -> float:
        found = []
        for count in elements:
            path = solve_statics(pressed(elements=count), rotation=0.0, increments=4, check=False)
            _, strips = path.critical_points
            found.append(20e3 * strips.load_factor)
        return float(abs(extrapolated(found) / STRIPS_BUCKLE - 1.0))

    hold("fe_pressed_pivot", error)


def test_a_bifurcation_is_where_it_is_for_any_increments() -> None:
    """It is placed by the eigenvalue that vanishes there, not by the increment that passes it."""
    paths = [
        solve_statics(pressed(elements=8), rotation=0.0, increments=k, check=False).critical_points
        for k in (3, 4)
    ]
    assert [point.kind for point in paths[0]] == ["limit point", "bifurcation"]
    assert paths[0][1].load_factor == pytest.approx(paths[1][1].load_factor, rel=1e-9)


def test_a_pressed_pivot_says_what_buckles() -> None:
    """A free pivot tips first and its strips buckle later."""
    answer = solve_mechanism(pressed(elements=8), increments=4, check=False)
    tips, strips = answer.critical_points
    assert tips.inertia == 1
    assert strips.inertia == answer.inertia[-1] > 1
    assert re.search(r"give way with the body at 2\.\d+ kN, load factor 0\.1", answer.message)
    assert re.search(r"the strips buckle at 1[78]\.\d+ kN, load factor 0\.9", answer.message)
    assert "the last state is unstable" in answer.message


def test_a_pressed_pivot_that_turns_stops_where_it_buckles() -> None:
    """Turned by a hundredth of a degree the pivot has no equilibrium beyond a load just below Euler's."""
    turned = {"rotation": np.radians(0.01), "order": "together", "increments": 4, "raise_on_failure": False}
    answer = solve_statics(pressed(elements=8), **turned)
    assert answer.status.value == "not_converged"
    assert not answer.inertia.any()
    straight = solve_statics(pressed(elements=8), rotation=0.0, increments=4).critical_points[1].load_factor
    (limit,) = (point for point in answer.critical_points if point.kind == "turning point")
    assert 0.99 * straight < limit.load_factor < straight
    assert limit.inertia == 1
    assert re.search(
        r"turning point: the strips buckle at 1\d\.\d+ kN, rotation 0\.009\d+ deg, ", answer.message
    )


def test_a_driven_body_without_stiffness_would_tip_over() -> None:
    """Where the stiffness of a driven turn at fixed loads vanishes is a limit point, and in words."""
    how = {"rotation": np.radians(1.0), "increments": 20, "order": "together"}
    answer = solve_statics(pressed(force=8e3, elements=8), **how)
    (point,) = answer.critical_points
    assert (point.kind, point.inertia) == ("limit point", 0)

    def error(elements: int = 8) -> float:
        path = solve_statics(pressed(force=8e3, elements=elements), **how)
        zero = np.interp(0.0, -path.stiffness, path.load_factor)
        return abs(point.load_factor - float(zero))

    hold("fe_tipping", error)
    assert point.rotation == pytest.approx(point.load_factor * np.radians(1.0))
    assert re.match(
        r"limit point: .* released, it tips over at 2\.08\d kN, rotation 0\.26\d+ deg", answer.message
    )


def test_a_stationary_torque_without_loads_is_nothing_to_warn_of() -> None:
    """The torque of Table 1 has a limit before 320 deg, and the message is empty."""
    answer = solve_statics(pivot(elements=10), rotation=np.radians(320), increments=40)
    (point,) = answer.critical_points
    assert (point.kind, point.inertia, answer.message) == ("limit point", 0, "")
    most = int(np.abs(answer.torque).argmax())
    assert abs(point.rotation - answer.rotation[most]) < np.radians(320) / 40
