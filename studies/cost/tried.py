"""The one list of settings that are compared, each held against the limit of its theory of the rod.

Implicit schemes of all models take the same steps; explicit ones take their own, near the largest stable one.
Surrogates are of statics alone. In motion strips have no shear and no rotary inertia of their sections, but
for Exudyn's exact beams, which have both: two theories are 3e-2 rad apart after 0.05 s, so that each is held
against the limit of its own. Of Exudyn's motions a relative tolerance of 1e-5 was tried as well: it is the
cheapest setting at no error.

A time is that of a whole call, once all is compiled and loaded: from the design in memory to the answer in
common terms, set-up included, and of a swing the static path to its start. What the model says of its
increments or steps alone stands beside it. An advice is the cheapest setting of every model on one design.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import product
from operator import attrgetter
from typing import Any

import numpy as np
import pandas as pd

from studies.answers import reference
from studies.answers.reference import Reference
from studies.cases.design import Design
from studies.cost.exudyn import exudyn_ancf, exudyn_exact
from studies.cost.model import Model, elements, spline
from studies.cost.openseespy import openseespy_frame
from studies.cost.surrogates import SURROGATES
from studies.engine import Row
from studies.errors import BadInput, Unanswered
from studies.kinds import Array, Progress
from studies.record.progress import measure, silent, watched

#: What models are compared under, the spline first.
SPLINE, ITSELF, ELEMENTS, SHEARED = "spline", "spline, by itself", "finite elements", "elements with shear"
EXUDYN, OPENSEES, SURROGATE = "Exudyn", "OpenSees", "surrogates"

#: Theories of a strip, both with bending per reference length: without and with shear.
THEORIES = MATERIAL, SHEAR = "material", "shear"


#: How settings are told; others by their name.
WORDS: dict[str, Callable[[Any], str]] = {
    "control_points": "n = {}".format,
    "elements": "{} elements".format,
    "accuracy": "accuracy {:g}".format,
    "integrator": str,
    "element": str,
    "step": lambda step: f"{1e6 * step:.3g} µs",
    "tolerance": "tolerance {:g}".format,
    "relative_tolerance": "relative tolerance {:g}".format,
    "spectral_radius": "spectral radius {:g}".format,
}
#: What makes a setting finer: more of it, or less.
FINER = {"step": -1.0, "accuracy": -1.0, "control_points": 1.0, "elements": 1.0}


@dataclass(frozen=True, eq=False, kw_only=True)
class Setting:
    """One setting of one model.

    Attributes:
        model: that is asked. group: what it is compared under. settings: keywords of the model.
    """

    model: Model
    group: str
    settings: Mapping[str, Any]

    @property
    def theory(self) -> str:
        """What the strips' energies are measured in, which decides on the limit: of `THEORIES`."""
        return SHEAR if self.model.sheared or self.settings.get("element") == "reissner" else MATERIAL

    @property
    def kind(self) -> tuple[str, ...]:
        """What settings have in common that differ in numbers alone: the code that they load."""
        words = (value for value in self.settings.values() if isinstance(value, str))
        return (self.model.name, *self.settings, *words)

    @property
    def finer(self) -> str:
        """Name of what makes it finer: the step, if it has one; empty if nothing does."""
        return next((name for name in FINER if name in self.settings), "")

    @property
    def columns(self) -> dict[str, Any]:
        """What it is in tables.

        A `family` are settings that differ in their `fineness` alone; of paths, in control points or elements
        and accuracy.
        """
        told = {name: WORDS[name](value) for name, value in self.settings.items()}
        finer = {self.finer} if self.finer == "step" else {*FINER}
        same = [words for name, words in told.items() if name not in finer]
        return {
            "model": self.model.name,
            "group": self.group,
            "setting": ", ".join(told.values()) or "closed form",
            "theory": self.theory,
            "family": ", ".join((self.model.name, *same)),
            "fineness": FINER[self.finer] * float(self.settings[self.finer]) if self.finer else 1.0,
        }


def grid(model: Model, group: str, **axes: Sequence[Any]) -> list[Setting]:
    """Return the settings of a model on a grid, the last axis changing fastest."""
    return [
        Setting(model=model, group=group, settings=dict(zip(axes, values, strict=True)))
        for values in product(*axes.values())
    ]


#: Elements a strip of the suite's own elements on a path.
MESHES = (4, 5, 10, 20, 40, 80, 160, 320)


def paths() -> list[Setting]:
    """Return the settings of the static path."""
    tolerances = (1e-5, 1e-6, 1e-8)
    exact = (1, 2, 3, 4, 6, 8, 12, 16, 20, 24)
    return [
        *grid(spline, SPLINE, control_points=range(4, 13)),
        *grid(spline, ITSELF, accuracy=(1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6)),
        *grid(elements, ELEMENTS, elements=MESHES),
        *grid(elements, SHEARED, elements=MESHES, element=("reissner",)),
        *(each for model in SURROGATES.values() for each in grid(model, SURROGATE)),
        *grid(exudyn_ancf, EXUDYN, elements=(2, 4, 6, 8, 12, 16, 24, 40), relative_tolerance=tolerances),
        *grid(exudyn_exact, EXUDYN, elements=exact, relative_tolerance=tolerances),
        *grid(openseespy_frame, OPENSEES, elements=(5, 10, 20, 40, 80, 160), tolerance=(1e-8, 1e-10)),
    ]


#: Steps of all implicit schemes [s].
STEPS = (5e-4, 2e-4, 1e-4, 5e-5, 2e-5, 1e-5)


def swings() -> list[Setting]:
    """Return the settings of the motion after the release of the paper's pivot."""
    exudyn: dict[str, Any] = {"step": STEPS, "spectral_radius": (0.9, 0.6), "relative_tolerance": (1e-3,)}
    explicit, implicit = ("central-difference",), ("generalised-alpha",)
    return [
        *grid(spline, SPLINE, control_points=range(4, 11), integrator=("leapfrog",)),
        *grid(spline, SPLINE, control_points=(4, 5, 6, 7, 8), integrator=("energy",), step=STEPS),
        *grid(elements, ELEMENTS, elements=(10, 16, 24, 36), integrator=explicit),
        *grid(elements, ELEMENTS, elements=(10, 16, 24), integrator=implicit, step=STEPS),
        *grid(exudyn_ancf, EXUDYN, elements=(3, 4, 6, 8, 12), **exudyn),
        *grid(exudyn_exact, EXUDYN, elements=(2, 3, 4, 6), **exudyn),
        *grid(openseespy_frame, OPENSEES, elements=(10, 20, 40), step=STEPS),
    ]


def path_limit(design: Design, theory: str) -> Reference:
    """Return the limit of a theory on the path of a design: that of elements, which share no code with the
    splines.

    Raises:
        NoReference: the elements do not reach the end of the path.
    """
    return reference.reference(design, "corotational" if theory == MATERIAL else "reissner")


#: Passes through the settings that are timed again, far apart in time: what else the machine does lasts
#: longer than one setting.
PASSES = 3
#: Time that the runs of a setting may take in a pass [s], and their largest number; what takes longer than
#: that time at once is timed by its first run alone.
AFFORDED, RUNS = 0.2, 3
#: What takes longer than this [s] is timed again only where its first run is within a factor of the fastest
#: of its group that keeps as small an error: it may still be the cheapest.
QUICK, RIVAL = 0.03, 2.0

#: Errors of a path, and those that it is judged by first; those of a motion.
PATH_ERRORS, PATH_JUDGED = ("trajectory", "torque", "stiffness", "stress"), ("trajectory", "torque")
SWING_JUDGED = ("rotation_rad",)


def compared(
    settings: Sequence[Setting],
    design: Design,
    limits: Mapping[str, Any],
    instants: Array | None = None,
    *,
    passes: int = PASSES,
    progress: Progress = silent,
) -> pd.DataFrame:
    """Return errors [1, rad] and times [s] of the path of a design, or of its motion up to `instants`
    (T,) [s].

    One row per setting: the medians of its times, of whole calls and of what they are without set-up, and how
    many `runs` they are of. One that fails has no errors.
    """

    on_path = instants is None
    timed = partial(_timed, design, None if instants is None else float(instants[-1]))
    errors = reference.largest_errors if on_path else reference.swing_errors
    rows: list[Row] = []
    times: list[list[tuple[float, float]]] = []
    loaded: set[tuple[str, ...]] = set()
    for each in watched(settings, progress):
        row = each.columns
        times.append([])
        try:
            first = timed(each, repeat=1, warm_up=int(each.kind not in loaded))
            found = errors(first.result, limits[each.theory])
            rows.append(row | {"status": "converged", "message": ""} | found)
            times[-1] += zip(first.seconds, first.parts, strict=True)
        except (Unanswered, BadInput) as stopped:
            rows.append(row | {"status": "failed", "message": str(stopped)})
        loaded.add(each.kind)
    table = pd.DataFrame(rows)
    judged = PATH_JUDGED if on_path else SWING_JUDGED
    firsts = [own[0][0] if own else math.nan for own in times]
    again = _rivals(table.assign(whole_s=firsts), judged)
    for place in again:  # whose first run has prepared what it depends on
        times[place].clear()
    for _, place in product(range(passes), again):
        more = timed(settings[place], repeat=int(min(RUNS, max(1.0, AFFORDED / firsts[place]))), warm_up=0)
        times[place] += zip(more.seconds, more.parts, strict=True)
    whole, alone = np.transpose([np.median(own or [(math.nan, math.nan)], axis=0) for own in times])
    return table.assign(whole_s=whole, solve_s=alone, runs=list(map(len, times)))


def _timed(design: Design, duration: float | None, each: Setting, **runs: int) -> Any:
    """Return the answer of a setting to the path of a design, or to its motion of a duration [s], with its
    times."""

    def solve() -> Any:
        if duration is None:
            return each.model.path(design, **each.settings)
        return each.model.swing(design, duration, **each.settings)

    return measure(solve, part=attrgetter("solve_s"), **runs)


def _rivals(rows: pd.DataFrame, judged: Sequence[str]) -> list[int]:
    """Return the places of the rows that may be the cheapest of their group at some error."""
    ordered = rows.assign(held=kept(rows, judged)).sort_values(["held", "whole_s"])
    enough = (RIVAL * ordered.groupby("group")["whole_s"].cummin()).clip(QUICK, AFFORDED)
    return [int(place) for place in ordered.index[ordered["whole_s"] <= enough]]


def kept(rows: pd.DataFrame, judged: Sequence[str]) -> pd.Series:
    """Return the largest of the judged errors of each row and of all finer ones of its family.

    An error that a finer setting does not keep is luck: of a step and a mesh whose errors cancel, for one.
    What has no error has an infinite one, so that what is coarser than a failure does not count either.
    """
    worst = rows.reindex(columns=list(judged)).max(axis=1, skipna=False).fillna(math.inf)
    finest_first = rows.assign(error=worst).sort_values("fineness", ascending=False)
    return finest_first.groupby(["group", "family"])["error"].cummax().reindex(rows.index)


def cheapest(rows: pd.DataFrame, judged: Sequence[str], error: float) -> pd.DataFrame:
    """Return the fastest row of each group whose judged errors are within `error` [1 or rad], or its best
    row.

    The column `meets` is added. If a group has no answer, its first row is returned.
    """
    now, held = rows.reindex(columns=list(judged)).max(axis=1, skipna=False), kept(rows, judged)
    found = []
    for _, mine in rows.groupby("group", sort=False):
        within = mine[(held[mine.index] <= error) & (mine["status"] == "converged")]
        best = now[mine.index].idxmin() if now[mine.index].notna().any() else mine.index[0]
        place: Any = within["whole_s"].idxmin() if len(within) else best
        found.append(rows.loc[place].to_dict() | {"meets": bool(len(within))})
    return pd.DataFrame(found)


#: Passes of timing of an advice.
ADVISED = 2


def advise(design: Design, error: float, progress: Progress = silent) -> pd.DataFrame:
    """Return the advice for the static path of a design, each model against the limit of its own theory.

    Args:
        error: wanted error of trajectory and torque [1].
        progress: called with settings done and settings in all.

    Returns:
        One row per group: setting, `meets` (whether trajectory and torque are within `error` over the path,
        also with all finer settings), errors of trajectory, torque, stiffness and stress [1], and the
        `uncertainty` of each limit [1], times as of `tried` [s], message (why a model has no answer). If a
        group does not meet the error, the row is its best setting.

    Raises:
        NoReference: the finite elements do not reach the end of the path.
    """
    pivot, own = design.crossing_point is not None, (spline, elements)
    asked = [each for each in paths() if each.model.installed() and (pivot or each.model in own)]
    limits = {theory: path_limit(design, theory) for theory in {each.theory for each in asked}}
    rows = compared(asked, design, limits, passes=ADVISED, progress=progress)
    found = cheapest(rows, PATH_JUDGED, error)
    columns: dict[str, list[Any]] = {
        f"uncertainty_{name}": [limits[theory].uncertainty[name] for theory in found["theory"]]
        for name in PATH_ERRORS
    }
    return found.assign(**columns)
