"""Statics of mechanisms and of effects: closed forms, a published value, balance, frame indifference."""

from typing import Any

import numpy as np
import pytest

from fe_reference import ELEMENTS, solve_loads, solve_mechanism, solve_statics
from studies.published.case import published
from tests.fe.cases import (
    EI,
    QUICK_ELEMENTS,
    extrapolated,
    pivot,
    rotated,
    rotation_matrix,
)
from tests.fe.scenes import APART, GUIDE, LINK, PARAMETERS, WIDE, four_bar, free_cantilever, guide
from tests.gates import hold

SOFT = {
    "area": 1e-3,
    "second_moment_of_area": 833.333e-9,
    "youngs_modulus": 1e9,
    "poisson_ratio": 0.3,
    "density": 78e3,
}
STATIC = {name: PARAMETERS[name] for name in ("gravity", "applied_force", "applied_moment", "pre_strain")}


def test_cantilever_under_its_own_weight() -> None:
    """The tip of a soft cantilever hangs where it was published.

    L = 2 m, EI = 833.333 N m^2, EA = 1e6 N, 78 kg/m; the value in print with its source is the suite's
    published problem of that name.
    """

    def error(elements: tuple[int, ...] = (16, 32, 64)) -> float:
        weight = {"gravity": {"acceleration": (0.0, -9.81)}}
        tips = [
            solve_mechanism(
                free_cantilever(length=2.0, section=SOFT, parameters=weight, elements=n), increments=8
            ).shape[-1, 0, -1, 0]
            for n in elements
        ]
        return float(abs(extrapolated(tips) - 2.0 - published("own_weight").values[0].published))

    hold("fe_own_weight", error)


@pytest.mark.parametrize("element", QUICK_ELEMENTS)
def test_natural_curvature_gives_a_stress_free_arc(element: str) -> None:
    """A strip with natural curvature and strain lies on the arc of that radius, without energy."""
    curvature, strain = 0.75 * np.pi / GUIDE, 0.02
    given = {"pre_strain": {"curvature": curvature, "strain": strain}}
    radius = (1.0 + strain) / curvature
    angle = curvature * GUIDE

    def error(elements: tuple[int, ...] = (10, 20, 40)) -> float:
        runs = [
            solve_mechanism(free_cantilever(parameters=given, elements=n, element=element)) for n in elements
        ]
        exact = radius * np.array([np.sin(angle), 1.0 - np.cos(angle)])
        return float(np.abs(extrapolated([run.shape[-1, 0, -1] for run in runs]) - exact).max() / GUIDE)

    hold("fe_natural_arc", error)
    answer = solve_mechanism(free_cantilever(parameters=given, element=element))
    assert abs(answer.strain_energy).max() < 1e-12 * EI * curvature * angle
    assert answer.counters["settling_increments"] == 20


@pytest.mark.parametrize("element", QUICK_ELEMENTS)
def test_roots_do_not_turn_where_there_is_no_stress(element: str) -> None:
    """On the arc of its natural curvature a strip has no moment that would turn its clamp."""
    given: dict[str, Any] = {"pre_strain": {"curvature": 3.0}}
    stiff, soft = (
        solve_mechanism(free_cantilever(parameters=given | roots, element=element, section=WIDE)).shape[-1, 0]
        for roots in ({}, {"root_compliance": {"root": 3.0}})
    )
    assert np.abs(soft - stiff).max() < 1e-12 * GUIDE


def test_parallel_strip_guide() -> None:
    """The stage of a guide that does not turn has the stiffness of two clamped-guided strips, 24 EI / L^3."""

    def error(force: float = 1e-3) -> float:
        model = guide({"applied_force": {"force": (force, 0.0)}})
        moved = solve_mechanism(model, rotation=0.0, increments=1).bodies["stage"][-1, 0] - 0.5 * APART
        return float(abs(force / moved / (24.0 * EI / GUIDE**3) - 1.0))

    hold("fe_guide_stiffness", error)


def test_guide_led_by_its_displacement() -> None:
    """Led to where its load had brought it, the guide is in the same state, and the drives do its energy."""
    pushed = solve_mechanism(guide({"applied_force": {"force": (5000.0, 0.0)}}), rotation=0.0)
    place = pushed.bodies["stage"][-1] - pushed.bodies["stage"][0]

    def error(share: float = 1.0) -> float:
        moved = (share * float(place[0]), share * float(place[1]))
        led = solve_mechanism(guide(), displacement=moved, rotation=0.0, increments=40)
        gaps = (
            (led.shape[-1] - pushed.shape[-1]) / GUIDE,
            led.torque[-1] / pushed.torque[-1] - 1.0,
            led.work[-1] / pushed.strain_energy[-1] - 1.0,
        )
        return float(max(np.abs(gap).max() for gap in gaps))

    hold("fe_led_guide", error)
    named = solve_mechanism(guide({"driven_displacement": {"displacement": tuple(place[:2])}}), rotation=0.0)
    assert np.allclose(named.shape[-1], pushed.shape[-1], rtol=0.0, atol=1e-9 * GUIDE)


def test_four_bar_of_flexures() -> None:
    """For small loads the coupler of a parallelogram moves as strips with a rigid middle let it.

    Each side of height H = 2 l + a carries half the force F with its moment zero at mid height:
    u = F ((H/2)^3 - (a/2)^3) / (3 EI).
    """

    def error(force: float = 1e-3, short: float = 0.02) -> float:
        load = {"applied_force": {"force": (force, 0.0), "body": "coupler"}}
        answer = solve_mechanism(four_bar(load, short=short), body="coupler", rotation=0.0, increments=1)
        moved = answer.bodies["coupler"][-1, 0] - answer.bodies["coupler"][0, 0]
        turned = answer.bodies["crank"][-1, 2] / answer.bodies["rocker"][-1, 2]
        half = short + 0.5 * LINK
        exact = force * (half**3 - (0.5 * LINK) ** 3) / (3.0 * EI)
        return float(max(abs(moved / exact - 1.0), abs(turned - 1.0)))

    hold("fe_four_bar", error)


def test_named_loads_are_those_of_load_control() -> None:
    """Named force and moment do what `solve_loads` does with them, and act beside a driven rotation."""
    named = {"applied_force": {"force": (200.0, -300.0)}, "applied_moment": {"moment": 50.0}}
    model = pivot(effects=(*pivot().effects.names, *named), parameters=named)
    one = solve_loads(model)
    other = solve_loads(pivot(), force=(200.0, -300.0), moment=50.0)
    assert np.allclose(one.torque, other.torque, rtol=1e-12)
    assert np.allclose(one.centre, other.centre, rtol=1e-12)
    assert one.torque[-1] == pytest.approx(50.0, rel=1e-9)
    held = solve_statics(model, rotation=float(one.rotation[-1]))
    assert abs(held.torque[-1]) < 1e-12 * 50.0
    assert np.allclose(held.centre[-1], one.centre[-1], rtol=1e-9)


def test_curved_strip_is_free_of_stress_at_rest() -> None:
    """A strip with a rise lies on its arc, without stress, and its clamps point along it."""
    rise, short = 0.004, 0.02
    answer = solve_mechanism(four_bar(rise=rise, short=short))
    assert not answer.strain_energy.any()
    first = answer.shape[0, 0]
    assert first[0] == pytest.approx([0.0, 0.0], abs=1e-18)
    assert first[-1] == pytest.approx([0.0, short], abs=1e-17)
    assert first[10] == pytest.approx([-rise, 0.5 * short], rel=1e-14)
    radius = (short**2 / 4.0 + rise**2) / (2.0 * rise)
    reach = np.hypot(first[:, 0] - radius + rise, first[:, 1] - 0.5 * short)
    assert np.allclose(reach, radius, rtol=1e-14)


def all_static(**discretisation: Any) -> Any:
    return four_bar(STATIC, rise=0.002, **discretisation)


@pytest.mark.parametrize("element", QUICK_ELEMENTS)
def test_static_balance(element: str) -> None:
    """Work of drives and loads is the change of strain and gravity energy along the whole path."""

    def error(increments: int = 60) -> float:
        answer = solve_mechanism(
            all_static(element=element, elements=8), body="crank", rotation=0.6, increments=increments
        )
        stored = answer.strain_energy + answer.gravity_energy
        return float(np.abs(answer.work - (stored - stored[0])).max() / np.abs(answer.work).max())

    hold(f"fe_static_balance_{element}", error)


@pytest.mark.parametrize("element", QUICK_ELEMENTS)
def test_mechanism_does_not_depend_on_the_frame(element: str) -> None:
    """A four-bar turned as a whole with its gravity and its loads moves as before, turned."""

    def error(angle: float = 2.0) -> float:
        one, other = (
            solve_mechanism(model, body="crank", rotation=0.6)
            for model in (all_static(element=element), rotated(all_static(element=element), 2.0))
        )
        gaps = [(other.shape - one.shape @ rotation_matrix(angle).T) / GUIDE]
        gaps += [(other.torque - one.torque) / np.abs(one.torque).max()]
        return float(max(np.abs(gap).max() for gap in gaps))

    hold("fe_mechanism_rotated", error)


@pytest.mark.parametrize("element", ELEMENTS)
def test_mechanism_reactions_balance(element: str) -> None:
    """Without weight the bodies receive from the strips what drives and loads exert on them."""
    loads = {name: PARAMETERS[name] for name in ("applied_force", "applied_moment", "pre_strain")}

    def error(force: float = 2000.0) -> float:
        answer = solve_mechanism(four_bar(loads, element=element), body="crank", rotation=0.6)
        on_coupler = answer.clamp_reactions[-1, 1, 1, :2] + answer.clamp_reactions[-1, 2, 0, :2]
        on_crank = answer.clamp_reactions[-1, 0, 1, :2] + answer.clamp_reactions[-1, 1, 0, :2]
        gaps = on_coupler - [force, 1000.0], on_crank
        return float(max(np.abs(gap).max() for gap in gaps) / 2000.0)

    hold("fe_mechanism_reactions", error)
