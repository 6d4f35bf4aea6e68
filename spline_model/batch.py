"""Many designs of the pivot at once, on the condensed path and on all cores."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from spline_model.compile import compile_scene
from spline_model.effects.registry import MOTION_ONLY
from spline_model.errors import InvalidParameter, require_count
from spline_model.newton import TOLERANCE
from spline_model.pivot import cross_axis_pivot
from spline_model.reduced.assembly import working_space
from spline_model.reduced.many import Designs, follow_share, stations_of
from spline_model.reduced.model import LEAST_COMPLIANCE, Reduced, at_rest, reduced
from spline_model.reduced.path import Route, empty_answer
from spline_model.reduced.preload import preload_of
from spline_model.static_answers import STATIONS
from spline_model.strip.laws import MATERIAL

Array = NDArray[np.float64]

BATCHED = {"bending", "stretching", *MOTION_ONLY}
"""Effects of a batch; of these statics asks for the first two only."""

POSITIVE = ("length", "area", "second_moment_of_area", "youngs_modulus")
"""Columns that statics reads and that must be above zero; the others are checked on the first design."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Batch:
    """Answers of D designs at S states each, the unloaded one first; nan behind a path that stopped.

    states (D,) converged states; rotation (S,), or (D, S) where designs have their own [rad];
    centre (D, S, 2) [m]; torque (D, S) [N m]; stiffness (D, S) [N m/rad]; energy (D, S) [J];
    strain (D, S) the largest of the extreme fibres, |N / (EA)| + |M| d / (2 EI) over the
    stations of both strips [1], nan without a section depth d; inertia (D, S) negative
    eigenvalues of the reduced tangent, 0 for a stable state, -1 behind a path that stopped;
    moment_defect (D, S) as in ``Path``; iterations (D,) of Newton.
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

    @property
    def converged(self) -> NDArray[np.bool_]:
        """Designs whose path reached its end, (D,)."""
        return np.asarray(self.states == self.rotation.shape[-1])


def solve_many(
    designs: Mapping[str, ArrayLike] | Sequence[Mapping[str, Any]],
    *,
    rotation: ArrayLike,
    increments: int = 20,
    threads: int | None = None,
    section_depth: ArrayLike | None = None,
    **discretisation: Any,
) -> Batch:
    """Static paths of many pivots to one rotation, or each to its own [rad], a number or (D,).

    designs: keywords of ``cross_axis_pivot`` as columns, each a number or an array (D,), or
    one mapping a design; section_depth: in the plane of bending [m], a number or (D,), by
    which strains are asked for; discretisation: the same for all. The compiled paths run
    without the interpreter's lock on ``threads`` threads, default all cores; the answers do
    not depend on their number. Raises InvalidParameter with the number of a bad design.
    """
    require_count("increments", increments, 1)
    columns = _columns(designs)
    cross_axis_pivot(**{name: _plain(values[0]) for name, values in columns.items()}, **discretisation)
    numbers = _designs(columns, rotation)
    count = len(numbers.length)
    depth = np.zeros(0)
    if section_depth is not None:
        given = _one_each("section_depth", section_depth, count, above=0.0)
        depth = np.broadcast_to(given, (count,)) / numbers.length
    batch = _empty(count, increments, rotation, numbers.rotation)
    workers = threads or os.cpu_count() or 1
    with ThreadPoolExecutor(workers) as pool:
        for slender in (False, True):  # their elements differ: see ``LEAST_COMPLIANCE``
            rows = np.flatnonzero((numbers.compliance < LEAST_COMPLIANCE) == slender)
            if not rows.size:
                continue
            share = _Share(
                model=_model(slender, discretisation),
                rows=rows,
                designs=Designs(*(part[rows] for part in numbers)),
                depth=depth[rows] if depth.size else depth,
                increments=increments,
                workers=workers,
                batch=batch,
            )
            list(pool.map(share.solve, range(workers)))
    return batch


def _model(slender: bool, discretisation: Mapping[str, Any]) -> Reduced:
    """The element's scene of a pivot of unit length and rigidity; refused where a batch does not know it."""
    compliance = LEAST_COMPLIANCE * (0.1 if slender else 10.0)
    pivot = cross_axis_pivot(
        length=1.0,
        area=1.0 / compliance,
        second_moment_of_area=1.0,
        youngs_modulus=1.0,
        poisson_ratio=0.3,
        density=1.0,
        body_mass=1.0,
        body_moment_of_inertia=1.0,
        inclination=math.pi / 4,
        crossing_ratio=0.5,
        **discretisation,
    )
    model = reduced(compile_scene(pivot.driven(1.0)))
    loaded = set(pivot.mechanism.effects) - BATCHED
    if model is None or loaded or model.strips.measure != MATERIAL or not model.strips.split:
        expected = "material measure, mixed stretching, no loads"
        raise InvalidParameter("discretisation", dict(discretisation), expected)
    return model


def _columns(designs: Mapping[str, ArrayLike] | Sequence[Mapping[str, Any]]) -> dict[str, Array]:
    """Designs as columns of equal length, pairs with a second axis."""
    if not isinstance(designs, Mapping):
        designs = {name: np.array([design[name] for design in designs]) for name in designs[0]}
    pairs = {name: 1 + (name == "centre_offset") for name in designs}
    values = {name: np.asarray(value, dtype=float) for name, value in designs.items()}
    count = max((len(v) for name, v in values.items() if v.ndim >= pairs[name]), default=1)
    shape = {name: (count, 2) if pairs[name] == 2 else (count,) for name in values}
    return {name: np.broadcast_to(value, shape[name]) for name, value in values.items()}


def _plain(value: Any) -> Any:
    return tuple(float(part) for part in value) if np.ndim(value) else float(value)


def _designs(columns: Mapping[str, Array], rotation: ArrayLike) -> Designs:
    """The designs' numbers over their own length and energy."""
    c = columns
    for name in POSITIVE:
        _refuse(c, name, c[name] > 0, "a finite number > 0")
    _refuse(c, "inclination", (c["inclination"] > 0) & (c["inclination"] < np.pi / 2), "0 to pi/2")
    _refuse(c, "crossing_ratio", (c["crossing_ratio"] > 0) & (c["crossing_ratio"] < 1), "0 to 1")
    length, count = c["length"], len(c["length"])
    turn = np.broadcast_to(c.get("orientation", np.zeros(1)), (count,))
    offset = np.broadcast_to(c.get("centre_offset", np.zeros((1, 2))), (count, 2)) / length[:, None]
    cos, sin = np.cos(c["inclination"]), np.sin(c["inclination"])
    axis = np.stack((np.stack((cos, sin), -1), np.stack((-cos, sin), -1)), axis=1)
    root = np.zeros((count, 2, 2))
    root[:, 1, 0] = 2 * c["crossing_ratio"] * cos
    tip = root + axis
    centre = tip.mean(axis=1) + offset
    matrix = np.moveaxis(np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]), -1, 0)
    arm = np.einsum("dij,dsj->dsi", matrix, tip - centre[:, None])
    axis, root = (np.einsum("dij,dsj->dsi", matrix, part) for part in (axis, root))
    angle = np.arctan2(axis[..., 1], axis[..., 0])[..., None]
    rigidity = c["youngs_modulus"] * c["second_moment_of_area"]
    turned = np.broadcast_to(_one_each("rotation", rotation, count), (count,))
    return Designs(
        length=np.ascontiguousarray(length),
        energy=rigidity / length,
        root=np.concatenate((root, angle), axis=2),
        tip=np.concatenate((arm, angle), axis=2),
        compliance=rigidity / (c["youngs_modulus"] * c["area"] * length**2),
        centre=root[:, 0] + axis[:, 0] - arm[:, 0],
        rotation=np.ascontiguousarray(turned),
    )


def _refuse(columns: Mapping[str, Array], name: str, good: NDArray[np.bool_], expected: str) -> None:
    bad = np.flatnonzero(~(good & np.isfinite(columns[name])))
    if bad.size:
        raise InvalidParameter(f"design {bad[0]}: {name}", float(columns[name][bad[0]]), expected)


def _one_each(name: str, given: ArrayLike, count: int, above: float = -np.inf) -> Array:
    """A number for all designs, (1,), or one for each, (D,)."""
    values = np.atleast_1d(np.asarray(given, dtype=float))
    if values.shape not in ((1,), (count,)):
        raise InvalidParameter(name, values.shape, f"a number or an array of {count}, one a design")
    bound = "" if above == -np.inf else f" > {above:g}"
    _refuse({name: values}, name, values > above, f"a finite number{bound}")
    return values


def _empty(designs: int, increments: int, rotation: ArrayLike, turned: Array) -> Batch:
    shape = (designs, increments + 1)
    paths = np.linspace(0.0, turned, increments + 1, axis=1)
    return Batch(
        states=np.zeros(designs, dtype=np.int64),
        rotation=paths if np.ndim(rotation) else paths[0],
        centre=np.full((*shape, 2), np.nan),
        torque=np.full(shape, np.nan),
        stiffness=np.full(shape, np.nan),
        energy=np.full(shape, np.nan),
        strain=np.full(shape, np.nan),
        inertia=np.full(shape, -1, dtype=np.int64),
        moment_defect=np.full(shape, np.nan),
        iterations=np.zeros(designs, dtype=np.int64),
    )


@dataclass(frozen=True, kw_only=True, eq=False)
class _Share:
    """Designs of one kind of element, their rows in the batch, and what each thread does of them."""

    model: Reduced
    rows: NDArray[np.int64]
    designs: Designs
    depth: Array
    increments: int
    workers: int
    batch: Batch

    def solve(self, worker: int) -> None:
        """Solve the designs of one thread, with working arrays of its own."""
        model, batch = self.model, self.batch
        own = {name: getattr(model.strips, name).copy() for name in ("root", "tip", "compliance", "gain")}
        bodies = model.bodies._replace(rest=model.bodies.rest.copy())
        factors = np.linspace(0.0, 1.0, self.increments + 1)
        route = Route(
            factor=factors, origin=np.zeros(1), target=np.zeros(1), load=0.0, growth=0.0, passes=True
        )
        results = (
            batch.states,
            batch.centre,
            batch.torque,
            batch.stiffness,
            batch.energy,
            batch.strain,
            batch.inertia,
            batch.moment_defect,
            batch.iterations,
        )
        follow_share(
            worker,
            self.workers,
            self.rows,
            self.designs,
            np.arange(model.strips.compliance.shape[1]) < model.strips.split,
            self.depth,
            stations_of(model, STATIONS),
            route,
            True,
            preload_of(model),
            at_rest(model),
            bodies,
            model.strips._replace(**own),
            model.shape,
            model.local(),
            working_space(bodies, model.size),
            TOLERANCE,
            empty_answer(len(factors), model.size, len(bodies.rest), 1),
            results,
        )
