"""What is asked of columns, frames and the pushed pivot, how either model is led there, and judged."""

import math
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from fe_reference.arc_length import ArcPath, follow_arc
from fe_reference.control import Control, equilibrate
from fe_reference.effects import DrivenDisplacement
from fe_reference.errors import ConvergenceError
from fe_reference.loads import full_load
from fe_reference.model import Model
from fe_reference.path import follow
from fe_reference.response import respond
from fe_reference.structure import structure_of
from studies.answers.models import put
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.engine.study import Answer, Part
from studies.errors import BadInput
from studies.published.case import published
from studies.stability import frames
from studies.stability.family import (
    CHECK,
    COLUMNS,
    FE,
    FINER,
    INDEPENDENT,
    REFINED,
    TOLERANCE,
    UNCHECKED,
    Found,
    judged,
)

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
            return _tilted_state(case.frame, settings, case.tilt)
        return element_arc(case.bent or case.frame, settings)
    assert isinstance(settings, SplineSettings)
    arc = frames.spline_arc(case.frame, settings, branch=case.branch)
    if (arc.inertia < 0).any():
        raise BadInput(
            f"spline: measure: got {settings.measure}, expected one with a potential: stability has no other"
        )
    return arc


def _cases() -> Iterator[BucklingCase]:
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
    for part, name in {TOGGLE: "williams_toggle", LEE: "lees_frame"}.items():
        for place, value in enumerate(published(name).values):
            yield BucklingCase(
                name=f"{part}: {('upper', 'lower')[place]} limit load",
                part=part,
                frame=frames.frame_of(name),
                quantity=f"limit load [{value.unit}]",
                value=_critical(LIMIT, place),
                published=value.published,
            )
    yield BucklingCase(
        name="toggle of rise 0.32 in: limit points",
        part=TOGGLE,
        frame=frames.frame_of("williams_shallow_toggle"),
        quantity="limit points [1]",
        value=lambda arc: float(len(arc.critical)),
        published=published("williams_shallow_toggle").values[0].published,
    )
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
    yield from map(pushed, DEPTHS)


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


def _critical(kind: str, place: int) -> Callable[[frames.Arc], float]:
    """Return what gives the load of a critical point of a path, nan if there is none."""

    def load(arc: frames.Arc) -> float:
        found = [point.load for point in arc.critical if point.kind == kind]
        return found[place] if place < len(found) else math.nan

    return load


def _outcomes_of(case: BucklingCase) -> Answer:
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


def element_arc(frame: frames.Frame, settings: FeSettings) -> frames.Arc:
    """Return the path to load factor 1; BadInput for what the model refuses to be asked."""
    model: Model = put(frame.design, settings).modelled
    message = ""
    try:
        path = follow_arc(_led(model, frame), increments=frame.design.increments)
    except ConvergenceError as stop:
        path, message = stop.solution, str(stop)
    return _arc(model, frame, path, message)


def _led(model: Model, frame: frames.Frame) -> Control:
    """Return the control of a frame: its pins held, its load or the displacement of its body growing."""
    structure = structure_of(model)
    ways: dict[str, tuple[float | None, float | None]] = {name: (0.0, 0.0) for name in frame.pins}
    named = model.effects.find(DrivenDisplacement)
    if named is not None:
        ways[frame.body] = named.displacement
    ends = {
        structure.body_slice(model.body_index(name)).start + k: part
        for name, way in ways.items()
        for k, part in enumerate(way)
        if part is not None
    }
    held = np.array(sorted(ends), dtype=np.int64)
    values = np.array([[0.0] * len(held), [ends[int(at)] for at in held]])
    return Control(structure=structure, held=held, values=values, load=full_load(structure))


def _tilted_state(frame: frames.Frame, settings: FeSettings, tilt: float) -> frames.Arc:
    """Return the state at load factor 1 that is found from a body turned by `tilt` [rad] first.

    The body is turned, then led to its displacement while it is turned, then let turn. So a branch is reached
    that the path from rest crosses; the path has this one state.
    """
    model: Model = put(frame.design, settings).modelled
    control = _led(model, frame)
    turn = structure_of(model).body_slice(model.body_index(frame.body)).stop - 1
    held = np.append(control.held, turn)
    values = np.zeros((3, len(held)))
    values[1:, -1], values[2, :-1] = tilt, control.values[1]
    legs = [
        replace(control, held=held, values=values[leg : leg + 2], span=(leg / 2, (leg + 1) / 2))
        for leg in range(2)
    ]
    before = follow(legs, frame.design.increments)
    message = before.message
    outcome = equilibrate(control, before.states[-1].y, control.span[1], Counter())
    found = before.states[-1] if outcome.failure else respond(control, outcome)
    return _arc(model, frame, ArcPath(states=(found,)), message or outcome.failure)


def _arc(model: Model, frame: frames.Frame, path: ArcPath, message: str) -> frames.Arc:
    at = structure_of(model).body_slice(model.body_index(frame.body))
    rest = np.array([*next(body.centre for body in frame.design.bodies if body.name == frame.body), 0.0])
    critical = tuple(
        frames.Critical(kind=point.kind, load=frame.load * point.parameter, place=rest + point.y[at])
        for point in path.critical
    )
    return frames.Arc(
        load=frame.load * np.array([state.parameter for state in path.states]),
        place=rest + np.array([state.y[at] for state in path.states]),
        energy=np.array([sum(structure_of(model).evaluate(state.y).strain) for state in path.states]),
        inertia=np.array([state.inertia for state in path.states]),
        critical=critical,
        reached=not message,
        message=message or "; ".join(f"{point.kind} at {point.load:.6g}" for point in critical),
    )


#: All questions and what comes of each.
ASKED = Part(at=_cases, ask=_outcomes_of)
