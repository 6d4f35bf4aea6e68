"""Effects: the named frozen values a scene is made of."""

from spline_model.effects.constraints import (
    ALWAYS,
    GROUND,
    Clamp,
    DrivenDisplacement,
    DrivenRotation,
)
from spline_model.effects.damping import BodyDamper, StripDamping, StripDrag
from spline_model.effects.elastic import MEASURES, Bending, MixedStretching, RootCompliance, Stretching
from spline_model.effects.inertia import BodyInertia, SectionRotaryInertia, StripInertia
from spline_model.effects.loads import AppliedForce, AppliedMoment, BodyGravity, StripGravity, TipForce

__all__ = [
    "ALWAYS",
    "GROUND",
    "MEASURES",
    "AppliedForce",
    "AppliedMoment",
    "Bending",
    "BodyDamper",
    "BodyGravity",
    "BodyInertia",
    "Clamp",
    "DrivenDisplacement",
    "DrivenRotation",
    "MixedStretching",
    "RootCompliance",
    "SectionRotaryInertia",
    "Stretching",
    "StripDamping",
    "StripDrag",
    "StripGravity",
    "StripInertia",
    "TipForce",
]
