"""The formulations that the paper's figures compare, each with its settings and its fixed look."""

from functools import cache

from studies.answers.adapters import answer_static
from studies.answers.reference import MESHES, Reference, reference
from studies.answers.response import Response
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.problem import named_case

CASE = "cross_axis_pivot"

PAPER = "n = 4, as the paper"
REFINED = "FE refined"
FE = "FE, 20 elements"
LOCKING_FREE = "n = 4, locking-free"

#: Spline formulations and the paper's finite elements; what each one is stands in `MEANING`.
SETTINGS: dict[str, Settings] = {
    PAPER: SplineSettings(control_points=4, measure="spatial", stretch="consistent"),
    "n = 4, printed forces": SplineSettings(control_points=4, measure="printed", stretch="consistent"),
    "n = 4, 3 Gauss points": SplineSettings(
        control_points=4, measure="spatial", stretch="consistent", gauss_points=3
    ),
    LOCKING_FREE: SplineSettings(control_points=4, axial_modes=2),
    "n = 6": SplineSettings(control_points=6),
    FE: FeSettings(elements=20),
}

#: What each formulation is, for tables and reports.
MEANING: dict[str, str] = {
    PAPER: "Eqs 10 and 13 integrated exactly: spatial measure, consistent stretch",
    "n = 4, printed forces": "the forces of Eqs 12 and 15 as printed, not the gradient of an energy",
    "n = 4, 3 Gauss points": "Eqs 10 and 13 with three Gauss points, too few to see the locking",
    LOCKING_FREE: "material measure, mixed stretch with two axial-force modes a strip",
    "n = 6": "material measure, mixed stretch with four axial-force modes a strip",
    FE: "corotational Euler-Bernoulli elements, 20 a strip, as the paper",
    REFINED: f"the same elements in the limit of refinement, from {', '.join(map(str, MESHES))} a strip",
}


@cache
def answer(name: str) -> Response:
    """Return the static path of a formulation, computed once however many figures ask."""
    return answer_static(named_case(CASE), SETTINGS[name])


@cache
def refined() -> Reference:
    """Return the limit of refinement of the case's static path."""
    return reference(named_case(CASE))
