"""What the tests of the machinery share: the Table 1 case and the command line in this process."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from studies.__main__ import main
from studies.cases.problem import FOLDER


class Outcome(NamedTuple):
    """What a command left behind."""

    code: int
    out: str
    err: str


@pytest.fixture
def case(tmp_path: Path) -> Callable[..., Path]:
    """Write the Table 1 case with texts replaced (old, new) and return its path."""

    def write(*replacements: tuple[str, str]) -> Path:
        text = (FOLDER / "cross_axis_pivot.toml").read_text(encoding="utf-8")
        for old, new in replacements:
            assert old in text, f"{old!r} is not in the Table 1 case"
            text = text.replace(old, new)
        path = tmp_path / "case.toml"
        path.write_text(text, encoding="utf-8")
        return path

    return write


@pytest.fixture
def command(capsys: pytest.CaptureFixture[str]) -> Callable[..., Outcome]:
    """Run `python -m studies` with the given words in this process."""

    def run(*words: object) -> Outcome:
        code = main([str(word) for word in words])
        captured = capsys.readouterr()
        return Outcome(code, captured.out, captured.err)

    return run


@pytest.fixture
def answered(command: Callable[..., Outcome]) -> Callable[..., dict[str, Any]]:
    """Return the JSON of a command that must succeed without a word on the error stream."""

    def run(*words: object) -> dict[str, Any]:
        outcome = command(*words, "--json", "-")
        assert (outcome.code, outcome.err) == (0, "")
        return json.loads(outcome.out)

    return run
