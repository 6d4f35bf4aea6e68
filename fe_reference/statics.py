"""Static solution of a model: a body driven along a path, or dead loads raised in steps."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .effects.loads import DeadLoad, at_body, together
from .effects.named import DrivenDisplacement
from .errors import InvalidParameter, count, finite, pair, several
from .follow import COUNTERS, Progress, checked, follow, full_load, load_factors, spans
from .model import Model
from .path import Path
from .recovery import recover
from .solution import MechanismSolution, StaticSolution, Status
from .stopwatch import Stopwatch
from .structure import Structure

Array = NDArray[np.float64]


def solve_statics(
    pivot: Model,
    *,
    rotation: float | Sequence[float],
    increments: int = 20,
    raise_on_failure: bool = True,
    progress: Progress | None = None,
) -> StaticSolution:
    """Drive the rotation of the one body from 0 to `rotation` and return every state in between.

    Each increment is one tangent predictor and Newton with the consistent tangent on all other coordinates;
    an increment that fails, or whose state is not believed, is halved. The torque is the generalised force on
    the rotation, the stiffness the Schur complement of the tangent. Gravity and natural strains act in full
    from the first state on, loads and the driven displacement of the scene grow with the load factor.

    Args:
        pivot: the model.
        rotation: end of the path [rad], or the ends of several legs, one after another.
        increments: equal increments of each leg.
        raise_on_failure: whether a path that ends early raises, or is returned with its status.
        progress: called as progress(done, total) after every increment.

    Raises:
        InvalidParameter: a rotation that is not finite, fewer than one increment, several bodies.
        ConvergenceError: the path ended early; carries the converged part.
    """
    watch = Stopwatch()
    ends = several("rotation", rotation, "rad")
    steps = count("increments", increments)
    structure, body = pivot.structure, pivot.body_index(None)
    controls = spans(
        structure,
        body=body,
        rotations=ends,
        displacement=_displacement(pivot, None),
        load=full_load(structure),
        watched=int(structure.turns[body]),
    )
    watch.stop("compile")
    path = follow(controls, steps, progress)
    watch.stop("solve")
    solution: StaticSolution = checked(_pack(path, steps * len(ends), watch), path, raise_on_failure)
    return solution


def solve_loads(
    model: Model,
    *,
    force: ArrayLike = (0.0, 0.0),
    moment: float = 0.0,
    increments: int = 20,
    raise_on_failure: bool = True,
    progress: Progress | None = None,
) -> StaticSolution:
    """Raise a dead force at the centre of the one body and a moment on it in equal steps of the load factor.

    Args:
        model: the model; loads and the driven displacement that its scene names are added.
        force: final force (2,) [N], fixed in space. moment: final moment [N m].
        increments, raise_on_failure, progress: as in `solve_statics`.
    """
    watch = Stopwatch()
    structure = model.structure
    pull = [finite("force", part, "N") for part in np.ravel(np.asarray(force)).tolist()]
    if len(pull) != 2:
        raise InvalidParameter("force", force, "two components [N]")
    mine = at_body(structure, None, force=pull, moment=finite("moment", moment, "N m"))
    named = full_load(structure)
    load = together([mine] if named is None else [mine, named])
    steps = count("increments", increments)
    led = _displacement(model, None)
    controls = spans(structure, displacement=led, load=load, watched=int(structure.turns[0]))
    watch.stop("compile")
    path = follow(controls, steps, progress)
    watch.stop("solve")
    solution: StaticSolution = checked(_pack(path, steps, watch), path, raise_on_failure)
    return solution


def solve_mechanism(
    mechanism: Model,
    *,
    body: str | None = None,
    rotation: float | None = None,
    displacement: Sequence[float] | None = None,
    increments: int = 20,
    raise_on_failure: bool = True,
    progress: Progress | None = None,
) -> MechanismSolution:
    """Return the states of a mechanism of any bodies from load factor 0 to 1.

    Args:
        mechanism: strips, bodies and effects.
        body: name of the driven body; None: the only one.
        rotation: that it is led to [rad]; None: its rotation is free.
        displacement: that its centre is led to (2,) [m]; None: the one of the effect driven_displacement, or
            free if that is not named.
        increments, raise_on_failure, progress: as in `solve_statics`.

    Gravity and natural strains act in full from load factor 0 on; drives and loads grow with it.

    Raises:
        InvalidParameter: an unknown body, a drive without a body, a displacement given twice.
        ConvergenceError: the path ended early; carries the converged part.
    """
    watch = Stopwatch()
    steps, structure = count("increments", increments), mechanism.structure
    led = _displacement(mechanism, displacement)
    driven = rotation is not None or led is not None
    which = mechanism.body_index(body) if driven or body is not None else None
    controls = spans(
        structure,
        body=which,
        rotations=None if rotation is None else [finite("rotation", rotation, "rad")],
        displacement=led,
        load=full_load(structure),
        watched=int(structure.turns[which]) if which is not None and rotation is not None else None,
    )
    watch.stop("compile")
    path = follow(controls, steps, progress)
    watch.stop("solve")
    packed = _pack_mechanism(path, steps, watch)
    solution: MechanismSolution = checked(packed, path, raise_on_failure)
    return solution


def static_state(
    model: Model,
    rotation: float | None,
    body: str | None = None,
    increments: int = 20,
    load: DeadLoad | None = None,
) -> Array:
    """Return the coordinates (size,) of `model.structure` in equilibrium at a driven rotation [rad].

    The load is by default that of the scene in full, as is its driven displacement. Errors as above; the
    solution that a ConvergenceError carries is that of a mechanism.
    """
    structure, led = model.structure, _displacement(model, None)
    which = model.body_index(body) if rotation is not None or led is not None else None
    controls = spans(
        structure,
        body=which,
        rotations=None if rotation is None else [finite("rotation", rotation, "rad")],
        displacement=led,
        load=full_load(structure) if load is None else load,
        watched=int(structure.turns[which]) if which is not None and rotation is not None else None,
    )
    first = controls[0]
    if not first.values.any() and first.load is None and not structure.constant_effects:
        return np.zeros(structure.size)  # rest, whether or not clamps hold it
    steps = count("increments", increments)
    path = follow(controls, steps)
    checked(_pack_mechanism(path, steps, Stopwatch()), path, True)
    return path.states[-1].y


def _displacement(model: Model, given: Sequence[float] | None) -> tuple[float, float] | None:
    """Return the displacement that is asked for or named [m]."""
    named = model.effects.find(DrivenDisplacement)
    if given is None:
        return None if named is None else named.displacement
    if named is not None:
        raise InvalidParameter("displacement", given, "none beside the effect driven_displacement [m]")
    return pair("displacement", given, "m")


def _status(path: Path, total: int) -> Status:
    return Status.CONVERGED if len(path.states) == total + 1 else Status.NOT_CONVERGED


def _energies(path: Path) -> dict[str, Any]:
    """Return energies and work [J], torque, stiffness and inertia of the states, arrays (S,) by name."""
    structure, states = path.control.structure, path.states
    energies = np.array([structure.energies(state.y) for state in states])
    return {
        "bending_energy": energies[:, 0],
        "axial_energy": energies[:, 1],
        "shear_energy": energies[:, 2],
        "gravity_energy": np.array([structure.gravity_energy(state.y) for state in states]),
        "work": np.array([state.work for state in states]),
        "torque": np.array([state.response.torque for state in states]),
        "stiffness": np.array([state.response.stiffness for state in states]),
        "inertia": np.array([state.response.inertia for state in states]),
    }


def _pack(path: Path, total: int, watch: Stopwatch) -> StaticSolution:
    """Gather the states of a path of one body into arrays."""
    structure, states = path.control.structure, path.states
    fields = [recover(structure, state.y) for state in states]
    y = np.array([state.y for state in states])
    origin = structure.model.strips[0].nodes[0]
    names = ("axial_force", "bending_moment", "shear_force", "clamp_reactions")
    return StaticSolution(
        status=_status(path, total),
        message=path.remark(),
        critical_points=tuple(path.critical),
        load_factor=load_factors(path, total),
        rotation=y[:, -1],
        centre=body_motion(structure, y, 0)[:, :2] - origin,
        stations=structure.basis.mesh.p[0, : structure.stations] / structure.model.strips[0].length,
        shape=np.array([each.shape - origin for each in fields]),
        states=y,
        counters={name: path.counters[name] for name in COUNTERS},
        history=tuple(state.norms for state in states[1:]),
        **_energies(path),
        **{name: np.array([getattr(each, name) for each in fields]) for name in names},
        seconds=watch.stop("recover"),
    )


def _pack_mechanism(path: Path, total: int, watch: Stopwatch) -> MechanismSolution:
    """Gather the states of a mechanism."""
    structure, states = path.control.structure, path.states
    y = np.array([state.y for state in states])
    fields = [recover(structure, state.y) for state in states]
    names = structure.model.body_names
    return MechanismSolution(
        status=_status(path, total),
        message=path.remark(),
        critical_points=tuple(path.critical),
        load_factor=load_factors(path, total),
        bodies={name: body_motion(structure, y, k) for k, name in enumerate(names)},
        shape=np.array([each.shape for each in fields]),
        bending_moment=np.array([each.bending_moment for each in fields]),
        clamp_reactions=np.array([each.clamp_reactions for each in fields]),
        states=y,
        effects=structure.model.effects.names,
        counters={name: path.counters[name] for name in (*COUNTERS, "settling_increments")},
        history=tuple(state.norms for state in states[1:]),
        **_energies(path),
        seconds=watch.stop("recover"),
    )


def body_motion(structure: Structure, y: Array, body: int) -> Array:
    """Return the place of a body's centre and its turn (S, 3) [m, rad] for coordinates (S, size)."""
    place = y[:, structure.body_slice(body)]
    c, s = np.cos(place[:, 2]), np.sin(place[:, 2])
    x0, y0 = structure.model.bodies[body].centre - structure.points[body]
    moved = structure.points[body] + place[:, :2] + np.stack([c * x0 - s * y0, s * x0 + c * y0], axis=1)
    return np.concatenate([moved, place[:, 2:]], axis=1)
