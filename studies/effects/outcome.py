"""The answers of one scene of an audit, and how far they are from those of the full one."""

import math
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

from studies.answers.adapters import answer_modes, answer_path, answer_release
from studies.answers.motion import Motion
from studies.answers.response import MechanismResponse, Response
from studies.answers.settings import SplineSettings
from studies.answers.spectrum import Spectrum
from studies.cases.design import Design
from studies.cases.problem import Problem
from studies.effects.variants import Size, Variant, size_of
from studies.errors import BadInput
from studies.kinds import Array

#: Duration of the motion and its steps, in swings of the first mode of the full scene. With so many steps
#: the frequency of Table 1's swing is within 1e-4 of the limit.
SWINGS, STEPS_A_SWING = 3.0, 240


#: A scene whose first mode is off by more than this is not followed in motion: it is another machine.
LOST = 1.0


class Unanswered(RuntimeError):
    """A scene that has no answer; the text says why."""


@dataclass(frozen=True, kw_only=True)
class Run:
    """What all scenes of an audit are asked: a static path, then a motion of `duration` in steps of `step`
    [s]."""

    settings: SplineSettings
    duration: float
    step: float


@dataclass(frozen=True, kw_only=True)
class Answer:
    """What a scene says.

    Attributes:
        path: (S, 2) centres of all bodies along the static path, side by side [m]; torque: (S,) [N m].
        mode: first natural frequency at rest [Hz].
        swing: frequency of the swing after the release [Hz], NaN where none is driven or none is whole.
        loss: energy dissipated in the motion over the largest kinetic and strain energy [1].
        wall_s: of the static path and the motion [s]; NaN without a whole motion.
        stopped: whether the motion stopped early; note: why there is no whole motion.
    """

    path: dict[str, Array]
    torque: Array
    mode: float
    swing: float = math.nan
    loss: float = math.nan
    wall_s: float = math.nan
    stopped: bool = False
    note: str = ""


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """A scene held against the full one.

    Attributes:
        variant: the scene. status: "converged", "refused", "not_converged" or "unstable"; reason: in a line,
            also why there was no motion.
        trajectory: largest distance of a body's centre along the static path over the largest travel [1].
        torque: largest change along the path over the largest torque [1]; NaN where nothing is driven.
        swing, mode: change of the frequencies [1]; loss: change of the energy lost [1].
        size: None where the scene has no answer.
        wall_s: time of static path and motion, the median where it was timed more than once [s].
    """

    variant: Variant
    status: str = "converged"
    reason: str = ""
    trajectory: float = math.nan
    torque: float = math.nan
    swing: float = math.nan
    mode: float = math.nan
    loss: float = math.nan
    size: Size | None = None
    wall_s: float = math.nan

    @property
    def largest(self) -> float:
        """The largest change of all [1]; infinite where the scene has no whole answer."""
        if self.status != "converged":
            return math.inf
        changes = (self.trajectory, self.torque, self.swing, self.mode, self.loss)
        return max((abs(each) for each in changes if not math.isnan(each)), default=math.inf)

    def timed(self, wall_s: float) -> "Outcome":
        """Return the outcome with its time [s]."""
        return replace(self, wall_s=wall_s)


def run_of(design: Design, settings: SplineSettings) -> Run:
    """Return the motion to ask of a design's scenes: some swings of its first mode.

    Raises:
        BadInput: what the model refuses. Unanswered: the design is not stable at rest.
    """
    modes = answer_modes(design, settings, count=1)
    first = float(modes.frequency[0]) if modes.converged and len(modes.frequency) else math.nan
    if not first > 0.0:
        raise Unanswered(modes.message or f"the first natural frequency at rest is {first:.4g} Hz")
    return Run(settings=settings, duration=SWINGS / first, step=1.0 / (STEPS_A_SWING * first))


def answered(design: Design, run: Run, full: Answer | None = None) -> Answer:
    """Return what the design's scene says; without a motion where its first mode is far from the full one's,
    or where the motion stops early, which only the full scene's must not.

    Raises:
        BadInput: what the model refuses. Unanswered: a path that stopped early, and why.
    """
    static = reached(answer_path(design, run.settings))
    mode = float(reached(answer_modes(design, run.settings, count=1)).frequency[0])
    turned = slice(
        -design.increments - 1, None
    )  # as the body turns: a scene without loads has no states before
    path = {name: each[turned] for name, each in static.centres.items()}
    answer = Answer(path=path, torque=static.torque[turned], mode=mode)
    if full is not None and abs(mode / full.mode - 1.0) > LOST:
        return replace(answer, note="no motion: the first mode is another")
    motion = answer_release(design, run.settings, duration=run.duration, step=run.step)
    if full is not None and not motion.converged:
        return replace(answer, stopped=True, note=f"motion: {motion.message}")
    reached(motion)
    driven = bool(design.rotation)
    return replace(
        answer,
        swing=motion.frequency if driven else math.nan,
        loss=_loss(motion),
        wall_s=static.wall_s + motion.wall_s,
    )


def timed(design: Design, run: Run) -> float:
    """Return the time of static path and motion once more [s]."""
    motion = answer_release(design, run.settings, duration=run.duration, step=run.step)
    return answer_path(design, run.settings).wall_s + motion.wall_s


def outcome(variant: Variant, design: Design, run: Run, full: Answer) -> Outcome:
    """Return how far a scene is from the full one; a scene without an answer keeps its reason.

    Args:
        variant: the scene. design: with it. run: what is asked. full: answer of the full scene.
    """
    try:
        answer = answered(design, run, full)
        size = size_of(design, run.settings)
    except BadInput as error:
        return Outcome(variant=variant, status="refused", reason=str(error))
    except Unanswered as error:
        return Outcome(variant=variant, status="not_converged", reason=str(error))
    rest = _rest(design, full)
    travel = max((_distance(path, rest[name]) for name, path in full.path.items()), default=0.0)
    apart = max((_distance(answer.path[name], path) for name, path in full.path.items()), default=0.0)
    torque = float(np.abs(full.torque).max())
    change = float(np.abs(answer.torque - full.torque).max())
    return Outcome(
        variant=variant,
        status="not_converged" if answer.stopped else "converged",
        reason=answer.note,
        trajectory=apart / travel if travel > 0.0 else math.nan,
        torque=change / torque if torque > 0.0 else math.nan,
        swing=answer.swing / full.swing - 1.0,
        mode=answer.mode / full.mode - 1.0,
        loss=answer.loss - full.loss,
        size=size,
        wall_s=answer.wall_s,
    )


Reached = TypeVar("Reached", Response | MechanismResponse, Spectrum, Motion)


def reached(answer: Reached) -> Reached:
    """Return the answer; Unanswered unless it is complete."""
    if not answer.converged:
        raise Unanswered(answer.message)
    return answer


def _rest(design: Design, full: Answer) -> dict[str, Array]:
    """Return the centres before weight and drives act [m]; of a pivot before it turns, which hardly sags."""
    if isinstance(design, Problem):
        return {name: path[0] for name, path in full.path.items()}
    return {body.name: np.array(body.centre) for body in design.bodies}


def _distance(path: Array, other: Array) -> float:
    return float(np.linalg.norm(path - other, axis=1).max())


def _loss(motion: Motion) -> float:
    largest = float((motion.kinetic_energy + motion.strain_energy).max())
    return float(motion.dissipated[-1]) / largest if largest > 0.0 else 0.0
