"""The tables of README and of the page of findings, as lines of Markdown made from the stored results."""

import math
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np
import pandas as pd

from studies.commands.case import markdown_head
from studies.design.sizing import AGAIN, BEAMS, EFFECTS, TOLERANCES
from studies.engine import percent
from studies.errors import BadInput
from studies.record.store import Store
from studies.registry import STUDIES
from studies.stability.verdict import DEFAULT, OUTCOMES

QUANTITIES = ("trajectory", "torque", "stiffness")
PAPER = "spline, {} control points, as the paper integrates it"
LOCKING_FREE = "spline, {} control points, locking-free"
ELEMENTS = "finite elements, {} a strip, as the paper"
#: Control-point counts of the table of paths for the default formulation.
COUNTS = (4, 6, 8, 12)
#: Formulations of Fig 6 in the order of the table.
SWINGS = {
    "n = 4, as the paper": PAPER.format(4),
    "n = 4, locking-free": LOCKING_FREE.format(4),
    "n = 6": LOCKING_FREE.format(6),
    "n = 10": LOCKING_FREE.format(10),
    "FE, 20 elements": ELEMENTS.format(20),
}
CLAIMED = ("n = 4, as the paper", "n = 4, locking-free", "n = 6")


def _sized(store: Store) -> Iterator[str]:
    """Yield the table of the designs that gradients found, with plate effects and supports, beside what each
    began from; below it what was promised as beams."""
    size = "length, thickness, width [mm]"
    yield markdown_head("design", size, "inclination", "crossing", "shift [mm]", "stiffness varies by")
    table = stored_table(store, "design/sizing", "designs")
    begun, again = (table[table["basis"] == basis].set_index("design") for basis in (EFFECTS, AGAIN))
    for baseline in sorted(set(table["baseline"])):
        found = again[again["baseline"] == baseline].sort_values("centre_shift_m", ascending=False)
        for name, row in pd.concat([begun.loc[[baseline]], found]).iterrows():
            yield _design(str(name), row, begun.loc[baseline])
    yield ""
    promised = "; ".join(_promised(table, str(name)) for name in again.index)
    yield "All numbers are with plate effects and supports."
    yield f"Sized as plain beams, the same questions have these factors: {promised}."


def _design(name: str, row: "pd.Series[Any]", begun: "pd.Series[Any]") -> str:
    """Return the line of a design, with how many times less its shift and variation are than at the begin."""
    size = ", ".join(f"{1e3 * row[f'{key}_m']:.3g}" for key in ("length", "thickness", "width"))
    shift, varies = (_less(begun[key] / row[key]) for key in ("centre_shift_m", "variation"))
    return (
        f"| {name} | {size} | {math.degrees(row['inclination_rad']):.3g}° | {row['crossing_ratio']:.3g} | "
        f"{1e3 * row['centre_shift_m']:.2g}{shift} | {100 * row['variation']:.2g} %{varies} |"
    )


def _promised(table: pd.DataFrame, name: str) -> str:
    """Return how many times less the aim of a design that was sized as beams is: as beams, with the effects
    and at the tolerances."""
    aim = "centre_shift_m" if "shift" in name else "variation"
    values = table.set_index(["design", "basis"])[aim]
    baseline = table.loc[table["design"] == name, "baseline"].iloc[0]
    beams, effects, tolerances = (
        f"{values[baseline, begun] / values[name, basis]:.3g}"
        for basis, begun in ((BEAMS, BEAMS), (EFFECTS, EFFECTS), (TOLERANCES, BEAMS))
    )
    return f"{name} {beams} ({effects} with the effects, {tolerances} at tolerances)"


def _less(factor: float) -> str:
    return "" if factor == 1.0 else f" (× 1/{factor:.3g})"


#: Formulations of the table in the README.
SHORT = ("n = 4, as the paper", "n = 4, locking-free", "n = 6", "FE, 20 elements")


def _short(store: Store) -> Iterator[str]:
    """Yield the table of the README: a row per formulation, errors in percent."""
    paths = _path_rows(store)
    swings = _rows_by(stored_table(store, "paper/fig06_release", "summary"), "formulation")
    names = ("trajectory", "torque", "stiffness", "vibration frequency")
    static = _uncertainties(store, "convergence/control_points")
    moving = _uncertainties(store, "paper/fig06_release")
    limits = [*(static[each] for each in QUANTITIES), moving["frequency"]]
    yield markdown_head("largest error, against refined finite elements", *names)
    for name in SHORT:
        errors = " | ".join(percent(paths[SWINGS[name]][f"error_{each}"]) for each in QUANTITIES)
        shift = swings[name]["frequency_shift"]
        shown = f"{'+' if shift > 0.0 else ''}{percent(shift)}"
        if abs(shift) <= limits[-1]:
            shown = f"< {percent(limits[-1])}"
        yield f"| {SWINGS[name]} | {errors} | {shown} |"
    yield "| *uncertainty of the reference* | " + " | ".join(map(percent, limits)) + " |"


def _paths(store: Store) -> Iterator[str]:
    """Yield the table of the static path: a row a formulation, and the uncertainty of the reference."""
    limits = _uncertainties(store, "convergence/control_points")
    yield markdown_head("largest error over 0 to 90°", *QUANTITIES)
    for label, row in _path_rows(store).items():
        yield f"| {label} | " + " | ".join(f"{row[f'error_{name}']:.1e}" for name in QUANTITIES) + " |"
    yield "| *uncertainty of the reference* | " + " | ".join(f"{limits[n]:.0e}" for n in QUANTITIES) + " |"


def _swings(store: Store) -> Iterator[str]:
    """Yield the table of the swing after the release: shift of the frequency and error of the rotation."""
    rows = _rows_by(stored_table(store, "paper/fig06_release", "summary"), "formulation")
    limits = _uncertainties(store, "paper/fig06_release")
    yield markdown_head("free vibration of 0.05 s from 90°", "frequency", "rotation")
    for name, label in SWINGS.items():
        row = rows[name]
        yield f"| {label} | {row['frequency_shift']:+.1e} | {row['error_rotation_rad']:.1e} rad |"
    uncertain = f"{limits['frequency']:.0e} | {limits['rotation_rad']:.0e} rad"
    yield f"| *uncertainty of the reference* | {uncertain} |"


def _claims(store: Store) -> Iterator[str]:
    """Yield the table of the paper's claims: one row a claim, one column a formulation."""
    studies = ("paper/fig04_trajectory", "paper/fig05_stiffness", "paper/fig06_release")
    found = pd.concat([stored_table(store, study, "findings") for study in studies])
    yield markdown_head("claim of the paper", *CLAIMED)
    for claim, rows in found.groupby("claim", sort=True):
        verdicts = _rows_by(rows, "formulation")
        cells = (f"{verdicts[name]['holds']} ({percent(verdicts[name]['value'])})" for name in CLAIMED)
        yield f"| {claim} | " + " | ".join(cells) + " |"


def _published(store: Store) -> Iterator[str]:
    """Yield the table of published problems: of each and each kind of answer the value that is met worst, by
    the splines where they answer."""
    values = stored_table(store, "published/problems", "values")
    yield markdown_head("published problem", "quantity", "published", "ours", "difference", "limit")
    for _, every in values.groupby(["problem", "answer"], sort=False):
        rows = every[every["model"] == "spline"] if (every["model"] == "spline").any() else every
        row = rows.iloc[int(rows["error"].abs().argmax())]
        name = row["problem"] if row["answer"] == "beam" else f"{row['problem']}, {row['answer']}"
        bound = "" if row["bound"] == "equal" else f"{row['bound']} "
        unit = "" if row["unit"] == "1" else f" {row['unit']}"
        printed = f"{bound}{row['published']:.6g} ± {row['uncertainty']:.1g}{unit}"
        difference = f"{100 * row['error']:+.2g} %"
        asked = row["quantity"].replace("_", " ")
        limit = f"{100 * row['limit']:.2g} %"
        yield f"| {name} | {asked} | {printed} | {row['found']:.6g}{unit} | {difference} | {limit} |"


def stored_table(store: Store, study: str, name: str) -> pd.DataFrame:
    """Return one stored table of a study; BadInput if it was never run."""
    try:
        return store.load_tables(study)[name]
    except (FileNotFoundError, KeyError):
        raise BadInput(f"{study}/{name}: got no stored table, expected those of `make figures`") from None


def _uncertainties(store: Store, study: str) -> "pd.Series[Any]":
    """Return the uncertainty of the reference of a study, by quantity."""
    return stored_table(store, study, "reference").set_index("quantity")["uncertainty"]


def _path_rows(store: Store) -> dict[str, Any]:
    """Return the rows of the errors along the static path, by the label of their formulation."""
    splines = stored_table(store, "convergence/control_points", "map")
    meshes = stored_table(store, "convergence/elements", "meshes")
    bezier = splines[splines["segments"] == 1]
    paper = bezier[(bezier["measure"] == "spatial") & (bezier["stretch"] == "consistent")]
    found = {PAPER.format(4): paper[paper["control_points"] == 4]}
    default = bezier[(bezier["measure"] == "material") & (bezier["stretch"] == "mixed")]
    default = default[default["axial_modes"] == default["control_points"] - 2]
    for n in COUNTS:
        found[LOCKING_FREE.format(n)] = default[default["control_points"] == n]
    twenty = meshes[(meshes["element"] == "corotational") & (meshes["elements"] == 20)]
    found[ELEMENTS.format(20)] = twenty
    return {label: rows.iloc[0] for label, rows in found.items()}


def _rows_by(table: pd.DataFrame, column: str) -> Mapping[str, Any]:
    """Return the rows of a table by what stands in one column."""
    return {row[column]: row for row in table.to_dict("records")}


#: Models beside the spline, in the order of the columns.
GROUPS = ("spline, by itself", "finite elements", "Exudyn", "Exudyn as delivered", "OpenSees", "surrogates")
#: Tables of the comparison: their first column, and how an error is written in it.
TASKS = {
    "path_ratios": ("error of path and torque, 0 to 90°", "{:.0e}"),
    "swing_ratios": ("error of the rotation, free vibration of 0.05 s", "{:g} rad"),
}


def _costs(store: Store) -> Iterator[str]:
    """Yield both tables of what an error costs: rows of errors, columns of models, all of one run."""
    for k, (name, (title, shown)) in enumerate(TASKS.items()):
        found = stored_table(store, "cost/codes", name)
        groups = [group for group in GROUPS if group in set(found.dropna(subset="ratio")["group"])]
        if k:
            yield ""
        yield markdown_head(title, "spline", "its increments or steps alone", *groups)
        for level, rows in sorted(found.groupby("level"), reverse=True):
            peers = _rows_by(rows, "group")
            cells = (_cost(peers[group]) if group in peers else "–" for group in groups)
            own = (_time(rows[name].iloc[0]) for name in ("spline_s", "spline_solve_s"))
            yield f"| {' | '.join((shown.format(level), *own, *cells))} |"


def _cost(row: Mapping[str, Any]) -> str:
    """Return the time of a model, and how many times that of the spline it is; a dash: not kept."""
    if pd.isna(row["ratio"]):
        return "–"
    ratio = float(f"{row['ratio']:.2g}")
    return f"{_time(row['whole_s'])} (× {ratio:g})"


def _hard_cases(store: Store) -> Iterator[str]:
    """Yield the counts of outcomes: a row a family, a column a model, "right / refused / wrong / bad input" a
    cell."""
    cells: dict[str, dict[Any, str]] = {}
    for study in (each for each in STUDIES if each.startswith("stability/")):
        counts = stored_table(store, study, "counts").set_index("model")[list(OUTCOMES)]
        cells[study.partition("/")[2]] = counts.astype(str).agg(" / ".join, axis=1).to_dict()
    models = list(dict.fromkeys((DEFAULT, *(model for row in cells.values() for model in row))))
    yield markdown_head("family", *models)
    for family, row in cells.items():
        yield f"| {family} | " + " | ".join(row.get(model, "") for model in models) + " |"


def _time(seconds: float) -> str:
    return f"{1e3 * seconds:.2g} ms" if seconds < 0.0995 else f"{seconds:.2g} s"


#: Rotations of the table of solids [deg].
SOLID_AT = (9.0, 45.0, 90.0)


def _solids(store: Store) -> Iterator[str]:
    """Yield the deviations of beam models from solids of the benchmark pivot."""
    rows = stored_table(store, "model_form/solid_pivot", "deviations")
    degrees = np.degrees(rows["rotation_rad"]).round(3)
    yield markdown_head("model", *(f"torque at {angle:g}°" for angle in SOLID_AT), "trajectory at 90°")
    for name in dict.fromkeys(rows["model"]):
        own = rows[rows["model"] == name].set_index(degrees[rows["model"] == name])
        torques = " | ".join(f"{100.0 * own['error_torque'][angle]:+.2f} %" for angle in SOLID_AT)
        yield f"| {name} | {torques} | {percent(own['error_trajectory'][SOLID_AT[-1]])} |"
    sure = rows[rows["model"] == rows["model"].iloc[0]]["uncertainty"].to_numpy()
    known = dict(zip(degrees.unique(), sure, strict=True))
    yield "| *uncertainty of the solids* | " + " | ".join(percent(known[a]) for a in SOLID_AT) + " |  |"


def _solid_designs(store: Store) -> Iterator[str]:
    """Yield the deviations of beam models from solids of other designs at the first and last rotation."""
    rows = stored_table(store, "model_form/solid_designs", "states")
    designs = list(rows["design"].unique())
    yield markdown_head("model, torque", *designs)
    for model, own in rows[rows["model"] != "solid"].groupby("model"):
        cells = [own.loc[own["design"] == each, "error_torque"].to_numpy() for each in designs]
        ends = (
            f"{100.0 * each[0]:+.2f} to {100.0 * each[-1]:+.2f} %" if len(each) else "–" for each in cells
        )
        yield f"| {model} | " + " | ".join(ends) + " |"
    unsure = rows.groupby("design")["uncertainty"].max()
    yield "| *uncertainty of the solids* | " + " | ".join(percent(unsure[each]) for each in designs) + " |"


#: Block of README.md or docs/findings.md -> the lines that stand between its marks.
TABLES: dict[str, Callable[[Store], Iterator[str]]] = {
    "agreement": _short,
    "paths": _paths,
    "swings": _swings,
    "claims": _claims,
    "costs": _costs,
    "hard cases": _hard_cases,
    "sized": _sized,
    "solids": _solids,
    "solid designs": _solid_designs,
    "published": _published,
}
