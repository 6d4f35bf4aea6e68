"""Names of commands and studies and their modules, which are imported when they are called."""

import difflib
from collections.abc import Iterable
from importlib import import_module
from typing import Any

from studies.errors import BadInput

#: Command -> (module with `add_arguments(parser)` and `main(arguments) -> exit code`, what it does).
COMMANDS: dict[str, tuple[str, str]] = {
    "solve": ("studies.commands.solve", "drive a pivot through a rotation and report its path"),
    "release": ("studies.commands.release", "let go of a driven pivot and report its motion"),
    "modes": ("studies.commands.modes", "report natural frequencies, at rest or at a rotation"),
    "export": (
        "studies.commands.export",
        "write deformed shapes and section forces as VTK, SVG, CSV, Parquet",
    ),
    "converge": ("studies.commands.converge", "refine both models on a design until an accuracy is reached"),
    "audit": ("studies.commands.audit", "say what each effect of a scene is worth, and which are enough"),
    "advise": ("studies.commands.advise", "say which setting of each model meets an error at the least cost"),
    "size": ("studies.commands.size", "size a pivot for a range, stiffness and stress by exact gradients"),
    "sweep": ("studies.commands.sweep", "solve thousands of designs into one table, here or on a cluster"),
    "interactive": (
        "studies.commands.interactive",
        "drive a pivot by camera or mouse and let it go, in the browser",
    ),
    "markers": ("studies.commands.markers", "print the sheet with the two markers"),
    "list": ("studies.commands.list_studies", "list the studies"),
    "run": ("studies.commands.run", "compute and draw studies"),
    "draw": ("studies.commands.draw", "redraw studies from their stored tables"),
    "status": ("studies.commands.status", "say which stored results are fresh, stale or missing"),
    "compile": ("studies.commands.compile_kernels", "compile the kernels of both models, once"),
    "readme": (
        "studies.commands.readme",
        "rewrite the tables of README.md and docs/ from the results",
    ),
}

#: Study -> (module with `CASES`, `compute(progress)` and `draw(tables)`, what it shows).
STUDIES: dict[str, tuple[str, str]] = {
    "paper/fig03_snapshots": (
        "studies.paper.fig03_snapshots",
        "Fig 3: deformed shapes, both models superposed",
    ),
    "paper/fig04_trajectory": (
        "studies.paper.fig04_trajectory",
        "Fig 4: path of the body's centre and its error",
    ),
    "paper/fig05_stiffness": (
        "studies.paper.fig05_stiffness",
        "Fig 5: torque and stiffness and their errors",
    ),
    "paper/fig06_release": (
        "studies.paper.fig06_release",
        "Fig 6: motion after the release from 90 degrees and its errors",
    ),
    "paper/fig07_interactive": (
        "studies.paper.fig07_interactive",
        "Fig 7: the interactive environment in a browser, its frame rate and solve time",
    ),
    "convergence/control_points": (
        "studies.convergence.control_points",
        "error against control points for every basis, measure and stretch form: the locking map",
    ),
    "convergence/elements": (
        "studies.convergence.elements",
        "error against elements, order and Richardson value",
    ),
    "convergence/frequency": (
        "studies.convergence.frequency",
        "frequency of the swing and of small motion against control points, elements, step and amplitude",
    ),
    "convergence/error_estimate": (
        "studies.convergence.error_estimate",
        "how well the spline model estimates its own error when it is asked for an accuracy",
    ),
    "convergence/slide_stiffness": (
        "studies.convergence.slide_stiffness",
        "error against the stiffness of the strains that the axial modes do not see",
    ),
    "stability/rotation": (
        "studies.stability.statics.rotation",
        "hard cases: rotation to a half turn and beyond, in any number of increments, there and back",
    ),
    "stability/slenderness": (
        "studies.stability.statics.slenderness",
        "hard cases: slenderness from 10 to 1e5 and strips that cannot stretch",
    ),
    "stability/geometry": (
        "studies.stability.statics.geometry",
        "hard cases: crossing ratios and inclinations to their ends, parallel, unequal and curved strips",
    ),
    "stability/buckling": (
        "studies.stability.statics.buckling",
        "hard cases: columns beyond the Euler load, frames that snap through, the pivot pushed down",
    ),
    "stability/step_size": (
        "studies.stability.motion.step_size",
        "hard cases: steps of a motion from 1e-7 to 1e-2 s: energy, order, and what a step does not resolve",
    ),
    "stability/long_run": (
        "studies.stability.motion.long_run",
        "hard cases: a million steps without damping, some minutes; goes on where it was interrupted",
    ),
    "stability/ratios": (
        "studies.stability.motion.ratios",
        "hard cases: light and heavy bodies, massless and heavy strips, one strip far stiffer",
    ),
    "stability/axial_modes": (
        "studies.stability.statics.axial_modes",
        "hard cases: too few and too many axial modes, too few Gauss points",
    ),
    "stability/bad_starts": (
        "studies.stability.statics.bad_starts",
        "hard cases: crumpled, reversed and other wrong guesses of a state",
    ),
    "stability/fuzz": (
        "studies.stability.whole.fuzz",
        "hard cases: random designs and commands",
    ),
    "stability/events": (
        "studies.stability.motion.events",
        "hard cases: drives reversed, bodies let go and caught a thousand times, targets that jump",
    ),
    "stability/environment": (
        "studies.stability.whole.environment",
        "hard cases: the same answers on any number of threads and in any order of strips and bodies",
    ),
    "effects/worth": (
        "studies.effects.worth",
        "what each effect is worth for four designs, and what simpler strips save",
    ),
    "design/sizing": (
        "studies.design.sizing",
        "two pivots sized by exact gradients: least centre shift, least variation of stiffness",
    ),
    "impulses/step_size": (
        "studies.impulses.step_size",
        "sequential impulses against their step: error, drift, energy, time, limits and sweeps",
    ),
    "baselines/surrogates": (
        "studies.baselines.comparison.surrogates",
        "error of pseudo-rigid-body models and the linear pivot over rotation and amplitude",
    ),
    "baselines/peers": (
        "studies.baselines.comparison.peers",
        "error against time beside other codes, where installed, of the static path and of the swing",
    ),
    "work_precision/statics": (
        "studies.work_precision.statics",
        "what accuracy costs in statics: error against time and counted work, for every model",
    ),
    "work_precision/dynamics": (
        "studies.work_precision.dynamics",
        "what accuracy costs in motion: error after the release against time and counted work",
    ),
    "sweep/design_space": (
        "studies.sweep.questions.design_space",
        "thousands of pivots: stiffness, its variation, shift and stress over +-45 degrees, and the best",
    ),
    "sweep/throughput": (
        "studies.sweep.questions.throughput",
        "designs a second by threads, processes and Dask workers, and what a chunk costs",
    ),
}


def module_of(study: str) -> Any:
    """Import and return the module of `study`."""
    return import_module(STUDIES[study][0])


def selected(names: Iterable[str]) -> list[str]:
    """Return the studies that `names` stand for, in the order of the register.

    A name is a study ("paper/fig04_trajectory"), its last part ("fig04_trajectory"), a group ("paper") or
    "all".

    Raises:
        BadInput: a name that stands for no study; it lists the nearest.
    """
    chosen: set[str] = set()
    for name in names:
        found = {study for study in STUDIES if name in (study, *study.split("/"), "all")}
        if not found:
            known = [*STUDIES, *(study.split("/")[-1] for study in STUDIES)]
            near = difflib.get_close_matches(name, known, n=1)
            hint = f"{near[0]} (the nearest name)" if near else "one of " + ", ".join(STUDIES)
            raise BadInput(f"study: got {name}, expected {hint}")
        chosen |= found
    return [study for study in STUDIES if study in chosen]
