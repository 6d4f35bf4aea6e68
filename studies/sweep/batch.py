"""Static paths of plain pivots by the compiled kernel of many at once; what it cannot do goes one by one."""

import json
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from studies.answers.answer import centre_shift, shift_error
from studies.answers.models import model_of
from studies.answers.named import named
from studies.answers.quantities import QUANTITIES
from studies.answers.settings import Settings
from studies.answers.validity import SAME_NAME, Strip
from studies.cases import keys as case_keys
from studies.cases.design import design_of
from studies.cases.document import CaseError, is_mechanism
from studies.cases.effects import MOTION_ONLY
from studies.cases.problem import PIVOT_PARAMETERS, SIDES, Problem
from studies.cases.section import of_sides
from studies.kinds import Array
from studies.sweep import plan, points
from studies.sweep.plan import Task
from studies.sweep.points import CONVERGED, KNOWN, Paths

#: I / (A L^2) below which a strip is for the multiplier path, a hundredth above the kernel's own limit.
LEAST_COMPLIANCE = 1.01e-9
PLAIN = {"bending", "stretching"}
INCREMENTS = "drive.increments"

Columns = dict[str, Array]
_KEYS = {name: key for name, key in plan.PIVOT_KEYS.items() if key is not case_keys.NAMED}
_PARTS = {f"{name}.{part}" for name, key in _KEYS.items() if key.rule.kind == "pair" for part in plan.PARTS}


def solve_chunk(task: Task, start: int, columns: Mapping[str, list[Any]]) -> pa.Table:
    """Return the rows of the designs in `columns`, the first of which is point `start` of the sweep.

    Designs of which the compiled paths are not sure are solved by themselves, as those that these do not
    take: that says why a path stopped, and which branch is right. A row of any status but "converged", as of
    `points.solve`, has no quantities.
    """
    count = len(next(iter(columns.values())))
    found: dict[str, Any] = {name: np.full(count, np.nan) for name in task.quantities}
    status, reason = [CONVERGED] * count, [""] * count
    alone = np.ones(count, dtype=bool)
    for rows, quantities, told in _together(task, columns, count) if task.batch else ():
        alone[rows] = False
        for row in rows.tolist():
            reason[row] = told
        for name, values in quantities.items():
            found[name][rows] = values
    for row in np.flatnonzero(alone).tolist():
        design = {key: column[row] for key, column in columns.items()}
        status[row], reason[row], answer = points.solve(task, design)
        for name, value in answer.items():
            found[name][row] = value
    table: dict[str, Any] = {points.POINT: np.arange(start, start + count)}
    for key, column in columns.items():
        table[key] = [json.dumps(value) if isinstance(value, list) else value for value in column]
    table |= {points.STATUS: status, points.REASON: reason}
    arrays = [pa.array(values) for values in table.values()]
    for name, quantity in points.stored(task).items():
        kind = pa.int64() if quantity.whole else pa.float64()
        arrays.append(pa.array(found[name], type=kind, mask=np.isnan(found[name])))
    return pa.Table.from_arrays(arrays, names=[*table, *found])


def takes(task: Task) -> bool:
    """Whether the kernel may take the designs of a sweep: plain pivots on a static path, by splines.

    What it refuses in the end (other curves, or strips too slender) goes one by one.
    """
    own = {*_KEYS, *_PARTS, plan.SLENDERNESS} - plan.TAPER
    asked = {each.key for each in QUANTITIES if each.name_in_sweep in task.quantities}
    if not asked <= set(KNOWN):
        return False
    if task.model != "spline" or task.kind != "static" or is_mechanism(task.case):
        return False
    if any(f"strip.{name}" in plan.TAPER for name in task.case["strip"]):
        return False
    try:
        design = design_of("case", task.case)
    except CaseError:  # only what is varied completes it
        return False
    effects = set(design.effects.names)
    return (
        not named(design)
        and PLAIN <= effects <= PLAIN | set(MOTION_ONLY)
        and all(key in own or plan.is_setting(key) for key in task.keys)
    )


def _together(
    task: Task, columns: Mapping[str, list[Any]], count: int
) -> Iterator[tuple[NDArray[np.int64], Columns, str]]:
    """Yield rows of designs whose compiled paths are sure, their quantities and the reason of them all."""
    given = _attributes(task, columns, count)
    stout = given["second_moment_of_area"] >= LEAST_COMPLIANCE * given["area"] * given["length"] ** 2
    keys = [key for key in columns if key == INCREMENTS or plan.is_setting(key)]
    alike: dict[tuple[Any, ...], list[int]] = {}
    for row in np.flatnonzero(stout).tolist():
        alike.setdefault(tuple(columns[key][row] for key in keys), []).append(row)
    for shared, members in alike.items():
        values, rows = dict(zip(keys, shared, strict=True)), np.array(members)
        increments = values.get(INCREMENTS, task.case["drive"]["increments"])
        settings = task.settings_of(values)
        sure, found = _paths(task, settings, increments, {name: each[rows] for name, each in given.items()})
        told = points.NOT_ESTIMATED if "control_points" in settings.keywords() else ""
        yield rows[sure], {name: column[sure] for name, column in found.items()}, told


def _attributes(task: Task, columns: Mapping[str, list[Any]], count: int) -> Columns:
    """Return what the kernel and the ratios ask for as columns in SI, (count,) or (count, 2)."""
    slenderness = columns.get(plan.SLENDERNESS)
    shaping = (plan.SLENDERNESS, *plan.MOMENTS)
    design = task.design({key: columns[key][0] for key in shaping if key in columns})
    assert isinstance(design, Problem)
    sides = () if design.width is None else SIDES
    names = (*PIVOT_PARAMETERS, *sides, "rotation", "outer_fibre", "yield_strength")
    given = {name: np.array([getattr(design, name)] * count, dtype=float) for name in names}  # None: nan
    for name, column in columns.items():
        pair, _, part = name.rpartition(".")
        if name in _PARTS:
            given[_KEYS[pair].attribute][:, plan.PARTS[part]] = column
        elif name in _KEYS and _KEYS[name].attribute in given:
            key = _KEYS[name]
            given[key.attribute] = np.array([key.rule.parse(value) for value in column], dtype=float)
    if slenderness is not None:
        given["thickness"] = given["length"] / np.array(slenderness, dtype=float)
    if sides:
        given |= of_sides(given.pop("width"), given.pop("thickness"))
    rectangle = np.sqrt(12.0 * given["second_moment_of_area"] / given["area"])
    fibre, strength = given.pop("outer_fibre"), given["yield_strength"]
    given["depth"] = np.where(np.isnan(fibre), rectangle, 2.0 * fibre)
    given["known"] = np.where(np.isnan(fibre) & (not sides), np.nan, 1.0)  # whether there is a stress
    given["yield_strength"] = np.where(np.isnan(strength), np.inf, strength)
    return given


def _paths(
    task: Task, settings: Settings, increments: int, given: Columns
) -> tuple[NDArray[np.bool_], Columns]:
    """Return which designs are sure, and the quantities of all; none where the kernel does not take them.

    A path that stops, passes a critical point, or misses the accuracy is not sure.
    """
    from spline_model.batch import solve_many

    try:
        batch = solve_many(
            {name: given[name] for name in PIVOT_PARAMETERS},
            rotation=given["rotation"],
            increments=increments,
            section_depth=given["depth"],
            threads=1,
            **settings.keywords(),
        )
    except model_of(settings).InvalidParameter:
        return np.zeros(len(given["rotation"]), dtype=bool), {}
    turning = (batch.stiffness[:, 1:] * batch.stiffness[:, :-1] < 0.0).any(axis=1)
    strain = batch.strain * given["known"][:, None]
    stress = strain * given["youngs_modulus"][:, None]
    shift = centre_shift(_crossing(given), batch.rotation, batch.centre)
    shift_errs = shift_error(batch.errors["trajectory"], batch.centre, shift)
    error = np.fmax.reduce((*batch.errors.values(), shift_errs))
    strip = Strip(
        thickness=given["depth"],
        width=given["area"] / given["depth"],
        **{name: given[name] for name in (*SAME_NAME, "yield_strength")},
    )
    paths = Paths(
        along={
            "rotation": batch.rotation,
            "shift": shift,
            "defect": batch.moment_defect,
            "inertia": batch.inertia.astype(float),
            "strain": strain[..., None],
            **dict(zip(KNOWN, (batch.torque, batch.stiffness, batch.energy, stress), strict=True)),
        },
        strips=(strip,),
        effects=tuple(PLAIN),
        iterations=batch.iterations,
        control_points=batch.control_points.astype(float),
        error=error,
    )
    resolved = batch.accuracy is None or error <= batch.accuracy
    sure = batch.converged & ~batch.inertia.any(axis=1) & ~turning & resolved
    return sure, points.values(points.stored(task), paths)


def _crossing(given: Columns) -> Array:
    """Return where the strips cross at rest (D, 2) [m]."""
    reach = given["crossing_ratio"] * given["length"]
    angle = given["inclination"] + given["orientation"]
    return np.column_stack((reach * np.cos(angle), reach * np.sin(angle)))
