"""Where the theory of the charts ends: what a plain beam leaves out of a strip's stiffness."""

import numpy as np
from scipy.optimize import brentq

from spline_model.effects.plate import plate_factors
from studies.answers.adapters import answer_static
from studies.answers.settings import FeSettings, SplineSettings
from studies.answers.validity import Strip
from studies.cases.problem import named_case
from studies.engine.study import Answer

#: Pivots that are marked where the theory ends.
PIVOTS = (
    "cross_axis_pivot",
    "spring_steel_pivot",
    "titanium_pivot",
    "polymer_pivot",
    "silicon_pivot",
    "large_steel_pivot",
)
#: Control points of the splines, and elements a strip by which shear is weighed.
POINTS, ELEMENTS = 10, 160


def judged(name: str) -> Answer:
    """Return where a pivot of the suite lies, and what a beam leaves out of its stiffness over its range."""
    problem = named_case(name)
    answer = answer_static(problem, SplineSettings(control_points=POINTS))
    shear, plain = (
        answer_static(problem, FeSettings(elements=ELEMENTS, element=element)).torque[-1]
        for element in ("reissner", "corotational")
    )
    strip = Strip(
        length=problem.length,
        thickness=problem.depth,
        width=problem.area / problem.depth,
        youngs_modulus=problem.youngs_modulus,
        poisson_ratio=problem.poisson_ratio,
        density=problem.density,
        curvature=float(np.abs(answer.bending_moment).max())
        / (problem.youngs_modulus * problem.second_moment_of_area),
    )
    return {
        "validity": {
            "pivot": name,
            "rotation_deg": np.degrees(problem.rotation),
            "thickness_ratio": strip.thickness_ratio,
            "width_ratio": strip.width_ratio,
            "curvature_ratio": strip.curvature_ratio,
            "clamped_least": float(strip.clamped[0]),
            "clamped_most": float(strip.clamped[1]),
            "flattened": float(strip.flattened),
            "roots": -strip.turned_roots,
            "shear": shear / plain - 1.0,
        }
    }


def _strip(thickness: float = 0.005, curved: float = 0.0) -> Strip:
    """Return a strip of unit length and a tenth as wide by its ratios; `curved` is b^2/(R t)."""
    return Strip(
        length=1.0,
        thickness=thickness,
        width=0.1,
        youngs_modulus=1.0,
        poisson_ratio=0.3,
        density=1.0,
        curvature=curved * thickness / 0.1**2,
    )


#: Ratio -> what of it a plain beam leaves out of the stiffness, and the range that is searched.
LEFT_OUT = {
    "width_ratio": (lambda ratio: plate_factors(ratio, 0.3).linear - 1.0, (0.02, 1.5)),
    "thickness_ratio": (lambda ratio: _strip(thickness=ratio).turned_roots, (1e-4, 0.5)),
    "curvature_ratio": (lambda ratio: float(_strip(curved=ratio).flattened), (0.01, 40.0)),
}


def limits() -> Answer:
    """Return the ratios at which what a plain beam leaves out is a share of the stiffness."""
    return {
        "limits": [
            {"ratio": name, "share": share, "value": brentq(lambda x, of=of, s=share: of(x) - s, *ends)}
            for name, (of, ends) in LEFT_OUT.items()
            for share in (0.01, 0.05)
        ]
    }
