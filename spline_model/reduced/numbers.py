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
from spline_model.scene import Scene
from spline_model.strip.compiled import called, copy, kernel
from spline_model.strip.element import (
    CURL,
    CURVATURE,
    DROP,
    FIRST,
    GROUNDED,
    MODES,
    PER_U,
    REACH,
    RIGIDITY,
    ROOT,
    SECOND,
    SPEED,
    STRAIN,
    STRETCHING,
    TIP,
    WEIGHT,
    WHERE,
    Shape,
)

Array = NDArray[Any]  # real, or complex with a step
Places = NDArray[np.int64]

DIGITS = 12
"""Of b/L and t/L over those of the scene: what differs less has the same profile."""


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
        points = np.array([[strip.control_points for strip in scene.strips]])
        centres = np.array([[body.centre for body in scene.bodies]], dtype=float).reshape(1, -1, 2)
        return cls(points, centres, same, same, same, same, same, same)


class Designs(NamedTuple):
    """Arrays of D designs, over the length (D,) [m] and energy (D,) [J] of each.

    along (D, S, P, 11 + K), numbers (D, S, 16 + 2 n) and compliance (D, S, K) as in ``Strips``; rest (D, S,
    P): curvature; to_modes (D, S, K, K): axial forces of the scene from those of the element, whose modes are
    orthonormal, weighed by their compliance over that at the start; start (D, Y): at rest; force (D, 2, 3 B):
    load and weight as in ``Bodies``; target (D, H): change of the held coordinates; springs (D, 3 B, 3 B) as
    in ``Bodies``; levers (D, C, 2) of frames.
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

    roots: Places
    tips: Places

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


class _Common(NamedTuple):
    """What all designs of a scene have in common, in SI units, by the places of what it becomes.

    along (1 or D, S, P, 11 + K): stress-free curvature over that at rest, EI, numbers of the curl, modes of
    the scene's axial forces, of which ``split`` are none of sliding; modes (G, K) at the Gauss points, and
    weights (S, 2, G) of those of stretching, over the area of the section, and of those of sliding;
    compliance (S, K); numbers (S, 16 + 2 n): EA and strain of stretching, dead loads; force (2, 3 B); target,
    turns (H,); springs; frames (C, 3) among the poses; bodies: B without free ends.
    """

    along: Array
    modes: Array
    weight: Array
    split: int
    compliance: Array
    numbers: Array
    force: Array
    target: Array
    turns: Places
    springs: Array
    frames: Places
    bodies: int


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
    system: System, shape: Shape, gauss: Shape, ends: Ends, given: Numbers, length: Array, energy: Array
) -> Designs:
    """Return the arrays of D designs of a system's scene, over lengths (D,) [m] and energies (D,) [J].

    shape: at whose points; gauss: at whose points modes are made orthonormal.
    """
    given = Numbers._make(map(np.ascontiguousarray, given))
    common = _common_of(system, shape, gauss, ends, given)
    (count, strips, n), kind = given.points.shape[:3], given.points.dtype
    points, modes, bodies = shape.rule.shape[1], common.modes.shape[1], common.force.shape[1] // 3
    shapes = (
        (count, strips, points, MODES + modes),
        (count, strips, points),
        (count, strips, modes, modes),
        (count, *common.numbers.shape),
        (count, strips, modes),
        (count, 3 * bodies + strips * (2 * n - 6 + modes)),
    )
    filled: list[Array] = [np.empty(each, dtype=kind) for each in shapes]
    filled += [np.empty((count, *each.shape)) for each in (common.force, common.target, common.springs)]
    filled.append(np.empty((count, len(common.frames), 2), dtype=kind))
    own = Designs._make((length, energy, *filled))
    _fill(given, common, ends, shape, gauss, own)
    return own


def _common_of(system: System, shape: Shape, gauss: Shape, ends: Ends, given: Numbers) -> _Common:
    """What designs have in common; the profiles of sections that have others are each design's own."""
    scene, u, layout = system.scene, shape.rule[WHERE], system.layout
    parts: dict[str, list[MixedStretching]] = {strip.name: [] for strip in scene.strips}
    for effect in scene.of(MixedStretching):
        parts[effect.strip].append(effect)
    bends, stretches = {e.strip: e for e in scene.of(Bending)}, {e.strip: e for e in scene.of(Stretching)}
    kinds = [e.modes for e in parts[scene.strips[0].name]]
    modes = _values(tuple(kinds), u.tobytes())
    along = np.zeros((1, len(parts), len(u), MODES + modes.shape[1]))
    along[..., MODES:] = modes
    numbers = np.zeros((len(parts), PER_U + 6 + 2 * len(shape.order)))
    weight = np.empty((len(parts), 2, gauss.rule.shape[1]))
    weight[:] = gauss.rule[WEIGHT]
    compliance = np.empty((len(parts), modes.shape[1]))
    for s, strip in enumerate(scene.strips):
        _add_profile(bends[strip.name], strip.basis.degree, u, along[0, s])
        done = 0
        for part in parts[strip.name]:
            compliance[s, done : done + part.modes.count] = part.axial_compliance
            done += part.modes.count
            if part.taper is not None:
                weight[s, 0] = gauss.rule[WEIGHT] / part.taper.area(gauss.rule[WHERE])
        if parts[strip.name]:
            numbers[s, STRAIN] = parts[strip.name][0].natural_strain
        if (consistent := stretches.get(strip.name)) is not None:
            numbers[s, STRAIN], numbers[s, STRETCHING] = consistent.natural_strain, consistent.axial_rigidity
        if system.weight.size:
            dead = in_order(system.weight[layout.strip(strip.name)].reshape(-1, 2), shape)
            numbers[s, PER_U:] = np.concatenate((scene.weight_of(strip.name).ravel(), dead.ravel()))
    return _Common(
        along=_own_profiles([bends[strip.name] for strip in scene.strips], along, given, u),
        modes=modes if shape is gauss else _values(tuple(kinds), gauss.rule[WHERE].tobytes()),
        weight=weight,
        split=sum(kind.count for kind in kinds if not isinstance(kind, SlideModes)),
        compliance=compliance,
        numbers=numbers,
        force=_forces(system, ends),
        target=system.drives.target,
        turns=system.drives.turns,
        springs=system.springs,
        frames=system.frames.among(layout.poses.start, 1.0).place,
        bodies=len(scene.bodies),
    )


def _add_profile(bend: Bending, degree: int, u: NDArray[np.float64], row: Array) -> None:
    """What a strip's bending is along it (P, 11 + K)."""
    row[:, CURVATURE], row[:, RIGIDITY] = bend.natural_curvature, bend.rigidity_at(degree, u)
    if bend.curl is not None:
        row[:, CURL], row[:, DROP:MODES] = bend.curl.flattening, bend.curl.drop(degree, u)


def _own_profiles(bends: list[Bending], along: Array, given: Numbers, u: NDArray[np.float64]) -> Array:
    """The same of each design (D, S, P, 11 + K) where a profile goes by b/L and t/L, and these differ."""
    along = along.astype(given.points.dtype, copy=False)
    profiled = [s for s, bend in enumerate(bends) if any(bend.roots) or (bend.curl and bend.curl.clamped)]
    ratios = given.longer, given.width, given.thickness
    if not profiled or all((ratio == 1.0).all() for ratio in ratios):
        return along
    along = np.repeat(along, len(given.longer), axis=0)
    for s in profiled:
        sides = np.stack((given.width, given.thickness))[..., s] / given.longer[:, s]
        sides += np.round(sides.real, DIGITS) - sides.real
        for d, (width, thickness) in enumerate(sides.T):
            _add_profile(bends[s].with_sides(width, thickness), given.points.shape[2] - 1, u, along[d, s])
    return along


def _forces(system: System, ends: Ends) -> Array:
    """Load and weight on the bodies (2, 3 B), free ends among them [N, N m]."""
    poses, loads = system.layout.poses, system.loads
    force = np.zeros((2, 3 * max(len(system.scene.bodies), 1 + max(ends.roots.max(), ends.tips.max()))))
    if loads.value.size:
        np.add.at(force[0], loads.coordinate - poses.start, loads.value)
    if system.weight.size:
        force[1, : poses.stop - poses.start] = system.weight[poses]
    return force


@lru_cache(maxsize=64)
def _values(parts: tuple[AxialModes, ...], at: bytes) -> NDArray[np.float64]:
    """Values of the scene's modes at the numbers of a buffer (P, K)."""
    u = np.frombuffer(at)
    return np.column_stack([np.zeros((len(u), 0)), *(modes.evaluate(u) for modes in parts)])


@called()
def _add_modes(d, s, given, common, gauss, own):
    """Axial forces of the scene from those of modes that are orthonormal at the Gauss points, those of
    stretching and of sliding each among themselves: with Cholesky's factor L of their products, L^-T."""
    points, m = given.points[d, s], own.to_modes[d, s]
    count, length = m.shape[0], own.length[d]
    for i in range(count):
        for j in range(count):
            m[i, j] = 0.0
    for p in range(common.modes.shape[0]):
        x, y, _, _ = _derivatives(p, points, gauss)
        speed = np.sqrt(x * x + y * y) / length
        for i in range(count):
            weight = speed * common.weight[s, int(i >= common.split), p]
            for j in range(i + 1):
                if (i < common.split) == (j < common.split):
                    m[i, j] += weight * common.modes[p, i] * common.modes[p, j]
    for j in range(count):
        for k in range(j):
            for i in range(j, count):
                m[i, j] -= m[i, k] * m[j, k]
        root = np.sqrt(m[j, j])
        for i in range(j, count):
            m[i, j] /= root
    for j in range(count):
        m[j, j] = 1.0 / m[j, j]
        for i in range(j + 1, count):
            total = m[i, j] * m[j, j]
            for k in range(j + 1, i):
                total += m[i, k] * m[k, j]
            m[i, j] = -total / m[i, i]
    for j in range(count):
        for i in range(j):
            m[i, j], m[j, i] = m[j, i], m[i, j]


@called()
def _derivatives(p, points, shape):
    """x', y', x'', y'' of a curve at a point of the shape."""
    x1 = y1 = x2 = y2 = points[0, 0] * 0.0
    for i in range(shape.order.size):
        x, y = points[shape.order[i], 0], points[shape.order[i], 1]
        first, second = shape.tables[FIRST, p, i], shape.tables[SECOND, p, i]
        x1 += first * x
        y1 += first * y
        x2 += second * x
        y2 += second * y
    return x1, y1, x2, y2


@called()
def _add_along(d, s, given, common, shape, own):
    """What changes along a strip, behind ``_add_modes``."""
    length, energy, to_modes = own.length[d], own.energy[d], own.to_modes[d, s]
    width, thickness, bending = given.width[d, s], given.thickness[d, s], given.bending[d, s]
    for p in range(own.rest.shape[2]):
        row, source = own.along[d, s, p], common.along[d % common.along.shape[0], s, p]
        x1, y1, x2, y2 = _derivatives(p, given.points[d, s], shape)
        square = x1 * x1 + y1 * y1
        speed = np.sqrt(square)
        own.rest[d, s, p] = length * (x1 * y2 - y1 * x2) / (square * speed)
        row[SPEED] = speed / length
        row[CURVATURE] = own.rest[d, s, p] + source[CURVATURE] * length
        row[RIGIDITY] = source[RIGIDITY] * bending / (energy * length)
        row[CURL] = source[CURL] * width * width / (thickness * length)
        for i in range(DROP, MODES):
            row[i] = source[i]
        for k in range(to_modes.shape[0]):
            row[MODES + k] = 0.0
            for i in range(k + 1):
                row[MODES + k] += source[MODES + i] * to_modes[i, k]


@called()
def _add_end(d, s, body, place, end, given, common, own):
    """Point and direction of an end of a strip in the frame of its body, and its reach; of a free end the
    body's place at rest."""
    points, numbers, length = given.points[d, s], own.numbers[d, s], own.length[d]
    outer = (points.shape[0] - 1) * end
    inner, sign = outer + 1 - 2 * end, 1.0 - 2.0 * end
    x, y = sign * (points[inner, 0] - points[outer, 0]), sign * (points[inner, 1] - points[outer, 1])
    angle = np.arctan2(y.real, x.real)
    cos, sin = np.cos(angle), np.sin(angle)
    numbers[place + 2] = angle + (y * cos - x * sin) / (x * cos + y * sin)  # of a complex step as well
    numbers[REACH + end] = np.sqrt(x * x + y * y) / length
    for k in range(2):
        point = points[outer, k] / length
        if body >= common.bodies:
            own.start[d, 3 * body + k] = point
            point *= 0.0
        elif body >= 0:
            point -= given.centres[d, body, k] / length
        numbers[place + k] = point


@called()
def _add_bodies(d, given, common, own):
    """What holds and loads the bodies, and where they are at rest."""
    length, energy, frames = own.length[d], own.energy[d], common.frames
    for i in range(common.force.shape[1]):
        unit = length if i % 3 < 2 else 1.0
        own.start[d, i] = 0.0
        if i < 3 * common.bodies and i % 3 < 2:
            own.start[d, i] = given.centres[d, i // 3, i % 3] / length
        for k in range(2):
            own.force[d, k, i] = common.force[k, i] * unit / energy
    for i in range(common.springs.shape[0]):
        for j in range(common.springs.shape[0]):
            unit = (length if i % 3 < 2 else 1.0) * (length if j % 3 < 2 else 1.0)
            own.springs[d, i, j] = common.springs[i, j] * unit / energy
    for h in range(common.target.size):
        own.target[d, h] = common.target[h] / (1.0 if common.turns[h] == 1 else length)
    for f in range(frames.shape[0]):
        for k in range(2):
            own.levers[d, f, k] = given.centres[d, frames[f, 0] // 3, k] / length
            if frames[f, 1] >= 0:
                own.levers[d, f, k] -= given.centres[d, frames[f, 1] // 3, k] / length


@kernel()
def _fill(given, common, ends, shape, gauss, own):
    """Fill the arrays of all designs."""
    modes, n = common.modes.shape[1], given.points.shape[2]
    for d in range(own.length.size):
        _add_bodies(d, given, common, own)
        length, force = own.length[d], own.energy[d] / own.length[d]
        for s in range(ends.roots.size):
            _add_modes(d, s, given, common, gauss, own)
            _add_along(d, s, given, common, shape, own)
            numbers, slid = own.numbers[d, s], given.longer[d, s] ** 2 / given.bending[d, s]
            copy(common.numbers[s], numbers)
            numbers[STRETCHING] *= given.axial[d, s] / force
            for i in range(PER_U, numbers.size):
                numbers[i] *= given.area[d, s] * given.longer[d, s] / force
            _add_end(d, s, ends.roots[s], ROOT, 0, given, common, own)
            _add_end(d, s, ends.tips[s], TIP, 1, given, common, own)
            at = common.force.shape[1] + s * (2 * n - 6 + modes)
            for i in range(2 * n - 8):
                own.start[d, at + i] = given.points[d, s, 2 + i // 2, i % 2] / length
            own.start[d, at + 2 * n - 8] = own.start[d, at + 2 * n - 7] = 1.0
            for k in range(modes):
                softer = slid if k >= common.split else 1.0 / given.axial[d, s]
                own.compliance[d, s, k] = common.compliance[s, k] * softer * force
                own.start[d, at + 2 * n - 6 + k] = 0.0
