"""Strips in segments: pieces of a strip with frames between them answer as the whole strip does."""

import math
from dataclasses import replace

import numpy as np
import pytest

import spline_model
from spline_model import (
    DEFAULT_EFFECTS,
    cross_axis_pivot,
    solve_mechanism,
    solve_statics,
    strip_fields,
)
from tests import gates
from tests.frames import one_strip
from tests.table_one import TABLE_ONE

SIDES = {"width": 0.03, "thickness": 0.002}
WIDE = {name: value for name, value in TABLE_ONE.items() if name not in ("area", "second_moment_of_area")}
WIDE = WIDE | SIDES
#: Effects that act along a whole strip, and what they are given.
ALONG = ("gravity", "pre_strain", "clamped_width")
GIVEN = {"gravity": {"acceleration": (2e2, -9e2)}, "pre_strain": {"strain": 1e-3}, "clamped_width": {}}
PLACES = ("shape", "axial_force", "bending_moment", "shear_force", "clamp_reactions", "bodies")


def apart(one, other, names):
    """Largest difference of arrays of two answers, each over the largest magnitude."""
    pairs = [(getattr(one, name), getattr(other, name)) for name in names]
    pairs = [
        (next(iter(a.values())), next(iter(b.values()))) if isinstance(a, dict) else (a, b) for a, b in pairs
    ]
    return max(float(np.abs(a - b).max() / np.abs(b).max()) for a, b in pairs)


def made(**grid):
    """The pivot of Table 1 with wide strips and effects along them."""
    return cross_axis_pivot(**WIDE, effects=(*DEFAULT_EFFECTS, *ALONG), parameters=GIVEN, **grid)


def test_a_pivot_in_segments_answers_as_a_whole_one():
    """Forces, shapes, reactions and fields along the strips are those of one curve with many points."""

    def error(segments=3, control_points=9):
        pivots = made(segments=segments, control_points=control_points), made(control_points=17)
        paths = [replace(solve_statics(each, rotation=0.9, increments=3), balanced=True) for each in pivots]
        fields = [strip_fields(each, path.states) for each, path in zip(pivots, paths, strict=True)]
        curves = ("arc_length", "rest_shape", "rotation", "stretch", "reactions", "rest_bodies")
        numbers = ("torque", "stiffness", "work", "bending_energy", "own_stiffness")
        return max(apart(*paths, (*PLACES, *numbers)), apart(*fields, curves))

    gates.hold("spline_segments", error)


@pytest.mark.slow
def test_a_strip_in_tension_is_resolved_by_default():
    """Under a pull of 1e4 EI/L^2 a tip turns in a layer a hundredth of the strip long.

    Exact of a half-infinite strip, of which the rest is e^-100 away: what is the same all along it is
    M^2 / 2 EI + F cos(turn) + (F cos(turn))^2 / 2 EA.
    """
    pull, turn = 1e4, 0.5
    section = {"area": 12e6, "second_moment_of_area": 1.0, "youngs_modulus": 1.0, "density": 1.0}
    pulled = {"applied_force": {"force": (pull, 0.0)}}
    strip = one_strip(spline_model, pulled, pulled, end=(1.0, 0.0), section=section)
    path = solve_mechanism(strip, rotation=turn, increments=4)
    stored = pull * (1.0 - math.cos(turn)) + (pull * math.sin(turn)) ** 2 / (2.0 * 12e6)
    assert path.segments > 1
    assert path.torque[-1] == pytest.approx(math.sqrt(2.0 * stored), rel=1e-4)
