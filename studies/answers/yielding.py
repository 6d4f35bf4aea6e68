"""From which load factor and rotation on a strip yields: solved for on its path."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from scipy.optimize import brentq

from studies.answers.models import put
from studies.answers.response import Response
from studies.answers.settings import Settings, settings_of_model
from studies.cases.design import Design
from studies.kinds import Array

#: What is in proportion to the load factor, by effect.
SCALED = {
    "applied_force": "force",
    "applied_moment": "moment",
    "tip_force": "force",
    "driven_displacement": "displacement",
}
#: What the models call the error of the largest stress.
STRESS = ("stress", "largest_stress")
#: Part of an increment to which the place is solved for.
PRECISION = 1e-7


@dataclass(frozen=True, kw_only=True)
class Yield:
    """Where a strip begins to yield.

    Attributes:
        load_factor: [1]; rotation: [rad], NaN where no body turns.
        error: estimated, in parts of the rotation or, where that does not change, of the load factor [1]; NaN
            where it is not estimated.
    """

    load_factor: float
    rotation: float
    error: float


def first_yield(answer: Response, share: Array) -> Yield | None:
    """Return where the share (S,) of the yield strength is first 1 on the path of an answer; None if nowhere.

    The states between two increments are solved for, with the discretisation of the answer.
    """
    beyond = np.flatnonzero(share >= 1.0)
    if not beyond.size:
        return None
    turns = np.full(len(share), np.nan) if answer.body is None else answer.rotation
    places = np.stack((answer.load_factor, turns), axis=1)
    after = int(beyond[0])
    if after == 0:
        return Yield(load_factor=float(places[0, 0]), rotation=float(places[0, 1]), error=0.0)
    known: dict[float, tuple[float, Array]] = {
        float(k): (share[k] - 1.0, places[k]) for k in (after - 1, after)
    }
    stress = next((answer.errors[name] for name in STRESS if name in answer.errors), np.nan)
    error = stress * float(share.max()) / float(share[after] - share[after - 1])
    at = _root(answer, places, known, after)
    if at is None:  # the path between the increments is not found: their line is all that is known
        at, error = after - 1 + (1.0 - share[after - 1]) / (share[after] - share[after - 1]), np.nan
        known[at] = 0.0, _between(places, at)
    found, step = known[at][1], places[after] - places[after - 1]
    turned = bool(abs(step[1]) > 0.0 and found[1] != 0.0)
    part = abs(step[1] / found[1]) if turned else abs(step[0] / found[0])
    return Yield(load_factor=float(found[0]), rotation=float(found[1]), error=float(error * part))


class _Lost(RuntimeError):
    """A path to a state between two increments that stopped."""


def _root(
    answer: Response, places: Array, known: dict[float, tuple[float, Array]], after: int
) -> float | None:
    """Return where between two states the share is 1, and keep what is known there; None where paths stop."""
    limits = np.array([strip.yield_strength for strip in answer.design.strips], dtype=float)

    def beyond(at: float) -> float:
        if at not in known:
            there = _solved(answer, _between(places, at))
            share = float((there.strip_stress[-1] / limits).max())
            turn = np.nan if there.body is None else float(there.rotation[-1])
            known[at] = share - 1.0, np.array([_between(places, at)[0], turn])
        return known[at][0]

    try:
        at = float(brentq(beyond, after - 1.0, float(after), xtol=PRECISION))
        beyond(at)
    except _Lost:
        return None
    return at


def _between(places: Array, at: float) -> Array:
    """Return load factor and rotation (2,) of a place between states: both are linear there where led."""
    return np.array([np.interp(at, np.arange(len(places)), column) for column in places.T])


def _solved(answer: Response, place: Array) -> Response:
    """Return the answer to a path that ends at a load factor and rotation on that of an answer."""
    design: Design = answer.design
    effects = design.effects
    if set(effects.names) & SCALED.keys():
        effects = replace(effects, tables=_scaled(effects.parameters(), float(place[0])))
    changes: dict[str, Any] = {"effects": effects}
    if design.rotation is not None:
        changes["rotation"] = float(place[1])
    asked = put(replace(design, **changes), _settings(answer))
    path = asked.static_path(raise_on_failure=False)
    if str(path.status.value) != "converged":
        raise _Lost(path.message)
    if getattr(answer.solution, "balanced", False):
        path = replace(path, balanced=True)
    return Response.of(asked, path)


def _scaled(parameters: Mapping[str, Mapping[str, Any]], factor: float) -> dict[str, dict[str, Any]]:
    """Return parameters of effects with the loads and led displacements times a factor."""
    found = {name: dict(values) for name, values in parameters.items()}
    for name, key in SCALED.items():
        if name in found:
            value = np.multiply(found[name][key], factor)
            found[name][key] = float(value) if value.ndim == 0 else tuple(map(float, value))
    return found


def _settings(answer: Response) -> Settings:
    """Return the settings that an answer was reached with."""
    make: Callable[..., Settings] = settings_of_model
    names = {each.name for each in fields(make(answer.model))} - {"element"}
    return make(answer.model, **{name: value for name, value in answer.settings.items() if name in names})
