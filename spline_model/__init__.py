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
    from spline_model.statics import solve_statics as solve_statics

_NAMES = {
    "batch": ("solve_many",),
    "design": ("BodyDesign", "StripDesign"),
    "discretisation": ("motion_penalty_stiffness",),
    "dynamics": ("solve_motion",),
    "effects.boundary": ("DrivenDisplacement", "DrivenRotation"),
    "effects.plate": ("plate_factors",),
    "effects.registry": ("DEFAULT_EFFECTS", "REGISTRY"),
    "errors": ("ConvergenceError", "InvalidParameter"),
    "held": ("HeldPivot",),
    "mechanism": ("Mechanism", "compliant_mechanism"),
    "modes": ("natural_frequencies",),
    "pivot": ("cross_axis_pivot",),
    "section_forces": ("strip_fields",),
    "sensitivity": ("sensitivities",),
    "sequential_impulse": ("solve_impulses",),
    "solution": ("Status",),
    "statics": ("solve_statics",),
}
_HOMES = {name: home for home, names in _NAMES.items() for name in names}
__all__ = list(_HOMES)


def __getattr__(name: str) -> Any:
    if name == "swinging_slide_stiffness":
        name = import_module(f"{__name__}.errors").present(name)
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}; public are {', '.join(_HOMES)}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return __all__
