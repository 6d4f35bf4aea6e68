"""The cheapest setting of every model that meets an error on one design, found by trying them all."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from studies.answers.adapters import answer_modes
from studies.answers.settings import SplineSettings
from studies.cases.design import Design
from studies.cases.problem import Problem
from studies.cost import settings, tried
from studies.cost.model import elements, spline
from studies.errors import Unanswered
from studies.kinds import Progress
from studies.record.progress import silent

#: A motion is followed for this many periods of the first mode at rest, and compared at so many instants.
PERIODS, INSTANTS = 4.0, 501
#: Control points of the spline that motions are held against, and of the one that says how uncertain it is.
REFERENCE = (16, 14)
#: Passes of timing.
PASSES = 2


def advise_path(design: Design, error: float, progress: Progress = silent) -> pd.DataFrame:
    """Return the advice for the static path of a design, each model against the limit of its own theory.

    A row a group: setting, meets (whether trajectory and torque are within `error` over the path, and stay so
    in all finer settings), errors of trajectory, torque, stiffness and stress, and of each the `uncertainty`
    of its limit, times as of `tried`, message (why a model has no answer). Of a group that does not meet the
    error it is the best setting.

    Raises:
        NoReference: the finite elements do not reach the end of the path.
    """
    asked = _askable(settings.paths(), design)
    limits = {theory: tried.path_limit(design, theory) for theory in {each.theory for each in asked}}
    rows = tried.compared(asked, design, limits, passes=PASSES, progress=progress)
    return _uncertain(tried.cheapest(rows, tried.PATH_JUDGED, error), limits)


def advise_swing(design: Design, error: float, progress: Progress = silent) -> pd.DataFrame:
    """Return the advice for the motion of a design after its release from the end of its path.

    Columns as of `advise_path`, with the errors of rotation (largest over the motion, over the rotation at
    the start) and of frequency. All are held against a spline of `REFERENCE` control points.

    Raises:
        NoReference: that spline's motion stops early.
    """
    frequency = float(answer_modes(design, SplineSettings(control_points=6), count=1).frequency[0])
    instants, start = np.linspace(0.0, PERIODS / frequency, INSTANTS), abs(design.rotation or 0.0)
    steps: dict[int, float | None] = dict.fromkeys(REFERENCE)
    limit = tried.swing_limit(design, instants, _integrator(design, 0.1 * PERIODS / frequency), steps)
    limits = {tried.MATERIAL: limit}
    asked = [each for each in _askable(settings.swings(frequency), design) if each.theory in limits]
    rows = tried.compared(asked, design, limits, instants, passes=PASSES, progress=progress)
    rows["rotation"] = rows.pop("rotation_rad") / start
    known = limit.uncertainty
    uncertainty = {"rotation": known["rotation_rad"] / start, "frequency": known["frequency"]}
    best = tried.cheapest(rows, ("rotation", "frequency"), error)
    return _uncertain(best, {tried.MATERIAL: replace(limit, uncertainty=uncertainty)})


def _askable(given: list[settings.Setting], design: Design) -> list[settings.Setting]:
    """Return the settings of installed models; of a mechanism those of the suite's own."""
    own = (spline, elements)
    pivot = isinstance(design, Problem)
    return [each for each in given if each.model.installed() and (pivot or each.model in own)]


def _integrator(design: Design, duration: float) -> str:
    """Return the spline's most accurate integrator that the scene allows, by trying."""
    try:
        spline.swing(design, duration, integrator="leapfrog", control_points=4)
    except Unanswered:
        return "energy"
    return "leapfrog"


def _uncertain(found: pd.DataFrame, limits: Mapping[str, Any]) -> pd.DataFrame:
    """Return the advice with how uncertain the limit of each quantity is."""
    names = next(iter(limits.values())).uncertainty
    columns: dict[str, list[Any]] = {
        f"uncertainty_{name}": [limits[theory].uncertainty[name] for theory in found["theory"]]
        for name in names
    }
    return found.assign(**columns)
