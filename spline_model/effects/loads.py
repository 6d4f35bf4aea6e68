"""Loads on a body; each grows in proportion to the load factor."""

from __future__ import annotations

from dataclasses import dataclass

from spline_model.effects.base import Load


@dataclass(frozen=True, kw_only=True, slots=True)
class AppliedForce(Load):
    """Dead force on a body at its centre, (fx, fy) at load factor 1.               [N]"""

    body: str
    force: tuple[float, float]


@dataclass(frozen=True, kw_only=True, slots=True)
class AppliedMoment(Load):
    """Moment on a body at load factor 1, counter-clockwise positive.             [N m]"""

    body: str
    moment: float
