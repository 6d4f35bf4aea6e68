"""Published problems: case files with published values and sources, and the results of the models."""

import math
import re

import pytest

from studies.cases.document import CaseError
from studies.published import problems
from studies.published.case import (
    AT_MOST,
    EQUAL,
    FOLDER,
    LIMIT_POINTS,
    Value,
    published,
    read_published,
)
from studies.published.problems import ours
from studies.record.store import Store
from studies.stability.buckling import load_ratio
from tests import gates

NAMES = sorted(path.stem for path in FOLDER.glob("*.toml"))
#: Problems that the splines answer in milliseconds, and in seconds.
QUICK = ("tip_force", "princeton_edgewise", "williams_shallow_toggle", "catalogue_pivot")
SLOWER = ("williams_toggle", "lees_frame")


@pytest.mark.parametrize("name", NAMES)
def test_every_case_file_is_whole(name):
    """Requirement: a case file has source, limits for each kind of answer, and uncertainty but of counts."""
    problem = published(name)
    assert len(problem.source) > 20
    for value in problem.values:
        assert problem.answers == [*value.limit]
        assert value.uncertainty > 0.0 or value.quantity == LIMIT_POINTS


def test_every_case_file_is_a_problem_of_the_study():
    """Requirement: a case file that the study does not ask is a mistake, and so is a name without a file."""
    assert sorted(problems.PROBLEMS) == NAMES


#: Of a missing key, or of a text and what stands in its place, what must be said.
LEFT_OUT = ("source", "published", "unit", "unit_SI", "uncertainty", "limit", "quantity", "title")
WRONG = [
    *((f"^{key} =.*$", "", f"'{key}'") for key in LEFT_OUT),
    ('body = "tip"', 'body = "top"', "problem.body: got 'top'"),
    ("^quantity = .*$", 'quantity = "place"', "values number 1.quantity: got place, expected displacement_x"),
    (r"limit = \{ beam", "limit = { bean", "limit: got bean, expected beam"),
    (r"\[\[values\]\]", "[[numbers]]", "[numbers]"),
]


@pytest.mark.parametrize(("old", "new", "said"), WRONG)
def test_what_is_missing_or_wrong_is_said(tmp_path, old, new, said):
    """Requirement: a case file without value, unit, source, uncertainty or limit, with names that stand for
    nothing or with answers without a limit is refused in one line by the key."""
    text = (FOLDER / "own_weight.toml").read_text(encoding="utf-8")
    path = tmp_path / "wrong.toml"
    path.write_text(re.sub(old, new, text, flags=re.MULTILINE), encoding="utf-8")
    with pytest.raises(CaseError, match=re.escape(said)):
        read_published(path)


@pytest.mark.parametrize(
    ("bound", "found", "within"),
    [
        (EQUAL, 10.29, True),
        (EQUAL, 9.69, False),
        (AT_MOST, 10.29, True),
        (AT_MOST, 10.31, False),
        (AT_MOST, 1.0, True),
        (EQUAL, float("nan"), False),
    ],
)
def test_when_a_value_is_met(bound, found, within):
    """Requirement: uncertainty and limit add up; bounds hold on one side; NaN is no answer."""
    value = Value(
        quantity="rotation", published=10.0, unit="rad", unit_SI=1.0, uncertainty=0.1, bound=bound, limit={}
    )
    assert value.met(found, 0.02) is within


@pytest.mark.parametrize("name", [*QUICK, *(pytest.param(each, marks=pytest.mark.slow) for each in SLOWER)])
def test_splines_meet_what_is_in_print(name):
    """Requirement: the spline's answers to quick problems are the published ones."""
    for value in published(name).values:
        assert value.met(ours(name, "spline", "beam", value), value.limit["beam"])


def error_of_the_column(model="spline"):
    """Largest relative error of the loads at the printed angles of the tip, by elliptic integrals."""
    values = Store().load_tables("published/problems")["values"].query("case == 'column' and model == @model")
    return max(abs(row.found / load_ratio(math.radians(row.at)) - 1.0) for row in values.itertuples())


def test_the_column_is_the_elastica_between_printed_digits():
    """Requirement: what stands beside a printed load is off the exact one by the discretisation alone."""
    gates.hold("published_column", error_of_the_column)


def test_all_values_are_met():
    """Requirement: every published value is met by every model that is asked, and the check has teeth."""
    values = Store().load_tables("published/problems")["values"]
    missed = values[values["within"] != "yes"]
    assert missed.empty, missed[["case", "model", "answer", "quantity", "published", "found"]].to_string()
    solids = values[(values["case"] == "parallelogram") & (values["answer"] == "beam")]
    assert (solids["error"].abs() > solids["limit"] / 2).all()  # a plain beam is seen to be too soft
