"""Frames that buckle and snap through, the pivot pushed along its strips, and the spline's paths of them."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray
from scipy.special import ellipe, ellipk

from spline_model.statics import solve_mechanism
from studies.answers.models import put
from studies.answers.settings import SplineSettings
from studies.cases.effects import Effects
from studies.cases.mechanism import Mechanism
from studies.cases.problem import named_case
from studies.kinds import Array
from studies.published.case import BEAM, loaded, published
from studies.stability.geometry import as_mechanism

STATIC = ("bending", "stretching")
#: Part of the load across a column that leads elements, which have no way onto a branch, to bend: the angle
#: moves by less than 1 %, and with a tenth of it the steps of their path jump the bend.
SIDE = 1e-4


@dataclass(frozen=True, kw_only=True)
class Frame:
    """A frame and how it is loaded: `load` is the force or displacement at load factor 1, in its units.

    Attributes:
        body: whose place is reported. pins: bodies that are held in their places and free to turn.
    """

    design: Mechanism
    load: float
    body: str
    pins: tuple[str, ...] = ()


def frame_of(name: str, answer: str = BEAM, load: float | None = None, *, side: float = 0.0) -> Frame:
    """Return the frame of a published problem under a load in its units, of None that of its first value.

    Args:
        answer: kind of answer. side: part of the load that acts across it, to the right of it.
    """
    problem = published(name)
    load = problem.values[0].load if load is None else load
    assert isinstance(problem.design, Mechanism)
    design = loaded(problem.design, answer, load)
    effects = design.effects
    if side:
        x, y = effects.tables["applied_force"]["force"]
        aside = {**effects.tables["applied_force"], "force": (x + side * y, y - side * x)}
        effects = replace(effects, tables={**effects.tables, "applied_force": aside})
    return Frame(design=replace(design, effects=effects), load=load, body=problem.body, pins=problem.pins)


def pushed_pivot(*, depth: float) -> Frame:
    """Return the pivot of Table 1 with its body's centre led down by `depth` [m], free to turn."""
    effects = Effects(
        names=(*STATIC, "driven_displacement"),
        tables={"driven_displacement": {"displacement": (0.0, -depth)}},
    )
    design = replace(as_mechanism(named_case(), 0.0), rotation=None, effects=effects)
    return Frame(design=design, load=depth, body="body")


#: Euler load of a cantilever [EI/L^2].
EULER = math.pi**2 / 4.0

#: Tip angle [deg] -> load over the Euler load [1] as printed.
PUBLISHED = {int(value.at): value.published for value in published("column").values}


def load_ratio(angle: float) -> float:
    """Return P over the Euler load at a tip angle [rad]: (2 K / pi)^2 with modulus sin(angle / 2)."""
    return float((2.0 * ellipk(math.sin(angle / 2.0) ** 2) / math.pi) ** 2)


def tip(angles: Array) -> Array:
    """Return the tip's place along and across the column (..., 2) [L] at tip angles [rad].

    2 E / K - 1 and 2 sin(angle / 2) / K: Timoshenko and Gere, section 2.7.
    """
    modulus = np.sin(angles / 2.0)
    first = ellipk(modulus**2)
    return np.stack((2.0 * ellipe(modulus**2) / first - 1.0, 2.0 * modulus / first), axis=-1)


def extensible_euler(slenderness: float) -> float:
    """Return the critical load [EI/L^2] of a column that is shortened first: (1 - P / EA) P is Euler's.

    slenderness: L sqrt(EA / EI) [1].
    """
    return slenderness**2 / 2.0 * (1.0 - math.sqrt(1.0 - 4.0 * EULER / slenderness**2))


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
    asked = put(frame.design, settings)
    with asked.refusals():
        path = solve_mechanism(
            asked.modelled.pinned(*frame.pins),
            increments=frame.design.increments,
            control="arc-length",
            branch=branch,
            raise_on_failure=False,
        )
    at = path.system.layout.body(frame.body)
    return Arc(
        load=frame.load * path.load_factor,
        place=path.bodies[frame.body],
        energy=path.bending_energy + path.axial_energy,
        inertia=path.inertia,
        critical=tuple(
            Critical(kind=point.kind, load=frame.load * point.load_factor, place=point.z[at])
            for point in path.critical_points
        ),
        reached=path.status.value == "converged",
        message=path.message,
        warning=path.resolution,
        counters=path.counters,
    )
