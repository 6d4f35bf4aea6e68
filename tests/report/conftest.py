"""What the tests of the report share: its content and its pages, made once."""

import pytest

from report.build import gathered, typeset
from report.facts import Results
from studies.record.store import Store


@pytest.fixture(scope="session")
def content():
    """Everything the sections may quote. Stale results pass here; one test asks for fresh ones."""
    return gathered(Results(Store(), allow_stale=True))


@pytest.fixture(scope="session")
def pdf(content):
    """The report."""
    return typeset(content)
