"""The hard cases: every model judged with its own warnings and without."""

from collections.abc import Callable
from typing import Any

import pandas as pd

from report.facts import Cell, Fact, Holds, Rows, Table, fact
from report.forms import count, power, significant, unit
from report.results import Results, at, largest, least, where
from studies.registry import STUDIES
from studies.stability.family import DEFAULT, FE, PAPER, SIX, VARIED
from studies.stability.summary import GROUP

#: Families in the order of the register, and what counts as right in each.
FAMILIES = tuple(study.removeprefix(GROUP) for study in STUDIES if study.startswith(GROUP))
PATHS = "path and torque within 5 % of a refined spline and of elements"
CRITERIA = {
    "rotation": PATHS,
    "slenderness": PATHS,
    "geometry": PATHS,
    "buckling": "load or deflection within 5 % of a refined spline, elements and print",
    "step_size": "rotation within 5 % of the amplitude over 1200 steps or the first swing",
    "long_run": "energy within 10⁻⁶ over 100\u202f000 steps",
    "ratios": "rotation within 5 % of the amplitude over the first swing",
    "axial_modes": "torque within 5 % of a refined spline",
    "bad_starts": "the state of the path from rest, to 10⁻⁷",
    "fuzz": "path within 5 % of seventeen points; balance of energy to 10⁻⁸",
    "events": "rotation and energy within 5 %; balance of energy",
    "environment": "the same answer, to 10⁻¹² (frequencies 10⁻⁹)",
}
COLUMNS = {DEFAULT: "spline, default", FE: "20 elements", PAPER: "n = 4, as the paper"}
RIGHT, WARNED, STOPPED, WRONG, INVALID = "right", "warned", "stopped", "wrong", "bad input"
KINDS = (RIGHT, WARNED, STOPPED, WRONG, INVALID)


def kinds(rows: pd.DataFrame) -> "pd.Series[Any]":
    """Return how each case ends when every model is judged with its own warnings."""
    off = rows["outcome"].isin(["refused", "wrong"])
    found = rows["outcome"].mask(off & rows["warned"], WARNED).mask(off & rows["stopped"], STOPPED)
    return found


def _of(results: Results, family: str, model: str) -> pd.DataFrame:
    table = results.table(GROUP + family, "outcomes")
    return table[table["model"] == model]


def _number(results: Results, model: str, *some: str, families: tuple[str, ...] = FAMILIES) -> int:
    """Return how many cases of a model end in some of the kinds; all of them without any."""
    found = pd.concat([kinds(_of(results, family, model)) for family in families])
    return int(found.isin(some or KINDS).sum())


def _cell(results: Results, family: str, model: str) -> Cell:
    rows = _of(results, family, model)
    if rows.empty:
        return "–"
    found = kinds(rows)
    return " / ".join(count((found == kind).sum()) for kind in KINDS)


def _families(results: Results) -> Table:
    rows: Rows = [
        [
            family.replace("_", " "),
            CRITERIA[family],
            count(results.table(GROUP + family, "outcomes").groupby("model").size().max()),
            *(_cell(results, family, model) for model in COLUMNS),
        ]
        for family in FAMILIES
    ]
    return ["family", "right if", "cases", *COLUMNS.values()], rows


def _shared() -> tuple[str, ...]:
    """Families in which elements and the default are asked the same cases."""
    return ("rotation", "slenderness", "geometry", "buckling", "step_size", "ratios")


def _fact(made: Callable[[Results], Any]) -> Fact:
    return Fact(made=made, form=count)


def _outcomes(family: str, pick: Callable[[pd.DataFrame], Any], form: Any, model: str = DEFAULT) -> Fact:
    return fact(GROUP + family, "outcomes", lambda t: pick(where(t, model=model)), form)


def _last_right(rows: pd.DataFrame) -> float:
    return float(rows.loc[(rows["outcome"] == "right") & (rows["x"] > 0.0), "x"].max())


def _short(rows: pd.DataFrame) -> int:
    """Return how many right motions end before a quarter of a swing, some 3 ms, in 1200 steps."""
    return int(((rows["outcome"] == "right") & (1200.0 * rows["x"] < 3e-3)).sum())


def _right_kind(kind: str) -> Fact:
    return _outcomes("fuzz", lambda t: int((where(t, kind=kind)["outcome"] == "right").sum()), count)


def _angle(value: float) -> str:
    return f"{significant(value, 3)}°"


def _bifurcation(model: str) -> Fact:
    return fact(
        GROUP + "buckling",
        "critical",
        at("load", part="column", model=model, kind="bifurcation"),
        lambda value: significant(value, 6),
    )


FACTS = {
    "hard.families": _fact(lambda _: len(FAMILIES)),
    "hard.both.tried": _fact(lambda r: _number(r, FE, families=_shared())),
    "hard.both.fe.right": _fact(lambda r: _number(r, FE, RIGHT, families=_shared())),
    "hard.both.default.right": _fact(lambda r: _number(r, DEFAULT, RIGHT, families=_shared())),
    "hard.total.default.tried": _fact(lambda r: _number(r, DEFAULT)),
    "hard.total.default.silent": _fact(lambda r: _number(r, DEFAULT, WRONG)),
    "hard.total.default.wrong": _fact(lambda r: _number(r, DEFAULT, WRONG, WARNED)),
    "hard.total.paper.tried": _fact(lambda r: _number(r, PAPER)),
    "hard.total.paper.wrong": _fact(lambda r: _number(r, PAPER, WRONG, WARNED)),
    "hard.total.paper.silent": _fact(lambda r: _number(r, PAPER, WRONG)),
    "hard.total.varied.tried": _fact(lambda r: _number(r, VARIED)),
    "hard.total.varied.right": _fact(lambda r: _number(r, VARIED, RIGHT)),
    "hard.total.varied.wrong": _fact(lambda r: _number(r, VARIED, WRONG)),
    "hard.fuzz.paths": _right_kind("path"),
    "hard.fuzz.motions": _right_kind("motion"),
    "hard.step_size.right": _fact(lambda r: _number(r, DEFAULT, RIGHT, families=("step_size",))),
    "hard.step_size.short": _outcomes("step_size", _short, count),
    "hard.rotation.to": _outcomes("rotation", _last_right, _angle),
    "hard.rotation.right-to": _outcomes("rotation", _last_right, _angle, SIX),
    "hard.slenderness.most": fact(GROUP + "slenderness", "limit", largest("slenderness"), power),
    "hard.slenderness.constant": fact(
        GROUP + "slenderness", "limit", largest("constant"), lambda v: significant(v, 3)
    ),
    "hard.slenderness.iterations": fact(GROUP + "slenderness", "limit", largest("iterations"), count),
    "hard.slenderness.iterations-least": fact(GROUP + "slenderness", "limit", least("iterations"), count),
    "hard.buckling.load": _bifurcation(DEFAULT),
    "hard.buckling.load.paper": _bifurcation(PAPER),
    "hard.buckling.pivot": fact(
        GROUP + "buckling", "branches", lambda t: t["first_bifurcation_mm"].dropna().min(), unit("mm", 3)
    ),
    "hard.buckling.turn": fact(GROUP + "buckling", "branches", largest("turn_deg"), _angle),
    "hard.buckling.down": fact(GROUP + "buckling", "branches", largest("reached_mm"), unit("mm")),
    "hard.long_run.steps": fact(GROUP + "long_run", "drift", largest("steps", model=DEFAULT), count),
    "hard.long_run.energy": fact(GROUP + "long_run", "drift", largest("energy_change", model=DEFAULT), power),
    "hard.long_run.residual": fact(
        GROUP + "long_run",
        "drift",
        largest("constraint_residual_m", model=DEFAULT),
        lambda v: f"{power(v)}\u00a0m",
    ),
}

HOLDS: dict[str, Holds] = {
    "hard.spline-loses": Holds(
        words="elements are right in more of the shared cases than the default",
        test=lambda r: (
            _number(r, FE, RIGHT, families=_shared()) > _number(r, DEFAULT, RIGHT, families=_shared())
        ),
    ),
    "hard.silent": Holds(
        words="the default is wrong without a warning in fewer than one of a hundred cases",
        test=lambda r: 100 * _number(r, DEFAULT, WRONG) < _number(r, DEFAULT),
    ),
    "hard.paper-most-wrong": Holds(
        words="the paper's choices are wrong in more than half of the cases",
        test=lambda r: _number(r, PAPER, WRONG, WARNED) > _number(r, PAPER) / 2,
    ),
    "hard.fuzz.none-wrong": Holds(
        words="no random design is wrong by the default",
        test=lambda r: _number(r, DEFAULT, WRONG, families=("fuzz",)) == 0,
    ),
    "hard.environment.order": Holds(
        words="the paper's choices alone depend on the order of strips, and on nothing else",
        test=lambda r: (
            (wrong := r.table(GROUP + "environment", "outcomes").query("outcome == 'wrong'"))["case"]
            .str.contains("reversed|first")
            .all()
            and set(wrong["model"]) == {PAPER}
        ),
    ),
    "hard.long_run.bounded": Holds(
        words="the energy of the long run changes by less than 1e-9 of itself",
        test=lambda r: r.table(GROUP + "long_run", "drift")["energy_change"].abs().max() < 1e-9,
    ),
}
LISTINGS = {"families": _families}
