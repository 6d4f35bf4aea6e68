"""What a beam leaves out: of a strip with clamps over its width, and of a guide that others solved as solids.

Ends that are built in over their whole width hold the section flat; away from them it curls. The stiffness of
a strip lies between those of the two, EI and EI / (1 - nu^2).

H.-J. Su and A. Servey publish displacements of a parallelogram by finite elements of solids: of 10 mm at all
loads, refined to 3 mm at one. From 4 to 3 mm they still grow by 0.07 %, and as 7.5 to 5 mm changed as much as
5 to 4 mm, no order can be told and nothing extrapolated. A beam leaves out what clamps over the width do to a
plate (`clamped_width`); what thickness does to that plate, as shear and as clamps that give (a strip of
solids); flattening, in a shell weaker between clamps than in the models' product of both effects; and the
stage, of 5000 GPa in theirs. Each is computed by itself, none fitted; all of them together are the answer
`complete`. The other ends are held: there are no roots. Flattening is that of a moment linear along the strip
and as large in the mean square, so that `complete` is less sure at loads under which moments are not.
"""

import math
from collections.abc import Iterable
from dataclasses import replace
from functools import cache
from itertools import product
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from fe_reference import PlateFactors, plate_factors
from studies.answers.adapters import answer_static
from studies.answers.settings import SplineSettings
from studies.cases.problem import TABLE_1, named_case
from studies.engine import Answer, Claim, Part, Study, Tables
from studies.published.case import BEAM, CLAMPED_WIDTH, SHEARED, printed, published
from studies.published.solids import guide_compliance, linear_factor, solid_factor
from studies.record.digits import Digits
from studies.record.marks import Level, Words
from studies.record.panels import Axis, Curves, Panel, sheet
from studies.record.style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, RED, Look

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


PLATE = Study(
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
    digits={
        "change_halved": Digits(floor=5e-7),
        **dict.fromkeys(("difference", "findings.value"), Digits(floor=1e-8)),
    },
    figures={"plate_factors": _plate_figure},
)
"""What a beam's clamps leave out: the stiffness of a strip as a plate, over its width and Poisson ratio."""


CASE = "parallelogram"
#: Load of the refined mesh [EI/L^2], and what a table of theirs calls the mesh of 10 mm there.
LOAD, COARSE = 5.0, "solids, 10 mm"
#: Loads whose displacements are in print for the mesh of 10 mm.
LOADS = (0.5, 1.0, 2.0, 5.0, 10.0, 20.0)
#: Modulus of their stage over the strips', its length over theirs, and one so stiff that it is rigid.
STAGE, STAGE_LENGTH, RIGID = 5000.0 / 210.0, 0.2, 1000.0
FINE = SplineSettings(control_points=12)
BOTH, SHELL, COMPLETE = "clamped_width, anticlastic", "shell", "complete"
#: Looks of the kinds of answer, and those of them that are held against the finest mesh.
LOOKS = {
    BEAM: Look(label="beam", colour=GREY, marker="o"),
    CLAMPED_WIDTH: Look(label="clamped width", colour=BLUE, marker="o"),
    SHEARED: Look(label="and shear", colour=BLACK, marker="o"),
    BOTH: Look(label="and anticlastic", colour=ORANGE, marker="o"),
    SHELL: Look(label="flattened as a shell", colour=PURPLE, marker="o"),
    COMPLETE: Look(label="complete", colour=GREEN, marker="o"),
}
STARS = {answer: replace(look, line="", marker="*") for answer, look in LOOKS.items()}
CLOSE, ALIKE = 2e-3, 1.1


def guide_shape() -> dict[str, float]:
    """Return the length of the strips [m], and over it their width, thickness and distance [1]."""
    one, other = published(CASE).design.strips
    assert one.width is not None
    assert one.thickness is not None
    apart = math.dist(one.start, other.start) / one.length
    shape = {"width": one.width / one.length, "thickness": one.thickness / one.length, "apart": apart}
    return shape | {"length": one.length}


@cache
def _factors() -> dict[str, float]:
    """Return stiffness over that of clamped beams [1] under a linear moment, and what the stage lets go."""
    nu, shape = published(CASE).design.strips[0].poisson_ratio, guide_shape()
    width, thickness = shape["width"], shape["thickness"]
    frame: dict[str, Any] = {
        "slenderness": 1.0 / thickness,
        "apart": shape["apart"],
        "stage": STAGE_LENGTH,
        "nu": nu,
    }
    rigid, stage = (guide_compliance(**frame, stiffer=each) for each in (RIGID, STAGE))
    return {
        "plate": plate_factors(width, nu).linear,
        "solid": solid_factor(width, thickness, nu),
        "shell, little bent": linear_factor(1e-3, width=width, thickness=thickness, nu=nu),
        "stage": stage / rigid,
    }


def accounted(load: float) -> Answer:
    """Return a row a kind of answer and mesh at a load: its displacement and the difference to the solids."""
    guide, shape, known = published(CASE), guide_shape(), _factors()
    strip = guide.design.strips[0]
    plate = answer_static(guide.frame(load, CLAMPED_WIDTH).design, FINE)
    unit = strip.youngs_modulus * strip.second_moment_of_area / strip.length
    square = np.trapezoid(plate.bending_moment[-1] ** 2, plate.stations).mean()
    moment = math.sqrt(3.0 * float(square)) / unit
    shell = linear_factor(moment, width=shape["width"], thickness=shape["thickness"], nu=strip.poisson_ratio)
    stiffer = {SHELL: shell / known["shell, little bent"]}
    stiffer[COMPLETE] = stiffer[SHELL] * known["solid"] / known["plate"] / known["stage"]
    rows = []
    for answer in LOOKS:
        design = guide.frame(load, CLAMPED_WIDTH if answer in stiffer else answer).design
        modulus = strip.youngs_modulus * stiffer.get(answer, 1.0)
        strips = tuple(replace(each, youngs_modulus=modulus) for each in design.strips)
        found = float(answer_static(replace(design, strips=strips), FINE).bodies["stage"][-1][1])
        for mesh, value in _solids(load):
            row = {"load": load, "answer": answer, "mesh_mm": mesh, "published": value, "found": found}
            rows.append({**row, "error": found / value - 1.0})
    parts = {f"factor_{name}": known[name] for name in ("plate", "solid", "stage")}
    return {"account": rows, "left_out": {"load": load, "moment": moment, "factor_shell": shell, **parts}}


def _solids(load: float) -> Iterable[tuple[float, float]]:
    """Yield the sizes of elements [mm] and the displacements [m] that are in print for a load."""
    if load == LOAD:
        yield 10.0, next(found for name, found, _ in printed(CASE) if name == COARSE)
    value = next(v for v in published(CASE).values if v.load == load and v.quantity == "displacement_y")
    yield 3.0 if load == LOAD else 10.0, value.published * value.scale


def _figure(tables: Tables) -> Figure:
    """Draw the differences to the solids of 10 mm over the load, by what is taken in."""
    fine = tables["account"]["mesh_mm"] == 3.0
    coarse, stars = tables["account"][~fine], tables["account"][fine]
    ends = coarse.sort_values("load").groupby("answer").last()
    panel = Panel(
        Axis("load", "load across [EI/L²]", limits=(0.0, 25.0)),
        Axis("error", "difference to solids [%]", factor=100.0),
        (
            Curves(coarse, LOOKS, by="answer", more={"markersize": 4}),
            Curves(stars, STARS, by="answer", more={"markersize": 9}),
            *(
                Words(
                    LOOKS[str(answer)].label, (end["load"], 100.0 * end["error"]), by=(5, -3),
                    colour=LOOKS[str(answer)].colour
                )
                for answer, end in ends.iterrows()
            ),
            Level(0.0),
        ),
        title="Lines: elements of 10 mm; stars: of 3 mm"
    )  # fmt: skip
    return sheet(6.3, 3.2, [[panel]])


def _flattened(account: pd.DataFrame) -> list[dict[str, Any]]:
    """Return how many times as much both effects of the models flatten the guide as a shell does, by load."""
    at = account[account["mesh_mm"] == 10.0].pivot(index="load", columns="answer", values="found")
    ratio = (at[CLAMPED_WIDTH] - at[BOTH]) / (at[CLAMPED_WIDTH] - at[SHELL])
    return [{"load": load, "ratio": value} for load, value in ratio.items()]


GUIDE = Study(
    cases=(f"published/cases/{CASE}", f"published/tables/{CASE}"),
    parts=(Part(at=lambda: LOADS, ask=accounted),),
    claims=(
        Claim(
            claim="All that a beam leaves out, computed and not fitted, is the solids' to 0.2 %",
            formulation="beam, plate, solid strip, flattening and stage",
            quantity="the difference to their mesh of 3 mm",
            rows=lambda tables: tables["account"].query("mesh_mm == 3 and answer == @COMPLETE"),
            value="error",
            holds=lambda row: abs(row["error"]) <= CLOSE,
        ),
        Claim(
            claim="Both effects of the models together flatten strips between clamps as a shell does",
            formulation="load {load:g}",
            quantity="what both take off the displacement over what a shell takes",
            rows=lambda tables: _flattened(tables["account"]),
            value="ratio",
            most=ALIKE,
            ratio=True,
        ),
    ),
    figures={"model_form_account": _figure},
)
"""What a beam leaves out of a guide that others solved as solids: each part computed by itself, none fitted.
"""
