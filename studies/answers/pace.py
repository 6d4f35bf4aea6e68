"""How long a motion is worth following, and in which steps: from the first frequency of the design."""

from dataclasses import dataclass

import numpy as np

from studies.answers.moving import answer_modes
from studies.answers.settings import Settings
from studies.cases.design import Design

#: Swings that are followed beyond what the design is led through, and steps in each.
SWINGS, STEPS = 4, 256
#: Modes that a step resolves, if they are at most so many times as fast as the first: steps in each period.
MODES, FASTEST, LEAST_STEPS = 3, 40.0, 20
#: Duration of what has no first frequency [s].
USUAL = 0.05


@dataclass(frozen=True, kw_only=True)
class Pace:
    """Duration of a motion [s], and step [s]; None for the model's own."""

    duration: float
    step: float | None


def pace(design: Design, settings: Settings) -> Pace:
    """Return the pace of the design's first mode at rest, after all histories of loads and drives.

    Exact for nothing: of what has no stable mode it is the usual duration in the model's own steps.
    """
    found = answer_modes(design, settings, count=MODES)
    frequency = found.frequency[found.frequency > 0.0]
    led = _last_time(design)
    if not found.converged or not frequency.size:
        return Pace(duration=led + USUAL, step=None)
    first = float(frequency[0])
    last = float(frequency[frequency <= FASTEST * first].max())
    return Pace(duration=led + SWINGS / first, step=1.0 / max(STEPS * first, LEAST_STEPS * last))


def _last_time(design: Design) -> float:
    """Return when the last history of a load or a drive is over [s]."""
    histories = [design.history or ()]
    histories += [design.effects.tables.get(name, {}).get("history") or () for name in design.effects.names]
    times = [float(time) for history in histories for time, _ in np.reshape(history, (-1, 2))]
    return float(max([0.0, *times, *(design.held or ())]))
