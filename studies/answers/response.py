"""The neutral answer to a static problem: arrays that do not tell which model they came from."""

from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from typing import Any, Protocol

import numpy as np

from studies.cases.effects import MOTION_ONLY
from studies.cases.problem import Problem
from studies.kinds import Array

#: Arrays that a response takes over from a model's solution as they are.
SHARED_ARRAYS = (
    "rotation",
    "load_factor",
    "centre",
    "torque",
    "stiffness",
    "bending_energy",
    "axial_energy",
    "shear_energy",
    "clamp_reactions",
    "stations",
    "shape",
    "axial_force",
    "bending_moment",
    "shear_force",
)


class Result(Protocol):
    """What every answer of either model says of how it came about."""

    @property
    def status(self) -> Any:
        """Enumeration of how the solve ended; its value is "converged" unless it stopped early."""

    @property
    def message(self) -> str:
        """Why and where or when the solve stopped; empty when it did not."""

    @property
    def counters(self) -> Mapping[str, int]:
        """Work done, by kind."""

    @property
    def seconds(self) -> Mapping[str, float]:
        """Time by part; "solve" is that of the path or of the steps alone."""


class StaticResult(Result, Protocol):
    """What the solution of either model offers; see `Response` for the arrays."""

    @property
    def history(self) -> tuple[tuple[float, ...], ...]:
        """Residual norms of every increment."""


@dataclass(frozen=True, kw_only=True)
class Critical:
    """Where a path loses or regains stability: "limit point", "turning point" or "bifurcation", at a load
    factor [1] and a rotation of the driven body [rad], NaN without one."""

    kind: str
    load_factor: float
    rotation: float


@dataclass(frozen=True, kw_only=True)
class Response:
    """Static answer over S converged states (the unloaded one first), G = 2 strips, P stations a strip.

    Attributes:
        model: "spline", "fe" or "fe-shear".
        settings: discretisation keywords.
        status: "converged" or "not_converged"; `message` says why and where it stopped, or what a path that
            reached its end has passed.
        critical_points: in the order of the path.
        resolution: how uncertain too coarse a discretisation makes the answer; empty where it is resolved,
            and of a model that cannot tell.
        rotation: (S,) of the body, counter-clockwise [rad].
        load_factor: (S,) share of the loads that acts, of the rotation where there are none [1].
        centre: (S, 2) centre of mass of the body, origin at A1 [m].
        torque: (S,) driving torque on the body [N m]; stiffness: (S,) its derivative from the tangent [N m /
            rad].
        bending_energy, axial_energy, shear_energy: (S,) of both strips together [J].
        clamp_reactions: (S, G, 2, 3) force x, force y [N], moment [N m] by the clamp on the strip, ground end
            first.
        stations: (P,) reference arc length over L [1]; shape: (S, G, P, 2) [m].
        axial_force, shear_force: (S, G, P) [N]; bending_moment: (S, G, P) [N m].
        centre_shift: (S, 2) displacement of the body's point that lies at the strips' crossing at rest [m].
        extreme_fibre_strain: (S, G, P) largest magnitude over the section's depth [1]; extreme_fibre_stress
            [Pa].
        effects: names of what was assembled.
        counters: work done, by kind; history: residual norms of every increment.
        wall_s: time of the answer, without import, compilation and set-up of the model [s].
        solve_s: of it, the increments alone: without tables, recovered multipliers and section forces [s].
        estimate: what a model that was asked for an accuracy says of its error, by name; None otherwise.
    """

    model: str
    settings: dict[str, Any]
    effects: tuple[str, ...]
    status: str
    message: str
    resolution: str
    rotation: Array
    load_factor: Array
    centre: Array
    torque: Array
    stiffness: Array
    bending_energy: Array
    axial_energy: Array
    shear_energy: Array
    clamp_reactions: Array
    stations: Array
    shape: Array
    axial_force: Array
    bending_moment: Array
    shear_force: Array
    centre_shift: Array
    extreme_fibre_strain: Array
    extreme_fibre_stress: Array
    counters: dict[str, int]
    history: tuple[tuple[float, ...], ...]
    wall_s: float
    solve_s: float
    estimate: dict[str, Any] | None = None
    critical_points: tuple[Critical, ...] = ()

    @property
    def converged(self) -> bool:
        """Whether the whole path was reached."""
        return self.status == "converged"

    @property
    def strain_energy(self) -> Array:
        """(S,) bending, axial and shear energy together [J]."""
        return self.bending_energy + self.axial_energy + self.shear_energy

    @property
    def max_stress(self) -> Array:
        """(S,) largest extreme-fibre stress over both strips [Pa]."""
        return np.asarray(self.extreme_fibre_stress.max(axis=(1, 2)))


def response(
    problem: Problem,
    result: StaticResult,
    *,
    model: str,
    settings: dict[str, Any],
    effects: tuple[str, ...],
    wall_s: float,
    solve_s: float,
) -> Response:
    """Return the neutral form of a model's `result`, with what follows from it and the given data."""
    arrays = {name: np.asarray(getattr(result, name), dtype=float) for name in SHARED_ARRAYS}
    strain = extreme_fibre_strain(problem, arrays["axial_force"], arrays["bending_moment"])
    estimate = estimate_of(result)
    return Response(
        model=model,
        settings=settings | chosen_by(result),
        effects=effects,
        status=str(result.status.value),
        message=result.message,
        resolution=getattr(result, "resolution", ""),
        centre_shift=centre_shift(problem, arrays["rotation"], arrays["centre"]),
        extreme_fibre_strain=strain,
        extreme_fibre_stress=problem.youngs_modulus * strain,
        counters=dict(result.counters),
        history=result.history,
        wall_s=wall_s,
        solve_s=solve_s,
        estimate=estimate,
        critical_points=critical_of(result),
        **arrays,
    )


def critical_of(result: Any) -> tuple[Critical, ...]:
    """Return the critical points of a model's path; none of a model that does not look for them."""
    return tuple(
        Critical(kind=point.kind, load_factor=float(point.load_factor), rotation=float(point.rotation))
        for point in getattr(result, "critical_points", ())
    )


def estimate_of(result: Any) -> dict[str, Any] | None:
    """Return a model's estimate of its own error by name; None where it was not asked for an accuracy."""
    estimate = getattr(result, "estimate", None)
    return None if estimate is None else asdict(estimate)


def chosen_by(result: Any) -> dict[str, Any]:
    """Return the settings that a model has chosen for the accuracy of its answer."""
    meshes = getattr(getattr(result, "estimate", None), "meshes", None)
    if meshes is not None:
        return {"elements": meshes[-1]}
    return {"control_points": result.control_points} if hasattr(result, "control_points") else {}


def assembled(names: Iterable[str]) -> tuple[str, ...]:
    """Return those of a scene's effects that a static path is made of."""
    return tuple(name for name in names if name not in MOTION_ONLY)


def centre_shift(problem: Problem, rotation: Array, centre: Array) -> Array:
    """Return the displacement of the body's point that lies at the strips' crossing at rest.

    With x_c the crossing point at rest, g the centre of mass and R the rotation of the body,
    shift = g + R (x_c - g_0) - x_c, where g_0 is the centre at rest, the first state.

    Args:
        problem: gives the crossing point.
        rotation: (S,) [rad].
        centre: (S, 2) [m].

    Returns:
        (S, 2) [m].
    """
    crossing = np.array(problem.crossing_point)
    arm = crossing - centre[0]
    cosine, sine = np.cos(rotation), np.sin(rotation)
    turned = np.stack((cosine * arm[0] - sine * arm[1], sine * arm[0] + cosine * arm[1]), axis=-1)
    return np.asarray(centre + turned - crossing)


def extreme_fibre_strain(problem: Problem, axial_force: Array, bending_moment: Array) -> Array:
    """Return max |N/(EA) +- M d/(2 EI)|, the larger magnitude of the two extreme fibres (d: depth of the
    section).

    Exact for plane sections and small strain; leaves out shear, the strips' initial curvature and the clamps'
    notches.

    Args:
        problem: gives E, A, I and d.
        axial_force: N, any shape [N].
        bending_moment: M, the same shape [N m].
    """
    modulus = problem.youngs_modulus
    axial = axial_force / (modulus * problem.area)
    bending = bending_moment * problem.depth / (2.0 * modulus * problem.second_moment_of_area)
    return np.asarray(np.abs(axial) + np.abs(bending))
