"""Names and parameters of the effects that a scene of finite elements may be made of.

A scene names its effects; what is not named is not assembled. Parameters are frozen values in SI units. Of
loads, drives, supports and springs a scene may have any number.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import MISSING, dataclass, fields
from typing import Annotated, Any, ClassVar

import numpy as np

from . import read
from .read import InvalidParameter

#: The history of what does not change, and the begin and end of what acts throughout a motion [s].
ALWAYS_FULL: read.History = ((0.0, 1.0),)
ALWAYS = (0.0, math.inf)
#: Coordinates of a body: those of its centre, and its turn.
WAYS = ("x", "y", "rotation")


@dataclass(frozen=True, kw_only=True)
class Effect(read.Checked):
    """An effect without parameters."""


@dataclass(frozen=True, kw_only=True)
class Several(Effect):
    """An effect of which a model definition may have any number, each with its own parameters.

    Attributes:
        body: what it acts on, by name; None: the only one.
    """

    body: str | None = None


@dataclass(frozen=True, kw_only=True)
class Load(Several):
    """A force (f_x, f_y) [N] and a moment [N m], times load factor or history, on a body or a free end.

    A dead force keeps its direction; a follower turns with what it acts on.

    Attributes:
        body: that it acts on, None: the only one. strip: whose free end it acts on, in place of a body.
        moment: positive counter-clockwise [N m].
        at: point of the body (x, y) [m] at rest where the force acts, by default its centre.
    """

    strip: str | None = None
    history: Annotated[read.History, read.history] = ALWAYS_FULL
    force: Annotated[read.Pair, read.pair, "N"] = (0.0, 0.0)
    moment: Annotated[float, read.finite, "N m"] = 0.0
    at: Annotated[read.Pair | None, read.optional, read.pair, "m"] = None
    follower: Annotated[bool, read.flag] = False


def _ways(name: str, value: Any) -> tuple[str, ...]:
    """Return the names of coordinates of a body, each once and one at least."""
    if not isinstance(value, list | tuple) or not value or len(set(value) & set(WAYS)) != len(value):
        raise InvalidParameter(name, value, f"one or more of {', '.join(WAYS)}, each once [name]")
    return tuple(value)


@dataclass(frozen=True, kw_only=True)
class Prescribed(Several):
    """Coordinates of a body that are led, times the load factor, or that stay where they are at rest.

    Attributes:
        body: None for the one whose rotation is driven, or the only one.
        history: in a motion what is led releases at the start, or with a history goes on leading, times that.
        displacement: (d_x, d_y) [m] of the centre. None in place of one of them leaves the body free that
            way.
        angle: positive counter-clockwise [rad], besides the body whose rotation is driven.
        fixed: coordinates, of WAYS, that stay, in a motion too.
    """

    history: Annotated[read.History | None, read.optional, read.history] = None
    displacement: Annotated[tuple[float | None, float | None] | None, read.optional, read.partly, "m"] = None
    angle: Annotated[float | None, read.optional, read.finite, "rad"] = None
    fixed: Annotated[tuple[str, ...] | None, read.optional, _ways] = None
    held: ClassVar = ALWAYS

    @property
    def ends(self) -> tuple[float | None, ...]:
        """Displacement x, y [m] and turn [rad] that the body is led to (3,), None where it is free."""
        if self.fixed:
            return tuple(0.0 if way in self.fixed else None for way in WAYS)
        return *(self.displacement or (None, None)), self.angle

    @property
    def leads(self) -> read.History | None:
        """How it goes on in a motion, None if it releases at the start."""
        return ALWAYS_FULL if self.fixed else self.history


@dataclass(frozen=True, kw_only=True)
class DrivenRotation(read.Checked):
    """The rotation of a body prescribed as an angle times the change of a history, from the current rotation.

    A body that is re-clamped loses the velocity that the drive does not have.

    Parameters
    ----------
    body : str, default None
        None: the only one.
    angle : float, rad
    history : pairs of s and 1, default ((0, 1),)
        Times and factors of the angle.
    held : (2,) s, default (0, inf)
        Begin and end of the drive.

    Raises
    ------
    InvalidParameter
        A value outside its domain.

    References
    ----------
    Valentini and Pezzuti (2013), Eq 7.

    Examples
    --------
    >>> DrivenRotation(angle=0.1, history=((0.0, 1.0), (0.01, 0.0)), held=(0.0, 0.02)).angle
    0.1
    """

    body: str | None = None
    angle: Annotated[float, read.finite, "rad"]
    history: Annotated[read.History, read.history] = ALWAYS_FULL
    held: tuple[float, float] = ALWAYS

    def __post_init__(self) -> None:
        super().__post_init__()
        begin, end = self.held
        read.refuse(not begin < end, "held", self.held, "two instants, the first before the second [s]")

    @property
    def ends(self) -> tuple[None, None, float]:
        """The turn [rad] that the body is led to (3,), None where it is free."""
        return None, None, self.angle

    @property
    def leads(self) -> read.History:
        """How it goes on in a motion."""
        return self.history


@dataclass(frozen=True, kw_only=True)
class Spring(Several):
    """Spring and damper between the centre of a body and that of another, or the ground.

    In axes of the ground, of displacements and turns since rest. In full at any load factor.

    Attributes:
        other: name of the other body; None: the ground.
        stiffness, damping: of the displacements, (k_x, k_y) [N/m] and (c_x, c_y) [N s/m].
        rotational_stiffness, rotational_damping: of the turns [N m/rad, N m s/rad].
    """

    other: str | None = None
    stiffness: Annotated[read.Pair, read.not_negatives, "N/m"] = (0.0, 0.0)
    rotational_stiffness: Annotated[float, read.not_negative, "N m/rad"] = 0.0
    damping: Annotated[read.Pair, read.not_negatives, "N s/m"] = (0.0, 0.0)
    rotational_damping: Annotated[float, read.not_negative, "N m s/rad"] = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        own = (*self.stiffness, self.rotational_stiffness, *self.damping, self.rotational_damping)
        read.refuse(not any(own), "spring", self.body, "a stiffness or a damping above 0 [N/m]")
        if self.other is not None and self.other == self.body:
            raise InvalidParameter("other", self.other, "another body, or None for the ground [name]")


def factor_of(points: read.History, time: float) -> float:
    """Return the factor at an instant [s]: constant before the first and after the last."""
    return float(np.interp(time, *np.transpose(points)))


#: Extra length of a strip cut from one block with its body: a half-plane at a sharp corner, plane stress.
#: W. J. O'Donnell measured 0.44, J. Appl. Mech. 27 (1960) 461-464.
MONOLITHIC = 0.416
#: Effects of a strip's width and thickness, and those of them that are of the curl across the width.
SIDES = ("clamped_width", "anticlastic", "root_compliance")
CURL = SIDES[:2]


@dataclass(frozen=True, kw_only=True)
class Gravity(Effect):
    """Weight of strips and bodies: acceleration (g_x, g_y) [m/s^2]. Acts whether or not they have inertia."""

    acceleration: Annotated[read.Pair, read.pair, "m/s^2"]


@dataclass(frozen=True, kw_only=True)
class StripDamping(Effect):
    """Kelvin-Voigt material: stress E (strain + b d strain/dt) in every strain.

    Attributes:
        relaxation_time: b, at least 0 [s].
    """

    relaxation_time: Annotated[float, read.not_negative, "s"]


@dataclass(frozen=True, kw_only=True)
class StripDrag(Effect):
    """Force -a mu v per unit length on the strips, in proportion to their mass, with the rate a [1/s]."""

    rate: Annotated[float, read.not_negative, "1/s"]


@dataclass(frozen=True, kw_only=True)
class BodyDamping(Effect):
    """Damper between every body and ground: translation of its centre [N s/m] and rotation [N m s]."""

    translation: Annotated[float, read.not_negative, "N s/m"] = 0.0
    rotation: Annotated[float, read.not_negative, "N m s"] = 0.0


@dataclass(frozen=True, kw_only=True)
class PreStrain(Effect):
    """Natural curvature [1/m] and natural strain [1] of every strip: where it is free of stress.

    They are counted from the shape at rest: the section laws are M = EI (kappa - curvature) and
    N = EA (eps - strain), with kappa the change of curvature from the shape at rest.
    """

    curvature: Annotated[float, read.finite, "1/m"] = 0.0
    strain: Annotated[float, read.finite, "1"] = 0.0


def _root_length(name: str, value: Any) -> float:
    """Return the extra length of a root in thicknesses of the strip, by number or by name."""
    return MONOLITHIC if value == "monolithic" else read.not_negative(name, value, "thicknesses")


@dataclass(frozen=True, kw_only=True)
class RootCompliance(Effect):
    """Clamped ends turn against springs of EI / (root t) [N m]; root: number or "monolithic", the default."""

    root: Annotated[float, _root_length] = MONOLITHIC


#: Every effect that these elements can have; of those that share a class, the parameters that are needed and
#: those that may be given.
KNOWN: Mapping[str, tuple[Any, ...]] = {
    "bending": (Effect,),
    "stretching": (Effect,),
    "strip_inertia": (Effect,),
    "section_rotary_inertia": (Effect,),  # shear-deformable elements have it in any case
    "body_inertia": (Effect,),
    "gravity": (Gravity,),
    "strip_damping": (StripDamping,),
    "strip_drag": (StripDrag,),
    "body_damping": (BodyDamping,),
    "applied_force": (Load, ("force",), ("body", "history", "at", "follower")),
    "applied_moment": (Load, ("moment",), ("body", "history")),
    "tip_force": (Load, ("strip", "force"), ("history", "moment", "follower")),
    "driven_displacement": (Prescribed, ("displacement",), ("body", "history")),
    "driven_rotation": (Prescribed, ("angle",), ("body", "history")),
    "support": (Prescribed, ("fixed",), ("body",)),
    "spring": (Spring,),
    "pre_strain": (PreStrain,),
    "clamped_width": (Effect,),
    "anticlastic": (Effect,),
    "root_compliance": (RootCompliance,),
    "shear": (Effect,),  # of shear-deformable elements, which have it in any case
}
DEFAULT_EFFECTS = ("bending", "stretching", "strip_inertia", "body_inertia")
#: Parameters of an effect, or of each one of several.
Given = Mapping[str, Any] | Sequence[Mapping[str, Any]]


#: The named effects of one scene, in the order they were named: one of each name, or several.
Named = Mapping[str, tuple[Effect, ...]]


def named(effects: Iterable[str], parameters: Mapping[str, Given]) -> Named:
    """Return the effects of these names with their parameters.

    Raises:
        InvalidParameter: a name that is not known or comes twice, "bending" or "stretching" missing, rotary
            inertia of strips without inertia, parameters that are missing, unknown or of no named effect,
            several sets of them for an effect that acts once.
    """
    names = tuple(effects)
    for name in names:
        read.choice("effects", name, tuple(KNOWN))
    rotary = "section_rotary_inertia" not in names or "strip_inertia" in names
    for holds, expected in (
        (len(set(names)) == len(names), "every name once"),
        ({"bending", "stretching"} <= set(names), "bending and stretching, which every element has"),
        (rotary, "strip_inertia beside section_rotary_inertia"),
    ):
        read.refuse(not holds, "effects", names, f"{expected} [name]")
    for name in parameters:
        read.refuse(
            name not in names, "parameters", name, f"one of the named effects {', '.join(names)} [name]"
        )
    return {name: tuple(_each(name, parameters.get(name, {}))) for name in names}


def twice(bodies: Sequence[str], at: int) -> InvalidParameter:
    """Return the refusal of a coordinate, numbered as in `Model.prescribed`, that is prescribed twice."""
    told = f"{WAYS[at % 3]} of {bodies[at // 3]}"
    return InvalidParameter("prescribed", told, "one drive or support for each coordinate [name]")


def _each(name: str, given: Given) -> Iterable[Effect]:
    """Yield the effects `name`, one for each set of parameters, refused by name if they are not its own."""
    (kind, *takes), every = KNOWN[name], [given] if isinstance(given, Mapping) else given
    if every is given and not issubclass(kind, Several):
        raise InvalidParameter(name, given, "the parameters of one effect, which acts once [name]")
    if not every or not all(isinstance(each, Mapping) for each in every):
        raise InvalidParameter(name, given, "parameters, or a sequence of them, one for each [name]")
    own = {each.name: each.default for each in fields(kind)}
    needed, others = takes or ([key for key in own if own[key] is MISSING], own)
    known = list(dict.fromkeys([*needed, *others]))
    for parameters in every:
        for key in parameters:
            read.refuse(key not in known, name, key, f"one of {', '.join(known) or 'no parameters'} [name]")
        if missing := [key for key in needed if parameters.get(key) is None]:
            raise InvalidParameter(name, dict(parameters), f"a value of {', '.join(missing)} [name]")
        yield kind(**parameters)
