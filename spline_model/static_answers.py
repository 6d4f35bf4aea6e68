"""From the states of an equilibrium path to what a user asks for: energies, sections, reactions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from spline_model.body_stiffness import body_stiffness
from spline_model.compile import System
from spline_model.effects import DrivenRotation
from spline_model.effects.registry import MOTION_ONLY
from spline_model.laps import Laps
from spline_model.sections import Sections, clamp_reactions, sections
from spline_model.solution import Later, Path, StaticSolution

Array = NDArray[np.float64]

STATIONS = np.linspace(0.0, 1.0, 61)
"""Where sections are recovered, reference arc length over L; both clamped ends are among them."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Along:
    """What the states of a system are along its strips, made when it is first asked for.

    unknowns (S, N): z of the states; balanced: see ``Sections``.
    """

    system: System
    unknowns: Later
    balanced: bool

    @property
    def stations(self) -> Array:
        """Where sections are recovered (P,)."""
        return STATIONS

    @cached_property
    def sections(self) -> Sections:
        """Shapes and section forces."""
        return sections(self.system, self.unknowns.array, STATIONS, balanced=self.balanced)

    @cached_property
    def clamp_reactions(self) -> Array:
        """Of root and tip of the strips (S, G, 2, 3) [N, N, N m]."""
        by_strip = [
            [clamp_reactions(self.system, self.unknowns.array, strip.name, end) for end in ("start", "end")]
            for strip in self.system.scene.strips
        ]
        return np.asarray(np.array(by_strip).transpose(2, 0, 1, 3))

    def body_stiffness(self, body: str) -> Array:
        """Of a body by its name (S, 3, 3)."""
        return body_stiffness(self.system, self.unknowns.array, body)


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
        gravity_energy=_gravity_energy(system, path),
        work=path.work,
        along=Along(system=system, unknowns=path.unknowns, balanced=balanced),
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
    return np.asarray(-(path.states[:, : weight.size] - system.rest[: weight.size]) @ weight)
