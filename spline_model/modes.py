"""Linearised natural frequencies and shapes, at rest and about any static state."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache, lru_cache, partial

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import LinAlgError, eigh, null_space

from spline_model.accuracy import search, wanted
from spline_model.compile import System, compile_scene
from spline_model.confirmed import Grid, at_limit
from spline_model.effects import DrivenRotation
from spline_model.errors import ConvergenceError, InvalidParameter, require_count, require_finite
from spline_model.mechanism import Mechanism, require_mechanism
from spline_model.reduced.model import Reduced, from_unknowns, require_reduced
from spline_model.reduced.states import coordinates_by, whole_tangents
from spline_model.rigid import Unheld, props_of
from spline_model.sections import STATIONS, curves
from spline_model.solution import ErrorEstimate
from spline_model.static_answers import StaticSolution
from spline_model.statics import settle, static_state
from spline_model.strip.element import RIGIDITY

Array = NDArray[np.float64]

SLIDE_SHARE = 0.5
"""A mode with more of its strain energy than this in the penalty stiffness is one of the control
points' sliding along the strip: a number of the discretisation, not of the pivot."""
NEARLY_NONE = 1e-3
"""Part of the highest frequency below which errors are related to that part: where stability is lost."""
MASSLESS = 1e-13
"""Directions with less than this of the largest modal mass follow the others statically."""

GRAIN = 1e-13
"""Part of the largest squared frequency below which the smallest is round-off of it."""
SLOW = 1e-8
"""Part of the largest 1 / w^2 down to which modes count as slow."""
ROUND_OFF = 1e-14
"""Squared frequency of a rigid motion, over the sum of the terms that cancel in its stiffness."""


class _RoundOff(InvalidParameter):
    """Matrices whose natural frequencies are decided by round-off."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Modes:
    """Natural modes, lowest first; F modes of G strips with P stations.

    Attributes
    ----------
    frequency : (F,) Hz
        Negative if the state is unstable (growth rate over 2 pi), 0 for a rigid motion.
    shapes : (F, G, P, 2) m
        Displacement of the stations at unit modal mass.
    body_shapes : (F, 3) m and rad
        Displacement x, y, theta of the body at unit modal mass; zero without a body.
    bodies : mapping of str to (F, 3)
        The same for every body, by name.
    slide_frequency : (K,) Hz
        Frequencies of the parametrisation only (slide modes), which are excluded.
    rotation : float, rad
        Of the static state; nan if no rotation was driven.
    held : bool
        Whether the rotation of the body was prescribed.
    state : (N,) m, rad and N
        Unknowns of the static state.
    segments, control_points : int
        Of a strip, and of each segment.
    estimate : ErrorEstimate or None
        Of the error, if an accuracy was given.
    """

    frequency: Array
    shapes: Array
    body_shapes: Array
    bodies: dict[str, Array]
    slide_frequency: Array
    rotation: float
    held: bool
    state: Array
    segments: int
    control_points: int
    estimate: ErrorEstimate | None = None


def natural_frequencies(
    pivot: Mechanism,
    *,
    rotation: float | None = None,
    body: str | None = None,
    count: int = 10,
    held: bool = False,
    increments: int = 20,
    accuracy: float | None = None,
) -> Modes:
    """Return the natural modes about a static state.

    The state is in equilibrium with the rotation of a body, and with driven displacements, weight,
    pre-strain and all loads in full. The modes are free vibrations of the coordinates that a release
    frees: the driven rotation, whose torque acts on as a dead moment, and the driven displacements
    without a history, whose forces act on. If nothing holds the mechanism against its loads in full, the
    state is the start of its motion, with loads and drives as their histories begin.

    Parameters
    ----------
    pivot : Mechanism
    rotation : float, rad, default None
        Of the static state; None is 0 for a pivot, and no driven rotation for a mechanism.
    body : str, default None
        Driven body; None is the only one.
    count : int, default 10
        Number F of modes.
    held : bool, default False
        Keep the rotation of the body prescribed.
    increments : int, default 20
        Of the static path to the state.
    accuracy : float, 1, default None
        Wanted relative error of all frequencies; control points are raised, and the modes have their
        `estimate`. Default 1e-4 without a number of control points, else no estimate.

    Returns
    -------
    Modes
        frequency (F,) in Hz, ascending; shapes (F, G, P, 2) of G strips at P stations, and more.

    Raises
    ------
    InvalidParameter
        A value outside its range.
    ConvergenceError
        Statics does not reach the state, or no number of control points reaches the accuracy.

    References
    ----------
    Bathe, Finite Element Procedures (1996), ch. 10 (generalised eigenvalue problem).

    Examples
    --------
    With ``pivot`` of the example of ``spline_model.pivot.cross_axis_pivot``:

    >>> print(f"{natural_frequencies(pivot, count=1).frequency[0]:.2f} Hz")
    11.55 Hz
    """
    require_mechanism(pivot)
    require_count("count", count, 1)
    if rotation is not None:
        require_finite("rotation", rotation, "rad")
    if rotation is None and (held or pivot.placing):
        rotation = 0.0
    solve = partial(_modes, rotation=rotation, body=body, count=count, held=held, increments=increments)
    chosen = wanted(accuracy, pivot.design)
    if chosen is None:
        return solve(pivot.in_motion())
    return _accurate_modes(pivot, chosen, solve, strict=accuracy is not None)


def _accurate_modes(
    pivot: Mechanism, accuracy: float, solve: Callable[[Mechanism], Modes], *, strict: bool
) -> Modes:
    """The modes with as many control points as the accuracy takes; strict: refused where none reaches it."""

    @cache
    def modes(grid: Grid) -> Modes | None:
        try:
            return solve(pivot.on(*grid).in_motion())
        except ConvergenceError as error:  # more control points may reach the state
            path = error.solution
            if path is not None and (not path.settled or at_limit(path)):
                raise
            return None
        except _RoundOff:  # fewer control points may have an answer
            return None

    def attempt(fewer: Grid, more: Grid) -> tuple[float, Modes] | None:
        coarse, fine = modes(fewer), modes(more)
        if coarse is None or fine is None or coarse.frequency.shape != fine.frequency.shape:
            return None
        return _apart(coarse.frequency, fine.frequency), coarse

    outcome = search(pivot.design.discretisation, accuracy, attempt)
    if outcome.found is None:
        return solve(pivot.on(*outcome.trials[-1]).in_motion())
    if strict and outcome.message:
        raise InvalidParameter("accuracy", accuracy, f"no less than {outcome.error:.2g}, which is reached")
    segments, points = outcome.best
    estimate = ErrorEstimate(
        accuracy=accuracy,
        errors={"frequency": outcome.error},
        segments=segments,
        control_points=points,
        trials=outcome.tried,
    )
    return replace(outcome.found, estimate=estimate)


def _apart(frequency: Array, better: Array) -> float:
    """Largest relative difference of frequencies."""
    least = max(NEARLY_NONE * float(np.abs(better).max(initial=0.0)), np.finfo(float).tiny)
    return float((np.abs(frequency - better) / np.maximum(np.abs(better), least)).max(initial=0.0))


def _modes(
    mechanism: Mechanism, rotation: float | None, body: str | None, count: int, held: bool, increments: int
) -> Modes:
    """The modes of a mechanism in motion, with its control points."""
    body = mechanism.design.body_named(body) if mechanism.design.bodies else None
    scene = mechanism.released()
    if held:
        scene = scene.with_effects(DrivenRotation(body=mechanism.design.body_named(body), angle=0.0))
    system = compile_scene(scene)
    system.require_dead("effects")
    layout = system.layout
    about, starts = mechanism, False
    try:
        z = static_state(about, rotation, increments, body)[: layout.size]
    except Unheld:  # under the loads in full: about the start of its motion
        about, starts = mechanism.at_start(), True
        z = static_state(about, rotation, increments, body, starts=True)[: layout.size]
    values, vectors, share = linear_modes(system, z)
    if np.sum(values < 0.0) > 1:
        about = about.propped(rotation is not None, body)
        _require_possible(values, settle(about, rotation, increments, body, starts=starts))
    slide = share > SLIDE_SHARE
    frequency = np.sign(values) * np.sqrt(np.abs(values)) / (2 * np.pi)
    kept = np.flatnonzero(~slide)[:count]
    return Modes(
        frequency=frequency[kept],
        shapes=curves(system, vectors[:, kept].T, STATIONS, 0),
        body_shapes=np.zeros((len(kept), 3)) if body is None else vectors[layout.body(body)][:, kept].T,
        bodies={each.name: vectors[layout.body(each.name)][:, kept].T for each in system.scene.own_bodies},
        slide_frequency=frequency[slide],
        rotation=math.nan if rotation is None else rotation,
        held=held,
        state=z,
        segments=mechanism.design.discretisation.segments,
        control_points=mechanism.design.discretisation.points,
    )


def _require_possible(values: Array, path: StaticSolution) -> None:
    """Raise _RoundOff if more squared frequencies are negative than the inertia of the state permits.

    Each drive that a motion releases adds at most one (Cauchy's interlacing theorem).
    """
    unstable, most = int(np.sum(values < 0.0)), int(path.inertia[-1]) + path.reactions.shape[1]
    if unstable > most:
        expected = f"{most} at most by the inertia of the state: round-off decides a frequency [1]"
        raise _RoundOff("unstable modes", unstable, expected)


def linear_modes(system: System, z: Array) -> tuple[Array, Array, Array]:
    """Return squared circular frequencies (F,) [1/s^2], shapes in q (Q, F) and slide shares (F,) [1] of a
    state.

    K and M are in the free coordinates of the strips' elements, in which clamps hold; axial forces are
    condensed, and inextensible strips are solved on the null space of their constraint. Answers are kept.

    Raises
    ------
    _RoundOff
        Frequencies that are decided by round-off.
    """
    if not system.mass.any():
        raise InvalidParameter("effects", "no inertia", "strip or body inertia for a natural mode")
    return _linear_modes(system, z.tobytes())


@lru_cache(maxsize=4)
def _linear_modes(system: System, state: bytes) -> tuple[Array, Array, Array]:
    stiffness, slide, rows, by = _linear(require_reduced(system), np.frombuffer(state))
    norms = np.linalg.norm(rows, axis=1, keepdims=True)
    free = null_space(rows / norms) if len(rows) else np.eye(len(stiffness))
    inertia, rigid = by.T @ system.mass @ by, len(props_of(system.scene))
    try:
        free = _without_massless(free, stiffness, inertia)
        values, vectors = _sorted_modes(free.T @ stiffness @ free, free.T @ inertia @ free, rigid)
    except LinAlgError:
        raise _RoundOff(
            "coordinates of the strips",
            len(stiffness),
            "fewer, or lengths and stiffnesses less far apart: round-off decides a frequency [1]",
        ) from None
    shapes = free @ vectors
    strain = np.einsum("im,ij,jm->m", shapes, stiffness, shapes)
    slid = np.einsum("im,ij,jm->m", shapes, slide, shapes)
    share = np.divide(slid, np.abs(strain), out=np.zeros_like(slid), where=values != 0.0)
    return values, by @ shapes, share


def stretching_share(system: System, z: Array, shape: Array, square: float) -> float:
    """Return the share [1] of the strain energy of a mode that is in stretching.

    z (N,): the state; shape (Q,): of unit modal mass; square: of its circular frequency [1/s^2].
    """
    model, unstressed = require_reduced(system), z.copy()
    unstressed[system.layout.coordinate_count :] = 0.0  # the stiffness of stretching alone, no force's
    limp = model.strips.along.copy()
    limp[..., RIGIDITY] = 0.0
    stiffness, slide, _, by = _linear(replace(model, strips=model.strips._replace(along=limp)), unstressed)
    moved = np.linalg.lstsq(by, shape, rcond=None)[0]
    return float(moved @ (stiffness - slide) @ moved / abs(square)) if square else 0.0


def _linear(model: Reduced, z: Array) -> tuple[Array, Array, Array, Array]:
    """Of F coordinates of the strips' elements, in which clamps hold: stiffness and its part from sliding
    (F, F) [J], constraints (C, F), dq by them (Q, F).

    Axial forces that comply are eliminated; strips that cannot stretch are constraints.
    """
    y, compliance = from_unknowns(model, z), model.strips.compliance
    hessian = model.energy * whole_tangents(model, y[None], np.ones(1))[1][0]
    places = np.arange(model.size)
    axial = np.array([places[model.places(s)[1]] for s in range(len(compliance))], dtype=np.int64)
    free = np.delete(places, np.append(axial, model.fixed).astype(int))
    soft, slides = compliance > 0.0, np.arange(compliance.shape[1]) >= model.strips.split

    def condensed(kept: NDArray[np.bool_]) -> Array:
        coupling = hessian[np.ix_(axial[kept], free)]
        return np.asarray(coupling.T / (model.energy * compliance[kept]) @ coupling)

    stiffness, slide = hessian[np.ix_(free, free)] + condensed(soft), condensed(soft & slides)
    return stiffness, slide, hessian[np.ix_(axial[~soft], free)], coordinates_by(model, y)[:, free]


def _sorted_modes(stiffness: Array, mass: Array, rigid: int) -> tuple[Array, Array]:
    """Squared frequencies and shapes of unit modal mass, lowest first; 0 of at most so many rigid motions.

    Slow modes by M x = K x / w^2, in which they are the largest and keep their digits beside axial ones many
    thousand times as fast; K is shifted by a part of M where it is not positive definite. Fast ones by
    K x = w^2 M x.
    """
    values, vectors = (np.asarray(found) for found in eigh(stiffness, mass))
    shift = 0.0
    if values[0] <= GRAIN * values[-1]:
        shift = 2.0 * abs(values[0]) + GRAIN * values[-1]
    inverse, slow = eigh(mass, stiffness + shift * mass)
    kept = np.flatnonzero(inverse[::-1] > SLOW * inverse[-1])
    values[kept] = 1.0 / inverse[::-1][kept] - shift
    vectors[:, kept] = slow[:, ::-1][:, kept] / np.sqrt(inverse[::-1][kept])
    loose = np.argsort(np.abs(values))[:rigid]
    size = np.abs(vectors[:, loose])
    least = ROUND_OFF * (np.einsum("im,ij,jm->m", size, np.abs(stiffness), size) + shift)
    values[loose[np.abs(values[loose]) <= least]] = 0.0
    return values, vectors


def _without_massless(free: Array, stiffness: Array, mass: Array) -> Array:
    """The free directions with mass, each with the static answer of those that have none.

    Each is weighed by its own mass, so that a light strip beside heavy bodies does not pass for massless.
    """
    own = free.T @ mass @ free
    heavy = np.diag(own) > MASSLESS**2 * np.diag(own).max()
    free = free / np.sqrt(np.where(heavy, np.diag(own), 1.0))
    weights, directions = eigh(free.T @ mass @ free)
    massless = weights < MASSLESS * weights[-1]
    if not massless.any():
        return free
    quiet, moving = free @ directions[:, massless], free @ directions[:, ~massless]
    answer = np.linalg.solve(quiet.T @ stiffness @ quiet, quiet.T @ stiffness @ moving)
    return np.asarray(moving - quiet @ answer)
