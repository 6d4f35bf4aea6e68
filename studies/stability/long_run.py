"""A million steps of free swing without damping: energy, constraints and memory."""

import math
import resource
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from typing import Any

import numpy as np
import pandas as pd

from spline_model.dynamics import solve_motion
from studies.answers.models import put
from studies.cases.problem import named_case
from studies.engine import Answer, Part
from studies.stability import family

LONG_STEP, START_DEG = 5e-5, 30.0
#: Steps of a piece, after which a row is kept, and pieces of each column: a million steps of the default, a
#: tenth of it of the others.
PIECE = 10_000
PIECES = {family.DEFAULT: 100, family.LOCKING_FREE: 10, family.PAPER: 10}
#: Largest change of energy that is right [1].
DRIFT = 1e-6
#: Factor by which the constraint residual of the last tenth may exceed that of the first.
GROWTH = 3.0


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


STUDY = family.study(Part(at=PIECES.items, ask=_pieces))
