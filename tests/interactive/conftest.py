"""A server without pictures, for the tests of a module."""

import pytest


@pytest.fixture(scope="module")
def server():
    """A server without pictures."""
    pytest.importorskip("cv2", reason="the extra `interactive` is not installed")
    pytest.importorskip("uvicorn", reason="the extra `interactive` is not installed")
    from studies.interactive.web.server import Server, Settings

    with Server(Settings(camera="none")) as hosted:
        yield hosted
