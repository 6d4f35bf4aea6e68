"""From the states of an equilibrium path to what a user asks for: energies, sections, reactions."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.effects import DrivenRotation
from spline_model.effects.registry import MOTION_ONLY
from spline_model.errors import ConvergenceError
from spline_model.newton import Laps
from spline_model.sections import centre_lines
from spline_model.solution import Path, StaticSolution, Status

Array = NDArray[np.float64]


def static_answer(
    system: System, path: Path, effects: Sequence[str], laps: Laps, *, balanced: bool = False
) -> StaticSolution:
    """The answer of a mechanism with these effects from its path; balanced: see ``Sections``."""
    scene, turns = system.scene, system.drives.turns.tolist()
    driven = next((drive.body for drive in scene.of(DrivenRotation)), None)
    return StaticSolution(
        status=path.status,
        message=path.message,
        load_factor=path.load_factor if driven is None else np.abs(path.load_factor),
        bodies={body.name: path.bodies[:, 3 * i : 3 * i + 3] for i, body in enumerate(scene.bodies)},
        driven=driven,
        torque=path.reactions[:, turns.index(1)] if 1 in turns else np.full(len(path.work), np.nan),
        stiffness=path.stiffness,
        bending_energy=path.energies[:, 0],
        axial_energy=path.energies[:, 1],
        shear_energy=path.energies[:, 2:].sum(axis=1),
        gravity_energy=_gravity_energy(system, path),
        work=path.work,
        system=system,
        unknowns=path.unknowns,
        balanced=balanced,
        effects=tuple(name for name in effects if name not in MOTION_ONLY),
        inertia=path.inertia,
        moment_defect=path.moment_defect,
        critical_points=path.critical_points,
        counters=path.counters,
        history=path.history,
        control_points=max((strip.basis.control_points for strip in scene.strips), default=0),
        seconds=laps.lap("recover"),
    )


def _gravity_energy(system: System, path: Path) -> Array:
    """Potential of the dead weight against the state at rest, (S,) [J]; zero without gravity."""
    weight = system.weight
    if not weight.size:
        return np.zeros(len(path.work))
    states = centre_lines(system, path.states)
    return np.asarray(-(states[:, : weight.size] - system.rest[: weight.size]) @ weight)


def checked(solution: StaticSolution, raise_on_failure: bool) -> StaticSolution:
    """The answer itself; raises ConvergenceError with it where it did not converge and that is asked for."""
    if raise_on_failure and solution.status is not Status.CONVERGED:
        raise ConvergenceError(
            solution.message,
            solution=solution,
            load_factor=float(solution.load_factor[-1]),
            history=solution.history,
        )
    return solution
