"""A million steps of free swing without damping: energy, constraints and memory."""

import math
import pickle
import re
import resource
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from spline_model.dynamics import Trajectory, solve_motion
from studies.answers.adapters import spline_mechanism
from studies.answers.settings import SplineSettings
from studies.cases.problem import named_case
from studies.engine.findings import Tables
from studies.engine.study import Answer, Part
from studies.record.source import ROOT, source_hash
from studies.record.style import BLUE, ORANGE, RED, SKY, page
from studies.stability.columns import COLUMNS, DEFAULT, LOCKING_FREE, PAPER
from studies.stability.family import CASE, family
from studies.stability.outcome import Found, judged

STEP, START_DEG = 5e-5, 30.0
#: Steps of a piece, after which the state is kept so that an interrupted run goes on from there, and pieces
#: of each column: a million steps of the default, a tenth of it of the others.
PIECE = 10_000
PIECES = {DEFAULT: 100, LOCKING_FREE: 10, PAPER: 10}
#: Largest change of energy that is right [1].
TOLERANCE = 1e-6
#: Factor by which the constraint residual of the last tenth may exceed that of the first.
GROWTH = 3.0
COLOURS = {DEFAULT: BLUE, LOCKING_FREE: SKY, PAPER: RED}

#: Where the pieces of an interrupted run are kept; not a result.
KEPT = ROOT / ".cache" / "long_run"


def pieces(model: str, count: int) -> Answer:
    """Return the drift of a column over so many pieces, the memory after each, and its outcome."""
    run = Run(model)
    while run.pieces < count and not run.message:
        run.go_on()
    drift = run.rows[:count]
    outcome = judgement(model, pd.DataFrame(drift))
    return {"outcomes": outcome, "drift": drift, "timings_memory": run.memory[:count]}


def figure(tables: Tables) -> Figure:
    """Draw energy, constraint residual and memory against the number of steps."""
    drawn = page(9.6, 3.1)
    panels = drawn.subplots(1, 3)
    for model, colour in COLOURS.items():
        mine = tables["drift"].query("model == @model").sort_values("steps")
        panels[0].loglog(mine["steps"], mine["energy_change"].clip(1e-16), color=colour, label=model)
        panels[1].loglog(mine["steps"], mine["constraint_residual_m"].clip(1e-19), color=colour)
    mine = tables["timings_memory"].query("model == @DEFAULT").sort_values("steps")
    panels[2].semilogx(mine["steps"], mine["largest_memory_MB"], color=ORANGE)
    panels[0].axhline(TOLERANCE, color=RED, linewidth=0.9, linestyle=":")
    panels[0].set(ylabel="largest change of energy [1]", xlabel="steps [1]", ylim=(1e-16, 1e-5))
    panels[0].legend(loc="upper left")
    panels[1].set(ylabel="constraint residual of a piece [m]", xlabel="steps [1]", ylim=(1e-18, 1e-14))
    panels[2].set(ylabel="largest memory of the process [MB]", xlabel="steps [1]")
    panels[2].set_ylim(bottom=0.0)
    drawn.suptitle(f"Free swing of Table 1 from {START_DEG:g}° in steps of {STEP:g} s, without damping")
    return drawn


class Run:
    """A run in pieces, each kept in a file: one that was interrupted goes on where it ended."""

    def __init__(self, model: str, *, folder: Path = KEPT, steps: int = PIECE) -> None:
        settings = COLUMNS[model]
        if not isinstance(settings, SplineSettings):
            raise TypeError(f"model: got {model}, expected a spline")
        self.model, self.steps = model, steps
        self.mechanism = spline_mechanism(named_case(CASE), settings)
        # pieces of other code are another run's
        self.path = (
            folder
            / f"{source_hash(__name__)[:16]}_{'_'.join(re.findall(r'[a-z0-9]+', model))}_{steps}.pickle"
        )
        self.rows: list[dict[str, Any]] = []
        self.memory: list[dict[str, Any]] = []
        self.last: Trajectory | None = None
        self.energy = self.change = 0.0
        if self.path.is_file():
            kept = pickle.loads(self.path.read_bytes())
            self.rows, self.memory, self.last, self.energy, self.change = kept

    @property
    def pieces(self) -> int:
        """Pieces that are done."""
        return len(self.rows)

    @property
    def message(self) -> str:
        """Why the run stopped; empty while it can go on."""
        return "" if self.last is None else self.last.message

    def go_on(self) -> None:
        """Take one more piece and keep it."""
        begin: dict[str, Any] = {"after": self.last} if self.last else {"start": math.radians(START_DEG)}
        piece = solve_motion(
            self.mechanism, duration=self.steps * STEP, step=STEP, records=100, check=False, **begin
        )
        energy = piece.kinetic_energy + piece.strain_energy
        self.energy = self.energy or float(energy[0])
        self.change = max(self.change, float(np.abs(energy / self.energy - 1.0).max()))
        steps = (self.pieces + 1) * self.steps
        self.rows.append(
            {
                "model": self.model,
                "steps": steps,
                "energy_change": self.change,
                "constraint_residual_m": float(piece.constraint_residual.max()),
                "amplitude_rad": float(np.abs(piece.rotation).max()),
                "newton_iterations": piece.counters["newton_iterations"],
                "message": piece.message,
            }
        )
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
        self.memory.append({"model": self.model, "steps": steps, "largest_memory_MB": peak})
        self.last = _last_record(piece)
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self.path.write_bytes(pickle.dumps((self.rows, self.memory, self.last, self.energy, self.change)))


def judgement(model: str, drift: pd.DataFrame) -> dict[str, Any]:
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
    )
    name = f"{int(drift['steps'].max())} steps"
    return {"case": name, "model": model, **judged(lambda: found, TOLERANCE).row(), "growth": growth}


def _last_record(piece: Trajectory) -> Trajectory:
    """Return the trajectory with its last record alone: what a restart needs."""
    arrays = {
        name: getattr(piece, name)[-1:]
        for name in (
            "time",
            "kinetic_energy",
            "strain_energy",
            "gravity_energy",
            "work",
            "dissipated",
            "constraint_residual",
            "velocity_residual",
            "states",
            "velocities",
        )
    }
    return replace(piece, bodies={name: place[-1:] for name, place in piece.bodies.items()}, **arrays)


STUDY = family(
    Part(at=PIECES.items, ask=pieces, alone=True),
    figures={"stability_long_run": figure},
)
