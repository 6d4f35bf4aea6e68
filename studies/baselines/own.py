"""The suite's own models with the interface of a baseline, so that all are timed alike: the solve alone.

Static paths of the spline are timed around `Elements.run` of `spline_model.reduced`, with geometry and
quadrature prepared, and its motions less one of one step, as the set-up of other codes is left out too; of
the elements it is what they say their increments or steps took.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from spline_model.compile import compile_scene
from spline_model.pivot import cross_axis_pivot
from spline_model.reduced.arrays import Answer
from spline_model.reduced.elements import Elements, followed
from spline_model.reduced.equilibrium import EVALUATIONS, ITERATIONS
from spline_model.reduced.model import at_rest
from studies.answers.adapters import answer_release, answer_static
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.baselines.answer import (
    BaselineFailed,
    SolvedMotion,
    SolvedPath,
    checked_release,
    checked_rotations,
    clocked,
)
from studies.baselines.variant import Baseline, repeats_of
from studies.cases.design import Design
from studies.cases.problem import Problem
from studies.errors import BadInput

#: Records of a motion, some 50 of every period of the strips' own oscillations.
RECORDS = 2500
#: Records of a motion whose errors are told: the strips' own oscillations, some 40 times as fast as the
#: swing, need so many for cubic interpolation to err by less than 1e-6 rad (1000 leave 8e-5 rad).
FINE_RECORDS = 4000
#: Records of one that is timed: these are read out by each model in its own way and are no part of it.
TIMED_RECORDS = 50
#: Schemes whose steps are far shorter than what happens between two records.
FINE = ("leapfrog", "central-difference")


@dataclass(eq=False, kw_only=True)
class _Own(Baseline):
    """A model as a baseline; keywords in `settings` are those of its discretisation."""

    discretised: Callable[..., Settings]

    def static_path(self, problem: Problem, rotations: Any, **settings: Any) -> SolvedPath:
        """Drive the body through equal `rotations` (S,) [rad], the first of which is 0.

        Raises:
            BaselineFailed: the path is not reached.
        """
        turns, chosen = checked_rotations(rotations), self.discretised(**settings)
        asked = replace(problem, rotation=float(turns[-1]), increments=len(turns) - 1)
        answer = answer_static(asked, chosen)
        if not answer.converged:
            raise BaselineFailed(f"{self.model}: {answer.message}")
        return SolvedPath.of(answer, again=lambda: answer_static(asked, chosen).solve_s, work=answer.counters)

    def release(
        self,
        problem: Problem,
        *,
        start: float,
        duration: float,
        step: float,
        integrator: str | None = None,
        **settings: Any,
    ) -> SolvedMotion:
        """Let go of the body at rest at `start` [rad] and follow it for `duration` [s].

        Args:
            step: [s]; of central differences not read: they take the longest that is stable.
            integrator: as the model names it; None for its own.

        Raises:
            BaselineFailed: the motion stopped early.
        """
        steps = checked_release(start, duration, step)
        asked = partial(
            answer_release, problem, self.discretised(**settings), start=start, duration=duration,
            records=steps // max(1, steps // RECORDS) if integrator in FINE else steps,
            integrator=integrator, step=None if integrator == "central-difference" else duration / steps,
        )  # fmt: skip
        motion = asked()
        if not motion.converged:
            raise BaselineFailed(f"{self.model}: {motion.message}")
        return SolvedMotion.of(motion, again=lambda: asked().solve_s, work=motion.counters)

    def path(
        self, problem: Design, repeat: int, *, accuracy: float | None = None, **settings: Any
    ) -> SolvedPath:
        """Return the path of a case, as far as it was followed.

        Args:
            repeat: timed solves [1]; accuracy: that a spline finds its own control points for.
        """
        free = {} if accuracy is None else {"control_points": None}
        chosen: Any = self.discretised(**free | settings)
        answer = answer_static(problem, chosen, repeat=repeat, accuracy=accuracy)
        return SolvedPath.of(answer, repeats=repeat, work=answer.counters)

    def swing(self, problem: Design, duration: float, **settings: Any) -> SolvedMotion:
        """Return the motion of a case for `duration` [s]; `integrator` and `step` [s] are the model's own
        unless they are given."""
        given = {name: settings.pop(name, None) for name in ("integrator", "step")}
        chosen = self.discretised(**settings)
        released = partial(answer_release, problem, chosen, duration=duration, **given)
        motion = released(records=FINE_RECORDS)
        if not motion.converged:
            return SolvedMotion.of(motion, work={})
        repeats = repeats_of(motion.solve_s)
        solve_s = released(records=TIMED_RECORDS, repeat=repeats).solve_s
        return SolvedMotion.of(motion, solve_s=solve_s, repeats=repeats, work=motion.counters)


class _Spline(_Own):
    """The spline, whose static path is timed in compiled code, and whose motion less that of one step."""

    def static_path(self, problem: Problem, rotations: Any, **settings: Any) -> SolvedPath:
        """Drive the body through `rotations` (S,) [rad], the first of which is 0, in compiled code.

        Raises:
            BadInput: a scene that the condensed path does not cover. BaselineFailed: the path is not reached.
        """
        turns = checked_rotations(rotations)
        largest = float(turns[abs(turns).argmax()])
        pivot = cross_axis_pivot(
            **problem.pivot_parameters(),
            effects=problem.effects.names,
            parameters=problem.effects.parameters(),
            **self.discretised(**settings).keywords(),
        )
        elements = followed(compile_scene(pivot.driven(largest)))
        if not isinstance(elements, Elements) or elements.system.is_preloaded:
            raise BadInput(f"spline: got the effects {', '.join(pivot.effects)}, expected an element's")
        scene, factors, rest = elements.model, turns / largest, at_rest(elements.model)

        def solve() -> Answer:
            return elements.run(factors, rest)

        answer = solve()
        if len(answer.y) < len(turns):
            raise BaselineFailed(f"{self.model}: the path is not reached")
        return SolvedPath(
            rotation=turns,
            centre=answer.y[:, :2] * scene.length,
            torque=answer.reaction[:, 0] * scene.energy,
            stiffness=answer.stiffness * scene.energy,
            again=clocked(lambda: solve),
            work={
                "unknowns": len(rest) - 1,
                "newton_iterations": int(answer.counters[ITERATIONS]),
                "factorisations": int(answer.counters[EVALUATIONS]),
            },
        )

    def release(
        self, problem: Problem, *, start: float, duration: float, step: float, **settings: Any
    ) -> SolvedMotion:
        """Let go of the body as `_Own.release`; what comes before and after the steps is not timed."""
        motion, once = (
            super(_Spline, self).release(problem, start=start, duration=span, step=step, **settings)
            for span in (duration, step)
        )
        return replace(motion, again=lambda: max(0.0, motion.again() - once.again()))


spline = _Spline(model="spline", discretised=partial(SplineSettings, control_points=6))
elements = _Own(model="finite elements", discretised=FeSettings)
