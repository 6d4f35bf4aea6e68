"""What is drawn along the strips of any states: shape, rotation, strains, section forces, clamp reactions."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from spline_model.basis import SlideModes
from spline_model.bordered import evaluate
from spline_model.compile import System, compile_scene
from spline_model.effects import GROUND, MixedStretching
from spline_model.errors import InvalidParameter
from spline_model.mechanism import Mechanism
from spline_model.motion.start import axial_rigidity
from spline_model.sections import ENDS, STATIONS, Sections, clamp_reactions, sections

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class StripFields:
    """Along G strips at P stations from root to tip, for S states.

    arc_length (G, P) at rest [m]; rest_shape (G, P, 2) [m]; shape (S, G, P, 2) [m]; rotation
    (S, G, P) of the section from rest, without wrapping [rad]; curvature (S, G, P)
    d(theta)/ds0 of the shape [1/m]; stretch (S, G, P) ds/ds0, the one whose law gives the axial
    force [1]; axial_force, shear_force [N], bending_moment [N m] (S, G, P): of the part
    beyond on the part before, along the tangent, along the normal to its left, and positive
    for counter-clockwise curvature; reactions (S, G, 2, 3): force [N] and moment [N m] on
    the strip at root and tip. rest_bodies (B, 2) centres at rest [m], bodies (S, B, 3) centre
    [m] and rotation [rad], in the order of the design.
    """

    arc_length: Array
    rest_shape: Array
    shape: Array
    rotation: Array
    curvature: Array
    stretch: Array
    axial_force: Array
    shear_force: Array
    bending_moment: Array
    reactions: Array
    rest_bodies: Array
    bodies: Array


ALONG = tuple(field.name for field in fields(StripFields) if "bodies" not in field.name)
GIVEN = ("arc_length", "rest_shape")


def static_fields(mechanism: Mechanism, states: Array) -> StripFields:
    """Fields of static states (S, N), as solutions hold them; a drive's multiplier at the end is ignored.

    Shear force and reactions are those of balance with the clamps: exact but for the solver's
    residual. N and M follow from the strains and show the error of too few control points.
    """
    system = compile_scene(mechanism.scene)
    return _fields(mechanism, system, _known(system, states), moving=False)


def moving_fields(mechanism: Mechanism, states: Array) -> StripFields:
    """Fields of the states (T, N) of a motion.

    Inertia is not among the states: the shear force is that of the moments' balance in a
    shear-rigid strip without rotary inertia of its sections, V = -M' / stretch (' = d/ds0),
    one order less accurate than M, and the reactions are the section forces at the ends, zero
    at a free one but for that error. Axial forces are those of the shape, as some integrators
    keep none; of inextensible strips those that the states hold.
    """
    system = compile_scene(mechanism.scene)
    known = _with_axial_forces(system, _known(system, states))
    return _fields(mechanism, system, known, moving=True)


def _known(system: System, states: Array) -> Array:
    """The unknowns (S, N) among states, which may have a drive's behind them; refuses another design's."""
    found, size = np.asarray(states), system.layout.size
    if found.ndim != 2 or found.shape[1] < size:
        raise InvalidParameter("states", found.shape, f"(S, {size}), of this design and control points")
    return found[:, :size]


def _fields(mechanism: Mechanism, system: System, states: Array, *, moving: bool) -> StripFields:
    along = sections(system, states, STATIONS)
    strips = [
        _strip_fields(system, states, along.strip(i), s.name, s.root, moving)
        for i, s in enumerate(mechanism.design.strips)
    ]
    return StripFields(
        **{name: np.stack([each[name] for each in strips], axis=int(name not in GIVEN)) for name in ALONG},
        rest_bodies=np.array([body.centre for body in mechanism.design.bodies]).reshape(-1, 2),
        bodies=states[:, system.layout.poses].reshape(len(states), -1, 3),
    )


def _strip_fields(
    system: System, states: Array, along: Sections, name: str, root: str, moving: bool
) -> dict[str, Array]:
    strip = system.scene.strip(name)
    first, second = (strip.basis.evaluate(STATIONS, order) for order in (1, 2))
    points = states[:, system.layout.strip(name)].reshape(len(states), -1, 2)
    tangent, rest = first @ points, first @ strip.control_points
    speed, rest_speed = np.linalg.norm(tangent, axis=-1), np.hypot(*rest.T)
    rotation = np.unwrap(np.arctan2(_cross(rest, tangent), np.sum(rest * tangent, axis=-1)), axis=1)
    if root != GROUND:  # a body at the root says how many whole turns it has made
        turn = states[:, system.layout.body(root)][:, 2:]
        rotation = rotation + 2.0 * np.pi * np.round((turn - rotation[:, :1]) / (2.0 * np.pi))
    stretch = _stretch(system, along.axial_force, name, speed / rest_speed)
    direction = rotation + np.arctan2(rest[:, 1], rest[:, 0])
    arc = strip.length_to(STATIONS)
    if moving:
        force, reactions = _by_moments(arc, along, stretch, direction)
    else:
        ends = [clamp_reactions(system, states, name, end) for end in ENDS]
        force, reactions = along.shear_force, np.stack(ends, axis=1)
    return {
        "arc_length": arc,
        "rest_shape": strip.basis.evaluate(STATIONS) @ strip.control_points,
        "shape": along.shape,
        "rotation": rotation,
        "curvature": _cross(tangent, second @ points) / speed**2 / rest_speed,
        "stretch": stretch,
        "axial_force": along.axial_force,
        "shear_force": force,
        "bending_moment": along.bending_moment,
        "reactions": reactions,
    }


def _stretch(system: System, axial_force: Array, name: str, kinematic: Array) -> Array:
    """1 + N/EA + natural strain of a mixed strip; that of the shape otherwise."""
    for mixed in system.scene.of(MixedStretching):
        if mixed.strip == name and not isinstance(mixed.modes, SlideModes):
            return np.asarray(1.0 + mixed.axial_compliance * axial_force + mixed.natural_strain)
    return kinematic


def _by_moments(arc: Array, along: Sections, stretch: Array, direction: Array) -> tuple[Array, Array]:
    """Shear force and reactions by the balance of moments."""
    slope = CubicSpline(arc, along.bending_moment, axis=1)(arc, 1)
    shear = -slope / stretch
    c, s = np.cos(direction), np.sin(direction)
    x, y = along.axial_force * c - shear * s, along.axial_force * s + shear * c
    beyond = np.stack((x, y, along.bending_moment), axis=-1)
    return shear, np.stack((-beyond[:, 0], beyond[:, -1]), axis=1)


def _with_axial_forces(system: System, states: Array) -> Array:
    """The states (T, N) with the axial-force modes that their shapes give, where strips can stretch."""
    layout, found = system.layout, np.array(states)
    axial = slice(layout.coordinate_count, layout.multiplier_start)
    rigidity = axial_rigidity(system)
    elastic = np.diag(rigidity) != 0.0
    gradient, hessian = np.empty(layout.size), np.empty((layout.size, layout.size))
    for z in found:
        free = z.copy()
        free[layout.coordinate_count :] = 0.0
        evaluate(system, free, 1.0, gradient, hessian)
        z[axial] = np.where(elastic, rigidity @ gradient[axial], z[axial])
    return found


def _cross(a: Array, b: Array) -> Array:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])
