"""Effects: the named frozen values a scene is made of."""

from spline_model.effects.constraints import GROUND, Clamp, DrivenRotation
from spline_model.effects.elastic import MEASURES, Bending, MixedStretching, Stretching
from spline_model.effects.inertia import BodyInertia, StripInertia
from spline_model.effects.loads import AppliedForce, AppliedMoment

__all__ = [
    "GROUND",
    "MEASURES",
    "AppliedForce",
    "AppliedMoment",
    "Bending",
    "BodyInertia",
    "Clamp",
    "DrivenRotation",
    "MixedStretching",
    "Stretching",
    "StripInertia",
]
