"""What is asked of Exudyn's pivots alike, whatever their strips are made of: a static path and a release."""

from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any, ClassVar, Protocol

from studies.baselines.answer import BaselineMotion, BaselinePath
from studies.baselines.peers.exudyn_solve import follow, let_go
from studies.baselines.peers.exudyn_system import System
from studies.cases.problem import Problem


class Strips(Protocol):
    """A frozen dataclass of how strips are discretised, which refuses what it cannot be."""

    __dataclass_fields__: ClassVar[dict[str, Any]]

    def system(self, problem: Problem) -> System:
        """Return the pivot with such strips in Exudyn."""


@dataclass(frozen=True)
class Code:
    """A kind of strip with the interface of a baseline; keywords in `settings` are those of the strips."""

    model: str
    strips: Callable[..., Strips]

    def static_path(
        self,
        problem: Problem,
        rotations: Any,
        *,
        repeat: int = 1,
        relative_tolerance: float = 1e-8,
        solver: str = "tuned",
        **settings: Any,
    ) -> BaselinePath:
        """Drive the body through `rotations` [rad], the first of which is 0, one load step each.

        Args:
            problem: the pivot.
            rotations: (S,) [rad].
            repeat: timed solves of the whole path [1].
            relative_tolerance: of Newton's residual against that at the step's start [1].
            solver: "tuned", or "as delivered" for Exudyn's own defaults but for files and messages.

        Raises:
            BadInput: a setting out of range. BaselineFailed: no convergence.
        """
        strips = self.strips(**settings)
        asked = asdict(strips) | {"relative_tolerance": relative_tolerance, "solver": solver}
        return follow(strips.system(problem), rotations, model=self.model, settings=asked, repeat=repeat)

    def release(
        self,
        problem: Problem,
        *,
        start: float,
        duration: float,
        step: float,
        repeat: int = 1,
        relative_tolerance: float = 1e-4,
        spectral_radius: float = 0.9,
        **settings: Any,
    ) -> BaselineMotion:
        """Let go of the body at rest at `start` [rad] and follow it by generalised-alpha for `duration` [s].

        Args:
            step: [s]; spectral_radius: of generalised-alpha at infinite frequency, 0 to 1. The others as of
                `static_path`.

        Raises:
            BadInput: a setting out of range. BaselineFailed: no convergence.
        """
        strips = self.strips(**settings)
        asked = asdict(strips) | {
            "relative_tolerance": relative_tolerance,
            "spectral_radius": spectral_radius,
        }
        return let_go(
            strips.system(problem),
            start=start,
            duration=duration,
            step=step,
            model=self.model,
            settings=asked,
            repeat=repeat,
        )
