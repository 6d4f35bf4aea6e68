"""The task that every chunk of a sweep has, what it stores of each design, and designs solved one by one, a
row each, whatever becomes of them.

Quantities have names with units, say what they mean, and how they follow from the answer of `solve`, `modes`
or `release`.
"""

import copy
import json
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from operator import attrgetter
from typing import Any, NamedTuple

import numpy as np
import pyarrow as pa

from studies.answers.adapters import answer_modes, answer_release, answer_static
from studies.answers.motion import Spectrum
from studies.answers.named import named
from studies.answers.quantities import QUANTITIES, STANDING, Quantity
from studies.answers.response import Response
from studies.answers.settings import Settings, settings_of_model
from studies.answers.validity import validity
from studies.cases.design import Design, design_of
from studies.cases.document import CaseError, is_mechanism
from studies.errors import BadInput
from studies.kinds import Array
from studies.sweep import varied

#: How a design ended.
CONVERGED, NOT_CONVERGED = "converged", "not_converged"
REFUSED, FAILED = "refused", "failed"
#: Columns beside keys and quantities.
POINT, STATUS, REASON = "point", "status", "reason"
#: Reason of a static row whose error nothing estimates: of elements, and of a given number of control points.
NOT_ESTIMATED = "error not estimated"
#: Analyses.
KINDS = ("static", "modes", "release")


@dataclass(frozen=True, kw_only=True)
class Task:
    """What every chunk of a sweep needs to know.

    Attributes:
        where: file that refusals name. case: document of the case with what is fixed by the sweep.
        model: as on the command line. settings: keywords of its settings.
        kind: of the analysis, one of `KINDS`.
        options: of modes (`rotation` [rad], `held`, `count`) or of a release (`duration` [s], ...).
        quantities: names of what is stored.
    """

    where: str
    case: dict[str, Any]
    model: str
    settings: dict[str, Any]
    kind: str
    options: dict[str, Any]
    quantities: tuple[str, ...]

    def design(self, values: Mapping[str, Any]) -> Design:
        """Return one design of the sweep; CaseError where a value is out of its range."""
        document = copy.deepcopy(self.case)
        varied.put(document, values)
        return design_of(self.where, document)

    def settings_of(self, values: Mapping[str, Any]) -> Settings:
        """Return the settings of one design: those of the sweep, and those that it varies."""
        prefix = varied.SETTINGS
        own = {key.removeprefix(prefix): value for key, value in values.items() if key.startswith(prefix)}
        return settings_of_model(self.model, **(self.settings | own))


class _Column(NamedTuple):
    """A column of the table: what it means, and its value by the answer of a design.

    `usual`: stored where the file does not say what is. `whole`: of whole numbers.
    """

    meaning: str
    of: Callable[[Any], Any]
    usual: bool = True
    whole: bool = False


def _standing(each: Quantity) -> _Column:
    """Return the column of a quantity of a path: its value in the state that stands for it."""
    everywhere = each in QUANTITIES

    def standing(answer: Response) -> Any:
        # an effect that varies may leave a design without the part
        if everywhere or each.key in {own.key for own in named(answer.design)}:
            return STANDING[each.standing](np.asarray(each.of(answer)))
        return math.nan

    return _Column(f"{each.meaning}, {each.standing}", standing)


def _unstable(answer: Response) -> int:
    lost = getattr(answer.solution, "inertia", None)
    return -1 if lost is None else int(np.count_nonzero(lost))


def _moved(answer: Response) -> Array:
    """Return the distance (S,) of the crossing point from rest [m]."""
    return np.asarray(np.hypot(*answer.centre_shift.T))


PATH = {
    "rotation_rad": _Column("rotation at the end", lambda a: a.rotation[-1] if a.body else math.nan),
    **{each.name_in_sweep: _standing(each) for each in QUANTITIES if each.standing},
    "stiffness_rest_Nm_per_rad": _Column("rotational stiffness at rest", lambda a: a.stiffness[0]),
    "stiffness_end_Nm_per_rad": _Column("rotational stiffness at the end", lambda a: a.stiffness[-1]),
    "stiffness_variation": _Column(
        "largest less smallest stiffness of the path, over that at rest",
        lambda a: np.ptp(a.stiffness) / abs(a.stiffness[0]),
    ),
    "moment_defect": _Column(
        "largest relative imbalance of the strips' moments, of a spline",
        lambda a: np.max(getattr(a.solution, "moment_defect", math.nan)),
    ),
    "iterations": _Column("Newton iterations", lambda a: a.counters["newton_iterations"], whole=True),
    "control_points": _Column(
        "control points of a strip, of a spline",
        lambda a: a.settings.get("control_points", math.nan),
        whole=True,
    ),
    "estimated_error": _Column(
        "largest estimated relative error of what `solve` answers; none where it is not estimated",
        lambda a: a.largest_error,
    ),
    "unstable_states": _Column(
        "states of the path that are not stable, -1 where the model does not say", _unstable, False, True
    ),
    "torque_max_Nm": _Column(
        "largest magnitude of the driving torque", lambda a: np.abs(a.torque).max(), False
    ),
    "stress_end_Pa": _Column("largest stress of the strips at the end", lambda a: a.max_stress[-1], False),
}
WORTH = {
    "width_ratio": _Column("b/L, largest of the strips", attrgetter("width_ratio")),
    "curvature_ratio": _Column("b^2/(R t), largest of strips and states", attrgetter("curvature_ratio")),
    "thickness_ratio": _Column("t/L, largest of the strips", attrgetter("thickness_ratio")),
    "strain_max": _Column("largest strain of strips and states", attrgetter("strain")),
    "outside": _Column(
        "limits of the model that the answer lies beyond", lambda worth: len(worth.outside), whole=True
    ),
}
"""By the validity of an answer."""
SHIFT = {
    "centre_shift_end_m": _Column(
        "displacement of the body's point at the strips' crossing, at the end", lambda a: _moved(a)[-1]
    ),
    "centre_shift_max_m": _Column("largest displacement of that point", lambda a: _moved(a).max()),
    "centre_shift_end_x_m": _Column(
        "x of the displacement at the end", lambda a: a.centre_shift[-1, 0], False
    ),
    "centre_shift_end_y_m": _Column(
        "y of the displacement at the end", lambda a: a.centre_shift[-1, 1], False
    ),
}


def _place(body: str, axis: int, answer: Response) -> Any:
    """Return x, y [m] or the rotation [rad] of a body at the end of a path."""
    return answer.bodies[body][-1, axis]


def _frequency(mode: int, found: Spectrum) -> float:
    """Return the frequency of a mode [Hz]; NaN of more modes than there are."""
    return found.frequency[mode] if mode < len(found.frequency) else math.nan


RELEASE = {
    "frequency_Hz": _Column("frequency of the swing", lambda m: m.frequency),
    "rotation_min_rad": _Column("smallest rotation", lambda m: m.rotation.min()),
    "rotation_max_rad": _Column("largest rotation", lambda m: m.rotation.max()),
    "kinetic_max_J": _Column("largest kinetic energy", lambda m: m.kinetic_energy.max()),
    "energy_error": _Column("largest relative error of the energy", lambda m: m.energy_error),
    "records": _Column("records of the motion", lambda m: len(m.time), usual=False, whole=True),
}
"""Of a release: functions of a `Motion`."""


def known(case: Mapping[str, Any], kind: str, count: int) -> dict[str, _Column]:
    """Return all quantities of an analysis of the case's document, `count` of modes."""
    if kind == "modes":
        return {
            f"frequency_{mode + 1}_Hz": _Column(f"frequency of mode {mode + 1}", partial(_frequency, mode))
            for mode in range(count)
        }
    if kind == "release":
        return RELEASE
    places = SHIFT
    if is_mechanism(case):
        places = {
            f"{body['name']}_{part}": _Column(
                f"{part} of {body['name']} at the end", partial(_place, body["name"], axis)
            )
            for body in case.get("bodies", [])
            for axis, part in enumerate(("x_m", "y_m", "rotation_rad"))
        }
    try:
        parts = named(design_of("case", case))
    except CaseError:  # only what is varied completes it
        parts = ()
    return PATH | WORTH | places | {each.name_in_sweep: _standing(each) for each in parts}


def stored(task: Task) -> dict[str, _Column]:
    """Return the quantities that the task stores, by name, in their order."""
    found = known(task.case, task.kind, task.options.get("count", 0))
    return {name: found[name] for name in task.quantities}


def values(found: Mapping[str, _Column], answer: Any) -> dict[str, float]:
    """Return the quantities of an answer in SI units."""
    worth = validity(answer) if found.keys() & WORTH.keys() else None
    return {name: float(each.of(worth if name in WORTH else answer)) for name, each in found.items()}


def solve_chunk(task: Task, start: int, columns: Mapping[str, list[Any]]) -> pa.Table:
    """Return the rows of the designs in `columns`, the first of which is point `start` of the sweep.

    A row of any status but "converged", as of `solve`, has no quantities.
    """
    count = len(next(iter(columns.values())))
    designs = [{key: column[row] for key, column in columns.items()} for row in range(count)]
    status, reason, found = zip(*(solve(task, design) for design in designs), strict=True)
    table: dict[str, Any] = {POINT: range(start, start + count)}
    for key, column in columns.items():
        table[key] = [json.dumps(value) if isinstance(value, list) else value for value in column]
    table |= {STATUS: status, REASON: reason}
    for name, quantity in stored(task).items():
        kept = np.array([row.get(name, math.nan) for row in found])
        kind = pa.int64() if quantity.whole else pa.float64()
        table[name] = pa.array(kept, type=kind, mask=np.isnan(kept))
    return pa.table(table)


def solve(task: Task, given: Mapping[str, Any]) -> tuple[str, str, dict[str, float]]:
    """Return status, reason and quantities (in SI units) of one design; without an answer, no quantities.

    The status is "converged"; "not_converged": the model stopped, and the reason states why and where;
    "refused": the model rejects the design; "failed": any other error.
    """
    analyses: tuple[Callable[..., Any], ...] = (answer_static, answer_modes, answer_release)
    ask = dict(zip(KINDS, analyses, strict=True))[task.kind]
    try:
        answer = ask(task.design(given), task.settings_of(given), **task.options)
        if not answer.converged:
            return NOT_CONVERGED, answer.message, {}
        remarks = [answer.message, answer.resolution]
        if task.kind == "static" and math.isnan(answer.largest_error):
            remarks.append(NOT_ESTIMATED)
        return CONVERGED, "; ".join(filter(None, remarks)), values(stored(task), answer)
    except BadInput as error:
        return REFUSED, str(error), {}
    except Exception as error:  # a fault at one design must not cost the others: it is told in its row
        return FAILED, f"{type(error).__name__}: {error}".splitlines()[0], {}
