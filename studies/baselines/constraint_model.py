"""The pivot as the beam constraint model has it, a beam a strip, and as its chained form, several in a row.

See `studies.baselines.constraint_strips`. What a rotation leaves free is eliminated: the body's place and,
in the chained form, the nodes within the strips, each solved for from rest on.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from studies.baselines.answer import geometry_of
from studies.baselines.constraint_strips import Strips
from studies.baselines.one_coordinate import Surrogate
from studies.cases.problem import Problem
from studies.kinds import Array

#: Beams a strip of the chained model.
CHAINED = 4
#: Largest turn of a step to a rotation [rad].
STEP = 0.1


@dataclass(frozen=True, kw_only=True)
class _State:
    """Equilibria at S rotations: the body's place (S, 2) [L], V, V', V'' (S,) [EI/L] and M (S,) [kg L^2]."""

    place: Array
    energy: Array
    torque: Array
    stiffness: Array
    inertia: Array


@dataclass(frozen=True, kw_only=True)
class _ConstraintModel:
    """The law of one pivot by its data and its strips; see `studies.baselines.one_coordinate.Law`."""

    problem: Problem
    strips: Strips
    _last: dict[bytes, _State] = field(default_factory=dict, repr=False)

    def centre(self, p: Array) -> Array:
        """Return the centre of mass; solves the equilibria, which the others then read."""
        self._last.clear()
        return self._states(p).place * self.problem.length

    def energy(self, p: Array) -> Array:
        """Return V."""
        return self._scale * self._states(p).energy

    def torque(self, p: Array) -> Array:
        """Return V'."""
        return self._scale * self._states(p).torque

    def stiffness(self, p: Array) -> Array:
        """Return V''."""
        return self._scale * self._states(p).stiffness

    def inertia(self, p: Array) -> Array:
        """Return M."""
        return self._states(p).inertia * self.problem.length**2

    @property
    def _scale(self) -> float:
        """EI/L [N m]."""
        given = self.problem
        return given.youngs_modulus * given.second_moment_of_area / given.length

    def _states(self, p: Array) -> _State:
        """Return the equilibria at rotations (S,), each reached from rest in equal steps."""
        key = np.asarray(p, dtype=float).tobytes()
        if key not in self._last:
            steps = max(1, math.ceil(float(np.abs(p).max(initial=0.0)) / STEP))
            y = np.tile(self.strips.rest(), (len(p), 1))
            slope = np.zeros_like(y)
            for step in range(steps + 1):
                ahead = step / steps * p - y[:, -1]
                y += ahead[:, None] * slope
                y[:, -1] = step / steps * p
                slope = self.strips.turned(y)
            self._last[key] = self._state(y, slope)
        return self._last[key]

    def _state(self, y: Array, slope: Array) -> _State:
        """Return the answers at equilibria with the derivative of their coordinates by the rotation."""
        energy, gradient, hessian = self.strips.assembled(y)
        given = self.problem
        speed = np.einsum("si,si->s", slope[:, -3:-1], slope[:, -3:-1])
        mass = given.density * given.area * given.length
        turning = given.body_moment_of_inertia / given.length**2
        return _State(
            place=y[:, -3:-1],
            energy=energy,
            torque=gradient[:, -1],
            stiffness=np.einsum("si,si->s", hessian[:, -1], slope),
            inertia=turning + given.body_mass * speed + mass * self.strips.moving(y, slope),
        )


def with_beams(count: int) -> Callable[[Problem], _ConstraintModel]:
    """Return what makes the law of a pivot with so many beams a strip."""

    def law(problem: Problem) -> _ConstraintModel:
        at_rest, length = geometry_of(problem), problem.length
        strips = Strips(
            root=at_rest.root / length,
            direction=at_rest.direction,
            centre=at_rest.centre / length,
            compliance=problem.second_moment_of_area / (problem.area * length**2),
            count=count,
        )
        return _ConstraintModel(problem=problem, strips=strips)

    return law


constraint_model = Surrogate(model="beam constraint model", law_of=with_beams(1))
chained_constraint_model = Surrogate(model="chained constraint model", law_of=with_beams(CHAINED))
