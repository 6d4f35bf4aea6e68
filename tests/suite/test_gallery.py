"""Problems of the gallery and inputs of users: both models print the number that is known of each."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from studies.record.source import ROOT

GALLERY, FINDS = ROOT / "docs" / "gallery", ROOT / "tests" / "suite" / "finds"
#: EI of the gallery's usual strip [N m^2].
EI = 205e9 * 0.01 * 0.0005**3 / 12.0
MODELS = {"spline": (), "fe": ("--model", "fe", "--accuracy", 1e-4)}
FIXED = {"spline": (), "fe": ("--model", "fe", "--elements", 20)}


def follower_tip(load: float) -> tuple[float, float]:
    """Return the place x/L, y/L of the tip of a cantilever under a follower force of `load` EI/L^2.

    From the tip inwards the force is constant in the axes of the tip: the elastica is an initial value
    problem, turned in the end so that its root is horizontal.
    """

    def rates(_: float, state: np.ndarray) -> list[float]:
        x, _, turn = state
        return [-math.cos(turn), -math.sin(turn), load * x]

    x, y, turn = solve_ivp(rates, (0.0, 1.0), [0.0, 0.0, 0.0], rtol=1e-11, atol=1e-12).y[:, -1]
    back = complex(-x, -y) * complex(math.cos(turn), -math.sin(turn))
    return back.real, back.imag


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


#: Stiffness at rest of a pivot whose strips are longer by the compliance of their supports [N m/rad].
SUPPORTED = 2.0 * 205e9 * 0.01 * 0.001**3 / 12.0 / (0.08 + 2.0 * 0.416 * 0.001)
#: What is asked, the number in its JSON, its value, and the part of it that finite axial stiffness (which the
#: closed form neglects) or the source's own digits may take [1].
KNOWN = {
    "pinned_column": ("critical-load", lambda a: a["critical_load_N"], math.pi**2 * EI / 0.2**2, 1e-4),
    "bistable_half_beam": ("solve", lambda a: min(a["shuttle_force_y_N"]), -3.231e-6, 5e-4),
    "driven_guide": ("solve", lambda a: a["stage_force_x_N"][1], 24.0 * EI * 0.0005 / 0.1**3, 5e-4),
    "cartwheel": ("solve", lambda a: a["stiffness_Nm_per_rad"][0], 8.0 * EI / 0.04 / math.sqrt(2.0), 5e-4),
    "butterfly": ("solve", lambda a: a["stiffness_Nm_per_rad"][0], 13.0 * EI / 0.02 / math.sqrt(2.0), 5e-4),
    "tapered_spring": ("solve", last("spring_tip_displacement_y_m"), tapered_tip(), 1e-4),
    "follower_cantilever": ("solve", last("beam_tip_displacement_y_m"), 0.1 * follower_tip(4.0)[1], 1e-4),
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
