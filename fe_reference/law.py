"""The two beam elements: energy, forces and tangent of each, written once and compiled.

Both are functions of the step (x, y) = u_2 - u_1 of the displacement over the element and of the turns phi_1,
phi_2 of its end sections, all from the reference; l0 is the reference length, (X, Y) the reference chord.

**Corotational** (Euler-Bernoulli). Strains are taken in the frame of the chord, of length l and turned by
beta:

    eps = (l - l0) / l0,    theta_i = phi_i - beta
    U = EA l0 (eps - e0)^2 / 2 + (2 EI / l0) (theta_1^2 + theta_1 theta_2 + theta_2^2)
        - EI k0 (phi_2 - phi_1) + l0 EI k0^2 / 2        [J]

Rotations of the chord are exact; the element itself is a straight linear beam in its own frame, which leaves
an error of second order in l0 (the bow of the element does not shorten its chord). No shear.

**Reissner** (geometrically exact, with shear). With the middle section turned by phi = (phi_1 + phi_2)/2, its
normal t and n = t turned by +90 deg, one integration point, free of locking, of second order in l0:

    eps = r'.t - 1,    gamma = r'.n,    kappa = (phi_2 - phi_1) / l0
    U = l0 (EA (eps - e0)^2 + kGA gamma^2 + EI (kappa - k0)^2) / 2        [J]

e0, k0: natural strain and curvature, of which a share may act. A test holds both against weak forms.

**Sections that do not curl freely** have the energy below in place of EI kappa^2 / 2: at the one point of the
shear-deformable element, and at two Gauss points of the other, whose curvature is linear.

A row of the table of elements is

    X, Y, l0, EA, EI, kGA, e0, k0, D (EI: it curls freely), nu^2 g at two points, reach [m]

Sources: M. A. Crisfield, Non-linear Finite Element Analysis of Solids and Structures, vol. 1 (1991), ch. 7;
E. Reissner, J. Appl. Math. Phys. (ZAMP) 23 (1972) 795-804; J. C. Simo, L. Vu-Quoc, Comput. Methods Appl.
Mech. Eng. 58 (1986) 79-116.

**Their law.** A section that is free to curl across its width (anticlastic bending) has the rigidity EI, one
that is held flat EI / (1 - nu^2). Let f be the share of the curl that remains at this curvature, and P(f) its
reduction by the clamps (`plate`); times nu^2, the energy per length and what follows from it are

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

from .arrays import Array, Indices, inlined, kernel

Energies = tuple[float, float, float]
#: The step of the displacement over an element [m], and the turns of its end sections [rad].
Moved = tuple[float, float, float, float]
#: What `elements` is given, and what it writes.
Given = tuple[bool, Array, Indices, Array]
Written = tuple[Array, Array, Array, Array]
#: What is asked of the law: forces, with the tangent, or with the part of it by the change of strains alone.
FORCES, TANGENT, MATERIAL = 0, 1, 2
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
CURL_TABLE = _table()
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
        curl: CURL_TABLE. rigidity: of the section held flat, D [N m^2].
        left: coefficients of P (TERMS,). reach: c [m], 0 for f = 1.
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
def _bent_element(curl: Array, row: Array, rate: float, first: float, second: float) -> Bent:
    """Return energy [J], end moments [N m] and their slopes 11, 12, 22 [N m] of an element with two points.

    Args:
        curl: CURL_TABLE, as of `section`.
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


@inlined()
def _turned(turn: float) -> float:
    """Return a turn [rad] less whole turns: nodes and chords may turn by any amount."""
    return turn - 2.0 * math.pi * math.floor(turn / (2.0 * math.pi) + 0.5)


@inlined()
def _corotational(
    curl: Array, row: Array, share: float, moved: Moved, asked: int, f: Array, h: Array
) -> Energies:
    """Write the ends (5,) of a corotational element; return bending, axial and shear energy.

    Also the tangent (4, 4) in `moved`, if it is asked for.
    """
    step_x, step_y, turn_1, turn_2 = moved
    x, y = row[0] + step_x, row[1] + step_y
    length, rate, bend = math.sqrt(x * x + y * y), 1.0 / row[2], share * row[7]
    turn, natural = math.atan2(row[0] * y - row[1] * x, row[0] * x + row[1] * y), row[4] * bend
    first, second, apart = _turned(turn_1 - turn), _turned(turn_2 - turn), turn_2 - turn_1
    if row[8] == row[4]:
        stiff = rate * row[4]
        moment_1, moment_2 = stiff * (4.0 * first + 2.0 * second), stiff * (2.0 * first + 4.0 * second)
        bending = 0.5 * (moment_1 * first + moment_2 * second)
        k_11, k_12, k_22 = 4.0 * stiff, 2.0 * stiff, 4.0 * stiff
    elif asked == FORCES:  # without the slopes
        bending, moment_1, moment_2, _, _, _ = _bent_element(curl, row, rate, first, second)
        k_11, k_12, k_22 = 0.0, 0.0, 0.0
    else:
        bending, moment_1, moment_2, k_11, k_12, k_22 = _bent_element(curl, row, rate, first, second)
    bending += natural * (0.5 * bend * row[2] - apart)
    # (l^2 - l0^2) / (l + l0) from the displacements: no cancellation of two nearly equal lengths
    strain = ((row[0] + x) * step_x + (row[1] + y) * step_y) / (length + row[2]) / row[2]
    strain -= share * row[6]
    axial, shear = row[3] * strain, (moment_1 + moment_2) / (length * length)
    stretching = 0.5 * axial * row[2] * strain
    axial /= length
    f[0], f[1] = axial * x + shear * y, axial * y - shear * x
    # half the turn between the ends is more than the larger only where a node has gained a whole turn
    f[2], f[3], f[4] = moment_1 + natural, moment_2 - natural, max(abs(first), abs(second), 0.5 * abs(apart))
    if asked != FORCES:
        c, s, along = x / length, y / length, row[3] / row[2]
        turning, mixed = (k_11 + 2.0 * k_12 + k_22) / (length * length), 0.0
        if asked == TANGENT:
            turning, mixed = turning + axial, shear
        h[0, 0] = along * c * c + turning * s * s - 2.0 * mixed * c * s
        h[1, 1] = along * s * s + turning * c * c + 2.0 * mixed * c * s
        h[0, 1] = (along - turning) * c * s + mixed * (c * c - s * s)
        lever_1, lever_2 = (k_11 + k_12) / length, (k_12 + k_22) / length
        h[0, 2], h[0, 3] = lever_1 * s, lever_2 * s
        h[1, 2], h[1, 3] = -lever_1 * c, -lever_2 * c
        h[2, 2], h[2, 3], h[3, 3] = k_11, k_12, k_22
    return bending, stretching, 0.0


@inlined()
def _reissner(
    curl: Array, row: Array, share: float, moved: Moved, asked: int, f: Array, h: Array
) -> Energies:
    """Write the ends (5,) of a shear-deformable element; return bending, axial and shear energy.

    Also the tangent (4, 4) in `moved`, if it is asked for.
    """
    x, y, turn_1, turn_2 = moved
    length, half = row[2], 0.25 * (turn_1 + turn_2)
    sine, less = 2.0 * math.sin(half) * math.cos(half), 2.0 * math.sin(half) ** 2
    cosine = 1.0 - less
    c, s = (row[0] * cosine - row[1] * sine) / length, (row[1] * cosine + row[0] * sine) / length
    # r'.t - 1 with r' = T + u' and T.t = cos(turn): the 1 cancels exactly for small turns
    strain = (x * c + y * s) / length - less
    sliding = (y * c - x * s) / length - sine
    curvature = (turn_2 - turn_1) / length - share * row[7]
    stretch, strain = 1.0 + strain, strain - share * row[6]
    axial, shear, moment, rigidity = row[3] * strain, row[5] * sliding, row[4] * curvature, row[4]
    unit = 0.5 * length
    bent = unit * moment * curvature
    if row[8] != row[4]:
        bent, moment, rigidity = section(curl, row[8], row[LEFT : LEFT + TERMS], row[9], curvature)
        bent *= length
    lever = 0.5 * length * (axial * sliding - shear * stretch)
    f[0], f[1] = axial * c - shear * s, axial * s + shear * c
    f[2], f[3], f[4] = lever - moment, lever + moment, 0.5 * abs(turn_2 - turn_1)
    if asked != FORCES:
        bending = rigidity / length
        along, across = 0.5 * row[3] * sliding, -0.5 * row[5] * stretch
        turning = row[3] * sliding * sliding + row[5] * stretch * stretch
        if asked == TANGENT:
            along, across = along - 0.5 * shear, across + 0.5 * axial
            turning -= axial * stretch + shear * sliding
        h[0, 0] = (row[3] * c * c + row[5] * s * s) / length
        h[1, 1] = (row[3] * s * s + row[5] * c * c) / length
        h[0, 1] = (row[3] - row[5]) * c * s / length
        h[0, 2] = h[0, 3] = along * c - across * s
        h[1, 2] = h[1, 3] = along * s + across * c
        h[2, 2] = h[3, 3] = 0.25 * length * turning + bending
        h[2, 3] = 0.25 * length * turning - bending
    return bent, unit * axial * strain, unit * shear * sliding


@inlined()
def elements(given: Given, share: float, asked: int, u: Array, written: Written) -> Energies:
    """Evaluate all elements at once.

    Args:
        given: whether they are Reissner's, the table (E, 10 + 2 TERMS), first nodes (E,), of which the second
            is the next one; CURL_TABLE.
        share: of the natural strains that acts. asked: FORCES, TANGENT or MATERIAL.
        u (nodes, 3): displacements and turns.
        written: the force (nodes, 3) that holds the elements; ends (E, 5): force x, y [N] at the second node,
            the moments [N m] at both, and the largest turn of an end from the element [rad]; matrices
            (E, 6, 6), where a tangent is asked for; scratch (4, 4).

    Returns:
        Bending, axial and shear energy [J].
    """
    (shear, table, first, curl), (force, ends, matrices, h) = given, written
    bending, axial, sliding = 0.0, 0.0, 0.0
    for i in range(len(force)):
        force[i, 0] = force[i, 1] = force[i, 2] = 0.0
    for e in range(len(first)):
        i, f = first[e], ends[e]
        j = i + 1
        moved = (u[j, 0] - u[i, 0], u[j, 1] - u[i, 1], u[i, 2], u[j, 2])
        if shear:
            parts = _reissner(curl, table[e], share, moved, asked, f, h)
        else:
            parts = _corotational(curl, table[e], share, moved, asked, f, h)
        bending, axial, sliding = bending + parts[0], axial + parts[1], sliding + parts[2]
        if asked != FORCES:
            _spread(h, matrices[e])
        force[i, 0] -= f[0]
        force[i, 1] -= f[1]
        force[i, 2] += f[2]
        force[j, 0] += f[0]
        force[j, 1] += f[1]
        force[j, 2] += f[3]
    return bending, axial, sliding


@kernel()
def _spread(h: Array, matrix: Array) -> None:
    """Write the tangent (6, 6) in the displacements of both nodes from that in their difference (4, 4)."""
    h[1, 0] = h[0, 1]
    for i in range(2):
        for j in range(2):
            matrix[i, j] = matrix[3 + i, 3 + j] = h[i, j]
            matrix[i, 3 + j] = matrix[3 + i, j] = -h[i, j]
        for k in range(2):
            turn = 2 + 3 * k
            matrix[i, turn] = matrix[turn, i] = -h[i, 2 + k]
            matrix[3 + i, turn] = matrix[turn, 3 + i] = h[i, 2 + k]
    matrix[2, 2], matrix[5, 5] = h[2, 2], h[3, 3]
    matrix[2, 5] = matrix[5, 2] = h[2, 3]
