"""A state from a guess of any kind: the primary branch, or a refusal."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.continuation.start import equilibrium
from spline_model.errors import InvalidParameter
from spline_model.path import follow
from spline_model.reduced.elements import followed
from spline_model.solution import Path, Status

Array = NDArray[np.float64]

HOME = 1e-6
"""Distance from rest at which a path has come home, in lengths of a strip and rad."""


def recover(system: System, load_factor: float, guess: Array, increments: int) -> Path:
    """The state of the primary branch at a load factor, one state; ``message`` says how it was found.

    What Newton finds from the guess is believed if the path from there back to load factor
    0 ends at rest; a wound-up or snapped strip has equilibria too, and passes every local
    check. Otherwise the path is followed from rest. Raises InvalidParameter for a guess that
    is no vector of unknowns.
    """
    whole = np.linspace(0.0, load_factor, increments + 1)
    try:
        found = equilibrium(work := followed(system), load_factor, guess)
    except InvalidParameter as error:
        if np.shape(guess) != (system.layout.size,):
            raise
        reason = str(error.got)
    else:
        back = follow(system, list(whole[-2::-1]), start=(load_factor, work.unknowns(found.z)))
        reason = "it lies on another branch"
        if back.status is Status.CONVERGED and _is_rest(system, back.states[-1]):
            return _only(back, 0, "found from the given state")
    path = follow(system, list(whole[1:]))
    if path.status is not Status.CONVERGED:
        return path
    return _only(path, -1, f"solved from rest, the given state led nowhere ({reason})")


def _is_rest(system: System, z: Array) -> bool:
    rest = follow(system, []).states[0]
    count = system.layout.coordinate_count
    return bool(np.abs((z - rest)[:count] / system.scales.unit[:count]).max() < HOME)


def _only(path: Path, place: int, message: str) -> Path:
    """One state of a path."""
    at = place % len(path.work)
    return replace(path, message=message, **path.rows(slice(at, at + 1)))
