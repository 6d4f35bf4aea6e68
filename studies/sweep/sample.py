"""Which designs: the sections [sample] and [vary] of DESIGNS.toml, and the points that they say, in order."""

import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import qmc

from studies.cases import document
from studies.cases.document import CaseError
from studies.cases.rules import Key, choice, shown, text, whole
from studies.kinds import Array
from studies.sweep.plan import METHODS, Axis, Sample

MOST = 100_000_000
POINTS = whole(1, MOST)
FIELDS = ("from", "to", "points", "scale", "values")
SCALES = ("linear", "log")
#: Keys of [sample].
KEYS = tuple(
    Key("sample", name, name, rule, optional=True)
    for name, rule in {
        "method": choice(*METHODS),
        "points": POINTS,
        "seed": whole(0, 2**32 - 1),
        "chunk": POINTS,
        "file": text("the name of a CSV file"),
    }.items()
)


def sample_of(
    where: str, given: Mapping[str, Any], varied: Mapping[str, Any], known: Mapping[str, Any], folder: Path
) -> Sample:
    """Return the sample that the section [vary] and the values of `KEYS` describe; CaseError as of
    `read_plan`."""
    method = given.get("method", "list" if "file" in given else "grid")
    random = method in METHODS[2:]
    for name in ("points", "seed"):
        if name in given and not random:
            raise CaseError(f"{where}: sample.{name}: got it for a {method}, which has those of [vary]")
    if random and "points" not in given:
        raise CaseError(f"{where}: sample.points: got no such key, expected {POINTS.expected}")
    if "file" in given:
        axes = _from_file(where, given, varied, known, folder)
    else:
        axes = tuple(_axis(where, key, value, known, method) for key, value in leaves(varied))
    counts = {axis.key: axis.count for axis in axes}
    if method == "list" and len(set(counts.values())) > 1:
        told = ", ".join(f"{key} {count}" for key, count in counts.items())
        raise CaseError(f"{where}: [vary]: got lists of different lengths ({told}), expected the same")
    points = axes[0].count if method == "list" else given.get("points", math.prod(counts.values()))
    if points > MOST:
        raise CaseError(f"{where}: [vary]: got a grid of {points} points, expected at most {MOST}")
    return Sample(method=method, axes=axes, points=points, seed=given.get("seed", 0))


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


def _axis(where: str, key: str, given: Any, known: Mapping[str, Any], method: str) -> Axis:
    """Return one axis of [vary]."""
    require_known(where, "vary", key, known)
    label = f"vary.{key}"
    if isinstance(given, list):
        given = {"values": given}
    if not isinstance(given, dict) or not given:
        raise CaseError(f"{where}: {label}: got {shown(given)}, expected a list or {{ from, to }}")
    document.refuse_unknown(where, label, given, FIELDS)
    if "values" in given:
        if len(given) > 1:
            others = ", ".join(name for name in given if name != "values")
            raise CaseError(f"{where}: {label}: got values beside {others}, expected one of the two")
        return Axis(key=key, values=_listed(where, label, known[key], given["values"]))
    if method == "list":
        raise CaseError(f'{where}: {label}: got a range, expected values for sample.method = "list"')
    return _range(where, key, given, known[key], grid=method == "grid")


def _listed(where: str, label: str, rule: Any, values: Any) -> tuple[Any, ...]:
    """Return listed values, each admitted by the rule; pairs as tuples."""
    if not isinstance(values, list) or not values:
        raise CaseError(f"{where}: {label}.values: got {shown(values)}, expected a list of values")
    for value in values:
        document.admitted(where, label, rule, value)
    whole = rule.kind != "number" and all(isinstance(value, int) for value in values)
    kept = values if whole else [_kept(value) for value in values]
    if len({type(value) for value in kept}) > 1:
        expected = "numbers, texts or pairs of numbers alone"
        raise CaseError(f"{where}: {label}: got values of different types, expected {expected}")
    return tuple(kept)


def _kept(value: Any) -> Any:
    """Return a number as a float, and a pair of numbers as a tuple; other texts and lists as they are."""
    if isinstance(value, list) and all(isinstance(part, int | float) for part in value):
        return tuple(map(float, value))
    return float(value) if isinstance(value, int | float) and not isinstance(value, bool) else value


def _range(where: str, key: str, given: Mapping[str, Any], rule: Any, *, grid: bool) -> Axis:
    """Return an axis from a low to a high end."""
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
    return Axis(key=key, low=float(low), high=float(high), points=found.get("points", 1), log=log)


def _from_file(
    where: str, given: Mapping[str, Any], varied: Mapping[str, Any], known: Mapping[str, Any], folder: Path
) -> tuple[Axis, ...]:
    """Return the axes of a list in a CSV file, whose head names the keys."""
    import pandas as pd

    if varied or given.get("method", "list") != "list":
        raise CaseError(f"{where}: sample.file: got it beside [vary] or a method, expected it alone")
    path = folder / given["file"]
    try:
        table = pd.read_csv(path)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error).splitlines()[0]
        raise CaseError(f"{where}: sample.file: {path}: cannot be read ({reason}), expected CSV") from None
    if table.empty:
        raise CaseError(f"{where}: sample.file: {path}: got no design, expected at least one row")
    axes = []
    for key in map(str, table.columns):
        require_known(where, f"sample.file: {path}", key, known)
        values = _listed(where, f"sample.file: {path}: {key}", known[key], table[key].tolist())
        axes.append(Axis(key=key, values=values))
    return tuple(axes)


Columns = dict[str, list[Any]]


class Drawer:
    """Draws the points of a sample forwards: `rows(start, stop)` with starts that do not fall.

    A grid, a list and a Sobol sequence are made where they are asked for; a Latin hypercube, whose points
    depend on their number, is drawn whole (8 bytes a point and key).
    """

    def __init__(self, sample: Sample) -> None:
        self._sample = sample
        dimensions = len(sample.axes)
        if sample.method == "sobol":
            self._sobol = qmc.Sobol(d=dimensions, scramble=True, seed=sample.seed)
        elif sample.method == "latin-hypercube":
            self._cube = qmc.LatinHypercube(d=dimensions, seed=sample.seed).random(sample.points)

    def rows(self, start: int, stop: int) -> Columns:
        """Return the points from `start` to before `stop` as columns by key, in the file's units."""
        axes, number = self._sample.axes, np.arange(start, stop)
        if self._sample.method == "list":
            return {axis.key: _column(axis, place=number) for axis in axes}
        if self._sample.method == "grid":  # the last axis runs fastest
            places = np.unravel_index(number, tuple(axis.count for axis in axes))
            return {axis.key: _column(axis, place=place) for axis, place in zip(axes, places, strict=True)}
        unit = self._unit(start, stop)
        return {axis.key: _column(axis, share=unit[:, i]) for i, axis in enumerate(axes)}

    def _unit(self, start: int, stop: int) -> Array:
        """Return the points within the unit cube, (stop - start, axes)."""
        if self._sample.method == "latin-hypercube":
            return np.asarray(self._cube[start:stop])
        skipped = start - self._sobol.num_generated
        if skipped:
            self._sobol.fast_forward(skipped)
        if start > 0:
            return np.asarray(self._sobol.random(stop - start))
        # one first: scipy warns of a first draw that is no power of two
        return np.concatenate([self._sobol.random(count) for count in (1, stop - 1) if count])


def _column(axis: Axis, *, place: Any = None, share: Any = None) -> list[Any]:
    """Return the values of an axis at places (D,), or at shares (D,) of [0, 1)."""
    if axis.values is not None:
        place = (share * len(axis.values)).astype(int) if place is None else place
        return [axis.values[i] for i in place]
    share = place / max(axis.points - 1, 1) if share is None else share
    if axis.log:
        low, high = math.log(axis.low), math.log(axis.high)
        values = np.exp(low + (high - low) * share)
    else:
        values = axis.low + (axis.high - axis.low) * share
    # the ends are exactly those of the file
    return list(np.clip(np.where(share == 1.0, axis.high, values), axis.low, axis.high).tolist())
