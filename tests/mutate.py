"""Slips put into both models and into the measures that they share: a named test notices each.

    python -m tests.mutate              try all of them, or those that are named
    python -m tests.mutate --page       write their table into docs/independence.md
    python -m tests.mutate --random 60 --seed 1     try as many at lines that chance chooses (random_slips.py)

A slip is a table of ``slips.toml``: one wrong sign, factor, weight or missing term, and the test that must
fail with it. All happens in a copy of the code, which is not compiled: that would take longer than the tests.
"""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from tests import random_slips

ROOT = Path(__file__).resolve().parent.parent
LIST, PAGE = ROOT / "tests" / "slips.toml", ROOT / "docs" / "independence.md"
MARKS = ("<!-- slips: begin -->\n", "<!-- slips: end -->\n")
#: What the tests need no copy of.
LEFT_OUT = shutil.ignore_patterns(".*", "__pycache__", "results", "_build", "*.egg-info", "build")
#: Exit codes of pytest.
PASSED, FAILED = 0, 1
#: Time after which a test counts as failed [s], or so many times it for as many: slips may keep a solver from
#: its end.
LONGEST = 300


@dataclass(frozen=True, kw_only=True)
class Slip:
    """`old`, which stands once in `file`, becomes `new`; `caught_by` fails, or it survives for a reason."""

    name: str
    file: str
    old: str
    new: str
    what: str
    caught_by: str = ""
    survives: str = ""


def slips() -> list[Slip]:
    """Return all slips in the order of the list."""
    return [Slip(name=name, **given) for name, given in tomllib.loads(LIST.read_text()).items()]


def copied(folder: Path) -> Path:
    """Return a copy of the code in a folder."""
    return Path(shutil.copytree(ROOT, folder / "copy", ignore=LEFT_OUT))


def outcome(copy: Path, tests: Sequence[str], *, shown: bool = False) -> int:
    """Return pytest's exit code for tests in a copy of the code; what it says is `shown` or dropped."""
    one = {f"{name}_NUM_THREADS": "1" for name in ("OMP", "OPENBLAS", "MKL")}
    apart = {"PYTHONPATH": str(copy), "NUMBA_DISABLE_JIT": "1", "PYTHONDONTWRITEBYTECODE": "1"}
    command = [sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", "-p", "no:xdist", *tests]
    env = os.environ | one | apart
    try:
        return subprocess.run(
            command, cwd=copy, env=env, capture_output=not shown, timeout=LONGEST * len(tests)
        ).returncode
    except subprocess.TimeoutExpired:
        print(f"no end within {LONGEST * len(tests)} s, which counts as failed:", *tests, flush=True)
        return FAILED


def slipped(copy: Path, slip: Slip) -> bool:
    """Return whether the test that is named notices a slip; those that survive have none.

    Raises:
        RuntimeError: the test could not be run at all.
    """
    path = copy / slip.file
    before = path.read_text()
    path.write_text(before.replace(slip.old, slip.new))
    try:
        code = outcome(copy, [slip.caught_by])
    finally:
        path.write_text(before)
    if code not in (PASSED, FAILED):
        raise RuntimeError(f"{slip.name}: pytest {slip.caught_by} ended with {code}, expected 0 or 1")
    return code == FAILED


def table() -> str:
    """Return the slips as the table of the page."""
    rows = ["| slip | in | noticed by |", "|---|---|---|"]
    for slip in slips():
        noticed = (
            f"`{slip.caught_by.removeprefix('tests/')}`" if slip.caught_by else f"no test: {slip.survives}"
        )
        rows.append(f"| {slip.what} | `{slip.file}` | {noticed} |")
    return "\n".join(rows) + "\n"


def page_with(text: str) -> str:
    """Return the text of the page with the table between its marks."""
    before, rest = text.split(MARKS[0])
    return before + MARKS[0] + "\n" + table() + "\n" + MARKS[1] + rest.split(MARKS[1])[1]


def main(arguments: Sequence[str] | None = None) -> int:
    """Try the slips; the exit code is 1 where one was not noticed."""
    parser = argparse.ArgumentParser(prog="python -m tests.mutate", description=str(__doc__).split("\n")[0])
    parser.add_argument("names", nargs="*", help="of the slips to try; all without any")
    parser.add_argument("--page", action="store_true", help="write the table of the page, try nothing")
    parser.add_argument("--random", type=int, default=0, metavar="COUNT", help="try so many random slips")
    parser.add_argument("--seed", type=int, default=1, help="of the random slips")
    given = parser.parse_args(arguments)
    if given.random:
        return int(random_slips.score(given.random, given.seed) < random_slips.WANTED)
    if given.page:
        PAGE.write_text(page_with(PAGE.read_text()))
        return 0
    tried = [slip for slip in slips() if slip.caught_by and (not given.names or slip.name in given.names)]
    with tempfile.TemporaryDirectory() as folder:
        copy = copied(Path(folder))
        if outcome(copy, sorted({slip.caught_by for slip in tried}), shown=True) != PASSED:
            print("the tests that are named do not pass without a slip")
            return 1
        missed = 0
        for slip in tried:
            noticed = slipped(copy, slip)
            missed += not noticed
            print(f"{'noticed' if noticed else 'MISSED '}  {slip.name}: {slip.what}", flush=True)
    print(f"{len(tried) - missed} of {len(tried)} slips noticed")
    return int(missed > 0)


if __name__ == "__main__":
    raise SystemExit(main())
