"""The paths of many designs of a mechanism with one number of control points, and their answers."""

from __future__ import annotations

from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import compile_scene
from spline_model.errors import InvalidParameter
from spline_model.mechanism import Mechanism
from spline_model.newton import TOLERANCE
from spline_model.parameters import Given
from spline_model.reduced.arrays import Answer, Route
from spline_model.reduced.many import Share, Stations, follow_all
from spline_model.reduced.model import LEAST_COMPLIANCE, Reduced, reduced
from spline_model.reduced.numbers import Designs, Numbers
from spline_model.reduced.preload import Preload
from spline_model.sections import STATIONS
from spline_model.solution import named, remark
from spline_model.statics import has_loads, steady

Array = NDArray[np.float64]

ESTIMATED = ("trajectory", "torque", "stiffness", "energy", "strain")
"""What the accuracy of a batch is about."""
SOLVED = (
    "states",
    "centre",
    "torque",
    "stiffness",
    "energy",
    "strain",
    "inertia",
    "moment_defect",
    "iterations",
)
"""What the kernel fills, in its order."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Batch:
    """Static paths of D designs at S states each, the unrotated state first; nan after the end of a stopped
    path.

    Attributes
    ----------
    states : (D,) int
        Number of converged states.
    rotation : (S,) or (D, S) rad
        (D, S) if designs have their own rotations.
    centre : (D, S, 2) m
    torque, stiffness : (D, S) N m and N m/rad
    energy : (D, S) J
    strain : (D, S) 1
        Largest strain of the extreme fibres, |N / (EA)| + |M| d / (2 EI), over the stations of all strips;
        nan without a section depth d.
    inertia : (D, S) int
        Negative eigenvalues of the reduced tangent, 0 for a stable state, -1 after the end of a stopped path.
    moment_defect : (D, S) 1
        As in ``spline_model.static_answers.StaticSolution``.
    iterations, control_points : (D,) int
    accuracy : float, 1, or None
        For which control points were chosen; None for a given number.
    errors : mapping of str to (D,) 1
        Estimated errors by the names of ``ErrorEstimate`` and "strain"; nan if no error is estimated.
    """

    states: NDArray[np.int64]
    rotation: Array
    centre: Array
    torque: Array
    stiffness: Array
    energy: Array
    strain: Array
    inertia: NDArray[np.int64]
    moment_defect: Array
    iterations: NDArray[np.int64]
    control_points: NDArray[np.int64]
    accuracy: float | None
    errors: dict[str, Array]

    @property
    def converged(self) -> NDArray[np.bool_]:
        """Whether the path of each design reached its end, (D,) of bool [1]."""
        return np.asarray(self.states == self.rotation.shape[-1])

    @property
    def resolved(self) -> NDArray[np.bool_]:
        """Designs whose estimated errors are below the accuracy, (D,); all of them for a given number."""
        if self.accuracy is None:
            return np.ones(len(self.states), dtype=bool)
        return np.asarray(np.fmax.reduce(list(self.errors.values())) <= self.accuracy)

    def take(self, other: Batch, rows: NDArray[np.int64], errors: Mapping[str, Array]) -> None:
        """Take over the answers of some designs from another batch.

        other: batch of these R designs, in their order; rows: their numbers in this batch (R,); errors: their
        estimated relative errors by quantity (R,) [1].
        """
        for name in (*SOLVED, "control_points"):
            getattr(self, name)[rows] = getattr(other, name)[rows]
        for name, each in errors.items():
            self.errors[name][rows] = each

    def resolution(self, row: int) -> str:
        """Return a message on errors of a design that exceed the accuracy or are not estimated; empty if none
        do."""
        if self.resolved[row]:
            return ""
        errors = {name: float(each[row]) for name, each in self.errors.items()}
        grid = named(1, int(self.control_points[row]))
        return remark(errors, float(self.accuracy or 0.0), grid) or (
            f"accuracy not estimated: {grid} and more have no common path"
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class Many:
    """What is asked of D designs of a mechanism: rotations (D,) [rad] of a body, the same for all where it is
    ``shared``, depths (D,) of the sections over L or (0,), and whether loads come on ``first``."""

    base: Mechanism
    given: Given
    turned: Array
    shared: bool
    depth: Array
    body: str
    increments: int
    first: bool
    workers: int

    def solve(self, batch: Batch, rows: NDArray[np.int64]) -> None:
        """Solve the designs of the numbers ``rows`` (R,) and write them into a batch in SI units."""
        base = self.base.on(1, int(batch.control_points[0]))
        model, place = _model(base, self.body, self.first), self._place
        split, small = model.strips.split, (self.given.compliance[rows] < LEAST_COMPLIANCE).any(axis=1)
        slender_ones = (small | ~model.strips.compliance[:, :split].all()) & (split > 0)
        with ThreadPoolExecutor(self.workers) as pool:
            for slender in (False, True):  # their elements differ: see ``LEAST_COMPLIANCE``
                alike = rows[slender_ones == slender]
                if alike.size:
                    kind = model.as_slender(slender=slender)
                    solved = partial(_solve_share, kind, self._share(kind, place, alike, batch))
                    together = map if self.workers == 1 else pool.map
                    list(together(solved, range(self.workers)))

    def _share(self, model: Reduced, place: int, rows: NDArray[np.int64], batch: Batch) -> Share:
        """What kernels know of the designs of the numbers ``rows``, as one thread would solve all of them."""
        given, base = self.given.rows(rows), Given.of(self.base.design)
        length = given.span.max(axis=1)
        units = length, given.rigidity.max(axis=1) / length
        numbers = given.numbers(base, model.system.scene)
        designs, strips = model.designs(numbers, *units), model.strips
        designs.target[:, model.bodies.driven] = self.turned[rows]
        outer = len(model.bodies.load) - designs.force.shape[2]
        stiff = 1.0 / designs.compliance[..., strips.coupled :]
        none = np.zeros(len(model.bodies.held))
        grows = np.linspace(0.0, 1.0, 2 * model.system.is_preloaded)
        force = np.pad(designs.force, ((0, 0), (0, 0), (0, outer)))
        return Share(
            rows=rows,
            begin=0,
            stride=self.workers,
            designs=designs,
            force=force,
            gain=np.concatenate((strips.gain[None, :, : strips.coupled].repeat(len(rows), 0), stiff), axis=2),
            preload=Preload.of_designs(model, designs, force[:, 1], numbers.points),
            stations=self._stations(rows, model, given, numbers, designs),
            growing=Route(factor=grows, origin=none, target=0.0 * none, growth=0.0, swells=True),
            place=place,
            results=tuple(getattr(batch, name) for name in SOLVED),
        )

    def _stations(
        self, rows: NDArray[np.int64], model: Reduced, given: Given, numbers: Numbers, designs: Designs
    ) -> Stations:
        """Where strains are computed, if they are asked for."""
        at = model.at_stations(STATIONS)
        if not self.depth.size:
            return Stations(np.zeros((0, 0, 0, 0)), np.zeros((0, 0, 0)), at.shape, at.local())
        length, energy = designs.length, designs.energy
        area, _, modulus = np.moveaxis(given.section, -1, 0)
        bend = 0.5 * (self.depth[rows] * length)[:, None] / given.rigidity
        fibre = np.stack((1.0 / (area * modulus * length[:, None]), bend), axis=-1)
        along = at.designs(numbers, length, energy, gauss=model.shape).along
        return Stations(along, fibre * energy[:, None, None], at.shape, at.local())

    def empty(self, control_points: int, accuracy: float | None) -> Batch:
        """Return a batch of D designs of which none is solved yet; accuracy: what it is asked for [1]."""
        designs = len(self.turned)
        paths = np.linspace(0.0, self.turned, self.increments + 1, axis=1)
        by_state = ("torque", "stiffness", "energy", "strain", "moment_defect")
        return Batch(
            states=np.zeros(designs, dtype=np.int64),
            rotation=paths[0] if self.shared else paths,
            centre=np.full((*paths.shape, 2), np.nan),
            **{name: np.full(paths.shape, np.nan) for name in by_state},
            inertia=np.full(paths.shape, -1, dtype=np.int64),
            iterations=np.zeros(designs, dtype=np.int64),
            control_points=np.full(designs, control_points),
            accuracy=accuracy,
            errors={name: np.full(designs, np.nan) for name in ESTIMATED},
        )

    @property
    def _place(self) -> int:
        """Where the body's pose begins."""
        return 3 * [body.name for body in self.base.design.bodies].index(self.body)


def _model(mechanism: Mechanism, body: str, first: bool) -> Reduced:
    """The element's scene of a mechanism, one body turned; refused where a batch does not know it.

    first: whether loads come on as weight does.
    """
    scene = mechanism.driven(1.0, body)
    system = compile_scene(steady(scene) if first and has_loads(scene) else scene)
    system.require_dead("designs")
    model = reduced(system)
    if model is None:
        raise InvalidParameter("discretisation", "published forces", "measure material or spatial")
    return model


def _solve_share(model: Reduced, share: Share, worker: int) -> None:
    """Solve what one thread does of the designs of one kind of element, with working arrays of its own."""
    held, states = len(model.bodies.held), share.results[SOLVED.index("torque")].shape[1]
    (origin, target), mine = np.zeros((2, held)), Preload.of(model)
    route = Route(np.linspace(0.0, 1.0, states), origin, target, growth=1.0, passes=True)
    own = share._replace(
        begin=worker,
        preload=share.preload._replace(change=mine.change, push=mine.push, out=mine.out),
        stations=share.stations._replace(local=model.at_stations(STATIONS).local()),
        growing=share.growing._replace(origin=origin),
    )
    answer = Answer.empty(states, model.size, held)
    follow_all(own, route, True, model.arrays(), TOLERANCE, answer)  # the moment defect refuses
