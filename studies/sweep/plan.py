"""A sweep as DESIGNS.toml describes it: which designs, in which order, and what is asked of each.

An error in the file is one line before anything is solved.
"""

import copy
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc

from studies.answers.models import put
from studies.answers.settings import MODELS
from studies.cases import document
from studies.cases.design import case_file
from studies.cases.document import CaseError
from studies.cases.keys import ROTATION
from studies.cases.rules import TRUTH, Key, Rule, choice, positive, shown, text, whole
from studies.kinds import Array
from studies.sweep import points, varied
from studies.sweep.points import KINDS, Task
from studies.sweep.varied import MOMENTS, SLENDERNESS

#: Values of a key that varies: numbers, or other values as objects.
Column = NDArray[Any]

#: Most points, whose varied values are all in memory.
MOST = 10_000_000
POINTS = whole(1, MOST)
FIELDS = ("from", "to", "points", "scale")
#: Keys of [sample].
SAMPLE = {
    "method": choice("grid", "list", "sobol"),
    "points": POINTS,
    "seed": whole(0, 2**32 - 1),
    "chunk": POINTS,
}
SECTIONS = ("settings", "set", "analysis", "sample", "vary", "store")
#: Most designs a chunk: a third of a second of static paths.
CHUNK = 64
#: Chunks that a sweep has at least, where they are not too small: enough for a few workers.
CHUNKS = 16
#: Kind of an analysis -> its options with their rules; and what options are that are not given.
OPTIONS: dict[str, dict[str, Rule]] = {
    "static": {},
    "modes": {"rotation_deg": ROTATION, "count": whole(1, 100), "held": TRUTH},
    "release": {
        "duration_s": positive("s"),
        "step_s": positive("s"),
        "integrator": text("the name of an integrator"),
    },
}
USUAL: dict[str, dict[str, Any]] = {"static": {}, "modes": {"count": 3}, "release": {"duration": 0.05}}


@dataclass(frozen=True, kw_only=True)
class Plan:
    """A sweep: the task, the values of each key that varies, in the file's units, designs a chunk, and what
    it was made from, to be kept beside it: DESIGNS.toml with its case."""

    task: Task
    columns: Mapping[str, Column]
    chunk: int
    content: dict[str, Any]

    @property
    def points(self) -> int:
        """Number of designs."""
        return len(next(iter(self.columns.values())))

    @property
    def chunks(self) -> int:
        """Number of chunks."""
        return -(-self.points // self.chunk)

    def span(self, number: int) -> tuple[int, int]:
        """Return the first point of a chunk and the one behind its last."""
        return number * self.chunk, min((number + 1) * self.chunk, self.points)

    def rows(self, start: int, stop: int) -> dict[str, list[Any]]:
        """Return the designs from `start` to before `stop` as columns by key."""
        return {key: column[start:stop].tolist() for key, column in self.columns.items()}


def read_plan(path: str | Path) -> Plan:
    """Return the sweep that the file describes.

    Raises:
        BadInput: one line with the file, the key, what was got and what was expected.
    """
    where = str(path)
    return plan_of(where, document.parsed(path), Path(path).parent)


def plan_of(where: str, content: Mapping[str, Any], folder: Path) -> Plan:
    """Return the sweep of a parsed file whose relative paths start from `folder`; CaseError as of
    `read_plan`."""
    tables = _tables(where, content)
    if not tables["vary"]:
        raise CaseError(f"{where}: [vary]: got nothing to vary, expected keys of the case, as strip.length_m")
    named = replace(text("the name of a case or a file"), read=partial(case_file, folder=folder))
    case = document.parsed(document.admitted(where, "case", named, content.get("case")))
    model = document.one_of(where, "model", content.get("model", "spline"), MODELS)
    known = varied.known(str(content["case"]), case, model)
    fixed = dict(_leaves(tables["set"]))
    for key, value in fixed.items():
        if key.startswith(varied.SETTINGS):
            raise CaseError(f"{where}: set.{key}: got a setting, expected it in [settings]")
        _require_known(where, "set", key, known)
        document.admitted(where, f"set.{key}", known[key], value)
    varied.put(case, fixed)
    settings = _values(where, "settings", varied.settings_rules(model), tables["settings"])
    asked = _values(where, "sample", SAMPLE, tables["sample"])
    columns = _sample_of(where, asked, tables["vary"], known)
    _refuse_overlaps(where, list(columns), case)
    kind, options = _analysis(where, tables["analysis"])
    found = points.known(case, kind, options.get("count", 0))
    task = Task(
        where=where,
        case=case,
        model=model,
        settings=settings,
        kind=kind,
        options=options,
        quantities=_quantities(where, tables["store"], found),
    )
    _require_usable(task, columns)
    count = len(next(iter(columns.values())))
    chunk = asked.get("chunk", min(CHUNK, -(-count // CHUNKS)))
    made_from = {**content, "case": case, "chunk": chunk}
    return Plan(task=task, columns=columns, chunk=chunk, content=copy.deepcopy(made_from))


def _tables(where: str, content: Mapping[str, Any]) -> dict[str, Mapping[str, Any]]:
    """Return the sections, empty where they are not there."""
    for name in content:
        if name in ("strip", "strips"):
            raise CaseError(f'{where}: [{name}]: got a case, expected a sweep, which names one: case = "..."')
        if name not in ("case", "model", *SECTIONS):
            expected = document.nearest(name, ["case", "model", *SECTIONS])
            raise CaseError(f"{where}: {name}: got an unknown name, expected {expected}")
    tables = {name: document.table(where, content, name) for name in SECTIONS}
    return tables | {"settings": {document.present(key): value for key, value in tables["settings"].items()}}


def _values(
    where: str, label: str, rules: Mapping[str, Rule], given: Mapping[str, Any], needed: Sequence[str] = ()
) -> dict[str, Any]:
    """Return the values of a table by its keys, each admitted by its rule; CaseError without a needed one."""
    keys = [Key(label, name, name, rule, optional=name not in needed) for name, rule in rules.items()]
    return document.values(where, keys, given, label)


def _refuse_overlaps(where: str, keys: list[str], case: Mapping[str, Any]) -> None:
    """Raise CaseError if a key comes twice, whole and in part, or beside a slenderness that sets it."""
    for key in keys:
        pair = key.rpartition(".")[0]
        if pair in keys:
            raise CaseError(f"{where}: vary.{key}: got it beside {pair}, expected one of them")
    given = [key for key in (*MOMENTS, "strip.thickness_m") if key in keys]
    given += ["strip.thickness_m"] if "outer_fibre_m" in case.get("strip", {}) else []
    if SLENDERNESS in keys and given:
        raise CaseError(f"{where}: vary.{SLENDERNESS}: got it beside {given[0]}, which it sets itself")


def _analysis(where: str, given: Mapping[str, Any]) -> tuple[str, dict[str, Any]]:
    """Return kind and options of a task, by their names without units."""
    kind = document.one_of(where, "analysis.kind", given.get("kind", "static"), KINDS)
    found = _values(where, "analysis", {"kind": choice(*KINDS), **OPTIONS[kind]}, given)
    named = {name.rpartition("_")[0] or name: value for name, value in found.items() if name != "kind"}
    return kind, USUAL[kind] | named


def _quantities(where: str, given: Mapping[str, Any], found: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the names of what is stored, of those that are found: as the file says, or what is usual."""
    document.refuse_unknown(where, "store", given, ["quantities"])
    names = given.get("quantities", [name for name, quantity in found.items() if quantity.usual])
    if not isinstance(names, list) or not names or len(set(map(str, names))) < len(names):
        raise CaseError(f"{where}: store.quantities: got {shown(names)}, expected different names in a list")
    for name in names:
        document.one_of(where, "store.quantities", name, tuple(found))
    return tuple(names)


def _require_usable(task: Task, columns: Mapping[str, Column]) -> None:
    """Raise BadInput unless the model takes the case and every setting.

    Ends of ranges and listed values have kept their own rules by now; here the case as a whole is read.
    """
    design = task.design({key: column[0] for key, column in columns.items()})
    settings = ((key, set(columns[key].tolist())) for key in columns if key.startswith(varied.SETTINGS))
    for values in ({}, *({key: value} for key, every in settings for value in every)):
        put(design, task.settings_of(values), moving=task.kind != "static")


def _sample_of(
    where: str, given: Mapping[str, Any], varied: Mapping[str, Any], known: Mapping[str, Rule]
) -> dict[str, Column]:
    """Return the values (D,) of each key that varies, in the file's units, as the section [vary] and the
    values of `SAMPLE` say; CaseError as of `read_plan`."""
    method = given.get("method", "grid")
    for name in ("points", "seed"):
        if name in given and method != "sobol":
            raise CaseError(f"{where}: sample.{name}: got it for a {method}, which has those of [vary]")
    if method == "sobol" and "points" not in given:
        raise CaseError(f"{where}: sample.points: got no such key, expected {POINTS.expected}")
    axes = {key: _axis(where, key, value, known, method) for key, value in _leaves(varied)}
    if method == "sobol":
        return _drawn(axes, given["points"], given.get("seed", 0))
    counts = {key: len(axis) for key, axis in axes.items()}
    if method == "list":
        if len(set(counts.values())) > 1:
            told = ", ".join(f"{key} {count}" for key, count in counts.items())
            raise CaseError(f"{where}: [vary]: got lists of different lengths ({told}), expected the same")
        return axes
    points = math.prod(counts.values())
    if points > MOST:
        raise CaseError(f"{where}: [vary]: got a grid of {points} points, expected at most {MOST}")
    mesh = np.meshgrid(*axes.values(), indexing="ij")  # the last axis runs fastest
    return {key: each.ravel() for key, each in zip(axes, mesh, strict=True)}


def _drawn(axes: Mapping[str, Any], points: int, seed: int) -> dict[str, Column]:
    """Return the columns of a random sample over axes."""
    sobol = qmc.Sobol(d=len(axes), scramble=True, seed=seed)
    unit = sobol.random_base2(math.ceil(math.log2(points)))[:points]
    return {
        key: axis(share) if callable(axis) else axis[(share * len(axis)).astype(int)]
        for (key, axis), share in zip(axes.items(), unit.T, strict=True)
    }


def _leaves(table: Mapping[str, Any], way: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the keys of nested tables with dots between the names, and what stands there.

    A table is gone into unless it has a field of an axis.
    """
    for name, value in table.items():
        if isinstance(value, dict) and value and not set(FIELDS) & set(value):
            yield from _leaves(value, f"{way}{name}.")
        else:
            yield f"{way}{name}", value


def _require_known(where: str, section: str, key: str, known: Mapping[str, Rule]) -> None:
    """Raise CaseError unless the case has the key."""
    if key not in known:
        expected = document.nearest(key, list(known))
        page = "" if expected.endswith(")") else ", which docs/cases.md lists"
        raise CaseError(f"{where}: {section}.{key}: got no key of the case, expected {expected}{page}")


def _axis(where: str, key: str, given: Any, known: Mapping[str, Rule], method: str) -> Any:
    """Return one axis of [vary]: its values, or, of a range that is drawn from, the values by shares (D,) of
    [0, 1]."""
    _require_known(where, "vary", key, known)
    label = f"vary.{key}"
    if isinstance(given, list):
        return _listed(where, label, known[key], given)
    if not isinstance(given, dict) or not given:
        raise CaseError(f"{where}: {label}: got {shown(given)}, expected a list or {{ from, to }}")
    document.refuse_unknown(where, label, given, FIELDS)
    if method == "list":
        raise CaseError(f'{where}: {label}: got a range, expected values for sample.method = "list"')
    return _range(where, label, given, known[key], grid=method == "grid")


def _listed(where: str, label: str, rule: Rule, values: list[Any]) -> Column:
    """Return listed values, each admitted by the rule: numbers as floats unless all are whole ones of a rule
    for these, pairs of numbers as tuples, texts and other lists as they are."""
    if not values:
        raise CaseError(f"{where}: {label}: got [], expected a list of values")
    for value in values:
        document.admitted(where, label, rule, value)
    whole = rule.kind != "number" and all(isinstance(value, int) for value in values)
    column: Column = np.empty(len(values), dtype=object)
    for place, value in enumerate(values):
        if isinstance(value, list) and all(isinstance(part, int | float) for part in value):
            column[place] = tuple(map(float, value))
        else:
            column[place] = float(value) if isinstance(value, int | float) and not whole else value
    if len({type(value) for value in column}) > 1:
        expected = "numbers, texts or pairs of numbers alone"
        raise CaseError(f"{where}: {label}: got values of different types, expected {expected}")
    return column


def _range(where: str, label: str, given: Mapping[str, Any], rule: Rule, *, grid: bool) -> Any:
    """Return an axis from a low to a high end, of a grid its values."""
    if rule.kind != "number":
        raise CaseError(f"{where}: {label}: got a range, expected values ({rule.expected})")
    if "points" in given and not grid:
        raise CaseError(f"{where}: {label}.points: got it without a grid, expected sample.points alone")
    fields = {"from": rule, "to": rule, "points": POINTS, "scale": choice("linear", "log")}
    found = _values(where, label, fields, given, ("from", "to", "points") if grid else ("from", "to"))
    low, high, log = given["from"], given["to"], found.get("scale") == "log"
    if not low < high:
        got = f"an empty range from {shown(low)} to {shown(high)}"
        raise CaseError(f"{where}: {label}: got {got}, expected from < to")
    if log and low <= 0:
        raise CaseError(f"{where}: {label}.from: got {low}, expected it above 0 for a logarithm")
    axis = partial(_spread, float(low), float(high), log)
    return axis(np.linspace(0.0, 1.0, found["points"])) if grid else axis


def _spread(low: float, high: float, log: bool, share: Array) -> Column:
    """Return the values at shares (D,) of [0, 1] of a range; the ends are exactly those of the file."""
    if log:
        values = np.exp(math.log(low) + (math.log(high) - math.log(low)) * share)
    else:
        values = low + (high - low) * share
    return np.asarray(np.clip(np.where(share == 1.0, high, values), low, high))
