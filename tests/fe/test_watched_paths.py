"""Static paths are watched: one state for any increments, and told where it is or became unstable."""

import re
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from fe_reference import (
    ELEMENTS,
    BodyDesign,
    Model,
    StripDesign,
    compliant_mechanism,
    cross_axis_pivot,
    solve_mechanism,
    solve_statics,
)
from tests.fe.cases import extrapolated, pivot
from tests.gates import hold

#: Spring steel, 100 mm x 10 mm x 0.5 mm.
LENGTH = 0.1
SECTION: dict[str, float] = {
    "area": 5e-6,
    "second_moment_of_area": 1.0416667e-13,
    "youngs_modulus": 206e9,
    "poisson_ratio": 0.29,
    "density": 7800.0,
}
EI = SECTION["youngs_modulus"] * SECTION["second_moment_of_area"]
EULER = EI / LENGTH**2
DEFAULT = ("bending", "stretching", "strip_inertia", "body_inertia")
PUSHED = (-1.3e-3, 13e-3)


def lever(elements: int = 10, element: str = "corotational") -> Model:
    """Return a horizontal strip with a body at its tip, 10 mm long."""
    strip = StripDesign(name="strip", start=(0.0, 0.0), end=(LENGTH, 0.0), tip="tip", **SECTION)
    body = BodyDesign(name="tip", centre=(0.11, 0.0), mass=0.05)
    return compliant_mechanism(strips=[strip], bodies=[body], elements=elements, element=element)


def column(load: float, elements: int = 10, element: str = "corotational", aside: float = 1e-3) -> Model:
    """Return an upright strip without weight that carries a weight of `load` EI/L^2, 1 mm beside its tip."""
    section = {**SECTION, "density": 1e-9}
    strip = StripDesign(name="strip", start=(0.0, 0.0), end=(0.0, LENGTH), tip="tip", **section)
    body = BodyDesign(name="tip", centre=(aside, LENGTH), mass=load * EULER)
    return compliant_mechanism(
        strips=[strip],
        bodies=[body],
        elements=elements,
        element=element,
        effects=(*DEFAULT, "gravity"),
        parameters={"gravity": {"acceleration": (0.0, -1.0)}},
    )


def stretched(load: float, elements: int = 10, element: str = "corotational") -> Model:
    """Return a strip between two clamps that would be longer by a natural strain of `load` EI/(EA L^2)."""
    strip = StripDesign(name="strip", start=(0.0, 0.0), end=(LENGTH, 0.0), tip="ground", **SECTION)
    strain = load * EULER / (SECTION["youngs_modulus"] * SECTION["area"])
    return compliant_mechanism(
        strips=[strip],
        elements=elements,
        element=element,
        effects=("bending", "stretching", "strip_inertia", "pre_strain"),
        parameters={"pre_strain": {"strain": strain}},
    )


def pressed(force: float = 20e3, elements: int = 20) -> Model:
    """Return a pivot of steel strips, 300 x 50 x 3 mm at 60 deg, crossing in the middle, pressed down."""
    area, moment = 50e-3 * 3e-3, 50e-3 * 3e-3**3 / 12.0
    return cross_axis_pivot(
        length=0.3,
        inclination=np.pi / 3.0,
        crossing_ratio=0.5,
        area=area,
        second_moment_of_area=moment,
        youngs_modulus=206e9,
        poisson_ratio=0.3,
        density=7850.0,
        body_mass=1.0,
        body_moment_of_inertia=0.01,
        effects=(*DEFAULT, "applied_force"),
        parameters={"applied_force": {"force": (0.0, -force)}},
        elements=elements,
    )


#: Load at which the clamped strips of the pressed pivot buckle [N].
STRIPS_BUCKLE = 4.0 * np.pi**2 * 206e9 * 50e-3 * 3e-3**3 / 12.0 / 0.3**2 * 2.0 * np.sin(np.pi / 3.0)


def lead(displacement: tuple[float, float], increments: int, **discretisation: Any) -> Any:
    answer = solve_mechanism(lever(**discretisation), displacement=displacement, increments=increments)
    assert answer.message == ""
    assert not answer.inertia.any()
    stored = answer.strain_energy[-1]
    assert abs(answer.work[-1] - stored) <= 0.01 * stored
    return np.array([stored, answer.bodies["tip"][-1, 2]])


@pytest.mark.slow
@pytest.mark.parametrize("elements", [20, 80])
@pytest.mark.parametrize("displacement", [PUSHED, (-1.5e-3, 15e-3)])
def test_no_number_of_increments_changes_the_state(displacement: tuple[float, float], elements: int) -> None:
    """A led body ends in the same state after 5, 20, 200 and 1000 increments, on coarse and fine meshes."""
    first, *others = (lead(displacement, k, elements=elements) for k in (5, 20, 200, 1000))
    assert all(np.allclose(other, first, rtol=1e-7, atol=0.0) for other in others)


def test_a_led_body_is_where_it_should_be() -> None:
    """Energy and rotation of the led body are those of a shooting solution: 9.47e-3 J, 14.77 deg."""

    def error(elements: int = 20) -> float:
        energy, turn = lead(PUSHED, 5, elements=elements)
        return float(max(abs(energy / 9.47e-3 - 1.0), abs(np.degrees(turn) / 14.77 - 1.0)))

    hold("fe_led_body", error)


def test_a_led_pivot_ends_in_one_state() -> None:
    """Table 1 led aside and turned has the same torque after 4 and 20 increments."""
    given = {"driven_displacement": {"displacement": (0.5e-3, -0.5e-3)}}
    model = pivot(effects=(*DEFAULT, *given), parameters=given, elements=10)
    one, other = (solve_statics(model, rotation=np.radians(20.0), increments=k) for k in (4, 20))
    assert one.torque[-1] == pytest.approx(other.torque[-1], rel=1e-10)
    assert not one.inertia.any()
    assert not other.inertia.any()


def hanging(load: float) -> float:
    """Return the turn of the tip [rad] of the column on the branch that grows from rest.

    EI phi'' = -P sin phi for the angle phi to the right of upright, EI phi' = P e cos phi at the tip.
    """

    def tip(slope: float) -> tuple[float, float]:
        found = solve_ivp(
            lambda _, y: (y[1], -load * np.sin(y[0])), (0.0, 1.0), (0.0, slope), rtol=1e-8, atol=1e-10
        )
        return float(found.y[0, -1]), float(found.y[1, -1])

    def gap(slope: float) -> float:
        angle, rate = tip(slope)
        return rate - load * 1e-3 / LENGTH * np.cos(angle)

    slopes = np.linspace(0.05, 12.0, 41)
    gaps = [gap(slope) for slope in slopes]
    k = next(k for k in range(len(slopes) - 1) if gaps[k] < 0.0 <= gaps[k + 1])
    return -tip(brentq(gap, slopes[k], slopes[k + 1], xtol=1e-9))[0]


def test_a_column_bends_under_its_weight() -> None:
    """Beyond Euler's load the weight bends a column to the side it stands on, as the elastica has it."""

    def error(elements: int = 40) -> float:
        errors = []
        for load in (3.0, 5.0):
            answer = solve_mechanism(column(load, elements=elements), increments=5)
            assert not answer.inertia.any()
            errors.append(abs(answer.bodies["tip"][-1, 2] / hanging(load) - 1.0))
        return float(max(errors))

    hold("fe_heavy_column", error)


def test_a_hanging_column_does_not_gain_whole_turns() -> None:
    """At twelve times Euler's load the body hangs in one place for any increments, turned by under pi."""
    places = [solve_mechanism(column(30.0), increments=k).bodies["tip"][-1] for k in (3, 10)]
    assert np.allclose(*places, rtol=1e-8, atol=1e-12)
    assert -np.pi < places[0][2] < -0.9 * np.pi


@pytest.mark.parametrize("element", [ELEMENTS[0], pytest.param(ELEMENTS[1], marks=pytest.mark.slow)])
def test_a_stretched_strip_tells_that_it_is_unstable(element: str) -> None:
    """Between clamps a strip that would be longer buckles at 4 pi^2 EI/L^2; beyond, the answer says so."""

    def error(elements: tuple[int, ...] = (10, 20, 40)) -> float:
        found = []
        for count in elements:
            answer = solve_mechanism(stretched(80.0, count, element), increments=1, check=False)
            assert "load factor 0; the last state is unstable" in answer.message
            (point,) = answer.critical_points
            assert (point.kind, point.load_factor, point.inertia) == ("bifurcation", 0.0, 1)
            told = re.search(r"the strips buckle at ([\d.]+) % of the natural strains", answer.message)
            found.append(0.8 * float(told.group(1)) if told else np.nan)
        return float(abs(extrapolated(found) / (4.0 * np.pi**2) - 1.0))

    hold(f"fe_stretched_strip_{element}", error)
    assert solve_mechanism(stretched(41.0, 40, element), increments=1).inertia.all()
    sound = solve_mechanism(stretched(39.0, 40, element), increments=1)
    assert sound.message == ""
    assert not sound.inertia.any()


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


def test_loads_grow_at_rotation_zero() -> None:
    """A pivot held at rotation 0 takes its loads in equal steps, and their work is what the strips store."""
    answer = solve_statics(pressed(force=15e3, elements=8), rotation=0.0, increments=4)
    assert np.array_equal(answer.load_factor, [0.0, 0.25, 0.5, 0.75, 1.0])
    assert np.array_equal(answer.rotation, np.zeros(5))
    assert not answer.inertia.any()

    def error(increments: int = 4) -> float:
        found = solve_statics(pressed(force=15e3, elements=8), rotation=1e-5, increments=increments)
        return float(abs(found.work[-1] / found.strain_energy[-1] - 1.0))

    hold("fe_work_of_held_loads", error)


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
        r"limit point: .* let go it tips over at 2\.08\d kN, rotation 0\.26\d+ deg", answer.message
    )


def test_a_stationary_torque_without_loads_is_nothing_to_warn_of() -> None:
    """The torque of Table 1 has a limit before 320 deg, and the message is empty."""
    answer = solve_statics(pivot(elements=10), rotation=np.radians(320), increments=40)
    (point,) = answer.critical_points
    assert (point.kind, point.inertia, answer.message) == ("limit point", 0, "")
    most = int(np.abs(answer.torque).argmax())
    assert abs(point.rotation - answer.rotation[most]) < np.radians(320) / 40
