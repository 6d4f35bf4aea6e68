"""Exact sensitivities of any mechanism against differences."""

from dataclasses import replace

import numpy as np
import pytest

from spline_model import BodyDesign, StripDesign, compliant_mechanism, sensitivities, solve_mechanism
from tests import gates
from tests.fe.cases import extrapolated

STEEL = {
    "area": 5e-6,
    "second_moment_of_area": 1.0416667e-12,
    "youngs_modulus": 206e9,
    "density": 7800.0,
}
STRIPS = (
    StripDesign(name="a", start=(0.0, 0.0), end=(0.1, 0.01), tip="b", **STEEL),
    StripDesign(name="c", start=(0.12, 0.01), end=(0.2, 0.05), root="b", tip="d", **STEEL),
    StripDesign(name="e", start=(0.22, 0.06), end=(0.25, 0.0), root="d", tip="ground", **STEEL),
    StripDesign(name="whisker", start=(0.12, -0.01), end=(0.16, -0.05), root="b", **STEEL),
)
BODIES = (
    BodyDesign(name="b", centre=(0.11, 0.0), mass=0.1),
    BodyDesign(name="d", centre=(0.21, 0.05), mass=0.1),
)
LOADS = {
    "gravity": {},
    "applied_moment": {"body": "b", "moment": 0.1},
    "tip_force": {"strip": "whisker", "force": (0.3, 0.5), "moment": 0.01},
    "spring": [
        {"body": "b", "other": "d", "stiffness": (90.0, 50.0), "rotational_stiffness": 0.1},
        {"body": "d", "stiffness": (0.0, 200.0)},
    ],
    "pre_strain": {"curvature": 1.0, "strain": 1e-4},
}
QUANTITIES = ("torque", "stiffness", "centre", "bending_energy", "fibre_stress")
STATIONS = np.linspace(0.0, 1.0, 5)


def solved(strips, bodies, rotation, grid, parameters=("area",)):
    """Sensitivities of the chain of three strips with a whisker."""
    made = compliant_mechanism(
        strips=strips, bodies=bodies, effects=("bending", "stretching", *LOADS), parameters=LOADS, **grid
    )
    path = solve_mechanism(made, body="b", rotation=rotation, increments=3)
    return sensitivities(made, path, parameters=parameters, stations=STATIONS, body="b")


def changed(name, step):
    """Strips and bodies with one number of the design changed by a step."""
    owner, field = name.split(".")

    def moved(part):
        if part.name != owner:
            return part
        if hasattr(part, field):
            return replace(part, **{field: getattr(part, field) + step})
        point, axis = field.split("_")
        place = np.array(getattr(part, point))
        place["xy".index(axis)] += step
        return replace(part, **{point: tuple(place)})

    return [moved(strip) for strip in STRIPS], [moved(body) for body in BODIES]


@pytest.mark.parametrize(
    ("name", "step", "rotation", "grid"),
    [
        ("c.start_x", 2e-3, 0.2, {}),
        ("b.centre_x", 2e-3, None, {}),
    ],
)
def test_any_mechanism_agrees_with_differences(name, step, rotation, grid):
    """A chain of strips with a free end, loaded and on springs, by a section, by an end and by a centre."""
    found, rows = solved(STRIPS, BODIES, rotation, grid, (name,)), []
    for level in range(4):
        h = step / 2**level
        up, down = (solved(*changed(name, sign * h), rotation, grid) for sign in (1, -1))
        rows.append([(getattr(up, q).value - getattr(down, q).value) / (2 * h) for q in QUANTITIES])
    for i, quantity in enumerate(QUANTITIES):
        expected = extrapolated([each[i] for each in rows])
        exact, value = (getattr(getattr(found, quantity), part) for part in ("derivative", "value"))
        if rotation is None and quantity in ("torque", "stiffness"):
            assert np.isnan(exact).all()
            continue
        scale = max(np.abs(expected).max(), 1e-2 * np.abs(value).max())
        gates.check("sensitivities", np.abs(exact[..., 0] - expected).max() / scale)
