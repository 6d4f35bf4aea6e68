"""Units of the unknowns: what makes a residual dimensionless."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from spline_model.effects import Bending, Clamp, DrivenDisplacement
from spline_model.effects.base import Constraint
from spline_model.layout import Layout
from spline_model.scene import Scene


@dataclass(frozen=True, kw_only=True, eq=False)
class Scales:
    """Length L and energy EI / L of a scene.

    Scaled by ``unit / energy`` a force row is in EI/L^2, a moment row in EI/L, a
    compatibility or constraint row in L or rad: no tolerance changes its meaning with the
    size, the material or the slenderness of a design.
    """

    scene: Scene
    layout: Layout
    length: float
    energy: float

    @cached_property
    def unit(self) -> NDArray[np.float64]:
        """The unit of each unknown (N,)."""
        force, moment = self.energy / self.length, self.energy
        unit = np.full(self.layout.size, self.length)
        for start in self.layout.bodies.values():
            unit[start + 2] = 1.0
        for start, count in self.layout.modes:
            unit[start : start + count] = force
        for constraint, (row, count) in zip(self.scene.of(Constraint), self.layout.multipliers, strict=True):
            if isinstance(constraint, Clamp):
                unit[row : row + count] = (force, force, moment)
            else:
                unit[row : row + count] = force if isinstance(constraint, DrivenDisplacement) else moment
        return unit


def scene_scales(scene: Scene, layout: Layout) -> Scales:
    """Scales from the longest strip and the largest flexural rigidity."""
    length = max(_arc_length(strip.control_points) for strip in scene.strips)
    rigidity = max((e.flexural_rigidity for e in scene.of(Bending)), default=1.0)
    return Scales(scene=scene, layout=layout, length=length, energy=rigidity / length)


def _arc_length(control_points: NDArray[np.float64]) -> float:
    """Length of the control polygon: the arc length of a straight strip, an upper bound of a curved one."""
    return float(np.hypot(*np.diff(control_points, axis=0).T).sum())
