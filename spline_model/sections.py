"""Shapes and section forces along the strips, from the states of a path."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from spline_model.basis import Bezier
from spline_model.compile import System
from spline_model.effects import GROUND, Bending, Clamp, Gravity, MixedStretching, Stretching
from spline_model.scene import Scene, Strip
from spline_model.solution import read_only
from spline_model.strip.compiled import called, kernel

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


def curves(system: System, states: Array, stations: Array, order: int) -> Array:
    """Return that derivative of the strips' curves at ``stations`` (P,), in the u of their pieces.

    Points or derivatives (S, G, P, 2) [m] of states (S, N).
    """
    groups = by_piece(system.scene, stations)
    parts = [
        strips[0].basis.evaluate(at, order) @ _points(system, states, strips).swapaxes(0, 1)
        for strips, at in groups
    ]
    return np.concatenate(parts, axis=2)


def _points(system: System, states: Array, strips: list[Strip]) -> Array:
    """Control points (G, S, n, 2) of strips of one basis [m]."""
    own = [states[:, system.layout.strip(strip.name)] for strip in strips]
    return np.array(own).reshape(len(strips), len(states), -1, 2)


def sections(system: System, states: Array, stations: Array, *, balanced: bool = False) -> Sections:
    """Return the sections of all strips at ``stations`` (P,), u in [0, 1], of states (S, N).

    balanced: whether forces and moments are by balance with the clamp at the root [N, N m].
    """
    scene, z, done = system.scene, np.array(states), 0
    size = len(states), len(scene.whole), len(stations)
    axial, moment, shear, shape = *np.empty((3, *size)), np.empty((*size, 2))
    weights = scene.of(Gravity)
    for strips, at in by_piece(scene, stations):
        places = [system.layout.strip(strip.name).start for strip in strips]
        roots = [scene.clamps.get((strip.name, "start")) for strip in strips]
        where = np.array((places, [-1 if rows is None else rows.start for rows in roots]))
        dead, borne = np.zeros((len(strips), 3, 2)), np.zeros((len(strips), 2, len(at)))
        for g, strip in enumerate(strips if weights else ()):
            dead[g] = scene.weight_of(strip.name)
            for weight in weights:
                mass = strip.linear_density * strip.length_to(at, strip.taper)
                borne[g] += np.multiply.outer(weight.acceleration, mass)
        tables, lanes = _tables(strips[0].basis, at.tobytes()), np.empty((6, len(at)))
        found = axial, moment, shear, shape
        _balance(z, where, tables, at, dead, borne, bool(weights), lanes, done, found)
        if not balanced:
            inside = slice(done, done + len(at))
            axial[..., inside], moment[..., inside] = _by_law(system, states, strips, at)
        done += len(at)
    return Sections(shape=shape, axial_force=axial, bending_moment=moment, shear_force=shear)


@lru_cache(maxsize=64)
def _tables(basis: Bezier, at: bytes) -> Array:
    """The basis at places u (P,), its derivative and integrals of it, of u and of u^2 times it (5, n, P)."""
    u = np.frombuffer(at)
    values = [basis.evaluate(u), basis.evaluate(u, 1), *(basis.areas(u, power) for power in range(3))]
    return np.ascontiguousarray(np.array(values).transpose(0, 2, 1))


@kernel()
def _balance(states, where, tables, u, dead, borne, heavy, lanes, first, found):
    """Force, moment and shear of what is beyond on what is before by balance with the clamp of the root, and
    the points.

    first: of the stations u; where (2, G): places of the first control points and of the clamps, -1 of none;
    dead (G, 3, 2): weight per du with 1, u and u^2, borne (G, 2, P) up to the stations [N].
    """
    axial, moment, shear, shape = found
    x, y, tx, ty, ax, ay = lanes[0], lanes[1], lanes[2], lanes[3], lanes[4], lanes[5]
    for row in range(states.shape[0]):
        for g in range(where.shape[1]):
            at, clamp, fx, fy, couple = where[0, g], where[1, g], 0.0, 0.0, 0.0
            z = states[row]
            if clamp >= 0:
                fx, fy, couple = z[clamp], z[clamp + 1], z[clamp + 2]
            _curve(z, at, tables[0], x, y)
            _curve(z, at, tables[1], tx, ty)
            for p in range(u.size):
                to = first + p
                shape[row, g, to, 0], shape[row, g, to, 1] = x[p], y[p]
                speed = np.sqrt(tx[p] * tx[p] + ty[p] * ty[p])
                ex, ey, px, py = tx[p] / speed, ty[p] / speed, -fx - borne[g, 0, p], -fy - borne[g, 1, p]
                axial[row, g, to], shear[row, g, to] = px * ex + py * ey, py * ex - px * ey
                moment[row, g, to] = (x[p] - z[at]) * fy - (y[p] - z[at + 1]) * fx - couple
            for power in range(3 * heavy):
                _curve(z, at, tables[2 + power], ax, ay)
                for p in range(u.size):
                    whole = u[p] ** (power + 1) / (power + 1)
                    bx, by = whole * x[p] - ax[p], whole * y[p] - ay[p]
                    moment[row, g, first + p] += bx * dead[g, power, 1] - by * dead[g, power, 0]


@called()
def _curve(z, at, table, x, y):
    """Coordinates of a curve whose control points begin at a place of the unknowns."""
    for p in range(x.size):
        x[p] = y[p] = 0.0
    for i in range(table.shape[0]):
        px, py = z[at + 2 * i], z[at + 2 * i + 1]
        for p in range(x.size):
            x[p] += table[i, p] * px
            y[p] += table[i, p] * py


def _by_law(system: System, states: Array, strips: list[Strip], at: Array) -> tuple[Array, Array]:
    """Axial forces and moments (S, G, P) of strips of one basis at places u (P,) by the law."""
    scene, basis = system.scene, strips[0].basis
    rest = np.array([strip.control_points for strip in strips])[:, None]
    points = np.concatenate((_points(system, states, strips), rest), axis=1)
    (x1, y1), (x2, y2) = (np.moveaxis(basis.evaluate(at, order) @ points, -1, 0) for order in (1, 2))
    speed = np.sqrt(x1 * x1 + y1 * y1)
    turning, stretch = (x1 * y2 - y1 * x2) / speed**2, speed[:, :-1] / speed[:, -1:]
    force, moment = np.zeros((2, *stretch.shape))
    place = {strip.name: g for g, strip in enumerate(strips)}
    for bending in scene.of(Bending):
        if (g := place.get(bending.strip, -1)) >= 0:
            length = speed[g, -1:] if bending.measure == "material" else speed[g, :-1]
            strain = turning[g, :-1] / length - turning[g, -1] / speed[g, -1] - bending.natural_curvature
            moment[g] = bending.moment_at(strain.T, basis.degree, at).T
    for consistent in scene.of(Stretching):
        if (g := place.get(consistent.strip, -1)) >= 0:
            force[g] += consistent.axial_rigidity * (stretch[g] - 1.0 - consistent.natural_strain)
    for i, mixed in enumerate(scene.of(MixedStretching)):
        if (g := place.get(mixed.strip, -1)) >= 0:
            force[g] += states[:, system.layout.axial_modes(i)] @ mixed.modes.evaluate(at).T
    return force.swapaxes(0, 1), moment.swapaxes(0, 1)


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
