"""What acts on strips and bodies at an instant, their energies, and what a step adds up."""

from __future__ import annotations

import math

from spline_model.bordered import assemble, bend, derivatives, stretch
from spline_model.effects.boundary import factor_at
from spline_model.impulses.arrays import ACTIVE, BEGIN, COORDINATE, DRIVE, ORIGIN, PAIRS, SIZE
from spline_model.quadrature import (
    FIRST,
    MEASURE,
    MODE,
    MODES,
    RELAXATION,
    RIGIDITY,
    SPEED,
    STRAIN,
    STRETCHING,
    WEIGHT,
    WIDTH,
)
from spline_model.strip.compiled import called, kernel
from spline_model.strip.laws import MATERIAL


@called()
def factor(a, time, problem):
    """The factor of a load or drive at an instant [s]."""
    acting, history = problem.acting[a], problem.history
    return factor_at(time, acting[BEGIN], acting[PAIRS], history[0], history[1])


@called()
def fill(z, problem, time, space):
    """Fill the gradient (N,) and the matrix (N, N) of V - lambda psi - f q at z (N,) and ``time``.

    Drives that do not hold have lambda = 0. In the rows of the multipliers the gradient is - psi, and the
    Hessian - psi_q. Returns the least v / J0.
    """
    gradient, matrix = space.gradient, space.matrix
    _, _, slowest = assemble(z, problem.points, problem.clamps, gradient, matrix, space.work)
    for i in range(problem.weight.size):
        gradient[i] -= problem.weight[i]
    for a in range(problem.acting.shape[0]):
        acting, sizes = problem.acting[a], problem.sizes[a]
        i, size = acting[COORDINATE], factor(a, time, problem) * sizes[SIZE]
        if acting[DRIVE] < 0:
            gradient[i] -= size
            continue
        row = problem.rows[acting[DRIVE], 0]
        if acting[ACTIVE] == 0:
            gradient[row] = -z[row]
            matrix[row, row] = -1.0
            continue
        gradient[row] = sizes[ORIGIN] + size - z[i]
        gradient[i] -= z[row]
        matrix[row, i] = -1.0
        matrix[i, row] = -1.0
    return slowest


@called()
def axial_strains(z, v, rates, problem, strains):
    """Fill strains (M,) = int eps P_k ds0 of every axial mode at z, or with the rate of eps at velocity v."""
    points = problem.points
    for k in range(strains.size):
        strains[k] = 0.0
    for p in range(points.place.shape[0]):
        place, numbers = points.place[p], points.numbers[p]
        first, width, d1, d2 = place[FIRST], place[WIDTH], points.basis[0, p], points.basis[1, p]
        x, y, _, _ = derivatives(z, first, width, d1, d2)
        length = math.hypot(x, y)
        if rates:
            vx, vy, _, _ = derivatives(v, first, width, d1, d2)
            gap = (x * vx + y * vy) / length
        else:
            gap = length - (1.0 + numbers[STRAIN]) * numbers[SPEED]
        for k in range(place[MODES]):
            strains[place[MODE] - v.size + k] += numbers[WEIGHT] * points.modes[p, k] * gap


@kernel()
def strain_energy(z, v, problem, space):
    """Strain energy [J] at z (N,), the axial forces being those that the strains give."""
    points, strains, energy = problem.points, space.strains, 0.0
    for p in range(points.place.shape[0]):
        place, numbers = points.place[p], points.numbers[p]
        x1, y1, x2, y2 = derivatives(z, place[FIRST], place[WIDTH], points.basis[0, p], points.basis[1, p])
        s = x1 * x1 + y1 * y1
        length, phi = math.sqrt(s), (x1 * y2 - y1 * x2) / s
        bent = bend(phi, length, numbers, place[MEASURE])[0]
        stretched = stretch(length, 0.0, 0, numbers, place[MEASURE])[0]
        energy += numbers[WEIGHT] * (bent + stretched)
    axial_strains(z, v, False, problem, strains)
    for k in range(strains.size):
        for j in range(strains.size):
            energy += 0.5 * strains[k] * problem.rigidity[k, j] * strains[j]
    return energy


@called()
def kinetic(v, mass):
    """Kinetic energy [J] of velocities v (Q,)."""
    energy = 0.0
    for i in range(v.size):
        for j in range(v.size):
            energy += 0.5 * v[i] * mass[i, j] * v[j]
    return energy


@kernel()
def fill_drag(z, problem, space):
    """Fill the drag (Q, Q): the coordinates' own, and the strips' Kelvin-Voigt damping at z.

    int beta EI (db/dq)^T (db/dq) W du of bending, and so with the strain and EA of stretching by quadrature.
    """
    drag, points, g = space.drag, problem.points, space.work[0]
    for i in range(drag.shape[0]):
        for j in range(drag.shape[0]):
            drag[i, j] = problem.drag[i, j]
    for p in range(points.place.shape[0]):
        place, numbers = points.place[p], points.numbers[p]
        if numbers[RELAXATION] == 0.0:
            continue
        first, width, d1, d2 = place[FIRST], place[WIDTH], points.basis[0, p], points.basis[1, p]
        x1, y1, x2, y2 = derivatives(z, first, width, d1, d2)
        s, material = x1 * x1 + y1 * y1, place[MEASURE] == MATERIAL
        v = math.sqrt(s)
        w, turning = numbers[SPEED] if material else v, (2.0 if material else 3.0) * (x1 * y2 - y1 * x2) / s
        weight = numbers[WEIGHT] * numbers[RELAXATION] * w
        g[0], g[1] = (y2 - turning * x1) / (s * w), (-x2 - turning * y1) / (s * w)
        g[2], g[3] = -y1 / (s * w), x1 / (s * w)
        _add_square(drag, first, width, d1, d2, weight * numbers[RIGIDITY], g)
        if numbers[STRETCHING] > 0.0:
            g[0], g[1], g[2], g[3] = x1 / (v * numbers[SPEED]), y1 / (v * numbers[SPEED]), 0.0, 0.0
            _add_square(drag, first, width, d1, d2, weight * numbers[STRETCHING], g)


@called()
def _add_square(matrix, first, width, d1, d2, weight, g):
    """Add weight (dp/dq)^T g g^T (dp/dq), p = (x', y', x'', y'') and g (4,)."""
    for a in range(2 * width):
        mine = weight * (d1[a // 2] * g[a % 2] + d2[a // 2] * g[2 + a % 2])
        for b in range(2 * width):
            matrix[first + a, first + b] += mine * (d1[b // 2] * g[b % 2] + d2[b // 2] * g[2 + b % 2])


@called()
def external_work(z0, z1, problem, time):
    """Work [J] from z0 to z1 of the loads at ``time`` and of the drives' multipliers in z1."""
    work = 0.0
    for a in range(problem.acting.shape[0]):
        acting = problem.acting[a]
        i = acting[COORDINATE]
        if acting[DRIVE] < 0:
            work += factor(a, time, problem) * problem.sizes[a, SIZE] * (z1[i] - z0[i])
        elif acting[ACTIVE] == 1:
            work += z1[problem.rows[acting[DRIVE], 0]] * (z1[i] - z0[i])
    return work


@called()
def damped(z, v, h, problem, space):
    """Energy [J] that damping takes in a step of length h with the velocity v and ``space.drag``."""
    lost, rates = 0.0, space.strains
    for i in range(v.size):
        for j in range(v.size):
            lost += h * v[i] * space.drag[i, j] * v[j]
    axial_strains(z, v, True, problem, rates)
    for k in range(rates.size):
        for j in range(rates.size):
            lost += h * problem.relaxation[k] * rates[k] * problem.rigidity[k, j] * rates[j]
    return lost
