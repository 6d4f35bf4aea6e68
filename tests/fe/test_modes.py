"""Modes: both masses, rotary inertia of the sections, strips without mass, what is held."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import brentq

from fe_reference import DEFAULT_EFFECTS, ELEMENTS, natural_frequencies
from tests.fe.scenes import GUIDE, MASSLESS, free_cantilever, pivot
from tests.gates import hold
from tests.models import extrapolated
from tests.table_one import MOMENT, SECTION, TABLE_ONE


def relative(value: np.ndarray, exact: np.ndarray) -> float:
    return float(np.abs(value / exact - 1.0).max())


@pytest.mark.parametrize("element", ELEMENTS)
def test_both_masses_extrapolate_to_the_same_frequencies(element: str) -> None:
    """At rest and at 60 degrees the frequencies do not depend on how the mass is put on the mesh."""

    def error(elements: tuple[int, ...] = (20, 40, 80)) -> float:
        worst = 0.0
        for rotation in (0.0, np.pi / 3.0):
            limits = []
            for mass in ("consistent", "lumped"):
                values = [
                    natural_frequencies(
                        pivot(elements=n, element=element),
                        rotation=rotation,
                        count=5,
                        mass=mass,
                        increments=5,
                    ).frequency
                    for n in elements
                ]
                limits.append(extrapolated(values))
            worst = max(worst, relative(*limits))
        return worst

    hold(f"fe_frequencies_by_mass_{element}", error)


def test_holding_the_rotation_interlaces_the_frequencies() -> None:
    """With the rotation held each frequency lies between two of the released pivot."""
    model = pivot(elements=10)
    free = natural_frequencies(model, rotation=1.0, count=6)
    held = natural_frequencies(model, rotation=1.0, count=5, held=True)
    assert np.all(held.frequency >= free.frequency[:5])
    assert np.all(held.frequency <= free.frequency[1:])
    assert np.all(held.body_shapes[:, 2] == 0.0)


def test_small_meshes_give_all_their_modes() -> None:
    """A mesh too small for the sparse solver is solved densely, and has no more modes than coordinates."""
    model = pivot(elements=2)
    many = natural_frequencies(model, count=9)
    few = natural_frequencies(model, count=3)
    assert many.frequency.shape == (9,)
    assert few.frequency == pytest.approx(many.frequency[:3], rel=1e-9)
    assert natural_frequencies(model, count=10).frequency == pytest.approx(many.frequency, rel=1e-9)
    assert natural_frequencies(model, count=10, accuracy=0.1).frequency.shape == (9,)


#: A thick section, so that its rotary inertia is felt; stretching is put out of the way at the same rho A.
THICK = SECTION | {"second_moment_of_area": SECTION["area"] * (0.02 * GUIDE) ** 2}


def rayleigh_frequency() -> float:
    """Return the second frequency [Hz] of a cantilever with rotary inertia.

    EI w'''' + rho I W^2 w'' - mu W^2 w = 0, clamped at 0; w'' = 0 and EI w''' + rho I W^2 w' = 0 at L. With
    w = exp(k s) this has the roots k = +-a and k = +-i b.
    """
    ei = THICK["youngs_modulus"] * THICK["second_moment_of_area"]
    mu, rotary = THICK["density"] * THICK["area"], THICK["density"] * THICK["second_moment_of_area"]

    def condition(omega: float) -> float:
        half, all_of = 0.5 * rotary * omega**2 / ei, mu * omega**2 / ei
        root = np.sqrt(half**2 + all_of)
        a, b = np.sqrt(root - half), np.sqrt(root + half)
        ch, sh, c, s = np.cosh(a * GUIDE), np.sinh(a * GUIDE), np.cos(b * GUIDE), np.sin(b * GUIDE)
        # w = A (cosh - cos) + B (sinh - a/b sin) satisfies the clamp
        moment = [a**2 * ch + b**2 * c, a**2 * sh + a * b * s]
        slope = [a * sh + b * s, a * ch - a * c]
        third = [a**3 * sh - b**3 * s, a**3 * ch + a * b**2 * c]
        shear = [p + 2.0 * half * q for p, q in zip(third, slope, strict=True)]
        return float((moment[0] * shear[1] - moment[1] * shear[0]) / (ch * ch))

    unit = np.sqrt(ei / mu) / GUIDE**2
    return float(brentq(condition, 18.0 * unit, 24.0 * unit, xtol=1e-9)) / (2.0 * np.pi)


def test_section_rotary_inertia() -> None:
    """Consistent and lumped masses with rotary inertia tend to the Rayleigh beam, without it they do not."""
    exact = rayleigh_frequency()

    def error(effects: tuple[str, ...] = ("section_rotary_inertia",)) -> float:
        worst = 0.0
        for mass in ("consistent", "lumped"):
            seen = [
                natural_frequencies(
                    free_cantilever(section=THICK, elements=n, effects=(*DEFAULT_EFFECTS, *effects)),
                    rotation=None,
                    count=2,
                    mass=mass,
                ).frequency[1]
                for n in (20, 40, 80)
            ]
            pairs = [(4.0 * fine - coarse) / 3.0 for coarse, fine in pairwise(seen)]
            worst = max(worst, abs((16.0 * pairs[1] - pairs[0]) / 15.0 / exact - 1.0))
        return float(worst)

    hold("fe_rayleigh_beam", error)


def test_body_on_massless_strips() -> None:
    """Bodies on strips without inertia have their own modes only, at the closed-form frequency."""
    inertia = TABLE_ONE["body_moment_of_inertia"] + TABLE_ONE["body_mass"] * 0.03**2
    exact = np.sqrt(2.0 * MOMENT / inertia) / (2.0 * np.pi)

    def error(area: float = 1e3) -> float:
        model = pivot(effects=MASSLESS, area=area * TABLE_ONE["area"])
        return abs(natural_frequencies(model, count=1).frequency[0] / exact - 1.0)

    hold("fe_massless_strips", error)
    assert len(natural_frequencies(pivot(effects=MASSLESS), count=4).frequency) == 3
