"""The models of the work-precision diagrams: a series of settings each, from coarse to fine."""

from dataclasses import dataclass
from types import ModuleType
from typing import Any

from studies.answers.settings import FeSettings, SplineSettings
from studies.baselines import four_bar, linear_pivot, pin_joint
from studies.baselines.peers import exudyn_ancf, exudyn_exact, openseespy_frame
from studies.record.style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, RED, SKY, YELLOW, Look
from studies.work_precision.paths import Member, of_baseline, of_settings


@dataclass(frozen=True, kw_only=True)
class Series:
    """One model from coarse to fine.

    Attributes:
        name: of the model, in tables.
        theory: key of `limits.THEORIES` that its answers tend to.
        look: label, colour, line and marker in figures.
        members: settings, the coarsest first.
        repeat: timed solves of each [1].
    """

    name: str
    theory: str
    look: Look
    members: tuple[Member, ...]
    repeat: int = 7


SPLINE, ELEMENTS, SHEAR = "spline", "finite elements", "finite elements with shear"
COUNTS = range(4, 13)
BSPLINE_COUNTS = (4, 6, 8, 12, 16, 24, 32, 48, 64)
MESHES = (5, 10, 20, 40, 80, 160)
PEER_MESHES = (2, 4, 8, 16, 32)
FRAME_MESHES = (10, 20, 40, 80)

#: Baseline -> module, theory, look, and its elements a strip; none for what has no refinement.
BASELINES: dict[str, tuple[ModuleType, str, Look, tuple[int, ...]]] = {
    "linear pivot": (
        linear_pivot, "material", Look(label="linear closed form", colour=GREY, line="", marker="P"), (),
    ),
    "pin joint": (
        pin_joint, "material", Look(label="pseudo-rigid: pin joint", colour=YELLOW, line="", marker="*"), (),
    ),
    "four-bar": (
        four_bar, "material", Look(label="pseudo-rigid: four-bar", colour=RED, line="", marker="X"), (),
    ),
    "exudyn ancf": (
        exudyn_ancf, "material", Look(label="Exudyn, ANCF cable", colour=PURPLE, marker="^"), PEER_MESHES,
    ),
    "exudyn exact": (
        exudyn_exact, "shear",
        Look(label="Exudyn, exact beam", colour=PURPLE, line=":", marker="v"), PEER_MESHES,
    ),
    "openseespy frame": (
        openseespy_frame, "material",
        Look(label="OpenSees, corotational", colour=ORANGE, line="--", marker="<"), FRAME_MESHES,
    ),
}  # fmt: skip


def own_series() -> list[Series]:
    """Return the series of the two models of the suite."""
    return [
        splines(SPLINE, "material", Look(label="spline", colour=BLUE, marker="x")),
        splines(
            "spline, one axial mode more", "material",
            Look(label="spline, m = n - 1", colour=SKY, line=":", marker="D"), modes=1,
        ),
        splines(
            "B-spline", "material", Look(label="cubic B-spline", colour=GREEN, line="-.", marker="o"),
            counts=BSPLINE_COUNTS, basis="bspline",
        ),
        splines(
            "spline, spatial measure", "spatial",
            Look(label="spline, spatial measure", colour=BLUE, line="--", marker="+"),
            measure="spatial",
        ),
        splines(
            "spline as the paper", "spatial",
            Look(label="spline, as the paper", colour=RED, line="--", marker="o"),
            measure="spatial", stretch="consistent",
        ),
        elements(ELEMENTS, "corotational", Look(label="finite elements", colour=BLACK, marker="s")),
        elements(SHEAR, "reissner", Look(label="finite elements, shear", colour=GREY, line="--", marker="s")),
    ]  # fmt: skip


def splines(
    name: str,
    theory: str,
    look: Look,
    *,
    counts: tuple[int, ...] | range = COUNTS,
    modes: int | None = None,
    **settings: Any,
) -> Series:
    """Return a series of splines; `modes`: axial modes less n - 2, None for the default."""
    members = []
    for n in counts:
        axial = None if modes is None else n - 2 + modes
        setting = SplineSettings(control_points=n, axial_modes=axial, **settings)
        members.append(of_settings(setting, f"n = {n}", n))
    return Series(name=name, theory=theory, look=look, members=tuple(members), repeat=15)


def elements(name: str, element: str, look: Look) -> Series:
    """Return a series of finite elements."""
    members = (of_settings(FeSettings(elements=e, element=element), f"{e} elements", e) for e in MESHES)
    theory = "material" if element == "corotational" else "shear"
    return Series(name=name, theory=theory, look=look, members=tuple(members))


def other_series() -> list[Series]:
    """Return the surrogate models and the other codes that are installed."""
    return [
        Series(name=name, theory=theory, look=look, members=_members(module, counts))
        for name, (module, theory, look, counts) in BASELINES.items()
        if module.installed()
    ]


def _members(module: ModuleType, counts: tuple[int, ...]) -> tuple[Member, ...]:
    if not counts:
        return (of_baseline(module, "closed form", 1),)
    return tuple(of_baseline(module, f"{e} elements", e, elements=e) for e in counts)


def all_series() -> list[Series]:
    """Return all series, the suite's own first."""
    return own_series() + other_series()


def looks() -> dict[str, Look]:
    """Return the look of every series by name, installed or not."""
    return {series.name: series.look for series in own_series()} | {
        name: look for name, (_, _, look, _) in BASELINES.items()
    }
