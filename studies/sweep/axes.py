"""Which designs: the sections [sample] and [vary] of DESIGNS.toml, and the points that they say, in order."""

import math
from collections.abc import Iterator, Mapping
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc

from studies.cases import document
from studies.cases.document import CaseError
from studies.cases.rules import Key, Rule, choice, shown, whole
from studies.kinds import Array

#: Values of a key that varies: numbers, or other values as objects.
Column = NDArray[Any]

METHODS = ("grid", "list", "sobol")
#: Most points, whose varied values are all in memory.
MOST = 10_000_000
POINTS = whole(1, MOST)
FIELDS = ("from", "to", "points", "scale")
#: Keys of [sample].
KEYS = tuple(
    Key("sample", name, name, rule, optional=True)
    for name, rule in {
        "method": choice(*METHODS),
        "points": POINTS,
        "seed": whole(0, 2**32 - 1),
        "chunk": POINTS,
    }.items()
)


def sample_of(
    where: str, given: Mapping[str, Any], varied: Mapping[str, Any], known: Mapping[str, Rule]
) -> dict[str, Column]:
    """Return the values (D,) of each key that varies, in the file's units, as the section [vary] and the
    values of `KEYS` say; CaseError as of `studies.sweep.plan.read_plan`."""
    method = given.get("method", "grid")
    for name in ("points", "seed"):
        if name in given and method != "sobol":
            raise CaseError(f"{where}: sample.{name}: got it for a {method}, which has those of [vary]")
    if method == "sobol" and "points" not in given:
        raise CaseError(f"{where}: sample.points: got no such key, expected {POINTS.expected}")
    axes = {key: _axis(where, key, value, known, method) for key, value in leaves(varied)}
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


def leaves(table: Mapping[str, Any], way: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the keys of nested tables with dots between the names, and what stands there.

    A table is gone into unless it has a field of an axis.
    """
    for name, value in table.items():
        if isinstance(value, dict) and value and not set(FIELDS) & set(value):
            yield from leaves(value, f"{way}{name}.")
        else:
            yield f"{way}{name}", value


def require_known(where: str, section: str, key: str, known: Mapping[str, Rule]) -> None:
    """Raise CaseError unless the case has the key."""
    if key not in known:
        expected = document.nearest(key, list(known))
        page = "" if expected.endswith(")") else ", which docs/cases.md lists"
        raise CaseError(f"{where}: {section}.{key}: got no key of the case, expected {expected}{page}")


def _axis(where: str, key: str, given: Any, known: Mapping[str, Rule], method: str) -> Any:
    """Return one axis of [vary]: its values, or, of a range that is drawn from, the values by shares (D,) of
    [0, 1]."""
    require_known(where, "vary", key, known)
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
    optional = {"scale", "points"} - ({"points"} if grid else set())
    keys = [Key(label, name, name, each, optional=name in optional) for name, each in fields.items()]
    found = document.values(where, keys, given, label)
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
