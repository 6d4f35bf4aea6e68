"""The equations of a pivot as the sum of what its effects say of states and design."""

from __future__ import annotations

import numpy as np

from spline_model.basis import SlideModes
from spline_model.compile import System
from spline_model.effects import MixedStretching
from spline_model.pivot import Pivot
from spline_model.sensitivity.bending import BendingPoints
from spline_model.sensitivity.lines import Line
from spline_model.sensitivity.mixed import MixedPoints
from spline_model.sensitivity.parameters import Rates
from spline_model.sensitivity.stretching import StretchingPoints


def bending_points(pivot: Pivot, system: System, rates: Rates) -> BendingPoints:
    """Bending of all strips."""
    strip, table = pivot.mechanism.design.strips[0], system.tables.bending
    return BendingPoints(
        first=Line.at_gauss(table.first, table.d1, system.layout.size),
        second=Line.at_gauss(table.first, table.d2, system.layout.size),
        weight=table.weight,
        rigidity=strip.flexural_rigidity,
        curvature=table.curvature,
        speed=strip.length,
        by_rigidity=rates.modulus * strip.second_moment_of_area + strip.youngs_modulus * rates.second_moment,
        by_speed=rates.length,
    )


def axial_points(pivot: Pivot, system: System, rates: Rates) -> MixedPoints | StretchingPoints:
    """Stretching of all strips, in the form that the discretisation has."""
    strip, table = pivot.mechanism.design.strips[0], system.tables.stretching
    if not table.first.size:
        return _mixed(pivot, system, rates)
    return StretchingPoints(
        line=Line.at_gauss(table.first, table.d1, system.layout.size),
        weight=table.weight,
        strain=table.strain,
        rigidity=strip.axial_rigidity,
        speed=strip.length,
        by_rigidity=rates.modulus * strip.area + strip.youngs_modulus * rates.area,
        by_speed=rates.length,
    )


def _mixed(pivot: Pivot, system: System, rates: Rates) -> MixedPoints:
    strip, table = pivot.mechanism.design.strips[0], system.tables.axial_force
    count = len(table.first)
    modes = np.zeros((count, system.layout.size))
    columns = table.mode_first[:, None] + np.arange(table.modes.shape[1])
    used = np.arange(table.modes.shape[1]) < table.mode_width[:, None]
    modes[np.nonzero(used)[0], columns[used]] = table.modes[used]
    softer = -rates.modulus / strip.youngs_modulus  # d(log c)/dp, without what A or I and L add
    axial = softer - rates.area / strip.area
    slide = softer - rates.second_moment / strip.second_moment_of_area + 2.0 * rates.length / strip.length
    effects = system.scene.of(MixedStretching)
    slides = [isinstance(effect.modes, SlideModes) for effect in effects]
    of_slides = np.repeat(slides, count // len(effects))  # all strips have as many points
    return MixedPoints(
        line=Line.at_gauss(table.first, table.d1, system.layout.size),
        modes=modes,
        weight=table.weight,
        strain=table.strain,
        compliance=table.compliance,
        speed=strip.length,
        by_compliance=table.compliance[:, None] * np.where(of_slides[:, None], slide, axial),
        by_speed=rates.length,
    )
