"""Many designs of one mechanism by the numbers that tell them apart, and what these make of its elements."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from spline_model.compile import compile_scene
from spline_model.design import Design
from spline_model.errors import InvalidParameter
from spline_model.mechanism import Mechanism
from spline_model.pivot import cross_axis_pivot
from spline_model.reduced.many import Designs
from spline_model.reduced.model import Reduced, at_rest
from spline_model.sensitivity.parameters import CENTRES, MATERIAL, POINTS, SECTION, Section, place_of
from spline_model.strip.element import PER_U, REACH, ROOT, STRETCHING, TIP

Array = NDArray[np.float64]

POSITIVE = ("length", "area", "second_moment_of_area", "youngs_modulus")
"""Columns that statics reads and that must be above zero; the others are checked on the first design."""


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


def designs_of(model: Reduced, base: Given, given: Given, rotation: Array) -> Designs:
    """Designs of the mechanism that ``model`` is of, whose own numbers are ``base``, to rotations (D,) [rad].

    Strips keep their form at rest: they are turned and lengthened with their chords.
    """
    strips, bodies, count = model.strips, model.bodies, len(given.ends)
    length = np.abs(given.chord).max(axis=1)
    energy = given.rigidity.max(axis=1) / length
    turn = given.chord / base.chord
    longer, wide = np.abs(turn), length[:, None]
    speed = longer * (model.length / wide)
    stiffer, thicker = given.rigidity / base.rigidity, given.thickness / base.thickness
    rigid = stiffer / (energy * length)[:, None] * (model.energy * model.length)
    force = (energy / length)[:, None] * (model.length / model.energy)
    area, _, modulus = np.moveaxis(given.section / base.section, -1, 0)
    soft = np.stack((1.0 / (area * modulus), longer**2 / stiffer), axis=-1) * force[..., None]
    which = (np.arange(strips.compliance.shape[1]) >= strips.split).astype(int)
    shares = np.concatenate((1.0 / force, 1.0 / force, model.energy / energy[:, None]), axis=1)
    shares = np.tile(shares, len(bodies.rest) // 3)
    target = np.repeat(model.drives[1][None], count, axis=0) * np.where(
        model.system.drives.turns == 1, 1.0, model.length / wide
    )
    if bodies.driven >= 0:
        target[:, bodies.driven] = rotation
    curvature, ones = np.broadcast_to(wide / model.length, speed.shape), np.ones_like(speed)
    curl = (given.width / base.width) ** 2 / thicker * (model.length / wide)
    return Designs(
        length=length,
        energy=energy,
        factor=np.stack((speed, curvature, rigid, ones, curl, speed**-0.5), axis=-1),
        numbers=_numbers(model, base, given, energy, wide),
        compliance=strips.compliance * soft[..., which],
        start=_starts(model, base, given, turn, wide),
        force=np.stack((bodies.load, bodies.weight))[:, : len(bodies.rest)] * shares[:, None],
        target=target,
    )


def _numbers(model: Reduced, base: Given, given: Given, energy: Array, wide: Array) -> Array:
    """The numbers of ``Strips`` of each design (D, S, 12 + 2 n), by its energy (D,) and length (D, 1)."""
    strips, turn = model.strips, given.chord / base.chord
    force = energy[:, None] / wide * (model.length / model.energy)
    area, _, modulus = np.moveaxis(given.section / base.section, -1, 0)
    numbers = np.repeat(strips.numbers[None], len(given.ends), axis=0)
    numbers[..., STRETCHING] *= area * modulus / force
    numbers[..., PER_U:] *= (area * np.abs(turn) / force)[..., None]
    numbers[..., REACH:PER_U] *= (np.abs(turn) * (model.length / wide))[..., None]
    for end, (place, carriers) in enumerate(((ROOT, strips.roots), (TIP, strips.tips))):
        numbers[..., place + 2] += np.angle(turn)
        for s, body in enumerate(carriers):
            if body < given.centres.shape[1]:
                origin = given.centres[:, body] if body >= 0 else 0.0
                numbers[:, s, place : place + 2] = (given.ends[:, s, end] - origin) / wide
    return numbers


def _starts(model: Reduced, base: Given, given: Given, turn: NDArray[Any], wide: Array) -> Array:
    """The designs' states at rest (D, Y), chords those of ``base`` times ``turn``; lengths (D, 1)."""
    strips, scene = model.strips, model.system.scene
    count, own = len(given.ends), len(scene.bodies)
    start = np.repeat(at_rest(model)[None], count, axis=0)
    for body in range(own):
        start[:, 3 * body : 3 * body + 2] = given.centres[:, body] / wide
    for s, strip in enumerate(scene.strips):
        w, inner = model.places(s)[0], strip.control_points[2:-2] - base.ends[0, s, 0]
        moved = turn[:, s, None] * (inner[:, 0] + 1j * inner[:, 1])
        points = (np.stack((moved.real, moved.imag), axis=-1) + given.ends[:, s, None, 0]) / wide[..., None]
        start[:, w.start : w.stop - 2] = points.reshape(count, -1)
        for end, carriers in enumerate((strips.roots, strips.tips)):
            if carriers[s] >= own:  # a free end is its own body
                place = 3 * carriers[s]
                start[:, place : place + 2] = given.ends[:, s, end] / wide
    return start


def pivots(
    designs: Mapping[str, ArrayLike] | Sequence[Mapping[str, Any]], discretisation: Mapping[str, Any]
) -> tuple[Mechanism, Given]:
    """A pivot of unit length and rigidity, so that no design's answer depends on another one, and the
    numbers of many by the keywords of ``cross_axis_pivot``; refused under loads, which these do not scale.
    """
    columns = _columns(designs)
    first: dict[str, Any] = {
        name: tuple(c[0].tolist()) if c.ndim > 1 else float(c[0]) for name, c in columns.items()
    }
    system = compile_scene(cross_axis_pivot(**first, **discretisation).driven(1.0))
    if system.is_preloaded or system.loads.value.any():
        expected = "no loads on pivots by their keywords: a mechanism and its values"
        raise InvalidParameter("discretisation", dict(discretisation), expected)
    unit: dict[str, Any] = dict.fromkeys(
        ("length", "second_moment_of_area", "youngs_modulus", "density"), 1.0
    )
    unit |= {"area": 1e3, "poisson_ratio": 0.3, "body_mass": 1.0, "body_moment_of_inertia": 1.0}
    unit |= {"inclination": np.pi / 4, "crossing_ratio": 0.5}
    return cross_axis_pivot(**unit, **discretisation), _pivots(columns)


def varied(mechanism: Mechanism, values: Mapping[str, ArrayLike], count: int = 1) -> Given:
    """Designs of a mechanism whose numbers are replaced by ``values``, by the names of the parameters."""
    design = mechanism.design
    columns = {name: np.atleast_1d(np.asarray(value, dtype=float)) for name, value in values.items()}
    count = max([count, *(len(column) for column in columns.values())])
    one, sides = Given.of(design), np.array([(s.thickness, s.width) for s in map(Section.of, design.strips)])
    given = one.rows(np.zeros(count, dtype=np.int64))
    side = np.repeat(sides[None], count, axis=0)
    for name in values:
        column = one_each(name, columns[name], count)
        part, at = place_of(design, name)
        if part in ("section", "sides"):
            _refuse({name: column}, name, column > 0.0, "a finite number > 0")
            (given.section if part == "section" else side)[:, at[0], at[1]] = column[:, None]
            if part == "sides":
                h, b = np.moveaxis(side[:, at[0]], -1, 0)
                given.section[:, at[0], 0], given.section[:, at[0], 1] = b * h, b * h**3 / 12.0
        elif part == "centres" or (part == "ends" and design.strips[at[0]].rise == 0.0):
            getattr(given, part)[(slice(None), *at)] = column
        else:
            one_of = f"STRIP.{', STRIP.'.join(POINTS)} of a straight strip or BODY.{', BODY.'.join(CENTRES)}"
            raise InvalidParameter("values", name, f"one of {', '.join((*MATERIAL, *SECTION))}, {one_of}")
    return given


def _columns(designs: Mapping[str, ArrayLike] | Sequence[Mapping[str, Any]]) -> dict[str, Array]:
    """Designs as columns of equal length, pairs with a second axis."""
    if not isinstance(designs, Mapping):
        designs = {name: np.array([design[name] for design in designs]) for name in designs[0]}
    pairs = {name: 1 + (name == "centre_offset") for name in designs}
    values = {name: np.asarray(value, dtype=float) for name, value in designs.items()}
    count = max((len(v) for name, v in values.items() if v.ndim >= pairs[name]), default=1)
    shape = {name: (count, 2) if pairs[name] == 2 else (count,) for name in values}
    return {name: np.broadcast_to(value, shape[name]) for name, value in values.items()}


def _pivots(columns: Mapping[str, Array]) -> Given:
    """Pivots by their keywords."""
    c = columns
    for name in POSITIVE:
        _refuse(c, name, c[name] > 0, "a finite number > 0")
    _refuse(c, "inclination", (c["inclination"] > 0) & (c["inclination"] < np.pi / 2), "0 to pi/2")
    _refuse(c, "crossing_ratio", (c["crossing_ratio"] > 0) & (c["crossing_ratio"] < 1), "0 to 1")
    length, count = c["length"], len(c["length"])
    turn = np.broadcast_to(c.get("orientation", np.zeros(1)), (count,))
    offset = np.broadcast_to(c.get("centre_offset", np.zeros((1, 2))), (count, 2))
    cos, sin = np.cos(c["inclination"]), np.sin(c["inclination"])
    axis = np.stack((np.stack((cos, sin), -1), np.stack((-cos, sin), -1)), axis=1) * length[:, None, None]
    root = np.zeros((count, 2, 2))
    root[:, 1, 0] = 2 * c["crossing_ratio"] * cos * length
    tip = root + axis
    centre = tip.mean(axis=1) + offset
    matrix = np.moveaxis(np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]), -1, 0)
    arm = np.einsum("dij,dsj->dsi", matrix, tip - centre[:, None])
    axis, root = (np.einsum("dij,dsj->dsi", matrix, part) for part in (axis, root))
    centre = root[:, 0] + axis[:, 0] - arm[:, 0]
    section = np.stack([c[name] for name in ("area", "second_moment_of_area", "youngs_modulus")], axis=-1)
    return Given(
        ends=np.stack((root, root + axis), axis=2),
        centres=centre[:, None],
        section=np.repeat(section[:, None], 2, axis=1),
    )


def _refuse(columns: Mapping[str, Array], name: str, good: NDArray[np.bool_], expected: str) -> None:
    """Refuse the first design whose number is not good, or not finite."""
    bad = np.flatnonzero(~(good & np.isfinite(columns[name])))
    if bad.size:
        raise InvalidParameter(f"design {bad[0]}: {name}", float(columns[name][bad[0]]), expected)


def one_each(name: str, given: ArrayLike, count: int, above: float = -np.inf) -> Array:
    """A number for all designs, (1,), or one for each, (D,)."""
    values = np.atleast_1d(np.asarray(given, dtype=float))
    if values.shape not in ((1,), (count,)):
        raise InvalidParameter(name, values.shape, f"a number or an array of {count}, one a design")
    bound = "" if above == -np.inf else f" > {above:g}"
    _refuse({name: values}, name, values > above, f"a finite number{bound}")
    return values
