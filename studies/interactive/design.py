"""A pivot of the environment: built from its parameters, what its strips tell, what a moment alone does to
it, and where its markers sit."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.polynomial import legendre

from spline_model.accuracy import FIRST
from spline_model.basis import Bezier
from spline_model.pivot import Pivot, cross_axis_pivot
from spline_model.solution import Status
from spline_model.statics import solve_statics
from studies.kinds import Array

#: In EI/L^2: strips that a hand compresses fold their control points at the smaller default.
SLIDE_STIFFNESS = 1000.0
#: Rotation up to which a design is known [rad], and at how many places; increments of the path to there by
#: which control points are chosen: 11 ms, 32 ms at most of 60 designs.
REACH, PLACES, INCREMENTS = 1.8, 25, 4
#: Load in EI/L^2 above which they are chosen without it: a path that loses its stability takes seconds.
HEAVY = 10.0
#: Places along a strip where its shape and stress are given, as fractions of its length.
STATIONS = np.linspace(0.0, 1.0, 25)

#: What a pivot is built from, by the names of the parameters.
GIVEN = (
    *("length", "inclination", "crossing_ratio", "thickness", "width", "youngs_modulus", "density"),
    *("body_mass", "body_moment_of_inertia"),
)
POISSON_RATIO = 0.3
EFFECTS = ("bending", "stretching", "strip_inertia", "body_inertia")


def scene(
    values: Mapping[str, float], *, loaded: bool = True
) -> tuple[tuple[str, ...], dict[str, dict[str, Any]]]:
    """Return the effects of a design and their parameters: strips with a damping time are damped, a load acts
    at the body's centre."""
    parameters: dict[str, dict[str, Any]] = {}
    if values["relaxation_time"] > 0.0:
        parameters["strip_damping"] = {"relaxation_time": values["relaxation_time"]}
    if loaded and values["load"]:
        parameters["applied_force"] = {"force": (0.0, -values["load"])}
    return (*EFFECTS, *parameters), parameters


def build(values: Mapping[str, float], control_points: int | None = None, *, loaded: bool = False) -> Pivot:
    """Return the pivot of the parameters, in SI units, and what acts on it but for its load; without a number
    its control points are left open."""
    effects, parameters = scene(values, loaded=loaded)
    given: dict[str, Any] = {name: values[name] for name in GIVEN}
    return cross_axis_pivot(
        **given,
        poisson_ratio=POISSON_RATIO,
        effects=effects,
        parameters=parameters,
        control_points=control_points,
        slide_stiffness=SLIDE_STIFFNESS,
    )


def chosen(values: Mapping[str, float]) -> tuple[int, str]:
    """Return how many control points a strip of a design takes, on the path by a moment alone to `REACH`, and
    what is to be said of their error; empty if it is below that of all answers."""
    heavy = abs(values["load"]) > HEAVY * scales(values)["force"]
    pivot = build(values, loaded=not heavy)
    path = solve_statics(pivot, rotation=REACH, increments=INCREMENTS, raise_on_failure=False)
    if path.status is not Status.CONVERGED or path.segments != 1:
        why = path.message or "its strips want segments, which a body in the hand does not take"
        return FIRST, f"not estimated: {why}"
    return path.control_points, path.resolution or "estimated without the load" * heavy


@cache
def _tables(control_points: int) -> tuple[list[Array], Array, Array]:
    """Tables of a strip's shape and its derivatives at the stations, of its slope at Gauss points, and from
    the stretch there to the axial modes' at the stations."""
    basis = Bezier(control_points=control_points)
    u, weight = legendre.leggauss(control_points + 3)
    modes = legendre.legvander(u, control_points - 3)
    project = (modes * (weight / 2.0)[:, None]) * (2 * np.arange(control_points - 2) + 1)
    spread = legendre.legvander(2.0 * STATIONS - 1.0, control_points - 3) @ project.T
    shapes = [basis.evaluate(STATIONS, order) for order in range(3)]
    return shapes, basis.evaluate((u + 1.0) / 2.0, 1), spread


def read(values: Mapping[str, float], points: Array) -> tuple[Array, Array]:
    """Return shape (2, P, 2) [m] and stress (2, P), largest in the section [Pa], |N| / A + |M| / W, at P
    stations of a design's strips with control points (2, n, 2) [m], by the constitutive laws of both models.

    Exact for the discretised strip: material curvature times E h / 2, and the stretch projected on the axial
    modes times E; leaves out what the clamps' fillets add.
    """
    shapes, slope, spread = _tables(points.shape[1])
    shape, tangent, bend = (table @ points for table in shapes)
    cross = tangent[..., 0] * bend[..., 1] - tangent[..., 1] * bend[..., 0]
    curvature = cross / np.einsum("spi,spi->sp", tangent, tangent) / values["length"]
    stretch = np.linalg.norm(slope @ points, axis=-1) / values["length"] - 1.0
    axial = stretch @ spread.T
    return shape, values["youngs_modulus"] * (np.abs(axial) + np.abs(curvature) * values["thickness"] / 2.0)


@dataclass(frozen=True, kw_only=True, eq=False)
class Curve:
    """A rotations [rad] from 0 on as far as the body goes; the other side is the mirror's picture.

    shift (A, 2): of the centre from rest [m]; moment (A,) [N m]; stress (A,): largest in the strips [Pa].
    """

    rotation: Array
    shift: Array
    moment: Array
    stress: Array

    def gap(self, displacement: Array) -> float:
        """Return the distance [m] of a displacement (3,) from the path; 0 beyond its end."""
        x, y, turn = displacement
        if abs(turn) > self.rotation[-1]:
            return 0.0
        along, across = (float(np.interp(abs(turn), self.rotation, self.shift[:, k])) for k in range(2))
        return math.hypot(x - math.copysign(1.0, turn) * along, y - across)

    def where(self, stress: float) -> tuple[float, float] | None:
        """Return rotation [rad] and moment [N m] at which the largest stress is `stress` [Pa], None where it
        stays below."""
        if self.stress[-1] < stress:
            return None
        turn, moment = (float(np.interp(stress, self.stress, y)) for y in (self.rotation, self.moment))
        return turn, moment


def scales(values: Mapping[str, float]) -> dict[str, float]:
    """Return the sizes of moment [N m], force [N], energy [J] and stress [Pa] of a design's bending."""
    length, thickness = values["length"], values["thickness"]
    bending = values["youngs_modulus"] * values["width"] * thickness**3 / 12.0 / length
    stress = values["youngs_modulus"] * thickness / length
    return {"moment": bending, "force": bending / length, "energy": bending, "stress": stress}


#: Distance of the ground's marker from the clamped plate it is glued to [m], as on the printed sheet.
STANDOFF = 0.045
#: Side of the black square [m], as printed.
SIDE = 0.06
#: Pose of marker 1 in marker 0's frame [m, m, rad] as printed: that of a pivot at rest, whatever the design.
PRINTED = (0.0, 0.15, 0.0)


def turned(angle: float, vector: Array) -> Array:
    """Return `vector` (2,) turned by `angle` [rad]."""
    cos, sin = math.cos(angle), math.sin(angle)
    return np.array([cos * vector[0] - sin * vector[1], sin * vector[0] + cos * vector[1]])


def inverse(pose: Array) -> Array:
    """Return the pose (3,) of the first frame seen from the second, `pose` being that of the second in the
    first."""
    return np.array([*turned(-pose[2], -pose[:2]), -pose[2]])


@dataclass(frozen=True, kw_only=True, eq=False)
class Placing:
    """Rest places of the markers' centres in the pivot's frame (origin A1), both upright.

    Attributes:
        ground: of marker 0 (2,) [m]; rest: pose (3,) of marker 1 in marker 0's frame when the pivot is at
            rest.
        centre: of the body at rest (2,) [m]. crossing: of the strips at rest (2,) [m].
    """

    ground: Array
    rest: Array
    centre: Array
    crossing: Array

    @classmethod
    def of(cls, pivot: Pivot, rest: Array | None = None) -> "Placing":
        """Return the placing for a design of markers as on the printed sheet, or at `rest` (3,)."""
        ground = pivot.clamp_points[:, 0].mean(axis=0) - np.array([0.0, STANDOFF])
        start, end = pivot.clamp_points[0]
        crossing = start + pivot.crossing_reach[0] * (end - start)
        rest = np.array(PRINTED) if rest is None else rest
        return cls(ground=ground, rest=rest, centre=pivot.centre, crossing=crossing)

    @property
    def _arm(self) -> Array:
        """From marker 1 to the body's centre (2,) [m], at rest."""
        return self.centre - self.ground - self.rest[:2]

    def crossing_shift(self, body: Array) -> float:
        """Return how far [m] the body's point that lies in the strips' crossing at rest is from there."""
        return float(np.hypot(*(body[:2] + turned(body[2], self.crossing - self.centre) - self.crossing)))

    def body(self, marker: Array, near: float = 0.0) -> Array:
        """Return the body's pose (3,) for marker 1 at `marker` in marker 0's frame, its turn counted on
        from `near`."""
        angle = near + math.remainder(marker[2] - self.rest[2] - near, math.tau)
        return np.array([*(self.ground + marker[:2] + turned(angle, self._arm)), angle])

    def marker(self, body: Array) -> Array:
        """Return the pose (3,) of marker 1 in marker 0's frame for the body's pose."""
        return np.array([*(body[:2] - self.ground - turned(body[2], self._arm)), body[2] + self.rest[2]])

    def spread(self, sd: Array, turn: float) -> Array:
        """Return the body's pose over those of the marker's x, y and turn (3, 3), in standard deviations, at
        the body's turn [rad]."""
        arm = turned(turn, self._arm)
        return np.array([[1.0, 0.0, -arm[1]], [0.0, 1.0, arm[0]], [0.0, 0.0, 1.0]]) * sd

    def looks_swapped(self, marker: Array) -> bool:
        """Return whether the markers fit the mechanism much better the other way round."""

        def strangeness(pose: Array) -> float:
            """How far the body would be from any place that bending takes it to, over the rest distance."""
            gap = self.body(pose)[:2] - self.centre
            return float(np.hypot(*gap) / np.hypot(*self.rest[:2]))

        return strangeness(marker) > 0.8 and strangeness(inverse(marker)) < 0.5 * strangeness(marker)
