"""Sweeps over refinement: one row a discretisation with its largest errors, failed ones included."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import partial
from itertools import pairwise, product

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from studies.answers.adapters import answer_static
from studies.answers.metrics import observed_order
from studies.answers.reference import QUANTITIES, Reference, largest_errors, limit_of
from studies.answers.response import Response
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.design import Design
from studies.cases.problem import named_case
from studies.engine import Claim, Part, Row, Study, Tables, percent
from studies.kinds import Progress
from studies.paper.formulations import FE, LOOKS, SIX, refined
from studies.record import panels
from studies.record.panels import Axis, Curves, Doubt, Panel, sheet
from studies.record.progress import silent, watched
from studies.record.style import ELEMENTS, STRETCH, Look

#: Meshes above this one are answered but not extrapolated from: their stiffness carries too much round-off.
FINEST = 160


def spline_row(problem: Design, setting: SplineSettings, against: Reference) -> Row:
    """Return what a spline is, how it ended, its errors, its work.

    Columns: segments, measure, stretch, control_points (of a segment), strip_points (of a strip, those that
    segments share counted once), axial_modes (none for consistent stretch), status,
    reached_rad (end of the converged part of the path), error_trajectory, error_torque, error_stiffness,
    error_stress (largest magnitudes over the path; empty when the path was not completed),
    newton_iterations, message.
    """
    modes = setting.axial_modes
    if modes is None and setting.stretch != "consistent":
        modes = setting.points - 2
    row = {name: getattr(setting, name) for name in ("segments", "measure", "stretch")}
    row |= {"control_points": setting.points, "axial_modes": modes}
    row["strip_points"] = setting.segments * (setting.points - 1) + 1
    return row | _outcome(answer_static(problem, setting), against)


def element_sweep(
    problem: Design, elements: Iterable[int], element: str, progress: Progress = silent
) -> tuple[pd.DataFrame, Reference]:
    """Return one row a mesh with its errors against the limit of the meshes themselves, and that limit.

    Columns: element, elements, status, reached_rad, the four errors, their observed orders (from the pair of
    this mesh and the one before), newton_iterations, message.

    Raises:
        NoReference: a mesh does not reach the end of the path.
    """
    counts = list(elements)
    answers = [
        answer_static(problem, FeSettings(elements=count, element=element))
        for count in watched(counts, progress)
    ]
    limit = limit_of([answer for answer in answers if answer.settings["elements"] <= FINEST])
    rows = [
        {"element": element, "elements": count} | _outcome(answer, limit)
        for count, answer in zip(counts, answers, strict=True)
    ]
    return with_orders(pd.DataFrame(rows), "elements"), limit


def with_orders(table: pd.DataFrame, count: str) -> pd.DataFrame:
    """Return `table`, sorted by the column `count`, with the observed order of each error beside it."""
    table = table.sort_values(count).reset_index(drop=True)
    for name in QUANTITIES:
        pairs = pairwise(zip(table[f"error_{name}"].astype(float), table[count], strict=True))
        orders = [observed_order(coarse, fine, m / n) for (coarse, n), (fine, m) in pairs]
        table[f"order_{name}"] = [np.nan, *orders]
    return table


def reaching(
    table: pd.DataFrame, count: str, accuracy: float, quantities: Iterable[str] = ("trajectory", "torque")
) -> int | None:
    """Return the smallest `count` from which on all relative errors of the quantities are within `accuracy`
    [1].

    None if no count of the table does; a failed row counts as an infinite error.
    """
    worst = table[[f"error_{name}" for name in quantities]].max(axis=1, skipna=False).fillna(np.inf)
    within = (worst <= accuracy)[::-1].cummin()[::-1]
    counts = table.loc[within, count]
    return None if counts.empty else int(counts.min())


def _outcome(answer: Response, against: Reference) -> Row:
    errors = largest_errors(answer, against) if answer.converged else dict.fromkeys(QUANTITIES, np.nan)
    return {
        "status": answer.status,
        "reached_rad": answer.rotation[-1],
        **{f"error_{name}": value for name, value in errors.items()},
        "newton_iterations": answer.counters["newton_iterations"],
        "message": answer.message,
    }


def known(limit: Reference) -> tuple[str, ...]:
    """Return the quantities of a reference: without a section's outermost fibre there is no stress."""
    return tuple(name for name in QUANTITIES if np.isfinite(limit.uncertainty[name]))


def drawn(splines: pd.DataFrame, elements: pd.DataFrame, limit: Reference) -> Figure:
    """Return the figure of the largest errors over the number of control points (above) and elements (below).

    Args:
        splines, elements: rows of `spline_row` and of `element_sweep`.
        limit: the reference, for its uncertainty.
    """
    above, below = [], []
    for quantity in known(limit):
        column, least = f"error_{quantity}", limit.uncertainty[quantity]
        most = np.fmax(splines[column].max(), elements[column].max())
        y = Axis(column, f"error of the {quantity} [1]", log=True, limits=(least / 10.0, 2.0 * most))
        doubt = Doubt(least)
        above.append(Panel(panels.CONTROL_POINTS, y, (Curves(splines, LOOKS[SIX]), doubt)))
        below.append(Panel(panels.MESH, y, (Curves(elements, LOOKS[FE]), doubt)))
    above[0], below[0] = replace(above[0], title="spline"), replace(below[0], title="finite elements")
    return sheet(11.5, 6.0, (above, below))


MESHES = (5, 10, 20, 40, 80, 160, 320)

#: Order of both elements, and how far the observed one may be from it to be called so.
ORDER, ALLOWANCE = 2.0, 0.1


def _on(elements: int, tables: Tables) -> pd.DataFrame:
    """Return the rows of a mesh, with the name of each element."""
    rows = tables["meshes"].query("elements == @elements")
    return rows.assign(name=[ELEMENTS[kind].label for kind in rows["element"]])


def _claimed(of: str) -> Iterator[Claim]:
    """Yield what is claimed of a quantity."""
    yield Claim(
        claim=f"The {of} of the finite elements converges with order 2",
        formulation="{name}",
        quantity="the distance of the observed order (80 to 160 elements) from 2, over 2,",
        rows=partial(_on, 160),  # the last mesh above round-off
        value=lambda row: abs(row[f"order_{of}"] - ORDER) / ORDER,
        most=ALLOWANCE / ORDER,
    )
    yield Claim(
        claim=f"Twenty elements a strip give the {of} to 1 %",
        formulation="{name}",
        quantity="the largest error of 20 elements over the path",
        rows=partial(_on, 20),
        value=f"error_{of}",
        most=0.01,
    )


ELEMENT_STUDY = Study(
    parts=(
        Part(at=lambda: ELEMENTS, ask=lambda each: {"meshes": element_sweep(named_case(), MESHES, each)[0]}),
    ),
    claims=tuple(claim for of in QUANTITIES for claim in _claimed(of)),
)
"""Convergence of the finite elements with their number: errors and observed orders."""

#: Control points of a segment, by segments a strip.
COUNTS = {1: range(4, 13), 2: range(4, 9)}
#: Segments of a strip with so many control points each.
SEGMENTS, EACH = range(1, 6), 5
MEASURES = ("material", "spatial")
#: Stretch forms with axial modes.
STRETCHES = ("mixed", "inextensible")
#: Error that is asked of trajectory and torque [1].
CLOSE = 1e-4
#: Look of the default in a heat map.
RING = Look(label="_default", colour="white", line="", marker="o", hollow=True)


def _settings() -> list[SplineSettings]:
    """Return every discretisation: segments, n, measure, stretch form, and m = 1 ... n - 1 modes.

    With more segments than those of the map m is n - 2.
    """
    grids = [(segments, n) for segments, counts in COUNTS.items() for n in counts]
    grids += [(segments, EACH) for segments in SEGMENTS if segments not in COUNTS]
    found = []
    for segments, n in grids:
        plain = SplineSettings(segments=segments, control_points=n)
        found += [replace(plain, measure=measure, stretch="consistent") for measure in MEASURES]
        for stretch, m in product(STRETCHES, range(1, n) if segments in COUNTS else (n - 2,)):
            found.append(replace(plain, measure="material", stretch=stretch, axial_modes=m))
    return found


def _default_modes(rows: pd.DataFrame) -> pd.DataFrame:
    """Return the rows of the default m = n - 2, and those of consistent stretch, which has no modes."""
    return rows[(rows["stretch"] == "consistent") | (rows["axial_modes"] == rows["control_points"] - 2)]


def _lines(tables: Tables) -> Figure:
    rows, limits = _default_modes(tables["map"]), tables["reference"]
    lines = []
    for quantity in ("trajectory", "torque"):
        y = Axis(f"error_{quantity}", f"largest error of the {quantity} [1]", log=True)
        doubt = Doubt(float(limits["uncertainty"][limits["quantity"] == quantity].max()))
        refined_by = (rows[rows["segments"] == 1], rows[rows["control_points"] == EACH])
        forms = [Curves(each, STRETCH, by=("stretch", "measure")) for each in refined_by]
        lines.append([Panel(panels.STRIP_POINTS, y, (curves, doubt)) for curves in forms])
    titles = ["one segment, more control points", f"more segments of {EACH} control points"]
    return sheet(9.5, 6.6, lines, columns=titles, legend=3)


def _maps(tables: Tables) -> Figure:
    """Draw the error of the torque over control points and axial modes, with rings around the default."""
    rows = tables["map"].query("stretch == 'mixed' and measure == 'material'")
    modes = Axis("axial_modes", "axial-force modes a segment, m", ticks=range(1, max(COUNTS[1])))
    points = Axis("control_points", "control points a segment, n", each=True)
    shown = []
    for segments, title in zip(COUNTS, ("one segment", "two segments"), strict=True):
        mine = rows[rows["segments"] == segments]
        errors = panels.HeatMap(rows=mine, column="error_torque", limits=(1e-10, 1.0))
        rings = Curves(_default_modes(mine), RING, more={"markersize": 15})
        shown.append(Panel(points, modes, (errors, rings), title=title))
    title = "Numbers: decimal exponent of the error; rings: the default m = n - 2; x: not converged"
    return sheet(9.5, 4.4, [shown], title=title, colours="largest error of the torque [1]")


def _forms(tables: Tables) -> Iterator[Row]:
    """Yield, for each stretch form of one segment with its default modes, the error of the torque with four
    control points, the least of any, and from which count on trajectory and torque are close."""
    chosen = _default_modes(tables["map"]).query("measure == 'material' and segments == 1")
    for stretch, curve in chosen.groupby("stretch"):
        count = reaching(curve, "control_points", CLOSE)
        yield {
            "name": f"{stretch} stretch",
            "four": curve.query("control_points == 4")["error_torque"].iloc[0],
            "best": curve["error_torque"].min(),
            "reaches": count is not None,
            "place": f" (within it from n = {count})" if count else "",
        }


MAP_STUDY = Study(
    parts=(
        Part(at=_settings, ask=lambda each: {"map": spline_row(named_case(), each, refined())}),
        Part(
            at=lambda: QUANTITIES,
            ask=lambda name: {"reference": {"quantity": name, "uncertainty": refined().uncertainty[name]}},
        ),
    ),
    claims=(
        Claim(
            claim="Four control points give the torque to 3 % on the whole path",
            formulation="{name}",
            quantity="the largest error of the torque with four control points",
            rows=_forms,
            value="four",
            most=0.03,
        ),
        Claim(
            claim=f"At most {COUNTS[1][-1]} control points give trajectory and torque to {percent(CLOSE)}",
            formulation="{name}",
            quantity="the smallest error of the torque{place}",
            rows=_forms,
            value="best",
            holds=lambda row: row["reaches"],
        ),
    ),
    figures={"control_points": _lines, "locking_map": _maps},
)
"""Convergence of the splines with their control points in every form: the locking map."""
