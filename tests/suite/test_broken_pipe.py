"""A reader that closes the pipe early, as `head` does, ends a command without an error message."""

import os
import subprocess
import sys

import pytest

from studies.record.source import ROOT

TABLE = ["solve", "studies/cases/cross_axis_pivot.toml", "--model", "fe", "--increments", "1"]


def code_without_a_reader(*words: str, errors: int | None = subprocess.PIPE) -> tuple[int, str]:
    """Return exit code and error stream of `python -m studies` whose output nobody reads."""
    read, write = os.pipe()
    os.close(read)
    try:
        done = subprocess.run(
            [sys.executable, "-m", "studies", *words],
            cwd=ROOT,
            stdout=write,
            stderr=errors,
            text=True,
            check=False,
        )
    finally:
        os.close(write)
    return done.returncode, done.stderr or ""


@pytest.mark.parametrize("words", [["list"], TABLE], ids=["list", "table"])
def test_a_reader_that_leaves_ends_the_command_quietly(words):
    """No traceback, nothing on the error stream, and the code that a shell gives for SIGPIPE."""
    assert code_without_a_reader(*words) == (141, "")


def test_an_error_that_nobody_reads_is_quiet_too():
    """With both streams gone, as in `2>&1 | true`, bad input ends without a traceback."""
    code, _ = code_without_a_reader("solve", "no.toml", "--model", "fe", errors=subprocess.STDOUT)
    assert code == 141
