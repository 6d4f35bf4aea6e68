"""Small sweeps for the tests, as texts of DESIGNS.toml."""

import tomllib
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path

from studies.sweep.plan import Plan, plan_of
from studies.sweep.run import Pool

#: Twelve pivots over two settings.
GRID = Path(__file__).with_name("grid.toml").read_text(encoding="utf-8")

#: Random pivots, three keys.
RANDOM = Path(__file__).with_name("random.toml").read_text(encoding="utf-8")


def plan(text: str, folder: Path = Path()) -> Plan:
    """Return the sweep that the text describes."""
    return plan_of("designs.toml", tomllib.loads(text), folder)


@contextmanager
def within() -> Iterator[Pool]:
    """Yield a worker within this process, which knows what a test has put in place of the suite's own."""
    with ThreadPoolExecutor(1) as executor:
        yield Pool(executor=executor, workers=1)
