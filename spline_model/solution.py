"""Results: frozen arrays with a status, and their estimated errors."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from enum import Enum
from functools import cached_property, partial, wraps
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import pandas as pd

Array = NDArray[np.float64]
T = TypeVar("T")

TORQUE_SHARE = 4.5
"""Error of torque and energy over the squared moment defect, at most: 2.3 to 4.3 over crossing ratios
0.05 to 0.95, inclinations 10 to 80 degrees and rotations to 180 degrees, with 4 to 10 control points."""
UNCERTAIN = 0.03
"""Estimated error of the torque from which an answer says that it is not resolved: at the ends of what
designs may be the factor above is exceeded, and no error of 0.05 may pass without a message."""


def read_only(given: T) -> T:
    """Return the same array, or the same container of arrays, after its arrays were set to read only."""
    if isinstance(given, np.ndarray):
        given.flags.writeable = False
    elif isinstance(given, dict | tuple):
        for each in given.values() if isinstance(given, dict) else given:
            read_only(each)
    return given


def kept(make: Callable[[Any], T]) -> cached_property[T]:
    """Return a property that is computed at its first access; its arrays are read only."""

    @wraps(make)
    def made(own: Any) -> T:
        return read_only(make(own))

    return cached_property(made)


class Status(Enum):
    """How a solve ended; the text ends with a remedy.

    Examples
    --------
    With ``pivot`` of the example of ``spline_model.pivot.cross_axis_pivot``:

    >>> solve_statics(pivot, rotation=0.1).status
    <Status.CONVERGED: 'converged'>
    >>> Status.CONVERGED.text
    'every increment converged'
    """

    CONVERGED = "converged"
    NOT_CONVERGED = "not_converged"

    @property
    def text(self) -> str:
        """The outcome in a sentence."""
        if self is Status.CONVERGED:
            return "every increment converged"
        return (
            "the path stopped before its end and its last state is the last good one; "
            "try more increments, more control points or gauss_points, or axial_modes = control_points - 2"
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class CriticalPoint:
    """Point of a path where stability is lost or regained, or where load or torque is stationary.

    kind: "limit point" of the load factor, or of a driven rotation's torque, where its stiffness
    at fixed loads vanishes; "turning point" of a drive, where the driven coordinate itself goes
    back; "bifurcation" otherwise.
    load_factor; rotation of the driven body [rad], nan without one; z (N,) unknowns; mode (Q,)
    change of the coordinates, its largest entry one strip length or 1 rad (for a limit of the
    torque the turn at fixed loads); inertia: that of the tangent after it; turns (B,) of all bodies [rad];
    preload: the share of weight and pre-strain that acts.
    """

    kind: str
    load_factor: float
    rotation: float
    z: Array
    mode: Array
    inertia: int
    turns: Array
    preload: float = 1.0


@dataclass(frozen=True, eq=False)
class Later:
    """An array (R, N) that is computed at its first access.

    model, y (R, Y): of its rows in the elements' own unknowns, where they are known.
    """

    make: Callable[[], Array]
    model: Any = None
    y: Array | None = None

    @kept
    def array(self) -> Array:
        """It."""
        return self.make()

    @property
    def last(self) -> tuple[Any, Array] | None:
        """The model and its last row in it."""
        return None if self.y is None else (self.model, self.y[-1])

    def rows(self, some: slice) -> Later:
        """Return some of its rows."""
        return Later(partial(_some, self, some), self.model, None if self.y is None else self.y[some])

    def followed_by(self, other: Later) -> Later:
        """Return its rows and those of another one behind them."""
        return Later(partial(_both, self, other))


def _some(own: Later, rows: slice) -> Array:
    return own.array[rows]


def _both(one: Later, other: Later) -> Array:
    return np.concatenate((one.array, other.array))


class Tabulated:
    """An answer with a ``status`` whose ``columns`` make a table and, their last row, its line.

    Its arrays are read only.
    """

    status: Status

    def __post_init__(self) -> None:
        read_only(vars(self))

    def columns(self) -> dict[str, Array]:
        """Return the columns of a table: arrays (S,) of one number in every row, by names with units."""
        raise NotImplementedError

    def to_frame(self) -> pd.DataFrame:
        """The columns as a table."""
        import pandas as pd

        return pd.DataFrame(self.columns())

    def __repr__(self) -> str:
        columns = self.columns()
        rows = len(next(iter(columns.values())))
        told = ", ".join(f"{name} = {values[-1]:.6g}" for name, values in columns.items())
        return f"<{type(self).__name__} {self.status.value}, {rows} rows, the last one: {told}>"


def body_columns(bodies: Mapping[str, Array]) -> dict[str, Array]:
    """Return columns of x [m], y [m], theta [rad] of bodies (S, 3), named after them if there are several."""
    return {
        part if len(bodies) == 1 else f"{name}_{part}": place[:, k]
        for name, place in bodies.items()
        for k, part in enumerate(("x_m", "y_m", "rotation_rad"))
    }


def resolution(defect: NDArray[np.float64]) -> str:
    """Return a message on the uncertainty of a path with moment defects (S,) [1]; empty if it is resolved.

    The defect (``continuation.followed``) is the error of the moments in the energy norm, and the error of
    torque and energy is proportional to its square.
    """
    worst = int(np.argmax(defect))
    error = TORQUE_SHARE * float(defect[worst]) ** 2
    if not error > UNCERTAIN:
        return ""
    return (
        f"the strips' moments differ from balance by {100 * defect[worst]:.2g} % in state {worst}: "
        f"torque and energy are uncertain by some {100 * min(error, 1.0):.2g} %; take more control points"
    )


def largest(errors: Iterable[float]) -> float:
    """Return the largest of relative errors [1], nan (no error is estimated) ignored; nan if all are."""
    return max((each for each in errors if not math.isnan(each)), default=math.nan)


@dataclass(frozen=True, kw_only=True)
class ErrorEstimate:
    """Estimated relative errors [1] of an answer whose control points were chosen for an ``accuracy``.

    errors, by name, of a static path: trajectory: largest error of a body's place over the largest
    displacement, and of its turn where that is not driven; body_stiffness: of the body that is asked for,
    over that of the same state; torque, stiffness, energy, section_forces, stress (the largest over a strip
    of the rectangular section that A and I imply): largest error over the largest magnitude on the path;
    reactions: the same of the forces that drives and supports exert, and of the moments, whichever is more.
    nan of what a path does not have. Of modes: frequency, the largest error of all of them.
    segments of a strip that were chosen, and control_points of each; trials: control points of a strip that
    were tried.
    Excludes errors that more control points do not reduce: the simplifications of the theory.
    """

    accuracy: float
    errors: Mapping[str, float]
    segments: int
    control_points: int
    trials: tuple[int, ...]

    @property
    def largest(self) -> float:
        """Largest of the estimated relative errors [1], which ``accuracy`` is about."""
        return largest(self.errors.values())

    @property
    def remark(self) -> str:
        """Empty, or what is more uncertain than the accuracy."""
        return remark(self.errors, self.accuracy, named(self.segments, self.control_points))


def named(segments: int, points: int) -> str:
    """Return a discretisation in words."""
    return f"{points} control points" if segments == 1 else f"{segments} segments of {points} control points"


def remark(errors: Mapping[str, float], accuracy: float, grid: str) -> str:
    """Return the names of the relative errors [1] of an answer that exceed its accuracy; empty if none
    does."""
    missed = ", ".join(
        f"{name.replace('_', ' ')} {error:.1e}" for name, error in errors.items() if error > accuracy
    )
    return f"estimated error above {accuracy:g} with {grid}: {missed}" if missed else ""


@dataclass(frozen=True, kw_only=True)
class MotionEstimate:
    """Estimated error of a motion that was solved to an ``accuracy`` [rad].

    Attributes
    ----------
    rotation : float, rad
        Largest error over the motion, of rotations [rad] and of places over the longest strip [1].
    time, space : float, rad
        Errors of the steps and of the control points, which may cancel in part.
    control_points : int
        Chosen number.
    runs : int
        Number of computed motions.
    """

    accuracy: float
    rotation: float
    time: float
    space: float
    control_points: int
    runs: int
