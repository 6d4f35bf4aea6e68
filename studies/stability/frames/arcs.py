"""A path that is followed in its arc length, by the spline: its places and its critical points."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from spline_model.effects import DrivenDisplacement
from spline_model.estimate import resolution
from spline_model.statics import solve_loads
from studies.answers.models import built, model_of
from studies.answers.settings import SplineSettings
from studies.kinds import Array
from studies.stability.frames.designs import Frame

HERE = (0.0, 0.0)


@dataclass(frozen=True, kw_only=True)
class Critical:
    """A critical point: "limit point" or "bifurcation", its load and the place (3,) of the reported body."""

    kind: str
    load: float
    place: Array


@dataclass(frozen=True, kw_only=True)
class Arc:
    """A path of S states.

    Attributes:
        load: (S,) load factor times the load of the frame, in its units.
        place: (S, 3) of the reported body: x, y [length] and turn [rad].
        energy: (S,) stored, in its unit.
        inertia: (S,) number of negative eigenvalues of the tangent, -1 where there is no potential.
        critical: the critical points in order.
        message: what the model says of the path; warning: and of its own resolution; empty: nothing.
    """

    load: Array
    place: Array
    energy: Array
    inertia: NDArray[np.int64]
    critical: tuple[Critical, ...]
    reached: bool
    message: str
    warning: str = ""
    counters: Mapping[str, int] = field(default_factory=dict)


def spline_arc(frame: Frame, settings: SplineSettings, *, branch: str = "primary") -> Arc:
    """Return the path to load factor 1; BadInput for what the model refuses to be asked.

    branch: "primary" or "follow" at a bifurcation.
    """
    asked, _ = built(model_of(settings), frame.design, settings, moving=False)
    scene = asked.with_effects(*(DrivenDisplacement(body=name, displacement=HERE) for name in frame.pins))
    system, path = solve_loads(scene, increments=frame.design.increments, control="arc-length", branch=branch)
    at = system.layout.body(frame.body)
    return Arc(
        load=frame.load * path.load_factor,
        place=path.states[:, at],
        energy=path.energies.sum(axis=1),
        inertia=path.inertia,
        critical=tuple(
            Critical(kind=point.kind, load=frame.load * point.load_factor, place=point.z[at])
            for point in path.critical_points
        ),
        reached=path.status.value == "converged",
        message=path.message,
        warning=resolution(path.moment_defect),
        counters=path.counters,
    )
