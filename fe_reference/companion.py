"""How far a motion is resolved by its elements, by a companion of fewer: half as many, a third where odd."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .errors import ConvergenceError, InvalidParameter
from .explicit import critical_step
from .mass import about_mass_centre
from .model import Model
from .solution import Status
from .structure import structure_of
from .trajectory import Trajectory

Array = NDArray[np.float64]

#: Estimated error of the rotation over the swing that is not remarked on.
UNRESOLVED = 0.05
#: Error of a motion that hardly is one [rad]: its start alone has it.
STILL = 1e-6
#: Part of the companion's critical step that it takes.
SAFETY = 0.8
#: Most elements that one of the companion's stands for.
COARSEST = 5


def coarser(model: Model) -> tuple[Model, int]:
    """Return the model on every second, third or fifth node, and which; 1 where none of these is possible."""
    elements = len(model.strips[0].nodes) - 1
    every = next((k for k in range(2, COARSEST + 1) if elements % k == 0 and elements > k), 1)
    strips = tuple(replace(strip, nodes=strip.nodes[::every]) for strip in model.strips)
    return replace(model, strips=strips), every


def with_companion(
    model: Model, motion: Trajectory, body: str | None, run: Callable[..., Trajectory]
) -> Trajectory:
    """Return a trajectory with its `rotation_error`, and a remark in `resolution` where that is much.

    The error goes with the square of the element, so that of the motion is the difference to the companion
    over the square of the ratio less one; the steps, which stability keeps short, have a share in both. A
    motion that stopped, a single instant and a mesh that cannot be halved are returned as they are.

    Args:
        model, motion: the motion and its model. body: name of the one whose rotation is compared.
        run: solves a model from the same start by `duration`, `step` and `samples`.
    """
    coarse, every = coarser(model)
    if every == 1 or motion.status is not Status.CONVERGED or len(motion.time) < 3:
        return motion
    samples = len(motion.time) - 2  # the last may be shorter
    spacing = float(motion.time[1])
    step = spacing / math.ceil(spacing / _longest(model, coarse, motion.settings))
    try:
        other = run(coarse, duration=samples * spacing, step=step, samples=samples)
        failed = other.message
    except (ConvergenceError, InvalidParameter) as refusal:
        failed = str(refusal)
    if failed or len(other.time) != samples + 1:
        return replace(motion, resolution=f"not checked with 1/{every} of the elements: {failed}")
    fine = _rotation(motion, model, body)[: samples + 1]
    error = np.abs(fine - _rotation(other, coarse, body)) / (every**2 - 1)
    remarks = [motion.resolution, _remark(model, motion, body, error)]
    remark = "; ".join(each for each in remarks if each)
    return replace(motion, rotation_error=float(error.max()), resolution=remark)


def _longest(model: Model, coarse: Model, settings: Any) -> float:
    """Return the longest step of the companion [s]: that of the motion, or an explicit one that is stable."""
    if "critical_step_s" not in settings:
        return float(settings["step_s"]) * (1.0 + 1e-9)
    at_rest = []
    for each in (model, coarse):
        structure, bodies = about_mass_centre(structure_of(each))
        at_rest.append(critical_step(structure, bodies, np.zeros(structure.size)))
    return SAFETY * float(settings["critical_step_s"]) * at_rest[1] / at_rest[0]


def _rotation(motion: Trajectory, model: Model, body: str | None) -> Array:
    """Return the rotation of the body (T,) [rad]."""
    return motion.bodies[model.body_names[model.body_index(body)]][:, 2]


def _remark(model: Model, motion: Trajectory, body: str | None, error: Array) -> str:
    """Return what is to be said of the estimated errors (T,) [rad], or nothing.

    They are held against the swing: half the range of the rotation, or of the nodes over the longest strip
    where the body hardly turns.
    """
    length = max(strip.length for strip in model.strips)
    travel = float(np.ptp(motion.shape, axis=0).max()) / length
    swing = 0.5 * max(float(np.ptp(_rotation(motion, model, body))), travel)
    much = np.flatnonzero(error > max(UNRESOLVED * swing, STILL))
    if not much.size:
        return ""
    return (
        f"the rotation is uncertain by {np.degrees(error.max()):.3g} deg, by more than {UNRESOLVED:.0%} of "
        f"the swing from {motion.time[much[0]]:.3g} s on: the motion is not resolved; take more elements"
    )
