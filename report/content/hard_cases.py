"""The hard cases: every model judged with its own warnings and without."""

from functools import lru_cache, partial
from typing import Any

import pandas as pd

from report.facts import FACTS, Fact, Results, Stored, Table, holds, listing
from report.forms import angle, count, digits, power, unit
from studies.registry import STUDIES

GROUP = "stability/"
DEFAULT, VARIED, SIX = "spline, default", "spline, settings varied", "spline n = 6"
PAPER, FE = "spline n = 4, as the paper", "FE, 20 elements"
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
}
#: Families in which elements and the default are asked the same cases.
SHARED = ("rotation", "slenderness", "geometry", "buckling", "step_size", "ratios")
COLUMNS = {DEFAULT: "spline, default", FE: "20 elements", PAPER: "n = 4, as the paper"}
RIGHT, WARNED, STOPPED, WRONG, INVALID = "right", "warned", "stopped", "wrong", "bad input"
KINDS = (RIGHT, WARNED, STOPPED, WRONG, INVALID)
SLENDER = Stored(GROUP + "slenderness", "limit")
LONG = Stored(GROUP + "long_run", "drift")
BRANCHES = Stored(GROUP + "buckling", "branches")
COLUMN = Stored(GROUP + "buckling", "critical", part="column", kind="bifurcation")
AGAINST = Stored(GROUP + "fuzz", "elements")


def kinds(rows: pd.DataFrame) -> "pd.Series[Any]":
    """Return how each case ends when every model is judged with its own warnings."""
    off = rows["outcome"].isin(["refused", "wrong"])
    return rows["outcome"].mask(off & rows["warned"], WARNED).mask(off & rows["stopped"], STOPPED)


def _outcomes(family: str, model: str = DEFAULT) -> Stored:
    return Stored(GROUP + family, "outcomes", model=model)


@lru_cache(maxsize=1)
def _all(results: Results) -> pd.DataFrame:
    """Return model, family and kind of end of every case that a model was asked; once, for twenty facts."""
    tables = (results.table(GROUP + family, "outcomes").assign(family=family) for family in FAMILIES)
    every = pd.concat(tables)
    return every.assign(kind=kinds(every))


def _number(model: str, *some: str, families: tuple[str, ...] = FAMILIES, results: Results) -> int:
    """Return how many cases of a model end in some of the kinds; all of them without any."""
    own = _all(results).query("model == @model and family in @families")
    return int(own["kind"].isin(some or KINDS).sum())


@listing("families")
def _families(results: Results) -> Table:
    every = _all(results)
    ends = every.groupby(["family", "model"])["kind"].value_counts().unstack().reindex(columns=list(KINDS))
    yield ["family", "right if", "cases", *COLUMNS.values()]
    for family, own in every.groupby("family", sort=False):
        asked = (ends.fillna(0).loc[family].reindex([model]).iloc[0] for model in COLUMNS)
        cells = ("–" if each.isna().all() else " / ".join(map(count, each)) for each in asked)
        most = count(own["model"].value_counts().max())
        yield [str(family).replace("_", " "), CRITERIA[str(family)], most, *cells]


def _last_right(rows: pd.DataFrame) -> float:
    return float(rows.loc[(rows["outcome"] == RIGHT) & (rows["x"] > 0.0), "x"].max())


def _short(rows: pd.DataFrame) -> int:
    """Return how many motions end before a quarter of a swing, some 3 ms, in 1200 steps."""
    return int((1200.0 * rows["x"] < 3e-3).sum())


def _total(model: str, *some: str, families: tuple[str, ...] = FAMILIES) -> Fact:
    return Fact(made=lambda r: _number(model, *some, families=families, results=r), form=count)


FACTS |= {
    "hard.families": Fact(made=lambda _: len(FAMILIES), form=count),
    "hard.both.tried": _total(FE, families=SHARED),
    "hard.both.fe.right": _total(FE, RIGHT, families=SHARED),
    "hard.both.default.right": _total(DEFAULT, RIGHT, families=SHARED),
    "hard.total.default.tried": _total(DEFAULT),
    "hard.total.default.silent": _total(DEFAULT, WRONG),
    "hard.total.default.wrong": _total(DEFAULT, WRONG, WARNED),
    "hard.total.paper.tried": _total(PAPER),
    "hard.total.paper.wrong": _total(PAPER, WRONG, WARNED),
    "hard.total.paper.silent": _total(PAPER, WRONG),
    "hard.total.varied.tried": _total(VARIED),
    "hard.total.varied.right": _total(VARIED, RIGHT),
    "hard.total.varied.wrong": _total(VARIED, WRONG),
    "hard.fuzz.paths": _outcomes("fuzz").fact(len, count, kind="path", outcome=RIGHT),
    "hard.fuzz.motions": _outcomes("fuzz").fact(len, count, kind="motion", outcome=RIGHT),
    "hard.against.asked": AGAINST.fact(len, count),
    "hard.against.compared": AGAINST.fact(lambda rows: rows["error"].notna().sum(), count),
    "hard.against.largest": AGAINST.largest("error", power),
    "hard.step_size.right": _outcomes("step_size").fact(len, count, outcome=RIGHT),
    "hard.step_size.short": _outcomes("step_size").fact(_short, count, outcome=RIGHT),
    "hard.rotation.to": _outcomes("rotation").fact(_last_right, angle(3)),
    "hard.rotation.right-to": _outcomes("rotation", SIX).fact(_last_right, angle(3)),
    "hard.slenderness.most": SLENDER.largest("slenderness", power),
    "hard.slenderness.constant": SLENDER.largest("constant", digits(3)),
    "hard.slenderness.iterations": SLENDER.fact(
        lambda rows: " to ".join(map(count, dict.fromkeys(rows["iterations"].agg(["min", "max"])))), str
    ),
    "hard.buckling.load": COLUMN.at("load", digits(6), model=DEFAULT),
    "hard.buckling.load.paper": COLUMN.at("load", digits(6), model=PAPER),
    "hard.buckling.pivot": BRANCHES.least("first_bifurcation_mm", unit("mm", 3)),
    "hard.buckling.turn": BRANCHES.largest("turn_deg", angle(3)),
    "hard.buckling.down": BRANCHES.largest("reached_mm", unit("mm")),
    "hard.long_run.steps": LONG.largest("steps", count, model=DEFAULT),
    "hard.long_run.energy": LONG.largest("energy_change", power, model=DEFAULT),
    "hard.long_run.residual": LONG.largest(
        "constraint_residual_m", lambda v: f"{power(v)}\u00a0m", model=DEFAULT
    ),
}


@holds("hard.spline-loses")
def _(r: Results) -> Any:
    """elements are right in more of the shared cases than the default"""
    right = partial(_number, families=SHARED, results=r)
    return right(FE, RIGHT) > right(DEFAULT, RIGHT)


@holds("hard.silent")
def _(r: Results) -> Any:
    """the default is wrong without a warning in fewer than one of a hundred cases"""
    return 100 * _number(DEFAULT, WRONG, results=r) < _number(DEFAULT, results=r)


@holds("hard.paper-most-wrong")
def _(r: Results) -> Any:
    """the paper's choices are wrong in more than half of the cases"""
    return 2 * _number(PAPER, WRONG, WARNED, results=r) > _number(PAPER, results=r)


@holds("hard.fuzz.none-wrong")
def _(r: Results) -> Any:
    """no random design is wrong by the default"""
    return _number(DEFAULT, WRONG, families=("fuzz",), results=r) == 0


@holds("hard.against.within")
def _(r: Results) -> Any:
    """every random path that elements follow too is within 5 % of theirs"""
    return AGAINST.rows(r)["error"].max() <= 0.05


@holds("hard.long_run.bounded")
def _(r: Results) -> Any:
    """the energy of the long run changes by less than 1e-9 of itself"""
    return LONG.rows(r)["energy_change"].abs().max() < 1e-9
