"""What the machine could do to answers: round-off over a million steps, memory, threads, compiler, order."""

import json
import math
import os
import resource
import subprocess
import sys
from collections.abc import Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import cache, partial
from multiprocessing import get_context
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from spline_model.batch import solve_many
from spline_model.dynamics import solve_motion
from studies.answers.adapters import answer_modes, answer_release, answer_static
from studies.answers.models import put
from studies.answers.settings import FeSettings, Settings
from studies.cases.design import named_design
from studies.cases.mechanism import Mechanism
from studies.cases.problem import TABLE_1, named_case
from studies.engine import Answer, Part, Tables
from studies.record.digits import Digits
from studies.record.marks import Level
from studies.record.panels import Axis, Curves, Panel, sheet
from studies.record.source import ROOT
from studies.record.style import BLUE, ORANGE, RED, SKY, Look
from studies.stability import family, maps

LONG_STEP, START_DEG = 5e-5, 30.0
#: Steps of a piece, after which a row is kept, and pieces of each column: a million steps of the default, a
#: tenth of it of the others.
PIECE = 10_000
PIECES = {family.DEFAULT: 100, family.LOCKING_FREE: 10, family.PAPER: 10}
#: Largest change of energy that is right [1].
DRIFT = 1e-6
#: Factor by which the constraint residual of the last tenth may exceed that of the first.
GROWTH = 3.0
COLOURS = {family.DEFAULT: BLUE, family.LOCKING_FREE: SKY, family.PAPER: RED}


def _pieces(model: str, count: int) -> Answer:
    """Return the drift of a column over so many pieces, the memory after each, and its outcome.

    They run in a process of their own: the largest memory of any other would be that of what it did before.
    """
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as own:
        drift, memory = zip(*own.submit(_all_of, model, count).result(), strict=True)
    return {"outcomes": _judgement(model, pd.DataFrame(drift)), "drift": drift, "timings_memory": memory}


def _all_of(model: str, count: int) -> list[tuple[dict[str, Any], dict[str, Any]]]:
    return list(_run(model, count))


def _run(model: str, count: int, steps: int = PIECE) -> Iterator[tuple[dict[str, Any], dict[str, Any]]]:
    """Yield the rows of drift and of memory after each piece of so many steps, until one stops early."""
    mechanism = put(named_case(), family.COLUMNS[model], moving=True).modelled
    begin: dict[str, Any] = {"start": math.radians(START_DEG)}
    first, change = 0.0, 0.0
    for number in range(1, count + 1):
        piece = solve_motion(
            mechanism, duration=steps * LONG_STEP, step=LONG_STEP, records=100, check=False, **begin
        )
        energy = piece.kinetic_energy + piece.strain_energy
        first = first or float(energy[0])
        change = max(change, float(np.abs(energy / first - 1.0).max()))
        place = {"model": model, "steps": number * steps}
        row = {
            "energy_change": change,
            "constraint_residual_m": float(piece.constraint_residual.max()),
            "amplitude_rad": float(np.abs(piece.rotation).max()),
            "newton_iterations": piece.counters["newton_iterations"],
            "message": piece.message,
        }
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
        yield place | row, place | {"largest_memory_MB": peak}
        if piece.message:
            return
        begin = {"after": piece}


def _drift_figure(tables: Tables) -> Figure:
    """Draw energy, constraint residual and memory against the number of steps."""
    looks = {model: Look(label=model, colour=colour) for model, colour in COLOURS.items()}
    drift = Curves(tables["drift"], looks, by="model")
    memory = tables["timings_memory"].query("model == @family.DEFAULT")
    steps, residual = Axis("steps", "steps [1]", log=True), "constraint residual [m]"
    energy = Axis("energy_change", "largest change of energy [1]", log=True, least=1e-16)
    clamps = Axis("constraint_residual_m", residual, log=True, least=1e-19)
    held = Axis("largest_memory_MB", "memory of the process [MB]", limits=(0.0, None))
    panels = (
        Panel(
            steps, replace(energy, limits=(1e-16, 1e-5)),
            marks=(drift, Level(DRIFT, colour=RED, line=":"))
        ),
        Panel(steps, replace(clamps, limits=(1e-18, 1e-14)), (drift,)),
        Panel(steps, held, (Curves(memory, Look(label="_", colour=ORANGE)),)),
    )  # fmt: skip
    title = f"Free swing of Table 1 from {START_DEG:g}° in steps of {LONG_STEP:g} s, without damping"
    return sheet(9.6, 3.4, [panels], title=title, legend=len(looks))


def _judgement(model: str, drift: pd.DataFrame) -> dict[str, Any]:
    """Return a column's outcome: energy within the tolerance, a constraint residual that does not grow."""
    tenth = max(1, len(drift) // 10)
    ordered = drift.sort_values("steps")["constraint_residual_m"].to_numpy()
    growth = float(ordered[-tenth:].max() / ordered[:tenth].max())
    message = str(drift["message"].iloc[-1])
    found = family.Found(
        error=float(drift["energy_change"].max()),
        reached=not message,
        reason=message,
        fault=f"the constraint residual grows {growth:.2g} times" if growth > GROWTH else "",
        counters={"newton_iterations": int(drift["newton_iterations"].sum())},
        measured={"growth": growth},
    )
    name = f"{int(drift['steps'].max())} steps"
    return {"case": name, "model": model, **family.judged(lambda: found, DRIFT, model)}


LONG_RUN = family.study(
    Part(at=PIECES.items, ask=_pieces),
    digits={"growth": Digits(floor=1.0)},
    figures={"stability_long_run": _drift_figure},
)
"""A million steps of free swing without damping: energy, constraints and memory."""


LINKAGE = "four_bar_of_flexures"

#: Largest relative difference that is none [1]: over all 144 orders of the linkage's parts round-off spreads
#: its stiffness by 2.4e-12; of frequencies, whose lowest loses the digits by which the square of the highest
#: exceeds its own: seven, for the linkage.
TOLERANCE, FREQUENCY_TOLERANCE = 5e-12, 1e-9
FREQUENCY, MODES = "frequency_", ": modes"
#: Columns that are asked; the motion is short, as a long one magnifies any difference.
ASKED = (family.DEFAULT, family.LOCKING_FREE, family.PAPER, family.FE)
STEPS, STEP = 20, 5e-5
THREADS = (1, 2, 4)
REORDERED = {"second strip first, pivot": TABLE_1, "strips and bodies reversed, linkage": LINKAGE}
VARIABLES = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")


def _tasks() -> list[family.Task]:
    """Return case, model, what is asked, and the tolerance."""
    chosen: list[family.Task] = []
    for model in ASKED:
        settings = family.COLUMNS[model]
        for modes in (False, True):
            end, limit = (MODES, FREQUENCY_TOLERANCE) if modes else ("", TOLERANCE)
            chosen += [
                (f"{what}{end}", model, partial(_reordered, case, settings, modes), limit)
                for what, case in REORDERED.items()
            ]
        chosen.append((f"{THREADS[-1]} threads", model, partial(_threaded, model, THREADS[-1]), TOLERANCE))
    chosen.append(("not compiled", family.DEFAULT, partial(_uncompiled, family.DEFAULT), TOLERANCE))
    for count in THREADS[1:]:
        chosen.append((f"batch on {count} threads", family.DEFAULT, partial(_batched, count), TOLERANCE))
    return chosen


def _answers(design: Mechanism, settings: Settings, *, increments: int = 20) -> dict[str, float]:
    """Return numbers that say what path, motion and modes of `design` are, by name."""
    driven = replace(design, rotation=design.rotation or 0.5, increments=increments)
    path = answer_static(driven, settings)
    integrator = "generalised-alpha" if isinstance(settings, FeSettings) else None
    motion = answer_release(
        design, settings, start=0.5, duration=STEPS * STEP, step=STEP, integrator=integrator
    )
    modes = answer_modes(design, settings, count=4)
    found = {
        "torque": path.torque[-1],
        "stiffness": path.stiffness[-1],
        "energy": path.strain_energy[-1],
        "kinetic_energy": motion.kinetic_energy[-1],
        **{f"{FREQUENCY}{i}": value for i, value in enumerate(modes.frequency)},
    }
    for kind, bodies in {"path": path.bodies, "motion": motion.bodies}.items():
        for name, place in bodies.items():
            found |= {f"{name}_{kind}_{i}": value for i, value in enumerate(place[-1])}
    return {name: float(value) for name, value in found.items()}


def _difference(one: Mapping[str, float], other: Mapping[str, float]) -> float:
    """Return the largest relative difference of numbers by name [1]; places count in strip lengths."""
    length = named_case().length
    gaps = []
    for name, value in one.items():
        scale = max(abs(value), length) if "_path_" in name or "_motion_" in name else abs(value)
        gaps.append(abs(value - other[name]) / scale)
    return float(np.max(gaps))


def _reordered(case: str, settings: Settings, modes: bool) -> family.Found:
    """Answer a mechanism with its strips and bodies in the opposite order: path and motion, or `modes`."""
    design = named_design(case)
    given = design if isinstance(design, Mechanism) else family.as_mechanism(design, 90.0)
    turned = replace(given, strips=given.strips[::-1], bodies=given.bodies[::-1])
    one, other = (_answers(each, settings) for each in (given, turned))
    asked = {name: value for name, value in one.items() if name.startswith(FREQUENCY) == modes}
    return family.Found(error=_difference(asked, other))


def _threaded(model: str, count: int) -> family.Found:
    """Answer in a process of its own with so many threads, and with one."""
    return family.Found(error=_difference(_elsewhere(model, threads=1), _elsewhere(model, threads=count)))


def _uncompiled(model: str) -> family.Found:
    """Answer in a process of its own without the compiler, on a path of few increments."""
    return family.Found(
        error=_difference(
            _elsewhere(model, threads=1, increments=2),
            _elsewhere(model, threads=1, increments=2, NUMBA_DISABLE_JIT="1"),
        )
    )


def _batched(count: int) -> family.Found:
    """Answer thirty designs on one and on several threads: the same numbers."""
    ratios = np.linspace(0.3, 0.7, 30)
    columns: dict[str, Any] = named_case().pivot_parameters() | {"crossing_ratio": ratios}
    one, many = (solve_many(columns, rotation=1.5, threads=n) for n in (1, count))
    return family.Found(error=float(np.abs(many.torque - one.torque).max() / np.abs(one.torque).max()))


@cache
def _elsewhere(model: str, *, threads: int, increments: int = 20, **variables: str) -> dict[str, float]:
    """Return the answers of Table 1 from a process with these settings."""
    words = [sys.executable, "-m", __name__, model, str(increments)]
    environment = os.environ | dict.fromkeys(VARIABLES, str(threads)) | variables
    done = subprocess.run(
        words,
        cwd=ROOT,
        env={**environment, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=True,
    )
    found: dict[str, float] = json.loads(done.stdout)
    return found


def _main(model: str, increments: str) -> None:
    """Print the answers of Table 1 as JSON."""
    given = family.as_mechanism(named_case(), 90.0)
    print(json.dumps(_answers(given, family.COLUMNS[model], increments=int(increments))))


ENVIRONMENT = family.study(
    Part(at=_tasks, ask=family.outcome_of),
    cases=(TABLE_1, LINKAGE),
    figures={
        "stability_environment": lambda tables: maps.listed(
            tables["outcomes"],
            [case for case, *_ in _tasks()],
            title=f"The same torque, path and motion to {TOLERANCE:g}, "
            f"the same modes to {FREQUENCY_TOLERANCE:g}",
        )
    },
)
"""The floating-point environment: threads, compiled or not, and the order of strips and bodies."""

if __name__ == "__main__":
    _main(*sys.argv[1:])
