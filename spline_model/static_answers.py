"""From the states of an equilibrium path to what a user asks for: energies, sections, reactions."""

from __future__ import annotations

from typing import Any

import numpy as np

from spline_model.compile import System
from spline_model.continuation.point import driven_row
from spline_model.effects import DrivenRotation
from spline_model.effects.base import Constraint
from spline_model.effects.registry import MOTION_ONLY
from spline_model.laps import Laps
from spline_model.mechanism import Mechanism
from spline_model.pivot import BODY, STRIPS
from spline_model.sections import clamp_reactions, sections
from spline_model.solution import MechanismSolution, Path, StaticSolution
from spline_model.work import gravity_energy

STATIONS = np.linspace(0.0, 1.0, 61)
"""Where sections are recovered, reference arc length over L; both clamped ends are among them."""


def mechanism_answer(system: System, path: Path, mechanism: Mechanism, laps: Laps) -> MechanismSolution:
    """The answer of a mechanism from the states of its path."""
    states, layout = path.states, system.layout
    row = driven_row(system)
    return MechanismSolution(
        load_factor=path.load_factor,
        bodies={body.name: states[:, layout.body(body.name)] for body in system.scene.bodies},
        torque=np.full(len(states), np.nan) if row is None else states[:, row],
        stiffness=path.stiffness,
        effects=tuple(name for name in mechanism.effects if name not in MOTION_ONLY),
        **_of_any_path(system, path),
        seconds=laps.lap("recover"),
    )


def pivot_answer(system: System, path: Path, laps: Laps) -> StaticSolution:
    """The pivot's answer from the states of its path."""
    states, layout = path.states, system.layout
    constraints = system.scene.of(Constraint)
    i, drive = next((i, c) for i, c in enumerate(constraints) if isinstance(c, DrivenRotation))
    row = layout.rows(i).start
    reactions = [[clamp_reactions(system, states, name, end) for end in ("start", "end")] for name in STRIPS]
    return StaticSolution(
        rotation=path.load_factor * drive.angle,
        load_factor=np.abs(path.load_factor),
        centre=states[:, layout.body(BODY)][:, :2],
        torque=states[:, row],
        stiffness=path.stiffness,
        shear_energy=np.zeros(len(states)),
        clamp_reactions=np.moveaxis(np.array(reactions), 2, 0),
        **_of_any_path(system, path),
        seconds=laps.lap("recover"),
    )


def _of_any_path(system: System, path: Path) -> dict[str, Any]:
    """What a pivot's and a mechanism's answer share, by name."""
    states = path.states
    along = [sections(system, states, strip.name, STATIONS) for strip in system.scene.strips]
    return {
        "status": path.status,
        "message": path.message,
        "bending_energy": path.energies[:, 0],
        "axial_energy": path.energies[:, 1],
        "gravity_energy": gravity_energy(system, states),
        "work": path.work,
        "stations": STATIONS,
        "shape": np.stack([s.shape for s in along], axis=1),
        "axial_force": np.stack([s.axial_force for s in along], axis=1),
        "bending_moment": np.stack([s.bending_moment for s in along], axis=1),
        "shear_force": np.stack([s.shear_force for s in along], axis=1),
        "inertia": path.inertia,
        "moment_defect": path.moment_defect,
        "critical_points": path.critical_points,
        "states": states,
        "counters": path.counters,
        "history": path.history,
    }
