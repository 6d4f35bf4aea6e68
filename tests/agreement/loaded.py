"""A pivot and mechanisms under loads, put to both models: what the tests of loads ask and compare."""

from dataclasses import dataclass
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


@dataclass(frozen=True, kw_only=True)
class State:
    """The last state of a static path: what both models must agree on.

    torque [N m]; stiffness [N m/rad]; place (3,) of the body [m, m, rad]; moments (G, 2) of the clamps on
    the strips' roots and tips [N m]; axial (G, 2) forces there [N]; energy of strain and weight, from rest
    [J]; path (S, 3) of the body.
    """

    torque: float
    stiffness: float
    place: np.ndarray
    moments: np.ndarray
    axial: np.ndarray
    energy: float
    path: np.ndarray


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


def state(asked: Design, settings: Settings) -> State:
    """Return the last state of the path of `asked`."""
    found, fields = solution(asked, settings)
    path = np.asarray(fields.bodies)[:, 0]
    shear = getattr(found, "shear_energy", 0.0)
    energy = found.bending_energy + found.axial_energy + shear + found.gravity_energy
    return State(
        torque=float(found.torque[-1]),
        stiffness=float(found.stiffness[-1]),
        place=path[-1],
        moments=np.asarray(fields.reactions)[-1, :, :, 2],
        axial=np.asarray(fields.axial_force)[-1][:, [0, -1]],
        energy=float(energy[-1]),
        path=path,
    )


def extrapolated(coarse: State, fine: State) -> State:
    """Return the limit of elements of which `fine` has twice as many, whose error goes with h^2."""
    names = State.__dataclass_fields__
    return State(**{n: (4.0 * getattr(fine, n) - getattr(coarse, n)) / 3.0 for n in names})


def differences(one: State, other: State) -> dict[str, float]:
    """Return the largest differences over EI/L, EI/L^2 and L, by quantity [1]."""
    unit = {
        "torque": MOMENT_UNIT,
        "stiffness": MOMENT_UNIT,
        "path": np.array([LENGTH, LENGTH, 1.0]),
        "moments": MOMENT_UNIT,
        "axial": FORCE_UNIT,
        "energy": MOMENT_UNIT,
    }
    return {
        name: float(np.max(np.abs(getattr(one, name) - getattr(other, name)) / scale))
        for name, scale in unit.items()
    }


@cache
def spline(effect: str, rotation: float | None, control_points: int = 10) -> State:
    """Return the state of the loaded design by the spline."""
    return state(design(effect, rotation), SplineSettings(control_points=control_points))


@cache
def elements(effect: str, rotation: float | None, count: int = 20) -> State:
    """Return the same by the finite elements."""
    return state(design(effect, rotation), FeSettings(elements=count))
