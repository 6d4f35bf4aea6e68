"""What a sweep stores of each design, and designs solved one by one, a row each, whatever becomes of them.

Quantities have names with units, say what they mean, and how they follow from an answer. Answers come for D
designs side by side; arrays over the path have shape (D, S).
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from studies.answers import validity
from studies.answers.adapters import answer_modes, answer_release
from studies.answers.models import put
from studies.answers.motion import Motion, Spectrum
from studies.answers.quantities import QUANTITIES, STANDING, Quantity, quantities_of
from studies.answers.response import Response
from studies.answers.settings import Settings
from studies.answers.validity import Strip, strips_of
from studies.cases.design import Design
from studies.cases.document import is_mechanism
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


class _Quantity(NamedTuple):
    """A column of the table: what it means, and its value for each design from their answer, (D,).

    `usual`: stored where the file does not say what is. `whole`: of whole numbers.
    """

    meaning: str
    of: Callable[[Any], Any]
    usual: bool = True
    whole: bool = False


@dataclass(frozen=True, kw_only=True)
class Paths:
    """Static paths of D designs over S states in the order of the rotation; `rest` is the unloaded one.

    values (D, S) of the quantities of a path by their key; shift (D, S, 2) of the crossing point [m]; defect
    of the moments [1]; unstable (D,) states, -1 where the model
    cannot tell; iterations (D,) of Newton; places (D, S, 3) of the bodies by name [m, m, rad];
    strips with the most that happens to them, arrays (D,); effects that were assembled; control_points (D,),
    nan of another model; error (D,) the largest estimated one [1], nan where it is not estimated.
    """

    rest: int
    rotation: Array
    values: Mapping[str, Array]
    defect: Array
    unstable: NDArray[np.int64]
    iterations: NDArray[np.int64]
    shift: Array
    places: Mapping[str, Array]
    strips: tuple[Strip, ...]
    effects: tuple[str, ...]
    control_points: Array
    error: Array

    @property
    def stiffness(self) -> Array:
        """(D, S) of the driven rotation [N m/rad]."""
        return self.values["stiffness_Nm_per_rad"]


def _shift(paths: Paths) -> Array:
    return np.hypot(paths.shift[..., 0], paths.shift[..., 1])


def _most(ratio: str) -> Callable[[Paths], Array]:
    """Return what takes the largest of a ratio over the strips."""
    return lambda paths: np.max([np.asarray(getattr(s, ratio), dtype=float) for s in paths.strips], axis=0)


def _standing(each: Quantity) -> _Quantity:
    """Return the column of a quantity of a path: its value in the state that stands for it."""
    return _Quantity(
        f"{each.meaning}, {each.standing}", lambda p: STANDING[each.standing](p.values[each.key])
    )


PATH = {
    "rotation_rad": _Quantity("rotation at the end", lambda p: p.rotation[:, -1]),
    **{each.name_in_sweep: _standing(each) for each in QUANTITIES if each.standing},
    "stiffness_rest_Nm_per_rad": _Quantity("rotational stiffness at rest", lambda p: p.stiffness[:, p.rest]),
    "stiffness_end_Nm_per_rad": _Quantity("rotational stiffness at the end", lambda p: p.stiffness[:, -1]),
    "stiffness_variation": _Quantity(
        "largest less smallest stiffness of the path, over that at rest",
        lambda p: np.ptp(p.stiffness, axis=1) / np.abs(p.stiffness[:, p.rest]),
    ),
    "moment_defect": _Quantity(
        "largest relative imbalance of the strips' moments, of a spline", lambda p: p.defect.max(axis=1)
    ),
    "iterations": _Quantity("Newton iterations", lambda p: p.iterations, whole=True),
    "control_points": _Quantity(
        "control points of a strip, of a spline", lambda p: p.control_points, whole=True
    ),
    "estimated_error": _Quantity(
        "largest estimated relative error of what `solve` answers; none where it is not estimated",
        lambda p: p.error,
    ),
    "unstable_states": _Quantity(
        "states of the path that are not stable, -1 where the model does not say",
        lambda p: p.unstable,
        usual=False,
        whole=True,
    ),
    "torque_max_Nm": _Quantity(
        "largest magnitude of the driving torque",
        lambda p: np.abs(p.values["torque_Nm"]).max(axis=1),
        usual=False,
    ),
    "stress_end_Pa": _Quantity(
        "largest stress of the strips at the end", lambda p: p.values["max_stress_Pa"][:, -1], usual=False
    ),
    # what an answer is worth; the curvature is taken as high as the strain allows
    "width_ratio": _Quantity("b/L, largest of the strips", _most("width_ratio")),
    "curvature_ratio": _Quantity(
        "b^2/(R t), largest of strips and states, at most", _most("curvature_ratio")
    ),
    "thickness_ratio": _Quantity("t/L, largest of the strips", _most("thickness_ratio")),
    "strain_max": _Quantity("largest strain of strips and states", _most("strain")),
    "outside": _Quantity(
        "limits of the model that the answer lies beyond",
        lambda p: validity.passed(p.strips, p.effects),
        whole=True,
    ),
}
SHIFT = {
    "centre_shift_end_m": _Quantity(
        "displacement of the body's point at the strips' crossing, at the end", lambda p: _shift(p)[:, -1]
    ),
    "centre_shift_max_m": _Quantity("largest displacement of that point", lambda p: _shift(p).max(axis=1)),
    "centre_shift_end_x_m": _Quantity(
        "x of the displacement at the end", lambda p: p.shift[:, -1, 0], usual=False
    ),
    "centre_shift_end_y_m": _Quantity(
        "y of the displacement at the end", lambda p: p.shift[:, -1, 1], usual=False
    ),
}


def _place(body: str, axis: int) -> Callable[[Paths], Array]:
    return lambda paths: paths.places[body][:, -1, axis]


def _of_bodies(names: list[str]) -> dict[str, _Quantity]:
    """Return the places of bodies at the end of a path."""
    return {
        f"{body}_{part}": _Quantity(f"{part} of {body} at the end", _place(body, axis))
        for body in names
        for axis, part in enumerate(("x_m", "y_m", "rotation_rad"))
    }


def _frequency(mode: int) -> Callable[[Spectrum], float]:
    return lambda found: found.frequency[mode] if mode < len(found.frequency) else np.nan


def _of_modes(count: int) -> dict[str, _Quantity]:
    """Return the frequencies of the lowest modes; negative where the state is unstable."""
    return {
        f"frequency_{mode}_Hz": _Quantity(f"frequency of mode {mode}", _frequency(mode - 1))
        for mode in range(1, count + 1)
    }


RELEASE = {
    "frequency_Hz": _Quantity("frequency of the swing", lambda m: m.frequency),
    "rotation_min_rad": _Quantity("smallest rotation", lambda m: m.rotation.min()),
    "rotation_max_rad": _Quantity("largest rotation", lambda m: m.rotation.max()),
    "kinetic_max_J": _Quantity("largest kinetic energy", lambda m: m.kinetic_energy.max()),
    "energy_error": _Quantity("largest relative error of the energy", lambda m: m.energy_error),
    "records": _Quantity("records of the motion", lambda m: len(m.time), usual=False, whole=True),
}
"""Of a release: functions of a `Motion`."""

Answer = Paths | Spectrum | Motion


def known(case: Mapping[str, Any], kind: str, count: int) -> dict[str, _Quantity]:
    """Return all quantities of an analysis of the case's document, `count` of modes."""
    if kind == "modes":
        return _of_modes(count)
    if kind == "release":
        return RELEASE
    mechanism = is_mechanism(case)
    return PATH | (_of_bodies([body["name"] for body in case.get("bodies", [])]) if mechanism else SHIFT)


def stored(task: Task) -> dict[str, _Quantity]:
    """Return the quantities that the task stores, by name, in their order."""
    found = known(task.case, task.kind, task.options.get("count", 0))
    return {name: found[name] for name in task.quantities}


def values(found: Mapping[str, _Quantity], answer: Answer) -> dict[str, Array]:
    """Return the quantities of an answer, (D,) each."""
    return {name: np.atleast_1d(np.asarray(each.of(answer))) for name, each in found.items()}


def static_answer(design: Design, settings: Settings, *, both_sides: bool) -> tuple[str, str, Paths | None]:
    """Return status, reason and static path of one design, to its rotation and, if asked, its opposite."""
    sides = [design]
    if both_sides:
        sides.append(replace(design, rotation=-(design.rotation or 0.0)))
    found: list[Any] = []
    asked = [put(side, settings) for side in sides]
    for side in asked:
        result = side.static_path(raise_on_failure=False)
        if result.status.value != CONVERGED:
            words = "" if not both_sides else "to the other side: " if found else "to the one side: "
            return NOT_CONVERGED, words + result.message, None
        found.append(result)
    answers = [Response.of(side, result) for side, result in zip(asked, found, strict=True)]
    remarks = (each for answer in answers for each in (answer.message, answer.resolution) if each)
    paths = list(map(_paths_of, answers))
    path = paths[0] if len(paths) == 1 else _joined(*paths)
    unknown = (NOT_ESTIMATED,) * bool(np.isnan(path.error[0]))
    return CONVERGED, "; ".join(dict.fromkeys((*remarks, *unknown))), path


def _paths_of(answer: Response) -> Paths:
    """Return the path of one design from its answer."""
    design, result = answer.design, answer.solution
    inertia, states = getattr(result, "inertia", None), len(answer.load_factor)
    places = {name: place[None] for name, place in answer.bodies.items()}
    moduli = np.array([strip.youngs_modulus for strip in design.strips])
    strains = (answer.strip_stress / moduli).max(axis=0)
    strips = zip(strips_of(design), strains[:, None], strict=True)
    nowhere = np.full((states, 2), np.nan)
    return Paths(
        rest=0,
        rotation=places[design.body][..., 2] if design.body else nowhere[None, :, 0],
        values={each.key: values[None] for each, values in quantities_of(answer)},
        defect=np.asarray(getattr(result, "moment_defect", nowhere[:, 0]))[None],
        unstable=np.array([-1 if inertia is None else np.count_nonzero(inertia)]),
        iterations=np.array([result.counters["newton_iterations"]]),
        shift=(nowhere if answer.crossing is None else answer.centre_shift)[None],
        places=places,
        strips=tuple(strip.bent(strain) for strip, strain in strips),
        effects=tuple(design.effects.names),
        control_points=np.array([answer.settings.get("control_points", np.nan)], dtype=float),
        error=np.array([answer.largest_error]),
    )


def _joined(one: Paths, other: Paths) -> Paths:
    """Return the paths to both sides as one, from the end of `other` through rest to that of `one`."""

    def through(back: Array, forth: Array) -> Array:
        return np.concatenate((back[:, :0:-1], forth), axis=1)

    arrays = ("rotation", "defect", "shift")
    both: dict[str, Any] = {name: through(getattr(other, name), getattr(one, name)) for name in arrays}
    both["values"] = {name: through(other.values[name], array) for name, array in one.values.items()}
    strips = zip(one.strips, other.strips, strict=True)
    return replace(
        one,
        rest=one.rotation.shape[1] - 1,
        unstable=np.where(one.unstable < 0, -1, one.unstable + other.unstable),
        iterations=one.iterations + other.iterations,
        strips=tuple(strip.bent(np.maximum(strip.strain, twin.strain)) for strip, twin in strips),
        control_points=np.fmax(one.control_points, other.control_points),
        error=np.fmax(one.error, other.error),
        **both,
    )


def solve(task: Task, given: Mapping[str, Any]) -> tuple[str, str, dict[str, float]]:
    """Return status, reason and quantities of one design, without these where it has no answer.

    The status is "converged"; "not_converged": the model stopped, with why and where as the reason;
    "refused": the model does not take the design; "failed": anything else went wrong.
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
        return static_answer(design, settings, **task.options)
    ask = answer_modes if task.kind == "modes" else answer_release
    answer: Spectrum | Motion = ask(design, settings, **task.options)
    status = CONVERGED if answer.converged else NOT_CONVERGED
    remarks = (answer.message, getattr(answer, "resolution", ""))
    return status, "; ".join(filter(None, remarks)), answer
