"""What an answer bears: its largest stress, and from which load factor and rotation on a strip yields."""

from dataclasses import dataclass, fields, replace
from functools import cache
from typing import Any

import numpy as np

from studies.answers.models import put
from studies.answers.response import STRESSES, Response
from studies.errors import Unanswered
from studies.kinds import Array

#: Part of a strip within which a place is its root, its middle or its tip.
NEAR = 0.02
#: Part of a stress below which two are the same: the strips of a symmetric pivot.
SAME = 1e-9
#: Part of an increment to which the place is solved for.
PRECISION = 1e-7


@dataclass(frozen=True, kw_only=True)
class _Yield:
    """Where a strip begins to yield.

    Attributes:
        load_factor: [1]; rotation: [rad], NaN where no body turns.
        error: estimated, in parts of the rotation or, where that does not change, of the load factor [1]; NaN
            where it is not estimated.
    """

    load_factor: float
    rotation: float
    error: float


@dataclass(frozen=True, kw_only=True)
class _Strength:
    """The largest stress on a path, and how far it is from yield.

    Attributes:
        stress: at an outer fibre [Pa]. strip: its name. station: arc length from its root over L [1].
        load_factor [1], rotation [rad]: of the state; NaN where no body turns.
        yield_strength: of that strip [Pa], None where none is given; safety: least of all strips, yield
            strength over largest stress [1].
        yields: from which load factor and rotation on some strip yields; None where none does.
    """

    stress: float
    strip: str
    station: float
    load_factor: float
    rotation: float
    yield_strength: float | None
    safety: float | None
    yields: _Yield | None

    @property
    def place(self) -> str:
        """Where along the strip it is, in words."""
        for at, word in ((0.0, "at its root"), (0.5, "in its middle"), (1.0, "at its tip")):
            if abs(self.station - at) <= NEAR:
                return word
        return f"at {self.station:.2f} of its length"


def strength(answer: Response) -> _Strength:
    """Return the largest stress [Pa] of an answer, and the part of its path below the yield strength.

    The stress is NaN if an outermost fibre is unknown.
    """
    stress, strips = answer.strip_stress, answer.design.strips
    first = int(np.argmax(stress >= (1.0 - SAME) * stress.max()))
    state, strip = map(int, np.unravel_index(first, stress.shape))
    along = answer.stress[state, strip]
    station = int(np.argmax(along >= (1.0 - SAME) * along.max()))
    load_factor, rotation = map(float, answer.places[state])
    share = answer.yield_share
    return _Strength(
        stress=float(stress.max()),
        strip=strips[strip].name,
        station=float(answer.stations[station]),
        load_factor=load_factor,
        rotation=rotation,
        yield_strength=strips[strip].yield_strength,
        safety=float(1.0 / share.max()) if share is not None and share.max() > 0.0 else None,
        yields=None if share is None else _first_yield(answer, share),
    )


def _first_yield(answer: Response, share: Array) -> _Yield | None:
    """Return where the share (S,) of the yield strength is first 1 on the path; None if it never is.

    The states between two increments are solved for, with the discretisation of the answer.
    """
    beyond = np.flatnonzero(share >= 1.0)
    if not beyond.size:
        return None
    places, after = answer.places, int(beyond[0])
    if after == 0:
        return _Yield(load_factor=float(places[0, 0]), rotation=float(places[0, 1]), error=0.0)
    from scipy.optimize import brentq  # imported by an answer that yields

    step, rise = places[after] - places[after - 1], float(share[after] - share[after - 1])

    @cache
    def state(at: float) -> tuple[float, Array]:
        """Return the share beyond 1, and the place, at a state or between two."""
        if at in (after - 1, after):
            return float(share[int(at)]) - 1.0, places[int(at)]
        return _solved(answer, places[after - 1] + (at - (after - 1)) * step)

    stress = next((answer.errors[name] for name in STRESSES if name in answer.errors), np.nan)
    error = stress * float(share.max()) / rise
    try:
        at = brentq(lambda at: state(at)[0], after - 1.0, float(after), xtol=PRECISION)
        found = state(at)[1]
    except Unanswered:  # the path between the increments is not found: their line is all that is known
        found, error = places[after - 1] + (1.0 - share[after - 1]) / rise * step, np.nan
    turned = bool(abs(step[1]) > 0.0 and found[1] != 0.0)
    part = abs(step[1] / found[1]) if turned else abs(step[0] / found[0])
    return _Yield(load_factor=float(found[0]), rotation=float(found[1]), error=float(error * part))


def _solved(answer: Response, place: Array) -> tuple[float, Array]:
    """Return the share beyond 1 at the end of a path to a load factor and rotation (2,) on that of an answer,
    and this place, with the rotation that is found where none is driven.

    Both are linear between two states if they are prescribed.
    """
    design = answer.design
    changes: dict[str, Any] = {"effects": design.effects.grown(float(place[0]))}
    if design.rotation is not None:
        changes["rotation"] = float(place[1])
    given = answer.asked.settings
    known = {each.name: answer.settings[each.name] for each in fields(given) if each.name in answer.settings}
    asked = put(replace(design, **changes), replace(given, **known))
    path = asked.static_path(raise_on_failure=False)
    if str(path.status.value) != "converged":
        raise Unanswered(path.message)
    if getattr(answer.solution, "balanced", False):
        path = replace(path, balanced=True)
    there = Response.of(asked, path)
    share = there.yield_share
    assert share is not None, "the strips of the answer have a yield strength"
    return float(share[-1]) - 1.0, np.array([place[0], there.places[-1, 1]])
