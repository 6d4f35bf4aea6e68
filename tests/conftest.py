"""For all tests: no kernel answers that was compiled from a source which is gone."""

from studies.record.kernels import forget_stale


def pytest_configure() -> None:
    """Drop compiled kernels of a former source, once, before the processes that run the tests begin."""
    forget_stale()
