"""Static solution of a model: a body driven along a path, or dead loads raised in steps."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from . import read
from .arrays import Array
from .control import require_balance, spans
from .effects import WAYS, Prescribed
from .law import FORCES
from .model import Model, require_model
from .path import COUNTERS, Path, Progress, follow
from .refined import confirmed, limit_of
from .solution import ENERGIES, StaticSolution, Status, strip_fields
from .structure import structure_of

#: How loads and a rotation meet.
LOADS_FIRST, TOGETHER = ORDERS = ("loads first", "together")


def solve_statics(
    mechanism: Model,
    *,
    body: str | None = None,
    rotation: float | Sequence[float] | None = None,
    increments: int = 20,
    order: str = LOADS_FIRST,
    accuracy: float | None = None,
    check: bool = True,
    raise_on_failure: bool = True,
    progress: Progress | None = None,
) -> StaticSolution:
    """Solve a mechanism from load factor 0 to 1 and return every state in between.

    Each increment is one extrapolation and Newton with the consistent tangent on all other coordinates; an
    increment that fails, or whose state is not believed, is halved. The torque is the generalised force on
    the driven rotation, the stiffness the Schur complement of the tangent. Gravity and natural strains act in
    full from the first state on, loads and the driven displacement of the scene as given by `order`.

    Parameters
    ----------
    mechanism : Model
    body : str, default None
        Driven body; None: the only one.
    rotation : float or sequence of float, rad, default None
        End of the path, or ends of several legs, one after the other; None: free.
    increments : int, default 20
        Equal increments of each leg, and of the loads before it.
    order : str
        "loads first" (default): loads grow with the body held, and then are constant. "together": loads and
        rotation grow with the load factor.
    accuracy : float, 1, default None
        Wanted error of path, torque, stiffness, strain energy, largest stress and what is exerted on bodies,
        relative to the largest of each. The mesh is doubled until the estimate is below it, and the answer is
        the limit.
    check : bool, default True
        Confirm critical points and an early end by twice the elements, see ``fe_reference.refined``.
    raise_on_failure : bool, default True
        Raise an error for a path that ends early, or return it with its status.
    progress : callable, default None
        Called as progress(done, total) after every increment.

    Returns
    -------
    StaticSolution
        S states, the unloaded state first: rotation (S,), torque (S,), stiffness (S,), centre (S, 2), ...

    Raises
    ------
    InvalidParameter
        A rotation that is not finite, fewer than one increment, an unknown body, a drive without a body.
    ConvergenceError
        The path ended early; it carries the converged part. Or the accuracy was not reached; it carries the
        best answer.

    References
    ----------
    Crisfield (1991) and Reissner (1972), as in ``fe_reference.law``.

    Examples
    --------
    With ``pivot`` of the example of ``fe_reference.model.cross_axis_pivot``:

    >>> path = solve_statics(pivot, rotation=0.3, increments=5)
    >>> print(f"{path.torque[-1]:.4f} N m")
    0.1634 N m
    >>> solve_statics(pivot, rotation=[0.1, 0.0], increments=2).rotation.round(3).tolist()
    [0.0, 0.05, 0.1, 0.05, 0.0]
    """
    require_model(mechanism)
    ends = None if rotation is None else read.several("rotation", rotation, "rad")

    def solve(model: Model) -> StaticSolution:
        return _solved(model, body, ends, increments, progress, order=order)

    if accuracy is not None:
        answer = limit_of(mechanism, accuracy, solve)
    else:
        answer = solve(mechanism)
        answer = confirmed(mechanism, answer, (), solve) if check else answer
    return answer.checked(raise_on_failure)


def settled_state(
    model: Model, rotation: float | None, body: str | None, increments: int, starts: bool = False
) -> tuple[Array, str]:
    """Return the coordinates (size,) in equilibrium at a driven rotation [rad], and a remark on the path.

    Loads and the driven displacement of the scene act in full, or where a motion `starts` there as their
    histories begin; then rigid motions that nothing resists are held until then, whatever it takes. Errors as
    above.
    """
    structure, moved = structure_of(model), any(any(led.ends) for led in model.every(Prescribed))
    ends = None if rotation is None else [read.finite("rotation", rotation, "rad")]
    if not rotation and structure.loads.factors() is None and not moved and not structure.constant_words:
        return np.zeros(structure.size), ""  # rest, whether or not clamps hold it
    solution = _solved(model, body, ends, increments, None, starts=starts).checked()
    return solution.states[-1], _passed(solution)


def _passed(solution: StaticSolution) -> str:
    """Return the critical points that a path passes before a motion starts at its end, in words."""
    told = []
    for point in solution.critical_points:
        told.append(f"{point.kind} at load factor {point.load_factor:.3g}")
        if np.isfinite(point.rotation) and point.rotation:
            told[-1] += f" ({np.degrees(point.rotation):.3g} deg)"
    if solution.inertia[-1]:
        told.append("the start is unstable while it is held")
    return "; ".join(told)


def _solved(
    model: Model,
    body: str | None,
    rotations: Sequence[float] | None,
    increments: int,
    progress: Progress | None,
    *,
    order: str = LOADS_FIRST,
    starts: bool = False,
) -> StaticSolution:
    """Follow the path through the rotations [rad], one leg each, under the loads in full or as they start."""
    steps, structure = read.count("increments", increments), structure_of(model)
    driven = rotations is not None or any(each.body is None for each in model.every(Prescribed))
    which = model.body_index(body) if driven or body is not None else None
    first = read.choice("order", order, ORDERS) == LOADS_FIRST
    controls = spans(structure, which, rotations, first=first, starts=starts)
    path = follow(controls, steps, progress)
    for state in () if starts else reversed(path.states):  # the load in full is named
        require_balance(path.control, state.at.gradient)
    shares = [c.share(p) for c in controls for p in np.linspace(*c.span, steps + 1)[1:]]
    driven_body = None if which is None else model.body_names[which]
    return _packed(path, np.array([0.0, *shares]), driven_body, rotations is not None)


def _packed(path: Path, shares: Array, driven: str | None, led: bool) -> StaticSolution:
    """Gather the states of a path into arrays; `shares` are the load factors of the whole path."""
    structure, states = path.control.structure, path.states
    model, here = structure.model, [structure.evaluate(state.y, asked=FORCES) for state in states]
    y = np.array([state.y for state in states])
    fields = strip_fields(model, y, np.array([at.ends for at in here]))
    held = path.control.held[: len(path.control.held) - len(path.control.props)] - structure.first_body
    answers: dict[str, Any] = {
        name: np.array([getattr(state, name) for state in states])
        for name in ("torque", "stiffness", "inertia", "work")
    }
    return StaticSolution(
        status=Status.CONVERGED if len(states) == len(shares) else Status.NOT_CONVERGED,
        message=path.remark(),
        critical_points=tuple(path.critical),
        load_factor=shares[: len(states)],
        bodies={name: fields.bodies[:, k] for k, name in enumerate(model.body_names)},
        **answers,
        **dict(zip(ENERGIES, np.array([(*at.strain, at.spring, at.gravity) for at in here]).T, strict=False)),
        prescribed=tuple((model.body_names[at // 3], WAYS[at % 3]) for at in held),
        reactions=np.array([state.drive for state in states])[:, : len(held)],
        tips=fields.tips(model),
        clamp_reactions=fields.reactions,
        largest_stress=fields.outer_stress(model).max(axis=(1, 2)),
        stations=structure.basis.mesh.p[0, : structure.stations] / model.lengths[0],
        **{name: getattr(fields, name) for name in ("shape", "axial_force", "shear_force", "bending_moment")},
        states=y,
        model=model,
        driven=driven,
        led=led,
        counters={name: path.counters[name] for name in (*COUNTERS, "settling_increments")},
        history=(*(state.norms for state in states[1:]), *path.failures),
        seconds={"solve": path.seconds},
    )
