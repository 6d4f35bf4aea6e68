"""Designs: what a case file may hold, a cross-axis pivot or any mechanism of strips and bodies."""

from pathlib import Path

from studies.cases.document import parsed
from studies.cases.mechanism import Mechanism, read_mechanism
from studies.cases.problem import FOLDER, Problem, read_problem

Design = Problem | Mechanism


def read_design(path: str | Path, *, changes: str | None = None) -> Design:
    """Return the design in the case file at `path`, a mechanism if it has [[strips]].

    Args:
        path: of the file.
        changes: of its effects, "+gravity,-strip_inertia" or the whole list; None for what the file says.

    Raises:
        CaseError: the file cannot be used; one line.
    """
    content = parsed(path)
    if isinstance(content.get("strips"), list):
        return read_mechanism(str(path), content, changes)
    return read_problem(str(path), content, changes)


def flexural_scale(design: Design) -> float:
    """Return the largest EI/L of the strips [N m], which torques and energies are compared with."""
    return max(strip.youngs_modulus * strip.second_moment_of_area / strip.length for strip in design.strips)


def named_design(name: str) -> Design:
    """Return the design of that name that comes with the suite."""
    return read_design(FOLDER / f"{name}.toml")
