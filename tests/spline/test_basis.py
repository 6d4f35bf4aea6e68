"""Bases, axial modes and Gauss rules."""

import numpy as np
import pytest

from spline_model import InvalidParameter
from spline_model.basis import HatModes, LegendreModes, SlideModes, SplineBasis, bezier, cubic_bspline

ROUND_OFF = 5e-13  # degree 11 with derivatives that grow like n^2
U = np.linspace(0.0, 1.0, 33)


@pytest.mark.parametrize("basis", [bezier(4), bezier(12), cubic_bspline(5), cubic_bspline(40)], ids=repr)
def test_partition_of_unity_and_linear_precision(basis):
    """Requirement: the basis sums to one and Greville abscissae give back u: uniform speed at rest."""
    assert np.abs(basis.evaluate(U).sum(axis=1) - 1).max() < ROUND_OFF
    assert np.abs(basis.evaluate(U) @ basis.greville - U).max() < ROUND_OFF
    assert np.abs(basis.evaluate(U, 1) @ basis.greville - 1).max() < ROUND_OFF


def test_four_control_points_are_the_papers_blending_functions():
    """Requirement: n = 4 has the functions printed in Eq 3."""
    printed = np.column_stack(((1 - U) ** 3, 3 * U * (1 - U) ** 2, 3 * U**2 * (1 - U), U**3))
    assert np.abs(bezier(4).evaluate(U) - printed).max() < ROUND_OFF


def test_gauss_rule_is_exact_to_twice_its_points():
    """Requirement: k points in each span integrate degree 2 k - 1 exactly and degree 2 k not."""
    u, weight = cubic_bspline(6).gauss_rule(3)
    assert abs(weight @ u**5 - 1 / 6) < ROUND_OFF
    assert abs(weight @ u**6 - 1 / 7) > 1e-8


@pytest.mark.parametrize("n, m", [(4, 2), (6, 4), (8, 6), (8, 3)])
@pytest.mark.parametrize("kind", ["bezier", "bspline"])
def test_slide_modes_are_unseen_by_the_axial_modes(kind, n, m):
    """Requirement: slide modes are orthogonal to the axial modes, and both together span C'."""
    basis = bezier(n) if kind == "bezier" else cubic_bspline(n)
    axial = LegendreModes(count=m) if kind == "bezier" else HatModes(count=m)
    slide = SlideModes(basis=basis, axial=axial)
    # a B-spline's knots and the hats' kinks differ: integrate on the union of both
    fine = SplineBasis(control_points=(n - 3) * (m - 1) + 3, degree=3)
    u, weight = fine.gauss_rule(n + 2)
    first, values = axial.evaluate(u)
    full = np.zeros((len(u), m))
    np.put_along_axis(full, first[:, None] + np.arange(axial.width), values, axis=1)
    unseen = slide.evaluate(u)[1]
    assert unseen.shape == (len(u), n - 1 - m)
    if kind == "bezier" or m == n - 2:
        assert np.abs(full.T @ (weight[:, None] * unseen)).max() < ROUND_OFF


def test_too_few_control_points_are_refused():
    """Requirement: a degree that the control points cannot carry is refused with what was expected."""
    with pytest.raises(InvalidParameter, match=r"degree: got 3, expected an integer >= 0 and <= 2"):
        SplineBasis(control_points=3, degree=3)
