"""Published problems and their values; solids, and CalculiX beside them; the judge of other codes."""

import math
import re

import numpy as np
import pandas as pd
import pytest

from report.facts import Results
from studies.__main__ import main
from studies.answers.adapters import answer_modes, answer_release, answer_static
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.document import CaseError
from studies.cases.problem import named_case
from studies.errors import Unanswered
from studies.published import benchmark, calculix, problems, solid_pivot
from studies.published.case import AT_MOST, EQUAL, FOLDER, LIMIT_POINTS, Value, published, read_published
from studies.published.problems import ours
from studies.published.solids import COMPARED, PIVOT, STIFF, Design
from studies.record.store import Store
from studies.stability.buckling import load_ratio
from tests import gates
from tests.gates import hold

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


ROTATION = np.linspace(0.2, 1.0, 5)


def states(shift=0.0, **labels):
    """States of a model whose torque and place are further by a share that grows to `shift`."""
    share = 1.0 + shift * ROTATION
    values = {"torque_Nm": ROTATION * share, "com_x_m": ROTATION * share, "com_y_m": 0.0}
    return pd.DataFrame(labels | {"rotation_rad": ROTATION} | values)


def test_limits_have_the_uncertainty_of_mesh_and_order():
    """Of meshes of second order the limit is exact, and the order 1.5 makes its uncertainty."""
    mesh = {"law": STIFF, "element": "serendipity"}
    meshes = pd.concat(
        states(fineness=n, **mesh).assign(torque_Nm=lambda rows, n=n: rows["torque_Nm"] * (1.0 + 0.1 / n**2))
        for n in (2, 3, 4)
    )
    (found,) = Design(orders=(2.0, 1.5)).limits(meshes)
    assert found["torque_Nm"].to_numpy() == pytest.approx(ROTATION, rel=1e-12)
    fine = 0.1 / 9 - 0.1 / 16
    by_order = fine * abs(1.0 / ((4 / 3) ** 2 - 1.0) - 1.0 / ((4 / 3) ** 1.5 - 1.0))
    assert found["uncertainty"].to_numpy() == pytest.approx(np.full(5, by_order), rel=1e-9)
    other = meshes.assign(element="lagrange", torque_Nm=1.01 * meshes["torque_Nm"])
    (found,) = Design(orders=(2.0, 1.5)).limits(pd.concat([meshes, other]))
    assert found["uncertainty"].to_numpy() == pytest.approx(np.full(5, max(0.01, by_order)), rel=1e-9)


def test_stored_solids_are_certain():
    """The committed torque of the benchmark pivot is certain from 9 degrees on, of both laws, from at least
    three meshes and both elements."""
    tables = Store().load_tables("model_form/solid_pivot")
    meshes, limits = tables["meshes"], tables["limits"]
    count = meshes[meshes["design"] == "benchmark"].groupby(["law", "element"])["fineness"].nunique()
    assert (count.xs("serendipity", level="element") >= 3).all() and count[STIFF, "lagrange"] >= 2

    def error(design="benchmark"):
        own = limits[(limits["design"] == design) & (limits["rotation_rad"] > COMPARED)]
        assert set(own["law"]) == {mesh[1] for mesh in solid_pivot.DESIGNS[design].meshes}
        return own["uncertainty"].max()

    hold("solid_uncertainty", error)


ccx = pytest.mark.skipif(bool(calculix.missing()), reason="ccx is not installed (calculix-ccx)")
DESIGN = Design(step=9.0, states=10)


@ccx
def test_same_torque_on_the_same_mesh():
    """Torques agree up to 90 degrees; those of another material law do not."""

    def error(law="st-venant-kirchhoff"):
        strip = DESIGN.strip(1, law)
        path = DESIGN.solids(strip)
        return np.abs(calculix.driven(DESIGN.pivot, strip, path)[0] / path.torque - 1.0).max()

    hold("calculix", error)


@ccx
def test_a_state_that_is_not_reached_is_an_error():
    """Where CalculiX stops, the error has the number of states that it reached."""
    strip = DESIGN.strip(1)
    moves = np.full((1, len(strip.tip)), np.nan + 0.0j)
    with pytest.raises(Unanswered, match=r"^CalculiX: got 0 states, expected 1: "):
        calculix.end_forces(strip, moves)


def test_stored_torque_is_that_of_the_stored_solids():
    """The committed results of CalculiX agree with solids on the same meshes; a gate has how far."""

    def error(law=STIFF):
        key = ["fineness", "rotation_rad"]
        solids = Store().load_tables("model_form/solid_pivot")["meshes"]
        own = solids.query(f"design == '{PIVOT}' and element == 'serendipity' and law == '{law}'")
        both = Store().load_tables("model_form/calculix")["states"].merge(own, on=key)
        assert len(both) == 13 * len(calculix.MESHES)
        return (both["torque_Nm_x"] / both["torque_Nm_y"] - 1.0).abs().max()

    hold("calculix_stored", error)


def test_without_the_program_the_study_says_what_it_needs(monkeypatch):
    """Where CalculiX is absent, the study names it and how to install it."""
    monkeypatch.setattr(calculix, "PROGRAM", "no-such-program")
    assert calculix.STUDY.missing() == "it needs CalculiX: apt-get install calculix-ccx"


CASE = named_case()


def rows(quantity, at, value):
    """Results of one quantity."""
    return pd.DataFrame({"quantity": quantity, "at": at, "value": value})


def statics(settings):
    """Results of the static path."""
    path = answer_static(CASE, settings)
    values = {"torque_Nm": path.torque, "centre_x_m": path.centre[:, 0], "centre_y_m": path.centre[:, 1]}
    return [rows(name, path.rotation, value) for name, value in values.items()]


@pytest.fixture
def judged(tmp_path, capsys):
    """Judge tables; return exit code and quantity -> (compared, verdict)."""

    def run(tables, *words):
        place = tmp_path / "mine.csv"
        pd.concat(tables).to_csv(place, index=False)
        code = main(["judge", str(place), *words])
        lines = [line.split() for line in capsys.readouterr().out.splitlines()[2:]]
        return code, {line[0]: (" ".join(line[1:4]), line[-1]) for line in lines}

    return run


def test_package_is_of_the_stored_results():
    """The files of the package are those that the stored tables give."""
    for name, content in benchmark.package(Results(Store(), allow_stale=True).table).items():
        assert (benchmark.FOLDER / name).read_bytes() == content, name


def test_answers_of_the_suite_pass(judged):
    """Eight control points pass in statics, first frequency and free vibration."""
    settings = SplineSettings(control_points=8)
    modes = answer_modes(CASE, settings, count=5)
    motion = answer_release(CASE, settings, duration=0.01, records=50)
    results = [
        *statics(settings),
        rows("frequency_Hz", modes.mode, modes.frequency),
        rows("vibration_rotation_rad", motion.time, motion.rotation),
    ]
    code, found = judged(results)
    assert code == 0 and set(found) == set(benchmark.QUANTITIES)
    assert found["torque_Nm"] == ("20 of 20", "pass") and found["frequency_Hz"] == ("5 of 5", "pass")
    assert found["vibration_rotation_rad"] == ("50 of 250", "pass")


def test_deviations_of_a_coarse_mesh_are_named(judged):
    """Ten elements per strip deviate in torque, and the sign of the deviation does not matter."""
    coarse = statics(FeSettings(elements=10))
    code, found = judged(coarse)
    assert code == 1 and {name: verdict for name, (_, verdict) in found.items()} == {
        "torque_Nm": "deviates",
        "centre_x_m": "deviates",
        "centre_y_m": "deviates",
    }
    shear = statics(FeSettings(elements=40, element="reissner"))
    assert judged(shear, "--reference", "beam_with_shear")[0] == 0
    code, found = judged(shear)
    assert code == 1 and found["torque_Nm"] == ("20 of 20", "deviates")


@pytest.mark.parametrize(("share", "code"), [(0.999, 0), (-0.999, 0), (1.001, 1), (-1.001, 1)])
def test_uncertainty_is_added_to_the_tolerance(judged, share, code, tmp_path, monkeypatch):
    """A value passes up to the tolerance times the scale plus the uncertainty, on both sides."""
    tolerance = benchmark.QUANTITIES["torque_Nm"]["tolerance"]
    known = rows("torque_Nm", [0.5], [8.0]).assign(uncertainty=3e-3, scale=4.0)
    known.to_csv(tmp_path / "beam.csv", index=False)
    monkeypatch.setattr("studies.commands.judge.FOLDER", tmp_path)
    assert judged([known.assign(value=8.0 + share * (4.0 * tolerance + 3e-3))])[0] == code


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "got no table (No columns to parse from file), expected a CSV file in UTF-8"),
        ("quantity,at\ntorque_Nm,1\n", "got 1 rows with the columns quantity, at, expected rows with"),
        ("quantity,at,value\n", "got 0 rows with the columns quantity, at, value, expected rows with"),
        ("quantity,at,value\ntorque,1,2\n", "line 2: quantity: got torque, expected torque_Nm (the nearest"),
        ("quantity,at,value\ntorque_Nm,1,x\n", "line 2: value: got x, expected a finite number"),
        ("quantity,at,value\ntorque_Nm,nan,1\n", "line 2: at: got nan, expected a finite number"),
        ("quantity,at,value\ntorque_Nm,1\n", "line 2: value: got nothing, expected a finite number"),
        ("quantity,at,value\ntorque_Nm,90,1\n", "torque_Nm: got no value at a place of the reference,"),
        ("\udcff", "got no table ("),
    ],
)
def test_broken_files_are_one_line(text, message, tmp_path, refused):
    """A file that cannot be judged is refused with its name, what was got and what was expected."""
    place = tmp_path / "mine.csv"
    place.write_bytes(text.encode("utf-8", "surrogateescape"))
    assert refused("judge", place, says=message).startswith(f"studies: {place}: ")
