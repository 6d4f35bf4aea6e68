"""The shear-deformable element against Timoshenko's cantilever, whose shear rigidity is written out here."""

from fe_reference import solve_mechanism
from tests.fe.cases import extrapolated
from tests.fe.scenes import free_cantilever
from tests.gates import hold

LENGTH, DEPTH, WIDTH, YOUNGS_MODULUS, POISSON_RATIO, FORCE = 0.05, 0.01, 0.008, 2e9, 0.3, 1e-3


def deflection(elements: int) -> float:
    """Return the deflection of the tip of a stubby strip under a force so small that it is linear [m]."""
    section = {"area": WIDTH * DEPTH, "second_moment_of_area": WIDTH * DEPTH**3 / 12.0, "density": 1.0}
    section |= {"youngs_modulus": YOUNGS_MODULUS, "poisson_ratio": POISSON_RATIO}
    load = {"tip_force": {"strip": "strip", "force": (0.0, FORCE)}}
    how = {"elements": elements, "element": "reissner"}
    model = free_cantilever(length=LENGTH, section=section, parameters=load, **how)
    return float(solve_mechanism(model, increments=1).shape[-1, 0, -1, 1])


def test_shear_of_a_stubby_cantilever_is_timoshenkos() -> None:
    """F L^3 / 3 EI + F L / (5/6 G A): the factor of a rectangle, of which the shear is 3 % here.

    Timoshenko and Gere, Mechanics of Materials (1972), section 7.
    """
    bending = FORCE * LENGTH**3 / (YOUNGS_MODULUS * WIDTH * DEPTH**3 / 4.0)
    shear_modulus = YOUNGS_MODULUS / (2.0 * (1.0 + POISSON_RATIO))
    exact = bending + FORCE * LENGTH / (5.0 / 6.0 * shear_modulus * WIDTH * DEPTH)
    assert 0.02 < 1.0 - bending / exact < 0.05

    def error(elements: tuple[int, ...] = (4, 8, 16)) -> float:
        return abs(float(extrapolated([deflection(count) for count in elements])) / exact - 1.0)

    hold("fe_timoshenko_tip", error)
