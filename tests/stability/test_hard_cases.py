"""Hard cases: how an answer is judged, no wrong answer of the default, settled references, the gates."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from studies.answers.adapters import answer_static
from studies.answers.metrics import differences
from studies.answers.settings import SplineSettings
from studies.errors import BadInput
from studies.paper import formulations
from studies.published.arcs import LIMIT, arc_of
from studies.published.case import published
from studies.record.store import Store
from studies.registry import STUDIES
from studies.stability import verdict
from studies.stability.buckling import OTHER, PRIMARY
from studies.stability.families import slender
from studies.stability.verdict import DEFAULT, FE, OUTCOMES, PAPER, TWELVE, VARIED, Found, judged
from tests import gates

FAMILIES = [name for name in STUDIES if name.startswith("stability/")]


@cache
def tables(family):
    """Return the stored tables of a family."""
    return Store().load_tables(family)


@pytest.mark.parametrize("family", FAMILIES)
def test_default_is_never_wrong(family):
    """Requirement: the default's answers, or those of varied settings, are right or refused, never wrong."""
    found = tables(family)["outcomes"]
    mine = found[found["model"] == (VARIED if family.endswith("axial_modes") else DEFAULT)]
    assert len(mine) > 0
    wrong = mine[mine["outcome"] == "wrong"]
    assert wrong.empty, wrong[["case", "error", "reason"]].to_string()
    refused = mine[mine["outcome"].isin(("refused", "bad input"))]
    assert (refused["reason"].astype(str).str.len() > 10).all()
    assert (mine["outcome"] == "right").sum() > 0.3 * len(mine)  # a model that refuses all is no use


@pytest.mark.parametrize("family", FAMILIES)
def test_references_are_settled(family):
    """Requirement: what others are held against, if not closed books or themselves, agrees with its own
    refinement and an independent model."""
    if "references" in tables(family):
        references = tables(family)["references"]
        assert (references["settled"] == "yes").all(), references[references["settled"] != "yes"].to_string()


SIX = SplineSettings(control_points=6)


def slender_error(slenderness=1000.0):
    """Largest difference of torque to the inextensible strip, at one slenderness, and Newton iterations."""
    rigid = answer_static(slender(slenderness), replace(SIX, stretch="inextensible"))
    answer = answer_static(slender(slenderness), SIX)
    counts = {each.counters["newton_iterations"] for each in (rigid, answer)}
    return differences(answer, rigid, ("torque",))["torque"], counts


def test_slender_strips_tend_to_inextensible_ones():
    """Requirement: at L/t = 1000 the torque is that of inextensible strips, and the work stays the same."""
    gates.hold("stability_slender", lambda slenderness=1000.0: slender_error(slenderness)[0])
    far, counts = slender_error(1e5)
    assert far * 1e10 == pytest.approx(slender_error(100.0)[0] * 1e4, rel=1e-2)  # it goes with (L/t)^-2
    assert max(counts) <= 1.2 * min(counts)


def energy_gain(model=DEFAULT):
    """Largest gain of energy of a column over all steps and amplitudes."""
    found = tables("stability/step_size")["outcomes"]
    return float(found[found["model"] == model]["energy_gain"].max())


def test_no_step_gains_energy():
    """Requirement: from 1e-7 to 1e-2 s no step gains energy, but those of generalised-alpha."""
    gates.hold("stability_energy_gain", energy_gain)


def on(branch, model):
    """Return the states of the pushed pivot on a branch, by depth."""
    rows = tables("stability/buckling")["branches"].set_index("asked_mm").sort_index()
    return rows[(rows["model"] == model) & (rows["branch"] == branch)]


@pytest.mark.parametrize("model", [TWELVE, FE])
def test_the_turned_branch_is_the_stable_one(model):
    """Requirement: pushed beyond the buckling of its strips the pivot turns: stable, with less energy."""
    turned, straight = on(OTHER, model), on(PRIMARY, model)
    assert (turned["unstable_directions"] == 0).all()
    assert (straight["unstable_directions"] == 2).all()
    assert (turned["energy_J"] < straight["energy_J"]).all()


def energy_difference(turned=OTHER):
    """Largest difference of stored energy to that of the elements, over both branches and all depths; these
    are to be on the branch `turned` where the splines are on the turned one."""
    return max(
        float(np.abs(on(branch, TWELVE)["energy_J"] / on(other, FE)["energy_J"] - 1.0).max())
        for branch, other in ((PRIMARY, PRIMARY), (OTHER, turned))
    )


def test_both_models_are_on_the_same_branches():
    """Requirement: on either branch both models store the same energy."""
    gates.hold("buckling_branches", energy_difference)


def test_the_default_is_right_where_the_paper_s_choices_are_wrong():
    """Requirement: limits, branches and the turned pivot: the default finds each; the judgement has teeth,
    the locking cubic fails in all geometries and misses most of what is asked of buckling."""
    counts = tables("stability/buckling")["counts"].set_index("model")
    assert (counts.loc[[DEFAULT, TWELVE], "right"] == counts.loc[[DEFAULT, TWELVE], "tried"]).all()
    assert counts.loc[PAPER, "wrong"] > counts.loc[PAPER, "tried"] / 2
    found = tables("stability/geometry")["outcomes"]
    assert (found[found["model"] == PAPER]["outcome"] == "wrong").all()


def raising(error):
    """Return an attempt that raises."""

    def attempt():
        raise error

    return attempt


@pytest.mark.parametrize(
    ("attempt", "outcome"),
    [
        (lambda: Found(error=0.01), "right"),
        (lambda: Found(error=0.5), "wrong"),
        (lambda: Found(error=math.nan), "wrong"),
        (lambda: Found(error=math.inf), "wrong"),
        (lambda: Found(error=0.01, reached=False, reason="stopped"), "refused"),
        (lambda: Found(error=0.5, reached=False, reason="stopped"), "wrong"),
        (lambda: Found(error=0.5, reason="too coarse", states_limit=True), "refused"),
        (lambda: Found(error=0.01, reason="too coarse", states_limit=True), "right"),
        (lambda: Found(error=0.01, fault="energy grows", states_limit=True), "wrong"),
        (raising(BadInput("length: got -1")), "bad input"),
        (raising(ZeroDivisionError("division by zero")), "wrong"),
    ],
)
def test_every_ending_has_its_outcome(attempt, outcome):
    """An answer is right, refused, wrong or bad input; a refusal must leave a good state."""
    assert judged(attempt, 0.05)["outcome"] == outcome
    assert outcome in OUTCOMES


def test_columns_are_what_they_say():
    """The default is the model's own default, and the paper's choices are those of the paper's figures."""
    assert verdict.COLUMNS[verdict.DEFAULT] == SplineSettings()
    assert verdict.COLUMNS[verdict.PAPER] == formulations.SETTINGS[formulations.PAPER]
    assert set(verdict.COLUMNS) <= set(verdict.ORDER)


@pytest.mark.parametrize("points", [12, 15])
def test_a_path_in_its_arc_length_does_not_go_back(points):
    """Requirement: a frame that snaps through has two limit points. With 15 control points a prediction lay
    behind the first one, so that the path went over it three times."""
    arc = arc_of(published("williams_toggle").frame(), SplineSettings(control_points=points))
    assert [point.kind for point in arc.critical] == [LIMIT, LIMIT]
