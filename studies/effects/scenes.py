"""The scenes that an audit compares: effects, sizes, answers, and how far these are from the full one's."""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Self, TypeVar

import numpy as np

from spline_model.compile import compile_scene
from spline_model.mechanism import Mechanism
from spline_model.modes import linear_modes
from spline_model.motion.leapfrog import STABILITY_LIMIT, highest_frequency
from spline_model.motion.start import set_in_motion
from spline_model.statics import static_state
from studies.answers.adapters import answer_modes, answer_release, answer_static
from studies.answers.models import put
from studies.answers.settings import Settings, SplineSettings
from studies.cases.design import Design
from studies.cases.effects import Effects
from studies.errors import BadInput, Unanswered
from studies.kinds import Array

#: Effects that a scene may do without but that could matter, with what they need beside them.
BESIDE = {"section_rotary_inertia": "strip_inertia", "gravity": "bending"}
#: Effects that cannot be removed without a substitute, with their simpler form.
SIMPLER = {"stretching": "inextensible"}
#: What goes with an effect when it goes.
TOGETHER = {"strip_inertia": ("section_rotary_inertia",)}
#: What a scene without an effect is called.
CALLED = {"stretching": "inextensible strips", "strip_inertia": "massless strips"}


#: What says how large a scene is, and what its change against the full one is told by.
SIZES = ("unknowns", "degrees_of_freedom", "highest_frequency_Hz", "explicit_step_s")
CHANGES = ("trajectory", "torque", "swing_frequency", "first_mode", "loss")
#: omega h up to which central differences are stable [1].
CENTRAL_LIMIT = 2.0


@dataclass(frozen=True, kw_only=True)
class Scene:
    """A scene in place of the full one and, once it is asked, how far it is from the answer of the full one.

    Attributes:
        dropped: effects of the full scene that were removed or simplified; added: those that were put in
            though the full scene could not have them. effects: of the scene.
        status: "converged", "refused", "not_converged" or "unstable"; reason: in a line, also why there was
            no motion.
        changes: each of `CHANGES` [1], NaN where there is none; trajectory and torque are the largest along
            the path, over the largest travel and torque.
        size: of `size_of`; empty where the scene has no answer. wall_s: the median of its times [s].
    """

    effects: Effects
    dropped: tuple[str, ...] = ()
    added: tuple[str, ...] = ()
    status: str = "converged"
    reason: str = ""
    changes: Mapping[str, float] = field(default_factory=lambda: dict.fromkeys(CHANGES, math.nan))
    size: Mapping[str, float] = field(default_factory=dict)
    wall_s: float = math.nan

    @property
    def label(self) -> str:
        """What was changed, in words."""
        words = [f"with {name.replace('_', ' ')}" for name in self.added]
        words += [CALLED.get(name, f"no {name.replace('_', ' ')}") for name in self.dropped]
        return ", ".join(words) or "full scene"

    @property
    def largest(self) -> float:
        """The largest change of all [1]; infinite where the scene has no whole answer."""
        if self.status != "converged":
            return math.inf
        known = (abs(each) for each in self.changes.values() if not math.isnan(each))
        return max(known, default=math.inf)

    def of(self, design: Design) -> Design:
        """Return the design with this scene."""
        return replace(design, effects=self.effects)

    def beside(self) -> Iterator[Self]:
        """Yield the scene with each effect that it does not have but that could matter."""
        for name, base in BESIDE.items():
            if name not in self.effects.names and base in self.effects.names:
                yield replace(self, added=(name,), effects=self.effects.plus(name))

    def without(self, *dropped: str) -> Self:
        """Return the scene without these effects, or with their simpler forms."""
        gone = {*dropped, *(other for name in dropped for other in TOGETHER.get(name, ()))}
        names = [SIMPLER.get(name, "") if name in gone else name for name in self.effects.names]
        return replace(self, dropped=dropped, effects=self.effects.renamed([name for name in names if name]))

    def row(self, full: "Scene") -> dict[str, Any]:
        """Return the scene as columns of a table: what it is, how it ended, changes and the largest of them,
        time, time_ratio (of the full scene over its own: above 1 it is faster) and size; NaN for none."""
        return {
            "scene": self.label,
            "dropped": self.dropped,
            "effects": self.effects.names,
            "status": self.status,
            "reason": self.reason,
            **self.changes,
            "largest": self.largest if math.isfinite(self.largest) else math.nan,
            "time_ratio": full.wall_s / self.wall_s,
            "wall_s": self.wall_s,
            **(self.size or dict.fromkeys(SIZES, math.nan)),
        }


def size_of(design: Design, settings: SplineSettings) -> dict[str, float]:
    """Return the size of the design's scene in motion, released from the end of its path, by name.

    Unknowns [1] are coordinates, axial forces and multipliers of a step's equations; degrees of freedom [1]
    are independent coordinates with inertia. The highest frequency [rad/s] is the larger one of the scene at
    rest and at the start; it gives the largest stable step [s] of the leapfrog, or of central differences
    for strips that cannot stretch.

    Raises:
        BadInput: a setting that the model rejects. spline_model.errors.ConvergenceError: no start is reached.
    """
    asked = put(design, settings, moving=True)
    mechanism: Mechanism = asked.modelled
    with asked.refusals():
        system = compile_scene(mechanism.released())
        motion = set_in_motion(system)
        start = static_state(mechanism.at_start(), design.rotation, body=design.body)[: system.layout.size]
        highest = highest_frequency(motion, start)
        modes = linear_modes(system, system.rest)[0]
    step = (CENTRAL_LIMIT if motion.inextensible else STABILITY_LIMIT) / highest
    return dict(zip(SIZES, (system.layout.size, len(modes), highest / (2.0 * math.pi), step), strict=True))


#: Duration of the motion and its steps, in swings of the first mode: within 1e-4 of that of Table 1.
SWINGS, STEPS_A_SWING = 3.0, 240
#: A scene whose first mode is off by more than this is not followed in motion: it is another machine.
LOST = 1.0


Given = TypeVar("Given")


@dataclass(frozen=True, kw_only=True)
class Answer:
    """What a scene says, along the static path as the body turns, which a scene with loads begins loaded.

    Attributes:
        path: (B, S, 2) centres of all bodies [m]; torque: (S,) [N m]; stiffness: (S,) [N m/rad]; stress: (S,)
            the largest [Pa].
        mode: first natural frequency at rest [Hz], NaN without one.
        swing: frequency of the swing after the release [Hz], NaN where none is driven or none is whole.
        loss: energy dissipated in the motion over the largest kinetic and strain energy [1].
        static_s: of the static path, wall_s: of it and the motion [s]; NaN without a whole motion.
        stopped: whether the motion stopped early; note: why there is no whole motion.
    """

    path: Array
    torque: Array
    stiffness: Array
    stress: Array
    mode: float
    static_s: float
    swing: float = math.nan
    loss: float = math.nan
    wall_s: float = math.nan
    stopped: bool = False
    note: str = ""

    @classmethod
    def of(cls, design: Design, settings: Settings) -> Self:
        """Return the answer without a motion.

        Raises:
            BadInput: what the model refuses. Unanswered: a path that stopped early, and why.
        """
        static, turned = answer_static(design, settings).whole(), slice(-design.increments - 1, None)
        modes = answer_modes(design, settings, count=1).whole().frequency
        return cls(
            path=np.array([*static.bodies.values()]).reshape(-1, len(static.torque), 3)[:, turned, :2],
            torque=static.torque[turned],
            stiffness=static.stiffness[turned],
            stress=static.max_stress[turned],
            mode=float(modes[0]) if len(modes) else math.nan,
            static_s=static.wall_s,
        )


def tried(ask: Callable[[], Given]) -> tuple[Given | None, str, str]:
    """Return what asking gives or None, the status, and the reason why there is nothing."""
    try:
        return ask(), "converged", ""
    except BadInput as error:
        return None, "refused", str(error)
    except Unanswered as error:
        return None, "not_converged", str(error)


@dataclass(frozen=True, kw_only=True)
class Run:
    """What all scenes of an audit are asked: a static path, then a motion; duration and step [s]."""

    design: Design
    settings: SplineSettings
    duration: float
    step: float

    @classmethod
    def of(cls, design: Design, settings: SplineSettings) -> Self:
        """Return the motion to ask of a design's scenes; Unanswered if the design is not stable at rest."""
        modes = answer_modes(design, settings, count=1)
        first = float(modes.frequency[0]) if modes.converged and len(modes.frequency) else math.nan
        if not first > 0.0:
            raise Unanswered(modes.message or f"the first natural frequency at rest is {first:.4g} Hz")
        step = 1.0 / (STEPS_A_SWING * first)
        return cls(design=design, settings=settings, duration=SWINGS / first, step=step)

    def answer(self, design: Design, full: Answer | None = None) -> Answer:
        """Return what the design's scene says; without a motion where its first mode is far from the full
        one's, or where the motion stops early or is not resolved, which only the full scene's must not.

        Raises:
            BadInput: what the model refuses. Unanswered: a path that stopped early, and why.
        """
        answer = Answer.of(design, self.settings)
        if full is not None and abs(answer.mode / full.mode - 1.0) > LOST:
            return replace(answer, note="no motion: the first mode is another")
        # massless strips may snap through between two states of a long step, unseen: then a companion stops
        massless = "strip_inertia" not in design.effects.names
        motion = answer_release(design, self.settings, duration=self.duration, step=self.step, check=massless)
        alone = motion.converged and massless and math.isnan(motion.rotation_error)
        early = "" if motion.converged else motion.message  # one that only remarks has its end
        if full is not None and (left := motion.resolution if alone else early):
            return replace(answer, stopped=True, note=f"motion: {left}")
        largest = float((motion.whole().kinetic_energy + motion.strain_energy).max())
        return replace(
            answer,
            swing=motion.frequency if design.rotation else math.nan,
            loss=float(motion.dissipated[-1]) / largest if largest > 0.0 else 0.0,
            wall_s=answer.static_s + motion.wall_s,
        )

    def asked(self, scene: Scene, full: Answer) -> Scene:
        """Return a scene with how far it is from the full one's answer; one without keeps its reason."""
        design = scene.of(self.design)
        found, status, reason = tried(lambda: (self.answer(design, full), size_of(design, self.settings)))
        if found is None:
            return replace(scene, status=status, reason=reason)
        answer, size = found
        torque = float(np.abs(full.torque).max())
        change = float(np.abs(answer.torque - full.torque).max())
        changes = (
            strayed(answer.path, full.path, _rest(self.design, full)),
            change / torque if torque > 0.0 else math.nan,
            answer.swing / full.swing - 1.0,
            answer.mode / full.mode - 1.0,
            answer.loss - full.loss,
        )
        return replace(
            scene,
            status="not_converged" if answer.stopped else status,
            reason=answer.note,
            changes=dict(zip(CHANGES, changes, strict=True)),
            size=size,
            wall_s=answer.wall_s,
        )


def _rest(design: Design, full: Answer) -> Array:
    """Return the centres (B, 2) before weight and drives act [m]; of a pivot before it turns, which hardly
    sags."""
    if design.crossing_point is not None:
        return full.path[:, 0]
    return np.array([body.centre for body in design.bodies]).reshape(-1, 2)


def strayed(path: Array, full: Array, rest: Array) -> float:
    """Return the largest distance of centres (B, S, 2) from those of the full scene, over the largest travel
    of these from `rest` (B, 2) [1]; NaN where none moves."""
    gap, travel = (
        float(np.linalg.norm(apart, axis=2).max(initial=0.0)) for apart in (path - full, full - rest[:, None])
    )
    return gap / travel if travel > 0.0 else math.nan
