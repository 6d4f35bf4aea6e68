"""Compute stale studies anew and call them fresh where every table comes out as it is stored.

    python -m studies verify convergence/elements

A name is a study, its last part, a group of studies or "all". Tables that differ from run to run, as times
do, are not compared, and nothing is drawn: only the note of the source that the results are of is renewed. A
study with another table is named and keeps what is stored. Exit code 0: all that could be computed here is
fresh; 1: a table differs; 2: bad input.
"""

import argparse
import sys
from typing import Any

from studies.commands.parser import Parser
from studies.commands.run import add_run_arguments, computed
from studies.engine.answer import processes
from studies.engine.findings import Tables
from studies.engine.study import Study
from studies.record.store import Store, as_csv
from studies.registry import STUDIES, selected, study_of

DIFFERS = 1


def add_arguments(parser: Parser) -> None:
    """Declare the arguments of the command."""
    add_run_arguments(parser)


def main(arguments: argparse.Namespace) -> int:
    """Verify the studies one after the other; return the exit code."""
    store, code = Store(arguments.results), 0
    with processes(arguments.processes) as pool:
        for name in selected(arguments.names):
            study = study_of(name)
            known: dict[str, Any] = {"module": STUDIES[name], "cases": study.cases}
            said = study.missing() or store.state(name, **known).kind
            if said == "stale":
                differing = _differing(store.load_tables(name), computed(name, pool), study)
                if differing:
                    said, code = f"differs: {', '.join(differing)}", DIFFERS
                else:
                    store.renew(name, **known)
                    said = f"the same, {store.state(name, **known).kind}"
            print(f"{name}: {said}", file=sys.stderr)
    return code


def _differing(stored: Tables, found: Tables, study: Study) -> list[str]:
    """Return the tables that are not as stored, of those that do not differ from run to run."""
    names = [name for name in {**stored, **found} if not study.varies(name)]
    both = {name for name in stored if name in found}
    return [name for name in names if name not in both or as_csv(stored[name]) != as_csv(found[name])]
