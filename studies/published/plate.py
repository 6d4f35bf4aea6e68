"""What a beam's clamps leave out: the stiffness of a strip as a plate, beside an independent solution.

Ends that are built in over their whole width hold the section flat; away from them it curls. The stiffness of
a strip lies between those of the two, EI and EI / (1 - nu^2).
"""

import math

from fe_reference import plate_factors
from studies.cases.problem import TABLE_1, named_case
from studies.engine import Answer, Claim, Part, Study
from studies.published.case import printed

#: b/L, Poisson ratio, f_b, f_s: an independent Ritz solution.
RITZ = printed("plate")
AGREES, LACKING = 2e-4, 0.01


def _known(width: float, nu: float, constant: float, linear: float) -> Answer:
    """Return both factors of a strip beside those of the Ritz solution."""
    found = plate_factors(width, nu)
    difference = max(abs(found.constant - constant), abs(found.linear - linear))
    row = {"width_ratio": width, "poisson_ratio": nu}
    row |= {"factor_constant": found.constant, "factor_linear": found.linear}
    return {"ritz": row | {"ritz_constant": constant, "ritz_linear": linear, "difference": difference}}


def _paper() -> Answer:
    """Return the rows of the paper's strip: width over length, and what a beam lacks by kind of moment."""
    given = named_case()
    width = given.area / math.sqrt(12.0 * given.second_moment_of_area / given.area) / given.length
    found = plate_factors(width, given.poisson_ratio)
    shape = {"width_ratio": width, "poisson_ratio": given.poisson_ratio}
    kinds = {"constant": found.constant, "linear": found.linear}
    return {"paper": [{"kind": kind, **shape, "excess": factor - 1.0} for kind, factor in kinds.items()]}


STUDY = Study(
    cases=(TABLE_1, "published/tables/plate"),
    parts=(
        Part(at=lambda: RITZ, ask=_known),
        Part(ask=_paper),
    ),
    claims=(
        Claim(
            claim="Finite elements of the plate agree with an independent Ritz solution to 2e-4",
            formulation="b/L = {width_ratio:g}, nu = {poisson_ratio:g}",
            quantity="the larger difference of both factors",
            rows=lambda tables: tables["ritz"],
            value="difference",
            most=AGREES,
        ),
        Claim(
            claim="The paper's strip is a beam within 1 %",
            formulation="{kind} moment",
            quantity="the stiffness that a beam lacks",
            rows=lambda tables: tables["paper"],
            value="excess",
            most=LACKING,
        ),
    ),
)
