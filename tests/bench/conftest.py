"""Seconds are for `make bench` alone: with other tests beside them, as in `make test`, they say nothing."""

from pathlib import Path

import pytest

#: What compares times.
TIMED = "test_ratios.py"


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Skip the comparison of times unless benchmarks are enabled."""
    return True if collection_path.name == TIMED and not config.getoption("benchmark_enable") else None
