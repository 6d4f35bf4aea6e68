"""Random case files: an answer or one line, whatever stands in them, and never a traceback."""

import random
import re

import pytest

from studies.__main__ import main
from studies.cases.problem import FOLDER

#: What may stand in place of a value: wrong types, numbers at the ends of their range, and beyond it.
NUMBERS = ("0", "-1", "1e-12", "1e-3", "0.5", "1", "7", "90", "180", "-170", "1e3", "1e9", f"1{'0' * 400}")
LIMITS = ("1e150", "1e-150", "1e308", "5e-324", "nan", "inf", "-inf")
TEXTS = ('"1"', '""', '"ground"', '"free"', '"steel"', "true", "1979-05-27")
LISTS = ("[]", "[0]", "[0, 0]", "[1, nan]", "[[0, 1], [1, 0]]", "{}", '["+gravity"]')
VALUES = (*NUMBERS, *LIMITS, *TEXTS, *LISTS, '["+root_compliance", "+anticlastic"]')
LINE = re.compile(r"^(\w+) *= *(.*?)( *#.*)?$")
COMMANDS = (
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
    words = rng.choice(COMMANDS)
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
