"""Baselines by name, and what this machine lacks of them.

Each is an object or a module with `model` (its name), `installed()`, `static_path(problem, rotations, *,
repeat, **settings)` and `release(problem, *, start, duration, step, repeat, **settings)`.
"""

from typing import Any

from studies.baselines import openseespy_frame
from studies.baselines.exudyn_strips import exudyn_ancf, exudyn_exact
from studies.baselines.four_bar import four_bar
from studies.baselines.linear_pivot import linear_pivot, pin_joint
from studies.record.extras import lacking

#: The models that are solved in closed form, and those that are other codes.
SURROGATES = {each.model: each for each in (linear_pivot, pin_joint, four_bar)}
PEERS: dict[str, Any] = {each.model: each for each in (exudyn_ancf, exudyn_exact, openseespy_frame)}

#: What to do about a peer that is not there.
HINT = "not installed: python -m pip install '.[peers]'"


def missing() -> str:
    """Return what this machine lacks of a study that holds the suite against all other codes; or nothing."""
    gone = [name.split()[0] for name, peer in PEERS.items() if not peer.installed()]
    return lacking("peers", list(dict.fromkeys(gone)))
