"""Many designs of one mechanism: what their numbers make of what its elements know."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.design import Design
from spline_model.reduced.model import Reduced, at_rest
from spline_model.strip.element import PER_U, REACH, ROOT, SPRING, STRETCHING, TIP

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Given:
    """D designs of S strips and B bodies: ends (D, S, 2, 2) at rest, root and tip, and centres (D, B, 2) [m];
    section (D, S, 3): area [m^2], second moment [m^4] and modulus [Pa].
    """

    ends: Array
    centres: Array
    section: Array

    @classmethod
    def of(cls, design: Design) -> Given:
        """One design."""
        strips, bodies = design.strips, design.bodies
        section = [(s.area, s.second_moment_of_area, s.youngs_modulus) for s in strips]
        return cls(
            ends=np.array([[(s.start, s.end) for s in strips]], dtype=float),
            centres=np.array([body.centre for body in bodies], dtype=float).reshape(1, -1, 2),
            section=np.array([section]),
        )

    @property
    def chord(self) -> Array:
        """From root to tip, as complex numbers (D, S) [m]."""
        chord = self.ends[:, :, 1] - self.ends[:, :, 0]
        return np.asarray(chord[..., 0] + 1j * chord[..., 1])

    @property
    def rigidity(self) -> Array:
        """EI (D, S) [N m^2]."""
        return np.asarray(self.section[..., 1] * self.section[..., 2])

    @property
    def width(self) -> Array:
        """Width of the rectangle with that section (D, S) [m]."""
        return np.asarray(self.section[..., 0] ** 1.5 / np.sqrt(12.0 * self.section[..., 1]))

    @property
    def thickness(self) -> Array:
        """Thickness of that rectangle (D, S) [m]."""
        return np.asarray(self.section[..., 0] / self.width)

    @property
    def compliance(self) -> Array:
        """Axial compliance of each strip over the longest strip and the largest rigidity, (D, S)."""
        length = np.abs(self.chord).max(axis=1)[:, None]
        stiffness = self.section[..., 0] * self.section[..., 2] * length**2
        return np.asarray(self.rigidity.max(axis=1)[:, None] / stiffness)

    def rows(self, kept: NDArray[np.int64]) -> Given:
        """Some of the designs."""
        return Given(ends=self.ends[kept], centres=self.centres[kept], section=self.section[kept])


class Designs(NamedTuple):
    """What tells D designs from one another, over the length (D,) [m] and energy (D,) [J] of each.

    factor (D, S, 6): of J0, stress-free curvature, EI, the numbers of ``curl_law`` and modes; numbers (D, S,
    14 + 2 n) and compliance (D, S, K) as in ``Strips``; start (D, Y): at rest; force (D, 2, 3 B): load and
    weight as in ``Bodies``; target (D, H): change of the held coordinates.
    """

    length: Array
    energy: Array
    factor: Array
    numbers: Array
    compliance: Array
    start: Array
    force: Array
    target: Array


def designs_of(model: Reduced, base: Given, given: Given, rotation: Array) -> Designs:
    """Designs of the mechanism that ``model`` is of, whose own numbers are ``base``, to rotations (D,) [rad].

    Strips keep their form at rest: they are turned and lengthened with their chords.
    """
    strips, bodies, scene = model.strips, model.bodies, model.system.scene
    count, own = len(given.ends), len(scene.bodies)
    length = np.abs(given.chord).max(axis=1)
    energy = given.rigidity.max(axis=1) / length
    turn = given.chord / base.chord
    longer, wide = np.abs(turn), length[:, None]
    force = (energy / length)[:, None] * (model.length / model.energy)
    area, _, modulus = np.moveaxis(given.section / base.section, -1, 0)
    speed = longer * (model.length / wide)
    thicker = given.thickness / base.thickness
    rigid = given.rigidity / base.rigidity / (energy * length)[:, None] * (model.energy * model.length)
    numbers = np.repeat(strips.numbers[None], count, axis=0)
    numbers[..., STRETCHING] *= area * modulus / force
    numbers[..., PER_U:] *= (area * longer / force)[..., None]
    numbers[..., REACH:SPRING] *= speed[..., None]
    springs = given.rigidity / base.rigidity / thicker * (model.energy / energy)[:, None]
    numbers[..., SPRING:PER_U] *= springs[..., None]
    for end, (place, carriers) in enumerate(((ROOT, strips.roots), (TIP, strips.tips))):
        numbers[..., place + 2] += np.angle(turn)
        for s, body in enumerate(carriers):
            if body < own:
                origin = given.centres[:, body] if body >= 0 else 0.0
                numbers[:, s, place : place + 2] = (given.ends[:, s, end] - origin) / wide
    slide = longer**2 / (given.rigidity / base.rigidity)
    soft = np.stack((1.0 / (area * modulus), slide), axis=-1) * force[..., None]
    which = (np.arange(strips.compliance.shape[1]) >= strips.split).astype(int)
    start = np.repeat(at_rest(model)[None], count, axis=0)
    for body in range(own):
        start[:, 3 * body : 3 * body + 2] = given.centres[:, body] / wide
    for s, strip in enumerate(scene.strips):
        w, inner = model.places(s)[0], strip.control_points[2:-2] - base.ends[0, s, 0]
        moved = turn[:, s, None] * (inner[:, 0] + 1j * inner[:, 1])
        points = (np.stack((moved.real, moved.imag), axis=-1) + given.ends[:, s, None, 0]) / wide[..., None]
        start[:, w.start + 2 * model.yields : w.stop - 2] = points.reshape(count, -1)
        for end, carriers in enumerate((strips.roots, strips.tips)):
            if carriers[s] >= own:  # a free end is its own body
                place = 3 * carriers[s]
                start[:, place : place + 2] = given.ends[:, s, end] / wide
    shares = np.concatenate((1.0 / force, 1.0 / force, model.energy / energy[:, None]), axis=1)
    shares = np.tile(shares, len(bodies.rest) // 3)
    target = np.repeat(model.drives[1][None], count, axis=0) * np.where(
        model.system.drives.turns == 1, 1.0, model.length / wide
    )
    if bodies.driven >= 0:
        target[:, bodies.driven] = rotation
    return Designs(
        length=length,
        energy=energy,
        factor=np.stack(
            (
                speed,
                np.broadcast_to(wide / model.length, speed.shape),
                rigid,
                np.ones_like(speed),
                (given.width / base.width) ** 2 / thicker * (model.length / wide),
                speed**-0.5,
            ),
            axis=-1,
        ),
        numbers=numbers,
        compliance=strips.compliance * soft[..., which],
        start=start,
        force=np.stack((bodies.load, bodies.weight))[:, : len(bodies.rest)] * shares[:, None],
        target=target,
    )
