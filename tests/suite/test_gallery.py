"""Problems of the gallery and inputs of users: known numbers, free motions, sizes that differ by orders."""

import json
import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import quad

import spline_model
from studies.answers.adapters import answer_static
from studies.answers.models import put
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.design import read_design
from studies.record.source import ROOT
from tests.closed_forms import followed
from tests.suite.refused import FINDS

GALLERY = ROOT / "docs" / "gallery"
#: EI of the gallery's usual strip [N m^2].
EI = 205e9 * 0.01 * 0.0005**3 / 12.0
MODELS = {"spline": (), "fe": ("--model", "fe", "--accuracy", 1e-4)}
FIXED = {"spline": (), "fe": ("--model", "fe", "--elements", 20)}


def tapered_tip() -> float:
    """Return the displacement of the tapered spring's tip [m], the integral of F (L - s)^2 / EI."""
    root = 205e9 * 0.01 * 0.001**3 / 12.0
    return 0.01 * quad(lambda s: (0.1 - s) ** 2 / (root * (1.0 - s / 0.2) ** 3), 0.0, 0.1)[0]


def last(key: str) -> Callable[[dict], float]:
    """Return what takes the last value of an array of the JSON."""
    return lambda answer: answer[key][-1]


def sprung(answer: dict) -> float:
    """Return the energy of the springs of the four-bar over that of its rotations."""
    crank, coupler = (answer["bodies"][name]["rotation_rad"][-1] for name in ("crank", "coupler"))
    return answer["spring_energy_J"][-1] / (0.1 * crank**2 + 0.05 * (coupler - crank) ** 2)


def push_and_pop(answer: dict) -> tuple[float, float]:
    """Return the extrema of the force on the shuttle of the bistable half beam [N]."""
    return min(answer["shuttle_force_y_N"]), max(answer["shuttle_force_y_N"])


#: Stiffness at rest of a pivot whose strips are longer by the compliance of their supports [N m/rad].
SUPPORTED = 2.0 * 205e9 * 0.01 * 0.001**3 / 12.0 / (0.08 + 2.0 * 0.416 * 0.001)
#: What is asked, the number in its JSON, its value, and the part of it that finite axial stiffness (which the
#: closed form neglects) or the source's own digits may take [1].
KNOWN = {
    "pinned_column": ("critical-load", lambda a: a["critical_load_N"], math.pi**2 * EI / 0.2**2, 1e-4),
    "bistable_half_beam": ("solve", push_and_pop, (-3.231e-6, 0.298e-6), 5e-4),
    "sliding_half_beam": ("solve", push_and_pop, (-2.989e-6, 0.0), 5e-4),
    "driven_guide": ("solve", lambda a: a["stage_force_x_N"][1], 24.0 * EI * 0.0005 / 0.1**3, 5e-4),
    "cartwheel": ("solve", lambda a: a["stiffness_Nm_per_rad"][0], 8.0 * EI / 0.04 / math.sqrt(2.0), 5e-4),
    "butterfly": ("solve", lambda a: a["stiffness_Nm_per_rad"][0], 13.0 * EI / 0.02 / math.sqrt(2.0), 5e-4),
    "tapered_spring": ("solve", last("spring_tip_displacement_y_m"), tapered_tip(), 1e-4),
    "follower_cantilever": ("solve", last("beam_tip_displacement_y_m"), 0.1 * followed(4.0)[1], 1e-4),
    "four_bar_with_springs": ("solve", sprung, 1.0, 1e-6),
    "half_circle": ("solve", last("torque_Nm"), -1e6, 1e-4),
    "round_rod": ("solve", last("max_stress_Pa"), 32.0 * 25.0 * 0.15 / (math.pi * 0.008**3), 1e-4),
    "supports_by_default": ("solve", lambda a: a["stiffness_Nm_per_rad"][0], SUPPORTED, 1e-4),
    "l_hinge": ("solve", lambda a: a["bodies"]["end"]["y_m"][-1] - 0.04, -0.01 * 0.216e-3 / EI, 1e-3),
}


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("name", KNOWN)
def test_the_known_number(name, model, answered):
    """A closed form, or the number of the source, is what `solve` or `critical-load` prints."""
    command, number, value, limit = KNOWN[name]
    how = (FIXED if command == "critical-load" else MODELS)[model]
    (case,) = (path for folder in (GALLERY, FINDS) if (path := folder / f"{name}.toml").is_file())
    assert number(answered(command, case, *how)) == pytest.approx(value, rel=limit)


def test_models_agree_on_the_pre_loaded_pivot(answered):
    """A force beside the centre and one at it: torque and stiffness of both models."""
    spline, fe = (answered("solve", GALLERY / "preloaded_pivot.toml", *how) for how in MODELS.values())
    for key in ("torque_Nm", "stiffness_Nm_per_rad", "com_x_m", "com_y_m"):
        scale = np.abs(spline[key]).max()
        assert np.array(fe[key]) / scale == pytest.approx(np.array(spline[key]) / scale, abs=2e-4)


FINE = {"spline": ("--control-points", 12, "--step", 1e-3), "fe": ("--model", "fe", "--elements", 40)}


@pytest.mark.slow
@pytest.mark.parametrize("model", MODELS)
def test_rotation_of_the_hub(model, answered):
    """The hub coasts with its cable: a chain of masses has turned it by 487.6 degrees after 6 s."""
    found = answered("release", GALLERY / "hub_with_cable.toml", *FINE[model], "--duration", 6)
    assert math.degrees(found["bodies"]["hub"]["rotation_rad"][-1]) == pytest.approx(487.6, rel=1e-3)


#: Fine enough for modes.
SIZE = {"spline": ["--control-points", 10], "fe": []}


@pytest.mark.parametrize("length", [2e-4, 0.1])
def test_lengths_that_differ_by_orders(length, tmp_path):
    """Requirement: both models solve a chain of strips, the middle one short or not, that is led aside by a
    twentieth of its length, and agree to 1e-3 on the torque that holds its last body straight."""
    chain, text = tmp_path / "chain.toml", (FINDS / "mixed_lengths.toml").read_text()
    places = {"0.10020000000000001": 0.1, "0.20020000000000002": 0.2}
    for old, before in places.items():
        text = text.replace(old, str(before + length))
    chain.write_text(text.replace("-0.010010000000000002", str(-0.05 * (0.2 + length))))
    design = read_design(chain)
    by = (SplineSettings(control_points=12), FeSettings(elements=20), FeSettings(elements=40))
    spline, coarse, fine = (answer_static(design, settings).torque[-1] for settings in by)
    assert spline == pytest.approx((4.0 * fine - coarse) / 3.0, rel=1e-3)


SIZES = {"spline": ("--control-points", "20"), "fe": ("--elements", "10")}


def test_modes_of_lengths_stiffnesses_and_masses_far_apart(command):
    """Requirement: 1e4 between them leaves both models' modes within 2e-3 (1e-3 of either is round-off)."""
    case = str(FINDS / "sizes_apart.toml")
    found = [
        json.loads(command("modes", case, "--model", model, *size, "--json", "-").out)["frequency_Hz"]
        for model, size in SIZES.items()
    ]
    assert found[0][:4] == pytest.approx(found[1][:4], rel=2e-3)
    refused = command("modes", case, "--model", "fe", "--elements", "20")
    assert refused.code == 2
    assert len(refused.err.splitlines()) == 1
    assert "round-off decides a frequency" in refused.err


def test_a_motion_of_lengths_stiffnesses_and_masses_far_apart(command):
    """Requirement: the led body has travelled alike in both models, though light nodes start in round-off."""
    case = str(FINDS / "sizes_apart.toml")
    sizes = {
        "spline": ("--control-points", "11"),
        "fe": ("--elements", "20", "--integrator", "generalised-alpha"),
    }
    travelled = []
    for model, size in sizes.items():
        words = ["release", case, "--model", model, *size, "--step", "2e-4", "--duration", "0.1"]
        outcome = command(*words, "--no-check", "--json", "-")
        y = json.loads(outcome.out)["bodies"]["last"]["y_m"]
        assert outcome.code == 0
        travelled.append(y[-1] - y[0])
    assert travelled[0] == pytest.approx(travelled[1], rel=0.02)


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize(
    ("name", "rigid", "first"), [("hub_with_cable", 1, 1.6876), ("free_flight", 3, 28.27)]
)
def test_rigid_motions_have_the_frequency_zero(name, rigid, first, model, command, answered):
    """Requirement: rigid motions are printed as such; the first elastic one agrees between the models."""
    words = ["modes", FINDS / f"{name}.toml", "--model", model, *SIZE[model]]
    frequency = answered(*words)["frequency_Hz"]
    assert frequency[:rigid] == [0.0] * rigid
    assert frequency[rigid] == pytest.approx(first, rel=1e-3)
    out = command(*words).out
    assert "rigid motions that nothing holds" in out and "unstable" not in out


@pytest.mark.parametrize("model", MODELS)
def test_the_slow_mode_of_a_stiff_pendulum(model, answered):
    """Requirement: sqrt(g / L) / (2 pi) = 0.28555 Hz of a point mass on a stiff bar with modes of 1e7 Hz."""
    found = answered("modes", FINDS / "pinned_pendulum.toml", "--model", model, *SIZE[model])
    exact = math.sqrt(9.8 / 3.0443) / (2.0 * math.pi)
    assert found["frequency_Hz"][0] == pytest.approx(exact, rel=2e-5)


#: Masses that move with the bodies of `free_flight`: the strip, an arc of titanium, as the mean of its ends.
STRIP = 4430.0 * 0.01 * 0.0005 * 0.1027
MASSES = {"A": 0.02 + 0.5 * STRIP, "B": 0.05 + 0.5 * STRIP}


def flown(answered, case, model, duration):
    """The answer to a release of `free_flight`, and how far its centre of mass has moved (2,)."""
    found = answered("release", case, "--model", model, "--duration", duration, "--no-check")
    places = {name: np.array([found["bodies"][name][key] for key in ("x_m", "y_m")]) for name in MASSES}
    moved = sum(mass * (places[name][:, -1] - places[name][:, 0]) for name, mass in MASSES.items())
    return found, moved / sum(MASSES.values())


@pytest.mark.parametrize("model", MODELS)
def test_free_flight_keeps_its_momentum(model, answered):
    """Requirement: the centre of mass moves by the impulse of the force, (1, 2) N as a triangle of 20 ms."""
    _, moved = flown(answered, FINDS / "free_flight.toml", model, 0.03)
    # int of the velocity: impulse 0.01 F reached at 0.02 s, 0.01 s at full speed after it
    exact = np.array([1.0, 2.0]) * (0.01 * 0.01 + 0.01 * 0.01) / sum(MASSES.values())
    assert moved == pytest.approx(exact, rel=0.03)


#: The elements need other settings: the message that refuses the default names them.
PENDULUM = {
    "spline": ["--control-points", 6, "--step", 2e-3],
    "fe": [
        *("--effects=-strip_inertia", "--elements", 4, "--model", "fe"),
        *("--integrator", "generalised-alpha", "--step", 1e-3),
    ],
}


@pytest.mark.parametrize("model", MODELS)
def test_pendulum_period(model, answered, refused):
    """Requirement: a point mass on a stiff bar from the horizontal swings in 4.1335 s, 1.18034 times 2 pi
    sqrt(L / g) (elliptic integral)."""
    words = ["release", ROOT / "docs" / "gallery" / "pendulum.toml", "--duration", 1.1]
    found = answered(*words, *PENDULUM[model], "--no-check")
    if model == "fe":
        says = "remove strip_inertia, if strips are light, and take --integrator generalised-alpha with a"
        refused("release", FINDS / "pinned_pendulum.toml", *words[2:], "--model", model, says=says)
    x, time = np.array(found["bodies"]["mass"]["x_m"]), np.array(found["time_s"])
    at = int(np.flatnonzero((x[:-1] > 0.0) & (x[1:] <= 0.0))[0])
    quarter = time[at] + (time[at + 1] - time[at]) * x[at] / (x[at] - x[at + 1])
    assert 4.0 * quarter == pytest.approx(4.1335, rel=1e-3)


def test_a_strip_of_next_to_no_mass_costs_no_shorter_steps(answered):
    """Requirement: the bar weighs 3e-8 of its mass. The steps that suit the swing are not halved for it: they
    were 107,000 for 3.6 swings. Bent by the weight, the bar starts 3.6e-4 rad below the horizontal."""
    words = ["release", FINDS / "pinned_pendulum.toml", "--duration", 15.0, "--no-check"]
    found = answered(*words)
    assert found["counters"]["halved_steps"] == 0
    assert found["counters"]["steps"] < 1200
    x, time = np.array(found["bodies"]["mass"]["x_m"]), np.array(found["time_s"])
    crossed = np.flatnonzero(x[:-1] * x[1:] <= 0.0)
    passed = time[crossed] + (time[crossed + 1] - time[crossed]) * x[crossed] / (x[crossed] - x[crossed + 1])
    assert len(passed) == 7
    assert 2.0 * np.diff(passed) == pytest.approx(4.1335, rel=3e-4)


def test_gradients_of_lengths_far_apart():
    """Requirement: a path of strips of which one is 500 times shorter has gradients, though its residual is
    round-off of the short strip: the torque at a given displacement is proportional to Young's modulus."""
    asked = put(read_design(FINDS / "mixed_lengths.toml"), SplineSettings(control_points=8))
    path = spline_model.solve_statics(asked.modelled, rotation=0.0, increments=10, body="b3")
    names = [f"s{i}.youngs_modulus" for i in range(3)]
    found = spline_model.sensitivities(asked.modelled, path, parameters=names, body="b3")
    assert 3.5e9 * found.torque.derivative[-1].sum() == pytest.approx(path.torque[-1], rel=1e-5)


@pytest.mark.slow
def test_a_search_ends_where_round_off_begins(answered):
    """Requirement: with strips of which one is 500 times shorter, finer discretisations are worse at last.
    The search ends there, and does not go on for minutes; round-off decides which is the best."""
    found = answered("solve", FINDS / "mixed_lengths.toml", "--rotation-deg", 60)
    assert found["estimate"]["torque"] < 1e-3
    assert len(found["estimate"]["trials"]) <= 12


@pytest.mark.parametrize("model", ["spline", "fe"])
def test_a_body_that_nothing_holds_has_no_stiffness(model, answered):
    """Requirement: round-off of a strip that leads from a body to itself is printed as no stiffness, without
    an error of it and without a word on the error stream."""
    found = answered("solve", FINDS / "loop.toml", "--model", model)
    assert {each for key, own in found.items() if key.startswith("body_stiffness_") for each in own} == {0.0}
    assert found["off_axis_ratio_x"] == [None] * 5
    if model == "spline":
        assert found["resolution"] == ""
        assert found["estimate"]["body_stiffness"] is None
