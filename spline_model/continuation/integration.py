"""Whether the Gauss points integrate the strips: the same states with twice as many."""

from __future__ import annotations

from spline_model.continuation.critical import Bracket, between, corrected
from spline_model.continuation.followed import Followed
from spline_model.continuation.point import Point

UNCONFIRMED = "a {kind} that is not found with twice the Gauss points (use more gauss_points)"
LARGEST_CHANGE = 0.02
"""Largest relative change of stiffness with twice the Gauss points of a state that is kept."""


class Finer:
    """A system with twice the Gauss points: its unknowns are the same ones.

    Too few points do not see a bend between them. The tangent then loses its stiffness there
    while all else still looks sound, and ends in a critical point that the strips do not have.
    """

    def __init__(self, work: Followed) -> None:
        self.work = work.finer()

    def confirms(self, work: Followed, before: Point, after: Point, step: float) -> bool:
        """Whether a critical point lies between two states here as well."""
        plane = Bracket(work=work, before=before, after=after, step=step).plane()
        ends = [corrected(self.work, p.z, p.load_factor, *plane) for p in (before, after)]
        if ends[0] is None or ends[1] is None:
            return False
        return bool(between(self.work, ends[0], ends[1], step))

    def agrees(self, point: Point) -> bool:
        """Whether a state keeps its stiffness, the rate of what does work on the load factor."""
        normal = 0.0 * point.z
        other = corrected(self.work, point.z, point.load_factor, normal, 1.0)
        if other is None:
            return False
        change = abs(other.conjugate_rate * point.slope - point.conjugate_rate)
        return change <= LARGEST_CHANGE * abs(other.conjugate_rate * point.slope)
