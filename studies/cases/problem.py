"""The pivots of the suite by their names."""

from pathlib import Path

from studies.cases.design import FOLDER, case_file, read_design
from studies.cases.document import CaseError
from studies.cases.mechanism import STRIPS, Problem

__all__ = ["FOLDER", "STRIPS", "TABLE_1", "CaseError", "Problem", "named_case"]

#: Name of the paper's pivot.
TABLE_1 = "cross_axis_pivot"


def named_case(case: str | Path = TABLE_1) -> Problem:
    """Return the pivot of that name in the suite (default: the benchmark pivot), or of a file; CaseError as
    of `read_design`."""
    path = case_file(str(case))
    found = read_design(path)
    if not isinstance(found, Problem):
        raise CaseError(f"{path}: [[strips]]: got a mechanism, expected a cross-axis pivot, with [strip]")
    return found
