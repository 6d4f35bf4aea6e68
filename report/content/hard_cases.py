"""The hard cases, family by family."""

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import pandas as pd

from report.facts import Cell, Fact, Holds, Rows, Table, fact
from report.forms import count, percent, power, significant, text, unit
from report.results import Results, at, largest, least, where
from studies.registry import STUDIES
from studies.stability.family import DEFAULT, FE, OUTCOMES, PAPER, SIX, VARIED
from studies.stability.maps import LOOKS
from studies.stability.summary import GROUP

#: Kinds of random designs in their table.
STATIC, MOTION = "path", "motion"

#: Families in the order of the register.
FAMILIES = tuple(study.removeprefix(GROUP) for study in STUDIES if study.startswith(GROUP))
#: Columns of the table of all families; what else a family tried stands in its figure.
COLUMNS = (DEFAULT, "spline n = 4, locking-free", PAPER, "spline n = 4, printed forces", FE)

#: Families that the text says the default is right in throughout.
ALL_RIGHT = ("rotation", "slenderness", "buckling", "bad_starts")
#: What a model says that stopped before the end.
STOPPED = r"\bstopped (?:at|between)\b"


def _counts(results: Results, family: str) -> pd.DataFrame:
    return results.table(GROUP + family, "counts")


def _cell(results: Results, family: str, model: str) -> Cell:
    rows = _counts(results, family)
    rows = rows[rows["model"] == model]
    if rows.empty:
        return "–"
    row = rows.iloc[0]
    worst = "wrong" if row["wrong"] else "right" if row["right"] else "refused"
    return {"text": " / ".join(count(row[name]) for name in OUTCOMES), "colour": LOOKS[worst][0]}


def _families(results: Results) -> Table:
    rows: Rows = [
        [family.replace("_", " "), *(_cell(results, family, model) for model in COLUMNS)]
        for family in FAMILIES
    ]
    return ["family", *COLUMNS], rows


def _number(family: str, model: str, outcome: str) -> Fact:
    """Return how many cases of a family ended so; none where the model was not asked."""

    def pick(table: pd.DataFrame) -> int:
        rows = table[table["model"] == model]
        return int(rows[outcome].iloc[0]) if len(rows) else 0

    return fact(GROUP + family, "counts", pick, count)


def _outcomes_of(results: Results, family: str) -> str:
    """Return in words how the cases of a family end, with default settings and with those that vary."""
    said = []
    for model, name in ((DEFAULT, "The default"), (VARIED, "With settings that vary")):
        rows = _counts(results, family).query("model == @model", local_dict={"model": model})
        if len(rows):
            row = rows.iloc[0]
            ends = ", ".join(
                f"{count(row[outcome])} {word}"
                for outcome, word in zip(OUTCOMES, ("right", "refused", "wrong", "not askable"), strict=True)
            )
            largest_right = _error(float(row["largest_right_error"]))
            said.append(
                f"{name}: {ends}, of {count(row['tried'])}; largest error of a right answer {largest_right}."
            )
    return " ".join(said)


def _others(results: Results, family: str) -> str:
    """Return how often the paper's choices and the elements are wrong, of those that were asked."""
    parts = []
    for model, name in ((PAPER, "The paper's choices are"), (FE, "Twenty elements are")):
        rows = _counts(results, family)
        rows = rows[rows["model"] == model]
        if len(rows):
            parts.append(f"{name} wrong in {count(rows['wrong'].iloc[0])} of {count(rows['tried'].iloc[0])}.")
    return " ".join(parts)


def _error(value: float) -> str:
    return percent(value) if value > 1e-4 else power(value)


def _none_wrong(family: str, model: str) -> Holds:
    return Holds(
        words=f"{model} has no wrong answer in the family {family}",
        test=lambda r: int(at("wrong", model=model)(_counts(r, family))) == 0,
    )


def _random_paths(results: Results) -> pd.DataFrame:
    return where(results.table(GROUP + "fuzz", "outcomes"), model=DEFAULT, kind=STATIC)


def _share_right(results: Results, family: str, model: str) -> float:
    row = where(_counts(results, family), model=model).iloc[0]
    return float(row["right"] / row["tried"])


def _all_right(family: str) -> Holds:
    return Holds(
        words=f"the default is right in every case of the family {family}",
        test=lambda r: _share_right(r, family, DEFAULT) == 1.0,
    )


def _total(results: Results, model: str, outcome: str, families: Sequence[str] = FAMILIES) -> int:
    return sum(
        int(rows[outcome].sum())
        for family in families
        for rows in [_counts(results, family).query("model == @model", local_dict={"model": model})]
    )


def _refusals(results: Results, *, stopped: bool) -> pd.DataFrame:
    """Return the refusals of the default that stopped, or those that answered with a warning."""
    tables = [results.table(GROUP + family, "outcomes") for family in FAMILIES]
    refused = pd.concat([table.query("model == @DEFAULT and outcome == 'refused'") for table in tables])
    return refused[refused["reason"].str.contains(STOPPED) == stopped]


def _right_kind(kind: str) -> Fact:
    """Return how many random designs of this kind count as right."""
    return _outcomes("fuzz", lambda t: int((where(t, kind=kind)["outcome"] == "right").sum()), count)


def _outcomes(
    family: str, pick: Callable[[pd.DataFrame], Any], form: Callable[[Any], str], model: str = DEFAULT
) -> Fact:
    """Return a fact from the default's rows of a family's outcomes, or those of another model."""
    return fact(GROUP + family, "outcomes", lambda t: pick(where(t, model=model)), form)


def _first_refused(rows: pd.DataFrame) -> float:
    refused = rows[(rows["outcome"] == "refused") & (rows["x"] > 0.0)]
    return float(refused["x"].min())


def _last_right(rows: pd.DataFrame) -> float:
    return float(rows.loc[(rows["outcome"] == "right") & (rows["x"] > 0.0), "x"].max())


def _rotation_ends(results: Results) -> bool:
    rows = where(results.table(GROUP + "rotation", "outcomes"), model=SIX)
    reasons = rows.loc[rows["outcome"] == "refused", "reason"]
    for_want = reasons.str.contains("control points do not resolve").all()
    return bool(for_want) and _first_refused(rows) > _last_right(rows)


def _span(rows: pd.DataFrame) -> float:
    """Return the largest factor over the least, of those that are not nought."""
    factors = rows.loc[rows["x"] > 0.0, "x"]
    return float(factors.max() / factors.min())


def _bifurcation(model: str) -> Fact:
    return fact(
        GROUP + "buckling",
        "critical",
        at("load", part="column", model=model, kind="bifurcation"),
        lambda value: significant(value, 6),
    )


FACTS = {
    f"hard.{family}.outcomes": Fact(made=partial(_outcomes_of, family=family), form=text)
    for family in FAMILIES
}
FACTS |= {
    f"hard.{family}.others": Fact(made=partial(_others, family=family), form=text) for family in FAMILIES
}
FACTS["hard.families"] = Fact(made=lambda _: len(FAMILIES), form=count)
FACTS["hard.step_size.fe.refused"] = _number("step_size", FE, "refused")
FACTS |= {
    f"hard.total.{name}.{outcome}": Fact(made=partial(_total, model=model, outcome=outcome), form=count)
    for name, model, outcomes in (
        ("default", DEFAULT, ("tried", "right", "refused", "bad input", "wrong")),
        ("varied", VARIED, ("tried", "right", "wrong")),
        ("paper", PAPER, ("tried", "wrong")),
        ("fe", FE, ("tried", "wrong")),
    )
    for outcome in outcomes
}
FACTS |= {
    "hard.environment.differs": _outcomes("environment", lambda rows: rows["error"].max(), power),
    "hard.total.default.stopped": Fact(made=lambda r: len(_refusals(r, stopped=True)), form=count),
    "hard.total.default.warned": Fact(made=lambda r: len(_refusals(r, stopped=False)), form=count),
    "hard.total.default.warned.error": Fact(
        made=lambda r: _refusals(r, stopped=False)["error"].max(), form=percent
    ),
    "hard.fuzz.paths": _right_kind(STATIC),
    "hard.fuzz.motions": _right_kind(MOTION),
    "hard.rotation.right-to": _outcomes("rotation", _last_right, lambda v: f"{significant(v, 3)}°", SIX),
    "hard.rotation.to": _outcomes("rotation", _last_right, lambda v: f"{significant(v, 3)}°"),
    "hard.rotation.refused-from": _outcomes(
        "rotation", _first_refused, lambda v: f"{significant(v, 3)}°", SIX
    ),
    "hard.rotation.hysteresis": fact(GROUP + "rotation", "increments", largest("hysteresis"), power),
    "hard.rotation.increments": fact(GROUP + "rotation", "increments", largest("torque_change"), power),
    "hard.slenderness.most": fact(GROUP + "slenderness", "limit", largest("slenderness"), power),
    "hard.slenderness.constant": fact(
        GROUP + "slenderness", "limit", largest("constant"), lambda v: significant(v, 3)
    ),
    "hard.slenderness.iterations": fact(GROUP + "slenderness", "limit", largest("iterations"), count),
    "hard.slenderness.iterations-least": fact(GROUP + "slenderness", "limit", least("iterations"), count),
    "hard.buckling.load": _bifurcation(DEFAULT),
    "hard.buckling.load.paper": _bifurcation(PAPER),
    "hard.buckling.pivot": fact(
        GROUP + "buckling",
        "branches",
        lambda t: t["first_bifurcation_mm"].dropna().min(),
        unit("mm", 3),
    ),
    "hard.buckling.turn": fact(
        GROUP + "buckling", "branches", largest("turn_deg"), lambda v: f"{significant(v)}°"
    ),
    "hard.buckling.down": fact(GROUP + "buckling", "branches", largest("reached_mm"), unit("mm")),
    "hard.step_size.longest": _outcomes(
        "step_size", lambda t: t.loc[t["outcome"] == "right", "x"].max(), unit("µs", 2, 1e6)
    ),
    "hard.step_size.gain": _outcomes("step_size", lambda t: t["energy_gain"].abs().max(), power),
    "hard.long_run.steps": fact(GROUP + "long_run", "drift", largest("steps", model=DEFAULT), count),
    "hard.long_run.energy": fact(GROUP + "long_run", "drift", largest("energy_change", model=DEFAULT), power),
    "hard.long_run.residual": fact(
        GROUP + "long_run",
        "drift",
        largest("constraint_residual_m", model=DEFAULT),
        lambda v: f"{power(v)}\u00a0m",
    ),
    "hard.ratios.span": _outcomes("ratios", _span, power),
    "hard.fuzz.span": _outcomes("fuzz", lambda t: t["y"].max() / t["y"].min(), significant),
}

HOLDS: dict[str, Holds] = {
    "hard.none-wrong": Holds(
        words="no family has a wrong answer of the default",
        test=lambda r: _total(r, DEFAULT, "wrong") == 0,
    ),
    "hard.none-wrong-but-by-order": Holds(
        words="the default is wrong in no family but where strips and bodies are put in another order",
        test=lambda r: _total(r, DEFAULT, "wrong") == _total(r, DEFAULT, "wrong", ["environment"]),
    ),
    "hard.fe-none-wrong": Holds(
        words="twenty elements are wrong in no case", test=lambda r: _total(r, FE, "wrong") == 0
    ),
    "hard.paper-most-wrong": Holds(
        words="the paper's choices are wrong in more than half of the cases",
        test=lambda r: _total(r, PAPER, "wrong") > _total(r, PAPER, "tried") / 2,
    ),
    "hard.rotation.ends": Holds(
        words="six control points are refused only beyond their last right rotation, and as too few",
        test=_rotation_ends,
    ),
    "hard.fuzz.paths-right": Holds(
        words="the default is right on every path of the random designs that can be asked",
        test=lambda r: set(_random_paths(r)["outcome"]) <= {"right", "bad input"},
    ),
    "hard.step_size.fe-says": Holds(
        words="twenty elements are wrong at no step size without saying so",
        test=lambda r: int(at("wrong", model=FE)(_counts(r, "step_size"))) == 0,
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
    **{
        f"hard.{family}.none-wrong": _none_wrong(family, VARIED if family == "axial_modes" else DEFAULT)
        for family in FAMILIES
        if family not in ALL_RIGHT
    },
    **{f"hard.{family}.all-right": _all_right(family) for family in ALL_RIGHT},
}
LISTINGS = {"families": _families}
