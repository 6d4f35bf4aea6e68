"""Design charts of the pivot: stiffness, shift, stress, range and loads over crossing ratio and inclination.

Two equal slender strips of length L, thickness t and rigidity EI, turned by theta. Dimensionless: stiffness
K L/(EI); distance by which the body's point at the crossing moves, over L; largest stress sigma L/(E t);
largest less smallest stiffness up to theta over that at rest; loads P L^2/(EI), at that point. All of these
depend on the two ratios alone where strips are slender, and the table `collapse` says by how much they do
not. Strain is that of the extreme fibre, |N|/(EA) + |M| t/(2 EI). Turned to either side the pivot is its own
mirror image, so one side is enough. The theory is limited by the effects on the stiffness that a plain beam
neglects.
"""

from dataclasses import replace
from itertools import product
from math import pi
from typing import Any

import numpy as np
import pandas as pd
from scipy.optimize import brentq

from spline_model import solve_many
from spline_model.batch_paths import Batch
from spline_model.effects.plate import plate_factors
from studies.answers.adapters import answer_static
from studies.answers.critical import FORCE, critical_load
from studies.answers.settings import FeSettings, SplineSettings
from studies.answers.validity import Strip, anticlastic_factor, strips_of
from studies.cases.effects import Effects
from studies.cases.problem import Problem, named_case
from studies.cases.section import of_sides
from studies.design.figures import CHARTS
from studies.engine import Answer, Claim, Part, Study, Tables
from studies.kinds import Array

CASE = "cross_axis_pivot"
#: The charts' grid, the rotations that are drawn, and the increment of a path [deg].
RATIOS, INCLINATIONS = np.linspace(0.1, 0.9, 33), np.linspace(25.0, 65.0, 17)
ROTATIONS, INCREMENT = (5.0, 10.0, 15.0, 30.0, 45.0), 2.5
#: Slenderness L/t of the charts, of those that they are compared with, and from which they must hold.
SLENDER, OTHERS, FROM = 200.0, (15.0, 20.0, 30.0, 50.0, 100.0), 30.0
#: Width over length and Poisson's ratio, which a beam's answer does not depend on.
WIDTH, POISSON = 0.1, 0.3
POINTS = 10
QUANTITIES = ("stiffness", "shift", "stress", "variation")
#: Strengths sigma_y L/(E t) whose ranges are listed, and the ratios of that list.
STRENGTHS, LISTED = (0.05, 0.1, 0.2, 0.3, 0.5), (0.1273, 0.2, 0.3, 0.4, 0.5)
#: Designs, rotations [deg], errors and control points of the table of points, and their reference.
COARSE = ((0.1, 0.3, 0.5, 0.7, 0.9), (25.0, 45.0, 65.0))
TURNS, LEVELS, COUNTS, REFERENCE = (5.0, 10.0, 15.0, 30.0, 45.0, 90.0), (1e-2, 1e-3, 1e-4), range(4, 12), 14
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
#: Loads P L^2/(EI) up to this one, and the designs that bear them, by half of the ratios: what holds for one
#: holds for what it lacks to one. Directions from x to y [rad].
MOST, STATES = 20.0, 20
LOADED = ((0.1273, 0.2, 0.3, 0.4, 0.5), (30.0, 45.0, 60.0))
DIRECTIONS = {"towards the ground": -pi / 2, "away from the ground": pi / 2, "across": 0.0}


def turned(ratios: Array, inclinations: Array, largest: float, slenderness: float, points: int) -> Batch:
    """Return the paths of pivots of unit length and modulus to a rotation [deg], crossing at (0, 0)."""
    thickness = 1.0 / slenderness
    return solve_many(
        {
            "length": 1.0,
            "youngs_modulus": 1.0,
            "poisson_ratio": POISSON,
            "density": 1.0,
            "body_mass": 1.0,
            "body_moment_of_inertia": 1.0,
            **of_sides(WIDTH, thickness),
            "crossing_ratio": ratios,
            "inclination": np.radians(inclinations),
        },
        rotation=np.radians(largest),
        increments=round(largest / INCREMENT),
        section_depth=thickness,
        control_points=points,
    )


def dimensionless(found: Batch, ratios: Array, inclinations: Array, slenderness: float) -> dict[str, Array]:
    """Return the quantities of the charts (D, S) [1] by name.

    ratios, inclinations: crossing ratio [1] and inclination [rad] of the D pivots; slenderness: L/t [1].
    """
    rigidity = WIDTH / slenderness**3 / 12.0
    stiffness = found.stiffness / rigidity
    most, least = (extreme.accumulate(stiffness, axis=1) for extreme in (np.maximum, np.minimum))
    # the body's centre is midway between its clamps: from the crossing up by this
    arm = ((1.0 - ratios) * np.sin(np.radians(inclinations)))[:, None]
    sine, cosine = np.sin(found.rotation), np.cos(found.rotation)
    x, y = (found.centre - found.centre[:, :1]).transpose(2, 0, 1)
    return {
        "stiffness": stiffness,
        "shift": np.hypot(x + arm * sine, y + arm * (1.0 - cosine)),
        "stress": found.strain * slenderness,
        "variation": (most - least) / stiffness[:, :1],
    }


def _grid(ratios: Any, inclinations: Any) -> tuple[Array, Array]:
    pairs = np.array(list(product(ratios, inclinations)))
    return pairs[:, 0], pairs[:, 1]


def _charts(ratios: Any, inclinations: Any, slenderness: float) -> pd.DataFrame:
    """Return a row a design and rotation of the charts."""
    designs = _grid(ratios, inclinations)
    found = turned(*designs, max(ROTATIONS), slenderness, POINTS)
    if not found.converged.all():
        raise ValueError(f"charts: {np.sum(~found.converged)} designs of L/t {slenderness:g} are not reached")
    values = dimensionless(found, *designs, slenderness)
    parts = [
        {"crossing_ratio": designs[0], "inclination_deg": designs[1], "rotation_deg": rotation}
        | {name: values[name][:, round(rotation / INCREMENT)] for name in QUANTITIES}
        for rotation in ROTATIONS
    ]
    return pd.concat(map(pd.DataFrame, parts), ignore_index=True)


def _charted() -> Answer:
    """Return the charts' map, to five digits, and how far other slendernesses and designs are from it."""
    slender = _charts(RATIOS, INCLINATIONS, SLENDER)
    rows = []
    for slenderness in OTHERS:
        other = _charts(RATIOS, INCLINATIONS, slenderness)
        for name, turn in product(QUANTITIES, ROTATIONS):
            here = slender["rotation_deg"] == turn
            apart = (other[name] - slender[name])[here].abs() / slender.loc[here, name].max()
            row = {"quantity": name, "slenderness": slenderness, "rotation_deg": turn}
            rows.append(row | {"median": apart.median(), "largest": apart.max()})
    digits = {name: [float(f"{value:.5g}") for value in slender[name]] for name in QUANTITIES}
    return {"map": slender.assign(**digits), "collapse": rows}


def _ranges() -> Answer:
    """Return how far pivots at 45 degrees turn within a strength sigma_y L/(E t); none where farther."""
    designs = _grid(LISTED, (45.0,))
    found = turned(*designs, max(TURNS), SLENDER, POINTS)
    stress, turns = found.strain * SLENDER, np.degrees(found.rotation)
    return {
        "ranges": [
            {"crossing_ratio": ratio, "strength": strength, "rotation_deg": _crossed(turns, path, strength)}
            for ratio, path in zip(designs[0], stress, strict=True)
            for strength in STRENGTHS
        ]
    }


def _crossed(turns: Array, path: Array, strength: float) -> float:
    """Return the rotation [deg] at which a path first passes the strength."""
    if path.max() < strength:
        return np.nan
    past = int(np.argmax(path >= strength))
    return float(np.interp(strength, path[past - 1 : past + 1], turns[past - 1 : past + 1]))


def _points() -> Answer:
    """Return the least control points that keep an error up to a rotation in each of the designs."""
    designs = _grid(*COARSE)
    found = {n: turned(*designs, max(TURNS), SLENDER, n) for n in (*COUNTS, REFERENCE)}
    rows = []
    for quantity, start in (("torque", 1), ("stiffness", 0)):
        exact = getattr(found[REFERENCE], quantity)[:, start:]
        errors = [np.abs(getattr(found[n], quantity)[:, start:] / exact - 1.0) for n in COUNTS]
        for turn, level in product(TURNS, LEVELS):
            worst = np.array(
                [error[:, : round(turn / INCREMENT)].max() for error in errors]
            )  # nan: not reached
            worst = np.where(np.isnan(worst), np.inf, worst)
            kept = np.maximum.accumulate(worst[::-1])[::-1] <= level
            least = COUNTS[int(np.argmax(kept))] if kept.any() else np.nan
            rows.append({"quantity": quantity, "rotation_deg": turn, "error": level, "control_points": least})
    return {"points": rows}


def _loaded(ratio: float, inclination: float, direction: str) -> Answer:
    """Return the stiffness of a pivot at rest under a growing load, and the load at which it buckles."""
    problem = _at_crossing(ratio, inclination)
    angle = DIRECTIONS[direction]
    unit = problem.youngs_modulus * problem.second_moment_of_area / problem.length**2
    force = tuple(MOST * unit * part for part in (np.cos(angle), np.sin(angle)))
    effects = Effects(names=(*problem.effects.names, FORCE), tables={FORCE: {"force": force}})
    under = replace(problem, rotation=0.0, increments=STATES, effects=effects)
    design = {"crossing_ratio": ratio, "inclination_deg": inclination, "direction": direction}
    path = answer_static(under, SplineSettings(control_points=POINTS))
    rows = [
        design | {"load": load, "stiffness": stiffness / (unit * problem.length)}
        for load, stiffness in zip(MOST * np.linspace(0.0, 1.0, STATES + 1), path.stiffness, strict=False)
    ]
    answer: dict[str, Any] = {"loads": rows}
    if direction == "towards the ground":
        found = critical_load(problem, SplineSettings(control_points=POINTS), direction=angle)
        answer["buckling"] = design | {"load": (found.force or np.nan) / unit, "kind": found.kind}
    return answer


def _at_crossing(ratio: float, inclination: float) -> Problem:
    """Return a slender pivot whose body is held and loaded at its point where the strips cross."""
    case, angle = named_case(CASE), np.radians(inclination)
    width, thickness = WIDTH * case.length, case.length / SLENDER
    return replace(
        case,
        width=width,
        thickness=thickness,
        crossing_ratio=ratio,
        inclination=angle,
        centre_offset=(0.0, -(1.0 - ratio) * case.length * float(np.sin(angle))),
        **of_sides(width, thickness),
    )


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
            "clamped_least": float(strip.clamped[0]),
            "clamped_most": float(strip.clamped[1]),
            "flattened": float(strip.flattened),
            "roots": -strip.turned_roots,
            "shear": shear / plain - 1.0,
        }
    }


def _roots(ratio: float) -> float:
    """Return the stiffness that roots take of a strip of that thickness over length."""
    section = {"thickness": ratio, "width": WIDTH}
    strip = Strip(length=1.0, **section, youngs_modulus=1.0, poisson_ratio=POISSON, density=1.0)
    return float(strip.turned_roots)


#: Ratio -> the part of the stiffness that a plain beam neglects, and the range that is searched.
LEFT_OUT = {
    "width_ratio": (lambda ratio: plate_factors(ratio, POISSON).linear - 1.0, (0.02, 1.5)),
    "thickness_ratio": (_roots, (1e-4, 0.5)),
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


STUDY = Study(
    cases=PIVOTS,
    parts=(
        Part(ask=_charted),
        Part(ask=_ranges),
        Part(ask=_points),
        Part(ask=limits),
        Part(at=lambda: product(*LOADED, DIRECTIONS), ask=_loaded),
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
    figures=CHARTS,
)
