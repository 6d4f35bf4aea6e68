"""Compile the kernels of both models, once; later runs load them from the disk.

    python -m studies compile

`make setup` does this. The kernels are kept beside their sources. A kernel is compiled anew when its own file
changes, but not when one changes that it calls: after such a change, run this command, which compiles all
afresh. Nothing else depends on it: what is not compiled is compiled when it is first called.
"""

import argparse
import sys
import time
from dataclasses import replace

from spline_model.sequential_impulse import solve_impulses
from studies.answers.adapters import answer_modes, answer_release, answer_static
from studies.answers.models import built, model_of
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.problem import named_case
from studies.commands.parser import Parser
from studies.record.source import ROOT

#: Small calls that between them enter every kernel: settings, and integrators of a release.
CALLS: tuple[tuple[Settings, tuple[str, ...]], ...] = (
    (SplineSettings(control_points=4), ("energy", "generalised-alpha", "explicit", "leapfrog")),
    (SplineSettings(control_points=4, stretch="consistent"), ("energy", "generalised-alpha", "explicit")),
    (FeSettings(elements=4), ("central-difference",)),
    (FeSettings(elements=4, element="reissner"), ("central-difference",)),
)


def add_arguments(parser: Parser) -> None:
    """Declare no arguments."""


def main(arguments: argparse.Namespace) -> int:
    """Enter every kernel; return the exit code."""
    problem = replace(named_case("cross_axis_pivot"), rotation=0.1, increments=1)
    print("studies: compiling the kernels, once (about a minute) ...", file=sys.stderr, flush=True)
    begin = time.perf_counter()
    forget()
    for settings, integrators in CALLS:
        answer_static(problem, settings, accuracy=1.0 if settings.model == "spline" else None)
        answer_modes(problem, settings)
        for integrator in integrators:
            answer_release(problem, settings, duration=1e-5, integrator=integrator, step=1e-8)
    chosen = built(model_of(CALLS[0][0]), problem, CALLS[0][0], moving=True)[0]
    for form in ("printed", "stable"):
        solve_impulses(chosen, duration=1e-5, step=1e-6, form=form)
    print(f"studies: ready after {time.perf_counter() - begin:.0f} s", file=sys.stderr)
    return 0


def forget() -> None:
    """Remove the kernels that were compiled before."""
    for package in ("spline_model", "fe_reference"):
        for kept in (ROOT / package).rglob("*.nb[ci]"):
            kept.unlink()
