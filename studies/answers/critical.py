"""The critical load of a design: the dead force at the centre of a body at which stability is first lost.

It counts only if two discretisations have it at the same force; their difference is its uncertainty.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from spline_model.solution import named
from studies.answers.answer import Answer
from studies.answers.metrics import extrapolate
from studies.answers.models import Asked, put
from studies.answers.response import Response
from studies.answers.settings import FeSettings, Settings
from studies.cases.design import Design
from studies.cases.effects import GROWING
from studies.cases.keys import GROUND, LOADS_FIRST
from studies.errors import BadInput

#: The effect that is raised; those that load or drive bodies are removed.
FORCE = "applied_force"
#: Forces that are tried one after another, in what the strips bear as Euler columns, and increments.
PARTS, INCREMENTS = tuple(2.0**k for k in range(-5, 2)), 10
#: Discretisations that are tried one after another: control points, then segments; in the given elements.
POINTS, SEGMENTS, MESHES = tuple(range(8, 15, 2)), (2, 4, 8, 16), (1, 2, 4, 8, 16)
#: How many alike give a limit of meshes, or that there is no critical load: two coarse ones may both miss it.
ALIKE = 3
#: Relative difference of two discretisations at which no finer one is tried, and up to which they agree.
SETTLED, AGREED = 1e-5, 1e-2
#: Parts of the largest Euler load that those of the strips are added up in.
FINEST = 2**20
#: Rotation that counts as soft [rad], and relative width to which its force is found.
SOFT, FOUND = math.radians(5.0), 1e-9
UNSTABLE, NONE = "unstable at zero force", ""


@dataclass(frozen=True, kw_only=True)
class CriticalLoad(Answer):
    """The smallest force in one direction at which a design loses stability.

    The status is "converged" if two discretisations agree on a force, or on none; otherwise the message has
    the result of each.

    Attributes:
        force_direction: from x to y [rad]; held: whether the body is kept from turning.
        force: at which stability is lost [N], 0 where weight and pre-strain alone lose it; None where none is
            found up to `borne`, the largest force that was borne [N].
        rotation_rad: of the body there [rad], NaN where weight alone is too much; rotation_error: how far the
            last two discretisations are apart in it [rad]; NaN where they are not resolved.
        kind: of the critical point, or UNSTABLE. weight_share: of weight and pre-strain that acts there [1].
        relative_error: of force or share [1]; NaN if unknown.
        rotation_5_deg, yield_N: force at which the rotation exceeds SOFT, and at which a strip yields [N], if
            no critical load is found; None otherwise. soft_relative_error: of both [1].
    """

    analysis = "critical load"

    force_direction: float
    held: bool
    force: float | None = None
    borne: float
    rotation_rad: float
    kind: str = NONE
    weight_share: float = 1.0
    relative_error: float = math.nan
    rotation_error: float = math.nan
    rotation_5_deg: float | None = None
    yield_N: float | None = None
    soft_relative_error: float = math.nan

    @property
    def value(self) -> float:
        """Number that discretisations are compared by: the share of the weight [1], force [N], or rotation
        [rad]."""
        if self.kind == UNSTABLE:
            return self.weight_share
        return self.rotation_rad if self.force is None else self.force

    def apart(self, other: "CriticalLoad") -> float:
        """Return the relative difference [1] to another discretisation; inf if the verdicts differ."""
        if not (self.converged and other.converged) or self.kind != other.kind:
            return math.inf
        if self.kind == NONE:
            return 0.0 if math.isclose(self.value, other.value, rel_tol=AGREED, abs_tol=AGREED) else math.inf
        return abs(self.value / other.value - 1.0)

    @property
    def verdict(self) -> str:
        """The result in words."""
        if not self.converged:
            return f"stops at {self.borne:.6g} N"
        if self.kind == UNSTABLE:
            return f"{UNSTABLE}, at {100.0 * self.weight_share:.4g} % of weight and pre-strain"
        return (
            f"none up to {self.borne:.6g} N" if self.force is None else f"{self.kind} at {self.force:.6g} N"
        )


@dataclass(frozen=True, kw_only=True)
class _Question:
    """A design, the direction of the force on its body, and whether the rotation is held."""

    design: Design
    direction: float
    held: bool

    def path(self, settings: Settings, force: float) -> tuple[Asked, Any]:
        """Return the path to a force [N] alone, beside weight and pre-strain.

        It stops at rest where these find no equilibrium.
        """
        design = self.design
        left = design.effects.renamed([name for name in design.effects.names if name not in GROWING])
        way = (force * math.cos(self.direction), force * math.sin(self.direction))
        load = {FORCE: {"force": way, "body": design.body}}
        asked = put(replace(design, effects=left.plus(**load)), settings)
        rotation = 0.0 if self.held else None
        how = {"rotation": rotation, "increments": INCREMENTS, "order": LOADS_FIRST}
        return asked, asked.static_path(check=False, raise_on_failure=False, **how)

    def paths(self, settings: Settings) -> Iterator[tuple[float, Asked, Any]]:
        """Yield forces [N], in the Euler loads of the strips that bear the body, and the paths to them."""
        unit = _euler_load(self.design)
        for part in PARTS:
            yield part * unit, *self.path(settings, part * unit)


def _euler_load(design: Design) -> float:
    """Return the Euler loads, clamped at both ends, of the weakest strips between the body and the ground
    [N].

    Strips side by side are added up; of strips in a row the weakest counts.
    """
    from scipy.sparse import csr_matrix
    from scipy.sparse.csgraph import maximum_flow

    places = [str(design.body), GROUND, *(b.name for b in design.bodies if b.name != design.body)]
    strips = design.strips
    loads = np.array([s.youngs_modulus * s.second_moment_of_area / s.length**2 for s in strips])
    shares = np.ceil(loads / loads.max() * FINEST).astype(np.int32)
    ends = np.array([[places.index(strip.root), places.index(strip.tip or strip.root)] for strip in strips])
    both = np.concatenate([ends, ends[:, ::-1]]).T
    graph = csr_matrix((np.tile(shares, 2), tuple(both)), shape=2 * (len(places),))
    flow = maximum_flow(graph, 0, 1).flow_value or shares.sum()
    return 4.0 * math.pi**2 * float(flow * loads.max() / FINEST)


def critical_load(
    design: Design, settings: Settings, *, direction: float, held: bool = False
) -> CriticalLoad:
    """Return the force at a body's centre, in one direction, at which the design first loses stability.

    Weight and pre-strain act in full; other loads and drives of the case are removed. The spline takes more
    control points until the force settles, or those of its settings and a few more; the elements are doubled
    until three meshes agree and their limit is taken.

    Args:
        design: the pivot or mechanism. settings: of the model.
        direction: of the force in the axes of the ground [rad].
        held: whether the rotation of the body is locked.

    Raises:
        BadInput: an input that the model rejects, or a design without bodies; one line.
    """
    if design.body is None:
        raise BadInput("body: got none, expected a design with a body that the force acts on")
    question = _Question(design=design, direction=direction, held=held)
    found: list[CriticalLoad] = []
    for each in _refined(settings):
        try:
            found.append(_of(question, each))
        except BadInput:
            if len(found) < 2:
                raise
            break  # a finer one whose stiffnesses are lost in round-off
        if isinstance(each, FeSettings):
            settled = _alike(found, ALIKE, AGREED)
        else:
            settled = _alike(found, ALIKE if found[-1].kind == NONE else 2, SETTLED)
        if settled:
            break
    return _agreed(question, _above_round_off(found) if isinstance(settings, FeSettings) else found)


def _above_round_off(found: Sequence[CriticalLoad]) -> Sequence[CriticalLoad]:
    """Return the meshes up to the finest two that agree: with strips of disparate stiffness still finer ones
    are lost in round-off. All of them if no two agree."""
    ends = (end for end in range(len(found), 1, -1) if _alike(found[:end], 2, AGREED))
    return found[: next(ends, len(found))]


def _alike(found: Sequence[CriticalLoad], count: int, limit: float) -> bool:
    """Return whether the last so many discretisations have the same, each within a limit of the next."""
    last = found[-count:]
    return len(last) == count and all(fine.apart(coarse) <= limit for coarse, fine in pairwise(last))


def _refined(settings: Settings) -> Iterator[Settings]:
    """Yield the discretisations to answer with."""
    if isinstance(settings, FeSettings):
        yield from (replace(settings, elements=settings.elements * times) for times in MESHES)
    elif settings.control_points is not None:
        from spline_model.confirmed import finer

        yield settings
        _, points = finer(settings.segments, settings.control_points)
        yield replace(settings, control_points=points, axial_modes=None, gauss_points=None)
    else:
        yield from (replace(settings, control_points=points) for points in POINTS)
        finer_ones = (settings.segments * times for times in SEGMENTS)
        yield from (replace(settings, control_points=POINTS[0], segments=each) for each in finer_ones)


def _agreed(question: _Question, found: Sequence[CriticalLoad]) -> CriticalLoad:
    """Return what the last two discretisations agree on, with their difference; or that they do not."""
    last, apart = found[-1], found[-1].apart(found[-2])
    if apart > AGREED:
        said = "; ".join(f"{_fineness(each.asked.settings)[0]}: {each.verdict}" for each in found)
        message = f"not resolved: {said}; {_fineness(last.asked.settings)[1]}"
        return replace(last, status="not_converged", message=message, force=None, kind=NONE)
    last = replace(last, rotation_error=abs(last.rotation_rad - found[-2].rotation_rad))
    if last.kind == NONE:
        return _softened(question, (*found[:-1], last))
    value, error = last.value, apart * last.value
    if isinstance(last.asked.settings, FeSettings) and _alike(found, ALIKE, AGREED):
        limit = extrapolate([np.array([each.value]) for each in found[-ALIKE:]])
        value, error = float(limit.value[0]), float(limit.uncertainty[0])
    known: dict[str, Any] = {"weight_share" if last.kind == UNSTABLE else "force": value}
    return replace(last, relative_error=error / value, **known)


def _fineness(settings: Settings) -> tuple[str, str]:
    """Return how fine settings are, in words, and what is finer."""
    if isinstance(settings, FeSettings):
        return f"{settings.elements} elements", f"take {2 * settings.elements} elements"
    finer = f"leave the number open, or take segments = {2 * settings.segments}"
    return named(settings.segments, settings.points), finer


def _of(question: _Question, settings: Settings) -> CriticalLoad:
    """Return the critical load with one discretisation."""
    for tried in question.paths(settings):
        size, asked, path = tried
        lost = [each for each in path.critical_points if each.inertia > 0]
        if lost or path.status.value != "converged":
            break
    last, place = float(path.load_factor[-1]), list(path.bodies).index(str(question.design.body))
    found: dict[str, Any] = {
        "status": str(path.status.value),
        "message": "" if last == 1.0 else str(path.message),
        "borne": size * last,
        "rotation_rad": float(path.bodies[question.design.body][-1, 2]),
    }
    for point in lost[:1]:
        unstable, force = point.preload < 1.0, size * float(point.load_factor)
        found = {"status": "converged", "borne": force, "force": force} | {
            "rotation_rad": math.nan if unstable else float(point.turns[place]),
            "kind": UNSTABLE if unstable else str(point.kind),
            "weight_share": float(point.preload),
        }
    known: dict[str, Any] = {"force_direction": question.direction, "held": question.held}
    return CriticalLoad(asked=asked, solution=path, **known, **found)


def _softened(question: _Question, found: Sequence[CriticalLoad]) -> CriticalLoad:
    """Return the last answer of a design without a critical load with the forces at which it turns and
    yields."""
    body = str(question.design.body)
    shares: dict[str, Callable[[Response], Any]] = {
        "rotation_5_deg": lambda answer: np.abs(answer.bodies[body][:, 2]) / SOFT
    }
    if all(strip.yield_strength is not None for strip in question.design.strips):
        shares["yield_N"] = lambda answer: answer.yield_share
    forces: dict[str, Any] = {}
    apart = [FOUND]
    for name, share in shares.items():
        coarse, fine = (_passing(question, each.asked.settings, share) for each in found[-2:])
        forces[name] = fine
        if fine is not None:
            same = coarse == fine  # such as both passed without any force
            apart.append(0.0 if same else abs(coarse / fine - 1.0) if coarse and fine else math.nan)
    error = max(apart) if any(forces.values()) else math.nan
    return replace(found[-1], soft_relative_error=error, **forces)


def _passing(question: _Question, settings: Settings, share: Callable[[Response], Any]) -> float | None:
    """Return the force [N] at which a share of a limit first is 1, by solutions that end there; or None."""

    def beyond(asked: Asked, path: Any) -> Any:
        return share(Response.of(asked, path)) - 1.0

    def left(force: float) -> Any:
        return beyond(*question.path(settings, force))[-1]

    for size, asked, first in question.paths(settings):
        passed = np.flatnonzero(beyond(asked, first) >= 0.0)
        if passed.size and passed[0] > 0:
            from scipy.optimize import brentq

            below, above = ((passed[0] - back) / INCREMENTS * size for back in (1, 0))
            return float(brentq(left, below, above, rtol=FOUND))
        if passed.size:
            return 0.0
    return None
