"""What a sweep stores of each design, and designs solved one by one, a row each, whatever becomes of them.

Quantities have names with units, say what they mean, and how they follow from an answer. Answers come for D
designs side by side; arrays over the path have shape (D, S).
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from studies.answers import validity
from studies.answers.adapters import answer_modes, answer_release, answer_static
from studies.answers.motion import Motion, Spectrum
from studies.answers.named import named, quantities_of
from studies.answers.quantities import QUANTITIES, STANDING, Quantity
from studies.answers.response import Response
from studies.answers.settings import Settings
from studies.answers.validity import Strip, strips_of
from studies.cases.design import Design, design_of
from studies.cases.document import CaseError, is_mechanism
from studies.errors import BadInput
from studies.kinds import Array
from studies.sweep.plan import Task

#: How a design ended.
CONVERGED, NOT_CONVERGED = "converged", "not_converged"
REFUSED, FAILED = "refused", "failed"
#: Columns beside keys and quantities.
POINT, STATUS, REASON = "point", "status", "reason"
#: Reason of a static row whose error nothing estimates: of elements, and of a given number of control points.
NOT_ESTIMATED = "error not estimated"
#: Quantities of a path that the kernel of many paths knows, by their keys in an answer.
KNOWN = ("torque_Nm", "stiffness_Nm_per_rad", "strain_energy_J", "max_stress_Pa")


class _Column(NamedTuple):
    """A column of the table: what it means, and its value for each design from their answer, (D,).

    `usual`: stored where the file does not say what is. `whole`: of whole numbers.
    """

    meaning: str
    of: Callable[[Any], Any]
    usual: bool = True
    whole: bool = False


@dataclass(frozen=True, kw_only=True)
class Paths:
    """Static paths of D designs over S states, of which the first is at rest.

    along: by name (D, S, ...): the quantities of a path by their key, rotation [rad], shift (2) of the
    crossing point [m], defect of the moments [1], inertia, not 0 of what is not stable and nan where the
    model cannot tell, strain, the largest of each strip [1], bodies (B, 3) [m, m, rad];
    strips, whose values may be of all designs (D,); effects that were assembled; iterations (D,) of Newton;
    control_points (D,), nan of another model; error (D,) the largest estimated one [1], nan where it is not
    estimated.
    """

    along: Mapping[str, Array]
    strips: tuple[Strip, ...]
    effects: tuple[str, ...]
    iterations: NDArray[np.int64]
    control_points: Array
    error: Array

    @property
    def stiffness(self) -> Array:
        """(D, S) of the driven rotation [N m/rad]."""
        return self.along["stiffness_Nm_per_rad"]

    @property
    def shift(self) -> Array:
        """(D, S) distance of the crossing point from rest [m]."""
        return np.asarray(np.hypot(*np.moveaxis(self.along["shift"], -1, 0)))

    @property
    def bent(self) -> list[Strip]:
        """The strips with the most that happens to them."""
        most = np.moveaxis(self.along["strain"].max(axis=1), -1, 0)
        return [strip.bent(strain) for strip, strain in zip(self.strips, most, strict=True)]


def _end(name: str, *place: int) -> Callable[[Paths], Array]:
    """Return what takes an array of the paths, or an entry of it, at their end."""
    return lambda paths: np.asarray([each[(-1, *place)] for each in paths.along[name]])


def _most(ratio: str) -> Callable[[Paths], Array]:
    """Return what takes the largest of a ratio over the strips."""
    return lambda paths: np.max([np.asarray(getattr(s, ratio), dtype=float) for s in paths.bent], axis=0)


def _standing(each: Quantity) -> _Column:
    """Return the column of a quantity of a path: its value in the state that stands for it."""

    def standing(paths: Paths) -> Array:
        none = np.full_like(
            paths.stiffness, np.nan
        )  # of a part that an effect of this design alone would have
        return STANDING[each.standing](paths.along.get(each.key, none))

    return _Column(f"{each.meaning}, {each.standing}", standing)


def _unstable(paths: Paths) -> Any:
    lost = paths.along["inertia"]
    return np.where(np.isnan(lost).any(axis=1), -1, np.count_nonzero(lost, axis=1))


PATH = {
    "rotation_rad": _Column("rotation at the end", _end("rotation")),
    **{each.name_in_sweep: _standing(each) for each in QUANTITIES if each.standing},
    "stiffness_rest_Nm_per_rad": _Column("rotational stiffness at rest", lambda p: p.stiffness[:, 0]),
    "stiffness_end_Nm_per_rad": _Column("rotational stiffness at the end", _end("stiffness_Nm_per_rad")),
    "stiffness_variation": _Column(
        "largest less smallest stiffness of the path, over that at rest",
        lambda p: np.ptp(p.stiffness, axis=1) / np.abs(p.stiffness[:, 0]),
    ),
    "moment_defect": _Column(
        "largest relative imbalance of the strips' moments, of a spline",
        lambda p: p.along["defect"].max(axis=1),
    ),
    "iterations": _Column("Newton iterations", lambda p: p.iterations, whole=True),
    "control_points": _Column(
        "control points of a strip, of a spline", lambda p: p.control_points, whole=True
    ),
    "estimated_error": _Column(
        "largest estimated relative error of what `solve` answers; none where it is not estimated",
        lambda p: p.error,
    ),
    "unstable_states": _Column(
        "states of the path that are not stable, -1 where the model does not say", _unstable, False, True
    ),
    "torque_max_Nm": _Column(
        "largest magnitude of the driving torque", lambda p: np.abs(p.along["torque_Nm"]).max(axis=1), False
    ),
    "stress_end_Pa": _Column("largest stress of the strips at the end", _end("max_stress_Pa"), False),
    # what an answer is worth; the curvature is taken as high as the strain allows
    "width_ratio": _Column("b/L, largest of the strips", _most("width_ratio")),
    "curvature_ratio": _Column("b^2/(R t), largest of strips and states, at most", _most("curvature_ratio")),
    "thickness_ratio": _Column("t/L, largest of the strips", _most("thickness_ratio")),
    "strain_max": _Column("largest strain of strips and states", _most("strain")),
    "outside": _Column(
        "limits of the model that the answer lies beyond",
        lambda p: validity.passed(p.bent, p.effects),
        whole=True,
    ),
}
SHIFT = {
    "centre_shift_end_m": _Column(
        "displacement of the body's point at the strips' crossing, at the end", lambda p: p.shift[:, -1]
    ),
    "centre_shift_max_m": _Column("largest displacement of that point", lambda p: p.shift.max(axis=1)),
    "centre_shift_end_x_m": _Column("x of the displacement at the end", _end("shift", 0), False),
    "centre_shift_end_y_m": _Column("y of the displacement at the end", _end("shift", 1), False),
}


def _of_bodies(names: list[str]) -> dict[str, _Column]:
    """Return the places of bodies at the end of a path."""
    return {
        f"{body}_{part}": _Column(f"{part} of {body} at the end", _end("bodies", place, axis))
        for place, body in enumerate(names)
        for axis, part in enumerate(("x_m", "y_m", "rotation_rad"))
    }


def _frequency(mode: int) -> Callable[[Spectrum], float]:
    return lambda found: found.frequency[mode] if mode < len(found.frequency) else np.nan


def _of_modes(count: int) -> dict[str, _Column]:
    """Return the frequencies of the lowest modes; negative where the state is unstable."""
    return {
        f"frequency_{mode}_Hz": _Column(f"frequency of mode {mode}", _frequency(mode - 1))
        for mode in range(1, count + 1)
    }


RELEASE = {
    "frequency_Hz": _Column("frequency of the swing", lambda m: m.frequency),
    "rotation_min_rad": _Column("smallest rotation", lambda m: m.rotation.min()),
    "rotation_max_rad": _Column("largest rotation", lambda m: m.rotation.max()),
    "kinetic_max_J": _Column("largest kinetic energy", lambda m: m.kinetic_energy.max()),
    "energy_error": _Column("largest relative error of the energy", lambda m: m.energy_error),
    "records": _Column("records of the motion", lambda m: len(m.time), usual=False, whole=True),
}
"""Of a release: functions of a `Motion`."""

Answer = Paths | Spectrum | Motion


def known(case: Mapping[str, Any], kind: str, count: int) -> dict[str, _Column]:
    """Return all quantities of an analysis of the case's document, `count` of modes."""
    if kind == "modes":
        return _of_modes(count)
    if kind == "release":
        return RELEASE
    try:
        design = design_of("case", case)
    except CaseError:  # only what is varied completes it
        parts = {}
    else:
        parts = {each.name_in_sweep: _standing(each) for each in named(design)}
    mechanism = is_mechanism(case)
    places = _of_bodies([body["name"] for body in case.get("bodies", [])]) if mechanism else SHIFT
    return PATH | places | parts


def stored(task: Task) -> dict[str, _Column]:
    """Return the quantities that the task stores, by name, in their order."""
    found = known(task.case, task.kind, task.options.get("count", 0))
    return {name: found[name] for name in task.quantities}


def values(found: Mapping[str, _Column], answer: Answer) -> dict[str, Array]:
    """Return the quantities of an answer, (D,) each."""
    return {name: np.atleast_1d(np.asarray(each.of(answer))) for name, each in found.items()}


def static_answer(design: Design, settings: Settings) -> tuple[str, str, Paths | None]:
    """Return status, reason and static path of one design."""
    answer = answer_static(design, settings)
    if not answer.converged:
        return NOT_CONVERGED, answer.message, None
    path = paths_of(answer)
    remarks = (answer.message, answer.resolution, NOT_ESTIMATED if np.isnan(path.error[0]) else "")
    return CONVERGED, "; ".join(filter(None, remarks)), path


def paths_of(answer: Response) -> Paths:
    """Return the path of one design from its answer."""
    design, result, none = answer.design, answer.solution, np.full(len(answer.load_factor), np.nan)
    moduli = np.array([strip.youngs_modulus for strip in design.strips])
    along = {each.key: values for each, values in quantities_of(answer)} | {
        "rotation": answer.rotation if answer.body else none,
        "shift": np.stack((none, none), axis=1) if answer.crossing is None else answer.centre_shift,
        "defect": np.asarray(getattr(result, "moment_defect", none)),
        "inertia": np.asarray(getattr(result, "inertia", none)),
        "strain": answer.strip_stress / moduli,
        "bodies": np.stack([answer.bodies[each.name] for each in design.bodies] or [none[:, None]], axis=1),
    }
    return Paths(
        along={name: array[None] for name, array in along.items()},
        strips=tuple(strips_of(design)),
        effects=tuple(design.effects.names),
        iterations=np.array([result.counters["newton_iterations"]]),
        control_points=np.array([answer.settings.get("control_points", np.nan)], dtype=float),
        error=np.array([answer.largest_error]),
    )


def solve(task: Task, given: Mapping[str, Any]) -> tuple[str, str, dict[str, float]]:
    """Return status, reason and quantities (in SI units) of one design; without an answer, no quantities.

    The status is "converged"; "not_converged": the model stopped, and the reason states why and where;
    "refused": the model rejects the design; "failed": any other error.
    """
    try:
        status, reason, answer = _answered(task, task.design(given), task.settings_of(given))
        found = {} if answer is None else values(stored(task), answer)
        return status, reason, {name: float(value[0]) for name, value in found.items()}
    except BadInput as error:
        return REFUSED, str(error), {}
    except Exception as error:  # a fault at one design must not cost the others: it is told in its row
        return FAILED, f"{type(error).__name__}: {error}".splitlines()[0], {}


def _answered(task: Task, design: Design, settings: Settings) -> tuple[str, str, Answer | None]:
    if task.kind == "static":
        return static_answer(design, settings)
    ask = answer_modes if task.kind == "modes" else answer_release
    answer: Spectrum | Motion = ask(design, settings, **task.options)
    status = CONVERGED if answer.converged else NOT_CONVERGED
    remarks = (answer.message, getattr(answer, "resolution", ""))
    return status, "; ".join(filter(None, remarks)), answer
