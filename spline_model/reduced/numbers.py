"""From the numbers of D designs of a scene to the arrays of the kernels.

D = 1 for the scene itself, many for a batch, and complex numbers for derivatives. SI units come in; all that
leaves is dimensionless.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from spline_model.basis import AxialModes, Bezier, SlideModes
from spline_model.compile import System
from spline_model.effects import Bending, Clamp, MixedStretching, Stretching
from spline_model.effects.elastic import Taper
from spline_model.scene import Scene
from spline_model.strip.element import (
    CURL,
    CURVATURE,
    DROP,
    FIRST,
    GROUNDED,
    MODES,
    ON_POINTS,
    PER_U,
    REACH,
    RIGIDITY,
    ROOT,
    SECOND,
    SPEED,
    STRAIN,
    STRETCHING,
    TIP,
    WHERE,
    Shape,
)

Array = NDArray[Any]  # real, or complex with a step

DIGITS = 12
"""Of b/L and t/L over those of the scene: what differs less has the same profile."""
ROUND_OFF = 1e-14
"""Difference of speeds along a strip, in its mean, that is none."""


class Numbers(NamedTuple):
    """What tells D designs of a scene from one another.

    points (D, S, n, 2) of the strips and centres (D, B, 2) of the bodies at rest [m]; longer, width,
    thickness, area, bending, axial (D, S): chord, sides and area of the sections, EI and EA over those of the
    scene [1].
    """

    points: Array
    centres: Array
    longer: Array
    width: Array
    thickness: Array
    area: Array
    bending: Array
    axial: Array

    @classmethod
    def of(cls, scene: Scene) -> Self:
        """The scene's own, D = 1."""
        same = np.ones((1, len(scene.strips)))
        return cls(
            points=np.array([[strip.control_points for strip in scene.strips]]),
            centres=np.array([[body.centre for body in scene.bodies]], dtype=float).reshape(1, -1, 2),
            **dict.fromkeys(("longer", "width", "thickness", "area", "bending", "axial"), same),
        )

    def over(self, length: Array) -> Self:
        """Return the same with points and centres over the length (D,) of each design [1]."""
        wide = length[:, None, None]
        return self._replace(points=self.points / wide[..., None], centres=self.centres / wide)


class Designs(NamedTuple):
    """Arrays of D designs, over the length (D,) [m] and energy (D,) [J] of each.

    along (D, S, G, 11 + K), numbers (D, S, 16 + 2 n) and compliance (D, S, K) as in ``Strips``; rest (D, S,
    G): curvature; to_modes (D, S, K, K): axial forces of the scene from those of the element; start (D, Y):
    at rest; force (D, 2, 3 B): load and weight as in ``Bodies``; target (D, H): change of the held
    coordinates; springs (D, 3 B, 3 B) as in ``Bodies``; levers (D, C, 2) of frames.
    """

    length: Array
    energy: Array
    along: Array
    rest: Array
    to_modes: Array
    numbers: Array
    compliance: Array
    start: Array
    force: Array
    target: Array
    springs: Array
    levers: Array


class Ends(NamedTuple):
    """Bodies (S,) at the strips' roots and tips, or GROUNDED; free ends are bodies behind those of the
    scene."""

    roots: NDArray[np.int64]
    tips: NDArray[np.int64]

    @classmethod
    def of(cls, scene: Scene) -> Self:
        """Those of a scene."""
        free, at = len(scene.bodies), {body.name: i for i, body in enumerate(scene.bodies)}
        held: dict[tuple[str, str], str] = {(c.strip, c.end): c.to for c in scene.of(Clamp)}
        found: dict[str, list[int]] = {"start": [], "end": []}
        for strip in scene.strips:
            for end, carriers in found.items():
                to = held.get((strip.name, end))
                carriers.append(free if to is None else at.get(to, GROUNDED))
                free += to is None
        return cls(*(np.array(carriers, dtype=np.int64) for carriers in found.values()))


def in_order(points: Array, shape: Shape) -> Array:
    """Return values at control points (..., n, k) in the order of elimination."""
    return np.asarray(points[..., shape.order, :])


@lru_cache(maxsize=64)
def shape_of(basis: Bezier, points: int) -> Shape:
    """Return the basis at the Gauss points."""
    return shape_at(basis, *basis.gauss_rule(points))


def shape_at(basis: Bezier, u: NDArray[np.float64], weight: NDArray[np.float64]) -> Shape:
    """Return the basis at any points u (P,) with weights."""
    n = basis.control_points
    order = np.array([*range(2, n - 2), 1, n - 2, n - 1, 0], dtype=np.int64)
    whole = np.ones(1)
    values = [basis.evaluate(u, k) for k in range(3)]
    values += [basis.areas(whole, power) - basis.areas(u, power) for power in range(3)]
    tables = np.ascontiguousarray(np.array(values)[:, :, order])
    return Shape.of(order, tables, np.array((u, weight)))


def arrays_of(
    system: System, shape: Shape, ends: Ends, given: Numbers, length: Array, energy: Array
) -> Designs:
    """Return the arrays of D designs of a system's scene, over lengths (D,) [m] and energies (D,) [J]."""
    given = given.over(length)
    along, rest, to_modes = along_of(system, shape, shape, given, length, energy)
    return Designs(
        length=length,
        energy=energy,
        along=along,
        rest=rest,
        to_modes=to_modes,
        numbers=_numbers(system, shape, ends, given, energy / length),
        compliance=_compliances(system.scene, given) * (energy / length)[:, None, None],
        start=_starts(system.scene, ends, given, to_modes.shape[-1]),
        force=_forces(system, ends, length, energy),
        target=system.drives.target / np.where(system.drives.turns == 1, 1.0, length[:, None]),
        springs=_springs(system, length, energy),
        levers=_levers(system, given),
    )


def _bends_of(scene: Scene) -> list[Bending]:
    """The bending of each strip."""
    bends = {e.strip: e for e in scene.of(Bending)}
    return [bends[strip.name] for strip in scene.strips]


def _mixed_of(scene: Scene) -> list[list[MixedStretching]]:
    """The mixed stretching of each strip, a part for each kind of modes."""
    mixed: dict[str, list[MixedStretching]] = {strip.name: [] for strip in scene.strips}
    for effect in scene.of(MixedStretching):
        mixed[effect.strip].append(effect)
    return list(mixed.values())


def along_of(
    system: System, shape: Shape, gauss: Shape, given: Numbers, length: Array, energy: Array
) -> tuple[Array, Array, Array]:
    """Return what changes along the strips (D, S, P, 11 + K), curvature at rest (D, S, P) and ``to_modes``.

    given: over their lengths; shape: at whose points; gauss: at whose points ``to_modes`` (D, S, K, K) makes
    modes orthonormal.
    """
    scene, degree = system.scene, system.scene.strips[0].basis.degree
    bends, parts, u = _bends_of(scene), _mixed_of(scene), shape.rule[WHERE]
    points = in_order(given.points, shape)[:, :, None]
    speed, rest = _speeds(points, shape)
    at_gauss = speed if shape is gauss else _speeds(points, gauss)[0]
    to_modes = _orthonormal_modes(parts, scene.strips[0].basis, at_gauss)
    along = np.zeros((*speed.shape, MODES + to_modes.shape[-1]), dtype=speed.dtype)
    along[..., SPEED], along[..., CURVATURE] = speed, rest
    stiffer = given.bending / (energy * length)[:, None]
    for s, bend in enumerate(bends):
        row = along[:, s]
        row[..., CURVATURE] += bend.natural_curvature * length[:, None]
        row[..., RIGIDITY] = bend.rigidity_at(degree, u) * stiffer[:, s, None]
        if bend.curl is not None:
            row[..., DROP:MODES] = bend.curl.drop(degree, u)
            curl = bend.curl.flattening * given.width[:, s] ** 2 / given.thickness[:, s]
            row[..., CURL] = (curl / length)[:, None]
        if parts[s]:
            modes = _values(tuple(e.modes for e in parts[s]), u.tobytes())
            row[..., MODES:] = modes @ to_modes[:, s]
        if (any(bend.roots) or (bend.curl and bend.curl.clamped)) and _are_other(given):
            _add_profiles(bend, row, given, s, degree, u, stiffer[:, s])
    return along, rest, to_modes


def _are_other(given: Numbers) -> bool:
    """Whether any design has another b/L or t/L than the scene."""
    return any((part != 1.0).any() for part in (given.longer, given.width, given.thickness))


def _add_profiles(
    bend: Bending, row: Array, given: Numbers, s: int, degree: int, u: NDArray[np.float64], stiffer: Array
) -> None:
    """Rigidity and drop of the designs (D, P, 11 + K) of strip s, whose profile goes by b/L and t/L."""
    sides = np.stack((given.width, given.thickness))[..., s] / given.longer[:, s]
    sides += np.round(sides.real, DIGITS) - sides.real
    for d, (width, thickness) in enumerate(sides.T):
        own = bend.with_sides(width, thickness)
        row[d, :, RIGIDITY] = own.rigidity_at(degree, u) * stiffer[d]
        if own.curl:
            row[d, :, DROP:MODES] = own.curl.drop(degree, u)


def _speeds(points: Array, shape: Shape) -> tuple[Array, Array]:
    """Speed and curvature (D, S, P) [1] at rest of curves of points (D, S, 1, n, 2)."""
    curve = shape.tables[FIRST : SECOND + 1] @ points
    x1, x2, y1, y2 = (curve[:, :, order, :, axis] for axis in range(2) for order in range(2))
    square = x1 * x1 + y1 * y1
    speed = np.sqrt(square)
    return speed, (x1 * y2 - y1 * x2) / (square * speed)


def _compliances(scene: Scene, given: Numbers) -> Array:
    """Compliances (D, S, K) [1/N] of the axial forces; those of sliding go by the bending of the chord."""
    stretched, slid = 1.0 / given.axial, given.longer**2 / given.bending
    parts = [[part for part in each for _ in range(part.modes.count)] for each in _mixed_of(scene)]
    soft = np.array([[part.axial_compliance for part in each] for each in parts])
    slides = [isinstance(part.modes, SlideModes) for part in parts[0]]
    return np.asarray(soft * np.where(slides, slid[..., None], stretched[..., None]))


def _numbers(system: System, shape: Shape, ends: Ends, given: Numbers, force: Array) -> Array:
    """The numbers of ``Strips`` of each design (D, S, 16 + 2 n)."""
    scene, points = system.scene, given.points
    numbers = np.zeros((*points.shape[:2], ON_POINTS + 2 * len(shape.order)), dtype=points.dtype)
    mixed = {e.strip: e for e in reversed(scene.of(MixedStretching))}
    consistent = {e.strip: e for e in scene.of(Stretching)}
    for s, strip in enumerate(scene.strips):
        if strip.name in mixed:
            numbers[:, s, STRAIN] = mixed[strip.name].natural_strain
        if strip.name in consistent:
            own = consistent[strip.name]
            numbers[:, s, STRAIN] = own.natural_strain
            numbers[:, s, STRETCHING] = own.axial_rigidity * given.axial[:, s] / force
    chords = points[:, :, 1] - points[:, :, 0], points[:, :, -1] - points[:, :, -2]
    for end, (place, carriers, chord) in enumerate(zip((ROOT, TIP), ends, chords, strict=True)):
        numbers[..., place : place + 2] = points[:, :, -end]
        for s, body in enumerate(carriers.tolist()):
            if body >= len(scene.bodies):
                numbers[:, s, place : place + 2] = 0.0
            elif body >= 0:
                numbers[:, s, place : place + 2] -= given.centres[:, body]
        numbers[..., place + 2] = _angle(chord[..., 0], chord[..., 1])
        numbers[..., REACH + end] = np.sqrt(np.sum(chord**2, axis=-1))
    if system.weight.size:
        heavier = given.area * given.longer / force[:, None]
        for s, strip in enumerate(scene.strips):
            dead = system.weight[system.layout.strip(strip.name)].reshape(-1, 2)
            dead = np.concatenate((scene.weight_of(strip.name).ravel(), in_order(dead, shape).ravel()))
            numbers[:, s, PER_U:] = dead * heavier[:, s, None]
    return numbers


def _angle(x: Array, y: Array) -> Array:
    """Direction [rad] of vectors, exact to first order in what is along the imaginary axis."""
    angle: Array = np.arctan2(y.real, x.real)
    if not np.iscomplexobj(x):
        return angle
    cos, sin = np.cos(angle), np.sin(angle)
    return np.asarray(angle + (y * cos - x * sin) / (x * cos + y * sin))


def _starts(scene: Scene, ends: Ends, given: Numbers, modes: int) -> Array:
    """States at rest (D, Y): poses, free ends among them, and of each strip points, reaches and forces."""
    count = len(given.points)
    bodies, strips = range(len(scene.bodies)), range(len(scene.strips))
    turn, reach, forces = np.zeros((count, 1)), np.ones((count, 2)), np.zeros((count, modes))
    parts = [part for b in bodies for part in (given.centres[:, b], turn)]
    for s in strips:
        for at, carriers in ((0, ends.roots), (-1, ends.tips)):
            if carriers[s] >= len(bodies):
                parts += [given.points[:, s, at], turn]
    for s in strips:
        parts += [given.points[:, s, 2:-2].reshape(count, -1), reach, forces]
    return np.concatenate(parts, axis=1)


def _units(bodies: int, length: Array) -> Array:
    """Units of the poses of so many bodies (D, 3 B) [m, rad]."""
    unit = np.ones((len(length), bodies, 3))
    unit[:, :, :2] = length[:, None, None]
    return unit.reshape(len(length), -1)


def _forces(system: System, ends: Ends, length: Array, energy: Array) -> Array:
    """Load and weight on the bodies (D, 2, 3 B)."""
    poses, loads = system.layout.poses, system.loads
    bodies = max(len(system.scene.bodies), 1 + max(ends.roots.max(), ends.tips.max()))
    force = np.zeros((2, 3 * bodies))
    if loads.value.size:
        np.add.at(force[0], loads.coordinate - poses.start, loads.value)
    if system.weight.size:
        force[1, : poses.stop - poses.start] = system.weight[poses]
    return np.asarray(force * (_units(bodies, length) / energy[:, None])[:, None])


def _springs(system: System, length: Array, energy: Array) -> Array:
    """Springs of each design (D, 3 B, 3 B), or (D, 0, 0)."""
    if not system.springs.size:
        return np.zeros((len(length), 0, 0))
    unit = _units(len(system.springs) // 3, length)
    return np.asarray(system.springs * (unit[:, :, None] * unit[:, None] / energy[:, None, None]))


def _levers(system: System, given: Numbers) -> Array:
    """Levers of frames (D, C, 2) from the centres of the bodies that carry them."""
    begin, frames = system.layout.poses.start, system.frames.place.tolist()
    levers = np.zeros((len(given.points), len(frames), 2), dtype=given.points.dtype)
    for f, (at, by, _) in enumerate(frames):
        levers[:, f] = given.centres[:, (at - begin) // 3]
        if by >= 0:
            levers[:, f] -= given.centres[:, (by - begin) // 3]
    return levers


def _orthonormal_modes(parts: list[list[MixedStretching]], basis: Bezier, speed: Array) -> Array:
    """The scene's axial forces (D, S, K, K) by those of modes that are orthonormal along strips of a speed
    (D, S, G), weighed by their compliance over that at the start.

    Those of one distribution of the speed are kept: all straight strips have the same, but for round-off.
    Designs have that of the first.
    """
    mean = speed.sum(axis=-1, keepdims=True) / speed.shape[-1]
    alike = np.rint((speed[0] / mean[0]).real / ROUND_OFF)
    kinds = [tuple((e.modes, e.taper) for e in each) for each in parts]
    found = [_modes_of(each, basis, len(v), v.tobytes()) for each, v in zip(kinds, alike, strict=True)]
    return np.asarray(np.array(found) / np.sqrt(mean)[..., None])


@lru_cache(maxsize=64)
def _values(parts: tuple[AxialModes, ...], at: bytes) -> NDArray[np.float64]:
    """Values of the scene's modes at the numbers of a buffer (P, K)."""
    return np.column_stack([modes.evaluate(np.frombuffer(at)) for modes in parts])


@lru_cache(maxsize=64)
def _modes_of(
    parts: tuple[tuple[AxialModes, Taper | None], ...], basis: Bezier, points: int, speed: bytes
) -> NDArray[np.float64]:
    """The same of one strip of mean speed 1; speed: in ``ROUND_OFF``."""
    u, weight = basis.gauss_rule(points)
    weight = weight * (ROUND_OFF * np.frombuffer(speed))
    back = np.zeros((0, 0))
    for modes, taper in parts:
        full, to_part = modes.evaluate(u), np.eye(modes.count)
        soft = weight if taper is None else weight / taper.area(u)
        if not isinstance(modes, SlideModes):  # the mean first
            to_part[:, 0] = np.linalg.lstsq(full, np.ones(len(u)), rcond=None)[0]
            full = full @ to_part
        factor = np.linalg.cholesky(full.T @ (soft[:, None] * full))
        k, m = len(back), modes.count
        back = np.block([[back, np.zeros((k, m))], [np.zeros((m, k)), to_part @ np.linalg.inv(factor).T]])
    return back
