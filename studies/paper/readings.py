"""What the paper leaves open: how it integrates, where the centre of mass lies, gravity and damping.

Coarser and finer quadratures of four control points as the paper has them, and what each open assumption
changes of its Figs 4 and 6: the travel of the body's centre, the frequency after the release and the
rotation itself.
"""

from collections.abc import Iterator
from dataclasses import replace
from math import pi, sin

import numpy as np
from matplotlib.figure import Figure

from studies.answers.adapters import answer_release, answer_static
from studies.answers.metrics import swing_frequency
from studies.answers.motion import Motion
from studies.answers.settings import SplineSettings
from studies.cases.effects import Effects
from studies.cases.problem import Problem, named_case
from studies.engine.study import Answer, Part, Study, Tables
from studies.paper.formulations import DURATION, INSTANTS, refined
from studies.record.panels import Axis, Curves, Panel, sheet
from studies.record.style import ORANGE, RED, Look

#: Gauss points of the paper's four control points: two do not see every stretch, the last are all but exact.
GAUSS = (3, 4, 5, 6, 8, 12)
#: Control points of what the assumptions are weighed with.
POINTS = 8
#: Share of critical damping of the swing.
DAMPING = 0.01
AS_READ = "midway between the upper clamps"


def _integrated(points: int) -> Answer:
    """Return the errors of the paper's formulation with so many Gauss points."""
    settings = SplineSettings(control_points=4, measure="spatial", stretch="consistent", gauss_points=points)
    path, limit = answer_static(named_case(), settings), refined()
    torque, stiffness = path.torque[1:] / limit.torque[1:] - 1.0, path.stiffness / limit.stiffness - 1.0
    row = {
        "gauss_points": points,
        "status": path.status,
        "error_torque": float(np.abs(torque).max()),
        "error_stiffness": float(np.abs(stiffness).max()),
        "error_stiffness_end": float(stiffness[-1]),
    }
    return {"quadrature": row}


def _readings() -> Iterator[tuple[str, Problem]]:
    """Yield other readings of the case, that of the suite first."""
    case = named_case()
    yield AS_READ, case
    rise = (1.0 - case.crossing_ratio) * case.length * sin(case.inclination)
    for name, offset in (("at the crossing", -rise), ("as far above the upper clamps", rise)):
        yield f"centre of mass {name}", replace(case, centre_offset=(0.0, offset))
    yield (
        "gravity, the ground below",
        replace(case, effects=case.effects.renamed([*case.effects.names, "gravity"])),
    )
    frequency = swing_frequency(INSTANTS, _swing(case)).value
    lost = 2.0 * DAMPING * 2.0 * pi * frequency * case.body_moment_of_inertia
    damped = Effects(
        names=(*case.effects.names, "body_damping"),
        tables={"body_damping": {"translation": 0.0, "rotation": lost}},
    )
    yield f"damping, {DAMPING:.0%} of critical in the swing", replace(case, effects=damped)


def _swing(problem: Problem) -> np.ndarray:
    motion: Motion = answer_release(
        problem, SplineSettings(control_points=POINTS), duration=DURATION, records=len(INSTANTS) - 1,
        integrator="energy", step=DURATION / (10 * (len(INSTANTS) - 1)),
    )  # fmt: skip
    return np.interp(INSTANTS, motion.time, motion.rotation)


def _read() -> Answer:
    """Return a row a reading: travel of the centre [mm], frequency, and the rotation's largest difference."""
    rows, first = [], None
    for name, problem in _readings():
        path, swing = answer_static(problem, SplineSettings(control_points=POINTS)), _swing(problem)
        first = swing if first is None else first
        rows.append(
            {
                "reading": name,
                "travel_m": float(np.hypot(*(path.centre[-1] - path.centre[0]))),
                "torque_end_Nm": float(path.torque[-1]),
                "frequency_Hz": swing_frequency(INSTANTS, swing).value,
                "rotation_rad": float(np.abs(swing - first).max()),
            }
        )
    return {"readings": rows}


def _figure(tables: Tables) -> Figure:
    """Draw the errors of torque and stiffness over the number of Gauss points."""
    looks = {
        "error_torque": Look(label="torque", colour=RED, marker="o"),
        "error_stiffness": Look(label="stiffness", colour=ORANGE, line="--", marker="s"),
    }
    panel = Panel(
        Axis("gauss_points", "Gauss points a strip"),
        Axis("error_torque", "largest error [1]", log=True),
        [Curves(tables["quadrature"], look, y=column) for column, look in looks.items()],
        legend="best",
    )
    return sheet(4.0, 2.4, [[panel]])


STUDY = Study(
    parts=(Part(at=lambda: GAUSS, ask=_integrated), Part(ask=_read)),
    figures={"readings": _figure},
)
