"""The benchmark package, and the command that judges results of other codes by it."""

import pandas as pd
import pytest

from report.facts import Results
from studies.__main__ import main
from studies.answers.adapters import answer_modes, answer_release, answer_static
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.problem import named_case
from studies.published import benchmark
from studies.record.store import Store

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
