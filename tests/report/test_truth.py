"""What the report says of the paper, of times, of simple models and of the default is that of the tables."""

import re

import pytest

from studies.record.source import ROOT
from studies.record.store import Store
from studies.stability.verdict import COLUMNS, DEFAULT, VARIED


def _stored(study, name):
    return Store().load_tables(study)[name]


def test_default_is_counted_by_itself():
    """Requirement: cases of the default are those with its settings; settings that vary are counted apart."""
    assert DEFAULT not in set(_stored("stability/axial_modes", "outcomes")["model"])
    random = _stored("stability/fuzz", "outcomes")
    assert {DEFAULT, VARIED} == set(random["model"])
    assert COLUMNS[DEFAULT].control_points is None


def test_families_state_their_criterion(content):
    """Requirement: criterion and tolerance stand beside the outcomes of every family."""
    for row in content["listings"]["families"]["rows"]:
        assert re.search(r"%|10[⁻¹²]", row[1]), row[0]


def test_families_are_those_of_the_findings(content):
    """Requirement: docs/findings.md and the report count the outcomes of a family alike."""
    page = (ROOT / "docs" / "findings.md").read_text(encoding="utf-8")
    for family, _, default, *_ in content["listings"]["families"]["rows"]:
        assert f"| {family.replace(' ', '_')} | {default.replace('–', '')}".rstrip() in page


@pytest.mark.parametrize("fact", ["locking.torque", "locking.stiffness", "elements.twenty.torque"])
def test_readme_and_report_print_the_same_numbers(content, fact):
    """Requirement: what README.md says of the paper's choices is what the report says, digit by digit."""
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert content["facts"][fact].replace("\u00a0", " ") in readme


def test_findings_and_report_print_the_same_verdicts(content):
    """Requirement: docs/findings.md has the verdicts and measured values of the report, claim by claim."""
    page = (ROOT / "docs" / "findings.md").read_text(encoding="utf-8")
    lines = [line.strip("| ").split(" | ") for line in page.splitlines()]
    told = {line[0]: line[1:] for line in lines if line[0].startswith("Fig ")}
    reported = {row[0]: row[1:] for row in content["listings"]["claims"]["rows"]}
    assert told and set(told) <= set(reported)
    for claim, cells in told.items():
        for short, full in zip(cells, reported[claim], strict=True):
            assert short.partition(" ")[0] == full.partition(" ")[0], claim
            values = (re.search(r"\((.*?)\s*%", cell)[1].replace("−", "-") for cell in (short, full))
            assert len(set(map(float, values))) == 1, claim
