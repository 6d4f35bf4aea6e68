"""Small sweeps for the tests, as texts of DESIGNS.toml."""

import tomllib
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path

from studies.sweep.plan import Plan, plan_of
from studies.sweep.run import Pool

#: Twelve pivots over two settings.
GRID = """
case = "cross_axis_pivot"
[set]
drive.rotation_deg = 30
drive.increments = 4
[sample]
chunk = 5
[vary]
strip.crossing_ratio = { from = 0.3, to = 0.7, points = 3 }
settings.control_points = [4, 6]
body.centre_offset_m.x = [0.0, 0.01]
"""

#: Random pivots, three keys.
RANDOM = """
case = "cross_axis_pivot"
[set]
drive.rotation_deg = 45
[sample]
method = "sobol"
points = 200
chunk = 32
[vary]
strip.crossing_ratio = { from = 0.1, to = 0.9 }
strip.inclination_deg = { from = 25, to = 65 }
strip.slenderness = { from = 20, to = 200, scale = "log" }
"""


def plan(text: str, folder: Path = Path()) -> Plan:
    """Return the sweep that the text describes."""
    return plan_of("designs.toml", tomllib.loads(text), folder)


@contextmanager
def within() -> Iterator[Pool]:
    """Yield a worker within this process, which knows what a test has put in place of the suite's own."""
    with ThreadPoolExecutor(1) as executor:
        yield Pool(executor=executor, workers=1)
