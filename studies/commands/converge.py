"""Refine both models on a design and say how many control points or elements reach an accuracy.

    python -m studies converge cross_axis_pivot
    python -m studies converge my_pivot.toml --control-points 4:16 --elements 5:320 --out my_pivot

The spline is refined point by point, the finite elements by doubling; both are held against the limit of the
finite elements' refinement, whose own uncertainty is printed. Errors are the largest over the path, of the
stress those of the largest stress of each state. Tables and a figure go to the output folder. Exit code 0:
done; 2: bad input; 3: the finite elements, and with them the reference, did not converge. A spline that does
not converge keeps its row.
"""

import argparse
import math
from collections.abc import Callable, Iterator
from pathlib import Path

import pandas as pd

from studies.answers.reference import QUANTITIES, NoReference, Reference
from studies.answers.settings import SplineSettings
from studies.commands import arguments as take
from studies.commands.answer import not_converged
from studies.commands.columns import Column, numbers, plain, table
from studies.commands.parser import command, reads
from studies.convergence.sweep import FINEST, drawn, element_sweep, known, reaching, spline_row, with_orders
from studies.errors import BadInput
from studies.record import style
from studies.record.files import require_writable_folder, write_whole
from studies.record.progress import Bar, watched
from studies.record.source import HOME
from studies.record.store import as_csv

#: Accuracies whose count is reported.
ACCURACIES = (1e-3, 1e-4, 1e-6)
#: Stands for a count where the reference cannot tell.
UNSURE = "unsure"


def _counts(low: int) -> Callable[[str], tuple[int, int]]:
    """Return a parser of ranges "first:last" of whole numbers from `low` upwards, both ends included."""

    def value_of(text: str) -> tuple[int, int] | None:
        first, _, last = text.partition(":")
        written = first.isdecimal() and last.isdecimal()
        return (int(first), int(last)) if written and low <= int(first) < int(last) else None

    return reads(f"FIRST:LAST with {low} <= FIRST < LAST", value_of)


@command(
    take.CASE,
    take.CONTROL_POINTS.but(
        "of the splines, in steps of 1, default 4:12", read=_counts(4), default=(4, 12), metavar="A:B"
    ),
    take.ELEMENTS.but(
        "of the meshes, by doubling, default 5:160", read=_counts(1), default=(5, 160), metavar="A:B"
    ),
    take.OUT.but("of tables and figure (default: results/designs/<name of the case>)"),
)
def main(arguments: argparse.Namespace) -> int:
    """Refine, print, store and draw; return the exit code. BadInput: a range of settings that the model
    rejects."""
    problem = take.turned_design(arguments, "rotation to relate errors to")
    meshes = _doubled(*arguments.elements)
    first, last = arguments.control_points
    settings = [SplineSettings(control_points=count) for count in range(first, last + 1)]
    output = arguments.out or HOME / "results" / "designs" / Path(arguments.case).stem
    require_writable_folder(output)
    try:
        with Bar("finite elements") as bar:
            elements, limit = element_sweep(problem, meshes, "corotational", bar)
    except NoReference as error:
        return not_converged(f"{error}; begin with more elements, as --elements 20:160, or turn less far")
    with Bar("splines") as bar:
        rows = [spline_row(problem, each, limit) for each in watched(settings, bar)]
    splines = with_orders(pd.DataFrame(rows), "control_points")
    print("\n".join(_report(splines, elements, limit)))
    with style.applied():
        figure = drawn(splines, elements, limit)
        contents = {f"convergence.{kind}": style.rendered(figure, kind) for kind in ("svg", "png")}
    contents = {"control_points.csv": as_csv(splines), "elements.csv": as_csv(elements)} | contents
    for name, content in contents.items():
        write_whole(output / name, content)
    print(f"\n{output}: {', '.join(contents)}")
    return 0


def _doubled(first: int, last: int) -> list[int]:
    """Return first, 2 first, 4 first ... up to `last`: three meshes at least to take a limit from."""
    meshes = [first]
    while 2 * meshes[-1] <= last:
        meshes.append(2 * meshes[-1])
    if len(meshes) < 3 or meshes[2] > FINEST:
        raise BadInput(f"--elements: got {first}:{last}, expected A:B with A <= {FINEST // 4} and B >= 4 A")
    return meshes


def _report(splines: pd.DataFrame, elements: pd.DataFrame, limit: Reference) -> Iterator[str]:
    """Yield the tables of both models and the counts that reach the accuracies."""
    yield "largest errors over the path, against the finite elements in the limit of refinement"
    unsure = {name: limit.uncertainty[name] for name in known(limit)}
    yield "its uncertainty: " + ", ".join(f"{name} {value:.1e}" for name, value in unsure.items())
    models = {"control_points": splines, "elements": elements}
    for count, rows in models.items():
        yield ""
        yield from table(_columns(rows, count))
    yield ""
    stress = "stiffness and largest stress" if len(unsure) == len(QUANTITIES) else "stiffness"
    for said, names in (("trajectory and torque", QUANTITIES[:2]), (stress, tuple(unsure))):
        reached = (
            plain(f"{accuracy:.0e}", (_reaching(*each, accuracy, names, limit) for each in models.items()))
            for accuracy in ACCURACIES
        )
        labels = (count.replace("_", " ") for count in models)
        yield from table([plain(f"count that reaches, in {said}", labels, left=True), *reached])
    if max(unsure.values()) > min(ACCURACIES):
        yield f"{UNSURE}: the reference is uncertain by more than that; finer meshes help (--elements 20:640)"


def _reaching(
    count: str, rows: pd.DataFrame, accuracy: float, quantities: tuple[str, ...], limit: Reference
) -> str:
    """Return the count of a model that reaches an accuracy in these quantities.

    An accuracy that the reference is not sure of itself is reached by no count.
    """
    if max(limit.uncertainty[name] for name in quantities) > accuracy:
        return UNSURE
    return str(reaching(rows, count, accuracy, quantities) or f"> {rows[count].max()}")


def _columns(rows: pd.DataFrame, count: str) -> Iterator[Column]:
    """Yield the columns of a model, the status with where a failed path stopped."""
    yield plain(count.replace("_", " "), map(str, rows[count]))
    for name in QUANTITIES:
        yield numbers(name, rows[f"error_{name}"], ".3e")
        yield numbers("order", rows[f"order_{name}"], ".2f")
    ended = (
        status.replace("_", " ") + f" beyond {math.degrees(reached):.4g} deg" * (status != "converged")
        for status, reached in zip(rows["status"], rows["reached_rad"], strict=True)
    )
    yield plain("status", ended, left=True)
