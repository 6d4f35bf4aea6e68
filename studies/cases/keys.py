"""The keys of a case file: unit, admissible values and the attribute of `Problem` that each one fills."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any


def _same(value: float) -> float:
    return float(value)


@dataclass(frozen=True, kw_only=True)
class Number:
    """A finite number in an interval, whose ends are excluded unless closed, converted to SI by `to_si`."""

    expected: str
    low: float = -math.inf
    high: float = math.inf
    closed_low: bool = False
    closed_high: bool = False
    to_si: Callable[[float], float] = _same
    from_si: Callable[[float], float] = _same

    def parse(self, value: Any) -> float:
        """Return `value` (in the file's unit) in SI; ValueError says what was got and expected."""
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise ValueError(f"got {_shown(value)}, expected {self.expected}")
        number = float(value)
        above = number >= self.low if self.closed_low else number > self.low
        below = number <= self.high if self.closed_high else number < self.high
        if not (math.isfinite(number) and above and below):
            raise ValueError(f"got {_shown(value)}, expected {self.expected}")
        return self.to_si(number)

    def verify(self, value: Any) -> None:
        """Raise ValueError unless `value` (SI) is admissible."""
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise ValueError(f"got {_shown(value)}, expected {self.expected}")
        self.parse(self.from_si(float(value)))


@dataclass(frozen=True, kw_only=True)
class Whole:
    """A whole number from `low` to `high`, both included."""

    expected: str
    low: int
    high: int

    def parse(self, value: Any) -> int:
        """Return `value`; raises ValueError that says what was got and expected."""
        if isinstance(value, bool) or not isinstance(value, int) or not self.low <= value <= self.high:
            raise ValueError(f"got {_shown(value)}, expected {self.expected}")
        return value

    def verify(self, value: Any) -> None:
        """Raise ValueError unless `value` is admissible."""
        self.parse(value)


@dataclass(frozen=True, kw_only=True)
class Pair:
    """Two finite numbers [x, y]."""

    expected: str

    def parse(self, value: Any) -> tuple[float, float]:
        """Return `value` as a tuple; raises ValueError that says what was got and expected."""
        if not isinstance(value, list | tuple) or len(value) != 2:
            raise ValueError(f"got {_shown(value)}, expected {self.expected}")
        for part in value:
            if isinstance(part, bool) or not isinstance(part, int | float) or not math.isfinite(part):
                raise ValueError(f"got {_shown(value)}, expected {self.expected}")
        return float(value[0]), float(value[1])

    def verify(self, value: Any) -> None:
        """Raise ValueError unless `value` is admissible."""
        self.parse(value)


@dataclass(frozen=True, kw_only=True)
class Key:
    """One key of a case file, the attribute of `Problem` it fills and the rule for its value."""

    section: str
    name: str
    attribute: str
    rule: Number | Whole | Pair
    optional: bool = False


def _shown(value: Any) -> str:
    """Return `value` as it stands in a TOML file, with its type where that is the likely mistake."""
    if isinstance(value, str):
        return f'the text "{value}"'
    if isinstance(value, bool):
        return f"the truth value {str(value).lower()}"
    return str(value)


def _positive(unit: str) -> Number:
    return Number(expected=f"a positive number [{unit}]", low=0.0)


ROTATION = Number(
    expected="a number from -360 to 360 [deg]",
    low=-360.0,
    high=360.0,
    closed_low=True,
    closed_high=True,
    to_si=math.radians,
    from_si=math.degrees,
)
INCREMENTS = Whole(expected="a whole number from 1 to 100000", low=1, high=100_000)

KEYS: tuple[Key, ...] = (
    Key(section="strip", name="length_m", attribute="length", rule=_positive("m")),
    Key(
        section="strip",
        name="inclination_deg",
        attribute="inclination",
        rule=Number(
            expected="a number between 0 and 90, both excluded [deg]",
            low=0.0,
            high=90.0,
            to_si=math.radians,
            from_si=math.degrees,
        ),
    ),
    Key(
        section="strip",
        name="crossing_ratio",
        attribute="crossing_ratio",
        rule=Number(expected="a number between 0 and 1, both excluded [1]", low=0.0, high=1.0),
    ),
    Key(section="strip", name="area_m2", attribute="area", rule=_positive("m^2")),
    Key(section="strip", name="second_moment_m4", attribute="second_moment_of_area", rule=_positive("m^4")),
    Key(
        section="strip", name="section_depth_m", attribute="section_depth", rule=_positive("m"), optional=True
    ),
    Key(section="material", name="youngs_modulus_Pa", attribute="youngs_modulus", rule=_positive("Pa")),
    Key(
        section="material",
        name="poisson_ratio",
        attribute="poisson_ratio",
        rule=Number(expected="a number above -1 and at most 0.5 [1]", low=-1.0, high=0.5, closed_high=True),
    ),
    Key(section="material", name="density_kg_m3", attribute="density", rule=_positive("kg/m^3")),
    Key(section="body", name="mass_kg", attribute="body_mass", rule=_positive("kg")),
    Key(
        section="body",
        name="moment_of_inertia_kg_m2",
        attribute="body_moment_of_inertia",
        rule=_positive("kg m^2"),
    ),
    Key(
        section="body",
        name="centre_offset_m",
        attribute="centre_offset",
        rule=Pair(expected="two finite numbers [x, y] [m]"),
    ),
    Key(section="drive", name="rotation_deg", attribute="rotation", rule=ROTATION),
    Key(section="drive", name="increments", attribute="increments", rule=INCREMENTS),
)
