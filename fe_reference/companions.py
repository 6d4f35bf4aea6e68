"""How far elements and steps resolve a motion: by companions of other elements and steps.

Errors of elements and of steps go with their squares. Where a mesh can be made coarser twice, companions have
a fraction of the elements and longer steps in proportion, and cost little. Their differences show how far the
errors are those of that order: then a part of the difference is the error, else more or all of it.
Elements make a motion too fast and implicit steps too slow; one more companion, of fewer elements alone,
tells one from the other, lest they cancel. A mesh of few elements, or one whose companions fail, has one of
twice as many and half the step.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np

from .arrays import Array
from .errors import ConvergenceError, InvalidParameter
from .mass import about_mass_centre
from .model import Model
from .motion import Trajectory
from .places import FREE
from .refined import finer
from .schemes import critical_step
from .solution import Status
from .structure import structure_of

#: Estimated error over the swing that is not remarked on.
UNRESOLVED = 0.05
#: Error of a motion that hardly is one [rad, or of strip lengths]: its start alone has it.
STILL = 1e-6
#: Part of a companion's critical step that it takes at most.
SAFETY = 0.8
#: Fewest elements of a strip in a companion, and most that one of its elements stands for.
FEWEST, COARSEST = 4, 10
#: Ratio of two differences over that of errors of second order, down to which they have a part of that order,
#: and the inverse of that up to which they are of it.
OF_ORDER = 0.75
#: What errors are more than coarser companions tell: fast motions are lost to all of them. On 36 random
#: releases the estimate was down to 0.29 of the error without it.
SHARED = 2.0


#: A companion: its model, its step over that of the motion, and its longest one [s].
_Level = tuple[Model, float, float]


def with_companions(model: Model, motion: Trajectory, run: Callable[..., Trajectory]) -> Trajectory:
    """Return a trajectory with its estimated errors, and a remark in `resolution` where they are much.

    A motion that stopped and one of a few instants are returned as they are.

    Args:
        model, motion: the motion and its model.
        run: solves a model from the same start by `duration`, `step` and `samples`.
    """
    if motion.status is not Status.CONVERGED or len(motion.time) < 3:
        return motion
    for levels in (_coarse(model, motion), [_level(model, finer(model), 0.5, motion)]):
        if not levels:
            continue
        try:
            return _compared(model, motion, levels, run)
        except (ConvergenceError, InvalidParameter) as refusal:
            remark = f"error not estimated: a companion of other elements: {refusal}"
    return replace(motion, resolution="; ".join(each for each in (motion.resolution, remark) if each))


def _compared(
    model: Model, motion: Trajectory, levels: list[_Level], run: Callable[..., Trajectory]
) -> Trajectory:
    """Return the motion with what companions say of its errors, or raise what they were refused for."""
    spacing = float(motion.time[1])
    stride = math.ceil(max(longest for _, _, longest in levels) / spacing * (1.0 - 1e-9))
    samples, spacing = (len(motion.time) - 2) // stride, stride * spacing  # the last may be shorter
    found = [moves(model, motion, stride)]
    for mesh, _, longest in levels:
        step = spacing / math.ceil(spacing / longest * (1.0 - 1e-9))
        other = run(mesh, duration=samples * spacing, step=step, samples=samples)
        if other.message or len(other.time) != samples + 1:
            reached = other.message or f"{len(other.time)} instants"
            raise InvalidParameter("step", step, f"one that reaches the end: {reached}")
        found.append(moves(mesh, other))
    ratios = [ratio for _, ratio, _ in levels]
    turns, places = (
        _errors([mine[: samples + 1] for mine in each], ratios) for each in zip(*found, strict=True)
    )
    places = np.linalg.norm(places, axis=2)
    remarks = [motion.resolution, _remark(model, motion, turns, places, stride)]
    return replace(
        motion,
        rotation_error=float(turns.max(initial=0.0)),
        displacement_error=float(places.max(initial=0.0)),
        resolution="; ".join(each for each in remarks if each),
    )


def _errors(found: list[Array], ratios: list[float]) -> Array:
    """Return the error of every coordinate (T, ...), of the motion and its companions.

    Args:
        found: the motion, one or two companions, and perhaps one of the first's elements and the motion's
            steps. ratios: of the companions' elements to those of the motion.
    """
    apart = [mine - its for mine, its in pairwise(found[:3])]
    part, most = 1.0 / abs(ratios[0] ** 2 - 1.0), np.abs(apart[0])
    if len(apart) == 1:
        return np.asarray(part * most)
    if len(found) > 3:
        most = np.abs(found[0] - found[3]) + np.abs(found[3] - found[1])
    growth = part * (ratios[1] ** 2 - ratios[0] ** 2)
    first, second = (np.abs(each).max(axis=0) for each in apart)
    # too little growth: out of phase in all of them; too much: errors of the first companion cancel
    most = np.where(second > growth / OF_ORDER * first, np.maximum(np.abs(apart[1]), most), most)
    short = 1.0 - second / np.where(first > 0.0, growth * first, np.inf)
    part = np.interp(short, (0.0, 1.0 - OF_ORDER), (part, 1.0))
    return np.asarray(SHARED * part * most)


def moves(model: Model, motion: Trajectory, stride: int = 1) -> tuple[Array, Array]:
    """Return rotations of all bodies (T, B) [rad], and places of them and of free ends (T, P, 2) [m]."""
    poses = np.array([*motion.bodies.values()]).reshape(-1, len(motion.time), 3)[:, ::stride].swapaxes(0, 1)
    free = np.flatnonzero(model.ends[:, 1] == FREE)
    return poses[..., 2], np.concatenate((poses[..., :2], motion.shape[::stride, free, -1]), axis=1)


def _coarse(model: Model, motion: Trajectory) -> list[_Level]:
    """Return two coarser companions, the finer one first, and one of an implicit motion's own step.

    There are none of a mesh of few elements.
    """
    elements = model.elements
    every = [k for k in range(2, COARSEST + 1) if elements % k == 0 and elements // k >= FEWEST]
    if len(every) < 2:
        return []
    first, second = every[0], next((k for k in every if k >= 2 * every[0]), every[1])
    levels = [
        _level(model, replace(model, elements=elements // k), float(k), motion) for k in (first, second)
    ]
    if "critical_step_s" not in motion.settings:
        mesh, ratio, longest = levels[0]
        levels.append((mesh, ratio, longest / first))
    return levels


def _level(model: Model, other: Model, ratio: float, motion: Trajectory) -> _Level:
    """Return a companion whose step is `ratio` times that of the motion, or a shorter explicit one."""
    longest = ratio * float(motion.settings["step_s"])
    if "critical_step_s" in motion.settings:
        stable = SAFETY * float(motion.settings["critical_step_s"]) * _stable(other) / _stable(model)
        longest = min(longest, stable)
    return other, ratio, longest


def _stable(model: Model) -> float:
    """Return the critical explicit step at rest [s]."""
    structure, bodies = about_mass_centre(structure_of(model))
    return critical_step(structure, bodies, np.zeros(structure.size))


def _remark(model: Model, motion: Trajectory, turns: Array, places: Array, stride: int) -> str:
    """Return what is to be said of the estimated errors (T, B) [rad] and (T, P) [m], or nothing.

    They are held against the swing: half the range of the rotation, or of the nodes over the longest strip,
    whichever is more.
    """
    length = float(model.lengths.max())
    travel = float(np.ptp(motion.shape, axis=0).max()) / length
    turned = np.ptp(moves(model, motion)[0], axis=0)
    swing = 0.5 * max(float(turned.max(initial=0.0)), travel)
    apart = np.hstack((turns, places / length)).max(axis=1, initial=0.0)
    much = np.flatnonzero(apart > max(UNRESOLVED * swing, STILL))
    if not much.size:
        return ""
    return (
        f"rotations are uncertain by up to {np.degrees(turns.max(initial=0.0)):.3g} deg and displacements by "
        f"up to {places.max(initial=0.0):.3g} m, by more than {UNRESOLVED:.0%} of the swing from "
        f"{motion.time[stride * much[0]]:.3g} s on: the motion is not resolved; take more elements"
    )
