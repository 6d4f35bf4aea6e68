"""Frames with published limit loads, and a column: mechanisms of several strips in consistent units."""

import itertools
import math

from spline_model import BodyDesign, Pivot, StripDesign, compliant_mechanism
from tests.table_one import TABLE_ONE

STATIC = ("bending", "stretching")


def toggle(*, rise=0.386, load=60.0, **discretisation):
    """Williams' toggle (1964): two members of 12.943 in, built in, EI = 9.27e3 lb in^2, EA = 1.885e6 lb.

    ``load`` [lb] downwards at the apex at load factor 1.
    """
    half = math.sqrt(12.943**2 - rise**2)
    section = {"area": 1.885e6, "second_moment_of_area": 9.27e3, "youngs_modulus": 1.0, "density": 1.0}
    return compliant_mechanism(
        strips=[
            StripDesign(name="left", start=(-half, 0.0), end=(0.0, rise), tip="apex", **section),
            StripDesign(name="right", start=(half, 0.0), end=(0.0, rise), tip="apex", **section),
        ],
        bodies=[BodyDesign(name="apex", centre=(0.0, rise))],
        effects=(*STATIC, "applied_force"),
        parameters={"applied_force": {"body": "apex", "force": (0.0, -load)}},
        **({"control_points": 6} | discretisation),
    )


def lees_frame(*, load=3.0, area=6.0, **discretisation):
    """Lee, Manuel and Rossow's frame (1968): two members of 120 cm at a right angle, pinned ends.

    A = 6 cm^2, I = 2 cm^4, E = 720 t/cm^2 (in print also 7.06e6 N/cm^2); ``load`` [t] down at 24 cm from the
    corner. The law is the extensible, shear-rigid elastica. A pin is a body without mass.
    """
    section = {"area": area, "second_moment_of_area": 2.0, "youngs_modulus": 720.0, "density": 1.0}
    joints = {"foot": (0.0, 0.0), "corner": (0.0, 120.0), "loaded": (24.0, 120.0), "far": (120.0, 120.0)}
    names = list(joints)
    strips = [
        StripDesign(name=f"{a}_{b}", start=joints[a], end=joints[b], root=a, tip=b, **section)
        for a, b in itertools.pairwise(names)
    ]
    frame = compliant_mechanism(
        strips=strips,
        bodies=[BodyDesign(name=name, centre=place) for name, place in joints.items()],
        effects=(*STATIC, "applied_force"),
        parameters={"applied_force": {"body": "loaded", "force": (0.0, -load)}},
        **({"control_points": 6} | discretisation),
    )
    return frame.pinned("foot", "far")


def column(*, load, slenderness=1e3, side=0.0, effects=STATIC, **discretisation):
    """A cantilever column of length 1 and EI = 1 along x; ``load`` [EI/L^2] pushes its tip back to the root.

    slenderness: L sqrt(EA / EI); side: part of the load that acts across, the imperfection.
    """
    section = {"area": slenderness**2, "second_moment_of_area": 1.0, "youngs_modulus": 1.0, "density": 1.0}
    return compliant_mechanism(
        strips=[StripDesign(name="column", start=(0.0, 0.0), end=(1.0, 0.0), tip="tip", **section)],
        bodies=[BodyDesign(name="tip", centre=(1.0, 0.0))],
        effects=(*effects, "applied_force"),
        parameters={"applied_force": {"body": "tip", "force": (-load, side * load)}},
        **({"control_points": 6} | discretisation),
    )


def opposed(*, offset=0.01, **discretisation):
    """A body on two parallel strips of Table 1's section that come from opposite sides, 0.1 m long.

    Turned clockwise, both strips are pushed together alike: half a turn maps the pivot onto
    itself, until the strips buckle and the body gives way. As a pivot.
    """
    names = ("area", "second_moment_of_area", "youngs_modulus", "poisson_ratio", "density")
    section = {name: TABLE_ONE[name] for name in names}
    half = 0.05
    ends = (((-half, -offset), (half, -offset)), ((half, offset), (-half, offset)))
    strips = [
        StripDesign(name=f"strip_{i}", start=start, end=end, tip="body", **section)
        for i, (start, end) in enumerate(ends, start=1)
    ]
    body = BodyDesign(name="body", centre=(0.0, 0.0))
    made = compliant_mechanism(
        strips=strips, bodies=[body], effects=STATIC, **({"control_points": 6} | discretisation)
    )
    return Pivot(design=made.design, effects=made.effects, parameters=made.parameters, scene=made.scene)
