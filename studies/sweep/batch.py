"""Static paths of plain pivots by the compiled kernel of many at once; what it cannot do goes one by one."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from studies.answers.models import model_of
from studies.answers.response import centre_shift
from studies.answers.settings import SplineSettings
from studies.answers.validity import SAME_NAME, Strip
from studies.cases import keys as case_keys
from studies.cases.document import is_mechanism
from studies.cases.effects import DEFAULT, MOTION_ONLY
from studies.cases.mechanism import of_sides
from studies.cases.problem import PIVOT_PARAMETERS, SIDES, Problem
from studies.kinds import Array
from studies.sweep import plan, points
from studies.sweep.plan import Task
from studies.sweep.points import CONVERGED, Paths

#: I / (A L^2) below which a strip is for the multiplier path, a hundredth above the kernel's own limit.
LEAST_COMPLIANCE = 1.01e-9
PLAIN = {"bending", "stretching"}

Columns = dict[str, Array]
_KEYS = {f"{key.section}.{key.name}": key for key in case_keys.KEYS if key is not case_keys.NAMED}
_PARTS = {f"{name}.{part}" for name, key in _KEYS.items() if key.rule.kind == "pair" for part in plan.PARTS}


def solve_chunk(task: Task, start: int, columns: Mapping[str, list[Any]]) -> pa.Table:
    """Return the rows of the designs in `columns`, the first of which is point `start` of the sweep.

    A row has the status "converged"; "not_converged": the model stopped, with why and where as the reason;
    "refused": the model does not take the design; "failed": anything else went wrong. All but the first
    have no quantities.
    """
    count = len(next(iter(columns.values())))
    designs = [{key: column[i] for key, column in columns.items()} for i in range(count)]
    found: Mapping[str, Any]
    if task.batch:
        status, reason, found = _solve_batch(task, columns)
    else:
        status, reason, found = points.solve_each(task, designs)
    names = {name: found[name] for name in task.quantities}
    table = {
        points.POINT: np.arange(start, start + count),
        **columns,
        points.STATUS: status,
        points.REASON: reason,
        **names,
    }
    whole = points.stored(task)
    done = np.array([each == CONVERGED for each in status])
    arrays = [
        pa.array(values, type=pa.int64() if whole[name].whole else pa.float64(), mask=~done, from_pandas=True)
        if name in whole
        else pa.array(values)
        for name, values in table.items()
    ]
    return pa.Table.from_arrays(arrays, names=list(table))


def takes(task: Task) -> bool:
    """Whether the kernel may take the designs of a sweep: plain pivots on a static path, by splines.

    What it refuses in the end (other curves, or strips too slender) goes one by one.
    """
    own = {*_KEYS, *_PARTS, plan.SLENDERNESS}
    if task.model != "spline" or task.analysis.kind != "static" or is_mechanism(task.case):
        return False
    effects = set(task.case.get("scene", {}).get("effects", DEFAULT))
    return PLAIN <= effects <= PLAIN | set(MOTION_ONLY) and all(
        key in own or key.startswith(f"{plan.SETTINGS}.") for key in task.keys
    )


def _solve_batch(
    task: Task, columns: Mapping[str, list[Any]]
) -> tuple[list[str], list[str], dict[str, Array]]:
    """Return status, reason and quantities of the designs, as `points.solve_each` does.

    A design whose compiled path stops, or passes a critical point, is solved by itself: that says why, and
    which branch is right. Both sides of a plain pivot are mirror images (its strips are alike and only the
    couple acts, wherever the body's centre lies), so that one is enough.
    """
    design = plan.design_of(task, {})
    assert isinstance(design, Problem)
    count = len(next(iter(columns.values())))
    given = _attributes(task, design, columns, count)
    slender = given["second_moment_of_area"] < LEAST_COMPLIANCE * given["area"] * given["length"] ** 2
    found = {name: np.full(count, np.nan) for name in task.quantities}
    single = np.ones(count, dtype=bool)
    for settings, increments, rows in _groups(task, design, columns, np.flatnonzero(~slender)):
        sure, values = _paths(task, settings, increments, {name: v[rows] for name, v in given.items()})
        single[rows[sure]] = False
        for name, column in values.items():
            found[name][rows] = column
    status, reason = np.full(count, CONVERGED, dtype=object), np.full(count, "", dtype=object)
    alone = np.flatnonzero(single)
    if len(alone):
        designs = [{key: column[i] for key, column in columns.items()} for i in alone]
        status[alone], reason[alone], each = points.solve_each(task, designs)
        for name, numbers in each.items():
            found[name][alone] = numbers
    return list(status), list(reason), found


def _attributes(task: Task, design: Problem, columns: Mapping[str, list[Any]], count: int) -> Columns:
    """Return what the kernel and the ratios ask for as columns in SI, (count,) or (count, 2)."""
    sides = () if design.width is None else SIDES
    names = (*PIVOT_PARAMETERS, *sides, "rotation", "depth")
    given = {name: np.array([getattr(design, name)] * count, dtype=float) for name in names}
    given["yield_strength"] = np.full(count, design.yield_strength or np.inf)
    depth = np.full(count, np.nan if design.section_depth is None else design.section_depth)
    for name, column in columns.items():
        if name in _KEYS:
            key = _KEYS[name]
            values = np.array([key.rule.parse(value) for value in column], dtype=float)
            if key.attribute == "section_depth":
                depth = values
            elif key.attribute in given:
                given[key.attribute] = values
        elif name in _PARTS:
            pair, _, part = name.rpartition(".")
            given[_KEYS[pair].attribute][:, plan.PARTS[part]] = column
    if sides:
        width, thickness = (given.pop(name) for name in sides)
        if plan.SLENDERNESS in columns:
            thickness = given["length"] / np.array(columns[plan.SLENDERNESS], dtype=float)
        given |= of_sides(width, thickness)
    elif plan.SLENDERNESS in columns:
        section = design.area, design.second_moment_of_area
        slenderness = np.array(columns[plan.SLENDERNESS], dtype=float)
        given["area"], given["second_moment_of_area"] = plan.of_slenderness(
            slenderness, given["length"], *section
        )
    rectangle = np.sqrt(12.0 * given["second_moment_of_area"] / given["area"])
    given["depth"] = np.where(np.isnan(depth), rectangle, depth)
    return given


def _groups(
    task: Task, design: Problem, columns: Mapping[str, list[Any]], rows: NDArray[np.int64]
) -> Iterator[tuple[dict[str, Any], int, NDArray[np.int64]]]:
    """Yield the rows that share settings and increments, with these."""
    increments = columns.get("drive.increments", [design.increments] * (rows.max(initial=0) + 1))
    varied = [key for key in task.keys if key.startswith(f"{plan.SETTINGS}.")]
    alike: dict[tuple[Any, ...], list[int]] = {}
    for row in rows:
        alike.setdefault((increments[row], *(columns[key][row] for key in varied)), []).append(row)
    for (count, *settings), members in alike.items():
        own = plan.varied_settings(task, dict(zip(varied, settings, strict=True)))
        yield own, count, np.array(members)


def _paths(
    task: Task, settings: dict[str, Any], increments: int, given: Columns
) -> tuple[NDArray[np.bool_], Columns]:
    """Return which designs are sure, and the quantities of all; none where the kernel does not take them."""
    from spline_model.batch import solve_many

    turns, depth = given["rotation"], given["depth"]
    designs = {name: given[name] for name in PIVOT_PARAMETERS}
    chosen = SplineSettings(**settings)
    model = model_of(chosen)
    try:
        batch = solve_many(
            designs,
            rotation=turns,
            increments=increments,
            section_depth=depth,
            threads=1,
            **chosen.keywords(),
        )
    except model.errors.InvalidParameter:
        return np.zeros(len(turns), dtype=bool), {}
    unstable = np.count_nonzero(batch.inertia, axis=1)
    turning = (batch.stiffness[:, 1:] * batch.stiffness[:, :-1] < 0.0).any(axis=1)
    own = {name: getattr(batch, name) for name in ("rotation", "torque", "stiffness", "energy")}
    paths = Paths(
        rest=0,
        stress=batch.strain * given["youngs_modulus"][:, None],
        defect=batch.moment_defect,
        unstable=unstable,
        iterations=(1 + task.analysis.both_sides) * batch.iterations,
        shift=centre_shift(_crossing(given), batch.rotation, batch.centre),
        places={},
        strips=(_strip(given).bent(batch.strain.max(axis=1)),),
        effects=tuple(PLAIN),
        **own,
    )
    sure = batch.converged & (unstable == 0) & ~turning
    return sure, points.values(points.stored(task), paths)


def _crossing(given: Columns) -> Array:
    """Return where the strips cross at rest (D, 2) [m]."""
    reach = given["crossing_ratio"] * given["length"]
    angle = given["inclination"] + given["orientation"]
    return np.column_stack((reach * np.cos(angle), reach * np.sin(angle)))


def _strip(given: Columns) -> Strip:
    """Return the strips of all designs as one of arrays."""
    return Strip(
        thickness=given["depth"],
        width=given["area"] / given["depth"],
        **{name: given[name] for name in (*SAME_NAME, "yield_strength")},
    )
