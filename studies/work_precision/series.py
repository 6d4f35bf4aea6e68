"""The models that are advised on: a series of settings each, from coarse to fine.

In motion all have strips without shear and without rotary inertia of their sections: two theories would be
3e-2 rad apart after 0.05 s, more than any mesh here.
"""

from studies.baselines.exudyn_strips import exudyn_ancf, exudyn_exact
from studies.baselines.openseespy import openseespy_frame
from studies.baselines.own import elements, spline
from studies.baselines.pseudo_rigid import four_bar, linear_pivot, pin_joint
from studies.baselines.variant import Baseline, Variant, grid

SPLINE, ITSELF = spline.model, "spline, by itself"
ELEMENTS, SHEAR = elements.model, "finite elements with shear"
IMPLICIT = "spline, energy-consistent"

#: Elements a strip of the paths of the others; what has none is in closed form.
MESHES: dict[Baseline, dict[str, tuple[int, ...]]] = {
    linear_pivot: {},
    pin_joint: {},
    four_bar: {},
    exudyn_ancf: {"elements": (2, 4, 8, 16, 32)},
    exudyn_exact: {"elements": (2, 4, 8, 16, 32)},
    openseespy_frame: {"elements": (10, 20, 40, 80)},
}
#: Steps [s] and elements a strip of their motions.
STEPS: dict[Baseline, dict[str, tuple[float, ...]]] = {
    linear_pivot: {"step": (1e-4,)},
    pin_joint: {"step": (1e-4,)},
    four_bar: {"step": (1e-4,)},
    exudyn_ancf: {"step": (2e-4, 1e-4, 5e-5, 2e-5, 1e-5, 5e-6), "elements": (4, 8)},
    openseespy_frame: {"step": (1e-4, 5e-5, 2e-5), "elements": (20,)},
}


def own_paths(counts: range) -> list[Variant]:
    """Return the settings of the two models of the suite, for paths; `counts`: control points."""
    meshes = (5, 10, 20, 40, 80, 160)
    return [
        *grid(spline, SPLINE, control_points=counts),
        *grid(elements, ELEMENTS, elements=meshes),
        *grid(elements, SHEAR, elements=meshes, element=("reissner",)),
    ]


def other_paths() -> list[Variant]:
    """Return those of the surrogate models and the other codes that are installed."""
    there = ((each, axes) for each, axes in MESHES.items() if each.installed())
    return [variant for each, axes in there for variant in grid(each, each.model, **axes)]


def own_swings(scale: float = 1.0) -> list[Variant]:
    """Return the settings of the two models of the suite in motion.

    Splines take explicit steps of their own choice, near the largest stable one, or large implicit ones.

    Args:
        scale: of the implicit steps [1].
    """
    steps = [scale * step for step in (2e-4, 1e-4, 5e-5, 2e-5)]
    explicit = (4, 5, 6, 7, 8, 9, 10, 12)
    return [
        *grid(spline, SPLINE, control_points=explicit, integrator=("leapfrog",)),
        *grid(spline, IMPLICIT, control_points=(4, 5, 6, 8), step=steps),
        *grid(elements, ELEMENTS, elements=(5, 10, 16, 24, 36)),
    ]


def other_swings(scale: float = 1.0) -> list[Variant]:
    """Return those of the surrogates and other codes that are installed, all steps times `scale` [1]."""
    there = ((each, axes) for each, axes in STEPS.items() if each.installed())
    return [
        variant
        for each, axes in there
        for variant in grid(each, each.model, **axes | {"step": tuple(scale * s for s in axes["step"])})
    ]
