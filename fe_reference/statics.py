"""Static solution of a model: a body driven along a path, or dead loads raised in steps."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from .arrays import Array
from .control import Control, require_balance, spans
from .effects import DrivenDisplacement
from .errors import InvalidParameter, choice, count, finite, pair, several
from .law import FORCES
from .loads import full_load
from .model import Model, require_model
from .path import COUNTERS, Path, Progress, follow
from .refined import confirmed, limit_of
from .section_forces import strip_fields
from .solution import ENERGIES, StaticSolution, Status, Stopwatch
from .structure import structure_of

#: How loads and a rotation meet.
LOADS_FIRST, TOGETHER = ORDERS = ("loads first", "together")
#: What an accuracy is asked of.
JUDGED = ("path", "torque", "stiffness", "strain_energy", "largest_stress")


def solve_statics(pivot: Model, *, rotation: float | Sequence[float], **options: Any) -> StaticSolution:
    """Drive the rotation of the one body there is from 0 to `rotation` [rad]: `solve_mechanism` of it."""
    require_model(pivot)
    pivot.body_index(None)
    return solve_mechanism(pivot, rotation=several("rotation", rotation, "rad"), **options)


def solve_mechanism(
    mechanism: Model,
    *,
    body: str | None = None,
    rotation: float | Sequence[float] | None = None,
    displacement: Sequence[float] | None = None,
    increments: int = 20,
    order: str = LOADS_FIRST,
    accuracy: float | None = None,
    check: bool = True,
    raise_on_failure: bool = True,
    progress: Progress | None = None,
) -> StaticSolution:
    """Lead a mechanism of any bodies from load factor 0 to 1 and return every state in between.

    Each increment is one extrapolation and Newton with the consistent tangent on all other coordinates; an
    increment that fails, or whose state is not believed, is halved. The torque is the generalised force on
    the driven rotation, the stiffness the Schur complement of the tangent. Gravity and natural strains act in
    full from the first state on, loads and the driven displacement of the scene as `order` says.

    Args:
        mechanism: strips, bodies and effects.
        body: name of the driven body; None: the only one.
        rotation: that it is led to [rad], or the ends of several legs, one after another; None: it is free.
        displacement: that its centre is led to (2,) [m]; None: the one of the effect driven_displacement, or
            free if that is not named.
        increments: equal increments of each leg, and of the loads before it.
        order: "loads first": they grow with the body held, and stay as it turns; "together": both grow with
            the load factor.
        accuracy: wanted error of path, torque, stiffness, strain energy and largest stress, in parts of the
            largest of each; the mesh is doubled until the estimate is below it, and the answer is the limit.
        check: whether critical points and an early end are compared with those of twice the elements; what
            is not confirmed is not resolved, see `refined.confirmed`.
        raise_on_failure: whether a path that ends early raises, or is returned with its status.
        progress: called as progress(done, total) after every increment.

    Raises:
        InvalidParameter: a rotation that is not finite, fewer than one increment, an unknown body, a drive
            without a body, a displacement given twice.
        ConvergenceError: the path ended early; carries the converged part. The accuracy was not reached;
            carries the best answer.
    """
    require_model(mechanism)
    ends = None if rotation is None else several("rotation", rotation, "rad")
    if displacement is not None:
        if "driven_displacement" in mechanism.effects:
            expected = "none beside the effect driven_displacement [m]"
            raise InvalidParameter("displacement", displacement, expected)
        led = DrivenDisplacement(displacement=pair("displacement", displacement, "m"))
        mechanism = replace(mechanism, effects=mechanism.effects.changed("driven_displacement", led))

    def solve(model: Model) -> StaticSolution:
        return _solved(model, body, ends, increments, progress, order=order)

    return _answered(mechanism, accuracy, solve, check).checked(raise_on_failure)


def _answered(
    model: Model, accuracy: float | None, solve: Callable[[Model], StaticSolution], check: bool
) -> StaticSolution:
    """Return the solution of a model, or to an accuracy the limit of its meshes, at the first one's nodes."""
    if accuracy is None:
        answer = solve(model)
        return confirmed(model, answer, (), solve) if check else answer
    structure = structure_of(model)
    length, force, moment = structure.length, structure.force_unit, structure.moment_unit
    section = model.strips[0]
    units = dict.fromkeys((*ENERGIES, "strain_energy", "torque", "stiffness", "bending_moment"), moment)
    units |= dict.fromkeys(("clamp_reactions", "axial_force", "shear_force"), force)
    units |= dict.fromkeys(("bodies", "shape"), length)
    units["largest_stress"] = moment * np.sqrt(3.0 / (section.area * section.second_moment_of_area))

    def path(places: Array) -> Array:
        moved: Array = (places - places[:, :1]) / np.array([length, length, 1.0])
        return moved

    solved: list[StaticSolution] = []

    def kept(mesh: Model) -> StaticSolution:
        solved.append(solve(mesh))
        return solved[-1]

    found = limit_of(model, accuracy, kept, units, {"path": path}, JUDGED)
    found = confirmed(found.model, found, solved, solve)
    every = (len(found.stations) - 1) // (found.shape.shape[2] - 1)
    return replace(found, stations=found.stations[::every])


def settled_state(
    model: Model,
    rotation: float | None,
    body: str | None = None,
    increments: int = 20,
    starts: bool = False,
) -> tuple[Array, str]:
    """Return the coordinates (size,) in equilibrium at a driven rotation [rad], and a remark on the path.

    Loads and the driven displacement of the scene act in full, or where a motion `starts` there as their
    histories begin; then rigid motions that nothing resists are held until then, whatever it takes. Errors as
    above.
    """
    structure, led = structure_of(model), model.effects.find(DrivenDisplacement)
    load = full_load(structure, time=0.0 if starts else None)
    ends = None if rotation is None else [finite("rotation", rotation, "rad")]
    if not rotation and load is None and led is None and not structure.constant_words:
        return np.zeros(structure.size), ""  # rest, whether or not clamps hold it
    if starts and led is not None:
        model = replace(model, effects=model.effects.changed("driven_displacement", led.at(0.0)))
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
    clock, steps, structure = Stopwatch(), count("increments", increments), structure_of(model)
    led = model.effects.find(DrivenDisplacement)
    driven = rotations is not None or (led is not None and led.body is None)
    which = model.body_index(body) if driven or body is not None else None
    acting = full_load(structure, time=0.0 if starts else None)
    first = choice("order", order, ORDERS) == LOADS_FIRST and rotations is not None and any(rotations)
    first = first and acting is not None and led is None  # a body that is led goes where both lead it
    controls = spans(
        structure,
        body=which,
        rotations=rotations,
        load=acting,
        first=first,
    )
    clock.stop("compile")
    path = follow(controls, steps, progress)
    clock.stop("solve")
    for state in () if starts else reversed(path.states):  # the load in full is named
        require_balance(structure, path.control.props, state.residual, acting)
    name = None if which is None else model.body_names[which]
    return _packed(path, controls, steps, clock, driven=name, led=rotations is not None)


def _packed(
    path: Path, controls: Sequence[Control], steps: int, clock: Stopwatch, *, driven: str | None, led: bool
) -> StaticSolution:
    """Gather the states of a path into arrays."""
    total = steps * len(controls)
    shares = [c.share(p) for c in controls for p in np.linspace(*c.span, steps + 1)[1:]]
    structure, states = path.control.structure, path.states
    model, here = structure.model, [structure.evaluate(state.y, asked=FORCES) for state in states]
    y, strain = np.array([state.y for state in states]), np.array([at.strain for at in here])
    fields = strip_fields(model, y, np.array([at.ends for at in here]))
    answers: dict[str, Any] = {
        name: np.array([getattr(state, name) for state in states])
        for name in ("torque", "stiffness", "inertia", "work")
    }
    return StaticSolution(
        status=Status.CONVERGED if len(states) == total + 1 else Status.NOT_CONVERGED,
        message=path.remark(),
        critical_points=tuple(path.critical),
        load_factor=np.array([0.0, *shares])[: len(states)],
        bodies={name: fields.bodies[:, k] for k, name in enumerate(model.body_names)},
        **answers,
        bending_energy=strain[:, 0],
        axial_energy=strain[:, 1],
        shear_energy=strain[:, 2],
        gravity_energy=np.array([at.gravity for at in here]),
        clamp_reactions=fields.reactions,
        largest_stress=fields.outer_stress(model).max(axis=(1, 2)),
        stations=structure.basis.mesh.p[0, : structure.stations] / model.lengths[0],
        **{name: getattr(fields, name) for name in ("shape", "axial_force", "shear_force", "bending_moment")},
        states=y,
        model=model,
        driven=driven,
        led=led,
        effects=model.effects.names,
        counters={name: path.counters[name] for name in (*COUNTERS, "settling_increments")},
        history=(*(state.norms for state in states[1:]), *path.failures),
        seconds=clock.stop("recover"),
    )
