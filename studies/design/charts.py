"""Design charts of the pivot: stiffness, shift, stress and variation over crossing ratio and inclination.

Two equal slender strips of length L, thickness t and rigidity EI, turned by theta. Dimensionless: stiffness
K L/(EI); distance by which the body's point at the crossing moves, over L; largest stress sigma L/(E t);
largest less smallest stiffness up to theta over that at rest. All of these depend on the two ratios alone
where strips are slender, and the table `collapse` says by how much they do not. Strain is that of the extreme
fibre, |N|/(EA) + |M| t/(2 EI). Turned to either side the pivot is its own mirror image, so one side is
enough. The theory is limited by the effects on the stiffness that a plain beam neglects.
"""

import math
from itertools import product
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from scipy.optimize import brentq

from spline_model import cross_axis_pivot, solve_many
from spline_model.effects.plate import plate_factors
from studies.answers.adapters import answer_static
from studies.answers.answer import centre_shift
from studies.answers.settings import FeSettings, SplineSettings
from studies.answers.validity import anticlastic_factor, strips_of, turned_roots
from studies.cases.problem import named_case
from studies.cases.section import of_sides
from studies.engine import Answer, Claim, Part, Study, Tables
from studies.kinds import Array
from studies.record.panels import Axis, Curves, Panel, sheet
from studies.record.style import BLACK, BLUE, GREEN, ORANGE, SKY, Look

#: The charts' grid, the rotations that are drawn, and the increment of a path [deg].
RATIOS, INCLINATIONS = np.linspace(0.1, 0.9, 33), np.linspace(25.0, 65.0, 17)
ROTATIONS, INCREMENT = (5.0, 10.0, 15.0, 30.0, 45.0), 2.5
#: Slenderness L/t of the charts, of those that they are compared with, and from which they must hold.
SLENDER, OTHERS, FROM = 200.0, (15.0, 20.0, 30.0, 50.0, 100.0), 30.0
#: Width over length and Poisson's ratio, which a beam's answer does not depend on.
WIDTH, POISSON = 0.1, 0.3
#: Control points of a strip.
POINTS = 10
#: Quantity -> how it is written beside its charts.
QUANTITIES = {
    "stiffness": "$K L/(EI)$",
    "shift": "shift/$L$",
    "stress": r"$\sigma L/(E t)$",
    "variation": "variation of $K$",
}
#: Inclinations of the columns [deg], and colours of the rotations.
DRAWN, COLOURS = (30.0, 45.0, 60.0), (BLUE, SKY, GREEN, ORANGE, BLACK)
#: Pivots that are marked where the theory ends, and elements a strip by which their shear is weighed.
PIVOTS = (
    "cross_axis_pivot",
    "spring_steel_pivot",
    "titanium_pivot",
    "polymer_pivot",
    "silicon_pivot",
    "large_steel_pivot",
)
ELEMENTS = 160


def paths(ratios: Array, inclinations: Array, slenderness: float) -> dict[str, Array]:
    """Return the quantities of the charts (D, S) [1] by name, of D pivots in increments to the last rotation.

    Of unit length and modulus.

    Args:
        ratios, inclinations: (D,) crossing ratios [1] and inclinations [deg]. slenderness: L/t [1].

    Raises:
        ValueError: a pivot that is not reached.
    """
    angles, section = np.radians(inclinations), of_sides(WIDTH, 1.0 / slenderness)
    ones = ("length", "youngs_modulus", "density", "body_mass", "body_moment_of_inertia")
    unit: dict[str, Any] = {**dict.fromkeys(ones, 1.0), **section, "poisson_ratio": POISSON}
    pivot = cross_axis_pivot(**unit, crossing_ratio=0.5, inclination=math.pi / 4, control_points=POINTS)
    found = solve_many(
        pivot,
        {"crossing_ratio": ratios, "inclination": angles},
        rotation=np.radians(max(ROTATIONS)),
        increments=round(max(ROTATIONS) / INCREMENT),
        section_depth=1.0 / slenderness,
    )
    if not found.converged.all():
        raise ValueError(f"charts: {np.sum(~found.converged)} designs of L/t {slenderness:g} are not reached")
    stiffness = found.stiffness / section["second_moment_of_area"]
    most, least = (extreme.accumulate(stiffness, axis=1) for extreme in (np.maximum, np.minimum))
    crossing = ratios[:, None] * np.stack((np.cos(angles), np.sin(angles)), axis=1)
    shift = centre_shift(crossing, found.rotation, found.centre)
    return {
        "stiffness": stiffness,
        "shift": np.linalg.norm(shift, axis=-1),
        "stress": found.strain * slenderness,
        "variation": (most - least) / stiffness[:, :1],
    }


def _charts(slenderness: float) -> pd.DataFrame:
    """Return a row a design and rotation of the charts."""
    ratios, inclinations = np.array(list(product(RATIOS, INCLINATIONS))).T
    values = paths(ratios, inclinations, slenderness)
    parts = [
        {"crossing_ratio": ratios, "inclination_deg": inclinations, "rotation_deg": rotation}
        | {name: values[name][:, round(rotation / INCREMENT)] for name in QUANTITIES}
        for rotation in ROTATIONS
    ]
    return pd.concat(map(pd.DataFrame, parts), ignore_index=True)


def _charted() -> Answer:
    """Return the charts' map, to five digits, and how far other slendernesses and designs are from it."""
    slender = _charts(SLENDER)
    rows = []
    for slenderness in OTHERS:
        other = _charts(slenderness)
        for name, turn in product(QUANTITIES, ROTATIONS):
            here = slender["rotation_deg"] == turn
            apart = (other[name] - slender[name])[here].abs() / slender.loc[here, name].max()
            row = {"quantity": name, "slenderness": slenderness, "rotation_deg": turn}
            rows.append(row | {"median": apart.median(), "largest": apart.max()})
    digits = {name: [float(f"{value:.5g}") for value in slender[name]] for name in QUANTITIES}
    return {"map": slender.assign(**digits), "collapse": rows}


def _judged(name: str) -> Answer:
    """Return where a pivot of the suite lies, and the part of its stiffness that a beam neglects."""
    problem = named_case(name)
    answer = answer_static(problem, SplineSettings(control_points=POINTS))
    shear, plain = (
        answer_static(problem, FeSettings(elements=ELEMENTS, element=element)).torque[-1]
        for element in ("reissner", "corotational")
    )
    strip = max(strips_of(problem, answer), key=lambda each: each.curvature)
    return {
        "validity": {
            "pivot": name,
            "rotation_deg": np.degrees(problem.rotation),
            "thickness_ratio": strip.thickness_ratio,
            "width_ratio": strip.width_ratio,
            "curvature_ratio": strip.curvature_ratio,
            "clamped_least": strip.clamped[0],
            "clamped_most": strip.clamped[1],
            "flattened": strip.flattened,
            "roots": -turned_roots(strip.thickness_ratio),
            "shear": shear / plain - 1.0,
        }
    }


#: Ratio -> the part of the stiffness that a plain beam neglects, and the range that is searched.
LEFT_OUT = {
    "width_ratio": (lambda ratio: plate_factors(ratio, POISSON).linear - 1.0, (0.02, 1.5)),
    "thickness_ratio": (turned_roots, (1e-4, 0.5)),
    "curvature_ratio": (lambda ratio: float(anticlastic_factor(ratio, POISSON)) - 1.0, (0.01, 40.0)),
}


def limits() -> Answer:
    """Return the ratios at which a plain beam neglects a share of the stiffness."""
    return {
        "limits": [
            {"ratio": name, "share": share, "value": brentq(lambda x, of=of, s=share: of(x) - s, *ends)}
            for name, (of, ends) in LEFT_OUT.items()
            for share in (0.01, 0.05)
        ]
    }


def _held(tables: Tables) -> list[dict[str, Any]]:
    """Return the collapse of each quantity from the slenderness on from which it must hold."""
    rows = tables["collapse"].query("slenderness >= @FROM", local_dict={"FROM": FROM})
    return [{"quantity": name, "largest": some["largest"].max()} for name, some in rows.groupby("quantity")]


def _figure(tables: Tables) -> Figure:
    """Draw a row of charts a quantity, a column an inclination, a curve a rotation."""
    rows = tables["map"]
    turns = zip(sorted(set(rows["rotation_deg"])), COLOURS, strict=True)
    looks = {turn: Look(label=f"{turn:g}°", colour=colour) for turn, colour in turns}
    ratio = Axis("crossing_ratio", "crossing ratio λ", ticks=(0.1, 0.3, 0.5, 0.7, 0.9))
    lines = []
    for name, label in QUANTITIES.items():
        some = (rows[rows["inclination_deg"] == inclination] for inclination in DRAWN)
        lines.append(
            [Panel(ratio, Axis(name, label), [Curves(each, looks, by="rotation_deg")]) for each in some]
        )
    columns = [f"inclination {inclination:g}°" for inclination in DRAWN]
    return sheet(6.3, 6.6, lines, columns=columns, legend=len(looks))


STUDY = Study(
    cases=PIVOTS,
    parts=(
        Part(ask=_charted),
        Part(ask=limits),
        Part(at=lambda: PIVOTS, ask=_judged),
    ),
    claims=(
        Claim(
            claim=f"From a slenderness of {FROM:g} on the charts hold within 1 %",
            formulation="{quantity}",
            quantity=f"the largest difference to L/t = {SLENDER:g} over the largest value at that rotation",
            rows=_held,
            value="largest",
            most=0.01,
        ),
    ),
    figures={"charts": _figure},
)
