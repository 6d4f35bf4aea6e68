"""Bad parameters and failed solves are refused in words, with evidence."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from fe_reference import (
    FREE,
    Body,
    ConvergenceError,
    InvalidParameter,
    Model,
    Section,
    Status,
    Strip,
    cross_axis_pivot,
    solve_loads,
    solve_statics,
)
from tests.fe.cases import SECTION, TABLE_1, cantilever, flat_strip, pivot


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        (
            "poisson_ratio",
            0.5,
            "poisson_ratio: got 0.5, expected a number between -1 and 0.5, both excluded [1]",
        ),
        ("centre_offset", (0.0,), "centre_offset: got (0.0,), expected two finite numbers [m]"),
        ("centre_offset", np.array(0.1), "centre_offset: got array(0.1), expected two finite numbers [m]"),
    ],
)
def test_bad_parameter_is_one_clear_line(name: str, value: Any, message: str) -> None:
    """A bad parameter is refused with its name, the value, what is expected and the unit."""
    with pytest.raises(InvalidParameter) as refusal:
        pivot(**{name: value})
    assert str(refusal.value) == message
    assert refusal.value.name == name


SIDES = {"width": 0.01, "thickness": 0.005}
BARE = {name: value for name, value in TABLE_1.items() if name not in ("area", "second_moment_of_area")}


def test_sides_make_the_section() -> None:
    """Width and thickness give area and second moment; printed ones beside them hold."""
    section = cross_axis_pivot(**BARE, **SIDES).strips[0].section
    assert (section.area, section.second_moment_of_area) == (0.01 * 0.005, 0.01 * 0.005**3 / 12.0)
    rounded = cross_axis_pivot(**TABLE_1, **SIDES).strips[0].section
    assert rounded.flexural_rigidity == cross_axis_pivot(**TABLE_1).strips[0].section.flexural_rigidity


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"width": 0.01}, "thickness: got None, expected a finite number [m]"),
        ({"width": -1.0, "thickness": 1.0}, "width: got -1.0, expected a number above 0 [m]"),
        (
            SIDES | {"second_moment_of_area": 1.05e-10},
            "second_moment_of_area: got 1.05e-10, expected 1.04167e-10, that of width and thickness [m^4]",
        ),
        ({"area": 5e-5}, "second_moment_of_area: got 'nothing', expected it, or width and thickness of a"),
        ({}, "area: got 'nothing', expected it, or width and thickness of a rectangle [m]"),
    ],
)
def test_sides_that_make_no_section_are_refused(given: dict[str, Any], message: str) -> None:
    """One side alone, none, or a section that contradicts its sides is refused in one line."""
    with pytest.raises(InvalidParameter) as refusal:
        cross_axis_pivot(**BARE, **given)
    assert str(refusal.value).startswith(message)


def test_bad_load_and_geometry_are_refused() -> None:
    """Loads of the wrong shape, folded meshes and unequal strips are refused."""
    with pytest.raises(InvalidParameter, match=r"force: got .*, expected two components \[N\]"):
        solve_loads(cantilever(elements=2), force=(1.0, 2.0, 3.0))
    with pytest.raises(InvalidParameter, match="coincident neighbours"):
        Strip(section=SECTION, nodes=np.zeros((3, 2)))
    with pytest.raises(InvalidParameter, match="finite positions"):
        Strip(section=SECTION, nodes=np.zeros(3))
    with pytest.raises(InvalidParameter, match="centre: got nan, expected a finite number"):
        Body(centre=np.array([np.nan, 0.0]))
    with pytest.raises(InvalidParameter, match="above 0"):
        Section(area=1.0, second_moment_of_area=1.0, youngs_modulus=1.0, poisson_ratio=0.3, density=0.0)
    strips = tuple(map(flat_strip, (2, 3)))
    with pytest.raises(InvalidParameter, match="same number of nodes"):
        Model(strips=strips, bodies=(Body(centre=np.zeros(2)),))


def test_model_without_clamps_is_refused() -> None:
    """A model that nothing holds has no static solution."""
    free = cantilever(elements=2)
    strip = replace(free.strips[0], root=FREE)
    with pytest.raises(InvalidParameter, match="nothing holds body body against turning"):
        solve_loads(replace(free, strips=(strip,)), moment=1.0)


def test_rest_is_a_path_too() -> None:
    """A path of no rotation stays at rest."""
    solution = solve_statics(pivot(elements=4), rotation=0.0, increments=2)
    assert solution.status is Status.CONVERGED
    assert not solution.torque.any()
    assert np.all(solution.stiffness == solution.stiffness[0])


def test_failed_path_keeps_what_converged() -> None:
    """A drive of more than six turns in four increments fails; the error carries what was reached."""
    calls: list[tuple[int, int]] = []
    with pytest.raises(ConvergenceError, match=r"between rotation .* halvings of the increment") as failure:
        solve_statics(
            pivot(elements=8),
            rotation=40.0,
            increments=4,
            check=False,
            progress=lambda *call: calls.append(call),
        )
    solution = failure.value.solution
    reached = len(solution.torque) - 1
    assert calls == [(k, 4) for k in range(1, reached + 1)]
    assert solution.status is Status.NOT_CONVERGED
    assert solution.status.text.endswith("use more increments or a finer mesh.")
    assert failure.value.load_factor == reached / 4.0
    assert len(failure.value.history) > 0
    assert solution.message in str(failure.value)


def test_failed_path_is_returned_on_request() -> None:
    """The same failure is a status for who asks for it."""
    solution = solve_statics(pivot(elements=8), rotation=40.0, increments=4, raise_on_failure=False)
    assert solution.status is Status.NOT_CONVERGED
    assert np.isfinite(solution.torque).all()
    assert solution.counters["increments"] == len(solution.torque) - 1


def test_converged_path_reports_its_work() -> None:
    """The paper's path takes twenty increments of at most four iterations, and says so."""
    solution = solve_statics(pivot(), rotation=np.pi / 2.0)
    assert solution.status is Status.CONVERGED
    assert solution.message == ""
    assert solution.counters["increments"] == 20
    assert solution.counters["halvings"] == 0
    assert solution.counters["newton_iterations"] == sum(len(norms) - 1 for norms in solution.history) <= 80
    assert solution.stations.shape == (21,)
    assert solution.shape.shape == (21, 2, 21, 2)
    assert solution.clamp_reactions.shape == (21, 2, 2, 3)
