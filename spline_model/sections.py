"""Shapes and section forces along the strips, from the states of a path."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.continuation.followed import balance
from spline_model.effects import GROUND, Bending, Clamp, Gravity, MixedStretching, Stretching
from spline_model.scene import Scene, Strip
from spline_model.solution import read_only

Array = NDArray[np.float64]

STATIONS = read_only(np.linspace(0.0, 1.0, 61))
"""Where sections are recovered, reference arc length over L; both clamped ends are among them."""
ENDS = ("start", "end")
ROUND_OFF = 1e-9
"""Part of a piece by which a station may lie before it."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Sections:
    """Along G strips at P stations, for S states.

    shape (S, G, P, 2) [m]; axial_force N and bending_moment M by the constitutive law, so
    that the oscillation of a locking strain is seen, or of a ``balanced`` static state by balance, which
    converges as the reactions do; shear_force V from the balance with
    the clamp's reaction and the strip's weight (no law gives it in a shear-rigid strip), so
    of a static state only; (S, G, P) [N, N m, N].
    """

    shape: Array
    axial_force: Array
    bending_moment: Array
    shear_force: Array

    def __post_init__(self) -> None:
        read_only(vars(self))


def by_piece(scene: Scene, stations: Array) -> list[tuple[list[Strip], Array]]:
    """Return groups of pieces that lie alike in their strips, root first, with the stations (Q,) [1] in
    each."""
    wholes = list(scene.whole.values())
    count = len(wholes[0]) if wholes else 1
    piece = np.minimum(count * stations + ROUND_OFF, count - 1).astype(np.int64)
    return [([each[k] for each in wholes], (count * stations - k)[piece == k]) for k in range(count)]


def curves(system: System, states: Array, order: int) -> Array:
    """Return that derivative of the strips' curves at STATIONS, in the u of their pieces (S, G, P, 2) [m].

    states (S, N or Q): unknowns, or their rates or shapes.
    """
    layout, parts = system.layout, []
    for strips, at in by_piece(system.scene, STATIONS):
        points = [states[:, layout.strip(strip.name)].reshape(len(states), -1, 2) for strip in strips]
        parts.append(strips[0].basis.evaluate(at, order) @ np.stack(points, axis=1))
    return np.concatenate(parts, axis=2)


def sections(system: System, states: Array, stations: Array, *, balanced: bool = False) -> Sections:
    """Return the sections of all strips at ``stations`` (P,), u in [0, 1], of states (S, N).

    balanced: whether forces and moments are by balance with the clamp at the root [N, N m].
    """
    parts = [_alike(system, states, strips, at, balanced) for strips, at in by_piece(system.scene, stations)]
    if len(parts) == 1:
        return parts[0]
    names = [part.name for part in fields(Sections)]
    return Sections(**{name: np.concatenate([getattr(p, name) for p in parts], axis=2) for name in names})


def _alike(system: System, states: Array, strips: list[Strip], stations: Array, balanced: bool) -> Sections:
    """Sections of strips of one basis: one product with its values, the strips at rest a state more."""
    scene, layout, count, basis = system.scene, system.layout, len(states), strips[0].basis
    points = np.empty((basis.control_points, 2, count + 1, len(strips)))
    for g, strip in enumerate(strips):
        own = states[:, layout.strip(strip.name)].reshape(count, -1, 2)
        points[:, :, :count, g], points[:, :, count, g] = own.transpose(1, 2, 0), strip.control_points
    values = np.concatenate([basis.evaluate(stations, order) for order in range(2 + (not balanced))])
    curve = (values @ points.reshape(len(points), -1)).reshape(-1, len(stations), *points.shape[1:])
    x1, y1 = curve[1, :, 0], curve[1, :, 1]  # (P, S + 1, G), the last state at rest
    speed = np.sqrt(x1 * x1 + y1 * y1)
    x, y = x1[:, :count] / speed[:, :count], y1[:, :count] / speed[:, :count]

    pull = _pulls(system, states, strips, stations)
    shear = pull[1] * x - pull[0] * y
    if balanced:
        force = (pull[0] * x + pull[1] * y).transpose(1, 2, 0)
        moment = _balanced_moments(system, states, strips, points[:, :, :count], stations)
    else:
        moment = _moments(scene, strips, curve, speed, stations)
        force = _axial_forces(system, states, strips, stations, speed[:, :count] / speed[:, count:])
    return Sections(
        shape=np.ascontiguousarray(curve[0, :, :, :count].transpose(2, 3, 0, 1)),
        axial_force=np.ascontiguousarray(force),
        bending_moment=np.ascontiguousarray(moment.transpose(1, 2, 0)),
        shear_force=np.ascontiguousarray(shear.transpose(1, 2, 0)),
    )


def _moments(scene: Scene, strips: list[Strip], curve: Array, speed: Array, stations: Array) -> Array:
    """Bending moments (P, S, G) by the law, of curves and derivatives (3, P, 2, S + 1, G), rest last."""
    (x1, y1), (x2, y2) = curve[1].swapaxes(0, 1), curve[2].swapaxes(0, 1)
    turning = (x1 * y2 - y1 * x2) / speed**2
    moment: Array = np.zeros_like(turning[:, :-1])
    bends = {bending.strip: bending for bending in scene.of(Bending)}
    for g, strip in enumerate(strips):
        if bending := bends.get(strip.name):
            rest = turning[:, -1:, g] / speed[:, -1:, g]
            length = speed[:, -1:, g] if bending.measure == "material" else speed[:, :-1, g]
            strain = turning[:, :-1, g] / length - rest - bending.natural_curvature
            moment[..., g] = bending.moment_at(strain, strip.basis.degree, stations)
    return moment


def _pulls(system: System, states: Array, strips: list[Strip], stations: Array) -> Array:
    """Force of what is beyond a station on what is before (2, P, S, G), by clamp of the root and weight.

    It is one for all stations where nothing has a weight, P = 1.
    """
    weights = system.scene.of(Gravity)
    pull = np.empty((2, len(stations) if weights else 1, len(states), len(strips)))
    for g, strip in enumerate(strips):
        pull[..., g] = -clamp_reactions(system, states, strip.name, "start")[:, :2].T[:, None]
        for weight in weights:
            mass = strip.linear_density * strip.length_to(stations, strip.taper)
            pull[..., g] -= np.multiply.outer(weight.acceleration, mass)[..., None]
    return pull


def _balanced_moments(
    system: System, states: Array, strips: list[Strip], points: Array, stations: Array
) -> Array:
    """Bending moments (P, S, G) by balance, of control points (n, 2, S, G)."""
    basis = strips[0].basis
    values = basis.evaluate(stations)
    by_strip = [
        balance(
            points[..., g].transpose(2, 0, 1),
            values,
            (basis, stations),
            clamp_reactions(system, states, strip.name, "start"),
            system.scene.weight_of(strip.name),
        )
        for g, strip in enumerate(strips)
    ]
    return np.array(by_strip).transpose(2, 1, 0)


def _axial_forces(
    system: System, states: Array, strips: list[Strip], stations: Array, stretch: Array
) -> Array:
    """Axial forces (S, G, P) by the law; stretch (P, S, G)."""
    scene, force = system.scene, np.zeros((len(states), len(strips), len(stations)))
    for g, strip in enumerate(strips):
        for consistent in scene.of(Stretching):
            if consistent.strip == strip.name:
                strain = stretch[..., g] - 1.0 - consistent.natural_strain
                force[:, g] += consistent.axial_rigidity * strain.T
        for i, mixed in enumerate(scene.of(MixedStretching)):
            if mixed.strip == strip.name:
                axial = states[:, system.layout.axial_modes(i)]
                force[:, g] += axial @ mixed.modes.evaluate(stations).T
    return force


def clamp_reactions(system: System, states: Array, strip: str, end: str) -> Array:
    """Return the force and moment of the clamp on that end of a strip or piece (S, 3) [N, N, N m]; zero if
    free."""
    pieces = system.scene.whole.get(strip)
    if pieces is not None:
        strip = pieces[0 if end == "start" else -1].name
    rows = None if end == "end" and strip in system.scene.free_ends else system.scene.clamps.get((strip, end))
    return np.zeros((len(states), 3)) if rows is None else states[:, rows]


def reactions(system: System, states: Array) -> Array:
    """Return force [N] and moment [N m] of the clamps at root and tip of all strips (S, G, 2, 3)."""
    ends = [[clamp_reactions(system, states, name, end) for end in ENDS] for name in system.scene.whole]
    return np.asarray(np.array(ends).transpose(2, 0, 1, 3))


def free_tips(system: System, states: Array) -> dict[str, Array]:
    """Return x, y [m] of the free ends, and how far their sections have turned since rest [rad], (S, 3) by
    strip.

    The turn is that of the root's frame and, from station to station, along the last piece.
    """
    scene, found = system.scene, {}
    roots = {each.strip: each.to for each in scene.of(Clamp) if each.end == "start"}
    for name in scene.free_ends:
        strip = scene.strip(name)
        points = states[:, system.layout.strip(name)].reshape(len(states), -1, 2)
        slopes = strip.basis.evaluate(STATIONS, 1) @ np.concatenate((points, strip.control_points[None]))
        angles = np.unwrap(np.arctan2(slopes[..., 1], slopes[..., 0]), axis=1)
        turn = angles[:, -1] - angles[:, 0]
        turn = turn[:-1] - turn[-1]
        if roots[name] != GROUND:
            turn = turn + states[:, system.layout.body(roots[name]).start + 2]
        found[strip.of or name] = np.column_stack((points[:, -1], turn))
    return found
