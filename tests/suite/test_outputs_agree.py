"""Outputs of one run never disagree, and random files are answered or refused in one line."""

import json
import math
import random
import re

import pandas as pd
import pytest

from studies.__main__ import main
from studies.cases.problem import FOLDER
from tests.suite.refused import FINDS

QUICK = ("titanium_pivot", "parallel_strip_guide", "shallow_arch", "free_flight", "led_guide", "half_circle")
CASES = sorted((*FOLDER.glob("*.toml"), *FINDS.glob("*.toml")))
COMMANDS = {
    "solve": [],
    "release": ["--duration", 0.002, "--no-check"],
    "modes": ["--count", 3],
    "critical-load": [],
}
SMALL = {"spline": ["--control-points", 6], "fe": ["--elements", 8]}
#: What the JSON has as one number in every state, and the command that prints it in every row.
SERIES = {"solve": "torque_Nm", "release": "strain_energy_J", "modes": "frequency_Hz"}
CELL = re.compile(r"-?\d+\.?\d*(?:e[-+]?\d+)?")
#: Digits of a cell by which it is known, and the part of a step of its last digit that rounding takes.
ENOUGH, HALF = 3, 0.5000001


def stands_in(value, text):
    """Whether a number stands in a text, in a unit of any power of ten, to the digits of its cell."""
    for cell in CELL.findall(text):
        digits = re.sub(r"e.*", "", cell).replace("-", "").replace(".", "").lstrip("0")
        if value == 0.0 and not digits:
            return True
        if value == 0.0 or len(digits) < ENOUGH:
            continue
        mantissa = abs(value) / 10.0 ** (math.floor(math.log10(abs(value))) + 1 - len(digits))
        if min(abs(mantissa * by - int(digits)) for by in (0.1, 1.0, 10.0)) <= HALF:
            return True
    return False


def expected_of(command, answer):
    """The numbers of an answer that its table must have."""
    if command == "critical-load":
        share = answer["weight_share"] if answer["critical_load_N"] == 0.0 else None
        return [each for each in (share, answer["critical_load_N"] or None) if each is not None]
    found = [each for each in answer.get(SERIES[command]) or [] if each is not None]
    return [each for each in (found if command == "modes" else found[-1:]) if abs(each) > 1e-9]


@pytest.mark.parametrize("model", SMALL)
@pytest.mark.parametrize("name", COMMANDS)
@pytest.mark.parametrize(
    "path",
    [pytest.param(path, marks=[] if path.stem in QUICK else [pytest.mark.slow]) for path in CASES],
    ids=lambda path: path.stem,
)
def test_all_that_a_run_leaves_is_one_answer(path, name, model, command, tmp_path):
    """Requirement: code 0 is the status converged, code 3 another one with its reason as an error, code 2 one
    line without files; the numbers of the table and of the CSV are those of the JSON."""
    told, table = tmp_path / "answer.json", tmp_path / "path.csv"
    more = ["--csv", table] if name == "solve" else []
    outcome = command(name, path, "--model", model, *SMALL[model], *COMMANDS[name], "--json", told, *more)
    if outcome.code == 2:
        assert (outcome.out, outcome.err.count("\n"), told.exists(), table.exists()) == ("", 1, False, False)
        return
    answer = json.loads(told.read_text(encoding="utf-8"))
    assert outcome.code == (0 if answer["status"] == "converged" else 3)
    if outcome.code == 3:
        assert answer["message"] and answer["message"] in outcome.err
    elif name in ("solve", "release", "modes"):
        assert answer["message"] in outcome.out
        assert re.search(r"^converged", outcome.out, re.MULTILINE)
    for value in expected_of(name, answer):
        assert stands_in(value, outcome.out), (value, outcome.out)
    if more:
        for key, column in pd.read_csv(table).items():
            if isinstance(answer.get(key), list):
                assert [None if pd.isna(each) else each for each in column] == pytest.approx(answer[key])


#: What may stand in place of a value: wrong types, numbers at the ends of their range, and beyond it.
NUMBERS = ("0", "-1", "1e-12", "1e-3", "0.5", "1", "7", "90", "180", "-170", "1e3", "1e9", f"1{'0' * 400}")
LIMITS = ("1e150", "1e-150", "1e308", "5e-324", "nan", "inf", "-inf")
TEXTS = ('"1"', '""', '"ground"', '"free"', '"steel"', "true", "1979-05-27")
LISTS = ("[]", "[0]", "[0, 0]", "[1, nan]", "[[0, 1], [1, 0]]", "{}", '["+gravity"]')
VALUES = (*NUMBERS, *LIMITS, *TEXTS, *LISTS, '["+root_compliance", "+anticlastic"]')
LINE = re.compile(r"^(\w+) *= *(.*?)( *#.*)?$")
ASKED = (
    ("solve",),
    ("solve", "--model", "fe", "--elements", "6"),
    ("modes",),
    ("release", "--duration", "0.002"),
    ("solve", "--control-points", "5"),
)


def changed(text, rng):
    """A case file with one to three of its lines changed, removed, doubled, or joined by a key of none."""
    lines = text.splitlines()
    for _ in range(rng.randint(1, 3)):
        place = rng.randrange(len(lines))
        found, act = LINE.match(lines[place]), rng.random()
        if found and act < 0.75:
            lines[place] = f"{found[1]} = {rng.choice(VALUES)}"
        elif act < 0.85:
            del lines[place]
        elif act < 0.9:
            lines.insert(place, lines[place])
        elif act < 0.95:
            lines.insert(
                place, f"{rng.choice(('width_m', 'rise_m', 'lenght_m', 'mass_kg'))} = {rng.choice(VALUES)}"
            )
        else:
            lines.insert(place, rng.choice(("[scene]", "[effects.gravity]", "[[bodies]]", "= 3", "[strip")))
    return "\n".join(lines)


def ask(seed, path, capsys):
    """Ask a command about the random file of a seed, and refuse what no command may do."""
    rng = random.Random(seed)
    cases = sorted(FOLDER.glob("*.toml"))
    text = changed(rng.choice(cases).read_text(encoding="utf-8"), rng)
    words = rng.choice(ASKED)
    path.write_text(text, encoding="utf-8")
    code = main([words[0], str(path), *words[1:]])
    said = capsys.readouterr()
    assert code in (0, 2, 3), (seed, code)
    if code == 2:
        assert (said.out, said.err.count("\n")) == ("", 1), (seed, said.err)
        assert said.err.startswith("studies: "), (seed, said.err)


@pytest.mark.parametrize(
    "block", [*range(5), *(pytest.param(block, marks=pytest.mark.slow) for block in range(5, 30))]
)
def test_random_files_are_answered_or_one_line(block, tmp_path, capsys):
    """Requirement: of three hundred random case files each is answered or refused in one line."""
    for seed in range(10 * block, 10 * block + 10):
        ask(seed, tmp_path / "case.toml", capsys)
