"""Strips: axis at rest, what their ends are on, and section, as plain SI numbers."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from . import read
from .arrays import Array
from .read import InvalidParameter

#: How an end of a strip is held on what it is on.
JOINTS = ("clamp", "hinge")
#: Name of what does not move.
FIXED = "ground"
#: Area and second moment of a section that is told by its sides.
NOT_GIVEN = math.nan
#: How far area and second moment may be from those of the sides beside them: printed values are rounded.
ROUNDING = 1e-3


@dataclass(frozen=True, kw_only=True)
class StripDesign(read.Checked):
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
    start: Annotated[read.Pair | Sequence[float], read.pair, "m"]
    end: Annotated[read.Pair | Sequence[float], read.pair, "m"]
    root: str | None = FIXED
    tip: str | None
    root_joint: Annotated[str, read.choice, JOINTS] = JOINTS[0]
    tip_joint: Annotated[str, read.choice, JOINTS] = JOINTS[0]
    rise: Annotated[float, read.finite, "m"] = 0.0
    area: Annotated[float, read.positive, "m^2"] = NOT_GIVEN
    second_moment_of_area: Annotated[float, read.positive, "m^4"] = NOT_GIVEN
    youngs_modulus: Annotated[float, read.positive, "Pa"]
    poisson_ratio: Annotated[float, read.within, -1.0, 0.5, "1"]
    density: Annotated[float, read.positive, "kg/m^3"]
    shear_factor: Annotated[float, read.positive, "1"] = 5.0 / 6.0
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
        """Fill in area and second moment from the sides; refuse contradictions and half a section."""
        names = ("area", "second_moment_of_area")
        missing = [name for name in names if getattr(self, name) != getattr(self, name)]  # NOT_GIVEN
        ends = (self.width_end, self.thickness_end)
        if all(side is None for side in (self.width, self.thickness, *ends)):
            if missing:
                raise InvalidParameter(missing[0], "nothing", "it, or width and thickness of a rectangle [m]")
            return
        b, t = (read.positive(name, getattr(self, name), "m") for name in ("width", "thickness"))
        for name, side in zip(("width_end", "thickness_end"), ends, strict=True):
            if side is not None:
                read.positive(name, side, "m")
        for name, made, power in zip(names, (b * t, b * t**3 / 12.0), (2, 4), strict=True):
            if name in missing:
                object.__setattr__(self, name, made)
            elif abs(read.positive(name, getattr(self, name), f"m^{power}") - made) > ROUNDING * made:
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
