"""What the tests of the elements share: the pivot, a cantilever, a four-bar."""

from collections.abc import Mapping
from typing import Any

import fe_reference as fe
from tests.models import scene
from tests.table_one import SECTION, TABLE_ONE

Parameters = Mapping[str, Any]
#: Length of the cantilever [m], width of the four-bar, and length of its links.
GUIDE, APART, LINK = 0.1, 0.05, 0.06
#: Effects of bodies on strips without inertia.
MASSLESS = ("bending", "stretching", "body_inertia")
#: Every effect that has a parameter, at a value that matters in the four-bar; its coupler is the loaded body.
PARAMETERS: dict[str, Any] = {
    "gravity": {"acceleration": (300.0, -981.0)},
    "strip_damping": {"relaxation_time": 2e-7},
    "strip_drag": {"rate": 200.0},
    "body_damping": {"translation": 3.0, "rotation": 1e-2},
    "applied_force": {"force": (2000.0, 1000.0), "body": "coupler", "history": ((0.0, 1.0), (2e-3, -1.0))},
    "applied_moment": {"moment": 30.0, "body": "crank"},
    "pre_strain": {"curvature": 3.0, "strain": 1e-3},
    "spring": [
        {"body": "crank", "other": "rocker", "stiffness": (4e4, 2e4), "damping": (20.0, 10.0)},
        {"body": "coupler", "rotational_stiffness": 30.0, "rotational_damping": 0.02},
    ],
}
#: Effects of the sides of a wide thin strip, and that strip: as wide as it is long in the four-bar.
SIDED: dict[str, dict[str, Any]] = {"clamped_width": {}, "anticlastic": {}, "root_compliance": {"root": 3.0}}
BARE = {name: value for name, value in SECTION.items() if name not in ("area", "second_moment_of_area")}
WIDE, THICK = BARE | {"width": 0.02, "thickness": 0.001}, BARE | {"width": 0.02, "thickness": 0.004}
SIDED_SCENE = {name: given for name, given in PARAMETERS.items() if name != "pre_strain"} | SIDED


def pivot(**changes: Any) -> fe.Model:
    """Return the paper's pivot with some parameters changed."""
    return fe.cross_axis_pivot(**{**TABLE_ONE, **changes})


def free_cantilever(
    *,
    length: float = GUIDE,
    section: Mapping[str, float] = SECTION,
    parameters: Parameters | None = None,
    effects: tuple[str, ...] = fe.DEFAULT_EFFECTS,
    root: str | None = "ground",
    **discretisation: Any,
) -> fe.Model:
    """Return a horizontal strip, clamped on the left, with a free tip."""
    strip = fe.StripDesign(name="strip", start=(0.0, 0.0), end=(length, 0.0), root=root, tip=None, **section)
    return fe.compliant_mechanism(strips=[strip], **scene(effects, **parameters or {}), **discretisation)


#: A body without mass at the tip of a strip.
TIP = fe.BodyDesign(name="tip", centre=(GUIDE, 0.0))


def tipped(
    *bodies: fe.BodyDesign,
    strip: Parameters | None = None,
    elements: int = 20,
    element: str = "corotational",
    **given: Any,
) -> fe.Model:
    """Return a horizontal strip with the first of the bodies at its tip, and effects by their parameters."""
    along = {"start": (0.0, 0.0), "end": (GUIDE, 0.0), "tip": bodies[0].name} | SECTION | dict(strip or {})
    effects = scene(fe.DEFAULT_EFFECTS, **given)
    strips = [fe.StripDesign(name="strip", **along)]
    return fe.compliant_mechanism(strips=strips, bodies=bodies, elements=elements, element=element, **effects)


def four_bar(
    parameters: Parameters | None = None,
    *,
    effects: tuple[str, ...] = fe.DEFAULT_EFFECTS,
    short: float = 0.02,
    rise: float = 0.0,
    section: Mapping[str, float] = SECTION,
    **discretisation: Any,
) -> fe.Model:
    """Return a parallelogram of crank, coupler and rocker with a strip of length `short` in every joint.

    All strips stand upright at rest; the rocker's lower strip runs from the rocker to ground.
    """
    low, high = short, short + LINK
    joints = (
        ("a", (0.0, 0.0), (0.0, low), "ground", "crank"),
        ("b", (0.0, high), (0.0, high + short), "crank", "coupler"),
        ("c", (APART, high + short), (APART, high), "coupler", "rocker"),
        ("d", (APART, low), (APART, 0.0), "rocker", "ground"),
    )
    strips = [
        fe.StripDesign(name=name, start=start, end=end, root=root, tip=tip, rise=rise, **section)
        for name, start, end, root, tip in joints
    ]
    centres = {
        "crank": (0.005, 0.5 * (low + high)),
        "coupler": (0.5 * APART, high + short),
        "rocker": (APART, 0.5 * (low + high)),
    }
    bodies = [
        fe.BodyDesign(name=name, centre=centre, mass=0.1, moment_of_inertia=1e-4)
        for name, centre in centres.items()
    ]
    given = scene(effects, **parameters or {})
    return fe.compliant_mechanism(strips=strips, bodies=bodies, **given, **discretisation)
