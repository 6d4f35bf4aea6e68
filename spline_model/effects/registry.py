"""The names of the effects, and what each of them makes of a design.

An entry is a function of the design and of the effect's own parameters that returns frozen
effects. A new effect is a class with such a function in a file of its own, and one line here.
"""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from spline_model.effects import by_name
from spline_model.errors import InvalidParameter

if TYPE_CHECKING:
    from spline_model.design import Design
    from spline_model.scene import Effect

Parameters = Mapping[str, Mapping[str, Any]]
Builder = Callable[..., "Iterable[Effect]"]

REGISTRY: dict[str, Builder] = {
    "bending": by_name.bending,
    "stretching": by_name.stretching,
    "inextensible": by_name.inextensible,
    "strip_inertia": by_name.strip_inertia,
    "section_rotary_inertia": by_name.section_rotary_inertia,
    "body_inertia": by_name.body_inertia,
    "gravity": by_name.gravity,
    "strip_damping": by_name.strip_damping,
    "strip_drag": by_name.strip_drag,
    "body_damping": by_name.body_damping,
    "applied_force": by_name.applied_force,
    "applied_moment": by_name.applied_moment,
    "tip_force": by_name.tip_force,
    "driven_displacement": by_name.driven_displacement,
    "pre_strain": by_name.pre_strain,
    "clamped_width": by_name.clamped_width,
    "anticlastic": by_name.anticlastic,
    "root_compliance": by_name.root_compliance,
}

DEFAULT_EFFECTS = ("bending", "stretching", "strip_inertia", "body_inertia")
CONTRADICTIONS = (("stretching", "inextensible"),)
INERTIA = ("strip_inertia", "section_rotary_inertia", "body_inertia")
MOTION_ONLY = (*INERTIA, "strip_damping", "strip_drag", "body_damping")
"""Effects that statics never asks for."""


def check_names(names: Sequence[str], parameters: Parameters) -> None:
    """Refuse unknown, doubled, contradictory and missing effects, and parameters of absent ones."""
    for name in (*names, *parameters):
        if name == "shear":
            kept = 'none: sections stay normal to the curve; fe_reference has it, element="reissner"'
            raise InvalidParameter("effects", name, kept)
        if name not in REGISTRY:
            near = difflib.get_close_matches(name, REGISTRY, n=1)
            hint = f" (nearest: {near[0]})" if near else ""
            raise InvalidParameter("effects", name, f"one of {', '.join(REGISTRY)}{hint}")
    if len(set(names)) != len(names):
        raise InvalidParameter("effects", list(names), "each name once")
    for pair in CONTRADICTIONS:
        if set(pair) <= set(names):
            raise InvalidParameter("effects", " and ".join(pair), f"one of {', '.join(pair)}, not both")
    if "bending" not in names:
        raise InvalidParameter("effects", list(names), "bending, without which a strip has no stiffness")
    if not {"stretching", "inextensible"} & set(names):
        raise InvalidParameter("effects", list(names), "stretching or inextensible beside bending")
    for name in parameters:
        if name not in names:
            raise InvalidParameter(f"parameters of {name}", name, f"an effect of the scene, {list(names)}")


def build(names: Sequence[str], parameters: Parameters, design: Design) -> tuple[Effect, ...]:
    """The effects of these names for a design, in the order of the names."""
    check_names(names, parameters)
    effects: list[Effect] = []
    for name in names:
        try:
            effects += REGISTRY[name](design, **parameters.get(name, {}))
        except TypeError as error:
            given = sorted(parameters.get(name, {}))
            raise InvalidParameter(f"parameters of {name}", given, _signature(name)) from error
    return tuple(effects)


def _signature(name: str) -> str:
    code = REGISTRY[name].__code__
    names = code.co_varnames[1 : code.co_argcount + code.co_kwonlyargcount]
    return "only " + ", ".join(names) if names else "none"
