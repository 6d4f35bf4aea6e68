"""Bad input is one line that says where, what was got and what was expected, with exit code 2, and nothing is
written: every key of a case file and every option of a command, and then what no rule of one value says."""

import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from studies.__main__ import command_of
from studies.answers.adapters import answer_static
from studies.answers.settings import SplineSettings
from studies.cases.document import parsed
from studies.cases.keys import EFFECT_KEYS, OWN
from studies.cases.problem import FOLDER, named_case
from studies.cases.rules import Key, Rule
from studies.commands.case import MECHANISM, PIVOT, SHOWN
from studies.errors import BadInput
from studies.record.source import ROOT
from studies.registry import COMMANDS
from studies.sweep.varied import known
from tests.suite.refused import CHANGED, FILES, FINDS, WORDS

HUGE = f"1{'0' * 400}"
#: What stands in a file -> how a refusal shows it, where that is not the same.
GOT = {
    '"45"': 'the text "45"',
    '""': 'the text ""',
    "true": "the truth value true",
    HUGE: "a whole number of about 400 digits",
    f"[0, {HUGE}]": "[0, a whole number of about 400 digits]",
    '[0, "free "]': "[0, 'free ']",
    '["free", "free"]': "['free', 'free']",
}
NO_NUMBER = ('"45"', "true", "nan", "-inf", HUGE, "[1]", "{}", "1979-05-27")
NO_PAIR = ("0", "[0]", "[0, nan]", "[0, 0, 0]", '[0, "free "]', f"[0, {HUGE}]")
#: What a rule says that it expects, without its unit -> what it must refuse.
BAD = {
    "a finite number": NO_NUMBER,
    "a positive number": ("0", "-0.2", *NO_NUMBER),
    "a number of at least 0": ("-0.2", *NO_NUMBER),
    '"monolithic" or a number of at least 0': ("-0.2", *NO_NUMBER),
    "a number between 0 and 1, both excluded": ("0.0", "1", *NO_NUMBER),
    "a number between 0 and 90, both excluded": ("0", "90", *NO_NUMBER),
    "a number from -360 to 360": ("-361", "400", *NO_NUMBER),
    "a number above -1 and at most 0.5": ("-1", "0.51", *NO_NUMBER),
    "a whole number from 4 to 100": ("3", "101", "4.5", *NO_NUMBER),
    **{
        f"a whole number from 1 to {n}": ("0", str(n + 1), "4.5", *NO_NUMBER)
        for n in (100, 200, 10**4, 10**5)
    },
    "true or false": ("1", '"45"', "[1]"),
    'a list of some of "x", "y", "rotation"': ('"45"', "[]", "[1]", "1"),
    "two finite numbers [x, y]": NO_PAIR,
    'two finite numbers [x, y], one of them or "free"': ('["free", "free"]', *NO_PAIR),
    "two instants [begin, end], the first before the second": ("[1, 0]", "[1, 1]", *NO_PAIR),
    "pairs [time, factor] with increasing times": ("[[0, 0], [0, 1]]", "[[0]]", "[]", *NO_PAIR),
}
#: The same of all rules of a kind.
BAD_TEXTS = {"text": ("45", "true", "nan", "[1]", "{}"), "choice": ('"45"', '""', "45", "true", "{}")}

Document = dict[str, dict[str, str]]
TABLES = (PIVOT, MECHANISM, {"[[strips]]": OWN}, {f"[effects.{e}]": rows for e, rows in EFFECT_KEYS.items()})
ROWS = [
    (kind, title, key) for kind, each in enumerate(TABLES) for title, rows in each.items() for key in rows
]


def document_of_kind(kind: int) -> Document:
    """Return the tables of a template as texts, of a pivot (0, 3) or of a mechanism (1, 2)."""
    return {
        title: {key.name: key.example for key in rows if not key.optional or key.name in SHOWN}
        for title, rows in (MECHANISM if kind in (1, 2) else PIVOT).items()
    }


def written(path: Path, document: Document) -> Path:
    """Write a case file and return its path."""
    lines = [line for title, rows in document.items() for line in (title, *map(" = ".join, rows.items()))]
    path.write_text("\n".join(lines), encoding="utf-8")
    return path


def bad_values(rule: Rule) -> tuple[str, ...]:
    """Return what a rule must refuse, by what it says that it expects."""
    return BAD_TEXTS.get(rule.kind) or BAD[re.sub(r" \[[^\[\]]*\]$", "", rule.expected)]


def faults(key: Key, table: dict[str, str]) -> list[tuple[dict[str, str], str]]:
    """Return tables with a fault in one key, and what must be said of it behind the name of the table."""
    others = {name: text for name, text in table.items() if name != key.name}
    wrong = f"{key.name[1:]}_"
    found = [
        (others | {key.name: bad}, f"{key.name}: got {GOT.get(bad, bad)}, expected {key.rule.expected}")
        for bad in bad_values(key.rule)
    ]
    found.append(
        (table | {wrong: "1"}, f"{wrong}: got an unknown key, expected {key.name} (the nearest name)")
    )
    if not key.optional:
        found.append((others, f"{key.name}: got no such key, expected {key.rule.expected}"))
    return found


@pytest.mark.parametrize(("kind", "title", "key"), ROWS, ids=lambda each: getattr(each, "name", str(each)))
def test_every_key_of_a_case(kind, title, key, tmp_path, refused):
    """Every key refuses each kind of wrong value, a misspelt name and, where it is needed, its absence."""
    document = document_of_kind(kind)
    own = {each.name: each.example for each in EFFECT_KEYS.get(key.section[8:], ()) if not each.optional}
    for table, said in faults(key, document.get(title, own)):
        path, answer = written(tmp_path / "case.toml", document | {title: table}), tmp_path / "answer.json"
        line = refused("solve", path, "--json", answer, says=f".{said}\n")
        assert line.startswith(f"studies: {path}: {key.section}")
        assert not answer.exists()


@pytest.mark.parametrize("title", PIVOT)
def test_every_section_of_a_pivot(title, tmp_path, refused):
    """A table that is missing is refused with what it needs; and so is one that is none, or misspelt."""
    document, path, name = document_of_kind(0), tmp_path / "case.toml", title[1:-1]
    table = document.pop(title)
    refused("solve", written(path, document), says=f": {title}: got no such section, expected one with ")
    refused("solve", written(path, {f"{name} = 3": {}} | document), says=f": {name}: got int, expected a ta")
    said = f": [{name}_]: got an unknown section, expected {name} (the nearest name)\n"
    refused("solve", written(path, document | {f"[{name}_]": table}), says=said)


def test_every_key_of_a_sweep(tmp_path, refused):
    """Whatever number a sweep varies is held to the rule of its key, and the folder is not made."""
    path, out, case = tmp_path / "designs.toml", tmp_path / "out", parsed(FOLDER / "cross_axis_pivot.toml")
    for key, rule in (known("case", case, "fe") | known("case", case, "spline")).items():
        model = "fe" if key == "settings.elements" else "spline"
        for bad in bad_values(rule) if rule.kind == "number" or key.startswith("settings") else ():
            path.write_text(f'case = "cross_axis_pivot"\nmodel = "{model}"\nvary.{key} = [{bad}]')
            refused("sweep", path, "--out", out, says=f"{GOT.get(bad, bad)}, expected {rule.expected}\n")
    assert not out.exists()


#: Option -> words that it must refuse beside one that is neither a number nor a name that it knows.
BEYOND = {
    **dict.fromkeys(("duration", "step", "accuracy", "tolerance", "stiffness"), ("0", "-1", "nan", "inf")),
    **dict.fromkeys(("count", "processes", "workers"), ("0", "-1", "1.5")),
    "rotation-deg": ("nan", "720", "-400", "inf"),
    "increments": ("0", "100001", "2.5"),
    "model": ("fe,fe", "spline,rod", ""),
}


@pytest.mark.parametrize("name", COMMANDS)
def test_every_option_of_a_command(name, refused):
    """Every option refuses what it does not read or does not know, before anything is read or written."""
    for each in command_of(name)[0].takes:
        option = each.usage.partition(" ")[0]
        if not option.startswith("--") or (each.read in (None, Path) and "choices" not in each.keywords):
            continue  # any text may be right, or only the case tells
        for word in ("no/?", *BEYOND.get(option[2:], ())):
            line = refused(name, f"{option}={word}", says=f"{name}: argument {option}: ")
            assert re.search(r"(got .*, expected .+|cannot be written .*|invalid int value: '.*')$", line)


@pytest.mark.parametrize(
    ("words", "change"), [(words, row) for words, rows in CHANGED.items() for row in rows]
)
def test_case_with_a_fault(words, change, tmp_path, refused):
    """What the tables of a case say together is refused with the file's name."""
    verb, name, *more = words.split()
    old, new, said = change
    (place,) = (each for folder in (FOLDER, FINDS) if (each := folder / f"{name}.toml").is_file())
    text, path = place.read_text(encoding="utf-8"), tmp_path / "case.toml"
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    line = refused(verb, path, *more, says=said)
    assert line.startswith(f"studies: {path}: ") or verb not in ("solve", "converge")


@pytest.mark.parametrize("text", FILES, ids=ascii)
def test_file_that_is_no_design(text, tmp_path, refused):
    """A file without what a design needs is refused with what it needs."""
    path = tmp_path / "case.toml"
    path.write_bytes(text.encode("utf-8", "surrogatepass"))
    assert refused("modes", path, says=FILES[text]).startswith(f"studies: {path}: ")


@pytest.mark.parametrize("words", WORDS)
def test_words_with_a_fault(words, tmp_path, refused, monkeypatch):
    """What commands, files and options say together is refused, and the folder is left as it was."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "there").touch()
    (tmp_path / "mine.toml").write_text("x", encoding="utf-8")
    refused(*words.replace("CASE", "cross_axis_pivot").split(), says=WORDS[words])
    assert sorted(path.name for path in tmp_path.iterdir()) == ["mine.toml", "there"]
    assert (tmp_path / "mine.toml").read_text(encoding="utf-8") == "x"


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"crossing_ratio": 1.5}, "spline: crossing_ratio: got 1.5, expected a number between 0 and 1"),
        ({"increments": 0}, "spline: increments: got 0, expected an integer >= 1"),
        ({"thickness": None}, "spline: thickness: got None, expected width and thickness, both or neither"),
    ],
)
def test_design_made_in_code(change, said):
    """A pivot that is made in code is held to the rules of the model that is asked."""
    with pytest.raises(BadInput, match=re.escape(said)):
        answer_static(replace(named_case(), **change), SplineSettings(control_points=4))


def test_bad_input_as_a_user_sees_it(tmp_path):
    """The process itself ends with exit code 2, one line on the error stream and no traceback."""
    case = tmp_path / "case.toml"
    case.write_text("[strip]\nlenght_m = 1\n", encoding="utf-8")
    words = [sys.executable, "-m", "studies", "solve", str(case), "--model", "fe"]
    done = subprocess.run(words, cwd=Path(ROOT), capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == (
        f"studies: {case}: strip.lenght_m: got an unknown key, expected length_m (the nearest name)\n"
    )
