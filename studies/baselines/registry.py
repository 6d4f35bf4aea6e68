"""Baselines by name, and what this machine lacks of them.

Each is an object or a module with `model` (its name), `installed()`, `static_path(problem, rotations, *,
repeat, **settings)` and `release(problem, *, start, duration, step, repeat, **settings)`.
"""

from typing import Any

from studies.baselines import openseespy_frame
from studies.baselines.constraint_model import chained_constraint_model, constraint_model
from studies.baselines.exudyn_strips import exudyn_ancf, exudyn_exact
from studies.baselines.four_bar import four_bar
from studies.baselines.linear_pivot import linear_pivot, pin_joint
from studies.record.extras import lacking

#: Models of which the rotation is the only coordinate, those whose beams have others that are eliminated, and
#: other codes.
PSEUDO_RIGID = {each.model: each for each in (linear_pivot, pin_joint, four_bar)}
SURROGATES = PSEUDO_RIGID | {each.model: each for each in (constraint_model, chained_constraint_model)}
PEERS: dict[str, Any] = {each.model: each for each in (exudyn_ancf, exudyn_exact, openseespy_frame)}

#: What to do about a peer that is not there.
HINT = "not installed: python -m pip install '.[peers]'"


def missing() -> str:
    """Return what this machine lacks of a study that holds the suite against all other codes; or nothing."""
    gone = [name.split()[0] for name, peer in PEERS.items() if not peer.installed()]
    return lacking("peers", list(dict.fromkeys(gone)))
