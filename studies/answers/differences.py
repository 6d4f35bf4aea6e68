"""How far the answers of several models to one design are apart."""

from collections.abc import Callable

import numpy as np

from studies.answers.response import StaticAnswer
from studies.kinds import Array

#: What is compared, by name: arrays over the states; angles count as they are, in rad.
QUANTITIES: dict[str, Callable[[StaticAnswer], Array]] = {
    "path": lambda answer: _moved(answer),
    "torque": lambda answer: answer.torque,
    "stiffness": lambda answer: answer.stiffness,
    "energy": lambda answer: answer.strain_energy,
    "stress": lambda answer: answer.max_stress,
    "body_stiffness": lambda answer: _without_units(answer.body_stiffness),
}


def differences(answer: StaticAnswer, other: StaticAnswer) -> dict[str, float | None]:
    """Return the largest difference of every quantity over the states that both reached, over its largest
    value in `other` [1]; None where there is nothing to compare."""
    both = min(len(answer.load_factor), len(other.load_factor))
    found: dict[str, float | None] = {}
    for name, of in QUANTITIES.items():
        if name == "body_stiffness" and (answer.driven is None or answer.solution is None):
            continue
        mine, theirs = of(answer)[:both], of(other)[:both]
        scale = float(np.abs(theirs).max(initial=0.0))
        found[name] = float(np.abs(mine - theirs).max()) / scale if scale > 0.0 else None
    return found


def _moved(answer: StaticAnswer) -> Array:
    """Return the displacements of all centres (S, B) [m], as complex numbers."""
    if not answer.bodies:
        return np.zeros((len(answer.load_factor), 0))
    centres = np.stack(list(answer.centres.values()), axis=1)
    moved = centres - centres[0]
    return np.asarray(moved[..., 0] + 1j * moved[..., 1])


def _without_units(stiffness: Array) -> Array:
    """Return stiffness matrices (S, 3, 3) over the units that make the diagonal at rest one."""
    unit = np.sqrt(np.abs(np.einsum("ii->i", stiffness[0])))
    return np.asarray(stiffness / (unit[:, None] * unit))
