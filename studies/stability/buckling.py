"""Compression and buckling: the column and the elastica, frames that snap through, the pivot pushed down.

Beside the outcomes: the branches of the pushed pivot.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from itertools import product
from operator import attrgetter

from scipy.special import ellipk

from studies.answers.settings import FeSettings, Settings
from studies.cases.effects import Effects
from studies.cases.problem import named_case
from studies.engine import Answer, Part
from studies.published.arcs import BIFURCATION, LIMIT, Arc, arc_of
from studies.published.case import Frame, published
from studies.record.store import Digits
from studies.stability import verdict
from studies.stability.verdict import FE, TOLERANCE, TWELVE, Found, judged

TOGGLE, LEE = "Williams' toggle", "Lee's frame"
#: Of the column: L sqrt(EA / EI) [1], and the load beyond which it is asked for its critical one [EI/L^2].
SLENDERNESS, BEYOND = 1e3, 4.0
#: Depths that the pivot's body is pushed down to [m]: the first before its strips buckle.
SHALLOW, DEPTHS = 1e-3, (2e-3, 5e-3, 1e-2, 2e-2)
#: Elements that confirm the refined spline.
INDEPENDENT = FeSettings(elements=40)
#: Tilt of the body over its depth, in lengths of a strip, from which elements find the branch [rad].
TILT = 2.0
#: Euler load of a cantilever [EI/L^2].
EULER = math.pi**2 / 4.0

#: Tip angle [deg] -> load over the Euler load [1] as printed.
PUBLISHED = {int(value.at): value.published for value in published("column").values}


def load_ratio(angle: float) -> float:
    """Return P over the Euler load at a tip angle [rad]: (2 K / pi)^2 with modulus sin(angle / 2)."""
    return float((2.0 * ellipk(math.sin(angle / 2.0) ** 2) / math.pi) ** 2)


@dataclass(frozen=True)
class _BucklingCase:
    """A question about a path with one number as its answer.

    Attributes:
        frame: as loaded. quantity: what is asked, with its unit. value: of a path; nan where it has none.
        exact: in closed form, or nan. published: as printed, or nan.
        follow_branch: whether the path is to leave the primary branch.
    """

    name: str
    frame: Frame
    quantity: str
    value: Callable[[Arc], float]
    exact: float = math.nan
    published: float = math.nan
    follow_branch: bool = False

    def arc(self, settings: Settings) -> Arc:
        """Return the path that is asked about."""
        return arc_of(self.frame, settings, follow_branch=self.follow_branch)


def _cases() -> Iterator[_BucklingCase]:
    """Yield all questions: of columns and frames, then of the pivot."""
    # turn of the other branch: of a column by the elastica, of the pivot beyond the buckling of its strips
    first, turn = partial(Arc.critical_load, kind=BIFURCATION), attrgetter("turned")
    # of a column that is shortened first: (1 - P / EA) P is Euler's
    euler = SLENDERNESS**2 / 2.0 * (1.0 - math.sqrt(1.0 - 4.0 * EULER / SLENDERNESS**2))
    column, shallow = published("column"), published("williams_shallow_toggle")
    yield _BucklingCase("column: critical load", column.frame(BEYOND), "bifurcation [EI/L^2]", first, euler)
    for degrees in PUBLISHED:
        name, angle = f"column: elastica at {degrees} deg", float(degrees)
        yield _BucklingCase(name, _bent_column(degrees), "tip angle [deg]", turn, angle, angle, True)
    for part, name in {TOGGLE: "williams_toggle", LEE: "lees_frame"}.items():
        for place, value in enumerate(published(name).values):
            limit = partial(Arc.critical_load, kind=LIMIT, place=place)
            which, unit = ("upper", "lower")[place], f"limit load [{value.unit}]"
            yield _BucklingCase(
                f"{part}: {which} limit load", published(name).frame(), unit, limit, published=value.published
            )
    name, known = "toggle of rise 0.32 in: limit points", shallow.values[0].published
    points, count = "limit points [1]", lambda arc: float(len(arc.critical))
    yield _BucklingCase(name, shallow.frame(), points, count, published=known)
    name, directions = f"pivot pushed down {1e3 * SHALLOW:g} mm: stable", "unstable directions [1]"
    yield _BucklingCase(name, _pushed_pivot(SHALLOW), directions, lambda arc: float(arc.inertia[-1]))
    name = "pivot pushed down: where its strips buckle"
    yield _BucklingCase(name, _pushed_pivot(DEPTHS[0]), "bifurcation [m]", first)
    for depth in DEPTHS:
        name = f"pivot pushed down {1e3 * depth:g} mm: other branch"
        yield _BucklingCase(name, _pushed_pivot(depth), "turn of the body [deg]", turn, follow_branch=True)


def _bent_column(degrees: float) -> Frame:
    """Return the column under the load at which the tip of the elastica has turned by `degrees` [deg]."""
    return published("column").frame(EULER * load_ratio(math.radians(degrees)))


def _pushed_pivot(depth: float) -> Frame:
    """Return the pivot of Table 1 with its body's centre displaced down by `depth` [m], free to turn."""
    given = named_case()
    effects = Effects(
        names=("bending", "stretching", "driven_displacement"),
        tables={"driven_displacement": {"displacement": (0.0, -depth)}},
    )
    design = replace(verdict.as_mechanism(given, 0.0), rotation=None, effects=effects)
    return Frame(design=design, load=depth, body="body", tilt=TILT * depth / given.length)


def _outcomes_of(case: _BucklingCase) -> Answer:
    """Return the outcomes of all models, and the reference: in closed form, or the refined spline.

    It is settled by elements, or by the published value where they do not reach it.
    """
    refined, check, independent = (
        case.value(case.arc(each)) for each in (verdict.REFINED, verdict.CHECK, INDEPENDENT)
    )
    reference = refined if math.isnan(case.exact) else case.exact
    spread = max(_difference(check, refined), _difference(refined, reference))
    gap = _difference(case.published if math.isnan(independent) else independent, reference)
    settled = "yes" if spread <= TOLERANCE / 5.0 and gap <= TOLERANCE else "no"
    place = {"case": case.name, "quantity": case.quantity}
    known = {"reference": reference, "published": case.published}

    def attempt(settings: Settings) -> Found:
        arc = case.arc(settings)
        value = case.value(arc)
        found = Found.of(arc, _difference(value, reference), found=value)
        # a path that says where it stopped does not claim what lies beyond
        return replace(found, states_limit=not found.reached)

    rows = [
        {**place, "model": model, "load": case.frame.load, "found": math.nan, **known}
        | judged(partial(attempt, settings), TOLERANCE, model)
        for model, settings in verdict.ARCS.items()
    ]
    reached = {"model": FE, "refinement": spread, "independent": gap, "settled": settled}
    return {"outcomes": rows, "references": {**place, **reached, **known}}


def _difference(found: float, reference: float) -> float:
    """Return the difference over the reference, or as it is where that is zero [1]; nan if there is none."""
    return abs(found - reference) / (abs(reference) or 1.0)


#: Branches of the pushed pivot, and depths that only they have [m].
PRIMARY, OTHER = "primary", "other"
BETWEEN = (3e-3, 7e-3, 1.5e-2)
#: Models that follow them.
PUSHED = (TWELVE, FE)


def _branch(depth: float, model: str, branch: str) -> Answer:
    """Return the last state of the pushed pivot on a branch; stable where it has no unstable direction."""
    frame = _pushed_pivot(depth)
    arc = arc_of(frame, verdict.ARCS[model], follow_branch=branch == OTHER)
    found = {
        "model": model,
        "branch": branch,
        "asked_mm": 1e3 * frame.load,
        "reached_mm": 1e3 * float(arc.load[-1]),
        "turn_deg": arc.turned,
        "energy_J": float(arc.energy[-1]),
        "unstable_directions": int(arc.inertia[-1]),
        "first_bifurcation_mm": min((1e3 * point.load for point in arc.critical), default=math.nan),
        "says": arc.message or arc.resolution,
    }
    return {"branches": found}


#: The branch beyond 10 mm amplifies round-off.
DIGITS: dict[str, Digits | None] = {
    **dict.fromkeys(("reached_mm", "turn_deg", "energy_J"), Digits(relative=1e-3, scale=1e-5)),
    "outcomes.found": Digits(relative=1e-5, floor=1e-5, rows="outcome == 'right'"),
    "outcomes.error": Digits(relative=0.05, floor=1e-8, rows="outcome == 'right'"),
    "largest_right_error": Digits(relative=0.05),
}

STUDY = verdict.study(
    Part(at=_cases, ask=_outcomes_of),
    Part(at=lambda: product(sorted({*DEPTHS, *BETWEEN}), PUSHED, (PRIMARY, OTHER)), ask=_branch),
    digits=DIGITS,
)
