"""Static solution of a model: rotation of the body driven along a path, or a dead load raised in steps."""

from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import ConvergenceError, InvalidParameter, count, finite
from .model import Model
from .newton import Control
from .path import Path
from .recovery import recover
from .solution import StaticSolution, Status
from .structure import Structure

Array = NDArray[np.float64]
Progress = Callable[[int, int], None]
COUNTERS = (
    "increments",
    "halvings",
    "newton_iterations",
    "residual_evaluations",
    "tangent_evaluations",
    "factorisations",
)


def solve_statics(
    pivot: Model,
    *,
    rotation: float | Sequence[float],
    increments: int = 20,
    raise_on_failure: bool = True,
    progress: Progress | None = None,
) -> StaticSolution:
    """Drive the rotation of the body from 0 to `rotation` and return every state in between.

    Each increment is one tangent predictor and Newton with the consistent tangent on all other coordinates;
    an increment that fails, or whose state is not believed, is halved. The torque is the generalised force on
    the rotation, the stiffness the Schur complement of the tangent.

    Args:
        pivot: the model.
        rotation: end of the path [rad], or the ends of several legs, one after another.
        increments: equal increments of each leg.
        raise_on_failure: whether a path that ends early raises, or is returned with its status.
        progress: called as progress(done, total) after every increment.

    Raises:
        InvalidParameter: a rotation that is not finite, or fewer than one increment.
        ConvergenceError: the path ended early; carries the converged part.
    """
    ends = [finite("rotation", end, "rad") for end in np.ravel(rotation).tolist()]
    steps = count("increments", increments)
    if not ends:
        raise InvalidParameter("rotation", rotation, "at least one angle [rad]")
    targets = [a + (b - a) * k / steps for a, b in pairwise([0.0, *ends]) for k in range(1, steps + 1)]
    structure = pivot.structure
    control = Control(structure=structure, driven=True, load=np.zeros(structure.size))
    return _answer(_follow(control, targets, progress), len(targets), raise_on_failure)


def driven_state(structure: Structure, rotation: float, increments: int = 20) -> Array:
    """Return the reduced coordinates (size,) in equilibrium at a driven rotation [rad]; errors as above.

    At rest they are zero, which holds for a model without clamps as well.
    """
    if rotation == 0.0:
        return np.zeros(structure.size)
    control = Control(structure=structure, driven=True, load=np.zeros(structure.size))
    path = _follow(control, [rotation * k / increments for k in range(1, increments + 1)], None)
    _answer(path, increments, True)
    return path.states[-1].y


def solve_loads(
    model: Model,
    *,
    force: ArrayLike = (0.0, 0.0),
    moment: float = 0.0,
    increments: int = 20,
    raise_on_failure: bool = True,
    progress: Progress | None = None,
) -> StaticSolution:
    """Raise a dead force at the centre of the body and a moment on it in equal steps of one load factor.

    Args:
        model: the model.
        force: final force (2,) [N], fixed in space. moment: final moment [N m].
        increments, raise_on_failure, progress: as in `solve_statics`.
    """
    structure = model.structure
    pull = np.array([finite("force", part, "N") for part in np.ravel(np.asarray(force)).tolist()])
    if pull.shape != (2,):
        raise InvalidParameter("force", force, "two components [N]")
    load = np.zeros(structure.size)
    load[-3:] = *pull, finite("moment", moment, "N m")
    steps = count("increments", increments)
    control = Control(structure=structure, driven=False, load=load)
    path = _follow(control, [k / steps for k in range(1, steps + 1)], progress)
    return _answer(path, steps, raise_on_failure)


def _follow(control: Control, targets: Sequence[float], progress: Progress | None) -> Path:
    """Walk through the targets as far as they can be reached."""
    path = Path(control=control)
    path.begin()
    for done, target in enumerate(targets, start=1):
        if not path.advance(target):
            break
        if progress is not None:
            progress(done, len(targets))
    return path


def _answer(path: Path, total: int, raise_on_failure: bool) -> StaticSolution:
    """Pack a path, or raise if it ended before its `total` increments."""
    solution = _pack(path, total)
    if solution.status is not Status.CONVERGED and raise_on_failure:
        raise ConvergenceError(
            f"{path.message}; {solution.status.text}",
            solution=solution,
            load_factor=float(solution.load_factor[-1]),
            history=tuple(path.failures),
        )
    return solution


def _pack(path: Path, total: int) -> StaticSolution:
    """Gather the states of a path into arrays."""
    structure, states = path.control.structure, path.states
    energies = np.array([structure.energies(state.y) for state in states])
    fields = [recover(structure, state.y) for state in states]
    y = np.array([state.y for state in states])
    names = ("shape", "axial_force", "bending_moment", "shear_force", "clamp_reactions")
    return StaticSolution(
        status=Status.CONVERGED if len(states) == total + 1 else Status.NOT_CONVERGED,
        message=path.message,
        load_factor=np.arange(len(states)) / total,
        rotation=y[:, -1],
        centre=body_centre(structure, y),
        torque=np.array([state.torque for state in states]),
        stiffness=np.array([state.stiffness for state in states]),
        bending_energy=energies[:, 0],
        axial_energy=energies[:, 1],
        shear_energy=energies[:, 2],
        stations=structure.basis.mesh.p[0, : structure.stations] / structure.model.strips[0].length,
        counters={name: path.counters[name] for name in COUNTERS},
        history=tuple(state.norms for state in states[1:]),
        **{name: np.array([getattr(each, name) for each in fields]) for name in names},
    )


def body_centre(structure: Structure, y: Array) -> Array:
    """Return the body's centre of mass (S, 2) for coordinates (S, size), counted from the first clamp [m]."""
    c, s = np.cos(y[:, -1]), np.sin(y[:, -1])
    x0, y0 = structure.model.body.centre - structure.point
    arm = np.stack([c * x0 - s * y0, s * x0 + c * y0], axis=1)
    centre: Array = structure.point + y[:, -3:-1] + arm - structure.model.strips[0].nodes[0]
    return centre
