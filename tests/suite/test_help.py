"""Every command explains itself: purpose, examples that run, options with units; former names still work."""

import argparse
import re
import shutil
import subprocess
from functools import cache
from pathlib import Path

import pytest

import spline_model
from spline_model import cross_axis_pivot, solve_impulses
from studies.__main__ import command_of, main
from studies.cases.problem import FOLDER
from studies.commands.arguments import ROTATION
from studies.commands.parser import Parser, degrees, positive
from studies.record.source import ROOT
from studies.registry import COMMANDS, selected
from tests.table_one import TABLE_ONE

#: Commands whose examples take a second or two; those of all others run with the slow tests.
QUICK = ("solve", "modes", "case", "markers")
#: Examples, by how they begin, that are parsed and not run, and why.
PARSED = {
    "run paper": "takes minutes, and `make results` runs it",
    "verify paper": "takes minutes, and `make verify` runs it",
    "interactive": "serves until it is stopped; tests/interactive runs it",
    "sweep DESIGNS.toml --out designs --scheduler": "needs a cluster; tests/sweep/test_command.py has one",
    "calibrate": "needs a camera; tests/interactive gives it a film",
    "compile": "removes the kernels that other tests run at the same time; `make setup` runs it",
    "readme": "rewrites README.md; tests/suite/test_results.py has what it writes",
}
#: What an example is run with beside its own words, so that it writes only here.
BESIDE = {name: ["--results", "results"] for name in ("run", "draw", "verify")}

NUMBERS = (float, positive, degrees, ROTATION.read)
UNIT = re.compile(r"\bin (s|deg|rad|m|mm|MPa|N m/rad|EI/L\^2)\b|\brelative\b|\bin s or rad\b")


@cache
def parser_of(name: str) -> Parser:
    return command_of(name)[1]


def examples(name: str) -> list[str]:
    """Return what the examples of a command's help say after `python -m studies`."""
    return re.findall(r"^    python -m studies (.+)$", parser_of(name).description or "", flags=re.MULTILINE)


def why_parsed(words: str) -> str:
    """Return why an example is not run; empty for one that is."""
    return next((why for begin, why in PARSED.items() if words.startswith(begin)), "")


EXAMPLES = [
    pytest.param(words, marks=() if name in QUICK or why_parsed(words) else pytest.mark.slow, id=words)
    for name in COMMANDS
    for words in examples(name)
]


def test_overview_names_every_command(capsys):
    """`--help` lists every command with what it does, and an example."""
    with pytest.raises(SystemExit):
        main(["--help"])
    said = capsys.readouterr().out
    for name, text in COMMANDS.items():
        assert re.search(rf"^  {name} +{re.escape(text)}$", said, flags=re.MULTILINE)
    assert max(map(len, said.splitlines())) <= 110
    (example,) = re.findall(r"^    python -m studies (.+)$", said, flags=re.MULTILINE)
    assert example in examples(example.split()[0])


@pytest.mark.parametrize("name", COMMANDS)
def test_help_has_purpose_and_example(name):
    """A command's help begins with its purpose in one sentence and an example, and tells the exit codes."""
    purpose, shown, *rest = (parser_of(name).description or "").split("\n\n")
    assert re.fullmatch(r"[A-Z][^.]+\.", purpose.replace("\n", " "))
    assert len(purpose) <= 140
    found = examples(name)
    assert len(found) == len(shown.splitlines()) >= 1, "the second paragraph is examples alone"
    assert all(words.split()[0] == name for words in found)
    assert "xit code" in " ".join(rest).replace("\n", " ")


def undocumented(action: argparse.Action) -> str:
    """Return what the help of an option lacks; empty for nothing."""
    said = action.help or ""
    if not said or said == argparse.SUPPRESS:
        return "no help"
    if action.nargs != 0 and action.option_strings and not action.required and "default" not in said:
        return "no default"
    if action.type in NUMBERS and not UNIT.search(said):
        return "no unit"
    if action.nargs != 0 and action.choices is None and action.metavar is None:
        return "no name of its value"
    return ""


@pytest.mark.parametrize("name", COMMANDS)
def test_every_option_is_documented(name):
    """Each option says what it is, its default where it has one, and the unit of a number."""
    lacks = {"/".join(a.option_strings) or a.dest: undocumented(a) for a in parser_of(name)._actions}
    assert {option: lack for option, lack in lacks.items() if lack} == {}


@pytest.mark.skipif(not shutil.which("bash"), reason="bash is not installed")
@pytest.mark.parametrize(
    ("before", "word", "completed"),
    [
        ("crosspivot", "crit", ["critical-load"]),
        ("crosspivot solve", "titan", ["titanium_pivot"]),
        ("crosspivot solve titanium_pivot", "--incr", ["--increments"]),
        ("crosspivot solve --measure", "", ["material", "spatial", "published"]),
        ("crosspivot run", "convergence/el", ["convergence/elements"]),
    ],
)
def test_words_are_completed(before, word, completed, tmp_path):
    """The script of `completion` completes commands, cases, options, their choices and studies in bash."""
    assert main(["completion", "--out", str(tmp_path / "script.sh")]) == 0
    words = [*before.split(), word]
    folder = tmp_path / "empty"
    folder.mkdir()
    asked = (
        f"source ../script.sh; COMP_WORDS=({before} '{word}'); COMP_CWORD={len(words) - 1}; "
        f"_crosspivot crosspivot '{word}' {words[-2]}; echo ${{COMPREPLY[@]}}"
    )
    done = subprocess.run(["bash", "-c", asked], cwd=folder, capture_output=True, text=True, check=True)
    assert done.stdout.split() == completed


@pytest.mark.parametrize("words", EXAMPLES)
def test_example_runs(words, tmp_path, monkeypatch, capsys):
    """An example of a help runs as it is written, on a design of one's own as on those of the suite."""
    name, *rest = words.split()
    arguments = parser_of(name).parse_args(rest)
    if name in ("run", "draw", "verify"):
        assert selected(arguments.names)
    if why_parsed(words):
        return
    if name == "markers":
        pytest.importorskip("cv2")
    for path in (ROOT / "studies").rglob("*.toml"):
        place = tmp_path / path.relative_to(ROOT)
        place.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(path, place)
    shutil.copy(FOLDER / "cross_axis_pivot.toml", tmp_path / "my_pivot.toml")
    _own_results(name, tmp_path / "results")
    monkeypatch.chdir(tmp_path)
    assert main([name, *rest, *BESIDE.get(name, ())]) == 0
    assert capsys.readouterr().out or any(tmp_path.iterdir())


def _own_results(name: str, folder: Path) -> None:
    """Give `draw` and `judge` a copy of what they read."""
    if name == "judge":
        shutil.copytree(ROOT / "results" / "reference", folder / "reference")
    if name == "draw":
        shutil.copytree(ROOT / "results" / "data" / "paper", folder / "data" / "paper")
        (folder / "figures").mkdir()


SOLVE = "solve silicon_pivot --control-points 5 --rotation-deg 5"
#: Arguments with a former name, and the same arguments with the present name.
FORMER = {
    "capacity silicon_pivot": "critical-load silicon_pivot",
    f"{SOLVE} --stretch=consistent --measure printed": f"{SOLVE} --stretch=consistent --measure published",
    f"{SOLVE} --stretch=consistent --measure=printed": f"{SOLVE} --stretch=consistent --measure=published",
}


@pytest.mark.parametrize("former", FORMER)
def test_former_words_of_a_command_are_accepted(former, command):
    """Requirement: the former word gives the same output, and a warning with the present word."""
    old, new = command(*former.split()), command(*FORMER[former].split())
    assert (old.code, _untimed(old.out)) == (new.code, _untimed(new.out))
    assert (new.code, new.err) == (0, "")
    assert re.fullmatch(r"studies: warning: (\S+) is now called \S+; version 0.3 ends \1\n", old.err)


def _untimed(text):
    """Return the output without the time of the solver."""
    return re.sub(r"in [\d.e+]+ ms", "", text)


def test_former_keywords_of_python_are_accepted():
    """Requirement: the former keyword, value and function give the same model, with a FutureWarning."""
    new = cross_axis_pivot(**TABLE_ONE, control_points=5, penalty_stiffness=20.0, axial_modes=3)
    with pytest.warns(FutureWarning, match="penalty_stiffness"):
        old = cross_axis_pivot(**TABLE_ONE, control_points=5, slide_stiffness=20.0, axial_modes=3)
    assert old.design.discretisation == new.design.discretisation
    with pytest.warns(FutureWarning, match="published"):
        old = cross_axis_pivot(**TABLE_ONE, control_points=5, measure="printed", stretch="consistent")
    assert old.design.discretisation.measure == "published"
    with pytest.warns(FutureWarning, match="published"):
        run = solve_impulses(new, form="printed", duration=1e-6, step=1e-6)
    assert run.settings["integrator"] == "sequential impulses, published"
    with pytest.warns(FutureWarning, match="motion_penalty_stiffness"):
        assert spline_model.swinging_slide_stiffness is spline_model.motion_penalty_stiffness
