"""A pivot and mechanisms under loads, put to both models: what the tests of loads ask and compare."""

from functools import cache
from typing import Any

import numpy as np

from studies.answers.models import put
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.design import Design
from studies.cases.effects import DEFAULT, Effects
from studies.cases.mechanism import Body, Mechanism, Strip
from studies.cases.problem import Problem

#: A polymer, 10 mm x 5 mm: EI/L^2 is 29 N and EI/L 2.5 N m.
SECTION: dict[str, float] = {
    "area": 5e-5,
    "second_moment_of_area": 1.0416667e-10,
    "youngs_modulus": 2e9,
    "poisson_ratio": 0.35,
    "density": 1200.0,
}
BODY_MASS, BODY_MOMENT_OF_INERTIA = 1.0, 1e-3
LENGTH, INCLINATION, CROSSING_RATIO = 0.085, float(np.radians(50.0)), 0.4
#: Of the body's centre from the middle of the strips' tips; the second is at the strips' crossing.
ECCENTRIC = (0.01, -0.015)
CROSSING = (0.0, -(1.0 - CROSSING_RATIO) * LENGTH * float(np.sin(INCLINATION)))
MOMENT_UNIT = SECTION["youngs_modulus"] * SECTION["second_moment_of_area"] / LENGTH
FORCE_UNIT = MOMENT_UNIT / LENGTH
ROTATION, INCREMENTS = float(np.radians(12.0)), 5

#: Each effect with parameters that change torque or stiffness by a tenth and more.
LOADS: dict[str, dict[str, Any]] = {
    "applied_force": {"force": (15.0, 11.0)},
    "applied_moment": {"moment": 0.75},
    "tip_force": {"strip": "whisker", "force": (-8.0, 8.0)},
    "gravity": {"acceleration": (5.0, -9.81)},
    "pre_strain": {"curvature": 3.0, "strain": 1e-4},
    "driven_displacement": {"displacement": (4e-4, -3e-4)},
}


def angle(rotation: float | None) -> str:
    """Return the name of a rotation among the tests."""
    return "free" if rotation is None else f"{np.degrees(rotation):+.0f}deg"


def scene(*loads: str, **parameters: dict[str, Any]) -> Effects:
    """Return the usual effects and these loads, with parameters changed by name of the load."""
    tables = {name: LOADS[name] | parameters.get(name, {}) for name in loads}
    return Effects(names=(*DEFAULT, *loads), tables=tables)


def pivot(effects: Effects, rotation: float = ROTATION, increments: int = INCREMENTS) -> Problem:
    """Return a pivot that is symmetric in nothing, or one that may be led at its crossing."""
    return Problem(
        length=LENGTH,
        inclination=INCLINATION,
        crossing_ratio=CROSSING_RATIO,
        **SECTION,
        body_mass=BODY_MASS,
        body_moment_of_inertia=BODY_MOMENT_OF_INERTIA,
        centre_offset=CROSSING if "driven_displacement" in effects.names else ECCENTRIC,
        rotation=rotation,
        increments=increments,
        order="together",
        effects=effects,
    )


def whiskered(effects: Effects, rotation: float | None = ROTATION, increments: int = INCREMENTS) -> Mechanism:
    """Return a body on two crossed strips with a third that it bears, whose tip is free."""
    ends = {
        "left": ((0.0, 0.0), (0.06, 0.06), "ground", "body"),
        "right": ((0.06, 0.0), (0.0, 0.06), "ground", "body"),
        "whisker": ((0.03, 0.07), (0.03, 0.14), "body", None),
    }
    return Mechanism(
        strips=tuple(
            Strip(name=name, start=start, end=end, root=root, tip=tip, **SECTION)
            for name, (start, end, root, tip) in ends.items()
        ),
        bodies=(
            Body(
                name="body", centre=(0.035, 0.065), mass=BODY_MASS, moment_of_inertia=BODY_MOMENT_OF_INERTIA
            ),
        ),
        body="body",
        rotation=rotation,
        increments=increments,
        order="together",
        effects=effects,
    )


def design(effect: str, rotation: float | None = ROTATION, **parameters: Any) -> Design:
    """Return the pivot under one load, or what has a free tip and follows loads alone."""
    effects = scene(effect, **{effect: parameters})
    if effect == "tip_force" or rotation is None:
        return whiskered(effects, rotation)
    return pivot(effects, rotation)


def solution(asked: Design, settings: Settings) -> tuple[Any, Any]:
    """Return the model's own answer for the static path, and its fields along the strips."""
    posed = put(asked, settings)
    found = posed.static_path()
    return found, posed.fields(found, found.states, "static")


@cache
def state(asked: Design, settings: Settings) -> dict[str, np.ndarray]:
    """Return the last state of the path of `asked`: what both models must agree on.

    torque [N m]; stiffness [N m/rad]; moments (G, 2) of the clamps on the strips' roots and tips [N m]; axial
    (G, 2) forces there [N]; energy of strain and weight, from rest [J]; path (S, 3) of the body [m, m, rad].
    """
    found, fields = solution(asked, settings)
    energy = found.bending_energy + found.axial_energy + getattr(found, "shear_energy", 0.0)
    return {
        "torque": found.torque[-1],
        "stiffness": found.stiffness[-1],
        "moments": np.asarray(fields.reactions)[-1, :, :, 2],
        "axial": np.asarray(fields.axial_force)[-1][:, [0, -1]],
        "energy": (energy + found.gravity_energy)[-1],
        "path": np.asarray(fields.bodies)[:, 0],
    }


def apart(asked: Design, control_points: int = 10) -> dict[str, float]:
    """Return how far splines are from the limit of two meshes, over EI/L, EI/L^2 and L, by quantity [1]."""
    coarse, fine = (state(asked, FeSettings(elements=count)) for count in (10, 20))
    units = dict.fromkeys(coarse, np.array(MOMENT_UNIT))
    units |= {"axial": np.array(FORCE_UNIT), "path": np.array([LENGTH, LENGTH, 1.0])}
    limits = {name: (4.0 * fine[name] - coarse[name]) / 3.0 for name in fine}
    found = state(asked, SplineSettings(control_points=control_points))
    return {name: float(np.abs((found[name] - limits[name]) / units[name]).max()) for name in found}
