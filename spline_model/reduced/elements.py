"""The strips' elements as a system to follow paths on, with nothing condensed: regular wherever a path is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from spline_model import checks
from spline_model.compile import System
from spline_model.continuation.followed import SMALLEST_MOMENT, Followed, Point
from spline_model.frames import Frames
from spline_model.newton import TOLERANCE
from spline_model.reduced.arrays import (
    AXIAL,
    BENDING,
    SLOWEST,
    Answer,
    Arrays,
    Route,
)
from spline_model.reduced.assembly import moment_defect
from spline_model.reduced.equilibrium import CONFIRMED, EVALUATIONS, HALVED, ITERATIONS
from spline_model.reduced.model import Reduced, from_unknowns, reduced
from spline_model.reduced.path import follow
from spline_model.reduced.preload import Preload, act, apart
from spline_model.reduced.states import gather, unknowns_of
from spline_model.strip.compiled import kernel
from spline_model.strip.element import ON_POINTS
from spline_model.tables import Followers

Array = NDArray[np.float64]

ASIDE = 1e-5
"""Part of a direction over which it is followed to either side, in lengths and rad: exact to 1e-10."""


@kernel()
def _defect_of(y, arrays):
    """The moment defect of the state that was last gathered."""
    return moment_defect(y, arrays.strips, arrays.shape, arrays.local, SMALLEST_MOMENT)


@dataclass(frozen=True, kw_only=True, eq=False)
class Elements(Followed):
    """Unknowns z (N,): poses, w and a of all strips, reactions of the drives.

    All is dimensionless. arrays: the model to kernels.
    """

    model: Reduced
    arrays: Arrays

    @classmethod
    def of(cls, system: System) -> Self:
        """The elements of a system that they know."""
        model = reduced(system)
        assert model is not None, "``followed`` asks first"
        size = model.size + len(model.bodies.held)
        return cls(
            system=system,
            gradient=np.empty(size),
            hessian=np.empty((size, size)),
            model=model,
            arrays=model.arrays(),
        )

    @property
    def compiled(self) -> bool:
        """Whether a path is followed by kernels where nothing happens on it."""
        return not self.followers.place.size

    @property
    def frames(self) -> Frames:
        """Frames that bodies carry, among these unknowns as among y."""
        return self.model.bodies.frames

    @property
    def followers(self) -> Followers:
        """Forces that turn with bodies, among these unknowns."""
        return self.model.followers

    @property
    def held(self) -> slice:
        """Places of the drives' reactions."""
        return slice(self.model.size, self.model.size + len(self.model.bodies.held))

    @cached_property
    def place(self) -> NDArray[np.int64]:
        """Place of each entry of y (Y,) in z, an index."""
        poses, (count, modes) = len(self.model.bodies.rest), self.model.strips.compliance.shape
        return _places(poses, count, (self.model.size - poses) // count - modes, modes)

    @cached_property
    def preload(self) -> Preload:
        """Weight and pre-strain of the model."""
        return Preload.of(self.model)

    @cached_property
    def loose(self) -> Arrays:
        """The same with bodies and strips that a share of the preload is written to."""
        bodies, strips = apart(self.model)
        return self.arrays._replace(bodies=bodies, strips=strips)

    @cached_property
    def unit(self) -> Array:
        """Of each unknown (N,): steps are measured in about as much as the control points move.

        With a pose go two points of each strip that is clamped to it, with s_A and s_B one, at its reach.
        """
        strips, unit = self.model.strips, np.ones(len(self.gradient))
        poses, count = len(self.model.bodies.rest), len(strips.roots)
        carried = np.bincount(np.append(strips.roots, strips.tips) + 1, minlength=poses // 3 + 1)[1:]
        unit[:poses] = np.repeat(1.0 / np.sqrt(1.0 + 2.0 * carried), 3)
        unit[poses : self.count].reshape(count, -1)[:, -2:] = 1.0 / strips.reach
        return unit

    def run(self, load_factors: Array, start: Array) -> Answer:
        """The states from ``start`` (Y,) at the first load factor on, until stability or a check ends it."""
        origin, target = self.model.drives
        return self._follow(Route(load_factors, origin, target, 1.0), start, self.arrays)

    def grown(self) -> Array | None:
        """State (Y,) under all weight and pre-strain [m, rad, N]; None if something happens on the way."""
        origin, target = self.model.drives
        route = Route(np.array([0.0, 1.0]), origin, 0.0 * target, 0.0, swells=True)
        answer = self._follow(route, self.model.start, self.loose)
        return answer.y[1] if len(answer.y) == 2 else None

    def _follow(self, route: Route, start: Array, arrays: Arrays) -> Answer:
        """A stretch of a path along which nothing happens, compiled."""
        count = self.counters
        answer = Answer.empty(len(route.factor), self.model.size, len(route.origin))
        done = follow(start, route, self.judged, self.preload, arrays, TOLERANCE, answer)
        count.halved_increments += int(answer.counters[HALVED])
        count.newton_iterations += int(answer.counters[ITERATIONS])
        evaluations = int(answer.counters[EVALUATIONS])
        count.residual_evaluations += evaluations + int(answer.counters[CONFIRMED])
        count.tangent_evaluations += evaluations
        count.factorisations += evaluations
        return answer.rows(slice(0, done))

    @property
    def energy(self) -> float:
        """All is dimensionless."""
        return 1.0

    @cached_property
    def count(self) -> int:
        """Poses and w."""
        return self.model.size - self.model.strips.compliance.size

    @property
    def driven(self) -> int | None:
        """Place of the driven rotation's torque, if there is one."""
        place = self.model.bodies.driven
        return self.model.size + place if place >= 0 else None

    def y(self, z: Array) -> Array:
        """Return the state (Y,) in the order of the elements, of unknowns z (N,) [m, rad, N]."""
        return z.take(self.place, axis=-1)

    def fill(self, z: Array, load_factor: float, share: float) -> tuple[float, float]:
        """Fill gradient and tangent at z (N,); return bending and axial energy [J].

        load_factor [1] of the loads; share [1] of the preload.
        """
        model = self.model
        arrays = self.arrays if share == 1.0 else self.loose
        if share != 1.0:
            act(share, self.preload, arrays.bodies, arrays.strips)
        (origin, target), held, own = model.drives, model.bodies.held, self.place
        y, gradient, hessian = self.y(z), np.zeros(model.size), np.zeros((model.size, model.size))
        gather(y[None], np.array([load_factor]), arrays, gradient[None], hessian[None])
        z[own], self.gradient[own], self.hessian[:] = y, gradient, 0.0  # frames in y were put in place
        self.hessian[own[:, None], own] = hessian
        self.hessian[model.bodies.frames.carried, model.bodies.frames.carried] = 1.0
        rows = model.size + np.arange(len(held))
        self.gradient[held] -= z[rows]
        self.gradient[rows] = origin + load_factor * target - z[held]
        self.hessian[held, rows] = self.hessian[rows, held] = -1.0
        self.followers.subtract(z, load_factor, self.gradient, self.hessian)
        out = arrays.space.out
        return float(out[BENDING]), float(out[AXIAL])

    def external(self, z: Array) -> tuple[float, float]:
        """Return the work from rest to z (N,) of loads and of weight [J]."""
        bodies, preload = self.model.bodies, self.preload
        moved = z[: len(bodies.rest)] - bodies.rest
        loads, weight = (float(moved @ force[: len(moved)]) for force in (bodies.load, bodies.weight))
        hung = preload.numbers[:, ON_POINTS:] * self.arrays.local.points
        return loads, weight + float(hung.sum() - preload.hung[0])

    def in_springs(self, z: Array) -> float:
        """Return the energy of the springs at z (N,) [J]."""
        springs = self.model.bodies.springs
        moved = z[: len(springs)] - self.model.bodies.rest[: len(springs)]
        return float(0.5 * moved @ springs @ moved)

    @cached_property
    def push_of_loads(self) -> Array:
        """Minus the derivative of the gradient in the load factor (N,)."""
        force, poses = np.zeros(len(self.gradient)), len(self.model.bodies.rest)
        force[:poses] = self.model.bodies.load[:poses]
        force[self.held] = -self.model.drives[1]
        return force

    def refuse(self, z: Array) -> str:
        """Return why a state z (N,) [m, rad, N] that was just evaluated is no strip; empty if it is one."""
        own = self.place[len(self.model.bodies.rest) :].reshape(len(self.model.strips.roots), -1)
        last = own.shape[1] - self.model.strips.compliance.shape[1]
        if (z[own[:, last - 2 : last]] > 0.0).all() and self.arrays.space.out[SLOWEST] > checks.SLOWEST_SPEED:
            return ""
        return super().refuse(self.unknowns(z))

    def defect(self, z: Array, load_factor: float) -> float:
        """Return the moment defect [1] of a state z (N,) at a load factor [1]."""
        share = self.acting(load_factor)[1]
        self.fill(z, load_factor, share)
        return float(_defect_of(self.y(z), self.arrays if share == 1.0 else self.loose))

    def state(self, unknowns: Array) -> Array:
        """Return z (N,) [m, rad, N] of the scene's unknowns (N,), whose clamps hold."""
        drives, z = self.system.drives, np.zeros(len(self.gradient))
        z[self.place] = from_unknowns(self.model, unknowns)
        z[self.held] = unknowns[drives.row] * self.model.drive_length / self.model.energy
        return z

    def unknowns(self, z: Array) -> Array:
        """Return the scene's unknowns [m, rad, N] at z (N,) or (S, N)."""
        states = np.atleast_2d(z)
        return unknowns_of(self.model, self.y(states), states[:, self.held]).reshape(*z.shape[:-1], -1)

    def moved(self, z: Array, direction: Array) -> Array:
        """Change (Q,) of the scene's coordinates, dimensionless, with that of poses and w."""
        count, step = self.system.layout.coordinate_count, np.zeros(len(z))
        part = ASIDE / np.abs(direction).max()
        step[: self.count] = part * self.unit[: self.count] * direction
        there, back = (self.unknowns(z + way * step)[:count] for way in (1.0, -1.0))
        return np.asarray((there - back) / (2.0 * part * self.system.scales.unit[:count]))

    def rows(self, points: Sequence[Point], done: Sequence[float]) -> dict[str, Any]:
        """Return the arrays that a ``Path`` has by state, a row for each point.

        done (S,): int P_lambda d(lambda) to each of the S points [J].
        """
        z, factor, stiffness, energies, inertia = (
            np.array([getattr(p, name) for p in points])
            for name in ("z", "load_factor", "stiffness", "energies", "inertia")
        )
        answer = Answer(
            y=self.y(z),
            reaction=z[:, self.held],
            stiffness=stiffness,
            energies=energies,
            done=np.array(done),
            inertia=inertia,
            defect=np.array([self.defect(p.z, p.load_factor) for p in points]),
            counters=np.zeros(4, dtype=np.int64),
        )
        return self.compiled_rows(factor, answer) | {"z": z}

    def compiled_rows(self, factors: Array, answer: Answer) -> dict[str, Any]:
        """Return the same from the answer at load factors (S,) [1]."""
        model = self.model
        z = np.empty((len(factors), len(self.gradient)))
        z[:, self.place], z[:, self.held] = answer.y, answer.reaction
        count = len(model.system.scene.bodies)
        return {
            "load_factor": factors,
            "poses": answer.y[:, : 3 * count] * np.array([model.length, model.length, 1.0] * count),
            "reactions": answer.reaction * (model.energy / model.drive_length),
            "z": z,
            "stiffness": answer.stiffness * model.energy,
            "energies": answer.energies * model.energy,
            "done": answer.done * model.energy,
            "inertia": answer.inertia,
            "moment_defect": answer.defect,
        }


@lru_cache(maxsize=64)
def _places(poses: int, count: int, own: int, modes: int) -> NDArray[np.int64]:
    """Place of each entry of y in z, for strips of ``own`` coordinates w and that many axial forces a."""
    w = poses + np.arange(count * own).reshape(count, own)
    a = poses + count * own + np.arange(count * modes).reshape(count, modes)
    return np.concatenate((np.arange(poses), np.column_stack((w, a)).ravel()))


def followed(system: System, method: str = "condensed") -> Followed:
    """Return the system to follow a path on: the elements, where they know the scene and are asked for."""
    model = reduced(system) if method == "condensed" else None
    return Followed.of(system) if model is None else Elements.of(system)
