"""What is asked of columns, frames and the pushed pivot, how either model is led there, and judged."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.engine.study import Answer
from studies.errors import BadInput
from studies.published.case import Value, published
from studies.stability import frames
from studies.stability.element_arcs import element_arc, tilted_state
from studies.stability.family import CHECK, COLUMNS, FE, FINER, INDEPENDENT, REFINED, UNCHECKED, Found, judged
from studies.stability.paths import TOLERANCE

COLUMN, TOGGLE, LEE, PIVOT = "column", "Williams' toggle", "Lee's frame", "pivot pushed down"
LIMIT, BIFURCATION = "limit point", "bifurcation"
#: Of the column: L sqrt(EA / EI) [1], and the load beyond which it is asked for its critical one [EI/L^2].
SLENDERNESS, BEYOND = 1e3, 4.0
#: Depths that the pivot's body is pushed down to [m]: the first before its strips buckle.
SHALLOW, DEPTHS = 1e-3, (2e-3, 5e-3, 1e-2, 2e-2)
#: Tilt of the body over its depth, in lengths of a strip, from which elements find the branch [rad].
TILT = 2.0


@dataclass(frozen=True, kw_only=True)
class BucklingCase:
    """A question about a path with one number as its answer.

    Attributes:
        part: frame that it is of. frame: as loaded. bent: what elements are given in its place, or None.
        quantity: what is asked, with its unit. value: of a path; nan where the path does not have it.
        branch: that the spline is to take. exact: in closed form, or nan. published: as printed, or nan.
    """

    name: str
    part: str
    frame: frames.Frame
    quantity: str
    value: Callable[[frames.Arc], float]
    branch: str = "primary"
    bent: frames.Frame | None = None
    tilt: float = 0.0
    exact: float = math.nan
    published: float = math.nan


def answer(case: BucklingCase, settings: Settings) -> frames.Arc:
    """Return the path of a case; BadInput for what the model refuses to be asked."""
    if isinstance(settings, FeSettings):
        if case.tilt:
            return tilted_state(case.frame, settings, case.tilt)
        return element_arc(case.bent or case.frame, settings)
    assert isinstance(settings, SplineSettings)
    arc = frames.spline_arc(case.frame, settings, branch=case.branch)
    if (arc.inertia < 0).any():
        raise BadInput(
            f"spline: measure: got {settings.measure}, expected one with a potential: stability has no other"
        )
    return arc


def cases() -> Iterator[BucklingCase]:
    """Yield all questions."""
    yield BucklingCase(
        name="column: critical load",
        part=COLUMN,
        frame=frames.frame_of("column", load=BEYOND),
        quantity="bifurcation [EI/L^2]",
        value=_critical(BIFURCATION, 0),
        exact=frames.extensible_euler(SLENDERNESS),
    )
    for degrees in frames.PUBLISHED:
        yield post_buckling(degrees)
    for place, value in enumerate(published("williams_toggle").values):
        yield _limit(TOGGLE, frames.frame_of("williams_toggle"), place, value)
    yield BucklingCase(
        name="toggle of rise 0.32 in: limit points",
        part=TOGGLE,
        frame=frames.frame_of("williams_shallow_toggle"),
        quantity="limit points [1]",
        value=lambda arc: float(len(arc.critical)),
        published=published("williams_shallow_toggle").values[0].published,
    )
    for place, value in enumerate(published("lees_frame").values):
        yield _limit(LEE, frames.frame_of("lees_frame"), place, value)
    yield from _pushed()


def post_buckling(degrees: int) -> BucklingCase:
    """Return the column at the load at which the elastica's tip has turned by `degrees`."""
    load = frames.EULER * frames.load_ratio(math.radians(degrees))
    return BucklingCase(
        name=f"column: elastica at {degrees} deg",
        part=COLUMN,
        frame=frames.frame_of("column", load=load),
        bent=frames.frame_of("column", load=load, side=frames.SIDE),
        quantity="tip angle [deg]",
        value=turned,
        branch="follow",
        exact=float(degrees),
        published=float(degrees),
    )


def pushed(depth: float) -> BucklingCase:
    """Return the pivot pushed down by `depth` [m], beyond the buckling of its strips, on the other branch."""
    frame = frames.pushed_pivot(depth=depth)
    length = math.dist(frame.design.strips[0].start, frame.design.strips[0].end)
    return BucklingCase(
        name=f"pivot pushed down {1e3 * depth:g} mm: other branch",
        part=PIVOT,
        frame=frame,
        quantity="turn of the body [deg]",
        value=turned,
        branch="follow",
        tilt=TILT * depth / length,
    )


def turned(arc: frames.Arc) -> float:
    """Return how far the body has turned at the end [deg], to either side: branches are mirror images."""
    return abs(math.degrees(arc.place[-1, 2]))


def _pushed() -> Iterator[BucklingCase]:
    yield BucklingCase(
        name=f"pivot pushed down {1e3 * SHALLOW:g} mm: stable",
        part=PIVOT,
        frame=frames.pushed_pivot(depth=SHALLOW),
        quantity="unstable directions [1]",
        value=lambda arc: float(arc.inertia[-1]),
    )
    yield BucklingCase(
        name="pivot pushed down: where its strips buckle",
        part=PIVOT,
        frame=frames.pushed_pivot(depth=DEPTHS[0]),
        quantity="bifurcation [m]",
        value=_critical(BIFURCATION, 0),
    )
    for depth in DEPTHS:
        yield pushed(depth)


def _limit(part: str, frame: frames.Frame, place: int, value: Value) -> BucklingCase:
    return BucklingCase(
        name=f"{part}: {('upper', 'lower')[place]} limit load",
        part=part,
        frame=frame,
        quantity=f"limit load [{value.unit}]",
        value=_critical(LIMIT, place),
        published=value.published,
    )


def _critical(kind: str, place: int) -> Callable[[frames.Arc], float]:
    """Return what gives the load of a critical point of a path, nan if there is none."""

    def load(arc: frames.Arc) -> float:
        found = [point.load for point in arc.critical if point.kind == kind]
        return found[place] if place < len(found) else math.nan

    return load


def outcomes_of(case: BucklingCase) -> Answer:
    """Return the outcomes of all models, and the reference: in closed form, or the refined spline."""
    refined = case.value(answer(case, REFINED))
    reference = refined if math.isnan(case.exact) else case.exact
    spread = max(_difference(case.value(answer(case, CHECK)), refined), _difference(refined, reference))
    gap = _difference(case.value(answer(case, INDEPENDENT)), reference)
    settled = "yes" if spread <= TOLERANCE / 5.0 and gap <= TOLERANCE else "no"
    place = {"case": case.name, "quantity": case.quantity}
    known = {"reference": reference, "published": case.published}
    rows = []
    for model, settings in (COLUMNS | FINER).items():
        values = [math.nan]
        attempt = partial(_attempt, case, settings, reference, values, checked=model not in UNCHECKED)
        verdict = judged(attempt, TOLERANCE)
        asked = {**place, "model": model, "load": case.frame.load}
        rows.append({**asked, "found": values[-1], **known, **verdict})
    reached = {"model": FE, "refinement": spread, "independent": gap, "settled": settled}
    return {"outcomes": rows, "references": {**place, **reached, **known}}


def _difference(found: float, reference: float) -> float:
    """Return the difference over the reference, or as it is where that is zero [1]; nan if there is none."""
    return abs(found - reference) / (abs(reference) or 1.0)


def _attempt(
    case: BucklingCase, settings: Settings, reference: float, values: list[float], *, checked: bool
) -> Found:
    """Answer a case, note the number that was found, and compare it."""
    arc = answer(case, settings)
    value = case.value(arc)
    values.append(value)
    warning = arc.warning if checked else ""
    return Found(
        error=_difference(value, reference),
        reached=arc.reached,
        reason=(warning if arc.reached else "") or arc.message,
        # a path that says where it stopped does not claim what lies beyond
        states_limit=bool(warning) or not arc.reached,
        warned=bool(arc.warning),
        counters=arc.counters,
    )
