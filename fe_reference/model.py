"""What a finite-element model is made of: strips of two-node beam elements, rigid bodies, and effects.

Each end of a strip is clamped to or hinged on ground or a body, or free. The parameters are plain SI numbers
and radians. A mechanism is made from designs that name what is joined to what. The cross-axis flexural pivot
is the one of two straight strips that cross without touching, and their body.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Annotated, Any, TypeVar

import numpy as np

from . import effects as scene
from . import read
from .arrays import Array, Indices
from .places import FREE, GROUND
from .read import InvalidParameter
from .strip import FIXED, StripDesign

ELEMENTS = ("corotational", "reissner")
T = TypeVar("T")


@dataclass(frozen=True, kw_only=True)
class BodyDesign(read.Checked):
    """A rigid body; without mass and inertia it is the common end node of its strips.

    Parameters
    ----------
    name : str, default "body"
    centre : (2,) m
        Centre of mass at rest.
    mass : float, kg, default 0
    moment_of_inertia : float, kg m^2, default 0
        About the centre of mass.

    Raises
    ------
    InvalidParameter
        A value outside its domain.

    Examples
    --------
    >>> BodyDesign(name="tip", centre=(0.1, 0.0), mass=0.05, moment_of_inertia=1e-5).mass
    0.05
    """

    centre: Annotated[read.Pair | Sequence[float], read.pair, "m"]
    mass: Annotated[float, read.not_negative, "kg"] = 0.0
    moment_of_inertia: Annotated[float, read.not_negative, "kg m^2"] = 0.0
    name: str = "body"


@dataclass(frozen=True, kw_only=True, eq=False)
class Model:
    """Strips between ground and rigid bodies, the elements they are made of, and the effects of the scene.

    Args:
        strips: one or more, of different names if they are many.
        bodies: the rigid bodies, of different names; none is legal.
        element: "corotational" (Euler-Bernoulli) or "reissner" (with shear).
        elements: number of elements of every strip.
        effects: the named effects.

    Examples
    --------
    With ``pivot`` of the example of ``fe_reference.model.cross_axis_pivot``:

    >>> pivot.element, pivot.strip_names, pivot.lengths.shape
    ('corotational', ('strip_1', 'strip_2'), (2,))
    """

    strips: tuple[StripDesign, ...]
    bodies: tuple[BodyDesign, ...] = ()
    element: str = "corotational"
    elements: int = 20
    effects: scene.Named = field(default_factory=lambda: scene.named(scene.DEFAULT_EFFECTS, {}))

    def __post_init__(self) -> None:
        read.choice("element", self.element, ELEMENTS)
        if "shear" in self.effects and self.element == ELEMENTS[0]:
            raise InvalidParameter("element", self.element, f"{ELEMENTS[1]} for shear [name]")
        read.count("elements", self.elements)
        read.refuse(FIXED in self.body_names, "bodies", FIXED, "another name for a body that moves [name]")
        for kind, names in (("strips", self.strip_names), ("bodies", self.body_names)):
            read.refuse(len(set(names)) != len(names), kind, names, "names that differ [name]")
        read.refuse(not self.ends.size, "strips", self.strips, "one or more strips")
        if not (np.diff(self.arcs) > 0.0).all():
            raise InvalidParameter("strips", "ends that coincide", "elements of a length above 0 [m]")
        self._check_places()
        self._check_sides()

    def _check_places(self) -> None:
        """Refuse loads, springs and drives on what is not there."""
        for load in self.every(scene.Load):
            if load.strip is None:
                self.body_index(load.body)
            elif self.ends[self.strip_index(load.strip), 1] != FREE:
                raise InvalidParameter("tip_force", load.strip, "a strip whose tip is free [name]")
        for spring in self.every(scene.Spring):
            self.body_index(spring.body)
            self.body_index(spring.other or spring.body)
        led = self.every(scene.Prescribed)
        if led and not self.bodies:
            name = next(name for name, same in self.effects.items() if led[0] in same)
            raise InvalidParameter(name, "no bodies", "a body to lead [name]")
        # those that name no body are of the one that is driven, which only a solve knows
        self.prescribed(None, [each for each in led if each.body is not None])

    def _check_sides(self) -> None:
        """Refuse effects of the strips' sides where they do not hold."""
        named = [name for name in scene.SIDES if name in self.effects]
        curl = [name for name in scene.CURL if name in named]
        natural = self.find(scene.PreStrain)
        if curl and natural is not None and natural.curvature:
            raise InvalidParameter(
                curl[0], "natural curvature", "strips that are straight when free of stress"
            )
        for strip in self.strips if named else ():
            if strip.width is None:
                raise InvalidParameter(named[0], strip.name, "strips with width and thickness [name]")
            if strip.tapered:
                raise InvalidParameter(named[0], strip.name, "strips of a constant section [name]")
            if curl and strip.rise:
                raise InvalidParameter(curl[0], strip.name, "straight strips [name]")
            if "clamped_width" in curl and (None in (strip.root, strip.tip) or any(strip.hinges)):
                raise InvalidParameter("clamped_width", strip.name, "strips clamped at both ends [name]")

    @cached_property
    def rest(self) -> Array:
        """Positions of the nodes at rest (G, P, 2) [m], from root to tip."""
        return np.array([strip.axis(self.elements) for strip in self.strips])

    @cached_property
    def arcs(self) -> Array:
        """Arc lengths of the nodes at rest (G, P) [m], along the elements."""
        return np.pad(np.cumsum(np.linalg.norm(np.diff(self.rest, axis=1), axis=2), axis=1), ((0, 0), (1, 0)))

    @property
    def lengths(self) -> Array:
        """Lengths of the strips at rest (G,) [m], along the elements."""
        return self.arcs[:, -1]

    @cached_property
    def ends(self) -> Indices:
        """What root and tip of the strips are on (G, 2): the index of a body, GROUND or FREE."""
        known = {None: FREE, FIXED: GROUND} | {name: k for k, name in enumerate(self.body_names)}
        for strip in self.strips:
            for name, there in (("root", strip.root), ("tip", strip.tip)):
                if there is not None:
                    read.choice(name, there, (FIXED, *self.body_names))
        return np.array([(known[strip.root], known[strip.tip]) for strip in self.strips], dtype=np.int64)

    @property
    def centres(self) -> Array:
        """Centres of the bodies at rest (B, 2) [m]."""
        return np.array([body.centre for body in self.bodies]).reshape(-1, 2)

    @property
    def strip_names(self) -> tuple[str, ...]:
        """Names of the strips in order."""
        return tuple(strip.name for strip in self.strips)

    @property
    def body_names(self) -> tuple[str, ...]:
        """Names of the bodies in order."""
        return tuple(body.name for body in self.bodies)

    def body_index(self, name: str | None) -> int:
        """Return the place of the body of this name; None means the only one there is.

        Raises:
            InvalidParameter: the name is unknown, or None with several bodies.
        """
        bodies = self.body_names
        if len(bodies) != 1 if name is None else name not in bodies:
            raise InvalidParameter("body", name, f"one of {', '.join(bodies) or 'no bodies'} [name]")
        return 0 if name is None else bodies.index(name)

    def every(self, kind: type[T]) -> list[T]:
        """Return all effects of this class."""
        return [each for same in self.effects.values() for each in same if isinstance(each, kind)]

    def find(self, kind: type[T]) -> T | None:
        """Return the effect of this class, or None if it is not named."""
        return next(iter(self.every(kind)), None)

    def require_inertia(self) -> None:
        """Check that the effects give a motion inertia.

        Raises:
            InvalidParameter: a motion is asked for, but nothing in the model has inertia.
        """
        names = tuple(self.effects)
        if not {"strip_inertia", "body_inertia"} & set(names):
            raise InvalidParameter("effects", names, "strip_inertia or body_inertia for a motion [name]")

    def prescribed(self, body: int | None, led: Sequence[Any] | None = None) -> dict[int, tuple[float, Any]]:
        """Return what drives and supports prescribe: end [m, rad] of a coordinate, and by which of them.

        Coordinate k of body b stands under 3 b + k.

        Args:
            body: number of the body where the effects name none; None: the only one.
            led: the drives and supports, by default all of the scene.

        Raises:
            InvalidParameter: a coordinate is prescribed twice, or a name is unknown.
        """
        found: dict[int, tuple[float, Any]] = {}
        for effect in self.every(scene.Prescribed) if led is None else led:
            index = body if effect.body is None and body is not None else self.body_index(effect.body)
            for at, end in enumerate(effect.ends, start=3 * index):
                if at in found and end is not None:
                    raise scene.twice(self.body_names, at)
                if end is not None:
                    found[at] = end, effect
        return found

    def strip_index(self, name: str) -> int:
        """Return the place of the strip of this name."""
        return self.strip_names.index(read.choice("strip", name, self.strip_names))


def require_model(value: Any) -> None:
    """Refuse what is no model of this package, such as a mechanism of the splines."""
    made = "what cross_axis_pivot or compliant_mechanism of fe_reference returns"
    read.require_kind("mechanism", value, Model, made)


def compliant_mechanism(
    *,
    strips: Sequence[StripDesign],
    bodies: Sequence[BodyDesign] = (),
    effects: Sequence[str] = scene.DEFAULT_EFFECTS,
    parameters: Mapping[str, scene.Given] | None = None,
    elements: int = 20,
    element: str = "corotational",
) -> Model:
    """Return the model of a mechanism at rest, free of stress unless it has natural strains.

    Parameters
    ----------
    strips : sequence of StripDesign
    bodies : sequence of BodyDesign, default ()
    effects : sequence of str
        Names of the effects.
    parameters : mapping, SI units, default None
        Parameters of each named effect, by effect, or a sequence of them for an effect that acts several
        times.
    elements : int, default 20
        Finite elements per strip.
    element : str
        "corotational" (default) or "reissner" (with shear).

    Returns
    -------
    Model

    Raises
    ------
    InvalidParameter
        A value outside its domain, an end on an unknown body, or effects that contradict each other.

    References
    ----------
    Crisfield (1991) and Reissner (1972), as in ``fe_reference.law``.

    Examples
    --------
    >>> strip = StripDesign(
    ...     name="strip", start=(0.0, 0.0), end=(0.1, 0.0), root="ground", tip="tip",
    ...     width=0.01, thickness=1e-3,
    ...     youngs_modulus=206e9, poisson_ratio=0.3, density=7850.0,
    ... )
    >>> tip = BodyDesign(name="tip", centre=(0.1, 0.0), mass=0.05, moment_of_inertia=1e-5)
    >>> compliant_mechanism(strips=[strip], bodies=[tip], elements=8).elements
    8
    """
    named = scene.named(effects, parameters or {})
    return Model(
        strips=tuple(strips), bodies=tuple(bodies), element=element, elements=elements, effects=named
    )


def cross_axis_pivot(
    *,
    length: float,
    inclination: float,
    crossing_ratio: float,
    body_mass: float,
    body_moment_of_inertia: float,
    centre_offset: Sequence[float] = (0.0, 0.0),
    orientation: float = 0.0,
    effects: Sequence[str] = scene.DEFAULT_EFFECTS,
    parameters: Mapping[str, scene.Given] | None = None,
    elements: int = 20,
    element: str = "corotational",
    **section: Any,
) -> Model:
    """Return the pivot at rest, with the ground end A1 of the first strip at the origin.

    With strip length L, inclination a and crossing ratio r (distance of the crossing from ground over L):

        A1 = (0, 0),  A2 = (2 r L cos a, 0),  B1 = A1 + L (cos a, sin a),  B2 = A2 + L (-cos a, sin a)

    and the body's centre at (B1 + B2)/2 + centre_offset; then the orientation rotates all of it about A1.

    Parameters
    ----------
    length : float, m
        L.
    inclination : float, rad
        a, between 0 and pi/2.
    crossing_ratio : float, 1
        r, between 0 and 1.
    body_mass, body_moment_of_inertia : float, kg and kg m^2
        The moment is about the centre of mass; zero is legal.
    centre_offset : (2,) m, default (0, 0)
    orientation : float, rad, default 0
        Counter-clockwise.
    effects, parameters : sequence of str, mapping
        Names of the effects, and the parameters of each effect by name.
    elements : int, default 20
        Finite elements per strip.
    element : str
        "corotational" (default) or "reissner" (with shear).
    section
        Of both strips, as of `StripDesign`: youngs_modulus [Pa], poisson_ratio [1], density [kg/m^3], and
        area [m^2] with second_moment_of_area [m^4], or width with thickness [m].

    Returns
    -------
    Model

    Raises
    ------
    InvalidParameter
        A value outside its domain; one line with name, value, expectation and unit.

    References
    ----------
    Valentini and Pezzuti (2013), Fig 2 and Table 1.

    Examples
    --------
    >>> pivot = cross_axis_pivot(
    ...     length=0.08, inclination=0.785, crossing_ratio=0.5, width=0.01, thickness=5e-4,
    ...     youngs_modulus=206e9, poisson_ratio=0.3, density=7850.0, body_mass=0.1,
    ...     body_moment_of_inertia=2e-5, elements=8,
    ... )
    >>> len(pivot.strips), pivot.elements
    (2, 8)
    """
    read.positive("length", length, "m")
    angle = read.within("inclination", inclination, 0.0, 0.5 * np.pi, "rad")
    ratio = read.within("crossing_ratio", crossing_ratio, 0.0, 1.0, "1")
    run, rise = length * np.cos(angle), length * np.sin(angle)
    ground = np.array([[0.0, 0.0], [2.0 * ratio * run, 0.0]])
    ends = ground + np.array([[run, rise], [-run, rise]])
    turned = read.finite("orientation", orientation, "rad")
    turn = np.array([[np.cos(turned), np.sin(turned)], [-np.sin(turned), np.cos(turned)]])
    offset = np.array(read.pair("centre_offset", centre_offset, "m"))
    ground, ends, offset = ground @ turn, ends @ turn, offset @ turn
    centre = ends.mean(axis=0) + offset
    mass = read.not_negative("body_mass", body_mass, "kg")
    inertia = read.not_negative("body_moment_of_inertia", body_moment_of_inertia, "kg m^2")
    body = BodyDesign(centre=tuple(centre), mass=mass, moment_of_inertia=inertia)
    strips = [
        StripDesign(name=f"strip_{number}", start=a, end=b, tip=body.name, **section)
        for number, (a, b) in enumerate(zip(ground, ends, strict=True), start=1)
    ]
    given: dict[str, Any] = {"effects": effects, "parameters": parameters}
    return compliant_mechanism(strips=strips, bodies=[body], elements=elements, element=element, **given)
