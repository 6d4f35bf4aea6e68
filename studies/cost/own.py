"""The suite's own models among those that are compared."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from studies.answers.adapters import answer_release, answer_static
from studies.answers.motion import Motion
from studies.answers.reference import RECORDS
from studies.answers.response import Response
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.design import Design
from studies.cost.model import Failed, Model

#: Schemes whose steps are far shorter than what happens between two records.
EXPLICIT = ("leapfrog", "central-difference")


@dataclass(eq=False, kw_only=True)
class _Own(Model):
    """A model of the suite; keywords in `settings` are those of its discretisation and its integrator."""

    discretised: Callable[..., Settings]

    def path(self, design: Design, *, accuracy: float | None = None, **settings: Any) -> Response:
        """Return the path; `accuracy`: that a spline chooses its own control points for [1]."""
        answer = answer_static(design, self.discretised(**settings), accuracy=accuracy)
        if not answer.converged:
            raise Failed(answer.message)
        return answer

    def swing(
        self,
        design: Design,
        duration: float,
        *,
        integrator: str | None = None,
        step: float | None = None,
        **settings: Any,
    ) -> Motion:
        """Return the motion; the step [s] of an explicit scheme is its own, near the largest stable one."""
        records = RECORDS if integrator in EXPLICIT else None
        motion = answer_release(
            *(design, self.discretised(**settings)),
            duration=duration, records=records, integrator=integrator, step=step,
        )  # fmt: skip
        if not motion.converged:
            raise Failed(motion.message)
        return motion


spline = _Own(name="spline", discretised=SplineSettings)
elements = _Own(name="finite elements", discretised=FeSettings)
