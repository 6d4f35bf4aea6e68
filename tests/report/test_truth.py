"""What the report says of the paper, of times, of surrogates and of the default is what the tables hold."""

import re
from math import degrees

import numpy as np
import pandas as pd
import pytest

from report.build import quotable
from report.content.hard_cases import kinds
from studies.record.source import ROOT
from studies.record.store import Store
from studies.stability.verdict import COLUMNS, DEFAULT, VARIED
from tests.report.sources import OneTable, text


def _stored(study, name):
    return Store().load_tables(study)[name]


def _words(path):
    return " ".join(text(path).split())


def _number(written):
    return float(written.partition("\u00a0")[0].rstrip("°"))


def test_time_of_a_picture_holds_the_search_for_the_markers(content):
    """Requirement: the time in the loop is given for tracking, solving and both, picture by picture."""
    table = _stored("paper/fig07_interactive", "frames_times")
    both = table["track_ms"] + table["solve_ms"]
    for part, times in (("track", table["track_ms"]), ("solve", table["solve_ms"]), ("both", both)):
        for name, share in (("median", 50), ("most", 95)):
            assert _number(content["facts"][f"fig07.{part}.{name}"]) == pytest.approx(
                np.percentile(times, share), rel=0.05
            )
    assert _number(content["facts"]["fig07.both.longest"]) == pytest.approx(both.max(), rel=0.05)


@pytest.mark.parametrize(
    ("name", "model"), [("paper", "n = 4, as the paper"), ("free", "n = 4, locking-free")]
)
def test_rotations_where_a_surrogate_is_nearer_are_counted(content, name, model):
    """Requirement: how often and between which rotations the four-bar is nearer than four points is said."""
    rows = _stored("cost/surrogates", "errors").set_index(["model", "rotation_rad"])["trajectory"].abs()
    nearer = [degrees(a) for a in rows[model].index if a > 0.0 and rows["four-bar", a] < rows[model, a]]
    facts = content["facts"]
    assert _number(facts[f"surrogates.path.{name}.nearer"]) == len(nearer)
    assert _number(facts[f"surrogates.path.{name}.from"]) == pytest.approx(min(nearer))
    assert _number(facts[f"surrogates.path.{name}.to"]) == pytest.approx(max(nearer))


def test_surrogate_that_is_nearer_to_the_end_takes_the_sentence_with_it():
    """Requirement: the sentence on where the splines are nearer falls when the four-bar wins at the end."""
    condition = quotable()["holds"]["surrogates.not-everywhere"]
    models = ("four-bar", "n = 4, as the paper", "n = 4, locking-free")

    def given(*spline):
        errors = np.concatenate([np.full(5, 0.5), spline, spline])
        return OneTable(
            model=np.repeat(models, 5), rotation_rad=np.tile(np.arange(5.0), 3), trajectory=errors
        )

    assert condition.made(given(0.0, 0.1, 0.9, 0.9, 0.1))
    assert not condition.made(given(0.0, 0.1, 0.9, 0.9, 0.9))
    assert not condition.made(given(0.0, 0.9, 0.1, 0.9, 0.1))


def test_default_is_counted_by_itself():
    """Requirement: cases of the default are those with its settings; settings that vary are counted apart."""
    assert DEFAULT not in set(_stored("stability/axial_modes", "outcomes")["model"])
    random = _stored("stability/fuzz", "outcomes")
    assert {DEFAULT, VARIED} == set(random["model"])
    assert COLUMNS[DEFAULT].control_points is None
    assert "its default gave no wrong answer" not in _words(ROOT / "report" / "sections" / "front.typ")


@pytest.mark.parametrize(
    ("outcome", "stopped", "warned", "kind"),
    [
        ("refused", True, True, "stopped"),
        ("refused", False, True, "warned"),
        ("wrong", False, True, "warned"),
        ("wrong", True, False, "stopped"),
        ("wrong", False, False, "wrong"),
        ("right", False, True, "right"),
        ("bad input", False, False, "bad input"),
    ],
)
def test_every_model_is_judged_with_its_own_warnings(outcome, stopped, warned, kind):
    """Requirement: stopped, off with a warning and off without one are told apart, for every model alike."""
    rows = pd.DataFrame({"outcome": [outcome], "stopped": [stopped], "warned": [warned]})
    assert list(kinds(rows)) == [kind]


def test_families_state_their_criterion(content):
    """Requirement: criterion and tolerance stand beside the outcomes of every family."""
    for row in content["listings"]["families"]["rows"]:
        assert re.search(r"%|10[⁻¹²]|same", row[1]), row[0]


@pytest.mark.parametrize("fact", ["fig05.paper.error_torque_largest", "fig05.paper.error_stiffness_largest"])
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
            assert short.startswith("no") == ("not as claimed" in full), claim
            values = (re.search(r"\((.*?)\s*%", cell)[1].replace("−", "-") for cell in (short, full))
            assert len(set(map(float, values))) == 1, claim


def test_floor_is_what_a_formulation_ends_on():
    """Requirement: a floor is the error at the most control points, not the least of any setting."""
    given = OneTable(
        basis="bezier", measure="spatial", stretch="consistent", control_points=[6, 6, 12, 12],
        error_trajectory=[0.0005, 0.0008, 0.00075, 0.00075],
    )  # fmt: skip
    assert quotable()["facts"]["map.spatial.trajectory"].made(given) == 0.00075


def test_energy_at_the_start_is_that_of_the_start():
    """Requirement: the energy that a swing begins with is taken at its first instant."""
    given = OneTable(formulation="FE refined", time_s=[0.0, 0.01], strain_J=[726.19, 728.45])
    assert quotable()["facts"]["fig06.energy"].made(given) == 726.19


def test_other_thresholds_are_told(content):
    """Requirement: the claims of a size are held against other thresholds, the suite's own among them."""
    table = content["listings"]["thresholds"]
    stated = {float(each) for row in table["rows"] for each in re.findall(r"(\d+) %", row[0])}
    shown = {float(word.split()[1].replace("%", "")) for word in table["head"][1:]}
    assert stated <= shown
    assert [row[0].split(":")[0] for row in table["rows"]].count("Fig 5") == 2
