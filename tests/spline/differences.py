"""Derivatives of a path by central differences, extrapolated: what the exact ones are held against."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from spline_model import cross_axis_pivot, sensitivities, solve_statics
from tests.models import extrapolated
from tests.table_one import TABLE_ONE

QUANTITIES = (
    "torque",
    "stiffness",
    "centre",
    "body_shift",
    "centre_shift",
    "bending_energy",
    "axial_energy",
    "fibre_stress",
)
STATIONS = np.linspace(0.0, 1.0, 9)
#: First step of the differences over the parameter: a path hardly knows area and modulus beside the shape.
STEPS = {"length": 0.03, "inclination": 0.03, "crossing_ratio": 0.03}
SECTION_STEP = 0.2


def random_design(rng: np.random.Generator) -> dict[str, Any]:
    """A design within what a designer would try, of any size, material and orientation."""
    length = 10.0 ** rng.uniform(-3, 0)
    thickness = length / rng.uniform(8.0, 60.0)
    width = thickness * rng.uniform(0.5, 10.0)
    return TABLE_ONE | {
        "length": length,
        "inclination": np.radians(rng.uniform(25.0, 65.0)),
        "crossing_ratio": rng.uniform(0.1, 0.9),
        "area": thickness * width,
        "second_moment_of_area": thickness**3 * width / 12.0,
        "youngs_modulus": 10.0 ** rng.uniform(9, 11.5),
        "centre_offset": tuple(length * rng.uniform(-0.5, 0.5, 2)),
        "orientation": rng.uniform(-3.0, 3.0),
    }


def exact(
    design: Mapping[str, Any], parameters: tuple[str, ...], rotation: float, grid: Mapping[str, Any]
) -> Any:
    """Exact derivatives along the path to a rotation [rad]."""
    pivot = cross_axis_pivot(**{"control_points": 6} | dict(design) | dict(grid))
    path = solve_statics(pivot, rotation=rotation, increments=6)
    return sensitivities(pivot, path, parameters=parameters, stations=STATIONS)


def changed(design: Mapping[str, Any], name: str, factor: float) -> dict[str, Any]:
    """The design with one parameter, or one side of its section, times a factor."""
    if name in design:
        return {**design, name: design[name] * factor}
    power = {"width": (1, 1), "thickness": (1, 3)}[name]
    both = zip(("area", "second_moment_of_area"), power, strict=True)
    return {**design, **{key: design[key] * factor**k for key, k in both}}


def value_of(design: Mapping[str, Any], name: str) -> float:
    """A design's parameter, or side of its section [m]."""
    if name in design:
        return float(design[name])
    strip = cross_axis_pivot(**design).design.strips[0]
    thickness = math.sqrt(12.0 * strip.second_moment_of_area / strip.area)
    return {"thickness": thickness, "width": strip.area / thickness}[name]


def by_differences(
    design: Mapping[str, Any], name: str, rotation: float, grid: Mapping[str, Any], levels: int = 5
) -> dict[str, np.ndarray]:
    """p dq/dp of every quantity, central differences of halved steps extrapolated ``levels`` - 1 times."""
    rows: dict[str, list[np.ndarray]] = {quantity: [] for quantity in QUANTITIES}
    for level in range(levels):
        step = STEPS.get(name, SECTION_STEP) / 2**level
        up, down = (
            exact(changed(design, name, 1.0 + sign * step), ("length",), rotation, grid) for sign in (1, -1)
        )
        for quantity in QUANTITIES:
            change = getattr(up, quantity).value - getattr(down, quantity).value
            rows[quantity].append(change / (2.0 * step))
    return {quantity: extrapolated(row) for quantity, row in rows.items()}
