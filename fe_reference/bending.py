"""The moment of a strip whose section curls across its width no more than clamps and curvature let it.

A section that is free to curl (anticlastic bending) has the rigidity EI, one that is held flat
EI / (1 - nu^2). With g the share of its curl that the clamps leave (`plate`) and f that which its own
curvature leaves, the energy per length and what follows from it are

    U = (1/2) D kappa^2 (1 - nu^2 g f),    D = EI / (1 - nu^2),    M = dU/dkappa

    f = (2 / x) (cosh x - cos x) / (sinh x + sin x),    x^2 = c |kappa|,    c = sqrt(3 (1 - nu^2)) b^2 / t

for a rectangle of width b and thickness t: the curl that its edges are too far apart to keep. f is a smooth
function of w = x^4 = (c kappa)^2, and with f_1 = w f'(w) and f_2 = w^2 f''(w)

    M = D kappa (1 - nu^2 g (f + f_1)),    dM/dkappa = D (1 - nu^2 g (f + 5 f_1 + 2 f_2)).

Sources: D. G. Ashwell, J. Roy. Aeronaut. Soc. 54 (1950) 708-715; B. Audoly, S. Neukirch, J. Mech. Phys.
Solids (2021).
"""

import math

from .arrays import Array, kernel

Shares = tuple[float, float, float]
Bent = tuple[float, float, float, float, float, float]

#: w below which f is taken as 2 P / Q with P = sum w^k / (4 k + 2)! and Q = sum w^k / (4 k + 1)!, whose terms
#: are all positive, and the number of them that is exact to the last digit there.
NEAR, TERMS = 5.0**4, 9
P = tuple(1.0 / math.factorial(4 * k + 2) for k in reversed(range(TERMS)))
Q = tuple(1.0 / math.factorial(4 * k + 1) for k in reversed(range(TERMS)))
#: At most so many Newton steps to the curvature of a moment, and to the turns of an element's roots.
STEPS = 50
#: Two Gauss points of an element, whose end turns a, b make the curvature ((6 xi - 4) a + (6 xi - 2) b) / l.
ROOT_3 = math.sqrt(3.0)


@kernel()
def left_by_curvature(reach: float, curvature: float) -> Shares:
    """Return f, w f' and w^2 f'' at a curvature [1/m] of a section with the `reach` c [m], 0 for f = 1."""
    if reach == 0.0:
        return 1.0, 0.0, 0.0
    w = (reach * curvature) ** 2
    if w < NEAR:
        p, q = _series(P, w), _series(Q, w)
        over = 1.0 / q[0]
        y, z = p[0] * over, q[1] * over
        once = p[1] * over - y * z
        return 2.0 * y, 2.0 * once, 2.0 * ((p[2] - y * q[2]) * over - 2.0 * once * z)
    x = math.sqrt(reach * abs(curvature))
    e = math.exp(-x)
    c, s = 2.0 * e * math.cos(x), 2.0 * e * math.sin(x)
    over = 1.0 / (1.0 - e * e + s)  # all relative to e^x / 2
    y, z, n = (1.0 + e * e - c) * over, (1.0 + e * e + c) * over, (1.0 - e * e - s) * over
    # f = 2 y / x with y' = 1 - y z and z' = n - z^2
    slope, bend, f = 1.0 - y * z, 2.0 * y * z * z - z - y * n, 2.0 * y / x
    once, twice = 2.0 * slope - f, 2.0 * x * bend - 4.0 * slope + 2.0 * f  # x f_x, x^2 f_xx
    return f, 0.25 * once, (twice - 3.0 * once) / 16.0


@kernel()
def _series(coefficients: tuple[float, ...], w: float) -> Shares:
    """Return a polynomial in w with the highest coefficient first, w times its slope and w^2 its bend."""
    value, slope, bend = 0.0, 0.0, 0.0
    for coefficient in coefficients:
        bend, slope, value = bend * w + slope, slope * w + value, value * w + coefficient
    return value, w * slope, 2.0 * w * w * bend


@kernel()
def section(rigidity: float, held: float, reach: float, curvature: float) -> Shares:
    """Return energy [J/m], moment [N m] and tangent rigidity [N m^2] of a section at a curvature [1/m].

    Args:
        rigidity: of the section held flat, D [N m^2]. held: nu^2 g. reach: c [m], 0 for f = 1.
    """
    f, f_1, f_2 = left_by_curvature(reach, curvature)
    moment = rigidity * curvature * (1.0 - held * (f + f_1))
    energy = 0.5 * rigidity * curvature * curvature * (1.0 - held * f)
    return energy, moment, rigidity * (1.0 - held * (f + 5.0 * f_1 + 2.0 * f_2))


@kernel()
def bent_element(row: Array, first: float, second: float) -> Bent:
    """Return energy [J], both end moments [N m] and their slopes 11, 12, 22 of an element with two points.

    Args:
        row: of the element, as in `law`. first, second: turns of its end sections from the chord [rad].
    """
    energy, m_1, m_2, k_11, k_12, k_22 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    rigidity, length = row[4] / (1.0 - row[8]), row[2]
    for point in range(2):
        side = ROOT_3 if point == 1 else -ROOT_3
        a, b = side - 1.0, side + 1.0
        parts = section(rigidity, row[8] * row[9 + point], row[11], (a * first + b * second) / length)
        moment, slope = 0.5 * parts[1], 0.5 * parts[2] / length
        energy, m_1, m_2 = energy + 0.5 * length * parts[0], m_1 + a * moment, m_2 + b * moment
        k_11, k_12, k_22 = k_11 + a * a * slope, k_12 + a * b * slope, k_22 + b * b * slope
    return energy, m_1, m_2, k_11, k_12, k_22


@kernel()
def curve(rigidity: Array, held: Array, reach: Array, moments: Array) -> None:
    """Write the curvatures [1/m] of the sections of N nodes (N,) in place of their moments (S, N) [N m]."""
    for n in range(len(rigidity)):
        for k in range(len(moments)):
            moment, last = moments[k, n], math.inf
            curvature = moment / rigidity[n]
            # M grows with kappa everywhere: Newton's steps, until they grow no smaller
            for _ in range(STEPS):
                parts = section(rigidity[n], held[n], reach[n], curvature)
                step = (parts[1] - moment) / parts[2]
                if not abs(step) < last:
                    break
                curvature, last = curvature - step, abs(step)
            moments[k, n] = curvature
