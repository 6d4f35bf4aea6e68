"""Random pivots and mechanisms under random loads, each from a seed."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from studies.cases.design import Design
from studies.cases.effects import DEFAULT, Effects
from studies.cases.mechanism import Body, Mechanism, Strip
from studies.cases.problem import Problem

STIFF = "driven_displacement"
Random = np.random.Generator


@dataclass(frozen=True, kw_only=True)
class Scale:
    """What a random scene is made to: strip length [m], moment EI/L [N m], force EI/L^2 [N], section."""

    length: float
    moment: float
    force: float
    section: dict[str, float]


def _scale(rng: Random) -> Scale:
    length, slenderness = rng.uniform(0.04, 0.15), float(np.exp(rng.uniform(np.log(15), np.log(300))))
    depth, width, modulus = length / slenderness, rng.uniform(0.005, 0.02), rng.choice([2e9, 110e9, 206e9])
    second_moment = width * depth**3 / 12.0
    rigidity = modulus * second_moment
    section = {
        "area": float(width * depth),
        "second_moment_of_area": float(second_moment),
        "youngs_modulus": float(modulus),
        "poisson_ratio": 0.3,
        "density": 2000.0,
    }
    return Scale(length=float(length), moment=rigidity / length, force=rigidity / length**2, section=section)


def _pair(rng: Random, largest: float) -> tuple[float, float]:
    """Return a random vector, its length up to `largest`."""
    size, angle = rng.uniform(0.0, largest), rng.uniform(0.0, 2.0 * np.pi)
    return float(size * np.cos(angle)), float(size * np.sin(angle))


def _effects(rng: Random, scale: Scale, mass: float, free: str | None = None, most: float = 1.5) -> Effects:
    """Return random loads up to `most` EI/L^2; `free`: a strip with a free tip, which bears a force."""
    sizes: dict[str, Callable[[], dict[str, Any]]] = {
        "applied_force": lambda: {"force": _pair(rng, most * scale.force)},
        "applied_moment": lambda: {"moment": float(rng.uniform(-most, most) * scale.moment)},
        "gravity": lambda: {"acceleration": _pair(rng, 0.7 * most * scale.force / mass)},
        "pre_strain": lambda: {"curvature": float(rng.uniform(-0.5, 0.5) / scale.length)},
    }
    if free is not None:
        sizes["tip_force"] = lambda: {"strip": free, "force": _pair(rng, 0.5 * most * scale.force)}
    chosen = [name for name in sizes if rng.random() < 0.5]
    return Effects(names=(*DEFAULT, *chosen), tables={name: sizes[name]() for name in chosen})


def _angle(rng: Random, largest_deg: float) -> float:
    return float(np.radians(rng.uniform(2.0, largest_deg)) * rng.choice([-1.0, 1.0]))


def _increments(rng: Random) -> int:
    return int(rng.choice([6, 10, 16]))


def _pivot(rng: Random) -> Problem:
    """A pivot of any outline, to 150 deg; some have a centre at the crossing that is led."""
    scale, mass = _scale(rng), float(rng.uniform(0.05, 1.0))
    inclination, ratio = np.radians(rng.uniform(20, 70)), rng.uniform(0.1, 0.9)
    effects, rotation, offset = _effects(rng, scale, mass), _angle(rng, 150), _pair(rng, 0.3 * scale.length)
    if rng.random() < 0.15:
        slack = scale.section["second_moment_of_area"] / (scale.section["area"] * scale.length)
        tables = dict(effects.tables) | {STIFF: {"displacement": _pair(rng, 10.0 * slack)}}
        effects = Effects(names=(*effects.names, STIFF), tables=tables)
        rotation *= 0.05
        offset = (0.0, -(1.0 - ratio) * scale.length * np.sin(inclination))
    return Problem(
        length=scale.length,
        inclination=float(inclination),
        crossing_ratio=float(ratio),
        **scale.section,
        body_mass=mass,
        body_moment_of_inertia=mass * scale.length**2,
        centre_offset=(float(offset[0]), float(offset[1])),
        rotation=rotation,
        increments=_increments(rng),
        effects=effects,
    )


def _mechanism(
    rng: Random,
    scale: Scale,
    strips: dict[str, tuple[Any, Any, str, str | None]],
    bodies: dict[str, tuple[float, float]],
    rotation: float | None,
    most: float = 1.5,
    rise: float = 0.0,
) -> Mechanism:
    """Return the mechanism of strips (start, end, root, tip) and centres over L, its first body driven."""
    mass, length = float(rng.uniform(0.05, 1.0)), scale.length
    free = next((name for name, (*_, tip) in strips.items() if tip is None), None)

    def at(place: Any) -> tuple[float, float]:
        return float(length * place[0]), float(length * place[1])

    driven = next(iter(bodies))
    effects = _effects(rng, scale, mass, free, most)
    tables = {
        name: values | ({"body": driven} if name.startswith("applied") else {})
        for name, values in effects.tables.items()
    }
    return Mechanism(
        strips=tuple(
            Strip(name=name, start=at(a), end=at(b), root=root, tip=tip, rise=rise * length, **scale.section)
            for name, (a, b, root, tip) in strips.items()
        ),
        bodies=tuple(
            Body(name=name, centre=at(place), mass=mass, moment_of_inertia=mass * length**2)
            for name, place in bodies.items()
        ),
        body=driven,
        rotation=rotation,
        increments=_increments(rng),
        effects=replace(effects, tables=tables),
    )


def _guide(rng: Random) -> Mechanism:
    """A platform on two parallel strips that follows its loads."""
    apart, lift = rng.uniform(0.3, 1.5), rng.uniform(-0.3, 0.3)
    strips = {
        "left": ((0, 0), (0, 1), "ground", "platform"),
        "right": ((apart, 0), (apart, 1), "ground", "platform"),
    }
    return _mechanism(rng, _scale(rng), strips, {"platform": (0.5 * apart, 1.0 + lift)}, None, most=4.0)


def _four_bar(rng: Random) -> Mechanism:
    """Crank, coupler and rocker on four short strips, the crank driven to 15 deg either way."""
    arm, span = rng.uniform(1.5, 4.0), rng.uniform(2.0, 5.0)
    strips = {
        "ground_crank": ((0, 0), (0, 1), "ground", "crank"),
        "crank_coupler": ((0, 1 + arm), (0, 2 + arm), "crank", "coupler"),
        "coupler_rocker": ((span, 2 + arm), (span, 1 + arm), "coupler", "rocker"),
        "rocker_ground": ((span, 1), (span, 0), "rocker", "ground"),
    }
    bodies = {"crank": (0, 1 + 0.5 * arm), "coupler": (0.5 * span, 2 + arm), "rocker": (span, 1 + 0.5 * arm)}
    return _mechanism(rng, _scale(rng), strips, bodies, _angle(rng, 15), most=0.4)


def _cantilever(rng: Random) -> Mechanism:
    """A straight or curved strip with a body at its tip, driven to 150 deg or left to its loads."""
    rotation = _angle(rng, 150) if rng.random() < 0.6 else None
    rise = float(rng.choice([0.0, rng.uniform(-0.2, 0.2)]))
    place = (1.0 + rng.uniform(0.0, 0.2), rng.uniform(-0.1, 0.1))
    strips = {"strip": ((0, 0), (1, 0), "ground", "body")}
    return _mechanism(rng, _scale(rng), strips, {"body": place}, rotation, rise=rise)


def _three_strips(rng: Random) -> Mechanism:
    """A body on three strips that meet near it, to 40 deg either way; some bear one with a free tip."""
    directions = np.radians(np.array([90.0, 210.0, 330.0]) + rng.uniform(-25, 25, 3))
    hub = rng.uniform(-0.3, 0.3)
    strips: dict[str, Any] = {}
    for name, angle in zip(("a", "b", "c"), directions, strict=True):
        way = np.array([np.cos(angle), np.sin(angle)])
        strips[name] = (tuple((1.0 + hub) * way), tuple(hub * way), "ground", "body")
    if rng.random() < 0.5:
        strips["whisker"] = ((0.1, 0.1), (0.1 + rng.uniform(0.3, 0.8), 0.4), "body", None)
    rotation = _angle(rng, 40)
    return _mechanism(rng, _scale(rng), strips, {"body": tuple(rng.uniform(-0.2, 0.2, 2))}, rotation)


def _column(rng: Random) -> Mechanism:
    """A strip that carries up to six times EI/L^2 above it, a little out of line; it buckles at 2.5."""
    strips = {"column": ((0, 0), (0, 1), "ground", "body")}
    design = _mechanism(
        rng, _scale(rng), strips, {"body": (rng.choice([-1, 1]) * rng.uniform(0.005, 0.05), 1.0)}, None, 0.0
    )
    first, mass = design.strips[0], design.bodies[0].mass
    unit = first.youngs_modulus * first.second_moment_of_area / first.end[1] ** 2
    gravity = {"gravity": {"acceleration": (0.0, -float(rng.uniform(0.5, 6.0)) * unit / mass)}}
    return replace(design, effects=Effects(names=(*DEFAULT, "gravity"), tables=gravity))


def _led(rng: Random) -> Mechanism:
    """A strip whose tip is led by a tenth of its length and more, where it may."""
    strips = {"strip": ((0, 0), (1, 0), "ground", "body")}
    design = _mechanism(rng, _scale(rng), strips, {"body": (1.0, 0.0)}, None, most=0.5)
    length = design.strips[0].end[0]
    drawn, aside = rng.uniform(0.0, 0.1) * length, rng.uniform(-0.3, 0.3) * length
    led = {STIFF: {"displacement": (-float(drawn), float(aside))}}
    names = (*design.effects.names, STIFF)
    return replace(design, effects=Effects(names=names, tables=dict(design.effects.tables) | led))


KINDS = (_pivot, _guide, _column, _pivot, _four_bar, _cantilever, _pivot, _three_strips, _led, _cantilever)


def scene(seed: int) -> Design:
    """Return the random scene of a seed; its kind goes round with the seed."""
    return KINDS[seed % len(KINDS)](np.random.default_rng(seed))


def listed(seed: int) -> Design:
    """Return a random scene with two to four more loads, and with springs and supports.

    Loads act at points beside the centres and at free ends. Scenes that lead a displacement have no support.
    """
    rng, design = np.random.default_rng([seed, 39]), scene(seed)
    first, names = design.strips[0], [body.name for body in design.bodies]
    length = first.length
    force = first.youngs_modulus * first.second_moment_of_area / length**2
    tables: dict[str, Any] = {name: [*design.effects.every(name)] for name in design.effects.tables}

    def add(effect: str, **own: Any) -> None:
        tables.setdefault(effect, []).append(own)

    for _ in range(int(rng.integers(2, 5))):
        body = design.bodies[int(rng.integers(len(names)))]
        x, y = np.add(body.centre, _pair(rng, 0.5 * length))
        if rng.random() < 0.3:
            add("applied_moment", body=body.name, moment=float(rng.uniform(-0.3, 0.3) * force * length))
        else:
            add("applied_force", body=body.name, force=_pair(rng, 0.3 * force), at=(float(x), float(y)))
    last = names[-1]
    if rng.random() < 0.7:
        stiff = tuple(float(each * force / length) for each in rng.uniform(0.0, 3.0, 2))
        add(
            "spring",
            body=last,
            stiffness=stiff,
            rotational_stiffness=float(rng.uniform(0, 1) * force * length),
        )
    if len(names) > 1 and rng.random() < 0.7:
        add("spring", body=names[0], other=last, stiffness=(float(force / length), 0.0))
    if STIFF not in tables and rng.random() < 0.3:
        add("support", body=last, fixed=(str(rng.choice(["x", "y"])),))
    effects = Effects(
        names=tuple(dict.fromkeys((*design.effects.names, *tables))),
        tables={name: tuple(own) if len(own) > 1 else own[0] for name, own in tables.items()},
    )
    return replace(design, effects=effects)
