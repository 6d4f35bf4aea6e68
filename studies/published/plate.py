"""What a beam's clamps leave out: the stiffness of a strip as a plate, over its width and Poisson ratio.

Ends that are built in over their whole width hold the section flat; away from them it curls. The stiffness of
a strip lies between those of the two, EI and EI / (1 - nu^2).
"""

import math
from itertools import product

from matplotlib.figure import Figure

from fe_reference import PlateFactors, plate_factors
from studies.cases.problem import TABLE_1, named_case
from studies.engine import Answer, Claim, Part, Study, Tables
from studies.published.case import printed
from studies.record.marks import Level
from studies.record.panels import Axis, Curves, Panel, sheet
from studies.record.style import BLACK, BLUE, GREEN, GREY, ORANGE, RED, Look

WIDTHS = (0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0)
POISSON_RATIOS = (0.25, 0.3, 0.35, 0.4, 0.45)
#: Poisson ratio -> colour.
COLOURS = dict(zip(POISSON_RATIOS, (BLACK, BLUE, GREEN, ORANGE, RED), strict=True))
#: b/L, Poisson ratio, f_b, f_s: an independent Ritz solution.
RITZ = printed("plate")
RITZ_LOOK = Look(label="Ritz, ν = 0.3", colour=GREY, line="", marker="s", hollow=True)
AGREES, RESOLVED, LACKING = 2e-4, 1e-5, 0.01


def _row(width: float, nu: float, found: PlateFactors) -> dict[str, float]:
    shape = {"width_ratio": width, "poisson_ratio": nu}
    return shape | {"factor_constant": found.constant, "factor_linear": found.linear}


def _plate(width: float, nu: float) -> Answer:
    """Return the row of a strip, and what halved elements change."""
    given, finer = (plate_factors(width, nu, halvings=each) for each in (0, 1))
    change = max(abs(given.constant - finer.constant), abs(given.linear - finer.linear))
    return {"factors": _row(width, nu, given) | {"unknowns": given.unknowns, "change_halved": change}}


def _known(width: float, nu: float, constant: float, linear: float) -> Answer:
    """Return both factors of a strip beside those of the Ritz solution."""
    found = plate_factors(width, nu)
    row, difference = _row(width, nu, found), max(abs(found.constant - constant), abs(found.linear - linear))
    return {"ritz": row | {"ritz_constant": constant, "ritz_linear": linear, "difference": difference}}


def _paper() -> Answer:
    """Return the rows of the paper's strip: width over length, and what a beam lacks by kind of moment."""
    given = named_case()
    width = given.area / math.sqrt(12.0 * given.second_moment_of_area / given.area) / given.length
    found = plate_factors(width, given.poisson_ratio)
    shape = {"width_ratio": width, "poisson_ratio": given.poisson_ratio}
    kinds = {"constant": found.constant, "linear": found.linear}
    return {"paper": [{"kind": kind, **shape, "excess": factor - 1.0} for kind, factor in kinds.items()]}


def _plate_figure(tables: Tables) -> Figure:
    """Draw what a beam lacks of the strip's stiffness over its width."""
    panels = [_lacking(tables, kind) for kind in ("constant", "linear")]
    return sheet(9.0, 3.8, [panels], legend=7)


def _lacking(tables: Tables, kind: str) -> Panel:
    """Return the panel of one kind of moment, with the limits of infinitely wide strips."""
    looks = {nu: Look(label=f"ν = {nu}", colour=each, marker="o") for nu, each in COLOURS.items()}
    factors, ritz = tables["factors"], tables["ritz"].query("poisson_ratio == 0.3")
    return Panel(
        Axis("width_ratio", "width over length b/L", log=True),
        Axis("excess", "stiffness above the beam's [%]", factor=100.0),
        (
            *(Level(100.0 / (1.0 - nu**2) - 100.0, colour=each, line=":") for nu, each in COLOURS.items()),
            Curves(factors.assign(excess=factors[f"factor_{kind}"] - 1.0), by="poisson_ratio", looks=looks),
            Curves(ritz.assign(excess=ritz[f"ritz_{kind}"] - 1.0), RITZ_LOOK, more={"markersize": 7.0}),
            Curves(
                tables["paper"].query("kind == @kind"),
                Look(label="Table 1", colour=RED, line="", marker="*"),
                more={"markersize": 11.0},
            ),
        ),
        title=f"{kind} moment",
    )


STUDY = Study(
    cases=(TABLE_1, "published/tables/plate"),
    parts=(
        Part(at=lambda: product(WIDTHS, POISSON_RATIOS), ask=_plate),
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
            claim="The plate's mesh leaves less than 1e-5",
            formulation="all strips",
            quantity="the largest change with halved elements",
            rows=lambda tables: [{"change": tables["factors"]["change_halved"].max()}],
            value="change",
            most=RESOLVED,
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
    figures={"plate_factors": _plate_figure},
)
