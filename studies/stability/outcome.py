"""How one hard case ends for one model: right, refused, wrong or bad input, and why."""

import math
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from studies.errors import BadInput

RIGHT, REFUSED, WRONG, BAD_INPUT = "right", "refused", "wrong", "bad input"

#: The four outcomes in the order of tables and legends; there is no fifth.
OUTCOMES = (RIGHT, REFUSED, WRONG, BAD_INPUT)


@dataclass(frozen=True, kw_only=True)
class Found:
    """What a model answered to a case, compared with what is known to be right.

    Attributes:
        error: the distance to the reference, or of an invariant to its value, over its scale [1].
        reached: whether the model says that it got to the end; if not, `reason` says why not.
        reason: what the model itself says about its answer; a limitation that it states makes an answer that
            is off a refusal, provided `states_limit` is set.
        states_limit: whether `reason` warns of what is off in an answer that reached its end.
        fault: an invariant that the answer breaks, in words; what the model says does not excuse it.
        counters: work done, by kind.
    """

    error: float
    reached: bool = True
    reason: str = ""
    states_limit: bool = False
    fault: str = ""
    counters: Mapping[str, int] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class Verdict:
    """The outcome of a case: one of `OUTCOMES`, the error [1], the reason in words and the work."""

    outcome: str
    error: float
    reason: str
    iterations: int
    halvings: int

    def row(self) -> dict[str, Any]:
        """Return the verdict as columns of a table."""
        return asdict(self)


def judged(attempt: Callable[[], Found], tolerance: float) -> Verdict:
    """Return how `attempt` ends: right within `tolerance` [1].

    An answer that is off, or not a finite number, is wrong unless the model said so itself. Bad input is a
    refusal of the question (`BadInput`); any other exception is a fault of the model, and wrong.
    """
    try:
        found = attempt()
    except BadInput as refusal:
        return _without_answer(BAD_INPUT, str(refusal))
    except (
        Exception
    ) as fault:  # whatever escapes a model is a wrong outcome to be counted, not the study's end
        return _without_answer(WRONG, f"{type(fault).__name__}: {fault}")
    work = found.counters
    return Verdict(
        outcome=_outcome(found, tolerance),
        error=found.error,
        reason=found.fault or found.reason,
        iterations=work.get("newton_iterations", work.get("iterations", 0)),
        halvings=work.get("halved_increments", 0) + work.get("halved_steps", 0),
    )


def _outcome(found: Found, tolerance: float) -> str:
    if found.fault:
        return WRONG
    # what a path or run holds up to where it stopped is judged as well: a refusal must leave a good state
    if math.isfinite(found.error) and found.error <= tolerance:
        return RIGHT if found.reached else REFUSED
    return REFUSED if found.states_limit else WRONG


def _without_answer(outcome: str, reason: str) -> Verdict:
    one_line = " ".join(reason.split())
    return Verdict(outcome=outcome, error=math.nan, reason=one_line, iterations=0, halvings=0)
