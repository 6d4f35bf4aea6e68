"""Static paths of hard designs: the answer of each model against a refined and an independent one."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np

from studies.answers.adapters import answer_static
from studies.answers.response import Response
from studies.answers.settings import FeSettings, Settings
from studies.cases.design import Design
from studies.engine.study import Answer
from studies.stability.family import CHECK, FE, PATHS, REFINED, UNCHECKED, Found, judged, said

#: Largest distance of a path that counts as right [1], over the largest torque and displacement. The error of
#: six control points grows to 0.03 at a half turn; another branch is off by more than 0.1.
TOLERANCE = 0.05

#: Finer elements, asked where those of the column do not confirm the refined spline.
ARBITER = FeSettings(elements=80)


@dataclass(frozen=True, kw_only=True)
class StaticCase:
    """One design and its path: a name, its place on the family's map, and which columns have other settings.

    Attributes:
        x, y: place on the map, in the units of the family's axes.
        settings: settings of columns for this case, in place of those in `PATHS`.
        refined, check: of the reference.
    """

    name: str
    x: float
    y: float
    design: Design
    settings: Mapping[str, Settings] = field(default_factory=dict)
    refined: Settings = REFINED
    check: Settings = CHECK


def distance(path: Response, reference: Response) -> float:
    """Return the largest distance of two paths over the states that both have: of torque or place [1].

    Each over its largest value on the reference's path; infinite where the path is not of finite numbers. A
    path that stopped may end between two of the reference's states.
    """
    near = np.abs(path.load_factor[:, None] - reference.load_factor).min(axis=1) < 1e-9
    same = np.abs(path.load_factor[near][:, None] - reference.load_factor).argmin(axis=1)
    if not (np.isfinite(path.torque).all() and np.isfinite(path.centre).all()):
        return float("inf")
    torque = np.abs(path.torque[near] - reference.torque[same]).max()
    place = np.linalg.norm(path.centre[near] - reference.centre[same], axis=1).max()
    travel = np.linalg.norm(reference.centre - reference.centre[0], axis=1).max()
    return float(max(torque / np.abs(reference.torque).max(), place / travel if travel > 0.0 else place))


def outcomes_of(case: StaticCase) -> Answer:
    """Return the outcomes of a case, a row a model, and the row of its reference.

    A reference is settled where refinement moves it by less than a fifth of the tolerance and elements agree
    with it within the tolerance.
    """
    reference = answer_static(case.design, case.refined)
    spread = distance(answer_static(case.design, case.check), reference)
    place = {"case": case.name, "x": case.x, "y": case.y}
    rows: list[dict[str, Any]] = []
    gap = float("inf")
    for model, settings in PATHS.items():
        chosen = case.settings.get(model, settings)
        attempt = partial(attempted, case.design, chosen, reference, checked=model not in UNCHECKED)
        rows.append({**place, "model": model, **judged(attempt, TOLERANCE)})
        if model == FE:
            gap = rows[-1]["error"]
    if not gap <= TOLERANCE:
        gap = distance(answer_static(case.design, ARBITER), reference)
    settled = reference.converged and spread <= TOLERANCE / 5.0 and gap <= TOLERANCE
    known = {**place, "refinement": spread, "independent": gap, "settled": "yes" if settled else "no"}
    return {"outcomes": rows, "references": known}


def attempted(design: Design, settings: Settings, reference: Response, *, checked: bool) -> Found:
    """Solve `design` and compare the path; without `checked`, as if it said nothing of its resolution."""
    path = answer_static(design, settings)
    return said(path, distance(path, reference), checked=checked)
