"""Swings of the spline and of other codes: errors against the limit of each one's theory, and times."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from studies.answers.adapters import answer_release
from studies.answers.settings import FeSettings, SplineSettings
from studies.answers.swing import RECORDS, limit_of, sampled
from studies.baselines.answer import BaselineMotion
from studies.baselines.comparison.variants import (
    WITH_SHEAR,
    WITHOUT_SHEAR,
    Variant,
    release_variants,
    tried,
)
from studies.cases.problem import Problem
from studies.kinds import Array
from studies.paper import swings

#: Control points of the limit without shear, and those whose difference is its uncertainty.
REFINED, CHECK = 10, 8
#: Meshes of the limit with shear, a third apart: linear elements, whose waves need finer ones.
MESHES = (36, 54, 81, 121)
#: What the other codes' rods with shear have beside it.
ROTARY = "section_rotary_inertia"
#: Timed releases in a pass.
REPEAT = 1

ERRORS = ("rotation_rad", "uncertainty_rad", "step_s")


def limits(problem: Problem) -> tuple[dict[str, Array], list[dict[str, Any]]]:
    """Return the rotation of either theory at the common instants, with rows of how certain they are."""
    refined, check = (
        sampled(swings.resolved(SplineSettings(control_points=n)), swings.INSTANTS).rotation
        for n in (REFINED, CHECK)
    )
    with_rotary = replace(problem, effects=problem.effects.renamed([*problem.effects.names, ROTARY]))
    reissner = limit_of(
        [
            answer_release(
                with_rotary,
                FeSettings(elements=n, element="reissner"),
                duration=swings.DURATION,
                records=RECORDS,
            )
            for n in MESHES
        ],
        swings.INSTANTS,
    )
    rows = [
        _row("uncertainty", WITHOUT_SHEAR, float(np.abs(check - refined).max())),
        _row("uncertainty", WITH_SHEAR, float(reissner.uncertainty.max())),
        _row("difference of the theories", "", float(np.abs(reissner.swing.rotation - refined).max())),
    ]
    return {WITHOUT_SHEAR: refined, WITH_SHEAR: reissner.swing.rotation}, rows


def compared(
    problem: Problem,
    against: dict[str, Array],
    uncertainty: Mapping[str, float],
) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
    """Return errors with the uncertainty of their limit and work, and times, a row a variant."""

    def solve(variant: Variant) -> tuple[dict[str, Any], float]:
        motion = variant.module.release(
            problem,
            start=problem.rotation,
            duration=swings.DURATION,
            repeat=REPEAT,
            **variant.settings,
        )
        unsure = float(uncertainty[variant.theory])
        work = {name: motion.work.get(name, np.nan) for name in ("steps", "newton_iterations")}
        apart = float(np.abs(at_instants(motion) - against[variant.theory]).max())
        errors = {"rotation_rad": apart, "uncertainty_rad": unsure, "step_s": variant.settings["step"]}
        return errors | work, motion.solve_s

    return tried(release_variants(), solve, ERRORS)


def at_instants(motion: BaselineMotion) -> Array:
    """Return the rotation at the common instants by cubic interpolation between steps [rad]."""
    return np.asarray(CubicSpline(motion.time, motion.rotation)(swings.INSTANTS))


def _row(what: str, theory: str, error: float) -> dict[str, Any]:
    return {"what": what, "theory": theory, "rotation_rad": error}
