"""The models of the work-precision diagrams: a series of settings each, from coarse to fine.

In motion all have strips without shear and without rotary inertia of their sections: two theories would be
3e-2 rad apart after 0.05 s, more than any mesh here.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from studies.answers.settings import FeSettings, SplineSettings
from studies.baselines.exudyn_strips import exudyn_ancf, exudyn_exact
from studies.baselines.openseespy import openseespy_frame
from studies.baselines.pseudo_rigid import four_bar, linear_pivot, pin_joint
from studies.record.style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, RED, SKY, YELLOW, Look
from studies.work_precision.members import Member, moving, moving_baseline, of_baseline, of_settings

SPLINE, ITSELF = "spline", "spline, by itself"
ELEMENTS, SHEAR = "finite elements", "finite elements with shear"
IMPLICIT = "spline, energy-consistent"
COUNTS = range(4, 13)
BSPLINE_COUNTS = (4, 6, 8, 12, 16, 24, 32, 48, 64)
MESHES = (5, 10, 20, 40, 80, 160)

#: In motion: control points of the splines that take explicit steps of their own choice, near the largest
#: stable one; control points and steps [s] of those that take large implicit steps; meshes.
MOVING_COUNTS = (4, 5, 6, 7, 8, 9, 10, 12)
IMPLICIT_COUNTS, STEPS = (4, 5, 6, 8), (2e-4, 1e-4, 5e-5, 2e-5)
MOVING_MESHES = (5, 10, 16, 24, 36)


@dataclass(frozen=True, kw_only=True)
class Series:
    """One model from coarse to fine.

    Attributes:
        name: of the model, in tables.
        theory: key of `paths.THEORIES` that its answers tend to.
        look: label, colour, line and marker in figures.
        members: settings, the coarsest first.
        repeat: timed solves of each path [1].
    """

    name: str
    look: Look
    members: tuple[Member, ...]
    theory: str = "material"
    repeat: int = 7


@dataclass(frozen=True, kw_only=True)
class _Other:
    """A baseline in the diagrams.

    Attributes:
        meshes, moving_meshes: elements a strip, none for what has no refinement; steps: [s], none for what
            has no motion here.
    """

    baseline: Any
    look: Look
    theory: str = "material"
    meshes: tuple[int, ...] = ()
    moving_meshes: tuple[int, ...] = ()
    steps: tuple[float, ...] = (1e-4,)


OTHERS = (
    _Other(baseline=linear_pivot, look=Look(label="linear closed form", colour=GREY, line="", marker="P")),
    _Other(
        baseline=pin_joint, look=Look(label="pseudo-rigid: pin joint", colour=YELLOW, line="", marker="*")
    ),
    _Other(baseline=four_bar, look=Look(label="pseudo-rigid: four-bar", colour=RED, line="", marker="X")),
    _Other(
        baseline=exudyn_ancf, look=Look(label="Exudyn, ANCF cable", colour=PURPLE, marker="^"),
        meshes=(2, 4, 8, 16, 32), moving_meshes=(4, 8), steps=(2e-4, 1e-4, 5e-5, 2e-5, 1e-5, 5e-6),
    ),
    _Other(
        baseline=exudyn_exact, look=Look(label="Exudyn, exact beam", colour=PURPLE, line=":", marker="v"),
        theory="shear", meshes=(2, 4, 8, 16, 32), steps=(),
    ),
    _Other(
        baseline=openseespy_frame,
        look=Look(label="OpenSees, corotational", colour=ORANGE, line="--", marker="<"),
        meshes=(10, 20, 40, 80), moving_meshes=(20,), steps=(1e-4, 5e-5, 2e-5),
    ),
)  # fmt: skip


def own_series() -> list[Series]:
    """Return the series of the two models of the suite, for paths."""
    return [
        splines(SPLINE, Look(label="spline", colour=BLUE, marker="x")),
        splines(
            "spline, one axial mode more",
            Look(label="spline, m = n - 1", colour=SKY, line=":", marker="D"), modes=1,
        ),
        splines(
            "B-spline", Look(label="cubic B-spline", colour=GREEN, line="-.", marker="o"),
            counts=BSPLINE_COUNTS, basis="bspline",
        ),
        splines(
            "spline, spatial measure",
            Look(label="spline, spatial measure", colour=BLUE, line="--", marker="+"), measure="spatial",
        ),
        splines(
            "spline as the paper", Look(label="spline, as the paper", colour=RED, line="--", marker="o"),
            measure="spatial", stretch="consistent",
        ),
        _elements(ELEMENTS, "corotational", Look(label="finite elements", colour=BLACK, marker="s")),
        _elements(
            SHEAR, "reissner", Look(label="finite elements, shear", colour=GREY, line="--", marker="s")
        ),
    ]  # fmt: skip


def by_itself(accuracy: float) -> Series:
    """Return the spline that finds its own control points for an accuracy, as `solve` does."""
    member = of_settings(SplineSettings(), f"accuracy {accuracy:g}", 0, accuracy=accuracy)
    return Series(name=ITSELF, look=Look(label=ITSELF, colour=BLUE), members=(member,))


def splines(
    name: str,
    look: Look,
    *,
    counts: tuple[int, ...] | range = COUNTS,
    modes: int | None = None,
    measure: str = "material",
    **settings: Any,
) -> Series:
    """Return a series of splines; `modes`: axial modes less n - 2, None for the default."""
    members = []
    for n in counts:
        axial = None if modes is None else n - 2 + modes
        setting = SplineSettings(control_points=n, axial_modes=axial, measure=measure, **settings)
        members.append(of_settings(setting, f"n = {n}", n))
    return Series(name=name, theory=measure, look=look, members=tuple(members), repeat=15)


def _elements(name: str, element: str, look: Look) -> Series:
    members = (of_settings(FeSettings(elements=e, element=element), f"{e} elements", e) for e in MESHES)
    theory = "material" if element == "corotational" else "shear"
    return Series(name=name, theory=theory, look=look, members=tuple(members))


def other_series() -> list[Series]:
    """Return the surrogate models and the other codes that are installed, for paths."""
    return [
        Series(
            name=each.baseline.model,
            theory=each.theory,
            look=each.look,
            members=tuple(of_baseline(each.baseline, f"{e} elements", e, elements=e) for e in each.meshes)
            or (of_baseline(each.baseline, "closed form", 1),),
        )
        for each in OTHERS
        if each.baseline.installed()
    ]


def moving_series(scale: float = 1.0) -> list[Series]:
    """Return the series of the two models of the suite in motion, the implicit steps times `scale` [1]."""
    explicit = (
        moving(SplineSettings(control_points=n), f"n = {n}", integrator="leapfrog") for n in MOVING_COUNTS
    )
    implicit = (
        moving(
            SplineSettings(control_points=n),
            f"n = {n}, {1e6 * scale * step:.3g} µs",
            f"n = {n}",
            step=scale * step,
        )
        for n in IMPLICIT_COUNTS
        for step in STEPS
    )
    meshes = (moving(FeSettings(elements=e), f"{e} elements") for e in MOVING_MESHES)
    return [
        Series(
            name=SPLINE, look=Look(label="spline, leapfrog", colour=BLUE, marker="x"),
            members=(*explicit,),
        ),
        Series(
            name=IMPLICIT, look=Look(label="spline, energy-consistent", colour=SKY, line=":", marker="D"),
            members=(*implicit,),
        ),
        Series(
            name=ELEMENTS, look=Look(label="finite elements, central difference", colour=BLACK, marker="s"),
            members=(*meshes,),
        ),
    ]  # fmt: skip


def moving_others(scale: float = 1.0) -> list[Series]:
    """Return the surrogates and other codes that are installed, in motion, all steps times `scale` [1]."""
    return [
        Series(name=each.baseline.model, look=each.look, members=tuple(_moving_members(each, scale)))
        for each in OTHERS
        if each.steps and each.baseline.installed()
    ]


def _moving_members(each: _Other, scale: float) -> Iterator[Member]:
    for step in (scale * step for step in each.steps):
        if not each.moving_meshes:
            yield moving_baseline(each.baseline, "closed form", "all", step)
        for e in each.moving_meshes:
            setting = f"{e} elements, {1e6 * step:.3g} µs"
            yield moving_baseline(each.baseline, setting, f"{e} elements", step, elements=e)


def looks(own: list[Series]) -> dict[str, Look]:
    """Return the look of the suite's own series and of all others by name, installed or not."""
    return {each.name: each.look for each in own} | {each.baseline.model: each.look for each in OTHERS}
