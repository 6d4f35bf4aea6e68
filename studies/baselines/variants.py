"""Baselines by name, what this machine lacks of them, and which settings of theirs a comparison tries.

Each is an object or a module with `model` (its name), `installed()`, `static_path(problem, rotations,
**settings)` and `release(problem, *, start, duration, step, **settings)`; what these return can be timed.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pandas as pd

from studies.baselines.answer import BaselineFailed, Followed
from studies.baselines.constraint_model import chained_constraint_model, constraint_model
from studies.baselines.exudyn_strips import exudyn_ancf, exudyn_exact
from studies.baselines.openseespy import openseespy_frame
from studies.baselines.own import elements as own_elements
from studies.baselines.own import spline
from studies.baselines.pseudo_rigid import four_bar, linear_pivot, pin_joint
from studies.engine.study import lacking
from studies.work_precision import equal_error

#: Models of which the rotation is the only coordinate, those whose beams have others that are eliminated, and
#: other codes.
PSEUDO_RIGID = {each.model: each for each in (linear_pivot, pin_joint, four_bar)}
SURROGATES = PSEUDO_RIGID | {each.model: each for each in (constraint_model, chained_constraint_model)}
PEERS: dict[str, Any] = {each.model: each for each in (exudyn_ancf, exudyn_exact, openseespy_frame)}

#: What to do about a peer that is not there.
HINT = "not installed: python -m pip install '.[peers]'"


def missing() -> str:
    """Return what this machine lacks of a study that holds the suite against all other codes; or nothing."""
    gone = [name.split()[0] for name, peer in PEERS.items() if not peer.installed()]
    return lacking("peers", list(dict.fromkeys(gone)))


#: Theories of the rod: the limit that a model tends to.
WITHOUT_SHEAR, WITH_SHEAR = "without shear", "with shear"

#: Group of a ratio -> modules, and the solver settings that count for it.
EXUDYN, AS_DELIVERED, OPENSEES = "Exudyn", "Exudyn as delivered", "OpenSees"
SPLINE, ELEMENTS, SURROGATE = "spline", "finite elements", "surrogates"

#: Passes through all variants, far apart in time: what else the machine does lasts longer than one variant.
PASSES = 3
#: What takes so many times as long as another of its model that is as accurate is timed in one pass only.
SLOW = 2.0


@dataclass(frozen=True, kw_only=True, eq=False)
class Variant:
    """One setting of one model.

    Attributes:
        module: a baseline.
        group: under which its times are compared.
        theory: of its rod.
        settings: keywords; label: the same as a text.
    """

    module: Any
    group: str
    theory: str
    settings: Mapping[str, Any] = field(default_factory=dict)

    @property
    def model(self) -> str:
        """Name of the model."""
        return str(self.module.model)

    @property
    def label(self) -> str:
        """The settings as a text."""
        return " ".join(f"{name}={_short(value)}" for name, value in self.settings.items())


def _short(value: Any) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)


def static_variants() -> list[Variant]:
    """Return the settings of the static path."""
    found = [_variant(spline, SPLINE, control_points=n) for n in range(4, 11)]
    found += [_variant(own_elements, ELEMENTS, elements=n) for n in (4, 5, 10, 20, 40, 80, 160, 320)]
    found += [_variant(each, SURROGATE) for each in SURROGATES.values()]
    for tolerance in (1e-5, 1e-6, 1e-8):
        for elements in (2, 4, 6, 8, 12, 16, 24, 40):
            found.append(_ancf(elements, relative_tolerance=tolerance))
        for elements in (1, 2, 3, 4, 6, 8, 12, 16, 20, 24):
            found.append(_exact(elements, relative_tolerance=tolerance))
    for integration in (1, 2):
        for elements in (4, 8, 16, 24, 40):
            found.append(_ancf(elements, integration=integration, relative_tolerance=1e-6))
    found += [_variant(exudyn_ancf, AS_DELIVERED, elements=n, solver="as delivered") for n in (4, 8, 16, 40)]
    found += [_variant(exudyn_exact, AS_DELIVERED, elements=n, solver="as delivered") for n in (2, 4, 8, 20)]
    return found + [
        _variant(openseespy_frame, OPENSEES, elements=n, tolerance=tolerance)
        for n in (5, 10, 20, 40, 80, 160)
        for tolerance in (1e-8, 1e-10)
    ]


def release_variants() -> list[Variant]:
    """Return the settings of the release."""
    found = [
        _variant(spline, SPLINE, control_points=n, integrator=integrator, step=step)
        for n in (5, 6, 7, 8)
        for integrator in ("energy", "generalised-alpha")
        for step in (2e-4, 1e-4, 5e-5, 2e-5)
    ]
    found += [_variant(spline, SPLINE, control_points=n, integrator="explicit", step=2e-6) for n in (6, 7, 8)]
    found += [
        _variant(spline, SPLINE, control_points=n, integrator="leapfrog", step=step)
        for n, step in ((5, 5e-6), (6, 5e-6), (6, 2.5e-6), (7, 4e-6), (8, 2.5e-6), (8, 1.25e-6), (9, 2e-6))
    ]
    found += [
        _variant(own_elements, ELEMENTS, elements=n, integrator=integrator, step=step)
        for integrator, step in (
            ("central-difference", 2e-5),
            ("generalised-alpha", 1e-4),
            ("generalised-alpha", 5e-5),
        )
        for n in (5, 10, 16, 24)
    ]
    found += [_variant(each, SURROGATE, step=1e-5) for each in SURROGATES.values()]
    for radius, tolerance in ((0.9, 1e-3), (0.6, 1e-3), (0.9, 1e-5)):
        options = {"spectral_radius": radius, "relative_tolerance": tolerance}
        for step in (2e-4, 1e-4, 5e-5, 2e-5):
            found += [_ancf(elements, step=step, **options) for elements in (3, 4, 5, 6, 8)]
            found += [_exact(elements, step=step, **options) for elements in (2, 3, 4, 6)]
    # do still shorter steps keep the smaller errors?
    found += [
        _ancf(elements, step=step, spectral_radius=0.9, relative_tolerance=1e-5)
        for elements in (8, 12)
        for step in (1e-5, 5e-6)
    ]
    return found + [
        _variant(openseespy_frame, OPENSEES, elements=n, step=step)
        for n in (10, 20, 40)
        for step in (1e-4, 5e-5, 2e-5)
    ]


def _variant(module: Any, group: str, **settings: Any) -> Variant:
    theory = WITH_SHEAR if module is exudyn_exact else WITHOUT_SHEAR
    return Variant(module=module, group=group, theory=theory, settings=settings)


def _ancf(elements: int, **settings: Any) -> Variant:
    return _variant(exudyn_ancf, EXUDYN, elements=elements, **settings)


def _exact(elements: int, **settings: Any) -> Variant:
    return _variant(exudyn_exact, EXUDYN, elements=elements, **settings)


def tried(
    variants: Sequence[Variant],
    solve: Callable[[Variant], tuple[dict[str, Any], Followed]],
    errors: Iterable[str],
    *,
    judged: str,
    repeat: int,
) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
    """Return the rows of the physics, and those of the times: median and quartiles of all runs.

    What is not installed has one row, and what fails keeps its own, both without errors.

    Args:
        solve: returns errors and work of a variant, and what can be timed. errors: their columns.
        judged: the error at which times are compared; repeat: timed runs in a pass [1].
    """
    nothing = dict.fromkeys(errors, np.nan)
    rows: list[dict[str, Any]] = []
    solved: dict[Variant, Followed] = {}
    seconds: dict[Variant, list[float]] = {}
    for variant in variants:
        row: dict[str, Any] = {"model": variant.model, "group": variant.group, "variant": variant.label}
        row |= {"theory": variant.theory, "reason": ""}
        if not variant.module.installed():
            row |= {"variant": "", "status": "not installed", "reason": HINT} | nothing
            rows += [row] if row not in rows else []
            continue
        try:
            outcome, solved[variant] = solve(variant)
        except BaselineFailed as error:
            rows.append(row | {"status": "failed", "reason": str(error)} | nothing)
            continue
        rows.append(row | {"status": "converged"} | outcome)
        seconds[variant] = [*solved[variant].seconds(repeat)]
    again = list(_compared(rows, seconds, judged))
    for _ in range(1, PASSES):
        for variant in again:
            seconds[variant] += solved[variant].seconds(repeat)
    return rows, [{"model": v.model, "variant": v.label} | spread(seconds[v]) for v in solved]


def _compared(
    rows: list[dict[str, Any]], seconds: Mapping[Variant, Sequence[float]], error: str
) -> Iterator[Variant]:
    """Yield the variants whose times may stand in a comparison: none of their model is as accurate and much
    faster."""
    if not seconds:
        return
    table = kept(pd.DataFrame(rows), error)
    solved = table[table["status"] == "converged"].assign(
        median=[float(np.median(each)) for each in seconds.values()]
    )
    for variant, row in zip(seconds, solved.to_dict("records"), strict=True):
        same = (solved["model"] == row["model"]) & (solved["group"] == row["group"])
        if row["median"] <= SLOW * solved.loc[same & (solved[error] <= row[error]), "median"].min():
            yield variant


def kept(rows: pd.DataFrame, error: str) -> pd.DataFrame:
    """Return the rows with their error replaced by the largest of their settings as fine as this and finer.

    `fineness` of a path is its elements or control points, of a swing its step with the sign turned. An error
    that comes and goes as these are refined is luck; this one only falls.
    """
    by = "step" if "step_s" in rows else "elements|control_points"
    settings = rows["variant"].fillna("").str.replace(rf"(?:{by})=\S+", "", regex=True)
    named = rows.assign(series=rows["model"], family=settings)
    return rows.assign(**{error: equal_error.kept(named, [error], "fineness")})


def spread(seconds: Sequence[float]) -> dict[str, float]:
    """Return median and quartiles of times [s], and how many they are, as columns of a table."""
    low, median, high = np.percentile(seconds, (25, 50, 75))
    return {"solve_s": median, "low_s": low, "high_s": high, "runs": len(seconds)}
