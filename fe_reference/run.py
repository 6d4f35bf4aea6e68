"""What is asked of a motion, and whether its steps and samples can be afforded."""

from dataclasses import dataclass
from math import ceil
from typing import Annotated

from .drives import DrivenRotation
from .errors import Checked, InvalidParameter, choice, count, finite, optional, positive, require_kind, within
from .model import Model
from .modes import first_frequency
from .motion import Progress

INTEGRATORS = ("central-difference", "generalised-alpha")
#: Default of the implicit step: so many in the first period of small motion; strips are fifty times as fast.
STEPS_PER_PERIOD = 6000
#: Most steps of one run unless more are allowed, some 25 s with 20 elements; 50 times more, 20 minutes, are
#: the most that are recommended. Most numbers kept of a run.
MOST_STEPS, FAR_MORE = 20_000_000, 50
MOST_NUMBERS = 200_000_000


@dataclass(frozen=True, kw_only=True)
class Run(Checked):
    """What is asked of a motion.

    Attributes:
        duration: [s].
        start: rotation at which a body is held until the start [rad]; None: none is held, and under loads
            without a history the mechanism stands still.
        body: name of the held body; None: the only one.
        drive: a rotation that is held or driven in a part of the motion, if any.
        settled: whether the start is in equilibrium; if not it is the shape at rest, where gravity, natural
            strains and loads act at once.
        increments: of the static path to the start.
        step: time step [s]. Default: for "central-difference" the smaller critical step of the start and of
            rest, times `safety`; for "generalised-alpha" a 6000th of the first period of small motion about
            the shape at rest, without gravity and loads. The default is shortened so that whole steps fill
            the duration.
        integrator: "central-difference" (explicit) or "generalised-alpha" (implicit, with `spectral_radius`).
        samples: states kept beside the start, at most.
        most_steps: beyond which a run is refused before it begins.
        accuracy: wanted error of rotations [rad] and of places in strip lengths; the mesh is doubled until
            the estimate is below it, and the motion is the limit, at equal instants. Each mesh takes eight
            times as long as the one before.
        progress: called as progress(done, total) after every sample.
    """

    duration: Annotated[float, positive, "s"]
    start: Annotated[float | None, optional, finite, "rad"] = None
    body: str | None = None
    drive: DrivenRotation | None = None
    settled: bool = True
    increments: Annotated[int, count] = 20
    step: Annotated[float | None, optional, positive, "s"] = None
    integrator: Annotated[str, choice, INTEGRATORS] = INTEGRATORS[0]
    safety: Annotated[float, positive, "1"] = 0.9
    spectral_radius: Annotated[float, within, 0.0, 1.0 + 1e-12, "1"] = 0.9
    samples: Annotated[int, count] = 1000
    most_steps: Annotated[int, count] = MOST_STEPS
    accuracy: float | None = None
    progress: Progress | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.drive is not None:
            require_kind("drive", self.drive, DrivenRotation, "a DrivenRotation or None")
        if self.start is not None and not self.settled:
            raise InvalidParameter("settled", self.settled, "True for a start at a held rotation [1]")
        if self.accuracy is not None and (self.step is not None or not self.explicit):
            raise InvalidParameter(
                "accuracy", self.accuracy, f"no step beside it, and the integrator {INTEGRATORS[0]}"
            )

    @property
    def explicit(self) -> bool:
        """Whether the integrator is the explicit one."""
        return self.integrator == INTEGRATORS[0]

    def steps(self, longest: float) -> tuple[float, int]:
        """Return step [s] and number of steps; what is not given is shortened to fill the duration.

        With an accuracy, to fill the time between two samples, so that all meshes have the same instants.
        """
        parts = 1 if self.accuracy is None else self.samples
        steps = parts * max(1, ceil(self.duration / parts / (self.step or longest) * (1.0 - 1e-12)))
        return self.step or self.duration / steps, steps

    def chunks(self, steps: int) -> list[int]:
        """Return the numbers of steps between samples: equal ones, the last perhaps shorter."""
        every = -(-steps // self.samples)
        whole, rest = divmod(steps, every)
        return [every] * whole + ([rest] if rest else [])

    def require_affordable(self, model: Model, step: float, steps: int, size: int) -> None:
        """Check the cost of a motion.

        Args:
            model: the model that moves.
            step: time step [s].
            steps: number of steps.
            size: number of coordinates.

        Raises:
            InvalidParameter: too many steps, or too many numbers to keep of so many coordinates.
        """
        if steps > self.most_steps:
            raise InvalidParameter(
                "duration",
                self.duration,
                f"at most {self.most_steps:.3g} steps of {step:.3g} s, this is {steps:.3g} of them: "
                f"{self._cheaper(model, steps)} [s]",
            )
        samples = min(self.samples, steps)
        if 2 * samples * size > MOST_NUMBERS:
            most = MOST_NUMBERS // (2 * size)
            raise InvalidParameter("samples", samples, f"at most {most} samples of {size} coordinates [1]")

    def _cheaper(self, model: Model, steps: int) -> str:
        """Return what to do about a run of too many steps: of all ways those that can be run."""
        ways = ["take longer steps"]
        if self.explicit:
            implicit = max(self.duration * STEPS_PER_PERIOD * first_frequency(model), 1.0)
            ways = [f"--integrator generalised-alpha takes about {implicit:.2g}"]
            if implicit > self.most_steps:
                ways = [
                    "remove strip_inertia, if strips are light, and take --integrator generalised-alpha "
                    f"with a --step (its own are about {implicit:.2g})"
                ]
        if steps <= FAR_MORE * MOST_STEPS:
            ways.append("allow more by most_steps")
        return "; or ".join(ways)
