"""Designs: what a case file may hold, a cross-axis pivot or any mechanism of strips and bodies."""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from studies.cases.document import is_mechanism, parsed
from studies.cases.mechanism import Mechanism, read_mechanism
from studies.cases.problem import FOLDER, Problem, read_problem

Design = Problem | Mechanism


def read_design(path: str | Path, *, changes: str | None = None) -> Design:
    """Return the design in the case file at `path`.

    Args:
        path: of the file.
        changes: of its effects, "+gravity,-strip_inertia" or the whole list; None for what the file says.

    Raises:
        CaseError: the file cannot be used; one line.
    """
    return design_of(str(path), parsed(path), changes)


def design_of(where: str, document: Mapping[str, Any], changes: str | None = None) -> Design:
    """Return the design of a parsed case file, a mechanism if it has [[strips]]; as of `read_design`."""
    read = read_mechanism if is_mechanism(document) else read_problem
    return read(where, document, changes)


def named_design(name: str) -> Design:
    """Return the design of that name that comes with the suite."""
    return read_design(FOLDER / f"{name}.toml")


def flexural_scale(design: Design) -> float:
    """Return the largest EI/L of the strips [N m], which torques and energies are compared with."""
    return max(strip.youngs_modulus * strip.second_moment_of_area / strip.length for strip in design.strips)


def fingerprint(design: Design) -> str:
    """Return the SHA-256 of a design's values, whatever the layout or comments of its file."""
    return hashlib.sha256(json.dumps(asdict(design), sort_keys=True).encode()).hexdigest()
