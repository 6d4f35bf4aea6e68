"""What a finite-element model is made of: strips of two-node beam elements, rigid bodies, and effects.

Each end of a strip is clamped to or hinged on ground or a body, or free. The parameters are plain SI numbers
and radians.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Annotated, Any

import numpy as np

from .arrays import Array, Indices
from .effects import CURL, SIDES, Effects, PreStrain
from .errors import (
    Checked,
    History,
    InvalidParameter,
    Pair,
    choice,
    count,
    finite,
    not_negative,
    pair,
    positive,
    require_kind,
    within,
)
from .places import FREE, GROUND, check_places, index_of, prescribed

ELEMENTS = ("corotational", "reissner")
#: How an end of a strip is held on what it is on.
JOINTS = ("clamp", "hinge")
#: Name of what does not move.
FIXED = "ground"
#: Area and second moment of a section that is told by its sides.
NOT_GIVEN = math.nan
#: How far area and second moment may be from those of the sides beside them: printed values are rounded.
ROUNDING = 1e-3


@dataclass(frozen=True, kw_only=True)
class StripDesign(Checked):
    """A strip: its axis at rest, what its ends are on, and a linear elastic, homogeneous beam section.

    Parameters
    ----------
    name : str
    start, end : (2,) m
        Of the axis at rest.
    root, tip : str
        "ground" or the name of the body that start and end are on; None for a free end.
    rise : float, m, default 0
        Sagitta of the circular arc at rest, to the left of start to end; 0: straight.
    area, second_moment_of_area : float, m^2 and m^4
        A and I; not needed with the sides.
    youngs_modulus, poisson_ratio, density : float, Pa, 1, kg/m^3
        E, nu and rho.
    shear_factor : float, 1, default 5/6
        k, the value for a rectangle in energy equivalence (Reissner), without the dependence on nu.
    width, thickness : float, m, default None
        Sides b and t of a rectangle, t in the plane of bending, which effects of the curl across the width
        need: then A = b t and I = b t^3 / 12, unless they are given and agree with the sides to ROUNDING.

    width_end, thickness_end : float, m, default None
        Sides at the end of a taper, between which they change linearly along the strip. Width, thickness,
        area and second moment are those at the start.
    root_joint, tip_joint : str, default "clamp"
        "clamp", or "hinge" about which the end turns freely on ground or body.

    Raises
    ------
    InvalidParameter
        A value outside its domain, half a section, or sections that do not agree.

    Notes
    -----
    Rigidities: EA [N], EI [N m^2], k G A [N] with G = E / (2 (1 + nu)); linear density rho A [kg/m].

    Examples
    --------
    >>> strip = StripDesign(
    ...     name="strip", start=(0.0, 0.0), end=(0.1, 0.0), tip=None, width=0.01, thickness=1e-3,
    ...     youngs_modulus=206e9, poisson_ratio=0.3, density=7850.0,
    ... )
    >>> print(f"{strip.second_moment_of_area:.3e} m^4")
    8.333e-13 m^4
    """

    name: str
    start: Annotated[Pair | Sequence[float], pair, "m"]
    end: Annotated[Pair | Sequence[float], pair, "m"]
    root: str | None = FIXED
    tip: str | None
    root_joint: Annotated[str, choice, JOINTS] = JOINTS[0]
    tip_joint: Annotated[str, choice, JOINTS] = JOINTS[0]
    rise: Annotated[float, finite, "m"] = 0.0
    area: Annotated[float, positive, "m^2"] = NOT_GIVEN
    second_moment_of_area: Annotated[float, positive, "m^4"] = NOT_GIVEN
    youngs_modulus: Annotated[float, positive, "Pa"]
    poisson_ratio: Annotated[float, within, -1.0, 0.5, "1"]
    density: Annotated[float, positive, "kg/m^3"]
    shear_factor: Annotated[float, positive, "1"] = 5.0 / 6.0
    width: float | None = None
    thickness: float | None = None
    width_end: float | None = None
    thickness_end: float | None = None

    def __post_init__(self) -> None:
        self._read_sides()
        super().__post_init__()
        ends = {"root_joint": self.root, "tip_joint": self.tip}
        for (name, there), hinged in zip(ends.items(), self.hinges, strict=True):
            if hinged and there is None:
                raise InvalidParameter(name, JOINTS[1], f"{JOINTS[0]} at the free end of {self.name} [name]")

    def _read_sides(self) -> None:
        """Compute section values from the sides; refuse values that contradict them, and half a section."""
        names = ("area", "second_moment_of_area")
        missing = [name for name in names if getattr(self, name) != getattr(self, name)]  # NOT_GIVEN
        ends = (self.width_end, self.thickness_end)
        if all(side is None for side in (self.width, self.thickness, *ends)):
            if missing:
                raise InvalidParameter(missing[0], "nothing", "it, or width and thickness of a rectangle [m]")
            return
        b, t = (positive(name, getattr(self, name), "m") for name in ("width", "thickness"))
        for name, side in zip(("width_end", "thickness_end"), ends, strict=True):
            if side is not None:
                positive(name, side, "m")
        for name, made, power in zip(names, (b * t, b * t**3 / 12.0), (2, 4), strict=True):
            if name in missing:
                object.__setattr__(self, name, made)
            elif abs(positive(name, getattr(self, name), f"m^{power}") - made) > ROUNDING * made:
                expected = f"{made:.6g}, that of width and thickness [m^{power}]"
                raise InvalidParameter(name, getattr(self, name), expected)

    @property
    def tapered(self) -> bool:
        """Whether its section changes along it."""
        return self.growth(1.0) != (1.0, 1.0)

    def growth(self, places: Any) -> tuple[Any, Any]:
        """Return area and second moment at places, parts of the length, over those at the start."""
        sides = (self.width, self.width_end), (self.thickness, self.thickness_end)
        b, t = (1.0 + places * (end / start - 1.0 if start and end else 0.0) for start, end in sides)
        return b * t, b * t**3

    @property
    def hinges(self) -> tuple[bool, bool]:
        """Whether root and tip are hinged."""
        return self.root_joint == JOINTS[1], self.tip_joint == JOINTS[1]

    @property
    def axial_rigidity(self) -> float:
        """EA [N]."""
        return self.youngs_modulus * self.area

    @property
    def flexural_rigidity(self) -> float:
        """EI [N m^2]."""
        return self.youngs_modulus * self.second_moment_of_area

    @property
    def shear_rigidity(self) -> float:
        """k G A [N]."""
        return self.shear_factor * self.axial_rigidity / (2.0 * (1.0 + self.poisson_ratio))

    @property
    def linear_density(self) -> float:
        """Mass per unit reference length, rho A [kg/m]."""
        return self.density * self.area

    @property
    def rotary_density(self) -> float:
        """Rotary inertia of the section per unit reference length, rho I [kg m]."""
        return self.density * self.second_moment_of_area

    def axis(self, elements: int) -> Array:
        """Return the nodes (P, 2) [m] on the chord or, at equal distances, on the arc over it.

        An arc of rise h over a chord c has the radius (c^2/4 + h^2) / (2 h) and the half angle
        2 atan(2 h / c). Each element keeps its own reference angle, so that an arc is stress-free as well.
        """
        start, end = np.array(self.start), np.array(self.end)
        chord, fraction = end - start, np.linspace(0.0, 1.0, elements + 1)
        if self.rise == 0.0:
            straight: Array = start + fraction[:, None] * chord
            return straight
        half = 2.0 * np.arctan2(2.0 * self.rise, float(np.hypot(*chord)))
        angle = half * (2.0 * fraction - 1.0)
        # along and across the chord as parts of it; a sine of half the angle keeps flat arcs free of
        # cancellation
        along = 0.5 * (1.0 + np.sin(angle) / np.sin(half))
        across = (np.sin(0.5 * half) ** 2 - np.sin(0.5 * angle) ** 2) / np.sin(half)
        left = np.array([-chord[1], chord[0]])
        nodes: Array = start + along[:, None] * chord + across[:, None] * left
        return nodes


@dataclass(frozen=True, kw_only=True, eq=False)
class BodyDesign:
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

    centre: Array
    mass: float = 0.0
    moment_of_inertia: float = 0.0
    name: str = "body"

    def __post_init__(self) -> None:
        not_negative("body_mass", self.mass, "kg")
        not_negative("body_moment_of_inertia", self.moment_of_inertia, "kg m^2")
        object.__setattr__(self, "centre", np.array(pair("centre", self.centre, "m")))


@dataclass(frozen=True, kw_only=True, eq=False)
class Model:
    """Strips between ground and rigid bodies, the elements they are made of, and the effects of the scene.

    Args:
        strips: one or more, of different names if they are many.
        bodies: the rigid bodies, of different names; none is legal.
        element: "corotational" (Euler-Bernoulli) or "reissner" (with shear).
        elements: number of elements of every strip.
        effects: the named effects.
    """

    strips: tuple[StripDesign, ...]
    bodies: tuple[BodyDesign, ...] = ()
    element: str = "corotational"
    elements: int = 20
    effects: Effects = field(default_factory=Effects)

    def __post_init__(self) -> None:
        choice("element", self.element, ELEMENTS)
        if "shear" in self.effects and self.element == ELEMENTS[0]:
            raise InvalidParameter("element", self.element, f"{ELEMENTS[1]} for shear [name]")
        count("elements", self.elements)
        if FIXED in self.body_names:
            raise InvalidParameter("bodies", FIXED, "another name for a body that moves [name]")
        for kind, names in (("strips", self.strip_names), ("bodies", self.body_names)):
            if len(set(names)) != len(names):
                raise InvalidParameter(kind, names, "names that differ [name]")
        if not self.ends.size:
            raise InvalidParameter("strips", self.strips, "one or more strips")
        if not (np.diff(self.arcs) > 0.0).all():
            raise InvalidParameter("strips", "ends that coincide", "elements of a length above 0 [m]")
        free = [name for name, tip in zip(self.strip_names, self.ends[:, 1], strict=True) if tip == FREE]
        check_places(self.effects, self.body_names, self.strip_names, free)
        self._check_sides()

    def _check_sides(self) -> None:
        """Refuse effects of the strips' sides where they do not hold."""
        named = [name for name in SIDES if name in self.effects]
        curl = [name for name in CURL if name in named]
        natural = self.effects.find(PreStrain)
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
                if there not in known:
                    expected = f"one of {', '.join([FIXED, *self.body_names])} [name]"
                    raise InvalidParameter(name, there, expected)
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

    @property
    def body(self) -> BodyDesign:
        """The one body of a model that has one."""
        return self.bodies[self.body_index(None)]

    def body_index(self, name: str | None) -> int:
        """Return the place of the body of this name; None means the only one there is."""
        return index_of(self.body_names, name)

    def prescribed(self, body: int | None) -> dict[int, tuple[float, History | None]]:
        """Return what drives and supports prescribe, as `places.prescribed`."""
        return prescribed(self.effects, self.body_names, body)

    def strip_index(self, name: str) -> int:
        """Return the place of the strip of this name."""
        return self.strip_names.index(choice("strip", name, self.strip_names))


def require_model(value: Any) -> None:
    """Refuse what is no model of this package, such as a mechanism of the splines."""
    made = "what cross_axis_pivot or compliant_mechanism of fe_reference returns"
    require_kind("mechanism", value, Model, made)
