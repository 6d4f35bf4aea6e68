"""The numbers that every state of an answer has, each declared once.

Tables, JSON, CSV, VTK, pictures, the columns of a sweep, `compare` and docs/data.md follow from these
entries: a new quantity is one more of them.
"""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from operator import attrgetter
from typing import Any

import numpy as np

from studies.cases.design import Design, flexural_scale
from studies.cases.section import Sectioned
from studies.kinds import Array

#: Analyses.
PATH, MOTION, MODES = "static", "release", "modes"
#: Energy that solvers do not resolve, in EI/L of the stiffest strip.
ENERGY_FLOOR = 1e-20
#: End of a key -> its unit, and what solvers do not resolve: of moments, forces and energies in EI/L of the
#: stiffest strip, of stress in E, of displacements in strip lengths.
UNITS = {
    "_Nm_per_rad": ("N m/rad", 1e-9),
    "_N_per_m": ("N/m", 1e-9),
    "_Nm": ("N m", 1e-9),
    "_N": ("N", 1e-9),
    "_J": ("J", ENERGY_FLOOR),
    "_Pa": ("Pa", 1e-12),
    "_m": ("m", 1e-12),
    "_rad": ("rad", 1e-12),
    "_Hz": ("Hz", 0.0),
}
#: Which state stands for a path, by what is said of it, of values (..., S).
STANDING: dict[str, Callable[[Array], Array]] = {
    "end": lambda values: np.asarray(values[..., -1]),
    "largest": lambda values: np.asarray(np.abs(values).max(axis=-1)),
}


#: What stands for a number that there is none of.
NOTHING = "-"
#: Power of ten -> prefix.
PREFIXES = {9: "G", 6: "M", 3: "k", 0: "", -3: "m", -6: "µ", -9: "n", -12: "p", -15: "f", -18: "a"}


def power_of(largest: float, highest: int = max(PREFIXES), lowest: int = min(PREFIXES)) -> int:
    """Return the power of ten of the SI prefix with at most three digits before the decimal point.

    Args:
        largest: value in the SI unit; 0 has the power nearest to none. highest, lowest: of the power [1].
    """
    power = 3 * math.floor(math.log10(largest) / 3.0) if largest > 0.0 else 0
    return max(lowest, min(highest, power))


def fixed(value: float, decimals: int) -> str:
    """Return a number, of any unit, with so many decimals; zero has no sign, and NaN is a dash."""
    return f"{round(value, decimals) + 0.0:.{decimals}f}" if math.isfinite(value) else NOTHING


def stress_of(strips: Sequence[Sectioned], axial_force: Array, bending_moment: Array) -> Array:
    """Return the extreme fibre stress of strips (S, G, P) [Pa] from their forces (S, G, P) [N, N m]."""
    forces = zip(np.moveaxis(axial_force, 1, 0), np.moveaxis(bending_moment, 1, 0), strict=True)
    pairs = zip(strips, forces, strict=True)
    return np.stack([strip.youngs_modulus * strip.extreme_fibre_strain(*own) for strip, own in pairs], axis=1)


def peak(values: Array) -> Array:
    """Return the largest value (...) of values (..., P), of any unit, along the last axis.

    A parabola through the neighbours of the largest value is used; the values are evenly spaced.
    """
    left, middle, right = values[..., :-2], values[..., 1:-1], values[..., 2:]
    bend = 2.0 * middle - left - right
    at_top = (middle >= left) & (middle >= right) & (bend > 0.0)
    rise = np.where(at_top, (right - left) ** 2 / np.where(at_top, 8.0 * bend, 1.0), 0.0)
    return np.asarray(np.maximum(values.max(axis=-1), (middle + rise).max(axis=-1, initial=0.0)))


@dataclass(frozen=True, kw_only=True)
class Scale:
    """Form of numbers of one kind in pictures and in the lines of `compare`.

    Attributes:
        heading: name. unit: in SI. highest: power of ten of the largest prefix.
        factor: to a unit without prefix, such as degrees for radians; 0 for a unit with prefixes.
    """

    heading: str
    unit: str = ""
    highest: int = 3
    factor: float = 0.0

    def fitting(self, arrays: Iterable[Array]) -> tuple[float, str]:
        """Return the factor to the unit that suits these values (any shape, in SI units), and that unit."""
        if self.factor:
            return self.factor, self.unit
        largest = max((float(np.nanmax(np.abs(each), initial=0.0)) for each in arrays), default=0.0)
        power = power_of(largest, self.highest)
        return 10.0**-power, PREFIXES[power] + self.unit

    def named(self, unit: str) -> str:
        """Return the label of an axis in that unit."""
        return f"{self.heading} [{unit}]" if unit else self.heading

    @classmethod
    def of_key(cls, key: str, highest: int = 6) -> "Scale":
        """Return the form of the numbers that files have under a key, which ends with its unit, if any."""
        end = next((end for end in UNITS if key.endswith(end)), "")
        heading = key.removesuffix(end).replace("_", " ")
        if not end:
            return Scale(heading=heading, factor=1.0)
        return Scale(heading=heading, unit=UNITS[end][0], highest=highest)


@dataclass(frozen=True, kw_only=True)
class Quantity(Scale):
    """One number of every state of an answer.

    Attributes:
        key: its name in files, which ends with its unit, as of `UNITS`.
        meaning: what it is.
        heading, of: the rest of the key, and the attribute of an answer of that name, unless they are given:
            what it is called, and its values (S,) in an answer.
        analyses: that have it, of PATH, MOTION and MODES.
        digits: significant, in tables.
        standing: the state that stands for the path in `compare` and a sweep, of `STANDING`; "": none does.
        swept: name of its column in a sweep; "": as the key.
        mechanisms: whether only files have it, and of mechanisms alone.
        chart: whether a picture of a path has a curve of it over the states.
        drive: whether it is of a drive, which only a driven rotation has.
        estimated: names of the errors that models estimate of it.
        group: what it is of, where that is a part of the design; above its column in a table.
    """

    key: str
    meaning: str
    heading: str = ""
    of: Any = None
    analyses: tuple[str, ...] = (PATH,)
    highest: int = 0
    digits: int = 7
    standing: str = "end"
    swept: str = ""
    mechanisms: bool = False
    chart: bool = True
    drive: bool = False
    estimated: tuple[str, ...] = ()
    group: str = ""
    floor: float = field(init=False)

    def __post_init__(self) -> None:
        end = next(end for end in UNITS if self.key.endswith(end))
        name = self.key.removesuffix(end)
        values = (*UNITS[end], self.heading or name.replace("_", " "), self.of or attrgetter(name))
        for attribute, value in zip(("unit", "floor", "heading", "of"), values, strict=True):
            object.__setattr__(self, attribute, value)

    def named(self, unit: str) -> str:
        """Return the label of an axis in that unit, below the name of its part."""
        return f"{self.group}\n{super().named(unit)}" if self.group else super().named(unit)

    @property
    def name_in_sweep(self) -> str:
        """Name of its column in a sweep."""
        return self.swept or self.key

    def least(self, design: Design) -> float:
        """Return the round-off value of a design for this quantity, in its SI unit."""
        if self.unit == "Pa":
            return self.floor * max(float(strip.youngs_modulus) for strip in design.strips)
        length = max(strip.length for strip in design.strips)
        bending = flexural_scale(design)
        scales = {"m": length, "N": bending / length, "rad": 1.0}
        return self.floor * scales.get(self.unit, bending)


#: Energies of a motion.
_MOVING: dict[str, Any] = {"analyses": (MOTION,), "standing": ""}

QUANTITIES = (
    Quantity(key="torque_Nm", meaning="torque of the drive", drive=True),
    Quantity(
        key="stiffness_Nm_per_rad",
        meaning="stiffness of the driven rotation at fixed loads",
        standing="",
        drive=True,
    ),
    Quantity(
        key="strain_energy_J",
        heading="energy",
        meaning="energy stored in all strips",
        swept="energy_J",
        chart=False,  # its parts are drawn
    ),
    Quantity(
        key="gravity_energy_J",
        heading="gravity",
        meaning="energy of the weight against rest",
        standing="",
        mechanisms=True,
        chart=False,
    ),
    Quantity(
        key="work_J",
        meaning="work of drives and loads since the first state",
        analyses=(PATH, MOTION),
        standing="",
        mechanisms=True,
        chart=False,
    ),
    Quantity(
        key="max_stress_Pa",
        heading="stress",
        meaning="largest extreme-fibre stress of all strips",
        analyses=(PATH, MOTION),
        highest=6,
        digits=6,
        standing="largest",
        swept="stress_max_Pa",
        chart=False,  # drawn with the yield strength
    ),
    Quantity(key="kinetic_J", meaning="of a motion", of=attrgetter("kinetic_energy"), **_MOVING),
    Quantity(key="strain_J", meaning="of a motion, of all strips", of=attrgetter("strain_energy"), **_MOVING),
    Quantity(
        key="gravity_J",
        meaning="of a motion against rest",
        of=attrgetter("gravity_energy"),
        mechanisms=True,
        **_MOVING,
    ),
    Quantity(key="dissipated_J", meaning="of a motion since its start", mechanisms=True, **_MOVING),
    Quantity(
        key="frequency_Hz",
        meaning="of the mode; negative where the state is unstable",
        analyses=(MODES,),
        standing="",
    ),
)


#: Numbers along the strips, by their key: the attribute of an answer, and what they are.
ALONG = {
    "curvature_per_m": ("along.curvature", "of the deformed strip, by its length at rest [1/m]"),
    "stretch": ("along.stretch", "length over length at rest [1]"),
    "axial_force_N": ("along.axial_force", "tension positive [N]"),
    "shear_force_N": (
        "along.shear_force",
        "of the part beyond on the part before, along the normal to the left [N]",
    ),
    "bending_moment_Nm": (
        "along.bending_moment",
        "positive for counter-clockwise curvature from root to tip [N m]",
    ),
    "extreme_fibre_stress_Pa": (
        "stress",
        "larger magnitude of axial and bending stress at the two outer fibres [Pa]",
    ),
}


def along_of(answer: Any) -> dict[str, Array]:
    """Return the numbers along the strips (S, G, P) in SI units by key."""
    return {key: attrgetter(path)(answer) for key, (path, _) in ALONG.items()}
