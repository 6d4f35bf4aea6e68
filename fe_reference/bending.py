"""The moment of a strip whose section curls across its width no more than clamps and curvature let it.

A section that is free to curl (anticlastic bending) has the rigidity EI, one that is held flat
EI / (1 - nu^2). With g the share of its curl that the clamps leave (`plate`) and f that which its own
curvature leaves, the energy per length and what follows from it are

    U = (1/2) D kappa^2 (1 - nu^2 g f),    D = EI / (1 - nu^2),    M = dU/dkappa

    f = (2 / x) (cosh x - cos x) / (sinh x + sin x),    x^2 = c |kappa|,    c = sqrt(3 (1 - nu^2)) b^2 / t

for a rectangle of width b and thickness t: the curl that its edges are too far apart to keep. f is a smooth
function of w = x^4 = (c kappa)^2, and with f_1 = w f'(w) and f_2 = w^2 f''(w)

    M = D kappa (1 - nu^2 g f_M),            f_M = f + f_1,
    dM/dkappa = D (1 - nu^2 g f_K),          f_K = f + 5 f_1 + 2 f_2.

Sources: D. G. Ashwell, J. Roy. Aeronaut. Soc. 54 (1950) 708-715; B. Audoly, S. Neukirch, J. Mech. Phys.
Solids (2021).
"""

import math

from .arrays import Array, inlined, kernel

Shares = tuple[float, float, float]
Bent = tuple[float, float, float, float, float, float]

#: w below which f is taken as 2 P / Q with P = sum w^k / (4 k + 2)! and Q = sum w^k / (4 k + 1)!, whose terms
#: are all positive, and the number of them that is exact to the last digit there.
NEAR, TERMS = 5.0**4, 9
P = tuple(1.0 / math.factorial(4 * k + 2) for k in reversed(range(TERMS)))
Q = tuple(1.0 / math.factorial(4 * k + 1) for k in reversed(range(TERMS)))
#: w below which f is its own power series, and its terms that are exact to the last digit there.
NEARER, FEW = 1.0, 8


def _quotient() -> tuple[float, ...]:
    """Return the power series of f = 2 P / Q, the lowest coefficient first."""
    found: list[float] = []
    for k in range(FEW):
        known = sum(f * Q[TERMS - 1 - k + j] for j, f in enumerate(found))
        found.append(2.0 * P[TERMS - 1 - k] - known)
    return tuple(found)


F = _quotient()
F_M = tuple((k + 1) * f for k, f in enumerate(F))
F_K = tuple((k + 1) * (2 * k + 1) * f for k, f in enumerate(F))
#: At most so many Newton steps to the curvature of a moment, and to the turns of an element's roots.
STEPS = 50
#: A change of a turn [rad] that no moment feels.
ROUND_OFF = 1e-17
#: Two Gauss points of an element, whose end turns a, b make the curvature ((6 xi - 4) a + (6 xi - 2) b) / l.
ROOT_3 = math.sqrt(3.0)


@inlined()
def _left_by_curvature(reach: float, curvature: float) -> Shares:
    """Return f, f_M and f_K at a curvature [1/m] of a section with the `reach` c [m], 0 for f = 1."""
    if reach == 0.0:
        return 1.0, 1.0, 1.0
    w = (reach * curvature) ** 2
    if w < NEARER:
        return _short(F, w), _short(F_M, w), _short(F_K, w)
    return _far(reach, curvature, w)


@inlined(fastmath={"contract"})  # products and sums in one instruction, where the machine has it
def _short(c: tuple[float, ...], w: float) -> float:
    """Return a polynomial of eight coefficients in w, the lowest first, by pairs: no long chain of sums."""
    y = w * w
    return (c[0] + c[1] * w) + y * (c[2] + c[3] * w) + y * y * ((c[4] + c[5] * w) + y * (c[6] + c[7] * w))


@kernel()
def _far(reach: float, curvature: float, w: float) -> Shares:
    """Return the same where the short series does not reach."""
    if w < NEAR:
        p, q = _series(P, w), _series(Q, w)
        over = 1.0 / q[0]
        y, z = p[0] * over, q[1] * over
        once = p[1] * over - y * z
        twice = (p[2] - y * q[2]) * over - 2.0 * once * z
        return 2.0 * y, 2.0 * (y + once), 2.0 * y + 10.0 * once + 4.0 * twice
    x = math.sqrt(reach * abs(curvature))
    e = math.exp(-x)
    c, s = 2.0 * e * math.cos(x), 2.0 * e * math.sin(x)
    over = 1.0 / (1.0 - e * e + s)  # all relative to e^x / 2
    y, z, n = (1.0 + e * e - c) * over, (1.0 + e * e + c) * over, (1.0 - e * e - s) * over
    # f = 2 y / x with y' = 1 - y z and z' = n - z^2
    slope, bend, f = 1.0 - y * z, 2.0 * y * z * z - z - y * n, 2.0 * y / x
    once, twice = 2.0 * slope - f, 2.0 * x * bend - 4.0 * slope + 2.0 * f  # x f_x, x^2 f_xx
    return f, f + 0.25 * once, f + 0.875 * once + 0.125 * twice


@kernel()
def _series(coefficients: tuple[float, ...], w: float) -> Shares:
    """Return a polynomial in w with the highest coefficient first, w times its slope and w^2 its bend."""
    value, slope, bend = 0.0, 0.0, 0.0
    for coefficient in coefficients:
        bend, slope, value = bend * w + slope, slope * w + value, value * w + coefficient
    return value, w * slope, 2.0 * w * w * bend


@inlined(fastmath={"contract"})
def section(rigidity: float, held: float, reach: float, curvature: float) -> Shares:
    """Return energy [J/m], moment [N m] and tangent rigidity [N m^2] of a section at a curvature [1/m].

    Args:
        rigidity: of the section held flat, D [N m^2]. held: nu^2 g. reach: c [m], 0 for f = 1.
    """
    f, f_m, f_k = _left_by_curvature(reach, curvature)
    moment = rigidity * curvature * (1.0 - held * f_m)
    energy = 0.5 * rigidity * curvature * curvature * (1.0 - held * f)
    return energy, moment, rigidity * (1.0 - held * f_k)


@inlined(fastmath={"contract"})
def bent_element(row: Array, rate: float, first: float, second: float) -> Bent:
    """Return energy [J], both end moments [N m] and their slopes 11, 12, 22 of an element with two points.

    Args:
        row: of the element, as in `law`. rate: 1 / l0 [1/m].
        first, second: turns of its end sections from the chord [rad].
    """
    even, odd = (second - first) * rate, ROOT_3 * (first + second) * rate
    u_1, m_1, s_1 = section(row[8], row[9], row[11], even - odd)
    u_2, m_2, s_2 = section(row[8], row[10], row[11], even + odd)
    equal, unlike = 0.5 * (m_2 + m_1), 0.5 * ROOT_3 * (m_2 - m_1)
    both, apart = rate * (s_2 + s_1), ROOT_3 * rate * (s_2 - s_1)
    slopes = (2.0 * both - apart, both, 2.0 * both + apart)
    return 0.5 * row[2] * (u_1 + u_2), unlike - equal, unlike + equal, slopes[0], slopes[1], slopes[2]


@kernel()
def rooted_element(
    row: Array, rate: float, natural: float, first: float, second: float, least: float
) -> tuple[Bent, float, float]:
    """Return the same where roots hold the end sections, and how far these turn from the nodes [rad].

    The turns are c M of the end moments M at these turns, and the slopes are condensed.

    Args:
        row, rate: as above. natural: moment of the natural curvature [N m].
        first, second: turns of the nodes from the chord [rad].
        least: Newton step [rad] that need not be made any more: ROUND_OFF for moments, 0 for slopes, which
            are those before the last step.
    """
    c_1, c_2, last, turn_1, turn_2 = row[12], row[13], 0.0, first, second  # from the straight element
    for n in range(STEPS):
        energy, m_1, m_2, k_11, k_12, k_22 = bent_element(row, rate, first - turn_1, second - turn_2)
        r_1, r_2 = c_1 * (m_1 + natural) - turn_1, c_2 * (m_2 - natural) - turn_2
        a, b, c, d = 1.0 + c_1 * k_11, c_1 * k_12, c_2 * k_12, 1.0 + c_2 * k_22
        over = 1.0 / (a * d - b * c)
        step_1, step_2 = (d * r_1 - b * r_2) * over, (a * r_2 - c * r_1) * over
        turn_1, turn_2, size = turn_1 + step_1, turn_2 + step_2, max(abs(step_1), abs(step_2))
        # steps shrink with their square: the next one would be size^3 / last^2
        if n > 0 and not least * last**2 < size**3 < last**3:
            break
        last = size
    # what the last step changes is linear in it to the last digit
    n_1, n_2 = m_1 - k_11 * step_1 - k_12 * step_2, m_2 - k_12 * step_1 - k_22 * step_2
    energy -= 0.5 * ((m_1 + n_1) * step_1 + (m_2 + n_2) * step_2)
    energy += 0.5 * (c_1 * (n_1 + natural) ** 2 + c_2 * (n_2 - natural) ** 2)
    slopes = (k_11 * d - k_12 * c) * over, k_12 * over, (k_22 * a - k_12 * b) * over
    return (energy, n_1, n_2, *slopes), turn_1, turn_2


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
