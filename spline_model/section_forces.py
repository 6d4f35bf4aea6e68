"""What is drawn along the strips of any states: shape, rotation, strains, section forces, clamp reactions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from spline_model.basis import SlideModes
from spline_model.compile import System, compile_scene
from spline_model.effects import GROUND, MixedStretching
from spline_model.errors import InvalidParameter, require_choice
from spline_model.mechanism import Mechanism, require_mechanism
from spline_model.motion.start import axial_rigidity
from spline_model.paper import strips_of
from spline_model.scene import Scene
from spline_model.sections import STATIONS, Sections, by_piece, curves, reactions, sections

Array = NDArray[np.float64]

STATIC, MOVING, _ = ANALYSES = ("static", "release", "modes")


@dataclass(frozen=True, kw_only=True, eq=False)
class StripFields:
    """Fields along G strips at P stations from root to tip, for S states.

    Attributes
    ----------
    arc_length : (G, P) m
        At rest.
    rest_shape, shape : (G, P, 2) and (S, G, P, 2) m
    rotation : (S, G, P) rad
        Of the section from rest, without wrapping.
    curvature : (S, G, P) 1/m
        d(theta)/ds0 of the shape.
    stretch : (S, G, P) 1
        ds/ds0 of the law of the axial force.
    axial_force, shear_force, bending_moment : (S, G, P) N, N and N m
        Exerted by the part beyond on the part before: along the tangent, along the normal to its left, and
        positive for counter-clockwise curvature.
    reactions : (S, G, 2, 3) N and N m
        Force and moment on the strip at root and tip.
    rest_bodies, bodies : (B, 2) m, and (S, B, 3) m and rad
        Centre at rest, and centre and rotation, in the order of the design.
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


def strip_fields(mechanism: Mechanism, states: Array, analysis: str = "static") -> StripFields:
    """Return the fields of states along the strips.

    Parameters
    ----------
    mechanism : Mechanism
    states : (S, N) m, rad and N
        Unknowns of S states, as solutions hold them; the multiplier of a drive at the end is ignored.
    analysis : str
        "static" (default), "release" for the states of a motion, or "modes" for states that modes are about:
        static ones without what is released in a motion.

    Returns
    -------
    StripFields
        Arrays (S, G, P) of G strips at P stations: axial force, shear force, moment and more.

    Raises
    ------
    InvalidParameter
        States of another size than the mechanism's, or another analysis.

    Notes
    -----
    N and M follow from the strains; they have the error of too few control points. Shear force and reactions
    of a static state follow from balance with the clamps: exact but for the residual of the solver. Inertia
    is not among the states of a motion: there the shear force is that of the moments' balance in a
    shear-rigid strip without rotary inertia of its sections, V = -M' / stretch (' = d/ds0), one order less
    accurate than M, and the reactions are the section forces at the ends, zero at a free one but for that
    error. Its axial forces are those of the shape, as some integrators keep none; of inextensible strips
    those that the states hold.

    References
    ----------
    Reissner, Zeitschrift fuer angewandte Mathematik und Physik 23 (1972), for the balance of a strip.

    Examples
    --------
    With ``pivot`` of the example of ``spline_model.pivot.cross_axis_pivot``:

    >>> path = solve_statics(pivot, rotation=0.1, increments=1)
    >>> strip_fields(pivot, path.states).bending_moment.shape[:2]
    (2, 2)
    >>> motion = solve_motion(pivot, start=0.1, duration=1e-3, step=1e-4, records=2, check=False)
    >>> strip_fields(pivot, motion.states, "release").shear_force.shape[:2]
    (3, 2)
    """
    require_mechanism(mechanism)
    require_choice("analysis", analysis, ANALYSES)
    scene = mechanism.scene if analysis == STATIC else mechanism.released()
    return _fields(mechanism, scene, states, moving=analysis == MOVING)


def _known(system: System, states: Array) -> Array:
    """The unknowns (S, N) among states, which may have a drive's behind them; refuses another design's."""
    found, size = np.asarray(states), system.layout.size
    if found.ndim != 2 or found.shape[1] < size:
        raise InvalidParameter("states", found.shape, f"(S, {size}), of this design and control points")
    return found[:, :size]


def _fields(mechanism: Mechanism, scene: Scene, states: Array, *, moving: bool) -> StripFields:
    system = compile_scene(scene)
    states = _known(system, states)
    if moving:
        states = _with_axial_forces(system, states)
    layout, along = system.layout, sections(system, states, STATIONS)
    rest_shape, rest = (curves(system, system.rest[None], STATIONS, order)[0] for order in (0, 1))
    arc, (tangent, bend) = _arc_length(scene), (curves(system, states, STATIONS, order) for order in (1, 2))
    speed, rest_speed = np.linalg.norm(tangent, axis=-1), np.linalg.norm(rest, axis=-1)
    rotation = np.unwrap(np.arctan2(_cross(rest, tangent), np.sum(rest * tangent, axis=-1)), axis=-1)
    for g, root in enumerate(strip.root for strip in mechanism.design.strips):
        if root != GROUND:  # a body at the root says how many whole turns it has made
            turn = states[:, layout.body(root)][:, 2:]
            rotation[:, g] += 2.0 * np.pi * np.round((turn - rotation[:, g, :1]) / (2.0 * np.pi))
    stretch = speed / rest_speed
    _stretch(mechanism, system.scene, along.axial_force, stretch)
    if moving:
        direction = rotation + np.arctan2(rest[..., 1], rest[..., 0])
        force, borne = _by_moments(arc, along, stretch, direction)
    else:
        force, borne = along.shear_force, reactions(system, states)
    return StripFields(
        arc_length=arc,
        rest_shape=rest_shape,
        shape=along.shape,
        rotation=rotation,
        curvature=_cross(tangent, bend) / speed**2 / rest_speed,
        stretch=stretch,
        axial_force=along.axial_force,
        shear_force=force,
        bending_moment=along.bending_moment,
        reactions=borne,
        rest_bodies=np.array([body.centre for body in mechanism.design.bodies]).reshape(-1, 2),
        bodies=states[:, layout.poses].reshape(len(states), -1, 3)[:, : len(scene.own_bodies)],
    )


def _arc_length(scene: Scene) -> Array:
    """Arc length at rest (G, P) [m] up to the stations."""
    begin, parts = np.zeros((len(scene.whole), 1)), []
    for strips, at in by_piece(scene, STATIONS):
        lengths = np.array([strip.length_to(np.append(at, 1.0)) for strip in strips])
        parts.append(begin + lengths[:, :-1])
        begin = begin + lengths[:, -1:]
    return np.concatenate(parts, axis=1)


def _stretch(mechanism: Mechanism, scene: Scene, axial_force: Array, stretch: Array) -> None:
    """Put 1 + N/EA + natural strain of mixed strips in the place of that of the shape."""
    of = {strip.name: strip.of or strip.name for strip in scene.strips}
    for mixed in reversed(scene.of(MixedStretching)):
        if not isinstance(mixed.modes, SlideModes):
            g = list(scene.whole).index(of[mixed.strip])
            taper = mechanism.design.strips[g].taper
            strain = mixed.axial_compliance * axial_force[:, g] / (taper.area(STATIONS) if taper else 1.0)
            stretch[:, g] = 1.0 + strain + mixed.natural_strain


def _by_moments(arc: Array, along: Sections, stretch: Array, direction: Array) -> tuple[Array, Array]:
    """Shear force and reactions by the balance of moments."""
    from scipy.interpolate import CubicSpline

    moments = zip(arc, np.moveaxis(along.bending_moment, 1, 0), strict=True)
    slope = np.stack([CubicSpline(s, moment, axis=1)(s, 1) for s, moment in moments], axis=1)
    shear = -slope / stretch
    c, s = np.cos(direction), np.sin(direction)
    x, y = along.axial_force * c - shear * s, along.axial_force * s + shear * c
    beyond = np.stack((x, y, along.bending_moment), axis=-1)
    return shear, np.stack((-beyond[:, :, 0], beyond[:, :, -1]), axis=2)


def _with_axial_forces(system: System, states: Array) -> Array:
    """The states (T, N) with the axial-force modes that their shapes give, where strips can stretch."""
    found, rigidity = np.array(states), axial_rigidity(system)
    axial = slice(system.layout.coordinate_count, system.layout.multiplier_start)
    forces = strips_of(system).strains(found) @ rigidity
    found[:, axial] = np.where(np.diag(rigidity) != 0.0, forces, found[:, axial])
    return found


def _cross(a: Array, b: Array) -> Array:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])
