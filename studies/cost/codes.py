"""What accuracy costs: both models, surrogates and other codes on the static path and the free swing.

Every error is against the limit of the model's own rod theory, with or without shear. Times are of whole
calls, one scope for all (`tried`), and are compared at equal error: the fastest setting of each group that
reaches a level, and keeps it at finer meshes or steps, over the fastest spline that does.
"""

import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from importlib.metadata import version
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from studies.answers import reference
from studies.answers.adapters import answer_release
from studies.answers.reference import SwingReference, largest_errors, sampled
from studies.answers.settings import SplineSettings
from studies.cases.problem import TABLE_1, Problem, named_case
from studies.cost import tried
from studies.cost.exudyn import exudyn_ancf
from studies.cost.openseespy import openseespy_frame
from studies.cost.tried import SPLINE
from studies.engine import Answer, Part, Row, Study, Tables, lacking
from studies.kinds import Array
from studies.paper.formulations import DURATION, INSTANTS
from studies.record.panels import Axis, Curves, Level, Panel, sheet
from studies.record.progress import measure
from studies.record.source import ROOT
from studies.record.style import BLACK, BLUE, ORANGE, PURPLE, SKY, Look

#: What paths and swings are judged by, and the errors at which their times are compared [1] and [rad].
JUDGED = {"paths": tried.PATH_JUDGED, "swings": tried.SWING_JUDGED}
LEVELS = {"paths": (1e-1, 1e-2, 1e-3, 2e-4, 1e-5, 1e-6), "swings": (1e-1, 2e-2, 1e-2, 5e-3, 2e-3)}
#: A limit must be this much more certain than the level that errors against it are compared at.
CERTAINTY = 2.0
#: Columns of what was measured in seconds, which stand in tables of their own.
TIMES = ("whole_s", "solve_s", "runs")
#: Columns that say which setting it is.
WHICH = ("model", "group", "setting")


#: Control points and steps [s] of the splines that are the limit of a swing, the finer one first.
SWINGS = {16: 3e-7, 14: 4e-7}
#: Records of these: the strips' own oscillations are some 40 times as fast as the swing, and cubic
#: interpolation between so many errs by less than 1e-6 rad.
RECORDS = 4000
#: Meshes of the limit with shear, a third apart: linear elements, whose waves need finer ones.
SHEAR_MESHES = (36, 54, 81, 121)
#: Other codes by their packages.
CODES = {"exudyn": exudyn_ancf, "openseespy": openseespy_frame}
#: Groups in the order of the tables, beside the spline.
GROUPS = (tried.ITSELF, tried.ELEMENTS, tried.SHEARED, tried.EXUDYN, tried.OPENSEES, tried.SURROGATE)
#: Looks of those that are drawn: a colour a code.
LOOKS = {
    SPLINE: Look(label="spline", colour=BLUE, marker="x"),
    tried.ITSELF: Look(label="spline, by itself", colour=SKY, line="--", marker="D"),
    tried.ELEMENTS: Look(label="finite elements", colour=BLACK, marker="s"),
    tried.EXUDYN: Look(label="Exudyn", colour=PURPLE, marker="^"),
    tried.OPENSEES: Look(label="OpenSees", colour=ORANGE, line="--", marker="<"),
}
#: What the other codes' rods with shear have beside it.
ROTARY = "section_rotary_inertia"


def _paths() -> Answer:
    """Return errors and times of the static path, and of the limits of all theories how certain they are and
    how far apart."""
    design = named_case()
    limits = {theory: tried.path_limit(design, theory) for theory in tried.THEORIES}
    rows = [
        {
            "theory": theory,
            "quantity": name,
            "uncertainty": limit.uncertainty[name],
            "distance_to_material": largest_errors(limit, limits[tried.MATERIAL])[name],
            "source": limit.source,
        }
        for theory, limit in limits.items()
        for name in reference.QUANTITIES
    ]
    return {"path_limits": rows, **_apart("paths", tried.compared(tried.paths(), design, limits))}


def _swings() -> Answer:
    """Return errors and times of the swing, and the same of the limits of both theories."""
    problem = named_case()
    with_rotary = replace(problem, effects=problem.effects.plus(ROTARY))
    how: dict[str, Any] = {"duration": DURATION, "instants": INSTANTS, "meshes": SHEAR_MESHES}
    sheared = reference.swing_reference(with_rotary, element="reissner", **how)
    limits = {tried.MATERIAL: _refined_swing(problem, INSTANTS), tried.SHEAR: sheared}
    rows = [
        {
            "theory": theory,
            "rotation_rad": limit.uncertainty["rotation_rad"],
            "frequency_error": limit.uncertainty["frequency"],
            "distance_to_material_rad": float(np.abs(limit.rotation - limits[tried.MATERIAL].rotation).max()),
            "source": limit.source,
        }
        for theory, limit in limits.items()
    ]
    return {
        "swing_limits": rows,
        **_apart("swings", tried.compared(tried.swings(), problem, limits, INSTANTS)),
    }


def _refined_swing(problem: Problem, instants: Array) -> SwingReference:
    """Return the swing without shear at the instants (T,) [s] by the finest splines."""
    how: dict[str, Any] = {"duration": float(instants[-1]), "records": RECORDS, "integrator": "leapfrog"}
    fine, coarse = (
        sampled(answer_release(problem, SplineSettings(control_points=n), step=step, **how).whole(), instants)
        for n, step in SWINGS.items()
    )
    told = " and ".join(f"n = {n} at {1e6 * step:g} µs" for n, step in SWINGS.items())
    uncertainty = reference.swing_errors(coarse, fine)
    return SwingReference(**vars(fine), uncertainty=uncertainty, source=told)


def _apart(name: str, found: pd.DataFrame) -> dict[str, pd.DataFrame]:
    """Return errors, and the times, as tables of their own."""
    timed = found[found["runs"] > 0]
    return {name: found.drop(columns=[*TIMES]), f"{name[:-1]}_times": timed[[*WHICH, *TIMES]]}


def _joined(tables: Tables, name: str) -> pd.DataFrame:
    """Return errors and times in one table."""
    return tables[name].merge(tables[f"{name[:-1]}_times"], on=[*WHICH], how="left")


def _ratios(name: str, tables: Tables) -> Iterator[Row]:
    """Yield the fastest settings: a row a level and group, with its time and that of the spline, and their
    ratio; empty where no setting of a group keeps the level."""
    rows = _joined(tables, name)
    for level in LEVELS[name]:
        sure = rows[~rows["theory"].isin(_unsure(tables, name, level))]
        best = {row["group"]: row for row in tried.cheapest(sure, JUDGED[name], level).to_dict("records")}
        mine = best[SPLINE]
        known = {"spline": mine["setting"], "spline_s": mine["whole_s"], "spline_solve_s": mine["solve_s"]}
        for row in (best[group] for group in GROUPS if group in best and mine["meets"]):
            told = {each: row[each] if row["meets"] else np.nan for each in TIMES[:-1]}
            setting = f"{row['model']}, {row['setting']}" if row["meets"] else ""
            ratio = told["whole_s"] / mine["whole_s"]
            yield {"level": level, "group": row["group"], "setting": setting, **told, "ratio": ratio, **known}


def _unsure(tables: Tables, name: str, level: float) -> list[str]:
    """Return the theories whose limit is too uncertain for errors of that size."""
    limits = tables[f"{name[:-1]}_limits"]
    of = "rotation_rad" if name == "swings" else "uncertainty"
    if name == "paths":
        limits = limits[limits["quantity"].isin(tried.PATH_JUDGED)]
    return list(limits.loc[CERTAINTY * limits[of] > level, "theory"])


#: Label -> words that ask for the settings of the least number that keep path and torque to 1e-4.
WAITED = {
    "spline, n = 6": ("--control-points", "6"),
    "80 elements": ("--model", "fe", "--elements", "80"),
}
#: Runs of a command.
COMMANDS = 3


def _waited(label: str) -> Answer:
    """Return what a user waits for a command, which loads everything."""
    command = [sys.executable, "-m", "studies", "solve", TABLE_1, *WAITED[label]]
    asked = partial(subprocess.run, command, cwd=ROOT, capture_output=True, check=True)
    timed = measure(asked, repeat=COMMANDS, warm_up=0)
    return {"waits_of_time": {"model": label, "whole_s": timed.median, "runs": COMMANDS}}


def _figure(tables: Tables) -> Figure:
    """Draw the error over the time of the best settings of each group, for the path and the swing."""
    path = Axis("error", "larger error of trajectory and torque [1]", log=True)
    swing = Axis("error", "largest error of the rotation [rad]", log=True)
    limits = tables["swing_limits"].set_index("theory")["rotation_rad"]
    doubts = [Level(float(limits[tried.SHEAR]), words="limit with shear", line=":", place=1.0)]
    panels = [
        _panel(tables, "paths", path, "Static path to 90° in 20 increments"),
        _panel(tables, "swings", swing, "Free swing of 0.05 s from 90°", *doubts),
    ]
    return sheet(9.5, 4.4, [panels], legend=3)


def _panel(tables: Tables, name: str, y: Axis, title: str, *marks: Level) -> Panel:
    """Return the panel of a task: of each group the settings that keep an error which none that is faster
    keeps, as the table of ratios has them."""
    rows = _joined(tables, name)
    rows = rows.assign(error=tried.kept(rows, JUDGED[name]))
    rows = rows[(rows["status"] == "converged") & np.isfinite(rows["error"])].sort_values("whole_s")
    best = rows[rows["error"] == rows.groupby("group")["error"].cummin()]
    best = best[~best.duplicated(["group", "error"]) & best["group"].isin(LOOKS)]
    time_axis = Axis("whole_s", "time of a whole call [ms]", factor=1e3, log=True)
    return Panel(time_axis, y, (Curves(best, LOOKS, by="group"), *marks), title=title)


def _missing() -> str:
    """Return what this machine lacks of the other codes; or nothing."""
    return lacking("peers", [code for code, model in CODES.items() if not model.installed()])


STUDY = Study(
    parts=(
        Part(at=lambda: CODES, ask=lambda code: {"codes": {"code": code, "version": version(code)}}),
        Part(ask=_paths, alone=True),
        Part(ask=_swings, alone=True),
        Part(at=lambda: tuple(WAITED), ask=_waited, alone=True),
    ),
    made={"path_ratios": partial(_ratios, "paths"), "swing_ratios": partial(_ratios, "swings")},
    varying=("path_ratios", "swing_ratios"),
    figures={"cost": _figure},
    missing=_missing,
)
