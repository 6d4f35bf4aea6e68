"""The pseudo-rigid-body model of Jensen and Howell with four pins: crossed rigid links with torsional
springs.

Each strip is a rigid link of length c L in the middle of it, with a pin and a spring k at either end; what
is left of the strip is rigid with ground or body. THE PUBLISHED COEFFICIENTS WERE NOT FOUND: c and k are
fitted here to the exact small-angle stiffness and centre shift of the pivot (`linear_pivot`), which is not
what Jensen and Howell did. For strips that cross at mid-length this gives c = 2/3 and k = 2 EI/L. Exact, by
that fit, for small rotations; leaves out that the real links' springs and lengths change with the load.

With q, b the pins' distances from the crossing towards ground and body, p the rotation, a the inclination,
in complex numbers,

    w = q + b e^(ip),  m = arg(w),  h = acos(cos(a) |w| / (q + b)) - a
    V = k (m^2 + (p - m)^2 + 2 h^2)
    u = i w (sqrt((q + b)^2 / |w|^2 - cos(a)^2) - sin(a))

where the links turn by m + h and m - h and u moves the body's point that lies at the crossing at rest.

In motion a link is a uniform rod on its ground pin, and the strip's part beyond the body pin belongs to the
body.

Source: Jensen and Howell, Mechanism and Machine Theory 37 (2002) 461-476, for the model; own derivation of
the rest.
"""

import math
from dataclasses import dataclass

import numpy as np

from studies.baselines.answer import Geometry, geometry_of
from studies.baselines.linear_pivot import shift_coefficient, small_angle_stiffness
from studies.baselines.one_coordinate import Surrogate
from studies.cases.problem import Problem
from studies.kinds import Array


def link_length(problem: Problem) -> float:
    """Return c, the links' length over L, with which the small-angle centre shift is exact.

    The linkage shifts by q b p^2 / (2 (q + b) sin(a)) with q b = L^2 (c^2/4 - e^2), e = crossing ratio - 1/2.
    """
    offset = problem.crossing_ratio - 0.5
    wanted = shift_coefficient(problem) * math.sin(problem.inclination) / problem.length
    return 4.0 * wanted + math.sqrt(16.0 * wanted**2 + 4.0 * offset**2)


def spring(problem: Problem) -> float:
    """Return k [N m / rad], with which the small-angle stiffness k (1 + 4 (e / c)^2) is exact."""
    offset = problem.crossing_ratio - 0.5
    return small_angle_stiffness(problem) / (1.0 + 4.0 * (offset / link_length(problem)) ** 2)


@dataclass(frozen=True, kw_only=True)
class _FourBar:
    """The law of one pivot; see `studies.baselines.one_coordinate.Law`.

    Attributes:
        ground, body: the pins' distances from the crossing, q and b [m]. mass, turning_inertia, rod: of the
        body [kg], [kg m^2]; of a link about its ground pin [kg m^2]. stub: mass of a strip's part on the
        body [kg]; stub_place: (2, 2) centres of both from the crossing [m].
    """

    at_rest: Geometry
    inclination: float
    ground: float
    body: float
    spring: float
    mass: float
    turning_inertia: float
    rod: float
    stub: float
    stub_place: Array

    def centre(self, p: Array) -> Array:
        """Return the centre of mass."""
        arm = self.at_rest.centre - self.at_rest.crossing
        return _plane(self._shift(p)[0] + complex(*arm) * np.exp(1j * p)) + self.at_rest.crossing

    def energy(self, p: Array) -> Array:
        """Return V."""
        mean, half = self._links(p)
        return np.asarray(self.spring * (mean[0] ** 2 + (p - mean[0]) ** 2 + 2.0 * half[0] ** 2))

    def torque(self, p: Array) -> Array:
        """Return V'."""
        mean, half = self._links(p)
        by_mean = mean[0] * mean[1] + (p - mean[0]) * (1.0 - mean[1])
        return np.asarray(2.0 * self.spring * (by_mean + 2.0 * half[0] * half[1]))

    def stiffness(self, p: Array) -> Array:
        """Return V''."""
        mean, half = self._links(p)
        by_mean = mean[1] ** 2 + mean[0] * mean[2] + (1.0 - mean[1]) ** 2 - (p - mean[0]) * mean[2]
        by_half = half[1] ** 2 + half[0] * half[2]
        return np.asarray(2.0 * self.spring * (by_mean + 2.0 * by_half))

    def inertia(self, p: Array) -> Array:
        """Return M."""
        mean, half = self._links(p)
        links = self.rod * ((mean[1] + half[1]) ** 2 + (mean[1] - half[1]) ** 2)
        return np.asarray(
            self.turning_inertia
            + links
            + self.mass * self._speed(p, self.at_rest.centre - self.at_rest.crossing)
            + self.stub * sum(self._speed(p, place) for place in self.stub_place)
        )

    def _speed(self, p: Array, arm: Array) -> Array:
        """Return the square of the speed of a point of the body at p' = 1 [m^2]."""
        return np.asarray(np.abs(self._shift(p)[1] + 1j * complex(*arm) * np.exp(1j * p)) ** 2)

    def _between(self, p: Array) -> tuple[Array, Array, Array]:
        """Return |w| and its two derivatives by p [m]."""
        q, b = self.ground, self.body
        size = np.abs(q + b * np.exp(1j * p))
        first = -q * b * np.sin(p) / size
        return size, first, (-q * b * np.cos(p) - first**2) / size

    def _links(self, p: Array) -> tuple[tuple[Array, ...], tuple[Array, ...]]:
        """Return mean rotation and half difference of the links, each with two derivatives by p."""
        q, b = self.ground, self.body
        size, first, second = self._between(p)
        mean = np.unwrap(np.angle(q + b * np.exp(1j * p)))
        mean_1 = b * (b + q * np.cos(p)) / size**2
        mean_2 = -q * b * np.sin(p) / size**2 - 2.0 * mean_1 * first / size
        scale = math.cos(self.inclination) / (q + b)
        z, z_1, z_2 = scale * size, scale * first, scale * second
        height = np.sqrt(1.0 - z**2)
        half = (np.arccos(z) - self.inclination, -z_1 / height, -z_2 / height - z * z_1**2 / height**3)
        return (mean, mean_1, mean_2), half

    def _shift(self, p: Array) -> tuple[Array, Array]:
        """Return the displacement of the body's point at the crossing, as x + iy, and its derivative [m]."""
        q, b = self.ground, self.body
        w, w_1 = q + b * np.exp(1j * p), 1j * b * np.exp(1j * p)
        size, first, _ = self._between(p)
        cosine, sine = math.cos(self.inclination), math.sin(self.inclination)
        height = np.sqrt((q + b) ** 2 / size**2 - cosine**2)
        height_1 = -((q + b) ** 2) * first / (size**3 * height)
        return 1j * w * (height - sine), 1j * (w_1 * (height - sine) + w * height_1)


def _law(problem: Problem) -> _FourBar:
    """Return the law of a pivot."""
    at_rest, link = geometry_of(problem), link_length(problem) * problem.length
    left = 0.5 * (problem.length - link)
    ground = problem.crossing_ratio * problem.length - left
    body = (1.0 - problem.crossing_ratio) * problem.length - left
    linear = problem.density * problem.area
    return _FourBar(
        at_rest=at_rest,
        inclination=problem.inclination,
        ground=ground,
        body=body,
        spring=spring(problem),
        mass=problem.body_mass,
        turning_inertia=problem.body_moment_of_inertia + 2.0 * linear * left**3 / 12.0,
        rod=linear * link**3 / 3.0,
        stub=linear * left,
        stub_place=(body + 0.5 * left) * at_rest.direction,
    )


def _plane(z: Array) -> Array:
    return np.stack((z.real, z.imag), axis=-1)


four_bar = Surrogate(model="four-bar", law_of=_law)
