"""What a user waits for: both models at an error of 1e-4 as a command, a first call, a whole call, a solver.

Seconds are those of one machine; everything is asked one after another, on one thread, with the kernels
compiled before. A command and a first call start Python anew each time.
"""

import json
import subprocess
import sys
import time

from studies.answers.adapters import answer_static
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.baselines.compared import spread
from studies.cases.problem import TABLE_1, named_case
from studies.engine import Answer, Part, Study
from studies.record.source import ROOT

#: Label -> settings of the least number that keep path and torque to 1e-4, and the words that ask for them.
MODELS: dict[str, tuple[Settings, tuple[str, ...]]] = {
    "spline, n = 6": (SplineSettings(control_points=6), ("--control-points", "6")),
    "80 elements": (FeSettings(elements=80), ("--model", "fe", "--elements", "80")),
}
#: Runs of a process of its own, and calls within one.
PROCESSES, CALLS = 5, 25
#: What a process is asked that makes one call: what importing and the call took [s].
FIRST = """
import json, time
begin = time.perf_counter()
from studies.answers.adapters import answer_static
from studies.work_precision.waits import MODELS
from studies.cases.problem import named_case
ready = time.perf_counter()
answer_static(named_case(), MODELS[{label!r}][0])
print(json.dumps([ready - begin, time.perf_counter() - ready]))
"""


def _waited(label: str) -> Answer:
    """Return the times of a model: a row each of what is waited for."""
    settings, words = MODELS[label]
    command = ("-m", "studies", "solve", TABLE_1, *words)
    imported, first = zip(
        *(json.loads(_process("-c", FIRST.format(label=label))[1]) for _ in range(PROCESSES)), strict=True
    )
    whole, solver = zip(*(_call(settings) for _ in range(CALLS)), strict=True)
    times = {
        "command line": [_process(*command)[0] for _ in range(PROCESSES)],
        "import of the suite": imported,
        "first call": first,
        "whole call": whole,
        "increments alone": solver,
    }
    return {"waits_of_time": [{"model": label, "what": what} | spread(each) for what, each in times.items()]}


def _process(*words: str) -> tuple[float, str]:
    """Return how long a process of Python takes [s], and what it prints."""
    begin = time.perf_counter()
    done = subprocess.run([sys.executable, *words], cwd=ROOT, capture_output=True, text=True, check=True)
    return time.perf_counter() - begin, done.stdout


def _call(settings: Settings) -> tuple[float, float]:
    """Return how long a whole call takes, from the case in memory to the answer, and its increments [s]."""
    problem = named_case()
    begin = time.perf_counter()
    answer = answer_static(problem, settings)
    return time.perf_counter() - begin, answer.solve_s


STUDY = Study(
    parts=(Part(at=lambda: tuple(MODELS), ask=_waited, alone=True),),
)
