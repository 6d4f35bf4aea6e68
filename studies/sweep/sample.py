"""Which designs: the sections [sample] and [vary] of DESIGNS.toml, and the points that they say, in order."""

import math
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
from scipy.stats import qmc

from studies.cases import document
from studies.cases.document import CaseError
from studies.cases.rules import Key, choice, shown, whole
from studies.kinds import Array
from studies.sweep.plan import Column

METHODS = ("grid", "list", "sobol")
#: Most points, whose varied values are all in memory.
MOST = 10_000_000
POINTS = whole(1, MOST)
FIELDS = ("from", "to", "points", "scale")
SCALES = ("linear", "log")
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


class _Range(NamedTuple):
    """Values from a low to a high end; `log`: even steps of the logarithm."""

    low: float
    high: float
    log: bool

    def at(self, share: Array) -> Column:
        """Return the values at shares (D,) of [0, 1]; the ends are exactly those of the file."""
        if self.log:
            low, high = math.log(self.low), math.log(self.high)
            values = np.exp(low + (high - low) * share)
        else:
            values = self.low + (self.high - self.low) * share
        found: Column = np.clip(np.where(share == 1.0, self.high, values), self.low, self.high)
        return found


def sample_of(
    where: str, given: Mapping[str, Any], varied: Mapping[str, Any], known: Mapping[str, Any]
) -> dict[str, Column]:
    """Return the values (D,) of each key that varies, in the file's units, as the section [vary] and the
    values of `KEYS` say; CaseError as of `read_plan`."""
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
    shares = dict(zip(axes, unit.T, strict=True))
    return {
        key: axis.at(shares[key]) if isinstance(axis, _Range) else axis[(shares[key] * len(axis)).astype(int)]
        for key, axis in axes.items()
    }


def leaves(table: Mapping[str, Any], way: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the keys of nested tables with dots between the names, and what stands there.

    A table is gone into unless it has a field of an axis.
    """
    for name, value in table.items():
        key = f"{way}.{name}" if way else name
        if isinstance(value, dict) and value and not set(FIELDS) & set(value):
            yield from leaves(value, key)
        else:
            yield key, value


def require_known(where: str, section: str, key: str, known: Mapping[str, Any]) -> None:
    """Raise CaseError unless the case has the key."""
    if key not in known:
        expected = document.nearest(key, list(known))
        page = "" if expected.endswith(")") else ", which docs/cases.md lists"
        raise CaseError(f"{where}: {section}.{key}: got no key of the case, expected {expected}{page}")


def _axis(where: str, key: str, given: Any, known: Mapping[str, Any], method: str) -> Any:
    """Return one axis of [vary]: its values, or the range that they are drawn from."""
    require_known(where, "vary", key, known)
    label = f"vary.{key}"
    if isinstance(given, list):
        return _listed(where, label, known[key], given)
    if not isinstance(given, dict) or not given:
        raise CaseError(f"{where}: {label}: got {shown(given)}, expected a list or {{ from, to }}")
    document.refuse_unknown(where, label, given, FIELDS)
    if method == "list":
        raise CaseError(f'{where}: {label}: got a range, expected values for sample.method = "list"')
    return _range(where, key, given, known[key], grid=method == "grid")


def _listed(where: str, label: str, rule: Any, values: list[Any]) -> Column:
    """Return listed values, each admitted by the rule; pairs as tuples."""
    if not values:
        raise CaseError(f"{where}: {label}: got [], expected a list of values")
    for value in values:
        document.admitted(where, label, rule, value)
    whole = rule.kind != "number" and all(isinstance(value, int) for value in values)
    kept = values if whole else [_kept(value) for value in values]
    if len({type(value) for value in kept}) > 1:
        expected = "numbers, texts or pairs of numbers alone"
        raise CaseError(f"{where}: {label}: got values of different types, expected {expected}")
    column: Column = np.empty(len(kept), dtype=object)
    for place, value in enumerate(kept):
        column[place] = value
    return column


def _kept(value: Any) -> Any:
    """Return a number as a float, and a pair of numbers as a tuple; other texts and lists as they are."""
    if isinstance(value, list) and all(isinstance(part, int | float) for part in value):
        return tuple(map(float, value))
    return float(value) if isinstance(value, int | float) and not isinstance(value, bool) else value


def _range(where: str, key: str, given: Mapping[str, Any], rule: Any, *, grid: bool) -> Any:
    """Return an axis from a low to a high end, of a grid its values."""
    label = f"vary.{key}"
    if rule.kind != "number":
        raise CaseError(f"{where}: {label}: got a range, expected values ({rule.expected})")
    if "points" in given and not grid:
        raise CaseError(f"{where}: {label}.points: got it without a grid, expected sample.points alone")
    fields = {"from": rule, "to": rule, "points": POINTS, "scale": choice(*SCALES)}
    optional = {"scale", "points"} - ({"points"} if grid else set())
    keys = [Key(label, name, name, each, optional=name in optional) for name, each in fields.items()]
    found = document.values(where, keys, given, label)
    low, high, log = given["from"], given["to"], found.get("scale") == "log"
    if not low < high:
        got = f"an empty range from {shown(low)} to {shown(high)}"
        raise CaseError(f"{where}: {label}: got {got}, expected from < to")
    if log and low <= 0:
        raise CaseError(f"{where}: {label}.from: got {low}, expected it above 0 for a logarithm")
    whole = _Range(float(low), float(high), log)
    return whole.at(np.linspace(0.0, 1.0, found["points"])) if grid else whole
