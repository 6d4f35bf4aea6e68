"""A million steps of free swing without damping: energy and constraints."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd

from spline_model.dynamics import solve_motion
from studies.answers.models import put
from studies.cases.problem import named_case
from studies.engine import Answer, Part
from studies.stability.verdict import COLUMNS, DEFAULT, LOCKING_FREE, Found, judged, study

LONG_STEP, START_DEG = 5e-5, 30.0
#: Steps of a piece, after which a row is kept, and pieces of each column: a million steps of the default, a
#: tenth of it of the others.
PIECE = 10_000
PIECES = {DEFAULT: 100, LOCKING_FREE: 10}
#: Largest change of energy that is right [1].
DRIFT = 1e-6
#: Factor by which the constraint residual of the last tenth may exceed that of the first.
GROWTH = 3.0


def _pieces(model: str, count: int) -> Answer:
    """Return the drift of a column over so many pieces, and its outcome."""
    drift = list(_run(model, count))
    return {"outcomes": _judgement(model, pd.DataFrame(drift)), "drift": drift}


def _run(model: str, count: int, steps: int = PIECE) -> Iterator[dict[str, Any]]:
    """Yield the row of drift after each piece of so many steps, until one stops early."""
    mechanism = put(named_case(), COLUMNS[model], moving=True).modelled
    begin: dict[str, Any] = {"start": math.radians(START_DEG)}
    first, change = 0.0, 0.0
    for number in range(1, count + 1):
        piece = solve_motion(
            mechanism, duration=steps * LONG_STEP, step=LONG_STEP, records=100, check=False, **begin
        )
        energy = piece.kinetic_energy + piece.strain_energy
        first = first or float(energy[0])
        change = max(change, float(np.abs(energy / first - 1.0).max()))
        yield {
            "model": model,
            "steps": number * steps,
            "energy_change": change,
            "constraint_residual_m": float(piece.constraint_residual.max()),
            "amplitude_rad": float(np.abs(piece.rotation).max()),
            "newton_iterations": piece.counters["newton_iterations"],
            "message": piece.message,
        }
        if piece.message:
            return
        begin = {"after": piece}


def _judgement(model: str, drift: pd.DataFrame) -> dict[str, Any]:
    """Return a column's outcome: energy within the tolerance, a constraint residual that does not grow."""
    tenth = max(1, len(drift) // 10)
    ordered = drift.sort_values("steps")["constraint_residual_m"].to_numpy()
    growth = float(ordered[-tenth:].max() / ordered[:tenth].max())
    message = str(drift["message"].iloc[-1])
    found = Found(
        error=float(drift["energy_change"].max()),
        reached=not message,
        reason=message,
        fault=f"the constraint residual grows {growth:.2g} times" if growth > GROWTH else "",
        counters={"newton_iterations": int(drift["newton_iterations"].sum())},
        measured={"growth": growth},
    )
    name = f"{int(drift['steps'].max())} steps"
    return {"case": name, "model": model, **judged(lambda: found, DRIFT, model)}


STUDY = study(Part(at=PIECES.items, ask=_pieces))
