"""Wide strips by the laws of either model against the literature: their clamps, and Ashwell's law."""

import numpy as np
import pytest

import fe_reference
import spline_model
from fe_reference import ELEMENTS
from spline_model import DEFAULT_EFFECTS
from tests import gates

#: b/L, Poisson ratio, factors of a constant and of a linear moment: Ritz values of the literature.
KNOWN = [
    (0.1, 0.30, 1.0075, 1.0205),
    (0.2, 0.29, 1.0140, 1.0349),
    (0.25, 0.30, 1.0188, 1.0445),
    (0.5, 0.30, 1.0376, 1.0678),
    (1.0, 0.29, 1.0599, 1.0776),
    (2.0, 0.33, 1.1009, 1.1125),
]
#: b^2 / (R t), factors of moment and stiffness in pure bending at nu = 0.3: Ashwell's law, printed digits.
ASHWELL = [
    (1.0, 1.0029, 1.0085),
    (2.0, 1.0106, 1.0293),
    (5.0, 1.0402, 1.0816),
    (10.0, 1.0634, 1.0854),
    (50.0, 1.0826, 1.0908),
    (1000.0, 1.0953, 1.0971),
]
SLOW = pytest.mark.slow


def strips(models, width, thickness, places=(0.0,), effects=(), parameters=None, nu=0.3, **grid):
    """A stage on parallel strips of unit length at these places."""
    section = {"width": width, "thickness": thickness, "youngs_modulus": 2e11, "poisson_ratio": nu}
    made = [
        models.StripDesign(
            name=f"strip at {y}", start=(0.0, y), end=(1.0, y), tip="stage", density=1.0, **section
        )
        for y in places
    ]
    return models.compliant_mechanism(
        strips=made,
        bodies=[models.BodyDesign(name="stage", centre=(1.0, 0.0))],
        effects=(*DEFAULT_EFFECTS, *effects),
        parameters=parameters or {},
        **grid,
    )


@pytest.mark.parametrize(
    ("gate", "models"),
    [
        ("spline_plate_factors", spline_model),
        pytest.param("fe_plate_factors", fe_reference, marks=SLOW),
    ],
    ids=["spline", "fe"],
)
def test_plate_factors_are_those_of_the_literature(gate, models):
    """Requirement: both factors of a clamped plate are the published ones, to their printed digits."""

    def error(poisson_ratio=0.0):
        found = [models.plate_factors(ratio, nu + poisson_ratio) for ratio, nu, *_ in KNOWN]
        factors = np.array([(each.constant, each.linear) for each in found])
        return np.abs(factors - np.array(KNOWN)[:, 2:]).max()

    gates.hold(gate, error)


@pytest.mark.parametrize(
    ("gate", "models", "grid"),
    [
        ("spline_clamped_guide", spline_model, {"control_points": 9}),
        ("spline_clamped_guide", spline_model, {"control_points": 6, "segments": 2}),
        pytest.param("fe_clamped_guide", fe_reference, {}, marks=SLOW),
    ],
)
def test_clamped_guide_is_as_stiff_as_its_plates(gate, models, grid):
    """Requirement: a parallel guide is stiffer by f_s than its beams."""
    given = {"driven_displacement": {"displacement": (0.0, 1e-6)}}

    def error(effects=("clamped_width",), **coarse):
        guides = [
            strips(models, 0.4, 1e-5, (-0.5, 0.5), (*given, *more), given, **grid | coarse)
            for more in ((), effects)
        ]
        plain, stiffer = (models.solve_mechanism(each, increments=1).bending_energy[-1] for each in guides)
        return abs(stiffer / plain / models.plate_factors(0.4, 0.3).linear - 1.0)

    gates.hold(gate, error)


@pytest.mark.parametrize(
    ("gate", "models", "grid"),
    [("spline_anticlastic", spline_model, {})]
    + [("fe_anticlastic_table", fe_reference, {"element": element}) for element in ELEMENTS],
    ids=["spline", *ELEMENTS],
)
def test_pure_bending_flattens_a_wide_strip(gate, models, grid):
    """Requirement: a strip rolled up by its end has the moment and the stiffness of Ashwell's law."""

    def error(poisson_ratio=0.3):
        found = []
        for flatness, *_ in ASHWELL:
            thickness = 0.3**2 * 0.5 / flatness
            made = strips(models, 0.3, thickness, effects=("anticlastic",), nu=poisson_ratio, **grid)
            path = models.solve_mechanism(made, rotation=0.5, increments=4)
            rigidity = 2e11 * 0.3 * thickness**3 / 12.0
            found.append((path.torque[-1] / (0.5 * rigidity), path.stiffness[-1] / rigidity))
        return np.abs(np.array(found) - np.array(ASHWELL)[:, 1:]).max()

    gates.hold(gate, error)
