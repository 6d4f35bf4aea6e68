"""The pivots that the sequential impulses are tried on, and the groups of modes that limit their step."""

import math
from dataclasses import replace
from functools import cache

from spline_model.pivot import Pivot
from studies.answers.models import built, model_of
from studies.answers.settings import SplineSettings
from studies.cases.problem import Problem, named_case

CASE = "cross_axis_pivot"

SETTINGS = SplineSettings(control_points=6)

#: Group of modes -> settings of a spline whose fastest mode belongs to it: strips that stretch, strips that
#: only bend, and strips whose shape follows the body, so that nothing but the swing is left.
GROUPS: dict[str, SplineSettings] = {
    "axial": SETTINGS,
    "bending": SplineSettings(control_points=5, axial_modes=4, stretch="inextensible", slide_stiffness=0.0),
    "swing": SplineSettings(control_points=4, axial_modes=3, stretch="inextensible", slide_stiffness=0.0),
}

#: Start of every release [rad].
START = math.pi / 2


def designs() -> dict[str, Problem]:
    """Return Table 1, and the same pivot with strips of a polymer, 10 mm x 0.8 mm, and a small body."""
    given = named_case(CASE)
    polymer = replace(
        given,
        area=8e-6,
        second_moment_of_area=1e-2 * 8e-4**3 / 12.0,
        youngs_modulus=2e9,
        density=1100.0,
        body_mass=0.05,
        body_moment_of_inertia=2e-5,
    )
    return {"Table 1": given, "polymer": polymer}


@cache
def pivot(design: str, settings: SplineSettings = SETTINGS) -> Pivot:
    """Return a design as a spline in motion."""
    found: Pivot = built(model_of(settings), designs()[design], settings, moving=True)[0]
    return found
