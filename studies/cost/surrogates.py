"""Surrogates in closed form, and their errors against the refined spline over the whole range of rotation.

`linear_pivot`: constant stiffness, and a centre shift that grows with the square. With EI and L of a strip,
l the crossing point's distance from the moving end over L, and a the strips' inclination to the ground plate,

    T = K p,  K = 8 (EI/L) (1 - 3 l + 3 l^2)                          [N m, N m / rad]
    d = -(9 l^2 - 9 l + 1) L p^2 / (15 sin(a)),  away from the ground  [m]

where d moves the point of the body that lies at the crossing at rest. Exact for rotations p towards zero
under a pure couple, K for strips that do not stretch (for l = 1/2 for any); neglects all that follows in
p. Source: the line of Haringx and Wittrick, checked against the spline in the tests.

`pin_joint`: the model of Jensen and Howell with one pin, a joint at the crossing with a torsional spring.

    T = K p,  K = K_Theta EI / (2 L),  n = height / width of the pivot between its four clamps
    K_Theta = 5.300185 - 1.6866 n + 0.885356 n^2 - 0.2094 n^3 + 0.018385 n^4

The body turns about the crossing point at rest, which stays where it is. Published for strips that cross at
mid-length, as a mean over large rotations: at small ones it is several per cent too stiff, at large ones too
soft. Range of validity 0.5 <= n <= 4 (n = tan(inclination)); outside it is refused. Source: Jensen and
Howell, Mechanism and Machine Theory 37 (2002) 461-476, polynomial as public codes have it; the original was
not at hand.

`four_bar`: their model with four pins, crossed rigid links with torsional springs. Each strip is a rigid link
of length c L in the middle of it, with a pin and a spring k at either end; what is left of the strip is rigid
with ground or body. THE PUBLISHED COEFFICIENTS WERE NOT FOUND: c and k are fitted to the exact small-angle
stiffness and centre shift of the pivot (`linear_pivot`), which is not what Jensen and Howell did. For strips
that cross at mid-length this gives c = 2/3 and k = 2 EI/L. Exact, by that fit, for small rotations; neglects
that the real links' springs and lengths change with the load. With q, b the pins' distances from the
crossing towards ground and body, p the rotation, a the inclination, in complex numbers,

    w = q + b e^(ip),  m = arg(w),  h = acos(cos(a) |w| / (q + b)) - a
    V = k (m^2 + (p - m)^2 + 2 h^2)
    u = i w (sqrt((q + b)^2 / |w|^2 - cos(a)^2) - sin(a))

where the links turn by m + h and m - h and u moves the body's point that lies at the crossing at rest.
Source of the model: as of the pin joint; own derivation of the rest.

`constraint_model`: strips as one beam each in closed form, the beam constraint model of Awtar.

Of a beam of length L, with everything over L, EI/L^2 and EI/L, let u be the displacement of its tip along it
and v = (y, theta) that across it and its rotation, in the frame of its root, and c = I / (A L^2). Stiffness
and shortening are those of the beam-column up to the second power of the axial force p,

    (f, m) = (K0 + p K1 + p^2 K2) v,      u = c p - v K1 v / 2 - p v K2 v

    K0 = [12 -6; -6 4],  K1 = [6/5 -1/10; -1/10 2/15],  K2 = [-1/700 1/1400; 1/1400 -11/6300]

which are the derivatives of the energy

    V = v K0 v / 2 + a^2 / (2 b),   a = u + v K1 v / 2,   b = c - v K2 v,   p = a / b

The model is for deflections up to about a tenth of the length. Exact for small displacements at small axial
forces; neglects large rotations of the beam itself.

A rotation leaves the place of the body free; it is solved for from where a pin at the crossing would have it.

Source: S. Awtar, A. H. Slocum, E. Sevincer, Journal of Mechanical Design 129 (2007) 625; the energy is
derived here.
"""

import cmath
import math
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from scipy.optimize import root

from studies.answers.adapters import answer_static
from studies.answers.reference import SolvedPath, errors, largest_errors
from studies.answers.response import Response
from studies.cases.problem import Problem, named_case
from studies.cost.model import Model, Places, centre_of, ends_of, spline, turns_of
from studies.engine import Answer, Claim, Part, Study, Tables
from studies.errors import BadInput, Unanswered
from studies.kinds import Array
from studies.paper import formulations

PIN_JOINT = "pin joint"
#: Coefficients of K_Theta in ascending powers of n, and the range they are for.
COEFFICIENTS = (5.300185, -1.6866, 0.885356, -0.2094, 0.018385)
RANGE = (0.5, 4.0)
#: Distance from mid-length, over L, at which strips still count as crossing there.
MID_LENGTH = 1e-6
K0 = np.array([[12.0, -6.0], [-6.0, 4.0]])
K1 = np.array([[6.0 / 5.0, -1.0 / 10.0], [-1.0 / 10.0, 2.0 / 15.0]])
K2 = np.array([[-1.0 / 700.0, 1.0 / 1400.0], [1.0 / 1400.0, -11.0 / 6300.0]])
#: Relative change of the body's place below which it is found.
PLACED = 1e-13


class State(NamedTuple):
    """A surrogate of one pivot at S rotations: centre of mass of the body (S, 2) [m], driving torque (S,)
    [N m] and its derivative by the rotation (S,) [N m / rad]."""

    centre: Array
    torque: Array
    stiffness: Array


#: What a pivot is at rotations (S,) [rad].
Law = Callable[[Problem, Array], State]


def _path(law: Law, problem: Problem) -> SolvedPath:
    """Return the path of a surrogate."""
    turns, begin = turns_of(problem), time.perf_counter()
    found = law(problem, turns)
    return SolvedPath(rotation=turns, solve_s=time.perf_counter() - begin, **found._asdict())


def small_angle_stiffness(problem: Problem) -> float:
    """Return K of the linear pivot [N m / rad]."""
    rigidity = problem.youngs_modulus * problem.second_moment_of_area
    away = 1.0 - problem.crossing_ratio
    return 8.0 * rigidity / problem.length * (1.0 - 3.0 * away + 3.0 * away**2)


def _shift_coefficient(problem: Problem) -> float:
    """Return d / p^2 of the linear pivot [m]."""
    away = 1.0 - problem.crossing_ratio
    return -(9.0 * away**2 - 9.0 * away + 1.0) * problem.length / (15.0 * math.sin(problem.inclination))


def _centre(problem: Problem, p: Array, shift: Any) -> Array:
    """Return the centre of mass (S, 2) of a body whose point at the crossing moves by x + iy [m]."""
    crossing = complex(*problem.crossing_point)
    z = crossing + shift + (centre_of(problem) - crossing) * np.exp(1j * p)
    return np.stack((z.real, z.imag), axis=-1)


def _constant(problem: Problem, p: Array, stiffness: float, shift: float = 0.0) -> State:
    """Return a pivot of constant stiffness [N m/rad]; shift: of the body's point at the crossing, over p^2
    [m]."""
    centre = _centre(problem, p, 1j * shift * p**2)
    return State(centre, stiffness * p, np.full(len(p), stiffness))


def _linear_law(problem: Problem, p: Array) -> State:
    """Return the linear pivot at rotations p (S,)."""
    return _constant(problem, p, small_angle_stiffness(problem), _shift_coefficient(problem))


def _pinned_law(problem: Problem, p: Array) -> State:
    """Return the pin joint at rotations p (S,): the linear pivot without a shift.

    Raises:
        BadInput: a pivot outside the model's range.
    """
    if abs(problem.crossing_ratio - 0.5) > MID_LENGTH:
        raise BadInput(
            f"{PIN_JOINT}: got crossing ratio {problem.crossing_ratio:g}, expected 0.5 "
            "(crossing at mid-length)"
        )
    ratio = math.tan(problem.inclination)
    if not RANGE[0] <= ratio <= RANGE[1]:
        raise BadInput(f"{PIN_JOINT}: got height / width {ratio:.3g}, expected {RANGE[0]:g} to {RANGE[1]:g}")
    rigidity = problem.youngs_modulus * problem.second_moment_of_area
    coefficient = float(np.polynomial.polynomial.polyval(ratio, COEFFICIENTS))
    return _constant(problem, p, coefficient * rigidity / (2.0 * problem.length))


def link_length(problem: Problem) -> float:
    """Return the links' length over L, c [1], for which the small-angle centre shift is exact.

    The linkage shifts by q b p^2 / (2 (q + b) sin(a)) with q b = L^2 (c^2/4 - e^2), e = crossing ratio - 1/2.
    """
    offset = problem.crossing_ratio - 0.5
    wanted = _shift_coefficient(problem) * math.sin(problem.inclination) / problem.length
    return 4.0 * wanted + math.sqrt(16.0 * wanted**2 + 4.0 * offset**2)


def spring(problem: Problem) -> float:
    """Return k [N m / rad], with which the small-angle stiffness k (1 + 4 (e / c)^2) is exact."""
    offset = problem.crossing_ratio - 0.5
    return small_angle_stiffness(problem) / (1.0 + 4.0 * (offset / link_length(problem)) ** 2)


def _links(p: Array, ground: float, body: float, inclination: float) -> tuple[tuple[Array, ...], ...]:
    """Return mean rotation m and half difference h of the links, each with two derivatives by p.

    Args:
        ground, body: the pins' distances from the crossing, q and b [m]. inclination: a [rad].
    """
    w = ground + body * np.exp(1j * p)
    size, first, second = _apart(p, ground, body)
    mean_1 = body * (body + ground * np.cos(p)) / size**2
    mean_2 = -ground * body * np.sin(p) / size**2 - 2.0 * mean_1 * first / size
    z, z_1, z_2 = (math.cos(inclination) / (ground + body) * each for each in (size, first, second))
    height = np.sqrt(1.0 - z**2)
    half_2 = -z_2 / height - z * z_1**2 / height**3
    return (np.unwrap(np.angle(w)), mean_1, mean_2), (np.arccos(z) - inclination, -z_1 / height, half_2)


def _apart(p: Array, ground: float, body: float) -> tuple[Array, Array, Array]:
    """Return |w| and its two derivatives by p [m]."""
    size = np.abs(ground + body * np.exp(1j * p))
    first = -ground * body * np.sin(p) / size
    return size, first, (-ground * body * np.cos(p) - first**2) / size


def _shift(p: Array, ground: float, body: float, inclination: float) -> Array:
    """Return the displacement of the body's point at the crossing, as x + iy [m]."""
    size = _apart(p, ground, body)[0]
    height = np.sqrt((ground + body) ** 2 / size**2 - math.cos(inclination) ** 2)
    shift: Array = 1j * (ground + body * np.exp(1j * p)) * (height - math.sin(inclination))
    return shift


def _linkage_law(problem: Problem, p: Array) -> State:
    """Return the linkage at rotations p (S,)."""
    k, left = spring(problem), 0.5 * (1.0 - link_length(problem)) * problem.length
    ground = problem.crossing_ratio * problem.length - left
    body = (1.0 - problem.crossing_ratio) * problem.length - left
    (m, m_1, m_2), (h, h_1, h_2) = _links(p, ground, body, problem.inclination)
    by_mean = m_1**2 + m * m_2 + (1.0 - m_1) ** 2 - (p - m) * m_2
    return State(
        centre=_centre(problem, p, _shift(p, ground, body, problem.inclination)),
        torque=2.0 * k * (m * m_1 + (p - m) * (1.0 - m_1) + 2.0 * h * h_1),
        stiffness=2.0 * k * (by_mean + 2.0 * (h_1**2 + h * h_2)),
    )


def _element(u: float, v: Array, compliance: float) -> tuple[Array, Array]:
    """Return the gradient (3,) and the Hessian (3, 3) of V by (u, y, theta); v: (2,), compliance: c [1]."""
    k1, k2 = K1 @ v, K2 @ v
    b = compliance - v @ k2
    p = (u + 0.5 * v @ k1) / b
    along = np.append(1.0, k1 + 2.0 * p * k2)
    hessian = np.outer(along, along) / b
    hessian[1:, 1:] += K0 + p * K1 + p**2 * K2
    return np.append(p, K0 @ v + p * k1 + p**2 * k2), hessian


def _assembled(problem: Problem, at_rest: Places, place: complex, turn: float) -> tuple[Array, Array]:
    """Return the gradient (3,) and the Hessian (3, 3) of the energy of both strips over EI/L by the body's
    place [m] and its rotation [rad].

    Args:
        at_rest: of each strip its root, its tip from there, and from the body's centre (2, 3) [m].
    """
    compliance = problem.second_moment_of_area / (problem.area * problem.length**2)
    gradient, hessian = np.zeros(3), np.zeros((3, 3))
    for ground, along, end in at_rest:
        arm = cmath.rect(1.0, turn) * end
        tip, *rates = np.array([place + arm - ground, 1.0, 1.0j, 1.0j * arm, -arm]) / along
        g, h = _element(tip.real - 1.0, np.array([tip.imag, turn]), compliance)
        moved = np.array(rates)
        jacobian = np.stack((moved[:3].real, moved[:3].imag, (0.0, 0.0, 1.0)))
        gradient += g @ jacobian
        hessian += jacobian.T @ h @ jacobian
        hessian[2, 2] += g[0] * moved[3].real + g[1] * moved[3].imag
    return gradient, hessian


def _beam_law(problem: Problem, turns: Array) -> State:
    """Return a pivot at rotations (S,).

    Raises:
        Unanswered: there is no equilibrium at one of them.
    """
    ground, end = ends_of(problem).T
    at_rest = np.stack((ground, end - ground, end - centre_of(problem)), axis=1)
    states = [_equilibrium(problem, at_rest, float(turn)) for turn in turns]
    place, torque, stiffness = (np.array(each) for each in zip(*states, strict=True))
    unit = problem.youngs_modulus * problem.second_moment_of_area / problem.length
    return State(place, unit * torque, unit * stiffness)


def _equilibrium(problem: Problem, at_rest: Places, turn: float) -> tuple[Array, float, float]:
    """Return the body's place (2,) [m], and torque and stiffness over EI/L; errors as of `_beam_law`."""

    def forces(place: Array) -> tuple[Array, Array]:
        gradient, hessian = _assembled(problem, at_rest, complex(*place), turn)
        return gradient[:2], hessian[:2, :2]

    found = root(forces, _centre(problem, np.array([turn]), 0.0)[0], jac=True, tol=PLACED)
    if not found.success:
        raise Unanswered(f"constraint model: no equilibrium at {math.degrees(turn):.3g} deg")
    gradient, hessian = _assembled(problem, at_rest, complex(*found.x), turn)
    free = np.linalg.solve(hessian[:2, :2], hessian[:2, 2])
    return found.x, gradient[2], hessian[2, 2] - hessian[2, :2] @ free


#: Laws by the names of the models: of those whose rotation is the only coordinate, and of all.
PSEUDO_LAWS: dict[str, Law] = {"linear pivot": _linear_law, PIN_JOINT: _pinned_law, "four-bar": _linkage_law}
LAWS = PSEUDO_LAWS | {"beam constraint model": _beam_law}
SURROGATES = {name: Model(name=name, path=partial(_path, law)) for name, law in LAWS.items()}

#: Splines beside them: what the paper wrote, the same count without locking, and the default.
SPLINES = (formulations.PAPER, formulations.LOCKING_FREE, formulations.SIX)
#: Control points of the reference, and those whose difference to it is its uncertainty.
REFINED, CHECK = 12, 10

#: States of a path: one a degree.
STATES = 91
QUANTITIES = ("trajectory", "torque", "stiffness")


def _paths() -> Answer:
    """Return errors over the path (a row a model and degree) and the reference's uncertainty."""
    problem = replace(named_case(), increments=STATES - 1)
    limit, near = (spline.path(problem, control_points=n) for n in (REFINED, CHECK))
    paths = {name: each.path(problem) for name, each in SURROGATES.items()}
    paths |= {name: answer_static(problem, formulations.SETTINGS[name]) for name in SPLINES}
    known = largest_errors(near, limit)
    return {
        "errors": pd.concat(_errors(name, path, limit) for name, path in paths.items()),
        "reference": [{"quantity": name, "unit": "1", "uncertainty": known[name]} for name in QUANTITIES],
    }


def _errors(name: str, path: SolvedPath | Response, limit: Response) -> pd.DataFrame:
    """Return the errors at each rotation: trajectory >= 0, the others signed [1]."""
    found = errors(path, limit)
    found["torque"][0] = 0.0  # at rest there is none, but for round-off
    columns = {quantity: found[quantity] for quantity in QUANTITIES}
    return pd.DataFrame({"model": name, "rotation_rad": path.rotation, **columns})


def _over_the_best(tables: Tables) -> list[dict[str, Any]]:
    """Return the largest error of each spline and quantity over that of the best pseudo-rigid body."""
    largest = tables["errors"].set_index("model")[list(QUANTITIES)].abs().groupby("model").max().T
    best = largest[list(PSEUDO_LAWS)].min(axis=1)
    return [
        {"model": name, "of": quantity, "ratio": largest[name][quantity] / best[quantity]}
        for name in SPLINES
        for quantity in QUANTITIES
    ]


STUDY = Study(
    parts=(Part(ask=_paths),),
    claims=(
        Claim(
            claim="Dynamic splines are more accurate than pseudo-rigid-body models",
            formulation="{model}",
            quantity="the largest error of the {of} over the best such model's",
            rows=_over_the_best,
            value="ratio",
            holds=lambda row: row["ratio"] < 1.0,
        ),
    ),
)
