"""Every command answers on every case as it did: the net under changes of the code.

`python -m tests.goldens` prints what differs; with `--write` it stores the new answers.
"""

import pytest

from tests.goldens.answers import STORED, asked, compared, stored
from tests.goldens.asked import CASES, requests

REQUESTS = [
    pytest.param(request, id=request.words, marks=[pytest.mark.slow] if request.slow else [])
    for case in CASES
    for request in requests(case)
]


@pytest.mark.parametrize("request_", REQUESTS)
def test_answer_is_the_stored_one(request_):
    """Exit code, error lines and all numbers are those of the golden, within their tolerances."""
    found = compared(request_, stored(request_.case)[request_.words], asked(request_))
    assert not found, "\n".join(map(str, found))


def test_goldens_are_of_what_is_asked():
    """Every stored answer is asked, and the files stay small enough to be read and reviewed."""
    for case in CASES:
        assert list(stored(case)) == [request.words for request in requests(case)]
    sizes = {path.stem: path.stat().st_size for path in STORED.glob("*.json")}
    assert set(sizes) == set(CASES)
    assert max(sizes.values()) < 200_000
    assert sum(sizes.values()) < 1_500_000
