"""`python -m studies audit`: what effects are worth, and a cheapest scene that is right and solves less.

What a scene costs is counted here, not timed: an audit is told Newton iterations in place of seconds.
"""

import dataclasses
import json
import math

import numpy as np
import pytest

from studies.__main__ import main
from studies.answers.adapters import answer_modes, answer_release, answer_static
from studies.answers.metrics import relative_error, trajectory_error
from studies.answers.settings import SplineSettings
from studies.cases.design import named_design
from studies.cases.effects import Effects
from studies.cases.problem import FOLDER, named_case
from studies.effects import audit as module
from studies.effects import scenes
from studies.effects.beyond import prices
from studies.effects.scenes import Variant, size_of
from studies.record.store import Store

TABLE_1 = FOLDER / "cross_axis_pivot.toml"
FULL = ("bending", "stretching", "strip_inertia", "body_inertia", "section_rotary_inertia", "gravity")
TOLERANCE = 1e-3


def counted(answer):
    """An answer of either kind whose time is its Newton iterations: 1 s each."""

    def asked(*arguments, **keywords):
        found = answer(*arguments, **keywords)
        return dataclasses.replace(found, wall_s=float(found.counters["newton_iterations"]))

    return asked


@pytest.fixture(scope="module")
def audited(tmp_path_factory):
    """The audit of Table 1 as JSON, made once, of one swing and a half."""
    from studies.__main__ import main

    path = tmp_path_factory.mktemp("audit") / "audit.json"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(scenes, "SWINGS", 1.5)
        for name in ("answer_static", "answer_release"):
            by_work = counted(getattr(scenes, name))
            for where in (scenes, module):
                patch.setattr(where, name, by_work)
        assert main(["audit", str(TABLE_1), "--tolerance", str(TOLERANCE), "--json", str(path)]) == 0
    return json.loads(path.read_text(encoding="utf-8"))


def swing_of(effects, audited):
    """The motion of Table 1 with these effects, as the audit asks it."""
    problem = dataclasses.replace(named_case("cross_axis_pivot"), effects=Effects(names=tuple(effects)))
    run = {"duration": audited["duration_s"], "step": audited["step_s"]}
    return problem, answer_release(problem, SplineSettings(control_points=6), **run)


@pytest.mark.slow
def test_cheapest_scene_is_within_the_tolerance(audited):
    """Run apart from the audit, the cheapest scene of Table 1 answers within 1e-3 of the full one."""
    best = audited["cheapest"]
    assert tuple(audited["full"]["effects"]) == FULL
    (full, swing), (least, other) = (swing_of(each["effects"], audited) for each in (audited["full"], best))
    one, two = (answer_static(problem, SplineSettings(control_points=6)) for problem in (full, least))
    changes = {
        "trajectory": float(trajectory_error(two.centre, one.centre).max()),
        "torque": float(np.abs(two.torque - one.torque).max() / np.abs(one.torque).max()),
        "swing_frequency": other.frequency / swing.frequency - 1.0,
        "first_mode": answer_modes(least, SplineSettings(control_points=6), count=1).frequency[0]
        / answer_modes(full, SplineSettings(control_points=6), count=1).frequency[0]
        - 1.0,
    }
    assert max(abs(change) for change in changes.values()) <= TOLERANCE
    for name, change in changes.items():
        assert best[name] == pytest.approx(change, rel=0.01, abs=1e-9)


def test_cheapest_scene_has_less_to_solve(audited):
    """The cheapest scene has fewer iterations in as many steps, fewer unknowns and slower oscillations."""
    best = audited["cheapest"]
    assert best["time_ratio"] == pytest.approx(audited["full_wall_s"] / best["wall_s"], rel=1e-12)
    assert best["degrees_of_freedom"] < audited["full"]["degrees_of_freedom"]
    assert best["highest_frequency_Hz"] < 0.5 * audited["full"]["highest_frequency_Hz"]
    works = [swing_of(each["effects"], audited)[1].counters for each in (audited["full"], best)]
    assert works[1]["newton_iterations"] < works[0]["newton_iterations"]
    assert works[1]["steps"] == works[0]["steps"]


def test_audit_has_a_row_for_every_effect(audited):
    """One row an effect of the full scene; what cannot run keeps its row with the reason."""
    rows = {row["dropped"][0]: row for row in audited["rows"]}
    assert tuple(rows) == FULL
    assert all(len(row["dropped"]) == 1 for row in audited["rows"])
    assert rows["bending"]["status"] == "refused"
    assert "expected bending, without which a strip has no stiffness" in rows["bending"]["reason"]
    assert rows["bending"]["torque"] is None
    assert "inextensible" in rows["stretching"]["effects"]
    assert rows["strip_inertia"]["effects"] == ["bending", "stretching", "body_inertia", "gravity"]
    assert rows["strip_inertia"]["degrees_of_freedom"] == 3
    assert 1e-3 < rows["strip_inertia"]["first_mode"] < 2e-2  # two strips of a third of the body's mass
    assert rows["strip_inertia"]["trajectory"] == rows["strip_inertia"]["torque"] == 0.0
    assert rows["body_inertia"]["first_mode"] > 1.0
    assert rows["body_inertia"]["swing_frequency"] is None
    assert 0.0 < rows["gravity"]["torque"] < 1e-4
    for row in (audited["full"], *audited["rows"][1:]):
        limit = 2.0 if "inextensible" in row["effects"] else 12.0**0.5
        step = limit / (2.0 * np.pi * row["highest_frequency_Hz"])
        assert row["explicit_step_s"] == pytest.approx(step, rel=1e-9)


def test_effects_that_are_tried_together_are_all_combinations(audited):
    """Of the effects that can each be left out, every combination of two and more is tried."""
    single = [row["dropped"][0] for row in audited["rows"] if row["status"] == "converged"]
    free = [name for name in single if _largest(audited, name) <= TOLERANCE]
    assert len(audited["tried"]) == 2 ** len(free) - 1 - len(free)
    assert {frozenset(row["dropped"]) for row in audited["tried"]} >= {frozenset(free)}


def _largest(audited, name):
    row = next(row for row in audited["rows"] if row["dropped"] == [name])
    changes = (row[key] for key in ("trajectory", "torque", "swing_frequency", "first_mode", "loss"))
    return max(abs(change) for change in changes if change is not None)


def test_leaving_out_an_effect():
    """Stretching is replaced, massless strips take their sections' rotary inertia along, others just go."""
    full = Variant.full(Effects(names=("bending", "stretching", "strip_inertia", "body_inertia", "gravity")))
    assert full.effects.names[-1] == "section_rotary_inertia"
    assert full.label == "full scene"
    rigid, light = full.without(["stretching"]), full.without(["strip_inertia", "gravity"])
    assert rigid.effects.names[:2] == ("bending", "inextensible")
    assert light.effects.names == ("bending", "stretching", "body_inertia")
    assert light.label == "massless strips, no gravity"
    massless = Variant.full(Effects(names=("bending", "stretching", "body_inertia")))
    assert "section_rotary_inertia" not in massless.effects.names


@pytest.mark.slow
def test_audit_of_a_mechanism_without_a_drive(command, monkeypatch):
    """A guide that follows its load has no torque and no swing, and is judged by path and first mode."""
    monkeypatch.setattr(scenes, "SWINGS", 0.5)
    monkeypatch.setattr(module, "ROUNDS", 1)
    monkeypatch.setattr(module, "DUELS", 1)
    case = FOLDER / "parallel_strip_guide.toml"
    found = json.loads(command("audit", case, "--effects=-strip_inertia", "--json", "-").out)
    rows = {row["dropped"][0]: row for row in found["rows"]}
    assert rows["applied_force"]["trajectory"] == pytest.approx(1.0, rel=0.05)
    assert rows["gravity"]["trajectory"] > 1e-2
    assert all(row["torque"] is None and row["swing_frequency"] is None for row in found["rows"])
    assert "applied_force" in found["cheapest"]["effects"]


def test_audit_reads_well(command, monkeypatch):
    """Without --json: a line a scene, and the cheapest with what it was verified by."""
    monkeypatch.setattr(scenes, "SWINGS", 0.2)
    monkeypatch.setattr(module, "ROUNDS", 1)
    monkeypatch.setattr(module, "DUELS", 1)
    out = command("audit", TABLE_1, "--tolerance", "1e-2", "--control-points", 4).out
    lines = out.splitlines()
    assert lines[0] == f"full scene: {', '.join(FULL)}"
    assert [line.split("  ")[0] for line in lines[3:10]] == [
        "full scene",
        "no bending",
        "inextensible strips",
        "massless strips",
        "no body inertia",
        "no section rotary inertia",
        "no gravity",
    ]
    assert "cheapest within 0.01: bending, " in out
    assert "run anew: largest change " in lines[-1]


def test_audit_of_what_is_not_stable(command, tmp_path):
    """A design that does not stand at rest is exit code 3, and says why."""
    text = (FOLDER / "parallel_strip_guide.toml").read_text(encoding="utf-8")
    path = tmp_path / "heavy.toml"
    path.write_text(text.replace("mass_kg = 0.1", "mass_kg = 10"), encoding="utf-8")
    result = command("audit", path)
    assert (result.code, result.out) == (3, "")
    assert result.err.startswith(
        "studies: not converged: the full scene: the first natural frequency at rest is -"
    )


@pytest.mark.parametrize("control_points", [4, 5, 6, 7, 8])
def test_inextensible_strips_at_least_double_the_explicit_step(control_points):
    """Without stretching the axial modes are gone: half the highest frequency or less, twice the step."""
    problem = named_design("cross_axis_pivot")
    full = Variant(dropped=(), effects=problem.effects)
    sizes = [
        size_of(
            dataclasses.replace(problem, effects=each.effects), SplineSettings(control_points=control_points)
        )
        for each in (full, full.without(["stretching"]))
    ]
    assert sizes[0]["highest_frequency_Hz"] >= 2.0 * sizes[1]["highest_frequency_Hz"]
    assert sizes[1]["explicit_step_s"] >= 2.0 * sizes[0]["explicit_step_s"]
    assert sizes[1]["degrees_of_freedom"] < sizes[0]["degrees_of_freedom"]


def test_stored_worth_says_where_effects_matter():
    """The tables hold every effect of every design, and say that weight matters to slender strips."""
    tables = Store().load_tables("effects/worth")
    rows = tables["worth"].set_index(["design", "dropped"])
    assert rows.index.is_unique
    assert len(rows) == 4 * len(FULL)
    assert set(rows.loc[rows["status"] == "refused"].index.get_level_values("dropped")) == {"bending"}
    weight = rows["largest"].xs("gravity", level="dropped")
    assert weight["ten times more slender"] > 1e-2 > 1e-3 > weight["Table 1"]
    massless = rows["first_mode"].xs("strip_inertia", level="dropped")
    assert (
        massless["body ten times heavier"] < 1e-3 < massless["Table 1"] < massless["body ten times lighter"]
    )
    assert (tables["cheapest"]["largest"] <= tables["cheapest"]["tolerance"]).all()
    steps = tables["steps"].pivot(index="control_points", columns="stretching", values="explicit_step_s")
    assert (relative_error(steps["no"].to_numpy(), steps["yes"].to_numpy()) >= 1.0).all()


def test_weight_that_makes_a_design_unstable_is_a_finding(monkeypatch):
    """The polymer pivot, which its weight would tip over, is audited without it, and a row says why."""
    monkeypatch.setattr(scenes, "SWINGS", 0.05)
    monkeypatch.setattr(module, "ROUNDS", 1)
    monkeypatch.setattr(module, "DUELS", 1)
    found = module.audit(named_design("polymer_pivot"), SplineSettings(control_points=6), 1e-3)
    assert "gravity" not in found.full.variant.effects.names
    row = found.rows[-1]
    assert (row.variant.label, row.status) == ("with gravity", "unstable")
    assert row.reason == "the first natural frequency at rest is -1.017 Hz"
    assert row.largest == math.inf


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(path.stem for path in FOLDER.glob("*.toml")))
def test_every_shipped_case_can_be_audited(name, monkeypatch, capsys):
    """None of the cases that come with the suite is refused."""
    monkeypatch.setattr(scenes, "SWINGS", 0.2)
    assert main(["audit", str(FOLDER / f"{name}.toml")]) == 0
    assert "cheape" in capsys.readouterr().out


def test_what_planar_beams_leave_out_is_priced(audited):
    """Table 1's wide clamps, flat sections, roots and shear change its answers by what theory says."""
    found = {row["effect"]: row for row in audited["beyond"]}
    assert list(found) == ["clamped_width", "anticlastic", "root_compliance", "all three", "shear"]
    root = 2.0 * 0.416 * 0.005 / (0.06 * math.sqrt(2.0))
    assert found["root_compliance"]["stiffness"] == pytest.approx(1.0 / (1.0 + root) - 1.0, rel=2e-3)
    assert found["clamped_width"]["stiffness"] == pytest.approx(0.0082, abs=1e-4)
    assert found["anticlastic"]["stiffness"] == pytest.approx(0.0, abs=1e-8)
    assert found["shear"]["torque"] == pytest.approx(-0.0024, abs=1e-5)
    assert all(
        row["first_mode"] == pytest.approx(0.5 * row["stiffness"], rel=0.1, abs=3e-5)
        for row in found.values()
    )


def test_what_has_no_price_says_why():
    """Inextensible strips are unknown to the elements: the row of shear says so, the others have prices."""
    design = named_design("cross_axis_pivot")
    rigid = dataclasses.replace(
        design, effects=design.effects.renamed(["bending", "inextensible", "body_inertia"])
    )
    rows = {row["effect"]: row for row in prices(rigid)}
    assert (rows["shear"]["status"], rows["anticlastic"]["status"]) == ("refused", "converged")
    assert "got 'inextensible'" in rows["shear"]["reason"]
    assert math.isnan(rows["shear"]["largest"])
