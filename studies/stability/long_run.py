"""A million steps of free swing without damping: energy, constraints and memory."""

import math
import resource
from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from spline_model.dynamics import solve_motion
from studies.answers.adapters import spline_mechanism
from studies.answers.settings import SplineSettings
from studies.cases.problem import named_case
from studies.engine.study import Answer, Part, Tables
from studies.record.style import BLUE, ORANGE, RED, SKY, page
from studies.stability import family

STEP, START_DEG = 5e-5, 30.0
#: Steps of a piece, after which a row is kept, and pieces of each column: a million steps of the default, a
#: tenth of it of the others.
PIECE = 10_000
PIECES = {family.DEFAULT: 100, family.LOCKING_FREE: 10, family.PAPER: 10}
#: Largest change of energy that is right [1].
TOLERANCE = 1e-6
#: Factor by which the constraint residual of the last tenth may exceed that of the first.
GROWTH = 3.0
COLOURS = {family.DEFAULT: BLUE, family.LOCKING_FREE: SKY, family.PAPER: RED}


def _pieces(model: str, count: int) -> Answer:
    """Return the drift of a column over so many pieces, the memory after each, and its outcome."""
    drift, memory = zip(*run(model, count), strict=True)
    return {"outcomes": _judgement(model, pd.DataFrame(drift)), "drift": drift, "timings_memory": memory}


def run(model: str, count: int, steps: int = PIECE) -> Iterator[tuple[dict[str, Any], dict[str, Any]]]:
    """Yield the rows of drift and of memory after each piece of so many steps, until one stops early."""
    settings = family.COLUMNS[model]
    if not isinstance(settings, SplineSettings):
        raise TypeError(f"model: got {model}, expected a spline")
    mechanism = spline_mechanism(named_case(family.CASE), settings)
    begin: dict[str, Any] = {"start": math.radians(START_DEG)}
    first, change = 0.0, 0.0
    for number in range(1, count + 1):
        piece = solve_motion(mechanism, duration=steps * STEP, step=STEP, records=100, check=False, **begin)
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


def _figure(tables: Tables) -> Figure:
    """Draw energy, constraint residual and memory against the number of steps."""
    drawn = page(9.6, 3.1)
    panels = drawn.subplots(1, 3)
    for model, colour in COLOURS.items():
        mine = tables["drift"].query("model == @model").sort_values("steps")
        panels[0].loglog(mine["steps"], mine["energy_change"].clip(1e-16), color=colour, label=model)
        panels[1].loglog(mine["steps"], mine["constraint_residual_m"].clip(1e-19), color=colour)
    mine = tables["timings_memory"].query("model == @family.DEFAULT").sort_values("steps")
    panels[2].semilogx(mine["steps"], mine["largest_memory_MB"], color=ORANGE)
    panels[0].axhline(TOLERANCE, color=RED, linewidth=0.9, linestyle=":")
    panels[0].set(ylabel="largest change of energy [1]", xlabel="steps [1]", ylim=(1e-16, 1e-5))
    panels[0].legend(loc="upper left")
    panels[1].set(ylabel="constraint residual of a piece [m]", xlabel="steps [1]", ylim=(1e-18, 1e-14))
    panels[2].set(ylabel="largest memory of the process [MB]", xlabel="steps [1]")
    panels[2].set_ylim(bottom=0.0)
    drawn.suptitle(f"Free swing of Table 1 from {START_DEG:g}° in steps of {STEP:g} s, without damping")
    return drawn


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
    )
    name = f"{int(drift['steps'].max())} steps"
    return {"case": name, "model": model, **family.judged(lambda: found, TOLERANCE), "growth": growth}


STUDY = family.study(
    Part(at=PIECES.items, ask=_pieces, alone=True),
    figures={"stability_long_run": _figure},
)
