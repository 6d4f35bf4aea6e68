"""For all tests: no kernel of a source which is gone, and what a refusal looks like."""

import gc
from collections.abc import Callable

import pytest

from studies.__main__ import main
from studies.record.files import forget_stale


def pytest_configure(config: pytest.Config) -> None:
    """Drop compiled kernels of a former source, once, before the processes that run the tests begin; collect
    no garbage of imports and of the list of tests."""
    gc.disable()
    if not hasattr(config, "workerinput"):
        forget_stale()


def pytest_collection_finish() -> None:
    """Keep what was imported and collected out of every later collection of garbage."""
    gc.enable()
    gc.freeze()


@pytest.fixture
def refused(capsys: pytest.CaptureFixture[str]) -> Callable[..., str]:
    """Run `python -m studies` with words that it must refuse: exit code 2 and one line, which is returned."""

    def run(*words: object, says: str) -> str:
        capsys.readouterr()
        assert main([str(word) for word in words]) == 2
        said = capsys.readouterr()
        assert (said.out, said.err.count("\n"), said.err[-1]) == ("", 1, "\n")
        assert says in said.err
        return said.err

    return run
