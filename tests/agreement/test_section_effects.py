"""Plate action and roots, each model by its own laws: at large rotations both agree."""

from functools import partial

import numpy as np
import pytest

import fe_reference
import spline_model
from tests import gates
from tests.models import refined
from tests.table_one import BARE

PLAIN = ("bending", "stretching", "strip_inertia", "body_inertia")
EFFECTS = ("clamped_width", "anticlastic", "root_compliance")
#: Width and thickness [m]: Table 1's, and a wide thin strip that flattens as it bends.
SECTIONS = {"table 1": (0.01, 0.005), "wide": (0.04, 0.0005)}
INCREMENTS = 18
#: Gates without and with roots, which are a smooth profile in the splines and springs in the elements.
TORQUE = ("section_effects_torque", "section_effects_torque_with_roots")


def scene(section, effects):
    """What both models are given for a section and effects beside the plain ones."""
    width, thickness = SECTIONS[section]
    roots = {"root_compliance": {"root": "monolithic"}} if EFFECTS[2] in effects else {}
    return {"effects": (*PLAIN, *effects), "parameters": roots, "width": width, "thickness": thickness}


def difference(section, effects, *, control_points=14):
    """Largest difference of torques to a quarter turn, over the largest, of the elements in the limit."""
    given, path = scene(section, effects), {"rotation": np.pi / 2, "increments": INCREMENTS}

    def torque(models=fe_reference, **grid):
        return models.solve_statics(models.cross_axis_pivot(**BARE, **given, **grid), **path).torque

    limit, found = refined(torque, (20, 40)), torque(spline_model, control_points=control_points)
    return float(np.abs(found - limit).max() / np.abs(limit).max())


@pytest.mark.parametrize("section", SECTIONS)
@pytest.mark.parametrize("effects", [*((name,) for name in EFFECTS), EFFECTS], ids="+".join)
def test_models_agree_at_large_rotations(section, effects):
    """Requirement: with each effect and all, both models agree to a quarter turn as they do without."""
    gates.check(TORQUE[EFFECTS[2] in effects], difference(section, effects))
    if (section, effects) == ("wide", EFFECTS):
        gates.refuse(TORQUE[1], partial(difference, section, effects))


def test_roots_of_a_turned_pivot_vibrate_alike():
    """Requirement: about a large rotation both models give roots the same modes, those of the strips too."""
    given, about = scene("table 1", ("root_compliance",)), {"rotation": 1.0, "count": 3}

    def frequency(models=fe_reference, **grid):
        return models.natural_frequencies(models.cross_axis_pivot(**BARE, **given, **grid), **about).frequency

    limit = refined(frequency, (10, 20))

    def apart(control_points=8, segments=1):
        found = frequency(spline_model, control_points=control_points, segments=segments)
        return np.abs(found / limit - 1.0)

    # higher modes bend where a root's polynomial is coarse
    gates.hold("modes_of_turned_roots_in_one_piece", lambda control_points=8: apart(control_points).max())
    gates.hold("modes_of_turned_roots", lambda segments=4: max(apart()[0], apart(segments=segments).max()))
