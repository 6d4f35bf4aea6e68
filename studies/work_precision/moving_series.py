"""The models of the dynamic work-precision diagram: settings and steps of each.

All have strips without shear and without rotary inertia of their sections: two theories would be 3e-2 rad
apart after 0.05 s, more than any mesh here.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from types import ModuleType

from studies.answers.settings import FeSettings, SplineSettings
from studies.baselines import four_bar, linear_pivot, pin_joint
from studies.baselines.peers import exudyn_ancf, openseespy_frame
from studies.record.style import BLACK, BLUE, GREY, ORANGE, PURPLE, RED, SKY, YELLOW, Look
from studies.work_precision.motions import MovingMember, moving, moving_baseline

SPLINE, IMPLICIT, ELEMENTS = "spline", "spline, energy-consistent", "finite elements"

#: Control points of the splines that take explicit steps of their own choice, near the largest stable one.
COUNTS = (4, 5, 6, 7, 8, 9, 10, 12)
#: Control points and steps [s] of those that take large implicit steps.
IMPLICIT_COUNTS, STEPS = (4, 5, 6, 8), (2e-4, 1e-4, 5e-5, 2e-5)
MESHES = (5, 10, 16, 24, 36)
PEER_STEPS = (2e-4, 1e-4, 5e-5, 2e-5, 1e-5, 5e-6)
FRAME_STEPS = (1e-4, 5e-5, 2e-5)
CLOSED_STEP = 1e-4


@dataclass(frozen=True, kw_only=True)
class MovingSeries:
    """One model and integrator.

    Attributes:
        name: in tables; look: in figures; members: coarse to fine.
    """

    name: str
    look: Look
    members: tuple[MovingMember, ...]


#: Baseline -> module, look, elements a strip and steps; no elements for a model that has none.
BASELINES: dict[str, tuple[ModuleType, Look, tuple[int, ...], tuple[float, ...]]] = {
    "linear pivot": (
        linear_pivot, Look(label="linear closed form", colour=GREY, line="", marker="P"), (), (CLOSED_STEP,),
    ),
    "pin joint": (
        pin_joint, Look(label="pseudo-rigid: pin joint", colour=YELLOW, line="", marker="*"),
        (), (CLOSED_STEP,),
    ),
    "four-bar": (
        four_bar, Look(label="pseudo-rigid: four-bar", colour=RED, line="", marker="X"), (), (CLOSED_STEP,),
    ),
    "exudyn ancf": (
        exudyn_ancf, Look(label="Exudyn, ANCF cable", colour=PURPLE, marker="^"), (4, 8), PEER_STEPS,
    ),
    "openseespy frame": (
        openseespy_frame, Look(label="OpenSees, corotational", colour=ORANGE, line="--", marker="<"),
        (20,), FRAME_STEPS,
    ),
}  # fmt: skip


def own_series(scale: float = 1.0) -> list[MovingSeries]:
    """Return the series of the two models of the suite, the implicit steps times `scale` [1]."""
    explicit = (
        moving(SplineSettings(control_points=n), f"n = {n}", "all", integrator="leapfrog") for n in COUNTS
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
    meshes = (moving(FeSettings(elements=e), f"{e} elements", "all") for e in MESHES)
    looks = own_looks()
    return [
        MovingSeries(name=name, look=looks[name], members=tuple(members))
        for name, members in ((SPLINE, explicit), (IMPLICIT, implicit), (ELEMENTS, meshes))
    ]


def own_looks() -> dict[str, Look]:
    """Return the look of the suite's own series by name."""
    return {
        SPLINE: Look(label="spline, leapfrog", colour=BLUE, marker="x"),
        IMPLICIT: Look(label="spline, energy-consistent", colour=SKY, line=":", marker="D"),
        ELEMENTS: Look(label="finite elements, central difference", colour=BLACK, marker="s"),
    }


def other_series(scale: float = 1.0) -> list[MovingSeries]:
    """Return the surrogate models and the other codes that are installed, all steps times `scale` [1]."""
    return [
        MovingSeries(
            name=name, look=look, members=tuple(_members(module, counts, [scale * step for step in steps]))
        )
        for name, (module, look, counts, steps) in BASELINES.items()
        if module.installed()
    ]


def _members(module: ModuleType, counts: tuple[int, ...], steps: list[float]) -> Iterator[MovingMember]:
    for step in steps:
        if not counts:
            yield moving_baseline(module, "closed form", "all", step)
        for e in counts:
            label = f"{e} elements, {1e6 * step:.3g} µs"
            yield moving_baseline(module, label, f"{e} elements", step, elements=e)


def looks() -> dict[str, Look]:
    """Return the look of every series by name, installed or not."""
    return own_looks() | {name: look for name, (_, look, _, _) in BASELINES.items()}
