"""Natural frequencies and shapes of small motion about a static state: K x = omega^2 M x."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import LinAlgError, eigh
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import eigsh, splu

from . import read
from .arrays import Array, Flags
from .control import NothingHolds, loose_coordinates
from .effects import DEFAULT_EFFECTS
from .mass import MASSES, mass_matrix
from .matrix import Symmetric
from .model import Model, require_model
from .places import GROUND
from .read import ConvergenceError, InvalidParameter
from .refined import Quantities, missed, refine
from .solution import ErrorEstimate
from .statics import settled_state
from .structure import Structure, structure_of

#: Effects that the first frequency is of.
ELASTIC = (*DEFAULT_EFFECTS, "spring", "support")
#: Stiffness of a rigid motion over the sum of the terms that cancel in it.
ROUND_OFF = 1e-14
#: Part of a squared frequency by which the energy of its mode may differ; beyond it round-off decides it.
BLURRED = 0.01
#: First shift of squared frequencies where the stiffness is not positive definite, in parts of their mean.
SHIFT = 1e-9


@dataclass(frozen=True, kw_only=True, eq=False)
class Modes:
    """The lowest modes of small motion, C modes of G strips with P nodes.

    Attributes:
        rotation: rotation of the static state [rad], nan if it was not driven.
        held: whether the rotation of the body is held; if not, the driving torque stays on as it is.
        mass: "consistent" or "lumped".
        frequency (C,): [Hz], ascending; negative where the state is unstable: -growth rate / (2 pi); 0 of a
            rigid motion.
        shapes (C, G, P, 2): displacements of the nodes, of unit modal mass [m / sqrt(kg m^2)].
        bodies: by name (C, 3): displacement of the centre of mass and rotation of a body, same scale.
        state (size,): reduced coordinates of the static state.
        estimate: of the frequencies' errors, where an accuracy was asked for; the rest is of the finest mesh.

    Examples
    --------
    With ``pivot`` of the example of ``fe_reference.model.cross_axis_pivot``:

    >>> modes = natural_frequencies(pivot, count=2)
    >>> bool(0.0 < modes.frequency[0] < modes.frequency[1])
    True
    """

    rotation: float
    held: bool
    mass: str
    frequency: Array
    shapes: Array
    bodies: Mapping[str, Array]
    state: Array
    estimate: ErrorEstimate | None = None


def natural_frequencies(
    pivot: Model,
    *,
    rotation: float | None = 0.0,
    count: int = 10,
    held: bool = False,
    mass: str = "consistent",
    increments: int = 20,
    body: str | None = None,
    accuracy: float | None = None,
) -> Modes:
    """Return the natural modes about a static state.

    The state is in equilibrium with the rotation driven, and with the driven displacement, gravity, natural
    strains and all loads in full. The modes are free vibrations of the coordinates that a release frees: the
    rotation, unless it is held, and a driven displacement without a history. Their driving forces act on
    unchanged. If nothing holds the model against its loads in full, the state is the start of its motion.

    Parameters
    ----------
    pivot : Model
    rotation : float, rad, default 0
        Of the static state; None: no rotation is driven.
    count : int, default 10
        Number of modes C; fewer where the mesh has no more.
    held : bool, default False
        Keep the rotation of the body prescribed; otherwise the torque of the drive stays on unchanged.
    mass : str
        "consistent" (default), or "lumped" as in the explicit integrator.
    increments : int, default 20
        Of the static path to the state.
    body : str, default None
        Driven body; None: the only one.
    accuracy : float, 1, default None
        Wanted relative error of every frequency. The mesh is doubled until the estimate is below it, and the
        frequencies are the limits.

    Returns
    -------
    Modes
        frequency (C,) in Hz, ascending; shapes (C, G, P, 2) of G strips with P nodes, and more.

    Raises
    ------
    InvalidParameter
        An unknown kind of mass, no inertia at all, a rotation that is held but not driven.
    ConvergenceError
        The static state cannot be reached, or the accuracy is not.

    Notes
    -----
    Exact for small motion; neglects damping. Strips without inertia follow the bodies statically.

    References
    ----------
    Bathe, Finite Element Procedures (1996), ch. 10 (generalised eigenvalue problem).

    Examples
    --------
    With ``pivot`` of the example of ``fe_reference.model.cross_axis_pivot``:

    >>> print(f"{natural_frequencies(pivot, count=1).frequency[0]:.2f} Hz")
    11.55 Hz
    """
    require_model(pivot)
    kind = read.choice("mass", mass, MASSES)
    pivot.require_inertia()
    if structure_of(pivot).loads.follows:
        expected = "a fixed direction for modes, as flutter is not modelled; `release` follows it [1]"
        raise InvalidParameter("follower", True, expected)
    read.refuse(rotation is None and held, "held", held, "a driven rotation to hold [1]")

    def solve(model: Model) -> Modes:
        nonlocal count
        structure, time = structure_of(model), None
        try:
            y, _ = settled_state(model, rotation, body, increments)
        except NothingHolds:  # under the loads in full
            y, _ = settled_state(model, rotation, body, increments, starts=True)
            time = 0.0
        tangent = structure.evaluate(y, load=structure.loads.factors(time)).tangent
        at = None if body is None else model.body_index(body)
        # what a release keeps: what is led on, and a held turn
        kept = [structure.first_body + k for k, (_, led) in model.prescribed(at).items() if led.leads]
        kept += [int(structure.turns[at or 0])] if held else []
        values, full = _lowest(structure, y, tangent, ~structure.flags(kept), kind, count)
        count = len(values)  # of finer meshes as many as of the first
        moves = np.array([structure.velocity(mode)[: structure.nodes, :2] for mode in full])
        return Modes(
            rotation=np.nan if rotation is None else float(rotation),
            held=held,
            mass=kind,
            frequency=np.sign(values) * np.sqrt(np.abs(values)) / (2.0 * np.pi),
            shapes=moves.reshape(len(full), structure.strips, structure.stations, 2),
            bodies=dict(zip(model.body_names, structure.bodies(full).swapaxes(0, 1), strict=True)),
            state=y,
        )

    if accuracy is None:
        return solve(pivot)
    answer, limits, estimate = refine(pivot, accuracy, solve, _frequencies)
    modes = replace(answer, frequency=np.array([*limits.values()]), estimate=estimate)
    if estimate is not None and (told := missed(estimate)):
        raise ConvergenceError(told, solution=modes, load_factor=1.0, history=())
    return modes


def first_frequency(model: Model) -> float:
    """Return the first frequency about the shape at rest, of inertia, elasticity and supports alone [Hz]."""
    kept = {name: same for name, same in model.effects.items() if name in ELASTIC}
    bare = replace(model, effects=kept)
    structure = structure_of(bare)
    rigid = len(loose_coordinates(structure, [structure.first_body + at for at in bare.prescribed(None)]))
    clamped = (model.ends == GROUND).any()
    found = np.zeros(0)  # of free strips without bodies
    if clamped or model.bodies:
        found = natural_frequencies(bare, rotation=None, count=rigid + 1, mass="lumped").frequency
    if not (found > 0.0).any():
        raise InvalidParameter("step", None, "a step: the model can move freely and has no first period [s]")
    return float(found[found > 0.0][0])


def _frequencies(modes: Modes) -> Quantities:
    """Return the frequencies by name, each with the largest as its unit."""
    largest = float(np.abs(modes.frequency).max())
    return {f"frequency_{k}": (value, largest) for k, value in enumerate(modes.frequency, start=1)}


def _lowest(
    structure: Structure, y: Array, tangent: Symmetric, free: Flags, kind: str, wanted: int
) -> tuple[Array, Array]:
    """Return the `wanted` lowest eigenvalues [1/s^2], ascending, and modes (C, size) of unit modal mass.

    Inverse iteration (Lanczos) keeps the lowest modes free of the round-off of the stiffest ones. It is
    shifted a little below zero, so that rigid motions do not make it singular. What has no mass is condensed.
    """
    kept = np.flatnonzero(free)
    wanted = _available(wanted, len(kept))
    matrices = (tangent, mass_matrix(structure, y, kind))
    stiffness, mass = (matrix.sparse()[:, kept][kept].tocsc() for matrix in matrices)
    if "strip_inertia" not in structure.model.effects:
        values, vectors = _condensed(structure.first_body, stiffness, mass, wanted)
    elif wanted >= len(kept) - 1:
        values, vectors = eigh(stiffness.toarray(), mass.toarray(), subset_by_index=(0, wanted - 1))
    else:
        shift = -0.01 * structure.force_unit / float(np.abs(mass.diagonal()[structure.axis[kept] == 0]).sum())
        start = np.ones(len(kept))
        values, vectors = eigsh(
            stiffness, wanted, mass, sigma=shift / structure.length, which="LM", v0=start, tol=0.0
        )
        order = np.argsort(values)
        values, vectors = values[order], vectors[:, order]
    rigid = np.argsort(np.abs(values))[: len(loose_coordinates(structure, np.flatnonzero(~free)))]
    energies = np.einsum("im,im->m", vectors, stiffness @ vectors)
    least = ROUND_OFF * np.einsum("im,im->m", np.abs(vectors), abs(stiffness) @ np.abs(vectors))
    values[rigid[np.abs(energies[rigid]) <= least[rigid]]] = 0.0
    blurred = np.abs(energies - values) > BLURRED * np.abs(values)
    blurred[rigid] = False  # what nothing resists has round-off alone
    if blurred.any():
        expected = "fewer, or lengths and stiffnesses less far apart: round-off decides a frequency [1]"
        raise InvalidParameter("elements", structure.stations - 1, expected)
    full = np.zeros((len(values), structure.size))
    full[:, kept] = vectors.T
    full *= np.sign(full[np.arange(len(full)), np.abs(full).argmax(axis=1)])[:, None]
    return values, full


def _condensed(strips: int, stiffness: csc_matrix, mass: csc_matrix, wanted: int) -> tuple[Array, Array]:
    """Return the modes of bodies on strips without mass, whose first `strips` coordinates follow them."""
    follow = -splu(stiffness[:strips, :strips]).solve(stiffness[:strips, strips:].toarray())
    shapes = np.vstack([follow, np.eye(stiffness.shape[0] - strips)])
    own = mass[strips:, strips:].toarray()
    wanted = _available(wanted, int(np.linalg.matrix_rank(own)))
    # largest inverses first: a body without rotary inertia leaves the mass matrix singular
    bodies, shift = shapes.T @ (stiffness @ shapes), 0.0
    while True:
        try:
            inverse, vectors = eigh(own, bodies + shift * own)
            break
        except LinAlgError:  # a rigid motion, or an unstable state
            shift = max(10.0 * shift, SHIFT * float(np.trace(bodies) / np.trace(own)))
            if not np.isfinite(shift):
                raise InvalidParameter(
                    "inertia", "none of a body that can move freely", "mass [kg]"
                ) from None
    order = np.argsort(inverse)[::-1][:wanted]
    values = 1.0 / inverse[order]
    return values - shift, shapes @ vectors[:, order] * np.sqrt(values)


def _available(wanted: int, available: int) -> int:
    """Return the wanted number of modes, or as many as there are; refuse a mesh without one."""
    read.refuse(not available, "count", wanted, "a mesh that has a mode: nothing with inertia is free [1]")
    return min(read.count("count", wanted), available)
