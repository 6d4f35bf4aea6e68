"""Requests of the goldens: every command on every shipped case, and on published problems where possible.

Arguments are reduced where a command is expensive: few increments, control points and elements.
"""

from collections.abc import Iterator
from typing import NamedTuple

from studies.cases.document import is_mechanism, parsed
from studies.cases.problem import FOLDER
from studies.published.case import FOLDER as PUBLISHED

SHIPPED = sorted(path.stem for path in FOLDER.glob("*.toml"))
PROBLEMS = sorted(path.stem for path in PUBLISHED.glob("*.toml"))
CASES = (*SHIPPED, *PROBLEMS)

#: Asked of every case by the quick tests, and by the slow ones.
QUICK = (
    "solve {case}",
    "solve {case} --control-points 6 --increments 4",
    "solve {case} --model fe --elements 8 --increments 4",
    "solve {case} --model fe-shear --elements 8 --increments 4",
    "modes {case}{mass} --control-points 6 --count 4",
    "modes {case}{mass} --model fe --elements 8 --count 4",
)
SLOW = (
    "solve {case} --control-points 6 --increments 4 --measure spatial --stretch consistent",
    "solve {case} --model fe --elements 5 --increments 4 --accuracy 1e-2",
    "modes {case}{mass} --count 4",
    "modes {case}{mass} --control-points 6 --rotation-deg 5 --held --count 4",
    "critical-load {case} --control-points 8",
    "critical-load {case} --model fe --elements 4 --held --force-direction-deg 180",
)
#: Asked of the shipped cases alone.
QUICK_SHIPPED = ("release {case} --control-points 5 --duration 0.005 --step 1e-4 --no-check",)
SLOW_SHIPPED = (
    "solve {case} --control-points 6 --increments 4 --stretch inextensible",
    "solve {case} --effects=bending,stretching,gravity --control-points 6 --increments 4",
    "release {case} --control-points 5",
    "release {case} --control-points 5 --integrator leapfrog --duration 0.005",
    "release {case} --model fe --elements 4 --duration 0.005",
    "compare {case} cross_axis_pivot --increments 4",
    "compare {case} --model spline,fe --elements 8 --increments 4",
    "audit {case} --control-points 5",
    "converge {case} --control-points 4:6 --elements 5:20",
    "size {case} --objective centre-shift --rotation-deg 5 --starts 1",
    "size {case} --objective {objective} --starts 1",
    "sweep {case} static",
)
#: Not asked, as the answer hangs on round-off: massless strips that snap through or have no tangent, a search
#: along a flat objective that reaches no optimum, a difference over a travel of nothing, and a pose far
#: beyond what six control points resolve.
UNREPEATABLE = (
    "audit cantilever_with_body",
    "audit parallel_strip_guide",
    "audit polymer_pivot",
    "modes parallelogram.toml --effects=+strip_inertia --control-points 6 --rotation-deg 5",
    "size large_steel_pivot",
)
#: Asked of a pivot and a mechanism: each starts a process.
SWEPT = ("cross_axis_pivot", "parallel_strip_guide")
SLOW_SWEPT = ("sweep {case} modes", "sweep {case} release")
#: DESIGNS.toml of the sweeps: of what kind, and what is varied.
SWEEP = """
case = "{case}"
[settings]
control_points = 5
[analysis]
kind = "{kind}"
{options}
[vary]
material.{varied} = {values}
"""
SWEEPS = {
    "static": {"options": "", "varied": "youngs_modulus_Pa", "values": "[1e10, 2e11]"},
    "modes": {"options": "count = 2", "varied": "density_kg_m3", "values": "[1000, 8000]"},
    "release": {
        "options": "duration_s = 0.005\nstep_s = 1e-4",
        "varied": "density_kg_m3",
        "values": "[1000, 8000]",
    },
}


class Request(NamedTuple):
    """A command on a case: its words, and whether the quick tests leave it out."""

    case: str
    words: str
    slow: bool


def requests(case: str) -> Iterator[Request]:
    """Yield every command that is asked of a case; modes give a published problem the mass that it lacks."""
    shipped = case in SHIPPED
    document = parsed((FOLDER if shipped else PUBLISHED) / f"{case}.toml")
    filled = {
        "case": case if shipped else f"{case}.toml",
        "mass": "" if "body" in document or shipped else " --effects=+strip_inertia",
        "objective": "stress --free section.thickness_m" if is_mechanism(document) else "stiffness-variation",
    }
    asked = [(words, False) for words in QUICK] + [(words, True) for words in SLOW]
    if shipped:
        asked += [(words, False) for words in QUICK_SHIPPED] + [(words, True) for words in SLOW_SHIPPED]
    if case in SWEPT:
        asked += [(words, True) for words in SLOW_SWEPT]
    for words, slow in asked:
        request = Request(case, words.format(**filled), slow)
        if not request.words.startswith(UNREPEATABLE):
            yield request
