"""Answers of the static solution: a status that says what to do, and arrays over the converged states.

Fields along the strips, at any states of a path or a motion: shape, strains and section forces.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from .arrays import Array, Indices
from .effects import PreStrain
from .law import FORCES
from .model import Model, require_model
from .places import FREE
from .read import ConvergenceError, InvalidParameter, Norms
from .response import CriticalPoint, body_stiffness
from .structure import structure_of

if TYPE_CHECKING:
    import pandas as pd


class Status(StrEnum):
    """How a solve ended.

    Examples
    --------
    With ``pivot`` of the example of ``fe_reference.model.cross_axis_pivot``:

    >>> solve_statics(pivot, rotation=0.1).status.value
    'converged'
    >>> Status.CONVERGED.text
    'converged: the whole path was solved; nothing to do.'
    """

    CONVERGED = "converged"
    NOT_CONVERGED = "not_converged"
    UNSTABLE = "unstable"

    @property
    def text(self) -> str:
        """One sentence, ending with a remedy."""
        return {
            Status.CONVERGED: "converged: the whole path was solved; nothing to do.",
            Status.NOT_CONVERGED: "not converged: the path ends early; use more increments or a finer mesh.",
            Status.UNSTABLE: "unstable: the energy grew without bound; use a smaller time step.",
        }[self]


@dataclass(frozen=True, kw_only=True)
class ErrorEstimate:
    """Estimated errors of an answer that meshes were refined for.

    Attributes:
        accuracy: what was asked for [1]. meshes: elements of a strip on each of them.
        stopped: elements of a finer mesh that round-off stopped early; 0 for none.
        errors: by quantity, the largest over the states in parts of its largest value [1].

    Examples
    --------
    With ``pivot`` of the example of ``fe_reference.model.cross_axis_pivot``:

    >>> path = solve_statics(pivot, rotation=0.1, accuracy=1e-3)
    >>> bool(path.estimate.largest <= 1e-3)
    True
    """

    accuracy: float
    meshes: tuple[int, ...]
    errors: Mapping[str, float]
    stopped: int = 0

    @property
    def elements(self) -> int:
        """Elements of a strip on the finest mesh."""
        return self.meshes[-1]

    @property
    def largest(self) -> float:
        """The largest of the estimated relative errors [1]."""
        return max(self.errors.values())


@dataclass(frozen=True, kw_only=True, eq=False)
class Answer:
    """Common part of solutions and trajectories.

    Attributes:
        status: whether the whole of it was reached.
        message: why it ended early ("" if it did not).
        bodies: places x, y and turn of each body by its name (S, 3) [m, m, rad].
        shape: positions of the nodes (S, G, P, 2) [m].
        states: reduced coordinates (S, size) [m, rad].
        gravity_energy, work: of the weight, and of drives and loads since the first state (S,) [J].
        counters: counted steps and iterations by name.
        history: residual norms of iterations.
        seconds: "solve", of the solution alone [s].
        estimate: estimated error, if it was asked for.
    """

    status: Status
    message: str
    bodies: Mapping[str, Array]
    shape: Array
    states: Array
    gravity_energy: Array
    work: Array
    counters: Mapping[str, int]
    history: Norms
    seconds: Mapping[str, float]
    estimate: ErrorEstimate | None = None

    def __post_init__(self) -> None:
        """Make all arrays read only."""
        for value in vars(self).values():
            for array in value.values() if isinstance(value, Mapping) else (value,):
                if isinstance(array, np.ndarray):
                    array.flags.writeable = False

    @property
    def reached(self) -> float:
        """Part of what was asked that was reached [1]."""
        raise NotImplementedError

    def checked(self, raise_on_failure: bool = True) -> Self:
        """Return the answer, or raise it as a ConvergenceError if it ended early and that is to raise."""
        if self.status is Status.CONVERGED or not raise_on_failure:
            return self
        told = self.message if self.estimate is not None else f"{self.message}; {self.status.text}"
        raise ConvergenceError(told, solution=self, load_factor=self.reached, history=self.history)

    @property
    def rotation(self) -> Array:
        """Turn of the only body (S,) [rad]."""
        return _only(self.bodies)[:, 2]

    @property
    def centre(self) -> Array:
        """Centre of mass of the only body (S, 2) [m]."""
        return _only(self.bodies)[:, :2]

    def columns(self) -> dict[str, Array]:
        """Return the columns of a table: arrays (S,) of one number in every state, by names with units."""
        raise NotImplementedError

    @staticmethod
    def body_columns(bodies: Mapping[str, Array], names: tuple[str, ...]) -> dict[str, Array]:
        """Return the columns (S,) [m, rad] of arrays (S, 3) of bodies, named after them if there are many."""
        many = len(bodies) > 1
        return {
            f"{body}_{name}" if many else name: values[:, k]
            for body, values in bodies.items()
            for k, name in enumerate(names)
        }

    def to_frame(self) -> "pd.DataFrame":
        """Return the columns as a table, a row a state."""
        import pandas as pd

        return pd.DataFrame(self.columns())


@dataclass(frozen=True, kw_only=True, eq=False)
class StaticSolution(Answer):
    """Converged states of a static path, the unloaded one first: S states, G strips, P nodes a strip.

    Attributes:
        status, message: how the solve ended; why and where it stopped, what was critical on the way ("" if
            nothing was).
        inertia (S,): negative eigenvalues of the tangent with the drives held, 0 for a stable state.
        critical_points: in the order of the path.
        load_factor (S,): fraction of the path, or of the load in load control [1].
        bodies: by name, place of the centre [m] and turn [rad], (S, 3) x, y, theta.
        torque (S,): generalised force on the watched rotation [N m]: the driving torque, or the applied
            moment; nan if no rotation is driven or watched.
        stiffness (S,): d torque / d rotation from the consistent tangent, all else free [N m/rad].
        bending_energy, axial_energy, shear_energy (S,): strain energy of all strips by part [J].
        spring_energy (S,): of springs between bodies and to the ground [J].
        gravity_energy (S,): energy of the weight, zero in the shape at rest [J].
        work (S,): of drives and loads since the first state, by Hermite's rule over the increments [J].
        prescribed: the D coordinates that are driven or supported: name of the body, and "x", "y" or
            "rotation". reactions (S, D): the force [N] or moment [N m] that is exerted on the body for it.
        tips: by strip, place x, y [m] of its free end and turn of the section there [rad], (S, 3).
        clamp_reactions (S, G, 2, 3): force x, y [N] and moment [N m] exerted on the strip at its root (0) and
            at its tip (1).
        largest_stress (S,): over all strips, of sections taken as rectangles [Pa].
        stations (P,): reference arc length of the nodes over the first strip's length, 0 at its root [1].
        shape, axial_force, shear_force, bending_moment: as in `StripFields`.
        states (S, size): reduced coordinates, for `strip_fields`, of the finest mesh: that of `model`.
        driven: name of the body whose turn is led or watched; None without one. led: whether it is led.
        counters: increments, halvings, newton_iterations, evaluations, factorisations, and
            settling_increments: of the way to the first state. history: residual norms of the increments,
            and of the attempts that failed.
        seconds: "solve", of following the path alone [s].
        estimate: of the error, where an accuracy was asked for: then all arrays but `states` and `inertia`
            are limits of meshes, at the nodes of the coarsest.

    References
    ----------
    Valentini and Pezzuti (2013), Figs 4 and 5.

    Examples
    --------
    With ``pivot`` of the example of ``fe_reference.model.cross_axis_pivot``:

    >>> path = solve_statics(pivot, rotation=0.1, increments=4)
    >>> path.torque.shape, path.bodies["body"].shape
    ((5,), (5, 3))
    """

    inertia: Indices
    critical_points: tuple[CriticalPoint, ...]
    load_factor: Array
    torque: Array
    stiffness: Array
    bending_energy: Array
    axial_energy: Array
    shear_energy: Array
    spring_energy: Array
    prescribed: tuple[tuple[str, str], ...]
    reactions: Array
    tips: Mapping[str, Array]
    clamp_reactions: Array
    largest_stress: Array
    stations: Array
    axial_force: Array
    bending_moment: Array
    shear_force: Array
    model: Model
    driven: str | None
    led: bool

    @property
    def reached(self) -> float:
        """Load factor of the last state [1]."""
        return float(self.load_factor[-1])

    @property
    def strain_energy(self) -> Array:
        """Sum of the three parts (S,), without springs between bodies [J]."""
        return self.bending_energy + self.axial_energy + self.shear_energy

    def until(self, count: int) -> Self:
        """Return the answer with its first states alone."""

        def first(value: Any) -> Any:
            return {k: it[:count] for k, it in value.items()} if isinstance(value, dict) else value[:count]

        arrays = {name for name, value in vars(self).items() if isinstance(value, np.ndarray)} - {"stations"}
        return replace(self, **{name: first(getattr(self, name)) for name in arrays | {"bodies", "tips"}})

    def body_stiffness(self, body: str | None = None) -> Array:
        """Return the stiffness (S, 3, 3) [N/m, N, N m] of a body's x, y and turn, on the finest mesh.

        Args:
            body: its name; None: the driven one, or the only one.

        Raises:
            InvalidParameter: there is no such body.
        """
        led = self.driven if self.led else None
        return body_stiffness(self.model, self.states, self.load_factor, body or self.driven, driven=led)

    def columns(self) -> dict[str, Array]:
        """Return the columns of a frame: arrays (S,) of one number in every state, by names with units."""
        return {
            "load_factor": self.load_factor,
            **self.body_columns(self.bodies, ("x_m", "y_m", "rotation_rad")),
            "torque_Nm": self.torque,
            "stiffness_Nm_per_rad": self.stiffness,
            **{f"{name}_J": getattr(self, name) for name in ENERGIES},
            "largest_stress_Pa": self.largest_stress,
            "inertia": self.inertia,
        }


ENERGIES = ("bending_energy", "axial_energy", "shear_energy", "spring_energy", "gravity_energy", "work")


def _only(bodies: Mapping[str, Array]) -> Array:
    """Return what belongs to the one body there is."""
    if len(bodies) != 1:
        known = ", ".join(bodies) or "none"
        raise InvalidParameter("bodies", known, "one body, or the name of one in `bodies` [name]")
    return next(iter(bodies.values()))


@dataclass(frozen=True, kw_only=True, eq=False)
class StripFields:
    """Nodal values of G strips with P nodes from root to tip, for S states.

    Attributes:
        arc_length (G, P): at rest [m]. rest_shape (G, P, 2): positions at rest [m].
        shape (S, G, P, 2): positions [m].
        rotation (S, G, P): turn of the section from rest, as the nodes have it, without wrapping [rad]; at an
            end whose root gives way that of the strip's section, not the body's.
        curvature (S, G, P): d theta / d s0, that at rest and M / EI + natural curvature [1/m]; of sections
            that do not curl freely the means of the adjacent elements' turns over their lengths.
        stretch (S, G, P): 1 + N / EA + natural strain [1].
        axial_force, shear_force (S, G, P): N = n.t, V = n.normal [N] at the nodes: n is the force of the part
            beyond on the part before, t the normal of the cross-section, normal = t turned by +90 deg.
        bending_moment (S, G, P): M at the nodes [N m], positive for counter-clockwise curvature from root.
        reactions (S, G, 2, 3): force x, y [N] and moment [N m] on the strip at its root and its tip; at a
            free end the force that acts there.
        rest_bodies (B, 2): centres at rest [m]. bodies (S, B, 3): centre [m] and turn [rad].

    Examples
    --------
    With ``pivot`` of the example of ``fe_reference.model.cross_axis_pivot``:

    >>> path = solve_statics(pivot, rotation=0.1, increments=4)
    >>> strip_fields(pivot, path.states).bending_moment.shape == (5, 2, pivot.elements + 1)
    True
    """

    arc_length: Array
    rest_shape: Array
    shape: Array
    rotation: Array
    curvature: Array
    stretch: Array
    axial_force: Array
    shear_force: Array
    bending_moment: Array
    reactions: Array
    rest_bodies: Array
    bodies: Array

    def tips(self, model: Model) -> dict[str, Array]:
        """Return the places x, y [m] of free ends and the turns of their sections [rad] (S, 3), by strips."""
        free = {k: -end for k, ends in enumerate(model.ends) for end in (0, 1) if ends[end] == FREE}
        return {
            model.strip_names[k]: np.hstack([self.shape[:, k, at], self.rotation[:, k, at, None]])
            for k, at in free.items()
        }

    def outer_stress(self, model: Model) -> Array:
        """Return the largest magnitude of stress at the nodes (S, G, P) [Pa], sections taken as rectangles.

        |N| / A + |M| d / (2 I) with the depth d = sqrt(12 I / A). Of a strip that does not curl freely this
        is the mean across the width, to which the stress is equal where the section is held flat or wholly
        free.
        """
        area, inertia = _sections(model)
        stress: Array = np.abs(self.axial_force) / area
        stress += np.abs(self.bending_moment) * np.sqrt(3.0 / (area * inertia))
        return stress


def strip_fields(model: Model, states: Array, ends: Array | None = None) -> StripFields:
    """Return the fields of states along the strips, natural strains in full.

    Section forces are those that hold the elements: they obey the balance of the mesh, with weight and
    inertia lumped at the nodes, to the residual of the state. Those at a node are the means of the end values
    of the adjacent elements, which agree to the residual. Exact at the nodes without distributed load; with
    it, and for strains, of second order in the element length. Reactions are the section forces at the ends.

    Parameters
    ----------
    model : Model
        With the structure that the states belong to.
    states : (S, size) m and rad
        Reduced coordinates.
    ends : (S, E, 5), default None
        Of the E elements, if known.

    Returns
    -------
    StripFields
        Arrays (S, G, P) of G strips with P nodes: axial force, shear force, moment and more.

    Raises
    ------
    InvalidParameter
        States of another structure, such as another number of elements.

    References
    ----------
    Reissner (1972), as in ``fe_reference.law``.

    Examples
    --------
    With ``pivot`` of the example of ``fe_reference.model.cross_axis_pivot``:

    >>> path = solve_statics(pivot, rotation=0.1, increments=1)
    >>> strip_fields(pivot, path.states).bending_moment.shape
    (2, 2, 9)
    """
    require_model(model)
    structure, y = structure_of(model), np.asarray(states)
    if y.ndim != 2 or y.shape[1] != structure.size:
        expected = f"(S, {structure.size}), of this model with its number of elements"
        raise InvalidParameter("states", y.shape, f"shape {expected} [m, rad]")
    if ends is None:
        ends = np.array([structure.evaluate(each, asked=FORCES).ends for each in y])
    grid, rows, many = (structure.strips, structure.stations), (structure.strips, -1), len(y)
    force_x, force_y, first, last = np.moveaxis(ends[..., :4], -1, 0).reshape(4, many, *rows)
    nodal = np.array([structure.displacement(each)[: structure.nodes] for each in y]).reshape(many, *grid, 3)
    force_x, force_y, moment = _midpoints(force_x), _midpoints(force_y), _at_nodes(-first, last)
    chord = structure.elements.chord.reshape(2, *rows)
    angle = _midpoints(np.unwrap(np.arctan2(chord[1], chord[0]), axis=1))
    c, s = np.cos(angle + nodal[..., 2]), np.sin(angle + nodal[..., 2])
    axial, beyond = force_x * c + force_y * s, np.stack([force_x, force_y, moment], axis=-1)
    natural, length = model.find(PreStrain) or PreStrain(), structure.elements.length.reshape(rows)
    (area, inertia), modulus = _sections(model), [[strip.youngs_modulus] for strip in model.strips]
    bent = moment / (modulus * inertia)
    if structure.elements.plate[:, 0].any():  # where it is no multiple of the moment
        bent = _midpoints(np.diff(nodal[..., 2]) / length)
    turning = np.diff(angle, axis=1) / length
    return StripFields(
        arc_length=structure.basis.mesh.p[0].reshape(grid),
        rest_shape=model.rest,
        shape=model.rest + nodal[..., :2],
        rotation=nodal[..., 2],
        curvature=_at_nodes(turning, turning) + bent + natural.curvature,
        stretch=1.0 + axial / (modulus * area) + natural.strain,
        axial_force=axial,
        shear_force=force_y * c - force_x * s,
        bending_moment=moment,
        reactions=np.stack([-beyond[:, :, 0], beyond[:, :, -1]], axis=2),
        rest_bodies=model.centres,
        bodies=structure.body_places(y),
    )


def _sections(model: Model) -> tuple[Array, Array]:
    """Return area [m^2] and second moment [m^4] at the nodes (G, P)."""
    places = model.arcs / model.lengths[:, None]
    growth = np.array([strip.growth(at) for strip, at in zip(model.strips, places, strict=True)])
    own = np.array([(strip.area, strip.second_moment_of_area) for strip in model.strips])
    return growth[:, 0] * own[:, :1], growth[:, 1] * own[:, 1:]


def _at_nodes(first: Array, last: Array) -> Array:
    """Merge the end values of elements (..., E) at the nodes (..., P): the means of the adjacent elements."""
    inner = 0.5 * (first[..., 1:] + last[..., :-1])
    return np.concatenate([first[..., :1], inner, last[..., -1:]], axis=-1)


def _midpoints(values: Array) -> Array:
    """Return values of the elements' middles (..., E) at the nodes (..., P).

    They are the means of the adjacent elements, and at the ends the line through the last two: a force there
    holds the weight or the inertia of the half element that stands at the end node, and a curved strip has
    the direction of its end.
    """
    if values.shape[-1] == 1:
        return np.repeat(values, 2, axis=-1)
    first = 1.5 * values[..., :1] - 0.5 * values[..., 1:2]
    last = 1.5 * values[..., -1:] - 0.5 * values[..., -2:-1]
    return np.concatenate([first, 0.5 * (values[..., 1:] + values[..., :-1]), last], axis=-1)
