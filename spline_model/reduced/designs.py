"""What the numbers of designs make of a mechanism's arrays, real or complex: of many at once, or of a step in
each parameter."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.parameters import Given, cross
from spline_model.reduced.many import Designs
from spline_model.reduced.model import Reduced, at_rest
from spline_model.reduced.numbers import bends_of
from spline_model.strip.element import DROP, MODES, PER_U, REACH, RIGIDITY, ROOT, STRETCHING, TIP, WHERE
from spline_model.strip.laws import TERMS

Array = NDArray[Any]

DIGITS = 12
"""Of b/L and t/L over those of the mechanism: what differs less has the same profile."""


def designs_of(model: Reduced, base: Given, given: Given, length: Array, energy: Array) -> Designs:
    """Return the arrays of designs of the mechanism that ``model`` is of, whose own numbers are ``base``.

    length (D,) [m], energy (D,) [J]: the units of each. Strips keep their form at rest: they are turned and
    lengthened with their chords.
    """
    strips, bodies, wide = model.strips, model.bodies, length[:, None]
    longer, area = given.span / base.span, given.section[..., 0] / base.section[..., 0]
    force = (energy / length)[:, None] * (model.length / model.energy)
    soft = np.stack((base.section[..., 2] / given.section[..., 2] / area, longer**2), axis=-1)
    soft[..., 1] *= base.rigidity / given.rigidity
    which = (np.arange(strips.compliance.shape[1]) >= strips.split).astype(int)
    shares = np.concatenate((1.0 / force, 1.0 / force, model.energy / energy[:, None]), axis=1)
    shares = np.tile(shares, len(bodies.rest) // 3)
    turns = model.system.drives.turns == 1
    return Designs(
        length=length,
        energy=energy,
        along=along_of_designs(model, base, given, length, energy),
        rest=model.rest * (wide / model.length)[..., None],
        numbers=_numbers(model, base, given, longer, force, wide),
        compliance=strips.compliance * (soft * force[..., None])[..., which],
        start=_starts(model, base, given, longer, wide),
        force=np.stack((bodies.load, bodies.weight))[:, : len(bodies.rest)] * shares[:, None],
        target=model.drives[1] * np.where(turns, 1.0, model.length / wide),
        springs=_springs(model, length, energy),
        levers=_levers(model, given) / wide[..., None],
    )


def _levers(model: Reduced, given: Given) -> Array:
    """Levers of frames (D, C, 2) [m]: of hinges at the ends of strips, of loads at points that stay."""
    strips, frames = model.strips, model.bodies.frames
    levers = np.zeros((len(given.ends), *frames.lever.shape), dtype=given.ends.dtype)
    for f, (at, by, _) in enumerate(frames.place.tolist()):
        levers[:, f] = model.system.scene.bodies[at // 3].centre
        for end, carriers in enumerate((strips.roots, strips.tips)):
            for s in np.flatnonzero(carriers == at // 3):
                levers[:, f] = given.ends[:, s, end]
        if by >= 0:
            levers[:, f] -= given.centres[:, by // 3]
    return levers


def _springs(model: Reduced, length: Array, energy: Array) -> Array:
    """Springs of each design (D, 3 B, 3 B), or (D, 0, 0)."""
    size, turns = len(model.bodies.springs), np.arange(len(model.bodies.springs)) % 3 == 2
    unit = np.where(turns, 1.0, length[:, None] / model.length)
    share = unit[:, :, None] * unit[:, None] * (model.energy / energy)[:, None, None]
    return np.asarray(model.bodies.springs * share).reshape(len(length), size, size)


def along_of_designs(model: Reduced, base: Given, given: Given, length: Array, energy: Array) -> Array:
    """Return the constants along the strips of designs (D, S, P, 11 + K) [1]; arguments as of
    ``designs_of``."""
    along, wide, longer = model.strips.along, length[:, None] / model.length, given.span / base.span
    rigid = given.rigidity / base.rigidity * (model.energy / energy * (model.length / length))[:, None]
    thicker, wider = np.moveaxis(given.sides / base.sides, -1, 0)
    speed, ones = longer / wide, np.ones_like(longer)
    curl = wider**2 / thicker / wide
    factor = np.stack((speed, ones * wide, rigid, curl, *TERMS * (ones,), speed**-0.5), axis=-1)
    found = along * factor[:, :, None, np.minimum(np.arange(along.shape[-1]), MODES)]
    scene, u = model.system.scene, model.shape.rule[WHERE]
    for s, bend in enumerate(bends_of(scene)):
        if any(bend.roots) or (bend.curl and bend.curl.clamped):  # of another profile, by b/L and t/L
            degree, parts = scene.strips[s].basis.degree, np.stack((wider, thicker))[..., s] / longer[:, s]
            parts += np.round(parts.real, DIGITS) - parts.real
            for d, (width, thickness) in enumerate(parts.T):
                own = bend.with_sides(width, thickness)
                rigidity = own.rigidity_at(degree, u) / (model.energy * model.length)
                found[d, s, :, RIGIDITY] = rigidity * rigid[d, s]
                if own.curl:
                    found[d, s, :, DROP:MODES] = own.curl.drop(degree, u)
    return np.asarray(found)


def of_design(model: Reduced, designs: Designs, d: int) -> Reduced:
    """The mechanism with the strips of one of the designs, which are over its own length and energy."""
    own = {name: getattr(designs, name)[d] for name in ("along", "numbers", "compliance")}
    rest, frames = designs.start[d, : len(model.bodies.rest)], model.bodies.frames
    bodies = model.bodies._replace(rest=rest, frames=frames._replace(lever=designs.levers[d]))
    return replace(model, bodies=bodies, strips=model.strips._replace(**own))


def _numbers(model: Reduced, base: Given, given: Given, longer: Array, force: Array, wide: Array) -> Array:
    """The numbers of ``Strips`` of each design (D, S, 16 + 2 n)."""
    strips, (cos, sin) = model.strips, _turns(base, given)
    area, modulus = (given.section[..., k] / base.section[..., k] for k in (0, 2))
    numbers = np.repeat(strips.numbers[None].astype(longer.dtype), len(longer), axis=0)
    numbers[..., STRETCHING] *= area * modulus / force
    numbers[..., PER_U:] *= (area * longer / force)[..., None]
    numbers[..., REACH:PER_U] *= (longer * (model.length / wide))[..., None]
    angle = np.arctan2(sin.real, cos.real)  # and what is beside it along the imaginary axis
    angle = angle + sin * np.cos(angle) - cos * np.sin(angle)
    for end, (place, carriers) in enumerate(((ROOT, strips.roots), (TIP, strips.tips))):
        numbers[..., place + 2] += angle
        for s, body in enumerate(carriers):
            if body < given.centres.shape[1]:
                origin = given.centres[:, body] if body >= 0 else 0.0
                numbers[:, s, place : place + 2] = (given.ends[:, s, end] - origin) / wide
    return numbers


def _starts(model: Reduced, base: Given, given: Given, longer: Array, wide: Array) -> Array:
    """The designs' states at rest (D, Y)."""
    strips, scene, (cos, sin) = model.strips, model.system.scene, _turns(base, given)
    count, own = len(longer), given.centres.shape[1]
    start = np.repeat(at_rest(model)[None].astype(longer.dtype), count, axis=0)
    for body in range(own):
        start[:, 3 * body : 3 * body + 2] = given.centres[:, body] / wide
    for s, strip in enumerate(scene.strips):
        w, (x, y) = model.places(s)[0], (strip.control_points[2:-2] - base.ends[0, s, 0]).T
        c, d = longer[:, s, None] * cos[:, s, None], longer[:, s, None] * sin[:, s, None]
        points = np.stack((c * x - d * y, d * x + c * y), axis=-1) + given.ends[:, s, None, 0]
        start[:, w.start : w.stop - 2] = (points / wide[..., None]).reshape(count, -1)
        for end, carriers in enumerate((strips.roots, strips.tips)):
            if carriers[s] >= own:  # a free end has a frame of its own
                place = 3 * carriers[s]
                start[:, place : place + 2] = given.ends[:, s, end] / wide
    return start


def _turns(base: Given, given: Given) -> tuple[Array, Array]:
    """Cosine and sine (D, S) of the turn of each chord."""
    both, a, b = base.span * given.span, base.chord, given.chord
    return np.sum(a * b, axis=-1) / both, cross(a, b) / both
