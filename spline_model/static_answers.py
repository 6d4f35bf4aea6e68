"""From the states of an equilibrium path to what a user asks for: energies, sections, reactions."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from spline_model.compile import System
from spline_model.continuation.point import driven_row
from spline_model.effects import DrivenRotation
from spline_model.effects.registry import MOTION_ONLY
from spline_model.laps import Laps
from spline_model.sections import clamp_reactions, sections
from spline_model.solution import Path, StaticSolution
from spline_model.work import gravity_energy

STATIONS = np.linspace(0.0, 1.0, 61)
"""Where sections are recovered, reference arc length over L; both clamped ends are among them."""


def static_answer(
    system: System, path: Path, effects: Sequence[str], laps: Laps, *, balanced: bool = False
) -> StaticSolution:
    """The answer of a mechanism with these effects from its path; balanced: see ``Sections``."""
    states, layout, scene = path.states, system.layout, system.scene
    row, along = driven_row(system), sections(system, states, STATIONS, balanced=balanced)
    reactions = np.array(
        [
            [clamp_reactions(system, states, strip.name, end) for end in ("start", "end")]
            for strip in scene.strips
        ]
    )
    return StaticSolution(
        status=path.status,
        message=path.message,
        load_factor=np.abs(path.load_factor),
        bodies={body.name: states[:, layout.body(body.name)] for body in scene.bodies},
        driven=next((drive.body for drive in scene.of(DrivenRotation)), None),
        torque=np.full(len(states), np.nan) if row is None else states[:, row],
        stiffness=path.stiffness,
        bending_energy=path.energies[:, 0],
        axial_energy=path.energies[:, 1],
        gravity_energy=gravity_energy(system, states),
        work=path.work,
        clamp_reactions=reactions.transpose(2, 0, 1, 3),
        stations=STATIONS,
        shape=along.shape,
        axial_force=along.axial_force,
        bending_moment=along.bending_moment,
        shear_force=along.shear_force,
        effects=tuple(name for name in effects if name not in MOTION_ONLY),
        inertia=path.inertia,
        moment_defect=path.moment_defect,
        critical_points=path.critical_points,
        states=states,
        counters=path.counters,
        history=path.history,
        control_points=max((strip.basis.control_points for strip in scene.strips), default=0),
        seconds=laps.lap("recover"),
    )
