"""Linear modes against the roots of the beam's characteristic equations."""

import math

import numpy as np

from spline_model import cross_axis_pivot, natural_frequencies
from tests.table_one import SIX, TABLE_ONE


def test_modes_about_a_bent_state():
    """Requirement: held or released, about rest and about 90 deg, modes come sorted and with shapes."""
    pivot = cross_axis_pivot(**SIX)
    rest, bent = natural_frequencies(pivot), natural_frequencies(pivot, rotation=math.pi / 2)
    held = natural_frequencies(pivot, rotation=math.pi / 2, held=True)
    for modes in (rest, bent, held):
        assert (np.diff(modes.frequency) >= 0).all()
        assert modes.shapes.shape == (len(modes.frequency), 2, 61, 2)
        assert modes.body_shapes.shape == (len(modes.frequency), 3)
    assert 70 < rest.frequency[0] < 80
    assert held.frequency[0] > 5 * bent.frequency[0]  # without the swing only the strips vibrate
    assert np.abs(held.body_shapes[:, 2]).max() < 1e-9 * np.abs(bent.body_shapes[:, 2]).max()


def test_slide_modes_are_named_not_counted():
    """Requirement: the control points' sliding appears apart from the pivot's own modes."""
    with_slide = natural_frequencies(cross_axis_pivot(**TABLE_ONE, control_points=8), count=5)
    without = natural_frequencies(cross_axis_pivot(**TABLE_ONE, control_points=8, axial_modes=7), count=5)
    assert len(with_slide.slide_frequency) == 2
    assert len(without.slide_frequency) == 0
    # at rest sliding and bending do not couple: the bending modes are the same to round-off
    assert np.abs(with_slide.frequency / without.frequency - 1).max() < 1e-7
