"""The floating-point environment: threads, compiled or not, and the order of strips and bodies."""

import json
import os
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import replace
from functools import cache, partial
from typing import Any

import numpy as np

from spline_model.batch import solve_many
from studies.answers.adapters import answer_modes, answer_release, answer_static
from studies.answers.settings import FeSettings, Settings
from studies.cases.design import named_design
from studies.cases.mechanism import Mechanism
from studies.cases.problem import named_case
from studies.engine.study import Part
from studies.record.source import ROOT
from studies.stability import family, maps
from studies.stability.geometry import as_mechanism

LINKAGE = "four_bar_of_flexures"

#: Largest relative difference that is none [1]; of frequencies, whose lowest loses the digits by which the
#: square of the highest exceeds its own: seven, for the linkage.
TOLERANCE, FREQUENCY_TOLERANCE = 1e-12, 1e-9
FREQUENCY, MODES = "frequency_", ": modes"
#: Columns that are asked; the motion is short, as a long one magnifies any difference.
ASKED = (family.DEFAULT, family.LOCKING_FREE, family.PAPER, family.FE)
STEPS, STEP = 20, 5e-5
THREADS = (1, 2, 4)
REORDERED = {"second strip first, pivot": family.CASE, "strips and bodies reversed, linkage": LINKAGE}
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
    for name, place in path.bodies.items():
        found |= {f"{name}_path_{i}": value for i, value in enumerate(place[-1])}
    for name, place in motion.bodies.items():
        found |= {f"{name}_motion_{i}": value for i, value in enumerate(place[-1])}
    return {name: float(value) for name, value in found.items()}


def _difference(one: Mapping[str, float], other: Mapping[str, float]) -> float:
    """Return the largest relative difference of numbers by name [1]; places count in strip lengths."""
    length = named_case(family.CASE).length
    gaps = []
    for name, value in one.items():
        scale = max(abs(value), length) if "_path_" in name or "_motion_" in name else abs(value)
        gaps.append(abs(value - other[name]) / scale)
    return float(np.max(gaps))


def _reordered(case: str, settings: Settings, modes: bool) -> family.Found:
    """Answer a mechanism with its strips and bodies in the opposite order: path and motion, or `modes`."""
    design = named_design(case)
    given = design if isinstance(design, Mechanism) else as_mechanism(design, 90.0)
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
    columns: dict[str, Any] = named_case(family.CASE).pivot_parameters() | {"crossing_ratio": ratios}
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


def main(model: str, increments: str) -> None:
    """Print the answers of Table 1 as JSON."""
    given = as_mechanism(named_case(family.CASE), 90.0)
    print(json.dumps(_answers(given, family.COLUMNS[model], increments=int(increments))))


STUDY = family.study(
    Part(at=_tasks, ask=family.outcome_of),
    cases=(family.CASE, LINKAGE),
    figures={
        "stability_environment": lambda tables: maps.listed(
            tables["outcomes"],
            family.names(_tasks()),
            title=f"The same torque, path and motion to {TOLERANCE:g}, "
            f"the same modes to {FREQUENCY_TOLERANCE:g}",
        )
    },
)

if __name__ == "__main__":
    main(*sys.argv[1:])
