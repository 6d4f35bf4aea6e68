"""Baselines by name, what this machine lacks of them, which settings of theirs a comparison tries, and how:
errors of path and swing against the limit of each theory, and times."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

import numpy as np
import pandas as pd
from scipy.interpolate import CubicSpline

from studies.answers.reference import Reference
from studies.baselines.answer import BaselineFailed, Followed, SolvedPath
from studies.baselines.constraint_model import constraint_model
from studies.baselines.exudyn_strips import exudyn_ancf, exudyn_exact
from studies.baselines.openseespy import openseespy_frame
from studies.baselines.own import elements as own_elements
from studies.baselines.own import spline
from studies.baselines.pseudo_rigid import four_bar, linear_pivot, pin_joint
from studies.baselines.variant import Baseline, Variant, grid, repeats_of
from studies.cases.problem import Problem
from studies.engine import Row, lacking
from studies.kinds import Array
from studies.paper import formulations
from studies.work_precision import equal_error
from studies.work_precision.limits import WITH_SHEAR, WITHOUT_SHEAR, errors_of
from studies.work_precision.series import ELEMENTS, SPLINE

#: Models of which the rotation is the only coordinate, the one whose beams have others that are eliminated,
#: and other codes.
PSEUDO_RIGID = {each.model: each for each in (linear_pivot, pin_joint, four_bar)}
SURROGATES = PSEUDO_RIGID | {constraint_model.model: constraint_model}
PEERS: dict[str, Baseline] = {each.model: each for each in (exudyn_ancf, exudyn_exact, openseespy_frame)}

#: What to do about a peer that is not there.
HINT = "not installed: python -m pip install '.[peers]'"


def missing() -> str:
    """Return what this machine lacks of a study that holds the suite against all other codes; or nothing."""
    gone = [name.split()[0] for name, peer in PEERS.items() if not peer.installed()]
    return lacking("peers", list(dict.fromkeys(gone)))


#: Theories of the rod: the limit that a model tends to.
NAMES = {"material": WITHOUT_SHEAR, "shear": WITH_SHEAR}

#: What times are compared under, beside the splines and elements of the suite.
EXUDYN, AS_DELIVERED, OPENSEES = "Exudyn", "Exudyn as delivered", "OpenSees"
SURROGATE = "surrogates"

#: Passes through all variants, far apart in time: what else the machine does lasts longer than one variant.
PASSES = 3
#: What takes so many times as long as another of its model that is as accurate is timed in one pass only.
SLOW = 2.0


#: Settings of the static path.
STATIC = (
    *grid(spline, SPLINE, control_points=range(4, 11)),
    *grid(own_elements, ELEMENTS, elements=(4, 5, 10, 20, 40, 80, 160, 320)),
    *(variant for each in SURROGATES.values() for variant in grid(each, SURROGATE)),
    *grid(exudyn_ancf, EXUDYN, elements=(2, 4, 6, 8, 12, 16, 24, 40), relative_tolerance=(1e-5, 1e-6, 1e-8)),
    *grid(
        exudyn_exact, EXUDYN,
        elements=(1, 2, 3, 4, 6, 8, 12, 16, 20, 24), relative_tolerance=(1e-5, 1e-6, 1e-8),
    ),
    *grid(exudyn_ancf, EXUDYN, elements=(4, 8, 16, 24, 40), integration=(1, 2), relative_tolerance=(1e-6,)),
    *grid(exudyn_ancf, AS_DELIVERED, elements=(4, 8, 16, 40), solver=("as delivered",)),
    *grid(exudyn_exact, AS_DELIVERED, elements=(2, 4, 8, 20), solver=("as delivered",)),
    *grid(openseespy_frame, OPENSEES, elements=(5, 10, 20, 40, 80, 160), tolerance=(1e-8, 1e-10)),
)  # fmt: skip

#: Steps of implicit schemes [s], and what a leapfrog is stable with: control points and steps.
STEPS = (2e-4, 1e-4, 5e-5, 2e-5)
LEAPS = ((5, 5e-6), (6, 5e-6), (6, 2.5e-6), (7, 4e-6), (8, 2.5e-6), (8, 1.25e-6), (9, 2e-6))
#: Exudyn's spectral radius, and the tolerance of its iterations.
DAMPED = ((0.9, 1e-3), (0.6, 1e-3), (0.9, 1e-5))

#: Settings of the release.
SWINGS = (
    *grid(spline, SPLINE, control_points=(5, 6, 7, 8), integrator=("energy",), step=STEPS),
    *(
        variant
        for n, step in LEAPS
        for variant in grid(spline, SPLINE, control_points=(n,), integrator=("leapfrog",), step=(step,))
    ),
    *(
        variant
        for integrator, steps in (("central-difference", (2e-5,)), ("generalised-alpha", (1e-4, 5e-5)))
        for variant in grid(
            own_elements, ELEMENTS, elements=(5, 10, 16, 24), integrator=(integrator,), step=steps
        )
    ),
    *(variant for each in SURROGATES.values() for variant in grid(each, SURROGATE, step=(1e-5,))),
    *(
        variant
        for radius, tolerance in DAMPED
        for each, meshes in ((exudyn_ancf, (3, 4, 5, 6, 8)), (exudyn_exact, (2, 3, 4, 6)))
        for variant in grid(
            each, EXUDYN,
            elements=meshes, step=STEPS, spectral_radius=(radius,), relative_tolerance=(tolerance,),
        )
    ),
    # do still shorter steps keep the smaller errors?
    *grid(
        exudyn_ancf, EXUDYN,
        elements=(8, 12), step=(1e-5, 5e-6), spectral_radius=(0.9,), relative_tolerance=(1e-5,),
    ),
    *grid(openseespy_frame, OPENSEES, elements=(10, 20, 40), step=(1e-4, 5e-5, 2e-5)),
)  # fmt: skip


def _label(variant: Variant) -> str:
    """Return the settings of a variant as a text."""
    return " ".join(
        f"{name}={value:g}" if isinstance(value, float) else f"{name}={value}"
        for name, value in variant.settings.items()
    )


#: Rows of errors and work, and those of times.
Tried = tuple[list[Row], list[Row]]
#: Largest number of timed solves of a path in a pass.
REPEAT = 5

PATH_ERRORS = ("trajectory", "torque", "torque_at_end", "worst", "fineness")
WORK = ("unknowns", "newton_iterations", "factorisations")
SWING_ERRORS = ("rotation_rad", "uncertainty_rad", "step_s", "fineness")


def compared_paths(problem: Problem, against: Mapping[str, SolvedPath | Reference]) -> Tried:
    """Return errors and work, and times, a row a variant."""
    turns = np.linspace(0.0, problem.rotation, problem.increments + 1)

    def solve(variant: Variant) -> tuple[Row, Followed]:
        path = variant.baseline.static_path(problem, turns, **variant.settings)
        work = {name: path.work.get(name, np.nan) for name in WORK}
        found = errors_of(path, against[NAMES[variant.theory]])
        fineness = float(variant.count) if variant.settings else np.nan  # a closed form has none
        return found | {"fineness": fineness} | work, path

    return tried(STATIC, solve, PATH_ERRORS, judged="worst", repeat=REPEAT)


def compared_swings(problem: Problem, against: dict[str, Array], uncertainty: Mapping[str, float]) -> Tried:
    """Return errors with the uncertainty of their limit and work, and times, a row a variant."""

    def solve(variant: Variant) -> tuple[Row, Followed]:
        motion = variant.baseline.release(
            problem,
            start=problem.rotation,
            duration=formulations.DURATION,
            **variant.settings,
        )
        theory = NAMES[variant.theory]
        unsure = float(uncertainty[theory])
        work = {name: motion.work.get(name, np.nan) for name in ("steps", "newton_iterations")}
        rotation = CubicSpline(motion.time, motion.rotation)(formulations.INSTANTS)
        apart = float(np.abs(rotation - against[theory]).max())
        step = variant.settings["step"]
        errors = {"rotation_rad": apart, "uncertainty_rad": unsure, "step_s": step, "fineness": -step}
        return errors | work, motion

    return tried(SWINGS, solve, SWING_ERRORS, judged="rotation_rad", repeat=1)


def tried(
    variants: Sequence[Variant],
    solve: Callable[[Variant], tuple[Row, Followed]],
    errors: Iterable[str],
    *,
    judged: str,
    repeat: int,
) -> Tried:
    """Return the rows of the physics, and those of the times: median and quartiles of all runs.

    What is not installed has one row, and what fails keeps its own, both without errors.

    Args:
        solve: returns errors and work of a variant, and what can be timed. errors: their columns.
        judged: the error at which times are compared; repeat: timed runs in a pass [1], fewer of what takes
            long.
    """
    nothing = dict.fromkeys(errors, np.nan)
    rows: list[Row] = []
    solved: dict[Variant, Followed] = {}
    seconds: dict[Variant, list[float]] = {}
    repeats: dict[Variant, int] = {}
    for variant in variants:
        row: Row = {"model": variant.baseline.model, "group": variant.series}
        row |= {"variant": _label(variant), "theory": NAMES[variant.theory], "reason": ""}
        if not variant.baseline.installed():
            row |= {"variant": "", "status": "not installed", "reason": HINT} | nothing
            rows += [row] if row not in rows else []
            continue
        try:
            outcome, solved[variant] = solve(variant)
        except BaselineFailed as error:
            rows.append(row | {"status": "failed", "reason": str(error)} | nothing)
            continue
        rows.append(row | {"status": "converged"} | outcome)
        once = solved[variant].seconds(1)
        repeats[variant] = min(repeat, repeats_of(*once))
        seconds[variant] = [*(once if repeats[variant] == 1 else solved[variant].seconds(repeats[variant]))]
    again = list(_compared(rows, seconds, judged))
    for _ in range(1, PASSES):
        for variant in again:
            seconds[variant] += solved[variant].seconds(repeats[variant])
    return rows, [{"model": v.baseline.model, "variant": _label(v)} | spread(seconds[v]) for v in solved]


def _compared(rows: list[Row], seconds: Mapping[Variant, Sequence[float]], error: str) -> Iterator[Variant]:
    """Yield the variants whose times may stand in a comparison: none of their model is as accurate and much
    faster."""
    if not seconds:
        return
    table = kept(pd.DataFrame(rows), error)
    solved = table[table["status"] == "converged"].assign(
        median=[float(np.median(each)) for each in seconds.values()]
    )
    for variant, row in zip(seconds, solved.to_dict("records"), strict=True):
        same = (solved["model"] == row["model"]) & (solved["group"] == row["group"])
        if row["median"] <= SLOW * solved.loc[same & (solved[error] <= row[error]), "median"].min():
            yield variant


def kept(rows: pd.DataFrame, error: str) -> pd.DataFrame:
    """Return the rows with their error replaced by the largest of their settings as fine as this and finer.

    `fineness` of a path is its elements or control points, of a swing its step with the sign turned. An error
    that comes and goes as these are refined is luck; this one only falls.
    """
    by = "step" if "step_s" in rows else "elements|control_points"
    settings = rows["variant"].fillna("").str.replace(rf"(?:{by})=\S+", "", regex=True)
    named = rows.assign(series=rows["model"], family=settings)
    return rows.assign(**{error: equal_error.kept(named, [error], "fineness")})


def spread(seconds: Sequence[float]) -> dict[str, float]:
    """Return median and quartiles of times [s], and how many they are, as columns of a table."""
    low, median, high = np.percentile(seconds, (25, 50, 75))
    return {"solve_s": median, "low_s": low, "high_s": high, "runs": len(seconds)}
