"""Motion of a model after its drives are removed, or from the shape at rest."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial
from typing import Any

import numpy as np

from .arrays import Array, Flags
from .companions import with_companions
from .drives import DrivenRotation, Span, drive_spans
from .errors import require_kind
from .mass import about_mass_centre, carried_over, couplings
from .model import Model, require_model
from .modes import first_frequency
from .motion import ENERGIES, Samples, Scheme, Trajectory, course, trajectory
from .refined import limit_of, places_of
from .run import STEPS_PER_PERIOD, Run
from .schemes import Explicit, Implicit, critical_step
from .solution import Stopwatch
from .statics import settled_state
from .structure import Structure, structure_of


def solve_release(pivot: Model, *, start: float | None, duration: float, **options: Any) -> Trajectory:
    """Release the only body at rest from the static state at a rotation.

    Parameters
    ----------
    pivot : Model
    start : float, rad
        Rotation at the release; None: no rotation is driven.
    duration : float, s
    options
        Keywords of `solve_motion`.

    Returns
    -------
    Trajectory
        T records, the start first: time (T,), rotation (T,), energies (T,) and more.

    Raises
    ------
    InvalidParameter, ConvergenceError
        As in `solve_motion`.

    References
    ----------
    Valentini and Pezzuti (2013), Fig 6.

    Examples
    --------
    With ``pivot`` of the example of ``fe_reference.model.cross_axis_pivot``:

    >>> motion = solve_release(pivot, start=0.1, duration=1e-4, samples=5, check=False)
    >>> motion.time.shape
    (6,)
    """
    require_model(pivot)
    pivot.body_index(None)
    return solve_motion(pivot, start=start, duration=duration, **options)


def solve_motion(
    mechanism: Model, *, check: bool = True, raise_on_failure: bool = True, **asked: Any
) -> Trajectory:
    """Compute the motion of all bodies of a mechanism that is released at rest.

    The start is in static equilibrium: with the rotation of a body driven to `start`, gravity, natural
    strains in full, and every load and the driven displacement at its value times its history at t = 0
    (without a history: in full). Then the rotation is released, and so is a driven displacement without a
    history; one with a history continues. Loads go on as value times history(t), constant before its first
    and after its last time.

    Parameters
    ----------
    mechanism : Model
        Both elements work with both integrators. Masses are lumped.
    check : bool, default True
        Compute companion motions of other elements and steps. They estimate `rotation_error` and
        `displacement_error`, and set `resolution` where these are large. They cost about a third of the
        motion, an implicit one nearly as much as itself, or eight times as much with few elements. None is
        made with an accuracy.
    raise_on_failure : bool, default True
        Raise an error for a motion that ends early, or return it with its status.
    asked
        Duration [s], and the other attributes of ``fe_reference.run.Run``.

    Returns
    -------
    Trajectory
        T records, the start first: time (T,), rotation (T,), energies (T,) and more.

    Raises
    ------
    InvalidParameter
        A value outside its domain, a run too long to finish or to keep, nothing with inertia, parts without
        inertia in the explicit integrator, a start that is held but not settled.
    ConvergenceError
        Statics does not reach the start. Or, unless `raise_on_failure` is False, the motion blew up, a step
        had no solution or the accuracy was not reached; it carries the part that was computed.

    Notes
    -----
    Unless the scene names the rotary inertia of the sections, the corotational element has none but a
    numerical one (see ``fe_reference.mass``).

    References
    ----------
    Chung and Hulbert (1993), as in ``fe_reference.schemes``.

    Examples
    --------
    With ``pivot`` of the example of ``fe_reference.model.cross_axis_pivot``:

    >>> motion = solve_motion(pivot, start=0.1, duration=1e-4, samples=5, check=False)
    >>> bool(motion.rotation[-1] < 0.1)
    True
    """
    require_model(mechanism)
    require_kind("check", check, bool, "True or False")
    run = Run(**asked)
    if run.accuracy is not None:
        return _limit(mechanism, run, run.accuracy).checked(raise_on_failure)
    motion = _moved(mechanism, run).checked(raise_on_failure)
    if not check or not run.settled:
        return motion
    return checked(mechanism, motion, start=run.start, body=run.body, drive=run.drive)


def _limit(model: Model, run: Run, accuracy: float) -> Trajectory:
    """Return the limit of a motion's meshes at the same instants; its rotations and places are judged."""
    units = {**dict.fromkeys((*ENERGIES, "bodies", "rates"), 1.0), "shape": structure_of(model).length}
    turns: dict[str, Callable[[Trajectory], Array]] = {"rotation": lambda found: places_of(found)[..., 2]}
    judged = ("rotation", "shape")
    motion = limit_of(model, accuracy, partial(_moved, run=run), units, turns, judged, relative=False)
    errors = {} if motion.estimate is None else motion.estimate.errors
    places = errors.get("shape", np.nan) * structure_of(model).length
    return replace(motion, rotation_error=errors.get("rotation", np.nan), displacement_error=places)


def _moved(model: Model, run: Run) -> Trajectory:
    """Return the motion of a model, however it ended."""
    model.effects.require_inertia()
    watch = Stopwatch()
    y, remark = np.zeros(structure_of(model).size), ""
    if run.settled:
        y, remark = settled_state(model, run.start, run.body, run.increments, starts=True)
    watch.stop("start")
    samples, settings = _integrate(model, y, run, watch)
    begin: dict[str, float | str] = {} if run.start is None else {"start_rad": run.start}
    remarks = [f"the way to the start: {remark}"] if remark else []
    return trajectory(samples, begin | settings, remarks, watch)


def checked(
    model: Model,
    motion: Trajectory,
    *,
    start: float | None,
    body: str | None = None,
    drive: DrivenRotation | None = None,
) -> Trajectory:
    """Return a motion with its estimated errors [rad, 1] and `resolution`, by companions of fewer elements.

    Args:
        model, body, drive: of the motion, which began in equilibrium.
        start: rotation at the start [rad]; None: no rotation is driven.
    """
    names = ("integrator", "spectral_radius")
    settings: dict[str, Any] = {name: motion.settings[name] for name in names if name in motion.settings}
    settings |= {"start": start, "body": body, "drive": drive, "check": False, "raise_on_failure": False}
    return with_companions(model, motion, partial(solve_motion, **settings))


def _integrate(model: Model, y: Array, run: Run, watch: Stopwatch) -> tuple[Samples, dict[str, float | str]]:
    """Integrate from rest at y; return the samples and the settings."""
    own = structure_of(model)

    @cache
    def scheme_of(led: tuple[int, ...]) -> Explicit | Implicit:
        about = about_mass_centre(own, led)
        return Explicit(*about) if run.explicit else Implicit(*about, run.spectral_radius)

    home = scheme_of(()).structure
    choices: dict[str, float] = {"spectral_radius": run.spectral_radius}
    longest = run.duration
    if run.explicit:
        rest = Span(begin=0.0, end=0.0, rates={}, begins=False)
        parts = {tuple(each.rates): each for each in (rest, *drive_spans(model, run.drive, run.duration))}
        limit = min(
            _critical(scheme_of(span.led), span.held(scheme_of(span.led).structure), own, state)
            for span in parts.values()
            for state in (y, np.zeros_like(y))
        )
        choices, longest = {"critical_step_s": limit, "safety": run.safety}, run.safety * limit
    elif run.step is None:
        longest = 1.0 / (STEPS_PER_PERIOD * first_frequency(model))
    h, steps = run.steps(longest)
    run.require_affordable(model, h, steps, y.size)
    spans = drive_spans(model, run.drive, steps * h)
    watch.stop("compile")
    began = carried_over(own, y, home), np.zeros_like(y)
    samples = course(scheme_of, spans, *began, h, run.chunks(steps), run.progress)
    watch.stop("solve")
    settings: dict[str, float | str] = {"integrator": run.integrator, "duration_s": run.duration, "step_s": h}
    return samples, settings | choices


def _critical(scheme: Scheme, held: Flags, own: Structure, y: Array) -> float:
    """Return the critical step [s] at coordinates y of a model's `own` structure, with what is held."""
    at, bodies = scheme.structure, scheme.bodies
    return critical_step(at, bodies, carried_over(own, y, at), couplings(at, bodies, held))
