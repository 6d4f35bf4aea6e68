"""Frames that buckle and snap through, in consistent units, and the pivot pushed down along its strips."""

import itertools
import math
from dataclasses import dataclass, replace

from studies.cases.effects import Effects
from studies.cases.mechanism import GROUND, Body, Mechanism, Strip
from studies.cases.problem import named_case
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
