"""What a finite-element model is made of: sections, strips of two-node beam elements, and rigid bodies.

Each end of a strip is clamped to ground, carried by a body, or free. The parameters are plain SI numbers and
radians.
"""

import math
from dataclasses import dataclass, field
from typing import Annotated, Any

import numpy as np

from .arrays import Array
from .effects import (
    CURL,
    SIDES,
    AppliedForce,
    AppliedMoment,
    DrivenDisplacement,
    Effects,
    PreStrain,
    TipForce,
)
from .errors import Checked, InvalidParameter, choice, not_negative, pair, positive, require_kind, within

ELEMENTS = ("corotational", "reissner")
#: What an end of a strip is on, where it is not on a body: clamped to ground, or on nothing.
GROUND, FREE = -1, -2
#: Area and second moment of a section that is told by its sides.
NOT_GIVEN = math.nan
#: How far area and second moment may be from those of the sides beside them: printed values are rounded.
ROUNDING = 1e-3


def rotation_matrix(angle: float) -> Array:
    """Return the matrix (2, 2) that turns a vector counter-clockwise by `angle` [rad]."""
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.array([[cosine, -sine], [sine, cosine]])


@dataclass(frozen=True, kw_only=True)
class Section(Checked):
    """Cross-section and material of a strip: a linear elastic, homogeneous beam section.

    Symbols: A [m^2], I [m^4], E [Pa], nu [1], rho [kg/m^3], shear factor k [1].
    Rigidities: EA [N], EI [N m^2], k G A [N] with G = E / (2 (1 + nu)); linear density mu = rho A [kg/m].
    k = 5/6 is the value for a rectangle in energy equivalence (Reissner), without the dependence on nu.

    A rectangle may be told by its sides, the width b [m] and the thickness t in the plane of bending [m],
    which effects of the curl across the width need: then A = b t and I = b t^3 / 12 where they are left out;
    where they are given they hold, and must be those of the sides to ROUNDING.
    """

    area: Annotated[float, positive, "m^2"] = NOT_GIVEN
    second_moment_of_area: Annotated[float, positive, "m^4"] = NOT_GIVEN
    youngs_modulus: Annotated[float, positive, "Pa"]
    poisson_ratio: Annotated[float, within, -1.0, 0.5, "1"]
    density: Annotated[float, positive, "kg/m^3"]
    shear_factor: Annotated[float, positive, "1"] = 5.0 / 6.0
    width: float | None = None
    thickness: float | None = None

    def __post_init__(self) -> None:
        self._read_sides()
        super().__post_init__()

    def _read_sides(self) -> None:
        """Fill in what the sides make of the section; refuse what contradicts them, and half a section."""
        names = ("area", "second_moment_of_area")
        missing = [name for name in names if getattr(self, name) != getattr(self, name)]  # NOT_GIVEN
        if self.width is None and self.thickness is None:
            if missing:
                raise InvalidParameter(missing[0], "nothing", "it, or width and thickness of a rectangle [m]")
            return
        b, t = (positive(name, getattr(self, name), "m") for name in ("width", "thickness"))
        for name, made, power in zip(names, (b * t, b * t**3 / 12.0), (2, 4), strict=True):
            if name in missing:
                object.__setattr__(self, name, made)
            elif abs(positive(name, getattr(self, name), f"m^{power}") - made) > ROUNDING * made:
                expected = f"{made:.6g}, that of width and thickness [m^{power}]"
                raise InvalidParameter(name, getattr(self, name), expected)

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


@dataclass(frozen=True, kw_only=True, eq=False)
class Strip:
    """A strip as a chain of two-node elements from its root to its tip.

    Args:
        section: cross-section and material, the same along the strip.
        nodes: reference positions (P, 2) [m], root first. The chain may turn from element to element:
            every element keeps its own reference angle, so that a curved strip is stress-free as well.
        root, tip: what the first and the last node are on: the index of a body, GROUND (clamped) or FREE.
        name: what it is called.
    """

    section: Section
    nodes: Array
    root: int = GROUND
    tip: int = 0
    name: str = "strip"

    def __post_init__(self) -> None:
        nodes = np.array(self.nodes, dtype=float)
        if nodes.ndim != 2 or nodes.shape[0] < 2 or nodes.shape[1] != 2 or not np.isfinite(nodes).all():
            raise InvalidParameter(
                "nodes", np.shape(self.nodes), "finite positions of shape (2 or more, 2) [m]"
            )
        if not np.all(np.linalg.norm(np.diff(nodes, axis=0), axis=1) > 0.0):
            raise InvalidParameter("nodes", "coincident neighbours", "elements of a length above 0 [m]")
        object.__setattr__(self, "nodes", nodes)

    @property
    def arcs(self) -> Array:
        """Arc lengths at rest of the nodes (P,) [m]."""
        return np.append(0.0, np.cumsum(np.linalg.norm(np.diff(self.nodes, axis=0), axis=1)))

    @property
    def length(self) -> float:
        """Reference length [m]."""
        return float(np.linalg.norm(np.diff(self.nodes, axis=0), axis=1).sum())

    @property
    def places(self) -> Array:
        """Parts of the length at which the nodes are (P,), from 0 to 1."""
        return self.arcs / self.length

    @property
    def straight(self) -> bool:
        """Whether it is straight at rest, to round-off."""
        return self.length <= (1.0 + 1e-12) * float(np.linalg.norm(self.nodes[-1] - self.nodes[0]))


@dataclass(frozen=True, kw_only=True, eq=False)
class Body:
    """A rigid body: centre of mass at rest (2,) [m], mass [kg], inertia about the centre [kg m^2], name.

    A body without mass and inertia is legal: it is then the common end node of the strips.
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
    """Strips between ground and rigid bodies, the element they are made of, and the effects of the scene.

    Args:
        strips: one or more, all of the same number of elements, of different names if they are many.
        bodies: the rigid bodies, of different names; none is legal.
        element: "corotational" (Euler-Bernoulli) or "reissner" (with shear).
        effects: the named effects.
    """

    strips: tuple[Strip, ...]
    bodies: tuple[Body, ...] = ()
    element: str = "corotational"
    effects: Effects = field(default_factory=Effects)

    def __post_init__(self) -> None:
        choice("element", self.element, ELEMENTS)
        if "shear" in self.effects and self.element == ELEMENTS[0]:
            raise InvalidParameter("element", self.element, f"{ELEMENTS[1]} for shear [name]")
        sizes = {len(strip.nodes) for strip in self.strips}
        if len(sizes) != 1:
            raise InvalidParameter(
                "strips", sorted(sizes), "one or more strips with the same number of nodes [1]"
            )
        for strip in self.strips:
            for end in (strip.root, strip.tip):
                if end not in (GROUND, FREE) and not 0 <= end < len(self.bodies):
                    raise InvalidParameter("strips", end, f"ends on {len(self.bodies)} bodies [index]")
        for kind, names in (("strips", self.strip_names), ("bodies", self.body_names)):
            if len(set(names)) != len(names):
                raise InvalidParameter(kind, names, "names that differ [name]")
        self._check_places()
        self._check_sides()

    def _check_places(self) -> None:
        """Refuse loads and drives on what is not there."""
        for load in (self.effects.find(AppliedForce), self.effects.find(AppliedMoment)):
            if load is not None:
                self.body_index(load.body)
        tip = self.effects.find(TipForce)
        if tip is not None and self.strips[self.strip_index(tip.strip)].tip != FREE:
            raise InvalidParameter("tip_force", tip.strip, "a strip whose tip is free [name]")
        led = self.effects.find(DrivenDisplacement)
        if led is not None and not self.bodies:
            raise InvalidParameter("driven_displacement", "no bodies", "a body to lead [name]")
        if led is not None and led.body is not None:
            self.body_index(led.body)

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
            if strip.section.width is None:
                raise InvalidParameter(named[0], strip.name, "strips with width and thickness [name]")
            if curl and not strip.straight:
                raise InvalidParameter(curl[0], strip.name, "straight strips [name]")
            if "clamped_width" in curl and FREE in (strip.root, strip.tip):
                raise InvalidParameter("clamped_width", strip.name, "strips clamped at both ends [name]")

    @property
    def rest(self) -> Array:
        """Positions of the nodes at rest (G, P, 2) [m]."""
        return np.array([strip.nodes for strip in self.strips])

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
    def body(self) -> Body:
        """The one body of a model that has one."""
        return self.bodies[self.body_index(None)]

    def body_index(self, name: str | None) -> int:
        """Return the place of the body of this name; None means the only one there is."""
        known = ", ".join(self.body_names) or "no bodies"
        if len(self.bodies) != 1 if name is None else name not in self.body_names:
            raise InvalidParameter("body", name, f"one of {known} [name]")
        return 0 if name is None else self.body_names.index(name)

    def strip_index(self, name: str) -> int:
        """Return the place of the strip of this name."""
        return self.strip_names.index(choice("strip", name, self.strip_names))


def require_model(value: Any) -> None:
    """Refuse what is no model of this package, such as a mechanism of the splines."""
    made = "what cross_axis_pivot or compliant_mechanism of fe_reference returns"
    require_kind("mechanism", value, Model, made)
