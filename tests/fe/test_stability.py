"""Inertia of the tangent, and arc length through limit points, of the finite elements."""

import numpy as np
import pytest
from fe_reference.arc_length import follow_arc

from fe_reference import solve_statics
from fe_reference.control import spans
from fe_reference.structure import structure_of
from tests import gates
from tests.fe.cases import extrapolated, observed_order, pivot
from tests.fe.frames import column, lees_frame, toggle
from tests.gates import hold

EULER = np.pi**2 / 4.0


def limits(control, load):
    """Return the loads of the critical points, all of them limit points."""
    path = follow_arc(control)
    assert {point.kind for point in path.critical} <= {"limit point"}
    return load * np.array([point.parameter for point in path.critical])


def test_inertia_counts_the_negative_eigenvalues():
    """The factorisation finds as many negative eigenvalues as there are, at stable and unstable states."""
    control = toggle(elements=6)
    path, seen = follow_arc(control), set()
    for state in path.states:
        y, parameter, negative = state.y, state.parameter, state.inertia
        balance = control.balance(y, parameter)
        block = balance.at.tangent.sparse().toarray()[np.ix_(control.free, control.free)]
        assert np.count_nonzero(np.linalg.eigvalsh(block) < 0.0) == negative
        assert control.factors(balance).negative == negative
        seen.add(int(negative))
    assert seen == {0, 1}
    assert path.message.startswith("limit point at load factor")


def euler_error(elements=(10, 20, 40), slenderness=100.0):
    """Return the error of the critical load of an extensible column, (1 - P/EA) P = Pe, extrapolated."""
    exact = 0.5 * slenderness**2 * (1.0 - np.sqrt(1.0 - 4.0 * EULER / slenderness**2))
    found = []
    for count in elements:
        (point,) = follow_arc(column(load=4.0, slenderness=slenderness, elements=count)).critical
        assert point.kind == "bifurcation"
        found.append(4.0 * point.parameter)
    return abs(float(extrapolated(found)) / exact - 1.0)


def test_a_column_buckles_at_its_critical_load():
    """The bifurcation of a compressed column is where theory has it."""
    hold("fe_euler_load", euler_error)


def test_a_bent_column_follows_the_elastica():
    """With a small side load the column bends smoothly to the elastica's angle at P = 2.5418 Pe, 140 deg."""

    def error(elements: int = 40) -> float:
        path = follow_arc(column(load=EULER * 2.5422, side=1e-4, slenderness=1e4, elements=elements))
        assert path.critical == ()
        assert max(state.inertia for state in path.states) == 0
        return float(abs(abs(np.degrees(path.states[-1].y[-1])) - 140.0))

    hold("fe_bent_column", error)


@pytest.mark.slow
def test_toggle_and_frame_converge_to_published_limits():
    """Limit loads of Williams' toggle and Lee's frame converge with order two to those in print."""
    for make, load, published, gate in (
        (toggle, 60.0, (33.9, 31.3), "fe_toggle_published"),
        (lees_frame, 3.0, (1.85, -0.94), "fe_lee_published"),
    ):
        found = [limits(make(elements=count), load) for count in (10, 20, 40)]
        assert abs(observed_order(found) - 2.0) < 0.15
        gates.check(gate, float(np.abs(extrapolated(found) - published).max()))
        with pytest.raises(AssertionError, match="x the gate"):
            coarse = limits(make(**gates.teeth(gate)), load)
            gates.check(gate, float(np.abs(coarse - published).max()))


def test_a_flatter_toggle_has_no_limit_point():
    """With a rise of 0.32 the load of the toggle only grows."""
    assert limits(toggle(rise=0.32, elements=20), 60.0).size == 0


def test_the_driven_pivot_ends_as_in_rotation_control():
    """Arc length and equal increments of the rotation end in the same torque."""
    model = pivot(elements=10)
    structure = structure_of(model)
    control = spans(structure, body=0, rotations=[1.5], watched=int(structure.turns[0]))[0]
    path, plain = follow_arc(control), solve_statics(model, rotation=1.5)
    assert path.critical == ()
    assert abs(path.states[-1].torque / plain.torque[-1] - 1.0) < 1e-9
