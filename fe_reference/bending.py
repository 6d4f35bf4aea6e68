"""The moment of a strip whose section curls across its width no more than clamps and curvature let it.

A section that is free to curl (anticlastic bending) has the rigidity EI, one that is held flat
EI / (1 - nu^2). Let f be the share of the curl that remains at this curvature, and P(f) its reduction by the
clamps (`plate`); times nu^2, the energy per length and what follows from it are

    U = (1/2) D kappa^2 (1 - P(f)),    D = EI / (1 - nu^2),    M = dU/dkappa

    f = (2 / x) (cosh x - cos x) / (sinh x + sin x),    x^2 = c |kappa|,    c = sqrt(3 (1 - nu^2)) b^2 / t

for a rectangle of width b and thickness t: the curl that its edges are too far apart to keep. f is a smooth
function of w = x^4 = (c kappa)^2, and with f_1 = w f'(w) and f_2 = w^2 f''(w)

    M = D kappa (1 - P - P' f_1),                              f_M = f + f_1,
    dM/dkappa = D (1 - P - P' (f_K - f) - 2 P'' f_1^2),        f_K = f + 5 f_1 + 2 f_2.

P has `TERMS` coefficients, of f, f^2, ... Without clamps it is nu^2 f.

All three are read off a table over x^2 = c |kappa|, to round-off and at one cost for any strip.

Sources: D. G. Ashwell, J. Roy. Aeronaut. Soc. 54 (1950) 708-715; B. Audoly, S. Neukirch, J. Mech. Phys.
Solids (2021).
"""

import math

import numpy as np
from numpy.polynomial import Chebyshev, Polynomial, chebyshev

from .arrays import Array, inlined

Shares = tuple[float, float, float]
Bent = tuple[float, float, float, float, float, float]

#: Coefficients of P; where those of the first point of an element stand in its row.
TERMS, LEFT = 7, 10
#: f, f_M and f_K are polynomials of POWERS terms in pieces of x^2, PIECES a unit, up to x = FAR, from where
#: e^-x does not count, and in 1/x beyond.
POWERS, PIECES, FAR = 8, 3, 37


def _closed(x: Array) -> Array:
    """Return f, f_M and f_K (3, ...) at x > 0, free of cancellation and of large numbers.

    As w f' = x f_x / 4, f_M = 3 f / 4 + g and f_K = 3 f / 8 + 5 g / 2 + x g_x / 2 with
    g = sinh x sin x / (sinh x + sin x)^2.
    """
    e = np.exp(-x)  # all relative to e^x
    sinh, cosh, sine, cosine = -0.5 * np.expm1(-2.0 * x), 0.5 + 0.5 * e * e, e * np.sin(x), e * np.cos(x)
    whole = sinh + sine
    f = (np.expm1(-x) ** 2 + 4.0 * e * np.sin(0.5 * x) ** 2) / (x * whole)
    g = sinh * sine / whole**2
    slope = (sinh - sine) * (sinh * cosine - cosh * sine) / whole**3
    return np.array([f, 0.75 * f + g, 0.375 * f + 2.5 * g + 0.5 * x * slope])


def _table() -> Array:
    """Return the coefficients of the polynomials (pieces, 3, POWERS), the lowest first, in t from 0 to 1 over
    a piece of x^2; the last are those in 1/x."""
    pieces = np.arange(PIECES * FAR**2)
    t, table = chebyshev.chebpts1(POWERS), np.zeros((len(pieces) + 1, 3, POWERS))
    values = _closed(np.sqrt((pieces + 0.5 * (1.0 + t[:, None])) / PIECES))
    fitted = chebyshev.chebfit(t, values.transpose(1, 0, 2).reshape(POWERS, -1), POWERS - 1)
    for k, parts in enumerate(fitted):
        powers = Chebyshev.basis(k, domain=[0.0, 1.0]).convert(kind=Polynomial).coef
        table[:-1, :, : k + 1] += parts.reshape(3, -1).T[:, :, None] * powers
    table[-1, :, 1] = 2.0, 1.5, 0.75
    return table


#: Handed to the compiled functions, which reach all of an array by its one address.
CURL = _table()
#: Two Gauss points of an element, whose end turns a, b make the curvature ((6 xi - 4) a + (6 xi - 2) b) / l.
ROOT_3 = math.sqrt(3.0)


@inlined(fastmath={"contract"})
def _left_by_curvature(curl: Array, reach: float, curvature: float) -> Shares:
    """Return f, f_M and f_K at a curvature [1/m] of a section with the `reach` c [m], 0 for f = 1."""
    if reach == 0.0:
        return 1.0, 1.0, 1.0
    square = reach * abs(curvature)
    place, last = PIECES * square, len(curl) - 1
    if place < last:
        piece = int(place)
        t = place - piece
    else:
        piece, t = last, 1.0 / math.sqrt(square)
    row = curl[piece]
    return _polynomial(row[0], t), _polynomial(row[1], t), _polynomial(row[2], t)


@inlined(fastmath={"contract"})  # products and sums in one instruction, where the machine has it
def _polynomial(c: Array, t: float) -> float:
    """Return a polynomial of eight coefficients, the lowest first, by pairs: no long chain of sums."""
    y = t * t
    low, high = (c[0] + c[1] * t) + y * (c[2] + c[3] * t), (c[4] + c[5] * t) + y * (c[6] + c[7] * t)
    value: float = low + y * y * high
    return value


@inlined(fastmath={"contract"})
def section(curl: Array, rigidity: float, left: Array, reach: float, curvature: float) -> Shares:
    """Return energy [J/m], moment [N m] and tangent rigidity [N m^2] of a section at a curvature [1/m].

    Args:
        curl: CURL. rigidity: of the section held flat, D [N m^2]. left: coefficients of P (TERMS,). reach: c
            [m], 0 for f = 1.
    """
    f, f_m, f_k = _left_by_curvature(curl, reach, curvature)
    value = slope = bend = 0.0  # P, P' and P'' / 2, by Horner's rule
    for k in range(len(left), -1, -1):
        bend = slope + f * bend
        slope = value + f * slope
        value = f * value + (left[k - 1] if k > 0 else 0.0)
    first = f_m - f
    moment = rigidity * curvature * (1.0 - value - slope * first)
    energy = 0.5 * rigidity * curvature * curvature * (1.0 - value)
    return energy, moment, rigidity * (1.0 - value - slope * (f_k - f) - 4.0 * bend * first * first)


@inlined(fastmath={"contract"})
def bent_element(curl: Array, row: Array, rate: float, first: float, second: float) -> Bent:
    """Return energy [J], end moments [N m] and their slopes 11, 12, 22 [N m] of an element with two points.

    Args:
        curl: CURL, as of `section`.
        row: row of the element (10 + 2 TERMS,), as in `law`.
        rate: 1 / l0 [1/m].
        first, second: turns of its end sections from the chord [rad].
    """
    even, odd = (second - first) * rate, ROOT_3 * (first + second) * rate
    u_1, m_1, s_1 = section(curl, row[8], row[LEFT : LEFT + TERMS], row[9], even - odd)
    u_2, m_2, s_2 = section(curl, row[8], row[LEFT + TERMS :], row[9], even + odd)
    equal, unlike = 0.5 * (m_2 + m_1), 0.5 * ROOT_3 * (m_2 - m_1)
    both, apart = rate * (s_2 + s_1), ROOT_3 * rate * (s_2 - s_1)
    energy = 0.5 * row[2] * (u_1 + u_2)
    return energy, unlike - equal, unlike + equal, 2.0 * both - apart, both, 2.0 * both + apart
