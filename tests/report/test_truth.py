"""What the report says of the paper, of times, of simple models and of the default is that of the tables."""

import re

import pytest

from studies.record.source import ROOT
from studies.record.store import Store
from studies.stability.verdict import COLUMNS, DEFAULT


def _stored(study, name):
    return Store().load_tables(study)[name]


def test_default_is_counted_by_itself():
    """Requirement: cases of the default are those with its settings; settings that vary are counted apart."""
    assert DEFAULT not in set(_stored("stability/axial_modes", "outcomes")["model"])
    assert COLUMNS[DEFAULT].control_points is None


def test_families_state_their_criterion(content):
    """Requirement: criterion and tolerance stand beside the outcomes of every family."""
    for row in content["listings"]["families"]["rows"]:
        assert re.search(r"%|10[⁻¹²]", row[1]), row[0]


@pytest.mark.parametrize("fact", ["locking.torque", "locking.stiffness", "elements.twenty.torque"])
def test_readme_and_report_print_the_same_numbers(content, fact):
    """Requirement: what README.md says of the paper's choices is what the report says, digit by digit."""
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert content["facts"][fact].replace("\u00a0", " ") in readme
