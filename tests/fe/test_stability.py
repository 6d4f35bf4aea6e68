"""Critical loads and what lies beyond them: a compressed column and a toggle as finite elements."""

from typing import Any

import numpy as np
import pytest

from fe_reference import BodyDesign, Model, StripDesign, compliant_mechanism, solve_mechanism
from tests.fe.cases import extrapolated
from tests.gates import hold

EULER = np.pi**2 / 4.0
#: In consistent units; mass and shear do not matter.
SECTION = {"youngs_modulus": 1.0, "poisson_ratio": 0.3, "density": 1.0}


def column(*, load: float, side: float = 0.0, slenderness: float = 1e3, **discretisation: Any) -> Model:
    """Return a column of length 1 and EI = 1, pushed at its free tip by `load`, and by `side` of it aside."""
    section = {**SECTION, "area": slenderness**2, "second_moment_of_area": 1.0}
    strip = StripDesign(name="column", start=(0.0, 0.0), end=(1.0, 0.0), tip="tip", **section)
    return compliant_mechanism(
        strips=[strip],
        bodies=[BodyDesign(name="tip", centre=(1.0, 0.0))],
        effects=("bending", "stretching", "applied_force"),
        parameters={"applied_force": {"body": "tip", "force": (-load, side * load)}},
        **discretisation,
    )


def test_a_column_buckles_at_its_critical_load() -> None:
    """The bifurcation of an extensible column is where theory has it, (1 - P/EA) P = Pe."""
    slenderness = 100.0
    exact = 0.5 * slenderness**2 * (1.0 - np.sqrt(1.0 - 4.0 * EULER / slenderness**2))

    def error(elements: tuple[int, ...] = (10, 20, 40)) -> float:
        found = []
        for count in elements:
            answer = solve_mechanism(column(load=4.0, slenderness=slenderness, elements=count))
            (point,) = answer.critical_points
            assert point.kind == "bifurcation"
            found.append(4.0 * point.load_factor)
        return abs(float(extrapolated(found)) / exact - 1.0)

    hold("fe_euler_load", error)


def test_a_bent_column_follows_the_elastica() -> None:
    """With a small side load the column bends smoothly to the elastica's angle at P = 2.5418 Pe, 140 deg."""

    def error(elements: int = 40) -> float:
        bent = column(load=EULER * 2.5422, side=1e-4, slenderness=1e4, elements=elements)
        answer = solve_mechanism(bent)
        assert answer.message == ""
        assert not answer.inertia.any()
        return float(abs(abs(np.degrees(answer.bodies["tip"][-1, 2])) - 140.0))

    hold("fe_bent_column", error)


def test_a_path_that_ends_at_a_limit_point_says_so() -> None:
    """Load control of a toggle stops at its limit point and names it, for any number of increments."""
    section = {**SECTION, "area": 1.885e6, "second_moment_of_area": 9.27e3}
    strips = [
        StripDesign(
            name=f"at {x}",
            start=(x, 0.0),
            end=(0.0, 0.386),
            tip="apex",
            **section,
        )
        for x in (-12.937, 12.937)
    ]
    toggle = compliant_mechanism(
        strips=strips,
        bodies=[BodyDesign(name="apex", centre=(0.0, 0.386))],
        effects=("bending", "stretching", "applied_force"),
        parameters={"applied_force": {"force": (0.0, -60.0)}},
        elements=6,
    )
    found = []
    for increments in (7, 20):
        answer = solve_mechanism(toggle, increments=increments, raise_on_failure=False)
        (limit,) = answer.critical_points
        assert (answer.status.value, limit.kind) == ("not_converged", "limit point")
        assert answer.message.startswith("limit point: the strips give way with the body at ")
        found.append(limit.load_factor)
    assert found[0] == pytest.approx(found[1], rel=1e-8)
    assert found[0] == pytest.approx(0.5749, rel=0.02)
