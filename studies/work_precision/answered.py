"""What a path and a motion in a work-precision diagram have in common: how they ended, and their work."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Answered:
    """The answer of any model.

    Attributes:
        status: "converged" or how it ended; message: why and where or when it stopped.
        solve_s: time of the increments or steps alone [s].
        work: machine-neutral work by column, NaN where it is not known.
    """

    status: str
    message: str
    solve_s: float
    work: Mapping[str, float]

    @property
    def converged(self) -> bool:
        """Whether it was followed to its end."""
        return self.status == "converged"


def counted(
    columns: Iterable[str], counters: Mapping[str, float], theirs: Mapping[str, str] | None = None
) -> dict[str, float]:
    """Return the columns of work from a model's counters, NaN of those that it does not count.

    theirs: names of columns in the counters, where they differ.
    """
    names = theirs or {}
    return {name: float(counters.get(names.get(name, name), math.nan)) for name in columns}
