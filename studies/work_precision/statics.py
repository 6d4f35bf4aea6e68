"""What accuracy costs in statics: error of the paper's path against time.

Every model solves the path of Table 1 to 90 degrees in 20 increments, on one thread. The residual of a solved
state is below 1e-11 in the splines and 1e-10 in the elements, in EI/L^2; the other codes' own tolerance is
set so that it does not show. Each is held against the limit of its own theory (see `limits`), and the
distance of the theories is stated. Time is that of the increments alone (`solve_s`), the median of repeats.
"""

import math
from functools import cache
from typing import Any

from studies.answers.reference import QUANTITIES
from studies.baselines.compared import missing
from studies.baselines.own import spline
from studies.baselines.variant import Variant
from studies.cases.problem import named_case
from studies.engine import Answer, Part, Study
from studies.work_precision.equal_error import digits, finer, less_time
from studies.work_precision.limits import THEORIES, Limit, counted, limit_of_theory, path_errors
from studies.work_precision.series import other_paths, own_paths

ERRORS = ("error_trajectory", "error_torque")
#: Errors at which models are compared.
TARGETS = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8)

#: Errors at which the two models are compared, and how it is said.
COMPARED = (1e-3, 1e-4, 1e-6)
AT_EQUAL = "At an error of {target:g} in path and torque"

#: How often the path is timed, and that of a spline among others.
REPEAT, SPLINE_REPEAT = 7, 15


def _solved(variant: Variant) -> Answer:
    """Return errors over the path and at its end, those of the reference, counters and times of a setting."""
    repeat = SPLINE_REPEAT if variant.baseline is spline else REPEAT
    path, exact = variant.path(named_case(), repeat), _limit(variant.theory)
    name = {"series": variant.series, "setting": variant.setting}
    errors = {
        "series": variant.series,
        "family": variant.family,
        "setting": variant.setting,
        "count": variant.count,
        "theory": variant.theory,
        "status": path.status,
        **path_errors(path, exact.path),
        **{f"reference_{each}": exact.uncertainty[each] for each in QUANTITIES},
        **counted(("iterations",), path.work),
        "message": path.message,
    }
    times = {"solve_s": path.solve_s, "wall_s": path.wall_s, "repeats": repeat}
    return {"errors": errors, "timings": name | times}


@cache
def _limit(theory: str) -> Limit:
    """Return what settings of a theory are held against."""
    return limit_of_theory(named_case(), theory)


def _reference(theory: str) -> list[dict[str, Any]]:
    """Return a limit's uncertainty, and how far it is from the material one."""
    found = _limit(theory)
    apart = path_errors(found.path, _limit("material").path)
    return [
        {
            "theory": theory,
            "quantity": name,
            "uncertainty": found.uncertainty[name],
            "distance_to_material": apart[f"error_{name}"] if theory != "material" else math.nan,
            "source": found.source,
        }
        for name in QUANTITIES
    ]


STUDY = Study(
    parts=(
        Part(at=lambda: THEORIES, ask=lambda theory: {"reference": _reference(theory)}),
        Part(at=lambda: [*own_paths(), *other_paths()], ask=_solved, alone=True),
    ),
    made=digits(ERRORS, "count", TARGETS),
    claims=(
        finer(
            "The reference of the {quantity} is ten times finer than every error",
            "{theory} theory",
            within=("theory",),
        ),
    ),
    claims_of_time=(less_time(AT_EQUAL, COMPARED),),
    figures={},
    missing=missing,
)
