"""Dynamic splines: flexure strips as curves of a few control points.

What is imported from here is public; all else may change. Each name is loaded when it is first used.

    from spline_model import cross_axis_pivot, solve_statics

Data flow one way: design (`cross_axis_pivot`, `compliant_mechanism`) -> scene of effects -> strips as
elements between bodies -> statics, motion, modes, batches -> solution.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from spline_model.batch import solve_many as solve_many
    from spline_model.design import BodyDesign as BodyDesign
    from spline_model.design import StripDesign as StripDesign
    from spline_model.discretisation import motion_penalty_stiffness as motion_penalty_stiffness
    from spline_model.dynamics import solve_motion as solve_motion
    from spline_model.dynamics import solve_release as solve_release
    from spline_model.effects.boundary import DrivenDisplacement as DrivenDisplacement
    from spline_model.effects.boundary import DrivenRotation as DrivenRotation
    from spline_model.effects.plate import plate_factors as plate_factors
    from spline_model.effects.registry import DEFAULT_EFFECTS as DEFAULT_EFFECTS
    from spline_model.effects.registry import REGISTRY as REGISTRY
    from spline_model.errors import ConvergenceError as ConvergenceError
    from spline_model.errors import InvalidParameter as InvalidParameter
    from spline_model.held import HeldPivot as HeldPivot
    from spline_model.mechanism import Mechanism as Mechanism
    from spline_model.mechanism import compliant_mechanism as compliant_mechanism
    from spline_model.modes import natural_frequencies as natural_frequencies
    from spline_model.pivot import cross_axis_pivot as cross_axis_pivot
    from spline_model.section_forces import strip_fields as strip_fields
    from spline_model.sensitivity import sensitivities as sensitivities
    from spline_model.sequential_impulse import solve_impulses as solve_impulses
    from spline_model.solution import Status as Status
    from spline_model.statics import solve_mechanism as solve_mechanism
    from spline_model.statics import solve_statics as solve_statics

_HOMES = {
    "BodyDesign": "design",
    "ConvergenceError": "errors",
    "DEFAULT_EFFECTS": "effects.registry",
    "DrivenDisplacement": "effects.boundary",
    "DrivenRotation": "effects.boundary",
    "HeldPivot": "held",
    "InvalidParameter": "errors",
    "Mechanism": "mechanism",
    "REGISTRY": "effects.registry",
    "Status": "solution",
    "StripDesign": "design",
    "compliant_mechanism": "mechanism",
    "cross_axis_pivot": "pivot",
    "motion_penalty_stiffness": "discretisation",
    "natural_frequencies": "modes",
    "plate_factors": "effects.plate",
    "sensitivities": "sensitivity",
    "solve_impulses": "sequential_impulse",
    "solve_many": "batch",
    "solve_mechanism": "statics",
    "solve_motion": "dynamics",
    "solve_release": "dynamics",
    "solve_statics": "statics",
    "strip_fields": "section_forces",
}


__all__ = list(_HOMES)


def __getattr__(name: str) -> Any:
    if name == "swinging_slide_stiffness":
        name = import_module(f"{__name__}.errors").present(name)
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}; public are {', '.join(_HOMES)}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return __all__
