"""Frames that buckle and snap through, the pivot pushed along its strips, and their paths in arc length."""

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray
from scipy.special import ellipe, ellipk

from spline_model.proportional import solve_mechanism
from studies.answers.models import built, model_of, refusals
from studies.answers.settings import SplineSettings
from studies.cases.effects import Effects
from studies.cases.mechanism import Body, Mechanism, Strip
from studies.cases.mechanism_keys import GROUND
from studies.cases.problem import named_case
from studies.kinds import Array
from studies.published.case import published
from studies.stability.statics.geometry import as_mechanism

CASE = "cross_axis_pivot"
STATIC = ("bending", "stretching")
#: Poisson's ratio and density, which no static path of these strips asks for.
UNASKED = {"poisson_ratio": 0.3, "density": 1.0}
INCREMENTS = 20


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


def column(*, load: float, side: float = 0.0, slenderness: float = 1e3) -> Frame:
    """Return a cantilever of length 1 and EI = 1 along x, its tip pushed towards its root by `load` [EI/L^2].

    Args:
        side: part of the load that acts across it. slenderness: L sqrt(EA / EI) [1].
    """
    strip = _strip("column", (0.0, 0.0), (1.0, 0.0), GROUND, "tip", (slenderness**2, 1.0, 1.0))
    return Frame(
        design=_loaded((strip,), {"tip": (1.0, 0.0)}, "tip", (-load, side * load)), load=load, body="tip"
    )


def toggle(*, rise: float, load: float = 60.0) -> Frame:
    """Return Williams' toggle: two built-in members of 12.943 in, EI = 9.27e3 lb in^2, EA = 1.885e6 lb.

    F. W. Williams, Quarterly Journal of Mechanics and Applied Mathematics 17 (1964) 451; `rise` [in], `load`
    [lb] down at the apex.
    """
    half, apex = math.sqrt(12.943**2 - rise**2), (0.0, rise)
    strips = tuple(
        _strip(name, (x, 0.0), apex, GROUND, "apex", (1.885e6, 9.27e3, 1.0))
        for name, x in (("left", -half), ("right", half))
    )
    return Frame(design=_loaded(strips, {"apex": apex}, "apex", (0.0, -load)), load=load, body="apex")


def lees_frame(*, load: float = 3.0) -> Frame:
    """Return Lee's frame: two pinned members of 120 cm at a right angle, `load` [t] 24 cm from the corner.

    A = 6 cm^2, I = 2 cm^4, E = 720 t/cm^2. S. L. Lee, F. S. Manuel, E. C. Rossow, Journal of the Engineering
    Mechanics Division (ASCE) 94 (1968) 521.
    """
    joints = {"foot": (0.0, 0.0), "corner": (0.0, 120.0), "loaded": (24.0, 120.0), "far": (120.0, 120.0)}
    strips = tuple(
        _strip(f"{a}_{b}", joints[a], joints[b], a, b, (6.0, 2.0, 720.0))
        for a, b in itertools.pairwise(joints)
    )
    return Frame(
        design=_loaded(strips, joints, "loaded", (0.0, -load)),
        load=load,
        body="loaded",
        pins=("foot", "far"),
    )


def pushed_pivot(*, depth: float) -> Frame:
    """Return the pivot of Table 1 with its body's centre led down by `depth` [m], free to turn."""
    effects = Effects(
        names=(*STATIC, "driven_displacement"),
        tables={"driven_displacement": {"displacement": (0.0, -depth)}},
    )
    design = replace(as_mechanism(named_case(CASE), 0.0), rotation=None, effects=effects)
    return Frame(design=design, load=depth, body="body")


def _strip(
    name: str,
    start: tuple[float, float],
    end: tuple[float, float],
    root: str,
    tip: str,
    section: tuple[float, float, float],
) -> Strip:
    """Return a strip of section (A, I, E)."""
    area, second, modulus = section
    return Strip(
        name=name, start=start, end=end, root=root, tip=tip, area=area, second_moment_of_area=second,
        youngs_modulus=modulus, **UNASKED,
    )  # fmt: skip


def _loaded(
    strips: tuple[Strip, ...],
    joints: dict[str, tuple[float, float]],
    body: str,
    force: tuple[float, float],
) -> Mechanism:
    """Return the strips between joints, which are bodies without mass, one of them under a force."""
    effects = Effects(
        names=(*STATIC, "applied_force"), tables={"applied_force": {"body": body, "force": force}}
    )
    bodies = tuple(
        Body(name=name, centre=place, mass=0.0, moment_of_inertia=0.0) for name, place in joints.items()
    )
    return Mechanism(
        strips=strips, bodies=bodies, body=body, rotation=None, increments=INCREMENTS, effects=effects
    )


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
    model = model_of(settings)
    asked, _ = built(model, frame.design, settings, moving=False)
    with refusals(model, settings):
        path = solve_mechanism(
            asked.pinned(*frame.pins),
            increments=frame.design.increments,
            control="arc-length",
            branch=branch,
            raise_on_failure=False,
        )
    at = path.along.system.layout.body(frame.body)
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
