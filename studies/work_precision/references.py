"""How certain the limits are that paths and swings are held against, and how far the theories are apart."""

import math
from typing import Any

import numpy as np

from studies.answers.adapters import answer_release
from studies.answers.metrics import swing_frequency
from studies.answers.reference import QUANTITIES
from studies.answers.settings import SplineSettings
from studies.baselines.own import FINE_RECORDS
from studies.cases.problem import named_case
from studies.engine import Part, Row, Study
from studies.paper.formulations import DURATION, INSTANTS
from studies.work_precision.limits import at, limit_of_theory, path_errors

#: Theories of a strip, by what their energies are measured in: bending per reference length without shear,
#: per current length as the paper's Eq 10, and per reference length with shear.
THEORIES = ("material", "spatial", "shear")
#: Leapfrog splines by control points and step [s], the coarser one first.
SWINGS = {14: 4e-7, 16: 3e-7}


def _paths() -> list[Row]:
    """Return, of each theory and quantity, the limit's uncertainty and its distance to the material one."""
    problem = named_case()
    limits = {theory: limit_of_theory(problem, theory) for theory in THEORIES}
    rows: list[Row] = []
    for theory, found in limits.items():
        apart = path_errors(found.path, limits["material"].path)
        rows += [
            {
                "theory": theory,
                "quantity": name,
                "uncertainty": found.uncertainty[name],
                "distance_to_material": apart[f"error_{name}"] if theory != "material" else math.nan,
                "source": found.source,
            }
            for name in QUANTITIES
        ]
    return rows


def _swings() -> list[Row]:
    """Return how far the two finest swings from 90 degrees are apart, in rotation and frequency."""
    rotations: list[Any] = []
    for n, step in SWINGS.items():
        motion = answer_release(
            named_case(), SplineSettings(control_points=n), duration=DURATION, records=FINE_RECORDS,
            integrator="leapfrog", step=step,
        )  # fmt: skip
        rotations.append(at(motion, INSTANTS))
    coarse, fine = rotations
    frequencies = [swing_frequency(INSTANTS, rotation).value for rotation in rotations]
    source = " and ".join(f"n = {n} at {1e6 * step:g} µs" for n, step in SWINGS.items())
    values = {
        "rotation_rad": float(np.abs(fine - coarse).max()),
        "frequency": abs(frequencies[0] / frequencies[1] - 1.0),
    }
    return [{"quantity": name, "uncertainty": value, "source": source} for name, value in values.items()]


STUDY = Study(
    parts=(
        Part(ask=lambda: {"paths": _paths()}),
        Part(ask=lambda: {"swings": _swings()}),
    ),
    figures={},
)
