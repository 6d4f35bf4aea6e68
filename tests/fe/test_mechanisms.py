"""Statics of mechanisms and of effects: closed forms, a published value, balance, frame indifference."""

from typing import Any

import numpy as np
import pytest

from fe_reference import solve_mechanism, solve_statics
from tests.fe.cases import EI, QUICK_ELEMENTS, extrapolated, pivot
from tests.fe.scenes import GUIDE, PARAMETERS, WIDE, four_bar, free_cantilever, guide
from tests.gates import hold

STATIC = {
    name: PARAMETERS[name] for name in ("gravity", "applied_force", "applied_moment", "pre_strain", "spring")
}


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


def test_loads_reach_the_same_state_whatever_is_driven() -> None:
    """Where the loads turn the pivot to, a drive exerts nothing; a named drive is that of a request."""
    named = {"applied_force": {"force": (200.0, -300.0)}, "applied_moment": {"moment": 50.0}}
    model = pivot(effects=(*pivot().effects.names, *named), parameters=named)
    one = solve_mechanism(model)
    held = solve_statics(model, rotation=float(one.rotation[-1]))
    assert abs(held.torque[-1]) < 1e-12 * 50.0
    assert np.allclose(held.centre[-1], one.centre[-1], rtol=1e-9)
    led = {"displacement": (4e-3, -1e-4)}
    named_led = solve_mechanism(guide({"driven_displacement": led}), rotation=0.0)
    assert np.array_equal(named_led.states, solve_mechanism(guide(), rotation=0.0, **led).states)


def all_static(**discretisation: Any) -> Any:
    return four_bar(STATIC, rise=0.002, **discretisation)


@pytest.mark.parametrize("element", QUICK_ELEMENTS)
def test_static_balance(element: str) -> None:
    """Work of drives and loads is the change of strain and gravity energy along the whole path."""

    def error(increments: int = 60) -> float:
        answer = solve_mechanism(
            all_static(element=element, elements=8), body="crank", rotation=0.6, increments=increments
        )
        stored = answer.strain_energy + answer.spring_energy + answer.gravity_energy
        return float(np.abs(answer.work - (stored - stored[0])).max() / np.abs(answer.work).max())

    hold(f"fe_static_balance_{element}", error)
