"""What an answer or a design bears: stress at the outer fibres, where it is largest, where it yields; and the
dead force at the centre of a body on flexures, growing, at which that buckles."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from studies.answers.metrics import extrapolate
from studies.answers.models import put
from studies.answers.response import Answered, Response, assembled
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.design import Design
from studies.cases.effects import Effects
from studies.cases.problem import Problem
from studies.errors import BadInput
from studies.kinds import Array

#: Part of a strip within which a place is its root, its middle or its tip.
NEAR = 0.02
#: Part of a stress below which two are the same: the strips of a symmetric pivot.
SAME = 1e-9
#: Effects that load or lead bodies; and the one that is raised.
FORCE = "applied_force"
LOADS = (FORCE, "applied_moment", "tip_force", "driven_displacement")
#: Forces that are tried one after another, in the clamped Euler loads of all strips together, and increments.
PARTS, INCREMENTS = tuple(2.0**k for k in range(-5, 2)), 10
#: Control points that are tried one after another where none are given; meshes, in the given elements.
POINTS, MESHES = tuple(range(8, 21, 2)), (1, 2, 4)
#: Relative change of the load below which more control points are not tried.
SETTLED = 1e-5
#: What a path with its rotation held passes without buckling: the body would tip if it were let go.
HELD_STABLE = "limit point"


@dataclass(frozen=True, kw_only=True)
class Strength:
    """The largest stress on a path, and how far it is from yield.

    Attributes:
        stress: at an outer fibre [Pa]. strip: its name. station: arc length from its root over L [1].
        load_factor [1], rotation [rad]: of the state; NaN where no body turns.
        yield_strength: of that strip [Pa], None where none is given; safety: least of all strips, yield
            strength over largest stress [1].
        yields: load factor [1] and rotation [rad] from which on some strip yields; None where none does.
    """

    stress: float
    strip: str
    station: float
    load_factor: float
    rotation: float
    yield_strength: float | None
    safety: float | None
    yields: tuple[float, float] | None

    @property
    def place(self) -> str:
        """Where along the strip it is, in words."""
        for at, word in ((0.0, "at its root"), (0.5, "in its middle"), (1.0, "at its tip")):
            if abs(self.station - at) <= NEAR:
                return word
        return f"at {self.station:.2f} of its length"


def strength(answer: Response) -> Strength:
    """Return the largest stress of an answer, and what of its path the material bears.

    Between states the share of the yield strength is interpolated monotonically, by cubics.
    """
    stress, strips = answer.extreme_fibre_stress, answer.design.strips
    limits = [strip.yield_strength for strip in strips]
    first = int(np.argmax(stress >= (1.0 - SAME) * stress.max()))
    state, strip, station = map(int, np.unravel_index(first, stress.shape))
    turns = np.full(len(answer.load_factor), np.nan) if answer.body is None else answer.rotation
    places = np.stack((answer.load_factor, turns), axis=1)
    known = all(limit is not None for limit in limits)
    share = (stress.max(axis=2) / np.array(limits, dtype=float)).max(axis=1) if known else None
    return Strength(
        stress=float(stress.max()),
        strip=strips[strip].name,
        station=float(answer.stations[station]),
        load_factor=float(places[state, 0]),
        rotation=float(places[state, 1]),
        yield_strength=limits[strip],
        safety=float(1.0 / share.max()) if share is not None and share.max() > 0.0 else None,
        yields=None if share is None else _crossed(share, places),
    )


def _crossed(share: Array, places: Array) -> tuple[float, float] | None:
    """Return load factor and rotation at which the share (S,) of the strength first is 1; None if never."""
    beyond = np.flatnonzero(share >= 1.0)
    if not beyond.size:
        return None
    at = float(beyond[0])
    if at > 0.0:
        from scipy.interpolate import PchipInterpolator  # only a path that yields waits for them
        from scipy.optimize import brentq

        states = np.arange(len(share))
        at = brentq(PchipInterpolator(states, share - 1.0), at - 1.0, at)
        places = np.array([[np.interp(at, states, column) for column in places.T]])
    return float(places[0, 0]), float(places[0, 1])


@dataclass(frozen=True, kw_only=True)
class Capacity(Answered):
    """The first load that a design does not bear, in one direction.

    Its message is that of the model on the path where the load was found, or where that ended.

    Attributes:
        direction: of the force [rad], from x to y; held: whether the body is kept from turning.
        force: at which stability is lost [N]; None where it is not, up to `reached`, the largest force that
            was borne [N]; turned: rotation of the body there [rad].
        kind: of the critical point. uncertainty: of the force, relative [1]; NaN of one discretisation.
    """

    direction: float
    held: bool
    force: float | None
    reached: float
    turned: float
    kind: str
    uncertainty: float


def capacity(
    design: Design, settings: Settings, *, direction: float, held: bool = False, body: str | None = None
) -> Capacity:
    """Return the force at a body's centre, in one direction, at which the design first loses stability.

    Weight and pre-strain act in full; other loads and drives of the case are left out. The spline takes more
    control points until the force settles, the elements are doubled twice and their limit is taken, unless
    the settings of the spline name a number.

    Args:
        design: the pivot or mechanism. settings: of the model.
        direction: of the force in the axes of the ground [rad].
        held: whether the rotation of the body is held.
        body: its name; None for that of the case.

    Raises:
        BadInput: what the model refuses; a design without bodies; one line.
    """
    known, name = [each.name for each in design.bodies], body or design.body
    if name not in known:
        expected = f"one of {', '.join(known)}" if known else "a design with a body that the force acts on"
        raise BadInput(f"body: got {name or 'none'}, expected {expected}")
    found: list[Capacity] = []
    for each in _refined(settings):
        found.append(_of(design, each, direction, held, name))
        if found[-1].force is None and found[-1].converged:
            return found[-1]
        if _settled(settings, found):
            break
    forces = [np.array([each.force]) for each in found if each.force is not None]
    if len(forces) < 2 or found[-1].force is None:
        return found[-1]
    if isinstance(settings, FeSettings) and len(forces) == len(MESHES):
        limit = extrapolate(forces)
        force, error = float(limit.value[0]), float(limit.uncertainty[0])
    else:
        force, error = float(forces[-1][0]), float(abs(forces[-1] - forces[-2])[0])
    return replace(found[-1], force=force, uncertainty=error / force)


def _refined(settings: Settings) -> Iterator[Settings]:
    """Yield the discretisations to answer with."""
    if isinstance(settings, FeSettings):
        yield from (replace(settings, elements=settings.elements * times) for times in MESHES)
    elif settings.control_points is not None:
        yield settings
    else:
        yield from (replace(settings, control_points=points) for points in POINTS)


def _settled(settings: Settings, found: list[Capacity]) -> bool:
    """Whether the force of a spline does not change any more."""
    forces = [each.force for each in found[-2:] if each.force is not None]
    spline = isinstance(settings, SplineSettings) and len(forces) == 2
    return spline and abs(forces[1] - forces[0]) <= SETTLED * forces[1]


def _of(design: Design, settings: Settings, direction: float, held: bool, body: str) -> Capacity:
    """Return the capacity with one discretisation."""
    unit, reached = _unit(design), 0.0
    towards = (float(np.cos(direction)), float(np.sin(direction)))
    for part in PARTS:
        size = part * unit
        loaded = _loaded(design, (size * towards[0], size * towards[1]), body)
        asked = put(loaded, settings)
        how = {"rotation": 0.0 if held else None, "increments": INCREMENTS, "raise_on_failure": False}
        with asked.refusals():
            path = asked.model.statics.solve_mechanism(asked.modelled, body=body, **how)
        lost = [each for each in path.critical_points if not (held and each.kind == HELD_STABLE)]
        reached = size * float(lost[0].load_factor if lost else path.load_factor[-1])
        if lost or path.status.value != "converged":
            break
    return Capacity(
        **Capacity.about(asked, path) | {"effects": assembled(asked.effects)},
        status="converged" if lost else str(path.status.value),
        message=str(path.message),
        direction=direction,
        held=held,
        force=reached if lost else None,
        reached=reached,
        turned=float(path.bodies[body][-1, 2]) if not lost else float(lost[0].rotation),
        kind=lost[0].kind if lost else "",
        uncertainty=float("nan"),
    )


def _unit(design: Design) -> float:
    """Return the Euler loads of all strips, clamped at both ends, together: 4 pi^2 EI / L^2 [N]."""
    loads = (part.youngs_modulus * part.second_moment_of_area / part.length**2 for part in design.strips)
    return 4.0 * math.pi**2 * float(sum(loads))


def _loaded(design: Design, force: tuple[float, float], body: str) -> Design:
    """Return the design with that force alone, beside weight and pre-strain."""
    names = (*(name for name in design.effects.names if name not in LOADS), FORCE)
    load: dict[str, Any] = {"force": force}
    if not isinstance(design, Problem):
        load["body"] = body
    return replace(design, effects=Effects(names=names, tables={**design.effects.tables, FORCE: load}))
