"""What a load factor stands for, in words: rotation, displacement, force and moment that act there."""

from __future__ import annotations

import math
from dataclasses import dataclass

from spline_model.compile import System
from spline_model.effects import AppliedForce, AppliedMoment, Driven, DrivenRotation
from spline_model.effects.base import Load

PREFIXES = {9: "G", 6: "M", 3: "k", 0: "", -3: "m", -6: "u", -9: "n"}
"""Prefixes by their powers of ten."""
PLAIN = 1e-2, 1e4
"""Sizes of forces and moments that are readable without one."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Place:
    """What the load factors of a path are called, with rotation [deg], ways [mm], forces [N], moments [N m].

    system: None where they are shares of weight and pre-strain.
    """

    system: System | None

    def at(self, load_factor: float, rotation: float = math.nan) -> str:
        """Return the words for one place.

        load_factor [1]; rotation [rad] of the driven body, if it is known better than by the load factor.
        """
        if self.system is None:
            return f"{100 * load_factor:.6g} % of weight and pre-strain"
        if self._is_steady:
            return self._acting(load_factor, rotation).strip(" ()")
        return f"load factor {self._share(load_factor):.6g}{self._acting(load_factor, rotation)}"

    def between(self, last: float, following: float) -> str:
        """Return the words for two neighbouring places, by their load factors [1]."""
        if self.system is None:
            return f"{100 * last:.6g} and {self.at(following)}"
        if self._is_steady:
            return f"{self.at(last)} and {self.at(following)}"
        acting = self._acting(following, math.nan)
        return f"load factor {self._share(last):.6g} and {self._share(following):.6g}{acting}"

    @property
    def _is_steady(self) -> bool:
        """Whether loads or driven displacements act in full at any load factor, the rotation's alone."""
        assert self.system is not None
        return any(getattr(effect, "steady", False) for effect in self.system.scene.effects)

    def _share(self, load_factor: float) -> float:
        """The share of the loads: of a driven rotation its size, to whichever side it goes."""
        assert self.system is not None
        return load_factor if self.system.scene.driven_row is None else abs(load_factor)

    def _acting(self, load_factor: float, rotation: float) -> str:
        assert self.system is not None
        parts = _drives(self.system, load_factor, rotation) + _loads(self.system, load_factor)
        return f" ({', '.join(parts)})" if parts else ""


def _drives(system: System, load_factor: float, rotation: float) -> list[str]:
    parts = []
    for drive in (each for each in system.scene.of(Driven) if each.moves):
        share = 1.0 if drive.steady else load_factor
        if isinstance(drive, DrivenRotation):
            known = not (drive.beside or math.isnan(rotation))
            angle = rotation if known else share * drive.angle
            parts.append(f"rotation {math.degrees(angle):.5g} deg")
        else:
            size = 1e3 * abs(share) * math.hypot(*drive.parts.values())
            parts.append(f"displacement {size:.4g} mm")
    return parts


def _loads(system: System, load_factor: float) -> list[str]:
    parts = []
    for load in system.scene.of(Load):
        share = 1.0 if getattr(load, "steady", False) else load_factor
        if isinstance(load, AppliedMoment) and load.moment:
            parts.append(f"moment {_sized(share * load.moment)}N m")
        elif isinstance(load, AppliedForce) and any(load.force):
            parts.append(f"force {_sized(abs(share) * math.hypot(*load.force))}N")
    return parts


def _sized(value: float) -> str:
    """A number with four digits and the prefix that spares it a power of ten."""
    if value == 0.0 or PLAIN[0] <= abs(value) < PLAIN[1]:
        return f"{value:.4g} "
    power = max(-9, min(9, 3 * math.floor(math.log10(abs(value)) / 3)))
    return f"{value / 10.0**power:.4g} {PREFIXES[power]}"
