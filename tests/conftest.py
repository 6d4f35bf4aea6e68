"""For all tests: no kernel answers that was compiled from a source which is gone, and one hash a source."""

from collections.abc import Iterator
from functools import cache

import pytest

from studies.record import store
from studies.record.source import forget_stale


def pytest_configure() -> None:
    """Drop compiled kernels of a former source, once, before the processes that run the tests begin."""
    forget_stale()


@pytest.fixture(scope="session", autouse=True)
def _hashed_once() -> Iterator[None]:
    """Every study's source is hashed once in a process: no test changes it."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(store, "source_hash", cache(store.source_hash))
        yield
