"""Designs: what a case file may hold, a cross-axis pivot or any mechanism of strips and bodies."""

from pathlib import Path

from studies.cases.document import parsed
from studies.cases.mechanism import Mechanism, read_mechanism
from studies.cases.problem import FOLDER, Problem, read_problem

Design = Problem | Mechanism


def read_design(path: str | Path) -> Design:
    """Return the design in the case file at `path`, a mechanism if it has [[strips]].

    Raises:
        CaseError: the file cannot be used; one line.
    """
    content = parsed(path)
    if isinstance(content.get("strips"), list):
        return read_mechanism(str(path), content)
    return read_problem(str(path), content)


def named_design(name: str) -> Design:
    """Return the design of that name that comes with the suite."""
    return read_design(FOLDER / f"{name}.toml")
