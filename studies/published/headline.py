"""How far models are from solids, and what a state costs: a guide that others solved in three dimensions.

H.-J. Su and A. Servey publish displacements and times of a parallelogram by eight theories; the truth here is
their finest mesh of solids, and their times are of their machine. Errors are of the stage's displacement
across at one load. What the theories leave
out is accounted for in `model_form/account`, whose answer with all of it is drawn as `complete`.
"""

from collections.abc import Iterable, Iterator
from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from studies.answers.adapters import answer_static
from studies.answers.models import put
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.engine import Answer, Claim, Part, Study, Tables, records
from studies.published.account import BOTH, CASE, CLOSE, LOAD, SHELL, accounted
from studies.published.account import LOOKS as WORDS
from studies.published.case import BEAM, CLAMPED_WIDTH, SHEARED, printed, published
from studies.record.marks import Level, Words
from studies.record.panels import Axis, Curves, Mark, Panel, sheet
from studies.record.progress import measure
from studies.record.style import BLACK, BLUE, GREY, ORANGE, PURPLE, Look

#: Theory or size of solids, displacement [m] at that load, and time a state [s].
THEIRS = printed(CASE)
#: Displacement by solids of 3 mm, the finest in print [m].
TRUTH = float(THEIRS[-1][1])
SETTINGS: dict[str, tuple[Settings, ...]] = {
    "spline": tuple(SplineSettings(control_points=n) for n in (4, 5, 6, 8, 12)),
    "fe": tuple(FeSettings(elements=n) for n in (2, 4, 8, 20, 40)),
    "fe-shear": tuple(FeSettings(elements=n, element="reissner") for n in (4, 8, 20, 40)),
}
#: Kinds of answer that each is asked for.
KINDS = {
    "spline": (BEAM, CLAMPED_WIDTH, BOTH, SHEARED),
    "fe": (BEAM, CLAMPED_WIDTH, BOTH),
    "fe-shear": (SHEARED,),
}
FINEST = {("spline", 12), ("fe", 40), ("fe-shear", 40)}
REPEATS = 7


def _asked() -> Iterable[tuple[str, Settings, str]]:
    """Yield every model and setting with the kinds of answer it is asked for."""
    for model, settings in SETTINGS.items():
        for each in settings:
            for answer in KINDS[model]:
                yield model, each, answer


def _solved(model: str, settings: Settings, answer: str) -> Answer:
    """Return error and whole time of a state: the design built in the model, and solved up to the load."""
    design = published(CASE).frame(LOAD, answer).design
    timing = measure(lambda: put(design, settings).static_path(), repeat=REPEATS)
    found = float(answer_static(design, settings).bodies["stage"][-1][1])
    count = settings.points if isinstance(settings, SplineSettings) else settings.elements
    setting = f"{count} " + ("control points" if model == "spline" else "elements")
    return _rows(model, answer, setting, count, found, timing.median)


def _rows(model: str, answer: str, setting: str, count: int, found: float, seconds: float) -> Answer:
    who = {"model": model, "answer": answer, "setting": setting, "count": count}
    error = found / TRUTH - 1.0
    return {"methods": [{**who, "found": found, "error": error}], "times": [{**who, "wall_s": seconds}]}


def _theirs() -> Answer:
    """Return what Su and Servey print of their theories, with the error at the same load."""
    rows = [
        {"model": name, "found": found, "error": found / TRUTH - 1.0, "wall_s": seconds}
        for name, found, seconds in THEIRS
    ]
    return {"theirs": rows}


#: Model and kind of answer -> label, which of its points it stands beside, how far [pt], and on which side.
LINES = {
    ("spline", BEAM): ("splines,\nbeam", 0, (-8, -36), "right"),
    ("spline", CLAMPED_WIDTH): ("splines,\nclamped width", 2, (-5, -21), "right"),
    ("fe", BEAM): ("elements, beam", 0, (4, 8), "right"),
    ("fe", CLAMPED_WIDTH): ("elements,\nclamped width", 1, (8, -2), "left"),
    ("spline", SHEARED): ("splines,\nclamped width\nand shear", 2, (-5, -28), "right"),
    ("fe-shear", SHEARED): ("elements, clamped\nwidth and shear", 3, (8, -9), "left"),
}
#: Looks of our curves, hollow where they are those of a beam, and of what is in print.
OURS = {"spline": (BLUE, "o"), "fe": (BLACK, "s"), "fe-shear": (ORANGE, "^")}
LOOKS = {
    (model, answer): Look(label="_", colour=OURS[model][0], marker=OURS[model][1], hollow=answer == BEAM)
    for model, answer in LINES
}
PRINTED = Look(label="_", colour=PURPLE, line="", marker="x")
#: Where their labels stand, but above [pt].
THEIR_LABELS = {"constraint model": (5, -3), "guided beam": (0, -12), "same, optimised": (-60, 6)}


def _figure(tables: Tables) -> Figure:
    """Draw errors against solids over the time of a state, with what each theory leaves."""
    rows, printed = _timed(tables).sort_values("count"), tables["theirs"].query("error != 0")
    panel = Panel(
        Axis("wall_s", "time of a state, whole call [s]", log=True, limits=(1e-7, 3e4)),
        Axis(
            "error", "difference to solids of 3 mm [%]", factor=100.0, log=True,
            limits=(0.03, 30.0)
        ),
        (
            Curves(rows, LOOKS, by=("model", "answer"), along="count", more={"linewidth": 0.9}),
            Curves(printed, PRINTED),
            *_said(rows, printed),
            *_levels(tables["floors"]),
        ),
        title="Crosses: Su and Servey, their machine"
    )  # fmt: skip
    return sheet(6.3, 4.1, [[panel]])


def _said(rows: pd.DataFrame, printed: pd.DataFrame) -> Iterator[Words]:
    """Yield the names of our curves and of their theories."""
    for (model, answer), (text, point, by, side) in LINES.items():
        at = rows[(rows["model"] == model) & (rows["answer"] == answer)].iloc[point]
        place = (at["wall_s"], 100.0 * abs(at["error"]))
        yield Words(text, place, by=by, colour=LOOKS[model, answer].colour, side=side)
    for row in records(printed):
        place, by = (row["wall_s"], 100.0 * abs(row["error"])), THEIR_LABELS.get(row["model"], (0, 5))
        yield Words(row["model"], place, by=by, colour=PURPLE)


def _levels(floors: pd.DataFrame) -> Iterator[Mark]:
    """Yield what each theory leaves, with its name."""
    for row in records(floors):
        level = 100.0 * abs(row["error"])
        by = -9 if row["answer"] == SHEARED else 2  # below its line: another is close above
        yield Level(level, colour=GREY, line=":")
        text = f"{WORDS[row['answer']].label}: {level:.2g} %"
        yield Words(text, (1.2e-7, level), by=(0, by), colour=GREY)


def _cheaper(tables: Tables) -> list[dict[str, Any]]:
    """Return how many times longer their cheapest theory takes that is as near as our finest setting."""
    found, printed = [], tables["theirs"].query("error != 0")
    for row in records(_timed(tables)):
        if row["answer"] == SHEARED and (row["model"], row["count"]) in FINEST:
            near = printed[printed["error"].abs() <= abs(row["error"])]
            found.append({**row, "ratio": near["wall_s"].min() / row["wall_s"]})
    return found


def _timed(tables: Tables) -> pd.DataFrame:
    return tables["methods"].merge(tables["times"], on=["model", "answer", "setting", "count"])


def _floors() -> Answer:
    """Return what each theory leaves at that load, at the finest setting."""
    rows: Any = accounted(LOAD)["account"]
    return {"floors": [row for row in rows if row["mesh_mm"] == 3.0 and row["answer"] != SHELL]}


STUDY = Study(
    cases=(f"published/cases/{CASE}", f"published/tables/{CASE}"),
    parts=(
        Part(at=_asked, ask=_solved, alone=True),
        Part(ask=_theirs),
        Part(ask=_floors),
    ),
    claims=(
        Claim(
            claim="Either model is within 0.2 % of the solids of 3 mm with clamps over the width and shear",
            formulation="{model}, {setting}",
            quantity="the difference to their mesh of 3 mm",
            rows=lambda tables: [
                row
                for row in records(tables["methods"])
                if row["answer"] == SHEARED and (row["model"], row["count"]) in FINEST
            ],
            value="error",
            holds=lambda row: abs(row["error"]) <= CLOSE,
        ),
    ),
    claims_of_time=(
        Claim(
            claim="A state takes less time than theirs as near to the solids",
            formulation="{model}, {setting}, clamps over the width and shear",
            quantity="the time of theirs, on their machine, over it",
            rows=_cheaper,
            value="ratio",
            least=1.0,
            ratio=True,
        ),
    ),
    varying=("times",),
    figures={"headline": _figure},
)
