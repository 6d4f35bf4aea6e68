"""Names of commands and studies and their modules, which are imported when they are called."""

from collections.abc import Iterable
from importlib import import_module
from typing import TYPE_CHECKING

from studies.cases.document import nearest
from studies.errors import BadInput

if TYPE_CHECKING:  # a command that runs no study does not wait for tables and figures
    from studies.engine import Study

#: Command -> what it does.
COMMANDS: dict[str, str] = {
    "solve": "rotate a pivot and report its equilibrium path",
    "release": "release a rotated pivot and report its motion",
    "modes": "report natural frequencies, at rest or at a rotation",
    "critical-load": "find the force at which a design loses its stability",
    "compare": "compare designs or models",
    "converge": "refine both models on a design until an accuracy is reached",
    "audit": "report the influence of each effect, and the effects that are sufficient",
    "advise": "find the cheapest setting of each model for an error",
    "size": "size a design for a range, stiffness and stress by exact gradients",
    "judge": "compare results of another code with a reference solution",
    "sweep": "solve thousands of designs into one table, here or on a cluster",
    "case": "print a commented case file to begin a design with",
    "interactive": "move and release a pivot by camera or mouse in the browser",
    "markers": "print the sheet with the two markers",
    "calibrate": "find a camera's constants from the marker sheet",
    "run": "compute and draw studies",
    "draw": "redraw studies from their stored tables",
    "verify": "compute stale studies again and mark reproduced ones as fresh",
    "status": "report which stored results are fresh, stale or missing",
    "compile": "compile the kernels of both models, once",
    "completion": "print a script that completes commands in bash and zsh",
    "readme": "rewrite README, docs and results/reference from the stored results",
}
#: Module in studies/commands -> its commands that are functions of their names; others are a `main` each.
MODULES: dict[str, tuple[str, ...]] = {
    "stability": ("modes", "critical-load"),
    "choose": ("converge", "audit", "advise"),
    "interactive": ("markers", "calibrate"),
    "results": ("run", "draw", "verify", "status", "readme"),
    "compile": ("completion",),
}

#: Study -> module with its declaration, `STUDY`, whose first line says what it shows; or module:constant, and
#: the line below that constant says it.
STUDIES: dict[str, str] = {
    "paper/fig03_snapshots": "studies.paper.static_curves:FIG03",
    "paper/fig04_trajectory": "studies.paper.static_curves:FIG04",
    "paper/fig05_stiffness": "studies.paper.static_curves:FIG05",
    "paper/fig06_release": "studies.paper.fig06_release",
    "paper/fig07_interactive": "studies.paper.fig07_interactive",
    "paper/readings": "studies.paper.formulations:READINGS",
    "convergence/control_points": "studies.convergence.sweep:MAP_STUDY",
    "convergence/elements": "studies.convergence.sweep:ELEMENT_STUDY",
    "convergence/frequency": "studies.convergence.frequency",
    "convergence/error_estimate": "studies.convergence.error_estimate",
    "model_form/solid_pivot": "studies.published.solid_pivot",
    "model_form/calculix": "studies.published.calculix",
    "published/problems": "studies.published.problems",
    "stability/rotation": "studies.stability.families:ROTATION",
    "stability/slenderness": "studies.stability.families:SLENDERNESS",
    "stability/geometry": "studies.stability.families:GEOMETRY",
    "stability/buckling": "studies.stability.buckling",
    "stability/step_size": "studies.stability.families:STEP_SIZE",
    "stability/long_run": "studies.stability.events:LONG_RUN",
    "stability/ratios": "studies.stability.families:RATIOS",
    "stability/axial_modes": "studies.stability.families:AXIAL_MODES",
    "stability/events": "studies.stability.events:EVENTS_STUDY",
    "effects/worth": "studies.effects.worth",
    "design/sizing": "studies.design.sizing",
    "charts/pivot": "studies.design.charts",
    "impulses/step_size": "studies.convergence.impulse_steps",
    "cost/surrogates": "studies.cost.surrogates",
    "cost/codes": "studies.cost.codes",
}


def study_at(place: str) -> "Study":
    """Import and return the declaration at a place: a module's `STUDY`, or the constant that it names."""
    module, _, constant = place.partition(":")
    study: Study = getattr(import_module(module), constant or "STUDY")
    return study


def study_of(name: str) -> "Study":
    """Import and return the declaration of a study."""
    return study_at(STUDIES[name])


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
            raise BadInput(f"study: got {name}, expected {nearest(name, known, listed=STUDIES)}")
        chosen |= found
    return [study for study in STUDIES if study in chosen]
