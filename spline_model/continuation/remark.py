"""What is said of the critical points of a path that reached its end."""

from __future__ import annotations

import math
from collections.abc import Sequence

from spline_model.continuation.critical import BIFURCATION
from spline_model.solution import CriticalPoint


def remark(critical: Sequence[CriticalPoint]) -> str:
    """Where the path crossed other branches and stayed on its own; empty without a bifurcation."""
    crossings = [c for c in critical if c.kind == BIFURCATION]
    if not crossings:
        return ""
    places = ", ".join(_place(c) for c in crossings)
    return f"{BIFURCATION} at {places}: the path stays on the primary branch (branch='follow' leaves it)"


def left(crossing: CriticalPoint) -> str:
    """That the path is another one from a bifurcation on."""
    return f"{BIFURCATION} at {_place(crossing)}: the path goes on along the branch that crosses there"


def _place(point: CriticalPoint) -> str:
    if math.isnan(point.rotation):
        return f"load factor {point.load_factor:.6g}"
    return f"rotation [rad] {point.rotation:.6g}"
